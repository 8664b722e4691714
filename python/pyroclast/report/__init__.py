"""Pages of runs, comparisons and folders: one file each, that needs nothing but a browser."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..errors import Error
from ..results import Results, read
from ..writing import write_text
from .run_page import run_page

PAGE = "report.html"


def write_page(folders: Sequence[Path], out: Path | None = None) -> Path:
    """Writes the page of a run into its folder, or to `out`. Returns its path."""
    run = read(folders[0])
    path = out or run.folder / PAGE
    write_text(path, run_page(run))
    return path
