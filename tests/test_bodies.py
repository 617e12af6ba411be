import math
from collections.abc import Iterator

import numpy as np
import pybullet
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import rgb_to_hsv
from numpy.typing import NDArray

from dcg_torch.simulator.bodies import Model, Part, add_object, extent, footprint, register, registered, rgb
from dcg_torch.simulator.bodies.looks import model
from dcg_torch.simulator.bodies.meshes import Mesh, ball, box, extruded, lathed, merged, rod, rounded_rectangle
from dcg_torch.types.arrays import Floats, Ints
from dcg_torch.world import generator

MODELLED = (*generator.TYPES, "crate")
HUES = {"red": 0.0, "green": 1 / 3, "blue": 2 / 3}
SIDES = [k * math.pi / 4 for k in range(8)]


@pytest.fixture
def client() -> Iterator[int]:
    number = pybullet.connect(pybullet.DIRECT)
    yield number
    pybullet.disconnect(number)


def render(
    client: int, eye: list[float], target: list[float], up: list[float], degrees: float, pixels: int = 160
) -> tuple[NDArray[np.uint8], Ints]:
    _, _, colors, _, bodies = pybullet.getCameraImage(
        pixels,
        pixels,
        pybullet.computeViewMatrix(eye, target, up),
        pybullet.computeProjectionMatrixFOV(degrees, 1.0, 0.1, 60.0),
        shadow=0,
        renderer=pybullet.ER_TINY_RENDERER,
        physicsClientId=client,
    )
    image = np.asarray(colors, dtype=np.uint8).reshape(pixels, pixels, 4)[..., :3]
    return image, np.asarray(bodies, dtype=np.int64).reshape(pixels, pixels)


def silhouette(client: int, eye: list[float], up: list[float]) -> Floats:
    """What is covered of the square metre about (0, 0, 0.4), from 40 m away: (n, 2) metres to the right and up."""
    _, mask = render(client, eye, [0.0, 0.0, 0.4], up, math.degrees(2 * math.atan(0.5 / 40.0)), pixels=250)
    rows, columns = np.nonzero(mask >= 0)
    return np.stack([(columns + 0.5) / 250 - 0.5, 0.5 - (rows + 0.5) / 250], axis=1)


def test_the_eight_types_of_the_generator_have_bodies() -> None:
    assert set(generator.TYPES) <= set(registered())


@pytest.mark.parametrize("type", MODELLED)
def test_every_type_is_one_static_body_with_one_id_in_the_mask(client: int, type: str) -> None:
    other = add_object(client, "cube", "red", (5.0, 5.0))
    body = add_object(client, type, "blue", (0.0, 0.0))
    assert pybullet.getNumBodies(physicsClientId=client) == 2
    assert pybullet.getDynamicsInfo(body, -1, physicsClientId=client)[0] == 0.0
    for side in SIDES[::2]:
        eye = [2 * math.cos(side), 2 * math.sin(side), 0.3]
        _, mask = render(client, eye, [0.0, 0.0, 0.25], [0.0, 0.0, 1.0], 25.0)
        assert set(np.unique(mask)) - {-1, other} == {body}


@pytest.mark.parametrize("type", MODELLED)
def test_drawn_size_is_the_stated_one_and_suits_the_robot(client: int, type: str) -> None:
    add_object(client, type, "green", (0.0, 0.0))
    above = silhouette(client, [0.0, 0.0, 40.4], [0.0, 1.0, 0.0])
    front = silhouette(client, [40.0, 0.0, 0.4], [0.0, 0.0, 1.0])
    x, y, z = extent(type)
    assert np.ptp(above, axis=0) == pytest.approx([x, y], abs=0.015)
    assert front[:, 1].max() + 0.4 == pytest.approx(z, abs=0.01)
    assert front[:, 1].min() + 0.4 == pytest.approx(0.0, abs=0.01)
    assert 0.30 <= z <= 0.65
    assert footprint(type) <= 0.22
    assert np.hypot(*above.T).max() <= footprint(type) + 0.008


@pytest.mark.parametrize("type", MODELLED)
def test_nothing_drawn_sticks_out_of_the_collision_hull(client: int, type: str) -> None:
    body = add_object(client, type, "green", (0.0, 0.0))
    low, high = np.array(pybullet.getAABB(body, physicsClientId=client))
    assert np.hypot(*np.maximum(abs(low), abs(high))[:2]) <= 0.22 * math.sqrt(2) + 0.01
    above = silhouette(client, [0.0, 0.0, 40.4], [0.0, 1.0, 0.0])
    assert (above >= low[:2] - 0.005).all()
    assert (above <= high[:2] + 0.005).all()
    assert high[2] >= extent(type)[2] - 0.005
    # a ray at any height that the object has meets the hull, so that the robot can't drive under it
    for height in (0.05, 0.15, 0.28):
        hit = pybullet.rayTest([1.0, 0.0, height], [-1.0, 0.0, height], physicsClientId=client)[0]
        assert hit[0] == body


@pytest.mark.parametrize("color", HUES)
@pytest.mark.parametrize("type", generator.TYPES)
def test_the_stated_colour_dominates_the_picture(client: int, type: str, color: str) -> None:
    body = add_object(client, type, color, (0.0, 0.0))
    seen = []
    for side in SIDES:
        eye = [1.8 * math.cos(side), 1.8 * math.sin(side), 0.6]
        image, mask = render(client, eye, [0.0, 0.0, 0.25], [0.0, 0.0, 1.0], 25.0)
        seen.append(rgb_to_hsv(image[mask == body] / 255.0))
    hue, saturation, _ = np.concatenate(seen).T
    colored = saturation > 0.35
    assert colored.mean() > 0.5
    away = abs((hue[colored] - HUES[color] + 0.5) % 1.0 - 0.5)
    assert away.max() < 0.06  # accents have no colour, so no other hue appears at all


def test_position_and_heading(client: int) -> None:
    body = add_object(client, "drill", "red", (1.5, -2.0), yaw=math.pi / 2)
    position, turn = pybullet.getBasePositionAndOrientation(body, physicsClientId=client)
    assert position == pytest.approx((1.5, -2.0, 0.0))
    assert pybullet.getEulerFromQuaternion(turn)[2] == pytest.approx(math.pi / 2)
    low, high = np.array(pybullet.getAABB(body, physicsClientId=client))
    x, y, _ = extent("drill")
    assert (high - low)[:2] == pytest.approx([y, x], abs=0.01)


def test_unknown_type_is_one_line_that_names_the_known_ones(client: int) -> None:
    for attempt in (lambda: add_object(client, "unicorn", "red", (0.0, 0.0)), lambda: extent("unicorn")):
        with pytest.raises(ValueError, match="'unicorn'") as caught:
            attempt()
        message = str(caught.value)
        assert "\n" not in message
        assert all(type in message for type in generator.TYPES)
    assert pybullet.getNumBodies(physicsClientId=client) == 0


def test_colour_names() -> None:
    assert rgb("RED") == rgb("red")
    assert rgb("#ff8000") == pytest.approx((1.0, 128 / 255, 0.0))
    red, green, blue = rgb("sky blue")
    assert blue > green > red
    with pytest.raises(ValueError, match="no colour named 'blurple-ish'"):
        rgb("blurple-ish")


def test_a_registered_type_can_be_added(client: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dcg_torch.simulator.bodies.looks._BUILDERS", {})

    @register("crate of this test")
    def crate() -> Model:
        return Model((Part(box(0.3, 0.2, 0.35)), Part(box(0.31, 0.21, 0.02).moved(z=0.1), (0.2, 0.2, 0.2))))

    assert extent("crate of this test") == pytest.approx((0.31, 0.21, 0.35))
    assert add_object(client, "crate of this test", "teal", (0.0, 0.0)) >= 0
    with pytest.raises(ValueError, match="registered already"):
        register("crate of this test")(crate)


def volume(mesh: Mesh) -> float:
    """Signed: positive when the faces are wound counter-clockwise seen from outside (divergence theorem)."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def assert_sound(mesh: Mesh) -> None:
    """Closed, wound one way round, with normals that point outwards."""
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
    corners = mesh.vertices[mesh.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("ij,ikj->ik", faces, mesh.normals[mesh.triangles]) > 0).all()
    _, place = np.unique(mesh.vertices.round(9), axis=0, return_inverse=True)
    edges: dict[tuple[int, int], int] = {}
    for triangle in place.reshape(-1)[mesh.triangles].tolist():
        for edge in zip(triangle, [*triangle[1:], triangle[0]], strict=True):
            edges[edge] = edges.get(edge, 0) + 1
    assert all(edges.get((b, a), 0) == count for (a, b), count in edges.items())


@pytest.mark.parametrize("type", MODELLED)
def test_meshes_of_the_types_are_sound(type: str) -> None:
    for part in model(type).parts:
        assert_sound(part.mesh)
        assert volume(part.mesh) > 0


@given(st.floats(0.01, 1.0), st.floats(0.01, 1.0), st.integers(3, 40), st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_a_lathed_cylinder_is_a_prism_however_it_is_turned(
    radius: float, height: float, segments: int, direction: tuple[float, float, float]
) -> None:
    expected = segments / 2 * radius**2 * math.sin(math.tau / segments) * height
    mesh = lathed([(radius, 0.0), (radius, height)], segments)
    assert_sound(mesh)
    assert volume(mesh) == pytest.approx(expected)
    if np.linalg.norm(direction) > 0.01:
        turned = mesh.pointing(direction)
        assert volume(turned.moved(1.0, 2.0, 3.0)) == pytest.approx(expected)
        tip = np.asarray(direction) / np.linalg.norm(direction) * height
        assert np.abs(turned.vertices - tip).sum(axis=1).min() == pytest.approx(0.0, abs=1e-9)


def test_other_solids() -> None:
    assert volume(box(2.0, 3.0, 4.0)) == pytest.approx(24.0)
    assert volume(ball(1.0, segments=100)) == pytest.approx(4 / 3 * math.pi, rel=0.01)
    assert volume(rod((0, 0, 0), (0, 3, 4), 0.5, segments=100)) == pytest.approx(
        math.pi * 0.25 * 5 + 4 / 3 * math.pi * 0.125, rel=0.05
    )
    square = extruded(rounded_rectangle(2.0, 1.0, 0.25), 3.0)
    assert volume(square) == pytest.approx(3 * (2.0 - (4 - math.pi) * 0.25**2), rel=0.01)
    for mesh in (box(2.0, 3.0, 4.0), ball(1.0), rod((0, 0, 0), (1, 2, 3), 0.5), square.upright(), square.lying()):
        assert_sound(mesh)
        assert volume(mesh) > 0
    assert volume(merged([box(1, 1, 1), box(2, 1, 1).moved(5)])) == pytest.approx(3.0)
