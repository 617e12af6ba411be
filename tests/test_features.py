"""Which features fire, which of them meet, and that columns are only ever appended."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import (
    COLORS,
    LEXICON,
    NOVEL,
    SHADES,
    TRAINED,
    VARIANTS,
    noun_phrase,
    objects,
    preposition_phrase,
    random_pair,
    verb_phrase,
)

from dcg_torch.fitting.psi import TERNARY
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet
from dcg_torch.model import GroundingModel, TrainingSet
from dcg_torch.types import (
    Child,
    Correspondence,
    Grounding,
    GroundingKind,
    Object,
    PhraseKind,
    Symbol,
    WorldModel,
)

ALL = VARIANTS["dcg_upup_away_color"]
symbols = st.builds(
    Symbol,
    st.sampled_from([*NOVEL, "gizmo", "thing", "dax"]),
    st.sampled_from(NOVEL),
    st.sampled_from([None, *COLORS, "teal", "purple"]),
    st.sampled_from([None, *COLORS, "teal"]),
)


@pytest.fixture(scope="module")
def features(trained: GroundingModel) -> FeatureSet:
    return trained.features


class TestKnownAndUnknown:
    """Section III-A: a noun is unknown unless it has been grounded to a known type."""

    def test_nouns_of_the_symbols_only(self, features: FeatureSet, training: TrainingSet) -> None:
        said = {e.phrase.noun for e in training.examples} - {None}
        assert {noun for noun in said if features.knows_noun(str(noun))} == {s.word for s in training.symbols}
        assert not features.knows_noun("dax")
        assert not features.knows_noun("fire hydrant")

    def test_a_known_noun_fires_its_own_feature(self, features: FeatureSet) -> None:
        assert set(features.language_names(noun_phrase("cube"))) >= {"noun: cube", "noun known: yes"}
        assert "noun known: no" not in features.language_names(noun_phrase("cube"))

    def test_unknown_nouns_are_all_alike(self, features: FeatureSet) -> None:
        names = features.language_names(noun_phrase("gizmo"))
        assert "noun known: no" in names
        assert names == features.language_names(noun_phrase("fire hydrant"))

    def test_a_pronoun_is_neither(self, features: FeatureSet) -> None:
        assert not any(name.startswith("noun") for name in features.language_names(noun_phrase(None)))

    def test_describing_words_are_no_nouns(self, features: FeatureSet) -> None:
        """In "the cube second from the left" nothing but its head makes a phrase mean a type."""
        names = features.language_names(noun_phrase("sphere", None, ("cube",)))
        assert "noun: cube" not in names

    def test_unknown_colors_are_all_alike(self, features: FeatureSet) -> None:
        names = [features.language_names(noun_phrase("cube", c)) for c in ("mauve", "ochre")]
        assert names[0] == names[1]
        assert {"color stated: yes", "color: unknown"} <= set(names[0])
        assert "color: red" in features.language_names(noun_phrase("cube", "red"))

    def test_unknown_objects_have_no_type(self, features: FeatureSet) -> None:
        one, other = Object("a", "cube", known=False), Object("b", "drill", known=False)
        assert features.object_names(one) == features.object_names(other) == ["known: no"]
        assert features.object_names(Object("c", "cube", known=True)) == ["type: cube", "known: yes"]

    def test_an_unseen_object(self, features: FeatureSet) -> None:
        assert "hypothetical: yes" in features.object_names(Object("a", "cube", True, hypothetical=True))
        assert "hypothetical: yes" not in features.object_names(Object("a", "cube", True))


class TestGroups:
    def test_each_is_switchable(self) -> None:
        """Taking a group away takes its features away, and no others."""
        full = random_pair(ALL, TERNARY, 0, nouns=LEXICON, colors=SHADES, phrases=TRAINED).features
        lost: list[set[str]] = []
        for group in ALL:
            fewer = random_pair(ALL - {group}, TERNARY, 0, nouns=LEXICON, colors=SHADES, phrases=TRAINED).features
            assert set(fewer.language) <= set(full.language)
            assert set(fewer.grounding) <= set(full.grounding)
            lost.append((set(full.language) - set(fewer.language)) | (set(full.grounding) - set(fewer.grounding)))
        assert all(lost)
        assert not any(a & b for a, b in itertools.combinations(lost, 2))
        assert set().union(*lost) == set(full.language) | set(full.grounding)

    def test_none_at_all(self) -> None:
        empty = random_pair(frozenset(), TERNARY, 0, nouns=LEXICON, colors=SHADES, phrases=TRAINED).features
        assert empty.shape == (0, 0)

    def test_colors_need_theirs(self) -> None:
        plain = random_pair(VARIANTS["dcg_upup_away"], TERNARY, 0, nouns=LEXICON, colors=SHADES, phrases=TRAINED)
        assert plain.features.language_names(noun_phrase("cube", "red")) == plain.features.language_names(
            noun_phrase("cube")
        )


class TestPairs:
    """A feature is a pair of names that have to do with each other."""

    def meets(self, features: FeatureSet, left: str, right: str) -> bool:
        return bool(features.pairs[features.language[left], features.grounding[right]])

    def test_nouns_meet_types_only(self, features: FeatureSet) -> None:
        assert self.meets(features, "noun: cube", "type: sphere")
        assert not self.meets(features, "noun: cube", "color: red")
        assert not self.meets(features, "noun: cube", "hypothetical: yes")

    def test_colors_meet_colors_only(self, features: FeatureSet) -> None:
        assert self.meets(features, "color: red", "color: blue")
        assert not self.meets(features, "color: red", "type: cube")

    def test_verbs_meet_their_children(self, features: FeatureSet) -> None:
        assert self.meets(features, "verb: go", "child: region, same, active")
        assert not self.meets(features, "verb: go", "type: cube")

    def test_a_noun_being_unknown_meets_the_object_being_so(self, features: FeatureSet) -> None:
        assert self.meets(features, "noun known: no", "known: no")
        assert not self.meets(features, "noun known: no", "color: red")

    def test_shape(self, features: FeatureSet) -> None:
        assert features.pairs.shape == features.shape == (len(features.language), len(features.grounding))


def fired(features: FeatureSet, kind: GroundingKind, world: WorldModel, children: tuple[Child, ...]) -> list[set[str]]:
    """For every grounding of a kind, the names of the features that fire."""
    names = list(features.grounding)
    bag = features.encode_groundings(kind, world, [children])[0]
    return [{names[column] for column in row if column >= 0} for row in bag]


class TestChildren:
    def test_a_grounding_and_its_child(self, features: FeatureSet) -> None:
        a, b = Object("a", "cube", True), Object("b", "cube", True)
        near = Child(Grounding(GroundingKind.REGION, a), Correspondence.INVERTED)
        own, other = fired(features, GroundingKind.ACTION, WorldModel((a, b)), (near,))
        assert "child: region, same, inverted" in own
        assert "child: region, other, inverted" in other
        assert "kind: action" in own & other

    def test_only_objects_have_types(self, features: FeatureSet) -> None:
        world = WorldModel((Object("a", "cube", True, color="red"),))
        assert fired(features, GroundingKind.REGION, world, ()) == [{"kind: region"}]
        names = list(features.grounding)
        assert "type: cube" in {names[column] for column in features.thing_columns(world.objects[0])}

    def test_every_kind_of_phrase_has_a_kind_of_grounding(self) -> None:
        assert set(GROUNDING_OF) == set(PhraseKind)
        assert set(GROUNDING_OF.values()) == set(GroundingKind)


class TestGrowth:
    @given(learned=st.lists(symbols, max_size=6))
    def test_columns_are_appended(self, features: FeatureSet, learned: list[Symbol]) -> None:
        grown = features
        for symbol in learned:
            before, grown = grown, grown.grow(symbol)
            for old, new in ((before.language, grown.language), (before.grounding, grown.grounding)):
                assert list(new.items())[: len(old)] == list(old.items())
                assert sorted(new.values()) == list(range(len(new)))
            rows, columns = before.shape
            assert (grown.pairs[:rows, :columns] == before.pairs).all()
            assert grown.knows_noun(symbol.word)

    @given(symbol=symbols)
    def test_growing_twice_is_growing_once(self, features: FeatureSet, symbol: Symbol) -> None:
        once = features.grow(symbol)
        assert once.grow(symbol) == once

    def test_the_old_set_stays_as_it_was(self, features: FeatureSet) -> None:
        before = dict(features.language)
        features.grow(Symbol("fire hydrant", "fire hydrant", "red", "red"))
        assert features.language == before

    @given(obj=objects(0), learned=st.lists(symbols, max_size=3))
    def test_old_phrases_and_objects_fire_as_before(
        self, features: FeatureSet, obj: Object, learned: list[Symbol]
    ) -> None:
        grown = features
        for symbol in learned:
            grown = grown.grow(symbol)
        if obj.color not in {c for s in learned for c in (s.color, s.color_word)} and obj.type not in NOVEL:
            assert grown.object_names(obj) == features.object_names(obj)
        for phrase in (verb_phrase("go"), preposition_phrase("to"), noun_phrase("cube", "red")):
            assert grown.language_names(phrase) == features.language_names(phrase)
