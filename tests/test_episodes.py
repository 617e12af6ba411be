"""Episode files: what may be written, what becomes of it, and what is said of a broken line."""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import pytest

from dcg_torch.evaluation.episodes import EpisodeError, read_episodes
from dcg_torch.types import Pose

OBJECT: dict[str, Any] = {"id": "a", "type": "cube", "position": [1, 2, 0]}


def line(thing: dict[str, Any] | None = None, **keys: Any) -> str:
    """A line with one object, made up for these tests."""
    episode = {"id": "x", "text": "take the cube", "objects": [{**OBJECT, **(thing or {})}], "target": ["a"]}
    return json.dumps({**episode, **keys})


def write(tmp_path: Path, *lines: str, end: str = "\n") -> Path:
    path = tmp_path / "e.jsonl"
    path.write_bytes("".join(text + end for text in lines).encode("utf-8"))
    return path


@pytest.mark.parametrize(
    ("size", "extents", "attributes"),
    [
        ([0.1, 0.2, 0.3], (0.1, 0.2, 0.3), set()),
        (0.5, (0.5, 0.5, 0.5), set()),
        (2, (2.0, 2.0, 2.0), set()),
        ("small", None, {"size: small"}),
        (None, None, set()),
    ],
)
def test_a_size_is_extents_one_number_or_a_word(
    tmp_path: Path, size: Any, extents: tuple[float, ...] | None, attributes: set[str]
) -> None:
    (episode,) = read_episodes(write(tmp_path, line({"size": size})))
    (percept,) = episode.percepts()
    assert percept.size == extents
    assert set(percept.attributes) == attributes


def test_further_keys_that_are_words_or_true_are_attributes(tmp_path: Path) -> None:
    further = {"material": "wood", "held": True, "broken": False, "age": 3, "weight": 1.5, "owner": None, "tags": ["x"]}
    (episode,) = read_episodes(write(tmp_path, line(further)))
    assert episode.percepts()[0].attributes == {"material: wood", "held", "broken: no", "tags: x"}
    (held,) = read_episodes(write(tmp_path, line({"material": "wood"}, holding="a")))
    assert held.percepts()[0].attributes == {"material: wood", "held"}


def test_positions_may_be_flat_and_the_speaker_may_look_somewhere(tmp_path: Path) -> None:
    (episode,) = read_episodes(write(tmp_path, line({"position": [1, 2]}, speaker={"x": 3, "y": 4, "yaw": 0.5})))
    assert episode.percepts()[0].position == (1.0, 2.0, 0.0)
    assert episode.speaker_pose == Pose(3.0, 4.0, 0.5)


def test_marks_and_line_ends_of_other_systems_and_blank_lines(tmp_path: Path) -> None:
    path = write(tmp_path, line(id="1"), "", "   ", line(id="2", text="take\u2028it"), end="\r\n")
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    # A line separator inside a JSON text is no end of a line.
    path.write_bytes(path.read_bytes().replace(rb"\u2028", "\u2028".encode()))
    first, second = read_episodes(path)
    assert (first.id, second.id, second.text) == ("1", "2", "take\u2028it")


NAN = line().replace("[1, 2, 0]", "[NaN, 0, 0]")
BROKEN = [
    pytest.param("{", "the line", id="no JSON"),
    pytest.param("[]", "the line", id="no object"),
    pytest.param(line(id=7), "id: ", id="a number for an id"),
    pytest.param(line(text=None), "text: ", id="no text"),
    pytest.param(line(target="a"), "target: ", id="target no list"),
    pytest.param(line(target=["b"]), "target: 'b' is no object of this episode", id="unknown target"),
    pytest.param(line(holding="b"), "holding: 'b' is no object of this episode", id="unknown holding"),
    pytest.param(line(objects=[]), "objects: ", id="no objects"),
    pytest.param(line(objects=[OBJECT, OBJECT]), "objects: the id 'a' is there twice", id="two of one id"),
    pytest.param(NAN, "objects.0.position: ", id="NaN"),
    pytest.param(line({"position": [1]}), "objects.0.position: ", id="too short a position"),
    pytest.param(line({"position": ["1", "2"]}), "objects.0.position: ", id="a position of texts"),
    pytest.param(line({"size": -1}), "objects.0.size: ", id="negative size"),
    pytest.param(line({"size": [1, 2]}), "objects.0.size: ", id="two extents"),
    pytest.param(line({"size": True}), "objects.0.size: ", id="size no size"),
    pytest.param(line({"color": 3}), "objects.0.color: ", id="a number for a colour"),
    pytest.param(line(robot={"x": 1}), "robot: ", id="half a pose"),
    pytest.param(line(speaker=[1, 2]), "speaker: ", id="speaker no pose"),
]


@pytest.mark.parametrize(("broken", "says"), BROKEN)
def test_a_broken_line_is_one_line_that_says_where_what_and_how_to_mend_it(
    tmp_path: Path, broken: str, says: str
) -> None:
    path = write(tmp_path, line(id="fine"), "", broken)
    with pytest.raises(EpisodeError) as error:
        read_episodes(path)
    said = str(error.value)
    assert said.startswith(f"{path}, line 3: {says}")
    assert "\n" not in said
    assert "constrained" not in said  # no names of pydantic's own
    assert said.count(":") >= 2


def test_an_id_may_be_there_once(tmp_path: Path) -> None:
    with pytest.raises(EpisodeError, match=r"line 3: id: 'x' is that of line 1 too"):
        read_episodes(write(tmp_path, line(), "", line()))


def test_what_is_no_episode_file(tmp_path: Path) -> None:
    packed = tmp_path / "e.jsonl.gz"
    packed.write_bytes(gzip.compress(line().encode()))
    for path, says in (
        (packed, "no UTF-8 text"),
        (tmp_path, "this is no file"),
        (tmp_path / "none", "no such episode file"),
        (write(tmp_path, "", " "), "holds no episodes"),
    ):
        with pytest.raises(EpisodeError, match=says) as error:
            read_episodes(path)
        assert "\n" not in str(error.value)
