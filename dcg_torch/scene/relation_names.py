"""The names of the features that say how a thing stands to landmarks; `relations` says which of them fire."""

from __future__ import annotations

from dcg_torch.scene.layout import NEAREST

DISTANCES = (0.6, 1.2, 1.6, 2.5, 4.0, 6.0)
"""The bounds of the distance features, in units of the world."""
VERTICAL = ("level", "on top", "higher over", "right under", "lower under", "above", "below")
SECTORS = ("ahead", "ahead left", "left", "behind left", "behind", "behind right", "right", "ahead right")
FRAMES = ("side", "side seen", "side spoken")
"""Whose left it is: the robot's as it stands, the robot's as it looks at the landmark, the speaker's as they do."""
ORDERS = ("closest", "farthest")
"""Orders by distance, of which `NEAREST` ranks each are features."""


def _names() -> dict[str, list[str]]:
    """Family of relation features -> the names of its values."""
    bounds = [f"to {d:g}" for d in DISTANCES] + ["farther"]
    families = {"vertical": list(VERTICAL), "distance": bounds, "place distance": bounds}
    families |= {frame: [f"{frame} {s}" for s in SECTORS] for frame in FRAMES}
    for order in ORDERS:
        families[order] = [f"{order} {k}" for k in range(1, NEAREST + 1)]
    families["itself"] = ["itself"]
    families["between"] = ["between", "not between"]
    families["line"] = ["in line across", "in line along"]
    families["direction"] = ["along", "rather along", "aslant", "against"]
    families["part"] = ["in that part", "in another part"]
    families["member"] = ["member", "no member"]
    families["member top"] = ["top member", "lower member"]
    families["member place"] = ["end member", "middle member", "inner member"]
    return families


RELATIONS = {family: [f"relation: {family}, {name}" for name in names] for family, names in _names().items()}
"""Family of relation features -> the names of its values; at most one value of a family fires."""
RELATION_NAMES = [name for names in RELATIONS.values() for name in names]
