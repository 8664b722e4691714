"""Stress-strain figures: one run against the references, and several runs together."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..errors import Error
from ..stored import reference
from ..stored.compressed import Compressed
from ..stored.deck_differences import names_by_decks
from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.results import Results
from . import style

_MEAN_POINTS = 400
_LEAST_STRAIN_SHOWN = 0.004
_WITHIN_FIT = 0.2  # of f_c: a stress within those to which E is fitted, so that its line passes through the curve there
_LEAST_BAND = 0.01  # difference of the platens over the stress, below which it is no wider than the curve
_TABLE_LOOKS = [(colour, dashes) for dashes in ((0, (5, 2)), (0, (2, 1.2)))
                for colour in (style.GREEN, style.PURPLE, style.BLACK, style.SKY)]
"""Colours and dashes of users' references: none is that of a reference of the program."""
MANY = 6
"""More runs than these are drawn as a range, not as a curve each."""


@style.in_style
def stress_strain(run: Results, marks: Mapping[str, Frame]) -> Figure:
    """Draws the run's curve beside the reference that its deck asks for (paper, Figure 8).

    marks: the frames to point out, by letter, as `select_frames` gives them; may be empty.
    """
    figure, axes, beside_table, of_table = _axes_and_table()
    axes.set_title(style.title_of(run))
    if run.parent and not Heated(run.parent).is_last:
        style.draw_parent(axes, run.parent, style.PER_MILLE * Compressed(run.parent).strain,
                          Compressed(run.parent).stress)
    _draw_run(axes, run)
    if reference.COMPRESSION in run.references.builtin:
        _draw_references(axes, max(np.nanmax(Compressed(run).strain), _LEAST_STRAIN_SHOWN))
    draw_tables(axes, [run], ("strain", style.PER_MILLE), ("stress", 1.0))
    _draw_marks(axes, marks)
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(style.STRAIN_LABEL)
    axes.set_ylabel(style.STRESS_LABEL)

    style.draw_legend(beside_table, axes, loc="center left")
    if of_table is not None:
        _draw_table(of_table, run)
    return figure


def _axes_and_table() -> tuple[Figure, Axes, Axes | None, Axes | None]:
    """Makes a figure with axes for a curve, for a legend (None: in the first), and for a table, if any."""
    if not style.page().has_table:
        figure, (axes,), below = style.panels(4.8, below=0.3)
        return figure, axes, below, None
    if style.page().is_column:
        figure, (axes, table), _ = style.panels(0.0, (1.0, 0.3))
        return figure, axes, None, table
    figure = style.new_figure(4.8)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 0.3], width_ratios=[1.25, 1.0])
    return figure, *(figure.add_subplot(grid[place]) for place in ((0, slice(None)), (1, 0), (1, 1)))


def _draw_run(axes: Axes, run: Results) -> None:
    test = Compressed(run)
    if (before := test.before).any():
        axes.plot(style.PER_MILLE * (run.history["strain"][before] - test.strain_before),
                  run.history[run.facts.press("stress")][before], color=style.BLUE, linewidth=0.9, zorder=2.5,
                  label="its stages before the last")
    strain = style.PER_MILLE * test.strain
    top, bottom = test.column("stress_top_MPa"), test.column("stress_bottom_MPa")
    again = test.rise_again
    axes.plot(strain, test.stress, color=style.BLUE, linewidth=1.8, zorder=3,
              label=style.page().said("this run, mean of both platens", "this run")
                    + (f";\nrises again, {100.0 * again:+.0f} % above $f_c$" if again > 0.005 else ""))
    if test.has_peak:
        at, strength = test.peak
        axes.plot(style.PER_MILLE * at, strength, "D", color=style.BLUE, markersize=5.0, zorder=4.5, linestyle="none",
                  label=f"its $f_c$, {strength:.3g} MPa")
        stress = test.stress
        passes = int(np.argmax(stress >= _WITHIN_FIT * strength))
        if isinstance(modulus := test.results.get("E_GPa"), float) and stress[passes] >= _WITHIN_FIT * strength:
            first = max(0.0, strain[passes] - stress[passes] / modulus)  # per mille: MPa over GPa
            ends = np.array([first, strain[passes] + (1.02 * strength - stress[passes]) / modulus])
            axes.plot(ends, stress[passes] + modulus * (ends - strain[passes]), color=style.BLACK, linewidth=0.7, zorder=2.8,
                      label=f"its $E$, {modulus:.3g} GPa")
    if np.nanmax(np.abs(top - bottom)) > _LEAST_BAND * np.nanmax(np.abs(top)):
        rows = style.kept(strain, top, bottom)
        axes.fill_between(strain[rows], top[rows], bottom[rows], color=style.SKY, alpha=0.5, linewidth=0.0,
                          label=style.page().said("between its upper and lower platen", "between its platens"))


def _draw_references(axes: Axes, last_strain: float, wrapped: bool = False) -> None:
    """Draws Anderberg and Thelandersson's law and the peaks of the paper's Table 3. wrapped: for a narrow legend."""
    strain = np.linspace(0.0, min(last_strain, reference.AT_LAST_STRAIN), 300)
    axes.plot(style.PER_MILLE * strain, reference.at_stress(strain), color=style.VERMILLION,
              linestyle=(0, (5, 2)), linewidth=1.2,
              label=style.page().said(
                  "Anderberg & Thelandersson law\nat 20 °C, generated,\nnot measured points" if wrapped else
                  "Anderberg & Thelandersson law at 20 °C,\ngenerated, not measured points",
                  "Anderberg & Thelandersson, law"))
    # the paper's model stands above the mean of runs, which it may nearly meet
    for values, marker, name, order in (
        (reference.EXPERIMENT, "D", "experiment", 5),
        (reference.PAPER_DEM, "s", "paper's DEM", 6),
    ):
        axes.plot(style.PER_MILLE * values.strain_at_peak, values.strength, marker, color=style.BLACK,
                  markerfacecolor="white", markersize=4.5, zorder=order, linestyle="none",
                  label=style.page().said(f"peak, {name}:" + ("\n" if wrapped else " ")
                                          + "$f_c$ at $f_c/E+\\varepsilon_{ic}$ (Table 3)", f"peak, {name}"))


def _draw_marks(axes: Axes, marks: Mapping[str, Frame]) -> None:
    axes.plot([style.PER_MILLE * frame.strain for frame in marks.values()],
              [frame.stress for frame in marks.values()], "o", color=style.BLUE, markersize=6.5,
              linestyle="none", zorder=4,
              label=style.page().said("frames shown in fracture: ", "frames ") + ", ".join(marks) if marks else None)
    for letter, frame in marks.items():
        axes.annotate(letter, (style.PER_MILLE * frame.strain, frame.stress), xytext=(-7, -11),
                      textcoords="offset points", ha="center", va="center", fontweight="bold", zorder=3.5,
                      bbox={"boxstyle": "circle,pad=0.15", "facecolor": "white", "edgecolor": "none",
                            "alpha": 0.8})


def _draw_table(axes: Axes, run: Results) -> None:
    test = Compressed(run)
    def shown(key: str, form: str) -> str:
        value = test.results.get(key)
        if isinstance(value, (int, float)):
            return format(value, form)
        return "not given" if test.has_peak else "no peak"

    columns = ["this run"]
    others = []
    if reference.COMPRESSION in run.references.builtin:
        columns += ["paper's DEM", "experiment"]
        others = [reference.PAPER_DEM, reference.EXPERIMENT]
    axes.axis("off")
    table = axes.table(
        cellText=[
            [shown("E_GPa", ".2f"), *(f"{other.modulus:.2f}" for other in others)],
            [shown("f_c_MPa", ".2f"), *(f"{other.strength:.2f}" for other in others)],
            [shown("strain_ic", ".5f"), *(f"{other.inelastic_strain:.5f}" for other in others)],
        ],
        rowLabels=["$E$ [GPa]", "$f_c$ [MPa]", "$\\varepsilon_{ic}$ [–]"],
        colLabels=columns,
        cellLoc="center",
        bbox=[0.16, 0.05, 0.28 * len(columns), 0.9] if not style.page().is_column else
        [0.15, 0.0, 0.85 * len(columns) / 3.0, 1.0],
    )
    table.auto_set_font_size(False)
    table.set_fontsize(style.page().size(7.5))
    for cell in table.get_celld().values():
        cell.set_linewidth(0.4)
        cell.set_edgecolor(style.FAINT)


@style.in_style
def compare(runs: Sequence[Results], are_seeds: bool = False) -> Figure:
    """Draws the curves of several runs, their mean as far as all of them go, and the mean of their peaks.

    are_seeds: the runs differ in the seed alone, so that their range is drawn and none has a name.

    More than MANY runs are drawn as the range that they span. A run without a peak (its summary has no f_c)
    is drawn but does not enter the mean of the peaks.
    """
    if not runs:
        raise Error("compare: no runs were given")
    if heated := [run for run in runs if Heated(run).is_last]:
        raise Error(f"{heated[0].folder}: ends with heating, so it has no stress-strain curve")
    figure, (axes,), beside = style.panels(4.2, beside=0.42)
    title_together(axes, runs)
    curves = [(style.PER_MILLE * strain, stress) for strain, stress in map(_curve, runs)]
    if are_seeds and len(runs) > 1:
        for curve in curves:
            axes.plot(*curve, color=style.SKY, linewidth=0.7)
        draw_spread(axes, curves, style.BLUE)
    elif len(runs) > MANY:
        draw_spread(axes, curves, style.BLUE)
    else:
        for run, curve, name, (colour, dashes) in zip(runs, curves, names_apart(runs), cycle(style.LOOKS)):
            test = Compressed(run)
            strength = f"{test.peak[1]:.2f} MPa" + ("" if test.has_peak else ", no peak reached")
            axes.plot(*curve, color=colour, linestyle=dashes, linewidth=1.0,
                      label=f"{textwrap.fill(name, 34)},\n{strength}")
        if len(runs) > 1:
            axes.plot(*mean_of(curves), color=style.BLACK, linewidth=2.0,
                      label=f"mean of {len(runs)}, as far as all go")
    _draw_mean_peak(axes, runs)
    last = max(np.nanmax(Compressed(run).strain) for run in runs)
    if any(reference.COMPRESSION in run.references.builtin for run in runs):
        _draw_references(axes, max(last, _LEAST_STRAIN_SHOWN), wrapped=True)
    draw_tables(axes, runs, ("strain", style.PER_MILLE), ("stress", 1.0))
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(style.STRAIN_LABEL)
    axes.set_ylabel(style.STRESS_LABEL)
    style.draw_legend(beside, axes, loc="upper left")
    return figure


def draw_tables(axes: Axes, runs: Sequence[Results], over: tuple[str, float], *drawn: tuple[str, float]) -> None:
    """Draws the users' own references that the runs' decks ask for, each once.

    over, drawn: what they are of, as decks name it, and the factor from the history's unit to the axis'.
    """
    x, x_factor = over
    tables = {own.content: (own, y_factor) for run in runs for y, y_factor in drawn for own in run.references.of(y, x)}
    for (own, y_factor), (colour, dashes) in zip(tables.values(), cycle(_TABLE_LOOKS)):
        name = style.plain(own.name)
        if own.is_range:
            axes.fill_between(x_factor * own.x, y_factor * own.low, y_factor * own.high, color=colour, alpha=0.25,
                              linewidth=0.0, label=name)
        else:
            axes.plot(x_factor * own.x, y_factor * own.low, color=colour, linestyle=dashes, linewidth=1.2,
                      label=name)


def draw_spread(axes: Axes, curves: Sequence[tuple[np.ndarray, np.ndarray]], colour: str,
                label: str | None = None) -> None:
    """Draws the range of many curves (x, y), least to greatest, and their mean. label: says both, unless it is None."""
    finite = [_advancing(*curve) for curve in curves]
    over = np.linspace(min(x[0] for x, _ in finite), max(x[-1] for x, _ in finite), _MEAN_POINTS)
    values = np.array([np.interp(over, x, y, left=np.nan, right=np.nan) for x, y in finite])
    known = np.isfinite(values).any(axis=0)
    low, high = np.nanmin(values[:, known], axis=0), np.nanmax(values[:, known], axis=0)
    axes.fill_between(over[known], low, high, color=colour, alpha=0.25, linewidth=0.0,
                      label=None if label else f"{len(curves)} runs:\nleast to greatest")
    axes.plot(*mean_of(curves), color=colour, linewidth=2.0, label=label or "their mean, as far as all go")


def _curve(run: Results) -> tuple[np.ndarray, np.ndarray]:
    """Returns strain and stress [MPa]; from rest, unless heat came before."""
    test = Compressed(run)
    strain, stress = test.strain, test.stress
    run.history.known("strain", test.rows)
    if not Heated(run).exchanged.any():
        strain, stress = np.concatenate([[0.0], strain]), np.concatenate([[0.0], stress])
    return strain, stress


def mean_of(curves: Sequence[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Returns the mean of curves (x, y) where all have values; points whose x does not exceed all before are left out.

    Each curve has a point that is finite.
    """
    advancing = [_advancing(*curve) for curve in curves]
    common = np.linspace(max(x[0] for x, _ in advancing), min(x[-1] for x, _ in advancing), _MEAN_POINTS)
    return common, np.mean([np.interp(common, x, y) for x, y in advancing], axis=0)


def _advancing(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the finite points of a curve whose x exceeds all before."""
    rows = np.isfinite(x) & np.isfinite(y)
    if not rows.any():
        raise Error("compare: a run has no finite value of the compared quantity")
    x, y = x[rows], y[rows]
    rows = np.concatenate([[True], x[1:] > np.maximum.accumulate(x)[:-1]])
    return x[rows], y[rows]


def _draw_mean_peak(axes: Axes, runs: Sequence[Results]) -> None:
    peaks = np.array([test.peak for test in map(Compressed, runs) if test.has_peak])
    if not len(peaks):
        return
    peaks[:, 0] *= style.PER_MILLE
    strain, stress = peaks.mean(axis=0)
    label = f"mean peak of {len(peaks)}:\n{stress:.2f} MPa at {strain:.2f}$\\times 10^{{-3}}$"
    spread = [None, None]
    if len(peaks) > 1:
        spread = peaks.std(axis=0, ddof=1)
        label += ";\nbars: standard deviation"
    axes.errorbar(strain, stress, xerr=spread[0], yerr=spread[1], fmt="o", color=style.BLACK,
                  markerfacecolor="white", capsize=2.5, elinewidth=1.0, linewidth=1.0,
                  zorder=5, label=label)


def names_apart(runs: Sequence[Results], written: Callable[[str], str] = style.plain) -> list[str]:
    """Returns titles; where these do not tell the runs apart, what differs between their decks, else the shortest ends
    of the folders' paths. Warnings stay.

    written: how a text of the user's stands in a figure, or elsewhere
    """
    names = [written(run.title) for run in runs]
    if len(set(names)) < len(names):
        ends = ends_apart([run.folder.resolve() for run in runs])
        names = [written(name) for name in names_by_decks(runs) or ends]
    return [" – ".join([name, *style.warnings_of(run)]) for name, run in zip(names, runs)]


def title_together(axes: Axes, runs: Sequence[Results]) -> None:
    """Heads a comparison with the title that its runs have in common."""
    if style.page().has_title and len({run.title for run in runs}) == 1:
        axes.set_title("\n".join(style.lines_of(style.plain(runs[0].title), style.page().letters)))


def ends_apart(folders: Sequence[Path]) -> list[str]:
    """Returns of each path as many of its last parts as tell it from the others."""
    ends = []
    for folder in folders:
        others = [other for other in folders if other != folder]
        ends.append(next(end for n in range(1, len(folder.parts) + 1) for end in ["/".join(folder.parts[-n:])]
                         if n == len(folder.parts) or all(other.parts[-n:] != folder.parts[-n:] for other in others)))
    return ends
