"""The pages on which people write commands: who may write what, how often, and what is kept of whom."""

from __future__ import annotations

import re
import threading
import time
from pathlib import Path

import pytest
from making import typed

pytest.importorskip("fastapi", reason="needs the extra collect, and httpx2")
pytest.importorskip("sqlalchemy", reason="needs the extra collect, and httpx2")
pytest.importorskip("uvicorn", reason="needs the extra collect, and httpx2")
pytest.importorskip("httpx2", reason="needs the extra collect, and httpx2")

from collect_making import WORLDS, Writer, study

from dcg_torch.apps.collect.database import Answers, open_database, read_rows, sqlite_url
from dcg_torch.apps.collect.page import COOKIE
from dcg_torch.apps.collect.program import main
from dcg_torch.apps.collect.tasks import CollectError, items_of, prepare
from dcg_torch.apps.collect.texts import EXAMPLE, copied, empty, normal, tidy
from dcg_torch.cli.commands import COMMANDS
from dcg_torch.cli.commands import main as commands_main
from dcg_torch.world.files import World, load_world


def stored(folder: Path) -> list[tuple[str, str, str]]:
    return [(w.world, w.object, w.text) for w in read_rows(sqlite_url(folder / "answers.sqlite"))]


def test_a_person_agrees_writes_and_gets_a_code(tmp_path: Path) -> None:
    writer = Writer(study(tmp_path))
    assert "Picture 1 of 3" in writer.start()
    for k in range(3):
        said = writer.write(f"go to thing number {k}")
    code = re.search(r'id="code">(\w+)<', said)
    assert code is not None
    assert len(code.group(1)) == 10
    assert [text for *_, text in stored(tmp_path)] == [f"go to thing number {k}" for k in range(3)]
    assert len({(world, thing) for world, thing, _ in stored(tmp_path)}) == 3


def test_nobody_writes_without_having_agreed(tmp_path: Path) -> None:
    of = study(tmp_path)
    writer, item = Writer(of), next(iter(items_of(WORLDS)))
    assert "Tell a robot" in writer.client.get("/task").text
    assert "Tell a robot" in writer.write("go to the cube", item)
    assert "tick the box" in writer.client.post("/", data={}).text
    writer.client.cookies.clear()
    assert "cookies" in writer.client.post("/", data={"agree": "yes"}).text
    assert stored(tmp_path) == []


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (" \t\u200b", "empty"),
        ("?!", "empty"),
        ("cube", "one word"),
        ("go to the " + "very " * 70 + "red cube", "too long"),
        (EXAMPLE, "the example"),
        (" drive OVER to  the white piano", "the example"),
        ("go to the highlighted object", "does not see the marks"),
    ],
)
def test_what_is_refused_is_said_and_may_be_mended(text: str, says: str, tmp_path: Path) -> None:
    writer = Writer(study(tmp_path))
    writer.start()
    refused = writer.write(text)
    assert says in refused
    assert 'role="alert"' in refused
    assert "Picture 1 of 3" in refused
    assert stored(tmp_path) == []
    assert "Picture 2 of 3" in writer.write("go to it")


def test_a_text_is_taken_once_from_a_person_and_again_from_another(tmp_path: Path) -> None:
    of = study(tmp_path)
    one, other = Writer(of), Writer(of)
    for writer in (one, other):
        writer.start()
        assert "Picture 2" in writer.write("Go to the red cube.")
    again = one.write("go to the RED cube!")
    assert "earlier picture" in again
    assert "go to the RED cube!</textarea>" in again  # what was typed is not lost
    assert len(stored(tmp_path)) == 2


def test_what_was_typed_stays_text_on_the_page(tmp_path: Path) -> None:
    writer = Writer(study(tmp_path))
    assert "The &lt;b&gt;zoo" in writer.client.get("/").text
    writer.start()
    assert "&lt;/textarea&gt;&lt;script&gt;" in writer.write("</textarea><script>alert(1)</script> highlighted")


def test_a_command_sent_twice_is_one_row(tmp_path: Path) -> None:
    writer = Writer(study(tmp_path))
    writer.start()
    item = writer.item()
    assert "is kept" in writer.write("go to the cube", item)
    assert "is kept" in writer.write("go to the cube", item)  # the same, as after a lost answer
    assert "no more commands" in writer.write("go to the other one", item)  # by the back button
    assert [text for *_, text in stored(tmp_path)] == ["go to the cube"]


def test_an_object_gets_no_more_than_its_number_and_a_person_no_other_than_their_own(tmp_path: Path) -> None:
    of = study(tmp_path, per_person=99, per_object=2)
    for k in range(3):
        writer = Writer(of)
        said = writer.start()
        for n in range(5):
            if 'id="code"' in said:
                break
            said = writer.write(f"person {k} says {n}")
    assert 'id="code"' in said  # the third finds nothing to do, and is not to blame
    written = [(world, thing) for world, thing, _ in stored(tmp_path)]
    assert len(written) == 10
    assert all(written.count(pair) == 2 for pair in written)


def test_what_cannot_be_told_is_left_out_and_comes_no_more(tmp_path: Path) -> None:
    of = study(tmp_path, per_person=99, per_object=1)
    writer = Writer(of)
    said, shown = writer.start(), []
    while 'name="skip"' in said:
        shown.append(writer.item())
        said = writer.client.post("/task", data={"item": shown[-1], "command": "", "skip": "yes"}).text
        assert "You left that picture out" in said
        assert "Picture 1 of" in said
    assert len(set(shown)) == len(shown) == len(items_of(WORLDS)) - 1  # the last one has no other in its place
    assert 'id="code"' in writer.write("go to the thing that is left")
    assert len(stored(tmp_path)) == 1
    other = Writer(of)
    other.start()
    assert other.item() in shown  # others are shown what one person left out


def test_objects_are_spread_among_those_who_look_at_once(tmp_path: Path) -> None:
    of = study(tmp_path)
    writers = [Writer(of) for _ in range(5)]
    for writer in writers:
        writer.start()
    assert len({writer.item() for writer in writers}) == 5
    assert writers[0].item() == writers[0].item()  # a reload shows the same picture


def test_a_clock_that_is_put_back_gives_no_time_below_zero(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    url = sqlite_url(tmp_path / "answers.sqlite")
    answers = Answers(open_database(url), items_of(WORLDS), per_person=2, per_object=3)
    answers.agree("p")
    now = time.time()
    for put_back, seconds in ((-60.0, 60.0), (3_600.0, None)):
        task = answers.task("p")
        assert task is not None
        assert task.item is not None
        with monkeypatch.context() as patch:
            patch.setattr("dcg_torch.apps.collect.database.time.time", lambda back=put_back: now - back)
            assert answers.add("p", task.item.id, f"go to the thing {put_back}").kept
        took = read_rows(url)[-1].seconds
        assert (took is None) == (seconds is None)
        assert took is None or took == pytest.approx(seconds, abs=30.0)


def test_limits_hold_for_threads_at_once(tmp_path: Path) -> None:
    items = items_of(WORLDS)
    engine = open_database(sqlite_url(tmp_path / "answers.sqlite"))
    answers = Answers(engine, items, per_person=2, per_object=3)

    def write(person: str, tag: str) -> None:
        answers.agree(person)
        for k, item in enumerate(items):
            answers.add(person, item, f"{person} {tag} says {k}")

    threads = [threading.Thread(target=write, args=(f"p{k % 4}", f"t{k}")) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    found = read_rows(sqlite_url(tmp_path / "answers.sqlite"))
    assert {p: sum(w.person == p for w in found) for p in ("p0", "p1", "p2", "p3")} == dict.fromkeys(
        ("p0", "p1", "p2", "p3"), 2
    )
    assert max(sum(w.item == i for w in found) for i in items) <= 3


def test_a_worker_number_is_not_kept_and_leads_back_to_the_same_person(tmp_path: Path) -> None:
    of = study(tmp_path)
    for parameter in ("workerId", "PROLIFIC_PID"):
        writer = Writer(of, f"/?{parameter}=A1SECRETWORKER")
        assert str(writer.client.get("/").url) == "http://testserver/"
        writer.start()
    writer.write("go to the cube")
    elsewhere = Writer(of, "/?workerId=A1SECRETWORKER")
    assert "Picture 2 of 3" in elsewhere.start()
    key = elsewhere.client.cookies[COOKIE]
    kept = b"".join(p.read_bytes() for p in tmp_path.glob("answers.sqlite*"))
    assert b"go to the cube" in kept
    assert b"A1SECRETWORKER" not in kept
    assert key.encode() not in kept  # who reads the database cannot go on as a person
    assert of.person(key).encode() in kept
    assert study(tmp_path / "..").person(key) == of.person(key)


def test_a_huge_form_and_a_strange_page_are_refused(tmp_path: Path) -> None:
    writer = Writer(study(tmp_path))
    writer.start()
    assert writer.client.post("/task", data={"command": "x" * 20_000}).status_code == 413
    assert writer.client.get("/nowhere").status_code == 404
    assert writer.client.get("/pictures/../answers.sqlite").status_code == 404
    response = writer.client.get("/task")
    assert "frame-ancestors 'none'" in response.headers["Content-Security-Policy"]
    assert response.headers["Cache-Control"] == "no-store"
    assert "<script" not in response.text


def test_a_broken_database_is_said_and_nothing_is_acknowledged(tmp_path: Path) -> None:
    writer = Writer(study(tmp_path))
    writer.start()
    item = writer.item()
    engine = open_database(sqlite_url(tmp_path / "answers.sqlite"))
    with engine.begin() as connection:
        connection.exec_driver_sql("DROP TABLE written")
    response = writer.client.post("/task", data={"command": "go to the cube", "item": item})
    assert response.status_code == 503
    assert "send it again" in response.text


def test_every_row_is_on_the_disk_before_it_is_acknowledged(tmp_path: Path) -> None:
    with open_database(sqlite_url(tmp_path / "a.sqlite")).connect() as connection:
        got = [
            connection.exec_driver_sql(f"PRAGMA {p}").scalar() for p in ("journal_mode", "synchronous", "busy_timeout")
        ]
    assert got == ["wal", 2, 5000]  # 2: FULL


def test_texts_are_compared_without_case_stops_and_spaces() -> None:
    assert normal("Go  to the\u00a0Red CUBE!") == normal("go to the red cube")
    assert normal("the robot's left") != normal("the robots left")
    assert tidy("  go\nto\x07 it ") == "go to it"
    assert empty("go there") is None
    assert copied("go to the white piano") is None


def test_pictures_and_worlds_are_made_once_and_never_mixed(tmp_path: Path) -> None:
    said: list[str] = []
    small = [World(name="hall", objects=WORLDS[0].objects[:1])]
    items = prepare(tmp_path, small, said.append)
    (picture,) = (tmp_path / "pictures").iterdir()
    assert picture.stem in items
    assert "cube" not in picture.name
    assert load_world(tmp_path / "worlds" / "hall.yaml") == small[0]
    prepare(tmp_path, small, said.append)
    assert len(said) == 1
    with pytest.raises(CollectError, match="another world called 'hall'"):
        prepare(tmp_path, WORLDS[:1], said.append)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["swerve"], "take serve, hit or import"),
        (["serve", "prt=1"], "did you mean port?"),
        (["serve", "port=many"], "port=many"),
        (["serve", "per_person=0"], "from 1 to"),
        (["serve", "worlds=nowhere"], "no such directory of world files"),
        (["hit"], "pictures_at="),
        (["hit", "pictures_at=http://example.org/p"], "write the https address"),
        (["import"], "say what"),
        (["import", "no.csv", "worlds=committed"], "no such file of results"),
        (["import", "no.csv"], "no folder of worlds beside it"),
        (["import", "sqlite:////nope", "worlds=committed"], "there is no file /nope"),
        (["import", "odd://x", "worlds=committed"], "database=odd://x"),
    ],
)
def test_errors_are_one_line(
    arguments: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    status, _, err = typed(capsys, main, "dcg-torch", *arguments)
    assert (status, err.count("\n")) == (2, 1)
    assert says in err
    assert list(tmp_path.iterdir()) == []


def test_help_names_every_setting(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = typed(capsys, commands_main, "dcg-torch", "collect", "--help")
    assert status == 0
    assert all(f"  {name}=" in out for name in ("per_person", "per_object", "pictures_at", "database", "code"))
    assert COMMANDS["collect"].extra == "collect"
