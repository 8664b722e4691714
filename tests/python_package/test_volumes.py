"""Stones in space from volumes of labels and signed distances: to a file, a deck, and a specimen."""

import collections
import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import pyroclast
from pyroclast import volumes

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"
BALLS = ((20.0, 20.0, 20.0, 8.0), (40.0, 20.0, 22.0, 10.0), (30.0, 42.0, 46.0, 12.0))  # voxels; the last is cut


def labels_of_balls(size=48):
    """Labels 1, 2, 3 in 0, (nz, ny, nx): centres in voxels from the lower corner, y upwards."""
    z, y, x = np.meshgrid(*[np.arange(size) + 0.5] * 3, indexing="ij")
    labels = np.zeros((size, size, size), int)
    for number, (a, b, c, radius) in enumerate(BALLS, 1):
        labels[np.hypot(np.hypot(x - a, (size - y) - b), z - c) < radius] = number
    return labels


def refused(text, call):
    with unittest.TestCase().assertRaisesRegex(pyroclast.Error, text):
        call()


class Volumes(unittest.TestCase):
    def require_closed(self, stone):
        edges = collections.Counter((a, b) for t in stone.triangles.tolist() for a, b in zip(t, t[1:] + t[:1]))
        self.assertEqual(set(edges.values()), {1})
        self.assertTrue(all((b, a) in edges for a, b in edges))

    def test_stones_have_the_volume_and_the_place_of_their_voxels(self):
        labels = labels_of_balls()
        stones = volumes.stones_of_labels(labels, "0.5 mm")
        self.assertEqual(len(stones), 3)
        for number, (stone, (a, b, c, radius)) in enumerate(zip(stones, BALLS), 1):
            self.require_closed(stone)
            voxels = np.count_nonzero(labels == number)
            self.assertAlmostEqual(stone.volume / (voxels * 0.125e-9), 1.0, delta=0.015)
            self.assertGreaterEqual(stone.vertices.min(), 0.0)
            self.assertLessEqual(stone.vertices.max(), 24e-3)
            if number < 3:
                self.assertLess(np.abs(stone.vertices.mean(axis=0) - 0.5e-3 * np.array([a, b, c])).max(), 0.1e-3)
                self.assertAlmostEqual(stone.area / (np.pi * (1e-3 * radius)**2), 1.0, delta=0.03)

    def test_touching_stones_share_a_surface_or_keep_a_gap(self):
        labels = np.zeros((20, 20, 30), int)
        labels[4:16, 4:16, 4:15] = 1
        labels[4:16, 4:16, 15:26] = 2
        for gap in (0.0, 1.0):
            left, right = volumes.stones_of_labels(labels, "1 mm", gap=f"{gap} mm")
            # smoothing rounds the rims, where the surface bends to one side
            middle = [v[np.abs(v[:, 1:] - 10e-3).max(axis=1) < 3e-3, 0] for v in (left.vertices, right.vertices)]
            self.assertAlmostEqual(1e3 * (middle[1].min() - middle[0].max()), gap, delta=0.05)

    def test_distance(self):
        ball, = volumes.stones_of_distance(lambda p: np.linalg.norm(p - 0.02, axis=1) - 0.01, ["0 mm"] * 3, ["40 mm"] * 3,
                                           "1 mm", "pore")
        self.require_closed(ball)
        self.assertEqual(ball.phase, "pore")
        self.assertAlmostEqual(ball.volume / (4.0 / 3.0 * np.pi * 1e-6), 1.0, delta=0.01)
        half, = volumes.stones_of_distance(lambda p: p[:, 2] - 0.01, ["0 mm"] * 3, ["20 mm"] * 3, "1 mm")
        self.require_closed(half)
        self.assertAlmostEqual(half.volume / 4e-6, 1.0, delta=1e-3)

    def test_refused(self):
        labels = labels_of_balls(24)
        for text, call in (
                ("slices, rows, columns", lambda: volumes.stones_of_labels(labels[0], "1 mm")),
                ("whole numbers", lambda: volumes.stones_of_labels(labels + 0.5, "1 mm")),
                ("label 1 has no phase", lambda: volumes.stones_of_labels(labels, "1 mm", phases={7: "pore"})),
                ("large enough", lambda: volumes.stones_of_labels(0 * labels, "1 mm")),
                ("is read from", lambda: volumes.stones_of_labels("a.raw", "1 mm")),
                ("no such file|No such file", lambda: volumes.stones_of_labels("missing.npy", "1 mm")),
                ("negative nowhere", lambda: volumes.stones_of_distance(lambda p: 1.0 + 0.0 * p[:, 0], ["0 mm"] * 3,
                                                                        ["1 mm"] * 3, "0.5 mm"))):
            refused(text, call)

    def test_files(self):
        labels = labels_of_balls().astype(np.uint8)
        first = volumes.stones_of_labels(labels, "1 mm")
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder) / "a.npy"]
            np.save(files[0], labels)
            try:
                from PIL import Image
                files.append(pathlib.Path(folder) / "a.tif")
                pages = [Image.fromarray(page) for page in labels]
                pages[0].save(files[-1], save_all=True, append_images=pages[1:])
            except ImportError:
                pass
            try:
                import vtk
                from vtk.util.numpy_support import numpy_to_vtk
                image = vtk.vtkImageData()
                image.SetDimensions(*labels.shape[::-1])
                image.GetPointData().SetScalars(numpy_to_vtk(labels[:, ::-1].ravel()))
                for name, writer in (("a.vti", vtk.vtkXMLImageDataWriter()), ("a.vtk", vtk.vtkStructuredPointsWriter())):
                    files.append(pathlib.Path(folder) / name)
                    writer.SetFileName(str(files[-1]))
                    writer.SetInputData(image)
                    writer.Write()
            except ImportError:
                pass
            for file in files:
                with self.subTest(file.suffix):
                    read = volumes.stones_of_labels(file, "1 mm")
                    self.assertTrue(all(np.array_equal(a.vertices, b.vertices) for a, b in zip(first, read)))

    def test_a_deck_reads_them(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            stones = volumes.stones_of_labels(labels_of_balls(), "1 mm", gap="1 mm")
            volumes.write_stones(folder / "stones.obj", stones)
            text = (CASES / "starter_3d.toml").read_text()
            begin, end = text.index("[aggregates]"), text.index("[materials.aggregate]")
            text = (text[:begin] + '[aggregates]\n[aggregates.surfaces]\nobj = "stones.obj"\n\n[blocks]\ncount = 1500\n'
                    'radius_spread = 0.3\nshortest_edge = 0.35\n\n[superposition]\nrule = "follow"\n\n' + text[end:])
            text = text.replace('shape = "cylinder"', 'width = "48 mm"').replace('diameter = "100 mm"', 'depth = "48 mm"')
            (folder / "deck.toml").write_text(text.replace('height = "200 mm"', 'height = "48 mm"'))
            program = os.environ["PYROCLAST"]
            subprocess.run([program, "specimen", folder / "deck.toml", "--out", folder / "out", "--no-figures"], check=True,
                           capture_output=True)
            with open(folder / "out/specimen/grain_fit.csv", newline="") as file:
                fits = list(csv.DictReader(file))
            self.assertEqual(len(fits), 3)
            for fit in fits:
                self.assertAlmostEqual(float(fit["volume_of_blocks_m3"]) / float(fit["volume_m3"]), 1.0, delta=0.03)
            # the file of a run has the same stones
            again = (folder / "out/specimen/stones.obj").read_text()
            self.assertEqual(again.count("\no "), 3)
            (folder / "stones.obj").write_text(again.replace("\nf ", "\nf 1 1 99999999\nf ", 1))
            failed = subprocess.run([program, "check", folder / "deck.toml"], capture_output=True, text=True)
            self.assertNotEqual(failed.returncode, 0)
            self.assertRegex(failed.stderr, "stones.obj:.*there is no vertex 99999999")


if __name__ == "__main__":
    unittest.main()
