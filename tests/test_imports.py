"""Who may import whom: rooms import in one direction, and each heavy package has its own."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import networkx as nx
import pytest

PACKAGE = Path(__file__).parent.parent / "dcg_torch"

# Rooms from the lowest to the highest floor: a room imports rooms that stand in a line above its own.
LAYERS = (
    {"types", "storage", "names", "english"},
    {"fitting", "language", "report", "scene", "world"},
    {"interpretation", "settings", "simulator", "speech_acts"},
    {"grounding"},
    {"learning"},
    {"agent", "lessons"},
    {"model"},
    {"evaluation", "experiment"},
    {"cli", "dialogue"},
    {"__main__", "apps", "bench", "collect", "convert", "evaluate", "ros", "talk"},
)
LEVEL = {room: level for level, rooms in enumerate(LAYERS) for room in rooms}

# The only modules (or all modules below them) that may import a package, at the top of the file or inside a function.
HYDRA = {"cli", "apps.talk.program"}
ONLY = {
    "pybullet": {"simulator"},
    "pybullet_utils": {"simulator"},
    "pybullet_data": {"simulator"},
    "hydra": HYDRA,
    "omegaconf": HYDRA,
    "torch": {"fitting", "grounding.tables", "experiment.worker", "bench", "cli.evaluate", "report.board"},
    "safetensors": {"model.serialization"},
    "tensorboard": {"report.board"},
    "sentence_transformers": {"names.embedding"},
    "transformers": {"names.embedding"},
    "rclpy": {"apps.ros"},
    "std_msgs": {"apps.ros"},
    "std_srvs": {"apps.ros"},
    "geometry_msgs": {"apps.ros"},
    "nav_msgs": {"apps.ros"},
    "visualization_msgs": {"apps.ros"},
    "sklearn": {"evaluation.baselines", "bench"},
    "glum": {"bench.peers"},
    "pycrfsuite": {"bench.peers"},
    "fastapi": {"apps.collect.page", "apps.talk.server"},
    "starlette": {"apps.collect.page", "apps.talk.gate", "apps.talk.live_updates"},
    "jinja2": {"apps.collect.page"},
    "sqlalchemy": {"apps.collect"},
    "uvicorn": {"apps.collect.program", "apps.talk.server"},
    "nicegui": {"apps.talk"},
    "gymnasium": {"apps.gym"},
    "defusedxml": {"storage.untrusted_files"},
    "joblib": {"experiment.backends"},
    "ray": {"experiment.backends"},
    "distributed": {"experiment.backends"},
}
ROOT = "dcg_torch"


@dataclass(frozen=True)
class Import:
    """A module (of this package, without its name) imports `name`, at the top of the file or inside a function."""

    name: str
    line: int

    @property
    def package(self) -> str:
        return self.name.partition(".")[0]

    @property
    def own(self) -> str | None:
        """The room that is imported, if it is one of this package's."""
        room = self.name.partition(".")[2].partition(".")[0]
        return room if self.package == ROOT and room else None


@cache
def imports_of(module: str, source: str, rooms: frozenset[str]) -> list[Import]:
    """All imports of a module; those of the package's public names are of the package itself."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = [ROOT, *module.split(".")]
                base = ".".join([*parts[: len(parts) - node.level], *([base] if base else [])])
            names = [f"{base}.{a.name}" if base == ROOT and a.name in rooms else base for a in node.names]
            if base == ROOT and [a.name for a in node.names] == ["__version__"]:
                continue  # a number, and no public name that draws in a room
        else:
            continue
        found += [Import(name, node.lineno) for name in dict.fromkeys(names)]
    return found


def room_of(module: str) -> str:
    return module.partition(".")[0]


def violations(sources: Mapping[str, str]) -> list[str]:
    """What is wrong with the imports of modules (name without the package's -> source), a line each."""
    rooms = frozenset(map(room_of, sources))
    found = [f"{room}: give it a line in LAYERS of {Path(__file__).name}" for room in sorted(rooms - set(LEVEL))]
    graph = nx.DiGraph()
    for module, source in sources.items():
        room = room_of(module)
        for entry in imports_of(module, source, rooms):
            at = f"{module}:{entry.line} imports {entry.name}"
            allowed = ONLY.get(entry.package)
            if allowed is not None and not any(f"{module}.".startswith(f"{a}.") for a in allowed):
                found.append(f"{at}: only {', '.join(sorted(allowed))} may")
            if entry.package == ROOT and entry.own is None:
                found.append(f"{at}: the public names are for users; import from the room")
            other = entry.own
            if other is None or other == room:
                continue
            graph.add_edge(room, other)
            if LEVEL.get(other, len(LAYERS)) >= LEVEL.get(room, len(LAYERS)):
                found.append(f"{at}: {other} does not stand below {room}")
    found += [f"a cycle: {' -> '.join(cycle)}" for cycle in nx.simple_cycles(graph)]
    return found


def sources() -> dict[str, str]:
    """Every module of the package but its front door, which hands out public names from everywhere."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        name = ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")
        if name != "__init__":
            found[name] = path.read_text(encoding="utf-8")
    return found


def test_the_rules_hold() -> None:
    assert violations(sources()) == []


def test_every_room_has_a_line_and_every_line_a_room() -> None:
    assert {room_of(module) for module in sources()} == set(LEVEL)
    assert sum(map(len, LAYERS)) == len(LEVEL)


def test_every_module_that_may_import_a_package_does() -> None:
    """An allowance that nobody uses hides the next who should not have it."""
    used = {name: set[str]() for name in ONLY}
    for module, source in sources().items():
        for entry in imports_of(module, source, frozenset(LEVEL)):
            used.get(entry.package, set()).add(f"{module}.")
    optional = {"transformers", "pybullet_utils", "pybullet_data"}  # of packages that come with the allowed ones
    idle = [(p, a) for p, allowed in ONLY.items() for a in allowed if not any(m.startswith(f"{a}.") for m in used[p])]
    assert [(p, a) for p, a in idle if p not in optional] == []


@pytest.mark.parametrize(
    ("module", "source", "says"),
    [
        ("language.parser", "import torch", "torch: only"),
        ("model.core", "from safetensors.numpy import load", "safetensors.numpy: only model.serialization may"),
        ("experiment.trial", "def f():\n    import pybullet as p", "pybullet: only simulator may"),
        ("experiment", "from hydra.core import hydra_config", "only apps.talk.program, cli may"),
        ("report.boardroom", "import torch.utils", "only"),
        ("model.core", "import torch", "torch: only"),
        ("names.normal_form", "import sentence_transformers", "only names.embedding may"),
        ("types", "from dcg_torch.grounding.features import Group", "grounding does not stand below types"),
        ("types", "from dcg_torch import grounding", "grounding does not stand below types"),
        ("world.files", "from ..grounding.graph import FactorGraph", "grounding does not stand below world"),
        (
            "grounding.graph",
            "def f():\n    from dcg_torch.model import GroundingModel",
            "model does not stand below grounding",
        ),
        (
            "scene.layout",
            "if TYPE_CHECKING:\n    from dcg_torch.grounding.graph import FactorGraph",
            "grounding does not stand below scene",
        ),
        ("world.speaker", "from dcg_torch import GroundingModel", "the public names are for users"),
        ("experiment.pool", "from dcg_torch.cli.run import run", "cli does not stand below experiment"),
        ("model.core", "from dcg_torch.model_zoo import x", "model_zoo does not stand below model"),
        ("attic", "import math", "give it a line"),
    ],
)
def test_the_checker_finds(module: str, source: str, says: str) -> None:
    """A made-up violation beside the real modules."""
    made_up = {**sources(), module: source}
    before, after = violations(sources()), violations(made_up)
    new = [line for line in after if line not in before]
    assert any(says in line for line in new), new


def test_the_checker_finds_a_cycle() -> None:
    found = violations({"types": "from dcg_torch.scene import x", "scene": "from dcg_torch.types import y"})
    assert any(line.startswith("a cycle") for line in found)


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("experiment", "def f():\n    from dcg_torch.model import GroundingModel"),
        ("simulator.engine", "import pybullet"),
        ("report.board", "from torch.utils.tensorboard import SummaryWriter"),
        ("grounding.graph", "from .. import types"),
        ("world.files", "from .generator import x"),
    ],
)
def test_the_checker_leaves_alone(module: str, source: str) -> None:
    assert violations({**dict.fromkeys(["model", "types"], ""), module: source}) == []


def test_the_types_of_arrays_have_one_home() -> None:
    """No module gives the types of arrays their names anew; `names` stands beside `types` and spells its own out."""
    named = {"Floats", "Bools", "Ints", "Points"}
    found = {
        module
        for module, source in sources().items()
        for node in ast.parse(source).body
        if isinstance(node, ast.Assign) and {ast.unparse(target) for target in node.targets} & named
    }
    assert found == {"types.arrays"}


def test_a_model_needs_no_simulator_no_parser_and_no_configuration() -> None:
    """Nor do worlds, speakers and reports need torch."""
    heavy = "pybullet", "spacy", "hydra", "omegaconf"
    light = "dcg_torch.types, dcg_torch.world.files, dcg_torch.scene.upsilon, dcg_torch.world.speaker, dcg_torch.report"
    script = (
        f"import sys, {light}, dcg_torch.report.measures\n"
        "assert 'torch' not in sys.modules\n"
        "import dcg_torch.model, dcg_torch.lessons, dcg_torch.model.checkpoint, dcg_torch.agent.command\n"
        f"print([m for m in {heavy} if m in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (done.stdout.strip(), done.returncode) == ("[]", 0), done.stderr
