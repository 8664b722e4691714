"""A fire of an hour and a half: what check foretells, what a broken run says, depths over time, a deck in one command."""

import csv
import json
import pathlib
import re
import shlex
import shutil
import tomllib
import unittest

import h5py
from in_a_folder import InAFolder

CASES = pathlib.Path(__file__).parents[2] / "cases"
SLAB = pathlib.Path(__file__).parents[1] / "hot_slab.toml"
STACK = pathlib.Path(__file__).parents[1] / "parted_stack.toml"
CONCRETE = ("--f_c", "38 MPa", "--E", "32 GPa", "--fraction", "0.4", "--d_max", "20 mm", "--blocks", "100",
            "--width", "60 mm", "--height", "120 mm")


class InTheFire(InAFolder):
    def table(self, name: str) -> list[dict]:
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return [{key: float(cell or "nan") for key, cell in row.items()} for row in csv.DictReader(file)]


class Foretold(InTheFire):
    """Heat alone tells beforehand that the curves end too early; what is said names the cure."""

    def wall(self, *changes: tuple[str, str]) -> tuple[str, ...]:
        text = (CASES / "fire_one_side.toml").read_text()
        for was, now in (("count = 2000", "count = 200"), ('duration = "30 min"', 'duration = "90 min"'),
                         ('exchange_increment = "5 K"', 'exchange_increment = "40 K"'), *changes):
            self.assertIn(was, text)
            text = text.replace(was, now)
        (self.folder / "wall.toml").write_text(text)
        return ("wall.toml", "--quiet", "--no-figures")

    def test_check_tells_when_the_range_is_left_and_which_curves_reach_farther(self):
        self.wall()
        seen = self.pyroclast("check", "wall.toml").stdout
        self.assertRegex(seen, r"leaves heat.temperature_range, 20 to 800 degC, at 3\d of 90 min, and the run would be")
        self.assertIn("materials.mortar.E ends at 800 degC (en1992_apparent_modulus reaches as far)", seen)
        self.assertIn("en1992_siliceous_expansion", seen)

    def test_other_fires_are_told_at_their_own_minute(self):
        for fire, minute in (("en1991_hydrocarbon", r"\d(\.\d)?"), ("rws", r"\d(\.\d)?"), ("astm_e119", r"[34]\d")):
            with self.subTest(fire):
                self.wall(('builtin = "iso834"', f'builtin = "{fire}"'))
                self.assertRegex(self.pyroclast("check", "wall.toml").stdout, rf"800 degC, at {minute} of 90 min")

    def test_a_range_that_holds_is_no_warning_and_the_hottest_place_is_told(self):
        self.wall(('duration = "90 min"', 'duration = "30 min"'))
        seen = self.pyroclast("check", "wall.toml").stdout
        self.assertRegex(seen, r"by heat alone the hottest place comes to 7\d\d degC after 30 min")
        self.assertNotIn("leaves", seen)

    def test_a_run_that_is_broken_off_gives_no_advice_that_does_not_help(self):
        deck = self.wall(("20 degC\", \"800 degC", "20 degC\", \"300 degC"))
        said = self.pyroclast("run", *deck, "-o", "out", code=1).stderr
        self.assertIn("leaves the run's range of 20 to 300 degC", said)
        watched = self.pyroclast("watch", "out", "--once").stdout
        for text in (said, " ".join(watched.split())):
            self.assertNotIn("pyroclast resume", text)
            self.assertIn("change the deck", text)

    def test_a_deck_without_a_range_is_refused_with_the_curves_that_reach_farther(self):
        self.wall(('temperature_range = ["20 degC", "800 degC"]', "#"))
        said = self.pyroclast("check", "wall.toml", code=1).stderr
        for line in said.splitlines():
            self.assertIn('heat.temperature_range = ["20 degC", "800 degC"]', line)
        self.assertIn("materials.mortar.E: is given from 20 to 800 degC, but the run needs it from 20 to 1005.99 degC; "
                      "curves are not extrapolated: en1992_apparent_modulus reaches as far", said)
        self.assertIn("en1992_siliceous_expansion, en1992_calcareous_expansion reach as far", said)

    def test_blocks_that_scatter_critical_temperatures_are_told_with_the_number_that_does_not(self):
        words = ("concrete", *CONCRETE[:CONCRETE.index("--blocks")], "--aggregate", "granite", "--fire", "iso834",
                 "--minutes", "1")
        self.pyroclast(*words, "-o", "mine.toml")
        self.assertNotIn("blocks.count", self.pyroclast("check", "mine-fire.toml").stdout)
        count = tomllib.loads((self.folder / "mine.toml").read_text())["blocks"]["count"]
        told = self.pyroclast("check", "mine-fire.toml", "--set", f"blocks.count={count // 2}").stdout
        finer = re.search(r"scatter by 100 K and more from seed to seed; (\d+) blocks are as fine as that", told)[1]
        self.assertLess(int(finer), count)
        told = self.pyroclast("check", "mine-fire.toml", "--set", f"blocks.count={finer}").stdout
        self.assertNotIn("scatter by 100 K", told)

    def test_no_failure_carries_its_conditions(self):
        deck = self.wall(('duration = "90 min"', 'duration = "2 min"'))
        self.pyroclast("run", *deck, "-o", "out")
        log = (self.folder / "out/run.log").read_text()
        self.assertIn("no failure of this one specimen of plain concrete in plane stress: no steel, no spalling, no member",
                      log)
        results = json.loads((self.folder / "out/summary.json").read_text())["stages"][-1]["results"]
        self.assertIn("plain concrete in plane stress", results["answer_is"])


class Depths(InTheFire):
    """Depths over time come from rows, and the isotherm begins when its temperature is reached."""

    def wall(self, minutes: int, *changes: str, is_solid: bool = False) -> None:
        text = (CASES / "thermal_wall.toml").read_text().split("[[probes]]")[0]
        text += "[output]\nframe_interval = '5 min'\n"
        if is_solid:
            text = re.sub('thickness = "1 m".*', 'depth = "40 mm"', text)
        (self.folder / "wall.toml").write_text(text)
        words = [word for change in ("blocks.count=200", f"stages[0].duration={minutes} min",
                                     f"output.frame_interval={minutes} min", *changes) for word in ("--set", change)]
        self.pyroclast("run", "wall.toml", "--quiet", "--no-figures", "-o", "out", *words)
        self.history, self.isotherm = self.table("out/history.csv"), self.table("out/isotherm.csv")

    def assert_begins_with_the_face(self):
        hot = [row["temperature_max_degC"] >= 500.0 for row in self.history].index(True)
        before, after = (self.history[i]["heating_time_s"] for i in (hot - 1, hot))
        first = self.isotherm[0]
        self.assertLessEqual(before, first["heating_time_s"] + 60.0)
        self.assertGreaterEqual(first["heating_time_s"], before)
        self.assertEqual(first["depth_500_degC_m"], 0.0)
        self.assertLess(self.isotherm[1]["depth_500_degC_m"], 1.5e-3)

    def test_isotherm_is_written_without_figures_and_begins_when_the_face_is_there(self):
        self.wall(30)
        self.assert_begins_with_the_face()
        self.assertEqual(json.loads((self.folder / "out/summary.json").read_text())["heated_face"], "left")
        times = {row["heating_time_s"] for row in self.table("out/temperature_profile.csv")}
        self.assertGreater(len(times), 20)  # of rows, not of the two frames

    def test_the_face_is_the_one_in_the_fire(self):
        self.wall(30, "heat.boundaries[0].faces=right", "heat.boundaries[1].faces=right", "heat.boundaries[2].faces=left")
        self.assert_begins_with_the_face()
        self.assertEqual(json.loads((self.folder / "out/summary.json").read_text())["heated_face"], "right")

    def test_no_row_where_the_temperature_is_not_reached(self):
        self.wall(6)
        self.assertEqual(self.isotherm, [])

    def test_a_run_without_fields_has_depths_too(self):
        self.wall(30, "output.fields=false")
        self.assert_begins_with_the_face()

    def test_a_solid_has_depths_too(self):
        self.wall(30, "output.fields=false", is_solid=True)
        self.assert_begins_with_the_face()

    def test_depths_in_a_solid_count_from_any_side_and_are_those_of_the_plane(self):
        """Heat flows one way, whatever the side: a body of six blocks over the depth differs from the plane by their
        size alone, up to 0.6 mm where 500 degC is 20 mm deep, and 6 of 95 degC at the far side.
        """
        plane = SLAB.read_text().replace('depth = "60 mm"', 'thickness = "1 m"')
        (self.folder / "plane.toml").write_text(plane)
        depths, far = {}, {}
        for face in ("left", "right", "bottom", "top", "front", "back", "plane"):
            deck = ["plane.toml"] if face == "plane" else [SLAB, "--set", f"heat.boundaries[0].faces={face}"]
            self.pyroclast("run", *deck, "--quiet", "--no-figures", "-o", face)
            self.assertEqual(json.loads((self.folder / face / "summary.json").read_text())["heated_face"],
                             face if face != "plane" else "left")
            last = self.table(f"{face}/temperature_profile.csv")[-121:]
            self.assertEqual({row["heating_time_s"] for row in last}, {600.0})
            self.assertEqual((last[0]["depth_m"], last[-1]["depth_m"]), (0.0, 0.06))
            self.assertAlmostEqual(last[0]["temperature_degC"], 1000.0, delta=1e-6)
            depths[face] = self.table(f"{face}/isotherm.csv")[-1]["depth_500_degC_m"]
            far[face] = last[-1]["temperature_degC"]
        self.assertAlmostEqual(depths["plane"], 0.0198, delta=2e-4)  # by the closed form 19.76 mm
        for face, depth in depths.items():
            self.assertAlmostEqual(depth, depths["plane"], delta=6e-4, msg=face)
            self.assertAlmostEqual(far[face], far["plane"], delta=6.0, msg=face)


class Gaps(InTheFire):
    """Cracks of a solid, by deck: what the motion opens and what is stated, in the heat of a whole run."""

    LENGTH, SIDE, BRICKS = 0.08, 0.04, 4  # m
    HOT, COLD, CONDUCTIVITY, GAS, JUMP, EMISSIVITY, STATED = 700.0, 100.0, 1.6, 0.04, 2e-7, 0.9, 2e-4

    def stack(self) -> dict:
        """Bricks on each other, as a file of polyhedra."""
        section = [(0.0, 0.0), (self.SIDE, 0.0), (self.SIDE, self.SIDE), (0.0, self.SIDE)]
        levels = range(self.BRICKS + 1)
        faces = [[4 * level + k for k in range(4)] for level in levels]
        cells = []
        for brick in levels[:-1]:
            below, above = faces[brick], faces[brick + 1]
            cells.append([brick, brick + 1, *range(len(faces), len(faces) + 4)])
            faces += [[below[k], below[(k + 1) % 4], above[(k + 1) % 4], above[k]] for k in range(4)]
        return {"phases": ["mortar"], "faces": faces, "cells": cells, "phase": [0] * self.BRICKS,
                "vertices_m": [[x, self.LENGTH * level / self.BRICKS, z] for level in levels for x, z in section],
                "body": {"axis": "y", "length_m": self.LENGTH, "section_m": section,
                         "sides": ["back", "right", "front", "left"]}}

    def behind(self, face: float, flux: float, width: float) -> float:
        """Temperature behind a gap into which a flux goes from a face, degC: gas and radiation, by bisection."""
        kelvin, sigma = 273.15, 5.670374419e-8
        low, high = -kelvin, face
        for _ in range(100):
            middle = 0.5 * (low + high)
            passed = (self.GAS / (width + self.JUMP) * (face - middle)
                      + sigma / (2.0 / self.EMISSIVITY - 1.0) * ((face + kelvin)**4 - (middle + kelvin)**4))
            low, high = (middle, high) if passed > flux else (low, middle)
        return 0.5 * (low + high)

    def far_side(self, flux: float, widths: list[float]) -> float:
        """Temperature of the cold end, degC, of bricks and gaps in series."""
        drop = flux * self.LENGTH / self.BRICKS / self.CONDUCTIVITY
        at = self.HOT - drop
        for width in widths:
            at = self.behind(at, flux, width) - drop
        return at

    def test_bricks_and_gaps_that_the_motion_opens_add_their_resistances(self):
        (self.folder / "stack.json").write_text(json.dumps(self.stack()))
        shutil.copy(STACK, self.folder)
        self.pyroclast("run", STACK.name, "--quiet", "--no-figures", "-o", "out")
        stages = json.loads((self.folder / "out/summary.json").read_text())["stages"]
        self.assertEqual(stages[1]["outcome_id"], "steady")
        with h5py.File(sorted((self.folder / "out/fields").glob("contacts_*.hdf"))[-1]) as frame:
            of_point = {name: frame[f"VTKHDF/CellData/{key}"][:4 * (self.BRICKS - 1)].reshape(-1, 4) for name, key in (
                ("opening", "opening [m]"), ("conductance", "heat_conductance [W m-2 K-1]"),
                ("drop", "temperature_jump [K]"), ("damage", "tension_damage [1]"))}
        # one joint has parted, by less than what its end was moved, evenly
        for joint in (*of_point["conductance"], *of_point["drop"]):
            self.assertLessEqual(joint.max() - joint.min(), 1e-6 * abs(joint).max())
        self.assertEqual([joint[0] == 1.0 for joint in of_point["damage"]].count(True), 1)
        openings = [max(0.0, joint.mean()) for joint in of_point["opening"]]
        self.assertTrue(9e-4 < max(openings) < 1e-3 and sorted(openings)[1] < 1e-8, openings)
        # the flux for which bricks and gaps in series lead from the hot to the cold end
        low, high = 0.0, (self.HOT - self.COLD) * self.CONDUCTIVITY / self.LENGTH
        widths = [self.STATED + opening for opening in openings]
        for _ in range(100):
            flux = 0.5 * (low + high)
            low, high = (flux, high) if self.far_side(flux, widths) > self.COLD else (low, flux)
        for joint, (h, drop) in enumerate(zip(of_point["conductance"], of_point["drop"])):
            # fields have single precision
            self.assertAlmostEqual(h.mean() * abs(drop.mean()) / flux, 1.0, delta=1e-6, msg=str(joint))


class OneCommand(InTheFire):
    def test_a_deck_of_ninety_minutes_stays_within_its_curves(self):
        for rock, fire, faces in (("quartzite", "iso834", "left,right"), ("limestone", "hydrocarbon", "left"),
                                  ("basalt", "rws", "right")):
            with self.subTest(fire):
                self.pyroclast("concrete", *CONCRETE, "--aggregate", rock, "--fire", fire, "--minutes", "90", "--faces",
                               faces, "--level", "0.25", "-o", f"{rock}.toml")
                deck = tomllib.loads((self.folder / f"{rock}-fire.toml").read_text())
                self.assertEqual([stage["kind"] for stage in deck["stages"]], ["settle", "load", "expose"])
                self.assertEqual(deck["stages"][1]["level"], 0.25)
                self.assertEqual({b["faces"] for b in deck["heat"]["boundaries"] if b["kind"] == "radiation"},
                                 set(faces.split(",")))
                seen = self.pyroclast("check", f"{rock}-fire.toml").stdout
                self.assertIn("after 90 min" if fire != "rws" else "leaves heat.temperature_range, 20 to 1200 degC", seen)

    def test_a_deck_runs_to_its_end_from_a_furnace_record(self):
        (self.folder / "records").mkdir()
        (self.folder / "records/furnace.csv").write_text("time [s],mean [degC],TC3 [degC]\n0,20,20\n600,700,650\n")
        fire = ("--fire", "records/furnace.csv", "--columns", "time", "TC3", "--minutes", "10")
        said = self.pyroclast("concrete", *CONCRETE, "--aggregate", "granite", *fire, "-o", "mine.toml").stdout
        program, *again = shlex.split(said.splitlines()[-1])  # what is to follow the calibration
        best = self.folder / again[again.index("--from") + 1]
        self.assertEqual((program, best), ("pyroclast", self.folder / "runs/mine-calibrate/best.toml"))
        best.parent.mkdir(parents=True)
        shutil.copy(self.folder / "mine.toml", best)
        self.pyroclast(*again)
        self.assertEqual(tomllib.loads((self.folder / "mine-calibrated-fire.toml").read_text())["blocks"]["count"], 100)
        self.pyroclast("run", "mine-calibrated-fire.toml", "--quiet", "--no-figures", "-o", "out", "--set",
                       "coupling.exchange_increment=40 K")

    def test_what_cannot_be_is_refused_and_nothing_is_written(self):
        (self.folder / "short.csv").write_text("time [s],T [degC]\n0,20\n600,700\n")
        for words, told in ((("--fire", "iso"), "--minutes is needed"),
                            (("--fire", "iso", "--minutes", "90"), "is neither a fire (iso834,"),
                            (("--fire", "iso834", "--minutes", "400"), "must be a number from 1 to 360"),
                            (("--fire", "iso834", "--minutes", "90", "--faces", "top"), "--faces \"top\""),
                            (("--fire", "iso834", "--minutes", "90", "--level", "1.2"), "--level \"1.2\""),
                            (("--fire", "iso834", "--minutes", "90", "--hot", "400 degC"), "--fire and --hot"),
                            (("--fire", "short.csv", "--minutes", "90"), "is given from 0 to 600 s")):
            with self.subTest(told):
                self.assertIn(told, self.pyroclast("concrete", *CONCRETE, "--aggregate", "granite", *words, "-o",
                                                   "mine.toml", code=1).stderr)
                self.assertEqual([file.name for file in self.folder.iterdir()], ["short.csv"])


if __name__ == "__main__":
    unittest.main()
