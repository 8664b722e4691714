"""Reports of Morris' method, Sobol' indices and polynomial chaos."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ...draw import style
from ..methods.surrogate import LEAST_Q2
from ..outputs import Output
from ..parameters import Parameter
from .drawing import (BAR, NOT_TOLD, Bar, draw_bar, grey_patch, legend_above, name_bars, output_label, parameter_label,
                      seed_bars, seed_patch)
from .responses import ResponseCurve, are_grey, classes, curves_figure, ranked, seed_sentence, told_cell, told_sentence
from .section import PageTable, Section, Shown, how_to_read, nothing
from .seen import Seen, between, number, numbers, percent

_FIRST, _TOTAL = style.SKY, style.BLUE
_DEPENDS = 0.05  # p-value up to which an output depends on a parameter

_MORRIS = ("μ* is the mean size of a parameter's effect over its whole range, in the output's unit, and σ their "
           "standard deviation: σ well below μ* is an effect that is much the same everywhere, σ about μ* or above "
           "one that bends or depends on other parameters. An effect is told from the seeds where its interval is "
           "above the μ* that seeds alone give.")
_MORRIS_CAPTION = ("Left: μ* with 95 % interval (bootstrap over the trajectories), ranked; the vermilion ticks are "
                   "what seeds alone give, at most; below, the seed's share of the variance. Right: μ* and σ; the "
                   "numbers stand for the bars, and on the dashed line σ = μ*. Grey: not told from the seeds.")
_SHARES = ("The main index of a parameter is the share of the variance that goes when this parameter alone is known; "
           "the total index is the share that stays when all others are known. Their difference are interactions.")
_SOBOL_CAPTION = ("Main and total indices of the mean over seeds with 95 % intervals (bootstrap over the rows), "
                  "ranked, and the seed's share of the variance. Grey: not told from the seeds.")
_CHAOS_CAPTION = ("Main and total indices of the surrogate with 95 % intervals (bootstrap over the runs that it was "
                  "fitted to), ranked, and the seed's share of the variance of the runs.")
_CURVES_CHAOS = ("Response of the surrogate to one parameter, all others in the middle of their ranges, ± its error "
                 "on runs kept apart; grey dots: means over seeds of all runs, where the others vary too.")
_CURVES_SOBOL = ("Means over seeds of all points (grey dots), and the mean of the independent ones by classes of one "
                 "parameter with its 95 % interval (Student's t over the points, all other parameters vary).")
_DEPENDENCE = ("The parameters are correlated, so that shares of the variance do not add up. R² of the "
               "Hilbert-Schmidt criterion is 0 for a parameter that the output does not depend on, and at most 1; a "
               "parameter that is only correlated with one that has an effect shows dependence too.")
_DEPENDENCE_CAPTION = ("Dependence on each parameter with 95 % intervals, and the seed's share of the variance. Grey: "
                       f"not told from independence (p above {_DEPENDS:g}).")


def sections(seen: Seen) -> list[Section]:
    of_method = {"morris": _of_morris, "sobol": _of_sobol, "chaos": _of_chaos}[seen.method]
    meaning = _MORRIS if seen.method == "morris" else _DEPENDENCE if seen.setup.correlations else _SHARES
    found = [how_to_read(meaning)]
    for output in seen.setup.outputs:
        of_output = seen.of_outputs().get(output.name, {"none_because": "no point is complete"})
        if set(of_output) == {"none_because"}:
            found.append(nothing(output_label(output), of_output["none_because"]))
        else:
            found.append(of_method(seen, output, of_output))
    return found


def _of_morris(seen: Seen, output: Output, found: dict[str, Any]) -> Section:
    effects, share, parameters = found["effects"], found["seed_share"], seen.setup.parameters
    title = output_label(output)
    mu_star = numbers(effects["mu_star"])
    if not np.isfinite(mu_star).any():
        return nothing(title, "no step of a trajectory has both ends")
    order = ranked(mu_star)
    told = [parameters[i].name for i in order if effects["told_from_seeds"][i]]
    dropped = [f"{parameters[i].name} {effects['planned'] - used}" for i, used in enumerate(effects["used"])
               if used < effects["planned"]]
    said = [f"{effects['planned']} trajectories.",
            told_sentence(told, share), seed_sentence(share),
            f"Steps that drop out for a missing value: {', '.join(dropped)}." if dropped else ""]
    rows = [[str(at + 1), parameter_label(parameters[i]), number(mu_star[i], 3),
             between(effects["mu_star_low"][i], effects["mu_star_high"][i], 3), number(effects["mu"][i], 3),
             number(effects["sigma"][i], 3), number(effects["from_seeds"][i], 2),
             told_cell(effects["told_from_seeds"][i]), f"{effects['used'][i]} of {effects['planned']}"]
            for at, i in enumerate(order)]
    table = PageTable(["", "parameter", "μ*", "95 % interval", "μ", "σ", "of seeds alone",
                       "told from the seeds", "effects used"], rows,
                      faint=frozenset(np.flatnonzero(are_grey(effects, order))))
    shown = Shown(f"{output.name}-morris", morris_figure(output, parameters, effects, share), _MORRIS_CAPTION)
    return Section(title, [" ".join(filter(None, said))], [shown], [table])


@matplotlib.rc_context(style.STYLE)
def morris_figure(output: Output, parameters: Sequence[Parameter], effects: dict[str, Any],
                  share: dict[str, Any]) -> Figure:
    """Draws ranked effects and the seed's share, beside effects and what they vary by."""
    order = ranked(numbers(effects["mu_star"]))
    grey = are_grey(effects, order)
    seeds = seed_bars(share)
    figure = style.new_figure(max(3.0, 1.7 + BAR * (len(order) + len(seeds))))
    grid = figure.add_gridspec(2, 2, height_ratios=[len(order) + 0.6, len(seeds) + 0.6], width_ratios=[1.1, 1.0])
    bars, strip, plane = (figure.add_subplot(place) for place in (grid[0, 0], grid[1, 0], grid[:, 1]))
    value, low, high = (numbers(effects[f"mu_star{end}"]) for end in ("", "_low", "_high"))
    alone = numbers(effects["from_seeds"])
    for at, i in enumerate(order):
        draw_bar(bars, at, Bar(value[i], low[i], high[i], NOT_TOLD if grey[at] else style.BLUE))
        if np.isfinite(alone[i]):
            bars.plot(np.full(2, alone[i]), [at - 0.42, at + 0.42], color=style.VERMILLION, linewidth=1.2)
    name_bars(bars, [f"{parameters[i].name} ({at + 1})" for at, i in enumerate(order)], grey)
    bars.set_xlim(left=0.0)
    bars.set_xlabel(f"μ* of {output_label(output)}")
    for at, (_, bar) in enumerate(seeds):
        draw_bar(strip, at, bar)
    name_bars(strip, [name for name, _ in seeds])
    strip.set_xlim(0.0, 1.0)
    strip.set_xlabel("Share of the variance")
    _draw_plane(plane, order, grey, effects)
    plane.set_xlabel(f"μ* of {output_label(output)}")
    plane.set_ylabel(f"σ of {output_label(output)}")
    if any(grey):
        legend_above(figure, [grey_patch()])
    return figure


def _draw_plane(axes: Axes, order: Sequence[int], grey: Sequence[bool], effects: dict[str, Any]) -> None:
    mu_star, sigma = numbers(effects["mu_star"]), numbers(effects["sigma"])
    right, top = 1.1 * np.nanmax(mu_star) or 1.0, 1.15 * np.nanmax(np.nan_to_num(sigma)) or 1.0
    axes.plot([0.0, right], [0.0, right], color=style.FAINT, linewidth=0.8, linestyle=(0, (4, 2)), scalex=False,
              scaley=False)
    for at, i in reversed(list(enumerate(order))):
        colour = NOT_TOLD if grey[at] else style.BLUE
        axes.plot(mu_star[i], sigma[i], "o", color=colour, markersize=10.0, markeredgecolor="white",
                  markeredgewidth=0.6, clip_on=False, zorder=3.0 - 0.01 * at)
        axes.annotate(str(at + 1), (mu_star[i], sigma[i]), ha="center", va="center_baseline", fontsize=6.5,
                      color=style.BLACK if grey[at] else "white", zorder=3.005 - 0.01 * at, annotation_clip=False)
    axes.set_xlim(0.0, right)
    axes.set_ylim(0.0, max(top, 0.15 * right))


def _of_sobol(seen: Seen, output: Output, found: dict[str, Any]) -> Section:
    parameters = seen.setup.parameters
    order = ranked(numbers(found["total"]))
    told = [parameters[i].name for i in order if found["told_from_seeds"][i]]
    share = found["seed_share"]
    lost = f"{percent(found['lost'])} of the rows are lost by runs without a value." if found["lost"] else ""
    said = [f"{found['rows']} rows.", lost, told_sentence(told, share), seed_sentence(share), _interactions(found)]
    # The points A and B of each row; all others share coordinates with them.
    independent = np.arange(len(seen.u)) % (len(parameters) + 2) < 2
    curves = classes(seen, output, independent)
    figures = [Shown(f"{output.name}-indices", indices_figure(parameters, found, share), _SOBOL_CAPTION),
               Shown(f"{output.name}-curves", curves_figure(seen, output, curves),
                     _CURVES_SOBOL)]
    return Section(output_label(output), [" ".join(filter(None, said))], figures,
                   [_index_table(parameters, found, order)])


def _interactions(indices: dict[str, Any]) -> str:
    total = float(np.nansum(numbers(indices["first"])))
    return f"The main indices add up to {number(total, 2)}; the rest to 1 are interactions, and their error."


def _index_table(parameters: Sequence[Parameter], indices: dict[str, Any], order: Sequence[int]) -> PageTable:
    knows = "told_from_seeds" in indices
    rows = [[parameter_label(parameters[i]),
             *(cell for what in ("first", "total") for cell in (
                 number(indices[what][i], 3), between(indices[f"{what}_low"][i], indices[f"{what}_high"][i], 3))),
             *([number(indices["from_seeds"][i], 2), told_cell(indices["told_from_seeds"][i])] if knows else [])]
            for i in order]
    return PageTable(["parameter", "main", "95 % interval", "total", "95 % interval",
                      *(["total of seeds alone", "told from the seeds"] if knows else [])], rows,
                     faint=frozenset(np.flatnonzero(are_grey(indices, order))))


@matplotlib.rc_context(style.STYLE)
def indices_figure(parameters: Sequence[Parameter], indices: dict[str, Any], share: dict[str, Any]) -> Figure:
    """Draws the main and total index of each parameter, ranked, and the seed's share."""
    order = ranked(numbers(indices["total"]))
    grey = are_grey(indices, order)
    seeds = seed_bars(share)
    figure = style.new_figure(1.0 + 1.3 * BAR * (len(order) + len(seeds)), 5.0)
    axes = figure.subplots()
    lowest = 0.0
    for at, i in enumerate(order):
        for what, colour, side in (("first", _FIRST, -0.19), ("total", _TOTAL, 0.19)):
            value, low, high = (numbers(indices[f"{what}{end}"])[i] for end in ("", "_low", "_high"))
            draw_bar(axes, at + side, Bar(value, low, high, NOT_TOLD if grey[at] else colour), 0.36)
            lowest = min(lowest, value, low)
    for at, (_, bar) in enumerate(seeds, start=len(order)):
        draw_bar(axes, at, bar, 0.5)
    name_bars(axes, [parameters[i].name for i in order] + [name for name, _ in seeds], grey)
    axes.axvline(0.0, color=style.BLACK, linewidth=0.6)
    axes.set_xlim(min(-0.01, 1.05 * lowest), max(1.0, axes.get_xlim()[1]))
    axes.set_xlabel("Share of the variance")
    handles = [Patch(color=_FIRST, label="main"), Patch(color=_TOTAL, label="total"), seed_patch()]
    legend_above(figure, handles + ([grey_patch()] if any(grey) else []))
    return figure


def _of_chaos(seen: Seen, output: Output, found: dict[str, Any]) -> Section:
    parameters, share = seen.setup.parameters, found["seed_share"]
    unit = output_label(output)
    lost = found["lost"]
    said = [f"The surrogate has {found['terms']} terms up to degree {found['degree']}. On runs kept apart its Q² is "
            f"{number(found['q2'], 3)} and its error {number(found['error'], 3)} (root mean square, in the unit of "
            f"{unit}). The seeds' scatter is in both; without it Q² is {number(found['own_q2'], 3)} and the error "
            f"{number(found['own_error'], 3)}.",
            f"{lost} {'points are' if lost > 1 else 'point is'} left out for a missing value." if lost else "",
            seed_sentence(share)]
    if "dependence" in found:
        return _of_dependence(parameters, output, found, " ".join(filter(None, said)))
    if "indices" not in found:
        return Section(unit, [" ".join(filter(None, said)), f"There are no indices: {found['none_because']}.",
                              f"Q² is 1 for a surrogate without error; below {LEAST_Q2:g}, without the seeds' "
                              "scatter, it says too little."])
    indices = found["indices"]
    error = found["error"]
    curves = [ResponseCurve(numbers(c["u"]), y, y - error, y + error)
              for c in found["curves"] for y in [numbers(c["y"])]]
    figures = [Shown(f"{output.name}-indices", indices_figure(parameters, indices, share), _CHAOS_CAPTION),
               Shown(f"{output.name}-curves", curves_figure(seen, output, curves, is_smooth=True), _CURVES_CHAOS)]
    order = ranked(numbers(indices["total"]))
    return Section(unit, [" ".join(filter(None, [*said, _interactions(indices)]))], figures,
                   [_index_table(parameters, indices, order)])


def _of_dependence(parameters: Sequence[Parameter], output: Output, found: dict[str, Any], said: str) -> Section:
    dependence = found["dependence"]
    order = ranked(numbers(dependence["r2"]))
    rows = [[parameter_label(parameters[i]), number(dependence["r2"][i], 2),
             between(dependence["r2_low"][i], dependence["r2_high"][i], 2), number(dependence["p_value"][i], 2)]
            for i in order]
    faint = frozenset(at for at, i in enumerate(order) if not _depends(dependence, i))
    table = PageTable(["parameter", "R²", "95 % interval", "p of independence"], rows, faint=faint)
    figure = dependence_figure(parameters, dependence, found["seed_share"])
    return Section(output_label(output), [said],
                   [Shown(f"{output.name}-dependence", figure, _DEPENDENCE_CAPTION)], [table])


def _depends(dependence: dict[str, Any], i: int) -> bool:
    return dependence["p_value"][i] is not None and dependence["p_value"][i] <= _DEPENDS


@matplotlib.rc_context(style.STYLE)
def dependence_figure(parameters: Sequence[Parameter], dependence: dict[str, Any], share: dict[str, Any]) -> Figure:
    """Draws R² of each parameter, ranked, and the seed's share."""
    order = ranked(numbers(dependence["r2"]))
    depends = [_depends(dependence, i) for i in order]
    seeds = seed_bars(share)
    figure = style.new_figure(1.0 + BAR * (len(order) + len(seeds)), 5.0)
    axes = figure.subplots()
    for at, i in enumerate(order):
        value, low, high = (numbers(dependence[f"r2{end}"])[i] for end in ("", "_low", "_high"))
        draw_bar(axes, at, Bar(value, low, high, style.BLUE if depends[at] else NOT_TOLD))
    for at, (_, bar) in enumerate(seeds, start=len(order)):
        draw_bar(axes, at, bar)
    name_bars(axes, [parameters[i].name for i in order] + [name for name, _ in seeds], [not d for d in depends])
    axes.axvline(0.0, color=style.BLACK, linewidth=0.6)
    axes.set_xlim(right=max(1.0, axes.get_xlim()[1]))
    axes.set_xlabel("R² of dependence; of the seed: share of the variance")
    legend_above(figure, [seed_patch()] + ([] if all(depends) else [grey_patch("not told from independence")]))
    return figure
