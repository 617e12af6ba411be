"""A worker in a real browser writes ten commands; they are imported, and a robot carries them out."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from making import typed, world_file

pytest.importorskip("fastapi", reason="needs the extra collect")
pytest.importorskip("sqlalchemy", reason="needs the extra collect")
pytest.importorskip("uvicorn", reason="needs the extra collect")

from browser import chromium, serving

from dcg_torch.apps.collect.tasks import items_of
from dcg_torch.cli.commands import main
from dcg_torch.world.writing import yaml_lines

# Ten things in a ring about the robot. The commands below were written for this test.
PLACES = [(3, 0), (2, 2), (0, 3), (-2, 2), (-3, 0), (-2, -2), (0, -3), (2, -2), (4, 3), (-4, -3)]
THINGS = ["red cube", "green cube", "blue cube", "red sphere", "green sphere", "blue sphere", "red cylinder"]
THINGS += ["green cylinder", "blue cylinder", "red mailbox"]
WORLD = world_file(*((thing, x, y) for thing, (x, y) in zip(THINGS, PLACES, strict=True)), name="ring")


def written(page: Any) -> str:
    """Write for the object of the picture that is shown; the command."""
    item = items_of([WORLD])[page.locator("input[name=item]").get_attribute("value")]
    text = f"Please go to the {item.object.replace('_', ' ')}"
    page.get_by_label("Write a command").fill(text)
    with page.expect_navigation():  # else a reload may come while the next page does
        page.get_by_role("button", name="Send").click()
    return text


@pytest.mark.slow
def test_a_worker_writes_ten_commands_which_are_imported_and_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "ring.yaml").write_text("\n".join(yaml_lines(WORLD)))
    with chromium() as browser, serving("collect", "serve", "port=0", "worlds=mine", cwd=tmp_path) as address:
        # As on a phone, and without JavaScript.
        context = browser.new_context(viewport={"width": 360, "height": 740}, java_script_enabled=False)
        page = context.new_page()
        page.goto(f"{address}?PROLIFIC_PID=5f3a")
        page.get_by_role("checkbox").check()
        page.get_by_role("button", name="Start").click()
        assert page.get_by_role("img").bounding_box()["width"] <= 360
        page.get_by_label("Write a command").fill("Drive over to the white piano.")
        page.get_by_role("button", name="Send").click()
        assert "example" in page.get_by_role("alert").inner_text()
        told = [written(page) for _ in range(5)]
        page.reload()
        told += [written(page) for _ in range(5)]
        assert re.fullmatch(r"[0-9A-F]{10}", page.locator("#code").inner_text())
    monkeypatch.chdir(tmp_path)
    status, out, err = typed(capsys, main, "dcg-torch", "collect", "import", "runs/collect/answers.sqlite")
    assert (status, "kept: 10 commands of 1 people for 10 objects" in out) == (0, True), err
    settings: tuple[str, ...] = (
        "speaker=written",
        "simulator=fake",
        "worlds=runs/collect_import/worlds",
        "order=file",
        "trials=1",
    )
    settings += ("workers=1", "figures=false", "tensorboard=false", "hydra.run.dir=runs/told")
    status, _, err = typed(capsys, main, "dcg-torch", *settings)
    assert status == 0, err
    lines = [json.loads(line) for line in Path("runs/told/iterations.jsonl").read_text().splitlines()]
    assert [line["command"] for line in lines] == told
    assert all(line["correct"] for line in lines[:3])
