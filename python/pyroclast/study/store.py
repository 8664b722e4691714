"""What came of the runs of a study: of each a file in the folder `runs`, beside the folder of the run.

10,000 of them are read in 0.5 s of processor time, out of one file or a database in 0.25 s; the decks of 10,000 points
take 27 s.
"""

from __future__ import annotations

import fcntl
import json
import math
import os
from collections.abc import Container, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from ..errors import Error
from ..programs import complain
from ..writing import make_folder, refuse_link, write_text

BEGUN = "begun"  # in the place of a state, in `begun_file`
DONE = "done"
CRASHED = "crashed"
TIMED_OUT = "timed out"
NOT_SETTLED = "not settled"
NOT_QUASI_STATIC = "not quasi-static"
NO_VALUE = "no value"
FAILED = (CRASHED, TIMED_OUT, NOT_SETTLED, NOT_QUASI_STATIC, NO_VALUE)

_AT_ONCE = 16  # files that are read at a time: on a disk, and more so on a network, one waits for each
REASON_LENGTH = 300  # characters of a reason that are kept
_said: set[str] = set()


@dataclass(frozen=True)
class RunResult:
    """What came of a run.

    outputs: by what they were taken from (Output.what): the number and why it is in doubt, or None and why there is
        none.
    state: as `judged` by all outputs that were taken.
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
        """Returns the number of an output; NaN where there is none, and where the run failed as a whole."""
        if self.state not in (DONE, NO_VALUE):
            return math.nan
        value = self.outputs.get(what, (None, ""))[0]
        return math.nan if value is None else value

    def doubt(self, what: str) -> str:
        """Returns why an output that has a value is in doubt; empty where nothing is against it."""
        return "" if math.isnan(self.number(what)) else self.outputs[what][1]


def judged(result: RunResult, outputs: Iterable[str], may_lack: Container[str] = ()) -> RunResult:
    """Judges a run that came to its end by some of its outputs: it has no value where it lacks one of them that it must
    have, or all of them. Returns it with its state, and with the reasons of all that it lacks, or else what it said
    itself, and of all that is in doubt.
    """
    if result.state not in (DONE, NO_VALUE):
        return result
    found = {what: result.outputs.get(what, (None, "was not taken")) for what in outputs}
    missing = {what: why for what, (value, why) in found.items() if value is None}
    is_done = len(missing) < max(len(found), 1) and all(what in may_lack for what in missing)
    reason = "; ".join(f"{what}: {why}" for what, why in missing.items())
    if not missing and result.state == DONE:
        reason = result.reason  # a stage that did not end as the deck asks
    doubts = dict.fromkeys(why for value, why in found.values() if value is not None and why and why not in reason)
    reason = "; ".join(filter(None, [reason, *doubts]))[:REASON_LENGTH]
    return replace(result, state=DONE if is_done else NO_VALUE, reason=reason)


def result_file(runs: Path, run: str) -> Path:
    """Returns the file beside the folder of a run that says what came of it."""
    return runs / f"{run}.json"


def begun_file(runs: Path, run: str) -> Path:
    """Returns the file beside a run's folder with its attempts so far. It goes last."""
    return runs / f"{run}.begun"


def read_result(file: Path) -> RunResult | None:
    """Reads a result; None where there is none. A damaged one is none, which is said once: its run is made again."""
    try:
        named: dict[str, Any] = json.loads(file.read_bytes())
        outputs = {what: (None if value is None else float(value), str(why))
                   for what, (value, why) in named["outputs"].items()}
        named.update(outputs=outputs, wall=float(named["wall"]), attempts=int(named["attempts"]))
        result = RunResult(**named)
        states = (BEGUN,) if file.suffix == ".begun" else (DONE, *FAILED)
        if result.id != file.stem or result.state not in states or not math.isfinite(result.wall):
            raise ValueError("it is not of this run, or not of one that is over")
        return result
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        line = f"{file} cannot be read ({error}); its run counts as not made"
        if line not in _said:
            _said.add(line)
            complain(line, "warning")
        return None


def write_result(file: Path, result: RunResult) -> None:
    """Writes a result in the place of an earlier one, which stays whole until then; not where it is there already."""
    if read_result(file) != result:
        write_text(file, json.dumps(asdict(result)))


class Store:
    """Results by the identity of their runs."""

    def __init__(self, folder: Path):
        """Opens a store. folder: of the study. What is put in is written down by `only_writer` alone."""
        self.folder = folder
        self.runs = folder / "runs"
        self.is_writer = False
        self._results: dict[str, RunResult] = {}
        self._stamps: dict[str, tuple[int, ...]] = {}  # of the files that results were read from, by run
        self.look()

    def look(self) -> None:
        """Takes in what was written, replaced and removed since the last look, by whatever process."""
        there = self._stamps_now()
        for run in self._stamps.keys() - there.keys():
            self._results.pop(run, None)
        changed = [run for run, stamp in there.items() if self._stamps.get(run) != stamp]
        with ThreadPoolExecutor(_AT_ONCE) as pool:
            read = list(pool.map(lambda run: read_result(result_file(self.runs, run)), changed))
        for run, result in zip(changed, read):
            self._results.pop(run, None)
            if result is not None:
                self._results[run] = result
        self._stamps = there

    def begun(self) -> set[str]:
        """Returns identities of the runs that are under way or were broken off."""
        return {file.stem for file in self.runs.glob("*.begun")}

    def _stamps_now(self) -> dict[str, tuple[int, ...]]:
        """Returns the number and time of each file: a file is replaced by another one, so it is changed where its
        number or its time is.
        """
        found: dict[str, tuple[int, ...]] = {}
        for name in os.listdir(self.runs) if self.runs.exists() else ():
            if name.endswith(".json"):
                with suppress(FileNotFoundError):  # another process forgets it now
                    known = os.stat(f"{self.runs}/{name}")
                    found[name.removesuffix(".json")] = (known.st_ino, known.st_mtime_ns, known.st_size)
        return found

    def get(self, *ids: str) -> RunResult | None:
        """Returns the result of the first of these runs that there is one of."""
        return next((self._results[i] for i in ids if i in self._results), None)

    def put(self, result: RunResult) -> None:
        """Raises OSError where it cannot be written down, as on a full disk."""
        self._results[result.id] = result
        if self.is_writer:
            write_result(result_file(self.runs, result.id), result)

    def drop(self, ids: Iterable[str]) -> None:
        """Forgets results of runs, which are then made again."""
        for run in ids:
            self._results.pop(run, None)
            for file in (result_file(self.runs, run), begun_file(self.runs, run)):
                file.unlink(missing_ok=True)

    def __iter__(self) -> Iterator[RunResult]:
        return iter(list(self._results.values()))


@contextmanager
def only_writer(folder: Path) -> Iterator[Store]:
    """Holds the results of a study, which no other driver writes meanwhile.

    Raises Error where another process runs a study in the folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    refuse_link(folder / "lock")
    with open(folder / "lock", "a", encoding="utf-8") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise Error(f"{folder}: another process runs a study in this folder") from None
        make_folder(folder / "runs")
        store = Store(folder)
        store.is_writer = True
        try:
            yield store
        finally:
            store.is_writer = False
