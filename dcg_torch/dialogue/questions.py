"""Answers to questions: what is there, where, how many, what a word means, why the robot did what it did."""

from __future__ import annotations

from collections.abc import Callable

from dcg_torch.dialogue import sentences
from dcg_torch.dialogue.acts import replies
from dcg_torch.dialogue.events import Done, Understood
from dcg_torch.dialogue.situation import Errand, Situation
from dcg_torch.grounding.explanation import explain, rivalry
from dcg_torch.grounding.solution import Solution, target_of
from dcg_torch.interpretation.marks import heard
from dcg_torch.language import Parse, parse_command
from dcg_torch.learning.beliefs import UNMET
from dcg_torch.names.vocabulary import GROUP_WORDS, PLACE_WORDS
from dcg_torch.speech_acts.requests import Question
from dcg_torch.types import ParseTree, Percept, Phrase, PhraseKind

_SURE = 0.5
"""Probability from which on a thing is said to be what a question is about."""
_NAMED = 0.4
"""How well the noun phrase must name a thing: a question, unlike a command, does not say that there is one."""


def answer_question(s: Situation, question: Question, pointing_at: str | None) -> Done:
    """Say what is asked for; the robot may look round first."""
    about = question.about or ""
    if question.kind in ("exists", "where", "color", "count"):
        return _about_things(s, question.kind, about)
    if question.kind == "identify":
        return _identify(s, about, pointing_at)
    s.emit(Understood("question", answer_at_once(s, question) or what_is_seen(s)))
    return Done(s.robot.pose, "done")


def answer_at_once(s: Situation, question: Question) -> str | None:
    """The answer to a question that takes neither a look nor a move; None for any other."""
    simple: dict[str, Callable[[], str]] = {
        "meaning": lambda: _meaning(s, question.about or ""),
        "why": lambda: why(s),
        "words": lambda: _words(s),
        "place": lambda: _place(s),
        "help": lambda: str(replies()["help"]),
    }
    return simple[question.kind]() if question.kind in simple else None


def _about_things(s: Situation, kind: str, about: str) -> Done:
    """Whether there are such things, where, of what colour, how many."""
    bare = about.removeprefix("the ").removeprefix("my ").removeprefix("your ")
    said = _read(s, f"go to the {bare}")
    if said.tree is None:
        s.emit(Understood("question", f"I do not know what you ask for: {said.problem}."))
        return Done(s.robot.pose, "done")
    answered = False

    def first(solution: Solution, moves: bool) -> None:
        nonlocal answered
        if moves:
            answered = True
            s.emit(Understood("question", f"You ask for {sentences.said_of(solution)}; I look round."))

    if kind == "count" and not s.places:
        answered = True
        s.emit(Understood("question", "I look round and count."))
        s.look()
        s.look_round()
    errand = s.find(about, said, first)
    unseen = _unseen_landmark(s, said.tree, errand.solution)
    if unseen is not None:
        text, id_ = f"{'No, there' if kind == 'exists' else 'There'} is no {unseen} here, as far as I can see.", None
    else:
        text, id_ = _count(s, errand) if kind == "count" else _found(s, errand, kind)
    if answered:
        s.say(text)
    else:
        s.emit(Understood("question", text, id_))
    return Done(s.robot.pose, "done" if id_ else "absent", id_)


def _unseen_landmark(s: Situation, asked: ParseTree, solution: Solution) -> str | None:
    """What a question says its thing by ("of the same colour as the cone"), if that is not there itself."""
    target = target_of(asked)
    for landmark in (below for place in (target.children if target else ()) for below in place.children):
        noun = landmark.phrase.noun
        if noun is None or noun in PLACE_WORDS or noun in GROUP_WORDS or landmark.phrase.plural:
            continue
        found = s.model.ground(ParseTree(Phrase(PhraseKind.VERB, ""), (landmark,)), solution.world)
        if found.object is None or found.object.hypothetical or found.named < _NAMED:
            return f"{landmark.phrase.color} {noun}" if landmark.phrase.color else noun
    return None


def _read(s: Situation, text: str) -> Parse:
    """What a command says here, where things may be called by their marks."""
    s.look()
    return heard(parse_command, text, s.model.symbols.keys(), s.seen)


def _found(s: Situation, errand: Errand, kind: str) -> tuple[str, str | None]:
    """The answer, and the object that it is about."""
    id_, solution = errand.chosen, errand.solution
    what = sentences.kind_of(solution)
    if id_ is None:
        if kind == "exists":
            return f"No, there is no {what} here.", None
        return f"There is no {what} here, as far as I can see.", None
    thing = s.memory[id_]
    if s.is_new(solution) and not s.is_named_so(solution, thing):
        new = f"I have not heard the word before, so {s.the(id_)} may be one"
        return f"I see nothing that I would call {sentences.with_article(what)}; {new}.", None
    if solution.named < _NAMED:
        return f"No, there is no {what} here.", None
    if solution.probabilities[id_] < _SURE:
        return f"I am not sure. It may be {s.the(id_)}, {s.where(id_)}.", id_
    if kind == "exists":
        return f"Yes: {s.the(id_)}, {s.where(id_)}.", id_
    if kind == "color":
        return f"The {what} is {thing.color}." if thing.color else f"I do not know the colour of the {what}.", id_
    others = [o.id for o in solution.objects if o.id != id_ and o.id in s.memory]
    also = f" There is also {sentences.listed([s.the(o) for o in others])}." if others else ""
    return f"The {what} is {s.where(id_)}.{also}", id_


def _count(s: Situation, errand: Errand) -> tuple[str, str | None]:
    """How many things the noun phrase describes."""
    solution, noun = errand.solution, errand.solution.noun
    there = errand.chosen is not None and solution.fits[errand.chosen] >= _NAMED
    found = [o.id for o in solution.objects if o.id in s.memory] if there else []
    color = f"{noun.color} " if noun is not None and noun.color else ""
    name = f"{color}{noun.noun if noun is not None and noun.noun else 'thing'}"
    text = f"I count {sentences.numbered(len(found), name)}"
    if not found:
        return f"{text}.", None
    return f"{text}: {sentences.listed([s.the(id_) for id_ in found])}.", found[0]


def _identify(s: Situation, about: str, pointing_at: str | None) -> Done:
    """What stands somewhere, or what is pointed at."""
    if about:
        said = _read(s, f"go to the thing {about}")
        moved = False

        def first(solution: Solution, moves: bool) -> None:
            nonlocal moved
            if moves:
                moved = True
                s.emit(Understood("question", "I look."))

        errand = s.find(about, said, first)
        id_ = errand.chosen
        text = "I see nothing there." if id_ is None else f"It is {name_of(s, s.memory[id_])}."
        unseen = None if said.tree is None else _unseen_landmark(s, said.tree, errand.solution)
        if unseen is not None:
            text, id_ = f"There is no {unseen} here, as far as I can see.", None
        if moved:
            s.say(text)
        else:
            s.emit(Understood("question", text, id_))
        return Done(s.robot.pose, "done", id_)
    id_ = pointing_at or (None if s.last is None else s.last.chosen)
    if id_ is None or id_ not in s.memory:
        s.emit(Understood("question", "I do not know which thing you mean; click on it."))
        return Done(s.robot.pose, "done")
    s.emit(Understood("question", f"It is {name_of(s, s.memory[id_])}.", id_))
    return Done(s.robot.pose, "done", id_)


def name_of(s: Situation, thing: Percept) -> str:
    """A thing's name, as in "a red cube"; by the robot's best guess, where it is not sure."""
    return sentences.a(thing, s.names())


def what_is_seen(s: Situation) -> str:
    """What is in view, and what else is remembered."""
    ids, names = s.look(), s.names()
    rest = [p for p in s.seen if p.id not in ids]
    if not ids and not rest:
        return "I see nothing from here."
    here = sentences.listed([sentences.a(s.memory[id_], names) for id_ in ids]) if ids else "nothing"
    more = f" I remember {sentences.listed([sentences.a(p, names) for p in rest])}." if rest else ""
    return f"I see {here}.{more}"


def _meaning(s: Situation, word: str) -> str:
    """What a word means."""
    noun = parse_command(f"go to the {word}", s.model.symbols.keys()).noun or word
    entry = next((e for e in s.model.lexicon() if e.word == noun), None)
    return sentences.meaning(noun, entry, s.taught)


def _words(s: Situation) -> str:
    """Which words it knows."""
    entries = s.model.lexicon()
    old = [e.word for e in entries if e.settled and e.word not in s.taught]
    new = [f"{e.word} ({e.types[0][0]})" for e in entries if e.word not in old and e.types and e.types[0][0] != UNMET]
    known = f"I knew {sentences.listed(old)} from the start." if old else ""
    return f"{known} {f'I learned {sentences.listed(new)}.' if new else 'I have learned no other word yet.'}".strip()


def _place(s: Situation) -> str:
    """Where the robot stands."""
    pose = s.robot.pose
    if not s.seen:
        return f"I stand at x {pose.x:.1f} m, y {pose.y:.1f} m."
    near = min(s.seen, key=lambda p: ((p.position[0] - pose.x) ** 2 + (p.position[1] - pose.y) ** 2, p.id))
    return f"I stand at x {pose.x:.1f} m, y {pose.y:.1f} m; {s.the(near.id)} is {s.where(near.id)}."


def why(s: Situation) -> str:
    """Why it went where it went, as a person would say it."""
    errand = s.last
    if errand is None:
        return "I have not gone anywhere yet."
    solution, noun = errand.solution, errand.solution.noun
    because: list[str] = []
    thing = None if errand.chosen is None else s.memory.get(errand.chosen)
    if thing is None or noun is None:
        looked = "I looked all round and " if errand.looked else "I "
        return f'You said "{errand.text}"; {looked}saw nothing that it would fit.'
    if any(reply.meant is not None for _, reply in errand.asked):
        because.append("you told me which one you mean")
    if noun.noun is not None:
        because.append(_because_of_noun(s, noun.noun, thing.type))
    if noun.color is not None:
        because.append(f'you said "{noun.color}", and it is {thing.color}')
    described = (
        [*noun.words, *(" ".join(child.phrase.words) for child in solution.target.children)]
        if (solution.target)
        else []
    )
    if any(described):
        because.append(f'of what I saw it fits "{" ".join(filter(None, described))}" best')
    others = sorted(((p, id_) for id_, p in solution.probabilities.items() if id_ != thing.id), reverse=True)
    next_best = next(((p, id_) for p, id_ in others if id_ in s.memory and p >= 0.005), None)
    share = f" I was {solution.probabilities[thing.id]:.0%} sure"
    rest = (
        f"; next came {s.the(next_best[1])} with {next_best[0]:.0%}."
        if next_best
        else "; nothing else that I saw fits."
    )
    because = because or ["it fits what you said"]
    return f"I went to {s.the(thing.id)} because {sentences.listed(because)}.{share}{rest}"


def _because_of_noun(s: Situation, noun: str, type_: str) -> str:
    belief = s.model.beliefs_of(noun).get(type_, 0.0)
    if s.taught.get(noun) == "told":
        return f"you told me that this is {sentences.with_article(noun)}"
    if belief >= _SURE:
        return f'you said "{noun}", which I take for what my camera calls "{type_}" ({belief:.0%})'
    return f'you said "{noun}", and it may be one ({belief:.0%})'


def reasons(s: Situation, most: int) -> list[str]:
    """The features behind the last command's grounding, the strongest first, and what told it from the second best."""
    if s.last is None:
        return []
    solution = s.last.solution
    lines = [f"{r.phrase}: {r.language} x {r.feature} {r.log_odds:+.2f}" for r in explain(s.model, solution)[:most]]
    rival = rivalry(s.model, solution)
    if rival is not None:
        lines.append(f"against {rival.object.id}: log-odds {rival.log_odds:+.2f}")
        lines += [f"{r.phrase}: {r.language} x {r.feature} {r.log_odds:+.2f}" for r in rival.reasons[:most]]
    return lines
