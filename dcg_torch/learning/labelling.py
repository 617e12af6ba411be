"""A phrase and what it means as a labelled example: the positive one, and the negatives that it implies."""

from __future__ import annotations

from dcg_torch.types import Child, Correspondence, Example, Object, Phrase, PhraseKind, WorldModel


def labelled(
    phrase: Phrase, meant: Child, children: tuple[Child, ...], world: WorldModel, *, unseen_alike: bool = False
) -> Example:
    """One positive example, with the negatives that it implies: all that the phrase does not describe as well.

    Args:
        unseen_alike: leave the hypothetical object of the meant one's type unlabelled too.
    """
    chosen = meant.grounding.object

    def label(o: Object) -> Correspondence | None:
        if o.id == chosen.id:
            return meant.correspondence
        if phrase.kind is PhraseKind.MODIFIER:
            return None  # it describes, it does not pick: others may stand so too
        if phrase.kind is PhraseKind.NOUN and (
            described_alike(phrase, o, chosen) or (unseen_alike and o.hypothetical and o.type == chosen.type)
        ):
            return None
        return Correspondence.INACTIVE

    return Example(
        phrase, world, tuple(label(o) for o in (world.objects if chosen in world.objects else world.things)), children
    )


def described_alike(phrase: Phrase, one: Object, other: Object) -> bool:
    """Would a noun phrase that means `other` describe `one` as well?

    Both of one type, in or out of view alike, and of one colour if the phrase states any.
    """
    same_kind = one.type == other.type and one.known == other.known and one.hypothetical == other.hypothetical
    return same_kind and (phrase.color is None or one.color == other.color)
