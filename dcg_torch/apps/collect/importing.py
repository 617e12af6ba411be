"""From rows to world files for `speaker=written`, episodes, and a CSV; what was left out is said, line by line."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from dcg_torch.apps.collect.results import OURS, Row, read_results
from dcg_torch.apps.collect.settings import ImportSettings
from dcg_torch.apps.collect.tasks import WORLDS, CollectError, worlds_folder
from dcg_torch.apps.collect.texts import copied, empty, normal, tidy
from dcg_torch.language import default_parser
from dcg_torch.language.tokens import mend, normal_noun, tokens
from dcg_torch.storage.atomic_files import write_whole, write_whole_folder
from dcg_torch.storage.claim import check_place
from dcg_torch.storage.untrusted_files import at_home, misspelt, plain, shown
from dcg_torch.world.files import World, WrittenCommand, load_worlds
from dcg_torch.world.writing import yaml_lines

COMMANDS, EPISODES = "commands.csv", "episodes.jsonl"
_NO_NOUN = "thing"  # the noun of a command in which none is found
_SHOWN = 12  # lines named of one kind


@dataclass(frozen=True)
class Kept:
    """A command that is kept, of the n-th person."""

    person: int
    world: World
    command: WrittenCommand


@dataclass
class Import:
    """What came of some rows: the commands kept, and what there is to say of the lines, by kind."""

    rows: int = 0
    kept: list[Kept] = field(default_factory=list)
    left_out: dict[str, list[str]] = field(default_factory=dict)
    noted: dict[str, list[str]] = field(default_factory=dict)


def judge(rows: Sequence[Row], worlds: Sequence[World]) -> Import:
    """Keep what is a person's own first command for an object; nothing is corrected."""
    found, known = Import(len(rows)), {world.name: world for world in worlds}
    seen: set[object] = set()
    earlier: dict[str, set[str]] = {}
    people: dict[str, int] = {}
    for row in rows:
        text, mine = tidy(row.text), earlier.setdefault(row.person, set())
        if why := _left_out(row, text, known, seen, mine):
            kind, detail = why
            found.left_out.setdefault(kind, []).append(f"{row.line}{detail and f' ({detail})'}")
            continue
        seen |= {row.assignment, (row.person, row.world, row.object)}
        mine.add(normal(text))
        command = _command(row, text, known[row.world], found)
        found.kept.append(Kept(people.setdefault(row.person, len(people) + 1), known[row.world], command))
    return found


def _left_out(
    row: Row, text: str, worlds: dict[str, World], seen: set[object], mine: set[str]
) -> tuple[str, str] | None:
    """(kind, detail) where a row is not kept."""
    if row.rejected:
        return "rejected by whoever asked", ""
    if not row.person:
        return "without a worker", ""
    for name, known in ((row.world, tuple(worlds)), (row.object, _objects(worlds.get(row.world)))):
        if name not in known:
            near = misspelt(name, known)
            return "of no such world or object", shown(name) + (f", did you mean {near}?" if near else "")
    if empty(text):
        return "empty, one word, or beyond measure", ""
    if (row.assignment is not None and row.assignment in seen) or (row.person, row.world, row.object) in seen:
        return "duplicates: this person has a command for this object", ""
    if copied(text, mine):
        return "copied: the example, the instructions, or the person's own text for another object", shown(text)
    return None


def _objects(world: World | None) -> tuple[str, ...]:
    return () if world is None else tuple(o.id for o in world.objects)


def _command(row: Row, text: str, world: World, found: Import) -> WrittenCommand:
    types = frozenset(normal_noun(o.type) for o in world.objects)
    parse = default_parser().parse(text, types)
    words = tokens(text)
    mended = mend(words, types)
    if len(mended) == len(words):
        changes = [f"{plain(old)} for {new}" for old, new in zip(words, mended, strict=True) if old != new]
        if changes:
            found.noted.setdefault("misspelt", []).append(f"{row.line} ({', '.join(changes)})")
    if parse.noun is None:
        what = f"without a noun that is found; {_NO_NOUN!r} stands for it"
        found.noted.setdefault(what, []).append(f"{row.line} ({shown(text)})")
    return WrittenCommand(text=text, target=row.object, noun=parse.noun or _NO_NOUN, color=parse.color, away=False)


def import_results(source: str, settings: ImportSettings) -> str:
    """Read, judge and write; what there is to say.

    Raises:
        UserError: something cannot be read or written, or there is nothing to keep.
    """
    folder = at_home(settings.folder)
    beside = at_home(source).parent / WORLDS
    if settings.worlds is None and ("://" in source or not beside.is_dir()):
        raise CollectError(
            f"{plain(source, 200)}: no folder of worlds beside it; name one: worlds=committed, worlds=FOLDER"
        )
    worlds = load_worlds(beside if settings.worlds is None else worlds_folder(settings.worlds))
    check_place(folder, (COMMANDS,), setting="folder")
    found = judge(read_results(source), worlds)
    said = describe(found, source)
    if not found.kept:
        raise CollectError(f"no command is kept; {'; '.join(said.splitlines())}")
    _write(found, folder)
    written = f"written: {folder / COMMANDS}, {folder / EPISODES}, {folder / WORLDS}"
    return f"{said}\n{written}\nrun them: python -m dcg_torch speaker=written worlds={folder / WORLDS}"


def describe(found: Import, source: str) -> str:
    """Counts, and the lines of what was left out or is to be looked at."""
    people, objects = len({k.person for k in found.kept}), len({(k.world.name, k.command.target) for k in found.kept})
    lines = [
        f"{plain(source, 200)}: {found.rows} rows; kept: {len(found.kept)} commands of {people} people "
        f"for {objects} objects"
    ]
    for prefix, kinds in (("left out", found.left_out), ("kept", found.noted)):
        for kind, of in kinds.items():
            more = f" and {len(of) - _SHOWN} more" if len(of) > _SHOWN else ""
            lines.append(f"{prefix}, {kind}: {len(of)}, in line {', '.join(of[:_SHOWN])}{more}")
    same = Counter((k.world.name, k.command.target, normal(k.command.text)) for k in found.kept)
    if several := sum(times - 1 for times in same.values()):
        lines.append(f"kept, the same as another person's for the same object: {several}")
    return "\n".join(lines)


def _write(found: Import, folder: Path) -> None:
    table, episodes = io.StringIO(newline=""), []
    writer = csv.writer(table)
    writer.writerow(OURS.values())
    by_world: dict[str, tuple[World, list[WrittenCommand]]] = {}
    for number, kept in enumerate(found.kept):
        person = f"p{kept.person:03d}"
        writer.writerow((person, kept.world.name, kept.command.target, kept.command.text))
        episodes.append(json.dumps(_episode(f"collected-{number:04d}", person, kept), ensure_ascii=False) + "\n")
        by_world.setdefault(kept.world.name, (kept.world, []))[1].append(kept.command)
    write_whole(folder / COMMANDS, table.getvalue())
    write_whole(folder / EPISODES, "".join(episodes))

    def fill(directory: Path) -> None:
        for world, commands in by_world.values():
            told = world.model_copy(update={"commands": tuple(commands), "relational": ()})
            head = ["# The commands were written by people; made by `dcg-torch collect import`."]
            (directory / f"{world.name}.yaml").write_text("\n".join([*head, *yaml_lines(told)]) + "\n", "utf-8")

    write_whole_folder(folder / WORLDS, fill)


def _episode(name: str, person: str, kept: Kept) -> dict[str, object]:
    """A line of an episode file: everything is in view, as it was for the person."""
    things = [
        {"id": o.id, "type": o.type, "color": o.color, "position": [*o.position, 0.0]} for o in kept.world.objects
    ]
    told = {"id": name, "text": kept.command.text, "robot": kept.world.robot.model_dump(), "objects": things}
    return {**told, "target": [kept.command.target], "world": kept.world.name, "person": person}
