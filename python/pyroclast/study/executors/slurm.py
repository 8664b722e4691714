"""Runs as tasks of Slurm arrays.

Beside the folder of the runs are slurm.json, which tells what was submitted, and slurm/, with the jobs of each array
and what its tasks print. Only the results in the folder of the runs tell what came of a run. Jobs go on in the queue
when the driver has ended, and the next one knows them again.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import shlex
import statistics
import subprocess
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from ...errors import Error
from ...writing import make_folder, write_text
from ..file import SlurmSettings
from ..start import python
from ..store import RunResult, begun_file
from ..work import Job, given_up, is_of_full_disk, kept, known_result, made

MOST_LOST = 3
"""Times, one after the other, that the task of a run ends without a result before the run is given up."""

_TASK_TIME = 600.0  # s, of a task
_SHARE_OF_TIME = 0.8  # of the time of a task, that its runs should take at most
_WARNING = 120  # s before the time of a task is over
_SHARE_OF_WARNING = 0.25  # of the time of a task, at most
_LOOK = 0.2  # s between two looks at what asks to stop
_GROWTH = 1.5  # of the interval between two questions to Slurm

_LATER = re.compile(r"(?:QOS|Assoc)\w*Submit\w*Limit|job submit limit|temporarily unable to accept|queue full|"
                    r"Job dependency problem", re.IGNORECASE)
_UNCLEAR = re.compile(r"Unable to contact|timed out|Zero Bytes|Connection (?:refused|reset)|"
                      r"Unexpected message", re.IGNORECASE)


class _Refused(Exception):
    """Slurm takes no job now."""


class _NoAnswer(Exception):
    """Slurm did not say whether it took a job."""


@dataclass
class Array:
    """Tasks that were submitted together: task i makes the runs from number i count on.

    job: number in the queue; empty as long as it is not known whether sbatch was heard. over: tasks that need no more
    attention.
    """

    name: str
    runs: list[str]
    count: int
    job: str = ""
    over: list[int] = field(default_factory=list)

    @property
    def open(self) -> list[int]:
        """Tasks that are not over."""
        gone = set(self.over)
        return [i for i in range(math.ceil(len(self.runs) / self.count)) if i not in gone]

    def of_task(self, task: int) -> list[str]:
        return self.runs[task * self.count:(task + 1) * self.count]


class Book:
    """What is in the queue, in a file."""

    def __init__(self, folder: Path):
        """Raises Error where the file is damaged."""
        self.folder = folder / "slurm"
        self._file = folder / "slurm.json"
        self.prefix = f"pyroclast-{hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:8]}-"
        self.arrays: list[Array] = []
        self._number = 0
        if self._file.exists():
            try:
                written = json.loads(self._file.read_text(encoding="utf-8"))
                self._number = int(written["number"])
                self.arrays = [Array(**entry) for entry in written["arrays"]]
            except (OSError, ValueError, KeyError, TypeError) as error:
                raise Error(f"{self._file}: cannot be read ({error}); cancel the jobs called {self.prefix}..., "
                            "then remove it") from error

    def write(self) -> None:
        text = json.dumps({"number": self._number, "arrays": [asdict(array) for array in self.arrays]})
        write_text(self._file, text)

    def add(self, jobs: Sequence[Job], count: int) -> Array:
        """Writes an array down before it is submitted, so that it is known whatever happens."""
        make_folder(self.folder)
        self._number += 1
        array = Array(f"{self.prefix}{self._number}", [job.id for job in jobs], count)
        write_text(self.jobs_file(array), "".join(f"{job.to_json()}\n" for job in jobs))
        self.arrays.append(array)
        self.write()
        return array

    def drop(self, array: Array) -> None:
        self.arrays.remove(array)
        self.write()
        self.jobs_file(array).unlink(missing_ok=True)

    def jobs_file(self, array: Array) -> Path:
        return self.folder / f"{array.name}.jobs"

    def log(self, array: Array, task: int | str) -> Path:
        """Returns what a task prints."""
        return self.folder / f"{array.name}_{task}.log"


@dataclass
class Slurm:
    """Tasks of arrays, as many at once as the study file says.

    interval: between two questions to Slurm, s, at first and at most. patience: until a job that was refused is
    submitted again, s. grace: until a run counts as lost whose task is not in the queue any more, s; a network file
    system may show its result that late.
    """

    settings: SlurmSettings
    say: Callable[[str], None] = print
    interval: tuple[float, float] = (1.0, 10.0)
    patience: float = 30.0
    grace: float = 60.0
    name: str = field(default="slurm", init=False)

    @property
    def slots(self) -> int:
        return self.settings.slots

    def run(self, jobs: Sequence[Job], runs: Path, finished: Callable[[RunResult], None],
            stopped: Callable[[], bool]) -> None:
        """Makes the jobs; see executors. Raises Error with the words of Slurm where it does not take them."""
        make_folder(runs)
        _Queue(self, jobs, runs.resolve(), finished, stopped).work()


class _Queue:
    """The jobs of one call, on their way through the queue."""

    def __init__(self, slurm: Slurm, jobs: Sequence[Job], runs: Path, finished: Callable[[RunResult], None],
                 stopped: Callable[[], bool]):
        self._slurm, self._runs, self._finished, self._stopped = slurm, runs, finished, stopped
        self._left = {job.id: job for job in jobs}
        self._ranks = max((job.ranks for job in jobs), default=1)
        self._book = Book(runs.parent)
        self._walls: list[float] = []  # of runs that are over, s
        self._lost: dict[str, tuple[int, tuple[str, int] | None]] = {}  # times, and what was kept at the last
        self._gone: dict[tuple[str, int], float] = {}  # tasks that left the queue without all results, and when
        self._has_results = False
        self._said = ""
        self._next_try = 0.0
        self._largest = _largest_array()
        self._size = self._largest  # of an array, in tasks

    def work(self) -> None:
        for run in list(self._left):
            self._collect(run)
        interval, most = self._slurm.interval
        while self._left and not self._stopped():
            states = self._states()
            if states is not None:
                self._look(states)
                self._submit(states)
            if self._left:
                self._sleep(interval)
                interval = min(_GROWTH * interval, most)
        if self._left:
            self._say_what_goes_on()
        elif self._book.arrays and (states := self._states()) is not None:
            self._look(states)

    def _sleep(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while not self._stopped() and (left := end - time.monotonic()) > 0.0:
            time.sleep(min(left, _LOOK))

    def _tell(self, text: str) -> None:
        """Tells something once, as long as it stays the same."""
        if text != self._said:
            self._slurm.say(text)
        self._said = text

    def _collect(self, run: str, is_in_queue: bool = False) -> None:
        """Takes in what came of a run, if it is over. is_in_queue: who makes it writes that down."""
        job = self._left.get(run)
        find = known_result if is_in_queue else made
        result = find(job, self._runs) if job else None
        if result is not None:
            self._take(result)
            self._has_results = True

    def _take(self, result: RunResult) -> None:
        del self._left[result.id]
        if result.wall > 0.0:
            self._walls.append(result.wall)
        self._lost.pop(result.id, None)
        self._finished(result)

    def _states(self) -> dict[tuple[str, int], str] | None:
        """Returns the states of our tasks in the queue; None where Slurm does not answer."""
        try:
            said = _ask("squeue", "--noheader", "--array", f"--user={os.getuid()}", "--format=%j|%F|%K|%T")
        except Error as error:
            self._tell(f"{error}; asking again")
            return None
        found = {}
        for line in said.splitlines():
            name, job, task, state = line.strip().rsplit("|", 3)
            if name.startswith(self._book.prefix) and task.isdigit():
                found[name, int(task)] = state
                for array in self._book.arrays:
                    if array.name == name:
                        array.job = job
        unknown = sorted({name for name, _ in found} - {array.name for array in self._book.arrays})
        if unknown:
            raise Error(f"{self._book.folder}.json: does not know the jobs {', '.join(unknown)} of this study, which "
                        f"are in the queue; to end them: scancel {shlex.quote('--name=' + ','.join(unknown))}")
        return found

    def _look(self, states: dict[tuple[str, int], str]) -> None:
        """Takes in results, and finds what was lost. states: asked for before results are read."""
        now = time.monotonic()
        for array in list(self._book.arrays):
            is_changed = False
            for task in array.open:
                state = states.get((array.name, task))
                if state == "PENDING":
                    self._gone.pop((array.name, task), None)
                    continue
                for run in array.of_task(task):
                    self._collect(run, state is not None)
                if state is not None:
                    self._gone.pop((array.name, task), None)
                    continue
                missing = [run for run in array.of_task(task) if run in self._left]
                since = self._gone.setdefault((array.name, task), now)
                if missing and now - since < self._slurm.grace:
                    self._tell(f"tasks are out of the queue; their runs have {self._slurm.grace:g} s to appear")
                    continue
                if missing:
                    self._lose(array, task, missing)
                else:
                    self._book.log(array, task).unlink(missing_ok=True)
                array.over.append(task)
                is_changed = True
            if not array.open:
                self._book.drop(array)
            elif is_changed:
                self._book.write()

    def _lose(self, array: Array, task: int, missing: list[str]) -> None:
        """Counts runs whose task ended without them: those that were going on, or all where none was."""
        if not array.job:
            return  # it never was in the queue
        begun = [run for run in missing if begun_file(self._runs, run).exists()]
        suspects = begun if begun or len(missing) < len(array.of_task(task)) else missing
        last = _last_line(self._book.log(array, task))
        if is_of_full_disk(last):
            raise Error(f"task {array.job}_{task} ended: {last}")
        said = f": {last}" if last else ""
        self._slurm.say(f"task {array.job}_{task} ended without {len(missing)} of its runs{said}")
        for run in suspects:
            times, before = self._lost.get(run, (0, None))
            now = kept(self._runs / run)
            times = times + 1 if now == before else 1
            self._lost[run] = times, now
            if times < MOST_LOST:
                continue
            if run not in begun and not self._has_results:
                raise Error(f"tasks end before they begin a run, {times} times: {last or 'they say nothing'}; "
                            f"{self._book.log(array, task)} has the output of the last one")
            self._take(given_up(self._left[run], self._runs, f"its task ended {times} times before anything new was "
                                f"kept; is there memory enough?{said}"))

    def _submit(self, states: dict[tuple[str, int], str]) -> None:
        """Submits the jobs that are in no task, unless Slurm has just refused them."""
        settings = self._slurm.settings
        queued = {run for array in self._book.arrays for task in array.open for run in array.of_task(task)}
        waiting = [job for job in self._left.values() if job.id not in queued]
        while waiting and not self._stopped() and time.monotonic() >= self._next_try:
            alone = [job for job in waiting if job.id in self._lost]  # what ended a task may end the next one
            expected = self._expected(waiting)
            chosen, count = alone or waiting, 1 if alone else runs_per_task(settings, len(waiting), expected)
            if not alone and not settings.points_per_task and expected == 0.0 and len(waiting) > settings.slots:
                if queued:
                    return  # the first runs tell how many a task takes
                chosen = chosen[:settings.slots]
                queued.update(job.id for job in chosen)
            chosen = chosen[:count * self._size]
            after = [a.job for a in self._book.arrays if a.job and any((a.name, task) in states for task in a.open)]
            array = self._book.add(chosen, count)
            try:
                array.job = self._sbatch(array, after[-1] if after else "")
            except _Refused as refused:
                self._book.drop(array)
                tasks = math.ceil(len(chosen) / count)
                self._size = max(1, min(settings.slots, tasks) if states else 1, tasks // 2)
                self._tell(f"{refused}; trying again every {self._slurm.patience:g} s")
                self._next_try = time.monotonic() + self._slurm.patience
                return
            except _NoAnswer as unclear:
                self._tell(f"{unclear}; looking for it in the queue")
                return
            except Error:
                self._book.drop(array)
                raise
            self._book.write()
            states |= {(array.name, task): "PENDING" for task in array.open}
            self._size = min(2 * self._size, self._largest)
            self._slurm.say(f"job {array.job}: {len(chosen)} runs in {len(array.open)} tasks")
            taken = set(array.runs)
            waiting = [job for job in waiting if job.id not in taken]

    def _expected(self, jobs: Sequence[Job]) -> float:
        """Returns the time that a run will probably take, s; 0: not known."""
        return max(max(job.expected for job in jobs), statistics.median(self._walls) if self._walls else 0.0)

    def _sbatch(self, array: Array, after: str) -> str:
        """Submits an array; returns the number of its job. Raises Error with the words of sbatch."""
        settings = self._slurm.settings
        seconds = round(settings.time)
        warning = min(_WARNING, round(_SHARE_OF_WARNING * seconds))
        package = Path(__file__).parents[3]  # not resolved: in a build tree the compiled part stands beside links
        worker = python("pyroclast.study.worker", str(self._book.jobs_file(array)), str(self._runs), str(array.count))
        script = (f"#!/bin/sh\nexport PYTHONPATH={shlex.quote(str(package))}${{PYTHONPATH:+:$PYTHONPATH}}\n"
                  f"exec {shlex.join(worker)}\n")
        tasks = len(array.open)
        log = str(self._book.log(array, "TASK")).replace("%", "%%").replace("TASK", "%a")
        words = ["sbatch", "--parsable", f"--job-name={array.name}", f"--array=0-{tasks - 1}%{settings.slots}",
                 f"--time={seconds // 60}:{seconds % 60:02d}", f"--signal=B:TERM@{warning}", "--requeue",
                 "--open-mode=append", f"--output={log}", f"--ntasks={self._ranks}", "--cpus-per-task=1",
                 *([f"--dependency=afterany:{after}"] if after else []), *settings.options]
        # a session of its own: Ctrl-C is the driver's, and must not end it half-way
        lines = []
        with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              start_new_session=True) as process:
            assert process.stdin and process.stdout and process.stderr
            process.stdin.write(script)
            process.stdin.close()
            for line in process.stderr:
                lines.append(line)
                if "sleeping and retrying" in line:
                    process.terminate()  # it would go on for two minutes, and fewer tasks may be let in now
            out = process.stdout.read()
        if process.returncode == 0:
            return out.strip().splitlines()[-1].partition(";")[0]
        why = _words("sbatch", process.returncode, lines)
        if _LATER.search(why):
            raise _Refused(why)
        if _UNCLEAR.search(why):
            raise _NoAnswer(why)
        raise Error(why)

    def _say_what_goes_on(self) -> None:
        jobs = " ".join(array.job or f"--name={array.name}" for array in self._book.arrays)
        if jobs:
            self._slurm.say(f"{len(self._left)} runs are not done; jobs {jobs} go on in the queue, and the same "
                            f"command takes them in (to end them: scancel {jobs})")


def runs_per_task(settings: SlurmSettings, jobs: int, expected: float) -> int:
    """Returns how many runs a task takes: as the study file says, else by the time a run may take, s; 0: not known."""
    if settings.points_per_task:
        return settings.points_per_task
    if not expected > 0.0:
        return 1
    in_time = int(min(_TASK_TIME, _SHARE_OF_TIME * settings.time) / expected)
    return max(1, min(in_time, jobs // settings.slots))


def _ask(*words: str) -> str:
    """Returns what a command of Slurm prints. Raises Error with its words."""
    try:
        said = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, start_new_session=True)
    except FileNotFoundError:
        raise Error(f"{words[0]} is not on the PATH; Slurm is used where jobs are submitted by sbatch") from None
    if said.returncode != 0:
        raise Error(_words(words[0], said.returncode, said.stderr.splitlines()))
    return said.stdout


def _words(name: str, code: int, lines: Iterable[str]) -> str:
    """Returns what a command of Slurm says is wrong, on a line."""
    said = "; ".join(line.strip() for line in lines if line.strip()) or f"exit code {code}"
    return said if said.startswith(name) else f"{name}: {said}"


def _largest_array() -> int:
    """Returns tasks that an array may have. Raises Error where there is no Slurm."""
    _ask("sbatch", "--version")
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", _ask("scontrol", "show", "config"), re.MULTILINE)
    return max(1, int(found[1])) if found else 1001


def _last_line(file: Path) -> str:
    try:
        lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    return next((line.strip() for line in reversed(lines) if line.strip()), "")
