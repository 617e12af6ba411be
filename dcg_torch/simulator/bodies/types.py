"""The eight types of the paper's simulated worlds (Section V-A), at a size that suits a robot 0.4 m tall.

All stand within 0.22 m of their foot and are 0.30 to 0.65 m tall, so that a robot of radius 0.18 m can stop
within 0.5 m of any of them without touching, and its camera sees them over no rim. A door handle of that size
is a giant; it is meant as a sample on a piece of door.
"""

from __future__ import annotations

import math

from dcg_torch.simulator.bodies.looks import BLACK, DARK_GRAY, GRAY, LIGHT_GRAY, WHITE, Model, Part, register
from dcg_torch.simulator.bodies.meshes import Mesh, arc, ball, box, extruded, lathed, rod, rounded_rectangle


@register("cube")
def cube() -> Model:
    """A plain cube."""
    return Model((Part(box(0.30, 0.30, 0.30)),))


@register("sphere")
def sphere() -> Model:
    """A plain ball."""
    return Model((Part(ball(0.19, segments=36)),), round_hull=True)


@register("cylinder")
def cylinder() -> Model:
    """A plain upright cylinder."""
    return Model((Part(lathed([(0.15, 0.0), (0.15, 0.42)], segments=36)),), round_hull=True)


@register("fire hydrant")
def fire_hydrant() -> Model:
    """Bolted base flange, barrel, domed bonnet with its nut, a large nozzle in front and two at the sides."""
    barrel = lathed([(0.098, 0.03), (0.092, 0.33)])
    base = lathed([(0.15, 0.0), (0.15, 0.03), (0.11, 0.045)])
    collar = lathed([(0.12, 0.33), (0.132, 0.338), (0.132, 0.362), (0.12, 0.37)])
    dome = lathed([(0.115, 0.37), *arc((0.0, 0.38), 0.112, 5.0, 75.0, 8), (0.029, 0.50)])
    bolts = [
        Part(lathed([(0.014, 0.0), (0.014, 0.05)], 6).moved(0.13 * math.cos(a), 0.13 * math.sin(a)), LIGHT_GRAY)
        for a in (math.pi * (k + 0.5) / 4 for k in range(8))
    ]
    nut = lathed([(0.036, 0.495), (0.036, 0.515), (0.024, 0.516), (0.022, 0.55)], segments=6)
    side = lathed([(0.044, 0.05), (0.044, 0.135)], 20)
    side_cap = lathed([(0.056, 0.135), (0.056, 0.165), (0.046, 0.175)], 20)
    side_nut = lathed([(0.018, 0.175), (0.018, 0.195)], 6)
    front = lathed([(0.06, 0.05), (0.06, 0.13)], 24)
    front_cap = lathed([(0.076, 0.13), (0.076, 0.162), (0.064, 0.174)], 24)
    front_nut = lathed([(0.022, 0.174), (0.022, 0.196)], 6)
    nozzles = [
        Part(mesh.pointing((1, 0, 0)).moved(z=0.22), paint)
        for mesh, paint in ((front, None), (front_cap, LIGHT_GRAY), (front_nut, LIGHT_GRAY))
    ]
    for y in (-1.0, 1.0):
        nozzles += [
            Part(mesh.pointing((0, y, 0)).moved(z=0.27), paint)
            for mesh, paint in ((side, None), (side_cap, LIGHT_GRAY), (side_nut, LIGHT_GRAY))
        ]
    solids = [Part(mesh) for mesh in (barrel, base, collar, dome)]
    return Model((*solids, Part(nut, LIGHT_GRAY), *bolts, *nozzles), round_hull=True)


@register("drill")
def drill() -> Model:
    """A cordless drill standing on its battery: motor housing, chuck, bit, pistol grip with trigger."""
    z = 0.345  # of the bit
    housing = lathed([(0.03, -0.20), (0.052, -0.19), (0.060, -0.17), (0.060, -0.02), (0.055, 0.02)])
    gearbox = lathed([(0.055, 0.02), (0.048, 0.05), (0.044, 0.06)])
    collar = lathed([(0.05, 0.06), (0.05, 0.085)])
    chuck = lathed([(0.038, 0.085), (0.038, 0.115), (0.018, 0.15)])
    bit = lathed([(0.009, 0.14), (0.009, 0.205), (0.0, 0.22)], 12)
    vents = [lathed([(0.0605, x), (0.0605, x + 0.008)]) for x in (-0.165, -0.150, -0.135)]
    along = [
        Part(mesh.pointing((1, 0, 0)).moved(z=z), paint)
        for mesh, paint in (
            (housing, None),
            (gearbox, None),
            (collar, BLACK),
            (chuck, DARK_GRAY),
            (bit, LIGHT_GRAY),
            *((vent, BLACK) for vent in vents),
        )
    ]

    def side_on(outline: list[tuple[float, float]], width: float) -> Mesh:
        """A plate of this width across y, from its (x, z) outline, counter-clockwise seen from -y."""
        return extruded(outline, width).upright().moved(y=width / 2)

    grip = Part(side_on([(-0.135, 0.07), (-0.035, 0.07), (-0.025, 0.30), (-0.125, 0.30)], 0.066))
    rubber = Part(side_on([(-0.145, 0.10), (-0.125, 0.10), (-0.115, 0.285), (-0.135, 0.285)], 0.05), BLACK)
    trigger = Part(side_on([(-0.035, 0.22), (-0.005, 0.225), (-0.01, 0.28), (-0.03, 0.28)], 0.03), BLACK)
    shoe = Part(extruded(rounded_rectangle(0.19, 0.105, 0.02), 0.03).moved(x=-0.075, z=0.055))
    battery = Part(extruded(rounded_rectangle(0.19, 0.105, 0.02), 0.055).moved(x=-0.075), DARK_GRAY)
    parts = (*along, grip, rubber, trigger, shoe, battery)
    return Model(tuple(Part(part.mesh.moved(x=-0.01), part.paint) for part in parts))


@register("mailbox")
def mailbox() -> Model:
    """A box with a rounded top on a post, a door with a knob in front, a raised flag at its side."""
    length, width, low, side = 0.34, 0.20, 0.32, 0.11

    def tunnel(width: float, side: float, length: float) -> Mesh:
        outline = [(-width / 2, 0.0), (width / 2, 0.0), *arc((0.0, side), width / 2, 0.0, 180.0, 14)]
        return extruded(outline, length).lying().moved(z=low)

    body = Part(tunnel(width, side, length).moved(x=-length / 2))
    door = Part(tunnel(width + 0.016, side, 0.014).moved(x=length / 2 - 0.03, z=-0.004))
    knob = Part(rod((length / 2, 0, low + 0.17), (length / 2 + 0.012, 0, low + 0.17), 0.012), LIGHT_GRAY)
    flag_arm = Part(box(0.018, 0.008, 0.20).moved(0.05, -width / 2 - 0.006, low + 0.06), WHITE)
    flag = Part(box(0.075, 0.008, 0.055).moved(0.022, -width / 2 - 0.006, low + 0.235), WHITE)
    post = Part(box(0.06, 0.06, low), GRAY)
    foot = Part(box(0.20, 0.20, 0.02), GRAY)
    return Model((body, door, knob, flag_arm, flag, post, foot))


@register("door handle")
def door_handle() -> Model:
    """A piece of door, upright, with a long plate, a keyhole and a lever on both of its faces."""
    door = Part(box(0.045, 0.24, 0.50), WHITE)
    parts = [door]
    for face in (1.0, -1.0):
        plate = extruded(rounded_rectangle(0.155, 0.43, 0.04), 0.014).pointing((face, 0, 0))
        parts.append(Part(plate.moved(x=face * 0.022, z=0.25)))
        parts.append(Part(rod((face * 0.03, 0.03, 0.33), (face * 0.085, 0.03, 0.33), 0.024)))
        parts.append(Part(rod((face * 0.085, 0.03, 0.33), (face * 0.085, -0.15, 0.325), 0.022)))
        hole = lathed([(0.02, 0.0), (0.02, 0.017)], 16).pointing((face, 0, 0)).moved(face * 0.022, 0.0, 0.17)
        slot = box(0.034, 0.014, 0.05).moved(face * 0.022, 0.0, 0.12)
        parts += [Part(hole, BLACK), Part(slot, BLACK)]
    return Model(tuple(parts))


@register("traffic cone")
def traffic_cone() -> Model:
    """A square foot and a tall cone with two white stripes."""
    foot = extruded(rounded_rectangle(0.31, 0.31, 0.03), 0.03)

    def radius(z: float) -> float:
        return 0.125 - (0.125 - 0.026) * (z - 0.03) / (0.55 - 0.03)

    def slice_of(low: float, high: float) -> list[tuple[float, float]]:
        return [(radius(low), low), (radius(high), high)]

    body = [lathed(slice_of(low, high)) for low, high in ((0.03, 0.20), (0.28, 0.38), (0.44, 0.55))]
    stripes = [lathed(slice_of(low, high)) for low, high in ((0.20, 0.28), (0.38, 0.44))]
    return Model((Part(foot), *(Part(m) for m in body), *(Part(m, WHITE) for m in stripes)))
