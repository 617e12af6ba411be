"""`dcg-torch collect serve|hit|import [KEY=VALUE ...]`: where it is put together."""

from __future__ import annotations

import os
import secrets
import socket
import sys
from pathlib import Path

import uvicorn

from dcg_torch.apps.collect.database import Answers, open_database, sqlite_url
from dcg_torch.apps.collect.hit import make_hit
from dcg_torch.apps.collect.page import WORKER_IDS, Study, make_app
from dcg_torch.apps.collect.settings import HitSettings, ImportSettings, ServeSettings
from dcg_torch.apps.collect.tasks import PICTURES, CollectError, prepare, task_worlds
from dcg_torch.cli.application import one_line_errors
from dcg_torch.cli.keyvalue import read_settings, settings_text
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.claim import check_place
from dcg_torch.storage.untrusted_files import at_home

_SALT, _DATABASE = "salt", "answers.sqlite"
_LOOPBACK = ("127.0.0.1", "::1", "localhost")
_USAGE = """\
usage: dcg-torch collect serve [KEY=VALUE ...]
       dcg-torch collect hit pictures_at=ADDRESS [KEY=VALUE ...]
       dcg-torch collect import RESULTS [KEY=VALUE ...]

People write commands for highlighted objects. serve asks them on pages of its own; hit makes the same task for
Mechanical Turk; import makes world files (speaker=written) and episodes of Mechanical Turk's batch results (CSV), of a
CSV with the columns person, world, object and text, or of serve's database (a file or an SQLAlchemy URL).
"""


def serve(settings: ServeSettings) -> None:
    """Serve the pages until it is stopped; the first line of output is the address.

    Raises:
        UserError: the worlds, the folder, the database or the address will not do.
    """
    folder, worlds = at_home(settings.folder), task_worlds(settings)
    check_place(folder, (_SALT,), setting="folder")
    salt = _salt(folder / _SALT)
    items = prepare(folder, worlds, _say)
    engine = open_database(settings.database or sqlite_url(folder / _DATABASE))
    answers = Answers(engine, items, settings.per_person, settings.per_object)
    app = make_app(Study(settings, answers, folder / PICTURES, salt, settings.code))
    try:
        family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
        listening = socket.create_server((settings.host, settings.port), family=family, backlog=512)
    except (OSError, UnicodeError) as error:
        said = getattr(error, "strerror", None) or "no such address"
        raise CollectError(f"host={settings.host} port={settings.port}: {said}; give others, port=0 for any") from None
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    print(f"http://{host}:{listening.getsockname()[1]}/", flush=True)
    _say(
        f"{len(items)} objects; add ?{WORKER_IDS[1]}=... or ?{WORKER_IDS[0]}=... for workers with a number; Ctrl-C ends"
    )
    if settings.host not in _LOOPBACK:
        _say("other machines can reach this: whoever has the address can write")
    with listening:
        uvicorn.Server(uvicorn.Config(app, log_level="warning", access_log=False)).run(sockets=[listening])


def _salt(path: Path) -> bytes:
    """The secret that people's ids are mixed with; kept beside the database and not in it."""
    if not path.exists():
        write_whole(path, secrets.token_hex(32))
        os.chmod(path, 0o600)
    return path.read_bytes()


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _run(command: str, arguments: list[str]) -> None:
    if command == "serve":
        serve(read_settings(ServeSettings, arguments))
    elif command == "hit":
        print(make_hit(read_settings(HitSettings, arguments), _say))
    elif command == "import":
        from dcg_torch.apps.collect.importing import import_results  # reading commands takes the language room

        if not arguments or ("=" in arguments[0] and not Path(arguments[0]).exists() and "://" not in arguments[0]):
            raise CollectError("import: say what, as in: dcg-torch collect import RESULTS.csv worlds=committed")
        print(import_results(arguments[0], read_settings(ImportSettings, arguments[1:])))
    else:
        raise CollectError(f"collect {command}: there is no such command; take serve, hit or import")


def _help() -> str:
    parts = (("serve", ServeSettings), ("hit", HitSettings), ("import", ImportSettings))
    return _USAGE + "".join(f"\n{name}:\n{settings_text(schema)}\n" for name, schema in parts)


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    arguments = sys.argv[1:]
    with one_line_errors():
        if not arguments or {"-h", "--help", "help"} & set(arguments):
            print(_help(), flush=True)
        else:
            _run(arguments[0], arguments[1:])
    return 0
