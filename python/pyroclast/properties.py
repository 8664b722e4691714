"""Figure of the properties over the temperature (paper, Figures 10 and 11)."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .errors import Error

_COLUMNS = ("property", "unit", "temperature_degC", "value", "ratio_to_20_degC")
_SOLID_COLOURS = (style.VERMILLION, style.BLUE, style.GREEN, style.PURPLE, style.ORANGE)
_SYMBOLS = {"f_t": "$f_t$", "f_cm": "$f_{cm}$", "c_o": "$c_o$", "c_res": "$c_{res}$", "G_f1": "$G_{f1}$",
            "G_f2": "$G_{f2}$"}
_COLOURS = (style.BLACK, style.GREEN, style.PURPLE, style.ORANGE, style.SKY, style.VERMILLION)
_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (5, 1.5, 1, 1.5)))
_MEGA = 1e6


@dataclass(frozen=True)
class Property:
    """One property over the temperature, each array (rows,)."""

    unit: str  #: SI unit of the values
    temperature: np.ndarray  #: degC
    value: np.ndarray
    ratio: np.ndarray  #: to the value at 20 degC; NaN where there is none


def read_properties(path: Path) -> dict[str, Property]:
    """Reads properties.csv: by path in the deck, such as "materials.mortar.E".

    Raises Error when the file is missing or malformed.
    """
    rows: dict[str, list[tuple[str, float, float, float]]] = {}
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            missing = [name for name in _COLUMNS if name not in (reader.fieldnames or [])]
            if missing:
                raise Error(f"{path}: has no column '{missing[0]}'")
            for row in reader:
                numbers = tuple(float(row[name]) for name in _COLUMNS[2:])
                rows.setdefault(row["property"], []).append((row["unit"], *numbers))
    except (OSError, UnicodeDecodeError) as error:
        raise Error(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
    except (TypeError, ValueError):
        raise Error(f"{path}, line {reader.line_num}: a number is missing or malformed") from None
    if not rows:
        raise Error(f"{path}: has a header but no rows")
    return {name: Property(entries[0][0], *np.array([entry[1:] for entry in entries]).T)
            for name, entries in rows.items()}


@style.in_style
def properties(table: Mapping[str, Property]) -> Figure:
    """One panel for each kind of property that the table holds."""
    panels: list[Callable[[Axes, Mapping[str, Property]], None]] = [_modulus, _strengths, _thermal_strain]
    if any(f"materials.{solid}.conductivity" in table for solid in _solids(table)):
        panels.append(_conductivity)
    if any(f"materials.{solid}.heat_capacity" in table for solid in _solids(table)):
        panels.append(_heat_capacity)
    across = 1 if style.page().is_column else 2
    rows = -(-len(panels) // across)
    figure = style.new_figure(2.5 * rows)
    all_axes = figure.subplots(rows, across, squeeze=False, sharex=True).ravel()
    for axes, draw in zip(all_axes, panels):
        draw(axes, table)
        style.draw_own_legend(axes)
        axes.tick_params(labelbottom=True)
        axes.set_xlabel("Temperature [°C]")
    for axes in all_axes[len(panels):]:
        axes.axis("off")
    return figure


def _solids(table: Mapping[str, Property]) -> list[str]:
    """Names of the phases, in the order of the file."""
    names = [path.split(".")[1] for path in table if path.startswith("materials.")]
    return [name for name in dict.fromkeys(names) if name != "platen"]


def _shown_contact(table: Mapping[str, Property]) -> str:
    """The interface whose strengths are drawn: that of the mortar, or the last one."""
    names = list(dict.fromkeys(path.split(".")[1] for path in table if path.startswith("contacts.")))
    return "mortar_mortar" if "mortar_mortar" in names or not names else names[-1]


def _modulus(axes: Axes, table: Mapping[str, Property]) -> None:
    _draw_solids(axes, table, "E", lambda p: p.ratio)
    axes.set_title("Young's modulus")
    axes.set_ylabel("Ratio to 20 °C [–]")
    axes.set_ylim(bottom=0.0)


def _strengths(axes: Axes, table: Mapping[str, Property]) -> None:
    """Properties with the same ratio share a line."""
    contact = _shown_contact(table)
    groups: list[tuple[Property, list[str]]] = []
    for key, symbol in _SYMBOLS.items():
        curve = table.get(f"contacts.{contact}.{key}")
        if curve is None:
            continue
        for other, names in groups:
            if _same(curve, other):
                names.append(symbol)
                break
        else:
            groups.append((curve, [symbol]))
    for number, (curve, names) in enumerate(groups):
        axes.plot(curve.temperature, curve.ratio, color=_COLOURS[number % len(_COLOURS)],
                  linestyle=_DASHES[number % len(_DASHES)], label=", ".join(names))
    axes.set_title(f"Strengths and fracture energies, {contact.replace('_', '–')}")
    axes.set_ylabel("Ratio to 20 °C [–]")
    axes.set_ylim(bottom=0.0)


def _same(a: Property, b: Property) -> bool:
    return np.array_equal(a.temperature, b.temperature) and np.allclose(a.ratio, b.ratio, rtol=1e-9, equal_nan=True)


def _thermal_strain(axes: Axes, table: Mapping[str, Property]) -> None:
    _draw_solids(axes, table, "thermal_strain", lambda p: style.PER_MILLE * p.value)
    axes.set_title("Free thermal strain since 20 °C")
    axes.set_ylabel("Strain, elongation positive [$10^{-3}$]")


def _conductivity(axes: Axes, table: Mapping[str, Property]) -> None:
    _draw_solids(axes, table, "conductivity", lambda p: p.value)
    axes.set_title("Thermal conductivity")
    axes.set_ylabel("$\\gamma$ [W/(m K)]")
    axes.set_ylim(bottom=0.0)


def _heat_capacity(axes: Axes, table: Mapping[str, Property]) -> None:
    _draw_solids(axes, table, "heat_capacity", lambda p: p.value / _MEGA)
    axes.set_title("Heat capacity")
    axes.set_ylabel("$\\rho c$ [MJ/(m³ K)]")
    axes.set_ylim(bottom=0.0)


def _draw_solids(axes: Axes, table: Mapping[str, Property], key: str,
                 shown: Callable[[Property], np.ndarray]) -> None:
    """The phases, dashed where the second would hide the first."""
    for dashes, solid, colour in zip(cycle(_DASHES), _solids(table), cycle(_SOLID_COLOURS)):
        curve = table.get(f"materials.{solid}.{key}")
        if curve is not None:
            axes.plot(curve.temperature, shown(curve), color=colour, linestyle=dashes, label=solid)
