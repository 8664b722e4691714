"""The programs in examples/. PYROCLAST names the program, RUN_DECK and OWN_STAGE the examples."""

import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).parents[2]
WALL = (ROOT / "cases" / "thermal_wall.toml").read_text()


class RunDeck(unittest.TestCase):
    def test_gives_what_the_program_gives(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            text = WALL.replace("count = 2000", "count = 100").replace('duration = "2 h"', 'duration = "10 min"')
            (folder / "deck.toml").write_text(text)
            example = subprocess.run([os.environ["RUN_DECK"], "deck.toml", "mine"], cwd=folder, capture_output=True,
                                     text=True, timeout=100, check=True)
            subprocess.run([os.environ["PYROCLAST"], "run", "deck.toml", "--out", "its", "--no-figures"], cwd=folder,
                           capture_output=True, timeout=100, check=True)
            self.assertIn("completed", example.stdout)
            names = {path.relative_to(folder / "its") for path in (folder / "its").rglob("*.*")
                     if path.name != "run.log"}  # the example is silent
            self.assertEqual({path.relative_to(folder / "mine") for path in (folder / "mine").rglob("*.*")}, names)
            for path in ("history.csv", "fields/frames.csv", "specimen/specimen.json", "deck.toml"):
                self.assertEqual((folder / "mine" / path).read_bytes(), (folder / "its" / path).read_bytes())

    def test_an_error_is_told(self):
        done = subprocess.run([os.environ["RUN_DECK"], "nowhere.toml", "out"], capture_output=True, text=True,
                              timeout=100, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("nowhere.toml", done.stderr)


class OwnStage(unittest.TestCase):
    def test_runs_behind_the_stages_of_a_deck(self):
        """Each turn of the platen leaves a row, whose strain goes up and down; the summary has the stage's result."""
        with tempfile.TemporaryDirectory() as name:
            out = Path(name) / "out"
            done = subprocess.run([os.environ["OWN_STAGE"], ROOT / "cases" / "starter.toml",
                                   ROOT / "examples" / "own_stage" / "shake.toml", out, "blocks.count=120",
                                   "stages[1].stop_strain=2e-4"], capture_output=True, text=True, timeout=100, check=True)
            self.assertIn("4 turns of the platen", done.stdout)
            with open(out / "history.csv", newline="") as file:
                rows = [row for row in csv.DictReader(file) if row["stage"] == "2"]
            self.assertEqual([float(row["turn"]) for row in rows], [1, 2, 3, 4])
            strain = [float(row["strain"]) for row in rows]
            self.assertGreater(min(strain[0], strain[2]), max(strain[1], strain[3]))
            results = json.loads((out / "summary.json").read_text())["stages"][2]["results"]
            self.assertEqual(results["largest_stress_MPa"], max(float(row["stress_MPa"]) for row in rows))


if __name__ == "__main__":
    unittest.main()
