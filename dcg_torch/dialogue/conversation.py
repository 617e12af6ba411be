"""One input of a person after the other: what it does, done."""

from __future__ import annotations

import math

from dcg_torch.dialogue.acts import Forget, Lesson, Refused, Stop, read_act
from dcg_torch.dialogue.commands import answer, carry_out
from dcg_torch.dialogue.events import Done, Learned, Understood
from dcg_torch.dialogue.questions import answer_question, what_is_seen
from dcg_torch.dialogue.sentences import ENDINGS, with_article
from dcg_torch.dialogue.situation import Situation, Stopped, beside
from dcg_torch.geometry import bearing
from dcg_torch.language.requests import Answer, Motion, Question
from dcg_torch.language.teaching import Teaching
from dcg_torch.simulator.limits import MAX_SPIN
from dcg_torch.types import DriveResult
from dcg_torch.world.files import WorldObject


def hear(s: Situation, text: str, pointed: WorldObject | None) -> Done:
    """What a person's text does. A question that was open is dropped, unless this answers it.

    Args:
        pointed: the object that the person points at.
    """
    try:
        done = _hear(s, text, pointed)
    except Stopped:
        s.say("I stopped.")
        done = Done(s.robot.pose, "stopped")
    s.look()
    return done


def _hear(s: Situation, text: str, pointed: WorldObject | None) -> Done:
    act = read_act(text, s.model.symbols.keys(), asked=s.open is not None)
    if isinstance(act, Answer):
        return answer(s, *s.open, act) if s.open is not None else _refused(s, "There is no question to answer.")
    s.open = None
    if isinstance(act, Stop):
        s.emit(Understood("stop", "I stand still."))
        return Done(s.robot.pose, "done")
    if isinstance(act, Forget):
        return _forget(s, act.word)
    if isinstance(act, Lesson):
        return _lesson(s, text, act.teaching, pointed)
    if isinstance(act, Question):
        if pointed is not None:
            _face(s, pointed)
        return answer_question(s, act, None if pointed is None else pointed.id)
    if isinstance(act, Motion):
        return _move(s, act)
    if isinstance(act, Refused):
        return _refused(s, act.text)
    return carry_out(s, text, act)


def clicked(s: Situation, thing: WorldObject) -> Done:
    """A click on an object: an answer, or else the robot says what it takes it for."""
    try:
        if s.open is not None:
            if thing.id not in s.memory:
                _face(s, thing)
            return answer(s, *s.open, thing.id)
        return answer_question(s, Question("identify"), thing.id if _face(s, thing) else "not seen")
    except Stopped:
        s.say("I stopped.")
        return Done(s.robot.pose, "stopped")


def _refused(s: Situation, text: str) -> Done:
    s.emit(Understood("refused", text))
    return Done(s.robot.pose, "done")


def _face(s: Situation, thing: WorldObject) -> bool:
    """Turn to where a person points, unless the thing was seen already; is it seen now?"""
    s.look()
    if thing.id not in s.memory:
        s.robot.spin(bearing(s.robot.pose, *thing.position))
        s.check()
        s.look()
    return thing.id in s.memory


def _lesson(s: Situation, text: str, teaching: Teaching, pointed: WorldObject | None) -> Done:
    """Learn a name."""
    s.look()
    start, id_ = s.robot.pose, None if pointed is None else pointed.id
    answered = False
    if pointed is not None and id_ not in s.memory:
        s.emit(Understood("lesson", "I look at it."))
        answered = True
        _face(s, pointed)
    elif pointed is None and teaching.subject is not None and not s.places:
        s.emit(Understood("lesson", "I look for it."))
        answered = True
        s.look_round()
    elif pointed is None and teaching.subject is None and teaching.same_as is None and s.last is not None:
        id_ = s.last.chosen
        s.last.taken_back = s.last.taken_back or text.lower().startswith(("no", "wrong"))
    described = {id_: s.the(id_) for id_ in s.memory}
    world = s.model.world_model(s.seen, start, looked=bool(s.places))
    told = s.model.tell(text, world, pointing_at=id_)
    if told.word is not None and told.type is not None and told:
        s.taught[told.word] = "told"
        if teaching.same_as is not None:
            said = f'"{teaching.name}" and "{teaching.same_as}" are the same to me now.'
        else:
            said = f"I call {described.get(told.object or '', 'it')} {with_article(told.word)} now."
    else:
        problem = told.problem or "I do not know why"
        said = f"I have not learned that: {problem}."
    if answered:
        s.say(said)
    else:
        s.emit(Understood("lesson", said, told.object))
    if told and told.word is not None:
        s.emit(Learned(told.word, told.type, "told"))
    return Done(s.robot.pose, "done", told.object)


def _forget(s: Situation, word: str) -> Done:
    """Forget a word."""
    try:
        s.model.forget(word)
    except ValueError:
        return _refused(s, f'I have never heard the word "{word}".')
    s.taught.pop(word, None)
    s.emit(Understood("forget", f'I have forgotten what "{word}" means.'))
    s.emit(Learned(word, None, "forgotten"))
    return Done(s.robot.pose, "done")


def _move(s: Situation, motion: Motion) -> Done:
    """A motion that names no thing."""
    s.look()
    here = s.robot.pose
    if motion.kind == "look":
        s.emit(Understood("motion", "I look round."))
        s.places.clear()
        s.look_round()
        s.say(what_is_seen(s))
        return Done(s.robot.pose, "done")
    if motion.kind == "turn":
        angle = max(-MAX_SPIN, min(MAX_SPIN, motion.angle))
        side = "left" if angle > 0 else "right"
        s.emit(Understood("motion", f"I turn {side} by {abs(math.degrees(angle)):.0f} degrees."))
        s.robot.spin(angle)
        s.check()
        return Done(s.robot.pose, "done")
    if motion.kind == "return":
        if s.before is None:
            return _refused(s, "I have not been anywhere else yet.")
        goal, said = (s.before.x, s.before.y), "I go back to where I was."
    else:
        goal = beside(here, motion.angle, motion.metres)
        side = min(_SIDES, key=lambda name: abs(math.remainder(motion.angle - _SIDES[name], math.tau)))
        said = f"I drive {motion.metres:.3g} m {side}."
    s.emit(Understood("motion", said))
    back, s.before = s.before, here
    result = s.robot.go_to(*goal, s.seen)
    s.check()
    if motion.kind == "return" and back is not None and result is DriveResult.ARRIVED:
        s.robot.spin(math.remainder(back.yaw - s.robot.pose.yaw, math.tau))
        s.check()
    s.say(ENDINGS[result])
    return Done(s.robot.pose, result.value)


_SIDES = {"forward": 0.0, "to the left": math.pi / 2, "back": math.pi, "to the right": -math.pi / 2}
