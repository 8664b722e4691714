"""A cylinder in space by deck: what its run keeps, what VTK and the package read of it, and how it is cut."""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
import pyroclast
from pyroclast.draw import solid_sections
from pyroclast.stored import cut
from pyroclast.stored.mesh import specimen_box

PROGRAM = os.environ["PYROCLAST"]
CASES = pathlib.Path(__file__).parents[2] / "cases"
DIAMETER, HEIGHT = 0.1, 0.2
CHANGES = ("blocks.count=150", "blocks.shortest_edge=0", "aggregates.fraction=0.2", "aggregates.d_min=20 mm",
           "aggregates.sieves=[]", "stages[1].stop_strain=1.2e-3",
           "stages[1].ramp_time=2 ms", "stages[1].velocity=4 mm/s", "output.history_strain=2e-5",
           "output.frame_strain=6e-4")


def words(changes) -> list[str]:
    return [word for change in changes for word in ("--set", change)]


class Cylinder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.place)
        cls.done = cls.run_deck("out")
        assert cls.done.returncode == 0, cls.done.stderr
        cls.results = pyroclast.read(cls.place / "out")
        cls.summary = json.loads((cls.place / "out/summary.json").read_text())

    @classmethod
    def run_deck(cls, out: str, *more: str) -> subprocess.CompletedProcess:
        return subprocess.run([PROGRAM, "run", CASES / "starter_3d.toml", "--out", out, *words(CHANGES), *more],
                              cwd=cls.place, capture_output=True, text=True, timeout=300, check=False)

    def read(self, name: str):
        from vtkmodules.vtkIOHDF import vtkHDFReader  # pylint: disable=import-outside-toplevel

        reader = vtkHDFReader()
        reader.SetFileName(str(self.place / "out/fields" / name))
        reader.Update()
        return reader.GetOutput()

    def test_vtk_reads_tetrahedra_and_contact_faces(self):
        blocks, contacts = self.read("blocks_0002.hdf"), self.read("contacts_0002.hdf")
        self.assertEqual({blocks.GetCellType(i) for i in range(blocks.GetNumberOfCells())}, {10})
        self.assertEqual({contacts.GetCellType(i) for i in range(contacts.GetNumberOfCells())}, {9})
        mesh = self.results.mesh
        self.assertEqual(blocks.GetNumberOfCells(), len(mesh.blocks.zones))
        self.assertEqual(contacts.GetNumberOfCells(), len(mesh.contacts.cells))
        data = contacts.GetCellData()
        area, damage = data.GetArray("area [m2]"), data.GetArray("mixed_damage [1]")
        self.assertGreater(damage.GetRange()[1], 0.0)
        # the cells of a face fill it, as the areas of its contact points do
        x = mesh.contacts.points[mesh.contacts.cells]
        shown = 0.5 * np.linalg.norm(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1)
        whole = sum(area.GetTuple1(i) for i in range(contacts.GetNumberOfCells()))
        self.assertAlmostEqual(shown.sum() / whole, 1.0, delta=1e-9)
        moved = contacts.GetPointData().GetArray("displacement [m]")
        self.assertEqual((moved.GetNumberOfTuples(), moved.GetNumberOfComponents()), (4 * len(mesh.contacts.cells), 3))

    def test_zones_fill_the_cylinder(self):
        blocks = self.results.mesh.blocks
        volume = math.pi / 4.0 * DIAMETER**2 * HEIGHT
        self.assertAlmostEqual(blocks.sizes[~blocks.of_bearing].sum() / volume, 1.0, delta=1e-12)
        self.assertTrue((blocks.sizes > 0.0).all())

    def test_the_stress_is_over_the_circle(self):
        loaded = self.results.history["stress_MPa"]
        self.assertGreater(loaded.max(), 10.0)
        self.assertAlmostEqual(self.summary["specimen"]["fraction"]["aggregate"], 0.20, delta=0.02)
        self.assertIn("area_m2", self.summary["cracks"]["mixed_mortar_mortar"])

    def test_a_plane_cuts_the_area_of_the_section(self):
        blocks = self.results.mesh.blocks
        for axis, share, area in (("y", 0.37, math.pi / 4.0 * DIAMETER**2), ("z", 0.5, None)):
            polygons = cut.section(blocks, solid_sections.axis_plane(blocks, axis, share))
            within = polygons.of(~blocks.of_bearing[polygons.owner])
            found = np.linalg.norm(within.area_vectors, axis=1).sum()
            if area is None:  # through the axis: the polygon of the circle is as wide as it is there
                self.assertAlmostEqual(found, DIAMETER * HEIGHT, delta=0.02 * DIAMETER * HEIGHT)
            else:
                self.assertAlmostEqual(found, area, delta=1e-9 * area)

    def test_a_corner_is_cut_away_and_the_rest_is_closed(self):
        blocks = self.results.mesh.blocks
        planes = solid_sections.middle_planes(blocks, (0.4, 0.6))
        whole, cuts = cut.without_corner(blocks, planes)
        for polygons in (whole, cuts):
            for plane, other in (planes, planes[::-1]):
                above = (plane.above(polygons.corners).min(axis=1) > 1e-9) & (
                    other.above(polygons.corners).min(axis=1) > 1e-9)
                self.assertFalse(above.any())
        # area vectors of a closed surface sum to zero; cuts are walked in either sense
        outward = whole.area_vectors.sum(axis=0)
        normals = np.abs(cuts.area_vectors).sum(axis=0)
        self.assertAlmostEqual(outward[1], 0.0, delta=1e-12)
        self.assertAlmostEqual(abs(outward[0]), normals[0], delta=1e-9)
        self.assertAlmostEqual(abs(outward[2]), normals[2], delta=1e-9)

    def test_cracks_show_on_the_sides_and_cuts_that_a_view_sees(self):
        mesh = self.results.mesh
        cells = mesh.contacts.points[mesh.contacts.cells]
        for signs in ([1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, -1.0]):
            view = solid_sections.View(solid_sections.VIEW.towards_eye * signs)
            lines = solid_sections.crack_lines(mesh, cells, np.ones(len(cells), bool), view)
            at = lines.mean(axis=1)
            above = [plane.above(at) > 1e-9 for plane in solid_sections.middle_planes(mesh.blocks, view=view)]
            self.assertFalse((above[0] & above[1]).any(), signs)  # where nothing is left
            low, high = (end[[0, 2]] for end in specimen_box(mesh.blocks))
            out = at[:, [0, 2]] - 0.5 * (low + high)
            on_rim = np.hypot(*out.T) > 0.98 * 0.5 * DIAMETER
            self.assertGreater(on_rim.sum(), 100)
            self.assertGreater((out[on_rim] @ view.towards_eye[[0, 2]]).min(), -0.1 * DIAMETER)  # it has few sides

    def test_traces_of_contacts_lie_in_the_plane_and_on_them(self):
        contacts, plane = self.results.mesh.contacts, solid_sections.axis_plane(self.results.mesh.blocks, "x", 0.3)
        cells = contacts.points[contacts.cells]
        lines, owner = cut.traces(cells, plane)
        self.assertGreater(len(lines), 100)
        self.assertLess(np.abs(plane.above(lines)).max(), 1e-12)
        low, high = cells[owner].min(axis=1), cells[owner].max(axis=1)
        self.assertTrue((lines >= low[:, None] - 1e-12).all() and (lines <= high[:, None] + 1e-12).all())

    def test_fields_have_three_components(self):
        fields = self.results.fields
        self.assertEqual(fields["displacement"].sizes["component"], 3)
        self.assertEqual(list(fields["component"].values), ["x", "y", "z"])
        self.assertAlmostEqual(float(fields["volume"].sum()), self.results.mesh.blocks.sizes.sum(), delta=1e-15)
        self.assertEqual(fields["contact_displacement"].sizes["end"], 4)

    def test_all_figures_of_a_solid_are_drawn(self):
        names = {path.stem for path in (self.place / "out/figures").iterdir()}
        self.assertLessEqual({"stress_strain", "fracture", "cracks", "energy", "cracks_inside"}, names)
        done = subprocess.run([PROGRAM, "figures", "plane", "out", "--axis", "x", "--at", "0.3"], cwd=self.place,
                              capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue((self.place / "out/figures/plane_x_0.3.png").exists())

    def test_statistics_of_crack_faces(self):
        faces = solid_sections.crack_faces(self.results, self.results.frames[-1])
        self.assertGreater(len(faces.area), 100)
        self.assertAlmostEqual(faces.damage_by_height(0.0, HEIGHT).sum(), 1.0, delta=1e-9)
        self.assertTrue(0.0 < faces.upright_share() <= 1.0)
        # smooth ends: the first cracks stand upright more often than by chance, which is 0.5
        first = solid_sections.crack_faces(self.results, self.results.frames[-2])
        self.assertTrue(100 < len(first.area) < len(faces.area))
        self.assertGreater(first.upright_share(30.0), 0.6)

    def test_a_specimen_is_drawn_and_written(self):
        done = subprocess.run([PROGRAM, "specimen", CASES / "starter_3d.toml", "--out", "made", *words(CHANGES)],
                              cwd=self.place, capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for name in ("fields/mesh.h5", "figures/morphology.png", "figures/gradation.png", "specimen/aggregates.csv"):
            self.assertTrue((self.place / "made" / name).exists(), name)
        facts = json.loads((self.place / "made/specimen/specimen.json").read_text())
        self.assertAlmostEqual(facts["volume_m3"], math.pi / 4.0 * DIAMETER**2 * HEIGHT, delta=1e-15)
        self.assertAlmostEqual(sum(c["asked"] for c in facts["size_classes"]), 0.20, delta=1e-12)

    def test_a_fork_from_the_checkpoint_of_a_stage_gives_the_same_bits(self):
        forked = subprocess.run([PROGRAM, "resume", "out", "--from-stage", "settle", "--out", "forked",
                                 "--no-figures"], cwd=self.place, capture_output=True, text=True, timeout=300,
                                check=False)
        self.assertEqual(forked.returncode, 0, forked.stderr)
        self.assertEqual((self.place / "forked/history.csv").read_text(),
                         (self.place / "out/history.csv").read_text())

    def test_threads_and_instructions_change_no_bit(self):
        want = (self.place / "out/history.csv").read_text()
        used = json.loads((self.place / "out/manifest.json").read_text())["instructions"]
        sets = re.findall(r"\w+", pyroclast.instruction_sets)
        for name in [name for name in sets if name != used] or [used]:
            done = self.run_deck(name, "--no-figures", "--threads", "1", "--instructions", name)
            if f'"{name}" is not one that this program and processor have' in done.stderr:
                self.assertNotEqual(name, "portable")
                continue
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual((self.place / name / "history.csv").read_text(), want, name)

    def test_a_run_starts_from_the_temperatures_of_a_solid_and_of_no_plane(self):
        """Where each gridpoint is strained by its own temperature without stress, which another run left."""
        frame = self.place / "out/fields/blocks_0001.hdf"
        stated = f'[coupling]\nstress_free = {{ frame = "{frame}" }}\n'
        for name, case in (("space", "starter_3d"), ("plane", "starter")):
            text = (CASES / f"{case}.toml").read_text()
            (self.place / f"{name}.toml").write_text(text + "\n" + stated)
        changes = words(CHANGES)
        taken = subprocess.run([PROGRAM, "check", "space.toml", *changes], cwd=self.place, capture_output=True,
                               text=True, timeout=300, check=False)
        self.assertEqual(taken.returncode, 0, taken.stderr)
        refused = subprocess.run([PROGRAM, "check", "plane.toml"], cwd=self.place, capture_output=True, text=True,
                                 timeout=300, check=False)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("is of a body in space, but this one is in the plane", refused.stderr)

    def test_python_drives_a_solid(self):
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        deck["blocks.count"] = 120
        specimen = deck.make_specimen()
        self.assertEqual(len(specimen.cells), 120)
        self.assertAlmostEqual(specimen.extent, math.pi / 4.0 * DIAMETER**2 * HEIGHT, delta=1e-15)
        areas = np.zeros((120, 3))
        for corners, (inner, outer) in zip(specimen.facets, specimen.neighbours):
            x = specimen.vertices[corners]
            vector = 0.5 * np.cross(x[1:-1] - x[0], x[2:] - x[0]).sum(axis=0)
            areas[inner] += vector
            if outer >= 0:
                areas[outer] -= vector
        self.assertLess(np.abs(areas).max(), 1e-15)

    def test_a_saved_specimen_gives_the_run_that_it_came_from(self):
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        for change in CHANGES:
            path, _, value = change.partition("=")
            deck[path] = json.loads(value) if value[0] in "[0123456789" and " " not in value else value
        made = deck.make_specimen()
        made.save(self.place / "cylinder.json")
        read = pyroclast.Specimen.read(self.place / "cylinder.json")
        for what in ("vertices", "neighbours", "phase", "stone"):
            np.testing.assert_array_equal(getattr(read, what), getattr(made, what))
        self.assertEqual({read.phases[p] for p in read.phase[read.stone >= 0]}, {"aggregate"})
        self.assertEqual((read.sides, read.phases, read.shares, read.size), (made.sides, made.phases, made.shares, made.size))
        self.assertEqual(len(read.stones), 0)
        deck["specimen"] = read
        self.assertEqual(deck["specimen"], {"shape": "polyhedra", "file": "cells.json"})
        run = pyroclast.Run(deck, out=self.place / "again", threads=1).finish()
        run.close()
        self.assertEqual((self.place / "again/history.csv").read_bytes(), (self.place / "out/history.csv").read_bytes())
        # the folder keeps the blocks, so the program makes the run again
        subprocess.run([PROGRAM, "run", "again/deck.toml", "--out", "program", "--no-figures", "--quiet"], cwd=self.place,
                       check=True)
        self.assertEqual((self.place / "program/history.csv").read_bytes(), (self.place / "out/history.csv").read_bytes())
        with self.assertRaisesRegex(pyroclast.Error, "seed has no meaning"):
            pyroclast.Run(deck, seed=2)

    def test_a_saved_disc_has_seats_of_bearings(self):
        deck = pyroclast.Deck(CASES / "brazilian.toml")
        del deck["specimen.thickness"]
        deck.update(specimen={"depth": "60 mm"}, blocks={"count": 150}, aggregates={"fraction": 0.0})
        deck["stages[0].drives[0].hold"] = ["x", "y", "z"]
        made = pyroclast.Run(deck, threads=1)
        deck["specimen"] = made.specimen
        again = pyroclast.Run(deck, threads=1)
        for name in ("rim", "lower_strip_face", "lower_strip_support", "upper_strip_pivot"):
            np.testing.assert_array_equal(again.sets[name], made.sets[name])

    def test_a_file_that_holds_no_blocks_is_told_with_its_name(self):
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        deck["blocks.count"] = 40
        deck.make_specimen().save(self.place / "good.json")
        good = json.loads((self.place / "good.json").read_text())
        self.assertEqual((good["body"]["axis"], good["body"]["sides"]), ("y", ["rim"]))
        surface = next(i for i in range(len(good["faces"])) if sum(i in cell for cell in good["cells"]) == 1)
        bent = [list(place) for place in good["vertices_m"]]
        for axis, way in enumerate((0.013, 0.011, 0.017)):  # in the plane of no side
            bent[good["faces"][surface][0]][axis] += way
        file = self.place / "mine.json"
        for change, told in (
                ({"faces": [[0, 1]]}, r"mine.json: face 0 .from 0. has 2 vertices, but needs 3"),
                ({"faces": [[0, 1, 10**6], *good["faces"][1:]]}, "names vertex 1000000"),
                ({"cells": [[0, 1, 2]] + good["cells"][1:]}, "cell 0 .from 0. has 3 faces, but needs 4"),
                ({"cells": good["cells"][:-1]}, "39 cells, but the phases of 40"),
                ({"cells": good["cells"][:-1], "phase": good["phase"][:-1]}, "39 cells, but the stones of 40"),
                ({"cells": good["cells"][:-1], "phase": good["phase"][:-1], "stone": good["stone"][:-1]},
                 "is of 0 cells|lies on no side"),
                ({"stone": [-2] * 40}, r"stone\[0\]: must be the number of a stone, from 0, or -1 for none"),
                ({"phase": [9] * 40}, "cell 0 .from 0. is of phase 9"), ({"body": None}, 'no table "body"'),
                ({"body": {**good["body"], "axis": "x"}}, '"y" or "z"'),
                ({"body": {**good["body"], "length_m": -1.0}}, "above 0"),
                ({"vertices_m": [[0, 0]]}, r"vertices_m\[0\]: must be a place, \[x, y, z\]"),
                ({"vertices_m": bent}, "lies on no side")):
            file.write_text(json.dumps({**good, **change}))
            with self.assertRaisesRegex(pyroclast.Error, told, msg=str(change)[:80]):
                pyroclast.Specimen.read(file)
        deck["specimen"] = pyroclast.Specimen.read(self.place / "good.json")
        for key, value, told in (("specimen.depth", "1 m", "has no meaning"), ("specimen.thickness", "1 m", "thickness"),
                                 ("blocks.count", 9, "no effect"),
                                 ("superposition.matrix", "paste", "none is the matrix")):
            other = deck.copy()
            other[key] = value
            with self.assertRaisesRegex(pyroclast.DeckError, told):
                other.check()

    def test_vtk_measures_the_blocks_as_a_mesh(self):
        # pylint: disable=import-outside-toplevel
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        deck["blocks.count"] = 120
        deck["blocks.shortest_edge"] = 0  # faces are plane
        specimen = deck.make_specimen()
        specimen.to_meshio().write(self.place / "blocks.vtu")
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.place / "blocks.vtu"))
        sizes = vtkCellSizeFilter()
        sizes.SetInputConnection(reader.GetOutputPort())
        sizes.Update()
        data = sizes.GetOutput().GetCellData()
        volume, phase = (vtk_to_numpy(data.GetArray(name)) for name in ("Volume", "phase"))
        for number, share in enumerate(specimen.shares.values()):
            # VTK leaves out slivers of the tetrahedra into which it cuts a block
            self.assertAlmostEqual(volume[phase == number].sum() / specimen.extent, share, delta=2e-3)


def pressed_quickly(deck: pyroclast.Deck, out: pathlib.Path) -> pyroclast.Specimen:
    """Presses a few blocks of a starter past the first cracks. Returns the specimen as it was made."""
    deck["output"].update(history_strain=2e-5, fields=False)
    deck["stages[1]"].update(stop_strain=6e-4, ramp_time="2 ms", velocity="4 mm/s")
    with pyroclast.Run(deck, out=out, threads=1) as run:
        run.finish()
        return run.specimen


def assert_same_bits(test: unittest.TestCase, place: pathlib.Path, deck: pyroclast.Deck,
                     specimen: pyroclast.Specimen) -> None:
    """The run `out` of a deck goes alike with the specimen given back, on two threads, and as a fork of its settling."""
    deck["specimen"] = specimen
    with pyroclast.Run(deck, out=place / "read", threads=2) as run:
        run.finish()
    done = subprocess.run([PROGRAM, "resume", "out", "--from-stage", "settle", "--out", "forked", "--no-figures"],
                          cwd=place, capture_output=True, text=True, timeout=300, check=False)
    test.assertEqual(done.returncode, 0, done.stderr)
    want = (place / "out/history.csv").read_bytes()
    test.assertGreater(want.count(b"\n"), 10)
    for name in ("read", "forked"):
        test.assertEqual((place / name / "history.csv").read_bytes(), want, name)


class WithoutShortEdges(unittest.TestCase):
    def test_faces_that_bend_are_kept_to_the_bit(self):
        """A run begun again at a checkpoint, one of another number of threads, and one of blocks from a file."""
        place = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, place)
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        deck["blocks"] = {"count": 150, "shortest_edge": 0.35, "largest_bend": "20 deg"}
        deck["aggregates"].update(fraction=0.2, d_min="20 mm", sieves=[])
        made = pressed_quickly(deck, place / "out")
        facts = json.loads((place / "out/specimen/specimen.json").read_text())
        self.assertGreater(facts["vertices_merged"], 300)
        self.assertTrue(15.0 < facts["largest_bend_deg"] < 20.0 + 1e-9)
        made.save(place / "cylinder.json")
        read = pyroclast.Specimen.read(place / "cylinder.json")
        for what in ("vertices", "neighbours", "phase"):
            np.testing.assert_array_equal(getattr(read, what), getattr(made, what))
        assert_same_bits(self, place, deck, read)
        again = json.loads((place / "read/specimen/specimen.json").read_text())
        self.assertEqual(again["largest_bend_deg"], facts["largest_bend_deg"])


class Finer(unittest.TestCase):
    def test_finer_blocks_are_kept_to_the_bit(self):
        """A run begun again at a checkpoint, one of another number of threads, and one of blocks from a file."""
        place = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, place)
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        del deck["blocks.count"]
        deck["blocks"] = {"size": "20 mm", "shortest_edge": 0.35,
                          "finer": [{"near": "top", "size": "12 mm", "distance": "10 mm"}]}
        deck["aggregates"].update(fraction=0.1, d_min="20 mm", sieves=[])
        made = pressed_quickly(deck, place / "out")
        sizes = made.block_size
        self.assertEqual(sizes.shape, made.phase.shape)
        self.assertAlmostEqual(sizes.min(), 12e-3, places=15)
        self.assertAlmostEqual(sizes.max(), 20e-3, places=15)
        facts = json.loads((place / "out/specimen/specimen.json").read_text())
        self.assertEqual((facts["smallest_block_size_m"], facts["largest_block_size_m"]), (sizes.min(), sizes.max()))
        told = subprocess.run([PROGRAM, "check", "out/deck.toml"], cwd=place, capture_output=True, text=True, check=True)
        self.assertIn("from 12.000 mm where they are finest to 20.000 mm", told.stdout)
        self.assertIn("between others t_b goes with their size", told.stdout)
        made.save(place / "cylinder.json")
        read = pyroclast.Specimen.read(place / "cylinder.json")
        for what in ("vertices", "neighbours", "phase", "block_size"):
            np.testing.assert_array_equal(getattr(read, what), getattr(made, what))
        good = json.loads((place / "cylinder.json").read_text())
        for wrong, words in (([1.0], "cells, but the sizes of 1"), (["a"], r"block_size_m\[0\]: must be a size in m"),
                             ([0.0, *good["block_size_m"][1:]], "cell 0 .from 0. has the size 0")):
            (place / "wrong.json").write_text(json.dumps({**good, "block_size_m": wrong}))
            with self.assertRaisesRegex(pyroclast.Error, words):
                pyroclast.Specimen.read(place / "wrong.json")
        assert_same_bits(self, place, deck, read)


class Script(unittest.TestCase):
    """A run of a solid in this process."""

    def test_arrays_have_three_coordinates(self):
        deck = pyroclast.Deck(CASES / "starter_3d.toml")
        deck["blocks.count"], deck["aggregates.fraction"] = 60, 0
        run = pyroclast.Run(deck, threads=1)
        run.until(steps=100)
        gridpoints, zones = len(run.position), len(run.zones)
        self.assertEqual((run.position.shape, run.zones.shape), ((gridpoints, 3), (zones, 4)))
        for name, shape in (("displacement", (gridpoints, 3)), ("velocity", (gridpoints, 3)), ("stress_Pa", (zones, 6))):
            self.assertEqual(run.fields[name].shape, shape, name)
        self.assertEqual(run.views.displacement.shape[1:], (3,))
        np.testing.assert_array_equal(run.views.displacement[run.slot], run.fields.displacement)
        contacts = run.contacts()
        self.assertLessEqual({"z_m", "area_m2"}, set(contacts))
        self.assertGreater(contacts["slip_m"].max(), 0.0)  # at the platens, which have no friction
        self.assertGreaterEqual(contacts["slip_m"].min(), 0.0)  # the size of a vector along the face
        beyond = contacts["tangential_jump_m"] - contacts["slip_m"] - contacts["held_jump_m"]
        self.assertLess(beyond[contacts["slip_m"] > 0.0].max(), 1e-15)  # the jump is the sum of both vectors
        self.assertEqual([cells.type for cells in run.to_meshio().cells], ["tetra"])
        twin = run.copy()
        for going in (run, twin):
            going.drive("rim_left", pressure="1 MPa")
            going.until(steps=100)
        self.assertGreater(run.fields.displacement[run.sets["rim_left"], 0].mean(), 0.0)
        np.testing.assert_array_equal(run.fields.displacement, twin.fields.displacement)


if __name__ == "__main__":
    unittest.main()
