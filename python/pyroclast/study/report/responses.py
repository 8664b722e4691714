"""Report of a grid or a Latin hypercube; response curves, which other methods have too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ...draw import style
from ..methods import main_effects
from ..methods.seeds import LEAST
from ..outputs import Output
from ..parameters import Parameter
from .drawing import (BAR, NOT_TOLD, SEED, SEED_HATCH, Bar, along, draw_bar, draw_scatter, grey_patch, legend_above,
                      name_bars, output_label, panels, parameter_label, places, seed_bars, seed_patch)
from .section import PageTable, Section, Shown, how_to_read
from .seen import Array, Seen, between, listed, number, numbers, percent

_MEANING = ("A standardised rank regression coefficient says by how many standard deviations of its ranks the output "
            "moves when the parameter moves by one of its own; 1 or −1 is an output that this parameter alone orders. "
            "Spearman's correlation says the same of the parameter alone, without taking the others out.")
_EFFECTS = ("Rank effects with 95 % intervals (bootstrap over the points). Grey: not told from the seeds. The seed's "
            "bar is the root of its share of the variance, as a coefficient is of a straight line.")
_CURVES = ("Means over seeds of all points (grey dots), and their mean by classes of one parameter with its 95 % "
           "interval (Student's t over the points, all other parameters vary).")
_CONTOURS = "Mean over seeds between the points of the grid (dots); crosses: no value."
_LEAST_LEVELS = 4  # of each parameter: contours between fewer show the drawing and not the answer
_LEAST_R2 = 0.7  # of a rank regression that describes the output


def sections(seen: Seen) -> list[Section]:
    found = [how_to_read(_MEANING)]
    for output in seen.setup.outputs:
        of_output = seen.of_outputs().get(output.name, {"none_because": "no point is complete"})
        figures, texts, tables = [], [], []
        if (effects := of_output.get("rank_effects")) is not None:
            texts, tables = [_sentence(seen.setup.parameters, effects)], [_table(seen.setup.parameters, effects)]
            figures = [Shown(f"{output.name}-effects", effects_figure(seen.setup.parameters, effects), _EFFECTS)]
        if np.isfinite(seen.means(output.name)).any():
            curves = curves_figure(seen, output, classes(seen, output))
            figures.append(Shown(f"{output.name}-curves", curves, _CURVES))
            if seen.method == "grid" and _makes_a_plane(seen.setup.parameters):
                figures.append(Shown(f"{output.name}-contours", contours_figure(seen, output), _CONTOURS))
        texts = texts or [f"There are no effects yet: {of_output['none_because']}."]
        found.append(Section(output_label(output), texts, figures, tables))
    return found


def _makes_a_plane(parameters: Sequence[Parameter]) -> bool:
    return len(parameters) == 2 and all(p.levels >= _LEAST_LEVELS and p.distribution.kind != "choice" for p in parameters)


def _sentence(parameters: Sequence[Parameter], effects: dict[str, Any]) -> str:
    told = [parameters[i].name for i in ranked(numbers(effects["coefficient"])) if effects["told_from_seeds"][i]]
    described = ""
    if effects["r2"] is not None:
        weak = "" if effects["r2"] >= _LEAST_R2 else "; much of it is not monotone, or an interaction, or the seeds"
        described = f"The rank regression describes {percent(effects['r2'])} of the ranks' variance{weak}."
    share = effects["seed_share"]
    said = [f"{effects['points']} complete points.", told_sentence(told, share), described, seed_sentence(share)]
    return " ".join(filter(None, said))


def told_sentence(names: Sequence[str], share: dict[str, Any]) -> str:
    """Returns which parameters' effects are told from the seeds."""
    if share["seeds"] < LEAST:
        return f"With fewer than {LEAST} seeds it is not known which effects are told from the seeds."
    return f"Told from the seeds: {listed(names)}." if names else "No parameter's effect is told from the seeds."


def are_grey(effects: dict[str, Any], order: Sequence[int]) -> list[bool]:
    """Returns which parameters have effects that are not told from the seeds; none where nothing is known of that."""
    told = effects.get("told_from_seeds")
    return [told is not None and told[i] is False for i in order]


def told_cell(is_told: bool | None) -> str:
    """Returns the cell of a table that says whether an effect is told."""
    return "unknown" if is_told is None else "yes" if is_told else "no"


def seed_sentence(share: dict[str, Any]) -> str:
    """Returns the seed's share of the variance; empty where it is not known."""
    if share["mean"] is None:
        return ""
    return (f"The seed's share of the variance is {percent(share['mean'])} in the means over {share['seeds']} seeds, "
            f"and {percent(share['single'])} in single runs.")


def ranked(values: Array) -> list[int]:
    """Returns places from the largest absolute value to the least; those without one last."""
    return [int(i) for i in np.argsort(-np.nan_to_num(np.abs(values), nan=-1.0), kind="stable")]


def _table(parameters: Sequence[Parameter], effects: dict[str, Any]) -> PageTable:
    rows = []
    order = ranked(numbers(effects["coefficient"]))
    for i in order:
        rows.append([parameter_label(parameters[i]),
                     *(cell for what in ("coefficient", "correlation") for cell in (
                         number(effects[what][i], 2),
                         between(effects[f"{what}_low"][i], effects[f"{what}_high"][i], 2))),
                     number(effects["standard_error"][i], 2), told_cell(effects["told_from_seeds"][i])])
    return PageTable(["parameter", "coefficient", "95 % interval", "correlation", "95 % interval",
                      "standard error from the seeds", "told from the seeds"], rows,
                     faint=frozenset(np.flatnonzero(are_grey(effects, order))))


@matplotlib.rc_context(style.STYLE)
def effects_figure(parameters: Sequence[Parameter], effects: dict[str, Any]) -> Figure:
    """Draws the coefficient and correlation of each parameter, ranked, and the seed's."""
    order = ranked(numbers(effects["coefficient"]))
    seeds = [(name, _root(bar)) for name, bar in seed_bars(effects["seed_share"])]
    figure = style.new_figure(1.0 + BAR * (len(order) + len(seeds)), 5.0)
    axes = figure.subplots()
    grey = are_grey(effects, order)
    for at, i in enumerate(order):
        value, low, high = (numbers(effects[f"coefficient{end}"])[i] for end in ("", "_low", "_high"))
        draw_bar(axes, at, Bar(value, low, high, NOT_TOLD if grey[at] else style.BLUE))
        axes.plot(numbers(effects["correlation"])[i], at, "D", color="white", markeredgecolor=style.BLACK,
                  markersize=4.0, markeredgewidth=0.8, zorder=4)
    for at, (_, bar) in enumerate(seeds, start=len(order)):
        draw_bar(axes, at, bar)
    axes.axvline(0.0, color=style.BLACK, linewidth=0.6)
    name_bars(axes, [parameters[i].name for i in order] + [name for name, _ in seeds], grey)
    axes.set_xlim(min(-0.05, *_ends(axes)), max(1.0, *_ends(axes)))
    axes.set_xlabel("Standardised rank regression coefficient")
    handles: list[Any] = [Line2D([], [], marker="D", linestyle="", color="white", markeredgecolor=style.BLACK,
                                 markersize=4.0, label="Spearman's correlation"), seed_patch("seed: root of its share")]
    legend_above(figure, handles + ([grey_patch()] if any(grey) else []))
    return figure


def _root(bar: Bar) -> Bar:
    value, low, high = np.sqrt(np.maximum([bar.value, bar.low, bar.high], 0.0))
    return Bar(value, low, high, SEED, SEED_HATCH)


def _ends(axes: Axes) -> tuple[float, float]:
    low, high = axes.get_xlim()
    return max(low, -1.05), min(high, 1.05)


@dataclass(frozen=True)
class ResponseCurve:
    """A response to one parameter; arrays of shape (places,), the interval where there is one."""

    u: Array
    y: Array
    low: Array | None = None
    high: Array | None = None


def classes(seen: Seen, output: Output, points: Any = slice(None)) -> list[ResponseCurve]:
    """Returns means by classes of each parameter, of some points or all."""
    means = seen.means(output.name)[points]
    found = [main_effects.curve(u, means, count=p.distribution.count)
             for u, p in zip(seen.asked[points].T, seen.setup.parameters)]
    return [ResponseCurve(c.u, c.mean, c.low, c.high) for c in found]


@matplotlib.rc_context(style.STYLE)
def curves_figure(seen: Seen, output: Output, curves: Sequence[ResponseCurve], is_smooth: bool = False) -> Figure:
    """Draws a panel for each parameter, all with the same ordinate. is_smooth: lines alone, of a surrogate."""
    figure, every = panels(len(curves))
    means = seen.means(output.name)
    for axes, parameter, curve, u in zip(every, seen.setup.parameters, curves, seen.u.T):
        draw_scatter(axes, places(parameter, u), means)
        x = places(parameter, curve.u)
        if curve.low is not None and curve.high is not None and not is_smooth:
            known = np.isfinite(curve.low)  # of one point there is no interval
            axes.errorbar(x[known], curve.y[known], [(curve.y - curve.low)[known], (curve.high - curve.y)[known]],
                          fmt="none", color=style.BLUE, linewidth=0.9, capsize=2.0)
        elif curve.low is not None:
            axes.fill_between(x, curve.low, curve.high, color=style.BLUE, alpha=0.2, linewidth=0.0)
        is_line = parameter.distribution.kind != "choice"
        axes.plot(x, curve.y, "-" if is_smooth else "o-" if is_line else "o", color=style.BLUE, markersize=3.5,
                  linewidth=1.4 if is_smooth else 0.9,
                  drawstyle="steps-mid" if is_smooth and not is_line else "default")
        along(axes, parameter)
    _share_ordinate(every, output)
    return figure


def _share_ordinate(every: Sequence[Axes], output: Output) -> None:
    low, high = min(a.get_ylim()[0] for a in every), max(a.get_ylim()[1] for a in every)
    for axes in every:
        axes.set_ylim(low, high)
        if axes.get_subplotspec().is_first_col():
            axes.set_ylabel(output_label(output))
        else:
            axes.tick_params(labelleft=False)


@matplotlib.rc_context(style.STYLE)
def contours_figure(seen: Seen, output: Output) -> Figure:
    """Draws contours over the plane of two parameters."""
    figure = style.new_figure(3.0, 4.2)
    axes = figure.subplots()
    first, second = seen.setup.parameters
    z = seen.means(output.name)
    x, y = places(first, seen.u[:, 0]), places(second, seen.u[:, 1])
    known = np.isfinite(z)
    across, up = np.unique(x), np.unique(y)
    table = np.full((len(up), len(across)), np.nan)
    table[np.searchsorted(up, y), np.searchsorted(across, x)] = z
    if np.unique(z[known]).size > 1:
        filled = axes.contourf(across, up, table, 10, cmap="cividis")
        figure.colorbar(filled, ax=axes, label=output_label(output))
    axes.plot(x[known], y[known], "o", color="white", markeredgecolor=style.BLACK, markersize=3.0, markeredgewidth=0.6,
              clip_on=False, zorder=4)
    axes.plot(x[~known], y[~known], "x", color=style.BLACK, markersize=4.0, clip_on=False, zorder=4)
    axes.grid(visible=False)
    along(axes, first)
    along(axes, second, vertical=True)
    return figure
