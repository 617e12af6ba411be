"""A tree in the words of a scene: each thing said in one way, by what is there."""

from __future__ import annotations

from dcg_torch.interpretation.alternatives import by_alternatives
from dcg_torch.interpretation.anaphora import by_introduction
from dcg_torch.interpretation.bearers import by_bearers
from dcg_torch.interpretation.compounds import by_compounds
from dcg_torch.interpretation.denials import by_denials
from dcg_torch.interpretation.faces import by_faces
from dcg_torch.interpretation.generic_nouns import by_generic_nouns
from dcg_torch.interpretation.loads import by_loads
from dcg_torch.interpretation.middles import by_middles
from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.interpretation.passages import by_passages
from dcg_torch.interpretation.plain_lines import lines_from_here
from dcg_torch.interpretation.plain_sets import by_members, few_together, one_pair, several_pairs
from dcg_torch.interpretation.plural_nouns import by_plural_nouns
from dcg_torch.interpretation.room_parts import by_corners, by_heights
from dcg_torch.interpretation.rooms import by_rooms
from dcg_torch.interpretation.same_kind_landmarks import by_same_kind
from dcg_torch.interpretation.shelves import by_shelves
from dcg_torch.interpretation.stacks import by_levels
from dcg_torch.interpretation.surfaces import by_surfaces
from dcg_torch.interpretation.walls import by_walls
from dcg_torch.types import ParseTree, WorldModel

_REWRITES = (
    by_generic_nouns,
    by_passages,
    by_plural_nouns,
    by_members,
    by_introduction,
    by_same_kind,
    by_rooms,
    by_loads,
    by_compounds,
    by_faces,
    by_corners,
    by_walls,
    by_bearers,
    by_surfaces,
    by_alternatives,
    by_denials,
    by_heights,
    by_levels,
    by_shelves,
    by_middles,
    one_pair,
    several_pairs,
    few_together,
    lines_from_here,
)
"""What turns words into others that say the same in a scene, in the order in which they are tried."""


def in_scene_words(tree: ParseTree, world: WorldModel) -> ParseTree:
    """A tree in the words of a scene; few commands say anything that would be said in others."""
    said = Words.of(tree)
    for rewrite in _REWRITES:
        found = rewrite(tree, said, world)
        if found is not tree and found != tree:  # what is kept of a tree is kept of this very one
            tree, said = found, Words.of(found)
    return tree
