"""`python -m dcg_torch.ros`: a ROS 2 node around the model."""

from __future__ import annotations

import importlib.util
import sys
import time
from dataclasses import fields

_BEGAN = time.perf_counter()
_USAGE = """usage: python -m dcg_torch.ros [--ros-args -p NAME:=VALUE ... -r FROM:=TO ...]

A ROS 2 node that takes commands and lessons as messages; docs/ros.md lists its topics and services. Parameters:
"""


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input."""
    from dcg_torch.apps.ros.options import Options
    from dcg_torch.cli.application import one_line_errors, refuse

    arguments = sys.argv[1:]
    if {"-h", "--help"} & set(arguments):
        lines = [f"  {one.name} (default {one.default!r}): {one.metadata['help']}" for one in fields(Options)]
        with one_line_errors():
            print(_USAGE + "\n".join(lines), flush=True)
        return 0
    if arguments and arguments[0] != "--ros-args":
        return refuse(f"{arguments[0]}: there is no such option; parameters are given as --ros-args -p NAME:=VALUE")
    if importlib.util.find_spec("rclpy") is None:
        return refuse("this needs rclpy, of the extra ros: in a checkout, pip install -e '.[ros]'")
    from dcg_torch.apps.ros.node import serve

    with one_line_errors():
        serve(arguments, _BEGAN)
    return 0
