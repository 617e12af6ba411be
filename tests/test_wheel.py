"""What is built from the checkout: a wheel that runs the experiment from anywhere, and a source archive."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def data_files() -> set[str]:
    """What has to come along besides Python code, by its place in the wheel."""
    found = {f"dcg_torch/_data/{p.relative_to(ROOT)}" for n in ("conf", "worlds") for p in (ROOT / n).rglob("*.yaml")}
    package = [p for p in (ROOT / "dcg_torch").rglob("*") if p.is_file() and "__pycache__" not in p.parts]
    return found | {str(p.relative_to(ROOT)) for p in package if p.suffix not in (".py", ".pyc")}


def test_the_makefile_pins_the_torch_of_the_project() -> None:
    wanted = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    pinned = re.findall(r"torch==[\d.]+", (ROOT / "Makefile").read_text())
    assert pinned
    assert set(pinned) <= set(wanted)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the wheel and the source archive, built without downloading anything."""
    directory = tmp_path_factory.mktemp("dist")
    command = [
        sys.executable,
        "-m",
        "build",
        "--no-isolation",
        "--wheel",
        "--sdist",
        "--outdir",
        str(directory),
        str(ROOT),
    ]
    subprocess.run(command, check=True, capture_output=True)
    return directory


@pytest.mark.slow
def test_the_wheel_holds_configuration_worlds_and_models(built: Path) -> None:
    (wheel,) = built.glob("*.whl")
    names = set(zipfile.ZipFile(wheel).namelist())
    wanted = data_files()
    assert {"dcg_torch/py.typed", "dcg_torch/model/shipped/model.json"} <= wanted
    assert wanted <= names
    assert any(name.startswith("dcg_torch/_data/worlds/hardware/") for name in names)
    assert not any(name.startswith(("tests/", "runs/")) for name in names)


@pytest.mark.slow
def test_the_source_archive_holds_all_that_tests_need(built: Path) -> None:
    (archive,) = built.glob("*.tar.gz")
    with tarfile.open(archive) as tar:
        names = {name.partition("/")[2] for name in tar.getnames()}
    wanted = {"Makefile", "LICENSE", "conf/config.yaml", "worlds/world_00.yaml", "tests/test_wheel.py"}
    assert wanted <= names
    assert not any(re.match(r"runs/.*\.jsonl|\.venv|.*__pycache__", name) for name in names)


@pytest.mark.slow
@pytest.mark.parametrize("experiment", ["smoke", "hardware"])
def test_the_installed_wheel_runs_from_any_directory(experiment: str, built: Path, tmp_path: Path) -> None:
    (wheel,) = built.glob("*.whl")
    site, elsewhere = tmp_path / "site", tmp_path / "elsewhere"
    elsewhere.mkdir()
    # The dependencies are this environment's; the package itself has to be the wheel's.
    install = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--no-deps",
        "--no-index",
        "--target",
        str(site),
        str(wheel),
    ]
    subprocess.run(install, check=True, capture_output=True)
    environment = {**os.environ, "PYTHONPATH": str(site)}
    where = [sys.executable, "-c", "import dcg_torch.storage.resources as r; print(r.__file__, r.resource('conf'))"]
    found = subprocess.run(where, check=True, capture_output=True, text=True, cwd=elsewhere, env=environment).stdout
    assert all(path.startswith(str(site)) for path in found.split())
    pretrained = "import dcg_torch; print(dcg_torch.pretrained().known_types[0])"
    said = subprocess.run(
        [sys.executable, "-c", pretrained],
        capture_output=True,
        text=True,
        cwd=elsewhere,
        env=environment,
        check=False,
    )
    assert said.stdout == "cube\n", said.stderr
    done = subprocess.run(
        [sys.executable, "-m", "dcg_torch", f"experiment={experiment}", "simulator=fake", "animate=[]"],
        capture_output=True,
        text=True,
        cwd=elsewhere,
        env=environment,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    (run,) = (elsewhere / "runs").iterdir()
    assert (run / "iterations.jsonl").read_text().count("\n") == {"smoke": 6, "hardware": 3}[experiment]
    assert (run / "figures" / "accuracy.png").is_file()
