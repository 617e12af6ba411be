"""The training set as what is known changes: replace_unknown (line 23), and the contrast of all known types."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from making import KNOWN, command_tree, noun_phrase

from dcg_torch.learning.commit_first import contrast, replace_unknown
from dcg_torch.types import Child, Correspondence, Example, Grounding, GroundingKind, Object, Symbol, WorldModel

ACTIVE, INACTIVE = Correspondence.ACTIVE, Correspondence.INACTIVE


class TestLine23:
    """replace_unknown: what was unknown when an example was recorded is known now."""

    def example(self) -> Example:
        drill, cone = Object("d", "drill", False), Object("c", "cone", False)
        world = WorldModel((drill, cone, Object("k", "cube", True), Object("h", None, False, True)))
        child = Child(Grounding(GroundingKind.OBJECT, drill))
        return Example(noun_phrase("gizmo"), world, (ACTIVE, INACTIVE, INACTIVE, INACTIVE), (child,))

    def test_the_positive(self) -> None:
        (new,) = replace_unknown([self.example()], ["cube", "drill"])
        assert [o.known for o in new.world.objects] == [True, False, True, False]
        assert new.correspondences == self.example().correspondences

    def test_the_negatives_too(self) -> None:
        (new,) = replace_unknown([self.example()], ["cube", "cone"])
        assert [o.known for o in new.world.objects] == [False, True, True, False]

    def test_the_children_too(self) -> None:
        (new,) = replace_unknown([self.example()], ["cube", "drill"])
        assert new.children[0].grounding.object == new.world.objects[0]

    def test_the_hypothetical_unknown_stays_unknown(self) -> None:
        (new,) = replace_unknown([self.example()], ["cube", "drill", "cone"])
        assert not new.world.objects[3].known

    def test_nothing_to_replace(self) -> None:
        example = self.example()
        (same,) = replace_unknown([example], ["cube"])
        assert same is example

    @given(types=st.sets(st.sampled_from(["cube", "drill", "cone", "mailbox"])))
    def test_is_a_function_of_what_is_known(self, types: set[str]) -> None:
        once = replace_unknown([self.example()], types)
        assert replace_unknown(once, types) == once
        assert replace_unknown(replace_unknown([self.example()], ["drill", "cone"]), types) == once
        assert all(o.known == (o.type in types) for e in once for o in e.world.objects)


class TestContrast:
    """Upsilon spans all symbols: training sees one of every known type that was not meant."""

    SYMBOLS = {t: Symbol(t, t) for t in KNOWN}  # noqa: RUF012

    def example(self, noun: str = "cube") -> Example:
        world = WorldModel((Object("a", "cube", True, color="red"), Object("b", "dax", False)))
        return Example(noun_phrase(noun, "red"), world, (ACTIVE, INACTIVE))

    def test_the_others_have_the_same_attributes(self) -> None:
        new = contrast(self.example(), self.SYMBOLS)
        added = new.world.objects[2:]
        assert [(o.type, o.known, o.color, o.hypothetical) for o in added] == [
            ("sphere", True, "red", False),
            ("cylinder", True, "red", False),
        ]
        assert new.correspondences == (ACTIVE, INACTIVE, INACTIVE, INACTIVE)
        assert len({o.id for o in new.world.objects}) == 4

    def test_the_type_that_the_noun_names_is_spared(self) -> None:
        """ "Sphere" said of a cube is no evidence that it could not be a sphere."""
        assert [o.type for o in contrast(self.example("sphere"), self.SYMBOLS).world.objects[2:]] == ["cylinder"]

    def test_only_noun_phrases_with_one_meaning(self) -> None:
        verb = Example(command_tree("cube").phrase, self.example().world, (ACTIVE, INACTIVE))
        nothing = Example(noun_phrase("cube"), self.example().world, (INACTIVE, None))
        assert contrast(verb, self.SYMBOLS) is verb
        assert contrast(nothing, self.SYMBOLS) is nothing
