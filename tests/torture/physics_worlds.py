"""Drives in random physics worlds of 5 to 60 objects: none may touch anything, and every one must end.

    python tests/torture/physics_worlds.py [worlds] [first seed]

Prints how the drives ended and exits with 1 if one touched an object or took too long.
"""

from __future__ import annotations

import sys
import time
from collections import Counter

import numpy as np

from dcg_torch.simulator import SimulatedRobot
from dcg_torch.simulator.bodies import extent
from dcg_torch.types import Percept
from dcg_torch.world.files import World
from dcg_torch.world.generator import TYPES, generate_world
from dcg_torch.world.names import MORE_COLORS

LONGEST = 300.0  # simulated seconds of one drive


def random_world(seed: int) -> tuple[World, np.random.Generator]:
    """5 to 60 objects, from wide apart to so close that there is no way between some."""
    rng = np.random.default_rng(seed)
    pairs = len(TYPES) * len(MORE_COLORS)
    while True:
        world = generate_world(
            rng,
            f"torture-{seed}",
            colors=MORE_COLORS,
            probability=float(rng.uniform(5, 60)) / pairs,
            spacing=float(rng.uniform(0.7, 1.1)),
        )
        if 5 <= len(world.objects) <= 60:
            return world, rng


def drive_about(robot: SimulatedRobot, world: World, rng: np.random.Generator) -> list[tuple[str, float]]:
    """To two objects, away from the second, and to a place; how each drive ended, and its simulated seconds.

    The robot knows its goal and what it has seen, and has to notice the rest on the way.
    """
    robot.load(world)
    ended: list[tuple[str, float]] = []
    for goal in rng.choice(len(world.objects), 2):
        item = world.objects[int(goal)]
        percept = Percept(item.id, item.type, item.color, (*item.position, 0.0), extent(item.type))
        for move in (robot.drive_to, robot.drive_away)[: 1 + (len(ended) > 0)]:
            began = robot.seconds
            ended.append((move(item.id, [percept, *robot.perceive()]).value, robot.seconds - began))
    began = robot.seconds
    x, y = rng.uniform(-4.0, 4.0, 2).tolist()
    ended.append((robot.go_to(x, y, robot.perceive()).value, robot.seconds - began))
    return ended


def main(worlds: int = 200, first: int = 0) -> int:
    ended: Counter[str] = Counter()
    collisions, longest, sizes = 0, 0.0, []
    began = time.process_time()
    with SimulatedRobot() as robot:
        for seed in range(first, first + worlds):
            world, rng = random_world(seed)
            drives = drive_about(robot, world, rng)
            ended.update(how for how, _ in drives)
            longest = max(longest, *(seconds for _, seconds in drives))
            sizes.append(len(world.objects))
            if robot.collisions:
                collisions += robot.collisions
                print(f"seed {seed}: {robot.collisions} collisions among {len(world.objects)} objects")
    print(f"{worlds} worlds of {min(sizes)} to {max(sizes)} objects, {ended.total()} drives: {dict(ended)}")
    print(f"{collisions} collisions; longest drive {longest:.0f} simulated s; {time.process_time() - began:.0f} s CPU")
    return int(collisions > 0 or longest > LONGEST)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:3])))
