"""Example agents: Algorithm 1 with the paper's model, or with the shipped one, over what the environment shows.

They know the robot only through observations and actions: `EnvRobot` is a `Robot` whose eyes and wheels are those.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import gymnasium
import numpy as np

from dcg_torch.agent.asking import Question
from dcg_torch.agent.asking import Reply as Answer
from dcg_torch.agent.command import Outcome, carry_out
from dcg_torch.apps.gym.scenario import Act, Observation, Reply
from dcg_torch.experiment.factory import make_asking, make_explorer, make_model
from dcg_torch.grounding.features import Group
from dcg_torch.model.pretrain import LESSONS, VARIANT
from dcg_torch.settings import Asking, LearnerKind, ModelSettings, Settings
from dcg_torch.types import DriveResult, Percept, Pose

Env = gymnasium.Env[Observation, Any]


class EnvRobot:
    """An `agent.robot.Robot` that acts in an environment; once an episode is over nothing moves any more.

    Attributes:
        info: of the last step.
        reward: of all steps since `reset`.
    """

    def __init__(self, env: Env) -> None:
        self._env = env
        self._seen: Observation = {}
        self._over = True
        self.info: dict[str, Any] = {}
        self.reward = 0.0

    @property
    def spin_step(self) -> float:
        """Radians that a look turns by."""
        return float(self._env.get_wrapper_attr("spin_step"))

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> str:
        """Begin an episode; the command."""
        self._seen, self.info = self._env.reset(seed=seed, options=options)
        self._over, self.reward = False, 0.0
        return str(self._seen["command"])

    def act(self, act: Act, percept: int = 0) -> None:
        """One step."""
        if self._over:
            return
        self._seen, reward, terminated, truncated, self.info = self._env.step(np.array([act, percept]))
        self._over = terminated or truncated
        self.reward += float(reward)

    @property
    def pose(self) -> Pose:
        """Where the robot is."""
        return Pose(*self._seen["robot"].tolist())

    def perceive(self) -> list[Percept]:
        """All that it has seen in this episode; ids are the percepts' numbers."""
        return [
            Percept(str(k), p["type"], p["color"] or None, tuple(p["position"].tolist()))
            for k, p in enumerate(self._seen["percepts"])
        ]

    def spin(self, angle: float) -> None:
        """Turn by as many looks as reach the angle."""
        for _ in range(math.ceil(abs(angle / self.spin_step) - 1e-9)):
            self.act(Act.LOOK)

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Drive to a percept."""
        return self._drive(Act.DRIVE, target)

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """Leave the surroundings of a percept."""
        return self._drive(Act.LEAVE, target)

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        """There is no such action."""
        return DriveResult.NO_WAY

    def answer(self, question: Question) -> Answer:
        """Ask about one candidate after the other, until it is the one."""
        for candidate in question.candidates:
            self.act(Act.ASK, int(candidate))
            if self._seen["reply"] == Reply.YES:
                return Answer(candidate)
        return Answer(None)

    def _drive(self, act: Act, target: str) -> DriveResult:
        if self._over:
            return DriveResult.STOPPED
        self.act(act, int(target))
        problem = self.info["problem"]
        return DriveResult(problem) if problem else DriveResult.ARRIVED


@dataclass(frozen=True)
class Played:
    """What came of an episode: its reward and last `info`, and what the model made of the command."""

    reward: float
    info: dict[str, Any]
    outcome: Outcome


class Agent:
    """Grounds a command, acts, and learns from the outcome; it starts anew with each trial.

    Args:
        env: one environment, `gymnasium.make("dcg_torch/Ground-v0")`.
        settings: of the model, of looking and of asking; `paper_settings` and `open_world_settings` are two.
    """

    def __init__(self, env: Env, settings: Settings) -> None:
        self._settings = settings
        self._robot = EnvRobot(env)
        self._asking = make_asking(settings)
        self.model = make_model(settings.model, settings.names, settings.training)

    def play(self, seed: int | None = None, options: dict[str, Any] | None = None) -> Played:
        """Play one episode, and learn; arguments are those of the environment's `reset`."""
        robot = self._robot
        text = robot.reset(seed, options)
        if robot.info["iteration"] == 0:
            self.model = make_model(self._settings.model, self._settings.names, self._settings.training)
        explorer = make_explorer(self._settings, self.model)
        outcome = carry_out(
            text,
            self.model,
            robot,
            spin_step=robot.spin_step,
            explorer=None if explorer is None else explorer(),
            # One candidate a question, which is what the environment answers.
            asking=None if self._asking is None else replace(self._asking, options=1),
            listener=robot.answer,
        )
        robot.act(Act.DONE)
        if outcome.solution is not None:
            self.model.learn(outcome.solution, outcome.experience(f"{robot.info['iteration']}"))
        return Played(robot.reward, robot.info, outcome)


def paper_settings() -> Settings:
    """The paper's policy, which grounds, turns, drives and commits to what it has learned: `dcg_upup_away_color`."""
    return Settings()


def open_world_settings(asking: Asking = Asking.never) -> Settings:
    """The shipped model, to which class names say nothing here; it looks before it decides, and may ask."""
    model = ModelSettings(
        name="open_world",
        groups=sorted(VARIANT.groups - {Group.NAMES}),
        lessons=LESSONS,
        beam=VARIANT.beam,
        l2=VARIANT.l2,
        learner=LearnerKind.word_posterior,
    )
    return Settings(model=model, asking=asking)
