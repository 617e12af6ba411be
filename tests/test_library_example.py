"""The library example does what its comments say, and README.md shows the same lines."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import dcg_torch
from dcg_torch import Percept, Pose

ROOT = Path(__file__).parent.parent
EXAMPLE = ROOT / "examples" / "library.py"


def test_the_example_teaches_grounds_learns_and_saves(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error", str(EXAMPLE)], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    told, grounded, *reasons, learned, problem = done.stdout.splitlines()
    assert "word='lamp', type='desk lamp', object='l1'" in told
    assert grounded.startswith("['m1']")  # the one to the left, though both are blue mugs
    assert "word='mug', type='mug'" in learned
    assert len(reasons) == 5
    assert not any("noun known: yes" in reason for reason in reasons)  # nobody had said "mug" when it was grounded
    assert problem not in ("", "None")
    # what was saved knows both words
    model = dcg_torch.load(tmp_path / "my_model")
    things = [Percept("x", "mug", "blue", (1.0, 0.4, 0.0)), Percept("y", "desk lamp", "red", (1.0, -0.6, 0.0))]
    world = model.world_model(things, robot=Pose(0.0, 0.0, 0.0))
    assert [o.id for o in model.ground("go to the mug", world).objects] == ["x"]
    assert [o.id for o in model.ground("go to the lamp", world).objects] == ["y"]


def test_the_readme_shows_the_example() -> None:
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    text = EXAMPLE.read_text(encoding="utf-8")
    assert text[text.index("import dcg_torch") :] in blocks
