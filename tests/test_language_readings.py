"""Readings: several for one command, with weights; what learned words may change; what stays unread; the cases."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from language_descriptions import DEVELOPMENT as DESCRIPTIONS
from language_sentences import DEVELOPMENT as SENTENCES

from dcg_torch.english.dictionary import read
from dcg_torch.language import Parse, Parser, Reading, target_phrase
from dcg_torch.language.decisions import Decisions, best_first
from dcg_torch.language.tagging import paths
from dcg_torch.types import ParseTree, Phrase

SHARED = Path(__file__).parents[2] / "shared"
CASES = SHARED / "cases"
TEXTS = [sentence.text for sentence in SENTENCES] + [said.text for said in DESCRIPTIONS]
ADVERSARIAL = ("pickup", "left", "can", "stand", "second", "orange", "close", "light", "place", "back", "up", "one")


def meant(reading: Reading) -> Phrase:
    return target_phrase(reading.tree).phrase


def relations(tree: ParseTree) -> list[tuple[str, str | None]]:
    return [(p.phrase.words[0], n.phrase.noun) for p in target_phrase(tree).children for n in p.children]


def has_reading(parse: Parse, noun: str | None, color: str | None) -> bool:
    return any((meant(reading).noun, meant(reading).color) == (noun, color) for reading in parse.readings)


@pytest.mark.parametrize("text", TEXTS)
def test_readings_are_a_distribution_with_distinct_trees(parser: Parser, text: str) -> None:
    readings = parser.parse(text).readings
    weights = [reading.log_weight for reading in readings]
    assert 1 <= len(readings) <= 4
    assert sum(map(math.exp, weights)) == pytest.approx(1.0)
    assert weights == sorted(weights, reverse=True)
    assert len({reading.tree for reading in readings}) == len(readings)


def test_k_bounds_the_readings(parser: Parser) -> None:
    text = "put the cube on the orange block near the sphere"
    assert [len(parser.parse(text, k=k).readings) for k in (1, 2)] == [1, 2]
    assert parser.parse(text, k=1).tree == parser.parse(text, k=4).tree


@pytest.mark.parametrize(
    ("text", "one", "other"),
    [
        ("go to the orange", (None, "orange"), ("orange", None)),
        ("find the salmon dish", ("dish", "salmon"), ("salmon dish", None)),
        ("go to the coffee table", ("coffee table", None), ("table", "coffee")),
    ],
)
def test_a_word_that_may_be_two_things_has_both_readings(
    parser: Parser, text: str, one: tuple[str | None, str | None], other: tuple[str | None, str | None]
) -> None:
    parse = parser.parse(text)
    assert has_reading(parse, *one)
    assert has_reading(parse, *other)


def test_attachment_has_both_readings(parser: Parser) -> None:
    parse = parser.parse("put the cube on the shelf")
    assert [relations(reading.tree) for reading in parse.readings[:2]] == [[], [("on", "shelf")]]
    assert [reading.rules[-1] for reading in parse.readings[:2]] == ["goal=destination", "goal=describes"]


@pytest.mark.parametrize("word", ADVERSARIAL)
def test_a_learned_noun_changes_no_other_words(parser: Parser, word: str) -> None:
    for text in TEXTS:
        assert parser.parse(text, [word]).tree == parser.parse(text).tree, text


@pytest.mark.parametrize(
    ("text", "vocabulary", "noun"),
    [
        ("go to the cola", ["colon"], "cola"),
        ("go to the brick", ["block"], "brick"),
        ("go to the zorq", ["zorg"], "zorg"),
        ("go to the wine glasses", ["WineGlass"], "wine glass"),
        ("go to the traffic cone", ["traffic_cone"], "traffic cone"),
    ],
)
def test_vocabulary(parser: Parser, text: str, vocabulary: list[str], noun: str) -> None:
    assert parser.parse(text, vocabulary).noun == noun


@pytest.mark.parametrize("word", ["form", "fort", "width", "then", "besides"])
def test_a_preposition_is_no_misspelt_noun(parser: Parser, word: str) -> None:
    for text in ("take the can from the shelf", "go to the box with handles", "look for the cube beside the lamp"):
        assert parser.parse(text, [word]).readings == parser.parse(text).readings


def test_a_mended_word_may_have_been_right(parser: Parser) -> None:
    parse = parser.parse("go to the zorq", ["zorg"])
    assert [meant(reading).noun for reading in parse.readings] == ["zorg", "zorq"]


@pytest.mark.parametrize("name", ["words.yaml", "patterns.yaml", "grammar.yaml"])
def test_no_word_of_the_data_is_read_as_a_truth_value(name: str) -> None:
    def leaves(value: object) -> Iterator[object]:
        if isinstance(value, dict):
            yield from value
            for item in value.values():
                yield from leaves(item)
        elif isinstance(value, list):
            for item in value:
                yield from leaves(item)
        else:
            yield value

    assert not [leaf for leaf in leaves(yaml.safe_load(read(name, "dcg_torch.language"))) if isinstance(leaf, bool)]


def test_rules_name_what_was_chosen(parser: Parser) -> None:
    rules = {meant(reading).color: reading.rules for reading in parser.parse("go to the orange").readings}
    assert rules == {"orange": ("words=COL",), None: ("words=N",)}


def test_content_words_that_no_phrase_uses_are_unread(parser: Parser) -> None:
    assert parser.parse("go to the red cube").unread == ()
    assert parser.parse("please go slowly to the red cube now").unread == ()
    assert "bouncing" in parser.parse("go to the cube bouncing").unread


@pytest.mark.parametrize(
    ("text", "words", "below"),
    [
        ("the second closest cone to the ball", ("second",), [("closest to", "ball")]),
        ("go to the cone that is third farthest from the ball", ("third",), [("farthest from", "ball")]),
        ("the second biggest cone", ("second", "biggest"), []),
        ("the next to last cone", ("second", "last"), []),
        ("the penultimate cone from the right", ("second", "last", "from the right"), []),
        ("the third leftmost cone", ("third", "from the left"), []),
        ("the second to closest cone", ("second", "closest"), []),
        ("go to cone 3", ("3",), []),
        ("go to cone number two", ("2",), []),
        ("the cone by itself", ("alone",), []),
        ("the cone farthest away", ("farthest",), []),
        ("the isolated cone", ("isolated",), []),
        ("the cone touching the wall", (), [("touching", "wall")]),
        ("the cone leaning against the wall", (), [("touching", "wall")]),
        ("the cone surrounded by the barrels", (), [("surrounded by", "barrel")]),
        ("the cone sandwiched between the barrels", (), [("between", "barrel")]),
        ("the cone lined up with the barrel", (), [("in line with", "barrel")]),
        ("the cone at the end of the row", (), [("at the end of", "row")]),
        ("the cone towards the back", (), [("in", "back")]),
        ("the cone nearest the edge", (), [("closest to", "edge")]),
        ("the cone in the corner of the room", (), [("in", "corner")]),
    ],
)
def test_selection_and_places(
    parser: Parser, text: str, words: tuple[str, ...], below: list[tuple[str, str | None]]
) -> None:
    parse = parser.parse(text)
    assert parse.tree is not None
    assert (parse.noun, meant(parse.readings[0]).words) == ("cone", words)
    assert relations(parse.tree) == below


@pytest.mark.parametrize(
    ("text", "noun", "words", "count", "plural", "below"),
    [
        ("the two cones", "cone", (), 2, True, []),
        ("both cones", "cone", ("both",), 2, True, []),
        ("every cone except the red one", "cone", ("every",), None, True, [("except", None)]),
        ("everything but the cone", None, ("all",), None, True, [("except", "cone")]),
        ("anything but the cone", "thing", (), None, False, [("except", "cone")]),
        ("the two nearest cones", "cone", ("closest",), 2, True, []),
    ],
)
def test_sets(
    parser: Parser, text: str, noun: str | None, words: tuple[str, ...], count: int | None, plural: bool,
    below: list[tuple[str, str | None]],
) -> None:  # fmt: skip
    parse = parser.parse(text)
    assert parse.tree is not None
    phrase = meant(parse.readings[0])
    assert (phrase.noun, phrase.words, phrase.count, phrase.plural) == (noun, words, count, plural)
    assert relations(parse.tree) == below


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("There are four yellow cones in a line. Take the middle one.", "cone"),
        ("Turn right, drive to the shelf and stop. Then grab the bottle on the top board.", "bottle"),
        ("Walk past the sofa until you see the lamp, then pick up the book next to it.", "book"),
        ("drive to the desk. open the drawer then pick it up.", "drawer"),
        ("i am cold, go to the heater", "heater"),
    ],
)
def test_longer_texts(parser: Parser, text: str, noun: str) -> None:
    assert parser.parse(text).noun == noun


def test_best_first_finds_the_heaviest_runs_in_order() -> None:
    def run(decisions: Decisions) -> str:
        first = decisions.choose("first", {"a": 0.0, "b": -1.0})
        return first + decisions.choose("second", {"c": 0.0, "d": -0.3 if first == "a" else -3.0})

    found = [(name, decisions.log_weight) for name, decisions in best_first(run, 4)]
    assert [name for name, _ in found] == ["ac", "ad", "bc"] + [name for name, _ in found[3:]]
    weights = [weight for _, weight in found]
    assert weights == sorted(weights, reverse=True)


@pytest.mark.parametrize("text", TEXTS[::9])
def test_paths_come_out_in_order_and_cover_the_words(text: str) -> None:
    words = text.lower().replace(",", " ,").replace(".", " .").split()
    found = paths(words, (), (), 5)
    assert [path.weight for path in found] == sorted((path.weight for path in found), reverse=True)
    assert len({tuple((t.start, t.stop, t.tag) for t in path.tokens) for path in found}) == len(found)
    for path in found:
        assert [t.start for t in path.tokens] == [0, *(t.stop for t in path.tokens[:-1])]
        assert path.tokens[-1].stop == len(words)


# Cases that are kept outside the repository ---------------------------------------------------------------------------


def cases(name: str) -> list[dict[str, Any]]:
    path = CASES / name
    if not path.exists():
        return []
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
    return [json.loads(line) if line.startswith("{") else {"text": line} for line in lines]


@pytest.mark.parametrize("case", cases("language.jsonl"), ids=lambda case: case["id"])
def test_case(parser: Parser, case: dict[str, Any]) -> None:
    parse = parser.parse(case["text"], case.get("vocabulary", ()))
    expected = case["expect"]
    if isinstance(expected, str):  # a number kept, or a refusal
        assert parse.refused or any(word.isdigit() for word in meant(parse.readings[0]).words)
        return
    if "destination" in expected:
        assert parse.tree is not None
        assert expected["destination"] in {node.phrase.noun for node in parse.tree.walk()}
    found = {"noun": parse.noun, "color": parse.color}
    assert all(found[key] == value for key, value in expected.items() if key in found)


def test_no_object(parser: Parser) -> None:
    assert not [case["text"] for case in cases("no_object.txt") if not parser.parse(case["text"]).refused]


@pytest.mark.skipif(not CASES.exists(), reason="the cases are not here")
def test_service_robot(parser: Parser) -> None:
    named: list[bool] = []
    refused: list[bool] = []
    for case in cases("service_robot.jsonl"):
        parse, expected = parser.parse(case["text"]), case["expect"]
        if expected == "refused":
            refused.append(parse.refused is not None)
        else:
            named.append(parse.noun in {expected["noun"], *expected["also_right"]})
    assert np.mean(named) >= 0.93
    assert np.mean(refused) >= 0.95


@pytest.mark.skipif(not CASES.exists(), reason="the cases are not here")
@pytest.mark.parametrize("carrier", ["go to the {}", "bring me the {}", "the {} on the table"])
def test_class_names(parser: Parser, carrier: str) -> None:
    def right(name: str) -> bool:
        parse = parser.parse(carrier.format(name))
        words = (parse.noun or "").split()
        heads = {name.split()[-1], name.split(" of ")[0].split()[-1], name.split(" in ")[0].split()[-1]}
        return parse.color is None and bool(words) and any(same(words[-1], head) for head in heads)

    def same(word: str, head: str) -> bool:
        return word == head or head in {f"{word}s", f"{word}es", f"{word[:-1]}ies", f"{word[:-1]}ves"}

    names = [case["text"].lower() for case in cases("class_names.txt")]
    assert np.mean([right(name) for name in names]) >= 0.97
