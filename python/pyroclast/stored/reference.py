"""What runs are held against: compression at room temperature, total strain while heated under load, and tables of
the user's.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Error
from .files import is_number, read_json_list

COMPRESSION, TRANSIENT_STRAIN = "compression", "transient_strain"
"""References of the program, as decks name them."""


@dataclass(frozen=True)
class Reference:
    """A table of the user's. Values are in the units of the history's columns; low and high are the same unless it is
    a range.
    """

    name: str
    of: str
    over: str
    x: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @property
    def is_range(self) -> bool:
        return bool((self.low != self.high).any())

    @property
    def content(self) -> tuple[str, bytes]:
        """The same of two that would be drawn alike."""
        return self.name, b"".join(np.asarray(v).tobytes() for v in (self.x, self.low, self.high))


@dataclass(frozen=True)
class References:
    """What the deck of a run asks for beside its results."""

    builtin: frozenset[str] = frozenset()  #: of COMPRESSION, TRANSIENT_STRAIN
    tables: tuple[Reference, ...] = ()

    def of(self, of: str, over: str) -> list[Reference]:
        """Returns the tables of a quantity over another, as the deck names both."""
        return [table for table in self.tables if (table.of, table.over) == (of, over)]


def read_references(path: Path) -> References:
    """Reads references.json, which the program leaves in the folder of a run; none without it.

    Raises Error when it is malformed.
    """
    if not path.exists():
        return References()
    builtin, tables = set(), []
    for number, entry in enumerate(read_json_list(path)):
        if not isinstance(entry, dict):
            raise Error(f"{path}: entry {number} is no object")
        if "builtin" in entry:
            if entry["builtin"] not in (COMPRESSION, TRANSIENT_STRAIN):
                raise Error(f"{path}: entry {number}: 'builtin' is neither {COMPRESSION} nor {TRANSIENT_STRAIN}")
            builtin.add(entry["builtin"])
        else:
            tables.append(_table(path, number, entry))
    return References(frozenset(builtin), tuple(tables))


def _table(path: Path, number: int, entry: dict[str, Any]) -> Reference:
    words = [entry.get(key) for key in ("name", "of", "over")]
    if not all(isinstance(word, str) for word in words):
        raise Error(f"{path}: entry {number}: 'name', 'of' and 'over' are not all texts")
    columns = []
    for key in ("x", "low", "high"):
        values = entry.get(key)
        if not isinstance(values, list) or not all(is_number(value) for value in values):
            raise Error(f"{path}: entry {number}: '{key}' is no list of finite numbers")
        columns.append(np.array(values, dtype=float))
    if len({len(column) for column in columns}) != 1 or len(columns[0]) < 2:
        raise Error(f"{path}: entry {number}: 'x', 'low' and 'high' are not alike in length, or shorter than 2")
    return Reference(*words, *columns)


# Compression at room temperature; stress and strain positive in compression.


@dataclass(frozen=True)
class CompressionValues:
    """Macroscopic response in uniaxial compression."""

    modulus: float  #: E, GPa
    strength: float  #: f_c, MPa
    inelastic_strain: float  #: eps_ic, strain at the peak less f_c / E

    @property
    def strain_at_peak(self) -> float:
        return self.strength / (1e3 * self.modulus) + self.inelastic_strain


# Table 3 of the paper.
EXPERIMENT = CompressionValues(modulus=21.5, strength=35.0, inelastic_strain=0.0015)
PAPER_DEM = CompressionValues(modulus=21.59, strength=34.30, inelastic_strain=0.00139)

AT_MODULUS = 21.5e3
"""E of the Anderberg and Thelandersson concrete, MPa (paper, section 3.2)."""
AT_STRENGTH = 35.0
"""f_c, MPa (paper, section 3.2)."""
AT_DESCENT = -880.0
"""Slope of the descending line, MPa. As commonly quoted; not checked against the original report."""

_AT_STRAIN_AT_PEAK = 2.0 * AT_STRENGTH / AT_MODULUS
_AT_STRAIN_AT_TANGENT = _AT_STRAIN_AT_PEAK * (1.0 - AT_DESCENT / AT_MODULUS)


def _parabola(strain):
    ratio = strain / _AT_STRAIN_AT_PEAK
    return AT_STRENGTH * ratio * (2.0 - ratio)


AT_LAST_STRAIN = _AT_STRAIN_AT_TANGENT - _parabola(_AT_STRAIN_AT_TANGENT) / AT_DESCENT
"""Strain at which the descending line reaches zero stress."""


def at_stress(strain):
    """Returns the stress [MPa] of the Anderberg and Thelandersson law at room temperature, generated, not measured.

    A parabola with initial slope E and apex f_c at 2 f_c / E, continued by the line of slope AT_DESCENT that
    is tangent to it. Takes a number or an array within [0, AT_LAST_STRAIN]; throws ValueError outside.
    The law's own inelastic strain at the peak is f_c / E = 0.00163; the paper quotes 0.0015 for the
    experiment.
    """
    strain = np.asarray(strain, dtype=float)
    if (strain < 0.0).any() or (strain > AT_LAST_STRAIN).any():
        raise ValueError(f"strain outside [0, {AT_LAST_STRAIN:.4g}], where the law is defined")
    line = _parabola(_AT_STRAIN_AT_TANGENT) + AT_DESCENT * (strain - _AT_STRAIN_AT_TANGENT)
    return np.where(strain <= _AT_STRAIN_AT_TANGENT, _parabola(strain), line)


# Heating under load; strain positive in expansion.

TRUSTED_TO = 500.0
"""Temperature [°C] up to which the bands of total strain are good; above, they only tell the order."""

_SAME_LEVEL = 0.005
_BANDS_FILE = Path(__file__).parent / "reference_data" / "transient_total_strain.csv"


@dataclass(frozen=True)
class StrainBand:
    """Range of total strain over temperature at one load level; what spans it stands in the data's header."""

    level: float  #: stress over the strength at 20 °C
    temperature: np.ndarray  #: (n,) °C, rising
    low: np.ndarray  #: (n,)
    central: np.ndarray  #: (n,)
    high: np.ndarray  #: (n,)

    def at(self, temperature):
        """Returns the low, central and high strain at a temperature [°C] or an array of them; ValueError outside."""
        temperature = np.asarray(temperature, dtype=float)
        first, last = self.temperature[[0, -1]]
        if (temperature < first).any() or (temperature > last).any():
            raise ValueError(f"temperature outside {first:g} to {last:g} °C, where the band is given")
        return tuple(np.interp(temperature, self.temperature, y) for y in (self.low, self.central, self.high))


@cache
def strain_bands() -> tuple[StrainBand, ...]:
    """Returns the four load levels of Anderberg and Thelandersson's transient tests, lowest first."""
    with open(_BANDS_FILE, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    names = ("temperature_degC", "strain_low", "strain_central", "strain_high")
    levels = sorted({float(row["level"]) for row in rows})
    return tuple(
        StrainBand(level, *np.array([[float(row[name]) for name in names]
                                     for row in rows if float(row["level"]) == level]).T)
        for level in levels
    )


def strain_band(level: float | None) -> StrainBand | None:
    """Returns the band of a load level, given to three digits; None when there is none for it."""
    if level is None:
        return None
    return next((band for band in strain_bands() if abs(band.level - level) < _SAME_LEVEL), None)
