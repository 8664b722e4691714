"""One run in its folder: begun or resumed, judged, and thinned."""

from __future__ import annotations

import ctypes
import datetime
import errno
import json
import math
import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from ..errors import Error
from ..writing import make_folder, refuse_link
from .hashes import require_unchanged
from .outputs import Output, read_facts, read_summary
from .start import FOLDER, environment, on_ranks, python
from .store import (BEGUN, CRASHED, DONE, NO_VALUE, NOT_QUASI_STATIC, NOT_SETTLED, REASON_LENGTH, TIMED_OUT, RunResult,
                    begun_file, judged, read_result, result_file, write_result)

MOST_IN_VAIN = 10
"""Attempts, one after the other, that were ended from outside before they kept anything new."""

PATIENCE = 30.0
"""Time that a process gets to keep its state before it is killed, s."""

_LEAST_ROOM = 1e6  # bytes; with less, a process that fails without a word has probably no room to write one
_LARGE = ("history.csv", "specimen", "fields", "figures", "checkpoints", "frames.json")
_PR_SET_PDEATHSIG = 1
_REASON_LINES = 3  # of what a process wrote last: an error, and what it says of it
_libc = ctypes.CDLL(None)  # before a fork: a child may not import

_QUIETLY = ("--no-figures", "--threads", "1", "--quiet")

_STATES = {"not_settled": NOT_SETTLED, "unstable": CRASHED}
"""States of runs that came to their end and give no value, by `outcome_id` of the run or of one of its stages."""


@dataclass(frozen=True)
class Job:
    """A run that is to be made.

    command: as its user would type it, without the folder; of a function FILE:NAME alone.
    checkpoint: wall time between two checkpoints, s.
    expected: wall time that it will probably take, s; 0: not known.
    code: hash of the code of a function or a command. files: that a command runs, with the SHA-256 of each.
    ranks: processes that share the body.
    """

    id: str
    seed: int
    kind: str
    command: tuple[str, ...]
    values: dict[str, Any]
    outputs: tuple[str, ...]
    keep: str
    wall_limit: float
    checkpoint: float
    version: int
    expected: float = 0.0
    code: str = ""
    files: dict[str, str] = field(default_factory=dict)
    ranks: int = 1

    @classmethod
    def from_json(cls, text: str) -> Job:
        named: dict[str, Any] = json.loads(text)
        named.update(command=tuple(named["command"]), outputs=tuple(named["outputs"]))
        return cls(**named)

    def to_json(self) -> str:
        return json.dumps(asdict(self))

    def line(self, folder: Path) -> list[str]:
        """Returns the command line of the run from its beginning, with results in a folder."""
        if self.kind == "function":
            return python("pyroclast.study.call", self.command[0], self.code, json.dumps(self.values),
                          str(self.seed), str(folder / "summary.json"))
        if self.kind == "command":
            return [word.replace(FOLDER, str(folder)) for word in self.command]
        fields = [] if self.keep == "all" else ["--no-fields"]
        return on_ranks(self.ranks, [*self.command, "--out", str(folder), *_QUIETLY, *fields])


def _log_file(runs: Path, run: str) -> Path:
    """Returns what a run prints, until it is over."""
    return runs / f"{run}.log"


class Attempt:
    """A process that makes a run, or goes on with one that was broken off.

    It dies with the thread that made it: no run is left behind when a driver is killed.
    """

    def __init__(self, job: Job, runs: Path):
        self.job = job
        self._runs = runs
        self.folder = runs / job.id
        before = read_result(begun_file(runs, job.id))
        self._wall_before = before.wall if before else 0.0
        self.attempts = before.attempts + 1 if before else 1
        self._log = _log_file(runs, job.id)
        self._kept_before = kept(self.folder)
        self._begun = datetime.datetime.now(datetime.timezone.utc)
        self._clock = time.monotonic()  # a limit follows no clock that somebody sets
        command = self._command()
        write_result(begun_file(runs, job.id), self._result(BEGUN))
        make_folder(self.folder)
        refuse_link(self._log)
        with open(self._log, "ab") as log:
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                            start_new_session=True, preexec_fn=die_with_parent(os.getpid()),
                                            env=environment(job.files))
        self._asked: float | None = None
        self.asked_to_stop = self.is_late = False

    def _command(self) -> list[str]:
        job = self.job
        if job.kind != "pyroclast":
            require_unchanged(job.files)
            return job.line(self.folder)
        checkpoint = ["--checkpoint", f"{job.checkpoint:g} s"]
        if kept(self.folder) is not None:
            return on_ranks(job.ranks, [job.command[0], "resume", str(self.folder), *_QUIETLY, *checkpoint])
        shutil.rmtree(self.folder, ignore_errors=True)  # of an attempt that was ended before its first checkpoint
        return [*job.line(self.folder), *checkpoint]

    @property
    def time_left(self) -> float:
        """Time until the wall limit, s."""
        return self.job.wall_limit - self._wall_before - self._wall()

    def _wall(self) -> float:
        return time.monotonic() - self._clock

    def look_after(self, stopped: bool) -> None:
        """Asks the process to keep its state and end where all stops, or at its wall limit; kills one that does not."""
        late = self.time_left <= 0.0
        if (stopped or late) and self._asked is None:
            self._asked, self.is_late = time.monotonic(), late and not stopped
            self.asked_to_stop = stopped
            # mpirun and srun would leave the ranks no time on SIGTERM
            _signal(self.process, signal.SIGTERM if self.job.ranks == 1 else signal.SIGUSR1)
        elif self._asked is not None and time.monotonic() - self._asked > PATIENCE:
            _signal(self.process, signal.SIGKILL)

    def end(self) -> RunResult | None:
        """Returns what came of the process, which has ended; None where it was ended from outside and another one goes
        on.

        Raises Error where the disk is full: that is no fault of the run, and the next one would fare no better.
        """
        code = self.process.wait()
        if self.job.ranks > 1 and code > 128:
            code = 128 - code  # so do mpirun and srun tell the signal that ended a rank
        summary = read_summary(self.folder)
        is_whole = summary is not None and not was_stopped(summary)
        if is_whole and (code in (0, 2) or (code < 0 and self.job.kind == "pyroclast")):
            assert summary is not None
            return self._finish(*judge(summary), summary)
        if self.is_late:
            return self._finish(TIMED_OUT, f"wall limit of {self.job.wall_limit:g} s", None)
        said = self._said()
        if code != 0 and (is_of_full_disk(said) or not said and shutil.disk_usage(self._runs).free < _LEAST_ROOM):
            raise Error(f"{said or f'{self._runs}: {os.strerror(errno.ENOSPC)}'}; runs keep their state: with room "
                        "again, the same command goes on")
        ended_outside = self.asked_to_stop or code in (-signal.SIGKILL, -signal.SIGTERM, -signal.SIGHUP, -signal.SIGINT,
                                                       130)
        if not ended_outside:
            how = f"signal {-code}" if code < 0 else f"exit code {code}" if code else "no summary.json was left"
            return self._finish(CRASHED, f"{how}: {said}" if said else how, None)
        write_result(begun_file(self._runs, self.job.id), self._result(BEGUN))
        return None

    @property
    def has_kept(self) -> bool:
        """Whether it kept something that the attempt before had not."""
        return kept(self.folder) != self._kept_before

    def give_up(self) -> RunResult:
        """Returns the result where one attempt after the other was ended from outside."""
        return self._finish(CRASHED, f"ended from outside {MOST_IN_VAIN} times before anything new was kept; is there "
                            "memory enough?", None)

    def _finish(self, state: str, reason: str, summary: dict[str, Any] | None) -> RunResult:
        return _concluded(self._result(state), reason, self.job, self._runs, summary)

    def _result(self, state: str) -> RunResult:
        return RunResult(self.job.id, self.job.seed, state, values=self.job.values, host=socket.gethostname(),
                         begun=self._begun.isoformat(timespec="seconds"),
                         wall=round(self._wall_before + self._wall(), 3), attempts=self.attempts,
                         version=self.job.version)

    def _said(self) -> str:
        """Returns what the process wrote last."""
        try:
            lines = self._log.read_text(encoding="utf-8", errors="replace").split("\n")
        except OSError:
            return ""
        said = [line.strip() for line in lines if line.strip(" -")]
        errors = [line for line in said if line.startswith("error:")]
        return "; ".join(errors if errors and self.job.ranks > 1 else said[-_REASON_LINES:])  # mpirun speaks last


def collected(job: Job, runs: Path) -> RunResult:
    """Returns the result of a run that was made by its command line alone; its summary is there."""
    folder = runs / job.id
    summary = read_summary(folder) or {}
    state, reason = judge(summary)
    wall = summary.get("wall_time_s", 0.0)
    result = RunResult(job.id, job.seed, state, values=job.values, wall=wall, version=job.version)
    write_result(begun_file(runs, job.id), replace(result, state=BEGUN))
    return _concluded(result, reason, job, runs, summary)


def _concluded(result: RunResult, reason: str, job: Job, runs: Path, summary: dict[str, Any] | None) -> RunResult:
    """Writes down the result of a run with its outputs, and thins its folder. Returns the result that there is where
    another process was first.
    """
    outputs = {}
    if summary is not None and result.state == DONE:
        facts = read_facts(runs / job.id)
        for what in job.outputs:
            value, why = Output("", what).of(runs / job.id, summary, facts)
            outputs[what] = (None if math.isnan(value) else value, why)
    known = known_result(job, runs)
    if known is None:
        known = judged(replace(result, reason=reason[:REASON_LENGTH], outputs=outputs), outputs)
        write_result(result_file(runs, job.id), known)  # before what it was taken from is gone
    _tidy(job, runs)
    return known


def _tidy(job: Job, runs: Path) -> None:
    """Tidies up once it is written down what came of a run."""
    thin(runs / job.id, job.keep)
    _log_file(runs, job.id).unlink(missing_ok=True)
    begun_file(runs, job.id).unlink(missing_ok=True)


def judge(summary: dict[str, Any]) -> tuple[str, str]:
    """Returns the state of a run that came to its end, and why it gives no value, or a value to be looked at."""
    stages = [s for s in summary.get("stages", []) if isinstance(s, dict)]
    for ended in (summary, *stages):
        if (state := _STATES.get(str(ended.get("outcome_id", "")))) is not None:
            return state, str(ended.get("outcome", ""))
    for number, stage in enumerate(stages, start=1):
        if stage.get("results", {}).get("quasi_static") is False:
            return NOT_QUASI_STATIC, f"stage {number} ({stage.get('kind')}) was not quasi-static"
    if was_stopped(summary):
        return CRASHED, "stopped"
    for number, stage in enumerate(stages, start=1):
        if stage.get("is_good") is False:
            return DONE, f"stage {number} ({stage.get('kind')}): {stage.get('outcome')}"
    return DONE, ""


def was_stopped(summary: dict[str, Any]) -> bool:
    """Returns whether a run was ended from outside, so that it can go on."""
    return summary.get("outcome_id") == "stopped"


def thin(folder: Path, keep: str) -> None:
    """Removes what is not to be kept of a run: "summary", "history" too, or "all"."""
    if keep == "all":
        return
    for name in _LARGE:
        if name == "history.csv" and keep == "history":
            continue
        path = folder / name
        shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


def known_result(job: Job, runs: Path) -> RunResult | None:
    """Returns what came of a run; None where it has to be made, be it for further outputs."""
    result = read_result(result_file(runs, job.id))
    is_lacking = result is not None and result.state in (DONE, NO_VALUE) and not set(job.outputs) <= set(result.outputs)
    return None if is_lacking else result


def made(job: Job, runs: Path) -> RunResult | None:
    """Returns `known_result`, also of a run that is whole in its folder because its driver was killed before it wrote
    that down.
    """
    begun = read_result(begun_file(runs, job.id))
    known = known_result(job, runs)
    if begun is None:
        return known
    if known is not None:
        _tidy(job, runs)
        return known
    summary = read_summary(runs / job.id)
    if summary is None or was_stopped(summary):
        return None
    state, reason = judge(summary)
    wall = max(begun.wall, float(summary.get("wall_time_s") or 0.0))
    return _concluded(replace(begun, state=state, wall=wall), reason, job, runs, summary)


def given_up(job: Job, runs: Path, reason: str) -> RunResult:
    """Returns the result of a run that is not tried again."""
    begun = read_result(begun_file(runs, job.id)) or RunResult(job.id, job.seed, CRASHED, values=job.values,
                                                               version=job.version)
    return _concluded(replace(begun, state=CRASHED), reason, job, runs, None)


def kept(folder: Path) -> tuple[str, int] | None:
    """Returns the newest checkpoint that a run can go on from; None without one."""
    files = [(f.stat().st_mtime_ns, f.name) for f in folder.glob("checkpoints/*.state")]
    return (max(files)[1], max(files)[0]) if files and (folder / "manifest.json").exists() else None


def _signal(process: subprocess.Popen[bytes], number: int) -> None:
    try:
        os.killpg(process.pid, number)  # a session of its own
    except ProcessLookupError:
        pass


def is_of_full_disk(said: str) -> bool:
    """Returns whether a process said that it could write no more."""
    return any(os.strerror(number) in said for number in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG))


def die_with_parent(parent: int) -> Callable[[], None]:
    """Returns what a child calls between fork and exec, so that it gets SIGTERM when its parent ends."""

    def arrange() -> None:
        _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != parent:
            os._exit(1)

    return arrange


def jobs_of(text: str) -> Sequence[Job]:
    """Reads the jobs of a file with a job on each line."""
    return [Job.from_json(line) for line in text.splitlines() if line.strip()]
