"""Several runs in one figure: stress-strain, total strain, cracks or thrust."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..errors import Error
from ..stored import reference
from ..stored.heated import Heated
from ..stored.results import Results
from . import style
from .curves import MANY, compare, draw_spread, draw_tables, mean_of, names_apart, title_together
from .heating import THRUST_LABEL, TOTAL_STRAIN_LABEL, draw_band, mark_leaving, over_minutes, strain_limits
from .progress import (MINUTES_LABEL, crack_extent, extent_of_cracks, heating_course, heating_minutes,
                       loading_course, temperature_label)

_LEVEL_COLOURS = {0.0: style.BLUE, 0.225: style.GREEN, 0.445: style.ORANGE, 0.675: style.VERMILLION}
_OTHER_COLOURS = (style.PURPLE, style.BLACK, style.SKY)
_BAND_LABEL = (f"range of models calibrated\non Anderberg & Thelandersson's\ntests, not measured points;\n"
               f"dashed: its centre; pale above\n{reference.TRUSTED_TO:g} °C: order only")


def compare_runs(runs: Sequence[Results], what: str | None = None) -> Figure:
    """Draws what the runs have in common: total strain or thrust when all end heated, stress-strain when none does.

    what: one of KINDS, to choose oneself. Raises Error when a run does not have it.
    """
    if not runs:
        raise Error("compare: no runs were given")
    return KINDS[what or _common_kind(runs)](runs)


def compare_seeds(runs: Sequence[Results]) -> Figure:
    """Runs that differ in the seed alone: the range of their curves and their mean."""
    if not runs:
        raise Error("compare: no runs were given")
    kind = _common_kind(runs)
    return compare(runs, are_seeds=True) if kind == "stress-strain" else KINDS[kind](runs)


def _common_kind(runs: Sequence[Results]) -> str:
    first = _kind(runs[0])
    for run in runs:
        if _kind(run) != first:
            raise Error(f"compare: {run.folder} would be compared by {_kind(run)}, but {runs[0].folder} "
                           f"by {first}; choose with --what")
    return first


def _kind(run: Results) -> str:
    hot = Heated(run)
    if not run.moves:
        raise Error(f"compare: {run.folder} is a run of heat alone, which has no stress and no strain; "
                    "`pyroclast report RUN RUN... --out FILE` draws temperatures of several runs together")
    if not hot.is_last:
        return "stress-strain"
    return "thrust" if hot.restrained else "total-strain"


@dataclass(frozen=True)
class _Group:
    """Runs that are seeds of one test."""

    label: str
    colour: str
    runs: list[Results]


def _by_load(runs: Sequence[Results]) -> list[_Group]:
    """Runs of one load level, or of one stress where the level is not known, lowest first; others alone."""
    together: dict[tuple, list[Results]] = {}
    for run, name in zip(runs, names_apart(runs)):
        hot = Heated(run)
        if hot.restrained or hot.load_stress is None:
            key = (2, 0.0, name)
        elif hot.load_level is not None:
            band = reference.strain_band(hot.load_level)
            key = (0, band.level if band else round(hot.load_level, 3), "")
        else:
            key = (1, round(hot.load_stress, 3), "")
        together.setdefault(key, []).append(run)
    others = cycle(_OTHER_COLOURS)
    return [_Group(style.load_label(together[key][0]) or key[2],
                   _LEVEL_COLOURS[key[1]] if key[0] == 0 and key[1] in _LEVEL_COLOURS else next(others),
                   together[key]) for key in sorted(together)]


def _label(group: _Group) -> str:
    lines = [group.label]
    if len(group.runs) > 1:
        each = "pale: least to greatest" if len(group.runs) > MANY else "thin: each"
        lines.append(f"mean of {len(group.runs)}; {each}")
    criticals = [Heated(run).critical_temperature for run in group.runs]
    if failed := sorted(critical for critical in criticals if critical is not None):
        told = ", ".join(f"{t:.0f}" for t in failed) if len(failed) <= MANY else f"{failed[0]:.0f} to {failed[-1]:.0f}"
        lines.append(f"✖ failed at {told} °C" + (f" ({len(failed)} runs)" if len(failed) > MANY else ""))
    if missed := sum(int(Heated(run).unconverged.sum()) for run in group.runs):
        lines.append(f"{missed} EXCHANGE{'S' if missed > 1 else ''} NOT CONVERGED")
    return "\n".join(textwrap.fill(line, 34) for line in lines)


@style.in_style
def compare_total_strain(runs: Sequence[Results]) -> Figure:
    """Draws the total strain over temperature, one colour a load level, on the reference bands (paper, Figure 12)."""
    _demand_heated(runs)
    figure, (axes,), beside = style.panels(4.2, beside=0.42)
    title_together(axes, runs)
    bands, timed = [], _timed(runs)
    over, label = _axis(runs)
    groups = _by_load(runs)
    for group in groups:
        asked = not timed and any(reference.TRANSIENT_STRAIN in run.references.builtin for run in group.runs)
        if asked and (band := reference.strain_band(Heated(group.runs[0]).load_level)):
            bands.append(band)
            draw_band(axes, band, group.colour)
        _draw_group(axes, group, over)
    draw_tables(axes, runs, _over(runs), ("total_strain", style.PER_MILLE))
    axes.axhline(0.0, color=style.BLACK, linewidth=0.6)
    axes.set_ylim(*strain_limits(runs, bands))
    for group in groups:
        for x, strain in _curves_of(group, over):
            mark_leaving(axes, x, strain, group.colour)
    axes.set_xlabel(label)
    axes.set_ylabel(TOTAL_STRAIN_LABEL.replace("\n", " "))
    handles, labels = axes.get_legend_handles_labels()
    if bands:
        handles, labels = [*handles, Patch(color=style.FAINT, alpha=0.4)], [*labels, _BAND_LABEL]
    style.draw_legend(beside, axes, handles, labels, loc="upper left")
    return figure


@style.in_style
def compare_thrust(runs: Sequence[Results]) -> Figure:
    """Draws the axial stress over temperature, or minutes where no run is uniform, each by itself."""
    _demand_heated(runs)
    over, label = _axis(runs)
    figure, (axes,), beside = style.panels(4.2, beside=0.42)
    title_together(axes, runs)
    if len(runs) > MANY:
        draw_spread(axes, [(over(run), Heated(run).stress) for run in runs], style.BLUE)
    else:
        _draw_thrusts(axes, runs, over)
    draw_tables(axes, runs, _over(runs), ("stress", 1.0))
    axes.set_xlabel(label)
    axes.set_ylabel(THRUST_LABEL.replace("\n", " "))
    style.draw_legend(beside, axes, loc="upper left")
    return figure


def _draw_thrusts(axes: Axes, runs: Sequence[Results], over: Callable[[Results], np.ndarray]) -> None:
    for run, name, (colour, dashes) in zip(runs, names_apart(runs), cycle(style.LOOKS)):
        largest = run.history.known(run.facts.press("stress"), Heated(run).rows).max()
        axes.plot(over(run), Heated(run).stress, color=colour,
                  linestyle=dashes, label=f"{textwrap.fill(name, 34)},\nlargest {largest:.2f} MPa")


@style.in_style
def compare_cracks(runs: Sequence[Results]) -> Figure:
    """Draws the length of broken contacts by mode, of solids their area, and the mean opening: while heated, or over
    strain if none ends heated.
    """
    if len({Heated(run).is_last for run in runs}) > 1:
        raise Error("compare: cracks of runs that end heated and of others have no common axis")
    courses = [heating_course(run) if Heated(run).is_last else loading_course(run) for run in runs]
    if len({course.ordered for course in courses}) > 1:
        raise Error("compare: cracks of runs that cool and of runs that do not have no common axis")
    figure, panels, beside = style.panels(5.4, (1.0, 1.0, 1.0), beside=0.42)
    title_together(panels[0], runs)
    if len({extent_of_cracks(run) for run in runs}) > 1:
        raise Error("compare: cracks of runs in the plane and in space have no common axis")
    what, unit = extent_of_cracks(runs[0])
    drawn = [(crack_extent(course, "tension", True), crack_extent(course, "shear", True),
              1e6 * course.opening) for course in courses]
    if len(runs) > MANY:
        for axes, of_all in zip(panels, zip(*drawn)):
            draw_spread(axes, [(course.over, values) for course, values in zip(courses, of_all)], style.BLUE)
    else:
        for course, of_run, name, (colour, dashes) in zip(courses, drawn, names_apart(runs), cycle(style.LOOKS)):
            for axes, values in zip(panels, of_run):
                axes.plot(course.over, values, color=colour, linestyle=dashes, linewidth=1.0,
                          label=textwrap.fill(name, 34))
    for axes, label in zip(panels, (f"{what} of broken\ncontacts, tension [{unit}]",
                                    f"{what} of broken\ncontacts, shear [{unit}]",
                                    "Mean opening of\ncontacts damaged\nin tension [µm]")):
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(left=min(course.start for course in courses))
        axes.tick_params(labelbottom=axes is panels[-1])
    panels[-1].set_xlabel(max((course.label for course in courses), key=len))  # "mean" if any has a mean
    style.draw_legend(beside, panels[0], loc="upper left")
    return figure


def _curves_of(group: _Group, over: Callable[[Results], np.ndarray]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Returns what runs are drawn over, and their total strain [10^-3], while they stood."""
    return [(over(hot.run)[rows], style.PER_MILLE * hot.total_strain[rows])
            for hot in map(Heated, group.runs) for rows in [hot.standing[hot.rows]]]


def _draw_group(axes: Axes, group: _Group, over: Callable[[Results], np.ndarray]) -> None:
    curves = _curves_of(group, over)
    if len(curves) == 1:
        axes.plot(*curves[0], color=group.colour, linewidth=1.8, label=_label(group))
    elif len(curves) > MANY:
        draw_spread(axes, curves, group.colour, _label(group))
    else:
        for curve in curves:
            axes.plot(*curve, color=group.colour, linewidth=0.5)
        axes.plot(*mean_of(curves), color=group.colour, linewidth=2.0, label=_label(group))
    for (x, strain), run in zip(curves, group.runs):
        if Heated(run).critical_temperature is not None:
            axes.plot(x[-1], strain[-1], "X", color=group.colour, markeredgecolor=style.BLACK,
                      markeredgewidth=0.5, markersize=6.0, zorder=4)


def _demand_heated(runs: Sequence[Results]) -> None:
    for run in runs:
        if not Heated(run).exchanged.any():
            raise Error(f"{run.folder}: was never heated")


def _timed(runs: Sequence[Results]) -> bool:
    """Returns whether the runs are drawn over minutes, which takes that all of them are."""
    return all(Heated(run).timed for run in runs)


def _over(runs: Sequence[Results]) -> tuple[str, float]:
    """Returns what their references are drawn over."""
    return over_minutes(_timed(runs))


def _axis(runs: Sequence[Results]) -> tuple[Callable[[Results], np.ndarray], str]:
    """Returns what heated runs are drawn over, and its label."""
    if _timed(runs):
        return heating_minutes, MINUTES_LABEL
    label = temperature_label(next((run for run in runs if not Heated(run).uniform), runs[0]))
    return lambda run: Heated(run).column("temperature_degC"), label


KINDS: dict[str, Callable[[Sequence[Results]], Figure]] = {
    "stress-strain": compare,
    "total-strain": compare_total_strain,
    "cracks": compare_cracks,
    "thrust": compare_thrust,
}
"""What runs can be compared by."""
