"""What is known of the runs of a study folder: a SQLite database with one writer, which the folders can rebuild."""

from __future__ import annotations

import fcntl
import json
import math
import os
import sqlite3
import sys
import urllib.parse
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, TextIO

from ..errors import Error
from ..writing import refuse_link, write_text

DONE = "done"
CRASHED = "crashed"
TIMED_OUT = "timed out"
NOT_SETTLED = "not settled"
NOT_QUASI_STATIC = "not quasi-static"
NO_VALUE = "no value"
FAILED = (CRASHED, TIMED_OUT, NOT_SETTLED, NOT_QUASI_STATIC, NO_VALUE)


@dataclass(frozen=True)
class Result:
    """What came of a run.

    outputs: by what they were taken from (Output.what): the number, or None and why there is none.
    wall: of all attempts, s. version: physics version.
    """

    id: str
    seed: int
    state: str
    reason: str = ""
    outputs: dict[str, tuple[float | None, str]] = field(default_factory=dict)
    values: dict[str, Any] = field(default_factory=dict)
    host: str = ""
    begun: str = ""
    wall: float = 0.0
    attempts: int = 1
    version: int = 0

    def number(self, what: str) -> float:
        """An output; NaN where there is none, and where the run failed as a whole."""
        if self.state not in (DONE, NO_VALUE):
            return math.nan
        value = self.outputs.get(what, (None, ""))[0]
        return math.nan if value is None else value


_COLUMNS = tuple(Result.__dataclass_fields__)
_NAMES = ", ".join(f'"{name}"' for name in _COLUMNS)
_AS_JSON = ("outputs", "values")
# what comes of a database that is none, is cut, or holds something else
_DAMAGE = (sqlite3.Error, ValueError, TypeError, KeyError, AttributeError)

_said: set[str] = set()


def _say_once(line: str) -> None:
    """A command may open a store more than once."""
    if line not in _said:
        _said.add(line)
        print(line, file=sys.stderr)


class Store:
    """Results by the identity of their runs. One process at a time writes; others may read."""

    def __init__(self, folder: Path, writes: bool = True):
        """writes: False for a reader, which may come while another process writes; what it puts in, it alone sees.

        Raises Error where another process has it open to write.
        """
        self.folder = folder
        self._results: dict[str, Result] = {}
        self._base: sqlite3.Connection | None = None
        self._lock: TextIO | None = None
        if not writes:
            self._read()
            return
        folder.mkdir(parents=True, exist_ok=True)
        if not self._take_lock():
            raise Error(f"{folder}: another process runs a study in this folder") from None
        self._open()

    def _take_lock(self) -> bool:
        refuse_link(self.folder / "lock")
        refuse_link(self._file)
        self._lock = open(self.folder / "lock", "a", encoding="utf-8")
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            self._lock.close()
            self._lock = None
            return False
        return True

    @property
    def _file(self) -> Path:
        return self.folder / "study.sqlite"

    def _read(self) -> None:
        if not self._file.exists():
            return
        try:
            base = sqlite3.connect(f"file:{urllib.parse.quote(str(self._file))}?mode=ro", uri=True)
            with closing(base):
                self._take_from(base)
        except _DAMAGE as error:
            self._raise_if_busy(error)
            self._read_records(error)

    def _read_records(self, error: Exception) -> None:
        """In the place of a database that cannot be read; makes it again where that is possible."""
        self._results.clear()
        try:
            if self._take_lock():
                self._open()
                self.close()
                return
        except (OSError, Error):  # nothing can be written here, or another process does it
            self.close()
        self.put(_records(self.folder / "runs"))
        _say_once(f"warning: {self._file} cannot be read ({error}) nor made again here; what is known is taken from "
                  f"the records of {len(self)} runs")

    def _open(self) -> None:
        is_there = self._file.exists()
        try:
            is_new = self._connect()
        except _DAMAGE as error:
            self._raise_if_busy(error)
            if isinstance(error, sqlite3.OperationalError) and not self._is_broken():
                raise Error(f"{self._file}: {error}") from error  # a full disk, say, and nothing wrong with the file
            self._set_aside()
            is_new = self._connect()
        if is_new:
            self.put(_records(self.folder / "runs"))
        if is_new and is_there:
            _say_once(f"warning: {self._file} could not be read; it is made again from the records of {len(self)} runs")

    def _connect(self) -> bool:
        """Whether the database was made now."""
        self._results.clear()
        if self._file.exists() and not os.access(self._file, os.R_OK | os.W_OK):
            raise sqlite3.OperationalError("no permission to read and write it")
        base = sqlite3.connect(self._file)
        try:
            is_new = not base.execute("SELECT count(*) FROM sqlite_master WHERE name = 'runs'").fetchone()[0]
            base.execute(f"CREATE TABLE IF NOT EXISTS runs ({_NAMES}, PRIMARY KEY (id))")
            self._take_from(base)
        except _DAMAGE:
            base.close()
            raise
        self._base = base
        return is_new

    def _is_broken(self) -> bool:
        """Of an error that can have other causes: whether it is that of the file."""
        return self._file.is_dir() or not os.access(self._file, os.R_OK | os.W_OK)

    def _set_aside(self) -> None:
        """With what SQLite keeps beside it, which would be taken for that of the new one."""
        for ending in ("", "-journal", "-wal", "-shm"):
            file = self._file.with_name(self._file.name + ending)
            if os.path.lexists(file):
                number, aside = 1, file.with_name(f"study.damaged{ending}")
                while os.path.lexists(aside):
                    number, aside = number + 1, file.with_name(f"study.damaged.{number}{ending}")
                file.rename(aside)

    def _raise_if_busy(self, error: Exception) -> None:
        if isinstance(error, sqlite3.OperationalError) and "locked" in str(error):
            raise Error(f"{self._file}: {error}") from error

    def _take_from(self, base: sqlite3.Connection) -> None:
        if [row[1] for row in base.execute("PRAGMA table_info(runs)")] != list(_COLUMNS):
            raise sqlite3.DatabaseError("holds no table of runs")  # SQLite would take a name for a text
        for row in base.execute(f"SELECT {_NAMES} FROM runs"):
            named = dict(zip(_COLUMNS, row))
            named.update({key: json.loads(named[key]) for key in _AS_JSON})
            named["outputs"] = {what: (value, why) for what, (value, why) in named["outputs"].items()}
            self._results[named["id"]] = Result(**named)

    def get(self, *ids: str) -> Result | None:
        """The result of the first of these runs that there is one of."""
        return next((self._results[i] for i in ids if i in self._results), None)

    def put(self, results: Iterable[Result]) -> None:
        """Raises Error where they cannot be written down, as on a full disk; what has a record is found again by it."""
        rows = []
        for result in results:
            self._results[result.id] = result
            named = asdict(result)
            rows.append([json.dumps(named[key]) if key in _AS_JSON else named[key] for key in _COLUMNS])
        if self._base is not None:
            self._write(f"INSERT OR REPLACE INTO runs VALUES ({', '.join('?' * len(_COLUMNS))})", rows)

    def drop(self, ids: Iterable[str]) -> None:
        """Forgets runs and their records; they are then run again."""
        gone = [(i,) for i in ids]
        for (i,) in gone:
            self._results.pop(i, None)
            record_file(self.folder / "runs", i).unlink(missing_ok=True)
        self._write("DELETE FROM runs WHERE id = ?", gone)

    def _write(self, what: str, rows: Sequence[Sequence[Any]]) -> None:
        """For each row, all or none. Raises Error where it cannot be written."""
        assert self._base is not None
        try:
            with self._base:
                self._base.executemany(what, rows)
        except sqlite3.OperationalError as error:
            raise Error(f"{self._file}: {error}") from error

    def __iter__(self) -> Iterator[Result]:
        return iter(self._results.values())

    def __len__(self) -> int:
        return len(self._results)

    def close(self) -> None:
        if self._base is not None:
            self._base.close()
            self._base = None
        if self._lock is not None:
            self._lock.close()
            self._lock = None


@contextmanager
def opened(folder: Path, writes: bool = True) -> Iterator[Store]:
    """A store, closed at the end."""
    store = Store(folder, writes)
    try:
        yield store
    finally:
        store.close()


def record_file(runs: Path, run: str) -> Path:
    """Beside the folder of a run: what came of it."""
    return runs / f"{run}.json"


def write_record(runs: Path, result: Result) -> None:
    """In the place of an earlier one, which stays whole if this is broken off."""
    file = record_file(runs, result.id)
    write_text(file, json.dumps(asdict(result)))


def read_record(runs: Path, run: str) -> Result | None:
    """None where there is none that is whole."""
    try:
        named = json.loads(record_file(runs, run).read_text(encoding="utf-8"))
        outputs = {what: (value, why) for what, (value, why) in named["outputs"].items()}
        return replace(Result(**{key: named[key] for key in _COLUMNS}), outputs=outputs)
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _records(runs: Path) -> list[Result]:
    found = [read_record(runs, file.stem) for file in sorted(runs.glob("*.json"))]
    return [record for record in found if record is not None and record.state in (DONE, *FAILED)]
