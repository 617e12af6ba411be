"""What two people said in turns, as one of them would say it alone: "Take the cup. - The red one? - No, the other."

An instruction giver and a follower speak in turns, with labels ("Commander: ...", "B: ..."), in lines, or in quotes.
What the follower asks and the giver takes is told by the giver; what he turns down is ruled out. The last turn decides;
of the turns before it those are kept on which it leans.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass, replace

from dcg_torch.interpretation.guesses import told_by_answers
from dcg_torch.interpretation.turn_words import pattern
from dcg_torch.names.attribute_values import says_value, states_value
from dcg_torch.names.normal_form import singular

_LABEL = r"(?:(?<=^)|(?<=[\s.!?,'\"]))(?P<who>{})\s?:\s+"
_ANY = r"[A-Za-z]{1,14}(?: ?\d)?"
_LONGEST, _LONGEST_QUESTION = 1000, 200
"""Characters of a text that is looked at, longer ones are no commands; and of a question in it."""
_SENTENCES = re.compile(r"[^\s.?!][^.?!]*[.?!]*")
_SAID = re.compile(r"\S.*?(?:[.?!]+(?=\s|$)|$)", re.DOTALL)
_IT, _ONE = re.compile(r"\bit\b"), re.compile(r"\bone\b")
_OF_ITSELF = re.compile(r"\b(?:with|has|having) [^.]*\b(?:on|in|inside|under|over|around|behind) it\b")
_WORD = re.compile(r"[A-Za-z]{2}")
_QUOTED = re.compile(r"\s*(?>(['\"])[^\"\n]+?\1(?=[\s,-]|$)[\s,-]*){2,}")
"""Turns in quotes. Each ends once for all: marks that could end several of them at many places would take for ever."""
_FOLLOWER = "follower"
_MATERIAL = frozenset({"material"})


@dataclass(frozen=True, slots=True)
class Turn:
    """What somebody says before another speaks.

    Attributes:
        anew: is all that was said before it done with?
        clarifies: does it answer what was asked of the thing that was named before?
    """

    who: str
    text: str
    anew: bool = False
    clarifies: bool = False


def in_one_voice(text: str) -> str:
    """A text in turns as the one who gives the instructions would say it alone; other texts as they are."""
    return _told(told_by_answers(text)) if len(text) <= _LONGEST else text


@functools.lru_cache(maxsize=1024)
def _told(text: str) -> str:
    turns = _turns(text.strip())
    if not turns:
        return text
    while len(turns) > 1 and _is("nothing", turns[-1].text) and not _asks(turns[-2].text):
        turns = turns[:-1]
    said = _of_giver(turns, turns[-1].who)
    told = _last_first(_still_valid(said)) if said else ""
    return told if told.strip(" .") else text


def _turns(text: str) -> list[Turn]:
    """The turns of a text; none where one speaks alone."""
    labels = list(re.finditer(_LABEL.format(_ANY), text))
    if labels and labels[0].start() == 0:
        ends = [*[label.start() for label in labels[1:]], len(text)]
        if _are_speakers([label["who"].lower() for label in labels]):
            found = [
                Turn(label["who"].lower(), text[label.end() : end].strip(" \n\"'"))
                for label, end in zip(labels, ends, strict=True)
            ]
            found = [turn for turn in found if turn.text]
            if all(_WORD.search(turn.text) for turn in found):
                return found
    quoted = _QUOTED.fullmatch(text)
    if quoted:
        said = re.findall(rf"{quoted[1]}(.+?){quoted[1]}(?=[\s,-]|$)", text)
        return [Turn(str((len(said) - k) % 2), part) for k, part in enumerate(said)]
    return _unlabelled(text)


def _are_speakers(labels: list[str]) -> bool:
    """Are labels those of people who speak, and not keys: "color: red, shape: cube"?"""
    return any(_is("speaker", label) for label in labels) or len(set(labels)) < len(labels)


def _unlabelled(text: str) -> list[Turn]:
    """The turns of a text in which nobody says who speaks, told by what is asked in it, and by what is done with."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    if not any(_starts("takes", line) or _starts("denies", line) for line in lines[1:]):
        lines = [text]
    parts = [(part, k > 0) for line in lines for k, part in enumerate(pattern("next").split(line)) if part]
    turns: list[Turn] = []
    dropped = False
    for part, anew in parts:
        first, sentences = len(turns), _SAID.findall(part)
        for said, then in zip(sentences, [*sentences[1:], ""], strict=True):
            if turns and _is("denies", said) and _starts("the_one", then):
                dropped = True  # "The red piece. Not that. The one at the top."
                continue
            who = _FOLLOWER if turns and len(said) <= _LONGEST_QUESTION and _is("follows", said) else ""
            if len(turns) > first and turns[-1].who == who:
                turns[-1] = replace(turns[-1], text=f"{turns[-1].text} {said}")
            else:
                turns.append(Turn(who, said, anew=anew and len(turns) == first))
    return turns if (len(turns) > 1 or dropped) and turns[-1].who != _FOLLOWER else []


def _asks(text: str) -> bool:
    """Is a turn one that waits for an answer: "The red one?", "I see two of them."?"""
    short = len(text) <= _LONGEST_QUESTION
    return "?" in text or (short and _is("asked", text) and _starts("denies", text) is None)


def _of_giver(turns: list[Turn], giver: str) -> list[Turn]:
    """What the giver says in each turn, with what he takes of what the follower asks."""
    said: list[Turn] = []
    for k, turn in enumerate(turns):
        if turn.who != giver:
            continue
        asked = turns[k - 1].text if k and turns[k - 1].who != giver else ""
        asked = asked if len(asked) <= _LONGEST_QUESTION else ""
        denied = _starts("denies", turn.text)
        if denied is not None and not asked and said and denied.end() < len(turn.text):
            said[-1] = replace(said[-1], text=f"{said[-1].text.rstrip(' .!')}, no, {turn.text[denied.end() :]}")
            continue
        answer = _answered(asked, turn.text, first=not said)
        own = _match("which", said[-1].text) if said and answer and "?" in said[-1].text else None
        if own is not None and own["what"] != "one":  # "Which cup? - The red one. - Fine": the giver asks himself
            said.pop()
            answer = _which(own, answer)
        anew = turn.anew or (not _asks(asked) and _starts("anew", turn.text) is not None)
        named = _is("where", asked) or ((which := _match("which", asked)) is not None and which["what"] != "one")
        clarifies = "?" in asked and not named and any(_starts(name, answer) for name in ("noun", "place", "denies"))
        if answer:
            said.append(Turn(giver, answer, anew, clarifies))
    return said


def _answered(asked: str, answer: str, *, first: bool) -> str:
    """A turn of the giver in which what was asked before it is told.

    Args:
        asked: what the follower said before; empty: nothing.
        first: has the giver told nothing before?
    """
    question = _match("asked", asked) if asked else None
    what = "" if question is None or _is("this", question["what"]) else _definite(question["what"])
    sides, side = (_match("sides", asked) if asked else None), _match("side", answer)
    if sides is not None and side is not None and side["side"].lower() in sides[0].lower():
        return f"the {side['side'].lower()} one"
    chosen = _chosen(asked, answer) if asked else None
    if chosen is not None:
        return chosen
    denied = _starts("denies", answer)
    if denied is not None:
        return _instead(what, answer[denied.end() :], first=first)
    for name, told in (("which", _which), ("where", _where)):
        open_question = _match(name, asked) if asked else None
        if open_question is not None and not _is("nothing", answer):
            return told(open_question, _bare(answer))
    taken = _starts("takes", answer)
    if taken is not None and what:
        rest = answer[taken.end() :]
        return f"{what}. {rest}" if rest and rest.strip(" .") != what else what
    if _is("nothing", answer):
        return ""
    answer = _one_of(what, _bare(answer))
    seen = _match("sees", answer)
    if seen is not None:
        return f"there is {seen['what']}"
    search = _match("search", answer) if asked and not first else None
    if search is not None:
        return f"it is {search['at'] or 'near'} {search['mark']}"
    alone = first and bool(asked) and "?" not in asked and _leans(answer) and not _leans(asked)
    return f"{asked.rstrip(' .')}. {answer}" if alone or (first and what and _leans(answer)) else answer


def _instead(what: str, rest: str, *, first: bool) -> str:
    """What is meant where an offer is turned down: "No, the other one", "No. Look on the desk."."""
    search, side = _match("search", rest), _match("side", rest)
    if search is not None:
        return f"it is {search['at'] or 'near'} {search['mark']}"
    if side is not None:
        return f"the {side['side'].lower()} one"
    place = re.sub(r"^the one ", "", what, flags=re.IGNORECASE)
    if what and (not rest or _is("other", rest)):
        return f"not {place if _starts('place', place) else what}"
    of_what = _match("at", place)
    if of_what is not None and _starts("noun", rest) and of_what["mark"] in rest.lower().split():
        return f"{of_what['at']} {rest}"  # "On the left wall?" - "No, the wall in front of you."
    if what and "other" in rest.lower().split() and _starts("place", place):
        return f"not {place}. {rest}"  # "The one by the lamp?" - "No, the one on the other side."
    return f"{what}, no, {rest}" if first and what and rest else rest


def _which(question: re.Match[str], answer: str) -> str:
    """ "Which chair?" - "The one by the door": the chair by the door."""
    found = _starts("found", answer)
    if question["what"] == "one":
        return f"{question['told'] or ''}{'it is ' if answer[:4].lower() == 'not ' else ''}{answer}"
    if found is not None and found.end():
        return f"the {question['what']} {answer[found.end() :]}"
    return re.sub(r"\bone\b", question["what"], answer, count=1)


def _chosen(asked: str, answer: str) -> str | None:
    """ "The red one or the blue one?" - "The latter.", "Glass or steel?" - "Glass": which of those that are offered."""
    offers, nth, bare = _match("offers", asked), _match("nth", answer), _match("bare_offers", asked)
    if offers is not None and nth is not None:
        options, place = pattern("offered").split(offers["options"]), str(nth.lastgroup)
        k = len(options) - 1 if place == "last" else int(place[1:])
        which = _match("which", asked)
        what = _definite(options[k]) if k < len(options) else None
        named = which is not None and which["what"] != "one"
        return _ONE.sub(which["what"], what, count=1) if what and which is not None and named else what
    said = answer.lower().removeprefix("the ").removesuffix(" please").strip(" .!")
    if bare is None or said not in (bare["one"].lower(), bare["other"].lower()) or not says_value(said):
        return None
    return f"the one made of {said}" if states_value(said, _MATERIAL) else f"the {said} one"


def _where(question: re.Match[str], answer: str) -> str:
    """ "Where is the mug?" - "On the table", "Check the shelf", "Second drawer": the mug is there."""
    what = _definite(question["what"]) if question["what"] else "it is"
    found, search, spot = _starts("found", answer), _match("search", answer), _match("spot", answer)
    if found is not None:
        return f"{what} {answer[found.end() :]}"
    if search is not None:
        return f"{what} {search['at'] or 'near'} {search['mark']}"
    return f"{what} in the {spot['mark']}" if spot is not None else answer


def _one_of(offered: str, answer: str) -> str:
    """ "The cup or the blue block?" - "The block": the one that is offered and named again."""
    options, said = offered.split(" or "), set(re.findall(r"\w+", answer)) - _EMPTY
    shared = [len(said & set(option.split(" "))) for option in options]
    best = max(shared)
    decided = len(options) > 1 and best and shared.count(best) == 1 and len(said) <= best
    return options[shared.index(best)] if decided else answer


_EMPTY = frozenset({"the", "one"})


def _bare(text: str) -> str:
    """Without what opens a turn and says nothing, and with an article before "left one"."""
    opening = _starts("opens", text)
    text = text if opening is None else text[opening.end() :]
    return text if _starts("bare_one", text) is None else f"the {text}"


def _definite(what: str) -> str:
    """ "One on the sofa" that the follower sees is from then on the one on the sofa, and so is "next to the lamp"."""
    if _starts("place", what):
        return f"the one {what}"
    return re.sub(r"^(?:an?|any|one)\b", lambda word: "the one" if word[0].lower() == "one" else "the", what)


def _still_valid(said: list[Turn]) -> list[Turn]:
    """What is left where all before was given up: "Never mind that. Bring the kettle."."""
    given_up = [k for k, turn in enumerate(said) if _starts("ends", turn.text)]
    if not given_up:
        return said
    at, end = given_up[-1], _starts("ends", said[given_up[-1]].text)
    rest = _bare(said[at].text[end.end() :]) if end is not None else ""
    return [turn for turn in (replace(said[at], text=rest), *said[at + 1 :]) if turn.text] or said


def _last_first(said: list[Turn]) -> str:
    """The last turn, after those on which it leans."""
    first = len(said) - 1
    parts = [turn.text for turn in said]
    while first > 0 and (said[first].clarifies or _leans(". ".join(parts[first:]))):
        if said[first].anew and not pattern("stands").search(parts[first]):
            # "Take the left crate. Thanks, now the blue one": a crate, and nothing more of it.
            parts[first] = _ONE.sub(_noun_before(parts[:first]) or "one", parts[first], count=1)
            break
        first -= 1
    kept = [sentence for part in parts[first:] for sentence in _SENTENCES.findall(part)]
    order = _match("order", kept[-2]) if len(kept) > 1 else None
    if order is not None:
        taking = _starts("taking", kept[-1])
        if taking is not None:  # "Cook the potato. Take the one in the fridge": that one is cooked
            kept[-1] = kept[-1][taking.end() :]
        elif _starts("noun", kept[-1]) and _IT.search(kept[-1]) and not _OF_ITSELF.search(kept[-1]):
            # "Push the red one. Good, now the blue one next to it": that is pushed, too.
            kept[-2:] = [_IT.sub(order["what"].strip(" .!"), f"{order['verb']}{kept[-1]}", count=1)]
    return " ".join(part if part[-1] in ".?!" else f"{part.rstrip(' ,')}." for part in kept)


def _noun_before(said: list[str]) -> str | None:
    """What the last thing before is called that was told by a noun: "the red card by the lake"."""
    for part in reversed(said):
        begin = pattern("noun").search(part)
        called = None if begin is None else pattern("called").match(part, begin.start())
        if called is not None:
            return singular(called["noun"])
    return None


def _leans(text: str) -> bool:
    """Does a turn speak of what was named before it, or name nothing by itself?"""
    return pattern("leans").search(text) is not None or pattern("names").search(text) is None


def _is(name: str, text: str) -> bool:
    return pattern(name).fullmatch(text) is not None


def _match(name: str, text: str) -> re.Match[str] | None:
    return pattern(name).fullmatch(text)


def _starts(name: str, text: str) -> re.Match[str] | None:
    return pattern(name).match(text)
