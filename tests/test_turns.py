"""What people say in turns and mend while they speak: commands that we wrote, at a table, with the shipped model."""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch import Percept

TABLE = [
    Percept("mug", "mug", "white", (0.9, 0.3, 0.8), (0.09, 0.09, 0.1)),
    Percept("bowl", "bowl", "green", (0.8, -0.3, 0.78), (0.17, 0.17, 0.07)),
    Percept("large plate", "plate", "purple", (0.9, 0.0, 0.76), (0.3, 0.3, 0.03)),
    Percept("small plate", "plate", "white", (0.95, 0.55, 0.76), (0.14, 0.14, 0.02)),
    Percept("one pear", "pear", "green", (0.9, 0.0, 0.81), (0.07, 0.07, 0.08)),
    Percept("other pear", "pear", "green", (0.95, 0.55, 0.8), (0.07, 0.07, 0.08)),
    Percept("tall glass", "glass", "blue", (1.1, 0.2, 0.84), (0.07, 0.07, 0.2)),
    Percept("short glass", "glass", "blue", (1.1, -0.2, 0.8), (0.07, 0.07, 0.12)),
    Percept("knife", "knife", "silver", (0.7, 0.5, 0.75), (0.2, 0.03, 0.02)),
    Percept("tape", "tape measure", "yellow", (0.7, -0.5, 0.77), (0.07, 0.07, 0.06)),
    Percept("marker", "marker", "black", (1.0, -0.5, 0.76), (0.02, 0.14, 0.02)),
    Percept("salt", "salt shaker", "gray", (0.8, 0.7, 0.78), (0.04, 0.04, 0.09)),
]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("A: go to the bowl. B: got it. A: now the knife, take that.", {"knife"}),
        ("Human: do you see the mug? Robot: yes. Human: good. Bring me the salt", {"salt"}),
        ("user: find the bowl. robot: ok. user: now hand me the marker", {"marker"}),
        ("I need a spoon. Forget the spoon, pass me the knife", {"knife"}),
        ("Take the mug. No, I don't need a mug. A glass! The tall glass.", {"tall glass"}),
        ("never mind the bowl, bring the salt", {"salt"}),
        ("give me the mug... er, the bowl", {"bowl"}),
        ("pick up the knife - um, the marker", {"marker"}),
        ("get the pear on the bowl, sorry, the small plate", {"other pear"}),
        ("the pear on the plate... the big plate I mean", {"one pear"}),
        ("There are two plates. Bring the pear on the white one.", {"other pear"}),
        ("you see the plates? on the bigger one there's a pear, take it", {"one pear"}),
        ("the glass, but the short one", {"short glass"}),
        ("There are two glasses. The tall one is empty, fill it", {"tall glass"}),
        ("same again with the knife", {"knife"}),
        ("pear, small plate", {"other pear"}),
        ("the marker pen nearest to you", {"marker"}),
        ("something to write with", {"marker"}),
        ("hand me the measuring thing", {"tape"}),
        ("I want something I can cut with", {"knife"}),
        ("all the fruits please", {"one pear", "other pear"}),
        ("the plate next of the salt", {"small plate"}),
        ("where is the pear? ah, on the small plate. bring it", {"other pear"}),
        ("is the mug clean? then I'll take that one", {"mug"}),
        ("this is a purple plate. the plate has a pear on it", {"large plate"}),
        ("go to the mug. Next to it there is a glass, I want that", {"tall glass"}),
        ("there is a small plate. on it there is a pear. to its left there is a salt shaker", {"small plate"}),
        ("the taller glass of the two beyond the plates", {"tall glass"}),
        ("the pear on the small plate and not on the large one", {"other pear"}),
        ("My sister bought that mug, hand it to me", {"mug"}),
    ],
)
def test_the_last_word_counts(text: str, ids: set[str]) -> None:
    assert meant(text, TABLE, looked=True) == ids


@pytest.mark.parametrize(
    "text", ["that's great, thanks, you did well today", "got it", "well done, thanks for your help"]
)
def test_praise_and_answers_are_no_orders(text: str) -> None:
    from dcg_torch.language import parse_command

    assert parse_command(text).refused
