"""The 53 hand-made examples say what they are said to say, and a broken file says where it is broken."""

from __future__ import annotations

from collections import Counter
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
import yaml
from making import COLORS, KNOWN, NOVEL

from dcg_torch.language import Parser
from dcg_torch.lessons import TrainingFileError, read_training
from dcg_torch.model import TrainingSet
from dcg_torch.scene.upsilon import HYPOTHETICAL_UNKNOWN
from dcg_torch.types import Correspondence, Phrase, PhraseKind

FILE = Path(str(files("dcg_torch.lessons").joinpath("initial.yaml")))
RAW: dict[str, Any] = yaml.safe_load(FILE.read_text(encoding="utf-8"))
ENTRIES: list[dict[str, Any]] = RAW["examples"]


class TestTheFile:
    def test_53_positive_examples(self, training: TrainingSet) -> None:
        assert len(ENTRIES) == 53
        assert sum(e.phrase.kind is PhraseKind.NOUN for e in training.examples) == 53

    def test_no_entry_twice(self) -> None:
        assert len({yaml.dump(e) for e in ENTRIES}) == 53

    def test_what_is_known(self, training: TrainingSet) -> None:
        assert {s.word: s.type for s in training.symbols} == {t: t for t in KNOWN}
        assert training.colors == COLORS

    def test_covers_what_there_is_to_teach(self) -> None:
        """Every kind of grounding with and without a colour, several verbs and prepositions, all three inversions."""

        def kind(e: dict[str, Any]) -> tuple[str, str, bool]:
            known = "known" if e["noun"] in KNOWN else "unknown"
            return known, "unseen" if e["means"].startswith("hypothetical") else "seen", "color" in e

        counts = Counter(map(kind, ENTRIES))
        assert len(counts) == 8
        assert min(counts.values()) >= 3
        assert len({e["verb"] for e in ENTRIES}) >= 8
        assert {e["preposition"] for e in ENTRIES if "preposition" in e} >= {"to", "towards", "near", "away from"}
        assert {e.get("inverted") for e in ENTRIES} == {None, "verb", "preposition"}
        assert sum(e.get("negated", False) for e in ENTRIES) >= 3
        known = {(e["noun"], e.get("color")) for e in ENTRIES if e["noun"] in KNOWN}
        assert known >= {(noun, color) for noun in KNOWN for color in (None, *COLORS)}
        assert {e["color"] for e in ENTRIES if "color" in e} > set(COLORS)

    def test_what_is_unknown_stays_unknown(self) -> None:
        """No noun or type that teaches "unknown" is one that the robot may meet."""
        nouns = {e["noun"] for e in ENTRIES} - set(KNOWN)
        types = {text.split(" ", 1)[1] for e in ENTRIES for text in e["see"]} - set(KNOWN)
        assert not (nouns | types) & set(NOVEL)
        assert min(len(nouns), len(types)) >= 6

    @pytest.mark.parametrize("entry", ENTRIES, ids=lambda e: f"{e['command']} ({e['means']})")
    def test_the_parse_is_the_one_stated(self, entry: dict[str, Any], parser: Parser) -> None:
        tree = parser.parse(entry["command"], RAW["symbols"]).tree
        assert tree is not None
        phrases = {node.phrase.kind: node.phrase for node in tree.walk()}
        assert len(phrases) == len(list(tree.walk()))
        verb, noun = phrases[PhraseKind.VERB], phrases[PhraseKind.NOUN]
        assert verb.words == ((entry["verb"], "not") if entry.get("negated") else (entry["verb"],))
        preposition = phrases.get(PhraseKind.PREPOSITION)
        assert (None if preposition is None else " ".join(preposition.words)) == entry.get("preposition")
        assert (noun.noun, noun.color, noun.words) == (entry["noun"], entry.get("color"), ())

    def test_the_examples_are_the_entries(self, training: TrainingSet) -> None:
        """Per entry a noun phrase, a preposition if there is one, a verb; each positive for what is meant."""
        examples = iter(training.examples)
        for entry in ENTRIES:
            kinds = [PhraseKind.NOUN, PhraseKind.PREPOSITION, PhraseKind.VERB]
            if "preposition" not in entry:
                kinds.remove(PhraseKind.PREPOSITION)
            below: Phrase | None = None
            for kind in kinds:
                example = next(examples)
                assert example.phrase.kind is kind
                meant = [
                    (o.id, c)
                    for o, c in zip(example.world.objects, example.correspondences, strict=True)
                    if c not in (None, Correspondence.INACTIVE)
                ]
                sign = Correspondence.INVERTED if entry.get("inverted") == kind.value else Correspondence.ACTIVE
                assert meant == [(entry["means"], sign)]
                assert [c.grounding.object.id for c in example.children] == ([] if below is None else [entry["means"]])
                assert [o.id for o in example.world.objects][: len(entry["see"])] == entry["see"]
                assert example.world.objects[-1].id == HYPOTHETICAL_UNKNOWN
                below = example.phrase
        assert next(examples, None) is None


GOOD: dict[str, Any] = {
    "symbols": {"cube": "cube"},
    "colors": ["red"],
    "examples": [
        {
            "command": "go to the cube",
            "verb": "go",
            "preposition": "to",
            "noun": "cube",
            "see": ["red cube"],
            "means": "red cube",
        },
        {"command": "find the dax", "verb": "find", "noun": "dax", "see": [], "means": HYPOTHETICAL_UNKNOWN},
    ],
}


def written(tmp_path: Path, **changes: Any) -> Path:
    """A file like `GOOD` whose second entry is changed."""
    entry = {k: v for k, v in {**GOOD["examples"][1], **changes}.items() if v is not ...}
    path = tmp_path / "training.yaml"
    path.write_text(yaml.dump({**GOOD, "examples": [GOOD["examples"][0], entry]}))
    return path


class TestReading:
    def test_a_good_file(self, tmp_path: Path) -> None:
        found = read_training(written(tmp_path))
        assert [e.phrase.kind.value for e in found.examples] == ["noun", "preposition", "verb", "noun", "verb"]

    @pytest.mark.parametrize(
        ("changes", "where", "says"),
        [
            ({"means": "red dax"}, "example 2 ('find the dax')", "hypothetical cube"),
            ({"see": ["cube"]}, "example 2 ('find the dax')", "write a colour and a type"),
            ({"see": ["red dax", "red dax"], "means": "red dax"}, "example 2 ('find the dax')", "red dax"),
            ({"verb": ...}, "examples.1.verb", "required"),
            ({"noun": None}, "examples.1.noun", "string"),
            ({"adverb": "quickly"}, "examples.1.adverb", "not permitted"),
            ({"inverted": "noun"}, "examples.1.inverted", "'verb' or 'preposition'"),
        ],
    )
    def test_a_broken_entry_is_named(self, tmp_path: Path, changes: dict[str, Any], where: str, says: str) -> None:
        path = written(tmp_path, **changes)
        with pytest.raises(TrainingFileError) as caught:
            read_training(path)
        message = str(caught.value)
        assert message.startswith(f"{path}: {where}")
        assert says in message
        assert "\n" not in message

    @pytest.mark.parametrize(
        ("text", "says"),
        [
            ("symbols: {cube: cube", "not readable as YAML"),
            ("", "the file"),
            ("symbols: {}\ncolors: []\nexamples: []\n", "symbols"),
            ("symbols: {cube: cube}\ncolors: [red]\nexamples: []\n", "examples"),
        ],
    )
    def test_a_broken_file(self, tmp_path: Path, text: str, says: str) -> None:
        path = tmp_path / "broken.yaml"
        path.write_text(text)
        with pytest.raises(TrainingFileError, match=says) as caught:
            read_training(path)
        assert "\n" not in str(caught.value)
        assert str(path) in str(caught.value)

    def test_no_file(self, tmp_path: Path) -> None:
        with pytest.raises(TrainingFileError, match="no such training file"):
            read_training(tmp_path / "nowhere.yaml")

    def test_bytes_that_are_no_text(self, tmp_path: Path) -> None:
        path = tmp_path / "latin.yaml"
        path.write_bytes(b"symbols: {w\xfcrfel: cube}")
        with pytest.raises(TrainingFileError, match="no UTF-8 text"):
            read_training(path)
