"""Studies by Slurm arrays: what is submitted, what is done about lost tasks, and who makes each run once.

The queue is that of fake_slurm.py; test_real_slurm.py asks a real one.
"""

from __future__ import annotations

import collections
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from collections.abc import Callable
from dataclasses import replace
from unittest import mock

from fake_slurm import FakeSlurm, on_path
from pyroclast.errors import Error
from pyroclast.study.executors import slurm
from pyroclast.study.executors.slurm import MOST_LOST, Slurm, runs_per_task
from pyroclast.study.file import SlurmSettings
from pyroclast.study.start import FOLDER
from pyroclast.study.store import CRASHED, DONE, RunResult, only_writer, result_file
from pyroclast.study.work import Job, known_result

PROGRAM = os.environ.get("PYROCLAST", "")
os.environ["PYROCLAST_CODE"] = "always"  # tests/app/test_code.py tries the others
CASES = pathlib.Path(__file__).parents[2] / "cases"

MODEL = '''
# NUMBER FOLDER MODE: leaves 2 NUMBER as z
echo "$1" >>"$2/../../made"
finish() {
  echo "{\\"outcome\\": \\"completed\\", \\"z\\": $((2 * $1))}" >"$2/summary.json"
}
gate=$2/../../gate
case $3 in
  gated) until [ -e "$gate" ]; do sleep 0.05; done ;;
  halves)  # keeps its state when it is asked to stop, and ends from there
    if ! [ -e "$2/half" ]; then
      trap 'touch "$2/half"; exit 0' TERM
      touch "$2/begun"
      while :; do sleep 0.05; done
    fi ;;
  deadly) kill -9 $PPID; exit 1 ;;  # takes its task along
  full) echo "error: summary.json: cannot be written (No space left on device)" >&2; exit 1 ;;
esac
finish "$1" "$2"
'''


class SlurmTest(unittest.TestCase):
    """A queue and a folder of its own."""

    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.runs = self.folder / "study" / "runs"
        self.model = self.folder / "model.sh"
        self.model.write_text(MODEL)
        self.slurm = FakeSlurm(self.folder / "bin")
        self.addCleanup(self.slurm.close)
        patch = mock.patch.dict(os.environ, PATH=on_path(self.slurm.folder))
        patch.start()
        self.addCleanup(patch.stop)
        self.said: list[str] = []
        self.results: dict[str, RunResult] = {}

    def job(self, i: int, mode: str = "plain") -> Job:
        return Job(f"run-{i}", 1, "command", ("sh", str(self.model), str(i), FOLDER, mode), {"x": i}, ("z",), "summary",
                   100.0, 1.0, 0)

    def jobs(self, count: int, mode: str = "plain") -> list[Job]:
        return [self.job(i, mode) for i in range(count)]

    def executor(self, **settings) -> Slurm:
        settings = {"slots": 2, "points_per_task": 4, **settings}
        return Slurm(SlurmSettings(**settings), self.said.append, interval=(0.1, 0.2), patience=0.1, grace=0.0)

    def run_all(self, jobs: list[Job], stopped: Callable[[], bool] = lambda: False, **settings) -> None:
        def finished(result: RunResult) -> None:
            self.assertNotIn(result.id, self.results)
            self.results[result.id] = result

        deadline = time.monotonic() + 120.0
        self.executor(**settings).run(jobs, self.runs, finished, lambda: stopped() or time.monotonic() > deadline)

    def made(self) -> list[int]:
        """Which runs were begun, in their order."""
        file = self.folder / "study" / "made"
        return [int(line) for line in file.read_text().split()] if file.exists() else []

    def open_gate(self) -> None:
        (self.folder / "study" / "gate").touch()

    def meanwhile(self, happening: Callable[[], None]) -> None:
        """In a thread, while the test goes on."""
        thread = threading.Thread(target=happening)
        thread.start()
        self.addCleanup(thread.join)

    def await_(self, holds: Callable[[], object]) -> None:
        deadline = time.monotonic() + 120.0
        while not holds():
            if time.monotonic() > deadline:
                raise TimeoutError
            time.sleep(0.01)

    def assert_all_done(self, count: int) -> None:
        self.assertEqual({r: self.results[r].number("z") for r in self.results}, {f"run-{i}": 2.0 * i for i in range(count)})
        self.assertEqual({r.state for r in self.results.values()}, {DONE})

    def assert_made_once(self, count: int) -> None:
        self.assertEqual(sorted(self.made()), list(range(count)))


class Ordinary(SlurmTest):
    def test_points_of_arrays(self) -> None:
        self.slurm.largest = 2
        self.run_all(self.jobs(12))
        self.assert_all_done(12)
        self.assert_made_once(12)
        first, second = self.slurm.jobs  # 3 tasks of 4 runs; an array has no more than 2
        self.assertEqual([len(first.tasks), len(second.tasks)], [2, 1])
        self.assertEqual(first.at_once, 2)
        self.assertEqual(second.options["dependency"], "afterany:1")
        self.assertEqual(first.options["time"], "60:00")
        self.assertEqual(first.options["signal"], "B:TERM@120")
        self.await_(lambda: self.slurm.is_idle)
        self.run_all([])
        left = [file.name for file in (self.folder / "study" / "slurm").iterdir()]
        self.assertLessEqual(len(left), 1, left)  # a task may have been on its way out

    def test_short_time_is_warned_of_in_time(self) -> None:
        self.run_all(self.jobs(1), time=60.0)
        self.assertEqual(self.slurm.jobs[0].options["time"], "1:00")
        self.assertEqual(self.slurm.jobs[0].options["signal"], "B:TERM@15")

    def test_runs_of_a_task(self) -> None:
        def count(expected: float, jobs: int, **settings) -> int:
            return runs_per_task(SlurmSettings(slots=2, **settings), jobs, expected)

        self.assertEqual(count(0.0, 100), 1)  # not known
        self.assertEqual(count(60.0, 100), 10)
        self.assertEqual(count(60.0, 6), 3)  # all slots get some
        self.assertEqual(count(60.0, 100, time=300.0), 4)
        self.assertEqual(count(7200.0, 100), 1)

    def test_the_first_runs_tell_how_many_a_task_takes(self) -> None:
        self.run_all(self.jobs(12), points_per_task=0)
        self.assert_all_done(12)
        self.assert_made_once(12)
        self.assertEqual([len(job.tasks) for job in self.slurm.jobs], [2, 2])  # two runs, then five in each of two tasks

    def test_of_a_function(self) -> None:
        file = self.folder / "model.py"
        file.write_text("def line(x, seed):\n    return {'z': 2 * x}\n")
        self.run_all([replace(job, kind="function", command=(f"{file}:line",)) for job in self.jobs(3)])
        self.assert_all_done(3)


class Refused(SlurmTest):
    def test_without_sbatch(self) -> None:
        with mock.patch.dict(os.environ, PATH="/nowhere"), self.assertRaisesRegex(Error, "sbatch is not on the PATH"):
            self.run_all(self.jobs(1))

    def test_words_of_sbatch(self) -> None:
        with self.assertRaisesRegex(Error, "invalid partition specified: long"):
            self.run_all(self.jobs(1), options=("--partition=long",))
        self.run_all(self.jobs(1))  # nothing stays behind that a right one would wait for
        self.assert_all_done(1)

    def test_options_that_the_study_says(self) -> None:
        for option in ("--time=10", "-t 10", "-J mine", "--array=1-2", "--arr=0-3", "--outp=x"):
            with self.assertRaisesRegex(Error, "the study says"):
                SlurmSettings(options=(option,))

    def test_options_whose_values_cannot_be_meant(self) -> None:
        for option, why in [("--partition=a\n#SBATCH --wrap=x", "line break"), ("--account", "--account=VALUE"),
                            ("--mem=", "--mem=VALUE"), ("--qos=--wrap=x", "--qos=VALUE")]:
            with self.subTest(option=option), self.assertRaisesRegex(Error, why):
                SlurmSettings(options=(option,))

    def test_options_that_may_run_a_program_are_told_from_others(self) -> None:
        plain = ("--partition=long", "--account=a", "--qos=q", "--mem=2G", "--mem-per-cpu=1G", "--constraint=a&b",
                 "--gres=gpu:1", "--nodelist=n[1-2]", "--exclude=n3", "--reservation=r", "--cpus-per-task=2",
                 "--mail-type=END", "--mail-user=a@b.c")
        unusual = ("--wrap=touch RAN", "--wra=touch RAN", "--export=ALL,LD_PRELOAD=x.so", "--export-file=x", "--bcast",
                   "--container=x", "--chdir=/tmp", "-p long", "-plong", "script.sh", "--prolog=x", "--part=long",
                   "--mem-bind=local", "--mail=END")
        self.assertEqual(SlurmSettings(options=(*plain, *unusual)).unusual, unusual)

    def test_full_queue(self) -> None:
        self.slurm.refusals = [
            "sbatch: error: QOSMaxSubmitJobPerUserLimit\nsbatch: error: Batch job submission failed: Job violates "
            "accounting/QOS policy (job submit limit, user's size and/or time limits)\n",
            "sbatch: error: Slurm temporarily unable to accept job, sleeping and retrying\n"]
        self.run_all(self.jobs(12), points_per_task=1)
        self.assert_all_done(12)
        self.assert_made_once(12)
        self.assertEqual(self.slurm.refusals, [])
        self.assertEqual(len(self.slurm.jobs[0].tasks), 3)  # 12, 6, 3: fewer may be let in
        self.assertIn("QOSMaxSubmitJobPerUserLimit", self.said[0])

    def test_controller_that_is_away(self) -> None:
        def go_away() -> None:
            self.await_(lambda: self.slurm.running)
            self.slurm.is_deaf = True
            self.await_(lambda: len(self.said) > 1)
            self.open_gate()
            self.slurm.is_deaf = False

        self.meanwhile(go_away)
        self.run_all(self.jobs(4, "gated"), points_per_task=1)
        self.assert_all_done(4)
        self.assert_made_once(4)
        self.assertIn("Unable to contact", self.said[1])


class Lost(SlurmTest):
    def test_cancelled_task(self) -> None:
        def cancel() -> None:
            self.await_(lambda: len(self.made()) == 2 and (self.runs / "run-4" / "begun").exists())
            self.slurm.cancel(self.slurm.jobs[0], 1)
            self.await_(lambda: not self.slurm.jobs[0].tasks[1].state)
            self.open_gate()

        self.meanwhile(cancel)
        jobs = self.jobs(12, "gated")
        self.run_all([*jobs[:4], self.job(4, "halves"), *jobs[5:]])
        self.assert_all_done(12)
        self.assertEqual(self.slurm.jobs[0].tasks[1].starts, 1)  # what is cancelled does not put itself back
        self.assertEqual(collections.Counter(self.made()), {i: 2 if i == 4 else 1 for i in range(12)})
        self.assertIn("task 1_1 ended without 4 of its runs", "\n".join(self.said))

    def test_dead_node(self) -> None:
        def die() -> None:
            self.await_(lambda: len(self.slurm.running) == 2 and len(self.made()) == 2)
            self.slurm.vanish(self.slurm.jobs[0], 0)
            self.open_gate()

        self.meanwhile(die)
        self.run_all(self.jobs(12, "gated"))
        self.assert_all_done(12)
        self.assertEqual(collections.Counter(self.made()), {i: 2 if i == 0 else 1 for i in range(12)})

    def test_run_that_kills_its_task(self) -> None:
        """Given up, and alone: the others of its task are made."""
        self.run_all([self.job(0), self.job(1, "deadly"), *map(self.job, range(2, 5))])
        self.assertEqual(self.made().count(1), MOST_LOST)
        bad = self.results.pop("run-1")
        self.assertEqual(bad.state, CRASHED)
        self.assertIn(f"ended {MOST_LOST} times", bad.reason)
        self.assertEqual({r: self.results[r].state for r in self.results}, {f"run-{i}": DONE for i in (0, 2, 3, 4)})

    def test_full_disk(self) -> None:
        with self.assertRaisesRegex(Error, "task 1_. ended: error: summary.json: .*No space left on device"):
            self.run_all(self.jobs(4, "full"))
        self.assertEqual(self.results, {})
        self.assertEqual(self.made(), [0])  # what a task has in its list was not tried

    def test_workers_that_cannot_start(self) -> None:
        with mock.patch.object(sys, "executable", "/nowhere/python3"), self.assertRaisesRegex(Error, "/nowhere/python3"):
            self.run_all(self.jobs(2))
        self.assertEqual(len(self.slurm.jobs), 1 + 1 + 1)

    def test_lost_result(self) -> None:
        """A run that was made, and whose result is not there, is made again."""
        def losing(job: Job, runs: pathlib.Path) -> RunResult | None:
            result = known_result(job, runs)
            if job.id != "run-0" or result is None or len(self.made()) > 2:
                return result
            result_file(runs, "run-0").unlink()
            return None

        with mock.patch.object(slurm, "made", losing), mock.patch.object(slurm, "known_result", losing):
            self.run_all(self.jobs(2))
        self.assert_all_done(2)
        self.assertEqual(collections.Counter(self.made()), {0: 2, 1: 1})


class TimeLimit(SlurmTest):
    def warn_first(self, sign: str) -> None:
        def warn() -> None:
            self.await_(lambda: list(self.runs.glob(sign)))
            self.slurm.warn(self.slurm.jobs[0], 0)

        self.meanwhile(warn)

    def test_requeued_and_resumed(self) -> None:
        self.warn_first("run-1/begun")
        self.run_all([self.job(0), self.job(1, "halves"), self.job(2)])
        self.assert_all_done(3)
        self.assertEqual(self.made(), [0, 1, 1, 2])
        self.assertEqual([task.starts for task in self.slurm.jobs[0].tasks], [2])
        self.assertEqual(self.results["run-1"].attempts, 2)

    def test_without_requeue_the_driver_submits_it(self) -> None:
        self.slurm.has_requeue = False
        self.warn_first("run-0/begun")
        self.run_all([self.job(0, "halves"), self.job(1)])
        self.assert_all_done(2)
        self.assertGreater(len(self.slurm.jobs), 1)

    @unittest.skipUnless(PROGRAM, "needs the program, named by PYROCLAST")
    def test_run_goes_on_to_the_same_bits(self) -> None:
        command = (PROGRAM, "run", str(CASES / "compression.toml"), "--set", "blocks.count=400", "--set",
                   "stages[1].velocity=1 mm/s", "--set", "stages[1].stop_strain=0.003")
        job = replace(self.job(0), id="once", kind="pyroclast", command=command, outputs=("f_c_MPa",), keep="history")
        self.warn_first("once/history.csv")
        self.run_all([job])
        self.assertEqual(self.results["once"].attempts, 2)
        self.run_all([replace(job, id="undisturbed")])
        self.assertEqual(self.results["undisturbed"].attempts, 1)
        histories = [(self.runs / run / "history.csv").read_bytes() for run in ("once", "undisturbed")]
        self.assertEqual(*histories)
        self.assertEqual(self.results["once"].outputs, self.results["undisturbed"].outputs)


class Driver(SlurmTest):
    def test_stopped(self) -> None:
        self.run_all(self.jobs(12, "gated"), stopped=lambda: bool(self.slurm.running))
        self.assertEqual(self.results, {})
        self.assertEqual(self.said[-1], "12 runs are not done; jobs 1 go on in the queue, and the same command takes them "
                         "in (to end them: scancel 1)")
        self.open_gate()
        self.await_(lambda: self.slurm.is_idle)
        self.run_all(self.jobs(12, "gated"))
        self.assertEqual(len(self.slurm.jobs), 1)
        self.assert_all_done(12)
        self.assert_made_once(12)

    def test_killed(self) -> None:
        file = self.folder / "study.toml"
        file.write_text(f'''
[study]
runner = "command"
command = "sh {self.model} {{x}} {{folder}} gated"
[method]
kind = "grid"
[parameters.x]
integer = [0, 11]
levels = 12
[outputs]
z = "z"
[slurm]
slots = 2
points_per_task = 4
''')
        self.folder.joinpath("study").mkdir()
        driver = [sys.executable, "-m", "pyroclast.study", "run", str(file), "--executor", "slurm"]
        (self.folder / "study-study").symlink_to(self.folder / "study")
        first = subprocess.Popen(driver, stdout=subprocess.DEVNULL)
        self.await_(lambda: self.slurm.running)
        first.send_signal(signal.SIGKILL)
        first.wait()
        self.meanwhile(lambda: (time.sleep(0.2), self.open_gate()))
        again = subprocess.run(driver, capture_output=True, text=True)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(len(self.slurm.jobs), 1)
        self.assert_made_once(12)
        rows = (self.folder / "study" / "table.csv").read_text().splitlines()
        self.assertEqual(len(rows), 1 + 12)
        self.assertTrue(all(",done," in row for row in rows[1:]), rows)

    def test_killed_between_sbatch_and_its_answer(self) -> None:
        """The job is in the queue, and its number is not written."""
        sbatch = slurm._Queue._sbatch

        def taken_and_killed(*arguments) -> str:
            sbatch(*arguments)
            raise KeyboardInterrupt

        with mock.patch.object(slurm._Queue, "_sbatch", taken_and_killed), self.assertRaises(KeyboardInterrupt):
            self.run_all(self.jobs(4, "gated"))
        self.open_gate()
        self.run_all(self.jobs(4, "gated"))
        self.assertEqual(len(self.slurm.jobs), 1)
        self.assert_all_done(4)
        self.assert_made_once(4)

    def test_jobs_that_the_file_does_not_know(self) -> None:
        self.run_all(self.jobs(4, "gated"), stopped=lambda: bool(self.slurm.running))
        (self.folder / "study" / "slurm.json").unlink()
        with self.assertRaisesRegex(Error, "does not know the jobs pyroclast-[0-9a-f]{8}-1 of this study"):
            self.run_all(self.jobs(4, "gated"))

    def test_failures_are_made_again(self) -> None:
        """A result that the store has dropped is not taken for a new one."""
        self.run_all(self.jobs(1))
        with only_writer(self.folder / "study") as store:
            store.drop(["run-0"])
        self.results.clear()
        self.run_all(self.jobs(1))
        self.assertEqual(self.made(), [0, 0])


class OneNode(unittest.TestCase):
    """scripts/slurm-one-node, with daemons that do nothing."""

    SCRIPT = pathlib.Path(__file__).parents[2] / "scripts" / "slurm-one-node"

    def run_script(self, *words: str, **env: str) -> subprocess.CompletedProcess:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        for name in ("munged", "slurmctld", "slurmd", "dpkg-query", "sinfo", "scancel", "squeue"):
            tool = pathlib.Path(scratch.name) / name
            tool.write_text({"dpkg-query": "#!/bin/sh\necho install ok installed\n",
                             "sinfo": "#!/bin/sh\necho idle\n"}.get(name, "#!/bin/sh\n"))
            tool.chmod(0o755)
        environment = {"PATH": f"{scratch.name}:{os.environ['PATH']}", "HOME": scratch.name, **env}
        return subprocess.run([self.SCRIPT, *words], env=environment, capture_output=True, text=True, check=False)

    def test_its_folder_has_a_name_that_nobody_knows_beforehand(self) -> None:
        folders = []
        for _ in range(2):
            said = self.run_script("start")
            self.assertEqual(said.returncode, 0, said.stderr)
            conf = pathlib.Path(said.stdout.split("SLURM_CONF=")[1].split()[0])
            self.addCleanup(shutil.rmtree, conf.parent)
            self.assertIn(f"StateSaveLocation={conf.parent}/state", conf.read_text())
            self.assertIn(f"stop {conf.parent}", said.stdout)
            folders.append(conf.parent)
            self.assertIn(str(conf.parent), self.run_script("stop", SLURM_CONF=str(conf)).stdout)
        self.assertNotEqual(*folders)

    def test_stop_needs_to_know_the_folder(self) -> None:
        said = self.run_script("stop")
        self.assertEqual(said.returncode, 2)
        self.assertIn("stop needs the folder that start named, or SLURM_CONF", said.stderr)


if __name__ == "__main__":
    unittest.main()
