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
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ..errors import Error
from .columns import ColumnNames, Columns

_PIECE = 1 << 24  # bytes of a table that are read at once
_FEW = 1 << 18  # bytes for which the compiled part is not loaded
_NUMBERS = b"0123456789+-.eE,\n"
_MOST_SHOWN = 40  # characters of a cell in a message
_LARGEST_WHOLE = 2.0**53
_FOREIGN_FILTERS = 256  # numbers of filters that are not a part of HDF5, from here on
_TIGHTEST_PACKING = 1032  # bytes from one of a file: what deflate reaches at best

MESH = "mesh.h5"
"""File with the mesh of a run, to which the frames beside it link."""

_IN_MESH = frozenset(("Points", "Connectivity", "Offsets", "Types", "NumberOfPoints", "NumberOfCells",
                      "NumberOfConnectivityIds", "block", "material", "bearing", "interface", "length", "area",
                      "material_names", "interface_names"))

LARGEST = 1e30
"""A number beyond it counts as not finite: in no unit is a quantity of a run so large, and drawing would overflow."""


def is_number(value: object) -> bool:
    """Returns whether a value of a JSON file is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= LARGEST


class GapWarning(UserWarning):
    """A table has cells that are not finite; they are drawn as gaps."""


class Table(Columns):
    """Columns of numbers of a csv file, by name: `table["strain"]` is a (rows,) read-only array.

    Under the name of the header ("stress_MPa") a column is in the unit of its name; without it ("stress") in SI.
    An empty cell is NaN: the stage of its row does not have the quantity. So is a cell that is inf or NaN, of
    which a GapWarning tells. A name that there is not raises Error, which names the file.
    """

    _takes_torn = True  #: a last line that does not end, but has all its cells

    def __init__(self, path: Path, may_be_empty: bool = False):
        """Raises Error when the file is missing, holds something that is not a number, or has no rows."""
        super().__init__(ColumnNames.of_header([]))
        self.path = path
        self._gaps: tuple[int, int, str, str] | None = None  # how many, and line, column and cell of the first
        self._values = np.empty((0, 0))  # (columns, room for rows)
        self._count = 0
        self._next_line = 1
        self._taken = 0  # bytes
        self._left = 0.0  # pieces of the size of the last one
        self._take_added()
        if not self.names:
            raise Error(f"{path}: is empty; a header line is expected")
        if not self.rows and not may_be_empty:
            raise Error(f"{path}: has a header but no rows")

    def _take_added(self) -> bool:
        """Takes the lines that came since, piece by piece, so that a long file is never in memory as a text; returns
        whether there were any.
        """
        before = self._next_line
        for piece in self._pieces():
            if rows := piece if self.names else self._begin(piece):
                self._take(rows)
        self._tell_gaps()
        return self._next_line > before

    def _pieces(self) -> Iterator[bytes]:
        """Yields the whole lines, and at the end that which is not whole."""
        try:
            with open(self.path, "rb") as file:
                if self._taken:  # a pipe has no places
                    file.seek(self._taken)
                rest = b""
                while more := file.read(_PIECE):
                    cut = more.rfind(b"\n") + 1
                    piece, rest = (rest + more[:cut], more[cut:]) if cut else (b"", rest + more)
                    if piece:
                        self._taken += len(piece)
                        self._left = (os.fstat(file.fileno()).st_size - self._taken) / len(piece)
                        yield piece
                if rest and self._takes_torn:
                    yield rest
        except OSError as error:
            raise Error(f"{self.path}: cannot be read: {_reason(error)}") from error

    def _begin(self, piece: bytes) -> bytes:
        """Takes the names; returns what follows their line, unless that was taken too."""
        head, _, rest = piece.partition(b"\n")
        lines = self._cut(head)
        if b'"' in head or len(lines) > 1:  # a name may hold line ends, and other marks cut lines too
            lines, rest = self._cut(piece), b""
        if not lines or not lines[0]:
            raise Error(f"{self.path}: is empty; a header line is expected")
        self._take_header(lines)
        self._drop_torn(lines, piece)
        self._append(self._parsed(lines))
        return rest

    def _take_header(self, lines: list[list[str]]) -> None:
        self._names = ColumnNames.of_header([name.strip() for name in lines.pop(0)])
        self._next_line += 1
        self._values = np.empty((len(self.names), 0))

    def _drop_torn(self, lines: list[list[str]], text: bytes) -> None:
        if lines and not text.endswith(b"\n") and len(lines[-1]) != len(self.names):
            lines.pop()  # the row that a run was killed in

    def _take(self, piece: bytes) -> None:
        numbers = _read_rows(piece, len(self.names))
        if numbers is None:
            lines = self._cut(piece)
            self._drop_torn(lines, piece)
            numbers = self._parsed(lines)
        else:
            self._next_line += numbers.shape[1]
        self._append(numbers)

    def _cut(self, piece: bytes) -> list[list[str]]:
        try:
            return list(csv.reader(piece.decode("utf-8").splitlines()))
        except (UnicodeDecodeError, csv.Error) as error:
            raise Error(f"{self.path}: cannot be read: {_reason(error)}") from error

    def _append(self, numbers: np.ndarray) -> None:
        """Appends numbers (columns, rows)."""
        count = self._count + numbers.shape[1]
        if count > self._values.shape[1]:
            room = max(count, int(1.02 * self._left * numbers.shape[1]) + count, 2 * self._count)
            values = np.empty((len(self.names), room))  # of which no memory is taken before it is written
            values[:, :self._count] = self._values[:, :self._count]
            self._values = values
        self._values[:, self._count:count] = numbers
        self._count = count

    def _parsed(self, lines: list[list[str]]) -> np.ndarray:
        """Reads the numbers (columns, rows) of lines that are cut into cells."""
        rows = [self._numbers(number, cells) for number, cells in enumerate(lines, start=self._next_line) if cells]
        self._next_line += len(lines)
        return np.array(rows).reshape(-1, len(self.names)).T

    def _tell_gaps(self) -> None:
        if self._gaps is not None:
            count, line, name, cell = self._gaps
            warnings.warn(f"{self.path}, line {line}: column {_shown(name)} holds {_shown(cell)}; cells that are not "
                          f"finite, {count} in all, are drawn as gaps", GapWarning, stacklevel=4)
        self._gaps = None

    def _numbers(self, line: int, cells: list[str]) -> list[float]:
        if len(cells) != len(self.names):
            counts = f"{len(cells)} values for the header's {len(self.names)} columns"
            raise Error(f"{self.path}, line {line}: {counts}")
        numbers = []
        for name, cell in zip(self.names, cells):
            try:
                number = float(cell) if cell else np.nan
            except ValueError:
                where = f"{self.path}, line {line}"
                raise Error(f"{where}: column {_shown(name)} holds {_shown(cell)}, not a number") from None
            if cell and not abs(number) <= LARGEST:
                first = self._gaps or (0, line, name, cell)
                self._gaps = (first[0] + 1, *first[1:])
                number = np.nan
            numbers.append(number)
        return numbers

    def _cells(self, column: int) -> np.ndarray:
        return self._values[column, :self._count]

    @property
    def rows(self) -> int:
        """Number of rows that were read by now."""
        return self._count

    def __getitem__(self, name: str) -> np.ndarray:
        """Raises Error naming file and column when there is no such column. Of names that are there twice the last
        one counts.
        """
        if name not in self:
            raise Error(f"{self.path}: has no column '{name}'")
        return super().__getitem__(name)

    def whole(self, name: str, none: int | None = None) -> np.ndarray:
        """Returns (rows,) int64, a column of whole numbers from zero. none: what an empty cell stands for.

        Raises Error naming file and column when a cell holds something else.
        """
        values = self[name] if none is None else np.where(np.isnan(self[name]), none, self[name])
        wrong = ~((values >= 0.0) & (values == np.floor(values)) & (values < _LARGEST_WHOLE))
        if wrong.any():
            raise Error(f"{self.path}: column '{name}' holds {values[wrong][0]:g}; "
                           "whole numbers from 0 are expected")
        return values.astype(np.int64)

    def known(self, name: str, rows: np.ndarray | slice = slice(None)) -> np.ndarray:
        """Returns the finite values of a column in some rows; raises Error when there is none."""
        values = self[name][rows]
        values = values[np.isfinite(values)]
        if not len(values):
            raise Error(f"{self.path}: column '{name}' has no finite value in the rows that are drawn")
        return values


class GrowingTable(Table):
    """A table that another process still writes: the rows that are whole, as far as they have come."""

    _takes_torn = False

    def __init__(self, path: Path, may_be_empty: bool = True):
        self._inode = path.stat().st_ino if path.exists() else None
        super().__init__(path, may_be_empty)

    @property
    def is_replaced(self) -> bool:
        """Whether the file is another one by now, or was cut off, as where a run was resumed or overwritten."""
        try:
            now = self.path.stat()
        except OSError:
            return True
        return now.st_ino != self._inode or now.st_size < self._taken

    def grow(self) -> bool:
        """Takes in the rows that came since; returns whether there were any. Raises Error as at first."""
        return self._take_added()


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
    """Opens to read: the only door to such files. Raises Error when the file is missing or damaged.

    The data of a run lie in its folder. A file is damaged where a dataset of it lies in another file (external storage,
    virtual datasets), where a link leads elsewhere than a frame's links into the mesh beside it, and where a filter
    that is not a part of HDF5 packs data, for HDF5 would load code. Readers follow no link.
    """
    if not path.exists():
        raise Error(f"{path}: does not exist")
    if path.name == MESH and path.is_symlink():
        raise Error(f"{path}: is a link, and data of a run lie in its folder")
    try:
        file = h5py.File(path, "r", driver="sec2")  # whatever HDF5_DRIVER says
    except Exception as error:  # of a damaged file the library throws many kinds, here and below
        raise Error(f"{path}: is not a readable HDF5 file") from error
    try:
        with file:
            _require_sound(path, file.id)
            yield file
    except Error:
        raise
    except Exception as error:
        raise Error(f"{path}: is a damaged HDF5 file: {_reason(error)}") from error


def _require_sound(path: Path, file: h5py.h5f.FileID) -> None:
    """Raises Error as `open_hdf`, for what is not data of a run. A file that was looked through is not again."""
    about = path.stat()
    this = (about.st_dev, about.st_ino, about.st_ctime_ns, about.st_size)
    if this not in _sound:
        if fault := file.links.visit(partial(_fault_of_link, path, file), info=True):
            raise Error(f"{path}: is a damaged HDF5 file: {fault}; data of a run lie in its folder")
        _sound.add(this)


_sound: set[tuple[int, ...]] = set()


def _fault_of_dataset(made: h5py.h5p.PropDCID) -> str | None:
    """Returns why a dataset cannot be data of a run, by how it was made; None where nothing is wrong."""
    if made.get_layout() == h5py.h5d.VIRTUAL:
        return "is put together from other files"
    if made.get_external_count():
        return "keeps its numbers in another file"
    filters = [made.get_filter(i)[0] for i in range(made.get_nfilters())]
    foreign = [f"is packed by filter {f}, which is not a part of HDF5" for f in filters if f >= _FOREIGN_FILTERS]
    return foreign[0] if foreign else None


def _fault_of_link(path: Path, file: h5py.h5f.FileID, name: bytes, link: h5py.h5l.LinkInfo) -> str | None:
    """Returns what is wrong with a link of a file; None where nothing is."""
    fault = None
    if link.type == h5py.h5l.TYPE_HARD:
        try:
            found = h5py.h5o.open(file, name)
            fault = _fault_of_dataset(found.get_create_plist()) if isinstance(found, h5py.h5d.DatasetID) else None
        except (KeyError, RuntimeError):  # nobody can read what cannot be opened
            return None
    elif link.type != h5py.h5l.TYPE_EXTERNAL:
        fault = "is a link, and a run writes none there"
    else:
        other, place = file.links.get_val(name)
        own = name.rpartition(b"/")[2].partition(b" [")[0]  # the object of the mesh has no unit in its name
        if (other != MESH.encode() or place not in (b"/blocks/" + own, b"/contacts/" + own)
                or own.decode(errors="replace") not in _IN_MESH):
            fault = f"is a link to {_shown(place.decode(errors='replace'))} of the file " \
                    f"{_shown(other.decode(errors='replace'))}"
        elif path.with_name(MESH).is_symlink():
            fault = f"leads to {MESH}, which is a link itself"
    return fault and f"/{name.decode(errors='backslashreplace')} {fault}"


def within(file: h5py.File, name: str) -> Any:
    """Returns the object of this name; None where there is none, and where a link leads to it."""
    parts = name.split("/")
    places = ("/".join(parts[:i]) for i in range(1, len(parts) + 1))
    return file.get(name) if all(isinstance(file.get(p, getlink=True), h5py.HardLink) for p in places) else None


def dataset(file: h5py.File, name: str) -> np.ndarray:
    """Reads all of a dataset of numbers; raises Error when there is none of that name, or one is not finite."""
    values = within(file, name)
    if not isinstance(values, h5py.Dataset):
        raise Error(f"{file.filename}: has no dataset /{name}")
    # A damaged header may ask for more memory than there is.
    if values.size * values.dtype.itemsize > _TIGHTEST_PACKING * Path(file.filename).stat().st_size:
        raise Error(f"{file.filename}: /{name} is larger than the file; the file is damaged")
    if values.dtype.kind not in "iuf" or values.shape is None:
        raise Error(f"{file.filename}: /{name} does not hold numbers")
    numbers = values[()]
    if numbers.dtype.kind == "f" and not (np.abs(numbers) <= LARGEST).all():
        raise Error(f"{file.filename}: /{name} has a value that is not finite")
    return numbers


def names_in(path: Path, group: str) -> list[str]:
    """Returns names in a group of an HDF5 file; raises Error as `open_hdf`, and when there is no such group."""
    with open_hdf(path) as file:
        inner = within(file, group)
        if not isinstance(inner, h5py.Group):
            raise Error(f"{path}: has no group /{group}")
        return list(inner)


def read_array(path: Path, name: str, shape: tuple[int, ...]) -> np.ndarray:
    """Reads all of a dataset of an HDF5 file. Raises Error as `open_hdf` and `dataset`, and for another shape."""
    with open_hdf(path) as file:
        values = dataset(file, name)
    if values.shape != shape:
        raise Error(f"{path}: /{name} has shape {values.shape}, but the mesh asks for {shape}")
    return values


def read_json(path: Path) -> dict:
    """Reads the object in a JSON file; raises Error when it cannot be read or is something else."""
    value = _read_json(path)
    if not isinstance(value, dict):
        raise Error(f"{path}: is not a JSON object")
    return value


def read_json_list(path: Path) -> list:
    """Reads the list in a JSON file; raises Error when it cannot be read or is something else."""
    value = _read_json(path)
    if not isinstance(value, list):
        raise Error(f"{path}: is not a JSON list")
    return value


def _read_json(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise Error(f"{path}: cannot be read: {_reason(error)}") from error


def _read_rows(lines: bytes, columns: int) -> np.ndarray | None:
    """Reads (columns, rows) of whole lines of finite numbers, NaN where a cell is empty; None: something else."""
    global _core
    if _core is None and len(lines) > _FEW:
        try:
            from .. import _core as compiled
        except Exception:  # figures must not need it
            compiled = False
        _core = compiled
    if _core:
        return _core.read_rows(lines, columns, LARGEST)
    return read_rows(lines, columns)


_core: Any = None  # once it was asked for


def read_rows(lines: bytes, columns: int) -> np.ndarray | None:
    """Reads rows as the compiled part does, but slower."""
    if not lines.endswith(b"\n") or lines.translate(None, _NUMBERS):
        return None
    text = np.frombuffer(lines, dtype=np.uint8)
    ends = np.flatnonzero((text == ord(",")) | (text == ord("\n")))
    if len(ends) % columns:
        return None
    is_line_end = (text[ends] == ord("\n")).reshape(-1, columns)
    if not is_line_end[:, -1].all() or is_line_end[:, :-1].any():
        return None
    empty = np.diff(ends, prepend=-1) == 1
    if columns == 1 and empty.any():
        return None
    cells = b"," + lines.replace(b"\n", b",")
    for _ in range(2):
        cells = cells.replace(b",,", b",nan,")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = np.fromstring(cells[1:], sep=",")
        except (DeprecationWarning, ValueError):
            return None
    if len(values) != len(ends) or not (np.abs(values[~empty]) <= LARGEST).all():
        return None
    return values.reshape(-1, columns).T


def _reason(error: Exception) -> str:
    """Returns the reason on one line."""
    return " ".join((getattr(error, "strerror", None) or str(error) or type(error).__name__).split())


def _shown(cell: str) -> str:
    """Returns what stands in a file, for a message: in quotes, on one line, not long."""
    return ascii(cell if len(cell) <= _MOST_SHOWN else cell[:_MOST_SHOWN] + "...")
