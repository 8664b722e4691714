"""Pages of runs, comparisons and folders: one file each, that needs nothing but a browser."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from ..errors import Error
from ..results import is_of_run, read
from ..writing import write_text
from .compare_page import compare_page
from .index_page import index_page, runs_in
from .run_page import run_page

PAGE = "report.html"


def write_page(folders: Sequence[Path], out: Path | None = None) -> Path:
    """Writes the page of a run into its folder, or to `out`; of several runs one that compares them; of a folder with
    folders of runs an index. Returns its path.

    Raises Error where a folder holds no run, or several runs have no `out`.
    """
    if len(folders) == 1 and not is_of_run(folders[0]) and runs_in(folders[0]):
        path = out or folders[0] / PAGE
        beside = path.resolve().parent
        write_text(path, index_page(folders[0], PAGE, lambda file: os.path.relpath(file.resolve(), beside)))
        return path
    runs = [read(folder) for folder in folders]
    if len(runs) > 1 and out is None:
        raise Error("report: the page of several runs needs --out FILE")
    path = out or runs[0].folder / PAGE
    write_text(path, run_page(runs[0]) if len(runs) == 1 else compare_page(runs))
    return path
