"""One input of a person after the other: what it does, done."""

from __future__ import annotations

import math

from dcg_torch.dialogue import lessons
from dcg_torch.dialogue.acts import Forget, Lesson, Refused, Stop, read_act
from dcg_torch.dialogue.commands import carry_out, go_on, reply_of
from dcg_torch.dialogue.events import Done, Understood
from dcg_torch.dialogue.lessons import face
from dcg_torch.dialogue.questions import answer_question, what_is_seen
from dcg_torch.dialogue.sentences import ENDINGS
from dcg_torch.dialogue.situation import Situation, Stopped, UnclearLesson, beside
from dcg_torch.simulator.limits import MAX_SPIN
from dcg_torch.speech_acts.requests import Answer, Motion, Question
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
    act = read_act(text, s.model.symbols.keys(), asked=s.open is not None, things=s.seen)
    if isinstance(act, Answer):
        return _answered(s, act)
    s.open = None
    if isinstance(act, Stop):
        s.emit(Understood("stop", "I stand still."))
        return Done(s.robot.pose, "done")
    if isinstance(act, Forget):
        return lessons.forget(s, act.word)
    if isinstance(act, Lesson):
        return lessons.hear(s, text, act.teaching, pointed)
    if isinstance(act, Question):
        if pointed is not None:
            face(s, pointed, "question")
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
            face(s, thing, "answer")
            return _answered(s, thing.id)
        return answer_question(s, Question("identify"), thing.id if face(s, thing, "question") else "not seen")
    except Stopped:
        s.say("I stopped.")
        return Done(s.robot.pose, "stopped")


def _answered(s: Situation, said: Answer | str) -> Done:
    """An answer to the open question, in words or by a click."""
    if s.open is None:
        return _refused(s, "I have asked nothing.")
    about, asking = s.open
    reply = reply_of(s, asking, said)
    if reply is None:
        s.emit(Understood("answer", "I still do not know which one you mean; click on it, or say: the first one."))
        return s.ask(about, asking.candidates)
    s.open = None
    if isinstance(about, UnclearLesson):
        return lessons.settle(s, about.text, reply.meant)
    return go_on(s, about, asking, reply)


def _refused(s: Situation, text: str) -> Done:
    s.emit(Understood("refused", text))
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
        said = f"I drive {round(motion.metres, 2):,.15g} m {side}."
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
