"""Dots of several grays and sizes, and stacks of blocks: what is compared with what. Commands that we wrote."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant, shipped

from dcg_torch.interpretation.marks import heard
from dcg_torch.interpretation.plain_words import in_plain_words
from dcg_torch.language import default_parser, parse_command, target_phrase
from dcg_torch.names.colors import color_scores
from dcg_torch.types import Percept, Pose

GRAYS = {"black": 15, "dark gray": 78, "gray": 138, "light gray": 205}
DOTS = (  # x, y, size, gray
    (0.8, 0.5, 0.12, "black"),
    (1.0, -0.6, 0.125, "dark gray"),
    (1.3, 0.1, 0.05, "black"),
    (1.5, -0.3, 0.2, "light gray"),
    (1.7, 0.6, 0.054, "black"),
    (1.9, -0.7, 0.045, "gray"),
    (2.1, 0.2, 0.19, "gray"),
    (2.3, -0.1, 0.2, "dark gray"),
)
BLOCKS = (  # x, y, how many
    (1.0, 0.5, 3),
    (1.2, -0.4, 4),
    (1.6, 0.1, 2),
)


@pytest.mark.parametrize("named", [True, False])
@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("the largest black one", {"0"}),
        ("all the black dots", {"0", "2", "4"}),
        ("all the tiny black dots", {"2", "4"}),
        ("the two small black specks", {"2", "4"}),
        ("the big dark gray dot", {"7"}),
        ("the small gray one", {"5"}),
        ("the red dot", set()),
        ("the green dot", set()),
    ],
)
def test_grays_and_sizes(text: str, numbers: set[str], named: bool) -> None:
    """With names of colours beside their looks, and without."""
    percepts = [
        Percept(str(k), "dot", gray if named else None, (x, y, 0.0), size=(size,) * 3, rgb=(GRAYS[gray],) * 3)
        for k, (x, y, size, gray) in enumerate(DOTS)
    ]
    assert meant(text, percepts, looked=True) == numbers


def test_of_two_none_is_of_medium_size() -> None:
    three = [(0.05, "red"), (0.1, "black"), (0.2, "black")]
    percepts = [Percept(str(k), "dot", c, (1.0, 0.3 * k, 0.0), size=(s,) * 3) for k, (s, c) in enumerate(three)]
    assert meant("the medium sized black dot", percepts, looked=True) == {"1"}


@pytest.mark.parametrize(
    ("word", "gray"), [("black", 20), ("dark gray", 80), ("gray", 138), ("light gray", 205), ("white", 250)]
)
def test_each_word_for_a_gray_has_its_own(word: str, gray: int) -> None:
    grays = np.array([[v] * 3 for v in (20, 80, 138, 205, 250)], dtype=np.float64)
    assert grays[color_scores(tuple(word.split()), grays).argmax(), 0] == gray


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("the tallest stack", {"1 0", "1 1", "1 2", "1 3"}),
        ("the highest tower", {"1 0", "1 1", "1 2", "1 3"}),
        ("the shortest stack", {"2 0", "2 1"}),
        ("the lowest block in the highest stack", {"1 0"}),
        ("the block on top of the highest stack", {"1 3"}),
        ("the bottom block of the tallest stack", {"1 0"}),
        ("the top block of the highest pile", {"1 3"}),
    ],
)
def test_stacks_have_a_height(text: str, ids: set[str]) -> None:
    percepts = [
        Percept(f"{k} {z}", "block", ("red", "blue", "green", "red")[(k + z) % 4], (x, y, 0.05 + 0.1 * z), (0.1,) * 3)
        for k, (x, y, count) in enumerate(BLOCKS)
        for z in range(count)
    ]
    assert meant(text, percepts, looked=True) == ids


@pytest.mark.parametrize("ground", ["ground", "floor", "table"])
def test_from_the_ground_is_from_the_bottom(ground: str) -> None:
    tree = parse_command(f"the second block from the {ground}").tree
    assert tree is not None
    assert target_phrase(in_plain_words(tree, frozenset({"block"}))).phrase.words == ("second", "from the bottom")
    plain = parse_command(f"the block from the {ground}").tree
    assert plain is not None
    assert "from the bottom" not in target_phrase(in_plain_words(plain, frozenset({"block"}))).phrase.words


PAIRS = (  # x, y, colour
    (1.0, 0.6, "gray"),
    (1.1, 0.45, "light gray"),
    (1.4, -0.5, "black"),
    (1.9, -0.2, "gray"),
    (2.1, -0.45, "gray"),
    (2.2, 0.6, "black"),
    (0.6, -0.7, "light gray"),
)


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("the two dots close together", {"0", "1"}),
        ("the two that almost touch", {"0", "1"}),
        ("two gray dots next to each other", {"3", "4"}),
        ("the pair of dots that are next to each other", {"0", "1"}),
        ("the three dots close together", {"2", "3", "4"}),
        ("pair of dots close together, the lighter of them", {"1"}),
        ("do you see a dot left of the light gray dot at the top? that's the one", {"0"}),
    ],
)
def test_what_stands_close_together(text: str, numbers: set[str]) -> None:
    percepts = [Percept(str(k), "dot", gray, (x, y, 0.0), (0.1,) * 3) for k, (x, y, gray) in enumerate(PAIRS)]
    assert meant(text, percepts, looked=True) == numbers


@pytest.mark.parametrize("word", ["camera", "viewer"])
def test_the_camera_is_where_the_scene_is_seen_from(word: str) -> None:
    percepts = [Percept(str(k), "cube", "red", (1.0 + k, 0.3 * k, 0.05)) for k in range(3)]
    assert meant(f"the cube farthest from the {word}", percepts, looked=True) == {"2"}
    assert meant(f"the cube closest to the {word}", percepts, looked=True) == {"0"}
    percepts.append(Percept("c", word, None, (4.0, 1.0, 0.0)))
    assert meant(f"the cube closest to the {word}", percepts, looked=True) == {"2"}


@pytest.mark.parametrize(
    "text", ["block 7 should go to the left of block 3", "block 7 needs to be moved to the left of block 3"]
)
def test_what_should_go_somewhere_is_meant(text: str) -> None:
    percepts = [
        Percept(n, "block", None, (1.0 + 0.3 * k, 0.5 - 0.4 * k, 0.0), attributes=frozenset({f"number: {n}"}))
        for k, n in enumerate(("3", "7", "9", "12"))
    ]
    command = heard(default_parser().parse, text, (), percepts)
    world = shipped().world_model(percepts, Pose(0.0, 0.0), looked=True)
    assert [o.id for o in shipped().ground(command, world).objects] == ["7"]


def test_of_several_of_one_color_all_are_denied() -> None:
    grays = np.array([[v] * 3 for v in (12, 14, 16, 18, 140)], dtype=np.float64)
    scores = color_scores(("not", "black"), grays)
    assert scores[4] > scores[:4].max() + 2.0


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("the gray one that is not small", "6"),
        ("the black dot which isn't small", "0"),
        ("not black, not small, lowest", "1"),
    ],
)
def test_sizes_that_are_denied(text: str, number: str) -> None:
    percepts = [
        Percept(str(k), "dot", gray, (x, y, 0.0), size=(size,) * 3) for k, (x, y, size, gray) in enumerate(DOTS)
    ]
    assert meant(text, percepts, looked=True) == {number}
