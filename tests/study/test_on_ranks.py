"""Runs of studies on several ranks: the launcher before each, the cores, the signals, the same identity."""

from __future__ import annotations

import os
import pathlib
import subprocess
import time
import unittest
from unittest import mock

from fake_slurm import FakeSlurm, on_path
from pyroclast.errors import Error
from pyroclast.study import study as study_module
from pyroclast.study.executors.local import Local
from pyroclast.study.executors.slurm import Slurm
from pyroclast.study.file import SlurmSettings
from pyroclast.study.store import CRASHED
from pyroclast.study.study import Study
from pyroclast.study.work import Attempt, Job
from study_files import PROGRAM, StudyTest, of_deck

HAS_MPI = (pathlib.Path(PROGRAM).parents[1] / "lib/pyroclast/pyroclast_mpi.so").exists()
NEEDS_MPI = unittest.skipUnless(HAS_MPI, "the program was built without MPI")
OUTSIDE = {name: value for name, value in os.environ.items() if name != "SLURM_JOB_ID"}


class OnRanks(StudyTest):
    """The launchers are scripts, but for the one test that asks a real mpirun."""

    def setUp(self) -> None:
        super().setUp()
        (self.folder / "bin").mkdir()
        patch = mock.patch.dict(os.environ, OUTSIDE | {"PATH": on_path(self.folder / "bin")}, clear=True)
        patch.start()
        self.addCleanup(patch.stop)

    def launcher(self, script: str, name: str = "mpirun") -> None:
        (self.folder / "bin" / name).write_text(f"#!/bin/sh\n{script}\n")
        (self.folder / "bin" / name).chmod(0o755)

    def job(self, ranks: int = 4) -> Job:
        return Job("run-1", 1, "pyroclast", ("pyroclast", "run", "deck.toml"), {}, ("z",), "summary", 100.0, 1.0, 0,
                   ranks=ranks)

    def test_mpirun_stands_before_a_run_and_within_a_job_of_slurm_srun(self) -> None:
        alone = self.job(1).line(pathlib.Path("out"))
        self.assertEqual(self.job().line(pathlib.Path("out")), ["mpirun", "-n", "4", *alone, "--mpi"])
        with mock.patch.dict(os.environ, SLURM_JOB_ID="7"):
            self.assertEqual(self.job().line(pathlib.Path("out")),
                             ["srun", "--mpi=pmix", "--exact", "-n", "4", *alone, "--mpi"])

    def test_a_run_goes_on_from_its_checkpoint_on_the_ranks(self) -> None:
        self.launcher('echo "$*"')
        folder = self.folder / "run-1"
        (folder / "checkpoints").mkdir(parents=True)
        for name in ("manifest.json", "checkpoints/1.state"):
            (folder / name).touch()
        attempt = Attempt(self.job(), self.folder)
        attempt.process.wait()
        said = (self.folder / "run-1.log").read_text().split()
        self.assertEqual(said[:5], ["-n", "4", "pyroclast", "resume", str(folder)])
        self.assertEqual(said[-1], "--mpi")

    def test_ranks_are_asked_to_stop_by_the_signal_that_launchers_pass_on(self) -> None:
        self.launcher("trap 'exit 130' USR1; touch \"$0.begun\"; while :; do sleep 0.05; done")
        attempt = Attempt(self.job(), self.folder)
        while not (self.folder / "bin/mpirun.begun").exists():
            time.sleep(0.02)
        attempt.look_after(True)
        self.assertIsNone(attempt.end())

    def test_a_rank_that_is_killed_is_no_fault_of_the_run_but_one_that_crashes_is(self) -> None:
        self.launcher("exit 137")
        self.assertIsNone(Attempt(self.job(), self.folder).end())
        self.launcher("echo 'error: rank 1: the sea is dry'; echo 'Primary job terminated'; echo -----; exit 139")
        result = Attempt(self.job(), self.folder).end()
        self.assertEqual((result.state, result.reason), (CRASHED, "signal 11: error: rank 1: the sea is dry"))

    def test_runs_at_once_share_the_cores_by_their_ranks(self) -> None:
        study = self.study(of_deck('kind = "ensemble"', "", "ranks = 4"))
        for cores, slots in ((1, 1), (8, 2), (11, 2)):
            with mock.patch.object(study_module, "free_cores", lambda cores=cores: cores):
                executor = study.executor("local")
                assert isinstance(executor, Local)
                self.assertEqual(executor.slots, slots)

    def test_slurm_is_asked_for_a_task_for_each_rank(self) -> None:
        slurm = FakeSlurm(self.folder / "slurm")
        self.addCleanup(slurm.close)
        begun = time.monotonic()
        with mock.patch.dict(os.environ, PATH=on_path(slurm.folder)):
            Slurm(SlurmSettings(), lambda text: None, (0.05, 0.1)).run(
                [self.job()], self.folder / "study" / "runs", lambda result: None, lambda: time.monotonic() > begun + 0.3)
        self.assertEqual(slurm.jobs[0].options["ntasks"], "4")

    @NEEDS_MPI
    def test_commands_take_srun_in_their_script(self) -> None:
        study = self.study(of_deck('kind = "ensemble"', "", "ranks = 4"))
        self.assertFalse(study.run("commands"))
        line = (study.setup.folder / "commands.txt").read_text()
        self.assertTrue(line.startswith("mpirun -n 4 "))
        script = (study.setup.folder / "commands.sbatch").read_text()
        self.assertIn("\n#SBATCH --ntasks=4\n", script)
        self.launcher('echo "$*" >"$0.said"', "srun")
        subprocess.run(["sh"], input=script, text=True, check=True, env=os.environ | {"SLURM_ARRAY_TASK_ID": "1"})
        self.assertTrue((self.folder / "bin/srun.said").read_text().startswith("--mpi=pmix -n 4 " + PROGRAM))

    @NEEDS_MPI
    def test_a_run_on_ranks_is_the_run_of_one_process(self) -> None:
        text = of_deck('kind = "ensemble"', "", "ranks = 2").replace("60,", "40,")
        with mock.patch.dict(os.environ, PYROCLAST_CHUNK_BLOCKS="16", OMPI_ALLOW_RUN_AS_ROOT="1",
                             OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1"):
            together = self.study(text)
            self.assertTrue(together.run())
        alone = self.study(text.replace("ranks = 2", ""))
        self.assertEqual([{**row, "command": ""} for row in alone.rows()],
                         [{**row, "command": ""} for row in together.rows()])
        self.assertEqual(alone.forecast().left, 0)
        self.assertEqual(alone.rows()[0]["state"], "done")

    def test_without_mpi_ranks_are_refused(self) -> None:
        program = self.folder / "bin" / "pyroclast"
        self.launcher("exit 1", "pyroclast")
        study = Study(self.file(of_deck('kind = "ensemble"', "", "ranks = 2")), program=str(program))
        with self.assertRaisesRegex(Error, r"study\.toml:\d+: .*bin/pyroclast was built without MPI.*-DPYROCLAST_MPI=ON"):
            study.check()
        self.assertFalse(study.setup.folder.exists())

    def test_ranks_are_of_decks_alone(self) -> None:
        with self.assertRaisesRegex(Error, 'ranks = 2: has no meaning with runner = "function"'):
            self.study(self.of_function('kind = "ensemble"', " ", "ranks = 2"))


if __name__ == "__main__":
    unittest.main()
