"""Fifty people who write commands at once, on a server that is killed twice: no acknowledged row may be lost."""

from __future__ import annotations

import contextlib
import http.client
import os
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from urllib.parse import urlencode

WRITERS, ROWS, KILLS = 50, 2_000, 2
EACH = ROWS // WRITERS
_FAILED = (OSError, http.client.HTTPException)


@dataclass
class Tally:
    """What all writers saw together."""

    kept: set[str] = field(default_factory=set)
    cut: int = 0  # requests that got no answer
    errors: int = 0  # answers of 500 and above
    slowest: float = 0.0


class Client:
    """One writer, with a cookie; asks again whatever got no answer."""

    def __init__(self, port: int, name: str, tally: Tally, until: float) -> None:
        self.port, self.name, self.tally, self.until = port, name, tally, until
        self.cookie = ""

    def ask(self, method: str, path: str, **form: str) -> tuple[str, str]:
        """Where the answer leads, and its text."""
        while time.monotonic() < self.until:
            began = time.monotonic()
            try:
                connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
                headers = {"Cookie": self.cookie, "Content-Type": "application/x-www-form-urlencoded"}
                connection.request(method, path, urlencode(form) if form else None, headers)
                response = connection.getresponse()
                text = response.read().decode()
            except _FAILED:
                self.tally.cut += 1
                time.sleep(0.2)
                continue
            finally:
                connection.close()
            self.tally.slowest = max(self.tally.slowest, time.monotonic() - began)
            if response.status >= 500:
                self.tally.errors += 1
                time.sleep(0.2)
                continue
            if given := response.getheader("Set-Cookie"):
                self.cookie = given.partition(";")[0]
            return response.getheader("Location") or "", text
        raise TimeoutError(self.name)

    def write(self) -> None:
        """Agree, and write for every picture until there is none."""
        self.ask("GET", f"/?participant={self.name}")
        self.ask("POST", "/", agree="yes")
        for number in range(EACH):
            text = f"{self.name} says go to thing {number}"
            while True:
                found = re.search(r'name="item" value="(\w+)"', self.ask("GET", "/task")[1])
                if found is None:
                    return
                where, _ = self.ask("POST", "/task", item=found.group(1), command=text)
                if where.endswith("note=kept"):
                    self.tally.kept.add(text)
                    break


def fifty_writers(rng: random.Random, directory: Path, until: float) -> tuple[bool, str]:
    """2,000 rows by 50 writers, the server killed twice on the way; every acknowledged row is looked for at the end."""
    if any(find_spec(name) is None for name in ("fastapi", "sqlalchemy", "uvicorn")):
        return True, "left out: it needs the extra collect"
    from dcg_torch.apps.collect.results import read_results

    _pictures(directory / "study")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    tally, began = Tally(), time.monotonic()
    threads = [
        threading.Thread(target=_written_by, args=(Client(port, f"w{k}", tally, until),)) for k in range(WRITERS)
    ]
    server = _serve(directory, port)
    for thread in threads:
        thread.start()
    try:
        for kill in range(KILLS):
            at = ROWS * (kill + rng.uniform(0.5, 1.0)) / (KILLS + 1)
            while len(tally.kept) < at and time.monotonic() < until:
                time.sleep(0.01)
            os.killpg(server.pid, signal.SIGKILL)
            server.wait()
            server = _serve(directory, port)
        for thread in threads:
            thread.join()
        seconds = time.monotonic() - began
    finally:
        os.killpg(server.pid, signal.SIGKILL)  # the third time: what was acknowledged last is there, too
        server.wait()
    texts = [row.text for row in read_results(str(directory / "study" / "answers.sqlite"))]
    lost, twice = tally.kept - set(texts), len(texts) - len(set(texts))
    good = not lost and not twice and len(texts) == ROWS and tally.kept == set(texts)
    said = (
        f"{len(texts)} rows by {WRITERS} writers in {seconds:.0f} s, {KILLS} kills (-9) on the way and one at the end; "
    )
    said += f"{len(tally.kept)} acknowledged, {len(lost)} lost, {twice} twice; {tally.cut} requests without an answer, "
    return good, said + f"{tally.errors} server errors, the slowest answer {tally.slowest:.1f} s"


def _written_by(client: Client) -> None:
    with contextlib.suppress(TimeoutError):  # too few rows tell
        client.write()


def _serve(directory: Path, port: int) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "dcg_torch.collect", "serve", "folder=study", f"port={port}"]
    command += [f"per_person={EACH}", f"per_object={WRITERS}"]
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    with (directory / "server.err").open("ab") as err:
        return subprocess.Popen(command, cwd=directory, env=environment, stdout=err, stderr=err, start_new_session=True)


def _pictures(folder: Path) -> None:
    """Empty pictures of the committed worlds: nobody looks at them here, and drawing takes longer than all else."""
    from dcg_torch.apps.collect.tasks import PICTURES, items_of
    from dcg_torch.storage.resources import resource
    from dcg_torch.world.files import load_worlds

    (folder / PICTURES).mkdir(parents=True)
    (folder / "salt").write_text("salt")
    for item in items_of(load_worlds(resource("worlds"))).values():
        (folder / PICTURES / item.picture).touch()
