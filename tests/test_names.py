from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import noun_table
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from name_pairs import MEANT, NOT_MEANT
from noun_table import fit_weights, make_table

from dcg_torch.grounding.features.name_facts import fact_odds
from dcg_torch.names import embedding
from dcg_torch.names.evidence import FORMS, KINDS, evidence
from dcg_torch.names.normal_form import DATA as DATA_FOLDER
from dcg_torch.names.normal_form import normalise, read_data, singular
from dcg_torch.names.weights import fact_weights, log_odds
from dcg_torch.names.wordnet import nouns

NAMES = [name for pair in MEANT + NOT_MEANT for name in pair]


@pytest.mark.parametrize(
    ("written", "normal"),
    [
        (("Cube", "CUBE", "cube", "cubes", " cube "), "cube"),
        (("CoffeeTable", "coffee_table", "coffee-tables", "COFFEE TABLE", "Coffee  Table"), "coffee table"),
        (("grey", "Gray", "GREY"), "gray"),
        (("Light-Grey", "lightGray"), "light gray"),
        (("TVStand", "tv_stand"), "tv stand"),
        (("bottles of wine", "Bottle_of_wine"), "bottle of wine"),
        (("wine glasses", "WineGlass"), "wine glass"),
        (("reading glasses",), "reading glasses"),
        (("knives",), "knife"),
        (("bus", "buses"), "bus"),
        (("cube3", "Cube 3", "cube_3"), "cube 3"),
        (("cubes 3",), "cube 3"),
        (("scissors",), "scissors"),
        (("tyre",), "tire"),
    ],
)
def test_one_name_has_one_normal_form(written: tuple[str, ...], normal: str) -> None:
    assert {normalise(one) for one in written} == {normal}


@given(st.text(max_size=40))
def test_normalising_twice_changes_nothing(name: str) -> None:
    assert normalise(normalise(name)) == normalise(name)


def test_a_name_without_letters_stays() -> None:
    assert (normalise(" ?! "), normalise("")) == ("?!", "")


@given(st.sampled_from(["lens", "dish", "glass", "gas", "iris", "person", "watch", "fox", "cherry", "cake", "shelf"]))
def test_a_singular_stays(noun: str) -> None:
    assert singular(noun) == noun


@pytest.mark.parametrize(
    ("noun", "name", "form", "kind"),
    [
        ("sofa", "Sofas", "name: equal", "kind: everyday"),
        ("coffee table", "CoffeeTable", "name: equal", "kind: everyday"),
        ("glass bottle", "glassbottle", "name: equal", "kind: everyday"),
        ("zorp", "Zorp", "name: equal", "kind: everyday"),
        ("headphone", "head_phones", "name: equal", "kind: everyday"),
        ("scissor", "scissors", "name: equal", "kind: everyday"),
        ("glass", "glasses", "name: none", None),
        ("head of lettuce", "lettuce", "name: class is head", None),
        ("bar of soap", "SoapBar", "name: word", "kind: everyday"),
        ("bottle of wine", "wine bottle", "name: equal", "kind: everyday"),
        ("cube", "cube3", "name: head", None),
        ("cube 3", "cube_3", "name: equal", "kind: everyday"),
        ("cube 2", "cube_3", "name: same head", None),
        ("zorp", "blick", "name: none", "kind: strange"),
        ("wine glass", "glass", "name: class is head", None),
        ("tire pallet", "tire assembly pallet", "name: part", None),
        ("coffee table", "kitchen table", "name: same head", None),
        ("pepper", "pepper shaker", "name: word", None),
        ("door knob", "door", "name: class is word", None),
        ("soap bar", "soap bottle", "name: shared word", None),
        ("couch", "sofa", "name: none", "kind: everyday"),
        ("tool", "power drill", "name: none", "kind: everyday"),
        ("chair", "armchair", "name: head", "kind: class is kind"),  # written as one word, it is a compound as well
        ("armchair", "chair", "name: class is head", "kind: noun is kind"),
        ("berry", "strawberry", "name: head", None),
        ("bag", "handbag", "name: head", "kind: same"),
        ("pan", "dustpan", "name: none", "kind: apart"),  # no pan, whatever its letters say
        ("table", "vegetable", "name: none", None),
        ("apple", "pineapple", "name: none", "kind: sibling"),
        ("seat", "folding chair", "name: none", "kind: everyday"),
        ("jewel", "gem", "name: none", "kind: same"),
        ("dagger", "weapon", "name: none", "kind: noun is kind"),
        ("weapon", "dagger", "name: none", "kind: class is kind"),
        ("jacket", "garment", "name: none", "kind: noun is far kind"),
        ("garment", "jacket", "name: none", "kind: class is far kind"),
        ("apple", "pear", "name: none", "kind: sibling"),
        ("leather settee", "sofa", "name: none", "kind: head everyday"),
        ("spoon", "ladder", "name: none", "kind: apart"),
        ("honey jar", "honey", "name: class is head", "kind: strange"),
        ("honey jar", "jar", "name: class is head", "kind: strange"),
        ("counter", "kitchen counter", "name: head", "kind: class is kind"),  # and not two names of one thing
        ("cabinet", "filing cabinet", "name: head", "kind: class is far kind"),  # both are made
        ("machine", "washing machine", "name: head", "kind: class is far kind"),
        ("horse", "sea horse", "name: head", "kind: apart"),
        ("butter", "peanut butter", "name: head", "kind: apart"),
        ("toilet roll", "toilet", "name: class is word", "kind: apart"),  # and no slice of one
        ("banana piece", "banana", "name: class is head", "kind: same"),
    ],
)
def test_facts(noun: str, name: str, form: str, kind: str | None) -> None:
    found = evidence(noun, name)
    assert found[0] == form
    assert kind is None or found[1] == kind


def test_a_generic_noun_tells_nothing_of_the_kind() -> None:
    assert evidence("thing", "lamp") == evidence("object", "sofa") == ("name: generic",)


@given(st.sampled_from(NAMES), st.sampled_from(NAMES))
def test_facts_turn_round_with_the_pair(one: str, other: str) -> None:
    turned = {
        "name: head": "name: class is head",
        "name: word": "name: class is word",
        "kind: noun is kind": "kind: class is kind",
        "kind: noun is far kind": "kind: class is far kind",
        "kind: head noun is kind": "kind: head class is kind",
    }
    turned |= {there: here for here, there in turned.items()}
    forth, back = evidence(one, other), evidence(other, one)
    assert forth[0] in FORMS
    assert forth[1:] == () or forth[1] in KINDS
    if forth[0] not in ("name: word", "name: class is word"):  # each head may be a word of the other name
        assert back[0] == turned.get(forth[0], forth[0])
    exact = ("kind: everyday", "kind: same", "kind: noun is far kind", "kind: sibling", "kind: strange")
    if forth[1] in exact:
        assert back[1] == turned.get(forth[1], forth[1])


def test_weights_tell_meant_from_not_meant() -> None:
    meant = np.array([log_odds(*pair) for pair in MEANT])
    other = np.array([log_odds(*pair) for pair in NOT_MEANT])
    wins = (meant[:, None] > other).mean() + 0.5 * (meant[:, None] == other).mean()
    assert wins > 0.93
    assert (meant > 0.0).mean() > 0.9
    assert (other < 0.0).mean() > 0.8


def test_an_equal_name_comes_before_every_other() -> None:
    for noun in ("bottle", "phone", "cone", "lamp", "chair", "box", "couch"):
        assert all(log_odds(noun, noun) > log_odds(noun, n) for n in {*NAMES, "cell phone"} if normalise(n) != noun)


@pytest.mark.parametrize(
    ("noun", "narrower"),
    [("chair", "office chair"), ("table", "coffee table"), ("cabinet", "file cabinet"), ("counter", "kitchen counter")],
)
def test_what_is_called_so_with_a_word_before_it_may_be_meant_as_well(noun: str, narrower: str) -> None:
    """Who says "chair" means a chair rather than an office chair; but where other words say which, they outweigh it."""
    odds = fact_odds()
    exact, head = (sum(odds[f"said {fact}"] for fact in evidence(noun, name)) for name in (noun, narrower))
    assert math.log(2.0) < exact - head < math.log(30.0)


def test_the_shipped_weights_are_those_of_the_lessons() -> None:
    lessons = read_data("nouns.yaml")
    assert fit_weights(lessons["classes"], lessons["nouns"]) == pytest.approx(fact_weights(), abs=0.011)


def test_the_pairs_of_the_tests_taught_nothing() -> None:
    lessons = read_data("nouns.yaml")["nouns"]
    assert not [pair for pair in MEANT + NOT_MEANT if normalise(pair[1]) in lessons.get(pair[0], [])]


def test_the_weights_of_a_made_up_world() -> None:
    """Where the same word always names the class, being equal is what tells; its weight is the greatest."""
    classes = ["apple", "fork", "lamp"]
    weights = fit_weights(classes, {name: [name] for name in classes})
    assert weights["name: equal"] > 0.0 > weights["name: none"]
    assert weights["name: head"] == 0.0


def test_what_is_a_kind_of_what() -> None:
    table = nouns()
    assert table.senses("chair", 1)[0] in table.kinds(table.senses("armchair", 1)[0])
    assert table.senses("zorp") == ()
    assert "sofa" in nouns()
    assert "zorp" not in nouns()


def test_senses_share_words() -> None:
    table = nouns()
    assert table.senses("sofa", 1) == table.senses("couch", 1)


DATA = """  1 a licence line
00000010 03 n 01 thing 0 001 ~ 00000020 n 0000 | all there is
00000020 06 n 02 seat 0 sitting_place 1 001 @ 00000010 n 0000 | to sit on
00000030 06 n 01 arm-chair 0 002 @ 00000020 n 0000 + 00000099 v 0101 | with arms
00000040 18 n 01 Chippendale 0 001 @i 00000010 n 0000 | a maker
00000050 09 n 01 comfort 0 000 | a feeling
00000060 18 n 01 chair 0 001 @ 00000010 n 0000 | who presides
"""
INDEX = """  1 a licence line
thing n 1 1 ~ 1 0 00000010
seat n 1 1 @ 1 0 00000020
arm-chair n 2 1 @ 2 0 00000030 00000060
arm_chair n 1 1 @ 1 0 00000030
chippendale n 1 1 @i 1 0 00000040
comfort n 1 0 1 0 00000050
"""


def test_a_table_is_made(tmp_path: Path) -> None:
    """Persons come last or not at all, single persons and feelings never, and both spellings are one noun."""
    path = tmp_path / "nouns.npz"
    np.savez_compressed(path, allow_pickle=False, **make_table(DATA, INDEX))
    table = type(nouns())(path)
    assert len(table) == 3
    assert table.kinds(table.senses("arm chair", 1)[0]) == table.senses("seat")
    assert table.ancestors(table.senses("arm chair")[0], 2).keys() >= set(table.senses("thing"))
    assert len(table.senses("arm chair")) == 1
    assert "comfort" not in table
    assert "chippendale" not in table


def test_no_dictionary_is_one_line(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, noun_table.__file__, str(tmp_path)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert str(tmp_path) in done.stderr
    assert done.stderr.count("\n") == 1


def test_the_notice_of_wordnet_comes_along() -> None:
    notice = (DATA_FOLDER / "WORDNET_LICENSE").read_text(encoding="utf-8")
    assert "Copyright 2006 by Princeton University" in notice


@pytest.mark.slow
@pytest.mark.skipif(not embedding.is_installed(), reason="the extra `embeddings` is not installed")
def test_the_embedding_knows_near_words() -> None:
    near, far, own = embedding.cosines("couch", ["sofa", "hammer", "couch"])
    assert far < near < own == pytest.approx(1.0, abs=1e-5)
    assert np.linalg.norm(embedding.embed(["a", "b", "a"]), axis=1) == pytest.approx([1.0, 1.0, 1.0], abs=1e-5)


def test_without_the_extra_one_line_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    embedding._model.cache_clear()
    with pytest.raises(embedding.EmbeddingMissing, match=r"install dcg-torch\[embeddings\]"):
        embedding.embed(["a"])
