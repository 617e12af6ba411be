"""An episode is one command: the robot looks, asks, drives to a thing that it has seen, and says that it is done."""

from __future__ import annotations

import math
from typing import Any

import gymnasium
import numpy as np

from dcg_torch.apps.gym.scenario import Act, Observation, Reply, experiment_settings, make_spaces
from dcg_torch.experiment.plan import trial_commands, trial_generators
from dcg_torch.experiment.robots import new_robot
from dcg_torch.types import Percept
from dcg_torch.types.arrays import Ints
from dcg_torch.world.speaker import Command


class GroundEnv(gymnasium.Env[Observation, Ints]):
    """A robot that is given commands.

    Observation: `command`, the text; `percepts`, what was seen since the command, in the order of first sight, each
    with `type`, `color` ("" where it is not known) and `position` (3,) in metres in the world frame; `robot` (3,), its
    x, y and yaw in metres and radians; `reply`, see `Reply`.

    Action: (act, percept), see `Act`; the second number counts `percepts` from 0 and matters to `DRIVE`, `LEAVE` and
    `ASK`. An action about a percept that is not there does nothing, and `info["problem"]` says so.

    Reward: 1 with `DONE` where the robot has last driven to the object meant (or left it, if the command was to keep
    away), else 0; less the costs of looks and questions.

    `info` holds `trial`, `iteration` (counted from 0 in the trial), `world` and `problem` ("" if there is none). At the
    end also `correct`, `target` and `reached` (numbers of percepts, -1: none that was seen) and the `target_id`,
    `target_type` and `target_color` of what was meant.

    `reset(seed=s)` gives the first command of trial 0 of the experiment with that seed; each `reset()` after it the
    next command, and those of the next trial after the last one of a trial. What an agent learns from one command is
    of use for the next ones of a trial; a new trial begins with new worlds. `reset(options={"trial": t})` goes to
    the beginning of a trial.

    Args:
        simulator: "fake", a robot of pure geometry, or "pybullet".
        look_cost, ask_cost: what a look and a question take from the reward.
        render_mode: None, or "ansi": `render` gives the episode as text.
        settings: of the experiment (`scenario.WORLD`, `scenario.ROBOT`), as `worlds="committed"`; without one the
            worlds are generated and the commands say noun and colour.

    Raises:
        SettingsError: there is no such setting, or its value makes no sense.
        WorldFileError: a world file is missing or not valid.
        SimulatorError: PyBullet is asked for and is not there.
    """

    metadata = {"render_modes": ["ansi"], "render_fps": 1}  # noqa: RUF012 - as Gymnasium's own

    def __init__(
        self,
        simulator: str = "fake",
        *,
        look_cost: float = 0.01,
        ask_cost: float = 0.1,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        chosen = {"worlds": "generated", "speaker": "canonical", **settings}
        self._settings = experiment_settings(simulator, chosen)
        self.observation_space, self.action_space = make_spaces(self._settings)
        self.render_mode = render_mode
        self._look_cost, self._ask_cost = look_cost, ask_cost
        self._robot = new_robot(self._settings.simulator, self._settings.types)
        self._trial, self._iteration = 0, -1
        self._commands: list[Command] = []
        self._percepts: dict[str, Percept] = {}
        self._reached: tuple[Act, str] | None = None
        self._reply = Reply.NOTHING

    @property
    def spin_step(self) -> float:
        """Radians that one look turns by; positive: left."""
        return math.radians(self._settings.simulator.spin_step)

    @property
    def command(self) -> Command:
        """The command of this episode, with what only the speaker knows."""
        return self._commands[self._iteration]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Give the next command; the robot stands at the start of its world.

        Raises:
            SpeakerError: the worlds have too few commands.
        """
        unseeded = self._np_random is None
        super().reset(seed=seed)
        if seed is not None:
            self._begin(0, seed)
        elif unseeded:
            self._begin(0, int(self.np_random.integers(2**31)))
        if "trial" in (options or {}):
            self._begin(int((options or {})["trial"]), self._settings.seed)
        self._iteration += 1
        if self._iteration == len(self._commands):
            self._begin(self._trial + 1, self._settings.seed)
            self._iteration = 0
        self._robot.load(self.command.world, rng=self._mistakes)
        self._percepts, self._reached, self._reply = {}, None, Reply.NOTHING
        self._see()
        return self._observe(), self._info("")

    def _begin(self, trial: int, seed: int) -> None:
        """Draw a trial's commands; its first is the next one."""
        self._settings.seed = seed
        self._trial, self._iteration = trial, -1
        self._commands = trial_commands(self._settings, trial)
        self._mistakes = trial_generators(seed, trial)[2]

    def step(self, action: Ints) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Do one thing; observation, reward, is the episode over, False, info."""
        act, which = Act(int(action[0])), int(action[1])
        self._reply = Reply.NOTHING
        problem, reward = "", 0.0
        if act is Act.LOOK:
            self._robot.spin(self.spin_step)
            self._see()
            reward -= self._look_cost
        elif act is Act.DONE:
            return self._observe(), float(self._correct), True, False, self._info("") | self._verdict()
        elif not 0 <= which < len(self._percepts):
            problem = f"there is no percept {which}"
        elif act is Act.ASK:
            self._reply = Reply.YES if self._ids[which] == self.command.target else Reply.NO
            reward -= self._ask_cost
        else:
            problem = self._drive(act, self._ids[which])
        return self._observe(), reward, False, False, self._info(problem)

    def render(self) -> str:
        """The episode as text: the command, where the robot is, what it has seen."""
        x, y, yaw = self._observe()["robot"]
        lines = [f"{k}: {p.color or ''} {p.type} at {p.position[:2]}" for k, p in enumerate(self._percepts.values())]
        return "\n".join([self.command.text, f"robot at ({x:.2f}, {y:.2f}), yaw {yaw:.2f}", *lines])

    def close(self) -> None:
        """End the physics server, if there is one."""
        client = getattr(self._robot, "client", None)
        if client is not None:
            client.close()

    @property
    def _ids(self) -> list[str]:
        return list(self._percepts)

    def _see(self) -> None:
        for percept in self._robot.perceive():
            self._percepts.setdefault(percept.id, percept)

    def _drive(self, act: Act, target: str) -> str:
        """Drive; the problem, if there was one."""
        move = self._robot.drive_to if act is Act.DRIVE else self._robot.drive_away
        result = move(target, tuple(self._percepts.values()))
        self._reached = (act, target) if result else None
        self._see()
        return "" if result else result.value

    @property
    def _correct(self) -> bool:
        act = Act.LEAVE if self.command.away else Act.DRIVE
        return self._reached == (act, self.command.target)

    def _observe(self) -> Observation:
        pose = self._robot.pose
        percepts = (
            {"type": p.type, "color": p.color or "", "position": np.array(p.position, dtype=np.float64)}
            for p in self._percepts.values()
        )
        return {
            "command": self.command.text,
            "percepts": tuple(percepts),
            "robot": np.array([pose.x, pose.y, pose.yaw], dtype=np.float64),
            "reply": np.int64(self._reply),
        }

    def _info(self, problem: str) -> dict[str, Any]:
        at = {"trial": self._trial, "iteration": self._iteration}
        return {**at, "world": self.command.world.name, "problem": problem}

    def _verdict(self) -> dict[str, Any]:
        """What was right."""
        (target,) = (o for o in self.command.world.objects if o.id == self.command.target)
        reached = None if self._reached is None else self._reached[1]
        where = {id_: k for k, id_ in enumerate(self._percepts)}
        return {
            "correct": self._correct,
            "target": where.get(target.id, -1),
            "reached": -1 if reached is None else where[reached],
            "target_id": target.id,
            "target_type": target.type,
            "target_color": target.color,
        }
