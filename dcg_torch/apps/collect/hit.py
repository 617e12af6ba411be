"""Writing commands as a task of Mechanical Turk: a page in the layout of its Crowd forms, and a CSV of pictures."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from urllib.parse import urlsplit

from dcg_torch.apps.collect.page import page
from dcg_torch.apps.collect.settings import HitSettings
from dcg_torch.apps.collect.tasks import PICTURES, CollectError, prepare, task_worlds
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.claim import check_place
from dcg_torch.storage.untrusted_files import at_home

TASK, CSV = "task.html", "pictures.csv"


def make_hit(settings: HitSettings, say: Callable[[str], object]) -> str:
    """Write the page, the CSV and the pictures; what to do with them.

    Raises:
        CollectError: there is no address for the pictures.
        UserError: the worlds or the folder will not do.
    """
    address = urlsplit(settings.pictures_at)
    if address.scheme != "https" or not address.netloc:  # Mechanical Turk's page is https, and shows no http pictures
        raise CollectError(
            f"pictures_at={settings.pictures_at}: write the https address below which you will put the pictures, "
            "as in pictures_at=https://example.org/pictures; browsers leave out http pictures on a page of https"
        )
    worlds, folder = task_worlds(settings), at_home(settings.folder)
    check_place(folder, (TASK,), setting="folder")
    write_whole(folder / TASK, page("hit.html", settings=settings))
    items = prepare(folder, worlds, say)
    table = io.StringIO(newline="")
    writer = csv.writer(table)
    writer.writerow(("image_url", "world", "object"))
    for item in items.values():
        writer.writerow((f"{settings.pictures_at.rstrip('/')}/{item.picture}", item.world, item.object))
    write_whole(folder / CSV, table.getvalue())
    return (
        f"{folder / TASK}: the task, for the design of a project on Mechanical Turk\n"
        f"{folder / CSV}: {len(items)} pictures, for a batch\n"
        f"{folder / PICTURES}: put these files where {settings.pictures_at} leads\n"
        f"then: dcg-torch collect import RESULTS.csv worlds={folder / 'worlds'}"
    )
