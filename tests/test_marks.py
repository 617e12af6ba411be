"""Things are called by what is written or printed on them. The commands are ours, no person's."""

from __future__ import annotations

import random
from collections.abc import Collection
from types import SimpleNamespace
from typing import Any

import pytest
from asked import grounded

from dcg_torch import GroundingModel, pretrained
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.protocol import answers
from dcg_torch.grounding.features.names import word_features
from dcg_torch.interpretation.marks import heard
from dcg_torch.language import default_parser, parse_command
from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.names.marks import marks_of
from dcg_torch.types import Percept, Phrase, PhraseKind, Pose

LOGOS = ["adidas", "BMW", "Burger King", "Coca Cola", "Heineken", "HP", "McDonalds", "Mercedes Benz", "Shell", "SRI",
         "Starbucks", "Stella Artois", "Target", "Twitter", "UPS"]  # fmt: skip
DIGITS = [str(k) for k in range(1, 16)]
SHAPES = ["T", "L", "X", "W", "Z", "I", "U", "P"]
STYLES = ["brand", "class", "class behind", "bare"]


def _places(count: int) -> list[tuple[float, float]]:
    draw, found = random.Random(3), list[tuple[float, float]]()
    while len(found) < count:
        x, y = draw.uniform(0.5, 2.0), draw.uniform(-1.0, 1.0)
        if all((x - a) ** 2 + (y - b) ** 2 > 0.05 for a, b in found):
            found.append((x, y))
    return found


def _board(marks: list[str], style: str, text: str) -> Episode:
    objects = []
    for mark, (x, y) in zip(marks, _places(len(marks)), strict=True):
        thing: dict[str, object] = {"id": mark, "type": "block", "position": [x, y, 0.076], "size": 0.152}
        if style == "class":
            thing["type"] = f"{mark} block".lower()
        elif style == "class behind":
            thing["type"] = f"block_{mark.lower().replace(' ', '_')}"
        elif style == "bare":
            thing["type"] = mark
        else:
            thing[style] = mark
        objects.append(thing)
    robot = {"x": 0.0, "y": 0.0, "yaw": 0.0}
    return Episode.model_validate({"id": "a", "text": text, "objects": objects, "target": [], "robot": robot})


def _meant(model: GroundingModel, episode: Episode) -> tuple[set[str], float]:
    (answer,) = answers(model, [episode], default_parser().parse)
    return set(answer.predicted), answer.probability or 0.0


@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("Move the Adidas block to the right of the BMW block.", "adidas"),
        ("Shell should be one block width to the left of Target", "Shell"),
        ("the Stella block goes on the left of Shell", "Stella Artois"),
        ("twitter to the left of target please", "Twitter"),
        ("pick up the mercedes-benz cube", "Mercedes Benz"),
        ("Place the block with the Shell logo beneath the block with the Target logo", "Shell"),
        ("the one that says UPS", "UPS"),
        ("Line up Target with BMW", "Target"),
        ("mcdonald's needs to go up two spaces", "McDonalds"),
        ("Put Coke above BMW.", "Coca Cola"),
        ("BMW -> right of SRI", "BMW"),
        ("Set burgerking's block under HP", "Burger King"),
        ("Move the starbuck block to the right of HP", "Starbucks"),
        ("UPS!", "UPS"),
        ("next to BMW goes Twitter", "Twitter"),
        ("I would like the Target block to be put above HP", "Target"),
        ("not Shell, Target please", "Target"),
    ],
)
def test_logos(model: GroundingModel, style: str, text: str, meant: str) -> None:
    found, probability = _meant(model, _board(LOGOS, style, text))
    assert found == {meant}
    assert probability > 0.6


@pytest.mark.parametrize("style", [*STYLES, "number"])
@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("Move block 3 below block 5", "3"),
        ("put 7 to the left of 9", "7"),
        ("Take the number 12 block and place it above 4", "12"),
        ("move block number nine up one space", "9"),
        ("move one to the left of two", "1"),
        ("put the twelve block under the six block", "12"),
        ("Eleven goes above three", "11"),
        ("move block #8 to the top", "8"),
        ("Move the block labeled 15 one block length north of 13", "15"),
        ("Take 14, put it at the bottom right corner", "14"),
        ("5 up", "5"),
        ("Move blocks 3 and 11 to the left", "3 11"),
        ("block 25 goes up", ""),
        ("no. 7 left of no. 8", "7"),
        ("pick up the three", "3"),
        ("two should be between three and four", "2"),
        ("block 1 north east of block 9 with a little gap", "1"),
    ],
)
def test_digits(model: GroundingModel, style: str, text: str, meant: str) -> None:
    assert _meant(model, _board(DIGITS, style, text))[0] == set(meant.split())


@pytest.mark.parametrize("style", ["shape", "class", "bare"])
@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the T", "T"),
        ("the w shaped one", "W"),
        ("take the letter P", "P"),
        ("the plus", "X"),
        ("the cross next to the snake", "X"),
        ("the piece shaped like a letter U", "U"),
        ("the stairs", "W"),
        ("I would like the long bar", "I"),
        ("grab a Z", "Z"),
    ],
)
def test_shapes(model: GroundingModel, style: str, text: str, meant: str) -> None:
    assert _meant(model, _board(SHAPES, style, text))[0] == {meant}


def test_what_no_block_bears_is_not_there(model: GroundingModel) -> None:
    found, probability = _meant(model, _board(LOGOS, "brand", "move the Pepsi block up a bit"))
    assert not found
    assert probability > 0.2


def test_marks_fire_no_features_of_their_own(model: GroundingModel) -> None:
    phrase = Phrase(PhraseKind.NOUN, "the Shell block", ("second", "brand: shell"), "block")
    assert not [name for _, name in word_features(phrase) if "shell" in name]


def test_counts_and_measures_are_no_names() -> None:
    things = _board(DIGITS, "digit", "").percepts()

    def stated(text: str) -> set[str]:
        tree = heard(default_parser().parse, text, (), things).tree
        return {word for node in tree.walk() for word in node.phrase.words if ":" in word} if tree else set()

    assert stated("move the two blocks on the left") == set()
    assert stated("slide the leftmost block 3 spaces to the right") == set()
    assert stated("take the red one") == set()
    assert stated("take the three in the back") == set()
    assert stated("There are two blocks on the left. Take the two") == set()
    assert stated("move it two block lengths above seven") == {"digit: 7"}


def test_texts_without_marks_are_read_as_ever() -> None:
    for text in ("pick up the block on the left", "target the shell", "go to the two cubes behind the five cones"):
        assert heard(parse_command, text, ("cube",), []) == parse_command(text, ("cube",))
    things = _board(LOGOS, "brand", "").percepts()
    for text in ("pick up the leftmost block", "the block in the corner", "go to the one behind the two others"):
        assert heard(parse_command, text, (), things) == parse_command(text, ())


def test_what_stands_for_marks_is_not_seen() -> None:
    things = _board(LOGOS, "brand", "").percepts()
    read = heard(parse_command, "put the Target block on Shell", (), things)
    assert "quorb" not in repr(read)
    assert read.noun == "block"
    draw, words = (
        random.Random(1),
        f"{' '.join(LOGOS)} the and should : row 3 one left of it is block blocks put".split(" "),
    )
    for _ in range(200):
        text = " ".join(draw.choice(words) for _ in range(draw.randint(0, 10)))
        read = heard(parse_command, text, (), things)
        assert read.text == text
        assert "quorb" not in repr(read)


def test_looks_are_no_marks() -> None:
    given = ["material: wood", "orientation: left", "shirt: red", "beard: no", "size: big"]
    assert marks_of([("chair", frozenset({attribute})) for attribute in given]) is None
    assert marks_of([("floor lamp", frozenset()), ("table lamp", frozenset()), ("sofa", frozenset())]) is None


def test_evidence_of_marks() -> None:
    shell, target, plain = frozenset({"brand: Shell"}), frozenset({"brand: Target"}), frozenset({"size: big"})
    found = [attribute_evidence(("brand: shell|hp",), given) for given in (shell, target, plain)]
    assert found == [("attribute: equal",), ("attribute: contrary",), ("attribute: silent",)]
    assert attribute_evidence(("not brand: shell",), shell) == ("attribute: contrary",)


def test_a_text_with_what_stands_for_marks_is_read_as_it_is() -> None:
    marks = [frozenset({f"label: m{k}"}) for k in range(3)]
    things = [Percept(f"o{k}", "block", None, (2.0, float(k), 0.0), attributes=mark) for k, mark in enumerate(marks)]
    model = pretrained()
    world = model.world_model(things, Pose(0.0, 0.0), looked=True)
    assert model.ground("take the quorba and quorbz", world).tree is not None


BRANDS = ("Shell", "Pepsi", "BMW")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the block that is not pepsi and not bmw", {"o0"}),
        ("the big block that is not shell and not pepsi", {"o2"}),
        ("the shell block", {"o0"}),
    ],
)
def test_marks_that_are_denied(text: str, meant: set[str]) -> None:
    things = [
        Percept(f"o{k}", "block", None, (2.0, float(k), 0.0), (0.2,) * 3, attributes=frozenset({f"brand: {brand}"}))
        for k, brand in enumerate(BRANDS)
    ]
    answer = grounded(text, things, looked=True)
    assert {o.id for o in answer.objects} == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("row 2 column 3", {"o6"}),
        ("the red ones", {"o0", "o3", "o6", "o9"}),
        ("two to the right of block 1", {"o2"}),
        ("block 7", {"o6"}),
        ("the blocks that are not red", {f"o{k}" for k in range(12) if k % 3}),
        ("every block except the red ones", {f"o{k}" for k in range(12) if k % 3}),
    ],
)
def test_numbers_that_are_marks_and_numbers_that_count(text: str, meant: set[str]) -> None:
    colors = ("red", "blue", "green")
    things = [
        Percept(
            f"o{k}", "block", colors[k % 3], (5.0 - k // 4, 1.5 - k % 4, 0.0), attributes=frozenset({f"digit: {k + 1}"})
        )
        for k in range(12)
    ]
    answer = grounded(text, things, looked=True)
    assert {o.id for o in answer.objects} == meant


def test_a_parser_of_ones_own_need_not_give_dataclasses() -> None:
    brands = [frozenset({f"brand: {brand}"}) for brand in BRANDS]
    things = [Percept(f"o{k}", "block", None, (2.0, float(k), 0.0), attributes=own) for k, own in enumerate(brands)]

    asked: list[str] = []

    def parse(text: str, vocabulary: Collection[str]) -> Any:
        asked.append(text)
        return SimpleNamespace(text=text, readings=(object(),), problem=None)

    heard(parse, "take the shell block", (), things)
    assert asked[-1] == "take the shell block"


NAMES = ("Shell", "Target", "Pepsi", "BMW", "Mark", "Will")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("mark the pepsi block", "Pepsi"),
        ("please mark pepsi", "Pepsi"),
        ("I want you to mark the BMW block", "BMW"),
        ("target the shell block", "Shell"),
        ("will you move shell to the left", "Shell"),
        ("Shell. Mark the BMW block.", "BMW"),
        ("Target to the left of Shell", "Target"),
        ("Mark goes above BMW", "Mark"),
        ("put target next to mark", "Target"),
        ("take the mark block", "Mark"),
        ("Will should be left of BMW", "Will"),
    ],
)
def test_a_mark_that_is_a_verb_as_well_is_the_verb_where_the_verb_stands(
    model: GroundingModel, text: str, meant: str
) -> None:
    assert meant in _meant(model, _board(list(NAMES), "brand", text))[0]


@pytest.mark.parametrize("text", ["block 7", "block 007", "take 07", "the block number seven"])
@pytest.mark.parametrize("digits", [1, 3])
def test_a_number_is_the_same_with_zeros_before_it(model: GroundingModel, text: str, digits: int) -> None:
    marks = [f"{k:0{digits}}" for k in range(1, 10)]
    assert _meant(model, _board(marks, "digit", text))[0] == {marks[6]}


def test_no_mark_of_a_text_is_dropped(model: GroundingModel) -> None:
    marks = [str(k) for k in range(1, 41)]
    text = f"take the blocks {', '.join(marks[:-2])} and {marks[-2]}"
    assert _meant(model, _board(marks, "digit", text))[0] == set(marks[:-1])


@pytest.mark.parametrize("mark", ["7Up", "3M", "Route 66", "4K"])
def test_names_with_numbers_in_them(model: GroundingModel, mark: str) -> None:
    assert _meant(model, _board([mark, "Shell", "BMW", "UPS"], "brand", f"take the {mark} block"))[0] == {mark}


@pytest.mark.parametrize(("type_", "word"), [("piece", "letter: x"), ("block", None)])
def test_letters_of_pieces_are_their_shapes(type_: str, word: str | None) -> None:
    """A piece with the letter X is a plus; on a block it is no more than a letter."""
    marks = marks_of((type_, frozenset({f"letter: {letter}"})) for letter in "XWL")
    assert marks is not None
    found = marks.named(["plus"])
    assert (found.word if found is not None else None) == word


CARDS = [("7", "spades"), ("7", "hearts"), ("2", "clubs"), ("9", "spades"), ("queen", "hearts"), ("queen", "clubs")]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("7 of spades", {"7 spades"}),
        ("turn over the seven of hearts", {"7 hearts"}),
        ("the two of clubs", {"2 clubs"}),
        ("the card to the right of the 9 of spades", {"queen hearts"}),
        ("the queen of hearts and the 9 of spades", {"queen hearts", "9 spades"}),
        ("put the seven of spades on the queen of clubs", {"7 spades"}),
        ("the red seven", {"7 hearts"}),
    ],
)
def test_a_card_is_called_by_its_rank_and_its_suit(model: GroundingModel, text: str, ids: set[str]) -> None:
    objects = [
        {"id": f"{rank} {suit}", "type": "card", "color": "red" if suit == "hearts" else "black",
         "position": [0.5, 0.5 - 0.2 * k, 0.0], "rank": rank, "suit": suit}
        for k, (rank, suit) in enumerate(CARDS)
    ]  # fmt: skip
    robot = {"x": 0.0, "y": 0.0, "yaw": 0.0}
    episode = Episode.model_validate({"id": "a", "text": text, "objects": objects, "target": [], "robot": robot})
    assert _meant(model, episode)[0] == ids
