"""What words mean may differ with the kind of scene that they are said in, where a corpus taught them there."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch import Percept, Pose
from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.interpretation.scene_kinds import scene_kind
from dcg_torch.language import parse_command
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.learning.learner import Taught
from dcg_torch.model import GroundingModel
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import WorldModel


def row(model: GroundingModel, unit: float, color: str | None) -> WorldModel:
    things = [Percept(f"{k}", "cube", color, (2.0 * unit, unit * (1 - k), 0.0)) for k in range(3)]
    return model.world_model(things, robot=Pose(0.0, 0.0), looked=True, workspace=Workspace(None, unit))


def test_a_kind_of_scene_is_what_anyone_sees(model: GroundingModel) -> None:
    room, table = row(model, 1.0, None), row(model, 0.1, "red")
    assert scene_kind(room) == "bare"
    assert scene_kind(table) == "table colors"
    assert scene_kind(replace(room, unit=3.0)) == "yard"
    assert scene_kind(replace(room, speaker=Pose(4.0, 0.0))) == "speaker"
    piled = replace(room, objects=tuple(replace(o, position=(0.0, 0.0, k)) for k, o in enumerate(room.objects)))
    assert scene_kind(piled) == "heights"
    assert scene_kind(replace(room, objects=room.objects * 9)) == "many"
    other = replace(room.objects[0], id="other", type="lamp")
    assert scene_kind(replace(room, objects=(*room.objects, other))) == "classes"
    assert scene_kind(replace(room, objects=())) == "bare"


def test_corpora_that_disagree_are_both_learned(model: GroundingModel) -> None:
    """In one kind of scene a word means the left one, in the other the right one; a model of both knows each."""
    text = "take the old cube"
    tree = parse_command(text).tree
    assert tree is not None
    words = [word for node in to_factor_tree(tree).walk() for word in node.phrase.words]
    assert "old" in words
    room, table = row(model, 1.0, None), row(model, 0.1, "red")
    taught = model.copy()
    taught.teach(
        [Lesson(tree, world, frozenset({id_})) for world, id_ in ((room, "0"), (table, "2")) for _ in range(60)],
        rounds=1,
    )
    for world, id_ in ((room, "0"), (table, "2")):
        found = taught.ground(text, world).object
        assert found is not None
        assert found.id == id_
    assert not any("scene" in name for name in model.features.language)  # none before a corpus was taught


def test_a_word_said_of_another_type_elsewhere_still_means_what_is_called_so(model: GroundingModel) -> None:
    """Where there are no mugs people say "mug" of a cup; it is no reason to take the cup where there is a mug."""
    kinds = {"kitchen": ("cup", "mug", "plate"), "office": ("cup", "lamp", "book")}
    worlds = {
        name: model.world_model(
            [Percept(f"{k}", type_, None, (2.0, 1.0 - k, 0.0)) for k, type_ in enumerate(types)],
            robot=Pose(0.0, 0.0),
            looked=True,
        )
        for name, types in kinds.items()
    }
    tree = parse_command("take the mug").tree
    assert tree is not None
    meant = {"kitchen": "1", "office": "0"}
    taught = model.copy()
    lessons = [Lesson(tree, worlds[name], frozenset({meant[name]})) for name in ["kitchen"] * 5 + ["office"] * 6]
    taught.teach(lessons, rounds=1)
    found = {name: taught.ground("take the mug", world) for name, world in worlds.items()}
    assert {name: solution.object.id for name, solution in found.items() if solution.object is not None} == meant
    assert (found["kitchen"].probability or 0.0) > 0.8


def test_lessons_deny_a_noun_of_types_that_they_pass_over() -> None:
    said = Taught((), (), {"mug": {"mug": 5, "cup": 6}}, {}, {"mug": {"cup": 5, "plate": 5}})
    assert said.denies("mug", "cup")
    assert said.denies("mug", "plate")
    assert not said.denies("mug", "mug")
    assert not said.denies("jug", "cup")
    assert not Taught((), (), {"mug": {"cup": 9}}, {}, {"mug": {"cup": 1}}).denies("mug", "cup")  # people slip
