"""Lessons: a person says what something is called, or that a word is to be forgotten."""

from __future__ import annotations

from dcg_torch.dialogue.events import Done, Learned, Understood
from dcg_torch.dialogue.sentences import with_article
from dcg_torch.dialogue.situation import Situation, UnclearLesson
from dcg_torch.learning.beliefs import UNMET
from dcg_torch.speech_acts.teaching import Teaching
from dcg_torch.types.geometry import bearing
from dcg_torch.world.files import WorldObject

_BELIEVED = 0.5
"""Probability from which on a meaning that a lesson changes is said to have been another."""


def face(s: Situation, thing: WorldObject, act: str) -> bool:
    """Turn to where a person points, and say so, unless the thing was seen already; is it seen now?"""
    s.look()
    if thing.id not in s.memory:
        s.emit(Understood(act, "I look at it."))
        s.robot.spin(bearing(s.robot.pose, *thing.position))
        s.check()
        s.look()
    return thing.id in s.memory


def hear(s: Situation, text: str, teaching: Teaching, pointed: WorldObject | None) -> Done:
    """Learn a name from a sentence; "this" and "that" are what is pointed at, or else what the last command meant."""
    s.look()
    if teaching.same_as is not None:
        s.emit(Understood("lesson", f'You say that "{teaching.name}" and "{teaching.same_as}" are the same.'))
        return _learn(s, text, None)
    if pointed is not None:
        face(s, pointed, "lesson")
        return _named(s, text, teaching.name, pointed.id)
    if teaching.subject is None:
        if s.last is not None:
            s.last.taken_back = s.last.taken_back or text.lower().startswith(("no", "wrong"))
        return _named(s, text, teaching.name, None if s.last is None else s.last.chosen)
    start = s.robot.pose
    if not s.places:
        s.emit(Understood("lesson", "I look for it."))
        s.look_round()
    found = s.model.ground(f"go to {teaching.subject}", s.model.world_model(s.seen, start, looked=True))
    ids = s.unclear(found)
    if len(ids) > 1:
        s.emit(Understood("lesson", "I am not sure which one you speak of."))
        return s.ask(UnclearLesson(text), ids)
    return _named(s, text, teaching.name, ids[0] if ids else found.object.id if found.object is not None else None)


def settle(s: Situation, text: str, meant: str | None) -> Done:
    """Go on with a lesson after the answer to the question which object it is about."""
    if meant is None:
        s.emit(Understood("answer", "Then I do not know what you speak of; click on it."))
        return Done(s.robot.pose, "done")
    s.emit(Understood("answer", f"You speak of {s.the(meant)}.", meant))
    return _learn(s, text, meant)


def _named(s: Situation, text: str, name: str, id_: str | None) -> Done:
    if id_ in s.memory:
        s.emit(Understood("lesson", f"You call {s.the(id_)} {with_article(name)}.", id_))
    else:
        s.emit(Understood("lesson", f"You tell me what {with_article(name)} is."))
    return _learn(s, text, id_)


def _learn(s: Situation, text: str, id_: str | None) -> Done:
    """Learn a name, after the first answer: the training takes longer than that may."""
    before = {entry.word: entry.types[0] for entry in s.model.lexicon() if entry.types}
    told = s.model.tell(text, s.model.world_model(s.seen, s.robot.pose, looked=bool(s.places)), pointing_at=id_)
    if not told or told.word is None:
        s.say(f"I have not learned that: {told.problem}.")
        return Done(s.robot.pose, "done")
    s.taught[told.word] = "told"
    s.emit(Learned(told.word, told.type, "told"))
    old, sure = before.get(told.word, (told.type, 0.0))
    if old in (told.type, UNMET) or sure < _BELIEVED:
        s.say("I will remember that.")
    else:
        s.say(f'Until now I took "{told.word}" for what my camera calls "{old}"; I take it for "{told.type}" now.')
    return Done(s.robot.pose, "done", told.object)


def forget(s: Situation, word: str | None) -> Done:
    """Forget a word, or all that were learned."""
    if word is None:
        return _forget_all(s)
    if word not in {entry.word for entry in s.model.lexicon()}:
        s.emit(Understood("forget", f'I have never heard the word "{word}".'))
        return Done(s.robot.pose, "done")
    s.emit(Understood("forget", f'You want me to forget what "{word}" means.'))
    s.model.forget(word)
    s.taught.pop(word, None)
    s.emit(Learned(word, None, "forgotten"))
    s.say("I have forgotten it.")
    return Done(s.robot.pose, "done")


def _forget_all(s: Situation) -> Done:
    """What was known from the start stays."""
    words = [e.word for e in s.model.lexicon() if not e.settled or e.word in s.taught]
    if not words:
        s.emit(Understood("forget", "I have learned no word yet."))
        return Done(s.robot.pose, "done")
    s.emit(Understood("forget", "You want me to forget all words that I have learned."))
    for word in words:
        s.model.forget(word)
        s.taught.pop(word, None)
        s.emit(Learned(word, None, "forgotten"))
    s.say("I have forgotten them.")
    return Done(s.robot.pose, "done")
