"""A plain list of commands, for whatever engine a user has, and a script that makes them in a Slurm array."""

from __future__ import annotations

import json
import math
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ...writing import make_folder, write_text
from ..file import SlurmSettings
from ..outputs import read_summary
from ..start import python
from ..store import RunResult
from ..work import Job, collected

_MOST_TASKS = 1000
"""Tasks of an array: Slurm takes no number above 1000 unless somebody set MaxArraySize."""


@dataclass
class Commands:
    """Takes in the runs that are done, and writes a command line for each of the others, a line each. Beside the list
    stands a script that takes it to Slurm without this driver.

    A line runs nothing where a file that its command names has changed since the line was written.
    """

    file: Path
    settings: SlurmSettings = SlurmSettings()
    written: int = field(default=0, init=False)
    name: str = field(default="commands", init=False)

    @property
    def script(self) -> Path:
        """The script for sbatch."""
        return self.file.with_suffix(".sbatch")

    def run(self, jobs: Sequence[Job], runs: Path, finished: Callable[[RunResult], None],
            stopped: Callable[[], bool]) -> None:
        """Takes in what is done and writes the rest; see executors."""
        make_folder(runs)
        lines = []
        ranks = max((job.ranks for job in jobs), default=1)
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
        if lines:
            write_text(self.script, self._script(ranks))
        else:
            self.script.unlink(missing_ok=True)

    def _script(self, ranks: int) -> str:
        asked = self.settings
        of_task = max(asked.points_per_task, math.ceil(self.written / _MOST_TASKS), 1)
        seconds = round(asked.time)
        options = [f"--array=1-{math.ceil(self.written / of_task)}%{asked.slots}",
                   f"--time={seconds // 60}:{seconds % 60:02d}", f"--ntasks={ranks}", "--cpus-per-task=1",
                   *(option for option in asked.options if option not in asked.unusual)]
        left_out = [f"# left out, as it may run a program: {option}\n" for option in asked.unusual]
        return ("#!/bin/sh\n"
                f"# Makes the runs of {self.file.name}: sbatch {self.script.name}. Each task makes {of_task} of them.\n"
                "# The program, the deck and the folders need the paths of the list on all nodes.\n"
                + "".join(f"#SBATCH {shlex.quote(option)}\n" for option in options) + "".join(left_out)
                + f"first=$(( (SLURM_ARRAY_TASK_ID - 1) * {of_task} + 1 ))\n"
                f"sed -n \"s/^mpirun /srun --mpi=pmix /; $first,$((first + {of_task - 1}))p\" "
                f"{shlex.quote(str(self.file.resolve()))} | {{\n"
                "  failed=0\n"
                "  while IFS= read -r line; do sh -c \"$line\" < /dev/null || failed=1; done\n"
                "  exit $failed\n"
                "}\n")
