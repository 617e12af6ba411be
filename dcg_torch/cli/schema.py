"""`dcg-torch schema [DIR]`: JSON Schemas of the files that people write and tools read.

They are made from the models that check those files, so that they cannot say anything else. Without DIR they are
printed as one JSON object, by name. Where a schema can't say it (ids that must not repeat, a target that must be an
object of its scene), the description does.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from dcg_torch.cli.application import one_line_errors
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.lessons.files import TrainingFile
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.records import Iteration
from dcg_torch.world.files import World

_FILES: dict[str, tuple[type[BaseModel], str]] = {
    "world": (World, "a world file (YAML)"),
    "training": (TrainingFile, "a training file (YAML)"),
    "episode": (Episode, "a line of an episode file (JSON lines)"),
    "iteration": (Iteration, "a line of iterations.jsonl"),
}


def schemas() -> dict[str, dict[str, Any]]:
    """Name of a kind of file -> its JSON Schema (draft 2020-12)."""
    made = {}
    for name, (model, title) in _FILES.items():
        schema = model.model_json_schema(mode="validation")
        made[name] = {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": title}
    return made


def write_schemas(directory: Path) -> list[Path]:
    """Write `NAME.schema.json` for each kind of file."""
    return [
        write_whole(directory / f"{name}.schema.json", json.dumps(schema, indent=2) + "\n")
        for name, schema in schemas().items()
    ]


def main() -> int:
    """Run the command line; the exit status."""
    parser = Arguments(prog="dcg-torch schema", description="Print or write the JSON Schemas of files.")
    parser.add_argument("directory", metavar="DIR", nargs="?", type=Path, help="a folder to write them into")
    directory: Path | None = parser.parse_args().directory
    with one_line_errors():
        if directory is None:
            print(json.dumps(schemas(), indent=2))
        else:
            for path in write_schemas(directory):
                print(path)
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
