"""Scene graphs of IRef-VLA and ConceptGraphs: what they mean, and what is left out and why."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from convert_making import edge, episodes, left_out, node, scene

from dcg_torch.evaluation.importers import concept_graphs, iref_vla


@pytest.mark.parametrize("given", ["", "s_scene_graph.json", "s_referential_statements.json"])
def test_statements_of_iref_vla(tmp_path: Path, given: str) -> None:
    found = iref_vla.convert(scene(tmp_path) / given)
    made = {e.text: e for e in episodes(found, tmp_path).values()}
    assert {text: e.target for text, e in made.items()} == {"the gray chair": ("0",), "the chair on the right": ("1",)}
    first, second = made["the gray chair"].objects
    assert (first.type, first.color, first.rgb, second.color, second.rgb) == (
        "chair",
        "gray",
        (105, 105, 105),
        None,
        None,
    )
    assert first.position == pytest.approx((1.0, 1.0, 0.0))
    assert first.extents == pytest.approx((0.4, 0.6, 1.0))
    assert {e.group for e in made.values()} == {"s"}
    assert made["the gray chair"].robot is None
    assert left_out(found) == {
        "object: no box": 1,
        "statement: the same words are said of several objects": 1,
        "statement: no object is meant": 1,
        "episode: target: '2' is no object of this episode: 0, 1": 1,
    }


def test_scenes_of_iref_vla_without_statements_or_regions_are_left_out(tmp_path: Path) -> None:
    scene(tmp_path, statements=None)
    scene(tmp_path, graph=[], name="t")
    scene(tmp_path, name="u")
    found = iref_vla.convert(tmp_path)
    assert {e.group for e in episodes(found, tmp_path).values()} == {"u"}
    assert left_out(found)["scene: no statements beside its scene graph"] == 1
    assert left_out(found)["scene: no regions in it"] == 1


def test_commands_are_generated_for_scenes_of_concept_graphs(tmp_path: Path) -> None:
    table_, shelf = node(4, "table", 1.0), node(5, "shelf", 5.0)
    first, second, third = node(6, "cup", 1.1, 1.2), node(7, "cup", 5.1, 1.2), node(8, "cup", 9.0)
    (tmp_path / "scene_graph.json").write_text(json.dumps([table_, shelf, first, second, third, node(9, "FAIL", 0.0)]))
    # The relations count objects otherwise than the list does.
    renumbered = [{**one, "id": k} for k, one in enumerate((table_, shelf, first, second))]
    relations = [
        edge(renumbered[2], renumbered[0], "a on b"),
        edge(renumbered[1], renumbered[3], "b in a"),
        edge(renumbered[0], renumbered[1], "none of these"),
    ]
    (tmp_path / "cfslam_object_relations.json").write_text(json.dumps(relations))
    (tmp_path / "other.json").write_text('{"a": 1}')
    found = concept_graphs.convert(tmp_path)
    made = episodes(found, tmp_path).values()
    assert {e.text: e.target for e in made} == {
        "go to the table": ("4",),
        "go to the shelf": ("5",),
        "go to the cup on the table": ("6",),
        "go to the cup in the shelf": ("7",),
    }
    cup = next(o for e in made for o in e.objects if o.id == "6")
    assert cup.position == pytest.approx((1.1, 1.0, 0.7))
    assert all(json.loads(line)["said_by"] == "generated" for line in found.lines)
    assert left_out(found) == {
        "object: it has no tag, or one that says it failed": 1,
        "relation: it says neither on nor in": 1,
        "file: neither objects nor relations of ConceptGraphs": 1,
        "object: others have its tag, so no command means it alone": 1,
    }


def test_a_relation_that_two_pairs_have_tells_nothing_apart(tmp_path: Path) -> None:
    cups, tables = [node(k, "cup", float(k)) for k in (0, 1)], [node(k, "table", float(k)) for k in (2, 3)]
    path = tmp_path / "relations.json"
    path.write_text(json.dumps([edge(c, t, "a on b") for c, t in zip(cups, tables, strict=True)]))
    found = concept_graphs.convert(path)
    assert found.lines == []
    assert left_out(found) == {"object: others have its tag, so no command means it alone": 4}
