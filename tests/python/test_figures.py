"""What the figures promise, on small runs of invented numbers in the layout of the program.

    python3 -m unittest discover -s tests/python
"""

from __future__ import annotations

import contextlib
import csv
import importlib.machinery
import importlib.util
import io
import json
import re
import shutil
import struct
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

import h5py
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection, TriMesh
from matplotlib.colors import to_rgba
from matplotlib.text import Text
from PIL import Image

HERE = Path(__file__).resolve().parent
IMAGES = HERE.parents[1] / "docs" / "images"
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]

import synthetic_run  # noqa: E402
from synthetic_run import Heating  # noqa: E402
from pyroclast import figures
from pyroclast.draw import style  # noqa: E402
from pyroclast.draw.comparisons import compare_cracks, compare_thrust, compare_total_strain  # noqa: E402
from pyroclast.draw.crack_styles import CRACKS, count_cracks, cracked  # noqa: E402
from pyroclast.draw.curves import compare, mean_curve, mean_of, names_apart, stress_strain  # noqa: E402
from pyroclast.draw.fractures import fracture, fracture_legend, fracture_panels, select_frames  # noqa: E402
from pyroclast.draw.heated_sections import (ISOTHERMS, frame_near, levels, select_heated_frames,  # noqa: E402
                                            temperature_field)
from pyroclast.draw.heating import strain_limits, temperature_history, total_strain  # noqa: E402
from pyroclast.draw.profiles import read_profile, temperature_profile  # noqa: E402
from pyroclast.draw.progress import cracks, energy, heating_course, loading_course  # noqa: E402
from pyroclast.draw.properties import read_properties  # noqa: E402
from pyroclast.draw.records import record_fracture, records  # noqa: E402
from pyroclast.draw.sections import morphology  # noqa: E402
from pyroclast.errors import Error  # noqa: E402
from pyroclast.stored import reference
from pyroclast.stored.compressed import Compressed  # noqa: E402
from pyroclast.stored.files import Table  # noqa: E402
from pyroclast.stored.frames import Frame  # noqa: E402
from pyroclast.stored.heated import Heated  # noqa: E402
from pyroclast.stored.mesh import specimen_box  # noqa: E402
from pyroclast.stored.results import Results, SpecimenFolder  # noqa: E402


# A fifth of what users get: what is drawn is the same, and half of the time goes into pictures' compression.
style.DPI = 60


def png_size(path: Path) -> tuple[int, int]:
    """Width and height in pixels, from the header."""
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is not a png"
    return struct.unpack(">II", head[16:24])


def replace_in(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text, f"{old!r} is not in {path}"
    path.write_text(text.replace(old, new, 1))


def writing_alone(*names: str):
    """Figures of these names are written; the others are drawn up, but not written, which takes most of the time."""
    def save(figure, path: Path) -> Path:
        return style.save(figure, path) if path.stem in names else path

    return mock.patch.object(figures, "save", save)


def assert_apart(test: unittest.TestCase, name: str, figure) -> None:
    """Panels with their labels, captions and legends lie apart, and within the page."""
    figure.set_dpi(100)
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw(renderer)
    boxes = []
    for axes in figure.axes:
        box = axes.get_tightbbox(renderer)
        if box is None or box.width * box.height == 0.0:
            continue
        # A pixel: texts are placed at whole ones.
        inside = (min(box.x0, box.y0) >= -1.0 and box.x1 <= figure.bbox.width + 1.0
                  and box.y1 <= figure.bbox.height + 1.0)
        test.assertTrue(inside, f"{name}: {box} reaches out of {figure.bbox}")
        boxes.append((axes, box))
    for i, (one, a) in enumerate(boxes):
        for other, b in boxes[:i]:
            width = min(a.x1, b.x1) - max(a.x0, b.x0)
            height = min(a.y1, b.y1) - max(a.y0, b.y0)
            twins = one in other.get_shared_x_axes().get_siblings(other) and one.bbox.bounds == other.bbox.bounds
            # Tick labels may stand two pixels beyond the end of an axis.
            test.assertFalse(not twins and width > 2.0 and height > 2.0, f"{name}: {a} covers {b}")


class CommandTest(unittest.TestCase):
    """Has a folder of its own, and the command at hand."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name)

    def command(self, *arguments) -> tuple[int, list[str], str]:
        """Exit code, lines printed, and what stands on stderr."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = figures.main([str(argument) for argument in arguments])
        return code, out.getvalue().splitlines(), err.getvalue()

    def assert_fails(self, arguments, *parts: str) -> None:
        """The command ends with 1 and one line that holds all parts."""
        code, _, err = self.command(*arguments)
        self.assertEqual(code, 1)
        self.assertEqual(len(err.splitlines()), 1, err)
        for part in parts:
            self.assertIn(part, err)


class FolderTest(CommandTest):
    """Has a folder of a compression run."""

    def setUp(self):
        super().setUp()
        self.run_folder = self.root / "run"
        self.section = synthetic_run.write_run(self.run_folder)


class HeatedTest(CommandTest):
    """Makes heated runs."""

    def heated(self, name: str, heating: Heating | None = None, /) -> Path:
        folder = self.root / name
        synthetic_run.write_heated_run(folder, heating or Heating())
        return folder

    def summary_of(self, folder: Path, **results) -> Results:
        """The run, results of those of its stages that have one of the name replaced."""
        path = folder / "summary.json"
        facts = json.loads(path.read_text())
        for stage in facts["stages"]:
            stage["results"] |= {name: value for name, value in results.items() if name in stage["results"]}
        path.write_text(json.dumps(facts))
        return Results(folder)


class BodyTest(FolderTest):
    """Has a run of a body without platens: records stand in the place of stress and strain."""

    def setUp(self):
        super().setUp()
        history = self.run_folder / "history.csv"
        header, rest = history.read_text().split("\n", 1)
        names = {"strain": "stretch_m", "stress_MPa": "grip_N", "stress_top_MPa": "temperature_max_degC",
                 "stress_bottom_MPa": "temperature_min_degC"}
        columns = [names.get(name, name) for name in header.split(",")]
        history.write_text(",".join(columns) + "\n" + rest)
        synthetic_run.write_facts(self.run_folder, columns)
        (self.run_folder / "deck.toml").write_text(
            '[[record]]\nname = "grip"\nkind = "force"\n[[record]]\nname = "stretch"\nkind = "opening"\n')
        with h5py.File(self.run_folder / "fields" / "mesh.h5", "r+") as file:
            file["blocks/bearing"][...] = 0
            file["blocks/material_names"][...] = np.array(["aggregate", "mortar", "sand"], "S")


class OtherBodies(BodyTest):
    def test_records_are_drawn_over_the_opening_and_all_blocks_are_of_the_body(self):
        code, printed, err = self.command("run", self.run_folder)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual([Path(line).name for line in printed], ["records.png", "energy.png", "fracture.png"])
        run = Results(self.run_folder)
        curve = records(run).axes[0].lines[0]
        np.testing.assert_allclose(curve.get_xdata(), 1e3 * run.history["stretch_m"])
        np.testing.assert_allclose(curve.get_ydata(), 1e-3 * run.history["grip_N"])
        figure = fracture_panels(record_fracture(run))
        shown = {patch.get_label(): patch.get_facecolor() for patch in figure.axes[-1].get_legend().get_patches()}
        self.assertEqual(set(shown), {"aggregate", "mortar", "sand"})
        self.assertNotIn(to_rgba(style.PLATEN_COLOUR), shown.values())
        low, high = specimen_box(run.mesh.blocks)
        np.testing.assert_array_equal(low, run.mesh.blocks.points.min(axis=0))
        np.testing.assert_array_equal(high, run.mesh.blocks.points.max(axis=0))

    def test_references_stand_beside_the_records_that_they_are_of(self):
        table = {"x": [0.0, 1e-4], "low": [0.0, 2e3], "high": [0.0, 2e3]}
        (self.run_folder / "references.json").write_text(json.dumps(
            [{"name": "beam 3", "of": "grip", "over": "stretch"} | table,
             {"name": "beam 4", "of": "grip", "over": "time"} | table]))
        first, second = records(Results(self.run_folder)).axes
        drawn = {line.get_label(): line for line in first.lines}
        np.testing.assert_allclose(drawn["beam 3"].get_xdata(), [0.0, 0.1])  # mm
        np.testing.assert_allclose(drawn["beam 3"].get_ydata(), [0.0, 2.0])  # kN
        self.assertNotIn("beam 4", drawn)
        self.assertIn("beam 4", [line.get_label() for line in second.lines])
        self.assertEqual([axes.get_xlabel() for axes in (first, second)], ["stretch, opening [mm]", "Time [s]"])

    def test_records_are_drawn_without_fields(self):
        shutil.rmtree(self.run_folder / "fields")
        code, printed, err = self.command("run", self.run_folder)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual([Path(line).name for line in printed], ["records.png", "energy.png"])


class CommandsMakePictures(FolderTest):
    def test_run_prints_and_writes_every_figure(self):
        code, printed, err = self.command("run", self.run_folder)
        self.assertEqual((code, err), (0, ""))
        names = ["stress_strain.png", "cracks.png", "energy.png", "fracture.png"]
        self.assertEqual(printed, [str(self.run_folder / "figures" / name) for name in names])
        page = round(style.WIDTH * style.DPI)
        for name in names[:3]:
            self.assertEqual(png_size(self.run_folder / "figures" / name), (page, round(4.8 * style.DPI)))
        # Fine cracks need twice the resolution; the height follows the specimen.
        self.assertEqual(png_size(self.run_folder / "figures" / "fracture.png")[0], 2 * page)

    def test_a_run_without_fields_gets_its_curves(self):
        shutil.rmtree(self.run_folder / "fields")
        code, printed, err = self.command("run", self.run_folder)
        self.assertEqual((code, err), (0, ""))
        self.assertEqual([Path(path).stem for path in printed], ["stress_strain", "cracks", "energy"])

    def test_blocks_that_have_moved_out_are_not_cut_off(self):
        run = Results(self.run_folder)
        marks = select_frames(run.frames, *Compressed(run).peak)
        points = run.mesh.blocks.points

        def reach(magnification: float) -> float:
            """Over the width, to the left and right of where the blocks were."""
            moved = [points + magnification * run.gridpoint_displacement(frame) for frame in marks.values()]
            return max(np.ptp(np.r_[points[:, 0], places[:, 0]]) for places in moved) / np.ptp(points[:, 0]) - 1.0

        magnification = next(m for m in range(1, 10000) if reach(m) > 0.2)
        drawn = fracture_panels(fracture(run, marks), magnification)
        for axes in drawn.axes[:len(marks)]:
            corners = np.concatenate([path.vertices for blocks in axes.collections for path in blocks.get_paths()])
            for limits, places in zip((axes.get_xlim(), axes.get_ylim()), corners.T):
                self.assertLess(limits[0], places.min())
                self.assertGreater(limits[1], places.max())

    def test_specimen_writes_both_figures(self):
        folder = self.root / "specimen"
        synthetic_run.write_specimen(folder, self.section)
        code, printed, err = self.command("specimen", folder)
        self.assertEqual((code, err), (0, ""))
        names = ["gradation.png", "morphology.png"]
        self.assertEqual(printed, [str(folder / "figures" / name) for name in names])
        self.assertEqual(png_size(Path(printed[0])), (round(style.WIDTH * style.DPI), round(3.8 * style.DPI)))
        self.assertEqual(png_size(Path(printed[1]))[0], 6 * style.DPI)

    def test_specimen_of_a_run_is_read_from_its_subfolder(self):
        synthetic_run.write_specimen(self.run_folder / "specimen", self.section)
        (self.run_folder / "specimen" / "fields" / "mesh.h5").unlink()
        code, printed, _ = self.command("specimen", self.run_folder)
        self.assertEqual(code, 0)
        self.assertEqual(Path(printed[1]).parent, self.run_folder / "figures")

    def test_specimen_without_aggregates_is_drawn(self):
        folder = self.root / "specimen"
        synthetic_run.write_specimen(folder, self.section)
        (folder / "aggregates.csv").write_text("x_m,y_m,diameter_m\n")
        (folder / "gradation.csv").unlink()
        code, printed, _ = self.command("specimen", folder)
        self.assertEqual((code, [Path(line).name for line in printed]), (0, ["morphology.png"]))
        title = morphology(SpecimenFolder(folder)).axes[0].get_title()
        self.assertTrue(title.endswith("blocks; of the area aggregate 31.2 %, mortar 68.8 %"), title)

    def test_compare_writes_the_file_asked_for(self):
        other, out = self.root / "other", self.root / "new" / "both.png"
        synthetic_run.write_run(other, strength_factor=0.9, E_GPa=None, quasi_static=False)
        code, printed, err = self.command("compare", self.run_folder, other, "--out", out)
        self.assertEqual((code, printed, err), (0, [str(out)], ""))
        self.assertEqual(png_size(out), (round(style.WIDTH * style.DPI), round(4.2 * style.DPI)))

    def test_format_chooses_the_file_and_the_same_run_gives_the_same_file(self):
        contents = []
        for _ in range(2):
            self.assertEqual(self.command("run", self.run_folder, "--format", "svg")[0], 0)
            written = sorted((self.run_folder / "figures").glob("*.svg"))
            contents.append([path.read_bytes() for path in written])
        self.assertEqual(len(contents[0]), 4)
        self.assertEqual(contents[0], contents[1])

    def test_run_without_a_peak_is_drawn(self):
        synthetic_run.write_summary(self.run_folder, "no peak", [("settle", {}), ("compress", {})])
        self.assertEqual(self.command("run", self.run_folder)[0], 0)

    def test_a_run_that_was_killed_is_drawn_as_far_as_it_came(self):
        (self.run_folder / "summary.json").unlink()
        history = self.run_folder / "history.csv"
        history.write_text(history.read_text() + "1,2")  # in the midst of a row
        self.assertEqual(self.command("run", self.run_folder)[0], 0)

    def test_a_fork_is_drawn_beside_its_parent(self):
        fork = self.root / "fork"
        synthetic_run.write_run(fork, strength_factor=0.9)
        for parent, drawn in ((self.run_folder, True), (self.root / "gone", False)):
            (fork / "manifest.json").write_text(json.dumps({"parent": {"folder": str(parent)}}))
            self.assertEqual(self.command("run", fork, "--format", "svg")[0], 0)
            figure = (fork / "figures/stress_strain.svg").read_text()
            self.assertEqual("run, of which this run is a fork" in figure, drawn)

    def test_later_columns_do_not_disturb(self):
        lines = (self.run_folder / "history.csv").read_text().splitlines()
        lines = [lines[0] + ",temperature_C", *(line + ",20" for line in lines[1:])]
        (self.run_folder / "history.csv").write_text("\n".join(lines))
        self.assertEqual(self.command("run", self.run_folder)[0], 0)


def script(name: str):
    """A script of the folder `scripts`, as a module."""
    loader = importlib.machinery.SourceFileLoader(name, str(IMAGES.parents[1] / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    sys.modules[name] = module
    loader.exec_module(module)
    return module


class PicturesOfTheDocs(unittest.TestCase):
    """Committed pictures of cracked specimens, which a palette of few colours would turn grey."""

    NEAR = 20  # of 765: rounding to the palette

    def test_broken_tension_is_orange(self):
        pictures = script("pictures").PICTURES
        cracked_ones = {name for name, shown in pictures.items() if any("fracture" in f for f in shown.figures)}
        self.assertGreater(len(cracked_ones), 14)
        for name in sorted(cracked_ones | {"hot_concrete_levels", "levels"}):
            with self.subTest(name), Image.open(IMAGES / f"{name}.png") as picture:
                red, green, blue = np.moveaxis(np.asarray(picture.convert("RGB"), int), 2, 0)
                packed = np.unique(red << 16 | green << 8 | blue)  # much faster than rows of three
                colours = np.column_stack([packed >> 16, packed >> 8 & 255, packed & 255])
                wanted = np.round(255 * np.array(to_rgba(style.TENSION_COLOUR)[:3]))
                self.assertLess(np.abs(colours - wanted).sum(axis=1).min(), self.NEAR)

    def test_one_script_knows_what_makes_each(self):
        pictures = script("pictures")
        for file in sorted(IMAGES.glob("*.png")):
            self.assertTrue(pictures.maker(file.stem), file.name)
        for name, shown in pictures.PICTURES.items():
            self.assertTrue((IMAGES.parents[1] / "cases" / f"{shown.case}.toml").exists(), name)

    def test_it_draws_the_figures_of_a_run_side_by_side(self):
        pictures = script("pictures")
        with tempfile.TemporaryDirectory() as root, mock.patch.object(pictures, "IMAGES", Path(root)):
            synthetic_run.write_run(Path(root) / "cyclic")
            file = pictures.make("case_cyclic", "no program", Path(root))
            wide, _ = png_size(file)
        both = (pictures.CURVE + style.WIDTH) * pictures.DPI + pictures.GAP
        self.assertAlmostEqual(wide, both, delta=2.0)  # a pixel each


class FireFigures(HeatedTest):
    """Time heads the fields, isotherms cross them, and temperatures below the face stand beside the gas."""

    def wall(self) -> Results:
        folder = self.root / "wall"
        synthetic_run.write_conduction(folder)
        return Results(folder)

    def test_time_is_the_heading_and_colours_start_at_room_temperature(self):
        figure = temperature_field(self.wall())
        self.assertEqual([axes.get_title() for axes in figure.axes[:4]], ["4 min", "8 min", "16 min", "20 min"])
        self.assertIn("mean 60 °C", figure.axes[1].get_xlabel())
        drawn = [mesh for mesh in figure.axes[0].collections if isinstance(mesh, TriMesh)][0]
        self.assertEqual(drawn.norm.vmin, 20.0)
        self.assertGreater(np.mean(drawn.cmap(0.0)[:3]), 0.75)  # light where it is cool

    def test_isotherms_are_drawn_where_the_field_passes_them(self):
        run = self.wall()
        passed = [level for level in ISOTHERMS if level < run.gridpoint_temperature(run.frames[-1]).max()]
        self.assertEqual(passed, [300.0])
        texts = [text.get_text() for text in temperature_field(run).axes[3].texts]
        self.assertIn("300", texts)
        self.assertNotIn("500", texts)

    def test_a_bearing_is_filled_as_one_outline(self):
        figure = temperature_field(self.wall())
        fills = [polygons for polygons in figure.axes[0].collections if isinstance(polygons, PolyCollection)
                 and np.allclose(polygons.get_facecolor()[0], to_rgba(style.PLATEN_COLOUR))]
        self.assertEqual([len(polygons.get_paths()) for polygons in fills], [2])

    def test_depths_and_gas_are_drawn_beside_the_probes(self):
        run = self.wall()
        profile = read_profile(run)
        axes = temperature_history(run, profile).axes[0]
        lines = {" ".join(line.get_label().split()): line for line in axes.lines}
        for depth in (10, 20, 30, 50):
            line = lines[f"{depth} mm below the {profile.face} face"]
            self.assertAlmostEqual(line.get_ydata()[-1], np.interp(1e-3 * depth, profile.depth, profile.temperature[-1]))
        np.testing.assert_array_equal(lines["gas"].get_ydata(), run.history["gas_max_degC"])
        self.assertIn("probe a", lines)

    def test_a_depth_that_a_probe_tells_is_not_drawn_again(self):
        run = self.wall()
        profile = read_profile(run)
        probe = np.interp(run.history["heating_time_s"], profile.time, profile.at(0.02))
        with mock.patch.object(Results, "probes", {"own": probe}):
            labels = " ".join(" ".join(line.get_label().split()) for line in temperature_history(run, profile).axes[0].lines)
        self.assertIn("10 mm below", labels)
        self.assertNotIn("20 mm below", labels)

    def test_times_are_told_in_round_minutes(self):
        run = self.wall()
        profile = read_profile(run)
        off = replace(profile, time=profile.time + 3.0)  # s
        labels = [line.get_label() for line in temperature_profile(run, off).axes[0].lines]
        self.assertEqual(labels, ["0 min", "3 min", "6 min", "9 min", "11 min", "14 min", "17 min", "20 min"])
        labels = [line.get_label() for line in temperature_profile(run, replace(off, time=0.1 * off.time)).axes[0].lines]
        self.assertEqual(labels[:3], ["0.0 min", "0.3 min", "0.6 min"])


class CracksAndEnergies(HeatedTest):
    def test_cracks_are_lengths_by_mode(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        run = Results(folder)
        axes = cracks(run).axes[0]
        self.assertEqual(axes.get_ylabel(), "Length of cracks [m]")
        lines = {line.get_label(): line for line in axes.lines}
        for mode in ("tension", "shear"):
            test = Compressed(run)
            length = sum(test.column(f"{mode}_{name}_broken_length_m") for name in run.facts.crack_modes[mode])
            np.testing.assert_allclose(np.nan_to_num(lines[f"{mode}, broken ($D=1$)"].get_ydata()), length)
        labels = [area.get_label() for area in axes.collections]
        self.assertEqual(len([label for label in labels if "damaged" in label]), 2)

    def test_change_of_properties_has_a_panel_of_its_own(self):
        run = Results(self.heated("run"))
        upper, change, error = [axes for axes in energy(heating_course(run)).axes if axes.axison]
        np.testing.assert_array_equal(change.lines[0].get_ydata(), Heated(run).column("energy_property_change_J"))
        self.assertNotIn("alone", " ".join(str(line.get_label()) for line in upper.lines))
        self.assertIn("Ledger", error.get_ylabel())

    def test_nothing_is_told_to_be_0_0_percent(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        history = folder / "history.csv"
        lines = [line.split(",") for line in history.read_text().splitlines()]
        for row, kinetic in ((-2, "500"), (-1, "0")):  # it had some, and has none at the end
            lines[row][lines[0].index("energy_kinetic_J")] = kinetic
        history.write_text("\n".join(map(",".join, lines)) + "\n")
        labels = energy(loading_course(Results(folder))).axes[0].get_legend_handles_labels()[1]
        self.assertIn("kinetic: none left", labels)
        self.assertFalse([label for label in labels if ": 0.0 %" in label])

    def test_total_strain_ends_at_failure_with_an_arrow(self):
        folder = self.heated("run", Heating(critical=505.0))
        history = folder / "history.csv"
        lines = [line.split(",") for line in history.read_text().splitlines()]
        column = lines[0].index("specimen_strain")
        for row, strain in ((-3, 0.008), (-2, 0.02)):  # it falls in two exchanges before the last
            lines[row][column] = str(strain)
        history.write_text("\n".join(map(",".join, lines)) + "\n")
        axes = total_strain(Results(folder)).axes[0]
        self.assertGreater(axes.get_ylim()[0], -1.0)
        self.assertIn("to −47", [text.get_text() for text in axes.texts][0])


class RecordsAndComparisons(BodyTest):
    def test_curves_that_are_one_are_drawn_once(self):
        history = self.run_folder / "history.csv"
        lines = [line.split(",") for line in history.read_text().splitlines()]
        grip = lines[0].index("grip_N")
        rows = [",".join([*line, line[grip] if i else "right_N", f"{0.9 * float(line[grip])}" if i else "third_N"])
                for i, line in enumerate(lines)]
        history.write_text("\n".join(rows) + "\n")
        deck = self.run_folder / "deck.toml"
        deck.write_text(deck.read_text() + '[[record]]\nname = "right"\nkind = "force"\n'
                                           '[[record]]\nname = "third"\nkind = "force"\n')
        labels = [line.get_label() for line in records(Results(self.run_folder)).axes[0].lines]
        self.assertEqual([label for label in labels if not label.startswith("_")],
                         ["grip and right, within 1 %", "third"])

    def test_labels_are_those_of_the_records(self):
        axes = records(Results(self.run_folder)).axes[0]
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("stretch, opening [mm]", "grip, force [kN]"))
        self.assertIsNone(axes.get_legend())

    def test_runs_are_told_apart_by_what_their_decks_differ_in(self):
        runs = []
        for name, modulus, seed in (("a", "50 GPa", 1), ("b", "40 GPa", 1), ("c", "40 GPa", 2)):
            folder = self.root / name
            synthetic_run.write_run(folder)
            (folder / "deck.toml").write_text(f'title = "{name}"\n[specimen]\nseed = {seed}\n[materials.mortar]\n'
                                              f'E = {{ value = "{modulus}", times = "glasgow" }}\nnu = 0.2\n')
            runs.append(Results(folder))
        self.assertEqual(names_apart(runs[:2]), ["E 50 GPa", "E 40 GPa"])
        self.assertEqual(names_apart(runs), ["seed 1, E 50 GPa", "seed 1, E 40 GPa", "seed 2, E 40 GPa"])
        self.assertEqual(compare(runs).axes[0].get_title(), "Synthetic run")
        (self.root / "c" / "deck.toml").unlink()
        self.assertEqual(names_apart([*runs[:2], Results(self.root / "c")]), ["a", "b", "c"])


class FracturePanels(HeatedTest):
    """Cracks as wide as they are open, captions of three numbers, and the counts in a table."""

    def setUp(self):
        super().setUp()
        self.run_folder = self.root / "run"
        synthetic_run.write_run(self.run_folder)

    def rows(self):
        run = Results(self.run_folder)
        test = Compressed(run)
        return fracture(run, select_frames(test.frames, *test.peak))

    def test_broken_shear_is_as_wide_as_broken_tension(self):
        widths = {(crack.mode, crack.broken): crack.width for crack in CRACKS}
        self.assertEqual(widths["shear", True], widths["tension", True])
        self.assertEqual(widths["shear", False], widths["tension", False])

    def test_a_crack_is_the_wider_the_more_it_opened(self):
        run = Results(self.run_folder)
        file = self.run_folder / "fields" / f"contacts_{run.frames[-1].number:04d}.hdf"
        with h5py.File(file, "r+") as fields:
            tension, shear = fields["VTKHDF/CellData/tension_damage [1]"], fields["VTKHDF/CellData/shear_damage [1]"]
            tension[...], shear[...] = 1.0, 0.0
            opening = np.linspace(0.0, 1e-3, len(tension))
            fields["VTKHDF/CellData/opening [m]"][...] = opening
            fields["VTKHDF/CellData/tangential_jump [m]"][...] = 0.0
        rows = self.rows()
        last = rows.panels[-1]
        lines = next(lines for lines in fracture_panels(rows).axes[len(rows.panels) - 1].collections
                     if lines.get_linewidths() is not None and len(lines.get_linewidths()) > 10
                     and np.allclose(lines.get_colors()[0], to_rgba(style.TENSION_COLOUR)))
        widths = np.array(lines.get_linewidths())
        drawn = opening[cracked(last.run, last.frame, CRACKS[-1])]
        self.assertGreater(widths.max(), 2.0 * widths.min())
        self.assertTrue((np.diff(widths[np.argsort(drawn)]) >= 0.0).all())

    def test_captions_are_three_numbers_and_one_panel_is_the_peak(self):
        panels = self.rows().panels
        self.assertEqual([panel.title for panel in panels], ["A", "B, peak", "C", "D"])
        for panel in panels:
            self.assertEqual(panel.caption.count("\n"), 2, panel.caption)
        self.assertIn("% of $f_c$", panels[0].caption)

    def test_no_panel_is_the_peak_of_a_run_whose_stress_never_fell(self):
        file = self.run_folder / "summary.json"
        summary = json.loads(file.read_text())
        for stage in summary["stages"]:
            if "f_c_MPa" in stage.get("results", {}):
                stage["results"] |= {"f_c_MPa": None, "strain_at_peak": None}
        file.write_text(json.dumps(summary))
        panels = self.rows().panels
        self.assertIn("B", [panel.title for panel in panels])
        self.assertFalse([panel.title for panel in panels if "peak" in panel.title])
        self.assertIn("% of the largest", panels[0].caption)

    def test_peak_is_the_frame_before_the_fall_and_not_the_nearest_by_strain(self):
        frames = [Frame(k, 1, 100 * k, 0.0, strain, stress)
                  for k, (strain, stress) in enumerate([(0.0025, 33.0), (0.0027, 33.9), (0.00282, 27.0), (0.003, 25.0)])]
        self.assertEqual(select_frames(frames, 0.00277, 34.0)["B"], frames[1])

    def test_counts_stand_in_a_table_beside_the_figure(self):
        self.assertEqual(self.command("run", self.run_folder)[0], 0)
        with open(self.run_folder / "figures" / "fracture.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([row["panel"] for row in table], ["A", "B, peak", "C", "D"])
        run = Results(self.run_folder)
        counts, last = count_cracks(run, run.frames[-1]), table[-1]
        self.assertEqual(int(last["tension_broken"]), counts["tension", True])
        self.assertEqual(int(last["shear_damaged_above_half"]), counts["shear", False])
        which = cracked(run, run.frames[-1], CRACKS[-1])
        self.assertAlmostEqual(float(last["tension_broken_length_m"]), run.mesh.contacts.extent[which].sum(), delta=1e-9)
        self.assertEqual(self.command("levels", self.heated("hot"), "--out", self.root / "levels.png")[0], 0)
        self.assertIn("broken_share", (self.root / "levels.csv").read_text())

    def test_panels_of_a_beam_are_stacked_with_the_crack_enlarged(self):
        folder = self.root / "beam"
        section = synthetic_run.write_run(folder, columns=12, rows=3)
        middles = section.line_points[1::2]
        near = np.abs(middles[:, 0] / section.width - 0.5) < 0.06
        for file in (folder / "fields").glob("contacts_*.hdf"):
            with h5py.File(file, "r+") as fields:
                fields["VTKHDF/CellData/tension_damage [1]"][...] = near
        run = Results(folder)
        test = Compressed(run)
        rows = fracture(run, select_frames(test.frames, *test.peak))
        figure = fracture_panels(rows)
        figure.draw(FigureCanvasAgg(figure).get_renderer())
        body, enlarged, below = figure.axes[:3]
        self.assertLess(body.bbox.x1, enlarged.bbox.x0 + 1.0)
        self.assertLess(below.bbox.y1, body.bbox.y0)
        self.assertLess(np.ptp(enlarged.get_xlim()), 0.5 * np.ptp(body.get_xlim()))
        self.assertIn("enlarged", enlarged.get_title())

    def test_bearings_of_a_body_without_platens_are_not_called_so(self):
        run = Results(self.run_folder)
        shown = lambda: [handle.get_label() for handle in fracture_legend(run)]  # noqa: E731
        self.assertIn("platen", shown())
        with mock.patch.object(Results, "has_platens", False):
            self.assertIn("bearing", shown())
            self.assertNotIn("platen", shown())


class WidthOfThePage(HeatedTest):
    """--width: all text has 8 pt, legends stand in the axes and cover nothing."""

    def test_files_have_the_width(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        self.assertEqual(self.command("run", folder, "--width", "90mm")[0], 0)
        wanted = 90.0 / 25.4 * style.DPI
        self.assertAlmostEqual(png_size(folder / "figures" / "energy.png")[0], wanted, delta=1.0)
        self.assertAlmostEqual(png_size(folder / "figures" / "fracture.png")[0], 2.0 * wanted, delta=1.0)
        out = self.root / "both.png"
        self.assertEqual(self.command("compare", folder, folder, "--out", out, "--width", "8.4 cm")[0], 0)
        self.assertAlmostEqual(png_size(out)[0], 84.0 / 25.4 * style.DPI, delta=1.0)

    def test_no_picture_of_a_column_is_higher_than_four_thirds_of_its_width(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        (folder / "references.json").write_text('[{"builtin": "compression"}]')
        for width in (90, 140):
            self.assertEqual(self.command("run", folder, "--width", f"{width}mm")[0], 0)
            for file in sorted((folder / "figures").glob("*.png")):
                across, high = png_size(file)
                self.assertLessEqual(high / across * width, min(240.0, 4.0 / 3.0 * width) + 0.2, file.name)

    def test_legends_of_a_column_do_not_say_what_axes_say(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        with style.page_of(90.0 / 25.4):
            for picture in figures.figures_of(Results(folder)):
                for axes in style.settle(picture.draw()).figure.axes:
                    said = " ".join(text.get_text() for text in legend.get_texts()).lower() \
                        if (legend := axes.get_legend()) else ""
                    for word in re.findall("[a-z]{5,}", f"{axes.get_ylabel()} {axes.get_xlabel()}".lower()):
                        self.assertNotIn(word, said, picture.name)

    def test_panels_title_and_table_are_chosen(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        run = Results(folder)
        drawn = {picture.name: picture for picture in figures.figures_of(run)}
        for width in (None, 90.0 / 25.4):
            with style.page_of(width, panels=[1], title=False, table=False):
                energy = style.settle(drawn["energy"].draw())
                self.assertEqual([axes.get_ylabel() for axes in energy.axes if axes.axison], ["Energy since the start [J]"])
                self.assertIn("strain", energy.axes[0].get_xlabel())
                self.assertEqual(sum(bool(axes.get_title()) for axes in drawn["fracture"].draw().axes), 1)
                curve = style.settle(drawn["stress_strain"].draw())
                self.assertFalse(any(axes.tables for axes in curve.axes))
                self.assertNotIn(run.title, [text.get_text() for text in curve.findobj(Text)])
            with style.page_of(width, panels=[2]):
                energy = style.settle(drawn["energy"].draw())
                self.assertEqual(len([axes for axes in energy.axes if axes.axison]), 1)
            with style.page_of(width, panels=[7]), self.assertRaisesRegex(Error, "none of the numbers 7"):
                style.settle(drawn["energy"].draw())
        code, _, said = self.command("run", folder, "--only", "energy,pace", "--no-title", "--panels", "a,C")
        self.assertEqual(code, 1)
        self.assertIn("has no figure pace; its figures are stress_strain, cracks, energy", said)
        self.assertEqual([file.name for file in (folder / "figures").iterdir()], ["energy.png"])

    def test_platens_cover_cracks_unless_they_are_asked_to_show_them(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        run = Results(folder)
        test = Compressed(run)
        for shown in (False, True):
            with style.page_of(None, cracks_under_platens=shown):
                axes = fracture_panels(fracture(run, select_frames(test.frames, *test.peak))).axes[0]
            drawn = sorted(axes.collections, key=lambda one: one.get_zorder())
            over = isinstance(drawn[-1], PolyCollection) and to_rgba(style.PLATEN_COLOUR) in map(tuple, drawn[-1].get_facecolor())
            self.assertEqual(over, not shown)

    def test_a_length_needs_a_unit_and_a_range(self):
        for text in ("90", "90px", "wide", "20mm", "3m", "1000mm", "-90mm"):
            with self.subTest(text), self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()) as told:
                figures.main(["run", "nowhere", f"--width={text}"])
            for part in (text, "70mm to 400mm", "mm, cm, in", "such as 90mm"):
                self.assertIn(part, told.getvalue())

    def figures_of_runs(self):
        cold, wall = self.root / "cold", self.root / "wall"
        synthetic_run.write_run(cold)
        (cold / "references.json").write_text('[{"builtin": "compression"}]')
        synthetic_run.write_conduction(wall)
        hot = self.heated("hot", Heating(critical=605.0, unconverged=(40,), spread=60.0))
        (hot / "references.json").write_text('[{"builtin": "transient_strain"}]')
        for folder in (cold, wall, hot):
            for picture in figures.figures_of(Results(folder)):
                yield f"{folder.name}/{picture.name}", picture.draw()
        cold, hot = Results(cold), Results(hot)
        yield "compare", compare([cold])
        yield "compare total strain", compare_total_strain([hot])
        yield "compare cracks", compare_cracks([hot])
        yield "levels", fracture_panels(levels([hot]))

    def test_text_has_eight_points_and_nothing_overlaps(self):
        for width in (70.0,):  # the narrowest is the hardest
            shutil.rmtree(self.root)
            self.root.mkdir()
            with style.page_of(width / 25.4):
                for name, figure in self.figures_of_runs():
                    with self.subTest(name, width=width):
                        style.settle(figure)
                        self.assertLessEqual(figure.get_figheight(), 4.0 / 3.0 * width / 25.4 + 1e-9, name)
                        assert_apart(self, name, figure)
                        sizes = {text.get_fontsize() for text in figure.findobj(Text) if text.get_text().strip()
                                 and not isinstance(text.axes, type(None)) and text.get_visible()}
                        self.assertLessEqual(sizes, {8.0, 6.0, 7.0}, name)  # marks in a picture may be smaller
                        self.assert_legends_cover_nothing(figure)

    def assert_legends_cover_nothing(self, figure) -> None:
        renderer = FigureCanvasAgg(figure).get_renderer()
        figure.draw(renderer)
        for axes in figure.axes:
            legend = axes.get_legend()
            if legend is None or not hasattr(legend, "on_top"):
                continue
            below = legend.get_window_extent(renderer).y0
            for line in axes.lines:
                if line.get_transform() == axes.transData:
                    y = line.get_transform().transform(line.get_xydata())[:, 1]
                    self.assertLess(np.nanmax(y), below + 1.0, axes.get_ylabel())

    def test_without_it_figures_are_those_of_a_page(self):
        self.assertEqual(style.page(), style.Page(style.WIDTH, False))
        with style.page_of(None):
            self.assertFalse(style.page().is_column)


class PropertiesFigure(FolderTest):
    HEADER = "property,unit,temperature_degC,value,ratio_to_20_degC\n"
    ROWS = ("materials.mortar.E,Pa,20,3e10,1\nmaterials.mortar.E,Pa,800,3e9,0.1\n"
            "materials.mortar.thermal_strain,1,20,0,nan\nmaterials.mortar.thermal_strain,1,800,-0.03,nan\n"
            "contacts.mortar_mortar.f_t,Pa,20,2e6,1\ncontacts.mortar_mortar.f_t,Pa,800,1e6,0.5\n")

    def write(self, text: str) -> None:
        (self.root / "properties.csv").write_text(text)

    def test_is_drawn_with_or_without_heat(self):
        self.write(self.HEADER + self.ROWS)
        self.assertEqual(self.command("properties", self.root)[0], 0)
        without_heat = png_size(self.root / "figures" / "properties.png")
        self.write(self.HEADER + self.ROWS + "materials.mortar.conductivity,W/m/K,20,2,1\n"
                                             "materials.mortar.heat_capacity,J/m3/K,20,2e6,1\n")
        self.assertEqual(self.command("properties", self.root)[0], 0)
        self.assertGreater(png_size(self.root / "figures" / "properties.png")[1], without_heat[1])

    def test_reads_each_property(self):
        self.write(self.HEADER + self.ROWS)
        table = read_properties(self.root / "properties.csv")
        self.assertEqual(list(table), ["materials.mortar.E", "materials.mortar.thermal_strain",
                                       "contacts.mortar_mortar.f_t"])
        modulus = table["materials.mortar.E"]
        self.assertEqual((modulus.unit, modulus.temperature.tolist(), modulus.value.tolist(),
                          modulus.ratio.tolist()), ("Pa", [20.0, 800.0], [3e10, 3e9], [1.0, 0.1]))

    def test_what_is_wrong_is_named(self):
        self.assert_fails(["properties", self.root], "properties.csv", "cannot be read")
        self.write(self.HEADER)
        self.assert_fails(["properties", self.root], "properties.csv", "no rows")
        self.write("property,unit,value\n")
        self.assert_fails(["properties", self.root], "properties.csv", "temperature_degC")
        self.write(self.HEADER + self.ROWS + "materials.mortar.E,Pa,hot,3e10,1\n")
        self.assert_fails(["properties", self.root], "properties.csv", "line 8")
        self.write(self.HEADER + "materials.mortar.E,Pa\n")
        self.assert_fails(["properties", self.root], "properties.csv", "line 2")


class ErrorsNameTheThing(FolderTest):
    def test_folder(self):
        self.assert_fails(["run", self.root / "nowhere"], "nowhere", "not a folder")

    def test_missing_files(self):
        for name in ("history.csv", "fields/mesh.h5", "fields/contacts_0007.hdf"):
            with self.subTest(name):
                path = self.run_folder / name
                aside = path.rename(self.root / "aside")
                self.assert_fails(["run", self.run_folder], str(path))
                aside.rename(path)

    def test_missing_column(self):
        for name in ("stress_MPa", "shear_mortar_mortar_broken_length_m", "energy_error_J"):
            with self.subTest(name):
                path = self.run_folder / "history.csv"
                before = path.read_text()
                replace_in(path, f",{name}", ",renamed")
                self.assert_fails(["run", self.run_folder], "history.csv", f"'{name}'")
                path.write_text(before)

    def test_a_column_that_a_run_lacks_stops_only_its_figure(self):
        path = self.run_folder / "history.csv"
        lines = [line.split(",") for line in path.read_text().splitlines()]
        kept = [i for i, name in enumerate(lines[0]) if not name.endswith("_broken_length_m")]
        path.write_text("".join(",".join(line[i] for i in kept) + "\n" for line in lines))
        code, printed, err = self.command("run", self.run_folder)
        self.assertEqual((code, [Path(line).stem for line in printed]), (1, ["stress_strain", "energy", "fracture"]))
        self.assertEqual(len(err.splitlines()), 1, err)
        self.assertIn("_broken_length_m'", err)

    def test_word_for_a_number(self):
        replace_in(self.run_folder / "history.csv", "1,1000,", "1,often,")
        self.assert_fails(["run", self.run_folder], "history.csv, line 3", "'step'", "'often'")

    def test_line_cut_short(self):
        with open(self.run_folder / "history.csv", "a") as file:
            file.write("1,2000,0.5\n")
        self.assert_fails(["run", self.run_folder], "history.csv, line 243", "3 values")

    def test_no_frames_still_draws_the_curves(self):
        frames = self.run_folder / "fields" / "frames.csv"
        header = frames.read_text().splitlines()[0] + "\n"
        for content in (header, None):
            if content is None:
                frames.unlink()
            else:
                frames.write_text(content)
            code, printed, err = self.command("run", self.run_folder)
            self.assertEqual((code, len(printed)), (1, 3))
            self.assertIn("frames.csv", err)

    def test_missing_dataset(self):
        with h5py.File(self.run_folder / "fields" / "contacts_0007.hdf", "a") as file:
            del file["VTKHDF/CellData/shear_damage [1]"]
        self.assert_fails(["run", self.run_folder], "contacts_0007.hdf", "shear_damage")

    def test_field_of_another_mesh(self):
        with h5py.File(self.run_folder / "fields" / "contacts_0007.hdf", "a") as file:
            del file["VTKHDF/CellData/shear_damage [1]"]
            file["VTKHDF/CellData/shear_damage [1]"] = np.zeros(3)
        self.assert_fails(["run", self.run_folder], "contacts_0007.hdf", "(3,)")

    def test_file_that_is_not_hdf(self):
        (self.run_folder / "fields" / "mesh.h5").write_text("no")
        self.assert_fails(["run", self.run_folder], "mesh.h5", "HDF5")

    def test_specimen_fact(self):
        folder = self.root / "specimen"
        synthetic_run.write_specimen(folder, self.section)
        replace_in(folder / "specimen.json", '"fraction_placed"', '"other"')
        self.assert_fails(["specimen", folder], "specimen.json", "'fraction_placed'")

    def test_unknown_ending(self):
        self.assert_fails(["compare", self.run_folder, "--out", self.root / "a.bmp"], "a.bmp", ".png")

    def test_never_compressed(self):
        table = Table(self.run_folder / "history.csv")
        columns = {name: np.zeros(2) for name in table.names}
        rows = np.column_stack(list(columns.values()))
        lines = [",".join(table.names), *(",".join(map(str, row)) for row in rows)]
        (self.run_folder / "history.csv").write_text("\n".join(lines))
        summary = json.loads((self.run_folder / "summary.json").read_text())
        summary["stages"][1]["results"]["f_c_MPa"] = None
        (self.run_folder / "summary.json").write_text(json.dumps(summary))
        self.assert_fails(["run", self.run_folder], "history.csv", "not compressed")


class HeatedRunsMakePictures(HeatedTest):
    def names_drawn(self, folder: Path, *options: str, are_written: bool = True) -> list[str]:
        with contextlib.nullcontext() if are_written else writing_alone():
            code, printed, err = self.command("run", folder, *options)
        self.assertEqual((code, err), (0, ""))
        for path in printed if are_written else []:
            self.assertEqual(png_size(Path(path))[0] % round(style.WIDTH * style.DPI), 0)
        self.assertEqual({Path(path).parent for path in printed}, {folder / "figures"})
        return [Path(path).stem for path in printed]

    def test_until_it_fails(self):
        folder = self.heated("run", Heating(critical=505.0, unconverged=(40,)))
        self.assertEqual(self.names_drawn(folder), ["total_strain", "heating_cracks", "heating_energy",
                                                    "convergence", "heating_fracture"])

    def test_restrained_and_not_uniform(self):
        folder = self.heated("run", Heating(restrained=True, spread=100.0))
        self.assertEqual(self.names_drawn(folder, "--temperatures", "250,650"),
                         ["thrust", "heating_cracks", "heating_energy", "temperature_history",
                          "temperature", "temperature_profile", "isotherm", "heating_fracture"])

    def test_cooled_then_compressed(self):
        folder = self.heated("run", Heating(level=0.3, hottest=300.0, cooled=True, compressed=True))
        self.assertEqual(self.names_drawn(folder),
                         ["total_strain", "heating_cracks", "heating_energy", "heating_fracture", "stress_strain", "cracks", "energy", "fracture"])

    def test_what_the_history_holds_where_no_fields_are_kept(self):
        fields = {"fracture", "heating_fracture", "temperature"}
        folders = [self.heated("hot", Heating(critical=505.0)), self.heated("spread", Heating(spread=100.0)),
                   self.heated("cooled", Heating(level=0.3, hottest=300.0, cooled=True, compressed=True)),
                   self.root / "conduction"]
        synthetic_run.write_conduction(folders[-1])
        for folder in folders:
            with_fields = self.names_drawn(folder, are_written=False)
            shutil.rmtree(folder / "fields")
            self.assertEqual(self.names_drawn(folder, are_written=False),
                             [name for name in with_fields if name not in fields])
            self.assert_fails(["run", folder, "--temperatures", "300"], "keeps no fields, so --temperatures")

    def test_conduction_without_mechanics(self):
        folder = self.root / "run"
        synthetic_run.write_conduction(folder)
        self.assertEqual(self.names_drawn(folder), ["temperature_history", "temperature", "temperature_profile"])
        run = Results(folder)
        self.assertEqual(style.title_of(run), run.title)
        self.assertEqual(list(run.probes), ["a", "b"])

    def test_compare_picks_what_the_runs_have_in_common(self):
        page = round(style.WIDTH * style.DPI), round(4.2 * style.DPI)
        loaded = [self.heated("a"), self.heated("b", Heating(critical=505.0)),
                  self.heated("c", Heating(level=0.1))]
        restrained = [self.heated("d", Heating(restrained=True))]
        compressed = [self.heated("e", Heating(hottest=200.0, compressed=True)), self.root / "f"]
        synthetic_run.write_run(compressed[1])
        for folders in (loaded, restrained, compressed):
            out = self.root / f"{folders[0].name}.png"
            self.assertEqual(self.command("compare", *folders, "--out", out), (0, [str(out)], ""))
            self.assertEqual(png_size(out), page)
        for folders in (loaded, compressed):
            out = self.root / f"cracks_{folders[0].name}.png"
            self.assertEqual(self.command("compare", *folders, "--what", "cracks", "--out", out)[0], 0)
            self.assertEqual(png_size(out)[0], page[0])

    def test_levels_draws_a_row_for_each_run(self):
        one, two = self.heated("one"), self.heated("two", Heating(level=0.675, critical=505.0))
        heights = []
        for folders in ((one,), (one, two)):
            out = self.root / "levels.png"
            code, printed, err = self.command("levels", *folders, "--temperatures", "400,600", "--out", out)
            self.assertEqual((code, printed, err), (0, [str(out)], ""))
            heights.append(png_size(out)[1])
        self.assertGreater(heights[1], 1.5 * heights[0])


class ErrorsOfHeatedRuns(HeatedTest):
    def test_temperature_without_a_frame(self):
        folder = self.heated("run")
        self.assert_fails(["run", folder, "--temperatures", "300,1000"], "frames.csv", "1000 °C", "700")

    def test_temperatures_of_a_run_that_was_not_heated(self):
        synthetic_run.write_run(self.root / "cold")
        self.assert_fails(["run", self.root / "cold", "--temperatures", "300"], "cold", "never heated")
        synthetic_run.write_conduction(self.root / "wall")
        self.assert_fails(["run", self.root / "wall", "--temperatures", "300"], "wall", "with mechanics")

    def test_runs_with_nothing_in_common(self):
        synthetic_run.write_run(self.root / "cold")
        cold, hot, out = self.root / "cold", self.heated("hot"), self.root / "out.png"
        for what in ((), ("--what", "cracks")):
            self.assert_fails(["compare", hot, cold, *what, "--out", out], "compare")
        self.assert_fails(["compare", cold, "--what", "total-strain", "--out", out], "never heated")
        self.assert_fails(["compare", hot, "--what", "stress-strain", "--out", out], "hot", "heating")
        self.assert_fails(["levels", cold, "--out", out], "frames.csv", "heating stage")

    def test_missing_field_and_column(self):
        folder = self.heated("run", Heating(spread=100.0, unconverged=(40,)))
        last = max((folder / "fields").glob("blocks_*.hdf"))
        with h5py.File(last, "a") as file:
            del file["VTKHDF/PointData/temperature [degC]"]
        self.assert_fails(["run", folder], last.name, "/VTKHDF/PointData/temperature [degC]")
        replace_in(folder / "fields" / "frames.csv", "temperature_degC", "renamed")
        out = self.root / "out.png"
        self.assert_fails(["levels", folder, "--out", out], "frames.csv", "'temperature_degC'")
        other = self.heated("other", Heating(spread=100.0, unconverged=(40,)))
        replace_in(other / "history.csv", "cycles", "renamed")
        self.assert_fails(["run", other], "history.csv", "'cycles'")

    def test_summary(self):
        folder = self.heated("run")
        self.summary_of(folder, load_level="high")
        self.assert_fails(["run", folder], "summary.json", "'load_level'")
        other = self.heated("other")
        (other / "summary.json").write_text('{"title": "other", "stages": [1]}')
        self.assert_fails(["run", other], "summary.json", "'stages'")


class FramesOfTheHeatedFractureFigure(unittest.TestCase):
    def frames(self, temperatures):
        return [Frame(k, 2, 100 * k, 0.0, 0.0, 0.0, float(t)) for k, t in enumerate(temperatures)]

    def selected(self, temperatures, failed=False):
        return [frame.temperature for frame in select_heated_frames(self.frames(temperatures), failed)]

    def test_near_the_papers_temperatures(self):
        self.assertEqual(self.selected(range(20, 801, 10)), [300, 400, 500, 600, 800])

    def test_failure_and_the_frame_before_come_first(self):
        self.assertEqual(self.selected(range(20, 691, 10), failed=True), [400, 500, 600, 680, 690])
        self.assertEqual(self.selected(range(20, 511, 10), failed=True), [300, 400, 500, 510])

    def test_last_frame_is_always_there(self):
        self.assertEqual(self.selected([20]), [20])
        self.assertEqual(self.selected([20, 120]), [120])
        self.assertEqual(self.selected([20, 310, 350], failed=True), [310, 350])

    def test_cooling_is_not_taken_for_heating(self):
        frames = self.frames([20, 280, 480, 300, 20])
        self.assertEqual(frame_near(frames, 300.0), frames[1])
        self.assertEqual(self.selected([20, 280, 480, 300, 20]), [280, 480, 20])

    def test_a_frame_25_k_away_is_the_last_to_stand_for_a_temperature(self):
        frames = self.frames([20, 325, 400])
        self.assertEqual(frame_near(frames, 300.0), frames[1])
        self.assertIsNone(frame_near(frames, 299.9))


class FramesOfTheFractureFigure(unittest.TestCase):
    """On the synthetic curve: peak 34 MPa at strain 0.003, straight down to 17 MPa at 0.006."""

    def frames(self, strains):
        return [Frame(k, 1, 100 * k, 0.0, strain, synthetic_run.stress(strain))
                for k, strain in enumerate(strains)]

    def strains(self, strains):
        selected = select_frames(self.frames(strains), synthetic_run.PEAK_STRAIN, synthetic_run.PEAK_STRESS)
        return {letter: frame.strain for letter, frame in selected.items()}

    def test_four_points_of_the_curve(self):
        # A at 85 % of the peak strain; C where the stress is 80 % of the peak, strain 0.0042.
        fine = [round(1e-5 * i, 5) for i in range(1, 601)]
        self.assertEqual(self.strains(fine), {"A": 0.00255, "B": 0.003, "C": 0.0042, "D": 0.006})

    def test_short_descent_puts_c_halfway_down(self):
        fine = [round(1e-5 * i, 5) for i in range(1, 361)]  # ends at 90 % of the peak
        self.assertEqual(self.strains(fine)["C"], 0.0033)

    def test_letters_without_a_frame_are_left_out(self):
        self.assertEqual(self.strains([0.001, 0.002, 0.003]), {"A": 0.002, "B": 0.003})
        self.assertEqual(self.strains([0.003, 0.005]), {"B": 0.003, "D": 0.005})
        self.assertEqual(self.strains([0.001]), {"B": 0.001})

    def test_peak_frame_saved_twice_at_the_end_is_not_taken_for_d(self):
        frames = self.frames([0.0025, 0.003])
        frames.append(Frame(2, 1, frames[-1].step, 0.0, 0.003, synthetic_run.PEAK_STRESS))
        selected = select_frames(frames, synthetic_run.PEAK_STRAIN, synthetic_run.PEAK_STRESS)
        self.assertEqual([*selected], ["A", "B"])

    def test_last_frame_saved_twice_is_not_taken_for_c(self):
        frames = self.frames([0.0025, 0.003, 0.004])
        frames.append(Frame(3, 1, frames[-1].step, 0.0, 0.004, synthetic_run.stress(0.004)))
        selected = select_frames(frames, synthetic_run.PEAK_STRAIN, synthetic_run.PEAK_STRESS)
        self.assertEqual([*selected], ["A", "B", "D"])


class Reference(unittest.TestCase):
    def test_numbers_of_the_generated_law(self):
        # strain, MPa: published by the project's reference data with six digits, hence the tolerance.
        for strain, stress in ((0.0, 0.0), (7.5e-05, 1.59393), (0.00105, 18.9348), (0.003, 34.7839),
                               (0.0033, 34.9936), (0.00345, 34.8878), (0.0051, 33.4358), (0.009, 30.0038)):
            self.assertAlmostEqual(float(reference.at_stress(strain)), stress, delta=5.1e-5)

    def test_slopes(self):
        step = 1e-7
        slope = (reference.at_stress(step) - reference.at_stress(0.0)) / step
        # A chord over 3e-5 of the peak strain.
        self.assertAlmostEqual(slope / reference.AT_MODULUS, 1.0, delta=1e-4)
        # Straight: a difference of values near 30 over 1e-3 keeps eleven digits.
        slope = (reference.at_stress(0.009) - reference.at_stress(0.008)) / 1e-3
        self.assertAlmostEqual(slope, reference.AT_DESCENT, delta=1e-6)

    def test_descent_leaves_the_parabola_without_a_kink(self):
        strain = np.linspace(0.0033, 0.0035, 2001)
        slopes = np.diff(reference.at_stress(strain)) / np.diff(strain)
        # The parabola's slope changes by 2 f_c / eps_peak^2 = 6.6e6 MPa, times the spacing of 1e-7.
        self.assertLess(np.abs(np.diff(slopes)).max(), 0.67)

    def test_refuses_to_extrapolate(self):
        for strain in (-1e-6, 1.001 * reference.AT_LAST_STRAIN):
            with self.assertRaises(ValueError):
                reference.at_stress(strain)
        self.assertAlmostEqual(float(reference.at_stress(reference.AT_LAST_STRAIN)), 0.0, delta=1e-9)

    def test_peak_strains_of_table_3(self):
        self.assertAlmostEqual(reference.EXPERIMENT.strain_at_peak, 0.003128, delta=5e-7)
        self.assertAlmostEqual(reference.PAPER_DEM.strain_at_peak, 0.002979, delta=5e-7)


class ReferenceBands(unittest.TestCase):
    def test_levels(self):
        self.assertEqual([band.level for band in reference.strain_bands()], [0.0, 0.225, 0.445, 0.675])
        self.assertEqual(reference.strain_band(0.2249).level, 0.225)
        self.assertIsNone(reference.strain_band(0.3))
        self.assertIsNone(reference.strain_band(None))

    def test_centre_lies_in_the_range(self):
        for band in reference.strain_bands():
            self.assertTrue((np.diff(band.temperature) > 0.0).all())
            self.assertTrue(((band.low <= band.central) & (band.central <= band.high)).all())

    def test_starts_with_the_strain_of_the_load(self):
        # The models take between the secant of the parabola and E; 1e-6 is the elongation at 20 degC itself.
        for band in reference.strain_bands():
            low, _, high = band.at(20.0)
            strain = -band.level * reference.AT_STRENGTH / reference.AT_MODULUS
            self.assertTrue(low - 1e-6 <= strain <= high + 1e-6, (band.level, low, high))

    def test_straight_between_rows_and_refused_outside(self):
        band = reference.strain_band(0.675)
        for between, left, right in zip(band.at(455.0), band.at(450.0), band.at(460.0)):
            self.assertAlmostEqual(between, 0.5 * (left + right), delta=1e-15)
        for temperature in (19.0, 501.0):
            with self.assertRaises(ValueError):
                band.at(temperature)


class HeatedReader(HeatedTest):
    def test_total_strain_is_positive_in_expansion_and_holds_the_loads(self):
        heating = Heating()
        run = Results(self.heated("run", heating))
        temperature = Heated(run).column("temperature_degC")
        expected = [heating.total_strain(t) for t in temperature]
        np.testing.assert_allclose(Heated(run).total_strain, expected, rtol=0.0, atol=1e-15)
        self.assertEqual(temperature[0], 20.0)
        self.assertAlmostEqual(Heated(run).total_strain[0], -0.225 * 35.0 / 21.5e3, delta=1e-15)
        self.assertGreater(Heated(run).total_strain[-1], 0.0)

    def test_standing_strain_is_that_between_rows_and_none_beyond(self):
        heating = Heating()
        run = Results(self.heated("run", heating))
        found = Heated(run).standing_strain([20.0, 302.5, 900.0])
        between = 0.5 * (heating.total_strain(300.0) + heating.total_strain(305.0))
        np.testing.assert_allclose(found[:2], [heating.total_strain(20.0), between], rtol=0.0, atol=1e-15)
        self.assertTrue(np.isnan(found[2]))

    def test_rows_of_the_heating(self):
        run = Results(self.heated("run"))  # settled and loaded, one row each; 20 to 700 degC in steps of 5 K
        self.assertEqual((run.history.rows, Heated(run).exchanged.sum(), Heated(run).rows.sum()), (138, 136, 137))
        self.assertTrue(Heated(run).is_last)
        self.assertEqual({frame.stage for frame in Heated(run).frames}, {2})

    def test_load_level(self):
        folder = self.heated("run")
        self.assertEqual(Heated(Results(folder)).load_level, 0.225)
        self.assertIsNone(Heated(self.summary_of(folder, load_level=None)).load_level)
        self.assertEqual(Heated(self.summary_of(folder, load_level=None, load_stress_MPa=0.0)).load_level, 0.0)

    def test_row_of_the_failure_is_neither_drawn_nor_blamed(self):
        run = Results(self.heated("run", Heating(critical=505.0, unconverged=(40,))))
        self.assertEqual(Heated(run).rows.sum() - Heated(run).standing.sum(), 1)
        self.assertEqual(run.history["temperature_degC"][Heated(run).standing][-1], 500.0)
        self.assertEqual(Heated(run).unconverged.sum(), 1)
        self.assertIn("1 OF 97 EXCHANGES NOT CONVERGED", style.title_of(run))
        self.assertGreater(strain_limits([run], [])[0], -0.6)  # the failure itself goes to -50e-3

    def test_run_that_converged_has_no_warning(self):
        run = Results(self.heated("run"))
        self.assertEqual(style.warnings_of(run), [])

    def test_compression_after_heating_counts_from_its_start(self):
        run = Results(self.heated("run", Heating(level=0.3, hottest=300.0, compressed=True)))
        self.assertFalse(Heated(run).is_last)
        self.assertAlmostEqual(Compressed(run).peak[0], synthetic_run.PEAK_STRAIN, delta=1e-12)
        self.assertAlmostEqual(Compressed(run).frames[-1].strain, synthetic_run.LAST_STRAIN, delta=1e-12)
        # Half of the strength at 20 degC, by the law that makes the run.
        self.assertAlmostEqual(Compressed(run).strength_retained, 0.5, delta=1e-12)
        # Nothing is put before the first row: the specimen is not at rest there.
        self.assertEqual(mean_curve([run])[0][0], Compressed(run).strain[0])

    def test_strength_retained_is_not_guessed(self):
        run = Results(self.heated("run", Heating(level=0.0, hottest=300.0, compressed=True)))
        self.assertIsNone(Compressed(run).strength_retained)

    def test_temperatures_of_the_field(self):
        run = Results(self.heated("run", Heating(spread=100.0)))
        self.assertFalse(Heated(run).uniform)
        blocks, temperature = run.mesh.blocks, run.gridpoint_temperature(Heated(run).frames[-1])
        platens = np.unique(blocks.zones[blocks.material == 2])
        np.testing.assert_array_equal(temperature[platens], 20.0)
        self.assertAlmostEqual(temperature.max(), 750.0, delta=1e-3)  # 700 in the mean; written as float32

    def test_temperature_orders_the_rows_only_while_it_rises(self):
        rising, cooled = Results(self.heated("a")), Results(self.heated("b", Heating(hottest=300.0, cooled=True)))
        self.assertIn("°C", heating_course(rising).label)
        self.assertIn("min", heating_course(cooled).label)
        self.assertEqual(heating_course(cooled).over[-1], 2 * 280.0 / 5.0)  # up and down at 5 K/min

    def test_mean_goes_as_far_as_all(self):
        x, y = mean_of([(np.array([1.0, 2.0, 5.0]), np.array([1.0, 2.0, 5.0])),
                        (np.array([0.0, 3.0, 2.0, 4.0]), np.array([2.0, 5.0, 9.0, 6.0]))])
        self.assertEqual((x[0], x[-1]), (1.0, 4.0))
        np.testing.assert_allclose(y, x + 1.0, rtol=1e-14)


class ReferencesOfTheDeck(HeatedTest):
    """What is drawn beside results is what the kept deck asks for, by the legend of the figure."""

    def setUp(self):
        super().setUp()
        self.compressed = self.root / "compressed"
        synthetic_run.write_run(self.compressed)

    def ask(self, folder: Path, *references: dict) -> None:
        (folder / "references.json").write_text(json.dumps(references))

    def legend(self, folder: Path, name: str, *references: dict) -> str:
        """Text of a figure of the run, drawn as svg."""
        self.ask(folder, *references)
        with writing_alone(name):
            code, _, err = self.command("run", folder, "--format", "svg")
        self.assertEqual((code, err), (0, ""))
        return (folder / "figures" / f"{name}.svg").read_text()

    def table(self, of: str, over: str, name: str = "tests_of_1976", **values: list[float]) -> dict:
        return {"name": name, "of": of, "over": over} | {"x": [0, 1], "low": [0, 1], "high": [0, 1]} | values

    def test_none_is_drawn_unless_asked_for(self):
        text = self.legend(self.compressed, "stress_strain")
        self.assertNotIn("Anderberg", text)
        self.assertNotIn("experiment", text)
        (self.compressed / "references.json").unlink()
        self.assertNotIn("Anderberg", stress_strain_text(self, self.compressed))
        self.assertNotIn("Anderberg", self.legend(self.heated("run"), "total_strain"))

    def test_built_in(self):
        text = self.legend(self.compressed, "stress_strain", {"builtin": "compression"})
        self.assertIn("Anderberg", text)
        self.assertIn("experiment", text)
        self.assertIn("Anderberg", self.legend(self.heated("run"), "total_strain", {"builtin": "transient_strain"}))

    def test_tables_of_ones_own_are_named_where_they_are_drawn(self):
        wall = self.root / "wall"
        synthetic_run.write_conduction(wall)
        for folder, figure, of, over in ((self.compressed, "stress_strain", "stress", "strain"),
                                         (self.heated("a"), "total_strain", "total_strain", "temperature"),
                                         (self.heated("b", Heating(spread=60.0)), "total_strain", "total_strain",
                                          "heating_time"),
                                         (self.heated("c", Heating(restrained=True)), "thrust", "stress",
                                          "temperature"),
                                         (wall, "temperature_history", "temperature", "heating_time")):
            with self.subTest(of=of, over=over):
                text = self.legend(folder, figure, self.table(of, over), self.table(of, over, "a range", high=[1, 2]),
                                   self.table(of, "something else", "not drawn"))
                self.assertIn("tests_of_1976", text)
                self.assertIn("a range", text)
                self.assertNotIn("not drawn", text)

    def test_uniform_runs_stand_beside_references_over_time(self):
        folder = self.heated("uniform")
        self.assertIn("tests_of_1976", self.legend(folder, "total_strain", self.table("total_strain", "heating_time")))

    def test_comparison_names_the_references_of_its_runs(self):
        out = self.root / "out.svg"
        for asked in ([], [{"builtin": "compression"}]):
            self.ask(self.compressed, *asked)
            self.assertEqual(self.command("compare", self.compressed, "--out", out)[0], 0)
            self.assertEqual("Anderberg" in out.read_text(), bool(asked))

    def test_what_is_wrong_is_named(self):
        for text, part in (("[", "cannot be read"), ("{}", "is not a JSON list"), ("[1]", "entry 0 is no object"),
                           ('[{"builtin": "other"}]', "entry 0: 'builtin' is neither"),
                           (json.dumps([self.table("stress", "strain", x=[0])]), "not alike in length"),
                           (json.dumps([self.table("stress", "strain", x=[0, "x"])]), "'x' is no list of finite numbers"),
                           (json.dumps([self.table("stress", 1)]), "'name', 'of' and 'over' are not all texts")):
            (self.compressed / "references.json").write_text(text)
            with writing_alone("stress_strain"):
                self.assert_fails(["run", self.compressed], "references.json", part)


def stress_strain_text(test: ReferencesOfTheDeck, folder: Path) -> str:
    with writing_alone("stress_strain"):
        test.assertEqual(test.command("run", folder, "--format", "svg")[0], 0)
    return (folder / "figures" / "stress_strain.svg").read_text()


class ManyRuns(HeatedTest):
    """Many runs are a range with a mean, and few are curves."""

    def lines_and_bands(self, make, folders) -> tuple[int, int]:
        axes = make([Results(folder) for folder in folders]).axes[0]
        return (len([line for line in axes.get_lines() if len(line.get_xdata()) > 2]), len(axes.collections))

    def test_twenty_are_a_range_and_a_mean(self):
        cold, hot = [], []
        for i in range(20):
            cold.append(self.root / f"cold_{i}")
            synthetic_run.write_run(cold[-1], strength_factor=0.9 + 0.01 * i)
            hot.append(self.heated(f"hot_{i}", Heating(level=0.3, expansion=0.9 + 0.01 * i)))
        restrained = [self.heated(f"held_{i}", Heating(restrained=True)) for i in range(7)]
        self.assertEqual(self.lines_and_bands(compare, cold), (1, 3))  # the others: bars of the mean peak
        self.assertEqual(self.lines_and_bands(compare_total_strain, hot), (1, 1))
        self.assertEqual(self.lines_and_bands(compare_cracks, cold), (1, 1))
        self.assertEqual(self.lines_and_bands(compare_thrust, restrained), (1, 1))
        labels = compare([Results(folder) for folder in cold]).axes[0].get_legend_handles_labels()[1]
        self.assertIn("20 runs:\nleast to greatest", labels)
        self.assertEqual(self.lines_and_bands(compare, cold[:3])[0], 4)
        self.assertEqual(self.lines_and_bands(compare, cold[:1])[0], 1)  # the mean of one is itself

    def test_the_range_is_that_of_the_runs(self):
        folders = []
        for i in range(8):
            folders.append(self.root / f"run_{i}")
            synthetic_run.write_run(folders[-1], strength_factor=0.8 + 0.05 * i)
        band = compare([Results(folder) for folder in folders]).axes[0].collections[0]
        height = band.get_paths()[0].vertices[:, 1]
        # The band's 400 points pass the peak by at most half their spacing, over which the parabola falls by 6e-5.
        self.assertAlmostEqual(height.max(), 1.15 * synthetic_run.PEAK_STRESS, delta=1e-3)

    def test_names_are_the_shortest_ends_of_paths(self):
        folders = [self.root / "a" / "seed_1", self.root / "b" / "seed_1", self.root / "b" / "seed_2"]
        for folder in folders:
            synthetic_run.write_run(folder)
        runs = [Results(folder) for folder in folders]
        self.assertEqual(names_apart(runs), ["a/seed_1", "b/seed_1", "seed_2"])
        self.assertEqual(names_apart(runs[:1]), ["Synthetic run"])
        self.assertEqual(names_apart([runs[0], runs[0]]), ["seed_1", "seed_1"])


class NothingOverlapsOrIsCutOff(HeatedTest):
    """See `assert_apart`."""

    def test_in_any_figure(self):
        cold = self.root / "cold"
        synthetic_run.write_run(cold)
        (cold / "references.json").write_text('[{"builtin": "compression"}]')
        wall = self.root / "wall"
        synthetic_run.write_conduction(wall)
        hot = self.heated("hot", Heating(critical=605.0, unconverged=(40,), spread=60.0))
        (hot / "references.json").write_text('[{"builtin": "transient_strain"}]')
        after = self.heated("after", Heating(level=0.3, hottest=300.0, cooled=True, compressed=True))
        held = self.heated("held", Heating(restrained=True, spread=60.0))
        for folder in (cold, wall, hot, after, held):
            for picture in figures.figures_of(Results(folder)):
                with self.subTest(folder=folder.name, figure=picture.name):
                    assert_apart(self, picture.name, picture.draw())
        cold, hot, held = map(Results, (cold, hot, held))
        for name, figure in (("compare", compare([cold])), ("total strain", compare_total_strain([hot])),
                             ("cracks", compare_cracks([hot])), ("levels", fracture_panels(levels([hot, held])))):
            with self.subTest(figure=name):
                assert_apart(self, name, figure)


class DepthOfTheHeat(HeatedTest):
    """Profiles across the specimen, and figures over minutes where it is not uniform."""

    def profiled(self, *faces: float) -> Results:
        """A run whose line falls to 20 degC across from each of these temperatures of its face, a minute apart."""
        folder = self.root / "wall"
        synthetic_run.write_conduction(folder)
        depth = np.linspace(0.0, 0.15, 7)
        synthetic_run.write_profile(folder, [60.0 * i for i in range(len(faces))], depth,
                                    np.array([face + (20.0 - face) * depth / 0.15 for face in faces]))
        return Results(folder)

    def test_a_profile_is_that_of_the_table(self):
        profile = read_profile(self.profiled(20.0, 260.0, 980.0))
        np.testing.assert_array_equal(profile.time, [0.0, 60.0, 120.0])
        self.assertEqual(profile.temperature.shape, (3, 7))
        np.testing.assert_allclose(profile.at(0.075), [20.0, 140.0, 500.0])
        np.testing.assert_allclose((profile.isotherm_time, profile.isotherm), ([120.0], [0.075]))

    def test_a_line_of_the_isotherm_is_drawn_only_where_there_is_one(self):
        run = self.profiled(20.0, 499.0)
        self.assertEqual(len(read_profile(run).isotherm), 0)
        self.assertNotIn("isotherm", [picture.name for picture in figures.figures_of(run)])

    def test_a_last_time_that_was_not_written_whole_is_left_out(self):
        run = self.profiled(20.0, 260.0)
        table = run.folder / "temperature_profile.csv"
        table.write_text("".join(table.read_text().splitlines(keepends=True)[:-3]))
        np.testing.assert_array_equal(read_profile(run).time, [0.0])

    def test_other_depths_at_another_time_are_refused(self):
        run = self.profiled(20.0, 260.0)
        table = run.folder / "temperature_profile.csv"
        lines = table.read_text().splitlines()
        self.assertTrue(lines[10].startswith("60.0,"))
        lines[10] = "60.0,0.06,200.0"
        table.write_text("\n".join(lines) + "\n")
        with self.assertRaisesRegex(Error, "same 7 depths"):
            read_profile(run)

    def test_figures_are_over_minutes(self):
        run, even = Results(self.heated("a", Heating(spread=80.0))), Results(self.heated("b"))
        self.assertIn("min", heating_course(run).label)
        for make, panel in ((total_strain, 1), (compare_total_strain, 0)):
            for one, unit in ((run, "[min]"), (even, "[°C]")):
                figure = make(one) if make is total_strain else make([one])
                self.assertIn(unit, figure.axes[panel].get_xlabel())
        failed = Results(self.heated("c", Heating(spread=80.0, critical=505.0)))
        marks = [line for line in total_strain(failed).axes[0].lines if str(line.get_label()).startswith("failed")]
        self.assertEqual([line.get_label() for line in marks], ["failed at 97 min"])  # 485 K at 5 K/min


class Titles(HeatedTest):
    def test_tell_load_and_temperatures_of_the_run(self):
        failed = Results(self.heated("a", Heating(critical=505.0)))
        self.assertEqual(style.title_of(failed),
                         "Synthetic heating\n$\\sigma/f_c$ = 0.225, 20 to 505 °C, failed at 505 °C")
        held = Results(self.heated("b", Heating(restrained=True, spread=80.0)))
        self.assertIn("between fixed platens, mean 20 to 700 °C", style.title_of(held))
        after = Results(self.heated("c", Heating(level=0.3, hottest=300.0, cooled=True, compressed=True)))
        self.assertIn("heated to 300 °C, compressed at 20 °C; largest stress", style.title_of(after))

    def test_long_ones_are_broken_into_lines_that_fit(self):
        folder = self.root / "run"
        synthetic_run.write_run(folder)
        for title, shown in ((15 * "long title ", (15 * "long title ").strip()),
                             (30 * "long title ", (30 * "long title ")[:200] + "… (329 characters)"),
                             ("a\x1b[31m\u202eb\n c", r"a\x1b[31m\u202eb c")):
            synthetic_run.write_summary(folder, title, [("compress", {"quasi_static": True})])
            lines = style.title_of(Results(folder)).splitlines()
            self.assertEqual(" ".join(lines), shown)
            self.assertLessEqual(max(map(len, lines)), 100)


class Reader(FolderTest):
    def test_settling_is_not_part_of_the_test(self):
        run = Results(self.run_folder)
        self.assertEqual(run.history.rows, 241)
        self.assertEqual(Compressed(run).rows.sum(), 240)
        self.assertEqual([frame.stage for frame in run.frames[:2]], [0, 1])
        self.assertEqual(len(Compressed(run).frames), len(run.frames) - 1)

    def test_stages_that_moved_the_platen_before_the_last_are_drawn_too(self):
        path = self.run_folder / "history.csv"
        lines = path.read_text().splitlines()
        path.write_text("\n".join(lines[:121] + [f"2{line[line.index(','):]}" for line in lines[121:]]) + "\n")
        stages = ("settle", "compress", "compress")
        (self.run_folder / "deck.toml").write_text("".join(f'[[stages]]\nkind = "{kind}"\n' for kind in stages))
        run = Results(self.run_folder)
        np.testing.assert_array_equal(np.flatnonzero(Compressed(run).before), np.arange(1, 120))
        curve = stress_strain(run, {}).axes[0].lines[0]
        np.testing.assert_allclose(curve.get_ydata(), run.history["stress_MPa"][1:120])

    def test_peak(self):
        strain, stress = Compressed(Results(self.run_folder)).peak
        self.assertAlmostEqual(strain, synthetic_run.PEAK_STRAIN, delta=1e-12)
        self.assertAlmostEqual(stress, synthetic_run.PEAK_STRESS, delta=1e-9)

    def test_outlines_walk_around_each_block(self):
        blocks = Results(self.run_folder).mesh.blocks
        outlines, material = blocks.outlines
        self.assertEqual([len(outline) for outline in outlines], [6] * 20 + [4] * 2)
        np.testing.assert_array_equal(material, self.section.block_material)
        for outline, block in zip(outlines, range(22)):
            x, y = blocks.points[outline].T
            area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
            a, b, c = (blocks.points[blocks.zones[blocks.block == block, i]] for i in range(3))
            zones = 0.5 * np.sum((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
            self.assertAlmostEqual(area / zones, 1.0, delta=1e-12)  # and positive: counter-clockwise

    def test_block_in_two_pieces_is_refused(self):
        with h5py.File(self.run_folder / "fields" / "mesh.h5", "a") as file:
            file["blocks/block"][6:12] = 0
        with self.assertRaisesRegex(Error, "mesh.h5.*simple polygon"):
            _ = Results(self.run_folder).mesh.blocks.outlines

    def test_platen_contacts_are_not_counted_as_cracks(self):
        run = Results(self.run_folder)
        broken_at_start = run.contact_field(run.frames[0], "tension_damage [1]") >= 1.0
        self.assertTrue(broken_at_start.any())
        counts = count_cracks(run, run.frames[0])
        self.assertEqual(set(counts.values()), {0})

    def test_counts_are_those_of_the_field(self):
        run = Results(self.run_folder)
        last = run.frames[-1]
        counts = count_cracks(run, last)
        inner = np.isin(run.mesh.contacts.interface, (1, 2))
        damage = run.contact_field(last, "tension_damage [1]")[inner]
        self.assertGreater(counts["tension", True], 0)
        self.assertEqual(counts["tension", True], np.sum(damage == 1.0))
        self.assertEqual(counts["tension", False], np.sum((damage > 0.5) & (damage < 1.0)))

    def test_mean_curve_lies_between(self):
        weaker = self.root / "weaker"
        synthetic_run.write_run(weaker, strength_factor=0.8)
        strain, stress = mean_curve([Results(self.run_folder), Results(weaker)])
        # Between history rows, 2.5e-5 apart, the straight pieces lie under the parabola by at most
        # f_c / eps_peak^2 (2.5e-5)^2 / 4 = 6e-4 MPa.
        expected = [0.9 * synthetic_run.stress(e) for e in strain]
        np.testing.assert_allclose(stress, expected, rtol=0.0, atol=7e-4)

    def test_runs_of_one_title_are_told_apart_by_their_folder(self):
        other = self.root / "other"
        synthetic_run.write_run(other, quasi_static=False)
        same_title = self.root / "same"
        synthetic_run.write_run(same_title)
        self.assertEqual(names_apart([Results(self.run_folder), Results(other), Results(same_title)]),
                         ["run", "other – NOT QUASI-STATIC", "same"])

    def test_specimen_table(self):
        folder = self.root / "specimen"
        synthetic_run.write_specimen(folder, self.section)
        specimen = SpecimenFolder(folder)
        self.assertEqual(specimen.aggregates.rows, len(self.section.circles))
        self.assertEqual(specimen.fact("fraction_placed"), 0.338)


if __name__ == "__main__":
    unittest.main()
