"""Grains whose outlines are known: from a distance and an image to a table, a deck, and a specimen."""

import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import pyroclast
from pyroclast import grains

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


def harmonic_stone(angle):
    return 8e-3 * (1.0 + 0.15 * np.cos(2.0 * angle) + 0.05 * np.cos(3.0 * angle + 1.0))


def image_of_harmonic_stone(pixel):
    """A stone at (20, 25) mm in 40 x 60 mm, of label 3 in 0."""
    rows, columns = round(0.06 / pixel), round(0.04 / pixel)
    x = pixel * (np.arange(columns) + 0.5) - 0.02
    y = 0.06 - pixel * (np.arange(rows) + 0.5) - 0.025
    x, y = np.meshgrid(x, y)
    return np.where(np.hypot(x, y) < harmonic_stone(np.arctan2(y, x)), 3, 0)


class Outlines(unittest.TestCase):
    def test_distance(self):
        def two_circles(places):
            return np.minimum(np.hypot(*(places - [0.02, 0.03]).T) - 0.01, np.hypot(*(places - [0.02, 0.005]).T) - 0.004)

        small, large = sorted(grains.grains_of_distance(two_circles, (0, 0), (0.05, 0.06), 0.2e-3), key=lambda g: g.area)
        for grain, radius in ((small, 0.004), (large, 0.01)):
            self.assertAlmostEqual(grain.area / (np.pi * radius**2), 1.0, delta=2e-3)
            self.assertAlmostEqual(grain.perimeter / (2.0 * np.pi * radius), 1.0, delta=2e-3)

    def test_image(self):
        angle = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)
        exact = grains.Grain(harmonic_stone(angle)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))
        stone, = grains.grains_of_labels(image_of_harmonic_stone(0.3e-3), 0.3e-3)
        self.assertAlmostEqual(stone.area / exact.area, 1.0, delta=0.01)
        self.assertAlmostEqual(stone.perimeter / exact.perimeter, 1.0, delta=0.01)
        apart = np.linalg.norm(stone.outline[:, None] - (exact.outline + [0.02, 0.025]), axis=2).min(axis=1)
        self.assertLess(apart.max(), 0.3e-3)  # a pixel

    def test_holes_are_filled(self):
        annulus, = grains.grains_of_distance(
            lambda p: np.abs(np.linalg.norm(p - 0.05, axis=1) - 0.02) - 0.01, (0, 0), (0.1, 0.1), 0.5e-3)
        self.assertAlmostEqual(annulus.area / (np.pi * 0.03**2), 1.0, delta=2e-3)
        stone, = grains.grains_of_labels(image_of_annulus(0), 1e-3)
        self.assertAlmostEqual(stone.area / (np.pi * 0.03**2), 1.0, delta=0.01)

    def test_refused(self):
        for message, call in (
                ("a grain of label 1 encloses the label 2 at row 35, column 50",
                 lambda: grains.grains_of_labels(image_of_annulus(2), 1e-3)),
                ("reaches out of the box", lambda: grains.grains_of_distance(lambda p: p[:, 0] - 0.5, (0, 0), (1, 1), 0.1)),
                ("returned an array of", lambda: grains.grains_of_distance(lambda p: p, (0, 0), (1, 1), 0.1)),
                ("must be finite", lambda: grains.grains_of_distance(lambda p: p[:, 0] * np.nan, (0, 0), (1, 1), 0.1)),
                ("no grid", lambda: grains.grains_of_distance(lambda p: p[:, 0], (0, 0), (0, 1), 0.1)),
                ("there are no grains", lambda: grains.grains_of_labels(np.zeros((5, 5), int), 1e-3)),
                ("it must be positive", lambda: grains.grains_of_labels(image_of_harmonic_stone(0.3e-3), 0.0))):
            with self.subTest(message), self.assertRaisesRegex(pyroclast.Error, message):
                call()


def image_of_annulus(inside):
    """(100, 100): a ring of label 1, from 15 to 30 pixels of its middle, and a label inside it."""
    row, column = np.mgrid[:100, :100] - 50
    distance = np.hypot(row, column)
    return np.select([distance <= 15, distance < 30], [inside, 1])


class ByDeck(unittest.TestCase):
    """Decks take grains, and a run gives back what a deck takes."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def deck(self, aggregates, rule="follow"):
        text = (CASES / "starter.toml").read_text()
        begin, end = text.index("[aggregates]"), text.index("[blocks]")
        lines = [line for line in (text[:begin] + aggregates + "\n" + text[end:]).splitlines()
                 if not line.startswith("covered_fraction")]
        lines = [f'rule = "{rule}"' if line.startswith("rule = ") else line for line in lines]
        deck = self.folder / "deck.toml"
        deck.write_text("\n".join(lines) + "\n")
        return deck

    def specimen(self, deck, out="out"):
        done = subprocess.run([os.environ["PYROCLAST"], "specimen", str(deck), "--out", str(self.folder / out), "--overwrite",
                               "--no-figures"], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr, self.folder / out / "specimen"

    def test_a_stone_of_an_image_is_followed(self):
        grains.write_grains(self.folder / "grains.csv", grains.grains_of_labels(image_of_harmonic_stone(0.3e-3), 0.3e-3))
        code, told, tables = self.specimen(self.deck('[aggregates]\n[aggregates.outlines]\ncsv = "grains.csv"\n'))
        self.assertEqual(code, 0, told)
        facts = json.loads((tables / "specimen.json").read_text())
        self.assertEqual(facts["aggregates"], 1)
        self.assertAlmostEqual(facts["fraction_superposed"] / facts["fraction_placed"], 1.0, delta=0.02)
        with open(tables / "grain_fit.csv", newline="") as file:
            fit, = csv.DictReader(file)
        self.assertAlmostEqual(float(fit["interface_m"]) / float(fit["perimeter_m"]), 1.0, delta=0.05)

    def test_outlines_of_a_run_make_the_same_specimen(self):
        shaped = ('[aggregates]\nfraction = 0.3\nd_min = "6 mm"\nd_max = "20 mm"\nfuller_exponent = 0.5\n'
                  'minimum_gap = "0.5 mm"\n[aggregates.grain_shape]\nkind = "ellipse"\nelongation = [1.2, 1.6]\n')
        code, told, tables = self.specimen(self.deck(shaped))
        self.assertEqual(code, 0, told)
        first = json.loads((tables / "specimen.json").read_text())
        (self.folder / "known.csv").write_text((tables / "outlines.csv").read_text())
        code, told, tables = self.specimen(self.deck('[aggregates]\n[aggregates.outlines]\ncsv = "known.csv"\n'), "again")
        self.assertEqual(code, 0, told)
        again = json.loads((tables / "specimen.json").read_text())
        self.assertEqual(first["aggregates"], again["aggregates"])
        self.assertAlmostEqual(first["fraction_placed"], again["fraction_placed"], delta=1e-6)

    def test_a_specimen_of_finer_blocks_keeps_their_sizes_and_stones(self):
        deck = pyroclast.Deck(CASES / "starter.toml")
        deck.update(blocks={"count": 250, "finer": [{"near": "left", "size": "8 mm", "distance": "8 mm"}]})
        deck["contacts.aggregate_mortar.between_stones"] = ["aggregate"]
        deck["stages[0].most_steps"] = 60
        del deck["stages[1]"]
        graded = pyroclast.Run(deck, threads=1).finish()
        made = graded.specimen
        self.assertGreater(made.block_size.max() / made.block_size.min(), 2.0)
        given = deck.copy()
        arrays = pyroclast.Specimen.from_arrays(made.vertices, made.cells, [made.phases[i] for i in made.phase],
                                                block_size=made.block_size, stone=made.stone, unit="m")
        for specimen in (made, arrays):
            given["specimen"] = specimen
            again = pyroclast.Run(given, threads=1).finish()
            np.testing.assert_array_equal(again.history.to_pandas(), graded.history.to_pandas())
        count = len(made.cells)
        for stone in (-2, 2**31):
            with self.assertRaisesRegex(pyroclast.Error, "from 0, or -1 for none"):
                pyroclast.Specimen.from_arrays(made.vertices, made.cells, ["mortar"] * count, stone=[stone] * count, unit="m")
        given["specimen"] = pyroclast.Specimen.from_arrays(made.vertices, made.cells,
                                                           [made.phases[i] for i in made.phase], unit="m")
        with self.assertRaisesRegex(pyroclast.DeckError, "which block belongs to which stone is not known"):
            pyroclast.Run(given, threads=1)
        arrays = pyroclast.Specimen.from_arrays(made.vertices, made.cells, [made.phases[i] for i in made.phase],
                                                stone=np.arange(count), unit="m")
        given["specimen"], given["contacts.aggregate_mortar.between_stones"] = arrays, ["mortar"]
        with self.assertRaisesRegex(pyroclast.DeckError, "between_stones"):
            pyroclast.Run(given, threads=1)

    def test_outlines_of_a_run_have_its_circles_too(self):
        kind = 'fraction = {}\nd_min = "6 mm"\nd_max = "12 mm"\nfuller_exponent = 0.5\nminimum_gap = "0.5 mm"\n'
        code, told, tables = self.specimen(self.deck(
            "[aggregates]\n" + kind.format(0.2) + '[aggregates.grain_shape]\nkind = "ellipse"\nelongation = [1.2, 1.6]\n'
            '[[inclusions]]\nshape = "circle"\nphase = "aggregate"\n' + kind.format(0.1)))
        self.assertEqual(code, 0, told)
        facts = json.loads((tables / "specimen.json").read_text())
        with open(tables / "outlines.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({int(row["grain"]) for row in rows}, set(range(facts["aggregates"])))
        (self.folder / "known.csv").write_text((tables / "outlines.csv").read_text())
        code, told, tables = self.specimen(self.deck('[aggregates]\n[aggregates.outlines]\ncsv = "known.csv"\n'), "again")
        self.assertEqual(code, 0, told)
        again = json.loads((tables / "specimen.json").read_text())
        self.assertAlmostEqual(facts["fraction_placed"], again["fraction_placed"], delta=1e-6)

    def test_faults_are_told_by_their_place(self):
        (self.folder / "bad.csv").write_text("grain,x_m,y_m\n0,0.01,0.01\n0,0.02,0.01\n0,0.02,0.02\n1,0.03,0.03\n1,0.04,0.03\n")
        code, told, _ = self.specimen(self.deck('[aggregates]\n[aggregates.outlines]\ncsv = "bad.csv"\n'))
        self.assertNotEqual(code, 0)
        self.assertRegex(told, r"bad\.csv:5: an outline of a grain has 2 corners")
        shape = ('[aggregates]\nfraction = 0.3\nd_min = "6 mm"\nd_max = "20 mm"\nfuller_exponent = 0.5\nminimum_gap = "0.5 mm"\n'
                 '[aggregates.grain_shape]\nkind = "{}"\nelongation = {}\n')
        for kind, elongation, message in (("elipse", "[1, 2]", "ellipse"), ("ellipse", "[2, 1]", "least and the largest"),
                                          ("ellipse", "[0.5, 1]", "between 1 and 5"), ("polygon", "[1, 2]", "corners")):
            code, told, _ = self.specimen(self.deck(shape.format(kind, elongation)))
            self.assertNotEqual(code, 0)
            self.assertIn(message, told)


if __name__ == "__main__":
    unittest.main()
