"""The Makefile, as far as it needs no installing."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.skipif(shutil.which("make") is None, reason="there is no make")
def test_what_is_compiled_is_kept_whatever_the_environment_says(tmp_path: Path) -> None:
    """Nothing that pip installs is compiled, so that each process that may keep nothing would compile it anew."""
    asking = tmp_path / "Makefile"
    asking.write_text(f'include {ROOT / "Makefile"}\nkept:\n\t@echo "[$$PYTHONDONTWRITEBYTECODE] [$$PYTHONHASHSEED]"\n')
    outer = {name: value for name, value in os.environ.items() if not name.startswith("MAKE") and name != "MFLAGS"}
    environment = {**outer, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONHASHSEED": "0"}  # not as a part of `make test`
    told = subprocess.run(
        ["make", "-f", str(asking), "kept"], env=environment, cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert told.stdout.splitlines()[-1] == "[] [0]"  # and what else is set stays
