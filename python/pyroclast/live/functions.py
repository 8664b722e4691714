"""Functions of temperature or of time as curves of a deck: tabulated before the run begins."""

from __future__ import annotations

import math
import os
import re
import shutil
import tempfile
import weakref
from collections.abc import Callable, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from ..errors import Error
from ..writing import write_text

_TOLERANCE = 1e-6  # of the range of values
_FIRST_INTERVALS = 64
_NARROWEST = 1e-9  # interval over the whole one: there a jump becomes a ramp
_MOST_POINTS = 50_000
_INSIDE = (0.21, 0.5, 0.83)  # of an interval, where a table is held against its function
_REFERENCE = 20.0  # degC
_FACTOR = re.compile(r"stages\[\d+\]\.drives\[\d+\]\.factor")


class Function(NamedTuple):
    """A curve as a function, and how it is meant.

    call: of the temperature [degC]; of the heating time [s] in `[[heat.boundaries]]`; of the time since the stage began
        [s] where it is the factor of a drive.
    unit: of what it returns; empty: the SI unit of its key, of a temperature degC.
    interval: that the table covers; None: all that the run of the deck comes to. A run whose stages are changed
        later may come further.
    """

    call: Callable[[float], float]
    unit: str = ""
    interval: tuple[float, float] | None = None


class Axis(NamedTuple):
    name: str
    unit: str


TEMPERATURE = Axis("temperature", "degC")
TIME = Axis("time", "s")


def axis_of(key: str) -> Axis:
    """Returns what a key's curve goes over: what happens at boundaries, and drives, time, all else over temperature."""
    return TIME if key.startswith("heat.boundaries") or is_of_drive(key) else TEMPERATURE


def is_of_drive(key: str) -> bool:
    """Returns whether it is the factor of a drive."""
    return _FACTOR.fullmatch(key) is not None


def first(axis: Axis) -> float:
    """Returns where a function is asked for the number that stands in for it until its interval is known."""
    return 0.0 if axis is TIME else _REFERENCE


def value_at(key: str, function: Function, x: float) -> float:
    """Raises Error naming key and place where the function raises, or its value is no finite number."""
    axis = axis_of(key)
    where = f"{key}: the function, at {axis.name} {x:g} {axis.unit},"
    try:
        value = float(function.call(x))
    except Exception as error:
        raise Error(f"{where} raises {type(error).__name__}: {error}") from error
    if not math.isfinite(value):
        raise Error(f"{where} gives {value}")
    return value


def tabulate(key: str, function: Function, low: float, high: float) -> list[tuple[float, float]]:
    """Returns points between which straight lines are off by less than 1e-6 of the range of values."""
    if not high > low:
        high = low + 1.0
    at = [low + (high - low) * i / _FIRST_INTERVALS for i in range(_FIRST_INTERVALS)] + [high]
    known = {x: value_at(key, function, x) for x in at}

    def value(x: float) -> float:
        if x not in known:
            known[x] = value_at(key, function, x)
        return known[x]

    points = [(low, known[low])]
    pending = list(zip(at, at[1:]))[::-1]
    span = max(known.values()) - min(known.values())
    tolerance = 0.5 * _TOLERANCE * (span or abs(known[low]) or 1.0)
    while pending:
        a, b = pending.pop()
        off = max(abs(value(a + t * (b - a)) - (1.0 - t) * value(a) - t * value(b)) for t in _INSIDE)
        if off > tolerance and b - a > _NARROWEST * (high - low):
            middle = 0.5 * (a + b)
            value(middle)
            pending += [(middle, b), (a, middle)]
        else:
            points.append((b, value(b)))
        if len(points) + len(pending) > _MOST_POINTS:
            axis = axis_of(key)
            raise Error(f"{key}: the function changes too wildly near {axis.name} {a:g} {axis.unit} for a table of "
                        f"{_MOST_POINTS} points")
    return points


def write_table(folder: str | Path, key: str, unit: str, points: Sequence[tuple[float, float]],
                owner: str = "") -> Path:
    """Writes a CSV file as decks read it, named after its key. owner: what the name begins with."""
    axis = axis_of(key)
    name = "".join(c if c.isalnum() else "_" for c in key).strip("_")
    path = Path(folder) / f"{owner}{name}.csv"
    lines = [f"{axis.name} [{axis.unit}], {name} [{unit or '1'}]", *(f"{x!r}, {y!r}" for x, y in points)]
    write_text(path, "\n".join(lines) + "\n")
    return path


def _remove(folder: str, maker: int) -> None:
    if os.getpid() == maker:  # and not a child of fork
        shutil.rmtree(folder, ignore_errors=True)


class Scratch:
    """A folder for the tables of functions, as long as this is there; made when it is first asked for."""

    @cached_property
    def folder(self) -> str:
        folder = tempfile.mkdtemp(prefix="pyroclast-")
        weakref.finalize(self, _remove, folder, os.getpid())
        return folder
