"""Figures of folders that are damaged: each is drawn, or one line says what is wrong; nothing else happens.

    SMALL_FORMS=build/strict/small_forms python3 -m unittest discover -s tests/python -p test_damaged_folders.py
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

import h5py
import numpy as np

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1] / "python"
sys.path[:0] = [str(HERE), str(PACKAGE)]

import small_forms  # noqa: E402
from pyroclast import figures
from pyroclast.draw import style  # noqa: E402
from pyroclast.draw.comparisons import compare_runs  # noqa: E402
from pyroclast.draw.fractures import fracture_panels  # noqa: E402
from pyroclast.draw.heated_sections import levels  # noqa: E402
from pyroclast.errors import Error  # noqa: E402
from pyroclast.stored.files import GapWarning  # noqa: E402
from pyroclast.stored.heated import Heated  # noqa: E402
from pyroclast.stored.results import Results  # noqa: E402
from pyroclast.watch import Watch  # noqa: E402

DAMAGED = int(os.environ.get("PYROCLAST_DAMAGED", "200"))  # 500 in a longer try
RENDERED_EVERY = int(os.environ.get("PYROCLAST_RENDERED_EVERY", "25"))  # also rendered, not only made; this is slow
WATCHED_EVERY = 10
READ_EVERY = 5
FORMS = ("starter", "transient_heating", "hot_strength", "restrained_heating", "thermal_wall")
FIGURES = 1  # of a damaged folder, drawn by lot
DRAWN = ("strain", "stress_MPa", "temperature_degC", "heating_time_s", "specimen_strain", "lateral_strain",
         "energy_loading_J", "exchange", "stage", "converged")
ODD_CELLS = ("inf", "-inf", "nan", "1e308", "-1e300", "", "word", "-1", "0", "1e9", "0x1f", "\x00")
ODD_VALUES = (None, "word", -1, 1e300, float("nan"), float("inf"), [], {}, [[]], True, "$x_$\\frac")


def cut(path, random):
    path.write_bytes(path.read_bytes()[:random.integers(path.stat().st_size)])


def zero(path, random):
    size = path.stat().st_size
    first, last = sorted(random.integers(0, size + 1, 2)) if random.random() < 0.5 else (0, size)
    content = bytearray(path.read_bytes())
    content[first:last] = bytes(last - first)
    path.write_bytes(content)


def flip(path, random):
    content = bytearray(path.read_bytes())
    # Half of the flips are at the start, where an HDF5 file has its headers and a table its names.
    reach = len(content) if random.random() < 0.5 else min(len(content), 4096)
    for place in random.integers(0, reach, random.integers(1, 20)):
        content[place] ^= 1 << random.integers(8)
    path.write_bytes(content)


def change_cells(path, random):
    """Some cells of a table, or a whole column."""
    lines = [line.split(",") for line in path.read_text().splitlines()]
    drawn = [i for i, name in enumerate(lines[0]) if name in DRAWN]
    column = drawn[random.integers(len(drawn))] if drawn and random.random() < 0.7 else random.integers(len(lines[0]))
    odd = ODD_CELLS[random.integers(len(ODD_CELLS))]
    if len(lines) == 1:  # a table without rows gets one
        lines.append(["0"] * len(lines[0]))
    rows = range(1, len(lines)) if random.random() < 0.3 else random.integers(1, len(lines), 3)
    for row in rows:
        lines[row][column] = odd
    path.write_text("\n".join(",".join(line) for line in lines) + "\n")


def change_values(path, random):
    """Some value of a JSON object, at any depth."""
    facts = json.loads(path.read_text())
    places = []

    def walk(value):
        for key in value if isinstance(value, dict) else range(len(value)):
            places.append((value, key))
            if isinstance(value[key], (dict, list)):
                walk(value[key])

    walk(facts)
    for _ in range(random.integers(1, 4)):
        value, key = places[random.integers(len(places))]
        value[key] = ODD_VALUES[random.integers(len(ODD_VALUES))]
    path.write_text(json.dumps(facts))


def change_dataset(path, random):
    """A dataset with odd numbers, another shape or another type."""
    with h5py.File(path, "a") as file:
        names = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        name = names[random.integers(len(names))]
        values, attributes = file[name][()], dict(file[name].attrs)
        kind = random.integers(4)
        if kind == 0:
            odd = (np.nan, np.inf, 1e38, -1e30, 300, -5)[random.integers(6)]
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                values.ravel()[random.integers(values.size)] = np.array(odd).astype(values.dtype)
        elif kind == 1:
            values = values[:random.integers(len(values))]
        elif kind == 2:
            values = np.array([b"word"] * len(values))
        else:
            values = random.permutation(values)
        del file[name]
        file[name] = values
        file[name].attrs.update(attributes if random.random() < 0.8 else {})


class Damaged(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.root = Path(temporary.name)
        for name in FORMS:
            for folder in (name, f"{name}_whole"):
                copied = small_forms.copy(name, cls.root / folder)
                shutil.rmtree(copied / "specimen")  # no figure of a run reads it, nor these
                for file in ("run.log", "properties.csv"):
                    (copied / file).unlink(missing_ok=True)
            (cls.root / name / "references.json").write_text(json.dumps(
                [{"builtin": "transient_strain" if name == "transient_heating" else "compression"},
                 {"name": "mine", "of": "stress", "over": "strain", "x": [0.0, 0.001], "low": [0.0, 20.0],
                  "high": [0.0, 21.0]}]))
            (cls.root / name / "deck.toml").write_text('[output]\n')
            parent = {"parent": {"folder": str(cls.root / f"{name}_whole")}}
            (cls.root / name / "manifest.json").write_text(json.dumps(parent))
        cls.content = {path: path.read_bytes() for path in cls.root.rglob("*") if path.is_file()}

    def damage(self, folder: Path, random) -> tuple[str, list[Path]]:
        """Damages a file or swaps two; returns what was done and to which."""
        files = sorted(path for path in folder.rglob("*") if path.is_file() and path.parent.name != "figures")
        common = [path for path in files if path.suffix in (".csv", ".json", ".h5", ".toml")]
        path = (common if random.random() < 0.7 else files)[random.integers(len(common))]
        if random.random() < 0.3:
            change_cells(folder / "history.csv", random)
            return "cells of", [folder / "history.csv"]
        special = {".csv": change_cells, ".json": change_values, ".h5": change_dataset, ".hdf": change_dataset,
                   ".toml": flip}
        draw = random.random()
        if draw < 0.35:
            kind = special[path.suffix]
        elif draw < 0.6:
            kind = flip
        elif draw < 0.7:
            kind = cut
        elif draw < 0.8:
            kind = zero
        elif draw < 0.85:
            path.unlink()
            return "removed", [path]
        elif draw < 0.9:
            path.write_bytes(b"")
            return "emptied", [path]
        else:
            other = files[random.integers(len(files))]
            one, two = path.read_bytes(), other.read_bytes()
            path.write_bytes(two)
            other.write_bytes(one)
            return "swapped", [path, other]
        kind(path, random)
        return kind.__name__, [path]

    def draw(self, run: Results, whole: Path, of_fields: bool, rendered: bool, random) -> None:
        """Makes some of the figures that the damage can spoil."""
        choice = [picture.draw for picture in figures.figures_of(run)
                  if not of_fields or picture.name.endswith("fracture") or picture.name == "temperature"]
        if not of_fields and run.moves:
            choice.append(lambda: compare_runs([run, Results(whole)]))
        if Heated(run).is_last:
            choice.append(lambda: fracture_panels(levels([run, Results(whole)])))
        for make in random.permutation(np.array(choice, dtype=object))[:FIGURES]:
            figure = make()
            if rendered:
                figure.savefig(io.BytesIO(), format="png", dpi=20)

    def damaged(self, every: int):
        """Each folder by turns, damaged, with what draws lots; mends it afterwards."""
        for seed in range(0, DAMAGED, every):
            random = np.random.default_rng(seed)
            folder = self.root / FORMS[seed // every % len(FORMS)]
            what, paths = self.damage(folder, random)
            with self.subTest(seed=seed, what=what, of=[path.name for path in paths]), \
                    warnings.catch_warnings(record=True) as noted:
                warnings.simplefilter("error")
                warnings.simplefilter("always", GapWarning)
                yield seed, folder, paths, random, noted
            for path in paths:
                path.write_bytes(self.content[path])

    def assert_one_line(self, error: Error) -> None:
        self.assertEqual(len(str(error).splitlines()), 1, str(error))
        self.assertIn(str(self.root), str(error))

    def test_each_is_drawn_or_told_in_one_line(self):
        drawn = told = gaps = 0
        for seed, folder, paths, random, noted in self.damaged(1):
            try:
                self.draw(Results(folder), self.root / f"{folder.name}_whole",
                          all(path.suffix in (".h5", ".hdf") for path in paths), seed % RENDERED_EVERY == 0, random)
                drawn += 1
                gaps += bool(noted)
            except Error as error:
                told += 1
                self.assert_one_line(error)
        # Damage that figures never meet would prove nothing.
        self.assertGreater(told, 0.2 * DAMAGED)
        self.assertGreater(drawn, 0.2 * DAMAGED)
        self.assertGreater(gaps, 0.02 * DAMAGED)

    def test_fields_and_notebooks_have_all_or_tell_it_in_one_line(self):
        read = told = 0
        for _, folder, *_ in self.damaged(READ_EVERY):
            try:
                results = Results(folder)
                results.fields.isel(frame=slice(None, None, 5)).load()
                results.block_fields.isel(frame=-1).load()
                read += 1
            except Error as error:
                told += 1
                self.assert_one_line(error)
            self.assertTrue(Results(folder)._repr_html_())
        self.assertGreater(told, 0.2 * DAMAGED / READ_EVERY)
        self.assertGreater(read, 0.2 * DAMAGED / READ_EVERY)

    def test_a_damaged_run_is_watched_as_far_as_it_can_be_read(self):
        shown = 0
        for _, folder, *_ in self.damaged(WATCHED_EVERY):
            watch = Watch(folder)
            curve, *_ = watch.draw().axes
            shown += bool(curve.lines)
            self.assertGreaterEqual(len(watch.text(79, 20)), 3)
        self.assertGreater(shown, 0.2 * DAMAGED / WATCHED_EVERY)


class CommandLine(unittest.TestCase):
    """The same through the command."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = small_forms.copy("starter", Path(temporary.name) / "run")

    def command(self, *arguments) -> tuple[int, str, str]:
        """Exit code and what is printed, of a process."""
        done = subprocess.run([sys.executable, "-m", "pyroclast.figures", *map(str, arguments)], text=True,
                              capture_output=True, env=os.environ | {"PYTHONPATH": str(PACKAGE)}, check=False)
        return done.returncode, done.stdout, done.stderr

    @staticmethod
    def called(*arguments) -> tuple[int, str, str]:
        """The same of this process, which need not start."""
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            return figures.main(list(map(str, arguments))), out.getvalue(), err.getvalue()

    def test_damage_is_told_in_one_line(self):
        out = self.folder / "figures" / "all.png"
        for name, damage in (("history.csv", lambda path: path.write_text(path.read_text() + "1,2\n")),
                             ("summary.json", lambda path: path.write_text("{")),
                             ("manifest.json", lambda path: path.write_text('{"parent": {"folder": 1}}')),
                             ("fields/mesh.h5", lambda path: path.write_bytes(bytes(5000)))):
            path = self.folder / name
            before = path.read_bytes() if path.exists() else b"{}"
            damage(path)
            for arguments in (("run", self.folder), ("compare", self.folder, "--out", out)):
                if arguments[0] == "compare" and name in ("fields/mesh.h5", "manifest.json"):
                    continue  # compare reads neither
                with self.subTest(name, command=arguments[0]):
                    code, _, err = self.command(*arguments) if name == "history.csv" else self.called(*arguments)
                    self.assertEqual(code, 1)
                    self.assertEqual(len(err.splitlines()), 1, err)
                    self.assertIn(str(path), err)
                    self.assertFalse(out.exists())
            path.write_bytes(before)

    def test_a_cell_that_is_not_finite_is_a_gap(self):
        with small_forms.table(self.folder / "history.csv") as cells:
            for row, name, cell in ((99, "strain", "nan"), (150, "stress_MPa", "inf"), (112, "energy_zones_J", "-inf")):
                cells.loc[row - 2, name] = cell
        code, said, err = self.command("run", self.folder)
        self.assertEqual((code, len(said.splitlines())), (0, 4), err)
        self.assertEqual(len(err.splitlines()), 1, err)
        for part in (f"{self.folder}/history.csv, line 99", "'strain'", "'nan'", "3 in all", "gaps"):
            self.assertIn(part, err)

    def test_a_picture_is_there_whole_or_not_at_all(self):
        figure = style.new_figure(2.0)
        figure.savefig = lambda path, **_: path.write_bytes(b"half") and 1 / 0
        picture = self.folder / "figures" / "energy.png"
        with self.assertRaises(ZeroDivisionError):
            style.save(figure, picture)
        self.assertEqual(list(picture.parent.iterdir()), [])

    def test_a_title_is_no_formula(self):
        for title in ("costs 3 $ or 4 $ \\frac{", "a\nb\x00c", "$"):
            with self.subTest(title):
                with small_forms.facts(self.folder / "summary.json") as summary:
                    summary["title"] = title
                marks = {}
                figures.stress_strain(Results(self.folder), marks).savefig(io.BytesIO(), format="svg")


if __name__ == "__main__":
    unittest.main()
