"""What a task of a Slurm array does: it makes its runs one after the other.

`python3 -m pyroclast.study.worker FILE RUNS COUNT`: FILE has a job on each line, of which task i takes COUNT from line
i COUNT on; RUNS is the folder of the runs. What came of each run is in a file of its own. At SIGTERM the run that
goes on keeps its state. The task then goes back into the queue, unless it was cancelled.
"""

from __future__ import annotations

import itertools
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

from ..errors import Error
from .executors.local import Local
from .store import RunResult, begun_file, read_result, result_file, write_result
from .work import MOST_IN_VAIN, Job, given_up, jobs_of, kept, made

_PATIENCE = 60.0  # s, for an answer of Slurm


def jobs_of_task(file: Path, task: int, count: int) -> list[Job]:
    """Reads the jobs of this task from a file with the jobs of all tasks."""
    with open(file, encoding="utf-8") as lines:
        return list(jobs_of("".join(itertools.islice(lines, task * count, (task + 1) * count))))


def requeue(task: str) -> bool:
    """Puts a task that runs back into the queue; whether that was done. One that was cancelled stays as it is."""
    try:
        state = subprocess.run(["squeue", "--noheader", f"--jobs={task}", "--format=%T"], capture_output=True,
                               text=True, timeout=_PATIENCE)
        if state.stdout.strip() != "RUNNING":
            print(f"{task} is {state.stdout.strip() or 'not in the queue'}, and not requeued {state.stderr.strip()}")
            return False
        return subprocess.run(["scontrol", "requeue", task], timeout=_PATIENCE).returncode == 0
    except (OSError, subprocess.TimeoutExpired) as error:
        print(f"{task} was not requeued: {error}")
        return False


def main(words: list[str]) -> int:
    """Runs the program; returns the exit code: 0 where all runs are over or the task is in the queue again, else 1;
    what is wrong stands last.
    """
    file, runs, count = Path(words[0]), Path(words[1]), int(words[2])
    array, index = os.environ["SLURM_ARRAY_JOB_ID"], os.environ["SLURM_ARRAY_TASK_ID"]
    asked = threading.Event()

    def ask(number: int, frame: Any) -> None:
        asked.set()

    signal.signal(signal.SIGTERM, ask)
    left = [job for job in jobs_of_task(file, int(index), count) if made(job, runs) is None]

    def finished(result: RunResult) -> None:
        write_result(result_file(runs, result.id), result)

    try:
        Local(1).run(left, runs, finished, asked.is_set)
    except (Error, OSError) as error:
        print(error, flush=True)
        return 1
    left = [job for job in left if made(job, runs) is None]
    for job in left:
        begun = read_result(begun_file(runs, job.id))
        if begun is not None and begun.attempts >= MOST_IN_VAIN and kept(runs / job.id) is None:
            given_up(job, runs, f"was stopped {begun.attempts} times, as a task has no more time, and leaves no "
                     "checkpoint from which it could go on")
    left = [job for job in left if made(job, runs) is None]
    return 0 if not left or requeue(f"{array}_{index}") else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
