"""The speaker who is one of the things there is what "me" means; who is not there to be seen cannot be meant."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from making import percept, typed

import dcg_torch
from dcg_torch.evaluate import main
from dcg_torch.types import Pose

AT = (2.0, -1.5)
ORDERS = (
    "follow me",
    "please follow me slowly to the crate",
    "robot, come here",
    "could you come over to me",
    "look at me",
    "drive towards me",
    "wait for me",
)
NO_ORDERS = ("tell me a joke", "give me five", "what do you think of me", "help me")


def scene(*, speaker: tuple[float, float] | None = AT, others: tuple[str, ...] = ()) -> dcg_torch.WorldModel:
    there = [
        percept("yellow worker", AT, name="own"),
        percept("blue crate", (3.0, 1.0), name="crate"),
        percept("grey ladder", (1.0, 2.0), name="ladder"),
        *(percept(f"red {text}", (4.0, 2.0 + n), name=text) for n, text in enumerate(others)),
    ]
    where = None if speaker is None else Pose(*speaker)
    return dcg_torch.pretrained().world_model(there, Pose(0.0, 0.0, 0.0), where, looked=True)


def meant(text: str, world: dcg_torch.WorldModel) -> list[str]:
    return [o.id for o in dcg_torch.pretrained().ground(text, world).objects if not o.hypothetical]


@pytest.mark.parametrize("text", ORDERS)
def test_me_is_what_stands_where_the_speaker_does(text: str) -> None:
    assert meant(text, scene()) == ["own"]


@pytest.mark.parametrize("text", ORDERS)
@pytest.mark.parametrize("speaker", [None, (-3.0, 0.5)])
def test_a_speaker_who_is_no_thing_there_is_not_meant(text: str, speaker: tuple[float, float] | None) -> None:
    assert "own" not in meant(text, scene(speaker=speaker))


@pytest.mark.parametrize("text", NO_ORDERS)
def test_what_orders_nothing_is_refused_whoever_is_there(text: str) -> None:
    assert dcg_torch.pretrained().ground(text, scene()).problem is not None


def test_others_are_not_the_speaker() -> None:
    """Who speaks says "me": another of the same kind is meant by its name, unless there is no other."""
    assert meant("follow the worker", scene(others=("worker",))) == ["worker"]
    assert meant("follow the worker", scene()) == ["own"]


def test_things_near_me_are_no_orders_about_me() -> None:
    assert meant("bring me the crate", scene()) == ["crate"]
    assert meant("the ladder far from me", scene()) == ["ladder"]


def test_nothing_is_learned_from_following() -> None:
    model = dcg_torch.pretrained()
    before = dict(model.symbols)
    model.learn(model.ground("follow me", scene()))
    assert dict(model.symbols) == before


def test_evaluate_counts_the_speaker(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    things = [
        {"id": "a", "type": "worker", "position": [*AT, 0.0]},
        {"id": "b", "type": "crate", "position": [3.0, 1.0, 0.0]},
    ]
    speaker = {"x": AT[0], "y": AT[1]}
    episodes = [
        {"id": "1", "text": "follow me", "objects": things, "speaker": speaker, "target": ["a"]},
        {"id": "2", "text": "follow me", "objects": things, "target": []},
        {"id": "3", "text": "sing a song", "objects": things, "speaker": speaker, "target": []},
    ]
    path, run = tmp_path / "said.jsonl", tmp_path / "run"
    path.write_text("".join(json.dumps(one) + "\n" for one in episodes))
    assert typed(capsys, main, "dcg_torch.evaluate", f"test={path}", f"hydra.run.dir={run}")[0] == 0
    rows = [json.loads(line) for line in (run / "predictions.jsonl").read_text().splitlines()]
    assert [row["predicted"] for row in rows] == [["a"], [], []]
    assert [row["refused"] is None for row in rows] == [True, False, False]


def test_who_is_ruled_out_is_not_meant() -> None:
    """The speaker is one of the things: what has been ruled out is so for "me" as well."""
    world = scene()
    others = frozenset(o.id for o in world.objects) - {"own"}
    assert "own" not in meant("drive towards me", replace(world, meant=others))
    assert "own" not in meant("follow me", replace(world, meant=others))
