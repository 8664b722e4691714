"""Pages of folders that are damaged: each is an error that names the file, or a page that says what is missing."""

import os
import pathlib
import shutil
import unittest
from unittest import mock

import h5py
import numpy as np
from browser import RUNS, FolderTest

from pyroclast.errors import Error
from pyroclast.report.run_page import run_page
from pyroclast.stored.files import Table
from pyroclast.stored.results import Results, read, read_at_once

_CELLS = "VTKHDF/CellData"


def _empty(path: pathlib.Path) -> None:
    path.write_bytes(b"")


def _halve(path: pathlib.Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def _folder(path: pathlib.Path) -> None:
    path.unlink()
    path.mkdir()


def _written(text: str):
    return lambda path: path.write_text(text)


def _without(name: str):
    def change(path: pathlib.Path) -> None:
        with h5py.File(path, "r+") as file:
            del file[name]
    return change


def _with(name: str, values):
    def change(path: pathlib.Path) -> None:
        with h5py.File(path, "r+") as file:
            old = file[name][()]
            del file[name]
            file[name] = values(old)
    return change


_ERRORS = (
    ("history.csv", _empty, "history.csv"), ("history.csv", _folder, "history.csv"),
    ("history.csv", _written("step,stage\n"), "history.csv"),
    ("history.csv", _written("\x00\xff"), "history.csv"), ("summary.json", _empty, "summary.json"),
    ("summary.json", _written("[1]"), "summary.json"), ("manifest.json", _halve, "manifest.json"),
    ("deck.toml", _written("a = ["), "deck.toml"), ("fields/frames.csv", _written("frame,stage\n0,0\n"), "frames.csv"),
    ("properties.csv", _halve, "properties.csv"),
)
_PAGES = (
    ("fields/blocks_0001.hdf", pathlib.Path.unlink, "frame 1 is left out: "),
    ("fields/contacts_0002.hdf", _halve, "frame 2 is left out: "),
    ("fields/contacts_0002.hdf", _empty, "contacts_0002.hdf: is not a readable HDF5 file"),
    ("fields/contacts_0001.hdf", _folder, "frame 1 is left out: "),
    ("fields/contacts_0003.hdf", _without(f"{_CELLS}/crack_step [1]"), "frame 3 is left out: "),
    ("fields/contacts_0003.hdf", _without(f"{_CELLS}/lost_shear [J m-2]"), "it has other fields than the frames"),
    ("fields/contacts_0003.hdf", _with(f"{_CELLS}/opening [m]", lambda old: old[:-1]), "has shape "),
    ("fields/blocks_0001.hdf", _with(f"{_CELLS}/stress [Pa]", lambda old: np.full(old.shape, np.nan)),
     "has a value that is not finite"),
    ("fields/blocks_0001.hdf", _with(f"{_CELLS}/stress [Pa]", lambda old: "text"), "does not hold numbers"),
    ("fields/mesh.h5", _halve, "the specimen cannot be shown: "),
    ("fields/mesh.h5", pathlib.Path.unlink, "the specimen cannot be shown: "),
    ("specimen/gradation.csv", _empty, ""), ("specimen/specimen.json", _written("null"), ""),
    ("summary.json", pathlib.Path.unlink, ""),
)


class Damaged(FolderTest):
    def damaged(self, name: str, change) -> pathlib.Path:
        shutil.rmtree(self.folder / "copy", ignore_errors=True)
        run = self.copy(RUNS / "fire_one_side")
        change(run / name)
        return run

    def test_without_numbers_to_show_the_file_is_named(self):
        for number, (name, change, said) in enumerate(_ERRORS):
            with self.subTest(f"{number}, {name}"), self.assertRaisesRegex(Error, said):
                self.page_of(self.damaged(name, change))

    def test_without_a_part_the_page_says_so(self):
        for number, (name, change, said) in enumerate(_PAGES):
            with self.subTest(f"{number}, {name}"):
                self.assertIn(said, self.page_of(self.damaged(name, change)).read_text())

    def test_comparisons_and_indexes_go_on_with_the_other_runs(self):
        run = self.damaged("fields/mesh.h5", _halve)
        self.assertIn("copy: the specimen cannot be shown: ", self.page_of(RUNS / "fire_one_side", run).read_text())
        for name in ("history.csv", "manifest.json", "summary.json", "deck.toml"):
            runs = self.folder / "runs"
            shutil.rmtree(runs, ignore_errors=True)
            runs.mkdir()
            shutil.copytree(RUNS / "fire_one_side", runs / "whole")
            self.damaged(name, _empty).rename(runs / "half")
            self.assertIn("whole", self.page_of(runs).read_text())


class Changing(FolderTest):
    """A run that another process writes while its page is made."""

    def test_of_a_run_that_begins_anew_the_page_is_that_of_the_new_one(self):
        run = self.copy(RUNS / "starter")

        def begin_anew(results, _reload_every):
            shutil.rmtree(run)
            (self.copy(RUNS / "compression") / "manifest.json").touch()  # a copy keeps the time
            return "half of one run, half of another"

        steps = iter([begin_anew, run_page])
        with mock.patch("pyroclast.report.run_page", side_effect=lambda *words: next(steps)(*words)):
            self.assertIn("5,000 blocks", self.page_of(run).read_text())
        with mock.patch("pyroclast.report.run_page", side_effect=begin_anew), \
                self.assertRaisesRegex(Error, "begins anew in this folder again and again"):
            self.page_of(run)

    def test_the_history_has_the_row_of_each_frame(self):
        run = self.copy(RUNS / "compression")
        late = {path: path.read_text() for path in (run / "history.csv", run / "fields" / "frames.csv")}
        for path, text in late.items():
            lines = text.splitlines(keepends=True)
            path.write_text("".join(lines[:len(lines) // 2]))

        def read_and_go_on(path, **more):
            table = Table(path, **more)
            for other, text in late.items():
                other.write_text(text)
            return table

        with mock.patch.object(Results, "_table", staticmethod(read_and_go_on)):
            results = read_at_once(run)
        self.assertLess(len(results.frames), len(read(run).frames))
        self.assertGreaterEqual(results.history["step"][-1], results.frames[-1].step)
        self.assertEqual(results.history.rows, read(run).history.rows)


if __name__ == "__main__":
    unittest.main()
