"""What commands say of the rows, columns and neighbours of a grid: "row 3, column 2", "two below the red one".

In a grid such words mean cells, and nothing else is as likely. So a noun phrase that speaks of them gets a word for the
cells ("cell: 2 1|2 2"), which is compared with the cell that each thing stands in (`with_cells`).
"""

from __future__ import annotations

import functools
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.names.color_names import color_evidence
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import CELL, CELL_STEPS, INSIDE, LINE_ENDS, LINE_OF, ORDINALS, cardinal
from dcg_torch.names.weights import names_one_of
from dcg_torch.scene.grids import Cell, Grid, grid_of
from dcg_torch.types import LOOKED_ROUND, NOT, Object, ParseTree, Phrase, PhraseKind, WorldModel

_WITHIN = INSIDE | listed("in a cell")
_BESIDE = listed("beside in a grid")
_DIAGONAL = "diagonal to"
_ANY, _FEW, _MOST_LINES = 3, 6, 100
"""Neighbours at least of what is surrounded, landmarks up to which "left of the white one" is read in a grid, and what
number is no row's."""
_AROUND: tuple[Cell, ...] = ((-1, 0), (1, 0), (0, -1), (0, 1))
_ASLANT: tuple[Cell, ...] = ((-1, -1), (-1, 1), (1, -1), (1, 1))
_MIDDLES = listed("middle")
_CORNER = "corner"
_RIMS = frozenset({_CORNER, "edge"})
"""What "the corner tiles" and "those on the edge" have in common with all that is on the rim of a grid."""
_SPOTS = listed("spots of a grid")
_TELLING = frozenset().union(
    LINE_OF, LINE_ENDS, CELL_STEPS, _BESIDE, _SPOTS, _MIDDLES, ("between", "surrounded by", _DIAGONAL)
)
_SAME = frozenset({"color: equal", "color: same hue", "color: alike"})


def with_cells(world: WorldModel, trees: Iterable[ParseTree]) -> WorldModel:
    """The world whose things have the cells of their grid as attributes, if a tree speaks of cells."""
    if not any(CELL in word for tree in trees for node in tree.walk() for word in node.phrase.words):
        return world
    grid = _grid(world)
    cells = {} if grid is None else grid.cells
    objects = tuple(_in_cell(o, cells.get(o.id)) for o in world.objects)
    return replace(world, objects=objects)


def _in_cell(thing: Object, cell: Cell | None) -> Object:
    """A thing with its cell as an attribute, and none where it was before."""
    own = {a for a in thing.attributes if not a.startswith(CELL)}
    return replace(thing, attributes=frozenset(own if cell is None else {*own, f"{CELL}{_name(cell)}"}))


def by_cells(trees: Sequence[ParseTree], world: WorldModel) -> list[ParseTree]:
    """Trees in which what is said of the rows, columns and neighbours of a grid is words for cells."""
    if not any(map(_may_speak_of_cells, trees)) or (grid := _grid(world)) is None:
        return list(trees)
    return [_Speaking(grid, world.objects).root(tree) for tree in trees]


@functools.lru_cache(maxsize=1024)
def _may_speak_of_cells(tree: ParseTree) -> bool:
    """Is there a word without which `_Speaking` finds nothing to say?"""
    return any(
        node.phrase.noun in _TELLING
        or (node.phrase.noun or "").partition(" ")[0] in _RIMS
        or not _TELLING.isdisjoint(node.phrase.words)
        for node in tree.walk()
    )


def _grid(world: WorldModel) -> Grid | None:
    return grid_of([o for o in world.objects if not o.hypothetical], world.viewer or world.robot)


def _name(cell: Cell) -> str:
    return f"{cell[0] + 1} {cell[1] + 1}"


class _Speaking:
    """Reads trees in a grid."""

    def __init__(self, grid: Grid, objects: Sequence[Object]) -> None:
        self.grid = grid
        self.things = {grid.cells[o.id]: o for o in objects if o.id in grid.cells}

    def root(self, tree: ParseTree) -> ParseTree:
        """The whole tree: "directly under the red one" is a thing; "row 2 and column 3" are both of one thing."""
        children = list(tree.children)
        first = children[0].phrase if children else tree.phrase
        if not tree.phrase.words and first.kind is PhraseKind.PREPOSITION and first.words[0] in CELL_STEPS:
            children = [ParseTree(Phrase(PhraseKind.NOUN, ""), tuple(children))]
        if children and first.noun in _MIDDLES and not children[0].children:
            children[0] = ParseTree(replace(first, noun=None, words=(*first.words, "middle")))
        if children and children[0].phrase.kind is PhraseKind.NOUN:
            lines = [c for c in children[1:] if self.line(c.phrase) is not None]
            inside = [ParseTree(Phrase(PhraseKind.PREPOSITION, "in", ("in",)), (line,)) for line in lines]
            children = [c for c in children if c not in lines]
            children[0] = replace(children[0], children=(*children[0].children, *inside))
        return replace(tree, children=tuple(self.node(child) for child in children))

    def node(self, tree: ParseTree) -> ParseTree:
        """A phrase and all below it."""
        phrase = self.without_rim(tree.phrase)
        if phrase.kind is not PhraseKind.NOUN:
            return replace(tree, children=tuple(self.node(child) for child in tree.children))
        lines = [line for child in tree.children for line in self.lines(child)]
        kept = [self.node(child) for place in tree.children for child in self.others(place)]
        found: set[Cell] | None = None
        for cells in lines:
            found = cells if found is None else found & cells
        if found and (ends := self.aside(tree)):
            fitting = sorted(self.fitting(phrase, found), key=lambda cell: -ends[0][1] * cell[ends[0][0] or 0])
            found = set(fitting[-1:]) or found
        elif found:
            phrase, found = self.counted(phrase, found, across=lines[0])
        for child in kept:
            near = self.beside(phrase, child) if child.phrase.kind is PhraseKind.PREPOSITION else None
            if near:
                found = (near if found is None else found & near) or near
                phrase = replace(phrase, words=tuple(w for w in phrase.words if not _number((w,))), count=None)
        if not found and (found := self.corner(phrase, tree.children)):
            kept = [self.node(place) for place in tree.children if not _is_a_spot(place)]
        if found:
            noun = None if phrase.noun in LINE_OF and len(found) == 1 else phrase.noun  # "row 2, column 3"
            phrase = replace(phrase, noun=noun, words=tuple(w for w in phrase.words if w not in _RIMS))
            phrase = replace(phrase, words=(*phrase.words, f"{CELL}{'|'.join(map(_name, sorted(found)))}"))
        return ParseTree(phrase, tuple(kept))

    def without_rim(self, phrase: Phrase) -> Phrase:
        """A noun phrase that says "corner" as a word of its own: "the corner tiles", where no class is called so."""
        rim, _, noun = (phrase.noun or "").partition(" ")
        called = any((thing.type or "").lower().startswith(rim) for thing in self.things.values())
        return (
            phrase if rim not in _RIMS or not noun or called else replace(phrase, noun=noun, words=(*phrase.words, rim))
        )

    def lines(self, place: ParseTree) -> Iterable[set[Cell]]:
        """The cells of each row or column that a prepositional phrase says a thing is in."""
        if place.phrase.kind is not PhraseKind.PREPOSITION or place.phrase.words[0] not in _WITHIN:
            return
        for landmark in place.children:
            cells = self.line(landmark.phrase) or self.line_of_another(landmark)
            if cells is not None:
                yield cells
                for below in landmark.children:
                    yield from self.lines(below)

    def line_of_another(self, landmark: ParseTree) -> set[Cell] | None:
        """The cells of "the same row as the red tile", without that tile; None where it means none for certain."""
        marks = [c.children[0].phrase for c in landmark.children if c.phrase.words[:1] == ("as",) and c.children]
        if landmark.phrase.noun not in LINE_OF or "same" not in landmark.phrase.words or len(marks) != 1:
            return None
        axis = 0 if landmark.phrase.noun != "column" else 1
        own = self.fitting(marks[0], set(self.things))
        return {c for c in self.things if c not in own and any(c[axis] == of[axis] for of in own)} or None

    def aside(self, tree: ParseTree) -> list[tuple[int | None, int]]:
        """At which end of a line a thing is: "in the third row on the left" is the leftmost there."""
        said = [c.phrase for place in tree.children for c in place.children if self.line(c.phrase) is not None]
        return [LINE_ENDS[word] for p in said for word in p.words if _is_aside(word, 0 if p.noun != "column" else 1)]

    def others(self, place: ParseTree) -> Iterable[ParseTree]:
        """A place, or of a row or column what else is said of the thing in it: "in the third row on the left"."""
        if not list(self.lines(place)):
            yield place
            return
        for landmark in place.children:
            if self.line_of_another(landmark) is not None:
                continue
            if self.line(landmark.phrase) is None:
                yield replace(place, children=(landmark,))
            else:
                yield from (other for below in landmark.children for other in self.others(below))

    def line(self, phrase: Phrase) -> set[Cell] | None:
        """The cells of a row or column that is told by its number or its end; None for what is none."""
        if phrase.kind is not PhraseKind.NOUN or phrase.noun not in LINE_OF or phrase.color is not None:
            return None
        axis = 0 if phrase.noun != "column" else 1
        told = [LINE_ENDS[word] for word in phrase.words if word in LINE_ENDS and not _is_aside(word, axis)]
        if axis == 0 and told and all(of == 1 for of, _ in told if of is not None) and told[0][0] == 1:
            axis = 1  # "the left row" is a column
        ends = [end for of, end in told if of in (axis, None)]
        number = _number(phrase.words)
        count = (self.grid.rows, self.grid.columns)[axis]
        if "middle" in phrase.words or "center" in phrase.words:
            at = count // 2 if count % 2 else -1
        elif number is None and not ends:
            return None
        else:
            at = (number or 1) - 1
            at = count - 1 - at if -1 in ends else at
        found = {cell for cell in self.things if cell[axis] == at}
        return found or None

    def counted(self, phrase: Phrase, cells: set[Cell], across: set[Cell]) -> tuple[Phrase, set[Cell]]:
        """A phrase without its ordinal, and the cell in a line that it counts to: "the second drawer", "the last"."""
        axis = 1 if len({r for r, _ in across}) == 1 else 0
        told = [LINE_ENDS[word] for word in phrase.words if word in LINE_ENDS]
        number = _number(phrase.words)
        middle = "middle" in phrase.words
        if (number is None and not told and not middle) or any(of not in (axis, None) for of, _ in told):
            return phrase, cells
        if phrase.plural or (phrase.count or 1) > 1:
            return phrase, cells
        row = sorted(self.fitting(phrase, cells), key=lambda cell: cell[axis])
        at = (len(row) // 2 if len(row) % 2 else -1) if middle else (number or 1) - 1
        if any(end == -1 for _, end in told):
            row = row[::-1]
        if not 0 <= at < len(row):
            return phrase, cells
        said = tuple(w for w in phrase.words if w not in LINE_ENDS and w != "middle" and _number((w,)) is None)
        return replace(phrase, words=said, count=None), {row[at]}

    def corner(self, phrase: Phrase, places: Sequence[ParseTree]) -> set[Cell] | None:
        """The cells of "the top left drawer", "on the right edge", "in the very middle", if what stands there is so."""
        words, edge = {*phrase.words}, False
        for spot in (place.children[0].phrase for place in places if _is_a_spot(place)):
            words |= {*spot.words, spot.noun or ""}
            edge = edge or spot.noun == "edge"
        ends = {LINE_ENDS[word] for word in words if word in LINE_ENDS}
        if words & _RIMS and not (ends or words & _MIDDLES):
            return self.fitting(phrase, self.grid.corners() if _CORNER in words else self.grid.rim()) or None
        if phrase.plural or _number(words) is not None:
            return None
        if words & _MIDDLES and words <= _MIDDLES:
            return self.fitting(phrase, self.grid.central())
        if not words.isdisjoint(("left", "right")) and _CORNER not in words:
            ends = {
                LINE_ENDS[word] for word in words - {"far"} if word in LINE_ENDS
            }  # "on the far right" is at no back
        both = len({axis for axis, _ in ends} & {0, 1})
        if both != len(ends) or not both or (both == 1 and not (edge or words & _MIDDLES)):
            return None
        size = (self.grid.rows, self.grid.columns)
        at = {axis or 0: 0 if end > 0 else size[axis or 0] - 1 for axis, end in ends}
        cells = {cell for cell in self.things if all(cell[a] == k for a, k in at.items())}
        if both == 1 and words & _MIDDLES:  # "the bottom drawer in the middle"
            (axis,) = {0, 1} - at.keys()
            cells = {cell for cell in cells if cell[axis] in ((size[axis] - 1) // 2, size[axis] // 2)}
        return self.fitting(phrase, cells) or None

    def beside(self, phrase: Phrase, place: ParseTree) -> set[Cell] | None:
        """The cells that a preposition to landmarks in the grid means; None where it means none for certain."""
        name = place.phrase.words[0]
        if NOT in place.phrase.words or not place.children:
            return None
        marks = [self.fitting(child.phrase, set(self.things)) for child in place.children]
        if name in ("between", "surrounded by"):
            return self.amid(name, phrase, marks)
        if len(marks) != 1 or not 0 < len(marks[0]) <= _FEW:
            return None
        if name in CELL_STEPS:
            found = {cell for mark in marks[0] for cell in self.stepped(phrase, mark, CELL_STEPS[name])}
        elif name in _BESIDE or name == _DIAGONAL:
            around = _ASLANT if name == _DIAGONAL else _AROUND
            near = {(r + dr, c + dc) for r, c in marks[0] for dr, dc in around}
            found = self.fitting(phrase, near)
        else:
            return None
        return found or None

    def stepped(self, phrase: Phrase, mark: Cell, step: Cell) -> set[Cell]:
        """The cell so many steps away, or the nearest that way that a phrase describes."""
        number = None if any(word in LINE_ENDS for word in phrase.words) else _number(phrase.words)
        for k in range(1, max(self.grid.rows, self.grid.columns)):
            cell = (mark[0] + k * step[0], mark[1] + k * step[1])
            if k == number or (number is None and self.fitting(phrase, {cell})):
                return {cell} & set(self.things)
        return set()

    def amid(self, name: str, phrase: Phrase, marks: Sequence[set[Cell]]) -> set[Cell] | None:
        """The cells between neighbours, or with neighbours all around: on most sides."""
        found: dict[Cell, int] = {}
        one, other = marks[0], marks[-1]
        for r, c in self.fitting(phrase, set(self.things)):
            around = [cell for dr, dc in _AROUND if (cell := (r + dr, c + dc)) in self.things]
            if name == "between":
                sides = [((r - dr, c - dc), (r + dr, c + dc)) for dr, dc in _AROUND]
                found |= {(r, c): 0} if any(a in one and b in other for a, b in sides) else {}
            elif len(around) >= _ANY and all(cell in one for cell in around):
                found[r, c] = len(around)
        most = max(found.values(), default=0)
        return {cell for cell, times in found.items() if times == most} or None

    def fitting(self, phrase: Phrase, cells: Collection[Cell]) -> set[Cell]:
        """Those of some cells whose things have the name, colour and marks that a phrase says."""
        return {cell for cell in cells if (thing := self.things.get(cell)) is not None and _fits(phrase, thing, cell)}


def _is_a_spot(place: ParseTree) -> bool:
    """Does a prepositional phrase name a part of the grid: "in the top left corner", "on the edge"?"""
    if place.phrase.words[:1] and place.phrase.words[0] in _WITHIN and len(place.children) == 1:
        landmark = place.children[0]
        return landmark.phrase.noun in _SPOTS | LINE_ENDS.keys() and not landmark.children
    return False


def _fits(phrase: Phrase, thing: Object, cell: Cell) -> bool:
    if phrase.noun is not None and not (thing.type is None or names_one_of(phrase.noun, (thing.type,))):
        return False
    colored = phrase.color is not None and thing.color is not None
    if colored and _SAME.isdisjoint(color_evidence(phrase.color or "", thing.color or "")):
        return False
    own = thing.attributes - {LOOKED_ROUND} | {f"{CELL}{_name(cell)}"}
    return not any("attribute: contrary" in attribute_evidence((w,), own) for w in phrase.words)


def _is_aside(word: str, axis: int) -> bool:
    """Is a word such as "from the left" about the other axis than that of a line of a row or column?"""
    return word.startswith("from ") and word in LINE_ENDS and LINE_ENDS[word][0] != axis


def _number(words: Iterable[str]) -> int | None:
    """What words count to: "third", "3", "three"."""
    numbers = (ORDINALS.get(word) or cardinal(word) for word in words)
    return next((number for number in numbers if number is not None and number < _MOST_LINES), None)
