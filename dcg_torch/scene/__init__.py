"""Where things are, as names of binary features: states, ranks, and relations between things.

places      what can be spoken of beside the objects: places, and groups of objects
layout      a world's things as arrays, seen from the robot (`layout_making` makes them)
ranks       by itself: clear or covered, on the floor, held ...; among those alike: leftmost, second, biggest ...
relations   to a landmark: above, beside, at which distance and on which side, closest to it of those alike ...
"""

from dcg_torch.scene.groups import groups
from dcg_torch.scene.layout import Layout
from dcg_torch.scene.layout_making import layout
from dcg_torch.scene.order import signatures
from dcg_torch.scene.places import Bounds, places, scene_bounds
from dcg_torch.scene.ranks import RANKS, STATES, ranks, state_signatures, states
from dcg_torch.scene.relation_names import RELATION_NAMES, RELATIONS
from dcg_torch.scene.relations import Relations, between

__all__ = [
    "RANKS",
    "RELATIONS",
    "RELATION_NAMES",
    "STATES",
    "Bounds",
    "Layout",
    "Relations",
    "between",
    "groups",
    "layout",
    "places",
    "ranks",
    "scene_bounds",
    "signatures",
    "state_signatures",
    "states",
]
