"""Tables, JSON objects and HDF5 files, with errors that name file and place."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import h5py
import numpy as np


class RunError(Exception):
    """Something in a run or specimen folder is missing or malformed; one line says what and where."""


class Table:
    """Columns of numbers of a csv file, by name: `table["strain"]` is a (rows,) float64 array.

    An empty cell is NaN: the stage of its row does not have the quantity.
    """

    def __init__(self, path: Path, may_be_empty: bool = False):
        """Throws RunError when the file is missing, holds something that is not a number, or has no rows."""
        self.path = path
        try:
            with open(path, newline="", encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise RunError(f"{path}: cannot be read: {_reason(error)}") from error
        lines = list(csv.reader(text.splitlines()))
        if not lines:
            raise RunError(f"{path}: is empty; a header line is expected")
        if not text.endswith("\n") and len(lines[-1]) != len(lines[0]):
            lines.pop()  # the row that a run was killed in
        self.names = [name.strip() for name in lines[0]]
        rows = [self._numbers(number, cells) for number, cells in enumerate(lines[1:], start=2) if cells]
        if not rows and not may_be_empty:
            raise RunError(f"{path}: has a header but no rows")
        self._columns = dict(zip(self.names, np.array(rows).reshape(-1, len(self.names)).T))

    def _numbers(self, line: int, cells: list[str]) -> list[float]:
        if len(cells) != len(self.names):
            counts = f"{len(cells)} values for the header's {len(self.names)} columns"
            raise RunError(f"{self.path}, line {line}: {counts}")
        numbers = []
        for name, cell in zip(self.names, cells):
            try:
                numbers.append(float(cell) if cell else np.nan)
            except ValueError:
                where = f"{self.path}, line {line}"
                raise RunError(f"{where}: column '{name}' holds '{cell}', not a number") from None
        return numbers

    def __getitem__(self, name: str) -> np.ndarray:
        """Throws RunError naming file and column when there is no such column."""
        if name not in self._columns:
            raise RunError(f"{self.path}: has no column '{name}'")
        return self._columns[name]

    def __contains__(self, name: str) -> bool:
        return name in self._columns

    def __len__(self) -> int:
        return len(self._columns[self.names[0]])


def open_hdf(path: Path) -> h5py.File:
    """Opens to read; throws RunError when the file is missing or not HDF5."""
    if not path.exists():
        raise RunError(f"{path}: does not exist")
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise RunError(f"{path}: is not a readable HDF5 file") from error


def dataset(file: h5py.File, name: str) -> np.ndarray:
    """All of a dataset; throws RunError when there is none of that name."""
    if not isinstance(file.get(name), h5py.Dataset):
        raise RunError(f"{file.filename}: has no dataset /{name}")
    return file[name][()]


def read_json(path: Path) -> dict:
    """The object in a JSON file; throws RunError when it cannot be read or is something else."""
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise RunError(f"{path}: cannot be read: {_reason(error)}") from error
    if not isinstance(value, dict):
        raise RunError(f"{path}: is not a JSON object")
    return value


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
