"""Studies, and a run on ranks, by a real Slurm: skipped where sinfo does not answer. scripts/slurm-one-node starts one.

    PYTHONPATH=build/release/python PYROCLAST=build/release/bin/pyroclast \\
        python3 -m unittest discover -s tests/study -p test_real_slurm.py -v
"""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
import tempfile
import threading
import time
import unittest
from collections.abc import Callable

from pyroclast.study.executors.slurm import Slurm
from pyroclast.study.file import SlurmSettings
from pyroclast.study.start import FOLDER
from pyroclast.study.store import DONE, RunResult
from pyroclast.study.work import Job

MODEL = '''
echo "$1" >>"$2/../../made"
[ "$3" = halves ] && ! [ -e "$2/half" ] && { trap 'touch "$2/half"; exit 0' TERM; while :; do sleep 0.5; done; }
echo "{\\"outcome\\": \\"completed\\", \\"z\\": $((2 * $1))}" >"$2/summary.json"
'''


def answers() -> bool:
    """Whether there is a Slurm with a node that is up."""
    if shutil.which("sinfo") is None:
        return False
    try:
        said = subprocess.run(["sinfo", "--noheader", "--format=%T"], capture_output=True, text=True, timeout=120.0)
    except subprocess.TimeoutExpired:
        return False
    return said.returncode == 0 and any(word in said.stdout for word in ("idle", "mixed", "allocated"))


@unittest.skipUnless(answers(), "there is no Slurm")
class RealSlurm(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        (self.folder / "model.sh").write_text(MODEL)
        (self.folder / "study").mkdir()
        self.results: dict[str, RunResult] = {}

    def job(self, i: int, mode: str = "plain") -> Job:
        return Job(f"run-{i}", 1, "command", ("sh", str(self.folder / "model.sh"), str(i), FOLDER, mode), {"x": i},
                   ("z",), "summary", 3600.0, 1.0, 0)

    def run_all(self, jobs: list[Job], stopped: Callable[[], bool] = lambda: False, **settings) -> None:
        slurm = Slurm(SlurmSettings(slots=2, **settings), lambda text: None, (0.5, 2.0), grace=5.0)
        slurm.run(jobs, self.folder / "study" / "runs", lambda result: self.results.__setitem__(result.id, result), stopped)

    def made(self) -> list[int]:
        return sorted(map(int, (self.folder / "study" / "made").read_text().split()))

    def test_forty_points(self) -> None:
        self.run_all([self.job(i) for i in range(40)], points_per_task=10)
        self.assertEqual({r.state for r in self.results.values()}, {DONE})
        self.assertEqual({r: self.results[r].number("z") for r in self.results}, {f"run-{i}": 2.0 * i for i in range(40)})
        self.assertEqual(self.made(), list(range(40)))

    def test_driver_stopped(self) -> None:
        begun = time.monotonic()
        self.run_all([self.job(i) for i in range(6)], lambda: time.monotonic() > begun + 0.5)
        self.run_all([self.job(i) for i in range(6) if f"run-{i}" not in self.results])
        self.assertEqual(len(self.results), 6)
        self.assertEqual(self.made(), list(range(6)))

    def test_cancelled(self) -> None:
        """What was cancelled does not put itself back, and is submitted again."""
        def cancel() -> None:
            while not (self.folder / "study" / "made").exists():
                time.sleep(0.2)
            said = subprocess.run(["squeue", "--noheader", "--format=%j %F"], capture_output=True, text=True).stdout
            job = next(line.split()[1] for line in said.splitlines() if line.startswith("pyroclast-"))
            subprocess.run(["scancel", job], check=True)

        thread = threading.Thread(target=cancel)
        thread.start()
        self.run_all([self.job(0, "halves"), self.job(1)], points_per_task=2)
        thread.join()
        self.assertEqual({r.state for r in self.results.values()}, {DONE})
        self.assertEqual(self.made(), [0, 0, 1])

    def test_time_limit(self) -> None:
        """A minute is the least that Slurm has; a task that was requeued waits two more before it begins."""
        self.run_all([self.job(0, "halves"), self.job(1)], time=60.0, points_per_task=2)
        self.assertEqual({r.state for r in self.results.values()}, {DONE})
        self.assertEqual(self.results["run-0"].attempts, 2)
        self.assertEqual(self.made(), [0, 0, 1])


@unittest.skipUnless(answers(), "there is no Slurm")
class RanksOfSlurm(unittest.TestCase):
    """`srun` starts the ranks of one run; which way they find each other is that of the cluster, see MpiDefault."""

    def test_a_run_has_the_history_of_one_process(self) -> None:
        program = os.environ["PYROCLAST"]
        if not (pathlib.Path(program).parents[1] / "lib/pyroclast/pyroclast_mpi.so").exists():
            self.skipTest("the program was built without MPI")
        case = pathlib.Path(__file__).parents[2] / "cases/starter.toml"
        run = [program, "run", str(case), "--no-figures", "--quiet", "--threads", "1", "--set", "blocks.count=120",
               "--set", "stages[1].velocity=8 mm/s", "--set", "stages[1].stop_strain=0.0002"]
        with tempfile.TemporaryDirectory() as place:
            for name, command in (("alone", run), ("together", ["srun", "-n", "2", *run, "--mpi"])):
                subprocess.run([*command, "--out", f"{place}/{name}"], check=True, timeout=300.0,
                               env={**os.environ, "PYROCLAST_CHUNK_BLOCKS": "16"})
            alone, together = (pathlib.Path(place, name, "history.csv").read_bytes() for name in ("alone", "together"))
            self.assertEqual(alone, together)


if __name__ == "__main__":
    unittest.main()
