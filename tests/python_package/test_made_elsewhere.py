"""Blocks that other programs made: files off by rounding, vertices at one place, files that cannot be read."""

import json
import re
import subprocess

import numpy as np
import pyroclast
from small import PROGRAM, Case

HEATED = """
title = "Blocks made elsewhere"
[specimen]
{specimen}
[materials.mortar]
density = "2000 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "1000 J/(kg K)"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "outline"
kind = "temperature"
temperature = "120 degC"
[[stages]]
kind = "conduct"
duration = "10 min"
interval = "5 min"
[output]
frame_interval = "1 h"
"""
SIDES = ["bottom", "right", "top", "left"]


def two_cubes() -> dict:
    """Two cubes of 0.1 m that share a face, as a file of polyhedra."""
    return {"phases": ["mortar"],
            "vertices_m": [[0.1 * x, 0.1 * y, 0.1 * z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)],
            "faces": [[0, 3, 9, 6], [1, 4, 10, 7], [0, 1, 7, 6], [3, 4, 10, 9], [0, 1, 4, 3], [6, 7, 10, 9],
                      [2, 5, 11, 8], [1, 2, 8, 7], [4, 5, 11, 10], [1, 2, 5, 4], [7, 8, 11, 10]],
            "cells": [[0, 1, 2, 3, 4, 5], [1, 6, 7, 8, 9, 10]], "phase": [0, 0],
            "body": {"axis": "z", "length_m": 0.1, "section_m": [[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]],
                     "sides": SIDES}}


def parted_cubes(gap: float = 0.0) -> dict:
    """The same without shared vertices; the second cube has its own where they touch."""
    cubes = two_cubes()
    own = {1: 12, 4: 13, 7: 14, 10: 15}
    cubes["vertices_m"] += [[x + gap, y, z] for x, y, z in (cubes["vertices_m"][v] for v in own)]
    cubes["faces"] = cubes["faces"][:6] + [[own.get(v, v) for v in face]
                                           for face in (*cubes["faces"][6:], cubes["faces"][1])]
    cubes["cells"][1] = [11, 6, 7, 8, 9, 10]
    return cubes


def grid(columns: int, angle: float = 0.0) -> tuple[np.ndarray, list[list[int]]]:
    """Squares that make one of 0.2 m, turned by an angle: vertices and cells."""
    line = np.linspace(0.0, 0.2, columns + 1)
    at = np.array([(x, y) for y in line for x in line])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    n = columns + 1
    return at @ turn, [[j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i]
                       for j in range(columns) for i in range(columns)]


def nine_digits(values) -> list:
    return [[float(f"{x:.9g}") for x in place] for place in values]


def single(values) -> list:
    return [[float(np.float32(x)) for x in place] for place in values]


class Made(Case):
    def file(self, content, name: str = "blocks.json"):
        path = self.folder() / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def refusal(self, make) -> str:
        with self.assertRaises(pyroclast.Error) as raised:
            make()
        return str(raised.exception)

    def solid(self, content, **options) -> pyroclast.Specimen:
        return pyroclast.Specimen.read(self.file(content), **options)


class Rounded(Made):
    """Promise: a file whose coordinates are off by rounding is read, in the plane and in space; its sides are straight
    and have their names. A vertex that is farther off is told, with the distance that is allowed.
    """

    def cylinder(self) -> dict:
        deck = pyroclast.Deck.from_text(
            HEATED.format(specimen='shape = "cylinder"\ndiameter = "60 mm"\nheight = "60 mm"\nseed = 1')
            + "[blocks]\ncount = 400\nradius_spread = 0.3\nshortest_edge = 0.35\n")
        path = self.folder() / "made.json"
        deck.make_specimen().save(path)
        return json.loads(path.read_text())

    def test_solids_of_nine_digits_and_single_precision_are_read(self):
        cubes, cylinder = two_cubes(), self.cylinder()
        noise = np.random.default_rng(1)
        for whole in (cubes, cylinder):
            off = noise.uniform(-1e-9, 1e-9, (len(whole["vertices_m"]), 3))
            for rounded in (nine_digits, single, lambda v, off=off: (np.array(v) + off).tolist()):
                made = self.solid(whole | {"vertices_m": rounded(whole["vertices_m"])})
                self.assertLess(np.abs(made.vertices - whole["vertices_m"]).max(), 1e-8)
                exact = self.solid(whole)
                self.assertAlmostEqual(made.extent, exact.extent, delta=1e-12 * exact.extent)
                self.assertEqual(made.sides, exact.sides)
                lowest, highest = np.abs(made.vertices[:, 1]).min(), made.vertices[:, 1].max()
                self.assertEqual((lowest, highest), (0.0, exact.size[1]))  # ends are level again

    def test_sections_may_be_rounded_too(self):
        for whole in (self.cylinder(), two_cubes()):
            body = whole["body"] | {"section_m": single(np.array(whole["body"]["section_m"]) * (1.0 + 3e-8))}
            made = self.solid(whole | {"vertices_m": single(whole["vertices_m"]), "body": body})
            self.assertEqual(len(made.cells), len(whole["cells"]))
        # a corner in the middle of a side, which rounding lets jut into the body
        cubes = two_cubes()
        cubes["body"] |= {"section_m": [[0, 0], [0.1, 2e-9], [0.2, 0], [0.2, 0.1], [0, 0.1]],
                          "sides": ["near", "far", "right", "top", "left"]}
        self.assertEqual(self.solid(cubes).sides, ["near", "far", "right", "top", "left", "front", "back"])

    def test_files_of_the_program_keep_their_bits(self):
        made = self.cylinder()
        self.assertEqual(self.solid(made).vertices.tolist(), made["vertices_m"])

    def test_a_vertex_off_its_side_is_told_with_what_is_allowed(self):
        cubes = two_cubes()
        cubes["vertices_m"][11] = [0.2001, 0.1, 0.1]
        said = self.refusal(lambda: self.solid(cubes))
        for words in ("face 6 (from 0), of cell 1 alone, lies on no side", "(0.2001, 0.1, 0.1) m is 0.0001 m off",
                      '"right"', "1e-05 m is allowed, 0.0001 of a block"):
            self.assertIn(words, said)
        cubes["vertices_m"][11] = [0.200009, 0.1, 0.1]
        self.assertEqual(self.solid(cubes).vertices[11].tolist(), [0.2, 0.1, 0.1])

    def test_the_plane_is_read_alike(self):
        noise = np.random.default_rng(1)
        for columns in (2, 10, 60):
            for angle, sides in ((0.0, SIDES), (0.3, ["side_1", "side_2", "side_3", "side_4"])):
                at, cells = grid(columns, angle)
                for rounded in (np.round(at, 9), at.astype(np.float32), at + noise.uniform(-1e-9, 1e-9, at.shape)):
                    made = pyroclast.Specimen.from_arrays(rounded, cells, ["mortar"] * len(cells), unit="m")
                    self.assertEqual(made.sides, sides)
                    self.assertAlmostEqual(made.extent, 0.04, delta=1e-7 * 0.04)
                    self.assertLess(np.abs(made.vertices - at).max(), 3e-8)

    def test_corners_on_a_straight_line_may_bend_inwards_by_rounding(self):
        # bricks: the corners of the upper row lie in the middle of the lower bricks' edges
        at = np.array([(0, 0), (1, 0), (2, 0), (0, 1), (0.5, 1), (1, 1), (1.5, 1), (2, 1), (0, 2), (0.5, 2), (1.5, 2),
                       (2, 2)]) * 0.01
        cells = [[0, 1, 5, 4, 3], [1, 2, 7, 6, 5], [3, 4, 9, 8], [4, 5, 6, 10, 9], [6, 7, 11, 10]]
        for low in (-5e-8, 5e-8):
            moved = at.copy()
            moved[4:7, 1] += low
            made = pyroclast.Specimen.from_arrays(moved, cells, ["mortar"] * 5, unit="m")
            self.assertEqual(len(made.cells), 5)
        moved[4, 1] -= 1e-4
        self.assertIn("is not convex", self.refusal(
            lambda: pyroclast.Specimen.from_arrays(moved, cells, ["mortar"] * 5, unit="m")))

    def test_corners_of_an_outline_stay(self):
        # a side parallel to the line between the first two corners that are found, and a slight bend
        at = np.array([(0, 0), (0.1, 0), (0.2, 0), (0.3, 0), (0.3, 0.1), (0.3, 0.2), (0.225, 0.25), (0.15, 0.3),
                       (0.075, 0.25), (0, 0.2), (0, 0.1), (0.15, 0.15)])
        cells = [[i, (i + 1) % 11, 11] for i in range(11)]
        made = pyroclast.Specimen.from_arrays(at, cells, ["mortar"] * 11, unit="m")
        self.assertEqual(len(made.sides), 5)
        at[1, 1] = -1e-4
        self.assertEqual(len(pyroclast.Specimen.from_arrays(at, cells, ["mortar"] * 11, unit="m").sides), 7)


class Few(Made):
    """Promise: a body of one block, or of too few, has a message that says what counts."""

    def check(self, text: str, *changes: str) -> subprocess.CompletedProcess:
        deck = self.file(text, "deck.toml")
        words = [word for change in changes for word in ("--set", change)]
        return subprocess.run([PROGRAM, "check", deck, *words], capture_output=True, text=True, check=False)

    def test_one_block_has_no_faces_to_others(self):
        cubes = two_cubes()
        cubes |= {"faces": cubes["faces"][:6], "cells": cubes["cells"][:1], "phase": [0],
                  "body": cubes["body"] | {"section_m": [[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]]}}
        done = self.check(HEATED.format(specimen=f'shape = "polyhedra"\nfile = "{self.file(cubes)}"'))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("12.0 zones\n", done.stdout)
        self.assertNotIn("corners", done.stdout)

    def test_too_few_blocks_for_a_rim_name_how_many_to_take(self):
        text = HEATED.format(specimen='shape = "cylinder"\ndiameter = "60 mm"\nheight = "120 mm"\nseed = 1') + (
            "[blocks]\ncount = 4\nradius_spread = 0.3\n")
        for seed in (1, 2):
            done = self.check(text, f"specimen.seed={seed}")
            self.assertEqual(done.returncode, 1, done.stdout)
            told = re.search(r"a face of a block has (\d+) corners, but contacts can join 15 at most: 4 blocks are too "
                             r"few for the outline, take (\d+) or more", done.stderr)
            self.assertIsNotNone(told, done.stderr)
            done = self.check(text, f"specimen.seed={seed}", f"blocks.count={told[2]}")
            self.assertEqual(done.returncode, 0, done.stderr)


class Joined(Made):
    """Promise: vertices at one place are counted, and `join` makes solids of them as of shared vertices."""

    def test_coinciding_vertices_are_counted(self):
        said = self.refusal(lambda: self.solid(parted_cubes()))
        for words in ("the cells are 2 pieces that have no face in common", "cell 0 (from 0) at (0.05, 0.05, 0.05) m",
                      "4 vertices coincide with others, and 1 face has the corners of another",
                      'join = "2e-07 m" joins them'):
            self.assertIn(words, said)
        self.assertIn("; no vertices coincide, and no face", self.refusal(lambda: self.solid(parted_cubes(1e-4))))

    def test_joined_cubes_are_the_cubes_that_share_vertices(self):
        shared = self.solid(two_cubes())
        for gap in (0.0, 5e-7, -5e-7):
            joined = self.solid(parted_cubes(gap), join="1 um")
            self.assertEqual(joined.vertices.tolist(), shared.vertices.tolist())
            self.assertEqual([face.tolist() for face in joined.facets], [face.tolist() for face in shared.facets])
            self.assertEqual(joined.neighbours.tolist(), shared.neighbours.tolist())
        self.assertIn("2 pieces", self.refusal(lambda: self.solid(parted_cubes(1e-4), join="1 um")))

    def test_a_joined_file_runs_to_the_same_numbers(self):
        folder = self.folder()
        (folder / "shared.json").write_text(json.dumps(two_cubes()))
        (folder / "parted.json").write_text(json.dumps(parted_cubes()))
        histories = []
        for name, join in (("shared", ""), ("parted", '\njoin = "1 um"')):
            (folder / "deck.toml").write_text(
                HEATED.format(specimen=f'shape = "polyhedra"\nfile = "{name}.json"{join}'))
            run = pyroclast.Run(folder / "deck.toml").finish()
            histories.append(run.history.to_pandas().drop(columns="wall_time_s", errors="ignore"))
        self.assertEqual(histories[0].to_csv(), histories[1].to_csv())

    def test_faces_listed_twice_are_told_and_joined(self):
        cubes = two_cubes()
        cubes["faces"].append([7, 10, 4, 1])  # the other way around, from another corner
        cubes["cells"][1][0] = 11
        self.assertIn("0 vertices coincide with others, and 1 face has the corners of another",
                      self.refusal(lambda: self.solid(cubes)))
        self.assertEqual((self.solid(cubes, join="1 nm").neighbours[:, 1] >= 0).sum(), 1)

    def test_faces_that_do_not_match_are_told(self):
        cubes = parted_cubes()
        cubes["vertices_m"][15][1] += 0.01
        cubes["vertices_m"][13][1] += 0.01
        said = self.refusal(lambda: self.solid(cubes))
        self.assertIn("2 vertices coincide with others, but no face has the corners of another then", said)

    def test_too_large_a_distance_is_refused(self):
        said = self.refusal(lambda: self.solid(parted_cubes(), join="0.15 m"))
        self.assertIn("face 0 (from 0) has two corners near (0, 0, 0) m", said)


class OneFault(Made):
    """Promise: a file of blocks that cannot be read is one error, whatever phases the deck's materials are of."""

    def faults(self, specimen: str, files: dict, more: str = "", phases=("mortar",)) -> list[str]:
        folder = self.folder()
        for name, content in files.items():
            (folder / name).write_text(content if isinstance(content, str) else json.dumps(content))
        text = HEATED.format(specimen=specimen)
        begin, end = text.index("[materials.mortar]"), text.index("[heat]")
        material = text[begin:end]
        text = text[:begin] + "".join(material.replace("mortar", name) for name in phases) + text[end:] + more
        (folder / "deck.toml").write_text(text)
        with self.assertRaises(pyroclast.DeckError) as raised:
            pyroclast.Deck(folder / "deck.toml").check()
        return [f"{fault.key}: {fault.message}" for fault in raised.exception.diagnostics]

    def one(self, words: str, *of, **more):
        faults = self.faults(*of, **more)
        self.assertEqual(len(faults), 1, faults)
        self.assertIn(words, faults[0])

    def test_of_solids(self):
        specimen = 'shape = "polyhedra"\nfile = "b.json"'
        cubes = two_cubes()
        for words, change in (('no table "body"', {"body": None}), ('no list "faces"', {"faces": None}),
                              ('no list "vertices_m"', {"vertices_m": None}),
                              ("phase[1]: must be", {"phase": [0, "mortar"]})):
            content = {key: value for key, value in (cubes | change).items() if value is not None}
            for phases in (("mortar",), ("paste",), ("paste", "stone")):
                with self.subTest(words=words, phases=phases):
                    self.one(words, specimen, {"b.json": content}, phases=phases)
        self.one("is not JSON", specimen, {"b.json": "solid"})
        self.one("b.json", specimen, {})
        self.one("2 pieces", specimen, {"b.json": parted_cubes()})
        self.one("file", 'shape = "polyhedra"', {})

    def test_of_the_plane(self):
        at, cells = grid(2)
        good = {"phases": ["paste", "stone"], "vertices_m": at.tolist(), "cells": cells, "phase": [0, 1, 0, 1]}
        specimen = 'shape = "cells"\nfile = "b.json"\nthickness = "0.1 m"'
        matrix = '[superposition]\nmatrix = "paste"\n'
        wrong = {"vertices": good["vertices_m"]} | {k: v for k, v in good.items() if k != "vertices_m"}
        for more in ("", matrix):
            self.one('there is no list "vertices_m"', specimen, {"b.json": wrong}, more, phases=("paste", "stone"))
            self.one("names vertex 99", specimen, {"b.json": good | {"cells": [[0, 1, 99]] + cells[1:]}}, more,
                     phases=("paste", "stone"))
        self.one("is not JSON", specimen, {"b.json": "$MeshFormat"}, matrix, phases=("paste", "stone"))
        # a fault beside a file that is read is one error too
        self.one("depht", specimen + '\ndepht = "1 m"', {"b.json": good}, matrix, phases=("paste", "stone"))

    def test_of_tessellations_and_lists_of_stones(self):
        tess = 'shape = "tessellation"\nwidth = "0.1 m"\nthickness = "0.1 m"\nseed = 1'
        blocks = '[blocks]\nfile = "b.tess"\nshortest_edge = 0.1\ngroups = ["paste", "stone"]\n'
        matrix = '[superposition]\nmatrix = "paste"\n'
        for content in ("***tess\n **format\n 1.0\n", "{}"):
            self.one("b.tess", tess, {"b.tess": content}, blocks + matrix, phases=("paste", "stone"))
        self.one("b.tess", tess, {}, blocks + matrix, phases=("paste", "stone"))
        stones = ('[aggregates.stones]\ncsv = "s.csv"\nphases = ["basalt", "chalk"]\n'
                  '[blocks]\ncount = 50\nshortest_edge = 0.1\n[superposition]\nrule = "centroid"\n')
        self.one("s.csv", 'width = "0.1 m"\nheight = "0.1 m"\nthickness = "0.1 m"\nseed = 1', {}, stones,
                 phases=("basalt", "chalk", "mortar"))

    def test_contacts_and_places_ask_for_nothing_more(self):
        specimen = 'shape = "polyhedra"\nfile = "b.json"\nsymmetry = ["rim"]'
        probe = '[[probes]]\nname = "p"\nx = "-5 mm"\ny = "7 m"\nz = "0 mm"\n'
        self.one('no table "body"', specimen, {"b.json": {k: v for k, v in two_cubes().items() if k != "body"}}, probe)


class InSpace(Made):
    """Promise: blocks of space that are given where the plane is read, and the other way around, are told of the way
    that is theirs.
    """

    HOW = '[specimen] shape = "polyhedra" and file'

    def test_arrays_and_images(self):
        at = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]) * 0.1
        self.assertIn("faces=[...]", self.refusal(
            lambda: pyroclast.Specimen.from_arrays(at, [[0, 1, 2]], ["mortar"], unit="m")))
        self.assertIn("a slice", self.refusal(
            lambda: pyroclast.Specimen.from_image(np.zeros((9, 9, 9), int), "1 mm", {0: "mortar"}, blocks=9)))

    def test_files(self):
        at, cells = grid(2)
        plane = {"phases": ["mortar"], "vertices_m": at.tolist(), "cells": cells, "phase": [0] * 4}
        for content, dimension, other, told in ((two_cubes(), 3, "cells", self.HOW),
                                                (plane, 2, "polyhedra", '[specimen] shape = "cells"')):
            file = self.file(content)
            self.assertEqual(pyroclast.Specimen.read(file).dimension, dimension)
            deck = self.folder() / "deck.toml"
            deck.write_text(HEATED.format(specimen=f'shape = "{other}"\nfile = "{file}"'))
            self.assertIn(told, self.refusal(lambda: pyroclast.Deck(deck).check()))

    def test_tessellations(self):
        folder = self.folder()
        (folder / "b.tess").write_text("***tess\n **format\n   3.5\n **general\n   3 standard\n")
        for specimen in ('shape = "tessellation"\nwidth = "0.1 m"\nthickness = "0.1 m"\nseed = 1',
                         'width = "0.1 m"\nheight = "0.1 m"\ndepth = "0.1 m"\nseed = 1'):
            (folder / "deck.toml").write_text(HEATED.format(specimen=specimen)
                                              + '[blocks]\nfile = "b.tess"\nshortest_edge = 0.1\n')
            said = self.refusal(lambda: pyroclast.Deck(folder / "deck.toml").check())
            self.assertIn(self.HOW, said)
            self.assertEqual(len(said.splitlines()), 1)
