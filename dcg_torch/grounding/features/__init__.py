"""Named binary features of phrases and of groundings, and the columns they have.

A feature f of the paper is a pair (language feature, grounding feature). The feature groups of eqs. 4 to 9 say
which names may fire:

    F_DCG            the words of a phrase, the type of a known object, how a grounding relates to its children
    F_U              is the noun known, is the object's type known
    F_H              is the object hypothetical
    F_C              the stated colour (f_word) and the object's colour (f_color)
    relation         beyond the paper: how things stand by themselves, among those alike, and to landmarks (`space`)

and `PAIRS` which of them meet: a noun with types, a stated colour with colours, a verb with the relation to its
child. Without that restriction a word learned from one blue object would come to mean "blue" as well.

What is known is a fact about the columns: a noun or colour without a column of its own fires the "unknown"
feature instead. Columns are only ever appended, so old indices stay valid.
"""

from dcg_torch.grounding.features.columns import FeatureSet, KindColumns, padded
from dcg_torch.grounding.features.name_facts import Said, look_codes
from dcg_torch.grounding.features.names import (
    GROUNDING_OF,
    PAIRS,
    PAPER,
    Feature,
    Group,
    Ranking,
    child_feature,
    picked_from,
    ranking,
)
from dcg_torch.grounding.features.prior_weights import give_odds

__all__ = [
    "GROUNDING_OF",
    "PAIRS",
    "PAPER",
    "Feature",
    "FeatureSet",
    "Group",
    "KindColumns",
    "Ranking",
    "Said",
    "child_feature",
    "give_odds",
    "look_codes",
    "padded",
    "picked_from",
    "ranking",
]
