"""The model that does not lock in its mistakes: `model=open_world`.

mind     what it has learned and what it takes for granted, as values
blocks   which weights follow from the posterior, and which are taught with relations
hearing  how well things fit a command apart from its nouns: what its words may be evidence of
model    `OpenWorldModel`
"""

from dcg_torch.open_world.mind import Census, Mind, OpenWorld
from dcg_torch.open_world.model import OpenWorldModel

__all__ = ["Census", "Mind", "OpenWorld", "OpenWorldModel"]
