"""The programs in examples/. PYROCLAST names the program, RUN_DECK the example."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

WALL = (Path(__file__).parents[2] / "cases" / "thermal_wall.toml").read_text()


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


if __name__ == "__main__":
    unittest.main()
