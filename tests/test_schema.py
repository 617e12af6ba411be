"""The JSON Schemas in docs/ say what the readers check."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hostile import EPISODE, TRAINING, WORLD

from dcg_torch.cli.schema import schemas, write_schemas

COMMITTED = Path(__file__).parent.parent / "docs" / "schemas"


def test_the_committed_ones_are_current(tmp_path: Path) -> None:
    made = {path.name: path.read_text() for path in write_schemas(tmp_path)}
    assert made == {path.name: path.read_text() for path in COMMITTED.iterdir()}, "run: dcg-torch schema docs/schemas"


@pytest.mark.parametrize(("name", "good"), [("world", WORLD), ("training", TRAINING), ("episode", EPISODE)])
def test_every_key_of_a_good_file_is_described(name: str, good: dict[str, Any]) -> None:
    schema = schemas()[name]
    assert set(schema["required"]) <= good.keys() <= schema["properties"].keys()
    json.dumps(schema, allow_nan=False)


def test_the_contract_of_iterations_is_required() -> None:
    contract = """trial iteration world command noun color robot objects in_view known_types target grounded correct
        kind probability asked symbols path_length turned"""
    assert set(contract.split()) <= set(schemas()["iteration"]["required"])
