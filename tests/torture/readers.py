"""Everything that the project reads, each with a way to write something near a good one into a folder."""

from __future__ import annotations

import functools
import io
import json
import random
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import mutants
import numpy as np
from convert_making import GRAPH, STATEMENTS, edge, example, node
from hostile import EPISODE, TRAINING, WORLD
from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from making import command_tree, saw
from report_rows import row, run, timing
from rich.console import Console
from safetensors.numpy import load, save

from dcg_torch.apps.collect.results import read_results
from dcg_torch.cli.config import CONFIG_ERRORS, explain, refuse_nothing, register, settings_of
from dcg_torch.dialogue.file import read_session
from dcg_torch.evaluation.episodes import read_episodes
from dcg_torch.evaluation.importers import concept_graphs, h2sl, h2sl_symbols, iref_vla, table
from dcg_torch.experiment.folder import check_owner, mark_as_own, open_trials, part_of
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.lessons import initial_training, read_training
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import DESCRIPTION, WEIGHTS
from dcg_torch.model.checkpoint import load as load_model
from dcg_torch.report.export import to_csv
from dcg_torch.report.runs import load_run
from dcg_torch.report.show import print_run, print_several
from dcg_torch.scene.upsilon import world_model
from dcg_torch.settings import Settings
from dcg_torch.storage.errors import UserError, explain_os_error
from dcg_torch.storage.resources import resource
from dcg_torch.storage.untrusted_files import plain
from dcg_torch.types import Percept
from dcg_torch.world.files import load_world

LONGEST = 1_000
"""Characters of a message."""


@dataclass(frozen=True)
class Reader:
    """How a hostile input is written into an empty folder, and read from there.

    `make` returns a handle, a path in most cases; `read` takes it, and raises `refuses` where it is not to be taken.
    """

    make: Callable[[random.Random, Path], Any]
    read: Callable[[Any], Any]
    refuses: type[Exception] = UserError


def readers(directory: Path) -> dict[str, Reader]:
    """All of them; `directory` is for the good files that some are made from."""
    return {
        "world": _file("w.yaml", lambda rng: mutants.yaml_file(rng, WORLD), load_world),
        "training": _file("t.yaml", lambda rng: mutants.yaml_file(rng, TRAINING), read_training),
        "episodes": _file("e.jsonl", lambda rng: mutants.json_lines(rng, EPISODE), read_episodes),
        "settings": Reader(_overrides, _composed),
        "model": Reader(functools.partial(_model, _saved(directory)), _use),
        "run for the report": Reader(_run, _report),
        "run to go on with": Reader(_unfinished, _owned),
        "session": _file("s.jsonl", _session, read_session),
        "answers (CSV)": _file(
            "a.csv", lambda rng: mutants.csv_file(rng, _ANSWERS), lambda path: read_results(str(path))
        ),
        "episodes (CSV)": _file("e.csv", lambda rng: mutants.csv_file(rng, _TABLE), _told(table)),
        "h2sl": _file("h.xml", lambda rng: mutants.xml_file(rng, _EXAMPLE), _told(h2sl)),
        "h2sl symbols": _file("h.xml", lambda rng: mutants.xml_file(rng, _SYMBOLS), _told(h2sl_symbols)),
        "iref_vla": Reader(_iref_vla, _told(iref_vla)),
        "concept_graphs": _file("scene_graph.json", _concept_graphs, _told(concept_graphs)),
        "percepts": Reader(lambda rng, _: _percepts(rng), lambda given: world_model(given, ("cube",)), ValueError),
    }


def _file(name: str, content: Callable[[random.Random], bytes], read: Callable[[Path], Any]) -> Reader:
    def make(rng: random.Random, folder: Path) -> Path:
        (folder / name).write_bytes(content(rng))
        return folder / name

    return Reader(make, read)


def _told(importer: Any) -> Callable[[Path], None]:
    """Convert, and see that what was left out is said in printable lines."""

    def convert(path: Path) -> None:
        found = importer.convert(path)
        for line in found.told():
            if not line.isprintable():
                raise AssertionError(repr(line))

    return convert


_ANSWERS = b"""person,world,object,text
p1,hall,red_cube,"take the cube, please"
p2,hall,blue_drill,go to the drill
p3,yard,blue_cube,find it
"""
_TABLE = b"""id,text,object,type,x,y,z,color,target,size_x,robot_x,robot_y,robot_yaw,group
1,"take the cone, please",a,cone,1,2,0,red,,0.2,0,0,0,g
1,,b,cone,1,-2,0,red,x,0.2,,,,
2,go to the cube,a,cube,1.5,2,,blue,yes,,,,,
"""
_EXAMPLE = example('<object id="a"/>').encode()
_SYMBOLS = b"""<root><symbol_dictionary>
<string_property key="object_type" value="na,crate,robot,table,door,cone"/>
<string_property key="object_color_type" value="na,red,black,light blue"/>
<int_property key="index_value" value="1,2"/>
</symbol_dictionary></root>
"""


def _session(rng: random.Random) -> bytes:
    header = {"dcg_torch_session": 1, "world": WORLD, "model": None, "sha256": "0" * 64, "simulator": "fake", "seed": 0}
    move = {"move": {"id": "a", "position": [1.0, 2.0], "yaw": 0.5}}
    return mutants.json_lines(rng, header, {"say": "go to the cube", "pointing_at": "a"}, {"click": "a"}, move)


def _iref_vla(rng: random.Random, folder: Path) -> Path:
    for name, good in (("s_scene_graph.json", GRAPH), ("s_referential_statements.json", STATEMENTS)):
        (folder / name).write_bytes(mutants.json_file(rng, good))
    return folder


def _concept_graphs(rng: random.Random) -> bytes:
    good = [node(1, "cup", 1.0), node(2, "table", 1.5), edge(node(1, "cup", 1.0), node(2, "table", 1.5), "a on b")]
    return mutants.json_file(rng, good)


_PERCEPT: dict[str, Any] = {"id": "m", "type": "mug", "color": "blue", "position": [1.0, 0.5, 0.0], "size": [0.1] * 3}


def _percepts(rng: random.Random) -> list[Percept]:
    """As from a robot of others: the fields are there, whatever they hold."""
    made = []
    for _ in range(rng.randint(1, 3)):
        given = {**_PERCEPT, "attributes": ["held"], "rgb": [0, 0, 255], "id": str(rng.randrange(4))}
        for name in rng.sample(sorted(given), rng.randint(0, 2)):
            given[name] = mutants.value(rng)
        made.append(Percept(**given))
    return made


def _overrides(rng: random.Random, folder: Path) -> list[str]:
    """One to three settings of the command line: of a real one a strange value, or a strange name. Not in a folder."""
    names = [*(field for field in vars(Settings())), "model.l2", "model.groups", "simulator.spin_step", "model", "trls"]
    given = []
    for _ in range(rng.randint(1, 3)):
        name = rng.choice(names) if rng.random() < 0.9 else mutants.text(rng)
        raw = rng.choice(("1", "0", "null", "[0]", "true", "fake", "open_world", "${seed}", "canonical", "dcg,dcg"))
        strange = str(mutants.value(rng, 2)).encode("utf-8", "replace").decode()
        given.append(rng.choice(("", "", "", "+", "~")) + f"{name}={raw if rng.random() < 0.4 else strange}")
    return given


def _composed(overrides: list[str]) -> Settings:
    """What the command line makes of overrides, and how it refuses them."""
    if not GlobalHydra.instance().is_initialized():  # once for all inputs
        register()
        initialize_config_dir(str(resource("conf")), version_base="1.3")
    try:
        refuse_nothing(overrides)
        return settings_of(compose("config", overrides))
    except CONFIG_ERRORS as error:
        raise UserError(plain(" ".join(explain(error).split()), LONGEST)) from None  # as `cli.application` says it
    except OSError as error:  # a name too long
        raise UserError(plain(explain_os_error(error), LONGEST)) from None


_Saved = dict[str, tuple[dict[str, Any], dict[str, np.ndarray]]]


def _saved(directory: Path) -> _Saved:
    """Two saved models, the paper's and one with a posterior, of few examples."""
    found: _Saved = {}
    training = initial_training()
    for name, learner in (("paper", None), ("posterior", WordPosterior.start(training))):
        model = GroundingModel.trained(training, learner=learner)
        model.learn(model.ground(command_tree("drill"), saw(model, "green drill", "red cube")))
        model.save(directory / name)
        described = json.loads((directory / name / DESCRIPTION).read_bytes())
        kept = described["commit_first" if learner is None else "word_posterior"]
        kept["examples"] = kept["examples"][:6]
        found[name] = described, load((directory / name / WEIGHTS).read_bytes())
    return found


def _model(saved: _Saved, rng: random.Random, folder: Path) -> Path:
    described, tensors = saved[rng.choice(sorted(saved))]
    content = json.dumps(described).encode() if rng.random() < 0.3 else mutants.json_file(rng, described)
    (folder / DESCRIPTION).write_bytes(content)
    if rng.random() < 0.3:
        tensors = dict(tensors)
        name = rng.choice(sorted(tensors))
        changed = tensors[name].copy()
        if len(changed) and rng.random() < 0.8:
            strange = (np.nan, np.inf, -1, 0, 1e300, -1e300) if changed.dtype.kind == "f" else (-1, 0, 2**31 - 1)
            changed[rng.randrange(len(changed))] = rng.choice(strange)
        else:
            changed = rng.choice((changed[:-1], changed.astype(np.float32), changed.reshape(-1, 1)))
        tensors[name] = changed
    weights = save(tensors)
    (folder / WEIGHTS).write_bytes(weights if rng.random() < 0.7 else mutants.damaged(rng, weights))
    return folder


def _use(folder: Path) -> None:
    """A model that is taken grounds a command and learns from it."""
    model = load_model(folder)
    model.learn(model.ground(command_tree("drill"), saw(model, "green drill", "red cube")))


def _settings_of_run() -> Settings:
    return replace(Settings(), trials=2, iterations=2, workers=1)


def _lines(rng: random.Random, *records: Any) -> bytes:
    return mutants.json_lines(rng, *(record.model_dump(mode="json") for record in records))


def _run(rng: random.Random, folder: Path) -> Path:
    """A run folder in which one or two files are not what they were."""
    rows = [row(), *run(1, 2, 3)[1:]]
    strange = rng.sample(("iterations", "timings", "settings", "overrides", "summary"), rng.randint(1, 2))
    whole = random.Random(0)
    for name, records in (("iterations", rows), ("timings", [timing(), timing(0, 1)])):
        content = b"".join(record.model_dump_json().encode() + b"\n" for record in records)
        (folder / f"{name}.jsonl").write_bytes(_lines(rng, *records) if name in strange else content)
    settings = {"seed": 0, "model": {"name": "dcg", "l2": 0.5}}
    (folder / "settings.json").write_bytes(
        mutants.json_file(rng, settings) if "settings" in strange else mutants.json_bytes(whole, settings)
    )
    (folder / ".hydra").mkdir()
    given = ["model=dcg", "seed=0"]
    (folder / ".hydra" / "overrides.yaml").write_bytes(
        mutants.yaml_file(rng, given) if "overrides" in strange else b"- model=dcg\n- seed=0\n"
    )
    if "summary" in strange or rng.random() < 0.3:
        (folder / "summary.json").write_bytes(mutants.json_file(rng, _summary()))
    return folder


@functools.cache
def _summary() -> Any:
    """A good summary."""
    import tempfile

    from report_rows import write_run

    with tempfile.TemporaryDirectory() as name:
        folder = write_run(Path(name), [row(), *run(1, 2, 3)[1:]], overrides=["model=dcg"], model={"name": "a"})
        return json.loads((folder / "summary.json").read_bytes())


def _report(folder: Path) -> None:
    console = Console(file=io.StringIO(), width=100)
    one = load_run(folder)
    print_run(one.measures, one.seconds, one.config, console)
    print_several([one, one], console)
    to_csv([one])


def _unfinished(rng: random.Random, folder: Path) -> Path:
    """A run folder whose trials or settings are not what they were."""
    settings = _settings_of_run()
    mark_as_own(settings, folder)
    if rng.random() < 0.4:
        (folder / "settings.json").write_bytes(mutants.json_file(rng, asdict(settings)))
    for trial in range(settings.trials):
        lines = []
        for iteration in range(settings.iterations):
            pair = (row(trial, iteration).model_dump(mode="json"), timing(trial, iteration).model_dump(mode="json"))
            if rng.random() < 0.3:
                pair = (mutants.mutated(rng, pair[0]), mutants.mutated(rng, pair[1]))
            lines.append(b"\t".join(mutants.json_bytes(rng, half) for half in pair) + b"\n")
        part_of(folder, trial).write_bytes(mutants.damaged(rng, b"".join(lines)))
    return folder


def _owned(folder: Path) -> None:
    settings = _settings_of_run()
    check_owner(settings, folder)
    _, notes = open_trials(settings, folder)
    for note in notes:
        if not note.isprintable():
            raise AssertionError(repr(note))
