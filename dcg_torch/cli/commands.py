"""`dcg-torch COMMAND ...` and `python -m dcg_torch ...`: which commands there are, each loaded when it is called."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Command:
    """One command: the module whose `main()` it is, what it does, and the extra that it needs, if any.

    `needs` are the packages of that extra which the module imports. `conf` is the folder of its configuration, where
    that says all that there is to say of `--help`, and the module takes long to load.
    """

    module: str
    does: str
    extra: str | None = None
    needs: tuple[str, ...] = ()
    conf: str | None = None


COMMANDS: Mapping[str, Command] = {
    "run": Command("cli.run", "one experiment, or a sweep of them with -m (the default)"),
    "evaluate": Command(
        "cli.evaluate", "ground the commands of episode files, perhaps after training on others", conf="conf"
    ),
    "report": Command("report.__main__", "tables of runs and sweeps"),
    "collect": Command(
        "apps.collect.program",
        "pages on which people write commands, and importers of what they wrote",
        "collect",
        ("fastapi", "jinja2", "sqlalchemy", "uvicorn"),
    ),
    "convert": Command("cli.convert", "scenes and commands of others as episode files"),
    "talk": Command(
        "apps.talk.program",
        "a page in the browser to talk to the robot, watch it and teach it",
        "talk",
        ("nicegui",),
        "dcg_torch/apps/talk/conf",
    ),
    "bench": Command("bench.__main__", "time the parts", "bench", ("sklearn",)),
    "ros": Command(
        "apps.ros.program",
        "a ROS 2 node: commands as messages, a robot that is known by its messages",
        "ros",
        ("rclpy",),
    ),
    "pretrain": Command("cli.pretrain", "make the shipped model anew"),
    "scenes": Command("cli.scenes", "scenes with commands that a program made, to certify with"),
    "schema": Command("cli.schema", "the JSON Schemas of all files"),
    "completion": Command("cli.completion", "what your shell completes: bash or zsh"),
}


def main(commands: Mapping[str, Command] = COMMANDS) -> int:
    """Run the command that the first argument names, `run` without one; the exit status."""
    program, *arguments = sys.argv
    name = arguments[0] if arguments else ""
    if name == "help" and arguments[1:]:
        return _help_on(arguments[1], program, commands)
    if name == "help" or (Path(program).name.startswith("dcg-torch") and name in ("", "-h", "--help")):
        print(usage(commands))
        return 0
    if re.fullmatch(r"\w[\w-]*", name) and name not in commands:  # what is no override either
        return _refuse(name, name, commands)
    if name not in commands:
        return _main_of("run", commands["run"])
    return start(name, [f"{program} {name}", *arguments[1:]], commands)


def _help_on(name: str, program: str, commands: Mapping[str, Command]) -> int:
    """Say more of one command; the exit status."""
    if name in commands:
        return start(name, [f"{program} {name}", "--help"], commands)
    return _refuse(f"help {name}", name, commands)


def _refuse(typed: str, name: str, commands: Mapping[str, Command]) -> int:
    """Say that there is no such command, and which is like it; the exit status."""
    from dcg_torch.storage.untrusted_files import (  # here: Ctrl-C while it loads is to be one line as well
        misspelt,
        plain,
    )

    near = misspelt(name, tuple(commands))
    hint = f"did you mean {near}?" if near else f"take {', '.join(commands)}"
    print(f"dcg_torch: {plain(typed)}: there is no such command; {hint}", file=sys.stderr)
    return 2


def start(name: str, typed: list[str], commands: Mapping[str, Command] = COMMANDS) -> int:
    """Run one command as if `typed` (its program, then its arguments) was the command line; the exit status."""
    sys.argv = typed
    return _main_of(name, commands[name])


def usage(commands: Mapping[str, Command] = COMMANDS) -> str:
    """The commands, a line each."""
    lines = [f"  {name:<12}{command.does}" for name, command in commands.items()]
    head = ["usage: dcg-torch COMMAND ...", "", *lines, "", "dcg-torch COMMAND --help says more of each."]
    return "\n".join([*head, "dcg-torch --version says which version this is."])


_ALONE = re.compile(r"-|(workers|trials)=1$|backend=|simulator\.gui=|hydra/launcher=")
"""Arguments with which an experiment takes no processes of its own, or others."""


def may_take_workers(arguments: list[str]) -> bool:
    """Whether an experiment is likely to be run by several processes: what these need is loaded meanwhile."""
    return not any(map(_ALONE.match, arguments))


def _main_of(name: str, command: Command) -> int:
    try:
        if name == "run" and may_take_workers(sys.argv[1:]):
            from dcg_torch.experiment.pool import prepare  # here: nothing else of it is asked for

            prepare()
        if command.conf is not None and not {"-h", "--help"}.isdisjoint(sys.argv[1:]):
            from dcg_torch.cli.quick_help import show_help  # here: Hydra takes a moment as well

            return show_help(name, command.conf)
        module = importlib.import_module(f"dcg_torch.{command.module}")
        status: int = module.main()
    except KeyboardInterrupt:  # before or after the program can say it itself
        print("dcg_torch: interrupted", file=sys.stderr)
        return 130
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if command.extra is None or missing not in command.needs:
            raise
        print(
            f"dcg_torch: {name} needs {missing}, of the extra {command.extra}: "
            f"pip install 'dcg-torch[{command.extra}]', in a checkout pip install -e '.[{command.extra}]'",
            file=sys.stderr,
        )
        return 2
    return status
