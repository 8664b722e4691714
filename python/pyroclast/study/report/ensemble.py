"""Report of one point with many seeds."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy import stats

from ...draw import style
from ..methods import ensemble
from ..outputs import Output
from .drawing import output_label
from .section import PageTable, Section, Shown, nothing
from .seen import Array, Seen, between, number, numbers, percent

_MEANING = ("Each run has its own random specimen. The sd is that of single runs; the 95 % interval says where the "
            "mean of very many seeds would lie (Student's t).")
_SHARE = 0.1  # of the mean: half of an interval that is narrow enough
_CAPTION = ("Left: the runs in the order of their values, against the share of runs below them, and a normal "
            "distribution of the same mean and sd. Right: the mean of the first runs and its 95 % interval, over how "
            "many they are. Vermilion: the mean of all and its 95 % interval.")


def sections(seen: Seen) -> list[Section]:
    found = []
    for output in seen.setup.outputs:
        summary = seen.of_outputs().get(output.name)
        if summary is None or not summary.get("n"):
            reasons = seen.missing[output.name]
            why = (summary or {}).get("none_because", reasons[0] if reasons else "no run has a value")
            found.append(nothing(output_label(output), str(why)))
            continue
        values = numbers(row[output.name] for row in seen.rows)
        values = values[np.isfinite(values)]
        shown = Shown(f"{output.name}-seeds", _figure(output, values, summary), _CAPTION)
        found.append(Section(output_label(output), [_sentence(summary)], [shown]))
    found.append(Section("Numbers", [_MEANING], tables=[_table(seen)]))
    return found


def _sentence(summary: dict[str, Any]) -> str:
    if summary["n"] < 2:
        return f"One run alone: {number(summary['mean'])}. Its scatter is not known."
    half = 0.5 * (summary["high"] - summary["low"])
    relative = f" (± {percent(half / abs(summary['mean']))})" if summary["mean"] else ""
    lost = summary["missing"]
    missing = f" {lost} {'runs' if lost > 1 else 'run'} gave no value." if lost else ""
    wanted = ensemble.seeds_for(_SHARE, summary["variation"] or np.nan)
    is_short = wanted is not None and wanted > summary["n"]
    more = f" If they go on so, {wanted} seeds give the mean ± {percent(_SHARE)}." if is_short else ""
    return (f"The mean of {summary['n']} seeds is {number(summary['mean'])}, 95 % interval "
            f"{between(summary['low'], summary['high'])}{relative}. Single runs scatter by "
            f"{number(summary['sd'], 3)} (sd), which is {percent(summary['variation'])} of the mean.{more}{missing}")


def _table(seen: Seen) -> PageTable:
    rows = []
    names: list[str] = []
    for output in seen.setup.outputs:
        s = seen.of_outputs().get(output.name, {})
        if "n" not in s:
            continue
        names = list(s["percentiles"])
        rows.append([output_label(output), str(s["n"]), str(s["missing"]), number(s["mean"]),
                     between(s["low"], s["high"]), number(s["sd"], 3), percent(s["variation"]),
                     *(number(s["percentiles"][p]) for p in names)])
    return PageTable(["output", "runs", "without a value", "mean", "95 % interval of the mean", "sd", "cv",
                      *(f"{float(p):g} % of runs below" for p in names)], rows)


@matplotlib.rc_context(style.STYLE)
def _figure(output: Output, values: Array, summary: dict[str, Any]) -> Figure:
    figure = style.new_figure(2.4)
    left, right = figure.subplots(1, 2)
    _draw_distribution(left, values, summary)
    left.set_xlabel(output_label(output))
    _draw_running_mean(right, values)
    right.set_ylabel(output_label(output))
    return figure


def _draw_distribution(axes: Axes, values: Array, summary: dict[str, Any]) -> None:
    n = len(values)
    if n > 1 and summary["sd"]:
        x = np.linspace(values.min() - summary["sd"], values.max() + summary["sd"], 200)
        axes.plot(x, stats.norm.cdf(x, summary["mean"], summary["sd"]), color=style.FAINT, linewidth=1.0)
        axes.axvspan(summary["low"], summary["high"], color=style.VERMILLION, alpha=0.2, linewidth=0.0)
    axes.axvline(summary["mean"], color=style.VERMILLION)
    axes.plot(np.sort(values), (np.arange(n) + 0.5) / n, "o", color=style.BLUE, markersize=3.5)
    axes.set_ylim(0.0, 1.0)
    axes.set_ylabel("Share of runs below")


def _draw_running_mean(axes: Axes, values: Array) -> None:
    count = np.arange(1, len(values) + 1)
    axes.plot(count, values, "o", color=style.FAINT, markersize=3.0, markeredgewidth=0.0, label="single runs")
    # Of two runs the interval is so wide that nothing else could be seen.
    margin = 0.3 * (values.max() - values.min()) or 0.05 * abs(values[0]) or 1.0
    axes.set_ylim(values.min() - margin, values.max() + margin)
    if len(values) > 1:
        running = [ensemble.summary(values[:n]) for n in count]
        axes.fill_between(count, [s.low for s in running], [s.high for s in running], color=style.VERMILLION, alpha=0.2,
                          linewidth=0.0)
        axes.plot(count, [s.mean for s in running], color=style.VERMILLION)
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.set_xlabel("Runs")
