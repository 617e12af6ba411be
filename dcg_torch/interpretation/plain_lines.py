"""Rows and columns of the whole scene, in plain words: "the third row", "the back row of mugs"."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from dcg_torch.names.vocabulary import INSIDE, LINE_FROM, LINE_OF, MIDDLE_LINE, ORDINALS, READ_FROM
from dcg_torch.types import ParseTree, Phrase, PhraseKind

_SAME_END = {"from the back": "from the top", "from the front": "from the bottom"}


def line_of_all(phrase: Phrase) -> Phrase | None:
    """ "The third row", "the bottom row" is one of the lines of the whole scene; None for a row by itself."""
    line = LINE_OF.get(phrase.noun or "")
    if line is None or phrase.plural or phrase.color is not None:
        return None
    ends, (start, _) = LINE_FROM[line], READ_FROM[line]
    ordinal = next((word for word in phrase.words if word in ORDINALS), None)
    plain = [_SAME_END.get(word, word) for word in phrase.words]
    sides = [ends[w] for w in plain if w in ends] + [w for w in plain if w in ends.values()]
    if ordinal is None and not sides:
        return replace(phrase, noun=line, words=(MIDDLE_LINE,)) if "middle" in phrase.words else None
    number = ORDINALS.get(ordinal or "", 1)
    return replace(phrase, noun=line, words=(f"{number} {sides[0] if sides else start}",))


def read_along(words: tuple[str, ...], children: Sequence[ParseTree]) -> tuple[str, ...]:
    """ "The second cube in the third row" is the second from the left."""
    lines = (c.children[0].phrase.noun for c in children if len(c.children) == 1 and c.phrase.words[0] in INSIDE)
    line = next((noun for noun in lines if noun in READ_FROM), None)
    counted = any(word in ORDINALS for word in words) and not any(word.startswith("from ") for word in words)
    if line is None or not counted or len(words) > 1:
        return words
    return (*words, READ_FROM[line][1])


def in_whole_line(tree: ParseTree) -> ParseTree:
    """A command about a line of the scene as one about all that is in it: "the back row", "the left column of mugs"."""
    phrase = tree.phrase
    if phrase.kind is PhraseKind.NOUN:
        named = next((word for word in (phrase.noun, *phrase.words) if word in LINE_OF), None)
        line = None if named is None or tree.children else line_of_all(_bare_line(phrase, named))
        if line is None or named is None:
            return tree
        noun = None if phrase.noun == named else phrase.noun
        inside = ParseTree(Phrase(PhraseKind.PREPOSITION, "in", ("in",)), (ParseTree(line),))
        return ParseTree(replace(phrase, noun=noun, words=(), plural=True, count=None), (inside,))
    if not tree.children:
        return tree
    return ParseTree(phrase, (in_whole_line(tree.children[0]), *tree.children[1:]))


def _bare_line(phrase: Phrase, named: str) -> Phrase:
    words = tuple(word for word in phrase.words if word != named)
    return Phrase(PhraseKind.NOUN, named, words, named)
