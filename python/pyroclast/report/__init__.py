"""Pages of runs, comparisons and folders: one file each, that needs nothing but a browser."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from ..errors import Error
from ..stored.results import is_of_run, read_at_once, runs_in
from ..writing import write_text
from .compare_page import compare_page
from .index_page import index_page
from .run_page import run_page

PAGE = "report.html"
_TRIES = 3  # where a run begins anew in a folder that is read


def write_page(folders: Sequence[Path], out: Path | None = None, reload_every: float | None = None) -> Path:
    """Writes the page of a run into its folder, or to `out`; of several runs one that compares them; of a folder with
    folders of runs an index. Returns its path.

    reload_every: seconds after which the page of a run loads itself anew; None: never.

    Raises Error where a folder holds no run, several runs have no `out`, or a run begins anew while it is read.
    """
    if len(folders) == 1 and not is_of_run(folders[0]) and runs_in(folders[0]):
        path = out or folders[0] / PAGE
        beside = path.resolve().parent
        write_text(path, index_page(folders[0], PAGE, lambda file: os.path.relpath(file.resolve(), beside)))
        return path
    if len(folders) > 1 and out is None:
        raise Error("report: the page of several runs needs --out FILE")
    path = out or folders[0] / PAGE
    write_text(path, _page_of_runs(folders, reload_every))
    return path


def _page_of_runs(folders: Sequence[Path], reload_every: float | None) -> str:
    for _ in range(_TRIES):
        begun = [_begun(folder) for folder in folders]
        try:
            runs = [read_at_once(folder) for folder in folders]
            text = run_page(runs[0], reload_every) if len(runs) == 1 else compare_page(runs)
        except Error:
            if begun == [_begun(folder) for folder in folders]:
                raise
            continue
        if begun == [_begun(folder) for folder in folders]:
            return text
    raise Error(f"{folders[0]}: a run begins anew in this folder again and again")


def _begun(folder: Path) -> list[tuple[int, int] | None]:
    """Returns marks that change as another run begins in a folder: first its files go, then it writes its manifest."""
    found: list[tuple[int, int] | None] = []
    for name, grows in (("manifest.json", False), ("history.csv", True)):
        try:
            now = (folder / name).stat()
            found.append((now.st_ino, 0 if grows else now.st_mtime_ns))
        except OSError:
            found.append(None)
    return found
