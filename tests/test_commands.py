"""`dcg-torch COMMAND`: each is found, and one whose packages are missing names the extra."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from making import typed

from dcg_torch.cli import convert, pretrain
from dcg_torch.cli.commands import COMMANDS, Command, main, may_take_workers, start, usage


def test_every_command_has_a_module_and_a_line_of_help() -> None:
    for name, command in COMMANDS.items():
        assert find_spec(f"dcg_torch.{command.module}") is not None
        assert f"  {name} " in usage()


def test_without_arguments_the_commands_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in ([], ["--help"], ["help"]):
        status, out, _ = typed(capsys, main, "dcg-torch", *arguments)
        assert status == 0
        assert all(command.does in out for command in COMMANDS.values())


def test_a_command_gets_its_arguments(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = typed(capsys, main, "dcg-torch", "completion", "bash")
    assert status == 0
    assert out.startswith("_dcg_torch()")
    status, out, _ = typed(capsys, main, "dcg-torch", "evaluate", "--help")
    assert "usage: python -m dcg_torch.evaluate" in out


@pytest.mark.parametrize("name", ["evaluate", "talk"])
def test_help_comes_without_torch(name: str) -> None:
    """And without the packages of the extra that the page needs."""
    program = (
        "import sys; sys.modules.update(torch=None, nicegui=None); from dcg_torch.cli.commands import start; "
        f"sys.exit(start('{name}', ['dcg-torch {name}', '--help']))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert f"usage: python -m dcg_torch.{name}" in done.stdout
    assert "model" in done.stdout


def test_help_on_a_command_is_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = typed(capsys, main, "dcg-torch", "help", "convert")
    assert status == 0
    assert "iref_vla" in out


WRONG = [
    ("help evalute", "did you mean evaluate?"),
    ("help no_such_thing", "there is no such command; take run, evaluate"),
    ("evalute test=x.jsonl", "evalute: there is no such command; did you mean evaluate?"),
    ("no-such", "there is no such command; take run, evaluate"),
    ("convert", "KIND, PATH, --out"),
    ("convert nonsense x --out y", "invalid choice: 'nonsense'"),
    ("convert h2sl no_such_file", "--out"),
    ("convert csv no_such_file.csv --out out.jsonl", "no_such_file.csv"),
    ("convert csv . --out out.jsonl", "this is no file"),
    ("collect nonsense", "there is no such command"),
    ("collect import", "say what"),
    ("collect serve port=abc", "port"),
    ("collect serve port=99999999", "port"),
    ("report", "DIR"),
    ("report no_such_folder", "no such folder"),
    ("report no_such_folder --figures gif", "invalid choice: 'gif'"),
    ("schema --nope", "--nope"),
    ("schema {file}", "give"),
    ("completion fish", "invalid choice: 'fish'"),
    ("completion", "SHELL"),
    ("evaluate --nope", "--nope"),
    ("--nope", "--nope"),
]


@pytest.mark.parametrize(("line", "says"), WRONG, ids=[line for line, _ in WRONG])
def test_wrong_input_is_one_line_and_exit_status_2(
    line: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.chdir(tmp_path)
    status, out, err = typed(capsys, main, "dcg-torch", *line.format(file=file).split())
    assert (status, out, err.count("\n")) == (2, "", 1), err
    assert err.startswith("dcg_torch: ")
    assert says in err


def test_overrides_alone_are_an_experiment(capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = typed(capsys, main, "dcg-torch", "trils=3")
    assert (status, err.count("\n")) == (2, 1)
    assert "did you mean trials?" in err


def test_a_missing_extra_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    needy = Command("cli.needy", "needs what is not there", "needy", ("no_such_package",))
    (tmp_path / "needy.py").write_text("import no_such_package.inside\n")
    monkeypatch.setattr("dcg_torch.cli.__path__", [str(tmp_path)])
    status, _, err = typed(capsys, lambda: main({"run": COMMANDS["run"], "needy": needy}), "dcg-torch", "needy")
    assert (status, err.count("\n")) == (2, 1)
    assert "needs no_such_package, of the extra needy: pip install 'dcg-torch[needy]'" in err


# As where PyBullet has no wheels: an import of it fails, and it cannot be found.
WITHOUT = """
import sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("pybullet", "pybullet_utils", "pybullet_data"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Absent())
import importlib.util
real = importlib.util.find_spec
importlib.util.find_spec = lambda name, package=None: None if name == "pybullet" else real(name, package)
import dcg_torch, dcg_torch.cli.evaluate
from dcg_torch.cli.run import main
sys.exit(main())
"""


@pytest.mark.slow
def test_without_pybullet_the_fake_robot_runs_and_the_other_says_how_to_get_it(tmp_path: Path) -> None:
    plain = ["workers=1", "trials=1", "iterations=1", "speaker=canonical", "figures=false", "tensorboard=false"]
    for simulator, status, says in (("fake", 0, ""), ("pybullet", 2, "pip install pybullet==3.2.7")):
        done = subprocess.run(
            [
                *(sys.executable, "-c", WITHOUT, *plain, f"simulator={simulator}"),
                f"hydra.run.dir={tmp_path / simulator}",
            ],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == status, done.stderr
        assert says in done.stderr
        assert done.stderr.count("\n") == (status == 2)


def test_ctrl_c_while_a_command_is_loaded_is_one_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(name: str) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("dcg_torch.cli.commands.importlib.import_module", interrupted)
    assert start("pretrain", ["dcg-torch pretrain"]) == 130
    assert capsys.readouterr().err == "dcg_torch: interrupted\n"


def test_ctrl_c_while_options_are_read_is_one_line(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("argparse.ArgumentParser.parse_args", interrupted)
    for program, arguments in ((pretrain.main, ["--lessons=0"]), (convert.main, ["csv", "a", "--out=b"])):
        with pytest.raises(SystemExit) as left:
            program(arguments)
        assert left.value.code == 130
        assert capsys.readouterr().err.startswith("dcg_torch: interrupted")


def test_what_workers_need_is_loaded_only_where_there_may_be_some() -> None:
    assert may_take_workers(["experiment=paper", "simulator=fake", "workers=16"])
    for alone in (["--help"], ["-m", "seed=1,2"], ["seed=1", "workers=1"], ["trials=1"], ["backend=loky"]):
        assert not may_take_workers(alone)
