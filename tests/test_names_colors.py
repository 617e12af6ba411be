from __future__ import annotations

import subprocess
import sys

import color_names
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb

from dcg_torch.names.attributes import ATTRIBUTE_FACTS, attribute_evidence
from dcg_torch.names.color_names import COLOR_FACTS, color_evidence
from dcg_torch.names.colors import FEATURES, WEIGHTS, color_features, color_scores
from dcg_torch.names.normal_form import DATA
from dcg_torch.names.palette import LISTED, color_log_likelihood, lab, named_rgb, region

RED, GREEN, BLUE = (230, 20, 20), (20, 180, 40), (20, 60, 220)
PALE, DARK = (150, 180, 250), (10, 20, 90)
GRAY, BROWN, PINK, PURPLE, TEAL = (128, 128, 128), (110, 70, 30), (250, 130, 190), (130, 40, 170), (20, 150, 140)


def chosen(text: str, *rgbs: tuple[int, int, int]) -> int:
    """Which of the colours a description fits best."""
    return int(color_scores(tuple(text.split()), np.array(rgbs, dtype=float)).argmax())


def test_the_list_of_colours_is_that_of_matplotlib() -> None:
    assert (DATA / LISTED).read_text(encoding="utf-8").splitlines() == color_names.lines()
    for name, code in (("army green", "xkcd:army green"), ("Dark_Sky Blue", "xkcd:dark sky blue"), ("snow", "snow")):
        assert named_rgb(name) == pytest.approx([255 * part for part in to_rgb(code)])


def test_a_colour_needs_no_library_of_figures() -> None:
    program = "import sys; from dcg_torch.names.palette import named_rgb; print(named_rgb('puce'), *sys.modules)"
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert said.startswith("(")
    assert "matplotlib" not in said.split()


@pytest.mark.parametrize(("rgb", "lightness", "chroma"), [((255, 255, 255), 100, 0), ((0, 0, 0), 0, 0)])
def test_white_and_black_in_lab(rgb: tuple[int, int, int], lightness: float, chroma: float) -> None:
    values = lab(np.array(rgb, dtype=float))
    assert values[0] == pytest.approx(lightness, abs=0.1)
    assert np.hypot(values[1], values[2]) == pytest.approx(chroma, abs=0.1)


def test_compressing_chroma_keeps_the_hue() -> None:
    """sRGB red has L* 53.2 and hue 40 degrees (CIE 15:2004)."""
    values = lab(np.array([255.0, 0.0, 0.0]))
    assert values[0] == pytest.approx(53.2, abs=0.1)
    assert np.degrees(np.arctan2(values[2], values[1])) == pytest.approx(40.0, abs=0.1)


@pytest.mark.parametrize(
    ("text", "rgbs"),
    [
        ("red", (RED, GREEN, BLUE)),
        ("the grey one", (GRAY, TEAL, BROWN)),
        ("brown", (BROWN, RED, GRAY)),
        ("teal", (TEAL, GREEN, BLUE)),
        ("light blue", (PALE, BLUE, DARK)),
        ("dark blue", (DARK, BLUE, PALE)),
        ("the darker blue", (DARK, PALE, RED)),
        ("the lightest one", (PALE, BLUE, DARK)),
        ("the more purple one", (PURPLE, BLUE, GREEN)),
        ("the pinker one", (PINK, PURPLE, BLUE)),
        ("not red", (BLUE, RED, (240, 40, 30))),
        ("not the green ; the blue one", (BLUE, GREEN, RED)),
        ("the dull one", (GRAY, RED, GREEN)),
        ("neon green", ((40, 250, 40), (110, 150, 110), BLUE)),
        ("the least bright green", ((100, 140, 100), (40, 250, 40), (30, 200, 30))),
        ("grayish purple", ((125, 105, 140), PURPLE, GREEN)),
        ("bluish green", ((30, 180, 130), (90, 180, 20), RED)),
        ("sky blue", ((110, 190, 250), DARK, GREEN)),
        ("darker than the others", (DARK, BLUE, PALE)),
        ("not red or green", (PURPLE, RED, GREEN)),
        ("neither the gray , nor the teal one", (BROWN, GRAY, TEAL)),
        ("a bit more purple than blue or red", (PURPLE, BLUE, RED)),
        ("the blue but not bright blue one", (DARK, BLUE, RED)),  # red is not bright blue either, but it is no blue
        ("not bright blue or red", (DARK, BLUE, RED)),
        ("not the darkest , not the lightest", (BLUE, DARK, PALE)),
        ("the darker gray one", ((70, 75, 80), (110, 110, 110), GREEN)),  # though the lighter is the grayer
        ("the darkest yellow", ((150, 130, 30), (240, 220, 60), RED)),
        ("the brighter purple", ((190, 40, 250), PURPLE, GREEN)),
        ("the darkest green", (GREEN, (120, 220, 130), DARK)),  # what is still darker is no green
        ("medium blue", (BLUE, (10, 20, 90), (150, 180, 250))),
        ("the middle shade", (BLUE, DARK, PALE)),
        ("the middle green color", ((40, 150, 60), (20, 70, 30), (150, 230, 160))),
        ("blueish green", ((30, 180, 130), (90, 180, 20), RED)),
    ],
)
def test_descriptions(text: str, rgbs: tuple[tuple[int, int, int], ...]) -> None:
    """The first is meant, wherever it stands."""
    for turn in range(len(rgbs)):
        order = rgbs[turn:] + rgbs[:turn]
        assert order[chosen(text, *order)] == rgbs[0]


@given(st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=6), st.randoms())
def test_the_order_of_the_colors_does_not_matter(rgbs: list[tuple[int, int, int]], random: object) -> None:
    words, colors = ("the", "darker", "bluish", "green", ",", "not", "pink"), np.array(rgbs, dtype=float)
    scores = color_scores(words, colors)
    assert color_scores(words, colors[::-1])[::-1] == pytest.approx(scores)
    assert np.isfinite(scores).all()


def test_words_that_are_no_colors_say_nothing() -> None:
    assert not color_features(("it", "stands", "there"), np.array([RED, BLUE], dtype=float)).any()


def test_scores_are_weighted_features() -> None:
    words, colors = ("dark", "red", "not", "brown"), np.array([RED, BROWN, DARK], dtype=float)
    features = color_features(words, colors)
    assert features.shape == (3, len(FEATURES)) == (3, len(WEIGHTS))
    assert color_scores(words, colors, (2.0, *WEIGHTS[1:])) - color_scores(words, colors) == pytest.approx(
        features[:, 0] * (2.0 - WEIGHTS[0])
    )


def test_a_region_is_graded() -> None:
    red = [color_log_likelihood("red", rgb) for rgb in (RED, (230, 90, 60), (230, 160, 60), GREEN)]
    assert red == sorted(red, reverse=True)
    assert color_log_likelihood("zorp", RED) == 0.0
    assert region("zorp") is None


@pytest.mark.parametrize(
    ("word", "name", "fact"),
    [
        ("Grey", "gray", "color: equal"),
        ("LightGrey", "light gray", "color: equal"),
        ("light blue", "blue", "color: same hue"),
        ("blue", "dark blue", "color: same hue"),
        ("dark blue", "light blue", "color: shades apart"),
        ("turquoise", "cyan", "color: alike"),
        ("aqua", "cyan", "color: alike"),
        ("violet", "purple", "color: alike"),
        ("silver", "gray", "color: alike"),
        ("pink", "magenta", "color: alike"),
        ("purple", "magenta", "color: alike"),
        ("purple", "pink", "color: near"),
        ("orange", "red", "color: near"),
        ("navy", "blue", "color: near"),
        ("red", "green", "color: far"),
        ("yellow", "purple", "color: far"),
        ("zorp", "red", "color: strange"),
    ],
)
def test_facts_of_colors(word: str, name: str, fact: str) -> None:
    assert color_evidence(word, name) == color_evidence(name, word) == (fact,)
    assert fact in COLOR_FACTS


@pytest.mark.parametrize(
    ("words", "attributes", "facts"),
    [
        (("big",), {"size: large"}, ("alike",)),
        (("large",), {"size_word: large"}, ("equal",)),
        (("big",), {"size: small"}, ("contrary",)),
        (("big",), {"size: medium"}, ("contrary",)),
        (("facing left",), {"orientation: left"}, ("alike",)),
        (("facing me",), {"orientation: front"}, ("alike",)),
        (("facing right",), {"orientation: left"}, ("contrary",)),
        (("left",), {"size: large"}, ("silent",)),
        (("wooden",), {"material: wood"}, ("alike",)),
        (("wooden",), {"material: metal"}, ("contrary",)),
        (("open",), {"state: closed"}, ("contrary",)),
        (("open",), {"state: clean"}, ("silent",)),
        (("held",), {"held"}, ("equal",)),
        (("shiny", "small"), {"size: small", "texture: matte"}, ("equal", "contrary")),
        (("zorp",), {"size: small"}, ()),
        (("zorp",), {"mood: Zorp"}, ("equal",)),
        ((), {"size: small"}, ()),
    ],
)
def test_facts_of_attributes(words: tuple[str, ...], attributes: set[str], facts: tuple[str, ...]) -> None:
    assert attribute_evidence(words, attributes) == tuple(f"attribute: {fact}" for fact in facts)
    assert {f"attribute: {fact}" for fact in facts} <= set(ATTRIBUTE_FACTS)


@pytest.mark.parametrize(
    ("word", "nearer", "farther"), [("white", "very light grey", "grey"), ("black", "very dark grey", "dark grey")]
)
def test_a_very_light_shade_is_farther_from_its_hue(word: str, nearer: str, farther: str) -> None:
    facts: list[str] = list(COLOR_FACTS)
    assert facts.index(color_evidence(word, nearer)[0]) < facts.index(color_evidence(word, farther)[0])
