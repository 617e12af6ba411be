"""The trained model decides as the paper says, in any world, before and after lessons."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import given, settings
from hypothesis import strategies as st
from making import COLORS, KNOWN, NOVEL, chosen, command_tree, saw

from dcg_torch.model import GroundingModel
from dcg_torch.scene.upsilon import HYPOTHETICAL_UNKNOWN
from dcg_torch.types import WorldModel

Pupil = Callable[[], GroundingModel]


def policy(lexicon: dict[str, str], noun: str, color: str | None, world: WorldModel) -> str:
    """The paper's policy: the first perceived object that fits, else the hypothetical one that does."""
    known = set(lexicon.values())
    for o in world.objects:
        if o.hypothetical or (color is not None and o.color != color):
            continue
        if (o.type == lexicon[noun]) if noun in lexicon else (o.type not in known):
            return o.id
    return f"hypothetical {lexicon[noun]}" if noun in lexicon else HYPOTHETICAL_UNKNOWN


sights = st.lists(
    st.tuples(st.sampled_from(COLORS), st.sampled_from([*KNOWN, *NOVEL])).map(" ".join), max_size=7, unique=True
)
sayings = st.tuples(st.sampled_from([*KNOWN, *NOVEL]), st.sampled_from([None, *COLORS]))
ways = st.sampled_from(
    [
        (("go",), "to"),
        (("approach",), None),
        (("find",), None),
        (("drive",), "towards"),
        (("head",), "over to"),
        ((), None),
    ]
)


class TestPolicy:
    """The trained model decides as the paper says, in any world, before and after lessons."""

    @settings(max_examples=150)
    @given(seen=sights, saying=sayings, way=ways)
    def test_before_any_lesson(
        self,
        trained: GroundingModel,
        seen: list[str],
        saying: tuple[str, str | None],
        way: tuple[tuple[str, ...], str | None],
    ) -> None:
        world = saw(trained, *seen)
        tree = command_tree(*saying, verb=way[0], preposition=way[1])
        assert chosen(trained, tree, world).id == policy({t: t for t in KNOWN}, *saying, world)

    @settings(max_examples=40)
    @given(seen=sights, saying=sayings)
    def test_with_binary_correspondences(
        self, binary: GroundingModel, seen: list[str], saying: tuple[str, str | None]
    ) -> None:
        world = saw(binary, *seen)
        assert chosen(binary, command_tree(*saying), world).id == policy({t: t for t in KNOWN}, *saying, world)

    @settings(max_examples=8)
    @given(
        lessons=st.lists(st.tuples(sights, sayings), min_size=1, max_size=6),
        probes=st.lists(st.tuples(sights, sayings), min_size=5, max_size=10),
    )
    def test_after_lessons(
        self,
        pupil: Pupil,
        lessons: list[tuple[list[str], tuple[str, str | None]]],
        probes: list[tuple[list[str], tuple[str, str | None]]],
    ) -> None:
        """What a lesson says is believed for ever, right or wrong."""
        model, lexicon = pupil(), {t: t for t in KNOWN}
        for seen, saying in lessons:
            world = saw(model, *seen)
            solution = model.ground(command_tree(*saying), world)
            assert solution.object is not None
            assert solution.object.id == policy(lexicon, *saying, world)
            symbol = model.learn(solution)
            if saying[0] not in lexicon and not solution.object.hypothetical:
                assert symbol is not None
                lexicon[saying[0]] = str(solution.object.type)
            assert {w: s.type for w, s in model.symbols.items()} == lexicon
        for seen, saying in probes:
            world = saw(model, *seen)
            assert chosen(model, command_tree(*saying), world).id == policy(lexicon, *saying, world)

    @given(seen=sights, noun=st.sampled_from(KNOWN), color=st.sampled_from(COLORS))
    def test_the_ranks_in_between(self, trained: GroundingModel, seen: list[str], noun: str, color: str) -> None:
        """In view beats unseen, unseen beats the wrong colour, and all beat the wrong type."""
        other = COLORS[COLORS.index(color) - 1]
        world = saw(trained, *(t for t in seen if t.split()[1] != noun), f"{other} {noun}", f"{color} {noun}")
        p = trained.ground(command_tree(noun, color), world).probabilities
        unseen = p[f"hypothetical {noun}"]
        by_text = {o.id.partition(" ")[2]: p[o.id] for o in world.objects if not o.hypothetical}
        assert by_text[f"{color} {noun}"] > unseen > by_text[f"{other} {noun}"]
        strangers = [share for text, share in by_text.items() if text.partition(" ")[2] != noun]
        assert all(unseen > share for share in strangers)
        assert unseen > p[HYPOTHETICAL_UNKNOWN]
