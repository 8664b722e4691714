"""Tables, JSON objects and HDF5 files, with errors that name file and place."""

from __future__ import annotations

import csv
import fcntl
import json
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from enum import Enum
from pathlib import Path

import h5py
import numpy as np

_MOST_SHOWN = 40  # characters of a cell in a message
_LARGEST_WHOLE = 2.0**53
_TIGHTEST_PACKING = 1032  # bytes from one of a file: what deflate reaches at best

LARGEST = 1e30
"""A number beyond it counts as not finite: in no unit is a quantity of a run so large, and drawing would overflow."""


class RunError(Exception):
    """Something in a run or specimen folder is missing or malformed; one line says what and where."""


class GapWarning(UserWarning):
    """A table has cells that are not finite; they are drawn as gaps."""


class Table:
    """Columns of numbers of a csv file, by name: `table["strain"]` is a (rows,) float64 array.

    An empty cell is NaN: the stage of its row does not have the quantity. So is a cell that is inf or NaN, of
    which a GapWarning tells.
    """

    def __init__(self, path: Path, may_be_empty: bool = False):
        """Throws RunError when the file is missing, holds something that is not a number, or has no rows."""
        self.path = path
        try:
            text = self._text()
            lines = list(csv.reader(text.splitlines()))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise RunError(f"{path}: cannot be read: {_reason(error)}") from error
        if not lines or not lines[0]:
            raise RunError(f"{path}: is empty; a header line is expected")
        if not text.endswith("\n") and len(lines[-1]) != len(lines[0]):
            lines.pop()  # the row that a run was killed in
        self.names = [name.strip() for name in lines[0]]
        self._columns = self._parsed(lines[1:], 2)
        if not len(self) and not may_be_empty:
            raise RunError(f"{path}: has a header but no rows")

    def _text(self) -> str:
        with open(self.path, newline="", encoding="utf-8") as file:
            return file.read()

    def _parsed(self, lines: list[list[str]], first: int) -> dict[str, np.ndarray]:
        """Columns of rows that are cut into cells. first: number of their first line."""
        self._gaps: list[tuple[int, str, str]] = []
        rows = [self._numbers(number, cells) for number, cells in enumerate(lines, start=first) if cells]
        if self._gaps:
            line, name, cell = self._gaps[0]
            warnings.warn(f"{self.path}, line {line}: column {_shown(name)} holds {_shown(cell)}; cells that are not "
                          f"finite, {len(self._gaps)} in all, are drawn as gaps", GapWarning, stacklevel=3)
        return dict(zip(self.names, np.array(rows).reshape(-1, len(self.names)).T))

    def _numbers(self, line: int, cells: list[str]) -> list[float]:
        if len(cells) != len(self.names):
            counts = f"{len(cells)} values for the header's {len(self.names)} columns"
            raise RunError(f"{self.path}, line {line}: {counts}")
        numbers = []
        for name, cell in zip(self.names, cells):
            try:
                number = float(cell) if cell else np.nan
            except ValueError:
                where = f"{self.path}, line {line}"
                raise RunError(f"{where}: column {_shown(name)} holds {_shown(cell)}, not a number") from None
            if cell and not abs(number) <= LARGEST:
                self._gaps.append((line, name, cell))
                number = np.nan
            numbers.append(number)
        return numbers

    def __getitem__(self, name: str) -> np.ndarray:
        """Throws RunError naming file and column when there is no such column."""
        if name not in self._columns:
            raise RunError(f"{self.path}: has no column '{name}'")
        return self._columns[name]

    def whole(self, name: str, none: int | None = None) -> np.ndarray:
        """(rows,) int64, a column of whole numbers from zero. none: what an empty cell stands for.

        Throws RunError naming file and column when a cell holds something else.
        """
        values = self[name] if none is None else np.where(np.isnan(self[name]), none, self[name])
        wrong = ~((values >= 0.0) & (values == np.floor(values)) & (values < _LARGEST_WHOLE))
        if wrong.any():
            raise RunError(f"{self.path}: column '{name}' holds {values[wrong][0]:g}; "
                           "whole numbers from 0 are expected")
        return values.astype(np.int64)

    def known(self, name: str, rows: np.ndarray | slice = slice(None)) -> np.ndarray:
        """The finite values of a column in some rows; throws RunError when there is none."""
        values = self[name][rows]
        values = values[np.isfinite(values)]
        if not len(values):
            raise RunError(f"{self.path}: column '{name}' has no finite value in the rows that are drawn")
        return values

    def __contains__(self, name: str) -> bool:
        return name in self._columns

    def __len__(self) -> int:
        return len(self._columns[self.names[0]])


class GrowingTable(Table):
    """A table that another process still writes: the rows that are whole, as far as they have come."""

    def __init__(self, path: Path, may_be_empty: bool = True):
        self.path = path
        self._taken = 0  # bytes
        self._inode = path.stat().st_ino if path.exists() else None
        super().__init__(path, may_be_empty)
        self._next_line = len(self) + 2

    def _text(self) -> str:
        with open(self.path, "rb") as file:
            file.seek(self._taken)
            added = file.read()
        added = added[:added.rfind(b"\n") + 1]
        self._taken += len(added)
        return added.decode("utf-8")

    @property
    def is_replaced(self) -> bool:
        """Whether the file is another one by now, or was cut off, as where a run was resumed or overwritten."""
        try:
            now = self.path.stat()
        except OSError:
            return True
        return now.st_ino != self._inode or now.st_size < self._taken

    def grow(self) -> bool:
        """Takes in the rows that came since; returns whether there were any. Throws RunError as at first."""
        try:
            lines = list(csv.reader(self._text().splitlines()))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise RunError(f"{self.path}: cannot be read: {_reason(error)}") from error
        added = self._parsed(lines, self._next_line)
        self._next_line += len(lines)
        self._columns = {name: np.concatenate([values, added[name]]) for name, values in self._columns.items()}
        return bool(lines)


class Writer(Enum):
    """Whether a process writes into a folder."""

    THERE = "there"
    DIED = "died"  #: without leaving its lock
    NONE = "none"


class Lock:
    """The file `lock` of a folder, which whoever writes there holds locked. To look at it disturbs nobody."""

    def __init__(self, folder: Path):
        self._path = folder / "lock"
        self._left: tuple[int, int] | None = None  # which file nobody holds any more

    @property
    def writer(self) -> Writer:
        """The lock is tried only on a file that says whose it is, and no more after it was found free: so nobody who is
        about to take it meets this look.
        """
        try:
            with open(self._path, "rb") as file:
                about = os.fstat(file.fileno())
                this = (about.st_ino, about.st_mtime_ns)
                if this == self._left:
                    return Writer.DIED
                if not about.st_size:
                    return Writer.THERE
                fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
                self._left = this
                return Writer.DIED if self._path.exists() else Writer.NONE
        except BlockingIOError:
            return Writer.THERE
        except OSError:
            return Writer.NONE


@contextmanager
def open_hdf(path: Path) -> Iterator[h5py.File]:
    """Opens to read; throws RunError when the file is missing, or is damaged where it is read."""
    if not path.exists():
        raise RunError(f"{path}: does not exist")
    try:
        file = h5py.File(path, "r")
    except Exception as error:  # of a damaged file the library throws many kinds, here and below
        raise RunError(f"{path}: is not a readable HDF5 file") from error
    try:
        with file:
            yield file
    except RunError:
        raise
    except Exception as error:
        raise RunError(f"{path}: is a damaged HDF5 file: {_reason(error)}") from error


def dataset(file: h5py.File, name: str) -> np.ndarray:
    """All of a dataset of numbers; throws RunError when there is none of that name, or one is not finite."""
    values = file.get(name)
    if not isinstance(values, h5py.Dataset):
        raise RunError(f"{file.filename}: has no dataset /{name}")
    # A damaged header may ask for more memory than there is.
    if values.nbytes > _TIGHTEST_PACKING * Path(file.filename).stat().st_size:
        raise RunError(f"{file.filename}: /{name} is larger than the file; the file is damaged")
    if values.dtype.kind not in "iuf" or values.shape is None:
        raise RunError(f"{file.filename}: /{name} does not hold numbers")
    numbers = values[()]
    if numbers.dtype.kind == "f" and not (np.abs(numbers) <= LARGEST).all():
        raise RunError(f"{file.filename}: /{name} has a value that is not finite")
    return numbers


def read_json(path: Path) -> dict:
    """The object in a JSON file; throws RunError when it cannot be read or is something else."""
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise RunError(f"{path}: cannot be read: {_reason(error)}") from error
    if not isinstance(value, dict):
        raise RunError(f"{path}: is not a JSON object")
    return value


def _reason(error: Exception) -> str:
    """One line."""
    return " ".join((getattr(error, "strerror", None) or str(error) or type(error).__name__).split())


def _shown(cell: str) -> str:
    """What stands in a file, for a message: in quotes, on one line, not long."""
    return ascii(cell if len(cell) <= _MOST_SHOWN else cell[:_MOST_SHOWN] + "...")
