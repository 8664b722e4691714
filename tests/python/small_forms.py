"""Folders of runs to draw and to damage: small forms of the cases, which the test reference.small leaves behind."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import numpy as np
import pandas

FORMS = Path(os.environ["SMALL_FORMS"])
FRAMES = 14
_KEPT = tempfile.TemporaryDirectory()


def copy(form: str, to: Path, fields: bool = True) -> Path:
    """Copies a run with at most FRAMES frames, or with none, and without checkpoints. Returns its folder."""
    shutil.copytree(_thinned(form), to, ignore=None if fields else shutil.ignore_patterns("fields"))
    return to


def copy_specimen(form: str, to: Path) -> Path:
    """Copies a run's specimen into a folder as `pyroclast specimen` makes it."""
    shutil.copytree(_thinned(form) / "specimen", to)
    (to / "fields").mkdir()
    shutil.copy(_thinned(form) / "fields" / "mesh.h5", to / "fields")
    return to


@cache
def _thinned(form: str) -> Path:
    folder = Path(_KEPT.name) / form
    shutil.copytree(FORMS / form, folder, ignore=shutil.ignore_patterns("checkpoints", "*.hdf", "*.series", "figures"))
    with table(folder / "fields" / "frames.csv") as frames:
        kept = np.unique(np.linspace(0, len(frames) - 1, FRAMES).round().astype(int))
        for new, old in enumerate(kept):
            for file in (FORMS / form / "fields").glob(f"*_{old:04d}.hdf"):
                shutil.copy(file, folder / "fields" / f"{file.stem[:-5]}_{new:04d}.hdf")
        frames.drop(frames.index.difference(kept), inplace=True)
        frames["frame"] = range(len(frames))
    return folder


@contextmanager
def table(file: Path) -> Iterator[pandas.DataFrame]:
    """Lets the cells of a table, which are texts, be changed."""
    cells = pandas.read_csv(file, dtype=str, keep_default_na=False)
    yield cells
    cells.to_csv(file, index=False)


@contextmanager
def facts(file: Path) -> Iterator[dict]:
    """Lets values of a JSON file be changed."""
    values = json.loads(file.read_text())
    yield values
    file.write_text(json.dumps(values))
