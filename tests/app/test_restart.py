"""Runs that are stopped, killed, resumed and forked. PYROCLAST names the program."""

import json
import pathlib
import resource
import shutil
import signal
import subprocess
import time
import unittest

from in_a_folder import PROGRAM, InAFolder

CASES = pathlib.Path(__file__).parents[2] / "cases"
SMALL = ("specimen.width=50 mm", "specimen.height=100 mm", "aggregates.d_max=12 mm", 'aggregates.sieves=["8 mm"]',
         "blocks.count=100", "stages[1].velocity=4 mm/s", "stages[1].ramp_time=2 ms", "stages[1].stop_strain=6e-4",
         "output.history_strain=4e-6", "output.frame_strain=1e-4")
HEATED = ("specimen.width=50 mm", "specimen.height=100 mm", "aggregates.d_max=12 mm", 'aggregates.sieves=["8 mm"]',
          "blocks.count=60", "coupling.exchange_increment=10 K", "coupling.least_cycles=100",
          "coupling.most_cycles=500", "stages[1].level=0.2", "stages[1].ramp_time=2 ms", "stages[2].to=120 degC")


def changes(*keys: str) -> list[str]:
    return [word for key in keys for word in ("--set", key)]


class RestartTest(InAFolder):
    def run_case(self, out: str, *more: str, case: str = "starter", small: tuple = SMALL, **options):
        return self.pyroclast("run", CASES / f"{case}.toml", *changes(*small), *more, "--out", out, "--no-figures",
                              **options)

    def broken_off(self, out: str, by: signal.Signals, rows: int = 60, *more: str, case: str = "starter",
                   small: tuple = SMALL) -> None:
        """A run that is ended once it has so many rows; it keeps its state after every batch."""
        words = [PROGRAM, "run", CASES / f"{case}.toml", *changes(*small), *more, "--out", out, "--no-figures",
                 "--checkpoint", "0 s"]
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            self.wait_for(out, rows)
            process.send_signal(by)
            process.wait(timeout=120)

    def wait_for(self, out: str, rows: int) -> None:
        history = self.folder / out / "history.csv"
        for _ in range(3000):
            if history.exists() and history.read_bytes().count(b"\n") > rows:
                return
            time.sleep(0.01)
        self.fail("the run writes no rows")

    def results(self, out: str) -> dict[str, bytes]:
        """All that must be the same, whether a run was broken off or not."""
        folder = self.folder / out
        found = {"history.csv": (folder / "history.csv").read_bytes()}
        for file in sorted((folder / "fields").iterdir()):
            found[file.name] = file.read_bytes()
        summary = json.loads((folder / "summary.json").read_text())
        summary.pop("wall_time_s")
        return found | {"summary.json": json.dumps(summary).encode()}

    def files(self, out: str) -> dict[pathlib.Path, bytes]:
        """All that stands in a folder, but for the lock of a process that was killed."""
        return {file: file.read_bytes() for file in (self.folder / out).rglob("*")
                if file.is_file() and file.name != "lock"}

    def assert_same(self, one: str, other: str) -> None:
        a, b = self.results(one), self.results(other)
        self.assertEqual([name for name in a.keys() | b.keys() if a.get(name) != b.get(name)], [])

    def checkpoints(self, out: str) -> list[pathlib.Path]:
        return sorted((self.folder / out / "checkpoints").glob("0*.state"))


class Resuming(RestartTest):
    def test_a_run_goes_on_as_if_it_was_never_stopped_or_killed(self):
        self.run_case("whole", "--threads", "1")
        for by in (signal.SIGTERM, signal.SIGKILL):
            out = by.name
            self.broken_off(out, by)
            self.assertEqual((self.folder / out / "summary.json").exists(), by != signal.SIGKILL)
            self.pyroclast("resume", out, "--threads", "2", "--instructions", "portable", "--no-figures")
            self.assert_same("whole", out)
            log = (self.folder / out / "run.log").read_text()
            self.assertEqual(log.count("goes on from"), 1)
            self.assertEqual(log.count("\nended  "), 1)  # what was said after the checkpoint is gone
        done = self.pyroclast("resume", "whole", code=1)
        self.assertIn("the run is over", done.stderr)
        # the disk was full at the very end
        (self.folder / "whole/summary.json").unlink()
        self.pyroclast("resume", "whole", "--no-figures")
        self.assert_same("whole", "SIGTERM")

    def test_a_body_that_turns_goes_on_with_the_masses_of_the_frames_before(self):
        # scaled masses follow stiffnesses, which were those of the last change of properties
        finite = changes('mechanics.kinematics="finite"', "stages[1].velocity=40 mm/s", "stages[1].stop_strain=4e-3")
        self.run_case("whole", *finite, "--threads", "1")
        self.broken_off("out", signal.SIGKILL, 600, *finite)
        self.pyroclast("resume", "out", "--no-figures")
        self.assert_same("whole", "out")

    def test_contacts_that_were_found_go_on(self):
        found = changes('mechanics.kinematics="finite"', 'mechanics.contacts="found"', "stages[1].velocity=80 mm/s",
                        "stages[1].stop_strain=8e-3", "stages[1].stop_fraction_of_peak=0.01")
        self.run_case("whole", *found, "--threads", "1")
        summary = json.loads((self.folder / "whole/summary.json").read_text())
        self.assertGreater(summary["energy_J"]["dissipated_contact_area"], 0.0)  # pairs have pressed and slid
        self.assertLess(abs(summary["energy_J"]["error_over_turnover"]), 1e-3)
        self.broken_off("out", signal.SIGKILL, 900, *found)
        self.pyroclast("resume", "out", "--threads", "2", "--no-figures")
        self.assert_same("whole", "out")

    def test_contacts_that_were_found_in_a_solid_go_on(self):
        solid = {"case": "starter_3d", "small": ("blocks.count=14", "aggregates.fraction=0.0", "specimen.height=100 mm",
                                                 "stages[1].velocity=80 mm/s", "stages[1].stop_strain=8e-3",
                                                 "stages[1].stop_fraction_of_peak=0.01", "output.history_strain=2e-5")}
        found = changes('mechanics.kinematics="finite"', 'mechanics.contacts="found"')
        self.run_case("whole", *found, "--threads", "1", **solid)
        summary = json.loads((self.folder / "whole/summary.json").read_text())
        self.assertNotEqual(summary["energy_J"]["dissipated_contact_area"], 0.0)  # faces were handed over and slid
        self.assertLess(abs(summary["energy_J"]["error_over_turnover"]), 1.5e-3)  # first contacts: 1.4e-3
        self.broken_off("out", signal.SIGKILL, 300, *found, **solid)
        self.pyroclast("resume", "out", "--threads", "2", "--instructions", "portable", "--no-figures")
        self.assert_same("whole", "out")

    def test_a_frame_that_is_lost_is_named(self):
        self.broken_off("out", signal.SIGKILL, 100)
        (self.folder / "out/fields/blocks_0001.hdf").unlink()
        with open(self.folder / "out/fields/contacts_0000.hdf", "r+b") as file:
            file.truncate(1000)
        done = self.pyroclast("resume", "out", "--no-figures")
        summary = json.loads((self.folder / "out/summary.json").read_text())
        for name in ("blocks_0001.hdf", "contacts_0000.hdf"):
            self.assertIn(f"a frame is lost: fields/{name}", done.stdout)
            self.assertIn(f"a frame is lost: fields/{name}", "".join(summary["warnings"]))
        self.assertNotIn("blocks_0000.hdf", done.stdout)

    def test_a_damaged_checkpoint_is_refused_and_the_one_before_it_offered(self):
        self.run_case("whole")
        self.broken_off("out", signal.SIGKILL)
        before, newest = self.checkpoints("out")[-2:]
        content = bytearray(newest.read_bytes())
        content[len(content) // 2] ^= 1
        newest.write_bytes(content)
        files = self.files("out")
        done = self.pyroclast("resume", "out", code=1)
        self.assertIn(f"{newest.name}: is damaged", done.stderr)
        self.assertIn(f"--checkpoint-file out/checkpoints/{before.name}", done.stderr)
        self.assertTrue(files == self.files("out"))
        self.pyroclast("resume", "out", "--checkpoint-file", f"out/checkpoints/{before.name}", "--no-figures")
        self.assert_same("whole", "out")

    def test_other_inputs_and_other_folders_are_refused(self):
        self.broken_off("out", signal.SIGTERM)
        deck = self.folder / "out/deck.toml"
        deck.write_text(deck.read_text().replace('f_t = "2.5 MPa"', 'f_t = "2.6 MPa"'))
        self.assertIn("other inputs", self.pyroclast("resume", "out", code=1).stderr)
        self.broken_off("other", signal.SIGTERM, 60, "--seed", "2")
        self.broken_off("third", signal.SIGTERM)
        shutil.copy(self.checkpoints("other")[-1], self.folder / "third/checkpoints/foreign.state")
        done = self.pyroclast("resume", "third", "--checkpoint-file", "third/checkpoints/foreign.state", code=1)
        self.assertIn("other inputs", done.stderr)
        self.assertIn("no such folder", self.pyroclast("resume", "nowhere", code=1).stderr)
        (self.folder / "mine").mkdir()
        (self.folder / "mine/manifest.json").write_text('{"name": "My page"}')
        self.assertIn("not the folder of a run", self.pyroclast("resume", "mine", code=1).stderr)
        self.assertEqual([f.name for f in (self.folder / "mine").iterdir()], ["manifest.json"])
        self.assertIn("fork", self.pyroclast("resume", "out", "--set", "output.frame_strain=1e-3", code=1).stderr)

    def test_nobody_else_writes_into_the_folder_of_a_run_that_lives(self):
        words = [PROGRAM, "run", CASES / "starter.toml", *changes(*SMALL, "stages[1].stop_strain=0.5"), "--out", "out",
                 "--no-figures"]
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            self.wait_for("out", 60)
            for words in (("resume", "out"), ("figures", "run", "out"),
                          ("run", CASES / "starter.toml", "--out", "out", "--overwrite"),
                          ("specimen", CASES / "starter.toml", "--out", "out", "--overwrite")):
                self.assertIn(f"another process ({process.pid})", self.pyroclast(*words, code=1).stderr)
            process.send_signal(signal.SIGKILL)
            process.wait()
        self.pyroclast("figures", "run", "out", "--only", "stress_strain")  # of a run that was killed
        self.assertTrue((self.folder / "out/figures/stress_strain.png").exists())

    def test_a_disk_that_fills_up_leaves_a_run_that_goes_on_once_there_is_room(self):
        self.run_case("whole")
        largest = max(file.stat().st_size for file in (self.folder / "whole").rglob("*") if file.is_file())
        history = (self.folder / "whole/history.csv").stat().st_size
        self.assertLess(history, largest)
        for room in (history // 2, largest - 1000):  # a row does not fit; a checkpoint or a frame does not
            out = f"out{room}"
            limits = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))}  # noqa: B023
            done = self.pyroclast("run", CASES / "starter.toml", *changes(*SMALL), "--out", out, "--no-figures", code=1,
                                  **limits)
            self.assertIn("cannot be written (File too large)", done.stderr)
            if "pyroclast resume" in done.stderr:
                self.pyroclast("resume", out, "--no-figures")
                self.assert_same("whole", out)
            else:
                self.assertEqual(list((self.folder / out / "checkpoints").glob("*")), [])

    def test_the_deck_in_the_folder_gives_the_same_run(self):
        table = self.folder / "E.csv"
        table.write_text("T [degC],E [GPa]\n20,29\n1000,10\n")
        deck = (CASES / "starter.toml").read_text().replace('E = "29.4 GPa"', 'E = { csv = "E.csv" }')
        (self.folder / "deck.toml").write_text(deck)
        self.pyroclast("run", "deck.toml", *changes(*SMALL), "--seed", 5, "--out", "one", "--no-figures")
        table.unlink()
        self.pyroclast("run", "one/deck.toml", "--out", "two", "--no-figures")
        self.assert_same("one", "two")


class Forking(RestartTest):
    def test_a_fork_is_the_run_of_its_deck_from_the_beginning(self):
        case = {"case": "transient_heating", "small": HEATED}
        self.run_case("parent", **case)
        change = ("stages[2].to=90 degC", "stages[2].coupling.exchange_increment=7 K")
        self.pyroclast("resume", "parent", "--from-stage", "1", *changes(*change), "--out", "fork", "--no-figures")
        self.run_case("whole", *changes(*change), **case)
        self.assert_same("fork", "whole")
        parent = json.loads((self.folder / "fork/manifest.json").read_text())["parent"]
        self.assertEqual((parent["from_stage"], parent["changes"]), (1, list(change)))
        # what comes earlier may not change, and is named
        for key, words in (("stages[1].level=0.3", "only stages[2] and later"),
                           ("coupling.exchange_increment=7 K", "stages[2].coupling.exchange_increment"),
                           ("materials.mortar.E=30 GPa", "materials.mortar.E"), ("specimen.seed=2", "specimen.seed")):
            done = self.pyroclast("resume", "parent", "--from-stage", "load", *changes(key), "--out", "no", code=1)
            self.assertIn(words, done.stderr)
        self.assertIn("--out NEW", self.pyroclast("resume", "parent", "--from-stage", "1", code=1).stderr)
        self.assertIn("stages 0 to 2", self.pyroclast("resume", "parent", "--from-stage", "3", "--out", "no",
                                                      code=1).stderr)
        self.assertFalse((self.folder / "no").exists())

    def test_stages_are_appended_to_a_run_that_is_over(self):
        case = {"case": "transient_heating", "small": HEATED}
        self.run_case("parent", **case)
        more = '[[stages]]\nkind = "heat"\nto = "20 degC"\nrate = "1 K/min"\nplaten = "force"\n'
        (self.folder / "more.toml").write_text(more)
        self.pyroclast("resume", "parent", "--stages", "more.toml", "--out", "fork", "--no-figures")
        (self.folder / "long.toml").write_text((self.folder / "parent/deck.toml").read_text() + "\n" + more)
        self.pyroclast("run", "long.toml", "--out", "whole", "--no-figures")
        self.assert_same("fork", "whole")
        self.pyroclast("resume", "fork", code=1)
        (self.folder / "more.toml").write_text("\n" + more.replace("1 K/min", "1 mm"))
        said = self.pyroclast("resume", "parent", "--stages", "more.toml", "--out", "no", code=1).stderr
        self.assertIn("more.toml:5:8: stages[3].rate", said)
        (self.folder / "more.toml").write_text("# later\n")
        said = self.pyroclast("resume", "parent", "--stages", "more.toml", "--out", "no", code=1).stderr
        self.assertIn("more.toml: has no [[stages]]", said)
        self.assertFalse((self.folder / "no").exists())

    WALL = """title = "Wall"
[specimen]
width = "100 mm"
height = "100 mm"
seed = 1
[blocks]
count = 60
shortest_edge = 0.3
[materials.mortar]
density = "2200 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "900 J/(kg K)"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "left"
kind = "temperature"
temperature = "120 degC"
[output]
frame_interval = "1 min"
"""

    def stage(self, name: str) -> str:
        return f'[[stages]]\nkind = "conduct"\nname = "{name}"\nduration = "1 min"\ninterval = "20 s"\n'

    def forks(self) -> None:
        """b is a, with a stage more, and c is b, with another one more."""
        (self.folder / "a.toml").write_text(self.WALL + self.stage("first") + self.stage("second"))
        self.pyroclast("run", "a.toml", "--out", "a", "--no-figures")
        for parent, fork, more in (("a", "b", "third"), ("b", "c", "fourth")):
            (self.folder / f"{more}.toml").write_text(self.stage(more))
            self.pyroclast("resume", parent, "--stages", f"{more}.toml", "--out", fork, "--no-figures")

    def test_a_fork_of_a_fork_begins_from_a_stage_that_neither_of_them_computed(self):
        self.forks()
        for parent, stage in (("b", 0), ("b", 1), ("c", 0), ("c", 2)):
            with self.subTest(parent=parent, stage=stage):
                change = changes(f"stages[{stage + 1}].duration=90 s")
                self.pyroclast("resume", parent, "--from-stage", stage, *change, "--out", "fork", "--overwrite",
                               "--no-figures")
                self.pyroclast("run", f"{parent}/deck.toml", *change, "--out", "whole", "--overwrite", "--no-figures")
                self.assert_same("fork", "whole")
        # the last fork has its states from three folders
        self.pyroclast("resume", "c", "--from-stage", 2, "--out", "d", "--no-figures")
        states = json.loads((self.folder / "d/manifest.json").read_text())["parent"]["states"]
        self.assertEqual([pathlib.Path(state["file"]).parts[-3::2] for state in states],
                         [("a", "stage_0.state"), ("a", "stage_1.state"), ("b", "stage_2.state")])

    def test_a_state_that_is_gone_is_named_with_what_to_do(self):
        self.forks()
        shutil.rmtree(self.folder / "b")  # c does not need it for the stages of a
        self.pyroclast("resume", "c", "--from-stage", 1, "--out", "d", "--no-figures")
        said = self.pyroclast("resume", "c", "--from-stage", 2, "--out", "no", "--no-figures", code=1).stderr
        self.assertIn("c: this fork did not compute stage 2 itself; the state at its end, "
                      f"{self.folder.resolve()}/b/checkpoints/stage_2.state, is not there", said)
        self.assertIn("pyroclast run c/deck.toml --out NEW", said)
        (self.folder / "a").rename(self.folder / "moved")
        said = self.pyroclast("resume", "c", "--from-stage", "first", "--out", "no", "--no-figures", code=1).stderr
        self.assertIn("a/checkpoints/stage_0.state, is not there: the run that holds it was moved or removed", said)
        self.pyroclast("run", "moved/deck.toml", *changes("heat.boundaries[0].temperature=90 degC"), "--out", "a",
                       "--no-figures")
        said = self.pyroclast("resume", "c", "--from-stage", 0, "--out", "no", "--no-figures", code=1).stderr
        self.assertIn("belongs to another run than the one that was forked", said)
        self.assertFalse((self.folder / "no").exists())

    def test_a_run_that_keeps_no_states_of_stages_says_so(self):
        (self.folder / "a.toml").write_text(self.WALL + "keep_stage_checkpoints = false\n" + self.stage("first")
                                            + self.stage("second"))
        self.pyroclast("run", "a.toml", "--out", "a", "--no-figures")
        said = self.pyroclast("resume", "a", "--from-stage", 0, "--out", "no", code=1).stderr
        self.assertIn("a: keeps no states of stages ([output] keep_stage_checkpoints = false)", said)
        self.assertFalse((self.folder / "no").exists())


if __name__ == "__main__":
    unittest.main()
