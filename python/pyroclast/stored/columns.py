"""Columns of numbers by name, with their units."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..libraries import library

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray

    Array = NDArray[np.float64]
else:
    Array = np.ndarray  # figures run with a NumPy that has no types yet

_IN_SI = {"K/s": 1.0, "s": 1.0, "m": 1.0, "m2": 1.0, "N": 1.0, "J": 1.0, "kg": 1.0, "degC": 1.0,
          "MPa": 1e6}
"""Units of the program's columns, longer ends of names first, with their factors to SI."""


class ColumnNames:
    """Names of columns: the program's ("stress_MPa"), and those without their units ("stress", in SI)."""

    def __init__(self, columns: Sequence[tuple[str, str]], factor: Callable[[str], float]):
        """Takes the columns of a table.

        columns: names and units; "1" for a number.
        factor: from a unit to SI.
        """
        self.names = [name for name, _ in columns]
        self.units = dict(columns)
        self._places: dict[str, tuple[int, float]] = {}
        for i, (name, unit) in enumerate(columns):
            ending = "_" + unit.replace("/", "_")
            if unit != "1" and name.endswith(ending):
                self._places.setdefault(name.removesuffix(ending), (i, factor(unit)))
        for i, name in enumerate(self.names):
            self._places[name] = (i, 1.0)

    @classmethod
    def of_header(cls, names: Sequence[str]) -> ColumnNames:
        """Takes the header of a file of the program: the units are what names end with."""
        ends = {"_" + unit.replace("/", "_"): unit for unit in _IN_SI}
        return cls([(name, next((unit for end, unit in ends.items() if name.endswith(end)), "1")) for name in names],
                   _IN_SI.__getitem__)

    def place(self, name: str) -> tuple[int, float]:
        """Returns the number of a column, and the factor of its values. Raises KeyError where there is none."""
        return self._places[name]

    def __contains__(self, name: object) -> bool:
        return name in self._places

    @property
    def bare(self) -> list[str]:
        """The names under which values are SI."""
        return [name for name in self._places if name not in self.units or self.units[name] == "1"]


class Columns(Mapping[str, Array]):
    """Columns by name, a read-only array (rows,) each; NaN where a cell is empty.

    Under the program's name ("stress_MPa") a column is in the unit of its name; without it ("stress") in SI.
    """

    def __init__(self, names: ColumnNames):
        self._names = names

    @abstractmethod
    def _cells(self, column: int) -> Array:
        """Returns the cells (rows,) of a column."""

    @property
    @abstractmethod
    def rows(self) -> int:
        """Number of rows."""

    def __getitem__(self, name: str) -> Array:
        i, factor = self._names.place(name)
        column = self._cells(i)[:] if factor == 1.0 else self._cells(i) * factor
        column.setflags(write=False)
        return column

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names.units)

    def __len__(self) -> int:
        return len(self._names.units)

    @property
    def names(self) -> list[str]:
        """The program's, in the order of the columns."""
        return self._names.names

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column, by the program's names; "1" for a number."""
        return dict(self._names.units)

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a DataFrame, its columns by the program's names; its `attrs["units"]` has their units."""
        table: pandas.DataFrame = library("pandas", "to_pandas").DataFrame(dict(self))
        table.attrs["units"] = self.units
        return table

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.rows} rows, {len(self)} columns>"
