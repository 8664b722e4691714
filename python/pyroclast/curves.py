"""Stress-strain figures: one run against the references, and several runs together."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from itertools import cycle

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import reference, style
from .run import Frame, Run, RunError

_MEAN_POINTS = 400
_LEAST_STRAIN_SHOWN = 0.004


@matplotlib.rc_context(style.STYLE)
def stress_strain(run: Run, marks: Mapping[str, Frame]) -> Figure:
    """The run's curve beside the Anderberg and Thelandersson law and the paper's Table 3 (paper, Figure 8).

    marks: the frames to point out, by letter, as `select_frames` gives them; may be empty.
    """
    figure = style.new_figure(4.8)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 0.3], width_ratios=[1.25, 1.0])
    axes = figure.add_subplot(grid[0, :])
    axes.set_title("\n".join([style.title_of(run), *_heated_before(run)]))
    if run.parent and not run.parent.ends_heated:
        style.draw_parent(axes, run.parent, style.PER_MILLE * run.parent.loaded_strain,
                          run.parent.loaded_history("stress_MPa"))
    _draw_run(axes, run)
    _draw_references(axes, max(np.nanmax(run.loaded_strain), _LEAST_STRAIN_SHOWN))
    _draw_marks(axes, marks)
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(style.STRAIN_LABEL)
    axes.set_ylabel(style.STRESS_LABEL)

    style.legend_alone(figure.add_subplot(grid[1, 0]), *axes.get_legend_handles_labels(), loc="center left")
    _draw_table(figure.add_subplot(grid[1, 1]), run)
    return figure


def _heated_before(run: Run) -> list[str]:
    """What heat did before the compression, for the title; empty when there was none."""
    if not run.exchanged.any():
        return []
    hottest = run.history.known("temperature_degC", run.heated).max()
    now = run.history.known("temperature_degC", run.loaded)[0]
    retained = run.strength_retained
    told = "" if retained is None else f"; largest stress {retained:.2f} of the strength before heating"
    return [f"heated to {hottest:.0f} °C, compressed at {now:.0f} °C{told}"]


def _draw_run(axes: Axes, run: Run) -> None:
    strain = style.PER_MILLE * run.loaded_strain
    top, bottom = run.loaded_history("stress_top_MPa"), run.loaded_history("stress_bottom_MPa")
    axes.plot(strain, run.loaded_history("stress_MPa"), color=style.BLUE, linewidth=1.8, zorder=3,
              label="this run, mean of both platens")
    axes.fill_between(strain, top, bottom, color=style.SKY, alpha=0.5, linewidth=0.0,
                      label="between its upper and lower platen")


def _draw_references(axes: Axes, last_strain: float) -> None:
    strain = np.linspace(0.0, min(last_strain, reference.AT_LAST_STRAIN), 300)
    axes.plot(style.PER_MILLE * strain, reference.at_stress(strain), color=style.VERMILLION,
              linestyle=(0, (5, 2)), linewidth=1.2,
              label="Anderberg & Thelandersson law at 20 °C,\ngenerated, not measured points")
    for values, marker, name in (
        (reference.EXPERIMENT, "D", "experiment"),
        (reference.PAPER_DEM, "s", "paper's DEM"),
    ):
        axes.plot(style.PER_MILLE * values.strain_at_peak, values.strength, marker, color=style.BLACK,
                  markerfacecolor="white", markersize=4.5, zorder=5, linestyle="none",
                  label=f"peak, {name}: $f_c$ at $f_c/E+\\varepsilon_{{ic}}$ (Table 3)")


def _draw_marks(axes: Axes, marks: Mapping[str, Frame]) -> None:
    axes.plot([style.PER_MILLE * frame.strain for frame in marks.values()],
              [frame.stress for frame in marks.values()], "o", color=style.BLUE, markersize=6.5,
              linestyle="none", zorder=4,
              label=f"frames shown in fracture: {', '.join(marks)}" if marks else None)
    for letter, frame in marks.items():
        axes.annotate(letter, (style.PER_MILLE * frame.strain, frame.stress), xytext=(-7, -11),
                      textcoords="offset points", ha="center", va="center", fontweight="bold", zorder=3.5,
                      bbox={"boxstyle": "circle,pad=0.15", "facecolor": "white", "edgecolor": "none",
                            "alpha": 0.8})


def _draw_table(axes: Axes, run: Run) -> None:
    def shown(key: str, form: str) -> str:
        value = run.compression.get(key)
        if isinstance(value, (int, float)):
            return format(value, form)
        return "not given" if run.compression else "no peak"

    def row(get, form: str) -> list[str]:
        return [format(get(values), form) for values in (reference.PAPER_DEM, reference.EXPERIMENT)]

    axes.axis("off")
    table = axes.table(
        cellText=[
            [shown("E_GPa", ".2f"), *row(lambda v: v.modulus, ".2f")],
            [shown("f_c_MPa", ".2f"), *row(lambda v: v.strength, ".2f")],
            [shown("strain_ic", ".5f"), *row(lambda v: v.inelastic_strain, ".5f")],
        ],
        rowLabels=["$E$ [GPa]", "$f_c$ [MPa]", "$\\varepsilon_{ic}$ [–]"],
        colLabels=["this run", "paper's DEM", "experiment"],
        cellLoc="center",
        bbox=[0.16, 0.05, 0.84, 0.9],
    )
    table.auto_set_font_size(False)
    table.set_fontsize(7.5)
    for cell in table.get_celld().values():
        cell.set_linewidth(0.4)
        cell.set_edgecolor(style.FAINT)


@matplotlib.rc_context(style.STYLE)
def compare(runs: Sequence[Run]) -> Figure:
    """Curves of several runs, their mean as far as all of them go, and the mean of their peaks.

    A run without a peak (summary's compression is null) is drawn but does not enter the mean of the peaks.
    """
    if not runs:
        raise RunError("compare: no runs were given")
    if heated := [run for run in runs if run.ends_heated]:
        raise RunError(f"{heated[0].folder}: ends with heating, so it has no stress-strain curve")
    figure = style.new_figure(4.2)
    axes, beside = figure.subplots(1, 2, width_ratios=[1.0, 0.42])
    for run, name, (colour, dashes) in zip(runs, names_apart(runs), cycle(style.LOOKS)):
        strength = f"{run.peak[1]:.2f} MPa" + ("" if run.compression else ", no peak reached")
        axes.plot(style.PER_MILLE * run.loaded_strain, run.loaded_history("stress_MPa"), color=colour,
                  linestyle=dashes, linewidth=1.0, label=f"{textwrap.fill(name, 34)}\n{strength}")
    strain, stress = mean_curve(runs)
    axes.plot(style.PER_MILLE * strain, stress, color=style.BLACK, linewidth=2.0,
              label=f"mean of {len(runs)}, as far as all go")
    _draw_mean_peak(axes, runs)
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(style.STRAIN_LABEL)
    axes.set_ylabel(style.STRESS_LABEL)
    style.legend_alone(beside, *axes.get_legend_handles_labels(), loc="upper left")
    return figure


def mean_curve(runs: Sequence[Run]) -> tuple[np.ndarray, np.ndarray]:
    """Strain from rest to the largest that all runs reach, and the runs' mean stress [MPa] at it."""
    curves = []
    for run in runs:
        strain, stress = run.loaded_strain, run.loaded_history("stress_MPa")
        if not run.exchanged.any():  # at rest before loading
            strain, stress = np.concatenate([[0.0], strain]), np.concatenate([[0.0], stress])
        curves.append((strain, stress))
    return mean_of(curves)


def mean_of(curves: Sequence[tuple[np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Mean of curves (x, y) where all have values; points whose x does not exceed all before are left out.

    Each curve has a point that is finite.
    """
    finite = [(x[rows], y[rows]) for x, y in curves for rows in [np.isfinite(x) & np.isfinite(y)]]
    advancing = [(x[rows], y[rows]) for x, y in finite
                 for rows in [np.concatenate([[True], x[1:] > np.maximum.accumulate(x)[:-1]])]]
    common = np.linspace(max(x[0] for x, _ in advancing), min(x[-1] for x, _ in advancing), _MEAN_POINTS)
    return common, np.mean([np.interp(common, x, y) for x, y in advancing], axis=0)


def _draw_mean_peak(axes: Axes, runs: Sequence[Run]) -> None:
    peaks = np.array([(style.PER_MILLE * run.peak[0], run.peak[1]) for run in runs if run.compression])
    if not len(peaks):
        return
    strain, stress = peaks.mean(axis=0)
    label = f"mean peak of {len(peaks)}:\n{stress:.2f} MPa at {strain:.2f}$\\times 10^{{-3}}$"
    spread = [None, None]
    if len(peaks) > 1:
        spread = peaks.std(axis=0, ddof=1)
        label += "\nbars: standard deviation"
    axes.errorbar(strain, stress, xerr=spread[0], yerr=spread[1], fmt="o", color=style.BLACK,
                  markerfacecolor="white", capsize=2.5, elinewidth=1.0, linewidth=1.0,
                  zorder=5, label=label)


def names_apart(runs: Sequence[Run]) -> list[str]:
    """Titles, or the folders' names where titles do not tell the runs apart; warnings stay."""
    titles = [style.title_of(run) for run in runs]
    if len(set(titles)) == len(titles):
        return titles
    return [" – ".join([style.plain(run.folder.resolve().name), *style.warnings_of(run)]) for run in runs]
