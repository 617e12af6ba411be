"""The Gymnasium environment: its interface, its episodes, its rewards, and the agents in it."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

gymnasium = pytest.importorskip("gymnasium", reason="needs the extra gym")

from gymnasium.utils.env_checker import check_env, data_equivalence  # noqa: E402
from gymnasium.vector import AsyncVectorEnv, SyncVectorEnv  # noqa: E402

from dcg_torch.apps.gym import ID  # noqa: E402
from dcg_torch.apps.gym.agents import Agent, EnvRobot, open_world_settings, paper_settings  # noqa: E402
from dcg_torch.apps.gym.env import GroundEnv  # noqa: E402
from dcg_torch.apps.gym.scenario import Act, Reply  # noqa: E402
from dcg_torch.experiment.factory import make_explorer, make_model  # noqa: E402
from dcg_torch.experiment.plan import trial_commands, trial_generators  # noqa: E402
from dcg_torch.experiment.trial import run_trial  # noqa: E402
from dcg_torch.language import default_parser  # noqa: E402
from dcg_torch.settings import Asking, Settings, SettingsError, Speaker  # noqa: E402
from dcg_torch.simulator import FakeRobot  # noqa: E402

ROOT = Path(__file__).parent.parent


def act(env: Any, kind: Act, percept: int = 0) -> tuple[Any, float, bool, bool, dict[str, Any]]:
    result: tuple[Any, float, bool, bool, dict[str, Any]] = env.step(np.array([kind, percept]))
    return result


def own_world(folder: Path, *commands: dict[str, Any]) -> str:
    """A folder with one world: a red cube ahead of the robot, a blue one behind it."""
    things = [
        {"id": "near", "type": "cube", "color": "red", "position": [2.0, 0.0]},
        {"id": "far", "type": "cubé", "color": "blue", "position": [-3.0, 0.0]},
    ]
    world = {"name": "own", "objects": things, "commands": list(commands)}
    (folder / "own.yaml").write_text(yaml.safe_dump(world, allow_unicode=True), encoding="utf-8")
    return str(folder)


def made(folder: Path, **command: Any) -> GroundEnv:
    said = {"text": "go to the red cube", "target": "near", "noun": "cube", **command}
    env = GroundEnv(worlds=own_world(folder, said), speaker="written", iterations=1)
    env.reset(seed=0)
    return env


@pytest.mark.parametrize("settings", [{}, {"worlds": "committed", "speaker": "written", "wrong_class": 0.2}])
def test_the_checker_of_gymnasium_finds_nothing(settings: dict[str, Any]) -> None:
    """Warnings are errors here."""
    check_env(gymnasium.make(ID, **settings).unwrapped)


def episodes(env: Any, number: int, seed: int) -> list[Any]:
    """The first observations of some episodes, and what a few looks show."""
    found = []
    for k in range(number):
        found.append(env.reset(seed=seed if k == 0 else None))
        found += [act(env, Act.LOOK) for _ in range(3)]
    return found


def test_a_seed_gives_the_same_episodes_and_another_one_others() -> None:
    first, again, other = (episodes(GroundEnv(iterations=2, wrong_class=0.5), 5, seed) for seed in (7, 7, 8))
    assert all(data_equivalence(a, b, exact=True) for a, b in zip(first, again, strict=True))
    assert [o[0]["command"] for o in first[::4]] != [o[0]["command"] for o in other[::4]]


def test_episodes_are_the_commands_of_the_experiment_in_their_order() -> None:
    env = GroundEnv(iterations=3)
    settings = Settings(seed=5, iterations=3, worlds="generated", speaker=Speaker.canonical)
    expected = [(t, k, c.text, c.world.name) for t in range(2) for k, c in enumerate(trial_commands(settings, t))]
    got = []
    for k in range(6):
        seen, info = env.reset(seed=5 if k == 0 else None)
        got.append((info["trial"], info["iteration"], seen["command"], info["world"]))
    assert got == expected
    seen, info = env.reset(options={"trial": 1})
    assert (info["trial"], info["iteration"], seen["command"]) == expected[3][:3]


def test_an_unseeded_environment_is_not_always_the_same() -> None:
    first, other = GroundEnv(), GroundEnv()
    commands = [[env.reset()[0]["command"] for _ in range(10)] for env in (first, other)]
    assert commands[0] != commands[1]


def test_the_right_drive_is_rewarded_and_looks_and_questions_cost(tmp_path: Path) -> None:
    env = made(tmp_path)
    seen, reward, over, cut, info = act(env, Act.LOOK)
    assert (reward, over, cut, len(seen["percepts"])) == (-0.01, False, False, 1)
    seen, reward, over, _, _ = act(env, Act.ASK, 0)
    assert (seen["reply"], reward, over) == (Reply.YES, -0.1, False)
    seen, reward, over, _, info = act(env, Act.DRIVE, 0)
    assert (seen["reply"], reward, over, info["problem"]) == (Reply.NOTHING, 0.0, False, "")
    assert math.dist(seen["robot"][:2], (2.0, 0.0)) < 0.6
    _, reward, over, _, info = act(env, Act.DONE)
    assert (reward, over, info["correct"], info["target"], info["reached"]) == (1.0, True, True, 0, 0)
    assert (info["target_id"], info["target_type"], info["target_color"]) == ("near", "cube", "red")


def test_a_turn_shows_what_is_behind_and_the_last_drive_counts(tmp_path: Path) -> None:
    env = made(tmp_path)
    for _ in range(9):
        seen = act(env, Act.LOOK)[0]
    assert [p["type"] for p in seen["percepts"]] == ["cube", "cubé"]
    assert seen in env.observation_space
    assert "cubé" in env.render()
    assert act(env, Act.ASK, 1)[0]["reply"] == Reply.NO
    act(env, Act.DRIVE, 0)
    act(env, Act.DRIVE, 1)
    _, reward, _, _, info = act(env, Act.DONE)
    assert (reward, info["correct"], info["target"], info["reached"]) == (0.0, False, 0, 1)


def test_done_without_a_drive_is_wrong_and_what_was_not_seen_has_no_number(tmp_path: Path) -> None:
    _, reward, over, _, info = act(made(tmp_path, target="far"), Act.DONE)
    assert (reward, over, info["correct"], info["target"], info["reached"]) == (0.0, True, False, -1, -1)
    assert info["target_id"] == "far"


def test_an_order_to_keep_away_is_obeyed_by_leaving(tmp_path: Path) -> None:
    for kind, right in ((Act.LEAVE, True), (Act.DRIVE, False)):
        env = made(tmp_path, text="stay away from the red cube", away=True)
        act(env, kind, 0)
        assert act(env, Act.DONE)[4]["correct"] is right


@pytest.mark.parametrize("kind", [Act.DRIVE, Act.LEAVE, Act.ASK])
def test_an_act_about_a_percept_that_is_not_there_does_nothing(tmp_path: Path, kind: Act) -> None:
    env = made(tmp_path)
    seen, reward, over, _, info = act(env, kind, 1)
    assert (reward, over, info["problem"], seen["reply"]) == (0.0, False, "there is no percept 1", Reply.NOTHING)
    assert seen["robot"].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"speakr": "canonical"}, "speakr: there is no such setting here; did you mean speaker?"),
        ({"trials": 3}, "trials: there is no such setting"),
        ({"speaker": "nobody"}, "speaker='nobody': choose from canonical"),
        ({"simulator": "gazebo"}, "simulator='gazebo': choose from pybullet, fake"),
        ({"iterations": "ten"}, "iterations='ten': give a number"),
        ({"types": 900}, "types=900: give a number from 1"),
    ],
)
def test_a_setting_that_makes_no_sense_is_one_line(settings: dict[str, Any], says: str) -> None:
    with pytest.raises(SettingsError) as caught:
        GroundEnv(**settings)
    assert str(caught.value).startswith(says)
    assert "\n" not in str(caught.value)


def test_vectors_of_environments_go_as_single_ones() -> None:
    """Each environment of a vector is the one of its own seed, in one process and in several."""
    actions = [np.array([[Act.LOOK, 0]] * 3), np.array([[Act.DONE, 0]] * 3), np.array([[Act.LOOK, 0]] * 3)]
    makers = [lambda: gymnasium.make(ID, iterations=2)] * 3
    vectors = [SyncVectorEnv(makers), AsyncVectorEnv(makers, shared_memory=False)]
    for vector in vectors:
        seen, _ = vector.reset(seed=4)
        rewards, over = [], []
        looks = [seen]
        for action in actions:
            seen, reward, ended, _, _ = vector.step(action)
            looks.append(seen)
            rewards.append(reward.tolist())
            over.append(ended.tolist())
        vector.close()
        assert rewards == [[-0.01] * 3, [0.0] * 3, [0.0] * 3]  # the step after the end begins anew
        assert over == [[False] * 3, [True] * 3, [False] * 3]
        for k in range(3):
            single = GroundEnv(iterations=2)
            first = single.reset(seed=4 + k)[0]
            alone = [first, act(single, Act.LOOK)[0], act(single, Act.DONE)[0], single.reset()[0]]
            for one, many in zip(alone, looks, strict=True):
                assert (many["command"][k], many["reply"][k]) == (one["command"], one["reply"])
                assert data_equivalence(many["percepts"][k], one["percepts"], exact=True)
                assert many["robot"][k].tolist() == one["robot"].tolist()


def test_the_paper_policy_does_through_the_environment_what_it_does_in_the_experiment() -> None:
    settings = Settings(seed=3, iterations=6, worlds="generated", speaker=Speaker.canonical)
    model = make_model(settings.model, settings.names)
    rows = run_trial(
        0,
        trial_commands(settings, 0),
        model,
        default_parser().parse,
        FakeRobot(),
        trial_generators(3, 0)[2],
        spin_step=math.radians(settings.simulator.spin_step),
        explorer=make_explorer(settings, model),
    )
    agent = Agent(gymnasium.make(ID, iterations=6), paper_settings())
    symbols = {}
    for k, (row, _) in enumerate(rows):
        played = agent.play(seed=3 if k == 0 else None)
        assert played.info["correct"] == row.correct
        assert played.outcome.solution is not None
        assert row.probability in (None, played.outcome.solution.probability)
        assert (played.info["target_id"], played.info["problem"]) == (row.target, "")
        symbols = row.symbols
    assert symbols
    learned = {word: symbol.type for word, symbol in agent.model.symbols.items()}
    assert symbols.items() <= learned.items()
    agent.play()  # of the next trial, for which it starts anew
    assert len(agent.model.symbols) <= len(learned) - len(symbols) + 1


def test_the_shipped_model_asks_and_is_right() -> None:
    agent = Agent(gymnasium.make(ID), open_world_settings(Asking.when_unsure))
    played = [agent.play(seed=1 if k == 0 else None) for k in range(10)]
    assert sum(p.info["correct"] for p in played) >= 9
    asked = [p for p in played if p.outcome.asked]
    assert asked
    assert all(p.reward <= 0.9 + 1e-9 for p in asked)


def test_a_robot_whose_episode_was_cut_off_stands_still() -> None:
    robot = EnvRobot(gymnasium.make(ID, max_episode_steps=2))
    robot.reset(seed=0)
    robot.spin(math.radians(40.0))
    there = robot.pose
    robot.spin(1.0)
    assert robot.pose == there
    assert [p.id for p in robot.perceive()] == [str(k) for k in range(len(robot.perceive()))]
    assert robot.drive_to("0", robot.perceive()).value == "stopped"


def test_the_environment_needs_no_torch() -> None:
    script = (
        "import sys, gymnasium, dcg_torch.apps.gym as g\n"
        "gymnasium.make(g.ID).reset(seed=0)\n"
        "print([m for m in ('torch', 'pybullet', 'hydra') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.stdout.strip(), done.returncode) == ("[]", 0), done.stderr


@pytest.mark.slow
def test_the_robot_in_physics_is_one_by_an_argument() -> None:
    pytest.importorskip("pybullet")
    env = gymnasium.make(ID, simulator="pybullet", worlds="committed", iterations=2)
    agent = Agent(env, paper_settings())
    played = [agent.play(seed=2 if k == 0 else None) for k in range(2)]
    env.close()
    assert any(p.info["correct"] for p in played)
    assert all(p.outcome.percepts for p in played)


@pytest.mark.slow
def test_the_example_shows_that_learning_pays() -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", str(ROOT / "examples" / "gym_agents.py"), "6"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    shares = [float(line.rpartition(" ")[2].rstrip("%")) for line in done.stdout.splitlines()]
    assert len(shares) == 4
    assert shares[0] < shares[1] <= 100.0
    assert shares[3] >= 90.0
