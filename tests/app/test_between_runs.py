"""Numbers that go from run to run, and the verdict on the run that they come from. PYROCLAST names the program."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["PYROCLAST"]

BODY = """title = "small"
[specimen]
width = "60 mm"
height = "120 mm"
seed = 1
[blocks]
count = 60
shortest_edge = 0.3
[materials.mortar]
E = "30 GPa"
nu = 0.2
density = "2200 kg/m3"
[materials.platen]
E = "200 GPa"
nu = 0.3
density = "7850 kg/m3"
[platens]
thickness = "20 mm"
[contacts]
t_b = "1.6 mm"
t_b_scaling = "block size"
t_b_block_size = "3 mm"
platen_friction = 0.0
[contacts.mortar_mortar]
f_t = "2.5 MPa"
G_f1 = "60 N/m"
f_cm = "31 MPa"
beta = 0.05
c_o = "3.8 MPa"
c_res = "0.038 MPa"
phi = "34 deg"
phi_res = "34 deg"
G_f2 = "240 N/m"
[mechanics]
mass = "scaled"
time_step = "20 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = "0 m/s2"
"""
OUTPUT = '[output]\nhistory_strain = 2e-5\nframe_strain = 1e-3\n'
COMPRESS = """[[stages]]
kind = "compress"
velocity = "{velocity}"
ramp_time = "10 ms"
stop_strain = 0.006
stop_fraction_of_peak = 0.85
"""
LOAD = """[[stages]]
kind = "load"
level = 0.3
f_c = {{ run = "{run}" }}
unbalanced_ratio = 1e-3
ramp_time = "20 ms"
most_steps = 5000
"""


def sure(summary: dict) -> None:
    """Takes all doubts out of a summary."""
    stage = summary["stages"][0]
    summary["warnings"].clear()
    stage["warnings"].clear()
    stage["results"]["stress_max_MPa"] = stage["results"]["f_c_MPa"]


class BetweenRuns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        for name, velocity in (("fast", "20 mm/s"), ("slow", "1 mm/s")):
            (cls.folder / f"{name}.toml").write_text(BODY + OUTPUT + COMPRESS.format(velocity=velocity))
            cls.pyroclast("run", f"{name}.toml", "-o", name, "--no-figures", "--quiet")

    @classmethod
    def pyroclast(cls, *words, code: int = 0) -> subprocess.CompletedProcess:
        done = subprocess.run([PROGRAM, *words], cwd=cls.folder, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == code, done.stdout + done.stderr
        return done

    def summary(self, run: str) -> dict:
        return json.loads((self.folder / run / "summary.json").read_text())

    def copied(self, name: str, change, of: str = "slow") -> str:
        """A copy of a run whose summary is changed."""
        shutil.copytree(self.folder / of, self.folder / name, dirs_exist_ok=True)
        summary = self.summary(of)
        change(summary)
        (self.folder / name / "summary.json").write_text(json.dumps(summary))
        return name

    def load_of(self, run: str) -> None:
        (self.folder / "load.toml").write_text(BODY + OUTPUT + LOAD.format(run=run))

    def test_the_two_runs_differ_in_their_verdict(self):
        self.assertIs(self.summary("fast")["stages"][0]["results"]["quasi_static"], False)
        self.assertIs(self.summary("slow")["stages"][0]["results"]["quasi_static"], True)

    def test_a_strength_that_does_not_count_is_refused_with_its_reason(self):
        def ended(outcome: str):
            return lambda s: (s.update(outcome_id=outcome, outcome=f"it is {outcome}", is_good=False),
                              s["stages"][-1].update(outcome_id=outcome, outcome=f"it is {outcome}", is_good=False))

        for run, told in [("fast", "stage 1 (compress) was not quasi-static, kinetic over elastic energy up to"),
                          *((self.copied(outcome, ended(outcome)), f"it is {outcome}")
                            for outcome in ("unstable", "stopped", "not_settled", "running"))]:
            with self.subTest(run):
                self.load_of(run)
                f_c = self.summary(run)["stages"][0]["results"]["f_c_MPa"]
                for command in (("check", "load.toml"), ("run", "load.toml", "-o", "no")):
                    said = self.pyroclast(*command, code=1).stderr
                    self.assertIn("load.toml:", said)
                    self.assertIn(f'stages[0].f_c.run = "{run}": {run}/summary.json: ' "the run's numbers do not count: ", said)
                    self.assertIn(told, said)
                    self.assertIn(f'f_c = "{f_c:.4g} MPa"', said)
                self.assertFalse((self.folder / "no").exists())

    def test_a_doubt_goes_with_the_strength_to_check_log_summary_and_a_run_that_goes_on(self):
        f_c = self.summary("slow")["stages"][0]["results"]["f_c_MPa"]
        for run, change, told in (
                ("risen", lambda s: s["stages"][0]["results"].update(stress_max_MPa=1.2 * f_c),
                 f"the stress rises again behind f_c {f_c:.2f} MPa, to {1.2 * f_c:.2f} MPa"),
                ("doubt", lambda s: s["stages"][0]["warnings"].append("f_c depends on it"), "f_c depends on it"),
                ("ledger", lambda s: s["warnings"].append("the energy ledger closes only within 2 %"),
                 "the energy ledger closes only within 2 %"),
                ("aim", lambda s: s.update(is_good=False), "does not count the run as good")):
            with self.subTest(run):
                self.load_of(self.copied(run, change))
                line = f"f_c.run = \"{run}\": its f_c, {f_c:.4g} MPa, is in doubt: "
                checked = self.pyroclast("check", "load.toml").stdout
                self.assertIn(line, " ".join(checked.split()))
                self.assertIn(told, " ".join(checked.split()))
                self.pyroclast("run", "load.toml", "-o", "load", "--overwrite", "--no-figures", "--quiet")
                self.assertIn(told, " ".join((self.folder / "load/run.log").read_text().split()))
                self.assertTrue(any(told in warning for warning in self.summary("load")["warnings"]))
                (self.folder / "more.toml").write_text(
                    '[[stages]]\nkind = "load"\nstress = "1 MPa"\nunbalanced_ratio = 1e-3\nramp_time = "5 ms"\n'
                    "most_steps = 5000\n")
                self.pyroclast("resume", "load", "--stages", "more.toml", "-o", "fork", "--overwrite", "--no-figures",
                               "--quiet")
                self.assertTrue(any(told in warning for warning in self.summary("fork")["warnings"]))

    def test_a_strength_without_doubt_brings_no_warning(self):
        self.load_of(self.copied("sure", sure))
        self.pyroclast("run", "load.toml", "-o", "sure_load", "--overwrite", "--no-figures", "--quiet")
        self.assertFalse(any("in doubt" in warning for warning in self.summary("sure_load")["warnings"]))

    def test_the_strength_is_that_of_the_stage_that_is_the_test(self):
        def crushed_twice(summary: dict) -> None:
            second = json.loads(json.dumps(summary["stages"][0]))
            second["results"] |= {"f_c_MPa": None, "f_c_none_because": "the stage ended before a peak"}
            summary["stages"].append(second)

        facts = self.folder / self.copied("twice", crushed_twice) / "run.json"
        for test, told in ((0, ""), (1, "twice/summary.json: the run has no f_c: the stage ended before a peak"),
                           (None, "twice/summary.json: the run has no f_c: none of its stages measures one")):
            with self.subTest(test=test):
                facts.write_text(json.dumps(json.loads(facts.read_text()) | {"test_stage": test}))
                self.load_of("twice")
                self.assertIn(told, self.pyroclast("check", "load.toml", code=1 if told else 0).stderr)
        facts.unlink()
        self.assertIn("twice/run.json", self.pyroclast("check", "load.toml", code=1).stderr)

    def test_a_history_that_figures_compare_with_and_a_frame_of_temperatures_bring_the_verdict_along(self):
        for key, text in (
                ("output.references[0].file", '[[output.references]]\nfile = "fast/history.csv"\nof = "stress"\n'
                 'columns = ["strain", "stress_MPa"]\n'),
                ("coupling.stress_free.frame", '[coupling]\nstress_free = { frame = "fast/fields/blocks_0001.hdf" }\n')):
            with self.subTest(key):
                deck = (BODY.replace('density = "2200 kg/m3"\n', 'density = "2200 kg/m3"\nexpansion = "1e-5 1/K"\n')
                        + OUTPUT + text + COMPRESS.format(velocity="2 mm/s").replace("0.006", "1e-4"))
                (self.folder / "other.toml").write_text(deck)
                said = " ".join(self.pyroclast("check", "other.toml").stdout.split())
                told = "is of a run in doubt: the run's numbers do not count: stage 1 (compress) was not quasi-static"
                self.assertRegex(said, r"other\.toml:\d+:\d+: " + key.replace("[", r"\[").replace("]", r"\]") + " = ")
                self.assertIn(told, said)
                self.pyroclast("run", "other.toml", "-o", "other", "--overwrite", "--no-figures", "--quiet")
                self.assertTrue(any(told in warning for warning in self.summary("other")["warnings"]))
                # the folder of the run knows it without the other run
                shutil.copytree(self.folder / "other", self.folder / "alone/other", dirs_exist_ok=True)
                self.pyroclast("run", "alone/other/deck.toml", "-o", "again", "--overwrite", "--no-figures", "--quiet")
                self.assertTrue(any(told in warning for warning in self.summary("again")["warnings"]))

    def test_a_history_of_a_good_run_and_a_table_of_a_laboratory_bring_nothing(self):
        self.copied("sure", sure)
        (self.folder / "measured.csv").write_text("strain,stress [MPa]\n0,0\n0.001,20\n0.002,27\n")
        for file in ("sure/history.csv", "measured.csv"):
            columns = 'columns = ["strain", "stress_MPa"]\n' if "history" in file else ""
            (self.folder / "other.toml").write_text(
                BODY + OUTPUT + f'[[output.references]]\nfile = "{file}"\nof = "stress"\n{columns}'
                + COMPRESS.format(velocity="2 mm/s"))
            self.assertNotIn("in doubt", self.pyroclast("check", "other.toml").stdout)


if __name__ == "__main__":
    unittest.main()
