"""Figures: what they draw, also of runs with one command, none right, or very many; their formats."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image
from report_rows import PAPER, row, run, timings, write_run

from dcg_torch.report import figures
from dcg_torch.report.canvas import save_figure
from dcg_torch.report.comparison import draw_comparison
from dcg_torch.report.configurations import configurations
from dcg_torch.report.intervals import wilson
from dcg_torch.report.measures import measure
from dcg_torch.report.runs import load_runs
from dcg_torch.storage.records import Iteration

NAMES = ["accuracy", "symbols", "shares", "errors", "calibration"]
NOTHING = row(correct=False, chosen=None, arrived=None, probability=None, grounded=None)


def line(axes: Axes, label: str) -> list[tuple[float, float]]:
    """The points of a labelled curve."""
    (found,) = [one for one in axes.lines if one.get_label() == label]
    return [(float(x), float(y)) for x, y in np.asarray(found.get_xydata(), np.float64)]


def texts(figure: Figure) -> str:
    """All that is written in a figure."""
    artists: Any = figure.findobj(lambda artist: hasattr(artist, "get_text"))
    return "\n".join(artist.get_text() for artist in artists)


def test_figures_are_written_and_show_something(tmp_path: Path) -> None:
    before = {k: v for k, v in mpl.rcParams.items() if k != "backend"}  # resolved on being looked at
    rows = run(4, 3)
    paths = figures.save_figures(rows, timings(rows), tmp_path / "figures", beside_paper=True)
    assert [p.name for p in paths] == [f"{name}.png" for name in (*NAMES, "time")]
    for path in paths:
        with Image.open(path) as image:
            assert min(image.size) >= 375
            assert len(np.unique(np.asarray(image.convert("L")))) > 20
    assert {k: v for k, v in mpl.rcParams.items() if k != "backend"} == before


@pytest.mark.parametrize(("form", "starts"), [("pdf", b"%PDF-"), ("svg", b"<?xml"), ("png", b"\x89PNG")])
def test_formats_give_the_same_bytes_again(form: str, starts: bytes, tmp_path: Path) -> None:
    measures = measure(run(2, 3))
    written = [
        save_figure(figures.draw_accuracy(measures, beside_paper=False), tmp_path / again / f"x.{form}").read_bytes()
        for again in ("one", "two")
    ]
    assert written[0] == written[1]
    assert written[0].startswith(starts)


def test_another_format_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="written as png, pdf, svg"):
        save_figure(Figure(), tmp_path / "x.jpg")


def test_accuracy_figure_draws_the_measured_values() -> None:
    measures = measure([row(t, i, correct=t >= i) for t in range(4) for i in range(3)])
    figure = figures.draw_accuracy(measures, beside_paper=False)
    assert line(figure.axes[0], "right object") == [(1, 1.0), (2, 0.75), (3, 0.5)]
    assert "paper" not in texts(figure)
    assert "the paper's range" in texts(figures.draw_accuracy(measures, beside_paper=True))


def test_symbols_figure_starts_at_what_was_known() -> None:
    axes = figures.draw_symbols(measure(run(5, 4))).axes[0]
    for label in ("types named rightly", "if all met were learned"):
        assert line(axes, label)[0] == (0, 3)


def test_long_runs_are_rolling_means() -> None:
    # 100 commands, right from the 51st on; windows of 5 are cut at the ends.
    measures = measure([row(0, i, correct=i >= 50) for i in range(100)])
    y = [p[1] for p in line(figures.draw_accuracy(measures, beside_paper=False).axes[0], "right object (mean of 5)")]
    assert (y[0], y[-1]) == (0, 1)
    np.testing.assert_allclose(y[47:53], [0, 0.2, 0.4, 0.6, 0.8, 1])


def test_one_command_is_a_point_with_its_interval() -> None:
    """In every figure of a run of a single right command, known, with a probability of 0.9."""
    measures = measure([row()])
    accuracy = figures.draw_accuracy(measures, beside_paper=False).axes[0]
    assert line(accuracy, "right object") == [(1, 1.0)]
    assert accuracy.get_xlim() == (0.5, 1.5)
    shares = figures.draw_shares(measures).axes[0]
    assert (line(shares, "known word"), line(shares, "learned word")) == ([(1, 1.0)], [(1, 0.0)])
    calibration = figures.draw_calibration(measures)
    points: Any = calibration.axes[0].collections[0].get_offsets()
    np.testing.assert_allclose(np.asarray(points), [(0.9, 1.0)])
    assert "0.100 over 1 grounding, which chance may explain" in texts(calibration)
    assert "No command went wrong" in texts(figures.draw_errors(measures))


def test_nothing_right_is_said() -> None:
    measures = measure([NOTHING])
    assert "no command was got right" in texts(figures.draw_shares(measures))
    calibration = texts(figures.draw_calibration(measures))
    assert "no grounding had a probability" in calibration
    assert "Without a grounding: 1 command." in calibration
    assert "100.0 %" in texts(figures.draw_errors(measures))


def test_shares_of_few_commands_rest_on_their_neighbours() -> None:
    # One trial of ten right commands, the first five known, the others learned: every point rests on all it can.
    few = measure([row(0, i, kind="known" if i < 5 else "learned") for i in range(10)])
    figure = figures.draw_shares(few)
    assert line(figure.axes[0], "known word")[4] == (5, 0.5)
    assert "10 right commands; a point: mean of up to 19 iterations" in texts(figure)
    # Thirty trials: each point is its own iteration, with the interval of its thirty commands.
    many = measure([row(t, i, kind="known" if i < 5 else "learned") for t in range(30) for i in range(10)])
    figure = figures.draw_shares(many)
    assert line(figure.axes[0], "known word")[3:6] == [(4, 1.0), (5, 1.0), (6, 0.0)]
    assert "mean of" not in texts(figure)
    band: Any = figure.axes[0].collections[0]
    low = wilson(30, 30).low
    assert min(y for x, y in band.get_paths()[0].vertices if x == 1) == pytest.approx(low)


@pytest.mark.parametrize("rows", [[row()], [NOTHING], run(1, 120)], ids=["one", "nothing", "long"])
def test_text_of_odd_runs_lies_within_the_figure(rows: list[Iteration]) -> None:
    measures = measure(rows)
    drawn = [
        figures.draw_accuracy(measures, beside_paper=True),
        figures.draw_symbols(measures),
        figures.draw_shares(measures),
        figures.draw_errors(measures),
        figures.draw_calibration(measures),
        figures.draw_time(timings(rows)),
    ]
    for figure in drawn:
        assert_inside(figure)


def assert_inside(figure: Figure) -> None:
    """What is drawn lies in the picture, and none of its text says nan."""
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    drawn = figure.get_tightbbox(canvas.get_renderer())  # inches
    width, height = figure.get_size_inches()
    assert min(drawn.x0, drawn.y0) >= -0.01
    assert drawn.x1 <= width + 0.01
    assert drawn.y1 <= height + 0.01
    assert "nan" not in texts(figure)


# --- several runs


def compare(directory: Path, models: int, seeds: int, **config: Any) -> Figure:
    for model in range(models):
        for seed in range(seeds):
            name = f"a_rather_long_name_of_a_model_{model}"
            rows = run(3, 4, seed, skill=1 - model / models)
            folder = directory / f"{name},{seed}"
            write_run(folder, rows, overrides=[f"model={name}", f"seed={seed}"], seed=seed, model=name, **config)
    return draw_comparison(configurations(load_runs([directory])))


def test_a_sweep_is_one_curve_a_configuration(tmp_path: Path) -> None:
    figure = compare(tmp_path, models=3, seeds=5)
    left, right = figure.axes
    found = configurations(load_runs([tmp_path]))
    assert [one.get_label() for one in left.lines] == [c.name for c in found]
    assert len(left.collections) == 3  # a band each
    for c in found:
        together = [(m.iteration + 1, m.accuracy.value) for m in c.measures.by_iteration]
        np.testing.assert_allclose(line(left, c.name), together)
        assert [m.n for m in c.measures.by_iteration] == [15] * 4
    assert [label.get_text() for label in right.get_yticklabels()] == [c.name for c in found]
    ticks = [one for one in right.lines if one.get_marker() == "|" and len(np.asarray(one.get_xdata())) == 5]
    assert [sorted(np.asarray(t.get_xdata())) for t in ticks] == [pytest.approx(sorted(c.by_seed)) for c in found]


@pytest.mark.parametrize(("models", "seeds"), [(1, 1), (3, 5), (12, 1)])
def test_a_comparison_is_not_cut(models: int, seeds: int, tmp_path: Path) -> None:
    assert_inside(compare(tmp_path, models, seeds))


def test_curves_that_coincide_differ_in_looks(tmp_path: Path) -> None:
    for name in "ab":
        write_run(tmp_path / name, run(2, 3), overrides=[f"model={name}"], model=name)
    one, other = draw_comparison(configurations(load_runs([tmp_path]))).axes[0].lines
    np.testing.assert_array_equal(np.asarray(one.get_ydata()), np.asarray(other.get_ydata()))
    assert one.get_linewidth() > other.get_linewidth()
    assert one.get_linestyle() != other.get_linestyle()


def test_the_paper_s_range_is_drawn_where_all_runs_follow_it(tmp_path: Path) -> None:
    assert "the paper's range" in texts(compare(tmp_path / "paper", 2, 1, **PAPER))
    assert "paper" not in texts(compare(tmp_path / "custom", 2, 1, **{**PAPER, "worlds": "my/worlds"}))


def test_a_name_is_no_formula(tmp_path: Path) -> None:
    for name in (r"$\frac$", "b"):
        folder = write_run(tmp_path / name.strip("$\\"), run(1, 2), model=name)
        save_figure(draw_comparison(configurations(load_runs([folder]))), tmp_path / "x.png")
    assert "$" in texts(draw_comparison(configurations(load_runs([tmp_path]))))


def test_nothing_to_compare_is_refused() -> None:
    with pytest.raises(ValueError, match="no runs"):
        draw_comparison([])
