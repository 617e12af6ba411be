"""Colour words learned from things that show what they look like, and from things whose colours only have names."""

from __future__ import annotations

import numpy as np
import pytest

import dcg_torch
from dcg_torch.evaluation.episodes import Episode, EpisodeObject
from dcg_torch.evaluation.protocol import Training, train
from dcg_torch.language import default_parser
from dcg_torch.learning.evidence import told_by_look
from dcg_torch.model import GroundingModel
from dcg_torch.types import Object, Percept

SKY, LEAF, STONE = (117.0, 187.0, 253.0), (60.0, 160.0, 40.0), (128.0, 128.0, 128.0)


def patches(word: str, count: int, *, shown: bool = True) -> list[Episode]:
    """A patch that somebody's buckets call blue, beside a green and a grey one; people say `word` of it."""
    rng = np.random.default_rng(4)
    found = []
    for k in range(count):
        looks = [("blue", SKY), ("green", LEAF), ("grey", STONE)]
        things = [
            EpisodeObject(
                id=f"p{j}",
                type="patch",
                color=color,
                position=(1.0, 0.3 - 0.3 * j, 0.5),
                rgb=tuple(np.clip(np.array(rgb) + rng.normal(0.0, 6.0, 3), 0, 255).tolist()) if shown else None,
            )
            for j, (color, rgb) in enumerate(looks)
        ]
        found.append(Episode(id=f"e{k}", text=word, objects=tuple(things), target=("p0",)))
    return found


def prisms(word: str, count: int) -> list[Episode]:
    """Cyan among red and green prisms whose looks nobody knows; people say `word` of it."""
    found = []
    for k in range(count):
        places = [(1.0 + k, 0.5 - 0.5 * j, 0.0) for j in range(3)]
        colors = ["cyan", "red", "green"]
        things = [EpisodeObject(id=c, type="prism", color=c, position=p) for c, p in zip(colors, places, strict=True)]
        found.append(Episode(id=f"t{k}", text=f"take the {word} prism", objects=tuple(things), target=("cyan",)))
    return found


def taught(word: str, *, shown: bool) -> GroundingModel:
    model = dcg_torch.pretrained()
    corpora = [patches(word, 4, shown=shown), prisms(word, 2)]
    train(model, corpora, default_parser().parse, Training(rounds=1))
    return model


def chosen(model: GroundingModel, text: str, colors: list[str]) -> str | None:
    things = [Percept(c, "prism", c, (2.0, 1.0 - k, 0.0)) for k, c in enumerate(colors)]
    answer = model.ground(text, model.world_model(things, looked=True))
    return answer.objects[0].color if answer.objects else None


def test_a_word_for_shades_is_not_bound_to_what_others_call_them() -> None:
    model = taught("sky blue", shown=True)
    assert chosen(model, "take the sky blue pyramid", ["cyan", "red", "green"]) == "cyan"
    assert chosen(model, "take the sky blue pyramid", ["cyan", "blue", "red"]) == "cyan"


def test_a_word_is_bound_to_names_where_there_is_nothing_else() -> None:
    model = taught("sky blue", shown=False)
    assert chosen(model, "take the sky blue pyramid", ["cyan", "blue", "red"]) == "blue"


@pytest.mark.parametrize(
    ("word", "rgb", "told"),
    [("sky blue", SKY, True), ("sky blue", None, False), ("zorp", SKY, False), ("zorp", None, False)],
)
def test_a_look_tells_of_listed_colours_alone(word: str, rgb: tuple[float, float, float] | None, told: bool) -> None:
    unseen = Object("b", "patch", True, True)  # what is only supposed to be there shows nothing
    assert told_by_look(word, [Object("a", "patch", True, False, color="blue", rgb=rgb), unseen]) is told
