"""A solid that is heated on one side: its pictures are seen from there, and show the field that the run kept."""

import contextlib
import io
import json
import pathlib
import shutil
import tempfile
import unittest

import numpy as np
import pyroclast
from pyroclast import figures
from pyroclast.draw import fields, heated_sections, solid_sections, style
from pyroclast.draw.profiles import read_profile
from pyroclast.draw.solid_sections import VIEW, View

style.DPI = 60  # a fifth of what users get: the same is drawn
SLAB = pathlib.Path(__file__).parents[1] / "hot_slab.toml"
SIDES = {"left": (0, -1), "right": (0, 1), "bottom": (1, -1), "top": (1, 1), "front": (2, -1), "back": (2, 1)}


class HotSolid(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.place)
        cls.runs = {}
        for face in SIDES:
            deck = pyroclast.Deck(SLAB)
            deck["heat.boundaries[0].faces"] = face
            with pyroclast.Run(deck, out=cls.place / face) as run:
                run.finish()
            cls.runs[face] = pyroclast.read(cls.place / face)

    def command(self, *words: str) -> tuple[int, str]:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as told:
            code = figures.main(list(words))
        return code, told.getvalue()

    def test_all_pictures_of_heat_are_drawn(self):
        self.assertEqual(self.command("run", str(self.place / "front")), (0, ""))
        names = {path.stem for path in (self.place / "front/figures").iterdir()}
        self.assertLessEqual({"temperature", "temperature_history", "temperature_profile", "isotherm"}, names)
        self.assertEqual(json.loads((self.place / "front/summary.json").read_text())["heated_face"], "front")

    def test_the_eye_and_the_quarter_are_on_the_hot_side(self):
        for face, (axis, sign) in SIDES.items():
            with self.subTest(face):
                run = self.runs[face]
                view = solid_sections.view_of(run)
                self.assertGreater(sign * view.towards_eye[axis], 0.0)
                others = [k for k in range(3) if k != axis]  # as those of a cold body
                np.testing.assert_array_equal(view.towards_eye[others], VIEW.towards_eye[others])
                for plane in solid_sections.middle_planes(run.mesh.blocks, view=view):
                    self.assertGreater(plane.normal @ view.towards_eye, 0.0)

    def test_isotherms_on_a_plane_lie_as_deep_as_the_profile_says(self):
        for face in ("front", "bottom", "right"):
            with self.subTest(face):
                run, (axis, sign) = self.runs[face], SIDES[face]
                across = "y" if axis != 1 else "x"
                figure = solid_sections.plane_section(run, run.frames[-1], across, colour="temperature")
                lines = [mesh for mesh in figure.axes[0].collections if hasattr(mesh, "get_paths")
                         and len(mesh.get_paths()) and mesh.get_linewidth()[0] == 0.6]
                places = np.concatenate([path.vertices for mesh in lines for path in mesh.get_paths()])
                along = places[:, solid_sections._IN_PLANE[across].index(axis)]  # pylint: disable=protected-access
                deep = along if sign < 0 else 60.0 - along
                profile = read_profile(run)
                wanted = 1e3 * np.interp(-np.array(fields.ISOTHERMS), -profile.temperature[-1], profile.depth)
                # each place lies near one of the three depths: blocks of 13 mm bend the lines by no more than 2.5 mm
                off = np.abs(deep[:, None] - wanted)
                self.assertLess(off.min(axis=1).max(), 2.5)
                self.assertEqual(set(off.argmin(axis=1)), {0, 1, 2})

    def test_the_picture_cut_open_shows_the_hottest_and_the_lines(self):
        for face in ("front", "left"):
            figure = heated_sections.temperature_field(self.runs[face])
            texts = {text.get_text() for text in figure.axes[len(self.runs[face].frames) - 1].texts}
            self.assertLessEqual({"300", "500", "700", "x", "y", "z"}, texts)
            hottest = np.array(figure.axes[-1].get_ylim())[1]
            self.assertAlmostEqual(hottest, 1000.0, delta=0.1)

    def test_planes_by_the_command(self):
        run = str(self.place / "top")
        for words, name in (((), "plane_z_0.5_temperature"), (("--axis", "x", "--at", "0", "--colour", "temperature"),
                                                              "plane_x_0_temperature")):
            self.assertEqual(self.command("plane", run, *words), (0, ""))
            self.assertTrue((self.place / "top/figures" / f"{name}.png").exists())
        for words, said in ((("--colour", "material"), "conducts heat alone"), (("--magnification", "3"), "before it moved")):
            code, told = self.command("plane", run, *words)
            self.assertEqual((code, told.count("\n")), (1, 1), told)
            self.assertIn(said, told)
        with self.assertRaises(pyroclast.Error) as raised:
            solid_sections.plane_section(self.runs["top"], self.runs["top"].frames[-1], "x", colour="heat")
        self.assertIn("material, temperature", str(raised.exception))


class Split(unittest.TestCase):
    """Promise: triangles of a field are split until their colours are few, and fill what they filled."""

    def test_parts_fill_the_triangles_and_keep_their_order(self):
        corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 8]], [[1, 0, 0], [1, 1, 0.5], [0, 1, 0]]], float)
        parts, owner = fields._split(corners, 1.0)  # pylint: disable=protected-access
        self.assertLessEqual(np.ptp(parts[..., 2], axis=1).max(), 1.0)
        self.assertEqual(owner.tolist(), sorted(owner))
        one, other = parts[:, 1, :2] - parts[:, 0, :2], parts[:, 2, :2] - parts[:, 0, :2]
        areas = 0.5 * (one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
        np.testing.assert_allclose(np.bincount(owner, areas), 0.5)
        first = parts[owner == 0].reshape(-1, 3)
        np.testing.assert_allclose(first[:, 2], 8.0 * first[:, 1], atol=1e-12)  # the field of the first one
        self.assertEqual((owner == 1).sum(), 1)


class Turned(unittest.TestCase):
    def test_a_view_from_another_side_is_the_body_turned(self):
        points = np.random.default_rng(1).random((20, 3))
        turned = View(VIEW.towards_eye * [-1.0, 1.0, -1.0])  # half a turn around y
        np.testing.assert_allclose(turned.flat(points), VIEW.flat(points * [-1.0, 1.0, -1.0]), atol=1e-12)


if __name__ == "__main__":
    unittest.main()
