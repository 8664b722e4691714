"""Bodies in space that other programs made break in a run: a tessellation of Neper, meshes, a volume of labels."""

import itertools
import types
import unittest

import numpy as np
import pyroclast
from pyroclast import volumes
from small import Case, deck

SIDE = 0.06  # m
NAMES = {1: "mortar", 2: "aggregate"}
KUHN = [[0, 1 << a, (1 << a) | (1 << b), 7] for a, b in itertools.permutations(range(3), 2)]


def cubes(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A cube of so many cubes along each axis: vertices, the corners of each with the bits of x, y, z, and groups."""
    line = np.linspace(0.0, SIDE, count + 1)
    at = np.array([(x, y, z) for z in line for y in line for x in line])
    step = (1, count + 1, (count + 1) ** 2)
    first = np.array([i * step[0] + j * step[1] + k * step[2] for k in range(count) for j in range(count)
                      for i in range(count)])
    corners = first[:, None] + np.array([sum(s for bit, s in enumerate(step) if corner >> bit & 1)
                                         for corner in range(8)])
    middle = at[corners].mean(axis=1) / SIDE - 0.5
    return at, corners, np.where(np.abs(middle).max(axis=1) < 0.3, 2, 1)


def mesh_of(at, kind: str, cells, groups) -> types.SimpleNamespace:
    """A mesh as meshio reads one of gmsh: with triangles of its surface that are no blocks."""
    return types.SimpleNamespace(
        points=1e3 * at, cell_sets={}, field_data={},
        cells=[types.SimpleNamespace(type="triangle", data=np.array([[0, 1, 2]])),
               types.SimpleNamespace(type=kind, data=cells)],
        cell_data={"gmsh:physical": [np.array([9]), np.asarray(groups)]})


def tess_of(made: pyroclast.Specimen) -> str:
    """A specimen in space as Neper writes it: faces have edges and planes, and cells their groups."""
    edges: dict[tuple[int, int], int] = {}
    lines = ["***tess", " **format", "   3.4", " **general", "   3 standard", " **cell", f"  {len(made.cells)}", "  *id",
             "   " + " ".join(str(i + 1) for i in range(len(made.cells))), "  *group",
             "   " + " ".join(str(phase + 1) for phase in made.phase), " **vertex", f"  {len(made.vertices)}"]
    lines += [f"   {i} {x:.12f} {y:.12f} {z:.12f} 0" for i, (x, y, z) in enumerate(1e3 * made.vertices, 1)]
    faces = []
    for i, face in enumerate(made.facets, 1):
        ends = [tuple(sorted((int(a), int(b)))) for a, b in zip(face, np.roll(face, -1))]
        numbers = [edges.setdefault(pair, len(edges) + 1) for pair in ends]
        faces += [f"   {i} {len(face)} {' '.join(str(v + 1) for v in face)}",
                  f"     {len(numbers)} {' '.join(map(str, numbers))}", "     0.0 1.0 0.0 0.0", "     0 0 0.0 0.0 0.0"]
    lines += [" **edge", f"  {len(edges)}"] + [f"   {i} {a + 1} {b + 1} 0" for (a, b), i in edges.items()]
    lines += [" **face", f"  {len(made.facets)}", *faces, " **polyhedron", f"  {len(made.cells)}"]
    inner = made.neighbours[:, 0]
    lines += [f"   {i + 1} {len(cell)} {' '.join(str((f + 1) * (1 if inner[f] == i else -1)) for f in cell)}"
              for i, cell in enumerate(made.cells)]
    return "\n".join([*lines, " **domain", "  *general", "   cube", "***end", ""])


def small_cube(blocks: int) -> pyroclast.Deck:
    made = deck("cube_3d", blocks__count=blocks)
    for side in ("width", "height", "depth"):
        made[f"specimen.{side}"] = f"{SIDE} m"
    return made


def of_stones(blocks: int) -> pyroclast.Deck:
    made = small_cube(blocks)
    made["aggregates.d_min"], made["aggregates.sieves"] = "20 mm", []
    return made


class BrokenElsewhere(Case):
    def assert_breaks(self, body: pyroclast.Deck, blocks: int):
        """Asserts that a run by deck loads the body past its peak and breaks contacts of it."""
        changes = {"stages[1].stop_strain": 0.02, "stages[1].velocity": "10 mm/s", "stages[1].ramp_time": "2 ms",
                   "stages[1].stop_fraction_of_peak": 0.5, "stages[0].unbalanced_ratio": 0.01, "output.fields": False}
        for key, value in changes.items():
            body[key] = value
        made = body.make_specimen()
        self.assertEqual(made.dimension, 3)
        self.assertEqual(len(made.cells), blocks)
        self.assertEqual(made.sides, ["bottom", "right", "top", "left", "front", "back"])
        self.assertAlmostEqual(made.extent, SIDE**3, delta=1e-9 * SIDE**3)
        summary = pyroclast.Run(body, threads=1).finish().summary
        self.assertGreater(summary["stages"][1]["results"]["stress_max_MPa"], 5.0)
        self.assertGreater(sum(modes["broken"] for modes in summary["cracks"].values() if isinstance(modes, dict)), 0)

    def with_specimen(self, specimen: pyroclast.Specimen) -> pyroclast.Deck:
        body = deck("cube_3d", contacts__aggregate_mortar__between_stones=[])
        body["specimen"] = specimen
        return body

    def test_tetrahedra_of_gmsh(self):
        at, corners, groups = cubes(3)
        cells = np.concatenate([corners[:, tetrahedron] for tetrahedron in KUHN])
        made = pyroclast.Specimen.from_meshio(mesh_of(at, "tetra", cells, np.tile(groups, len(KUHN))), phases=NAMES,
                                              unit="mm")
        self.assertAlmostEqual(made.shares["aggregate"], 1.0 / 27.0, delta=1e-12)
        self.assert_breaks(self.with_specimen(made), 6 * 27)

    def test_hexahedra_are_polyhedra(self):
        at, corners, groups = cubes(3)
        hexahedra = corners[:, [0, 1, 3, 2, 4, 5, 7, 6]]
        made = pyroclast.Specimen.from_meshio(mesh_of(at, "hexahedron", hexahedra, groups), phases=NAMES, unit="mm")
        sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
        polyhedra = [[cell[side] for side in sides] for cell in corners]
        again = pyroclast.Specimen.from_meshio(mesh_of(at, "polyhedron8", polyhedra, groups), phases=NAMES, unit="mm")
        self.assertEqual(made.shares, again.shares)
        self.assertEqual(sorted(sorted(face) for face in made.facets), sorted(sorted(face) for face in again.facets))

    def test_a_mesh_of_convex_cells(self):
        made = of_stones(80).make_specimen()
        cells = [[made.facets[face] for face in cell] for cell in made.cells]
        mesh = mesh_of(made.vertices, "polyhedron", cells, made.phase)
        self.assert_breaks(self.with_specimen(
            pyroclast.Specimen.from_meshio(mesh, phases=dict(enumerate(made.phases)), unit="mm")), 80)

    def test_a_tessellation_of_neper(self):
        made = of_stones(80).make_specimen()
        file = self.folder() / "n80.tess"
        file.write_text(tess_of(made))
        read = pyroclast.Specimen.from_neper(file, {i + 1: name for i, name in enumerate(made.phases)}, unit="mm")
        np.testing.assert_allclose(read.vertices, made.vertices, atol=1e-12)
        self.assertEqual(read.phase.tolist(), made.phase.tolist())
        self.assert_breaks(self.with_specimen(read), 80)
        for told, change in (("is of dimension 2", ("   3 standard", "   2 standard")),
                             ("is periodic", ("standard", "periodic")),
                             ("0 faces and 80 polyhedra", (" **face\n", " **fase\n")),
                             ("no tessellation of Neper", ("***tess", "***mesh"))):
            file.write_text(tess_of(made).replace(*change, 1))
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Specimen.from_neper(file, "mortar", unit="mm")

    def test_cells_that_fill_no_box_are_refused(self):
        at, corners, groups = cubes(3)
        with self.assertRaisesRegex(pyroclast.Error, "lies on no side of the body"):
            pyroclast.Specimen.from_meshio(mesh_of(at, "hexahedron", corners[1:, [0, 1, 3, 2, 4, 5, 7, 6]], groups[1:]),
                                           phases=NAMES, unit="mm")

    def test_a_volume_of_labels(self):
        z, y, x = np.indices((30, 30, 30)) + 0.5
        labels = sum(number * ((z - c[2])**2 + (y - c[1])**2 + (x - c[0])**2 < 7.0**2)
                     for number, c in enumerate(((8, 8, 15), (22, 22, 15)), 1))
        folder = self.folder()
        volumes.write_stones(folder / "stones.obj", volumes.stones_of_labels(labels, "2 mm", gap="2 mm"))
        body = small_cube(400)
        for key in ("fraction", "d_min", "d_max", "fuller_exponent", "sieves", "minimum_gap"):
            del body[f"aggregates.{key}"]
        body["aggregates.surfaces"] = {"obj": str(folder / "stones.obj")}
        body["superposition.rule"] = "follow"
        self.assert_breaks(body, 400)


if __name__ == "__main__":
    unittest.main()
