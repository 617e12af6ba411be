"""Which of several orders names the object meant, and which words are orders. These commands were written for this
project."""

from __future__ import annotations

import pytest

from dcg_torch.language import parse_command, target_phrase


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("go to the kitchen and take the cup", "kitchen"),  # the first order leads
        ("go to the bathroom, then take the towel", "towel"),
        ("go to the bathroom then take the towel", "towel"),
        ("navigate to the shelf, pick up the chips and hand them to Maria", "chip"),
        ("enter the hall and go to the desk and take the cup", "cup"),
        ("walk to the fridge, then take a few steps to the right. take the egg.", "egg"),
        ("go to the bathroom and water the plant", "plant"),
        ("drive the jeep over to the mast", "jeep"),
        ("drive over to the mast", "mast"),
    ],
)
def test_of_several_orders_one_names_what_is_meant(text: str, noun: str) -> None:
    assert parse_command(text).noun == noun


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("water the plant by the door", "plant"), ("vacuum the rug", "rug"), ("iron the shirt", "shirt"),
        ("dust this shelf", "shelf"), ("cube that has a ball on it", "cube"),
        ("water by the door", "water"), ("iron on the shelf", "iron"), ("painting", "painting"), ("drawing", "drawing"),
        ("the drawing", "drawing"),
    ],
)  # fmt: skip
def test_a_verb_is_followed_by_what_it_handles(text: str, noun: str) -> None:
    assert parse_command(text).noun == noun


@pytest.mark.parametrize("text", ["follow me to the kitchen", "come with me to the car", "please follow me"])
def test_to_follow_is_no_order_about_a_thing(text: str) -> None:
    assert parse_command(text).refused is not None


def test_the_row_is_closest_and_not_what_is_in_it() -> None:
    tree = parse_command("the mug in the row closest to you").tree
    assert tree is not None
    (row,) = target_phrase(tree).children
    assert [below.phrase.words for below in row.children[0].children] == [("closest to",)]


def test_whom_to_follow_is_one() -> None:
    assert parse_command("follow the man to the door").noun == "man"
