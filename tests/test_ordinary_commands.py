"""What people commonly say of things on a floor or a table, in scenes by chance: commands that we wrote.

Each text has a meaning that is worked out from positions, sizes and colours. Where the meaning is not clear in a scene
(two things are about as near), the text is not asked there. A text that is wrong in every scene is a hole in the model.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest

import dcg_torch
from dcg_torch.model import GroundingModel
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose, WorldModel

Value = Callable[[Percept], float]
Ids = frozenset[str]
KINDS = ("cube", "ball", "mug", "box", "cone", "bottle", "chair", "lamp")
SCENES = 6
NUMBERS = {2: "two", 3: "three"}
ORDINALS = {1: "first", 2: "second", 3: "third", 4: "fourth"}


class NotClearError(Exception):
    """People would not agree on what is meant."""


@dataclass(frozen=True)
class Scene:
    """Four to six things of one kind and colour, three of the kind in another colour, a landmark and one thing more."""

    things: tuple[Percept, ...]
    alike: tuple[Percept, ...]
    others: tuple[Percept, ...]
    scale: float
    words: dict[str, str]

    @property
    def kind(self) -> tuple[Percept, ...]:
        return (*self.alike, *self.others)

    @property
    def marks(self) -> tuple[Percept, ...]:
        return self.things[-2:]

    @property
    def mark(self) -> Percept:
        return self.marks[0]

    def world(self, model: GroundingModel) -> WorldModel:
        return model.world_model(self.things, Pose(0.0, 0.0), looked=True, workspace=Workspace.of(self.things))


Meaning = Callable[[Scene], Ids]


def scene(rng: np.random.Generator) -> Scene:
    kind, mark, more = map(str, rng.permutation(KINDS)[:3])
    color, other = map(str, rng.permutation(["red", "green", "blue", "yellow"])[:2])
    scale = float(rng.choice([0.6, 4.0]))
    number = int(rng.integers(4, 7))
    places: list[tuple[float, float]] = []
    while len(places) < number + 5:
        at = float(rng.uniform(0.25, 1.2)) * scale, float(rng.uniform(-0.6, 0.6)) * scale
        if all(math.dist(at, place) > 0.11 * scale for place in places):
            places.append(at)
    edges = (*rng.permutation(np.linspace(0.04, 0.1, number)), *rng.permutation([0.05, 0.07, 0.09]), 0.06, 0.06)
    names = [(kind, color)] * number + [(kind, other)] * 3 + [(mark, "white"), (more, "black")]
    things = tuple(
        Percept(f"{name[1]} {k}", *name, (*at, 0.0), (float(edge) * scale,) * 3)
        for k, (name, at, edge) in enumerate(zip(names, places, edges, strict=True))
    )
    words = {"kind": kind, "these": f"{color} {kind}", "others": f"{other} {kind}", "other": other, "color": color}
    words |= {"mark": mark, "more": more}
    return Scene(things, things[:number], things[number : number + 3], scale, words)


def first(things: Sequence[Percept], value: Value, count: int, gap: float) -> Ids:
    """The first so many along an order."""
    order = sorted(things, key=value)
    if len(order) < count or (len(order) > count and value(order[count]) - value(order[count - 1]) < gap):
        raise NotClearError
    return frozenset(o.id for o in order[:count])


def left(o: Percept) -> float:
    return -o.position[1]


def right(o: Percept) -> float:
    return o.position[1]


def near(o: Percept) -> float:
    return math.hypot(*o.position[:2])


def far(o: Percept) -> float:
    return -near(o)


def small(o: Percept) -> float:
    return o.size[0] if o.size is not None else 0.0


def large(o: Percept) -> float:
    return -small(o)


def the_first(of: str, value: Value | None, count: int, gap: float = 0.04) -> Meaning:
    """The first so many of those; `value` None: by the distance to the landmark."""

    def meant(here: Scene) -> Ids:
        return first(getattr(here, of), value or to_mark(here), count, here.scale * gap if value not in SIZES else 0.0)

    return meant


def the_nth(of: str, value: Value | None, number: int, gap: float = 0.04) -> Meaning:
    """The one at that place, clearly apart from its neighbours."""
    upto, before = the_first(of, value, number, gap), the_first(of, value, number - 1, gap)
    return lambda here: upto(here) - (before(here) if number > 1 else frozenset())


def all_of(of: str) -> Meaning:
    return lambda here: frozenset(o.id for o in getattr(here, of))


def to_mark(here: Scene) -> Value:
    return lambda o: math.dist(o.position[:2], here.mark.position[:2])


def stands(degrees: float) -> Meaning:
    """The only one of the kind on that side of the landmark; 0 is away from the robot."""

    def meant(here: Scene) -> Ids:
        def off(o: Percept) -> float:
            x, y = (o.position[k] - here.mark.position[k] for k in range(2))
            return abs((math.degrees(math.atan2(y, x)) - degrees + 180.0) % 360.0 - 180.0)

        clear = [o for o in here.kind if off(o) < 22.0 and to_mark(here)(o) < 0.9 * here.scale]
        if len(clear) != 1 or sum(off(o) < 62.0 for o in here.kind) != 1:
            raise NotClearError
        return frozenset({clear[0].id})

    return meant


SIZES = (small, large)
SAID: list[tuple[str, Meaning]] = []


def say(meaning: Meaning, *texts: str) -> None:
    SAID.extend((text, meaning) for text in texts)


for n, many in NUMBERS.items():
    say(
        the_first("alike", near, n),
        *(f"the {many} {{these}}s closest to you", f"take the {many} nearest {{these}}s"),
        *(f"the {many} closest {{these}}s", f"bring me the {many} {{these}}s that are closest to you"),
    )
    say(the_first("alike", far, n), f"the {many} {{these}}s farthest from you", f"the {many} farthest {{these}}s")
    say(the_first("alike", None, n, 0.08), f"the {many} {{these}}s closest to the {{mark}}")
    say(the_first("alike", left, n), f"the {many} leftmost {{these}}s", f"the {many} {{these}}s on the left")
    say(the_first("alike", right, n), f"the first {many} {{these}}s from the right")
    say(the_first("alike", large, n), f"the {many} largest {{these}}s", f"the {many} biggest {{these}}s")
    say(the_first("alike", small, n), f"the {many} smallest {{these}}s")
for n, place in ORDINALS.items():
    say(
        the_nth("alike", left, n),
        *(f"the {place} {{these}} from the left", f"from the left, the {place} {{these}}"),
        *(f"counting from the left, the {place} {{these}}", f"the {place} {{these}}, starting from your left"),
    )
    if n > 1:
        say(the_nth("alike", near, n), f"the {place} closest {{these}} to you", f"the {place} nearest {{these}}")
        say(the_nth("alike", far, n), f"the {place} farthest {{these}}")
        say(the_nth("alike", None, n), f"the {place} closest {{these}} to the {{mark}}")
        say(the_nth("alike", large, n), f"the {place} biggest {{these}}")
        say(the_nth("alike", left, n), f"the {place} {{these}} to the left")
say(
    the_nth("alike", left, 1),
    *("the leftmost {these}", "the {these} on the far left", "the {these} all the way to the left", "the left {these}"),
    *("the leftmost {kind} that is not {other}", "of the {these}s, the one on the left"),
)
say(the_nth("others", large, 1), "the biggest of the three {others}s", "of the three {others}s, the biggest")
say(
    the_nth("others", left, 1),
    *("there are three {others}s. take the leftmost one", "i see three {others}s, i want the left one"),
    *("take one of the {others}s: the leftmost", "the leftmost {kind} that isn't {color}"),
)
say(the_nth("others", near, 1), "the nearest {kind} that isn't {color}", "the closest {others}")
say(
    all_of("others"),
    *("all three {others}s", "every one of the {others}s", "all the {kind}s that are not {color}", "the {others}s"),
    *("all {kind}s except the {these}s", "each of the {others}s"),
)
say(
    the_nth("kind", None, 1, 0.12),
    *(
        "the {kind} next to the {mark}",
        "the {kind} right next to the {mark}",
        "there's a {mark}, take the {kind} by it",
    ),
    *("the {kind} that the {mark} is next to", "the {mark} is next to the {kind} i want"),
)
for way, back, turn in (("behind", "in front of", 0.0), ("in front of", "behind", 180.0)):
    say(stands(turn), f"the {{kind}} {way} the {{mark}}", f"the {{kind}} with the {{mark}} {back} it")
for side, across, turn in (("left", "right", 90.0), ("right", "left", -90.0)):
    say(stands(turn), f"the {{kind}} {side} of the {{mark}}", f"the {{kind}} that has the {{mark}} on its {across}")
say(all_of("marks"), "the {mark} as well as the {more}", "the {mark} and the {more}")
say(
    lambda here: frozenset({here.mark.id}),
    *("what i want is the {mark}", "the one to take is the {mark}", "how about you get me the {mark}?", "{mark}"),
    *("i think the {mark} is the right one", "the object called {mark}", "something like a {mark}", "it is the {mark}"),
    *("no, not the {more}. the {mark}", "ignore the {more} and take the {mark}", "put the {mark} next to the {more}"),
    *("see that {mark}? that's the one", "the {mark} has to be moved", "something white"),
)


@pytest.fixture(scope="module")
def found() -> dict[str, list[bool]]:
    """Of each text, was it right in each scene where it is clear?"""
    model, rng = dcg_torch.pretrained(), np.random.default_rng(11)
    ok: dict[str, list[bool]] = defaultdict(list)
    for here in (scene(rng) for _ in range(SCENES)):
        world = here.world(model)
        for text, meaning in SAID:
            try:
                meant = meaning(here)
            except NotClearError:
                continue
            got = model.ground(text.format(**here.words), world).objects
            ok[text].append({o.id for o in got} == meant)
    return ok


def test_no_ordinary_wording_is_a_hole(found: dict[str, list[bool]]) -> None:
    holes = [text for text, ok in found.items() if len(ok) > 2 and not any(ok)]
    assert not holes, holes


def test_ordinary_wordings_are_right(found: dict[str, list[bool]]) -> None:
    every = [one for ok in found.values() for one in ok]
    assert len(every) > 300
    assert np.mean(every) > 0.9, sorted((float(np.mean(ok)), text) for text, ok in found.items())[:12]


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("bring anna the mug", "mug"),
        ("my sister wants the mug", "mug"),
        ("I'd like the table somebody put a monitor on", "table"),
        ("there are two crates by the truck, take whichever is closer to the gate", "crate"),
    ],
)
def test_orders_for_others_and_things_told_by_what_was_done(text: str, noun: str) -> None:
    target = next(node for node in dcg_torch.parse(text).readings[0].tree.walk() if node.phrase.noun)
    assert target.phrase.noun == noun
