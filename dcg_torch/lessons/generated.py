"""All generated lessons together, for a model that starts without a corpus of its own."""

from __future__ import annotations

from collections.abc import Callable, Collection

from dcg_torch.learning.landmarks import Lesson
from dcg_torch.lessons.arranged import Reading, arranged_lessons
from dcg_torch.lessons.relations import relational_lessons
from dcg_torch.lessons.rooms import room_lessons


def generated_lessons(parse: Callable[[str, Collection[str]], Reading], count: int) -> tuple[Lesson, ...]:
    """So many lessons on relations, and a third as many in arranged scenes and in rooms; the same for the same arguments.

    Args:
        parse: reads commands.
    """
    third = count // 3
    return (*relational_lessons(count), *arranged_lessons(parse, third), *room_lessons(parse, third))
