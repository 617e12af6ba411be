"""The notebook runs from top to bottom, and no outputs are kept in it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(__file__).parent.parent / "examples" / "tour.ipynb"

# Where Jupyter is not there: the cells one after the other, as one program.
PLAIN = """
import json, pathlib, sys
import matplotlib
matplotlib.use("Agg")
names = {"__name__": "__main__"}
for cell in json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))["cells"]:
    if cell["cell_type"] == "code":
        exec("".join(cell["source"]), names)
"""


def cells() -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(NOTEBOOK.read_text("utf-8"))["cells"]
    return found


def test_no_outputs_are_kept() -> None:
    code = [cell for cell in cells() if cell["cell_type"] == "code"]
    assert len(code) > 5
    assert [(cell["outputs"], cell["execution_count"]) for cell in code] == [([], None)] * len(code)


@pytest.mark.slow
def test_it_runs_from_top_to_bottom(tmp_path: Path) -> None:
    """By nbmake (the extra `notebook`) where it is there, otherwise without a kernel."""
    plain = [sys.executable, "-W", "error", "-c", PLAIN, str(NOTEBOOK)]
    # A configuration of its own: this project's turns warnings into errors, Jupyter's too.
    own = ["-c", os.devnull, "--rootdir", str(tmp_path), "-p", "no:cacheprovider", "-q"]
    kernel = [sys.executable, "-m", "pytest", "--nbmake", "--nbmake-timeout=300", *own, str(NOTEBOOK)]
    command = kernel if find_spec("nbmake") and find_spec("ipykernel") else plain
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
