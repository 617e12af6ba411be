"""What the tests of `collect` share: a study without pictures, and someone who writes for it."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi.testclient import TestClient
from making import world_file

from dcg_torch.apps.collect.database import Answers, open_database, sqlite_url
from dcg_torch.apps.collect.page import Study, make_app
from dcg_torch.apps.collect.settings import ServeSettings
from dcg_torch.apps.collect.tasks import items_of
from dcg_torch.world.files import World

WORLDS = [
    world_file(("red cube", 2, 0), ("blue drill", 2, 1), ("green cone", -2, 1), name="hall"),
    world_file(("red cube", 1, 0), ("blue cube", 2, 1), name="yard"),
]
HEADER = "HITId,AssignmentId,WorkerId,AssignmentStatus,Input.image_url,Input.world,Input.object,Answer.command"


def study(folder: Path, worlds: list[World] | None = None, per_person: int = 3, per_object: int = 2) -> Study:
    items = items_of(WORLDS if worlds is None else worlds)
    answers = Answers(open_database(sqlite_url(folder / "answers.sqlite")), items, per_person, per_object)
    (folder / "pictures").mkdir(exist_ok=True)
    return Study(ServeSettings(asked_by="The <b>zoo</b>"), answers, folder / "pictures", b"a salt")


class Writer:
    """A person with a browser."""

    def __init__(self, of: Study, address: str = "/") -> None:
        self.client = TestClient(make_app(of), follow_redirects=True)
        self.client.get(address)

    def start(self) -> str:
        return self.client.post("/", data={"agree": "yes"}).text

    def item(self) -> str:
        found = re.search(r'name="item" value="(\w+)"', self.client.get("/task").text)
        assert found is not None
        return found.group(1)

    def write(self, text: str, item: str | None = None) -> str:
        return self.client.post("/task", data={"command": text, "item": item or self.item()}).text


def results(folder: Path, *rows: str, header: str = HEADER) -> Path:
    path = folder / "results.csv"
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path
