"""A plain list of commands, for whatever engine a user has."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ...writing import make_folder, write_text
from ..outputs import read_summary
from ..start import python
from ..store import RunResult
from ..work import Job, collected


@dataclass
class Commands:
    """Takes in the runs that are done, and writes a command line for each of the others, a line each.

    A line runs nothing where a file that its command names has changed since the line was written.
    """

    file: Path
    written: int = field(default=0, init=False)
    name: str = field(default="commands", init=False)

    def run(self, jobs: Sequence[Job], runs: Path, finished: Callable[[RunResult], None],
            stopped: Callable[[], bool]) -> None:
        """Takes in what is done and writes the rest; see executors."""
        make_folder(runs)
        lines = []
        for job in jobs:
            folder = runs / job.id
            if read_summary(folder) is not None:
                finished(collected(job, runs))
            else:
                make_folder(folder)
                checked = python("pyroclast.study.checked", json.dumps(job.files)) if job.files else []
                lines.append(shlex.join([*checked, *job.line(folder)]))
        write_text(self.file, "".join(f"{line}\n" for line in lines))
        self.written = len(lines)
