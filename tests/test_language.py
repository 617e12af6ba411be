"""The language room on sentences written for the project: what is meant, what tells it apart, what is refused."""

from __future__ import annotations

import time

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from language_sentences import DEVELOPMENT, HELD_OUT, Sentence

from dcg_torch.experiment.reading import bearing
from dcg_torch.language import Parse, Parser, target_phrase
from dcg_torch.types import ParseTree, PhraseKind

KNOWN = ("cube", "sphere", "cylinder", "fire hydrant", "pyramid")


def tree_of(parse: Parse) -> ParseTree:
    assert parse.tree is not None, parse.problem
    return parse.tree


def relations(tree: ParseTree) -> tuple[tuple[str, str | None], ...]:
    return tuple(
        (place.phrase.words[0], child.phrase.noun) for place in target_phrase(tree).children for child in place.children
    )


@pytest.mark.parametrize("sentence", DEVELOPMENT, ids=lambda sentence: sentence.text)
def test_sentence(parser: Parser, sentence: Sentence) -> None:
    parse = parser.parse(sentence.text, KNOWN[:3])
    tree = tree_of(parse)
    assert (parse.noun, parse.color) == (sentence.noun, sentence.color)
    assert relations(tree) == sentence.relations


def test_held_out_sentences(parser: Parser) -> None:
    parses = [(parser.parse(sentence.text, KNOWN[:3]), sentence) for sentence in HELD_OUT]
    right = sum((parse.noun, parse.color) == (sentence.noun, sentence.color) for parse, sentence in parses)
    assert right / len(HELD_OUT) >= 0.9


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("go to the cube", ("go",)),
        ("going to the cube", ("go",)),
        ("do not go to the cube", ("go", "not")),
        ("don't go to the cube", ("go", "not")),
        ("you should never go to the cube", ("go", "not")),
        ("pick up the cube", ("pick up",)),
        ("look for the cube", ("look for",)),
        ("could you please find the cube", ("find",)),
        ("I want you to approach the cube", ("approach",)),
        ("the red cube", ()),
    ],
)
def test_root_is_the_verb(parser: Parser, text: str, words: tuple[str, ...]) -> None:
    root = tree_of(parser.parse(text)).phrase
    assert root.kind is PhraseKind.VERB
    assert root.words == words


@pytest.mark.parametrize(
    ("said", "normal"),
    [
        ("to the left of", "left of"), ("on the left of", "left of"), ("left of", "left of"),
        ("on the left side of", "left of"), ("to the right of", "right of"), ("in front of", "in front of"),
        ("next to", "next to"), ("beside", "next to"), ("on top of", "on top of"), ("on the top of", "on top of"),
        ("atop", "on top of"), ("underneath", "under"), ("below", "under"), ("close to", "close to"), ("near", "near"),
        ("near to", "near"), ("behind", "behind"), ("above", "above"), ("nearest to", "closest to"),
        ("closest to", "closest to"), ("that is closest to", "closest to"), ("which is on top of", "on top of"),
        ("sitting on", "on"), ("located behind", "behind"), ("that's standing in front of", "in front of"),
        ("far from", "far from"), ("furthest from", "farthest from"), ("opposite", "opposite"),
    ],
)  # fmt: skip
def test_prepositions_have_one_normal_form(parser: Parser, said: str, normal: str) -> None:
    tree = tree_of(parser.parse(f"find the blue cone {said} the green drill"))
    assert relations(tree) == ((normal, "drill"),)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("go to the leftmost cube", ("leftmost",)),
        ("go to the left most cube", ("leftmost",)),
        ("go to the nearest cube", ("closest",)),
        ("go to the big tall cube", ("big", "tall")),
        ("go to the second cube from the left", ("second", "from the left")),
        ("go to the 3rd cube from the right", ("third", "from the right")),
        ("go to the cube you are holding", ("held",)),
        ("go to the cube that is second from the right", ("second", "from the right")),
        ("go to the cube which is biggest", ("biggest",)),
    ],
)
def test_adjectives_and_ordinals(parser: Parser, text: str, words: tuple[str, ...]) -> None:
    target = target_phrase(tree_of(parser.parse(text))).phrase
    assert (target.noun, target.words) == ("cube", words)


@pytest.mark.parametrize(
    ("text", "count", "plural", "words"),
    [
        ("go to the two cubes", 2, True, ()),
        ("go to all red cubes", None, True, ("all",)),
        ("go to both cubes", 2, True, ("both",)),
        ("find the row of cubes", None, True, ("row",)),
        ("find the stack of blue cubes", None, True, ("stack",)),
        ("go to one of the cubes", 1, False, ("one of",)),
        ("go to the cube", None, False, ()),
    ],
)
def test_number(parser: Parser, text: str, count: int | None, plural: bool, words: tuple[str, ...]) -> None:
    target = target_phrase(tree_of(parser.parse(text))).phrase
    assert (target.noun, target.count, target.plural, target.words) == ("cube", count, plural, words)


@pytest.mark.parametrize(
    ("text", "noun", "color"),
    [
        ("go to the pyramind", "pyramid", None),
        ("go to the hydrent", "hydrant", None),
        ("go to the qube", "cube", None),
        ("go to the grren sphere", "sphere", "green"),
        ("aproach the yelow cylindar", "cylinder", "yellow"),
        ("go to the brick", "brick", None),  # an English word is no misspelling
        ("go to the cane", "cane", None),
        ("go to the dax", "dax", None),  # too short to be sure
    ],
)
def test_spelling(parser: Parser, text: str, noun: str, color: str | None) -> None:
    parse = parser.parse(text, KNOWN)
    assert (parse.noun, parse.color) == (noun, color)


def test_vocabulary_joins_but_does_not_restrict(parser: Parser) -> None:
    assert parser.parse("go to the mail box", ["mailbox"]).noun == "mailbox"
    assert parser.parse("go to the mail box").noun == "mail box"
    assert parser.parse("go to the teapot", ["mailbox"]).noun == "teapot"
    orange = parser.parse("go to the orange", ["orange"])  # the world decides between the two
    assert {target_phrase(reading.tree).phrase.noun for reading in orange.readings} == {None, "orange"}


def test_chain_hangs_on_the_landmark(parser: Parser) -> None:
    target = target_phrase(tree_of(parser.parse("go to the red block on the blue block near the corner")))
    (on,) = target.children
    (landmark,) = on.children
    assert (landmark.phrase.noun, landmark.phrase.color) == ("block", "blue")
    assert [child.phrase.words for child in landmark.children] == [("near",)]


def test_destination_hangs_on_the_verb(parser: Parser) -> None:
    for text in ("place the cone on the cube", "pick up the cone and put it on the cube", "move cone onto cube"):
        tree = tree_of(parser.parse(text))
        assert target_phrase(tree).phrase.noun == "cone"
        assert not target_phrase(tree).children
        assert [child.phrase.kind for child in tree.children] == [PhraseKind.NOUN, PhraseKind.PREPOSITION]
        assert tree.children[1].children[0].phrase.noun == "cube"


def test_two_colors_keep_the_first(parser: Parser) -> None:
    target = target_phrase(tree_of(parser.parse("go to the red and blue block"))).phrase
    assert (target.noun, target.color, target.words) == ("block", "red", ("blue",))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "the command is empty"),
        (" \n\t ", "the command is empty"),
        ("go to the cube " * 45, "the command is longer than 600 characters"),
        ("a b " * 61, "the command is longer than 120 words"),
    ],
)
def test_what_cannot_be_read(parser: Parser, text: str, problem: str) -> None:
    assert parser.parse(text) == Parse(text, problem=problem)


@pytest.mark.parametrize(
    "text", ["!?!", "🤖🔥", "иди к красному кубу", "go forward", "turn left", "say hi", "count the cones", "follow me",
             "is there a cone?", "thanks robot", "wait a moment", "what color is the box?", "i am tired"],
)  # fmt: skip
def test_no_order_about_a_thing_is_refused_with_a_reason(parser: Parser, text: str) -> None:
    parse = parser.parse(text)
    assert parse.refused
    assert parse == Parse(text, problem=parse.refused, refused=parse.refused)


def test_target_phrase_needs_a_noun_phrase(parser: Parser) -> None:
    root = tree_of(parser.parse("go to the cube")).phrase
    with pytest.raises(ValueError, match="no noun phrase"):
        target_phrase(ParseTree(root))


# Hostile input -------------------------------------------------------------------------------------------------------

_WORDS = """
go to the of on and one that is you not red cube , . move left from it all 2 dark don't 's which behind pick closest
most held between same ' " - ; DROP TABLE <b> {{7*7}} 🤖 куб 立方体 ﷽ ½ ²
"""
_PIECES = st.sampled_from([*_WORDS.split(), "\n", "\x00", "\ud800"])
_HOSTILE = st.one_of(
    st.text(max_size=500),
    st.lists(_PIECES, max_size=60).map(" ".join),
    st.lists(_PIECES, max_size=60).map("".join),
    st.integers(0, 200).map(lambda depth: "go to the cube" + " on the cube" * depth),
    st.integers(0, 100_000).map(lambda length: "a" * length),
)


def check_tree(node: ParseTree) -> None:
    phrase = node.phrase
    if phrase.kind is PhraseKind.PREPOSITION:
        assert len(phrase.words) == 1
        assert node.children
    below = {child.phrase.kind for child in node.children}
    assert PhraseKind.VERB not in below
    assert phrase.kind is PhraseKind.VERB or PhraseKind.NOUN not in below or phrase.kind is PhraseKind.PREPOSITION
    assert phrase.noun is None or phrase.noun == phrase.noun.strip().lower() != ""
    for child in node.children:
        check_tree(child)


@settings(max_examples=250, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
@given(text=_HOSTILE)
def test_any_string_has_an_outcome(parser: Parser, text: str) -> None:
    parse = parser.parse(text, KNOWN)
    assert (parse.tree is None) != (parse.problem is None)
    assert parse == parser.parse(text, KNOWN)
    if parse.tree is not None:
        assert parse.tree.phrase.kind is PhraseKind.VERB
        check_tree(parse.tree)


def test_long_input_is_refused_at_once(parser: Parser) -> None:
    start = time.process_time()
    assert parser.parse("the cube on " * 10_000).problem is not None
    assert time.process_time() - start < 0.05


def test_what_bears_on_a_text_decides_how_it_is_read(parser: Parser) -> None:
    """The robot of each trial knows other words; few of them bear on a text."""
    nouns = ("cube", "mailbox", "traffic_cone", "FireHydrant", "wug", "wugs", "dax", "cabinet", "filing cabinet")
    texts = [s.text for s in HELD_OUT[:12]]
    texts += ["go to the mail box", "go to the trafic cone", "take the dax to the wugs", "find the fire hydrants"]
    for text in texts:
        read: dict[object, Parse] = {}
        for k in range(len(nouns)):
            for known in (nouns[:k], nouns[k:], nouns[k : k + 1]):
                found = parser.parse(text, known)
                assert read.setdefault(bearing(text, known), found) == found, (text, known)
    assert bearing("go to the wug", ["cube"]) == bearing("go to the wug", ["dax", "fire hydrant"])
    for text, noun in (("go to the mail box", "mailbox"), ("go to the filing cabinets", "filing cabinet")):
        assert bearing(text, ["cube"]) != bearing(text, ["cube", noun])
