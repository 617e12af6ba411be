"""Bodies for the physics: `add_object` puts a coloured object of a registered type into a client.

    from dcg_torch.simulator.bodies import Model, Part, register
    from dcg_torch.simulator.bodies.meshes import box

    @register("suitcase")
    def suitcase() -> Model:
        return Model((Part(box(0.3, 0.2, 0.45)),))

teaches a new type.
"""

from __future__ import annotations

import functools
import math
from typing import Any

from dcg_torch.simulator.bodies import laboratory, types  # noqa: F401 - their types register themselves
from dcg_torch.simulator.bodies.colors import RGB, rgb
from dcg_torch.simulator.bodies.looks import Model, Part, model, register, registered

__all__ = ["Model", "Part", "add_model", "add_object", "extent", "footprint", "register", "registered", "rgb"]


def extent(type: str) -> tuple[float, float, float]:
    """(x, y, z) lengths in metres of the bounding box of an object of this type at yaw 0.

    Raises:
        ValueError: unknown type; the message lists the known ones.
    """
    low, high = model(type).bounds
    x, y, z = high - low
    return float(x), float(y), float(z)


def footprint(type: str) -> float:
    """Radius in metres of the smallest circle about the foot that holds the object, seen from above.

    Raises:
        ValueError: unknown type; the message lists the known ones.
    """
    return model(type).radius


def add_object(client: int, type: str, color: str, position: tuple[float, float], yaw: float = 0.0) -> int:
    """Put a static object on the floor of a physics client.

    Args:
        client: a physicsClientId.
        type: a registered type.
        color: a colour name, see `rgb`.
        position: (x, y) of its foot, metres.
        yaw: heading in radians; 0 looks along +x.

    Returns:
        The body's unique id, which is also its id in segmentation masks.

    Raises:
        ValueError: unknown type or colour.
    """
    return add_model(client, model(type), rgb(color), position, yaw)


def add_model(client: int, looks: Model, color: RGB, position: tuple[float, float], yaw: float = 0.0) -> int:
    """Put any model, registered or not, on the floor as one static body; arguments as for `add_object`."""
    from dcg_torch.simulator.engine import pybullet  # here: looks, sizes and colours need no physics

    visuals = [
        pybullet.createVisualShape(
            pybullet.GEOM_MESH,
            rgbaColor=[*(color if part["paint"] is None else part["paint"]), 1.0],
            specularColor=[0.1, 0.1, 0.1],
            physicsClientId=client,
            **part["mesh"],
        )
        for part in _prepared(looks)
    ]
    # One body may have one mesh made in memory per link, so the accents hang on fixed links without a shape to
    # collide with; masks without the link flag show all of them under the body's id.
    links = len(visuals) - 1
    return int(
        pybullet.createMultiBody(
            baseMass=0,
            baseCollisionShapeIndex=_hull(client, looks),
            baseVisualShapeIndex=visuals[0],
            basePosition=[position[0], position[1], 0.0],
            baseOrientation=[0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)],
            linkMasses=[0.0] * links,
            linkCollisionShapeIndices=[-1] * links,
            linkVisualShapeIndices=visuals[1:],
            linkPositions=[[0.0, 0.0, 0.0]] * links,
            linkOrientations=[[0.0, 0.0, 0.0, 1.0]] * links,
            linkInertialFramePositions=[[0.0, 0.0, 0.0]] * links,
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]] * links,
            linkParentIndices=[0] * links,
            linkJointTypes=[pybullet.JOINT_FIXED] * links,
            linkJointAxis=[[0.0, 0.0, 1.0]] * links,
            physicsClientId=client,
        )
    )


def _hull(client: int, looks: Model) -> int:
    """The shape that a model collides with: a box around it, or a cylinder."""
    from dcg_torch.simulator.engine import pybullet  # as above

    low, high = looks.bounds
    middle = ((low + high) / 2).tolist()
    if looks.round_hull:
        height = float(high[2] - low[2])
        hull = {"radius": looks.radius, "height": height, "collisionFramePosition": [0.0, 0.0, middle[2]]}
        shape = pybullet.GEOM_CYLINDER
    else:
        hull = {"halfExtents": ((high - low) / 2).tolist(), "collisionFramePosition": middle}
        shape = pybullet.GEOM_BOX
    return int(pybullet.createCollisionShape(shape, physicsClientId=client, **hull))


@functools.cache
def _prepared(looks: Model) -> list[dict[str, Any]]:
    """The merged parts as the plain lists that pybullet wants, kept because making them is the slow part."""
    return [
        {
            "paint": part.paint,
            "mesh": {
                "vertices": part.mesh.vertices.tolist(),
                "normals": part.mesh.normals.tolist(),
                "indices": part.mesh.triangles.ravel().tolist(),
            },
        }
        for part in looks.by_paint()
    ]
