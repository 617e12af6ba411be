"""What the documentation names is there: files, modules, names, links, rooms, settings."""

from __future__ import annotations

import doctest
import importlib
import re
import shlex
from pathlib import Path

import pytest
from hydra import compose, initialize_config_dir

from dcg_torch.apps.collect.settings import HitSettings, ImportSettings, ServeSettings
from dcg_torch.cli.config import evaluate_settings_of, register, settings_of
from dcg_torch.settings import EvaluateSettings, Settings, described
from dcg_torch.storage.resources import resource

SCHEMAS = (Settings, EvaluateSettings, ServeSettings, HitSettings, ImportSettings)

ROOT = Path(__file__).parent.parent
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").rglob("*.md")])
COMPOSED = {"": ("config", settings_of), ".evaluate": ("evaluate", evaluate_settings_of)}
"""What follows `python -m dcg_torch` -> the configuration that Hydra composes for it, and what checks it."""


_PARTIAL = re.compile(r"\[KEY|experiment=search\b")


def prose(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def composed_commands(text: str) -> list[tuple[str, tuple[str, ...]]]:
    """The commands of a page whose settings Hydra composes, and these: on lines of their own and within sentences.

    Left out are sweeps, what only shows the form of a command ("[KEY=VALUE ...]"), and what needs an extra of Hydra's.
    """
    found = re.findall(r"(?:^|`)python -m dcg_torch(|\.evaluate)(?: ([^`#\n]*))?(?=[`#\n])", text, re.MULTILINE)
    whole = [(program, given) for program, given in found if not given.startswith("-") and not _PARTIAL.search(given)]
    split = [(program, shlex.split(given.replace(",...]", "]"))) for program, given in whole]
    return [(program, tuple(word for word in words if not word.startswith("hydra."))) for program, words in split]


def exists(dotted: str) -> bool:
    """Whether a dotted name of the package leads to a module or to something in one."""
    parts = dotted.split(".")
    for k in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:k]))
        except ModuleNotFoundError:
            continue
        try:
            for part in parts[k:]:
                found = getattr(found, part)
        except AttributeError:
            return False
        return True
    return False


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_files_links_and_names_are_there(page: Path) -> None:
    text = prose(page)
    links = [link.partition("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link]
    assert [link for link in links if link and not (page.parent / link).exists()] == []
    files = re.findall(r"`((?:dcg_torch|docs|examples|tests|conf|worlds)/[\w./]*)`", text)
    assert [name for name in files if not (ROOT / name).exists()] == []
    names = re.findall(r"(?:`|::: |from |import )(dcg_torch(?:\.[A-Za-z_]\w*)+)", text)
    assert [name for name in names if not exists(name)] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_settings_in_commands_are_settings(page: Path) -> None:
    keys = {name for schema in SCHEMAS for name, *_ in described(schema)}
    keys |= {"experiment", "model", "simulator"}
    commands = re.findall(r"^(?:python -m dcg_torch|dcg-torch)\b.*$", prose(page), re.MULTILINE)
    given = [word for command in commands for word in re.findall(r" '?([a-z_.]+)=", command.partition("#")[0])]
    assert [key for key in given if key not in keys and not key.startswith("hydra")] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_the_settings_in_commands_can_be_composed(page: Path) -> None:
    """Also their values: "baseline=true" names a setting, but one that is a list."""
    register()
    for program, given in composed_commands(prose(page)):
        name, settings = COMPOSED[program]
        with initialize_config_dir(str(resource("conf")), version_base="1.3"):
            settings(compose(name, overrides=list(given)))


def test_commands_are_found_in_text_and_on_lines() -> None:
    text = """Say `python -m dcg_torch.evaluate train='[FILE,...]' halves=true` here.
python -m dcg_torch experiment=paper trials=2 hydra.run.dir=runs/two   # two trials
python -m dcg_torch -m seed=0,1
python -m dcg_torch.evaluate test=FILE [KEY=VALUE ...]
`python -m dcg_torch.report runs` and `python -m dcg_torch`
"""
    assert composed_commands(text) == [
        (".evaluate", ("train=[FILE]", "halves=true")),
        ("", ("experiment=paper", "trials=2")),
        ("", ()),
    ]


EXAMPLES = sorted(p for p in (ROOT / "dcg_torch").rglob("*.py") if ">>>" in p.read_text("utf-8"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_the_examples_in_docstrings_hold(path: Path) -> None:
    module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    done = doctest.testmod(module)
    assert done.attempted > 0
    assert done.failed == 0


def test_every_room_has_its_line_in_the_architecture() -> None:
    package = ROOT / "dcg_torch"
    there = {p.stem for p in package.iterdir() if p.suffix == ".py" or (p / "__init__.py").exists()} - {"__init__"}
    lines = re.findall(r"^\| \d+ \| (.*?) \|", (ROOT / "docs" / "architecture.md").read_text("utf-8"), re.MULTILINE)
    assert {room for line in lines for room in re.findall(r"`(\w+)`", line)} == there


def named_in(*pages: str) -> set[str]:
    """The parts of the names that stand in backquotes in pages of the documentation."""
    found = (re.findall(r"`(\w+(?:\.\w+)*)`", (ROOT / "docs" / page).read_text("utf-8")) for page in pages)
    return {part for names in found for name in names for part in name.split(".")}


@pytest.mark.parametrize("room", ["interpretation", "grounding"])
def test_every_step_between_a_text_and_an_object_has_its_place(room: str) -> None:
    there = {p.stem for p in (ROOT / "dcg_torch" / room).glob("*.py")} - {"__init__"}
    assert there - named_in("order.md", "architecture.md") == set()


def test_the_steps_that_are_named_are_there() -> None:
    sources = list((ROOT / "dcg_torch").rglob("*.py"))
    there = {p.stem for p in sources} | {p.name for p in (ROOT / "dcg_torch").iterdir()}
    there |= {name for p in sources for name in re.findall(r"(?:def|class) (\w+)", p.read_text("utf-8"))}
    assert named_in("order.md") - there == set()


@pytest.mark.parametrize(
    "name", ["dcg_torch.nothing", "dcg_torch.model.core.Nothing", "dcg_torch.types.Object.nothing"]
)
def test_a_name_that_is_not_there_is_found(name: str) -> None:
    assert not exists(name)
