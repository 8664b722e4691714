"""Figure of the properties over the temperature (paper, Figures 10 and 11)."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..errors import Error
from . import style

_COLUMNS = ("property", "unit", "temperature_degC", "value", "ratio_to_20_degC")
_SOLID_COLOURS = (style.VERMILLION, style.BLUE, style.GREEN, style.PURPLE, style.ORANGE)
_STRENGTHS = ("f_t", "f_cm", "c_o", "c_res", "G_f1", "G_f2")
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


@dataclass(frozen=True)
class PropertyLine:
    label: str
    curve: Property
    shown: np.ndarray  #: (rows,) in the unit of the panel


@dataclass(frozen=True)
class PropertyPanel:
    """Curves of one kind of property."""

    title: str
    label: str  #: of the values, with their unit
    lines: list[PropertyLine]
    is_of_contacts: bool = False
    from_zero: bool = True


def panels(table: Mapping[str, Property]) -> list[PropertyPanel]:
    """Returns a panel for each kind of property that the table holds."""
    contact = _shown_contact(table)
    found = [
        PropertyPanel("Young's modulus", "Ratio to 20 °C [–]", _of_solids(table, "E", lambda p: p.ratio)),
        PropertyPanel(f"Strengths and fracture energies, {contact.replace('_', '–')}", "Ratio to 20 °C [–]",
              list(_strengths(table, contact)), is_of_contacts=True),
        PropertyPanel("Free thermal strain since 20 °C", "Strain, elongation positive [10⁻³]",
              _of_solids(table, "thermal_strain", lambda p: style.PER_MILLE * p.value), from_zero=False),
        PropertyPanel("Creep strain on heating at a stress of f_c", "Strain [10⁻³]",
              _of_solids(table, "creep.strain", lambda p: style.PER_MILLE * p.value)),
        PropertyPanel("Thermal conductivity", "γ [W/(m K)]", _of_solids(table, "conductivity", lambda p: p.value)),
        PropertyPanel("Heat capacity", "ρc [MJ/(m³ K)]", _of_solids(table, "heat_capacity", lambda p: p.value / _MEGA))]
    return [panel for panel in found if panel.lines]


@style.in_style
def properties(table: Mapping[str, Property]) -> Figure:
    """Draws a panel for each kind of property that the table holds. Raises Error where it holds none of a kind."""
    shown = panels(table)
    if not shown:
        raise Error(f"no property of the table has a panel: {', '.join(table)}")
    across = 1 if style.page().is_column else 2
    rows = -(-len(shown) // across)
    figure = style.new_figure(2.5 * rows)
    all_axes = figure.subplots(rows, across, squeeze=False, sharex=True).ravel()
    for axes, panel in zip(all_axes, shown):
        _draw(axes, panel)
        style.draw_own_legend(axes)
        axes.tick_params(labelbottom=True)
        axes.set_xlabel("Temperature [°C]")
    for axes in all_axes[len(shown):]:
        axes.axis("off")
    return figure


def _draw(axes: Axes, panel: PropertyPanel) -> None:
    colours = _COLOURS if panel.is_of_contacts else _SOLID_COLOURS
    for number, line in enumerate(panel.lines):  # dashed where the second would hide the first
        axes.plot(line.curve.temperature, line.shown, color=colours[number % len(colours)],
                  linestyle=_DASHES[number % len(_DASHES)], label=_symbols(line.label))
    axes.set_title(_symbols(panel.title))
    axes.set_ylabel(panel.label)
    if panel.from_zero:
        axes.set_ylim(bottom=0.0)


def _symbols(text: str) -> str:
    """Returns words such as f_cm as formulas."""
    return re.sub(r"\b([A-Za-z])_(\w+)\b", r"$\1_{\2}$", text)


def _solids(table: Mapping[str, Property]) -> list[str]:
    """Returns names of the phases, in the order of the file."""
    names = [path.split(".")[1] for path in table if path.startswith("materials.")]
    return [name for name in dict.fromkeys(names) if name != "platen"]


def _shown_contact(table: Mapping[str, Property]) -> str:
    """Returns the interface whose strengths are drawn: that of the mortar, or the last one."""
    names = list(dict.fromkeys(path.split(".")[1] for path in table if path.startswith("contacts.")))
    return "mortar_mortar" if "mortar_mortar" in names or not names else names[-1]


def _strengths(table: Mapping[str, Property], contact: str) -> Iterator[PropertyLine]:
    """Yields a line for all properties that have the same ratio."""
    groups: list[tuple[Property, list[str]]] = []
    for key in _STRENGTHS:
        curve = table.get(f"contacts.{contact}.{key}")
        if curve is None:
            continue
        for other, names in groups:
            if _same(curve, other):
                names.append(key)
                break
        else:
            groups.append((curve, [key]))
    for curve, names in groups:
        yield PropertyLine(", ".join(names), curve, curve.ratio)


def _same(a: Property, b: Property) -> bool:
    return np.array_equal(a.temperature, b.temperature) and np.allclose(a.ratio, b.ratio, rtol=1e-9, equal_nan=True)


def _of_solids(table: Mapping[str, Property], key: str, shown: Callable[[Property], np.ndarray]) -> list[PropertyLine]:
    """Returns the phases that have the property."""
    return [PropertyLine(solid, curve, shown(curve)) for solid in _solids(table)
            if (curve := table.get(f"materials.{solid}.{key}")) is not None]
