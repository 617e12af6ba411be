"""Whatever stands in a world, training or episode file: it is read, or refused with one short line."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from hostile import EPISODE, SCALARS, TRAINING, WORLD, json_lines, yaml_files
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.evaluation.episodes import read_episodes, turned_note, unused_keys, unused_note
from dcg_torch.lessons import read_training
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import _QuickLoader
from dcg_torch.world.files import load_world

READERS: dict[str, tuple[Callable[[Path], Any], dict[str, Any]]] = {
    "world": (load_world, WORLD),
    "training": (read_training, TRAINING),
    "episodes": (read_episodes, EPISODE),
}
LONGEST = 500  # characters of a message, beside the path


def refusal(read: Callable[[Path], Any], path: Path) -> str | None:
    """What a reader says of a file; None if it takes it. Anything but a `UserError` comes through."""
    try:
        read(path)
    except UserError as error:
        said = str(error)
        assert said.startswith(str(path))
        assert said.isprintable()
        assert len(said) <= LONGEST + len(str(path))
        return said
    return None


def in_a_file(read: Callable[[Path], Any], content: bytes) -> str | None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a_file"
        path.write_bytes(content)
        return refusal(read, path)


@pytest.mark.parametrize("scalar", SCALARS, ids=lambda s: repr(s[:30]))
@pytest.mark.parametrize(("read", "good"), [READERS["world"], READERS["training"]], ids=["world", "training"])
def test_a_hostile_scalar_is_one_line(read: Callable[[Path], Any], good: dict[str, Any], scalar: str) -> None:
    head = yaml.safe_dump({k: v for k, v in good.items() if k not in ("name", "colors")}, sort_keys=False)
    for key in ("name", "colors"):
        assert in_a_file(read, f"{head}{key}: {scalar}\n".encode()) is not None


@pytest.mark.parametrize("name", READERS)
def test_places_that_are_no_files(name: str, tmp_path: Path) -> None:
    read, _ = READERS[name]
    (tmp_path / "folder.yaml").mkdir()
    (tmp_path / "round.yaml").symlink_to(tmp_path / "round.yaml")
    for place in (tmp_path / "folder.yaml", tmp_path / "round.yaml", Path("/dev/zero"), tmp_path / ("x" * 300)):
        assert refusal(read, place) is not None


def changed(good: dict[str, Any], **changes: Any) -> bytes:
    return json.dumps({**good, **changes}).encode()  # JSON is YAML, too


def thing(good: dict[str, Any], **changes: Any) -> bytes:
    """The good value with a change in its first object."""
    first, *others = good["objects"]
    return changed(good, objects=[{**first, **changes}, *others])


@pytest.mark.parametrize(
    ("content", "says"),
    [
        pytest.param(thing(WORLD, position=["2", 1]), "objects.0.position.0", id="coordinate a text"),
        pytest.param(thing(WORLD, position=[True, 1]), "objects.0.position.0", id="coordinate true"),
        pytest.param(thing(WORLD, position=[1e308, 1]), "objects.0.position.0", id="coordinate beyond the world"),
        pytest.param(thing(WORLD, id="../../x"), "objects.0.id", id="id that is a path"),
        pytest.param(changed(WORLD, objects=WORLD["objects"] * 1_000), "object ids repeat: 'a'", id="ids repeat"),
        pytest.param(changed(WORLD, robt={"x": 1}), "did you mean robot?", id="misspelt key"),
        pytest.param(thing(WORLD, colour="red"), "did you mean color?", id="misspelt key within"),
        pytest.param(b"name: a\nname: b\n", "the key 'name' is there twice", id="key twice"),
        pytest.param(changed(WORLD, robot=1), "robot", id="robot no pose"),
    ],
)
def test_what_is_wrong_in_a_world_file_is_said(content: bytes, says: str) -> None:
    said = in_a_file(load_world, content)
    assert said is not None
    assert says in said


@pytest.mark.parametrize(
    ("content", "says"),
    [
        pytest.param(changed(EPISODE, targt=["a"]).replace(b'"target"', b'"t"'), "did you mean target?", id="key"),
        pytest.param(
            thing(EPISODE, colour="red").replace(b'"color": "red", ', b""), "did you mean color?", id="colour"
        ),
        pytest.param(changed(EPISODE)[:-1] + b', "id": "z"}', "the key 'id' is there twice", id="key twice"),
        pytest.param(changed(EPISODE, robot={"x": 0, "y": 0, "yaww": 1}), "did you mean yaw?", id="yaw"),
        pytest.param(
            thing(EPISODE, label="x").replace(b'"type"', b'"sort"'), "objects.0.type: is missing; there are ", id="sort"
        ),
        pytest.param(changed(EPISODE).replace(b'"text"', b'"said"'), "text: is missing; there are id, said", id="said"),
        pytest.param(thing(EPISODE, type=""), "objects.0.type", id="empty type"),
        pytest.param(thing(EPISODE, type=" "), "objects.0.type", id="blank type"),
        pytest.param(thing(EPISODE, rgb=[1, 2]), "objects.0.rgb", id="two shades"),
        pytest.param(thing(EPISODE, rgb=[1, 2, 256]), "objects.0.rgb", id="too bright"),
        pytest.param(thing(EPISODE, position=[1e308, 0]), "objects.0.position", id="far away"),
        pytest.param(b"[" * 100_000, "the line", id="brackets"),
        pytest.param(b'{"id": "\x1b[31m"}', "the line", id="escapes"),
        pytest.param(changed(EPISODE, objects=EPISODE["objects"] * 2), "the id 'a' is there twice", id="id twice"),
    ],
)
def test_what_is_wrong_in_an_episode_is_said(content: bytes, says: str) -> None:
    said = in_a_file(read_episodes, content)
    assert said is not None
    assert says in said


def test_what_scanners_and_corpora_write_is_taken(tmp_path: Path) -> None:
    path = tmp_path / "e.jsonl"
    path.write_bytes(thing(EPISODE, size=0, age=3, tags=[7], targets=1, target_id=2) + b"\n")
    (episode,) = read_episodes(path)
    assert episode.objects[0].extents is None  # 0: the scanner could not tell
    assert episode.objects[0].rgb == (255.0, 0.0, 0.0)
    assert unused_keys([episode]) == {f"objects.{key}": 1 for key in ("age", "tags", "targets", "target_id")}
    path.write_bytes(changed(EPISODE, target=[]))
    assert read_episodes(path)[0].target == ()


def test_keys_that_are_not_used_are_said_in_one_line(tmp_path: Path) -> None:
    path = tmp_path / "e.jsonl"
    path.write_bytes(
        changed(EPISODE, id="1", grp="x", robot={"x": 0, "y": 0, "heading": 1})
        + b"\n"
        + changed(EPISODE, id="2", grp="x", **{"a\x1b[31m\n": 1, **{f"k{n}": 0 for n in range(20)}})
    )
    note = unused_note(read_episodes(path))
    assert note is not None
    assert "grp (2), " in note
    assert note.isprintable()
    assert "more" in note
    path.write_bytes(changed(EPISODE, id="1", robot={"x": 0, "y": 0, "heading": 1}))
    assert "robot.heading (1)" in (unused_note(read_episodes(path)) or "")
    path.write_bytes(thing(EPISODE, held=True, material="wood"))
    assert unused_note(read_episodes(path)) is None


def test_degrees_are_noticed(tmp_path: Path) -> None:
    """What is more than a turn cannot be meant in radians; three quarters of a turn, 4.7, can."""
    path = tmp_path / "e.jsonl"
    path.write_bytes(changed(EPISODE, id="7", robot={"x": 0, "y": 0, "yaw": -90}, speaker={"x": 0, "y": 0, "yaw": 180}))
    assert turned_note(read_episodes(path)) == (
        "a yaw of more than a turn (how often: 2; -90 in 7): angles are radians"
    )
    path.write_bytes(changed(EPISODE, robot={"x": 0, "y": 0, "yaw": 4.7}))
    assert turned_note(read_episodes(path)) is None


def test_an_object_may_be_called_what_the_robot_calls_its_guesses(tmp_path: Path) -> None:
    path = tmp_path / "w.yaml"
    path.write_bytes(thing(WORLD, id="hypothetical cube").replace(b'"target": "a"', b'"target": "hypothetical cube"'))
    assert load_world(path).objects[0].id == "hypothetical cube"


@given(yaml_files(WORLD))
def test_any_world_file_is_read_or_refused(content: bytes) -> None:
    in_a_file(load_world, content)


@given(yaml_files(TRAINING))
def test_any_training_file_is_read_or_refused(content: bytes) -> None:
    in_a_file(read_training, content)


@given(json_lines(EPISODE))
def test_any_episode_file_is_read_or_refused(content: bytes) -> None:
    in_a_file(read_episodes, content)


@given(x=st.floats(), y=st.floats(), yaw=st.floats())
def test_coordinates_are_taken_exactly_if_they_are_within_the_world(x: float, y: float, yaw: float) -> None:
    inside = all(map(math.isfinite, (x, y, yaw))) and max(abs(x), abs(y), abs(yaw)) <= 1_000.0
    world = {**WORLD, "robot": {"x": x, "y": y, "yaw": yaw}}
    said = in_a_file(load_world, yaml.safe_dump(world).encode())
    assert (said is None) == inside


@given(yaml_files(WORLD) | yaml_files(TRAINING))
def test_a_file_holds_the_same_whichever_loader_reads_it(content: bytes) -> None:
    values = []
    for loader in (yaml.SafeLoader, _QuickLoader):
        try:
            values.append(repr(yaml.load(content.decode("utf-8", "surrogateescape"), loader)))
        except (yaml.YAMLError, RecursionError, ValueError, ArithmeticError, LookupError, TypeError, AttributeError):
            return
    assert values[0] == values[1]
