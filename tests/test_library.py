"""The library as its users meet it: public names, the shipped model, text and trees, and a teacher's sentences."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import torch

import dcg_torch
from dcg_torch import GroundingModel, Percept, Pose, WorldModel
from dcg_torch.agent.command import carry_out
from dcg_torch.fitting.threads import one_thread
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model.checkpoint import CheckpointError
from dcg_torch.types import DriveResult

ROOT = Path(__file__).parent.parent
THINGS = (
    Percept("m1", "mug", "blue", (1.0, 0.4, 0.0)),
    Percept("m2", "mug", "red", (1.0, -0.6, 0.0)),
    Percept("p1", "euro pallet", "brown", (2.0, 1.5, 0.0)),
    Percept("c1", "cube", "red", (2.5, -1.0, 0.0)),
)


@pytest.fixture
def model() -> GroundingModel:
    return dcg_torch.pretrained()


@pytest.fixture
def world(model: GroundingModel) -> WorldModel:
    return model.world_model(THINGS, robot=Pose(0.0, 0.0, 0.0), looked=True)


@pytest.mark.parametrize("scale", [0.1, 0.2, 1.0, 2.0])
@pytest.mark.parametrize(
    ("text", "meant"),
    [("the white mug next to the blue mug", "w1"), ("the mug left of the kettle", "w1"), ("the mug by the pan", "w2")],
)
def test_a_scene_means_the_same_at_any_scale(model: GroundingModel, scale: float, text: str, meant: str) -> None:
    """Whoever brings a table top says neither how far its things are apart nor that it is one."""
    spots = {"kettle": (2.0, 1.0), "w1": (2.0, 2.0), "blue": (2.0, 3.0), "pan": (2.0, -2.0), "w2": (2.0, -3.0)}
    kinds = {"w1": ("mug", "white"), "w2": ("mug", "white"), "blue": ("mug", "blue"), "kettle": ("kettle", "silver")}
    things = [Percept(i, *kinds.get(i, (i, "black")), (scale * x, scale * y, 0.0)) for i, (x, y) in spots.items()]
    answer = model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0, 0.0)))
    assert [thing.id for thing in answer.objects] == [meant]


@pytest.mark.parametrize("text", ["the mug next to the green one", "the mug next to the green thing"])
def test_what_has_a_colour_is_no_place(model: GroundingModel, text: str) -> None:
    """Of a landmark without a noun its colour alone tells, and sides and the ground have none."""
    spots = {
        "a": ("mug", "red", 1.0),
        "b": ("mug", "red", -3.0),
        "c": ("box", "green", 2.0),
        "d": ("box", "blue", -1.0),
    }
    things = [Percept(i, kind, color, (2.0, y, 0.0)) for i, (kind, color, y) in spots.items()]
    answer = model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0, 0.0)))
    assert [thing.id for thing in answer.objects] == ["a"]
    (modifier,) = answer.modifiers
    told = modifier.posterior[:, answer.world.things.index(answer.objects[0])]
    landmarks = [combo[0].child.grounding.object for combo in modifier.combos]
    assert landmarks[int(told.argmax())].id == "c"
    assert told.max() > 0.9
    assert not told[[one in answer.world.places for one in landmarks]].any()


def test_a_bare_colour_stands_beside_nothing(model: GroundingModel) -> None:
    """ "Closest to blue" is said of shades: it is not taken for near a blue thing, as "closest to the blue one" is."""
    looks = {"a": (77.0, 178.0, 138.0), "b": (105.0, 131.0, 150.0), "c": (128.0, 131.0, 124.0)}
    patches = [Percept(i, "patch", None, (1.0, 0.3 * k, 0.5), rgb=rgb) for k, (i, rgb) in enumerate(looks.items())]
    world = model.world_model(patches, robot=Pose(0.0, 0.0), looked=True)
    for text, placed in (("closest to blue", True), ("closest to the blue one", False)):
        answer = model.ground(text, world)
        (modifier,) = answer.modifiers
        there = [c[0].child.grounding.object in world.places for c in modifier.combos]
        assert bool((modifier.log_prior[there] > -100.0).any()) is placed


def fresh(script: str) -> str:
    """What a script prints in a process of its own, in a folder that is not the project's."""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=Path(__file__).parent
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


class TestNames:
    def test_every_public_name_is_there_and_listed(self) -> None:
        assert sorted(dcg_torch.__all__) == dcg_torch.__all__
        assert set(dcg_torch.__all__) <= set(dir(dcg_torch))
        for name in dcg_torch.__all__:
            assert getattr(dcg_torch, name).__doc__, name

    def test_the_list_is_whole_before_anything_was_used(self) -> None:
        names = set(fresh("import dcg_torch; print(*dir(dcg_torch))").split())
        assert set(dcg_torch.__all__) | {"__version__"} <= names

    def test_importing_the_package_loads_nothing_heavy(self) -> None:
        heavy = "torch", "numpy", "scipy", "pybullet", "hydra", "matplotlib"
        assert fresh(f"import sys, dcg_torch; print([m for m in {heavy} if m in sys.modules])").strip() == "[]"

    def test_a_strange_name_is_an_attribute_error(self) -> None:
        with pytest.raises(AttributeError, match="no attribute 'Scene'"):
            dcg_torch.Scene  # noqa: B018

    def test_the_versions_agree(self) -> None:
        project = (ROOT / "pyproject.toml").read_text("utf-8")
        assert re.findall(r'^version = "(.*)"$', project, re.M) == [dcg_torch.__version__]
        citation = (ROOT / "CITATION.cff").read_text("utf-8")
        assert re.findall(r"^version: (.*)$", citation, re.M) == [dcg_torch.__version__]


class TestTheShippedModel:
    def test_it_is_small_and_knows_what_it_should(self, model: GroundingModel) -> None:
        files = list((ROOT / "dcg_torch" / "model" / "shipped").iterdir())
        assert sum(path.stat().st_size for path in files) <= 3_000_000
        assert {"cube", "sphere", "cylinder"} <= set(model.symbols)
        assert isinstance(model.learner, WordPosterior)

    @pytest.mark.parametrize(
        ("command", "meant"),
        [
            ("go to the red cube", "c1"),
            ("drive to the blue one", "m1"),
            ("go to the red thing left of the cube", "m2"),
            ("go to the thing on my left", None),
        ],
    )
    def test_a_sentence_is_grounded(
        self, model: GroundingModel, world: WorldModel, command: str, meant: str | None
    ) -> None:
        answer = model.ground(command, world)
        assert answer.problem is None
        assert sum(answer.probabilities.values()) == pytest.approx(1.0)
        if meant is not None:
            assert [o.id for o in answer.objects] == [meant]

    def test_text_and_tree_are_one(self, model: GroundingModel, world: WorldModel) -> None:
        parse = dcg_torch.parse("go to the red cube")
        assert parse.tree is not None
        text, tree = model.ground("go to the red cube", world), model.ground(parse.tree, world)
        assert text.objects == tree.objects
        assert text.probabilities["c1"] == pytest.approx(tree.probabilities["c1"], abs=0.05)

    @pytest.mark.parametrize("command", ["", "   ", "?!", "\x00", "say hello"])
    def test_what_is_no_command_has_a_problem_and_teaches_nothing(
        self, model: GroundingModel, world: WorldModel, command: str
    ) -> None:
        answer = model.ground(command, world)
        assert answer.objects == ()
        assert (answer.object, answer.probability) == (None, None)
        assert answer.problem
        assert "\n" not in answer.problem
        learner = model.learner
        learned = model.learn(answer)
        assert learned.reason == answer.problem
        assert model.learner == learner

    def test_an_empty_world_has_a_problem(self, model: GroundingModel) -> None:
        bare = WorldModel(())
        assert model.ground("go to the cube", bare).problem == "there is nothing here to mean"

    @pytest.mark.parametrize("kind", [str, Path])
    def test_it_is_saved_and_loaded_by_text_or_path(
        self, model: GroundingModel, world: WorldModel, kind: type[str] | type[Path], tmp_path: Path
    ) -> None:
        where = kind(tmp_path / "saved")
        dcg_torch.save(model, where)
        again = dcg_torch.load(where)
        command = "go to the red thing left of the cube"
        assert again.ground(command, world).probabilities == model.ground(command, world).probabilities


class TestATeacher:
    @pytest.mark.parametrize(
        ("sentence", "pointing_at", "word", "type_", "id_"),
        [
            ("this is a pallet", "p1", "pallet", "euro pallet", "p1"),
            ("that is called a beaker", "m1", "beaker", "mug", "m1"),
            ("no, that is a beaker", "m2", "beaker", "mug", "m2"),
            ("it's a beaker.", "m2", "beaker", "mug", "m2"),
            ("call it a beaker", "m2", "beaker", "mug", "m2"),
            ("the red cube is called a die", None, "die", "cube", "c1"),
            ("that red cube is a die", None, "die", "cube", "c1"),
            ("a die is the same as a cube", None, "die", "cube", None),
            ("die is another word for cube", None, "die", "cube", None),
        ],
    )
    def test_a_name_is_learned(
        self,
        model: GroundingModel,
        world: WorldModel,
        sentence: str,
        pointing_at: str | None,
        word: str,
        type_: str,
        id_: str | None,
    ) -> None:
        assert model.symbols.get(word) is None or model.symbols[word].type != type_
        told = model.tell(sentence, world, pointing_at=pointing_at)
        assert told
        assert (told.word, told.type, told.object, told.problem) == (word, type_, id_, None)
        assert model.symbols[word].type == type_
        assert model.beliefs_of(word)[type_] == pytest.approx(1.0)
        found = model.ground(f"go to the {word}", model.world_model(THINGS, Pose(0.0, 0.0, 0.0), looked=True)).object
        assert found is not None
        assert found.type == type_

    @pytest.mark.parametrize(
        ("sentence", "pointing_at", "says"),
        [
            ("go to the cube", None, "teaches no name"),
            ("", "p1", "teaches no name"),
            ("this is a pallet", None, "pointed at"),
            ("this is a pallet", "nobody", "no such object"),
            ("a wug is the same as a dax", None, "neither"),
        ],
    )
    def test_what_teaches_nothing_says_why(
        self, model: GroundingModel, world: WorldModel, sentence: str, pointing_at: str | None, says: str
    ) -> None:
        learner, weight = model.learner, model.factor.weight.clone()
        told = model.tell(sentence, world, pointing_at=pointing_at)
        assert not told
        assert told.problem is not None
        assert says in told.problem
        assert "\n" not in told.problem
        assert model.learner == learner
        assert torch.equal(model.factor.weight, weight)

    def test_nonsense_to_correct_and_to_forget_is_one_line(self, model: GroundingModel, world: WorldModel) -> None:
        model.learn(model.ground("go to the pallet", world))
        learner = model.learner
        with pytest.raises(ValueError, match="'nonsense': nothing of this type was ever met") as wrong:
            model.correct("cube", "nonsense")
        with pytest.raises(ValueError, match="'nothing': this noun was never heard") as unheard:
            model.forget("nothing")
        assert "\n" not in f"{wrong.value}{unheard.value}"
        assert model.learner == learner

    def test_correct_and_forget(self, model: GroundingModel, world: WorldModel) -> None:
        model.learn(model.ground("go to the zorp", world))
        model.correct("zorp", "euro pallet")
        assert "zorp" in {entry.word for entry in model.lexicon() if entry.settled}
        found = model.ground("go to the zorp", model.world_model(THINGS, Pose(0.0, 0.0, 0.0), looked=True)).object
        assert found is not None
        assert found.id == "p1"
        model.forget("zorp")
        assert "zorp" not in {entry.word for entry in model.lexicon()}
        assert "zorp" not in model.symbols

    def test_a_world_from_before_the_lesson_will_do(self, model: GroundingModel, world: WorldModel) -> None:
        assert model.tell("that is called a beaker", world, pointing_at="m1")
        found = model.ground("go to the beaker", world).object
        assert found is not None
        assert found.type == "mug"


class TestThreads:
    def test_a_fit_leaves_the_number_of_threads_as_it_was(self, model: GroundingModel) -> None:
        before = torch.get_num_threads()
        try:
            torch.set_num_threads(2)
            with one_thread():
                assert torch.get_num_threads() == 1
            assert torch.get_num_threads() == 2
            model.train()
            assert torch.get_num_threads() == 2
            with pytest.raises(ZeroDivisionError), one_thread():
                1 / 0  # noqa: B018
            assert torch.get_num_threads() == 2
        finally:
            torch.set_num_threads(before)


class TestWrongArguments:
    @pytest.mark.parametrize("command", [None, 3, b"go to the mug"])
    def test_what_is_no_command_is_said(self, model: GroundingModel, world: WorldModel, command: object) -> None:
        with pytest.raises(TypeError, match="a command is text, a parse tree or what a parser made of it"):
            model.ground(command, world)  # type: ignore[arg-type]
        with pytest.raises(TypeError, match="an outcome is what ground"):
            model.learn(None)  # type: ignore[arg-type]

    def test_no_word_is_settled_on_nothing(self, model: GroundingModel) -> None:
        with pytest.raises(ValueError, match="not empty"):
            model.correct(" ", "cube")
        assert " " not in model.symbols

    def test_a_model_is_not_saved_into_nowhere(self, model: GroundingModel) -> None:
        with pytest.raises(CheckpointError, match="give its name"):
            model.save("")


def test_attributes_may_be_a_dict_for_a_robot_of_one_s_own(model: GroundingModel) -> None:
    """What is told apart by them is the same whether a world or a robot has them."""
    women = [
        Percept(
            "w1", "person", None, (2.0, 0.5, 0.0), attributes={"gender": "female", "glasses": True, "name": "Anna"}
        ),
        Percept(
            "w2", "person", None, (2.0, -0.5, 0.0), attributes={"gender": "female", "glasses": False, "name": "Eva"}
        ),
    ]

    class Standing:
        pose = Pose(0.0, 0.0, 0.0)

        def perceive(self) -> list[Percept]:
            return women

        def drive_to(self, target: str, percepts: Any) -> DriveResult:
            return DriveResult.ARRIVED

    world = model.world_model(women, robot=Pose(0.0, 0.0, 0.0))
    for text, meant in (("go to the woman without glasses", "w2"), ("go to Eva", "w2"), ("go to Anna", "w1")):
        assert [o.id for o in model.ground(text, world).objects] == [meant]
        outcome = carry_out(text, model, Standing())  # type: ignore[arg-type]
        assert outcome.solution is not None
        assert [o.id for o in outcome.solution.objects] == [meant]


def test_a_look_that_makes_no_sense_is_refused_by_name(model: GroundingModel) -> None:
    class Doubled:
        pose = Pose(0.0, 0.0, 0.0)

        def perceive(self) -> list[Percept]:
            return [THINGS[0], THINGS[0]]

    with pytest.raises(ValueError, match="'m1': two objects have this id"):
        carry_out("go to the mug", model, Doubled())  # type: ignore[arg-type]


def test_an_answer_is_shown_in_one_line(model: GroundingModel, world: WorldModel) -> None:
    assert re.fullmatch(
        r"Solution\(objects=\['c1'\], probability=(0\.\d{3}|1\.000)\)", repr(model.ground("the cube", world))
    )
    assert repr(model.ground("", world)) == "Solution(problem='the command is empty')"
