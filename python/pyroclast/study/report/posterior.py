"""Report of what targets tell of parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ...draw import style
from ..methods.calibration import NOT_DETERMINED
from ..parameters import Parameter
from .drawing import (BAR, NOT_TOLD, along, ends, grey_patch, legend_above, name_bars, output_label, parameter_label,
                      places, value_text)
from .responses import ranked
from .section import PageTable, Section, Shown
from .seen import Array, Seen, listed, number, numbers, percent

_MOST_PAIRS = 6  # parameters of a pairs plot
_MOST_DRAWN = 2000  # draws in a panel
_BINS = 25

_MEANING = ("The posterior is the part of the ranges that the targets leave: values that the surrogates take to the "
            "targets within the scatter of the seeds, the sd of the experiment and the surrogates' error. A parameter "
            f"is not determined where its standard deviation is above {NOT_DETERMINED:g} of that of its range.")
_PAIRS_CAPTION = "Draws of the posterior: each parameter alone (line: the prior) and in pairs. Grey: not determined."
_SPREAD_CAPTION = ("Posterior standard deviation over the prior's, both as shares of the range; at 1 the targets say "
                   "nothing. Grey: not determined.")
_CHECK = ("Runs at draws of the posterior, against the surrogates' predictions, in standard deviations of that "
          "difference. Where the surrogates hold, 95 % lie within ± 2.")
_CHECK_CAPTION = "True runs minus predictions at draws of the posterior, in standard deviations; band: ± 2."


def sections(seen: Seen) -> list[Section]:
    found = seen.findings
    if found is None:
        return []
    posterior, parameters = found["posterior"], seen.setup.parameters
    chain, free = numbers(posterior["chain"]), [bool(f) for f in posterior["not_determined"]]
    named = [p.name for p, is_free in zip(parameters, free) if is_free]
    said = f"Not determined: {listed(named)}." if named else "The targets determine all parameters."
    chosen = sorted(ranked(-numbers(posterior["sd_ratio"]))[::-1][:_MOST_PAIRS])
    left_out = len(parameters) - len(chosen)
    caption = _PAIRS_CAPTION + (f" The {left_out} least determined parameters are not drawn." if left_out else "")
    figures = [Shown("posterior", pairs_figure(parameters, chain, free, chosen), caption),
               Shown("spread", spread_figure(parameters, posterior), _SPREAD_CAPTION)]
    convergence = f"The chain: {posterior['statement']}."
    made = [Section("Posterior", [said, _MEANING, convergence], figures,
                    [_table(parameters, posterior, chain), _surrogates(seen, found)])]
    if found.get("check"):
        made.append(_of_check(found["targets"]["names"], found["check"]))
    return made


def _table(parameters: Sequence[Parameter], posterior: dict[str, Any], chain: Array) -> PageTable:
    rows = []
    for i, parameter in enumerate(parameters):
        low, middle, high = (value_text(parameter, parameter.distribution.at(float(u)))
                             for u in np.percentile(chain[:, i], [2.5, 50.0, 97.5]))
        rows.append([parameter_label(parameter), middle, f"{low} to {high}", number(posterior["sd_ratio"][i], 2),
                     "no" if posterior["not_determined"][i] else "yes"])
    faint = frozenset(i for i, free in enumerate(posterior["not_determined"]) if free)
    return PageTable(["parameter", "median", "95 % of the draws", "sd over the prior's", "determined"], rows,
                     faint=faint)


def _surrogates(seen: Seen, found: dict[str, Any]) -> PageTable:
    labels = {o.name: output_label(o) for o in seen.setup.outputs}
    targets = found["targets"]
    columns = zip(targets["names"], targets["values"], targets["sd"], found["q2"], found["own_q2"], found["error"])
    rows = [[labels[name], number(value), number(sd, 3), number(q2, 3), number(own_q2, 3), number(error, 3)]
            for name, value, sd, q2, own_q2, error in columns]
    return PageTable(["target", "value", "sd of the experiment", "Q² of its surrogate", "without the seeds' scatter",
                      "error of its surrogate"], rows)


@matplotlib.rc_context(style.STYLE)
def pairs_figure(parameters: Sequence[Parameter], chain: Array, free: Sequence[bool], chosen: Sequence[int]) -> Figure:
    """Draws marginals on the diagonal, pairs below it."""
    k = len(chosen)
    side = min(style.WIDTH, 1.3 + 1.25 * k) if k > 1 else 3.6
    figure = style.new_figure(side if k > 1 else 2.4, side)
    every = figure.subplots(k, k, squeeze=False, sharex="col")
    thin = np.random.default_rng(0).permutation(len(chain))[:_MOST_DRAWN]
    drawn = [places(parameters[i], chain[thin, i]) for i in chosen]
    for row in range(k):
        for column in range(k):
            axes = every[row, column]
            if column > row:
                axes.remove()
            elif column == row:
                _draw_marginal(axes, parameters[chosen[row]], drawn[row], free[chosen[row]])
                if k > 1:
                    axes.set_title(style.plain(parameters[chosen[row]].name), fontsize=8.0)
            else:
                grey = free[chosen[row]] and free[chosen[column]]
                axes.plot(drawn[column], drawn[row], "o", markersize=1.2, alpha=0.35, markeredgewidth=0.0,
                          rasterized=True, color=style.FAINT if grey else style.BLUE)
                along(axes, parameters[chosen[row]], vertical=True, label=column == 0)
                axes.tick_params(labelleft=column == 0)
                axes.set_ylim(*ends(parameters[chosen[row]]))
            if column <= row:
                along(axes, parameters[chosen[column]], label=row == k - 1)
                axes.tick_params(labelbottom=row == k - 1)
                axes.set_xlim(*ends(parameters[chosen[column]]))
                axes.tick_params(axis="x", rotation=45 if k > 3 else 0)
    figure.align_labels()
    return figure


def _draw_marginal(axes: Axes, parameter: Parameter, values: Array, is_free: bool) -> None:
    prior = places(parameter, (np.arange(_MOST_DRAWN) + 0.5) / _MOST_DRAWN)
    low, high = ends(parameter)
    is_log = parameter.distribution.kind == "log_uniform"
    bins = np.geomspace(low, high, _BINS + 1) if is_log else np.linspace(low, high, _BINS + 1)
    share, of_prior = (np.full(len(draws), 1.0 / len(draws)) for draws in (values, prior))
    axes.hist(values, bins, weights=share, color=NOT_TOLD if is_free else style.SKY)
    axes.hist(prior, bins, weights=of_prior, histtype="step", color=style.BLACK, linewidth=0.8)
    axes.set_yticks([])
    axes.grid(visible=False)
    axes.spines["left"].set_visible(False)


@matplotlib.rc_context(style.STYLE)
def spread_figure(parameters: Sequence[Parameter], posterior: dict[str, Any]) -> Figure:
    """Draws how much narrower than its range each parameter has become."""
    order = ranked(-numbers(posterior["sd_ratio"]))[::-1]
    free = [bool(posterior["not_determined"][i]) for i in order]
    figure = style.new_figure(0.9 + BAR * len(order), 4.6)
    axes = figure.subplots()
    axes.barh(range(len(order)), numbers(posterior["sd_ratio"])[order], 0.7,
              color=[NOT_TOLD if is_free else style.BLUE for is_free in free])
    axes.axvline(NOT_DETERMINED, color=style.VERMILLION, linewidth=1.0)
    axes.axvline(1.0, color=style.BLACK, linewidth=0.6)
    name_bars(axes, [parameters[i].name for i in order], free)
    axes.set_xlim(0.0, max(1.05, axes.get_xlim()[1]))
    axes.set_xlabel("Posterior standard deviation over the prior's")
    if any(free):
        legend_above(figure, [grey_patch("not determined")])
    return figure


def _of_check(names: Sequence[str], check: dict[str, Any]) -> Section:
    rows = [[name, str(n), number(rms, 2), percent(within)]
            for name, n, rms, within in zip(names, check["points"], check["rms"], check["within_two"])]
    table = PageTable(["target", "true runs", "root mean square", "within ± 2"], rows)
    figure = check_figure(names, numbers(check["standardised"]))
    return Section("True runs", [_CHECK], [Shown("check", figure, _CHECK_CAPTION)], [table])


@matplotlib.rc_context(style.STYLE)
def check_figure(names: Sequence[str], standardised: Array) -> Figure:
    """Draws differences of each true run. standardised: (runs, targets)."""
    figure = style.new_figure(0.8 + BAR * len(names), 4.6)
    axes = figure.subplots()
    axes.axvspan(-2.0, 2.0, color=style.GREEN, alpha=0.15, linewidth=0.0)
    axes.axvline(0.0, color=style.BLACK, linewidth=0.6)
    for at, values in enumerate(standardised.T):
        axes.plot(values, np.full(len(values), at), "o", color=style.BLUE, markersize=4.0, alpha=0.7,
                  markeredgewidth=0.0)
    name_bars(axes, names)
    reach = max(3.0, 1.1 * float(np.nanmax(np.abs(standardised), initial=0.0)))
    axes.set_xlim(-reach, reach)
    axes.set_xlabel("True run minus prediction [standard deviations]")
    return figure
