"""Files that appear whole, folders of one owner, and messages that carry nothing of a hostile file."""

from __future__ import annotations

import errno
import itertools
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.storage.atomic_files import (
    _to_disk,
    read_whole_files,
    sweep_parts,
    write_whole,
    write_whole_files,
    write_whole_folder,
)
from dcg_torch.storage.claim import LOCK, ClaimError, check_place, claim
from dcg_torch.storage.errors import explain_os_error
from dcg_torch.storage.untrusted_files import misspelt, plain, shown


class TestWhole:
    def test_content_of_every_kind(self, tmp_path: Path) -> None:
        for content in ("grün", "grün".encode(), lambda path: path.write_text("grün", encoding="utf-8")):
            path = write_whole(tmp_path / "new" / "a.txt", content)
            assert path.read_text(encoding="utf-8") == "grün"
            assert [p.name for p in path.parent.iterdir()] == ["a.txt"]

    def test_a_writer_is_given_the_suffix(self, tmp_path: Path) -> None:
        given_paths: list[Path] = []

        def write(path: Path) -> None:
            given_paths.append(path)
            path.touch()

        write_whole(tmp_path / "a.gif", write)
        assert given_paths[0].suffix == ".gif"

    def test_the_old_file_stays_if_the_writer_fails(self, tmp_path: Path) -> None:
        path = write_whole(tmp_path / "a.txt", "old")

        def fail(part: Path) -> None:
            part.write_text("half")
            raise OSError(errno.ENOSPC, "No space left on device", str(part))

        with pytest.raises(OSError, match="No space"):
            write_whole(path, fail)
        assert {p.name: p.read_text() for p in tmp_path.iterdir()} == {"a.txt": "old"}

    def test_a_folder_is_replaced_as_one(self, tmp_path: Path) -> None:
        def fill(folder: Path) -> None:
            (folder / "new").write_text("new")

        (tmp_path / "model").mkdir()
        (tmp_path / "model" / "old").write_text("old")
        write_whole_folder(tmp_path / "model", fill)
        assert [str(p.relative_to(tmp_path)) for p in sorted(tmp_path.rglob("*"))] == ["model", "model/new"]

    def test_a_folder_that_cannot_be_filled_stays_as_it_was(self, tmp_path: Path) -> None:
        def fail(folder: Path) -> None:
            (folder / "half").write_text("half")
            raise OSError(errno.ENOSPC, "No space left on device")

        (tmp_path / "model").mkdir()
        (tmp_path / "model" / "old").write_text("old")
        with pytest.raises(OSError, match="No space"):
            write_whole_folder(tmp_path / "model", fail)
        assert [str(p.relative_to(tmp_path)) for p in sorted(tmp_path.rglob("*"))] == ["model", "model/old"]

    @pytest.mark.parametrize("point", range(1, 8))
    def test_files_that_belong_together_never_stand_beside_those_of_another_writing(
        self, point: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The process dies before the `point`-th step on the disk."""
        write_whole_files(tmp_path, {"weights": b"old", "description": b"old"})
        steps = itertools.count(1)

        def dying(real: Callable[..., object]) -> Callable[..., object]:
            def step(*arguments: object) -> object:
                if next(steps) >= point:
                    raise _Killed
                return real(*arguments)

            return step

        with monkeypatch.context() as patch:
            patch.setattr("dcg_torch.storage.atomic_files._to_disk", dying(_to_disk))
            patch.setattr("dcg_torch.storage.atomic_files.os.replace", dying(os.replace))
            with pytest.raises(_Killed):
                write_whole_files(tmp_path, {"weights": b"new", "description": b"new"})
        description = tmp_path / "description"
        if description.exists():
            assert (tmp_path / "weights").read_bytes() == description.read_bytes()
        write_whole_files(tmp_path, {"weights": b"new", "description": b"new"})
        assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == {"weights": b"new", "description": b"new"}

    def test_who_reads_while_it_is_written_anew_gets_files_of_one_writing(self, tmp_path: Path) -> None:
        """The reader opens the old description; before it reads the weights, they are those of another writing."""
        write_whole_files(tmp_path, {"weights": b"0", "description": b"0"})
        stop = threading.Event()

        def writes() -> None:
            for number in itertools.count(1):
                write_whole_files(tmp_path, {"weights": b"%d" % number, "description": b"%d" % number})
                if stop.is_set():
                    return

        writer = threading.Thread(target=writes)
        writer.start()
        try:
            for _ in range(300):
                found = read_whole_files(tmp_path, ("weights", "description"))
                assert found["weights"] == found["description"]
        finally:
            stop.set()
            writer.join()

    def test_files_that_a_killed_writing_left_without_their_last_are_missing(self, tmp_path: Path) -> None:
        (tmp_path / "weights").touch()
        with pytest.raises(FileNotFoundError, match="description"):
            read_whole_files(tmp_path, ("weights", "description"))
        with pytest.raises(FileNotFoundError, match="description"):
            read_whole_files(tmp_path / "none", ("weights", "description"))

    def test_what_killed_writers_left_is_swept_up(self, tmp_path: Path) -> None:
        (tmp_path / "trials").mkdir()
        for left in (".a.1f.part.gif", "trials/.b.22.part"):
            (tmp_path / left).touch()
        (tmp_path / ".model.3a.part").mkdir()
        (tmp_path / "kept.part.txt").touch()
        sweep_parts(tmp_path)
        assert [str(p.relative_to(tmp_path)) for p in sorted(tmp_path.rglob("*"))] == ["kept.part.txt", "trials"]


class _Killed(BaseException):
    """As a kill, at a moment of one's choice."""


# Claims a folder, says so, and waits to be told to end.
HOLDER = """
import sys
from collections.abc import Callable
from pathlib import Path
from dcg_torch.storage.claim import ClaimError, claim
try:
    with claim(Path(sys.argv[1])):
        print("mine", flush=True)
        sys.stdin.readline()
except ClaimError as error:
    print(error, flush=True)
"""


def holder(directory: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", HOLDER, str(directory)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )


def first_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline()


class TestClaim:
    def test_the_second_is_told_and_the_lock_ends_with_its_process(self, tmp_path: Path) -> None:
        owner = holder(tmp_path / "run")
        assert first_line(owner) == "mine\n"
        with pytest.raises(ClaimError, match="another process works in this folder"), claim(tmp_path / "run"):
            pass
        owner.kill()
        owner.communicate()
        with claim(tmp_path / "run"):
            assert (tmp_path / "run" / LOCK).exists()
        assert not (tmp_path / "run" / LOCK).exists()

    def test_of_many_at_once_one_has_it(self, tmp_path: Path) -> None:
        rivals = [holder(tmp_path / "run") for _ in range(4)]
        said = sorted(first_line(rival) for rival in rivals)
        for rival in rivals:
            rival.communicate("\n")
        assert said[1:].count("mine\n") + said[:1].count("mine\n") == 1
        assert all("another process works in this folder" in line for line in said if line != "mine\n")

    @pytest.mark.parametrize(
        ("place", "says"),
        [
            ("/", "this is / itself"),
            ("", "itself"),
            ("~", "itself"),
            ("/dev/null", "no folder"),
            ("a_file/run", "folder"),
        ],
    )
    def test_what_is_no_place_for_a_run(
        self, place: str, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.chdir(tmp_path)
        (tmp_path / "a_file").touch()
        with pytest.raises(ClaimError, match=says) as error, claim(Path(place).expanduser()):
            pass
        assert "\n" not in str(error.value)
        assert [p.name for p in tmp_path.iterdir()] == ["a_file"]

    def test_names_too_long_and_links_in_a_circle(self, tmp_path: Path) -> None:
        (tmp_path / "round").symlink_to(tmp_path / "round")
        for place in (tmp_path / ("x" * 300), tmp_path / "round" / "run"):
            with pytest.raises(ClaimError, match="give a"), claim(place):
                pass

    def test_other_files_are_left_alone(self, tmp_path: Path) -> None:
        (tmp_path / "thesis.tex").touch()
        with pytest.raises(ClaimError, match=r"thesis\.tex"):
            check_place(tmp_path, ("settings.json",))
        (tmp_path / "settings.json").touch()
        check_place(tmp_path, ("settings.json",))


@given(st.text())
def test_what_is_quoted_is_short_and_has_no_control_characters(text: str) -> None:
    for quoted in (shown(text), plain(text)):
        assert quoted.isprintable()
        assert len(quoted) <= 65


@pytest.mark.parametrize(
    "value", [10**5000, "\x1b[31mred", {"a": 1}, [[]] * 1000, b"\xff" * 99, None, 1e308], ids=lambda v: type(v).__name__
)
def test_values_of_any_kind_are_shown_short(value: Any) -> None:
    assert len(shown(value)) <= 65
    assert shown(value).isprintable()


def test_a_misspelt_key_is_told_from_another() -> None:
    known = ("position", "color", "size")
    assert misspelt("postion", known) == "position"
    assert misspelt("Colour", known) == "color"
    assert misspelt("orientation", known) is None
    assert misspelt("size_word", known) is None


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.ENAMETOOLONG, errno.EACCES, errno.ENOTDIR])
def test_what_the_machine_says_is_one_line_that_mends(number: int) -> None:
    said = explain_os_error(OSError(number, os.strerror(number), "some/file"))
    assert said.startswith(f"some/file: {os.strerror(number)}; ")
    assert "\n" not in said


def test_a_folder_is_claimed_where_nobody_knows_the_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a container whose user has no name."""
    monkeypatch.delenv("HOME")
    monkeypatch.setattr("pwd.getpwuid", lambda uid: {}[uid])
    with claim(tmp_path / "run"):
        assert (tmp_path / "run" / LOCK).exists()
