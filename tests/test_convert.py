"""Files of others become episode files: tables, whatever stands in a file, the program, and the originals."""

from __future__ import annotations

import json
import math
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from convert_making import GRAPH, STATEMENTS, edge, episodes, example, left_out, node, put, scene
from hostile import damaged, mutated
from hypothesis import given
from hypothesis import strategies as st
from making import typed

from dcg_torch import convert, evaluate
from dcg_torch.evaluation.importers import concept_graphs, h2sl, h2sl_symbols, iref_vla, table
from dcg_torch.evaluation.importers.base import Converted, ImportFileError

SAMPLES = Path(__file__).parents[2] / "shared" / "samples"

CSV = """\
id,text,object,type,color,x,y,z,target,robot_x,robot_y,weight
1,"take the ""red"", small cone",a,cone,red,1,0.5,,yes,0,-1,3
1,,b,cone,,2,0,0.2,,,,4
2,go to the tree,a,tree,,1,1,,x,,,5
3,go to the tree,a,tree,,1,one,,x,,,5
4,go to the tree,a,tree,,1,1,,perhaps,,,5
5,go to the tree,a,tree,,1,1,,x,,,5
5,go to the bush,b,tree,,1,1,,,,,5
,go,a,tree,,1,1,,,,,5
6,short
"""


def test_rows_of_a_table_become_episodes(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text("\ufeff" + CSV, encoding="utf-8")
    found = table.convert(path)
    first, second = episodes(found, tmp_path).values()
    assert (first.id, first.text, first.target) == ("1", 'take the "red", small cone', ("a",))
    assert [(o.id, o.color, o.position) for o in first.objects] == [("a", "red", (1, 0.5, 0)), ("b", None, (2, 0, 0.2))]
    assert first.pose is not None
    assert (first.pose.x, first.pose.y, first.pose.yaw) == (0.0, -1.0, 0.0)
    assert (second.id, second.target, second.robot) == ("2", ("a",), None)
    assert left_out(found) == {
        "column: 'weight' is none that is read": 1,
        "episode: a place or size is not given in numbers": 1,
        "episode: target is neither yes nor no": 1,
        "episode: its rows say different things in text": 1,
        "row: no id of an episode": 1,
        "row: more or fewer values than columns": 1,
    }


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "no column id; the first line names id, text, object, type, x, y"),
        ("id,text,object,typ,x,y\n", "no column type"),
        ("id,id,text,object,type,x,y\n", "the column 'id' is there twice"),
        ('id,text,object,type,x,y\n1,"go', "not readable as CSV"),
        ("id,text,object,type,x,y\n1," + "a" * 200_000, "not readable as CSV: field larger"),
    ],
)
def test_a_table_that_cannot_be_read_is_one_line(tmp_path: Path, content: str, says: str) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(content)
    with pytest.raises(ImportFileError) as caught:
        table.convert(path)
    assert says in str(caught.value)
    assert str(caught.value).isprintable()


def refused_or_valid(importer: Callable[[Path], Converted], content: bytes, name: str, beside: bytes = b"") -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(content)
        if beside:
            path.with_name("s_referential_statements.json").write_bytes(beside)
        try:
            found = importer(path)
        except ImportFileError as error:
            said = str(error)
            assert (said.isprintable(), len(said) < 500 + len(folder)) == (True, True)
            return
        assert all(line.isprintable() for line in found.told())
        if found.lines:
            assert len(episodes(found, Path(folder))) == len(found.lines)


def json_bytes(value: Any) -> bytes:
    return json.dumps(value).encode("utf-8", "surrogatepass")


@given(damaged(example('<object id="a"/>').encode(), [b"<", b"&lt;", b"\xff", b"<a>" * 2_000, b'"', b"\x00"]))
def test_whatever_an_xml_file_holds(content: bytes) -> None:
    pytest.importorskip("defusedxml")
    refused_or_valid(h2sl.convert, content, "one.xml")
    refused_or_valid(h2sl_symbols.convert, content, "one.xml")


scenes = st.one_of(
    st.tuples(mutated(GRAPH), st.just(STATEMENTS)),
    st.tuples(st.just(GRAPH), mutated(STATEMENTS)),
)


@given(scenes)
def test_whatever_a_scene_of_iref_vla_holds(files: tuple[Any, Any]) -> None:
    graph, statements = files
    refused_or_valid(iref_vla.convert, json_bytes(graph), "s_scene_graph.json", json_bytes(statements))


@given(st.one_of(mutated(edge(node(1, "cup", 1.0), node(2, "table", 1.0), "a on b")), mutated(node(1, "cup", 1.0))))
def test_whatever_a_scene_of_concept_graphs_holds(entry: Any) -> None:
    refused_or_valid(concept_graphs.convert, json_bytes([node(3, "sofa", 2.0), entry]), "scene_graph.json")


@given(damaged(CSV.encode(), [b'"', b",", b"\n", b"\r", b"\x00", b"\xff", b"nan", b"1e999"]))
def test_whatever_a_table_holds(content: bytes) -> None:
    refused_or_valid(table.convert, content, "mine.csv")


def test_the_program_writes_counts_and_can_be_evaluated(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source, out = tmp_path / "mine.csv", tmp_path / "new" / "mine.jsonl"
    source.write_text(CSV)
    status, said, err = typed(capsys, convert.main, "convert", "csv", str(source), "--out", str(out))
    assert (status, err) == (0, "")
    assert f"written: {out}: 2 episodes" in said
    assert "left out: 1 row: no id of an episode (first: line 9)" in said
    status, said, err = typed(
        capsys, evaluate.main, "evaluate", f"test={out}", "save=false", f"hydra.run.dir={tmp_path / 'run'}"
    )
    assert status == 0, err
    assert json.loads(said.splitlines()[-1])["n"] == 2


@pytest.mark.parametrize(
    ("kind", "make", "says"),
    [
        ("csv", lambda folder: folder / "none.csv", "no such CSV file"),
        ("h2sl", lambda folder: folder / "none", "no such file or folder"),
        ("iref_vla", lambda folder: folder, "holds no file that ends in _scene_graph.json"),
        (
            "concept_graphs",
            lambda folder: scene(folder, statements=None),
            "gives no episodes; left out: 1 file: neither",
        ),
    ],
)
def test_where_nothing_comes_of_it_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str, make: Callable[[Path], Path], says: str
) -> None:
    out = tmp_path / "out.jsonl"
    status, said, err = typed(capsys, convert.main, "convert", kind, str(make(tmp_path)), "--out", str(out))
    assert (status, said, err.count("\n")) == (2, "", 1)
    assert says in err
    assert not out.exists()


def test_without_defusedxml_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "defusedxml", None)
    with pytest.raises(ImportFileError, match="of the extra convert"):
        h2sl.convert(put(tmp_path, one=example("")) / "one.xml")


@pytest.mark.skipif(not SAMPLES.exists(), reason="the samples are not here")
def test_samples_of_the_originals(tmp_path: Path) -> None:
    pytest.importorskip("defusedxml")
    found = h2sl.convert(SAMPLES / "h2sl")
    made = episodes(found, tmp_path)
    assert len(made) == 4
    assert made["example_0033"].target == ("o3",)
    assert len(made["groups_0003"].target) == 4
    assert left_out(found)["file: a symbol dictionary; convert it with h2sl_symbols"] == 1
    dictionary = h2sl_symbols.convert(SAMPLES / "h2sl" / "symbol_dictionary_default.xml")
    assert "block" in dictionary.notes[0]
    rooms = iref_vla.convert(SAMPLES / "iref_vla")
    assert len(episodes(rooms, tmp_path)) == 40
    assert all(math.isfinite(v) for e in episodes(rooms, tmp_path).values() for o in e.objects for v in o.position)
