"""Measured tables as a user brings them: names of columns, units in headers, records of loggers. PYROCLAST names the
program."""

import json
import pathlib
import re
import subprocess
import unittest

from in_a_folder import InAFolder

AGGREGATE = """
[materials.aggregate]
density = "2600 kg/m3"
conductivity = "3 W/(m K)"
specific_heat = "800 J/(kg K)"
"""
MORTAR = """
[materials.mortar]
density = "2200 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "900 J/(kg K)"
"""
STONES = """
title = "Known stones"
[specimen]
width = "120 mm"
height = "80 mm"
thickness = "100 mm"
seed = 1
[aggregates]
{aggregates}
[blocks]
count = 300
shortest_edge = 0.3
[superposition]
rule = "fit"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "left"
kind = "temperature"
temperature = "120 degC"
[[stages]]
kind = "conduct"
duration = "1 min"
interval = "30 s"
[output]
frame_interval = "1 h"
""" + AGGREGATE + MORTAR
RECORD = """
title = "Record"
[specimen]
shape = "cells"
file = "one.json"
[heat]
field = "conduction"
{initial}
[[heat.boundaries]]
faces = "outline"
{boundary}
[[stages]]
kind = "conduct"
duration = "20 min"
interval = "5 min"
[output]
frame_interval = "1 h"
""" + MORTAR
CELL = {"phases": ["mortar"], "vertices_m": [[0, 0], [0.1, 0], [0.1, 0.2], [0, 0.2]], "cells": [[0, 1, 2, 3]],
        "phase": [0]}
FACE = 'kind = "temperature"\ntemperature = {}'
GAS = 'kind = "convection"\ncoefficient = "25 W/(m2 K)"\ngas_temperature = {}'


class Tables(InAFolder):
    def pyroclast(self, *words, code: int | None = None, **options) -> subprocess.CompletedProcess:
        return super().pyroclast(*words, code=code, **options)

    def check(self, deck: str, **files: str) -> subprocess.CompletedProcess:
        for name, text in (files | {"deck.toml": deck}).items():
            (self.folder / name.replace("_csv", ".csv")).write_text(text)
        return self.pyroclast("check", "deck.toml")

    def record(self, text: str, boundary: str = FACE, initial: str = "") -> subprocess.CompletedProcess:
        (self.folder / "one.json").write_text(json.dumps(CELL))
        deck = RECORD.format(boundary=boundary.format('{ csv = "record.csv" }'), initial=initial)
        return self.check(deck, record_csv=text)

    def refused(self, done: subprocess.CompletedProcess, *parts: str) -> None:
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)


class NamesOfColumns(Tables):
    def share(self, stones: str, keys: str = "") -> float:
        """The share of circles that the specimen asks for."""
        (self.folder / "packing.csv").write_text(stones)
        deck = STONES.format(aggregates=f'stones = {{ csv = "packing.csv"{keys} }}')
        (self.folder / "deck.toml").write_text(deck)
        done = self.pyroclast("specimen", "deck.toml", "--out", "out", "--no-figures", "--overwrite")
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.folder / "out/specimen/specimen.json").read_text())["fraction_asked"]

    def test_radii_are_half_of_diameters_in_any_order_of_the_columns(self):
        share = 3.141592653589793 / 4 * (20**2 + 30**2) / (120 * 80)
        for stones, keys in (
                ("x [mm],y [mm],radius [mm]\n30,40,10\n90,40,15\n", ""),
                ("x [mm],y [mm],radius [mm]\n30,40,10\n90,40,15\n", ', columns = ["x", "y", "radius"]'),
                ("x_mm,y_mm,R_mm\n30,40,10\n90,40,15\n", ""),
                ("y [mm],x [mm],d [mm]\n40,30,20\n40,90,30\n", ""),
                ("id,x,y,r\n17,30,40,10\n23,90,40,15\n", ', units = ["mm", "mm", "mm"]')):
            with self.subTest(stones):
                self.assertAlmostEqual(self.share(stones, keys), share, places=6)

    def test_an_order_that_cannot_be_is_refused_and_the_right_columns_are_proposed(self):
        stones = 'stones = { csv = "a.csv" }'
        for keys, table, parts in (
                (stones, "x [mm],y [mm],z [mm]\n30,40,20\n", ("a.csv:1: column \"z\" is the z by its name",)),
                (stones, "id,x,y,d\n7,30,40,20\n9,90,40,30\n", ('columns = ["x", "y", "d"], units = ["m", "m", "m"]',)),
                ('outlines = { csv = "a.csv" }', "grain,radius [mm],y [mm]\n0,1,2\n0,2,2\n0,2,3\n",
                 ("column \"radius\" is the radius by its name, but stands in the place of the x",)),
                ('fraction = 0.3\nminimum_gap = "0.5 mm"\npassing = { csv = "a.csv" }\npassing_by = "area"',
                 "Sieve,Opening [mm],Passing [%]\n5,4,10\n7,16,100\n", ('columns = ["Opening", "Passing"]',)),
                ('fraction = 0.3\nminimum_gap = "0.5 mm"\npassing = { csv = "a.csv" }\npassing_by = "area"',
                 "Opening [mm],retained [%]\n4,0\n16,100\n", ("write the shares that pass",))):
            with self.subTest(table):
                self.refused(self.check(STONES.format(aggregates=keys), a_csv=table), "aggregates.", *parts)

    def test_outlines_are_read_by_name(self):
        square = ((30, 20), (50, 20), (50, 50), (30, 50))
        for head, order in (("grain,x_mm,y_mm", (0, 1, 2)), ("x [mm],y [mm],id", (1, 2, 0)),
                            ("y [mm],x [mm],particle no", (2, 1, 0))):
            rows = "".join(",".join(str((7, *point)[i]) for i in order) + "\n" for point in square)
            with self.subTest(head):
                done = self.check(STONES.format(aggregates='outlines = { csv = "a.csv" }'), a_csv=f"{head}\n{rows}")
                self.assertEqual(done.returncode, 0, done.stderr)


class RecordsOfLoggers(Tables):
    def test_what_a_record_looks_like_is_told_with_a_remedy_that_keeps_it(self):
        midnight = "t [s];T [degC]\n86000;20\n86300;120\n200;220\n500;320\n900;420\n"
        twice = "t [s];T [degC]\n0;20\n60;30\n1300;40\n0;20\n60;30\n1300;40\n"
        for text, parts, never in (
                (midnight, ("from line 3 to line 4", "the clock passes midnight", "since the start"), "sort"),
                (twice, ("from line 4 to line 5", "the record begins again there"), "sort"),
                ('t [s],T [degC]\n0,20\n600,220\n"1,200",420\n', ('record.csv:4: "1,200" may be 1.200',), "sed"),
                ("t [s],T [degC]\n1700000000,20\n1700001300,420\n", ("it counts from a date",), "sort"),
                ("t [min],T [degC]\n600,20\n630,420\n",
                 ("is given from 36000 to 37800 s (table file record.csv)", 'write start = "first row" beside csv'), "sort"),
                ("time,T [degC]\n10:14:05,20\n10:14:15,420\n",
                 ("is given from 0 to 10 s (table file record.csv, times since 10:14:05)",), "start ="),
                ("t [s],Temperature rise [degC]\n0,0\n1300,420\n", ("add the temperature at the start",), "sort")):
            with self.subTest(text):
                done = self.record(text)
                self.refused(done, "heat.boundaries[0].temperature", *parts)
                self.assertNotIn(never, done.stderr)

    def test_times_of_a_calendar_and_of_a_clock_count_from_the_first_row_or_a_stated_start(self):
        for first, last, start in (("2026-03-02T10:14:05", "2026-03-02T10:44:05", ""),
                                   ("2026-03-02 23:50:00+01:00", "2026-03-03 00:20:00+01:00", ""),
                                   ("02.03.2026 23:50:00", "03.03.2026 00:20:00", ""),
                                   ("10:14:05", "10:44:05", ""), ("23:50:00", "00:20:00", ""),
                                   ("10:14:05", "10:44:05", ', start = "10:14:15"'),
                                   ("2026-03-02T10:14:05", "2026-03-02T10:44:05", ', start = "2026-03-02T10:14:05"')):
            with self.subTest(first, start=start):
                boundary = FACE.format('{{ csv = "record.csv"' + start + " }}")
                done = self.record(f"Zeit;Ofen 1 [°C]\n{first};20\n{last};420\n", boundary)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn("20 to 289 degC" if "10:14:15" in start else "20 to 287 degC", done.stdout)

    def test_thousands_and_powers_of_fortran_are_read(self):
        for text in ("t [s];T [degC]\n0;20\n1 200;420\n", "t [s];T [degC]\n0;20\n1\u202f200;420\n",
                     "t [s],T [degC]\n0,20\n1'200,420\n", "t [s] T [degC]\n0.0D+00 2.0D+01\n1.2D+03 4.2D+02\n"):
            with self.subTest(text):
                done = self.record(text)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn("20 to 420 degC", done.stdout)

    def test_a_rise_in_K_is_warned_of_wherever_it_is_a_temperature(self):
        rise = "time [min],T [K]\n0,0\n10,400\n20,700\n"
        for done, key in ((self.record(rise), "temperature"), (self.record(rise, GAS), "gas_temperature"),
                          (self.record("t [s],T [degC]\n0,20\n1300,30\n", initial='initial = "20 K"'), "initial"),
                          (self.record("t [s],T [degC]\n0,-90\n1300,30\n"), "temperature")):
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, rf"{key}.*: is -\d.* degC, but usually it is between -60 and 1400 degC")
        usual = self.record("time [min],T [K]\n0,293.15\n10,400\n20,700\n")
        self.assertNotIn("usually", usual.stdout + usual.stderr)


class UnitsOfReferences(Tables):
    def setUp(self):
        super().setUp()
        starter = pathlib.Path(__file__).parents[2] / "cases" / "starter.toml"
        small = re.sub(r"^count = \d+", "count = 100", starter.read_text(), flags=re.MULTILINE)
        self.deck = small + '\n[[output.references]]\nfile = "press.csv"\nof = "stress"\n'

    def test_strains_are_in_the_unit_of_their_header(self):
        """A strain of 0.2 is warned of, so that the warning shows what was read."""
        for header, value in (("Strain (‰)", 200), ("ε [per mille]", 200), ("Strain (microstrain)", 2e5),
                              ("eps (\u03bcε)", 2e5), ("Strain [wt%]", 20), ("Strain (-)", 0.2), ("Strain ‰", 200)):
            for table in (f"{header};Stress (N/mm²)\n0;0\n{value};1.44\n",
                          f"id;Stress (N/mm²);{header}\n7;0;0\n9;1.44;{value}\n"):
                with self.subTest(table):
                    done = self.check(self.deck, press_csv=table)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertIn("the strain reaches 0.2 (no unit)", done.stdout + done.stderr)

    def test_units_of_the_deck_are_read_alike(self):
        for unit, value in (("‰", 200), ("[-]", 0.2), ("µε", 2e5)):
            with self.subTest(unit):
                done = self.check(self.deck + f'units = ["{unit}", ""]\n',
                                  press_csv=f"strain,stress_MPa\n0,0\n{value},1.44\n")
                self.assertIn("the strain reaches 0.2 (no unit)", done.stdout + done.stderr)

    def test_empty_cells_below_a_shorter_curve_are_its_end(self):
        table = "eps,sigma,eps,sigma\n‰,MPa,‰,MPa\n0,0,0,0\n0.5,1,0.2,1\n,,200,2\n"
        for columns, parts in (("[1, 2]", ()), ("[3, 4]", ("the strain reaches 0.2",))):
            done = self.check(self.deck + f"columns = {columns}\n", press_csv=table)
            self.assertEqual(done.returncode, 0, done.stderr)
            for part in parts:
                self.assertIn(part, done.stdout + done.stderr)

    def test_an_unknown_unit_in_round_brackets_is_refused(self):
        for unit in ("‰x", "mstrain", "kN/m2x", "per thousand"):
            with self.subTest(unit):
                done = self.check(self.deck, press_csv=f"Strain ({unit}),Stress (N/mm²)\n0,0\n0.08,1.44\n")
                self.refused(done, "output.references[0].file", f'unit "{unit}"')
        for remark in ("measured", "mean of 3", "LVDT 1"):
            done = self.check(self.deck, press_csv=f"Strain ({remark}),Stress (N/mm²)\n0,0\n0.08,1.44\n")
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_column_of_another_quantity_is_no_end_of_a_range(self):
        done = self.check(self.deck, press_csv="strain,stress_MPa,load [kN]\n0,0,0\n1e-3,20,90\n")
        self.refused(done, "has 3 columns, of which 2 are needed", 'columns = ["strain", "stress_MPa"]')
        done = self.check(self.deck, press_csv="strain,stress_MPa,stress_MPa\n0,0,1\n1e-3,20,19\n")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.check(self.deck, press_csv="strain,force\n0,0\n1e-3,20\n")
        self.refused(done, 'column "force" is the force by its name, but stands in the place of the stress')

    def test_times_of_a_clock_are_read_in_a_reference_too(self):
        (self.folder / "one.json").write_text(json.dumps(CELL))
        deck = RECORD.format(boundary=FACE.format('"400 degC"'), initial="")
        deck += '\n[[output.references]]\nfile = "a.csv"\nof = "temperature"\n'
        midnight = "time,T [degC]\n23:50:00,20\n00:00:00,120\n00:10:00,200\n"
        for start, parts in (("", ("times of a.csv count from its first row, 23:50:00", 'start = "0:00:00"')),
                             ('start = "first row"\n', ()), ('start = "23:55:00"\n', ())):
            done = self.check(deck + start, a_csv=midnight)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual("count from its first row" in done.stdout + done.stderr, bool(parts))
            for part in parts:
                self.assertIn(part, done.stdout + done.stderr)
        self.refused(self.check(deck + 'start = "1:00:00"\n', a_csv=midnight), "output.references[0].file",
                     'start = "1:00:00" comes after the last time, "00:10:00"')
        done = self.check(deck, a_csv="T [degC],time\n20,00:00:00\n120,00:10:00\n200,00:20:00\n")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("first row", done.stdout + done.stderr)

    def test_a_start_without_times_has_no_meaning(self):
        done = self.check(self.deck + 'start = "first row"\n', press_csv="strain,stress_MPa\n0,0\n1e-3,20\n")
        self.refused(done, "output.references[0].start", 'has no meaning: "strain" is no time')


if __name__ == "__main__":
    unittest.main()
