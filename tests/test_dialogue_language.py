"""Commands as people say them to somebody: corrections, what is there, what later sentences say. We wrote them."""

from __future__ import annotations

import pytest
from test_language_references import Relations, described

from dcg_torch.language import parse_command


@pytest.mark.parametrize(
    ("text", "color", "noun"),
    [
        ("Grab the mug on my left, no wait, the red one.", "red", "mug"),
        ("Take the yellow cube. Sorry, I meant the yellow ball.", "yellow", "ball"),
        ("Go to the cone, no, to the cube.", None, "cube"),
        ("Pick up the plate - actually, make that the bowl.", None, "bowl"),
        ("Bring me the red book. No, not the red one, the blue one.", "blue", "book"),
        ("Take the box on the table. Scratch that, take the bag.", None, "bag"),
        ("Could you bring it to me? The mug, I mean, the white one.", "white", "mug"),
        ("Let's take a green thing, the ball.", "green", "ball"),
        ("Take the mug. No, put it on the shelf.", None, "mug"),
        ("Put the cube on the table, no, the ball.", None, "ball"),
        ("Take the red cup. No, the blue one. Sorry, the white one.", "white", "cup"),
        ("Take the cup from the sink, no, the plate.", None, "plate"),
    ],
)
def test_a_correction_replaces_what_was_said(text: str, color: str | None, noun: str) -> None:
    parse = parse_command(text)
    assert (parse.color, parse.noun) == (color, noun)


@pytest.mark.parametrize(
    ("text", "noun", "relations"),
    [
        ("Grab the mug on the left, no wait, on the right.", "mug", [("on", "right")]),
        ("Take the cup by the lamp, no, behind it.", "cup", [("behind", "lamp")]),
        ("On the shelf, the cup.", "cup", [("on", "shelf")]),
        ("We need a torch. It should be lying by the vise.", "torch", [("by", "vise")]),
        ("Do you see the shelf? There's a cup on it. Bring me that cup.", "cup", [("on", "shelf")]),
        ("You know the bowl? Well, next to it is a spoon, and I'd like the spoon.", "spoon", [("next to", "bowl")]),
        ("I left my tape on the tin. Can u get the measuring tape?", "measuring tape", [("on", "tin")]),
        ("It is a chair. It is pushed up to the desk, there is another one by the door.", "chair", [("to", "desk")]),
        ("A cup sits on the shelf. That cup please.", "cup", [("on", "shelf")]),
        ("Of the two lamps, the one nearest the window.", "lamp", [("closest to", "window")]),
        ("Looking at the sofa, the pillow on the right.", "pillow", [("on", "right")]),
        ("The door on the left side when you are looking at both.", "door", [("on", "left")]),
    ],
)
def test_what_other_sentences_say_of_a_thing(text: str, noun: str, relations: Relations) -> None:
    found = described(text)
    assert found[0] == noun
    assert found[2] == relations


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("hey buddy, clean the pan, would ya?", "pan"),
        ("Move the block, thanks a lot.", "block"),
        ("why don't you take the cube", "cube"),
        ("would you mind handing me the wrench?", "wrench"),
        ("take a look at the painting", "painting"),
        ("please hand over the wrench", "wrench"),
        ("i am now holding the plate so please you give me the fork", "fork"),
        ("swivel chair", "swivel chair"),
        ("monitor right of the laptop", "monitor"),
    ],
)
def test_manners_are_no_part_of_an_order(text: str, noun: str) -> None:
    assert parse_command(text).noun == noun


@pytest.mark.parametrize("text", ["good job!! that looks really nice now", "That's perfect.", "thanks a lot"])
def test_praise_orders_nothing(text: str) -> None:
    assert parse_command(text).refused is not None


def test_a_coloured_part_gives_the_colour() -> None:
    assert parse_command("screwdriver, red handle").color == "red"
    assert parse_command("the pot with a blue lid").color == "blue"
    assert parse_command("the cube with a blue ball").color is None


@pytest.mark.parametrize(
    ("text", "verb", "noun"),
    [
        ("My grandmother gave us that painting. Could you bring it?", "bring", "painting"),
        ("Our neighbour sold me the red lamp, take it upstairs.", "take", "lamp"),
        ("I was reading; hand me the book.", "hand", "book"),
        ("We bought a new lamp yesterday. Take it to the bedroom.", "take", "lamp"),
        ("The red mug was a present. Bring it here.", "bring", "mug"),
        ("She dropped her keys, fetch them.", "fetch", "key"),
        ("There is a cup on the shelf. Take it.", "take", "cup"),
        ("The vase that held the flowers, bring it.", "bring", "vase"),
        ("Take the cup placed on the table.", "take", "cup"),
        ("Take the piece shaped like a letter.", "take", "piece"),
    ],
)
def test_what_was_done_is_no_order_and_names_what_the_order_is_about(text: str, verb: str, noun: str) -> None:
    (reading, *_) = parse_command(text).readings
    assert (reading.tree.phrase.words[0], parse_command(text).noun) == (verb, noun)


@pytest.mark.parametrize(
    ("text", "noun", "relations"),
    [
        ("Go to the kitchen table and pick up the cup that's on it.", "cup", [("on", "kitchen table")]),
        ("Take what's on the table.", None, [("on", "table")]),
        ("Whatever is standing between the lamp and the bed.", None, [("between", "lamp"), ("between", "bed")]),
    ],
)
def test_what_is_told_by_where_it_is(text: str, noun: str | None, relations: Relations) -> None:
    found = described(text)
    assert found[0] == noun
    assert found[-1] == relations


def test_where_one_turns_to_says_how_sides_are_seen() -> None:
    tree = parse_command("Turn to the sofa and take the plant on your left.").readings[0].tree
    assert [(child.phrase.words, child.phrase.noun) for child in tree.children][-1] == (("facing",), None)
    assert tree.children[-1].children[0].phrase.noun == "sofa"


def test_a_question_what_stands_somewhere_stays_a_question() -> None:
    assert parse_command("What's standing between the lamp and the bed?").refused == "it is a question"
