"""Who gives the commands: everything that is said is about one object of one world."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import world_file

from dcg_torch.language import Parser
from dcg_torch.world.files import World, WrittenCommand
from dcg_torch.world.generator import COLORS, TYPES, generate_world
from dcg_torch.world.speaker import (
    CANONICAL_FORMS,
    GeneratingSpeaker,
    SpeakerError,
    WrittenSpeaker,
    draw_trial,
    human_names,
    make_speaker,
)

WORLD = world_file(("red cube", 1.0, 0.0), ("blue fire hydrant", 0.0, 2.0), ("green door handle", -2.0, 0.0))
seeds = st.integers(0, 2**32)


def said(world: World, *commands: tuple[str, str]) -> World:
    return world.model_copy(
        update={
            "commands": tuple(WrittenCommand(text=t, target=o, noun=t.split()[-1], away=False) for t, o in commands)
        }
    )


class TestCanonical:
    @given(seed=seeds)
    def test_a_command_for_every_object(self, seed: int) -> None:
        world = generate_world(np.random.default_rng(seed), "made")
        commands = GeneratingSpeaker().commands(world, np.random.default_rng(seed))
        assert [c.target for c in commands] == [o.id for o in world.objects]
        for command, obj in zip(commands, world.objects, strict=True):
            assert (command.noun, command.color) == (obj.type, obj.color)
            assert command.text in {form.format(thing=f"{obj.color} {obj.type}") for form in CANONICAL_FORMS}

    def test_color_rate(self) -> None:
        rng = np.random.default_rng(0)
        colored = [c.color is not None for _ in range(200) for c in GeneratingSpeaker(0.8).commands(WORLD, rng)]
        # 600 draws: within four standard deviations of 0.8.
        assert abs(np.mean(colored) - 0.8) < 4 * (0.8 * 0.2 / 600) ** 0.5
        assert all(c.color is None for c in GeneratingSpeaker(0.0).commands(WORLD, rng))
        assert all(c.color is not None for c in GeneratingSpeaker(1.0).commands(WORLD, rng))

    @given(seed=seeds, rate=st.sampled_from([0.0, 0.5, 1.0]))
    def test_one_seed_one_text(self, seed: int, rate: float) -> None:
        one, other = (GeneratingSpeaker(rate).commands(WORLD, np.random.default_rng(seed)) for _ in range(2))
        assert one == other

    @pytest.mark.parametrize("rate", [-0.1, 1.1, float("nan")])
    def test_a_share_lies_between_0_and_1(self, rate: float) -> None:
        with pytest.raises(SpeakerError, match="color_rate"):
            GeneratingSpeaker(rate)

    @pytest.mark.parametrize("form", CANONICAL_FORMS)
    @pytest.mark.parametrize("kind", TYPES)
    def test_the_parser_reads_what_is_said(self, parser: Parser, form: str, kind: str) -> None:
        for color in (None, COLORS[0]):
            parse = parser.parse(form.format(thing=kind if color is None else f"{color} {kind}"), TYPES[:3])
            assert (parse.noun, parse.color) == (kind, color)


class TestHuman:
    def test_every_type_has_names(self) -> None:
        assert set(human_names()) == set(TYPES)
        assert all(count > 0 for names in human_names().values() for count in names.values())
        assert all(kind in names for kind, names in human_names().items())

    def test_names_are_drawn_as_often_as_they_are_used(self) -> None:
        speaker, rng = GeneratingSpeaker(0.0, {"cube": {"cube": 3.0, "block": 1.0}}), np.random.default_rng(1)
        world = world_file(("red cube", 1.0, 0.0))
        counts = Counter(speaker.commands(world, rng)[0].noun for _ in range(400))
        assert abs(counts["block"] - 100) < 4 * (400 * 0.25 * 0.75) ** 0.5
        assert set(counts) == {"cube", "block"}

    def test_a_type_without_names_is_called_by_its_own(self) -> None:
        commands = GeneratingSpeaker(1.0, {"cube": {"box": 1.0}}).commands(WORLD, np.random.default_rng(0))
        assert [c.noun for c in commands] == ["box", "fire hydrant", "door handle"]


class TestWritten:
    def test_as_they_stand(self) -> None:
        world = said(WORLD, ("go to the cube", "red_cube"), ("find the hydrant", "blue_fire_hydrant"))
        commands = WrittenSpeaker().commands(world, np.random.default_rng(0))
        assert [(c.text, c.noun, c.target) for c in commands] == [
            ("go to the cube", "cube", "red_cube"),
            ("find the hydrant", "hydrant", "blue_fire_hydrant"),
        ]

    def test_a_world_without_any(self) -> None:
        with pytest.raises(SpeakerError, match=r"made.*speaker=canonical") as caught:
            WrittenSpeaker().commands(WORLD, np.random.default_rng(0))
        assert "\n" not in str(caught.value)


class TestMake:
    def test_each_kind(self) -> None:
        assert isinstance(make_speaker("written", 1.0), WrittenSpeaker)
        canonical, human = make_speaker("canonical", 0.3), make_speaker("human", 0.3)
        assert isinstance(canonical, GeneratingSpeaker)
        assert isinstance(human, GeneratingSpeaker)
        assert (canonical.color_rate, canonical.names) == (0.3, {})
        assert human.names == human_names()

    def test_no_such_speaker(self) -> None:
        with pytest.raises(SpeakerError, match="canonical, written"):
            make_speaker("parrot", 1.0)


class TestDrawTrial:
    @given(seed=seeds, iterations=st.integers(1, 6))
    def test_without_replacement(self, seed: int, iterations: int) -> None:
        worlds = [WORLD, WORLD.model_copy(update={"name": "other"})]
        drawn = draw_trial(worlds, GeneratingSpeaker(), iterations, np.random.default_rng(seed))
        assert len({(c.world.name, c.target) for c in drawn}) == len(drawn) == iterations

    def test_every_pair_is_as_likely(self) -> None:
        rng = np.random.default_rng(2)
        firsts = Counter(draw_trial([WORLD], GeneratingSpeaker(), 1, rng)[0].target for _ in range(600))
        assert all(abs(count - 200) < 4 * (600 * 2 / 9) ** 0.5 for count in firsts.values())
        assert len(firsts) == 3

    def test_too_few(self) -> None:
        with pytest.raises(SpeakerError, match=r"iterations=4.* have 3 commands"):
            draw_trial([WORLD], GeneratingSpeaker(), 4, np.random.default_rng(0))
