"""The example of a robot of one's own does what it says, and needs neither simulator nor PyBullet."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

EXAMPLE = Path(__file__).parent.parent / "examples" / "own_robot.py"

WITHOUT_PYBULLET = """
import runpy, sys
sys.modules["pybullet"] = None  # as if it were not installed
{rest}
"""


def run(rest: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT_PYBULLET.format(rest=rest)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_the_example_looks_drives_and_learns() -> None:
    lines = run(f"runpy.run_path({str(EXAMPLE)!r}, run_name='__main__')")
    commands = [k for k, line in enumerate(lines) if not line.startswith(" ")]
    known, unknown, learned = (lines[a:b] for a, b in zip(commands, [*commands[1:], len(lines)], strict=True))
    # the red cube is in view
    assert sum("looks from" in line for line in known) == 1
    assert "  drives to (2.0, 0.5)" in known
    assert any(line.startswith("  means box-1") for line in known)
    # the pallet is behind the robot, and its word is new
    assert sum("looks from" in line for line in unknown) > 1
    assert "  drives to (-2.0, 0.3)" in unknown
    assert "  learns that 'pallet' names a euro pallet" in unknown
    # by now it is known, and nothing is learned twice
    assert any(line.startswith("  means pallet-7") for line in learned)
    assert not any("learns" in line for line in learned)


def test_the_fake_robot_runs_without_pybullet_and_the_other_says_what_is_missing() -> None:
    lines = run(
        "from dcg_torch.simulator import FakeRobot, Recogniser, SimulatorError\n"
        "import dcg_torch.agent.command, dcg_torch.agent.explore, dcg_torch.agent.asking\n"
        "FakeRobot(), Recogniser()\n"
        "try:\n"
        "    from dcg_torch.simulator import SimulatedRobot\n"
        "except SimulatorError as error:\n"
        "    print(error)\n"
    )
    assert len(lines) == 1
    assert "pip install pybullet" in lines[0]
    assert "simulator=fake" in lines[0]
