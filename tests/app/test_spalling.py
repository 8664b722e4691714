"""Pieces leave a heated slab: whole runs by deck, what they tell, and decks that ask for the impossible."""

import csv
import json
import pathlib
import subprocess
import time
import tomllib

from in_a_folder import PROGRAM, InAFolder

ROOT = pathlib.Path(__file__).parents[2]
CASE = ROOT / "cases/spalling_slab.toml"
SMALL = tomllib.loads((ROOT / "validation/reference.toml").read_text())["small"]["spalling_slab"]


class Slab(InAFolder):
    def deck(self, *changes: tuple[str, str]) -> None:
        text = CASE.read_text()
        for was, now in changes:
            self.assertIn(was, text)
            text = text.replace(was, now)
        (self.folder / "slab.toml").write_text(text)

    def small(self, out: str) -> list[str]:
        """Returns the words that run the small form of the deck."""
        sets = [part for change in SMALL for part in ("--set", change)]
        return ["run", "slab.toml", *sets, "--out", out, "--quiet", "--no-figures", "--threads", "1"]

    def slab(self, *changes: tuple[str, str], out: str = "out") -> dict:
        """Runs the small form and returns its summary."""
        self.deck(*changes)
        self.pyroclast(*self.small(out))
        return json.loads((self.folder / out / "summary.json").read_text())

    def table(self, name: str) -> list[dict]:
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))


class PiecesLeave(Slab):
    def test_they_are_told_and_what_they_take_along_is_booked(self):
        """... and a run that is killed while they leave goes on to the same bytes."""
        heights = range(5, 100, 10)
        watched = [f'[[probes]]\nname = "at_{y}"\nx = "1 mm"\ny = "{y} mm"\n' for y in heights]
        watched += ['[[record]]\nname = "way"\nkind = "displacement"\nset = "left"\ndirection = "x"\n', "[spalling] "]
        summary = self.slab(("[spalling] ", "\n".join(watched)))
        self.assert_same_bytes_when_killed("out")
        self.assertEqual(summary["stages"][2]["outcome_id"], "completed")
        told, pieces, blocks = summary["spalling"], self.table("out/spalls.csv"), self.table("out/spalled_blocks.csv")
        history = self.table("out/history.csv")
        self.assertGreater(told["pieces"], 2)
        self.assertEqual(told["pieces"], len(pieces))
        self.assertEqual(told["blocks"], len(blocks))
        self.assertEqual(len({row["block"] for row in blocks}), len(blocks))
        self.assertEqual([int(row["piece"]) for row in pieces], list(range(1, len(pieces) + 1)))
        self.assertAlmostEqual(told["mass_kg"], sum(float(row["mass_kg"]) for row in pieces), 6)
        self.assertAlmostEqual(told["first_s"], float(pieces[0]["heating_time_s"]), 5)
        times = [float(row["heating_time_s"]) for row in pieces]
        self.assertEqual(times, sorted(times))
        for row in pieces:
            self.assertLessEqual(float(row["mean_depth_m"]), float(row["largest_depth_m"]) + 1e-12)
        last = {name: float(cell or "nan") for name, cell in history[-1].items()}
        self.assertEqual(last["spalled_pieces"], told["pieces"])
        self.assertLess(abs(last["heat_error_J"]), 1e-9 * last["heat_stored_J"])
        self.assertGreater(last["heat_removed_J"], 0.01 * last["heat_stored_J"])
        self.assertLess(abs(last["water_error_kg"]), 1e-9 * last["water_kg"])
        self.assertLess(abs(summary["energy_J"]["error_over_turnover"]), 0.01)
        self.assertTrue(history[1]["way_m"] and not history[-1]["way_m"])
        for name in ("probe_at_{}_degC", "probe_at_{}_pore_MPa"):
            columns = [name.format(y) for y in heights]
            self.assertTrue(all(history[1][column] for column in columns))
            self.assertTrue(any(not history[-1][column] for column in columns))
        self.assertNotIn("nan", (self.folder / "out/history.csv").read_text())
        self.assertIn("pieces left the body, from", (self.folder / "out/run.log").read_text())

    def test_none_leaves_where_the_pressure_acts_on_nothing(self):
        self.assertEqual(self.slab(("biot = 1.0 ", 'acts = "no" '))["spalling"]["pieces"], 0)

    def assert_same_bytes_when_killed(self, whole: str) -> None:
        """Of the deck at hand, whose whole run is there."""
        run = subprocess.Popen([PROGRAM, *self.small("killed"), "--checkpoint", "0 s"], cwd=self.folder,
                               stdout=subprocess.DEVNULL)
        spalls = self.folder / "killed/spalls.csv"
        while run.poll() is None and not (spalls.exists() and spalls.read_bytes().count(b"\n") > 3):
            time.sleep(0.01)
        self.assertIsNone(run.poll(), "the run was over before it could be killed")
        run.kill()
        run.wait()
        self.pyroclast("resume", "killed", "--quiet", "--no-figures", "--checkpoint", "1 h")
        for name in ("history.csv", "spalls.csv", "spalled_blocks.csv", "temperature_profile.csv"):
            self.assertEqual((self.folder / whole / name).read_bytes(), (self.folder / "killed" / name).read_bytes())


class Refused(Slab):
    def refusal(self, *changes: tuple[str, str]) -> str:
        self.deck(*changes)
        done = self.pyroclast("check", "slab.toml", code=None)
        self.assertNotEqual(done.returncode, 0)
        return done.stderr

    def test_a_body_of_which_no_stage_exchanges_temperatures(self):
        text = CASE.read_text()
        stages = text.index("[[stages]]                   # ... and stands in the fire")
        self.assertIn("spalling: has no meaning: no stage exchanges temperatures",
                      self.refusal((text[stages:text.index("[coupling]")], "")))

    def test_keys_out_of_range(self):
        self.assertIn("bond", self.refusal(("[spalling] ", "[spalling]\nbond = 1.5 #")))
        self.assertIn("rim_opening", self.refusal(("[spalling] ", '[spalling]\nrim_opening = "-1 mm" #')))
        self.assertIn("bars", self.refusal(('bars = ["25 mm", "35 mm"]', 'bars = ["25"]')))
