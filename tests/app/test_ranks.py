"""A run on the ranks of an MPI job is that of one process, and its errors are told once. PYROCLAST names the program."""

import importlib.machinery
import importlib.util
import os
import pathlib
import subprocess
import time
import unittest

from in_a_folder import PROGRAM, InAFolder

ROOT = pathlib.Path(__file__).parents[2]
CASE = str(ROOT / "cases/starter.toml")
SMALL = ["--set", "blocks.count=250", "--set", "stages[1].velocity=4 mm/s", "--no-figures"]
HAS_MPI = (pathlib.Path(PROGRAM).parents[1] / "lib/pyroclast/pyroclast_mpi.so").exists()
NEEDS_MPI = unittest.skipUnless(HAS_MPI, "the program was built without MPI")
SCRIPT = str(ROOT / "validation" / "ranks")
loader = importlib.machinery.SourceFileLoader("ranks", SCRIPT)
validation_ranks = importlib.util.module_from_spec(importlib.util.spec_from_loader("ranks", loader))
loader.exec_module(validation_ranks)
MPI = {**validation_ranks.MPI, "PYROCLAST_CHUNK_BLOCKS": "16", "PYROCLAST_RANKS_LIMIT": "60"}
SOON = 10  # s, within which all ranks end after an error


class Ranks(InAFolder):
    def start(self, ranks: int, *words, program: str = PROGRAM, **variables) -> subprocess.CompletedProcess:
        """Starts copies of the program together."""
        return subprocess.run(["mpirun", "-n", str(ranks), program, *(str(word) for word in words)], cwd=self.folder,
                              env={**os.environ, **MPI, **variables}, capture_output=True, text=True, timeout=300,
                              check=False)

    def refused(self, ranks: int, *words, program: str = PROGRAM) -> str:
        """The one error of a command, which ends all ranks soon."""
        began = time.monotonic()
        done = self.start(ranks, *words, program=program)
        took = time.monotonic() - began
        self.assertNotEqual(done.returncode, 0, done.stdout)
        errors = [line for line in done.stderr.splitlines() if "error:" in line]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertLess(took, SOON)
        return errors[0]

    @NEEDS_MPI
    def test_a_run_says_what_one_process_says(self):
        """The log has the lines of one process but times, and the ranks; the folder has no file of another rank."""
        alone = self.pyroclast("run", CASE, *SMALL, "-t", "1", "--out", "alone",
                               env={**os.environ, "PYROCLAST_CHUNK_BLOCKS": "16"})
        together = self.start(2, "run", CASE, *SMALL, "-t", "1", "--mpi", "--out", "together")
        self.assertEqual(together.returncode, 0, together.stderr)
        timeless = [[line for line in done.stdout.splitlines()
                     if line[2:3] != ":" and not line.startswith(("ended", "processor", "results"))]
                    for done in (alone, together)]
        self.assertEqual(timeless[0], timeless[1])
        self.assertIn("2 ranks with 1 thread", together.stdout)
        files = [{str(file.relative_to(self.folder / run)) for file in (self.folder / run).rglob("*") if file.is_file()}
                 for run in ("alone", "together")]
        self.assertEqual({file for file in files[0] if not file.startswith("checkpoints")}, files[1])

    @NEEDS_MPI
    def test_errors_are_told_once_and_end_all_ranks(self):
        self.assertIn("stages[1].velocity", self.refused(3, "run", CASE, "--mpi", "--set", "stages[1].velocity=-1"))
        (self.folder / "full").mkdir()
        (self.folder / "full/file").touch()
        self.assertIn("full", self.refused(2, "run", CASE, *SMALL, "--mpi", "--out", "full"))
        self.assertRegex(self.refused(30, "run", CASE, *SMALL, "--set", "blocks.count=60", "--mpi"),
                         r"30 ranks cannot share a body of \d+ chunks")
        self.assertFalse((self.folder / "runs").exists())

    @NEEDS_MPI
    def test_ranks_that_read_other_decks_are_refused(self):
        text = pathlib.Path(CASE).read_text()
        for rank in (0, 1):
            place = self.folder / str(rank)
            place.mkdir()
            (place / "deck.toml").write_text(text if rank == 0 else text.replace("E = \"", "E  = \"") + "\n")
        program = self.folder / "program"
        program.write_text(f'#!/bin/sh\ncd "${{OMPI_COMM_WORLD_RANK:-$PMI_RANK}}" && exec {PROGRAM} "$@"\n')
        program.chmod(0o755)
        self.assertIn("rank 1 reads another deck than rank 0",
                      self.refused(2, "run", "deck.toml", *SMALL, "--mpi", program=str(program)))

    def test_copies_that_know_nothing_of_each_other_are_refused(self):
        """The count is that of the step at hand. A large allocation in which one copy runs is none."""
        for variable in ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"):
            done = self.pyroclast("run", CASE, *SMALL, code=1, env={**os.environ, variable: "4"})
            self.assertIn(f"4 copies of this command were started together ({variable}=4)", done.stderr)
            self.assertIn("--mpi", done.stderr)
        self.assertFalse((self.folder / "runs").exists())
        self.pyroclast("check", CASE, *SMALL[:4], env={**os.environ, "SLURM_NTASKS": "4", "SLURM_STEP_NUM_TASKS": "1"})

    @unittest.skipIf(HAS_MPI, "the program was built with MPI")
    def test_a_program_without_mpi_says_so(self):
        self.assertIn("-DPYROCLAST_MPI=ON", self.pyroclast("run", CASE, "--mpi", code=1).stderr)

    def test_some_options_have_no_meaning_on_ranks(self):
        for words in (["--seeds", "3"], ["--dry-run"]):
            self.assertIn("--mpi", self.pyroclast("run", CASE, "--mpi", *words, code=1).stderr)


if __name__ == "__main__":
    unittest.main()
