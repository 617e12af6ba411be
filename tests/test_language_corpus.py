"""The language room on a corpus of human commands, where it is at hand."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from dcg_torch.language import default_parser, target_phrase
from dcg_torch.language.colors import normal_color

CORPUS = Path(__file__).parents[2] / "shared" / "data" / "train_robots.jsonl"


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus is not here")
@pytest.mark.parametrize("step", [4, pytest.param(1, marks=pytest.mark.slow)], ids=["every-fourth-row", "all-rows"])
def test_noun_and_color_agree_with_the_annotators(step: int) -> None:
    parser = default_parser()
    rows = [json.loads(line) for line in CORPUS.read_text(encoding="utf-8").splitlines()][::step]
    agreed = rows_with_both = attached = 0
    for row in rows:
        gold, parse = row["gold"], parser.parse(row["text"])
        assert parse.tree is not None, row["text"]
        attached += bool(gold["relations"]) == bool(target_phrase(parse.tree).children)
        if gold["noun"] and gold["color"]:
            # "blue - sky" is how the annotators noted the words "blue-sky".
            color = "sky blue" if gold["color"] == "blue - sky" else normal_color(gold["color"])
            rows_with_both += 1
            agreed += (parse.noun, parse.color) == (gold["noun"], color)
    assert rows_with_both > 0
    assert agreed / rows_with_both >= 0.99
    assert attached / len(rows) >= 0.98
