"""Of things that a command describes equally well, the first perceived is meant; order changes nothing else."""

from __future__ import annotations

import pytest
from graphs import best_score, pair_of, seeds, solve
from hypothesis import given, settings
from hypothesis import strategies as st
from making import COLORS, VARIANTS, chains, command_tree, trees, worlds

from dcg_torch.fitting.psi import TERNARY
from dcg_torch.types import Object, ParseTree, WorldModel


@st.composite
def worlds_with_twins(draw: st.DrawFn) -> WorldModel:
    """A world in which every thing stands several times, under other ids."""
    things = draw(worlds(3)).objects
    order = draw(st.lists(st.integers(0, len(things) - 1), min_size=2, max_size=24))
    return WorldModel(
        tuple(
            Object(f"t{k}", things[j].type, things[j].known, things[j].hypothetical, things[j].color)
            for k, j in enumerate(order)
        )
    )


class TestEqualScores:
    """Of things that the command describes equally well, the first perceived is meant (Section IV-E)."""

    @settings(max_examples=60)
    @given(world=worlds_with_twins(), tree=chains, seed=seeds, beam=st.integers(1, 9))
    def test_the_first_of_twins_wins(self, world: WorldModel, tree: ParseTree, seed: int, beam: int) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
        chosen = solve(pair, tree, world, beam).best
        assert chosen is not None
        # A parent may want another thing than its children's; then it takes the first such thing.
        taken: set[str] = set()
        for h in reversed(chosen.walk()):
            obj = h.child.grounding.object
            assert obj.id in taken or obj.id == next(o.id for o in world.objects if alike(o, obj) and o.id not in taken)
            taken.add(obj.id)

    @pytest.mark.parametrize("count", [5, 13, 24])
    def test_the_first_of_many_twins(self, count: int) -> None:
        """The sums that decide are over the same numbers in another order; they must not differ in the last bit."""
        tree = command_tree("cube", "red", preposition="to")
        for seed in range(25):
            pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
            world = WorldModel(
                tuple(Object(f"o{k}", "cube" if k % 3 else "cone", True, color="red") for k in range(count))
            )
            chosen = solve(pair, tree, world, 8).best
            assert chosen is not None
            *above, noun = chosen.walk()
            assert noun.child.grounding.object.id in ("o0", "o1")
            for h in above:
                assert h.child.grounding.object.id in ("o0", "o1", "o2", "o3")

    @given(tree=trees, count=st.integers(1, 30), beam=st.integers(1, 9))
    def test_without_any_preference_the_first(self, tree: ParseTree, count: int, beam: int) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, 0)
        pair.model.weight.zero_()
        world = WorldModel(tuple(Object(f"o{k}", "cube", True, color=COLORS[k % 3]) for k in range(count)))
        solution = solve(pair, tree, world, beam)
        assert solution.best is not None
        assert {h.child.grounding.object.id for h in solution.best.walk()} == {"o0"}
        assert solution.probabilities == pytest.approx({o.id: 1 / count for o in world.objects})

    @given(world=worlds(4), tree=trees, seed=seeds, data=st.data())
    def test_probabilities_do_not_depend_on_the_order(
        self, world: WorldModel, tree: ParseTree, seed: int, data: st.DataObject
    ) -> None:
        pair = pair_of(VARIANTS["dcg_upup_away_color"], TERNARY, seed)
        shuffled = WorldModel(tuple(data.draw(st.permutations(world.objects))))
        one, other = solve(pair, tree, world), solve(pair, tree, shuffled)
        assert dict(one.probabilities) == pytest.approx(dict(other.probabilities), abs=1e-10)
        assert best_score(one) == pytest.approx(best_score(other), abs=1e-10)


def alike(one: Object, other: Object) -> bool:
    def look(o: Object) -> tuple[object, ...]:
        return o.type, o.known, o.hypothetical, o.color

    return look(one) == look(other)
