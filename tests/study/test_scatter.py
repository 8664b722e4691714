"""`pyroclast run DECK --seeds N`: results with their scatter, and the specimen in the middle."""

import csv
import json
import re
import statistics
import subprocess
import tomllib
import unittest
from unittest import mock

import numpy as np
import pyroclast
from pyroclast.draw.comparisons import compare_seeds
from pyroclast.errors import Error
from pyroclast.report import write_page
from pyroclast.study import converge, scatter
from pyroclast.study.methods import ensemble
from pyroclast.study.report import write_report
from pyroclast.study.study import Study
from scipy.stats import t, ttest_ind
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
        self.assertIn("mean of 3 seeds ± half its 95 % interval (Student's t)", done.stdout)
        for line in re.findall(r"(?m)^ {16}\w+ +([\d.]+) ±", done.stdout):
            self.assertLessEqual(len(line.replace(".", "").lstrip("0")), 4, line)
        self.assertTrue((out / "figures/seeds.png").exists())

        strengths = sorted((float(row["f_c_MPa"]), int(row["seed"])) for row in rows if row["f_c_MPa"])
        median = strengths[(len(strengths) - 1) // 2]
        self.assertIn(f"seed {median[1]}, by f_c_MPa", done.stdout)
        stages = json.loads((out / "median/summary.json").read_text())["stages"]
        self.assertAlmostEqual(stages[-1]["results"]["f_c_MPa"], median[0], places=9)
        self.assertTrue((out / "median/figures/fracture.png").exists())
        deck = tomllib.loads((out / "median/deck.toml").read_text())
        self.assertEqual((deck["blocks"]["count"], deck["specimen"]["seed"]), (60, median[1]))

        # the band again, for a journal
        drawn = subprocess.run([PROGRAM, "figures", "run", out, "--format", "pdf", "--width", "140mm", "--out", out / "140"],
                               capture_output=True, text=True, check=True)
        self.assertEqual(drawn.stdout, f"{out / '140' / 'seeds.pdf'}\n")
        self.assertIn("/MediaBox [ 0 0 396", (out / "140/seeds.pdf").read_bytes().decode("latin-1"))

        # a second time nothing is run again, and one more specimen is added
        before = {file: file.stat().st_mtime_ns for file in out.glob("runs/*/summary.json")}
        self.run_deck("--seeds", "4", "--seed", "4", "--no-figures", *SMALL)
        after = {file: file.stat().st_mtime_ns for file in out.glob("runs/*/summary.json")}
        self.assertEqual(len(after), 4)
        self.assertEqual({file: after[file] for file in before}, before)

    def test_a_dry_run_tells_the_time_of_all_seeds_and_leaves_nothing(self):
        before = sorted(self.folder.rglob("*"))
        said = self.run_deck("--seeds", "3", "--dry-run", *SMALL).stdout
        self.assertRegex(said, r"runs +3, 0 of them done: 3 left")
        self.assertRegex(said, r"time +\d+ \w+ a run, \d+ \w+ of one core in all")
        self.run_deck("--seeds", "3", "--dry-run", "--out", "kept/seeds", *SMALL)
        self.assertRegex(self.run_deck("--dry-run", *SMALL).stdout, r"run +2 stages, about .* steps; about \d+ \w+")
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_runs_of_heat_alone_have_no_curves_of_stress(self):
        wall = mock.Mock(moves=False, folder="runs/wall")
        with self.assertRaisesRegex(Error, "runs/wall is a run of heat alone, .* `pyroclast report RUN"):
            compare_seeds([wall, wall])

    def test_a_specimen_that_lacks_one_result_has_a_value(self):
        done = self.run_deck("--seeds", "2", "--no-figures", *SMALL, "--set", "stages[1].stop_strain=0.0006")
        with open(self.folder / "runs/starter-seeds/table.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(row["state"], row["f_c_MPa"]) for row in rows], [("no value", "")] * 2)
        self.assertIn("none            f_c_MPa: the stage ended before a peak", done.stdout)
        self.assertTrue(all(row["E_GPa"] for row in rows))
        self.assertRegex(done.stdout, "(?m)^2 of 2 runs$")
        self.assertNotIn("without a value", done.stdout)
        self.assertRegex(done.stdout, "(?m)^warning         2 of 2 runs: no f_c: the stage ended before a peak")

    def test_warnings_that_differ_by_numbers_alone_are_told_once(self):
        for run, texts in {"a": ["3 of 9 exchanges did not come to rest (worst 1.2e-03); see it", "no peak: at 2 MPa"],
                           "b": ["14 of 80 exchanges did not come to rest (worst 7.1e-04); see it"]}.items():
            (self.folder / "runs" / run).mkdir(parents=True)
            (self.folder / "runs" / run / "summary.json").write_text(json.dumps({"warnings": texts}))
        study = mock.Mock(setup=mock.Mock(folder=self.folder),
                          rows=lambda: [{"run": "a"}, {"run": "b"}, {"run": "not_kept"}])
        self.assertEqual(sorted(Study.warnings(study)), [
            "1 of 2 runs: no peak: at 2 MPa", "2 of 2 runs: 3 of 9 exchanges did not come to rest (worst 1.2e-03); see it"])

    def test_a_result_that_nobody_asked_for_fails_no_run(self):
        done = self.run_deck("--seeds", "2", "--no-figures", *SMALL, "--set", "stages[1].stop_fraction_of_peak=0.96", "--set",
                             "contacts.aggregate_mortar.between_stones=[]")
        out = self.folder / "runs/starter-seeds"
        with open(out / "table.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        name = "f_c_by_fall_of_10_percent_MPa"
        lacking = [row for row in rows if not row[name]]
        self.assertEqual([row["state"] for row in rows], ["done"] * 2)
        self.assertTrue(lacking)
        self.assertIn(f"{len(lacking)} of 2 seeds have none" if len(lacking) < 2 else f"none            {name}: the", done.stdout)
        page = write_report(Study(out / "study.toml", program=PROGRAM)).read_text()
        self.assertNotIn("gave no value; see below", page)
        self.assertRegex(page, rf"{name} is missing in {len(lacking)} runs? of 2: the stress never fell by 10 % from above a third")

        index = write_page([out]).read_text()
        self.assertEqual(re.findall(r'data-name="(seed \d)', index), ["seed 1", "seed 2"])

    def test_the_median_stands_among_its_seeds(self):
        for run, deck, seed in (("runs/aaaabbbbcccc", "/there/mine.toml", 2), ("runs/bbbbccccdddd", "/there/mine.toml", 1),
                                ("median", "mine.toml", 2), ("other", "mine.toml", 7)):
            (self.folder / run).mkdir(parents=True)
            (self.folder / run / "history.csv").write_text("stage,step,time_s\n")
            (self.folder / run / "manifest.json").write_text(json.dumps({"deck": deck, "seed": seed}))
        found = re.findall(r'data-name="([^"]*)"', write_page([self.folder]).read_text())
        self.assertEqual(found, ["seed 1, bbbbcccc", "seed 2, aaaabbbb (median)", "other"])
        with self.assertRaisesRegex(Error, "holds no run, but folders of runs: median and 3 more; .* `pyroclast report "):
            pyroclast.read(self.folder)

    def test_few_seeds_that_scatter_say_how_many_would_do(self):
        three = ensemble.summary([3.0, 42.0, 78.0])
        line = scatter._lines({"f_c_MPa": three}, 3)[1]
        wanted = int(re.search(r"f_c_MPa  41 ± 93 .*; ± 10 % takes about (\d+) seeds$", line)[1])
        for n, is_enough in ((wanted, True), (wanted - 1, False)):
            half = t.ppf(0.975, n - 1) * statistics.stdev([3.0, 42.0, 78.0]) / n**0.5
            self.assertEqual(half <= 0.1 * 41.0, is_enough, n)
        self.assertNotIn("takes", scatter._lines({"E_GPa": ensemble.summary([30.0, 30.2, 30.1])}, 3)[1])
        self.assertEqual(ensemble.seeds_for(0.1, 0.05), 4)
        self.assertIsNone(ensemble.seeds_for(0.1, float("nan")))

    def test_a_deck_in_error_is_told_as_by_a_single_run(self):
        for words in (("--set", "blocks.cuont=60"), ("--set", "blocks.count=-1")):
            done = self.run_deck("--seeds", "2", *words, code=1)
            self.assertIn(words[1].split("=")[0], done.stderr)
        self.assertIn("--watch", self.run_deck("--seeds", "2", "--watch", code=1).stderr)


class Converge(StudyTest):
    def test_variants_halve_rates_increments_and_blocks_of_what_the_deck_has(self):
        deck = tomllib.loads((CASES / "hot_strength.toml").read_text())
        found = {v.name: v for v in converge.variants_of(deck)}
        self.assertEqual(list(found), ["half the rate", "half the exchange step", "half the block size",
                                       "double the block size"])
        self.assertEqual(found["half the rate"].changes,
                         ('stages[4].velocity="0.1 mm/s"', 'stages[4].fastest_velocity="4.0 mm/s"'))
        self.assertEqual(found["half the exchange step"].changes, ('coupling.exchange_increment="2.0 K"',))
        self.assertEqual(found["half the block size"].changes, ("blocks.count=8000", 'mechanics.time_step="5.0 us"'))
        self.assertFalse(found["half the block size"].same_specimens)
        beam = {v.name: v for v in converge.variants_of(tomllib.loads((CASES / "notched_beam.toml").read_text()))}
        self.assertEqual([c.split("=")[0] for c in beam["half the rate"].changes],
                         ["stages[2].control.rate", "stages[2].duration"])
        self.assertNotIn("half the exchange step", beam)

    def test_half_the_size_is_eight_times_the_blocks_of_a_solid(self):
        solid = tomllib.loads((CASES / "starter_3d.toml").read_text())
        found = {v.name: v.changes for v in converge.variants_of(solid)}
        self.assertEqual(found["half the block size"][0], f"blocks.count={8 * solid['blocks']['count']}")
        del solid["specimen"]["shape"]
        solid["specimen"]["depth"] = "0.1 m"
        self.assertEqual({v.name: v.changes for v in converge.variants_of(solid)}, found)
        solid["blocks"] = {"size": "8 mm"}
        found = {v.name: v.changes for v in converge.variants_of(solid)}
        self.assertEqual(found["double the block size"][0], 'blocks.size="16.0 mm"')

    def test_effects_are_those_of_students_intervals(self):
        before, after = np.array([10.0, 11.0, 12.0]), np.array([10.1, 11.3, 12.2])
        paired = converge.effect("f_c", converge.Variant("a", ()), before, after)
        self.assertAlmostEqual(paired.share, 0.2 / 11.0)
        self.assertAlmostEqual(paired.half, 4.302652729911275 * 0.1 / 3**0.5 / 11.0)
        self.assertFalse(paired.is_told)
        other = converge.effect("f_c", converge.Variant("a", (), False), before, after + 5.0)
        self.assertAlmostEqual(other.share, 5.2 / 11.0)
        told = ttest_ind(after + 5.0, before, equal_var=False)
        self.assertAlmostEqual(other.half * 11.0, t.ppf(0.975, told.df if hasattr(told, "df") else 3.99) * 5.2 / told.statistic,
                               delta=0.02)
        self.assertTrue(other.is_told)
        none = converge.effect("f_c", converge.Variant("a", ()), before, np.array([np.nan, np.nan, 12.2]))
        self.assertEqual((none.seeds, none.is_told), (1, False))

    def test_a_deck_by_its_command(self):
        words = [PROGRAM, "converge", CASES / "starter.toml", "--seeds", "2", *SMALL]
        ahead = subprocess.run([*words, "--dry-run"], cwd=self.folder, capture_output=True, text=True, check=True).stdout
        self.assertEqual(len(ahead.splitlines()), 3 if "double" not in ahead else 4)
        self.assertFalse((self.folder / "runs").exists())
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, check=True).stdout
        self.assertRegex(done, r"half the rate +[+-]\d")
        with open(self.folder / "runs/starter-converge/converge.csv", newline="", encoding="utf-8") as file:
            rows = {(row["result"], row["variant"]): row for row in csv.DictReader(file)}
        rate = rows["E_GPa", "half the rate"]
        self.assertLess(abs(float(rate["change"])), 0.05)
        self.assertIn(("E_GPa", "half the block size"), rows)


if __name__ == "__main__":
    unittest.main()
