"""Measures and causes of rows made by hand; every expected value is worked out here."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from report_rows import OBJECTS, row, run, thing, timing

from dcg_torch.report.causes import CAUSES, error_cause, is_right, names_of_types
from dcg_torch.report.intervals import Estimate, wilson
from dcg_torch.report.measures import measure, path_efficiency
from dcg_torch.report.seconds import PHASES, summarise_seconds
from dcg_torch.storage.records import ParsedRecord, PoseRecord

WRONG: dict[str, Any] = {"correct": False}
UNKNOWN: dict[str, Any] = {"noun": "drill", "target": "d", "kind": "unknown"}


def test_accuracy_has_the_trial_as_its_unit() -> None:
    # Trial means 1, 1/2 and 0: mean 1/2, standard deviation 1/2, t = 4.303 -> wider than [0, 1], so cut.
    # A fourth trial of 1/2 brings sd sqrt(1/6), t = 3.182: half-width 3.182 sqrt(1/6) / 2.
    outcomes = {0: (True, True), 1: (True, False), 2: (False, False)}
    rows = [row(t, i, correct=c) for t, both in outcomes.items() for i, c in enumerate(both)]
    three = measure(rows).accuracy
    assert (three.value, three.low, three.high) == (0.5, 0.0, 1.0)
    four = measure([*rows, row(3, 0), row(3, 1, correct=False)])
    assert four.trial_accuracy == (1.0, 0.5, 0.0, 0.5)
    assert four.accuracy.value == 0.5
    half = 3.18245 * math.sqrt(1 / 6) / 2
    assert four.accuracy.low == pytest.approx(max(0.0, 0.5 - half), abs=1e-4)
    assert four.accuracy.high == pytest.approx(min(1.0, 0.5 + half), abs=1e-4)
    first, second = four.by_iteration
    assert (first.accuracy, second.accuracy) == (wilson(3, 4), wilson(1, 4))


def test_unequal_trials_weigh_the_same() -> None:
    rows = [row(0, 0), row(0, 1), row(0, 2), row(1, 0, correct=False)]
    assert measure(rows).accuracy.value == 0.5  # (1 + 0) / 2, not 3 / 4


@pytest.mark.parametrize("outcomes", [[True], [True] * 5, [False] * 5])
def test_trials_all_alike_do_not_pretend_to_certainty(outcomes: list[bool]) -> None:
    rows = [row(t, correct=c) for t, c in enumerate(outcomes)]
    assert measure(rows).accuracy == wilson(sum(outcomes), len(outcomes))


def test_shares_and_accuracy_by_kind() -> None:
    rows = [
        row(0, kind="known"),
        row(1, kind="unknown"),
        row(2, kind="unknown"),
        row(3, kind="learned"),
        row(4, kind="known", **WRONG),
    ]
    (only,) = measure(rows).by_iteration
    assert only.shares == {"known": 0.25, "unknown": 0.5, "learned": 0.25}
    assert measure(rows).by_kind["known"].accuracy == wilson(1, 2)
    assert measure(rows[:1]).by_kind["learned"].accuracy is None
    assert measure(rows[4:]).by_iteration[0].shares == {}


def test_symbols_right_wrong_and_expected() -> None:
    # Trial 0 learns "drill" rightly and "dropbox" rightly by use; trial 1 learns "drill" wrongly.
    rows = [
        row(0, 0, **UNKNOWN, symbols={"drill": "drill"}, expected_symbols=4.0),
        row(
            0,
            1,
            noun="dropbox",
            target="m",
            kind="unknown",
            color=None,
            symbols={"drill": "drill", "dropbox": "mailbox"},
            expected_symbols=5.0,
        ),
        row(1, 0, **UNKNOWN, symbols={"drill": "mailbox"}, expected_symbols=4.0, chosen="m", **WRONG),
    ]
    measures = measure(rows)
    assert measures.types == ("cube", "cylinder", "drill", "mailbox", "sphere")
    first, second = measures.by_iteration
    assert (first.correct_symbols.value, second.correct_symbols.value) == (3.5, 5.0)  # (4 + 3) / 2, then trial 0 alone
    assert (first.wrong_symbols, second.wrong_symbols) == (0.5, 0.0)
    assert (first.expected_symbols, second.expected_symbols) == (4.0, 5.0)
    assert (first.all_symbols, second.all_symbols) == (0.0, 1.0)
    assert measures.initial_symbols == 3
    # 5 and 3 at the trials' ends: sd sqrt 2, t = 12.7, far beyond the 5 types there are
    assert measures.correct_symbols == Estimate(4.0, 0.0, 5.0)
    assert measures.all_symbols == wilson(1, 2)
    assert measures.wrong_symbols == 0.5


def test_two_names_of_one_type_count_once() -> None:
    rows = [
        row(0, 0, noun="ball", target="s", objects=(thing("s", "sphere"),), in_view=(), symbols={"ball": "sphere"}),
    ]
    measures = measure(rows)
    assert (measures.correct_symbols.value, measures.wrong_symbols) == (3.0, 0.0)


def test_a_noun_means_what_it_is_mostly_said_of() -> None:
    cubes = [row(0, i, noun="block", target="c") for i in range(2)]
    rows = [*cubes, row(0, 2, noun="block", target="m"), row(0, 3, noun="box", target="m"), row(0, 4, noun="box")]
    names = names_of_types(rows)
    assert names == {"block": frozenset({"cube"}), "box": frozenset({"cube", "mailbox"})}
    assert is_right("block", "cube", names)
    assert not is_right("block", "mailbox", names)
    assert is_right("mailbox", "mailbox", names)  # never said, but the type's own name


def test_accuracy_per_symbol_counts_what_was_held_before() -> None:
    # Held before: 3, 4, 4 with outcomes 0, 1, 1 in both trials: a slope of 1.
    drill: dict[str, Any] = {"symbols": {"drill": "drill"}}
    trial: list[tuple[int, dict[str, Any]]] = [(0, {**WRONG, **drill}), (1, drill), (2, drill)]
    rows = [row(t, i, **{**UNKNOWN, **changes}) for t in (0, 1) for i, changes in trial]
    slope = measure(rows).accuracy_per_symbol
    assert slope is not None
    assert slope.value == pytest.approx(1.0)
    assert measure([row()]).accuracy_per_symbol is None


def test_out_of_view_is_pooled() -> None:
    few = (thing("c", "cube"),)
    rows = [row(0, in_view=("c",)), row(1, objects=few, in_view=("c",))]
    assert measure(rows).out_of_view == pytest.approx(1 - 2 / 5)  # 4 + 1 objects, 2 seen


def test_effort_is_meant_over_commands() -> None:
    rows = [row(0, asked=1, path_length=1.0, turned=0.0), row(1, asked=0, path_length=2.0, turned=3.0, collisions=1)]
    measures = measure(rows)
    assert (measures.asked, measures.path_length, measures.turned, measures.collisions) == (0.5, 1.5, 1.5, 0.5)


@pytest.mark.parametrize(
    ("driven", "distance", "expected"),
    [(1.5, 2.0, 1.0), (3.0, 2.0, 0.5), (1.0, 2.0, 1.0), (0.0, 0.4, 1.0), (0.7, 0.4, 0.0)],
)
def test_path_efficiency(driven: float, distance: float, expected: float) -> None:
    # The robot stands at (1, 1) and need come only to within 0.5 m.
    pose, objects = PoseRecord(x=1.0, y=1.0, yaw=2.0), (thing("c", "cube", x=1.0, y=1.0 + distance),)
    assert path_efficiency(row(robot=pose, objects=objects, path_length=driven)) == pytest.approx(expected)
    assert path_efficiency(row(robot=pose, objects=objects, path_length=driven, **WRONG)) == 0.0


def test_an_obeyed_order_to_keep_away_counts_and_has_no_shortest_way() -> None:
    obeyed = row(0, 0, grounded=None, command="stay away from the red cube")
    assert path_efficiency(obeyed) is None
    alone = measure([obeyed])
    assert (alone.accuracy.value, alone.path_efficiency) == (1.0, None)
    assert alone.by_kind["known"].correct == 1
    # Beside a failure (0) and a straight drive (1) it takes no part in the mean.
    both = measure([obeyed, row(0, 1, **WRONG), row(0, 2, path_length=1.5)])
    assert both.path_efficiency == pytest.approx(0.5)
    assert sum(both.causes.values()) == 1


LESSON = {"drill": "mailbox"}
CASES = [
    ("parse", {"parsed": None}, {}),
    ("parse", {"parsed": ParsedRecord(noun="cubes", color="red")}, {}),
    ("parse", {"parsed": ParsedRecord(noun="cube", color=None)}, {}),
    ("not perceived", {"chosen": None, "seen": ("m",), "arrived": None}, {}),
    ("path", {"chosen": "c", "arrived": False}, {}),
    ("wrong lesson", {**UNKNOWN, "kind": "learned", "chosen": "m"}, LESSON),
    ("wrong lesson", {**UNKNOWN, "kind": "learned", "chosen": None, "arrived": None}, LESSON),
    # "mailbox" is unknown, but the robot takes the mailbox for a drill.
    ("wrong lesson", {"noun": "mailbox", "color": "blue", "target": "m", "kind": "unknown", "chosen": "d"}, LESSON),
    ("other name", {"noun": "box", "kind": "unknown", "chosen": "d"}, {}),
    ("other name", {**UNKNOWN, "noun": "borer", "chosen": "m"}, {"drill": "drill"}),
    ("no grounding", {"chosen": None, "arrived": None}, {}),
    ("wrong unknown", {**UNKNOWN, "chosen": "m"}, {}),
    ("wrong unknown", {**UNKNOWN, "chosen": "m", "seen": ("m",)}, {}),  # settled before it saw the drill
    ("wrong type", {"chosen": "d"}, {}),
    ("wrong type", {**UNKNOWN, "kind": "learned", "chosen": "m"}, {"drill": "drill"}),
    ("wrong type", {"chosen": "gone"}, {}),
    ("wrong colour", {"chosen": "c2"}, {}),
    ("ambiguous", {"chosen": "c2", "color": None}, {}),
    ("ambiguous", {"chosen": "c3", "objects": (*OBJECTS, thing("c3", "cube"))}, {}),
]


@pytest.mark.parametrize(("cause", "changes", "held"), CASES)
def test_error_cause(cause: str, changes: dict[str, Any], held: dict[str, str]) -> None:
    wrong = row(correct=False, **changes)
    assert error_cause(wrong, held) == cause
    assert error_cause(wrong.model_copy(update={"correct": True}), held) is None


def test_every_cause_is_tried() -> None:
    assert {cause for cause, _, _ in CASES} == set(CAUSES)


def test_causes_use_the_symbols_of_the_row_before() -> None:
    rows = [
        row(0, 0, **UNKNOWN, chosen="m", symbols=LESSON, **WRONG),
        row(0, 1, **{**UNKNOWN, "kind": "learned"}, chosen="m", symbols=LESSON, **WRONG),
        row(1, 0, **UNKNOWN, chosen="m", symbols=LESSON, **WRONG),
    ]
    measures = measure(rows)
    assert {cause: n for cause, n in measures.causes.items() if n} == {"wrong unknown": 2, "wrong lesson": 1}
    assert measures.by_iteration[0].causes["wrong unknown"] == 2


def test_refuses_what_can_t_be_measured() -> None:
    with pytest.raises(ValueError, match="no commands to measure"):
        measure([])
    with pytest.raises(ValueError, match="trial 0, iteration 3 comes twice"):
        measure([row(0, 3), row(0, 3)])
    with pytest.raises(ValueError, match="trial 0, iteration 0: object 'z' is not among"):
        measure([row(target="z")])


@settings(max_examples=30, deadline=None)
@given(
    trials=st.integers(1, 5),
    iterations=st.integers(1, 12),
    seed=st.integers(0, 10**6),
    skill=st.sampled_from([0.0, 0.5, 1.0]),
    away=st.booleans(),
    data=st.data(),
)
def test_any_run(trials: int, iterations: int, seed: int, skill: float, away: bool, data: st.DataObject) -> None:
    rows = run(trials, iterations, seed, skill=skill, away=away)
    measures = measure(rows)
    assert measure(data.draw(st.permutations(rows))) == measures
    assert sum(measures.causes.values()) == measures.commands - measures.correct
    assert sum(k.n for k in measures.by_kind.values()) == measures.commands == trials * iterations
    for m in measures.by_iteration:
        assert sum(m.shares.values()) == pytest.approx(1.0 if m.correct else 0.0)
        assert 3 <= m.correct_symbols.value <= m.expected_symbols + 1e-9


def test_a_thousand_commands_in_one_trial() -> None:
    measures = measure(run(1, 1000))
    assert (measures.trials, measures.iterations) == (1, 1000)
    assert measures.correct_symbols.value == 8


def test_seconds() -> None:
    timings = [timing(0, 0, train=0.02, ground=0.001), timing(0, 1, train=0.04, ground=0.003)]
    seconds = summarise_seconds(timings)
    assert seconds["train"] == pytest.approx(0.03)
    assert (seconds["train_max"], seconds["ground_max"]) == (0.04, 0.003)
    assert seconds["command"] == pytest.approx(sum(seconds[phase] for phase in PHASES))
    assert summarise_seconds([]) == {}
