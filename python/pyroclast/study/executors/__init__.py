"""Where the runs of a study are made.

An executor has `run(jobs, runs, finished, stopped)`: it makes the jobs below the folder `runs`, calls `finished` with
each result as it comes, from the thread that called it, and returns when all are done or `stopped()` holds. What it was
not able to make is missing from what it finished.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

from ..store import RunResult
from ..work import Job


class Executor(Protocol):
    """Makes the runs of a study."""

    name: str

    def run(self, jobs: Sequence[Job], runs: Path, finished: Callable[[RunResult], None],
            stopped: Callable[[], bool]) -> None:
        """Makes the jobs; see the module."""


__all__ = ["Executor"]
