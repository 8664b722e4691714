"""A run on the ranks of an MPI job is that of one process, sends no more than it must, and tells its errors once.

PYROCLAST names the program, MPI_CALLS_COUNTER the shared object of mpi_calls.cpp.
"""

import concurrent.futures
import csv
import importlib.machinery
import importlib.util
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import unittest

from in_a_folder import PROGRAM, InAFolder

ROOT = pathlib.Path(__file__).parents[2]


def case_file(name: str) -> str:
    return str(ROOT / f"cases/{name}.toml")


CASE = case_file("starter")
SMALL = ["--set", "blocks.count=250", "--set", "stages[1].velocity=4 mm/s", "--no-figures"]
HAS_MPI = (pathlib.Path(PROGRAM).parents[1] / "lib/pyroclast/pyroclast_mpi.so").exists()
NEEDS_MPI = unittest.skipUnless(HAS_MPI, "the program was built without MPI")
SCRIPT = str(ROOT / "validation" / "ranks")
loader = importlib.machinery.SourceFileLoader("ranks", SCRIPT)
validation_ranks = importlib.util.module_from_spec(importlib.util.spec_from_loader("ranks", loader))
loader.exec_module(validation_ranks)
MPI = {**validation_ranks.MPI, "PYROCLAST_CHUNK_BLOCKS": "16", "PYROCLAST_RANKS_LIMIT": "60"}
COUNTER = os.environ.get("MPI_CALLS_COUNTER", "")
# Some rows of a press, without frames between their stages.
PRESS = ["--set", "stages[1].velocity=8 mm/s", "--set", "stages[1].ramp_time=2 ms", "--set",
         "stages[1].stop_strain=0.0002", "--set", "output.frame_strain=1", "--set", "aggregates.fraction=0.2"]
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
        small = [*SMALL, "--set", "blocks.count=120", "--set", "stages[1].velocity=12 mm/s"]
        alone = self.pyroclast("run", CASE, *small, "-t", "1", "--out", "alone",
                               env={**os.environ, "PYROCLAST_CHUNK_BLOCKS": "16"})
        together = self.start(2, "run", CASE, *small, "-t", "1", "--mpi", "--out", "together")
        self.assertEqual(together.returncode, 0, together.stderr)
        timeless = [[line for line in done.stdout.splitlines()
                     if line[2:3] != ":" and not line.startswith(("ended", "processor", "results"))]
                    for done in (alone, together)]
        self.assertEqual(timeless[0], timeless[1])
        self.assertIn("2 ranks with 1 thread", together.stdout)
        files = [{str(file.relative_to(self.folder / run)) for file in (self.folder / run).rglob("*") if file.is_file()}
                 for run in ("alone", "together")]
        self.assertEqual(files[0], files[1])

    def calls(self, ranks: int, case: str, *words) -> list[list[tuple[str, list[list[str]]]]]:
        """Runs a case into a folder of its name. Returns the calls of each rank: collectives and messages by turns."""
        done = self.start(ranks, f"LD_PRELOAD={COUNTER}", f"MPI_CALLS={case}.calls", PROGRAM, "run", case_file(case),
                          *words, "-t", "1", "--no-figures", "--quiet", "--mpi", "--out", case, program="env")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [[line.split() for line in (self.folder / f"{case}.calls.{rank}").read_text().splitlines()]
                 for rank in range(ranks)]
        return [[(kind, list(group)) for kind, group in itertools.groupby(of_rank, lambda line: line[0])]
                for of_rank in lines]

    def assert_foretold(self, sent: list[int], what: str, case: str, *words):
        """sent: bytes of each rank, whose mean and most `check` tells in kB."""
        said = self.pyroclast("check", case_file(case), *words, "--ranks", len(sent), env={**os.environ, **MPI}).stdout
        told = re.search(rf"sent after each {what} .*\[kB\] +(\S+) +(\S+)", said)
        self.assertEqual(told.groups(), (f"{sum(sent) / len(sent) / 1000:.1f}", f"{max(sent) / 1000:.1f}"))

    @NEEDS_MPI
    def test_a_batch_takes_a_message_a_step_and_three_collectives(self):
        """A batch of s steps sends each neighbour s + 1 messages, as long as `check` foretells, and no collective.

        Three at most follow, but where a stage begins. A gather that has grown is sent once more.
        """
        for case, ranks, blocks in (("starter", 2, 120), ("starter_3d", 3, 60)):
            changes = ["--set", f"blocks.count={blocks}", *PRESS]
            sent = []
            for calls in self.calls(ranks, case, *changes):
                with open(self.folder / case / "history.csv", newline="") as file:
                    steps = int(list(csv.DictReader(file))[-1]["step"])
                batches = [group for kind, group in calls if kind == "messages"]
                self.assertGreater(len(batches), 20)
                for _, to, length, _ in batches[0]:
                    of_one = [int(count) for batch in batches for _, rank, bytes_, count in batch
                              if (rank, bytes_) == (to, length)]
                    self.assertEqual((len(of_one), sum(of_one)), (len(batches), steps + len(batches)))
                self.assertEqual({len(batch) for batch in batches}, {len(batches[0])})
                sent.append(sum(int(length) for _, _, length, _ in batches[0]))
                looks = [[name for _, name in group] for kind, group in calls if kind == "collective"][1:-1]
                looks = [look for look in looks if "gatherv" not in look]
                self.assertLessEqual(max(look.count("allgather") for look in looks), 3)
                self.assertLessEqual(sum(look.count("allgatherv") for look in looks), 4)
            self.assert_foretold(sent, "step", case, *changes)

    @NEEDS_MPI
    def test_a_frame_takes_nine_collectives(self):
        """However large it is: all ranks write it."""
        for blocks in (120, 480):
            changes = [*PRESS, "--set", f"blocks.count={blocks}", "--set", "output.frame_strain=0.00005"]
            for calls in self.calls(2, "starter", *changes, "--overwrite"):
                counts = [len(group) for kind, group in calls if kind == "collective"]
                self.assertGreaterEqual(counts.count(3 + 9), 3, counts)
                self.assertEqual(max(count for count in counts if count < 20), 3 + 9)

    @NEEDS_MPI
    def test_a_heat_stage_takes_a_message_and_with_limits_two(self):
        changes = ["--set", "blocks.count=100", "--set", "stages[0].duration=2 min"]
        sent = []
        for calls in self.calls(2, "thermal_wall", *changes):
            solver = json.loads((self.folder / "thermal_wall/summary.json").read_text())["heat_solver"]
            trials = [{int(length): int(count) for _, _, length, count in group}
                      for kind, group in calls if kind == "messages"]
            length = min(length for trial in trials for length in trial)
            self.assertEqual(sum(trial[length] for trial in trials), solver["evaluations"] + 1, "one before the first")
            limited = [trial for trial in trials if len(trial) > 1]
            for trial in limited:
                self.assertEqual(trial, {length: trial[length], 2 * length: trial[length]})
            self.assertTrue(solver["limited_steps"] <= len(limited) < len(trials))
            sent.append(length)
        self.assert_foretold(sent, "stage", "thermal_wall", *changes)

    @NEEDS_MPI
    def test_all_calls_of_mpi_are_counted(self):
        """What sends is among the calls that the tests above count, or is called once a run."""
        of = [set(re.findall(r"(?<!P)MPI_[A-Z]\w+(?=\()", (ROOT / file).read_text()))
              for file in ("src/pyroclast/parallel/mpi_processes.cpp", "tests/app/mpi_calls.cpp")]
        self.assertEqual(of[0] - of[1], {f"MPI_{name}" for name in (
            "Abort", "Allgather", "Comm_free", "Comm_rank", "Comm_size", "Comm_split_type", "Ibarrier", "Init_thread",
            "Irecv", "Test", "Testall")})

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

    def ended(self, end) -> tuple[subprocess.Popen, str, str]:
        """Starts a long run on two ranks and ends it by `end(mpirun, processes of the ranks)`. All are gone soon.

        Returns mpirun and all that was said.
        """
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        words = ["run", CASE, *SMALL, "--set", "stages[1].stop_strain=0.5", "--set", "stages[1].velocity=1 mm/s", "-t", "1",
                 "--mpi", "--out", "out"]
        with subprocess.Popen(["mpirun", "-n", "2", PROGRAM, *words], cwd=self.folder, env={**os.environ, **MPI},
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as mpirun:
            history = self.folder / "out/history.csv"
            while mpirun.poll() is None and not (history.exists() and len(history.read_text().splitlines()) > 5):
                time.sleep(0.05)
            copies = list(map(int, subprocess.run(["pgrep", "--parent", str(mpirun.pid)], capture_output=True, text=True,
                                                  check=False).stdout.split()))
            self.assertEqual(len(copies), 2)
            began = time.monotonic()
            end(mpirun, copies)
            said = mpirun.communicate(timeout=60)
            self.assertLess(time.monotonic() - began, SOON)
        while any(pathlib.Path(f"/proc/{copy}").exists() for copy in copies):
            self.assertLess(time.monotonic() - began, SOON)
            time.sleep(0.05)
        return mpirun, *said

    @NEEDS_MPI
    def test_a_signal_that_time_is_short_stops_all_ranks_after_a_batch(self):
        """mpirun passes SIGUSR1 on, more than once too; one rank that gets it alone stops the others."""
        for end in (lambda mpirun, copies: [mpirun.send_signal(signal.SIGUSR1), time.sleep(0.05),
                                            mpirun.send_signal(signal.SIGUSR1)],
                    lambda mpirun, copies: os.kill(copies[1], signal.SIGUSR1)):
            mpirun, said, _ = self.ended(end)
            self.assertEqual(mpirun.returncode, 130)
            self.assertEqual(said.count("\nended           stopped"), 1)
            self.assertEqual(json.loads((self.folder / "out/summary.json").read_text())["outcome_id"], "stopped")

    @NEEDS_MPI
    def test_a_rank_that_dies_ends_all_and_this_is_told(self):
        mpirun, _, errors = self.ended(lambda mpirun, copies: os.kill(copies[1], signal.SIGKILL))
        self.assertEqual(mpirun.returncode, 128 + signal.SIGKILL)
        self.assertIn("rank 1", errors)
        self.assertIn("signal 9", errors)
        self.assertFalse((self.folder / "out/summary.json").exists())

    @NEEDS_MPI
    def test_a_run_that_lost_a_rank_goes_on_on_another_number(self):
        """Killed on two ranks, stopped on three, and ended by two: files and checkpoints are those of one process.

        Blocks that drop find contacts between ranks.
        """
        def start(ranks: int, *words) -> subprocess.Popen:
            return subprocess.Popen(["mpirun", "-n", str(ranks), PROGRAM, *map(str, words), "-t", "1", "--mpi", "--quiet",
                                     "--no-figures", "--checkpoint", "0s"], cwd=self.folder, env={**os.environ, **MPI},
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def wait_for(rows: int, history: pathlib.Path, mpirun: subprocess.Popen) -> None:
            while not (history.exists() and len(history.read_text().splitlines()) > rows):
                self.assertIsNone(mpirun.poll(), "the run ended too early")
                time.sleep(0.02)

        drop = ["--set", "blocks.count=100", "--set", "stages[0].duration=0.6 ms", "--no-figures"]
        for case, words in ((CASE, [*SMALL, *PRESS]), (case_file("drop"), drop)):
            whole, broken = (self.folder / f"{how} {pathlib.Path(case).stem}" for how in ("whole", "broken"))
            self.pyroclast("run", case, *words, "-t", "1", "--out", whole,
                           env={**os.environ, "PYROCLAST_CHUNK_BLOCKS": "16"})
            with start(2, "run", case, *words, "--out", broken) as mpirun:
                wait_for(4, broken / "history.csv", mpirun)
                subprocess.run(["pkill", "-KILL", "--parent", str(mpirun.pid)], check=True)
            with start(3, "resume", broken) as mpirun:
                wait_for(9, broken / "history.csv", mpirun)
                mpirun.send_signal(signal.SIGUSR1)
            self.assertEqual(mpirun.returncode, 130)
            with start(2, "resume", broken) as mpirun:
                pass
            self.assertEqual(mpirun.returncode, 0)
            self.assertEqual(validation_ranks.differences(whole, broken), [])
        with self.subTest("other chunks"):
            self.assertIn("chunks of 16 blocks, and this run has chunks of 1024",
                          self.pyroclast("resume", whole, code=1).stderr)

    @NEEDS_MPI
    def test_a_file_that_one_rank_cannot_write_ends_all(self):
        """Rank 1 does not see the file that the first one made, or its disk is full: it says so. No file is left."""
        (self.folder / "elsewhere").mkdir()

        def try_it(how: str, says: str, name: str, *words: str) -> None:
            out = f"{how.split()[0]}{name}"
            program = self.folder / f"{out}.sh"
            program.write_text(f'#!/bin/sh\n[ "${{OMPI_COMM_WORLD_RANK:-$PMI_RANK}}" = 1 ] && {how}\n'
                               f'exec {PROGRAM} "$@"\n')
            program.chmod(0o755)
            error = self.refused(2, "run", CASE, *SMALL, *words, "--mpi", "--out", out, program=str(program))
            for part in ("rank 1", says, name):
                self.assertIn(part, error)
            for place in (self.folder, self.folder / "elsewhere"):
                self.assertEqual(list((place / out).rglob(f"*{name}*")), [])

        trials = itertools.product(
            (("cd elsewhere", "all ranks need one file system"), ("ulimit -f 8", "cannot be written")),
            (("mesh.h5",), (".state", "--set", "output.fields=false")))
        with concurrent.futures.ThreadPoolExecutor() as pool:  # mpirun mostly waits
            for trial in [pool.submit(try_it, *how, *what) for how, what in trials]:
                trial.result()

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


class ScriptOfSlurm(InAFolder):
    def test_the_script_of_the_docs_goes_on_after_its_time_limit(self):
        """A run of one process stands for the ranks; srun sends the signal that Slurm sends before the time is over."""
        page = (ROOT / "docs/do/cluster.md").read_text()
        script = re.search(r"```sh\n(#!/bin/bash\n.*?)```", page, re.DOTALL)[1]
        options = re.findall(r"^#SBATCH --([a-z-]+)", script, re.MULTILINE)
        self.assertLessEqual({"ntasks", "time", "signal", "requeue", "open-mode"}, set(options))
        (self.folder / "deck.toml").write_text(pathlib.Path(CASE).read_text().replace("count = 1000", "count = 80"))
        for name, text in (("srun", """
            echo "srun $*" >>said
            while [[ $1 == --* ]]; do shift; done
            words=(); for word; do [[ $word == --mpi ]] || words+=("$word"); done
            "${words[@]}" & until [[ $(wc -l 2>/dev/null <runs/beam/history.csv) -gt 5 ]]; do sleep 0.05; done
            [[ ${words[1]} == resume ]] || kill -USR1 $!
            wait $!"""), ("scontrol", 'echo "scontrol $*" >>said')):
            (self.folder / name).write_text(f"#!/bin/bash\n{text}\n")
            (self.folder / name).chmod(0o755)
        (self.folder / "pyroclast").symlink_to(PROGRAM)
        for count in ("0", "1"):
            done = subprocess.run(["bash", "-c", script], cwd=self.folder, capture_output=True, text=True, timeout=100,
                                  check=False, env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}",
                                                    "SLURM_JOB_ID": "7", "SLURM_RESTART_COUNT": count})
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        said = (self.folder / "said").read_text().splitlines()
        self.assertEqual([" ".join(line.split()[:4]) for line in said],
                         ["srun --mpi=pmix pyroclast run", "scontrol requeue 7", "srun --mpi=pmix pyroclast resume"])
        self.assertNotEqual(json.loads((self.folder / "runs/beam/summary.json").read_text())["outcome_id"], "stopped")


if __name__ == "__main__":
    unittest.main()
