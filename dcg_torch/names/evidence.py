"""What the name of a recogniser's class says about a noun that a person used: named facts, to be weighed elsewhere.

Every pair has one fact of its form, `name: ...`, and unless the noun is generic, one of its meaning, `kind: ...`.
Meanings come from the table of WordNet and from `data/everyday.yaml`.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from typing import Final

from rapidfuzz.distance import OSA

from dcg_torch.names.everyday_names import Name, everyday, name_parts, share_a_name
from dcg_torch.names.wordnet import nouns

FORMS: Final = (
    "name: equal",  # "coffee table", "CoffeeTable"
    "name: head",  # "lamp" for a floor lamp
    "name: class is head",  # "wine glass" for a glass
    "name: part",  # "tire pallet" for a tire assembly pallet
    "name: same head",  # "coffee table" for a dining table
    "name: word",  # "pepper" for a pepper shaker
    "name: class is word",  # "door knob" for a door
    "name: shared word",  # "soap bar" for a soap bottle
    "name: generic",  # "thing" for whatever there is
    "name: none",
)
KINDS: Final = (
    "kind: everyday",  # two names of one thing, or of it and its kind: equal, or in the lists of this project
    "kind: same",  # a synset in common among the first senses
    "kind: noun is kind",  # "armchair" for a chair
    "kind: class is kind",  # "fruit" for an apple
    "kind: noun is far kind",  # the same in three or four steps
    "kind: class is far kind",  # "garment" for a jacket
    "kind: head everyday",  # the same, of the heads: "office couch" for a sofa
    "kind: head same",
    "kind: head noun is kind",
    "kind: head class is kind",
    "kind: sibling",  # both are directly kinds of one thing: "apple" for a pear
    "kind: apart",  # WordNet knows both, and none of these holds
    "kind: strange",  # WordNet does not know one of them
)
_SENSES, _STEPS, _FAR = 4, 2, 4
_TOP = 20
"""More steps than lie above any noun."""
_LOOSE = frozenset({"noun is far kind", "class is far kind", "sibling", "apart", "strange"})
_OF_ONE_KIND = frozenset(KINDS[KINDS.index("kind: same") : KINDS.index("kind: head everyday")])
_COMMON = 400
"""A synset that so many others are kinds of ("artifact", "person") makes no siblings."""


@functools.lru_cache(maxsize=65536)
def evidence(noun: str, class_name: str) -> tuple[str, ...]:
    """The facts that hold between a noun and the name of a class: one of `FORMS`, and one of `KINDS` or none.

    >>> evidence("lamp", "FloorLamp"), evidence("couch", "sofa")
    (('name: head', 'kind: class is kind'), ('name: none', 'kind: everyday'))

    Args:
        noun: what was said, in the singular; one word or a compound.
        class_name: as the recogniser writes it.
    """
    said, named = name_parts(noun), name_parts(class_name)
    if unheard_of(noun):
        said = next((other for other in (named, name_parts(named.head)) if _misspells(said.text, other.text)), said)
    said = _unpacked(said, named)
    if (told := _by_purpose(said, named)) is not None:
        return told
    if (held := _as_held(said, named)) is not None:
        return held
    form = _form(said, named)
    if form == "name: generic":
        return (form,)
    kind = "kind: everyday" if form == "name: equal" else _kind(said, named)
    if (form, kind) == ("name: head", "kind: everyday"):
        kind = "kind: class is kind"  # a kitchen counter is a counter, but rather is what is called just that
    return _solid_head(said, named, kind) or form, kind


def _by_purpose(said: Name, named: Name) -> tuple[str, ...] | None:
    """The facts of "the measuring thing", "the lamp thingy" and of a name before its kind; None for all else."""
    lists = everyday()
    if len(said.words) < 2 or said.head in named.words:
        return None
    begins = said.words[: len(named.words)] == named.words and said.text not in lists.groups  # no toilet: a toilet roll
    rest = said.words[len(named.words) :] if begins else ()
    if rest and (lists.portions.issuperset(rest) or _says_kind(rest, named)):
        return "name: class is head", "kind: same"  # "marker pen", "pizza slice"
    if rest and lists.packages.issuperset(rest):
        return "name: class is head", "kind: strange"  # "milk carton" for milk, but a carton is one as well
    if said.head not in lists.purposeful:
        return None
    *_, word = before = said.words[:-1]
    if (base := _verb_of(word)) is not None and _is_for(base, named.text):
        return "name: part", "kind: same"
    if said.head not in lists.generic:
        return None
    inner = " ".join(before)
    return evidence(inner, named.text) if base is None and not unheard_of(word) else ("name: generic",)


def _unpacked(said: Name, named: Name) -> Name:
    """What was said with what wares come in for wares, or the other way round: "box pallet" for "spare parts pallet".

    A noun without either, and for a class of no package, stays.
    """
    packs, wares, holds = everyday().packs, everyday().wares, named.words[:-1]
    if named.head not in everyday().packages or not set(said.words).isdisjoint(holds):
        return said
    for these, those in ((packs, wares), (wares, packs)):
        held = next((word for word in holds if word in those), None)
        spoken = next((k for k, word in enumerate(said.words) if word in these and word != named.head), None)
        if held is not None and spoken is not None:
            return name_parts(" ".join((*said.words[:spoken], held, *said.words[spoken + 1 :])))
    return said


def _as_held(said: Name, named: Name) -> tuple[str, ...] | None:
    """The facts of what a package holds: "tomato soup" for "Campbell's tomato soup can"; None for all else.

    A "glass bottle" holds no glass, so there are two words before the package at least.
    """
    holds = named.words[:-1]
    if not holds or named.head not in everyday().packages:
        return None
    if said.head not in holds:  # "soda" for a Fanta bottle
        of = _relation(said.text, " ".join(holds)) if named.text not in everyday().groups else "apart"
        return ("name: none", "kind: head everyday") if of == "everyday" else None
    if len(holds) < 2:
        return None
    form, *kind = evidence(said.text, " ".join(holds))
    if form not in {"name: equal", "name: head"} or _kind(said, named) == "kind: everyday":
        return None
    # What is called so itself is called so rather: a package is no soup.
    return "name: word", *("kind: strange" if one == "kind: everyday" else one for one in kind)


def _verb_of(word: str) -> str | None:
    """What a word in -ing begins with: "writ" of "writing", "cut" of "cutting"."""
    base = word.removesuffix("ing")
    if base == word or len(base) < _SHORTEST:
        return None
    return base[:-1] if base[-1] == base[-2] and base[-1] not in "lsz" else base


@functools.lru_cache(maxsize=8192)
def _is_for(base: str, name: str) -> bool:
    """Is a thing of some name for what a verb says: has it, or a kind that it is of, a name with the verb in it?"""
    listed = next((of for verb, of in everyday().purposes.items() if base in (verb, verb.removesuffix("e"))), ())
    table, listed_whole = nouns(), name in nouns() or name in everyday().groups
    own = {name} if listed_whole else {name, name_parts(name).head}  # a trash can is no can to drink from
    senses = table.senses(name, _MAIN) or table.senses(name_parts(name).head, _MAIN)
    kinds = {kind for sense in senses for kind in table.ancestors(sense, _STEPS)}
    words = name.split(" ")
    same = any(share_a_name(one, part) or one == part or one in words for one in listed for part in own)
    if same or any(not kinds.isdisjoint(table.senses(one, _MAIN)) for one in listed):
        return True
    above = {kind for sense in senses for kind in table.ancestors(sense, _UP - 2)}
    told = {part for kind in above for lemma in table.names(kind) for part in lemma.split(" ")} | {*name.split(" ")}
    return any(re.match(rf"{base}(?:e?$|ing|er|or|{base[-1]}ing|{base[-1]}er)", part) for part in told)


def _form(said: Name, named: Name) -> str:
    if said.solid == named.solid:
        return "name: equal"
    if said.text in everyday().generic and not share_a_name(said.text, named.text):
        return "name: generic"
    longer, shorter = len(named.words) > len(said.words), len(named.words) < len(said.words)
    if longer and named.words[-len(said.words) :] == said.words:
        return "name: head"
    if shorter and said.words[-len(named.words) :] == named.words:
        return "name: class is head"
    one, other = set(said.words), set(named.words)
    if said.head == named.head:
        return "name: part" if one <= other or other <= one else "name: same head"
    if said.head in other:
        return "name: word"
    if named.head in one:
        return "name: class is word"
    return "name: shared word" if one & other else "name: none"


def _solid_head(said: Name, named: Name, kind: str) -> str | None:
    """The form of two names of which one, written as one word, ends with the other and is of its kind: "armchair"."""
    longer, shorter = (named, said) if len(named.text) > len(said.text) else (said, named)
    solid = len(longer.words) == 1 and longer.text.endswith(shorter.text) and len(shorter.text) >= _SHORTEST
    if not solid or kind not in _OF_ONE_KIND:
        return None
    return "name: head" if longer is named else "name: class is head"


def _says_kind(rest: tuple[str, ...], named: Name) -> bool:
    """Whether what follows the name of a class says what kind of thing it is: "banana fruit", "marker pen"."""
    kind = " ".join(rest)
    if _relation(kind, named.text) in {"everyday", "class is kind", "class is far kind"}:
        return True
    # A table lamp is no table: both must be kinds of one narrow kind.
    said, own = _meanings(kind), _meanings(named.text)
    return any(nouns().size(one) <= _NARROW for one in said.direct & own.direct)


_NARROW = 20


def _misspells(word: str, name: str) -> bool:
    """Whether a word that nobody knows is a name but for a letter, of long ones two: "screwdrver"."""
    shorter = min(len(word), len(name))
    return shorter >= _SPELT and OSA.distance(word, name, score_cutoff=2) <= 1 + (shorter >= _LONG)


_SPELT, _LONG = 5, 8


@functools.lru_cache(maxsize=65536)
def may_be_meant_for(noun: str, class_name: str) -> bool:
    """Is a noun the name of a class, or its head, but for a letter that is not the first: "bell" for a ball?"""
    said, named = name_parts(noun).text, name_parts(class_name)
    return any(
        min(len(said), len(name)) > 3 and said[0] == name[0] and OSA.distance(said, name, score_cutoff=1) == 1
        for name in (named.text, named.head)
    )


def _kind(said: Name, named: Name) -> str:
    whole = _relation(said.text, named.text)
    if whole.startswith("class is") and named.head in everyday().kinds.get(said.text, ()):
        return "kind: everyday"  # a power drill is as much a tool as a drill is
    if whole == "apart" and said.text == named.head and _is_made(said.text, named.text):
        return "kind: class is far kind"  # a filing cabinet is some cabinet, wherever WordNet puts it
    if whole not in _LOOSE or said.head == named.head:
        return f"kind: {whole}"
    found = {_relation(*pair) for pair in ((said.text, named.head), (said.head, named.text), (said.head, named.head))}
    for relation in ("everyday", "same", "noun is kind", "class is kind"):
        if relation in found:
            return f"kind: head {relation}"
    return f"kind: {whole}" if whole != "strange" or found == {"strange"} else "kind: apart"


def _is_made(*names: str) -> bool:
    """Is each, in one of its first senses, something that people make?"""
    table = nouns()
    made = table.senses("artifact", 1)[0]
    return all(any(made in table.ancestors(s, _TOP) for s in table.senses(name, _SENSES)) for name in names)


@functools.lru_cache(maxsize=65536)
def _relation(noun: str, name: str) -> str:
    """How two nouns of the table relate: the end of one of the `KINDS` that are not of heads."""
    if share_a_name(noun, name) or name in everyday().kinds.get(noun, ()):
        return "everyday"
    said, named = _meanings(noun), _meanings(name)
    if not said.senses or not named.senses:
        return "strange"
    if said.senses & named.senses:
        return "same"
    if _is_whoever(noun) and not _is_whoever(name) and nouns().senses(_PERSON, 1)[0] in named.above[1]:
        return "same"  # a "guy" may be a waiter
    for reach, relation in ((0, "kind"), (1, "far kind")):
        if said.above[reach] & named.senses:
            return f"noun is {relation}"
        if named.above[reach] & said.senses:
            return f"class is {relation}"
    return "sibling" if said.direct & named.direct else "apart"


def _is_whoever(noun: str) -> bool:
    """Is it a name of a person, whoever that is: "guy", "lady", "kid"?"""
    return share_a_name(noun, _PERSON)


_PERSON: Final = "person"


_MAIN, _UP, _SHORTEST = 2, 5, 3


def is_generic(noun: str) -> bool:
    """May it be said of whatever there is: "thing", "piece"?"""
    name, generic = name_parts(noun), everyday().generic
    if len(name.words) > 1 and name.head in generic & everyday().purposeful:  # "the measuring thing"
        return _verb_of(name.words[-2]) is not None or unheard_of(name.words[-2])
    return name.text in generic


def unheard_of(noun: str) -> bool:
    """Is it one word that neither WordNet nor this project's list knows?"""
    name = name_parts(noun)
    return len(name.words) == 1 and not _meanings(name.text).senses and name.text not in everyday().groups


@dataclass(frozen=True, slots=True)
class _Meanings:
    """The first senses of a noun, what they are directly kinds of, and what they are within few and more steps."""

    senses: frozenset[int]
    direct: frozenset[int]
    above: tuple[frozenset[int], frozenset[int]]


@functools.lru_cache(maxsize=8192)
def _meanings(noun: str) -> _Meanings:
    table = nouns()
    senses = table.senses(noun, _SENSES)
    direct = frozenset(kind for sense in senses for kind in table.kinds(sense) if table.size(kind) < _COMMON)
    few, more = (frozenset(a for s in senses for a in table.ancestors(s, steps)) for steps in (_STEPS, _FAR))
    return _Meanings(frozenset(senses), direct, (few, more))
