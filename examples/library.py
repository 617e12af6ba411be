"""The library: learn a word from a teacher and one from the outcome, ground a sentence, ask why, save and load.

Run it with `python examples/library.py`. It needs neither simulator nor robot. README.md shows the same lines.
"""

import dcg_torch
from dcg_torch import Percept, Pose

model = dcg_torch.pretrained()
things = [  # id, class name, colour, position in metres: x is ahead of the robot, y to its left
    Percept("m1", "mug", "blue", (1.0, 0.4, 0.0)),
    Percept("m2", "mug", "blue", (1.0, -0.6, 0.0)),
    Percept("l1", "desk lamp", "red", (1.0, 0.0, 0.0)),
]


def look() -> dcg_torch.WorldModel:
    """The things as the model knows them now: a world says what is known, so look again after each lesson."""
    return model.world_model(things, robot=Pose(0.0, 0.0, 0.0))


print(model.tell("this is a lamp", look(), pointing_at="l1"))  # a teacher points and says a name
answer = model.ground("the blue mug left of the lamp", look())  # nobody has said "mug" before
print([thing.id for thing in answer.objects], answer.probability, answer.probabilities)
for reason in dcg_torch.explain(model, answer)[:5]:  # what moved each phrase to its grounding, as log-odds
    print(reason)
print(model.learn(answer))  # the word that the outcome taught, or the reason why it taught none
print(model.ground("how many mugs are there?", look()).problem)  # this is no order about a thing
dcg_torch.save(model, "my_model")  # safetensors and JSON
model = dcg_torch.load("my_model")
