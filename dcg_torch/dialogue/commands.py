"""Commands: said what is understood, looked, asked, driven, learned; and answers to the robot's questions."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.agent.asking import Question, Reply
from dcg_torch.agent.command import Look
from dcg_torch.dialogue.events import Done, Learned, Understood
from dcg_torch.dialogue.sentences import ENDINGS, kind_of, said_of
from dcg_torch.dialogue.situation import ASKING, Errand, Situation
from dcg_torch.grounding.solution import Solution
from dcg_torch.interpretation.marks import heard
from dcg_torch.language import Parse, parse_command
from dcg_torch.language.lexicon import VERBS
from dcg_torch.learning.learner import Experience
from dcg_torch.speech_acts.requests import Answer
from dcg_torch.types import PhraseKind

_SURE_ANSWER = 0.6
"""Probability from which on an answer in words is taken to mean one of the objects asked about."""


def carry_out(s: Situation, text: str, said: Parse) -> Done:
    """Look for what a command means, ask if that is not clear, go there, and learn from it."""

    at_first: list[str | None] = []

    def first(solution: Solution, moves: bool) -> None:
        seen = solution.object is not None and not solution.object.hypothetical
        meant = solution.object.id if solution.object is not None and seen else None
        at_first.append(meant if moves else "")
        s.emit(Understood("command", understood(s, solution, moves=moves), meant))

    errand = s.find(text, said, first)
    s.last = errand
    if at_first != [""] and errand.chosen is not None and errand.chosen in at_first:
        return _decide(s, errand, saying=f"{_doing(errand.solution)}.")
    return _decide(s, errand, saying="" if at_first == [""] else None)


def understood(s: Situation, solution: Solution, *, moves: bool) -> str:
    """What a command is taken to mean, and what the robot does about it.

    Args:
        moves: it turns or drives now to see more.
    """
    noun, new = solution.noun.noun if solution.noun is not None else None, s.is_new(solution)
    thing = solution.object
    if thing is None or thing.hypothetical:
        looking = ", so I look round." if moves else "."
        if new:
            return f'I have not heard the word "{noun}" before, and see nothing that it may name{looking}'
        return f"You mean {said_of(solution)}; I have not seen it yet{looking}"
    sure = (solution.probabilities.get(thing.id) or 0.0) >= ASKING.below
    what = f"{s.the(thing.id)}"
    several = [o for o in solution.objects if not o.hypothetical]
    if new:
        begin = f'I have not heard the word "{noun}" before; I {"" if sure else "may "}take it for {what}'
    elif len(several) > 1:
        begin = f"You mean {len(several)} things; {what} is the first of them"
    else:
        begin = f"You {'' if sure else 'may '}mean {what}"
    if moves:
        return f"{begin}; I look round to be sure."
    return f"{begin}; {_doing(solution) if sure else 'I ask to be sure'}."


def _doing(solution: Solution) -> str:
    if solution.inverted:
        return "I keep away from it"
    tree = solution.tree
    action = {word.split()[0] for word in tree.phrase.words[:1]} if tree is not None else set()
    to = tree is not None and any(child.phrase.kind is PhraseKind.PREPOSITION for child in tree.children)
    handles = action & (VERBS["take"] | VERBS["put"]) and not (to and action & VERBS["go"])
    return "I can take and carry nothing, but I go there" if handles else "I go there"


def _decide(s: Situation, errand: Errand, *, saying: str | None) -> Done:
    """Ask, or go, or say that it is not there.

    Args:
        saying: what it says before it goes; None: what it has understood.
    """
    solution = errand.solution
    if len(errand.asked) < ASKING.questions and (ids := s.unclear(solution)):
        return s.ask(errand, ids)
    chosen = errand.chosen
    if chosen is None:
        s.say(f"There is no {kind_of(solution)} here." if solution.noun is not None else "I see nothing like that.")
        return Done(s.robot.pose, "absent")  # nothing is learned: visitors ask for what was never there
    if saying is None:
        saying = f"You mean {s.the(chosen)}; {_doing(solution)}."
    if saying:
        s.say(saying)
    s.before = s.robot.pose
    move = s.robot.drive_away if solution.inverted else s.robot.drive_to
    errand.result = move(chosen, s.seen)
    s.check()
    s.say("I keep away from it now." if solution.inverted and errand.result else ENDINGS[errand.result])
    s.look()
    _learn(s, errand)
    return Done(s.robot.pose, errand.result.value, chosen)


def _learn(s: Situation, errand: Errand) -> None:
    """Learn from how a command came out."""
    certain = any(reply.meant is not None for _, reply in errand.asked)
    learned = s.model.learn(errand.solution, Experience(errand.looked, certain, source=errand.text))
    if learned.symbol is not None:
        s.emit(Learned(learned.symbol.word, learned.symbol.type, "outcome"))
        word, type_ = learned.symbol.word, learned.symbol.type
        what = "a good word for it; my camera calls it so, too" if word == type_ else f'what my camera calls "{type_}"'
        s.say(f'I think that "{word}" is {what}.')


def go_on(s: Situation, errand: Errand, asking: Question, reply: Reply) -> Done:
    """Go on with a command after the answer to the question about it."""
    errand.asked.append((asking, reply))
    errand.solution = errand.command.told(errand.solution, asking, reply)
    if reply.meant is not None:
        s.emit(Understood("answer", f"You mean {s.the(reply.meant)}; {_doing(errand.solution)}.", reply.meant))
    else:
        s.emit(Understood("answer", "None of these, then."))
    s.show(errand.looks, Look(s.robot.pose, errand.looks[-1].percepts, errand.solution))
    return _decide(s, errand, saying=None if reply.meant is None else "")


def reply_of(s: Situation, asking: Question, said: Answer | str) -> Reply | None:
    """What an answer says; None if that is not clear.

    Args:
        said: in words, or the id of the object that was clicked.
    """
    ids = asking.candidates
    if isinstance(said, str):
        return Reply(said) if said in s.memory else None
    if said.ordinal is not None:
        return Reply(ids[said.ordinal]) if said.ordinal < len(ids) else None
    if said.phrase is not None:
        return _described(s, ids, said.phrase)
    if said.yes:
        return Reply(ids[0]) if len(ids) == 1 else None
    return Reply(None)


def _described(s: Situation, ids: tuple[str, ...], phrase: str) -> Reply | None:
    """The one that a phrase describes, as the robot stands now: of all that was seen, or else of those asked about."""
    read = heard(parse_command, phrase, s.model.symbols.keys(), s.seen)
    world = s.model.world_model(s.seen, s.robot.pose, looked=True)
    for meant, least in ((None, ASKING.below), (frozenset(ids), _SURE_ANSWER)):
        found = s.model.ground(read, replace(world, meant=meant))
        thing = found.object
        if thing is not None and not thing.hypothetical and (found.probability or 0.0) >= least:
            return Reply(thing.id)
    return None
