"""Tables of the page as HTML: the candidates, the words. Everything that comes from outside is escaped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from dcg_torch.dialogue.events import Candidate

_ROWS = 9
_LEAST = 0.005
"""At most so many rows, and of at least this probability, so that the table stays short in a large world."""


def candidates_table(rows: Sequence[Candidate]) -> str:
    """A bar for every object that may be meant, the most probable first."""
    if not rows:
        return '<p class="none">Nothing was said of an object yet.</p>'
    shown = [row for k, row in enumerate(rows[:_ROWS]) if k < 2 or row.probability >= _LEAST]
    rest = rows[len(shown) :]
    lines = [_bar(_candidate_name(row), row.probability, "unseen" if row.hypothetical else "seen") for row in shown]
    if rest:
        lines.append(_bar(f"<i>{len(rest)} more</i>", sum(row.probability for row in rest), "seen"))
    return f'<table class="bars"><tbody>{"".join(lines)}</tbody></table>'


def words_table(words: Mapping[str, Mapping[str, float]]) -> str:
    """Each word that was learned, with a bar for each thing that it may mean."""
    if not words:
        return '<p class="none">None yet. From the start it knows cube, sphere, cylinder, red, green and blue.</p>'
    lines = []
    for word, types in words.items():
        ranked = sorted(types.items(), key=lambda item: (-item[1], item[0]))[:3]
        for k, (type_, share) in enumerate(ranked):
            head = f'<th scope="rowgroup" rowspan="{len(ranked)}">{escape(word)}</th>' if k == 0 else ""
            lines.append(_bar(escape(type_), share, "seen", head))
    return f'<table class="bars words"><tbody>{"".join(lines)}</tbody></table>'


def _candidate_name(row: Candidate) -> str:
    hint = "" if row.known or row.hypothetical else ' <small title="the robot has no word for it">no word yet</small>'
    return escape(row.name) + hint


def _bar(name: str, share: float, kind: str, head: str = "") -> str:
    percent = f"{100 * share:.0f} %" if share >= 0.005 or share == 0 else "&lt; 1 %"
    width = f"{100 * min(1.0, max(0.0, share)):.1f}%"
    bar = f'<span class="{kind}" style="width:{width}"></span>'
    return (
        f"<tr>{head}<td>{name}</td><td class='bar' aria-hidden='true'>{bar}</td><td class='share'>{percent}</td></tr>"
    )
