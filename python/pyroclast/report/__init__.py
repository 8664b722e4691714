"""Pages of runs, comparisons and folders: one file each, that needs nothing but a browser."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..errors import Error
from ..results import read
from ..writing import write_text
from .compare_page import compare_page
from .run_page import run_page

PAGE = "report.html"


def write_page(folders: Sequence[Path], out: Path | None = None) -> Path:
    """Writes the page of a run into its folder, or to `out`; of several runs one that compares them. Returns its path.

    Raises Error where a folder holds no run, or several runs have no `out`.
    """
    runs = [read(folder) for folder in folders]
    if len(runs) > 1 and out is None:
        raise Error("report: the page of several runs needs --out FILE")
    path = out or runs[0].folder / PAGE
    write_text(path, run_page(runs[0]) if len(runs) == 1 else compare_page(runs))
    return path
