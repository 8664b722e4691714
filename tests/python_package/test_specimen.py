"""Specimens from arrays, meshes and images, and runs on them."""

import json
import shutil
import subprocess

import meshio
import numpy as np

import pyroclast
from pyroclast import mm
from small import PROGRAM, Case, deck, plate

SQUARES = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [4, 5, 9, 8], [6, 7, 11, 10], [8, 9, 13, 12], [9, 10, 14, 13],
           [10, 11, 15, 14]]


def squares(size=0.02) -> np.ndarray:
    """Corners of three by three squares, of which SQUARES leaves the middle one out."""
    return size * np.array([[x, y] for y in range(4) for x in range(4)], float)


class Arrays(Case):
    def refused(self, told, vertices=None, cells=SQUARES, labels=("mortar",) * 8, **more):
        with self.assertRaisesRegex(pyroclast.Error, told):
            pyroclast.Specimen.from_arrays(squares() if vertices is None else vertices, cells, labels, **more)

    def test_cells_become_a_specimen_with_its_outline_and_holes(self):
        labels = ["mortar"] * 7 + ["stone"]
        made = pyroclast.Specimen.from_arrays(squares(), [SQUARES[0][::-1], *SQUARES[1:]], labels)
        self.assertEqual(made.sides, ["bottom", "right", "top", "left", "hole_1"])
        self.assertAlmostEqual(made.area, 8 * 0.02**2)
        self.assertAlmostEqual(made.shares["stone"], 1 / 8)
        self.assertEqual([made.phases[i] for i in made.phase], labels)
        np.testing.assert_array_equal(made.vertices, squares())
        self.assertEqual(sorted(made.cells[0].tolist()), sorted(SQUARES[0]))
        tilted = squares() + np.array([0.3, 0.1]) + squares()[:, ::-1] * [0.0, 0.5]
        self.assertEqual(pyroclast.Specimen.from_arrays(tilted, SQUARES, np.arange(8) % 2, {0: "a", 1: "b"}).sides,
                         ["side_1", "side_2", "side_3", "side_4", "hole_1"])

    def test_what_does_not_fit_is_told_by_cell(self):
        self.refused("cell 2 names vertex 99", cells=[*SQUARES[:2], [2, 3, 99, 6], *SQUARES[3:]])
        self.refused("cell 2 names vertex -1", cells=[*SQUARES[:2], [2, 3, -1, 6], *SQUARES[3:]])
        self.refused("cell 1 must be a list", cells=[SQUARES[0], [0.5, 1, 2], *SQUARES[2:]])
        self.refused("cell 1 has 2 corners", cells=[SQUARES[0], [1, 2], *SQUARES[2:]])
        self.refused("cell 3 has the label 1", labels=["mortar"] * 3 + [1] * 5)
        self.refused("cell 0 has the label 'mortar'", phases={1: "mortar"})
        self.refused("phases of 7", labels=["mortar"] * 7)
        self.refused("not one piece|meet in one point", cells=[SQUARES[0], SQUARES[-1]], labels=["mortar"] * 2)
        self.refused("no cells", cells=[], labels=[])
        self.refused("must be .n, 2.", vertices=squares().T)
        dented = squares()
        dented[5] = [0.001, 0.001]
        self.refused("not convex", vertices=dented)

    def test_a_run_of_them_is_made_again_from_its_folder(self):
        made = pyroclast.Specimen.of(plate())
        again = pyroclast.Specimen.from_arrays(made.vertices, made.cells, [made.phases[i] for i in made.phase])
        of_cells = plate()
        of_cells["specimen"] = again
        self.assertEqual(of_cells["specimen"], {"shape": "cells", "file": "cells.json", "thickness": "0.1 m"})
        of_cells.check()
        folder = self.folder()
        run = pyroclast.Run(of_cells, out=folder / "run", threads=1)
        run.until(steps=700)
        run.checkpoint()
        copied = run.copy()
        run.close()
        resumed = pyroclast.Run.resume(folder / "run", threads=1).finish()
        copied.finish()
        straight = pyroclast.Run(plate(), threads=1).finish()
        for other in (resumed, copied, pyroclast.Run(folder / "run" / "deck.toml", threads=1).finish()):
            np.testing.assert_array_equal(other.history.to_pandas(), straight.history.to_pandas())
        shutil.copytree(folder / "run" / "inputs", folder / "moved" / "inputs")
        shutil.copy(folder / "run" / "deck.toml", folder / "moved")
        subprocess.run([PROGRAM, "run", "deck.toml", "--out", "program", "--no-figures", "--quiet", "--threads", "1"],
                       cwd=folder / "moved", check=True)
        self.assertEqual((folder / "moved" / "program" / "history.csv").read_bytes(),
                         (folder / "run" / "history.csv").read_bytes())
        of_cells.save(folder / "saved.toml")
        self.assertEqual(json.loads((folder / "saved_cells.json").read_text())["phases"], ["mortar"])
        self.assertEqual(len(pyroclast.Specimen.of(folder / "saved.toml").phase), 40)
        other = of_cells.copy()
        other["title"] = "other"
        other.save(folder / "other.toml")  # into the same folder: neither takes the blocks of the other
        self.assertEqual(sorted(file.name for file in folder.glob("*_cells.json")),
                         ["other_cells.json", "saved_cells.json"])

    def test_platens_and_bearings_lie_on_them(self):
        starter = deck()
        of_cells = deck()
        made = pyroclast.Specimen.of(starter)
        of_cells["specimen"] = pyroclast.Specimen.from_arrays(made.vertices, made.cells, made.phase,
                                                              dict(enumerate(made.phases)))
        runs = [pyroclast.Run(d, threads=1).until(strain=1e-4) for d in (starter, of_cells)]
        self.assertEqual(runs[0].stress, runs[1].stress)
        seat = {"name": "seat", "at": ["31 mm", "0 mm"], "width": "23 mm", "thickness": "6 mm", "contact": "glued"}
        on_bearing = plate(bearings=[seat], stages=[{"kind": "drive", "duration": "1 ms", "drives": [
            {"set": "seat_support", "hold": ["x", "y"]}]}])
        made = pyroclast.Specimen.of(plate())
        on_bearing["specimen"] = pyroclast.Specimen.from_arrays(made.vertices, made.cells, ["mortar"] * 40)
        on_bearing["materials.platen"] = starter["materials.platen"]
        run = pyroclast.Run(on_bearing, threads=1)
        face = run.position[run.sets["seat_face"], 0]
        ends = made.vertices[made.vertices[:, 1] == 0.0, 0]
        for end, asked in ((face.min(), 19.5e-3), (face.max(), 42.5e-3)):
            self.assertEqual(end, ends[np.abs(ends - asked).argmin()])

    def test_what_belongs_to_another_specimen_is_refused(self):
        made = plate()
        made["specimen"] = pyroclast.Specimen.of(plate())
        with self.assertRaisesRegex(pyroclast.DeckError, "blocks.*no effect"):
            made.copy().update(blocks={"count": 9}).check()
        with self.assertRaisesRegex(pyroclast.Error, "seed has no meaning"):
            pyroclast.Run(made, seed=2)
        other = made.copy()
        other["superposition.matrix"] = "paste"
        with self.assertRaisesRegex(pyroclast.DeckError, "none is the matrix"):
            other.check()
        with self.assertRaisesRegex(pyroclast.Error, 'belongs to "specimen"'):
            made["materials"] = pyroclast.Specimen.of(plate())

    def test_a_file_that_holds_no_cells_is_told_with_its_name(self):
        good = {"phases": ["mortar"], "vertices_m": squares().tolist(), "cells": SQUARES, "phase": [0] * 8}
        file = self.folder() / "mine.json"
        for change, told in (({"cells": [[0, 1.5, 2]]}, r"mine.json: cells\[0\]"), ({"phase": None}, 'no list "phase"'),
                             ({"vertices_m": [[0, 0, 0]]}, r"vertices_m\[0\]: must be a place"),
                             ({"cells": [[0, 1, 1e300]]}, r"cells\[0\]"), ({"phases": [3]}, r"phases\[0\]"),
                             ({"phase": [0] * 7 + [5]}, "cell 7 is of phase 5")):
            file.write_text(json.dumps({**good, **change}))
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.read(file)
        for text in ("{", "[]"):
            file.write_text(text)
            with self.assertRaisesRegex(pyroclast.Error, "mine.json: is no"):
                pyroclast.Specimen.read(file)
        file.write_text(json.dumps(good))
        self.assertEqual(pyroclast.Specimen.read(file).sides[-1], "hole_1")


class Meshes(Case):
    def test_a_mesh_of_polygons_comes_back(self):
        made = pyroclast.Specimen.of(plate())
        again = pyroclast.Specimen.from_meshio(made.to_meshio(), "phase", dict(enumerate(made.phases)))
        self.assertEqual(sorted(map(len, again.cells)), sorted(map(len, made.cells)))
        self.assertAlmostEqual(again.area, made.area, places=12)

    def test_triangles_and_quads_with_lines_and_spare_points(self):
        points = np.column_stack([np.vstack([[[9.0, 9.0]], squares()]), np.zeros(17)])
        cells = [("line", np.array([[1, 2]])), ("quad", np.array(SQUARES[1:]) + 1),
                 ("triangle", np.array([[1, 2, 6], [1, 6, 5]]))]
        mesh = meshio.Mesh(points, cells, cell_data={"kind": [[7], [1] * 7, [2, 2]]})
        made = pyroclast.Specimen.from_meshio(mesh, "kind", {1: "mortar", 2: "stone"})
        self.assertAlmostEqual(made.shares["stone"], 1 / 8)
        for change, told in (({"data": "sort"}, "no cell data 'sort'; it has kind"),
                             ({"phases": {1: "mortar"}}, "label 2")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_meshio(**{"mesh": mesh, "data": "kind", "phases": {1: "a", 2: "b"}, **change})
        points[3, 2] = 0.01
        with self.assertRaisesRegex(pyroclast.Error, "plane"):
            pyroclast.Specimen.from_meshio(meshio.Mesh(points, cells, cell_data=mesh.cell_data), "kind", {})
        solid = meshio.Mesh(points, [("tetra", np.array([[0, 1, 2, 3]]))], cell_data={"kind": [[1]]})
        with self.assertRaisesRegex(pyroclast.Error, "plane|'tetra'"):
            pyroclast.Specimen.from_meshio(solid, "kind", {1: "mortar"})


class Images(Case):
    def image(self, rows=120, columns=60) -> np.ndarray:
        """A stone of 30 % of the area in the upper half, in mortar."""
        y, x = np.mgrid[0:rows, 0:columns] + 0.5
        return (np.hypot(x - 0.5 * columns, y - 0.3 * rows) < 0.31 * columns).astype(int)

    def test_blocks_are_of_the_phase_of_most_of_their_pixels(self):
        image = self.image()
        made = pyroclast.Specimen.from_image(image, 1 * mm, {0: "mortar", 1: "stone"}, blocks=400)
        self.assertEqual(made.sides, ["bottom", "right", "top", "left"])
        self.assertAlmostEqual(made.area, 0.06 * 0.12, places=12)
        self.assertAlmostEqual(made.shares["stone"], image.mean(), delta=0.01)
        self.assertGreater(made.agreement, 0.96)
        middle = np.array([made.vertices[cell].mean(axis=0) for cell in made.cells])
        of_stone = np.array(made.phases)[made.phase] == "stone"
        self.assertAlmostEqual(middle[of_stone, 1].mean(), 0.7 * 0.12, delta=0.003)  # the first row is on top
        fine = pyroclast.Specimen.from_image(image, 1 * mm, {0: "mortar", 1: "stone"}, blocks=1600)
        self.assertGreater(fine.agreement, made.agreement)

    def test_votes_are_those_of_every_pixel(self):
        rng = np.random.default_rng(1)
        image = rng.integers(0, 3, (30, 20))
        made = pyroclast.Specimen.from_image(image, "1 mm", {0: "a", 1: "b", 2: "c"}, blocks=60)
        y, x = np.mgrid[0:30, 0:20] + 0.5
        alike, inside = 0, 0
        for cell, phase in zip(made.cells, made.phase):
            corners = made.vertices[cell] * 1e3
            edge = np.roll(corners, -1, axis=0) - corners
            within = np.all([e[0] * (30 - y - c[1]) >= e[1] * (x - c[0]) for e, c in zip(edge, corners)], axis=0)
            counts = np.bincount(image[within], minlength=3)
            self.assertEqual(counts[phase], counts.max())
            alike, inside = alike + counts[phase], inside + within.sum()
        self.assertEqual(inside, image.size)
        self.assertAlmostEqual(made.agreement, alike / image.size)

    def test_pixels_larger_than_blocks_are_seen(self):
        made = pyroclast.Specimen.from_image([[0, 1], [1, 0]], 20 * mm, {0: "mortar", 1: "stone"}, blocks=400)
        self.assertAlmostEqual(made.shares["stone"], 0.5, delta=0.05)

    def test_where_there_is_nothing_no_blocks_are(self):
        y, x = np.mgrid[-40:40, -40:40] + 0.5
        image = np.where(np.hypot(x, y) > 38.0, 0, 1)
        image[np.hypot(x - 8.0, y) < 14.0] = 2
        image[np.hypot(x + 20.0, y) < 9.0] = 0
        image[:3, :3] = 1  # a crumb that does not hang together with the core
        made = pyroclast.Specimen.from_image(image, "1 mm", {0: None, 1: "mortar", 2: "stone"}, blocks=900)
        self.assertAlmostEqual(made.area, 1e-6 * np.pi * (38.0**2 - 9.0**2), delta=0.03 * 4.3e-3)
        self.assertEqual([side for side in made.sides if side.startswith("hole")], ["hole_1"])
        self.assertAlmostEqual(made.shares["stone"] * made.area, 1e-6 * np.pi * 14.0**2, delta=0.1 * 6e-4)
        speckled = np.where(np.random.default_rng(2).random((60, 60)) < 0.25, 0, 1)
        pyroclast.Specimen.from_image(speckled, "1 mm", {0: None, 1: "mortar"}, blocks=1500)

    def test_what_is_wrong_is_told(self):
        for image, pixel, phases, told in (
                (self.image(), 1e-3, {0: "a", 1: "b"}, "a unit of length is needed"),
                (self.image(), "1 s", {0: "a", 1: "b"}, "length"),
                (self.image(), "1 mm", {0: "a"}, r"pixel \[\d+, \d+\] has the label 1"),
                (self.image()[0], "1 mm", {0: "a"}, "rows, columns"),
                (np.zeros((9, 9)), "1 mm", {0: None}, "nothing in the image")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_image(image, pixel, phases, blocks=50)
