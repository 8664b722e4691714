"""A curve in plain characters, for terminals."""

from __future__ import annotations

import math
import re

import numpy as np

from .style import thinned

_THIRDS = ".-'"  # where in its cell the curve is, from below
_STEEP, _NOW = ":", "o"
_PLAIN = {"°C": "degC", "µ": "u", "·": " x ", "⁻³": "^-3", "–": "-", "×": "x"}  # not every terminal has these marks
_LEAST = (30, 5)  # columns and rows of a plot that still says something
_ROWS_A_TICK, _COLUMNS_A_TICK = 4, 12
_LARGEST_PLAIN, _LEAST_PLAIN = 1e5, 1e-4  # numbers beyond are printed with a power of ten
_MOST_POINTS = 5000  # more than a terminal has cells to tell apart
_SAMPLES = 3  # of a straight piece of the curve, in each cell that it may cross


def plain_label(label: str) -> str:
    """Returns a label of a figure's axis without the marks of formulas, on one line."""
    text = re.sub(r"[${}]", "", label)
    for mark, plain in _PLAIN.items():
        text = text.replace(mark, plain)
    return " ".join(text.split())


def curve(x: np.ndarray, y: np.ndarray, x_label: str, y_label: str, size: tuple[int, int]) -> list[str]:
    """Returns lines of a picture of the curve through these points, its last one marked; NaN is a gap.

    x_label, y_label: with unit, as figures have them. size: columns and rows of all lines together.
    """
    x, y = thinned(x, y, _MOST_POINTS)
    rows, columns = max(size[1] - 4, _LEAST[1]), max(size[0], _LEAST[0])
    known = np.isfinite(x) & np.isfinite(y)
    (x_low, x_high), (y_low, y_high) = (_range(values[known]) for values in (x, y))
    y_ticks = _ticks(y_low, y_high, max(rows // _ROWS_A_TICK, 2))
    y_low, y_high = min(y_low, y_ticks[0]), max(y_high, y_ticks[-1])
    names = _printed(y_ticks)
    margin = max(map(len, names)) + 1
    columns -= margin + 2
    cells = _cells(_scaled(x, x_low, x_high, columns), _scaled(y, y_low, y_high, 3 * rows), columns, rows)

    labels = {int(_scaled(tick, y_low, y_high, 3 * rows)) // 3: name for tick, name in zip(y_ticks, names)}
    lines = [f"{plain_label(y_label)}"]
    for row in reversed(range(rows)):
        edge = "+" if row in labels else "|"
        lines.append(f"{labels.get(row, ''):>{margin}} {edge}{''.join(cells[row])}".rstrip())
    ticks = _ticks(x_low, x_high, max(columns // _COLUMNS_A_TICK, 2))
    places = [int(_scaled(tick, x_low, x_high, columns)) for tick in ticks]
    axis, numbers = ["-"] * columns, " " * (columns + margin + 2)
    for place, name in zip(places, _printed(ticks)):
        axis[place] = "+"
        at = min(margin + 2 + place - len(name) // 2, len(numbers) - len(name))
        numbers = numbers[:at] + name + numbers[at + len(name):]
    lines.append(" " * (margin + 1) + "+" + "".join(axis))
    lines.append(numbers.rstrip())
    lines.append(plain_label(x_label).rjust(columns + margin + 2))
    return [line[:size[0]] for line in lines]


def _range(values: np.ndarray) -> tuple[float, float]:
    """Returns what an axis shows: the values, from zero on where that is near."""
    if not len(values):
        return 0.0, 1.0
    low, high = float(values.min()), float(values.max())
    if 0.0 < low < 0.5 * high:
        low = 0.0
    if 0.5 * low < high < 0.0:
        high = 0.0
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        middle, half = 0.5 * (low + high), 0.5 * abs(low + high) or 1.0
        return middle - half, middle + half
    return low, high


def _ticks(low: float, high: float, most: int) -> list[float]:
    """Returns at most so many round numbers from low to high, and at least two, for which they may lie outside."""
    rough = (high - low) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= rough * (1.0 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    if last <= first:
        first, last = math.floor(low / step), math.ceil(high / step)
    return [i * step for i in range(first, last + 1)]


def _printed(ticks: list[float]) -> list[str]:
    """Returns numbers that differ in print, all with as many decimals."""
    step, largest = ticks[1] - ticks[0], max(map(abs, ticks))
    if largest >= _LARGEST_PLAIN or step < _LEAST_PLAIN:
        return [f"{tick:.4g}" for tick in ticks]
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return [f"{tick + 0.0:.{decimals}f}" for tick in ticks]


def _scaled(values, low: float, high: float, cells: int):
    """Returns places of values on an axis of so many cells, the ends in the middle of the first and last."""
    return 0.5 + (np.asarray(values) - low) / (high - low) * (cells - 1)


def _cells(x: np.ndarray, y: np.ndarray, columns: int, rows: int) -> list[list[str]]:
    """Returns characters, from the lowest row. x in columns, y in thirds of rows."""
    thirds = np.zeros((rows, columns, 3), dtype=bool)
    pieces = [(x, y)]  # of the curve, at its points and between them
    for (x0, y0), (x1, y1) in zip(zip(x[:-1], y[:-1]), zip(x[1:], y[1:])):
        if np.isfinite([x0, y0, x1, y1]).all():
            share = np.linspace(0.0, 1.0, 2 + int(_SAMPLES * (abs(x1 - x0) + abs(y1 - y0))))
            pieces.append((x0 + share * (x1 - x0), y0 + share * (y1 - y0)))
    along, up = (np.concatenate(values) for values in zip(*pieces))
    seen = np.isfinite(along) & np.isfinite(up) & (along < columns) & (up >= 0.0) & (up < 3 * rows)
    column, third = along[seen].astype(int), up[seen].astype(int)
    thirds[third // 3, column, third % 3] = True
    cells = [[_character(cell) for cell in row] for row in thirds]
    if last := np.flatnonzero(np.isfinite(x) & np.isfinite(y))[-1:].tolist():
        cells[int(y[last[0]]) // 3][int(x[last[0]])] = _NOW
    return cells


def _character(thirds: np.ndarray) -> str:
    hit = np.flatnonzero(thirds)
    if not len(hit):
        return " "
    return _THIRDS[hit[0]] if len(hit) == 1 else _STEEP if len(hit) == 3 else _THIRDS[hit[-1] if hit[0] else hit[0]]
