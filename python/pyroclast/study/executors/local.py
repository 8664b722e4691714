"""Runs in processes of this machine, of one thread or of several ranks."""

from __future__ import annotations

import json
import math
import os
import select
import socket
import subprocess
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import Error
from ...writing import make_folder
from ..start import python
from ..store import CRASHED, DONE, TIMED_OUT, RunResult, judged
from ..work import MOST_IN_VAIN, Attempt, Job, die_with_parent

_LOOK = 0.2  # s between two looks at wall limits and at what asks to stop


@dataclass
class Local:
    """An executor of as many runs at once as `slots`, each in a process of its own that dies with this one."""

    slots: int
    name: str = field(default="local", init=False)

    def run(self, jobs: Sequence[Job], runs: Path, finished: Callable[[RunResult], None],
            stopped: Callable[[], bool]) -> None:
        """Makes the jobs; see executors."""
        if jobs and jobs[0].kind == "function":
            _call(jobs, min(self.slots, len(jobs)), finished, stopped)
        else:
            make_folder(runs)
            _run(jobs, self.slots, runs, finished, stopped)


def _run(jobs: Sequence[Job], slots: int, runs: Path, finished: Callable[[RunResult], None],
         stopped: Callable[[], bool]) -> None:
    waiting = deque(jobs)
    in_vain: dict[str, int] = {}
    running: dict[int, Attempt] = {}  # by the file descriptor that tells when its process has ended
    broken: Exception | None = None  # what no run can go on with, as a full disk

    def is_over() -> bool:
        return broken is not None or stopped()

    while running or (waiting and not is_over()):
        try:
            while waiting and len(running) < slots and not is_over():
                attempt = Attempt(waiting.popleft(), runs)
                running[os.pidfd_open(attempt.process.pid)] = attempt
            ended, _, _ = select.select(list(running), [], [], _LOOK)
            for descriptor in ended:
                attempt = running.pop(descriptor)
                os.close(descriptor)
                attempt.asked_to_stop |= is_over()  # what stops this process may have stopped the run too
                result = attempt.end()
                job = attempt.job
                if result is None and not is_over():
                    in_vain[job.id] = 0 if attempt.has_kept else in_vain.get(job.id, 0) + 1
                    if in_vain[job.id] >= MOST_IN_VAIN:
                        result = attempt.give_up()
                    else:
                        waiting.append(job)
                if result is not None:
                    finished(result)
        except (Error, OSError) as error:
            broken = broken or error  # the others get their time to keep their states
        for attempt in running.values():
            attempt.look_after(is_over())
    if broken is not None:
        raise broken


class _Server:
    """A process that calls the function of a study, point by point."""

    def __init__(self, job: Job):
        """Starts a process. job: one of those that call the same function."""
        self.process = subprocess.Popen(python("pyroclast.study.call", job.command[0], job.code), bufsize=0,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
                                        preexec_fn=die_with_parent(os.getpid()))
        self.job: Job | None = None
        self.is_ready = False  # it has loaded the function; from then on time counts
        self._begun = 0.0
        self._said = b""

    @property
    def wall(self) -> float:
        """Time of the call that goes on, s."""
        return time.monotonic() - self._begun if self.is_ready else 0.0

    @property
    def descriptor(self) -> int:
        assert self.process.stdout
        return self.process.stdout.fileno()

    def begin(self, job: Job) -> None:
        assert self.process.stdin
        self.job, self._begun = job, time.monotonic()
        try:
            self.process.stdin.write((json.dumps([job.values, job.seed]) + "\n").encode())
        except BrokenPipeError:
            pass  # the end of its answers tells

    def hear(self) -> tuple[RunResult | None, bool]:
        """Returns its answer, if whole, and whether the process has ended. Called when there is something to read."""
        piece = os.read(self.descriptor, 65536)
        self._said += piece
        result = None
        while (end := self._said.find(b"\n")) >= 0:
            line, self._said = self._said[:end], self._said[end + 1:]
            if not self.is_ready:
                self.is_ready, self._begun = True, time.monotonic()
            elif self.job is not None:
                result, self.job = _result(self.job, json.loads(line), self.wall), None
        return result, not piece

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()


def _result(job: Job, said: dict[str, float | None] | str, wall: float) -> RunResult:
    outputs: dict[str, tuple[float | None, str]] = {}
    state, reason = DONE, ""
    if isinstance(said, str):
        state, reason = CRASHED, said
    else:
        for what in job.outputs:
            value = said.get(what)
            if value is None or not math.isfinite(value):
                why = "is not finite" if what in said else f"the function gives no {what!r}"
                outputs[what] = (None, why)
            else:
                outputs[what] = (value, "")
    result = RunResult(job.id, job.seed, state, reason, outputs, job.values, socket.gethostname(),
                       time.strftime("%Y-%m-%dT%H:%M:%S+00:00", time.gmtime()), round(wall, 6), 1, job.version)
    return judged(result, outputs)


def _call(jobs: Sequence[Job], slots: int, finished: Callable[[RunResult], None], stopped: Callable[[], bool]) -> None:
    waiting = deque(jobs)
    in_vain: dict[str, int] = {}
    servers = [_Server(jobs[0]) for _ in range(slots)]
    try:
        while not stopped():
            for server in servers:
                if server.job is None and waiting:
                    server.begin(waiting.popleft())
            busy = {server.descriptor: server for server in servers if server.job is not None}
            if not busy:
                break
            ready, _, _ = select.select(list(busy), [], [], _LOOK)
            for descriptor in ready:
                server = busy[descriptor]
                job = server.job
                result, has_ended = server.hear()
                if has_ended:
                    if not server.is_ready and server.process.wait() > 0:
                        raise Error(f"{jobs[0].command[0]}: the function cannot be loaded; Python's message stands above")
                    server.close()
                    servers[servers.index(server)] = _Server(jobs[0])
                    if result is None and job is not None:
                        in_vain[job.id] = in_vain.get(job.id, 0) + 1
                        if in_vain[job.id] < MOST_IN_VAIN:
                            waiting.append(job)
                        else:
                            result = _result(job, f"the process ended {MOST_IN_VAIN} times", 0.0)
                if result is not None:
                    finished(result)
            for server in busy.values():
                if server.job is not None and server.wall > server.job.wall_limit:
                    late = server.job
                    server.close()
                    servers[servers.index(server)] = _Server(late)
                    finished(RunResult(late.id, late.seed, TIMED_OUT, f"wall limit of {late.wall_limit:g} s",
                                       values=late.values, host=socket.gethostname(), wall=late.wall_limit,
                                       version=late.version))
    finally:
        for server in servers:
            server.close()
