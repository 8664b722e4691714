"""What the runs of a study will take."""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..writing import make_folder
from .driver import StudyForecast
from .study import Study

_DISK = {"summary": (20e3, "summary"), "history": (700e3, "summary and history"), "all": (30e6, "whole folder")}
"""Bytes of a run, of the order of those that 5,000 blocks leave, and their name, by `keep`."""


def foresee(study: Study, say: Callable[[str], None]) -> None:
    """Says how many runs a study wants, their time and their disk space; makes none."""
    seen = study.forecast()
    setup = study.setup
    more = "" if seen.is_complete else " to begin with; more may follow"
    say(f"points          {seen.points}{more}")
    say(f"runs            {seen.runs}, {seen.known} of them done: {seen.left} left")
    if not seen.left:
        return
    say_time(study, seen, say)
    if setup.runner.kind == "pyroclast":
        there = next(folder for folder in (setup.folder.resolve(), *setup.folder.resolve().parents) if folder.exists())
        disk, what = _DISK[setup.keep]
        say(f"disk            about {seen.left * disk / 1e6:.0f} MB to keep the {what} of each run; "
            f"{shutil.disk_usage(there).free / 1e9:.0f} GB are free")


def say_time(study: Study, seen: StudyForecast, say: Callable[[str], None]) -> None:
    """Says how long the runs of a forecast take."""
    seconds = seen.seconds / seen.left if not math.isnan(seen.seconds) else study.time_of_a_run()
    say(f"time            {'not known before one run is done' if seconds is None else seen.time(seconds)}")


@contextmanager
def folder_of_runs(out: Path, is_kept: bool) -> Iterator[Path]:
    """Makes a folder, also of a study that only looks ahead; what this one made goes at its end."""
    made = [folder for folder in (out, *out.parents) if not folder.exists()]
    try:
        yield make_folder(out)
    finally:
        if made and not is_kept:
            shutil.rmtree(made[-1])
