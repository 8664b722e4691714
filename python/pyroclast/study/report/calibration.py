"""Report of a search for targets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ...draw import style
from ..methods.calibration import NOT_DETERMINED, usual_population
from ..parameters import Parameter, Value
from .drawing import (BAR, NOT_TOLD, along, ends, legend_above, name_bars, no_value_ticks, output_label, panels,
                      parameter_label, places, value_text)
from .section import PageTable, Section, Shown, nothing
from .seen import Array, Seen, listed, number, numbers

_MISFIT = ("The misfit is the sum of squares of the distances to the targets, each in standard deviations: of the mean "
           "over the seeds, and of the experiment. With as many targets as parameters it can go to 0; about the "
           "number of targets is as good as the scatter allows one to tell.")
_MISFIT_CAPTION = ("Misfit of each point, by generation of the search; line: the best so far; crosses on the upper "
                   "edge: infeasible, or without a value for a target. Vermilion: the number of targets.")
_SEARCH_CAPTION = ("Misfit of all points over each parameter; vermilion: the best point; crosses on the upper edge: "
                   "infeasible, or without a value for a target.")
_RESIDUALS_CAPTION = "Best point minus target, in standard deviations of that difference; band: ± 2."
_PARAMETERS = ("The standard deviation is that of a linear form around the best point, within the ranges. A parameter "
               f"is not determined where it is above {NOT_DETERMINED:g} of that of its range: the targets say hardly "
               "more of it than the range did.")
_PARAMETERS_CAPTION = ("Best value and ± one standard deviation within the range of each parameter, whose ends stand "
                       "beside. Grey: not determined.")
_DIRECTIONS = ("A direction is a combination of parameters, each as a share of its range, that the targets tell as a "
               "whole. Along one that they cannot tell, parameters may be exchanged for each other.")
_DIRECTIONS_CAPTION = ("Directions from the best told to the least, a row each: the parts of the parameters, and at "
                       "the right the standard deviation over that of the ranges. Grey rows: above "
                       f"{NOT_DETERMINED:g}, which the targets cannot tell.")
_LEAST_PART = 0.3  # of a direction, that a sentence names
_MOST_NAMED = 5  # directions in a sentence
_MOST_DIRECTIONS = 10  # in a figure
_MOST_LEVEL = 6  # names of parameters side by side that are not turned
_NOT_TOLD_ROW = "#efefef"
_DARK = 0.7  # part whose colour is dark


def sections(seen: Seen) -> list[Section]:
    found = seen.findings
    if found is None:
        return []
    best = [p.distribution.at(u) for p, u in zip(seen.setup.parameters, found["best"]["u"])]
    return [_of_search(seen, found, best), _of_targets(seen, found), *_of_parameters(seen, found, best)]


def standing(found: dict[str, Any]) -> str:
    """Returns whether a search is done, and why."""
    said = f"The search is done: {found['finished']}." if found["finished"] else "The search goes on."
    doubts = found["best"]["doubts"].items()
    return " ".join([said, *(f"{output} does not count as met: {why}." for output, why in doubts)])


def generation_size(seen: Seen) -> int:
    """Returns the points of a generation, as stated or as CMA-ES has it by default."""
    return int(seen.setup.method.settings["population"]) or usual_population(len(seen.setup.parameters))


def _of_search(seen: Seen, found: dict[str, Any], best: Sequence[Value]) -> Section:
    named = listed([f"{p.name} = {value_text(p, v)}" for p, v in zip(seen.setup.parameters, best)])
    said = (f"{standing(found)} The best of {found['points']} points has a misfit of {number(found['best']['misfit'], 3)} for "
            f"{len(found['targets']['names'])} targets: {named}.")
    figures = [Shown("misfit", misfit_figure(seen, found), _MISFIT_CAPTION),
               Shown("search", search_figure(seen, found), _SEARCH_CAPTION)]
    return Section("Search", [said, _MISFIT], figures)


@matplotlib.rc_context(style.STYLE)
def misfit_figure(seen: Seen, found: dict[str, Any]) -> Figure:
    """Draws misfits by generation."""
    misfits, size = numbers(found["misfits"]), generation_size(seen)
    number_of = np.arange(len(misfits))
    generation = 1 + number_of // size
    figure = style.new_figure(2.4, 4.6)
    axes = figure.subplots()
    spread = 0.6 * ((number_of % size + 0.5) / size - 0.5)
    axes.plot(generation + spread, misfits, "o", color=style.SKY, markersize=3.0, markeredgewidth=0.0)
    no_value_ticks(axes, (generation + spread)[np.isnan(misfits)])
    so_far = np.fmin.accumulate(misfits)
    last = np.append(np.flatnonzero(np.diff(generation)), len(misfits) - 1)
    axes.plot(generation[last], so_far[last], color=style.BLUE, drawstyle="steps-mid")
    targets = len(found["targets"]["names"])
    axes.axhline(targets, color=style.VERMILLION, linewidth=0.8)
    axes.annotate("number\nof targets", (1.01, targets), xycoords=axes.get_yaxis_transform(), va="center", fontsize=7.0,
                  color=style.VERMILLION, annotation_clip=False)
    if np.nanmin(misfits) > 0.0:
        axes.set_yscale("log")
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.set_xlabel("Generation")
    axes.set_ylabel("Misfit [sd²]")
    return figure


@matplotlib.rc_context(style.STYLE)
def search_figure(seen: Seen, found: dict[str, Any]) -> Figure:
    """Draws the misfit over each parameter."""
    misfits = numbers(found["misfits"])
    figure, every = panels(len(seen.setup.parameters))
    for axes, parameter, u, best in zip(every, seen.setup.parameters, seen.u.T, found["best"]["u"]):
        x = places(parameter, u)
        axes.plot(x, misfits, "o", color=style.SKY, markersize=3.0, markeredgewidth=0.0)
        no_value_ticks(axes, x[np.isnan(misfits)])
        axes.plot(places(parameter, [best]), [found["best"]["misfit"]], "o", color=style.VERMILLION, markersize=5.0)
        if np.nanmin(misfits) > 0.0:
            axes.set_yscale("log")
        along(axes, parameter)
        axes.set_xlim(*ends(parameter))
        if axes.get_subplotspec().is_first_col():
            axes.set_ylabel("Misfit [sd²]")
        else:
            axes.tick_params(labelleft=False)
    return figure


def _of_targets(seen: Seen, found: dict[str, Any]) -> Section:
    targets, best, sd = found["targets"], numbers(found["best"]["y"]), numbers(found["sd"])
    labels = {o.name: output_label(o) for o in seen.setup.outputs}
    residuals = (best - numbers(targets["values"])) / sd
    rows = [[labels[name], number(value), number(stated, 3), number(at), number(of_difference, 3), number(residual, 2)]
            for name, value, stated, at, of_difference, residual
            in zip(targets["names"], targets["values"], targets["sd"], best, sd, residuals)]
    table = PageTable(["target", "value", "sd of the experiment", "best point", "sd of the difference",
                       "difference in sd"], rows)
    far = [name for name, residual in zip(targets["names"], residuals) if abs(residual) > 2.0]
    said = (f"Farther than two standard deviations from its target: {listed(far)}." if far else
            "All targets are met within two standard deviations.")
    figure = residuals_figure(targets["names"], residuals)
    return Section("Targets", [said], [Shown("targets", figure, _RESIDUALS_CAPTION)], [table])


@matplotlib.rc_context(style.STYLE)
def residuals_figure(names: Sequence[str], residuals: Array) -> Figure:
    """Draws what is left to each target."""
    figure = style.new_figure(0.8 + BAR * len(names), 4.6)
    axes = figure.subplots()
    axes.axvspan(-2.0, 2.0, color=style.GREEN, alpha=0.15, linewidth=0.0)
    axes.axvline(0.0, color=style.BLACK, linewidth=0.6)
    axes.hlines(range(len(names)), 0.0, residuals, color=style.BLUE)
    axes.plot(residuals, range(len(names)), "o", color=style.BLUE, markersize=5.0)
    name_bars(axes, names)
    reach = max(3.0, 1.1 * float(np.nanmax(np.abs(residuals))))
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("Best point minus target [standard deviations]")
    return figure


def _of_parameters(seen: Seen, found: dict[str, Any], best: Sequence[Value]) -> list[Section]:
    told = found["uncertainty"]
    parameters = seen.setup.parameters
    if "none_because" in told:
        return [nothing("Parameters", told["none_because"])]
    u, sd = numbers(found["best"]["u"]), numbers(told["sd"])
    rows = [[parameter_label(p), value_text(p, v), _interval(p, centre, width), number(ratio, 2),
             "no" if free else "yes"] for p, v, centre, width, ratio, free
            in zip(parameters, best, u, sd, told["sd_ratio"], told["not_determined"])]
    faint = frozenset(i for i, free in enumerate(told["not_determined"]) if free)
    free = [p.name for p, is_free in zip(parameters, told["not_determined"]) if is_free]
    said = f"Not determined: {listed(free)}." if free else "The targets determine all parameters."
    table = PageTable(["parameter", "best", "± one standard deviation", "sd over that of its range", "determined"],
                      rows, faint=faint)
    ranges = ranges_figure(parameters, u, sd, told["not_determined"])
    made = [Section("Parameters", [f"{said} The form comes from {told['points']} points.", _PARAMETERS],
                    [Shown("parameters", ranges, _PARAMETERS_CAPTION)], [table])]
    if len(parameters) > 1:
        figure = directions_figure(parameters, told)
        more = len(parameters) - _MOST_DIRECTIONS
        left_out = f" The {more} least told are not drawn." if more > 0 else ""
        made.append(Section("Directions", [_not_told(parameters, told), _DIRECTIONS],
                            [Shown("directions", figure, _DIRECTIONS_CAPTION + left_out)]))
    return made


def _interval(parameter: Parameter, centre: float, width: float) -> str:
    low, high = (parameter.distribution.at(float(np.clip(u, 0.0, 1.0))) for u in (centre - width, centre + width))
    return f"{value_text(parameter, low)} to {value_text(parameter, high)}"


def _not_told(parameters: Sequence[Parameter], told: dict[str, Any]) -> str:
    combinations = []
    for direction, is_free in zip(numbers(told["directions"]), told["direction_not_determined"]):
        if is_free:
            parts = [(part, p.name) for part, p in zip(direction, parameters) if abs(part) >= _LEAST_PART]
            combinations.append(" ".join(f"{'+' if part > 0.0 else '−'}{abs(part):.2f} {name}" for part, name in parts))
    if not combinations:
        return "The targets tell all directions."
    more = len(combinations) - _MOST_NAMED
    return (f"The targets cannot tell: {'; '.join(combinations[:_MOST_NAMED])}"
            + (f"; and {more} directions more." if more > 0 else "."))


@matplotlib.rc_context(style.STYLE)
def ranges_figure(parameters: Sequence[Parameter], u: Array, sd: Array, free: Sequence[bool],
                  label: str = "best ± sd") -> Figure:
    """Draws a place and a spread within the range of each parameter."""
    figure = style.new_figure(0.9 + 1.3 * BAR * len(parameters), 5.4)
    axes = figure.subplots()
    for at, (parameter, centre, width, is_free) in enumerate(zip(parameters, u, sd, free)):
        colour = NOT_TOLD if is_free else style.SKY
        low, high = max(centre - width, 0.0), min(centre + width, 1.0)
        axes.barh(at, 1.0, 0.56, color="none", edgecolor=style.FAINT, linewidth=0.6)
        axes.barh(at, high - low, 0.5, left=low, color=colour)
        axes.plot([centre, centre], [at - 0.3, at + 0.3], color=style.FAINT if is_free else style.BLUE, linewidth=2.0)
        first, *_, last = (value_text(parameter, v) for v in parameter.distribution.ends())
        for x, end, side in ((-0.015, first, "right"), (1.015, last, "left")):
            axes.annotate(style.plain(end), (x, at), ha=side, va="center", fontsize=7.0, annotation_clip=False)
    name_bars(axes, [p.name for p in parameters], list(free))
    axes.tick_params(axis="y", pad=52)
    axes.spines["left"].set_visible(False)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("Place within the range (share of the distribution below)")
    legend_above(figure, [Patch(color=style.SKY, label=label)]
                 + ([Patch(color=NOT_TOLD, label="not determined")] if any(free) else []))
    return figure


@matplotlib.rc_context(style.STYLE)
def directions_figure(parameters: Sequence[Parameter], told: dict[str, Any]) -> Figure:
    """Draws parts of the parameters in each direction, the best told ones first."""
    directions = numbers(told["directions"])[:_MOST_DIRECTIONS]
    free = np.array(told["direction_not_determined"], bool)[:_MOST_DIRECTIONS]
    rows, k = directions.shape
    is_wide = k > _MOST_LEVEL
    figure = style.new_figure(0.9 + 0.3 * rows + (0.8 if is_wide else 0.0), min(style.WIDTH, 2.2 + 0.6 * k))
    axes = figure.subplots()
    shades = matplotlib.colormaps["PuOr"](0.5 + 0.42 * directions)
    shades[free] = to_rgba(_NOT_TOLD_ROW)
    axes.imshow(shades, aspect="auto")
    for row, column in np.ndindex(rows, k):
        axes.annotate(f"{directions[row, column]:+.2f}".replace("-", "−"), (column, row), ha="center", va="center",
                      fontsize=7.0 if k <= 8 else 5.0, color=_ink(directions[row, column], free[row]))
    for row, ratio in enumerate(told["direction_ratio"][:rows]):
        _beside(axes, row, number(ratio, 2) + ("  not told" if free[row] else ""), free[row])
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0)
    axes.set_xticks(range(k), [p.name for p in parameters], rotation=60 if is_wide else 0,
                    ha="right" if is_wide else "center")
    axes.set_yticks(range(rows), [str(i + 1) for i in range(rows)])
    axes.set_ylabel("Direction")
    _beside(axes, -0.75, "sd ratio", False)
    return figure


def _ink(part: float, is_faint: bool) -> str:
    """Returns the ink that is read on the colour of a part."""
    return style.FAINT if is_faint else "white" if abs(part) > _DARK else style.BLACK


def _beside(axes: Axes, row: float, text: str, is_faint: bool) -> None:
    axes.annotate(text, (1.02, row), xycoords=axes.get_yaxis_transform(), va="center", fontsize=7.0,
                  color=style.FAINT if is_faint else style.BLACK, annotation_clip=False)
