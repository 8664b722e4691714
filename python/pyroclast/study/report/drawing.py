"""What figures of studies have in common: axes of parameters and outputs, bars with intervals."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from ...draw import style
from ..outputs import Output
from ..parameters import Parameter, Value
from .seen import numbers

Array = NDArray[np.float64]
NOT_TOLD = "#cfcfcf"
"""The colour of effects that are not told from the seeds."""
SEED = style.ORANGE
SEED_HATCH = "////"
BAR = 0.26  # inches, of a figure's height
_LEGEND = 0.16  # the same
_WIDTHS = {1: 3.6, 2: 5.6}  # of a figure with so many panels in a row, inches
_SHOWN_UNITS = {"degC": "°C", "percent": "%", "um": "µm"}
_LONGEST_CHOICE = 12


def output_label(output: Output) -> str:
    """Returns the name and unit, where what it is taken from tells one."""
    if output.unit == "1":
        return output.name
    name = output.name.removesuffix(f"_{output.unit.replace('/', '_')}")
    return f"{name} [{_SHOWN_UNITS.get(output.unit, output.unit)}]"


def parameter_label(parameter: Parameter) -> str:
    """Returns the name and unit."""
    if parameter.unit:
        return style.plain(f"{parameter.name} [{_SHOWN_UNITS.get(parameter.unit, parameter.unit)}]")
    return f"{parameter.name} (factor)" if parameter.how == "scale" else parameter.name


def place(parameter: Parameter, u: float) -> float:
    """Returns the place of a number of the unit cube on an axis of the parameter's: its value, or how many choices
    stand before.
    """
    distribution = parameter.distribution
    if distribution.count is not None:
        first = 0.0 if distribution.kind == "choice" else distribution.numbers[0]
        return first + u * distribution.count - 0.5
    return float(distribution.at(u))


def places(parameter: Parameter, u: Any) -> Array:
    """Returns the places of several numbers."""
    return np.array([place(parameter, float(x)) for x in u])


def value_text(parameter: Parameter, value: Value) -> str:
    """Returns a value with its unit."""
    shown = f"{value:.4g}".replace("-", "−") if isinstance(value, float) else str(value)
    unit = _SHOWN_UNITS.get(parameter.unit, parameter.unit)
    return f"{shown} {unit}" if unit else shown


def along(axes: Axes, parameter: Parameter, vertical: bool = False, label: bool = True) -> None:
    """Makes an axis one of the parameter's values."""
    axis, name = (axes.yaxis, "y") if vertical else (axes.xaxis, "x")
    distribution = parameter.distribution
    if distribution.kind == "log_uniform":
        axes.set(**{f"{name}scale": "log"})
        low, high = distribution.numbers
        if high / low < 20.0:  # else the decades alone are labelled, of which there may be none
            at = np.unique([float(f"{value:.2g}") for value in np.geomspace(low, high, 4)])
            axis.set_ticks(at, [f"{value:g}" for value in at])
            axis.set_ticks([], minor=True)
    elif distribution.kind == "choice":
        axis.set_ticks(range(len(distribution.choices)),
                       [style.plain(textwrap.shorten(str(c), _LONGEST_CHOICE, placeholder="…"))
                        for c in distribution.choices])
        axes.set(**{f"{name}lim": ends(parameter)})
    elif distribution.kind == "integer":
        axis.get_major_locator().set_params(integer=True)
    if label:
        axes.set(**{f"{name}label": parameter_label(parameter)})


def ends(parameter: Parameter) -> tuple[float, float]:
    """Returns the ends of an axis that shows all of the parameter's range."""
    if parameter.distribution.count is not None:
        return place(parameter, 0.0), place(parameter, 1.0)
    low, high = parameter.distribution.ends()
    return float(low), float(high)


def panels(count: int, columns: int = 3, height: float = 2.0) -> tuple[Figure, list[Axes]]:
    """Makes a figure with so many axes, in rows of at most `columns`."""
    columns = min(count, columns)
    rows = -(-count // columns)
    figure = style.new_figure(height * rows + 0.1, _WIDTHS.get(columns, style.WIDTH))
    every = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes in every[count:]:
        axes.remove()
    return figure, every[:count]


@dataclass(frozen=True)
class Bar:
    """A number with its interval."""

    value: float
    low: float
    high: float
    colour: str
    hatch: str = ""


def draw_bar(axes: Axes, at: float, bar: Bar, thickness: float = 0.7) -> None:
    """Draws a lying bar. One without a value says so."""
    if not np.isfinite(bar.value):
        axes.annotate("no value", (0.0, at), xytext=(3, 0), textcoords="offset points", va="center", fontsize=7.0,
                      color=style.FAINT)
        return
    axes.barh(at, bar.value, thickness, color=bar.colour, hatch=bar.hatch, linewidth=0.0,
              edgecolor="white" if bar.hatch else bar.colour)
    if np.isfinite([bar.low, bar.high]).all():
        axes.plot([bar.low, bar.high], [at, at], color=style.BLACK, linewidth=0.9, marker="|", markersize=4.0,
                  markeredgewidth=0.9)


def name_bars(axes: Axes, names: Sequence[str], grey: Sequence[bool] = ()) -> None:
    """Names the bars from the top down; grey ones stand back."""
    axes.set_yticks(range(len(names)), [style.plain(name) for name in names])
    for label, is_grey in zip(axes.get_yticklabels(), grey):
        label.set_color(style.FAINT if is_grey else style.BLACK)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)


def seed_bars(share: dict[str, Any]) -> list[tuple[str, Bar]]:
    """Returns the seed as an entry of its own: its share of the variance of the mean, and of single runs."""
    n = share["seeds"]
    if n < 2:
        return [("seed (only one)", Bar(np.nan, np.nan, np.nan, SEED))]
    return [(f"seed, mean of {n}", _share_bar(share, "mean")), ("seed, single run", _share_bar(share, "single"))]


def _share_bar(share: dict[str, Any], of: str) -> Bar:
    value, low, high = numbers(share[key] for key in (of, f"{of}_low", f"{of}_high"))
    return Bar(value, low, high, SEED, SEED_HATCH)


def seed_patch(label: str = "the seed") -> Patch:
    """Returns the seed's handle for legends."""
    return Patch(facecolor=SEED, hatch=SEED_HATCH, edgecolor="white", linewidth=0.0, label=label)


def grey_patch(label: str = "not told from the seeds") -> Patch:
    return Patch(color=NOT_TOLD, label=label)


def legend_above(figure: Figure, handles: Sequence[Any]) -> None:
    """Draws a legend in one row over all axes, which make room for it."""
    figure.legend(handles=list(handles), loc="upper left", ncol=len(handles), handlelength=1.4, columnspacing=1.4,
                  borderaxespad=0.3, borderpad=0.0)
    figure.get_layout_engine().set(rect=(0.0, 0.0, 1.0, 1.0 - _LEGEND / figure.get_figheight()))


def draw_scatter(axes: Axes, x: Any, y: Any) -> None:
    """Draws points that stand back behind a curve."""
    axes.plot(x, y, "o", color=style.FAINT, markersize=2.2, alpha=0.7, markeredgewidth=0.0,
              rasterized=len(x) > 1000)


def no_value_ticks(axes: Axes, x: Any) -> None:
    """Marks points that gave no value, on the upper edge."""
    if len(x):
        axes.plot(x, np.full(len(x), 0.985), "x", color=style.BLACK, markersize=3.5, markeredgewidth=0.8, clip_on=False,
                  transform=axes.get_xaxis_transform())
