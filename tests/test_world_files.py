import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from sample_worlds import OBJECT_RADIUS, generate_worlds, representative_seed, share_out_of_view

from dcg_torch.world.files import World, WorldFileError, load_world, load_worlds
from dcg_torch.world.generator import TYPES

COMMITTED = Path(__file__).parent.parent / "worlds"

GOOD = """
name: two
robot: {x: 1.0, y: -0.5, yaw: 0.25}
objects:
  - {id: a, type: cube, color: red, position: [1, 2]}
  - {id: b, type: fire hydrant, color: sky blue, position: [-1.5, 2], yaw: 1.0}
commands:
  - {text: go to the cube, target: a, noun: cube}
"""


@pytest.fixture(scope="module")
def committed() -> list[World]:
    return load_worlds(COMMITTED)


def test_ten_worlds_in_order(committed: list[World]) -> None:
    assert [world.name for world in committed] == [f"world_{k:02d}" for k in range(10)]
    assert sorted(path.stem for path in COMMITTED.glob("*.yaml")) == [world.name for world in committed]


def test_the_worlds_are_what_their_head_says(committed: list[World]) -> None:
    heads = {path.read_text().split("\n", 1)[0] for path in COMMITTED.glob("*.yaml")}
    (head,) = heads
    found = re.search(r"seed=(\d+), count=(\d+)", head)
    assert found is not None
    seed, count = int(found[1]), int(found[2])
    assert seed == representative_seed()
    made = generate_worlds(seed, count)
    assert [(w.name, w.robot, w.objects) for w in committed] == [(w.name, w.robot, w.objects) for w in made]


def test_the_worlds_are_a_fair_sample(committed: list[World]) -> None:
    occurring = Counter(o.type for world in committed for o in world.objects)
    assert set(occurring) == set(TYPES)
    assert 3 <= min(occurring.values()) <= max(occurring.values()) <= 7
    assert 34 <= occurring.total() <= 42
    assert share_out_of_view(committed) == pytest.approx(0.87, abs=0.01)
    assert share_out_of_view(committed, radius=OBJECT_RADIUS) == pytest.approx(0.87, abs=0.01)
    for world in committed:
        places = np.array([o.position for o in world.objects])
        gaps = np.linalg.norm(places[:, None] - places[None], axis=2)[~np.eye(len(places), dtype=bool)]
        assert gaps.min(initial=np.inf) >= 1.1
        assert np.linalg.norm(places - [world.robot.x, world.robot.y], axis=1).min() >= 1.2


def test_a_good_file(tmp_path: Path) -> None:
    path = tmp_path / "two.yaml"
    path.write_text(GOOD)
    world = load_world(path)
    assert (world.start.x, world.start.y, world.start.yaw) == (1.0, -0.5, 0.25)
    assert world.objects[1].color == "sky blue"
    assert world.objects[0].yaw == 0.0
    assert (world.commands[0].target, world.commands[0].color) == ("a", None)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (GOOD.replace("id: b", "id: a"), "object ids repeat"),
        (GOOD.replace("target: a", "target: c"), "'c'"),
        (GOOD.replace("color: red", "colour: red"), "objects.0.col"),
        (GOOD.replace("[1, 2]", "[1]"), "objects.0.position"),
        (GOOD.replace("x: 1.0", "x: far"), "robot.x"),
        (GOOD.replace("x: 1.0", "x: .nan"), "robot.x"),
        (GOOD.replace("[1, 2]", "[1, .inf]"), "objects.0.position.1"),
        ("name: w\nobjects: []\n", "objects"),
        ("- just\n- a list\n", "the file"),
        ("", "the file"),
        ("name: [unclosed", "YAML"),
    ],
)
def test_bad_files_are_one_line(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text(text)
    with pytest.raises(WorldFileError) as caught:
        load_world(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert says in message
    assert "\n" not in message


def test_directories(tmp_path: Path) -> None:
    with pytest.raises(WorldFileError, match="no such directory"):
        load_worlds(tmp_path / "nowhere")
    with pytest.raises(WorldFileError, match="holds no world file"):
        load_worlds(tmp_path)
    (tmp_path / "b.yaml").write_text(GOOD.replace("name: two", "name: alpha"))
    (tmp_path / "a.yaml").write_text(GOOD.replace("name: two", "name: beta"))
    assert [world.name for world in load_worlds(tmp_path)] == ["alpha", "beta"]
    (tmp_path / "c.yaml").write_text(GOOD.replace("name: two", "name: beta"))
    with pytest.raises(WorldFileError, match=r"c\.yaml: the name 'beta' is taken by .*a\.yaml"):
        load_worlds(tmp_path)
    with pytest.raises(WorldFileError, match="no such world file"):
        load_world(tmp_path / "missing.yaml")
