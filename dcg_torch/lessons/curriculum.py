"""All generated lessons together, for a model that starts without a corpus of its own."""

from __future__ import annotations

from collections.abc import Callable, Collection

from dcg_torch.learning.landmarks import Lesson
from dcg_torch.lessons.arrangements import Reading, arranged_lessons
from dcg_torch.lessons.boards import board_scene
from dcg_torch.lessons.clutter import clutter_scene
from dcg_torch.lessons.ends import scattered_scene
from dcg_torch.lessons.formations import formation_scene
from dcg_torch.lessons.furniture import furnished_scene
from dcg_torch.lessons.handling import stack_scene
from dcg_torch.lessons.looks import height_scene, lonely_scene, shelf_scene
from dcg_torch.lessons.parts import part_scene
from dcg_torch.lessons.relations import relational_lessons
from dcg_torch.lessons.rooms import room_lessons
from dcg_torch.lessons.selections import half_scene, size_scene
from dcg_torch.lessons.table_tops import table_top_scene


def generated_lessons(parse: Callable[[str, Collection[str]], Reading], count: int) -> tuple[Lesson, ...]:
    """So many lessons on relations, and a part of that in each other kind of scene; the same for the same arguments.

    Boards of things that look alike have a quarter as many. Cluttered tables have a sixth, things that say how large
    they are two ninths, things at an end five twelfths, all others a third.

    Args:
        parse: reads commands.
    """
    third = count // 3
    picks = arranged_lessons(parse, 3 * third, makers=(half_scene, size_scene, formation_scene))
    handled = arranged_lessons(parse, third, makers=(stack_scene,))
    cluttered = arranged_lessons(parse, count // 6, makers=(clutter_scene,))
    boards = arranged_lessons(parse, count // 4, makers=(board_scene,))
    scattered = arranged_lessons(parse, third + count // 12, makers=(scattered_scene,))
    looks = arranged_lessons(parse, third, makers=(height_scene, shelf_scene, shelf_scene, lonely_scene))
    sized = arranged_lessons(parse, 2 * third // 3, makers=(furnished_scene, furnished_scene, table_top_scene))
    parts = arranged_lessons(parse, third, makers=(part_scene,))
    tables = (*arranged_lessons(parse, third), *picks, *handled, *cluttered, *looks, *sized, *scattered, *boards)
    return (*relational_lessons(count), *tables, *parts, *room_lessons(parse, third))
