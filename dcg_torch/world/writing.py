"""Worlds as the text of world files."""

from __future__ import annotations

import math

import yaml

from dcg_torch.world.files import World


def yaml_lines(world: World) -> list[str]:
    """The world as YAML with one line per object and command; `load_world` reads the same world from it."""
    lines = [f"name: {_flow(world.name)}", f"robot: {_flow(world.robot.model_dump())}", "objects:"]
    lines += [f"  - {_flow(o.model_dump(mode='json'))}" for o in world.objects]
    for key, commands in (("commands", world.commands), ("relational", world.relational)):
        if commands:
            lines += [f"{key}:", *(f"  - {_flow(c.model_dump(exclude_defaults=True))}" for c in commands)]
    return lines


def _flow(value: object) -> str:
    text = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, width=math.inf, allow_unicode=True)
    return text.removesuffix("...\n").strip()
