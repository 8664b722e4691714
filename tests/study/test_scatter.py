"""`pyroclast run DECK --seeds N`: results with their scatter, and the specimen in the middle."""

import csv
import json
import statistics
import subprocess
import tomllib
import unittest

from study_files import CASES, PROGRAM, StudyTest

SMALL = ("--set", "blocks.count=60", "--set", "stages[1].velocity=4 mm/s", "--set", "stages[1].stop_strain=0.003")


class Seeds(StudyTest):
    def run_deck(self, *words, deck: str = "starter", code: int = 0) -> subprocess.CompletedProcess:
        done = subprocess.run([PROGRAM, "run", CASES / f"{deck}.toml", *words], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_means_intervals_and_the_median_specimen(self):
        done = self.run_deck("--seeds", "3", "--seed", "4", *SMALL)
        out = self.folder / "runs/starter-seeds"
        with open(out / "table.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["seed"] for row in rows], ["4", "5", "6"])
        with open(out / "scatter.csv", newline="", encoding="utf-8") as file:
            scatter = {row["result"]: row for row in csv.DictReader(file)}
        self.assertIn("E_GPa", scatter)
        self.assertNotIn("steps", scatter)
        moduli = [float(row["E_GPa"]) for row in rows]
        found = scatter["E_GPa"]
        self.assertAlmostEqual(float(found["mean"]), statistics.mean(moduli), places=12)
        half = 4.302652729911275 * statistics.stdev(moduli) / 3**0.5  # Student's t of two degrees of freedom
        self.assertAlmostEqual(float(found["high_95"]), statistics.mean(moduli) + half, places=9)
        self.assertRegex(done.stdout, r"E_GPa +\d+\.?\d* ± \d")
        self.assertTrue((out / "figures/seeds.png").exists())

        strengths = sorted((float(row["f_c_MPa"]), int(row["seed"])) for row in rows if row["f_c_MPa"])
        median = strengths[(len(strengths) - 1) // 2]
        self.assertIn(f"seed {median[1]}, by f_c_MPa", done.stdout)
        stages = json.loads((out / "median/summary.json").read_text())["stages"]
        self.assertAlmostEqual(stages[-1]["results"]["f_c_MPa"], median[0], places=9)
        self.assertTrue((out / "median/figures/fracture.png").exists())
        deck = tomllib.loads((out / "median/deck.toml").read_text())
        self.assertEqual((deck["blocks"]["count"], deck["specimen"]["seed"]), (60, median[1]))

        # a second time nothing is run again, and one more specimen is added
        before = {file: file.stat().st_mtime_ns for file in out.glob("runs/*/summary.json")}
        self.run_deck("--seeds", "4", "--seed", "4", "--no-figures", *SMALL)
        after = {file: file.stat().st_mtime_ns for file in out.glob("runs/*/summary.json")}
        self.assertEqual(len(after), 4)
        self.assertEqual({file: after[file] for file in before}, before)

    def test_a_deck_in_error_is_told_as_by_a_single_run(self):
        for words in (("--set", "blocks.cuont=60"), ("--set", "blocks.count=-1")):
            done = self.run_deck("--seeds", "2", *words, code=1)
            self.assertIn(words[1].split("=")[0], done.stderr)
        self.assertIn("--watch", self.run_deck("--seeds", "2", "--watch", code=1).stderr)


if __name__ == "__main__":
    unittest.main()
