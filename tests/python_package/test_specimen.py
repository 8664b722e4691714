"""Specimens from arrays, meshes and images, and runs on them."""

import json
import shutil
import subprocess
import warnings

import meshio
import numpy as np

import pyroclast
from pyroclast import m, mm
from pyroclast.live import label_image
from small import PROGRAM, Case, deck, plate

SQUARES = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [4, 5, 9, 8], [6, 7, 11, 10], [8, 9, 13, 12], [9, 10, 14, 13],
           [10, 11, 15, 14]]

HEATED = """title = "case"
[specimen]
{}
[materials.mortar]
density = "2200 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "900 J/(kg K)"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "outline"
kind = "temperature"
temperature = "100 degC"
[[stages]]
kind = "conduct"
duration = "1 min"
interval = "20 s"
[output]
frame_interval = "1 min"
"""  # a body that is heated, with what [specimen] and more tables say
TESS = """***tess
 **format
   3.4
 **general
   2 standard
 **cell
  2
 **vertex
 6
   1  0 0 0     0
   2  1 0 0     0
   3  2 0 0     0
   4  2 1 0     0
   5  1 1 0     0
   6  0 1 0     0
 **face
 2
   1 4 1 2 5 6
     4 1 1 1 1
    0 0 0 1
     0 -1 0 0 0
   2 4 2 3 4 5
     4 1 1 1 1
    0 0 0 1
     0 -1 0 0 0
 **domain
  *general
   cube
  *vertex
   4
   1  0 0 0 x1
      1 1
   2  2 0 0 x2
      1 2
   3  2 1 0 x3
      1 3
   4  0 1 0 x4
      1 4
***end
"""


def squares(size=0.02) -> np.ndarray:
    """Corners of three by three squares, of which SQUARES leaves the middle one out."""
    return size * np.array([[x, y] for y in range(4) for x in range(4)], float)


class Arrays(Case):
    def refused(self, told, vertices=None, cells=SQUARES, labels=("mortar",) * 8, **more):
        with self.assertRaisesRegex(pyroclast.Error, told):
            pyroclast.Specimen.from_arrays(squares() if vertices is None else vertices, cells, labels,
                                           **{"unit": "m", **more})

    def test_cells_become_a_specimen_with_its_outline_and_holes(self):
        labels = ["mortar"] * 7 + ["stone"]
        made = pyroclast.Specimen.from_arrays(squares(), [SQUARES[0][::-1], *SQUARES[1:]], labels, unit="m")
        self.assertEqual(made.sides, ["bottom", "right", "top", "left", "hole_1"])
        self.assertAlmostEqual(made.extent, 8 * 0.02**2)
        self.assertAlmostEqual(made.shares["stone"], 1 / 8)
        self.assertEqual([made.phases[i] for i in made.phase], labels)
        np.testing.assert_array_equal(made.vertices, squares())
        self.assertEqual(sorted(made.cells[0].tolist()), sorted(SQUARES[0]))
        tilted = squares() + np.array([0.3, 0.1]) + squares()[:, ::-1] * [0.0, 0.5]
        self.assertEqual(pyroclast.Specimen.from_arrays(tilted, SQUARES, np.arange(8) % 2, {0: "a", 1: "b"},
                                                        unit="m").sides,
                         ["side_1", "side_2", "side_3", "side_4", "hole_1"])

    def test_what_does_not_fit_is_told_by_cell(self):
        self.refused("cell 2 .from 0. names vertex 99", cells=[*SQUARES[:2], [2, 3, 99, 6], *SQUARES[3:]])
        self.refused("cell 2 .from 0. names vertex -1", cells=[*SQUARES[:2], [2, 3, -1, 6], *SQUARES[3:]])
        self.refused("cell 1 .from 0. must be a list", cells=[SQUARES[0], [0.5, 1, 2], *SQUARES[2:]])
        self.refused("cell 1 .from 0. has 2 vertices", cells=[SQUARES[0], [1, 2], *SQUARES[2:]])
        self.refused("cell 3 .from 0. has the label 1", labels=["mortar"] * 3 + [1] * 5)
        self.refused("cell 0 .from 0. has the label 'mortar'", phases={1: "mortar"})
        self.refused("8 cells, but the labels of 7", labels=["mortar"] * 7)
        self.refused("2 pieces", cells=[SQUARES[0], SQUARES[-1]], labels=["mortar"] * 2)
        self.refused("no cells", cells=[], labels=[])
        self.refused("must be .n, 2.", vertices=squares().T)
        dented = squares()
        dented[5] = [0.001, 0.001]
        self.refused("cell 0 .from 0. near .* not convex", vertices=dented)

    def test_messages_count_cells_from_0(self):
        vertices = [(0.1 * (i // 2), 0.1 * (i % 2)) for i in range(10)] + [(0.35, 0.05)]
        cells = [[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(3)] + [[6, 8, 9, 7, 10]]
        vertices[10] = (0.37, 0.05)
        with self.assertRaisesRegex(pyroclast.Error, "cell [23] .from 0."):
            pyroclast.Specimen.from_arrays(vertices, cells, ["m"] * 4, unit="m")

    def test_the_unit_of_vertices_is_asked_for(self):
        with self.assertWarnsRegex(UserWarning, "taken in m, as no unit is stated"):
            pyroclast.Specimen.from_arrays(squares(), SQUARES, ["mortar"] * 8)
        in_m = pyroclast.Specimen.from_arrays(squares(), SQUARES, ["mortar"] * 8, unit="m")
        for unit, size in (("mm", 20.0), (mm, 20.0), ("km", 2e-5), (20 * mm, 1.0)):
            made = pyroclast.Specimen.from_arrays(squares(size), SQUARES, ["mortar"] * 8, unit=unit)
            np.testing.assert_allclose(made.vertices, in_m.vertices, rtol=1e-15)
        tenths = pyroclast.Specimen.from_arrays([[0.1, 0], [17.3, 0], [0.1, 20]], [[0, 1, 2]], ["mortar"], unit="mm")
        np.testing.assert_array_equal(tenths.vertices[:2, 0], [0.0001, 0.0173])
        for unit, told in (("s", "unit: .*length"), ("1", "unit"), (0 * mm, "unit is .* greater than 0"),
                           (3, "unit of")):
            self.refused(told, unit=unit)

    def test_an_outline_that_is_too_small_or_too_large_is_warned_of(self):
        for size, unit in ((20.0, "m"), (0.02, "mm")):
            with self.assertWarnsRegex(UserWarning, f"usually it is between .*vertices are in {unit}") as warned:
                made = pyroclast.Specimen.from_arrays(squares(size), SQUARES, ["mortar"] * 8, unit=unit)
            self.assertEqual(warned.filename, __file__)
        on_it = plate()
        on_it["specimen"] = made
        self.assertRegex("\n".join(map(str, on_it.check())),
                         "specimen.file.*the outline is 6e-05 m wide and 6e-05 m high")
        folder = self.folder()
        corners = {"phases": ["mortar"], "cells": [[0, 1, 2, 3]], "phase": [0]}
        (folder / "mm.json").write_text(json.dumps(
            {**corners, "vertices_m": [[0, 0], [100, 0], [100, 200], [0, 200]]}))
        body = pyroclast.Deck.from_text(HEATED.format('shape = "cells"\nfile = "mm.json"'), folder=folder)
        self.assertRegex(str(body.check()[0]), "100 m wide and 200 m high.*vertices_mm")
        (folder / "mm.json").write_text(json.dumps(
            {**corners, "vertices_mm": [[0, 0], [100, 0], [100, 200], [0, 200]]}))
        self.assertEqual(body.check(), [])
        self.assertAlmostEqual(body.make_specimen().extent, 0.02)
        wide = pyroclast.Deck.from_text(HEATED.format(
            'shape = "polygon"\nseed = 1\ncorners = [["0 m", "0 m"], ["20 m", "0 m"], ["0 m", "1 m"]]\n'
            '[blocks]\ncount = 40\nshortest_edge = 0.2'))
        self.assertRegex(str(wide.check()[0]), "specimen.corners.*20 m wide")

    def test_labels_of_any_shape_with_one_for_each_cell(self):
        numbers = np.arange(8) % 2
        straight = pyroclast.Specimen.from_arrays(squares(), SQUARES, numbers, {0: "a", 1: "b"}, unit="m")
        for labels in (numbers[:, None], numbers[None], [[n] for n in numbers.tolist()], list(numbers[:, None])):
            made = pyroclast.Specimen.from_arrays(squares(), SQUARES, labels, {0: "a", 1: "b"}, unit="m")
            np.testing.assert_array_equal(made.phase, straight.phase)
        self.refused(r"labels of 16, in shape \(8, 2\)", labels=np.zeros((8, 2)), phases={0: "a"})
        self.refused("cell 0 .from 0. has the label", labels=[[1, 2]] * 8, phases={1: "a"})

    def test_pieces_are_told_and_joined_on_request(self):
        apart = np.vstack([squares(), squares()])
        cells = [*SQUARES[:5], *(np.array(SQUARES[5:]) + 16)]
        self.refused(r"are 2 pieces .*cell 5 \(from 0\) at \(0.01, 0.05\) m is of .* 3 cells; .*coincide.*join =",
                     vertices=apart, cells=cells)
        for join in ("1 um", 1e-3 * mm):
            made = pyroclast.Specimen.from_arrays(apart, cells, ["mortar"] * 8, unit="m", join=join)
            self.assertEqual((made.sides[-1], len(made.vertices)), ("hole_1", 16))
        folder = self.folder()
        (folder / "two.json").write_text(json.dumps(
            {"phases": ["mortar"], "vertices_m": apart.tolist(), "cells": np.array(cells).tolist(), "phase": [0] * 8}))
        self.assertEqual(pyroclast.Specimen.read(folder / "two.json", join="1 um").sides[-1], "hole_1")
        with self.assertRaisesRegex(pyroclast.Error, "two.json: the cells are 2 pieces"):
            pyroclast.Specimen.read(folder / "two.json")
        text = 'shape = "cells"\nfile = "two.json"'
        with self.assertRaisesRegex(pyroclast.DeckError, "specimen.file = .*2 pieces"):
            pyroclast.Deck.from_text(HEATED.format(text), folder=folder).check()
        pyroclast.Deck.from_text(HEATED.format(text + '\njoin = "1 um"'), folder=folder).check()
        self.refused("join", join=1e-6)
        self.refused("cell 0 .* two corners", join="25 mm")

    def test_facets_of_the_plane_are_edges_with_the_block_on_their_left_first(self):
        made = plate().make_specimen()
        self.assertEqual((made.dimension, made.shape, made.size), (2, "cells", (0.06, 0.04)))
        corners = [cell.tolist() for cell in made.cells]
        for (start, end), (first, second) in zip(made.facets, made.neighbours):
            self.assertEqual(corners[first][(corners[first].index(start) + 1) % len(corners[first])], end)
            if second >= 0:
                self.assertEqual(corners[second][corners[second].index(start) - 1], end)
        self.assertEqual(np.bincount(made.neighbours[made.neighbours >= 0]).tolist(), [len(cell) for cell in corners])
        self.assertEqual(made.stones.shape[1], 3)

    def test_a_run_of_them_is_made_again_from_its_folder(self):
        made = plate().make_specimen()
        again = pyroclast.Specimen.from_arrays(made.vertices, made.cells, [made.phases[i] for i in made.phase],
                                                 unit="m")
        of_cells = plate()
        of_cells["specimen"] = again
        self.assertEqual(of_cells["specimen"], {"shape": "cells", "file": "cells.json", "thickness": 0.1 * m})
        of_cells.check()
        np.testing.assert_array_equal(of_cells.make_specimen().vertices, made.vertices)
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
        self.assertEqual(len(pyroclast.Deck(folder / "saved.toml").make_specimen().phase), 40)
        other = of_cells.copy()
        other["title"] = "other"
        other.save(folder / "other.toml")  # into the same folder: neither takes the blocks of the other
        self.assertEqual(sorted(file.name for file in folder.glob("*_cells.json")),
                         ["other_cells.json", "saved_cells.json"])

    def test_platens_and_bearings_lie_on_them(self):
        starter = deck()
        of_cells = deck()
        made = starter.make_specimen()
        of_cells["specimen"] = pyroclast.Specimen.from_arrays(made.vertices, made.cells, made.phase,
                                                              dict(enumerate(made.phases)), unit="m", stone=made.stone)
        runs = [pyroclast.Run(d, threads=1).until(strain=1e-4) for d in (starter, of_cells)]
        self.assertEqual(runs[0].stress, runs[1].stress)
        seat = {"name": "seat", "at": ["31 mm", "0 mm"], "width": "23 mm", "thickness": "6 mm", "contact": "glued"}
        on_bearing = plate(bearings=[seat], stages=[{"kind": "drive", "duration": "1 ms", "drives": [
            {"set": "seat_support", "hold": ["x", "y"]}]}])
        made = plate().make_specimen()
        on_bearing["specimen"] = pyroclast.Specimen.from_arrays(made.vertices, made.cells, ["mortar"] * 40, unit="m")
        on_bearing["materials.platen"] = starter["materials.platen"]
        run = pyroclast.Run(on_bearing, threads=1)
        face = run.position[run.sets["seat_face"], 0]
        ends = made.vertices[made.vertices[:, 1] == 0.0, 0]
        for end, asked in ((face.min(), 19.5e-3), (face.max(), 42.5e-3)):
            self.assertEqual(end, ends[np.abs(ends - asked).argmin()])

    def test_what_belongs_to_another_specimen_is_refused(self):
        made = plate()
        made["specimen"] = plate().make_specimen()
        with self.assertRaisesRegex(pyroclast.DeckError, "blocks.*no effect"):
            made.copy().update(blocks={"count": 9}).check()
        with self.assertRaisesRegex(pyroclast.Error, "seed has no meaning"):
            pyroclast.Run(made, seed=2)
        other = made.copy()
        other["superposition.matrix"] = "paste"
        with self.assertRaisesRegex(pyroclast.DeckError, "none is the matrix"):
            other.check()
        with self.assertRaisesRegex(pyroclast.Error, 'belongs to "specimen"'):
            made["materials"] = plate().make_specimen()

    def test_a_file_that_holds_no_cells_is_told_with_its_name(self):
        good = {"phases": ["mortar"], "vertices_m": squares().tolist(), "cells": SQUARES, "phase": [0] * 8}
        file = self.folder() / "mine.json"
        for change, told in (({"cells": [[0, 1.5, 2]]}, r"mine.json: cells\[0\]"), ({"phase": None}, 'no list "phase"'),
                             ({"vertices_m": [[0, 0, 0]]}, r"vertices_m\[0\]: must be a place"),
                             ({"cells": [[0, 1, 1e300]]}, r"cells\[0\]"), ({"phases": [3]}, r"phases\[0\]"),
                             ({"phase": [0] * 7 + [5]}, "cell 7 .from 0. is of phase 5")):
            file.write_text(json.dumps({**good, **change}))
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.read(file)
        for text in ("{", "[]"):
            file.write_text(text)
            with self.assertRaisesRegex(pyroclast.Error, "mine.json: is no"):
                pyroclast.Specimen.read(file)
        dented = squares()
        dented[0] = [0.019, 0.019]
        for change, told in (({"vertices_m": dented.tolist()}, r"mine.json: cell 0 \(from 0\) .*not convex"),
                             ({"vertices_mm": []}, 'mine.json: .*"vertices_m" and "vertices_mm"; only one')):
            file.write_text(json.dumps({**good, **change}))
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.read(file)
        file.write_text(json.dumps({**good, "vertices_m": None, "vertices_s": good["vertices_m"]}))
        with self.assertRaisesRegex(pyroclast.Error, 'mine.json: .*only one'):
            pyroclast.Specimen.read(file)
        del good["vertices_m"]
        file.write_text(json.dumps({**good, "vertices_s": squares().tolist()}))
        with self.assertRaisesRegex(pyroclast.Error, 'mine.json: "vertices_s": .*length'):
            pyroclast.Specimen.read(file)
        file.write_text(json.dumps({**good, "vertices_mm": squares(20).tolist()}))
        np.testing.assert_array_equal(pyroclast.Specimen.read(file).vertices[:4, 0], [0.0, 0.02, 0.04, 0.06])
        file.write_text(json.dumps({**good, "vertices_m": squares().tolist()}))
        self.assertEqual(pyroclast.Specimen.read(file).sides[-1], "hole_1")


class Tessellations(Case):
    def of(self, tess, specimen='shape = "tessellation"\nwidth = "100 mm"\nseed = 1', blocks="", more=""):
        """A deck with the blocks of a .tess file."""
        folder = self.folder()
        (folder / "a.tess").write_text(tess, encoding="utf-8")
        text = f'{specimen}\n[blocks]\nfile = "a.tess"\nshortest_edge = 0.0\n{blocks}\n{more}'
        return pyroclast.Deck.from_text(HEATED.format(text), "a.toml", folder)

    def refused(self, told, *args, **more):
        with self.assertRaisesRegex(pyroclast.DeckError, told):
            self.of(*args, **more).check()

    def test_a_tilted_plane_is_laid_flat(self):
        tilted = TESS
        for x in (2, 1, 0):
            tilted = tilted.replace(f" {x} 1 0 ", f" {x} 0.707106781187 0.707106781187 ")
        self.assertNotEqual(tilted, TESS)
        made = self.of(tilted).make_specimen()
        np.testing.assert_allclose(np.ptp(made.vertices, axis=0), [0.1, 0.05], rtol=1e-11)

    def test_groups_are_phases(self):
        grouped = TESS.replace("**cell\n  2", "**cell\n  2\n  *group\n   1 7")
        self.refused(r"blocks.file.*line 8 of the file .*groups 1, 7: groups = .* 2 names", grouped)
        self.refused("blocks.groups.*so 2 names are needed, got 1", grouped, blocks='groups = ["mortar"]')
        self.refused("blocks.groups.*into no groups", TESS, blocks='groups = ["mortar"]')
        self.refused("blocks.groups.*none is the matrix", grouped, blocks='groups = ["paste", "stone"]')
        stone = "[materials.stone]\n" + HEATED.split("[materials.mortar]\n")[1].split("[heat]")[0]
        made = self.of(grouped, blocks='groups = ["mortar", "stone"]', more=stone).make_specimen()
        self.assertEqual(made.phases, ["mortar", "stone"])
        self.assertAlmostEqual(made.shares["stone"], 0.5)
        of_stone = made.cells[made.phase.tolist().index(1)]
        self.assertAlmostEqual(made.vertices[of_stone, 0].min(), 0.05)
        self.assertEqual(self.of(grouped, blocks='groups = ["mortar", "mortar"]').make_specimen().phases,
                         ["mortar"])
        run = pyroclast.Run(self.of(grouped, blocks='groups = ["mortar", "stone"]', more=stone))
        self.assertEqual(len(run.specimen.phase), 2)

    def test_groups_beside_circles_are_warned_of(self):
        grouped = TESS.replace("**cell\n  2", "**cell\n  2\n  *group\n   1 2")
        circles = ('[aggregates]\nfraction = 0.0\nd_min = "5 mm"\nd_max = "10 mm"\nfuller_exponent = 0.45\n'
                   'minimum_gap = "1 mm"\nsieves = ["8 mm"]\n[superposition]\nrule = "area"\ncovered_fraction = 0.5\n'
                   "[materials.aggregate]\n" + HEATED.split("[materials.mortar]\n")[1].split("[heat]")[0])
        self.assertIn("have no effect", "\n".join(map(str, self.of(grouped, more=circles).check())))
        self.refused("blocks.groups.*beside .aggregates.", grouped, more=circles, blocks='groups = ["mortar", "stone"]')

    def test_a_periodic_one_is_refused_with_the_remedy(self):
        self.refused("a.tess, line 5: .*periodic.*without -periodicity", TESS.replace("standard", "periodic"))

    def test_a_byte_order_mark_is_no_part_of_the_file(self):
        self.assertEqual(len(self.of("\ufeff" + TESS).make_specimen().cells), 2)

    def test_a_unit_says_how_large_it_is(self):
        in_cm = 'shape = "tessellation"\nunit = "cm"\nseed = 1'
        np.testing.assert_allclose(np.ptp(self.of(TESS, in_cm).make_specimen().vertices, axis=0), [0.02, 0.01])
        self.assertRegex(str(self.of(TESS, in_cm.replace("cm", "mm")).check()[0]), "specimen.unit.*0.002 m wide")
        self.refused("specimen.unit.*length", TESS, in_cm.replace("cm", "s"))
        self.refused("specimen.width.*no effect", TESS, in_cm + '\nwidth = "10 mm"')


class Meshes(Case):
    def test_a_mesh_of_polygons_comes_back(self):
        made = plate().make_specimen()
        again = pyroclast.Specimen.from_meshio(made.to_meshio(), "phase", dict(enumerate(made.phases)), unit="m")
        self.assertEqual(sorted(map(len, again.cells)), sorted(map(len, made.cells)))
        self.assertAlmostEqual(again.extent, made.extent, places=12)

    def test_triangles_and_quads_with_lines_and_spare_points(self):
        points = np.column_stack([np.vstack([[[9.0, 9.0]], squares()]), np.zeros(17)])
        cells = [("line", np.array([[1, 2]])), ("quad", np.array(SQUARES[1:]) + 1),
                 ("triangle", np.array([[1, 2, 6], [1, 6, 5]]))]
        mesh = meshio.Mesh(points, cells, cell_data={"kind": [[7], [1] * 7, [2, 2]]})
        made = pyroclast.Specimen.from_meshio(mesh, "kind", {1: "mortar", 2: "stone"}, unit="m")
        self.assertAlmostEqual(made.shares["stone"], 1 / 8)
        for change, told in (({"data": "sort"}, "no cell data 'sort'; it has cell data kind"),
                             ({"phases": {1: "mortar"}}, "label 2")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_meshio(**{"mesh": mesh, "data": "kind", "phases": {1: "a", 2: "b"},
                                                      "unit": "m", **change})
        points[3, 2] = 0.01
        with self.assertRaisesRegex(pyroclast.Error, "plane"):
            pyroclast.Specimen.from_meshio(meshio.Mesh(points, cells, cell_data=mesh.cell_data), "kind", {}, unit="m")
        solid = meshio.Mesh(points, [("tetra", np.array([[0, 1, 2, 3]]))], cell_data={"kind": [[1]]})
        with self.assertRaisesRegex(pyroclast.Error, "lies on no side"):
            pyroclast.Specimen.from_meshio(solid, "kind", {1: "mortar"}, unit="m")


    def two_quads(self, **more) -> meshio.Mesh:
        points = 0.1 * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]])
        return meshio.Mesh(points, more.pop("cells", [("quad", np.array([[0, 1, 2, 3], [1, 4, 5, 2]]))]), **more)

    def of_stone(self, *args, **more) -> float:
        """Where the stone begins, m."""
        made = pyroclast.Specimen.from_meshio(*args, unit="m", **more)
        return float(made.vertices[made.cells[made.phases.index("stone")], 0].min())

    def test_cell_data_with_a_column_of_their_own(self):
        mesh = self.two_quads(cell_data={"l": [np.array([[1], [2]])]})
        self.assertEqual(self.of_stone(mesh, "l", {1: "mortar", 2: "stone"}), 0.1)
        three = self.two_quads(cell_data={"l": [np.zeros((2, 3))]})
        with self.assertRaisesRegex(pyroclast.Error, "'l' have 3 numbers for each cell"):
            pyroclast.Specimen.from_meshio(three, "l", {0: "mortar"}, unit="m")

    def test_cell_sets_are_phases(self):
        mesh = self.two_quads(cell_sets={"paste": [np.array([0])], "stone": [np.array([1])]})
        self.assertEqual(self.of_stone(mesh), 0.1)
        self.assertEqual(self.of_stone(mesh, phases={"paste": "mortar", "stone": "stone"}), 0.1)
        for told, more in (("no cell data 'paste'; it has cell sets paste, stone; leave data out", {"data": "paste"}),
                           ("cell 1 .from 0. is in none of the cell sets paste", {"phases": {"paste": "mortar"}}),
                           ("no cell set 'x'; it has paste, stone", {"phases": {"paste": "mortar", "x": "y"}}),
                           ("nothing that names .* it has cell sets paste, stone; phases has 1", {"phases": {1: "a"}})):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_meshio(mesh, unit="m", **more)
        both = self.two_quads(cell_sets={"all": [np.array([0, 1])], "stone": [np.array([1])]})
        with self.assertRaisesRegex(pyroclast.Error, "cell 1 .from 0. is in the cell sets 'all' and 'stone'"):
            pyroclast.Specimen.from_meshio(both, unit="m")
        with self.assertRaisesRegex(pyroclast.Error, "it has cell data l; data='l' takes cell data"):
            pyroclast.Specimen.from_meshio(self.two_quads(cell_data={"l": [[1, 1]]}), phases={1: "mortar"}, unit="m")
        with self.assertRaisesRegex(pyroclast.Error, "nothing that names the phases of its cells; it has no cell data"):
            pyroclast.Specimen.from_meshio(self.two_quads(), unit="m")

    def test_elsets_of_abaqus_and_physical_names_of_gmsh(self):
        folder = self.folder()
        (folder / "sets.inp").write_text("*NODE\n1, 0, 0, 0\n2, 0.1, 0, 0\n3, 0.1, 0.1, 0\n4, 0, 0.1, 0\n5, 0.2, 0, 0\n"
                                         "6, 0.2, 0.1, 0\n*ELEMENT, TYPE=CPS4, ELSET=PASTE\n1, 1, 2, 3, 4\n"
                                         "*ELEMENT, TYPE=CPS4, ELSET=STONE\n2, 2, 5, 6, 3\n")
        mesh = meshio.read(folder / "sets.inp")
        self.assertEqual(self.of_stone(mesh, phases={"PASTE": "mortar", "STONE": "stone"}), 0.1)
        groups = {"bottom": np.array([3, 1]), "paste": np.array([1, 2]), "stone": np.array([2, 2])}
        cells = [("line", np.array([[0, 1]])), ("quad", np.array([[0, 1, 2, 3], [1, 4, 5, 2]]))]
        mesh = self.two_quads(cells=cells, cell_data={"gmsh:physical": [np.array([3]), np.array([1, 2])]},
                              field_data=groups)
        for more in ({}, {"data": "gmsh:physical"}, {"phases": {"paste": "mortar", "stone": "stone"}},
                     {"phases": {1: "mortar", 2: "stone"}}):
            self.assertEqual(self.of_stone(mesh, **more), 0.1)

    def test_of_cells_of_higher_order_the_corners_count(self):
        points = 0.1 * np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [4, 0], [3, 0],
                                 [3, 1]])
        cells = [("quad8", np.array([[0, 1, 2, 3, 4, 5, 6, 7]])), ("triangle6", np.array([[1, 8, 2, 9, 10, 5]])),
                 ("line3", np.array([[0, 1, 4]]))]
        made = pyroclast.Specimen.from_meshio(meshio.Mesh(points, cells, cell_data={"k": [[1], [1], [1]]}), "k",
                                              {1: "mortar"}, unit="m")
        self.assertEqual(sorted(map(len, made.cells)), [3, 4])
        self.assertAlmostEqual(made.extent, 0.06)

    def test_a_mesh_in_mm(self):
        mesh = self.two_quads(cell_data={"l": [[1, 1]]})
        mesh.points = mesh.points * 1000.0
        self.assertAlmostEqual(pyroclast.Specimen.from_meshio(mesh, "l", {1: "mortar"}, unit="mm").extent, 0.02)
        with self.assertWarnsRegex(UserWarning, "200 m wide and 100 m high.*points of the mesh are in m"):
            pyroclast.Specimen.from_meshio(mesh, "l", {1: "mortar"}, unit="m")


class Images(Case):
    def image(self, rows=120, columns=60) -> np.ndarray:
        """A stone of 30 % of the area in the upper half, in mortar."""
        y, x = np.mgrid[0:rows, 0:columns] + 0.5
        return (np.hypot(x - 0.5 * columns, y - 0.3 * rows) < 0.31 * columns).astype(int)

    def test_blocks_are_of_the_phase_of_most_of_their_pixels(self):
        image = self.image()
        made = pyroclast.Specimen.from_image(image, 1 * mm, {0: "mortar", 1: "stone"}, blocks=400)
        self.assertEqual(made.sides, ["bottom", "right", "top", "left"])
        self.assertAlmostEqual(made.extent, 0.06 * 0.12, places=12)
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
        self.assertAlmostEqual(made.extent, 1e-6 * np.pi * (38.0**2 - 9.0**2), delta=0.03 * 4.3e-3)
        self.assertEqual([side for side in made.sides if side.startswith("hole")], ["hole_1"])
        self.assertAlmostEqual(made.shares["stone"] * made.extent, 1e-6 * np.pi * 14.0**2, delta=0.1 * 6e-4)
        speckled = np.where(np.random.default_rng(2).random((60, 60)) < 0.25, 0, 1)
        pyroclast.Specimen.from_image(speckled, "1 mm", {0: None, 1: "mortar"}, blocks=1500)

    def test_a_file_is_opened_by_its_name(self):
        from PIL import Image
        folder, image, names = self.folder(), self.image().astype(np.uint8), {0: "mortar", 1: "stone"}
        straight = pyroclast.Specimen.from_image(image, 1 * mm, names, blocks=100)
        np.save(folder / "slice.npy", image)
        Image.fromarray(image).save(folder / "slice.png")
        Image.fromarray(image.astype(np.int32)).save(folder / "slice.tif")
        with_palette = Image.fromarray(image).convert("P")
        with_palette.putpalette([255, 0, 0, 0, 255, 0])
        with_palette.save(folder / "palette.png")
        Image.fromarray(image.astype(bool)).save(folder / "bits.png")
        for name in ("slice.npy", "slice.png", "slice.tif", "bits.png"):
            made = pyroclast.Specimen.from_image(folder / name, 1 * mm, names, blocks=100)
            np.testing.assert_array_equal(made.phase, straight.phase)
        made = pyroclast.Specimen.from_image(str(folder / "palette.png"), 1 * mm, names, blocks=100)
        np.testing.assert_array_equal(made.phase, straight.phase)
        Image.fromarray(np.zeros((9, 9, 3), np.uint8)).save(folder / "colours.png")
        Image.fromarray(image).save(folder / "pages.tif", save_all=True, append_images=[Image.fromarray(image)])
        (folder / "broken.png").write_text("no picture")
        (folder / "broken.npy").write_text("no array")
        for name, told in (("colours.png", "colours.png: its pixels are RGB"), ("pages.tif", "holds 2 pages"),
                           ("broken.png", "broken.png: "), ("broken.npy", "broken.npy: "), ("none.png", "No such file"),
                           ("slice.jpg", "read from .npy, .png, .tif")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_image(folder / name, 1 * mm, names, blocks=100)

    def test_a_picture_is_turned_as_its_tag_orientation_says(self):
        from PIL import Image
        folder = self.folder()
        image = np.arange(6, dtype=np.uint8).reshape(2, 3)
        turned = {1: image, 2: image[:, ::-1], 3: image[::-1, ::-1], 4: image[::-1], 5: image.T, 6: np.rot90(image, -1),
                  7: image[::-1, ::-1].T, 8: np.rot90(image)}  # TIFF 6.0, page 36
        for orientation, right in turned.items():
            exif = Image.Exif()
            exif[274] = orientation
            saved = {"raw.tif": {"tiffinfo": {274: orientation}}, "slice.png": {"exif": exif},
                     "packed.tif": {"tiffinfo": {274: orientation}, "compression": "tiff_lzw"}}
            for name, how in saved.items():
                for pixels in (image, image.astype(np.int32)):
                    Image.fromarray(pixels).save(folder / name, **how)
                    with self.subTest(orientation=orientation, name=name, type=pixels.dtype):
                        np.testing.assert_array_equal(label_image.pixels_of(folder / name)[0], right)
        Image.fromarray(self.image().astype(np.uint8)).save(folder / "side.tif", tiffinfo={274: 6})
        made = pyroclast.Specimen.from_image(folder / "side.tif", 1 * mm, {0: "mortar", 1: "stone"}, blocks=400)
        self.assertGreater(made.agreement, 0.96)

    def test_a_picture_that_does_not_keep_labels_is_refused_whatever_its_name(self):
        from PIL import Image
        picture = self.folder() / "slice.png"
        Image.fromarray(self.image().astype(np.uint8)).save(picture, format="JPEG")
        with self.assertRaisesRegex(pyroclast.Error, "slice.png: it holds JPEG"):
            pyroclast.Specimen.from_image(picture, 1 * mm, {0: "a", 1: "b"}, blocks=50)

    def watershed(self) -> np.ndarray:
        """Four stones, 1 to 4, that touch in the middle of 40 x 40 pixels of 0."""
        y, x = np.mgrid[-20:20, -20:20] + 0.5
        return np.where(np.hypot(x, y) < 14.0, 1 + 2 * (y > 0.0) + (x > 0.0), 0).astype(int)

    def test_many_labels_are_one_phase_and_each_is_a_stone(self):
        image = self.watershed()
        for phases in ({0: "mortar", ...: "stone"}, {0: "mortar", range(1, 5): "stone"}, {(1, 2, 3, 4): "stone", ...: "mortar"},
                       {0: "mortar", 1: "stone", 2: "stone", 3: "stone", 4: "stone"}):
            with self.subTest(phases=phases):
                made = pyroclast.Specimen.from_image(image, "1 mm", phases, blocks=300)
                middle = np.array([made.vertices[cell].mean(axis=0) for cell in made.cells]) * 1e3
                label = image[39 - middle[:, 1].astype(int), middle[:, 0].astype(int)]
                is_stone = np.array([made.phases[i] == "stone" for i in made.phase])
                alike = (made.stone - made.stone[is_stone].min() + 1 == label)[is_stone]
                self.assertGreater(alike.mean(), 0.9)
                self.assertEqual(len(set(made.stone[is_stone])), 4)
        self.assertIsNone(pyroclast.Specimen.from_image(np.minimum(image, 1), "1 mm", {0: "mortar", 1: "stone"},
                                                        blocks=100).stone)

    def test_cracks_may_run_between_the_stones_of_a_watershed(self):
        made = pyroclast.Specimen.from_image(self.watershed(), "2.5 mm", {0: "mortar", ...: "aggregate"}, blocks=120)
        whole, parted = deck(), deck()
        whole["contacts.aggregate_mortar.between_stones"] = []
        counts = []
        for one in (whole, parted):
            one["specimen"] = made
            counts.append((pyroclast.Run(one, threads=1).contacts()["interface"] == "aggregate_mortar").sum())
        self.assertGreater(counts[1], counts[0] + 5)

    def test_labels_are_whole_numbers_or_texts_and_have_one_name(self):
        image = self.image()
        texts = np.where(image, "stone", "matrix")
        names = {0: "a", 1: "b"}
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # NumPy warns of numbers that are compared with texts
            made = pyroclast.Specimen.from_image(texts, "1 mm", {"matrix": "a", "stone": "b"}, blocks=50)
            whole = pyroclast.Specimen.from_image(image.astype(np.float32), "1 mm", names, blocks=50)
            np.testing.assert_array_equal(made.phase, whole.phase)
            for pixels, phases, told in (
                    (texts, names, "the label 'matrix', for which there is no phase"),
                    (image, {"0": "a", "1": "b"}, "the label 0, for which there is no phase.*phases has '0', '1'"),
                    (0.5 * image, {0: "a", 0.5: "b"}, r"pixel \[\d+, \d+\] is 0.5, but labels must be whole numbers"),
                    (np.where(image, np.inf, 0.0), names, "is inf, but labels must be whole"),
                    (image + 0j, names, "of the type complex128"),
                    (image, {range(2): "a", 1: "b"}, r"names the label 1 twice: by 1 and by range\(0, 2\)"),
                    (image, {0: "a", ...: 1}, r"phases: ... has the phase 1; it must be a name"),
                    (image, {(0, 2): "a"}, r"label 1, .*phases has \(0, 2\)")):
                with self.subTest(told), self.assertRaisesRegex(pyroclast.Error, told):
                    pyroclast.Specimen.from_image(pixels, "1 mm", phases, blocks=50)

    def test_masked_pixels_and_nan_are_told(self):
        image = self.image().astype(float)
        image[7, 5:8] = np.nan
        for pixels, told in ((image, r"3 of 7200 pixels are NaN, the first is \[7, 5\].*label of their own"),
                             (np.ma.masked_invalid(image), r"3 of 7200 pixels are masked, .*\[7, 5\].*filled"),
                             (image[:, :6], r"1 of 720 pixels is NaN")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_image(pixels, 1 * mm, {0: "mortar", 1: "stone"}, blocks=50)
        whole = np.ma.array(self.image(), mask=False)
        self.assertEqual(len(pyroclast.Specimen.from_image(whole, 1 * mm, {0: "a", 1: "b"}, blocks=50).cells), 50)

    def test_labels_are_counted(self):
        image = self.image()
        image[100, 30] = 7
        stones = np.count_nonzero(image == 1)
        with self.assertRaisesRegex(pyroclast.Error, rf"pixel \[100, 30\] has the label 7.*1 of 7200 pixels have none.*"
                                                     rf"{stones} pixels\), 7 \(1 pixel\); phases has 0, 1"):
            pyroclast.Specimen.from_image(image, 1 * mm, {0: "mortar", 1: "stone"}, blocks=50)
        with self.assertRaisesRegex(pyroclast.Error, "and 7190 others"):
            pyroclast.Specimen.from_image(np.arange(7200).reshape(120, 60), 1 * mm, {0: "a"}, blocks=50)

    def test_a_phase_of_one_pixel_is_warned_of_and_does_not_fail(self):
        image = self.image()
        image[100, 30] = 2
        with self.assertWarnsRegex(UserWarning, "phase 'pore' is of 1 pixel and of no block") as warned:
            made = pyroclast.Specimen.from_image(image, 1 * mm, {0: "mortar", 1: "stone", 2: "pore"}, blocks=100)
        self.assertEqual(warned.filename, __file__)
        self.assertEqual((made.phases, made.shares["pore"]), (["mortar", "stone", "pore"], 0.0))

    def test_the_size_of_pixels_is_checked(self):
        for pixel, told in (("0 mm", "pixel is 0 mm; it must be greater than 0"), (-1 * mm, "greater than 0"),
                            ("nan mm", "pixel: .*not finite")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_image(self.image(), pixel, {0: "a", 1: "b"}, blocks=50)
        for pixel in ("1 m", "1 um"):
            with self.assertWarnsRegex(UserWarning, f"usually .*: the image has 60 x 120 pixels of {pixel}"):
                pyroclast.Specimen.from_image(self.image(), pixel, {0: "a", 1: "b"}, blocks=50)

    def test_what_is_wrong_is_told(self):
        for image, pixel, phases, told in (
                (self.image(), 1e-3, {0: "a", 1: "b"}, "a unit of length is needed"),
                (self.image(), "1 s", {0: "a", 1: "b"}, "length"),
                (self.image(), "1 mm", {0: "a"}, r"pixel \[\d+, \d+\] has the label 1"),
                (self.image()[0], "1 mm", {0: "a"}, "rows, columns"),
                (np.zeros((9, 9)), "1 mm", {0: None}, "nothing in the image")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_image(image, pixel, phases, blocks=50)
