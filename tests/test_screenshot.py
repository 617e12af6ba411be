import math
from pathlib import Path

import numpy as np
import pybullet
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from dcg_torch.simulator.screenshot import HIGHLIGHT, save_pair_screenshots, world_screenshot
from dcg_torch.simulator.stage import Stage
from dcg_torch.simulator.view import View, direction, fitting_view
from dcg_torch.types.arrays import Floats
from dcg_torch.world.files import World, load_worlds

SIZE = (320, 240)


@pytest.fixture(scope="module")
def worlds() -> list[World]:
    return load_worlds(Path(__file__).parent.parent / "worlds")


def highlighted(picture: np.ndarray) -> int:
    """Number of pixels in the highlight's colour."""
    return int((abs(picture.astype(int) - HIGHLIGHT).max(axis=2) < 30).sum())


def test_only_a_highlight_has_its_colour_and_it_moves_with_the_object(worlds: list[World]) -> None:
    world = worlds[0]
    bare = world_screenshot(world, None, SIZE)
    assert bare.shape == (240, 320, 3)
    assert bare.dtype == np.uint8
    assert highlighted(bare) < 30  # the robot may wear a little of it
    pictures = [world_screenshot(world, o.id, SIZE) for o in world.objects[:2]]
    assert all(highlighted(picture) > 200 for picture in pictures)
    assert (pictures[0] != pictures[1]).any()


@given(
    arrays(float, (6, 3), elements=st.floats(-20.0, 20.0)),
    st.floats(-3.1, 3.1),
    st.floats(0.2, 1.3),
    st.floats(0.2, 1.0),
)
def test_the_camera_has_all_points_in_the_picture_and_is_no_further_than_needed(
    points: Floats, yaw: float, down: float, fov: float
) -> None:
    forward = np.array([math.cos(down) * math.cos(yaw), math.cos(down) * math.sin(yaw), -math.sin(down)])
    view = fitting_view(points, forward, fov, SIZE)
    from_middle = abs(view.project(points) / SIZE - 0.5) / 0.5
    depth = ((points - view.eye) @ forward).min()
    assert from_middle.max() <= 0.86 + 1e-6
    assert depth >= 8.0 - 1e-6
    assert from_middle.max() >= 0.86 - 1e-6 or depth <= 8.0 + 1e-6


@pytest.mark.parametrize("down", [0.6, 0.02, -0.5])
def test_the_painted_floor_is_the_one_that_the_renderer_draws(worlds: list[World], down: float) -> None:
    with Stage(worlds[1]) as stage:
        far = View(np.array([-1.0, 0.3, 1.2]), direction(0.4, down), 0.9, SIZE, near=2.0, far=12.0)
        for view in (stage.overview(SIZE, 0.6), far):
            drawn, bodies = view.render(stage.client)
            painted, mask = stage.unshaded(view)
            assert (mask == bodies).mean() > 0.999
            assert (abs(painted.astype(int) - drawn).max(axis=2) <= 1).mean() > 0.999
        assert (stage.floor in mask) == (down > 0.0)


def test_a_picture_leaves_no_client_behind(worlds: list[World]) -> None:
    def connected() -> list[int]:
        return [k for k in range(16) if pybullet.getConnectionInfo(k)["isConnected"]]

    before = connected()
    world_screenshot(worlds[1], None, SIZE)
    with pytest.raises(ValueError, match="no object 'unicorn' to highlight; it has") as caught:
        world_screenshot(worlds[1], "unicorn", SIZE)
    assert "\n" not in str(caught.value)
    assert connected() == before


def test_one_file_per_pair(worlds: list[World], tmp_path: Path) -> None:
    paths = save_pair_screenshots(worlds[:2], tmp_path / "shots", SIZE)
    assert [path.stem for path in paths] == [f"{w.name}-{o.id}" for w in worlds[:2] for o in w.objects]
    first = np.asarray(Image.open(paths[0]))
    assert (first == world_screenshot(worlds[0], worlds[0].objects[0].id, SIZE)).all()
