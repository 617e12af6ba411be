"""A thing that is found out by questions: "Is it a person? No. A cup? Yes. The red one? No."

Each question with its answer is told as a sentence, "It is no person", so that a parser reads what holds of the thing
and what does not. Texts of which any part is neither such a question nor its answer stay as they are.
"""

from __future__ import annotations

import re

from dcg_torch.english.forms import parts
from dcg_torch.interpretation.turn_words import pattern
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import color_words

_ONE = re.compile(r"\bone\b")
_DOING = 2.0
"""How common "sitting" and "eating" are as nouns; "painting" and "ceiling" are more so."""


def told_by_answers(text: str) -> str:
    """A series of questions and answers as sentences about the thing; other texts as they are.

    >>> told_by_answers("Is it a cup? Yes. The red one? No.")
    'It is a cup. It is not the red cup.'
    """
    told, at, kind = list[str](), 0, "one"
    while at < len(text):
        pair = pattern("guess").match(text, at)
        said = None if pair is None else _told(pair["question"], _answer(pair))
        if pair is None or said is None:
            return text
        named = pattern("guess_kind").fullmatch(said)
        kind = kind if named is None else named["kind"]
        if _answer(pair) is False:  # one of them, and no other, is ruled out
            said = _ONE.sub(kind, said, count=1)
        told, at = [*told, said], pair.end()
    return " ".join(filter(None, told)) or text


def _answer(pair: re.Match[str]) -> bool | None:
    """Is it so? None where the answer says neither."""
    return True if pair["yes"] else False if pair["no"] else None


def _told(question: str, answer: bool | None) -> str | None:
    """A question with its answer as a sentence, empty where that says nothing; None where it is no such question."""
    for name, told in (("guess_has", _has), ("guess_use", _used), ("guess_is", _is)):
        found = pattern(name).fullmatch(question)
        if found is not None:
            return "" if answer is None else told(found, answer)
    if pattern("guess_other").match(question):
        return None
    return "" if answer is None else _is_so(question, answer)


def _is(found: re.Match[str], answer: bool) -> str:
    return _is_so(found["what"], answer)


def _is_so(what: str, answer: bool) -> str:
    what = f"{what[0].lower()}{what[1:]}"
    side = pattern("guess_side").fullmatch(what)
    what = f"on the {side['side']}" if side is not None else what
    worn = pattern("guess_worn").fullmatch(what)
    what = worn["what"] if worn is not None and _is_color(worn["what"]) else what
    used = parts(what.lower()) if what.isalpha() else {}
    least = max(used.get("a", 0.0), _DOING if what.endswith("ing") else 0.0)
    what = f"a {what}" if used.get("n", 0.0) > least and not what.endswith("s") else what
    return f"It is {'' if answer else 'not '}{what}."


def _has(found: re.Match[str], answer: bool) -> str:
    if _is_color(found["what"]):  # who wears red is the red one
        return _is_so(found["what"], answer)
    what = found["what"] if answer else re.sub(r"^(?:an?|any|the|some) ", "", found["what"], flags=re.IGNORECASE)
    return f"It has {'' if answer else 'no '}{what}."


def _is_color(word: str) -> bool:
    return normalise(word) in color_words().basic


def _used(found: re.Match[str], answer: bool) -> str:
    return f"It is something you can {found['what']}." if answer else ""
