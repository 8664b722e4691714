"""Stones whose outlines are known: from a distance and an image to a table, a deck, and a specimen."""

import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import pyroclast
from pyroclast import m, mm
from pyroclast import stones

MM = ("0 mm", "0 mm", "100 mm", "100 mm")  # corners of a box
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

        small, large = sorted(stones.stones_of_distance(two_circles, MM[:2], ("50 mm", "60 mm"), "0.2 mm"), key=lambda g: g.area)
        for stone, radius in ((small, 0.004), (large, 0.01)):
            self.assertAlmostEqual(stone.area / (np.pi * radius**2), 1.0, delta=2e-3)
            self.assertAlmostEqual(stone.perimeter / (2.0 * np.pi * radius), 1.0, delta=2e-3)

    def test_image(self):
        angle = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)
        exact = stones.FlatStone(harmonic_stone(angle)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))
        stone, = stones.stones_of_labels(image_of_harmonic_stone(0.3e-3), "0.3 mm")
        self.assertAlmostEqual(stone.area / exact.area, 1.0, delta=0.01)
        self.assertAlmostEqual(stone.perimeter / exact.perimeter, 1.0, delta=0.01)
        apart = np.linalg.norm(stone.outline[:, None] - (exact.outline + [0.02, 0.025]), axis=2).min(axis=1)
        self.assertLess(apart.max(), 0.3e-3)  # a pixel

    def test_holes_are_filled(self):
        annulus, = stones.stones_of_distance(
            lambda p: np.abs(np.linalg.norm(p - 0.05, axis=1) - 0.02) - 0.01, MM[:2], MM[2:], "0.5 mm")
        self.assertAlmostEqual(annulus.area / (np.pi * 0.03**2), 1.0, delta=2e-3)
        stone, = stones.stones_of_labels(image_of_annulus(0), "1 mm")
        self.assertAlmostEqual(stone.area / (np.pi * 0.03**2), 1.0, delta=0.01)

    def test_refused(self):
        for message, call in (
                ("a stone of label 1 encloses the label 2 at row 35, column 50",
                 lambda: stones.stones_of_labels(image_of_annulus(2), "1 mm")),
                ("reaches out of the box", lambda: in_box(lambda p: p[:, 0] - 0.05)),
                ("returned an array of", lambda: in_box(lambda p: p)),
                ("must be finite", lambda: in_box(lambda p: p[:, 0] * np.nan)),
                ("no grid", lambda: stones.stones_of_distance(lambda p: p[:, 0], MM[:2], ("0 mm", "9 mm"), "1 mm")),
                ("all pixels are of the matrix", lambda: stones.stones_of_labels(np.zeros((5, 5), int), "1 mm")),
                ("greater than 0", lambda: stones.stones_of_labels(image_of_harmonic_stone(0.3e-3), "0 mm"))):
            with self.subTest(message), self.assertRaisesRegex(pyroclast.Error, message):
                call()

    def test_a_mask_is_no_distance_and_a_distance_is_negative_in_stones(self):
        def inside(places):
            return 0.02 - np.linalg.norm(places - 0.05, axis=1)

        self.assertEqual(len(in_box(lambda p: -inside(p))), 1)
        for told, distance in (("reaches out of the box.*positive within stones.*its negative", inside),
                               ("False and True alone, as a mask has.*distance_transform_edt", lambda p: inside(p) > 0.0),
                               ("0.0 and 1.0 alone", lambda p: (inside(p) > 0.0).astype(float)),
                               ("-1.0 and 1.0 alone", lambda p: np.where(inside(p) > 0.0, -1.0, 1.0)),
                               ("negative nowhere", lambda p: np.clip(100.0 * inside(p), 0.0, 1.0)),
                               ("negative nowhere", lambda p: np.abs(inside(p)) + 1e-6),
                               ("ndarray, not a function of places.*stones_of_labels", np.zeros((9, 9), bool))):
            with self.subTest(told), self.assertRaisesRegex(pyroclast.Error, told):
                in_box(distance)

    def test_lengths_have_units(self):
        image = image_of_harmonic_stone(0.3e-3)
        areas = [stones.stones_of_labels(image, pixel)[0].area for pixel in ("0.3 mm", 0.3 * mm, "300 um", 3e-4 * m)]
        self.assertAlmostEqual(max(areas) / min(areas), 1.0)

        def circle(places):
            return np.linalg.norm(places - 0.05, axis=1) - 0.01

        same = [stones.stones_of_distance(circle, *box)[0].area for box in (
            (MM[:2], MM[2:], "1 mm"), (np.zeros(2) * mm, [0.1 * m, "10 cm"], 1 * mm), ([0 * mm, "0 m"], MM[2:], 0.001 * m))]
        self.assertAlmostEqual(max(same) / min(same), 1.0)
        for told, call in (('pixel: a unit of length is needed.*got 1.0; .*"1.0 m"', lambda: stones.stones_of_labels(image, 1.0)),
                           ("pixel: .*dimension|pixel: .*length", lambda: stones.stones_of_labels(image, "1 s")),
                           (r"low\[0\]: a unit", lambda: stones.stones_of_distance(circle, (0, 0), MM[2:], "1 mm")),
                           (r"high\[1\]: a unit", lambda: stones.stones_of_distance(circle, MM[:2], ("1 m", 1), "1 mm")),
                           ("spacing: a unit", lambda: stones.stones_of_distance(circle, MM[:2], MM[2:], 1e-3))):
            with self.subTest(told), self.assertRaisesRegex(pyroclast.Error, told):
                call()


class Labels(unittest.TestCase):
    """Stones of an image that are not one smooth part within it."""

    def areas(self, image, **more):
        """Areas of the stones in pixels, whose sum is the number of pixels of stones."""
        found = stones.stones_of_labels(image, "1 mm", **more)
        areas = np.array([1e6 * stone.area for stone in found])
        self.assertAlmostEqual(areas.sum() / np.count_nonzero(image), 1.0, delta=1e-5)
        return found, areas

    def test_a_neck_of_one_pixel_parts_stones_and_one_of_two_does_not(self):
        image = discs((40, 30, 20), (40, 90, 20))
        image[40, 30:90] = 1
        found, areas = self.areas(image)
        np.testing.assert_allclose(areas, 1245, rtol=0.01)
        np.testing.assert_allclose(sorted(1e3 * middle_of(stone)[0] for stone in found), [30.5, 90.5], atol=0.5)
        image[41, 30:90] = 1
        whole, = self.areas(image)[0]
        self.assertAlmostEqual(np.ptp(whole.outline[:, 0]), 0.099, delta=2e-3)

    def test_whatever_smoothing_cuts_the_areas_stay(self):
        chain = discs((20, 20, 9), (20, 60, 9), (60, 60, 12), (60, 100, 5))
        chain[20, 20:60] = chain[20:60, 60] = chain[60, 60:100] = 1
        self.assertEqual(len(self.areas(chain)[0]), 4)
        hairy = discs((40, 60, 15))
        hairy[40, 10:60] = hairy[5:40, 60] = 1
        stone, = self.areas(hairy)[0]
        self.assertLess(np.ptp(stone.outline[:, 0]), 0.04)  # a hair is no part of the outline
        unequal = discs((40, 30, 20), (40, 60, 4))
        unequal[40, 30:60] = 1
        self.assertGreater(min(self.areas(unequal)[1]), 45.0)

    def test_a_mouth_of_one_pixel_closes_and_may_hold_no_other_stone(self):
        image = discs((40, 60, 30)) - discs((40, 60, 20))
        image[40, 75:] = 0
        stone, = stones.stones_of_labels(image, "1 mm")
        self.assertAlmostEqual(stone.area / (1e-6 * discs((40, 60, 30)).sum()), 1.0, delta=0.01)
        image[35:45, 55:65] = 2
        with self.assertRaisesRegex(pyroclast.Error, "a stone of label 1 encloses the label 2 at row 35, column 55"):
            stones.stones_of_labels(image, "1 mm")

    def test_parts_that_are_too_small_are_told(self):
        image = discs((40, 60, 15))
        image[5, 7] = image[70, 10] = image[70, 11] = 1
        with self.assertWarnsRegex(UserWarning, "2 parts are too small.*row 5, column 7: 3 pixels together"):
            self.assertEqual(len(stones.stones_of_labels(image, "1 mm")), 1)

    def test_a_stone_that_the_edge_cuts_ends_there(self):
        for name, image, low, high in (
                ("left", discs((40, 0, 20)), (0, 20), (20, 59)), ("corner", discs((0, 0, 20)), (0, 60), (20, 80)),
                ("edge", band(columns=15), (0, 0), (15, 80)), ("right", band(columns=15)[:, ::-1], (105, 0), (120, 80)),
                ("both", discs((40, 60, 45)), (16, 0), (105, 80)), ("bottom", discs((79, 60, 9)), (52, 0), (69, 9))):
            with self.subTest(name):
                stone, = self.areas(image)[0]
                np.testing.assert_allclose(1e3 * stone.outline.min(axis=0), low, atol=0.5)
                np.testing.assert_allclose(1e3 * stone.outline.max(axis=0), high, atol=0.5)
                self.assertGreaterEqual(stone.outline.min(), 0.0)
                self.assertTrue(np.all(stone.outline <= [0.12, 0.08]))

    def test_what_fills_the_image_is_the_matrix(self):
        for image in (np.ones((9, 9), int), 1 - discs((40, 60, 20))):
            with self.assertRaisesRegex(pyroclast.Error, "as a matrix does; if it is the matrix, say matrix=1"):
                stones.stones_of_labels(image, "1 mm")
        self.assertEqual(len(stones.stones_of_labels(1 - discs((40, 60, 20)), "1 mm", matrix=1)), 1)

    def test_labels_are_whole_numbers(self):
        image = discs((40, 60, 20))
        for pixels, told in ((0.5 * image, "is 0.5, but labels must be whole numbers"),
                             (image / 255.0, "must be whole numbers.*1245 of 9600"),
                             (np.where(image, "stone", "mortar"), "the labels are texts, such as 'mortar'")):
            with self.subTest(told), self.assertRaisesRegex(pyroclast.Error, told):
                stones.stones_of_labels(pixels, "1 mm")
        self.assertEqual(len(stones.stones_of_labels(image.astype(bool), "1 mm")), 1)

    def test_stones_of_a_watershed_share_their_lines_and_a_phase(self):
        image = watershed()
        found, areas = self.areas(image, phases={...: 0})
        np.testing.assert_allclose(areas, np.bincount(image.ravel())[1:], rtol=0.01)
        self.assertEqual({stone.phase for stone in found}, {0})
        self.assertEqual([stone.phase for stone in stones.stones_of_labels(image, "1 mm", phases={(1, 2): 1, range(3, 5): 0})],
                         [1, 1, 0, 0])
        self.assertEqual([stone.phase for stone in stones.stones_of_labels(image, "1 mm", phases={3: None, ...: 2})], [2, 2, 2])
        self.assertEqual([stone.phase for stone in stones.stones_of_labels(image, "1 mm")], [0, 1, 2, 3])
        for phases, told in (({1: 0}, "the label 2, for which there is no phase"), ({...: "stone"}, "the phase 'stone'; it must"),
                             ({1: -1, ...: 0}, "the phase -1"), ({range(1, 3): 0, ...: 0, 2: 1}, "names the label 2 twice")):
            with self.subTest(told), self.assertRaisesRegex(pyroclast.Error, told):
                stones.stones_of_labels(image, "1 mm", phases=phases)


def in_box(distance):
    return stones.stones_of_distance(distance, MM[:2], MM[2:], "1 mm")


def middle_of(stone):
    return 0.5 * (stone.outline.min(axis=0) + stone.outline.max(axis=0))


def discs(*places):
    """(80, 120): discs of label 1, each of a row, a column and a radius."""
    row, column = np.mgrid[:80, :120]
    return np.any([np.hypot(row - a, column - b) < radius for a, b, radius in places], axis=0).astype(int)


def band(columns):
    image = np.zeros((80, 120), int)
    image[:, :columns] = 1
    return image


def watershed():
    """(80, 120): four stones, 1 to 4, that touch, and meet in the middle."""
    row, column = np.mgrid[-40:40, -60:60] + 0.5
    return np.where(np.hypot(row, column) < 30.0, 1 + 2 * (row > 0.0) + (column > 0.0), 0).astype(int)


def image_of_annulus(inside):
    """(100, 100): a ring of label 1, from 15 to 30 pixels of its middle, and a label inside it."""
    row, column = np.mgrid[:100, :100] - 50
    distance = np.hypot(row, column)
    return np.select([distance <= 15, distance < 30], [inside, 1])


class ByDeck(unittest.TestCase):
    """Decks take stones, and a run gives back what a deck takes."""

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
        stones.write_stones(self.folder / "grains.csv", stones.stones_of_labels(image_of_harmonic_stone(0.3e-3), "0.3 mm"))
        code, told, tables = self.specimen(self.deck('[aggregates]\n[aggregates.outlines]\ncsv = "grains.csv"\n'))
        self.assertEqual(code, 0, told)
        facts = json.loads((tables / "specimen.json").read_text())
        self.assertEqual(facts["aggregates"], 1)
        self.assertAlmostEqual(facts["fraction_superposed"] / facts["fraction_placed"], 1.0, delta=0.02)
        with open(tables / "grain_fit.csv", newline="") as file:
            fit, = csv.DictReader(file)
        self.assertAlmostEqual(float(fit["interface_m"]) / float(fit["perimeter_m"]), 1.0, delta=0.05)

    def test_stones_that_the_edge_cuts_or_that_touch_are_followed(self):
        cut = np.zeros((60, 30), int)  # as the specimen of the deck: 5 mm a pixel
        for number, (row, column) in enumerate(((30, 0), (0, 29), (59, 15)), 1):
            cut[np.hypot(*(np.mgrid[:60, :30] - np.array([row, column])[:, None, None])) < 9.0] = number
        touching = np.zeros((60, 30), int)
        touching[20:40, 5:25] = np.where(np.arange(20) < 10, 1, 2)
        for name, image in (("cut", cut), ("touching", touching)):
            with self.subTest(name):
                stones.write_stones(self.folder / "grains.csv", stones.stones_of_labels(image, "5 mm", phases={...: 0}))
                code, told, tables = self.specimen(self.deck('[aggregates]\n[aggregates.outlines]\ncsv = "grains.csv"\n'), name)
                self.assertEqual(code, 0, told)
                with open(tables / "grain_fit.csv", newline="") as file:
                    fits = list(csv.DictReader(file))
                self.assertEqual(len(fits), image.max())
                for fit in fits:
                    self.assertAlmostEqual(float(fit["area_of_blocks_m2"]) / float(fit["area_m2"]), 1.0, delta=0.02)

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
        self.assertRegex(told, r"bad\.csv:5: an outline of a stone has 2 corners")
        shape = ('[aggregates]\nfraction = 0.3\nd_min = "6 mm"\nd_max = "20 mm"\nfuller_exponent = 0.5\nminimum_gap = "0.5 mm"\n'
                 '[aggregates.grain_shape]\nkind = "{}"\nelongation = {}\n')
        for kind, elongation, message in (("elipse", "[1, 2]", "ellipse"), ("ellipse", "[2, 1]", "least and the largest"),
                                          ("ellipse", "[0.5, 1]", "between 1 and 5"), ("polygon", "[1, 2]", "corners")):
            code, told, _ = self.specimen(self.deck(shape.format(kind, elongation)))
            self.assertNotEqual(code, 0)
            self.assertIn(message, told)


if __name__ == "__main__":
    unittest.main()
