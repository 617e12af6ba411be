"""What people wrote, imported: batch results of Mechanical Turk and rows of our own, good and bad."""

from __future__ import annotations

import contextlib
import csv
import json
import sqlite3
from pathlib import Path

import pytest
import yaml
from making import typed

pytest.importorskip("fastapi", reason="needs the extra collect, and httpx2")
pytest.importorskip("sqlalchemy", reason="needs the extra collect, and httpx2")
pytest.importorskip("uvicorn", reason="needs the extra collect, and httpx2")
pytest.importorskip("httpx2", reason="needs the extra collect, and httpx2")

from collect_making import HEADER, WORLDS, Writer, results, study

from dcg_torch.apps.collect.hit import make_hit
from dcg_torch.apps.collect.importing import import_results
from dcg_torch.apps.collect.program import main
from dcg_torch.apps.collect.results import read_results
from dcg_torch.apps.collect.settings import HitSettings, ImportSettings
from dcg_torch.apps.collect.tasks import items_of
from dcg_torch.evaluation.episodes import read_episodes
from dcg_torch.storage.errors import UserError
from dcg_torch.world.files import World, load_worlds
from dcg_torch.world.writing import yaml_lines

# A batch as a requester may download it: line 2 is the first row.
BATCH = (
    'h1,a1,ANNA,Approved,https://x/1.png,hall,red_cube,"Go to the red cube, please."',
    "h2,a2,ANNA,Approved,https://x/2.png,hall,blue_drill,drive to the blue drll",
    'h3,a3,BERT,Submitted,https://x/1.png,hall,red_cube,"Go to the\nred cube"',
    "h4,a4,BERT,Rejected,https://x/2.png,hall,blue_drill,asdf asdf",
    "h5,a5,BERT,Approved,https://x/3.png,hall,green_cone,   ",
    "h1,a1,ANNA,Approved,https://x/1.png,hall,red_cube,Go to the red cube",
    "h6,a6,ANNA,Approved,https://x/1.png,hall,red_cube,approach the red one",
    "h7,a7,ANNA,Approved,https://x/4.png,yard,red_cube,GO TO THE RED CUBE PLEASE",
    "h8,a8,CARL,Approved,https://x/4.png,yard,red_cuub,go to the red cube",
    "h9,a9,CARL,Approved,https://x/4.png,yardd,red_cube,go to the red cube",
    "h10,a10,CARL,Approved,https://x/3.png,hall,green_cone,Drive over to the white piano",
    ",,,,,,,",
    "h11,a11,CARL,Approved,https://x/5.png,yard,blue_cube,turn left",
    "h12,a12,CARL,Approved,https://x/3.png,hall,green_cone,go to the red cube",
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "worlds").mkdir()
    for world in WORLDS:
        (tmp_path / "worlds" / f"{world.name}.yaml").write_text("\n".join(yaml_lines(world)))
    return tmp_path


def imported(folder: Path, source: Path | str) -> tuple[str, Path]:
    out = folder / "out"
    return import_results(str(source), ImportSettings(folder=str(out))), out


def test_a_batch_of_results_is_imported_and_every_bad_line_said(folder: Path) -> None:
    said, out = imported(folder, results(folder, *BATCH))
    lines = said.splitlines()
    assert "13 rows; kept: 5 commands of 3 people for 4 objects" in lines[0]
    for part in (
        "rejected by whoever asked: 1, in line 6",
        "empty, one word, or beyond measure: 1, in line 7",
        "this person has a command for this object: 2, in line 8, 9",
        "copied: the example, the instructions, or the person's own text for another object: 2, in line 10 ('GO TO",
        "no such world or object: 2, in line 11 ('red_cuub', did you mean red_cube?), 12 ('yardd', did you mean yard?)",
        "misspelt: 1, in line 3 (drll for drill)",
        "without a noun that is found; 'thing' stands for it: 1, in line 15 ('turn left')",
    ):
        assert any(part in line for line in lines), (part, said)
    worlds = {world.name: world for world in load_worlds(out / "worlds")}
    told = [(c.text, c.target, c.noun, c.color) for c in worlds["hall"].commands]
    assert told == [
        ("Go to the red cube, please.", "red_cube", "cube", "red"),
        ("drive to the blue drll", "blue_drill", "drill", "blue"),  # as it was written; the noun is mended
        ("Go to the red cube", "red_cube", "cube", "red"),
        ("go to the red cube", "green_cone", "cube", "red"),  # wrong, and theirs
    ]
    assert worlds["hall"].objects == WORLDS[0].objects
    episodes = read_episodes(out / "episodes.jsonl")
    assert [(e.text, e.target) for e in episodes][-1] == ("go to the red cube", ("green_cone",))
    assert [json.loads(line)["person"] for line in (out / "episodes.jsonl").read_text().splitlines()] == [
        *("p001", "p001", "p002", "p003", "p003")
    ]
    everything = b"".join(p.read_bytes() for p in out.rglob("*") if p.is_file())
    assert not any(name in everything for name in (b"ANNA", b"BERT", b"CARL", b"a1,"))


def test_a_row_of_ours_comes_back_the_same(folder: Path) -> None:
    _, out = imported(folder, results(folder, *BATCH))
    first = {p.name: p.read_bytes() for p in out.rglob("*") if p.is_file()}
    again, _ = imported(out, out / "commands.csv")
    assert "5 rows; kept: 5 commands" in again
    assert {p.name: p.read_bytes() for p in (out / "out").rglob("*") if p.is_file()} == first


def test_the_answers_of_the_pages_are_imported(folder: Path) -> None:
    writer = Writer(study(folder))
    writer.start()
    writer.write("go to the cube")
    writer.write("move to that drll")
    said, out = imported(folder, folder / "answers.sqlite")
    assert "2 rows; kept: 2 commands of 1 people" in said
    by_url = read_results(f"sqlite:///{folder / 'answers.sqlite'}")
    assert [row.text for row in by_url] == ["go to the cube", "move to that drll"]
    with (out / "commands.csv").open(newline="") as file:
        assert [row["person"] for row in csv.DictReader(file)] == ["p001", "p001"]


def test_answers_of_a_form_that_does_not_flatten_them_are_read(folder: Path) -> None:
    header = HEADER.replace("Answer.command", "Answer.taskAnswers")
    good = 'h1,a1,ANNA,Approved,https://x/1.png,hall,red_cube,"[{""command"":""go to the cube""}]"'
    bad = 'h2,a2,ANNA,Approved,https://x/1.png,hall,blue_drill,"[oops"'
    said, _ = imported(folder, results(folder, good, bad, header=header))
    assert "kept: 1 commands" in said
    assert "empty, one word, or beyond measure: 1, in line 3" in said


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (
            HEADER.replace("Answer.command", "Answer.comand") + "\n",
            "no column Answer.command; Answer.comand must be it",
        ),
        (HEADER.replace("WorkerId", "Who") + "\n", "no column WorkerId"),
        ("a,b\n1,2\n", "no column person; it has a, b"),
        ("", "no column person; it has none"),
        ("person,world,object,text\n", "no command is kept"),
        ('person,world,object,text\nx,y,z,"' + "a" * 200_000, "line 2: not readable as CSV"),
        ("person,world,object,text\nx,hall\n", "no command is kept"),
    ],
)
def test_files_that_will_not_do_are_one_line(
    content: str, says: str, folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    (folder / "odd.csv").write_text(content)
    status, _, err = typed(capsys, main, "dcg-torch", "import", "odd.csv")
    assert (status, err.count("\n")) == (2, 1)
    assert says in err
    assert not (folder / "runs").exists()


def test_a_database_that_is_not_there_is_not_made(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="there is no file"):
        read_results(f"sqlite:///{tmp_path}/typo.sqlite")
    assert list(tmp_path.iterdir()) == []


def test_a_database_of_others_and_a_broken_one_are_refused_and_left_as_they_were(tmp_path: Path) -> None:
    other, broken = tmp_path / "other.sqlite", tmp_path / "broken.sqlite"
    with contextlib.closing(sqlite3.connect(other)) as connection:
        connection.execute("CREATE TABLE written (id INTEGER)")
    broken.write_bytes(other.read_bytes()[:200] + b"?" * 4_000)
    for path in (other, broken):
        with pytest.raises(UserError, match="is of this program"):
            read_results(str(path))
    with contextlib.closing(sqlite3.connect(other)) as connection:
        assert connection.execute("SELECT name FROM sqlite_master").fetchall() == [("written",)]


def test_a_folder_of_other_files_is_left_alone(folder: Path) -> None:
    source = results(folder, *BATCH)
    with pytest.raises(UserError, match="holds other files"):
        import_results(str(source), ImportSettings(folder=str(folder)))


def test_a_world_is_read_as_it_was_written(tmp_path: Path) -> None:
    odd = WORLDS[0].model_copy(update={"name": "no: {1}, \u00e9 #"})
    command = {"text": "go: 'to' {the} #1 \u201ccube\u201d", "target": "red_cube", "noun": "yes", "color": None}
    told = World.model_validate({**odd.model_dump(), "commands": [command], "relational": [command]})
    assert World.model_validate(yaml.safe_load("\n".join(yaml_lines(told)))) == told


def test_mechanical_turk_gets_the_task_and_its_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    worlds = tmp_path / "mine"
    worlds.mkdir()
    (worlds / "hall.yaml").write_text("\n".join(yaml_lines(World(name="hall", objects=WORLDS[0].objects[:2]))))
    settings = HitSettings(worlds=str(worlds), pictures_at="https://example.org/p/", asked_by="Us & co", folder="hit")
    make_hit(settings, lambda line: None)
    task = Path("hit/task.html").read_text()
    assert all(part in task for part in ("<crowd-form", 'src="${image_url}"', 'name="command"', "Us &amp; co"))
    with Path("hit/pictures.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["world"], row["object"]) for row in rows] == [("hall", "red_cube"), ("hall", "blue_drill")]
    items = items_of(WORLDS)
    for row in rows:
        name = row["image_url"].removeprefix("https://example.org/p/")
        assert Path("hit/pictures", name).is_file()
        assert items[Path(name).stem].object == row["object"]
