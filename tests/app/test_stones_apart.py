"""Stones of any form do not overlap and keep off holes, notches and slits; empty cells of a file are told."""

import csv
import json
import re
import subprocess
import unittest

import numpy as np
from in_a_folder import InAFolder

HEAD = """title = "Stones"
[specimen]
width = "120 mm"
height = "{height} mm"
thickness = "100 mm"
"""
AGGREGATE = """[materials.aggregate]
density = "2600 kg/m3"
conductivity = "3 W/(m K)"
specific_heat = "800 J/(kg K)"
"""
TAIL = """[materials.mortar]
density = "2000 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "1000 J/(kg K)"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "left"
kind = "temperature"
temperature = "120 degC"
[[stages]]
kind = "conduct"
duration = "5 s"
interval = "5 s"
[output]
frame_interval = "1 h"
"""
BLOCKS = '[blocks]\ncount = 600\nshortest_edge = 0.3\n[superposition]\nrule = "follow"\n'
HOLES = [(x, y) for x in (30, 60, 90) for y in (30, 60, 90)]
RADIUS = 4.0  # mm, of each hole
PIERCED = "".join(f'[[specimen.holes]]\ncentre = ["{x} mm", "{y} mm"]\ndiameter = "{2 * RADIUS} mm"\n'
                  for x, y in HOLES)
NOTCH = '[[specimen.notches]]\nmouth = ["60 mm", "0 mm"]\ntip = ["60 mm", "40 mm"]\nwidth = "{}"\n'


def circle(radius=20.0, middle=(50.0, 40.0), count=40):
    """(count, 2) points around a circle, mm."""
    angle = 2.0 * np.pi * np.arange(count) / count
    return middle + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def box(left, low, right, high):
    """(4, 2) corners of a rectangle, mm."""
    return np.array([[left, low], [right, low], [right, high], [left, high]], float)


def sides(outline):
    return np.stack([outline, np.roll(outline, -1, axis=0)], axis=1)


def cross(a, b):
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def run_through_each_other(one, other):
    """Whether sides of two outlines cross."""
    (a, b), (c, d) = sides(one).swapaxes(0, 1)[:, :, None], sides(other).swapaxes(0, 1)[:, None]
    parted = (cross(b - a, c - a) * cross(b - a, d - a) < 0.0, cross(d - c, a - c) * cross(d - c, b - c) < 0.0)
    return bool(np.any(parted[0] & parted[1]))


def distance_from(point, outline):
    """Distance of a point from the sides of an outline."""
    begin, end = sides(outline).swapaxes(0, 1)
    along = end - begin
    share = np.clip(((point - begin) * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(begin + share[:, None] * along - point, axis=1).min())


def holds(outline, point):
    begin, end = sides(outline).swapaxes(0, 1)
    is_between = (begin[:, 1] > point[1]) != (end[:, 1] > point[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        at = begin[:, 0] + (point[1] - begin[:, 1]) / (end[:, 1] - begin[:, 1]) * (end[:, 0] - begin[:, 0])
    return bool(np.count_nonzero(is_between & (point[0] < at)) % 2)


class ProgramTest(InAFolder):
    def pyroclast(self, *words, code: int | None = None, **options) -> subprocess.CompletedProcess:
        return super().pyroclast(*words, code=code, **options)


class Stones(ProgramTest):
    def draw(self, shape, fraction=0.3, sizes=(6, 10), body="", seed=1):
        """What the program says of a specimen of drawn stones."""
        (self.folder / "deck.toml").write_text(
            f'{HEAD.format(height=120)}seed = {seed}\n{body}[aggregates]\nfraction = {fraction}\n'
            f'd_min = "{sizes[0]} mm"\nd_max = "{sizes[1]} mm"\nfuller_exponent = 0.5\nminimum_gap = "0.2 mm"\n'
            f'[aggregates.grain_shape]\n{shape}\n'
            f"{BLOCKS}{AGGREGATE}{TAIL}")
        return self.pyroclast("specimen", "deck.toml", "--out", "out", "--overwrite", "--no-figures")

    def drawn(self, *mix, **options):
        """Outlines of the stones of a specimen, each (n, 2), mm."""
        done = self.draw(*mix, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        stones = {}
        with open(self.folder / "out/specimen/outlines.csv", newline="") as file:
            for row in csv.DictReader(file):
                stones.setdefault(row["grain"], []).append([1e3 * float(row["x_m"]), 1e3 * float(row["y_m"])])
        return [np.array(stone) for stone in stones.values()]

    def check_given(self, outlines, body="", height=80):
        """The program's word on outlines that are given, mm."""
        rows = ["grain,x_m,y_m"] + [f"{number},{x * 1e-3:.10g},{y * 1e-3:.10g}"
                                    for number, outline in outlines for x, y in outline]
        (self.folder / "grains.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "deck.toml").write_text(f'{HEAD.format(height=height)}seed = 1\n{body}[aggregates]\n'
                                               f'outlines = {{ csv = "grains.csv" }}\n{BLOCKS}{AGGREGATE}{TAIL}')
        return self.pyroclast("check", "deck.toml")

    def assert_refused(self, outlines, *parts, **options):
        done = self.check_given(outlines, **options)
        self.assertNotEqual(done.returncode, 0, done.stdout)
        for part in parts:
            self.assertIn(part, done.stderr)

    def test_no_two_polygons_cross(self):
        for corners, elongation, fraction in (
                ("[4, 4]", "[3, 4]", 0.3), ("[3, 3]", "[1, 1.5]", 0.3), ("[4, 4]", "[1, 1.5]", 0.45),
                ("[3, 4]", "[2, 2.5]", 0.3), ("[5, 8]", "[3, 4]", 0.3)):
            with self.subTest(corners=corners, elongation=elongation):
                stones = self.drawn(f'kind = "polygon"\ncorners = {corners}\nelongation = {elongation}', fraction)
                self.assertGreater(len(stones), 15)
                for i, stone in enumerate(stones):
                    for other in stones[:i]:
                        if np.linalg.norm(stone[0] - other[0]) > 80.0:  # more than both are long
                            continue
                        self.assertFalse(run_through_each_other(stone, other))
                        apart = min(distance_from(point, line) for points, line in ((stone, other), (other, stone))
                                    for point in points)
                        self.assertGreater(apart, 0.2 - 1e-6)  # nine digits of a file in m

    def test_no_stone_lies_over_a_hole(self):
        polygon = 'kind = "polygon"\ncorners = [4, 4]\nelongation = [1, 1.5]'
        for shape, seed in ((polygon, 1), (polygon, 3), (polygon, 5),
                            ('kind = "harmonics"\nelongation = [1, 1.5]\nroughness = [0.02, 0.06]', 2)):
            with self.subTest(shape, seed=seed):
                stones = self.drawn(shape, 0.4, (8, 26), PIERCED, seed)
                for stone in stones:
                    for hole in HOLES:
                        self.assertFalse(holds(stone, hole))
                        # 12 sides at least stand for a circle of the same area: within 2.4 % of the radius
                        self.assertGreater(distance_from(hole, stone), RADIUS * 0.97 + 0.2)

    def test_a_mix_that_only_fits_over_holes_is_refused_at_its_place(self):
        done = self.draw('kind = "ellipse"\nelongation = [1, 1.5]', 0.4, (16, 30), PIERCED)
        self.assertNotEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"deck\.toml:\d+: aggregates: the aggregates do not fit: .* found no place")

    def test_no_stone_lies_over_a_notch_or_a_slit(self):
        for width in ("3 mm", "0 mm"):
            for stone in self.drawn('kind = "ellipse"\nelongation = [1, 2]', 0.35, (8, 30), NOTCH.format(width)):
                self.assertFalse(run_through_each_other(stone, np.array([[60.0, -1.0], [60.0, 40.0]])))

    def test_an_outline_that_is_given_twice_is_refused_at_its_line(self):
        once = circle()
        again = {"the same": once, "begun at its 8th corner": np.roll(once, -7, axis=0), "turned round": once[::-1],
                 "1 nm away": once + [1e-6, 0.0], "begun elsewhere and turned": np.roll(once, 5, axis=0)[::-1],
                 "a little smaller": circle(20.0 - 1e-6)}
        for name, outline in again.items():
            with self.subTest(name):
                self.assert_refused([(0, once), (1, outline)], "grains.csv:42: ", "lies on another")
        horseshoe = np.array([[30, 10], [90, 10], [90, 70], [80, 70], [80, 20], [40, 20], [40, 70], [30, 70]], float)
        self.assert_refused([(0, horseshoe), (1, horseshoe)], "grains.csv:10: ", "lies on another")

    def test_outlines_that_cross_without_a_corner_in_each_other_are_refused(self):
        lying, standing = box(20, 35, 100, 45), box(55, 10, 65, 70)
        self.assert_refused([(0, lying), (1, standing)], "grains.csv:6: ", "lies on another")
        touching = [(0, lying), (1, box(55, 45, 65, 70)), (2, box(100, 30, 110, 40)),
                    (3, [[30, 35], [20, 10], [40, 10]])]
        done = self.check_given(touching)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_two_outlines_under_one_number_are_refused(self):
        once = circle()
        for again in (once, np.roll(once, -7, axis=0)):
            self.assert_refused([(0, once), (0, again)], "grains.csv:2: ", "runs around more than once")
        self.assert_refused([(0, once), (0, once + [1e-6, 0.0])], "grains.csv:2: ", "an outline of a stone")
        self.assert_refused([(0, once), (0, once[::-1])], "grains.csv:42: ", "repeats the one before")

    def test_an_outline_on_a_hole_notch_or_slit_is_refused(self):
        for outline in (circle(15.0, (60.0, 60.0)), circle(5.0, (32.0, 60.0)), box(50, 59, 70, 61),
                        box(20, 55, 100, 65)):
            self.assert_refused([(0, outline)], "grains.csv:2: ", "does not lie in the specimen, all of it", '"hole_',
                                body=PIERCED, height=120)
        hole = [[50, 50], [70, 50], [70, 70], [50, 70]]
        corners = ", ".join(f'["{x} mm", "{y} mm"]' for x, y in hole)
        self.assert_refused([(0, hole)], "does not lie in the specimen", height=120,
                            body=f"[[specimen.holes]]\ncorners = [{corners}]\n")
        for width in ("3 mm", "0 mm"):
            for outline in (circle(15.0, (60.0, 40.0)), box(30, 15, 90, 25)):
                self.assert_refused([(0, outline)], "grains.csv:2: ", '"notch_1"', body=NOTCH.format(width))
        done = self.check_given([(0, box(30, 15, 60, 25)), (1, box(60, 15, 90, 25))], body=NOTCH.format("0 mm"))
        self.assertEqual(done.returncode, 0, done.stderr)

    def told(self, outlines) -> str:
        """What `check` says, but for memory and times, which it measures."""
        done = self.check_given(outlines)
        self.assertEqual(done.returncode, 0, done.stderr)
        return re.sub(r"\d+ MB of memory|about \d+ (?:s|min|h).*", "", done.stdout)

    def test_an_outline_whose_last_row_repeats_the_first_is_the_same(self):
        once = circle(count=12)
        small, triangle = circle(5.0, (100.0, 40.0), 7), box(5, 5, 20, 20)[:3]
        ring = [np.vstack([outline, outline[:1]]) for outline in (once, small, triangle)]
        self.assertEqual(self.told([(0, ring[0])]), self.told([(0, once)]))
        self.assertEqual(self.told(list(enumerate(ring))), self.told(list(enumerate((once, small, triangle)))))
        ring[0][-1] += 1e-9  # as a program rounds it
        self.assertEqual(self.check_given([(0, ring[0])]).returncode, 0)

    def test_a_row_that_repeats_the_one_before_is_named(self):
        once = circle(count=12)
        self.assert_refused([(0, np.repeat(once, [1, 1, 1, 2] + [1] * 8, axis=0))],
                            "grains.csv:6: the point repeats the one before")


TWO_CELLS = """***tess
 **format
   3.5
 **general
   2 standard
 **cell
  {cells}
 **vertex
 6
   1  0 0 0 0
   2  0.8 0 0 0
   3  2 0 0 0
   4  2 1 0 0
   5  1.2 1 0 0
   6  0 1 0 0
 **face
 {cells}
{faces} **domain
  *general
   cube
  *vertex
   4
   1  0 0 0 x0y0
      1 1
   2  2 0 0 x1y0
      1 3
   3  2 1 0 x1y1
      1 4
   4  0 1 0 x0y1
      1 6
***end
"""
FACES = ("4 1 2 5 6\n  4 1 7 5 6\n  0 0 0 1\n  0 -1 0 0 0\n", "4 2 3 4 5\n  4 2 3 4 7\n  0 0 0 1\n  0 -1 0 0 0\n")
EMPTY = "0\n  0\n  0 0 0 1\n  0 -1 0 0 0\n"


class EmptyCells(ProgramTest):
    def deck(self, *faces):
        text = "".join(f"  {number} {face}" for number, face in enumerate(faces, 1))
        (self.folder / "cells.tess").write_text(TWO_CELLS.format(cells=len(faces), faces=text))
        (self.folder / "deck.toml").write_text(f'{HEAD.format(height=60)}seed = 1\n[blocks]\nfile = "cells.tess"\n'
                                               f"shortest_edge = 0\n{TAIL}")

    def test_empty_cells_of_a_tessellation_are_told_on_the_screen_and_in_the_summary(self):
        left_out = "of its cells {} no vertices and {} left out: cell"
        one, more = left_out.format("has", "is"), left_out.format("have", "are")
        for faces, told in (((EMPTY, *FACES, EMPTY), f"2 {more}s 1, 4 (from 1)"),
                            ((*FACES, *[EMPTY] * 6), f"6 {more}s 3, 4, 5, 6, 7, ... (from 1)"),
                            ((FACES[0], EMPTY, FACES[1]), f"1 {one} 2 (from 1)")):
            self.deck(*faces)
            self.assertIn(told, self.pyroclast("check", "deck.toml").stdout)
        done = self.pyroclast("run", "deck.toml", "--out", "out", "--no-figures")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(told, done.stdout)
        warnings = json.loads((self.folder / "out/summary.json").read_text())["warnings"]
        self.assertTrue(any(told in warning for warning in warnings), warnings)
        self.deck(*FACES)
        self.assertNotIn("no vertices", self.pyroclast("check", "deck.toml").stdout)


if __name__ == "__main__":
    unittest.main()
