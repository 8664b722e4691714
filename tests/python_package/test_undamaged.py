"""Bodies whose contacts never break: every figure, page and view of their runs; planes at the ends of solids."""

import contextlib
import io
import unittest

import pyroclast
from pyroclast import figures, read, report, watch
from pyroclast.draw import solid_sections, style
from small import Case

style.DPI = 60  # a fifth of what users get: the same is drawn
SHAPES = {3: 'shape = "cylinder"\ndiameter = "60 mm"\nheight = "60 mm"',
          2: 'width = "60 mm"\nheight = "60 mm"\nthickness = "0.1 m"'}
LAWS = {"elastic": 'law = "elastic"', "frictional": 'law = "frictional"\nfriction = 0.5'}
DECK = """
title = "Never breaks"
[specimen]
{shape}
seed = 1
[blocks]
count = 40
radius_spread = 0.3
shortest_edge = 0.35
[materials.mortar]
E = "30 GPa"
nu = 0.2
density = "2000 kg/m3"
expansion = "1e-5 1/K"
{platens}
[contacts]
t_b = "1 mm"
t_b_scaling = "fixed"
{friction}
[contacts.mortar_mortar]
{law}
[mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = "0 m/s2"
{stages}
"""
PLATENS = '[materials.platen]\nE = "200 GPa"\nnu = 0.3\ndensity = "7850 kg/m3"\n[platens]\nthickness = "20 mm"\n'
PRESSED = """
[[stages]]
kind = "drive"
duration = "4 ms"
[[stages.drives]]
set = "bottom"
hold = {held}
[[stages.drives]]
set = "top"
velocity = "-0.5 mm/s"
direction = "y"
ramp_time = "2 ms"
[[record]]
name = "foot"
kind = "force"
set = "bottom"
direction = "y"
[output]
frame_temperature = "50 K"
"""
COMPRESSED = """
[[stages]]
kind = "compress"
velocity = "10 mm/s"
ramp_time = "1 ms"
stop_strain = 2e-4
[output]
history_strain = 2e-5
frame_strain = 1e-4
"""
HEATED = """
[[stages]]
kind = "heat"
to = "60 degC"
rate = "5 K/min"
platen = "force"
[coupling]
exchange_increment = "20 K"
unbalanced_ratio = 1e-3
platen_difference = "0.2 MPa"
least_cycles = 100
most_cycles = 300
failure_strain = 0.002
[output]
history_strain = 2e-5
frame_strain = 1e-4
frame_temperature = "20 K"
"""


def deck(dimension: int, law: str, kind: str) -> pyroclast.Deck:
    stages = {"drive": PRESSED, "compress": COMPRESSED, "heat": HEATED}[kind]
    return pyroclast.Deck.from_text(DECK.format(
        shape=SHAPES[dimension], law=LAWS[law], friction="" if kind == "drive" else "platen_friction = 0.2",
        platens="" if kind == "drive" else PLATENS,
        stages=stages.replace("{held}", '["x", "y", "z"]' if dimension == 3 else '["x", "y"]')))


class Undamaged(Case):
    """Promise: a body without a law that has a damage is drawn as any other, but for what shows cracks alone."""

    def drawn(self, folder) -> list[str]:
        told = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()) as printed, contextlib.redirect_stderr(told):
            self.assertEqual(figures.main(["run", str(folder)]), 0, told.getvalue())
        self.assertEqual(told.getvalue(), "")
        return [line.rsplit("/", 1)[1] for line in printed.getvalue().splitlines()]

    def test_all_that_shows_a_run(self):
        for dimension, runs in ((3, (("elastic", "drive"), ("frictional", "drive"), ("elastic", "compress"),
                                     ("elastic", "heat"))), (2, (("elastic", "drive"), ("elastic", "heat")))):
            for law, kind in runs:
                with self.subTest(dimension=dimension, law=law, kind=kind):
                    folder = self.folder() / "out"
                    with pyroclast.Run(deck(dimension, law, kind), out=folder) as run:
                        run.finish()
                    names = self.drawn(folder)
                    self.assertIn("heating_fracture.png" if kind == "heat" else "fracture.png", names)
                    self.assertNotIn("cracks_inside.png", names)
                    results = read(folder)
                    self.assertEqual(results.facts.crack_modes, {})
                    report.write_page([folder])
                    watch.Watch(folder).draw()
                    if dimension == 3:
                        faces = solid_sections.crack_faces(results, results.frames[-1])
                        self.assertEqual(len(faces.area), 0)
                        solid_sections.cracks_inside(results, results.frames[-1])


class Ends(Case):
    """Promise: a plane may stand at any share of a solid from 0 to 1; at its ends it shows the specimen's own blocks,
    not those of a platen.
    """

    def test_planes_at_the_ends(self):
        folder = self.folder() / "out"
        with pyroclast.Run(deck(3, "elastic", "compress"), out=folder) as run:
            run.finish()
        for axis in "xyz":
            for at in ("0", "1"):
                with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as told:
                    self.assertEqual(figures.main(["plane", str(folder), "--axis", axis, "--at", at]), 0,
                                     told.getvalue())
        results = read(folder)
        for at in (0.0, 1.0):
            figure = solid_sections.plane_section(results, results.frames[-1], "y", at)
            labels = [text.get_text() for axes in figure.axes for legend in [axes.get_legend()] if legend
                      for text in legend.get_texts()]
            self.assertEqual(labels, ["mortar"])
            self.assertIn(f"y = {60 * at:g} mm", figure.axes[0].get_title())
            self.assertGreater(figure.axes[0].get_xlim()[1], 29.0)

    def test_other_shares_and_axes_are_refused(self):
        folder = self.folder() / "out"
        with pyroclast.Run(deck(3, "elastic", "drive"), out=folder) as run:
            run.finish()
        results = read(folder)
        for axis, at, words in (("y", 1.001, "1.001"), ("y", -0.1, "-0.1"), ("y", float("nan"), "nan"),
                                ("w", 0.5, "'w'")):
            with self.assertRaises(pyroclast.Error) as raised:
                solid_sections.plane_section(results, results.frames[-1], axis, at)
            self.assertIn(words, str(raised.exception))
        for at in ("1.001", "-0.1", "nan", "50 %"):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()) as told:
                figures.main(["plane", str(folder), "--at", at])
            self.assertIn("is not a share between 0 and 1", told.getvalue())


if __name__ == "__main__":
    unittest.main()
