"""Figures of a study, and one page that gathers them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from ...draw.style import save
from ...writing import make_folder, write_text
from ..study import Study
from . import calibration, ensemble, indices, posterior, responses, secant
from .page import page_of
from .runs import pages_of_runs
from .section import Section
from .seen import Seen, seen

PAGE = "report.html"
FINDINGS = "findings.json"
_FORMATS = ("pdf", "png")
_SECTIONS: dict[str, Callable[[Seen], list[Section]]] = {
    "ensemble": ensemble.sections, "grid": responses.sections, "lhs": responses.sections, "morris": indices.sections,
    "sobol": indices.sections, "chaos": indices.sections, "calibrate": calibration.sections,
    "secant": secant.sections, "posterior": posterior.sections}


def write_report(study: Study, out: Path | None = None) -> Path:
    """Draws the figures of a study into report/ of its folder, writes its findings there, and a page with all of it.

    What an earlier report left there is taken away. A study that is not complete gets a page of what there is. Returns
    the page.

    out: a folder for all of these in the place of the study's own, which is then only read; nothing is taken away.
    """
    found = seen(study)
    if out is None:
        folder = make_folder(study.setup.folder / "report")
        _clear(folder)
    else:
        folder = out
        folder.mkdir(parents=True, exist_ok=True)
    if found.findings is not None:
        findings = json.dumps(found.findings, ensure_ascii=False, allow_nan=False)
        write_text(folder / FINDINGS, findings)
    sections = _SECTIONS[found.method](found) if found.findings is not None else []
    pictures = _save(sections, folder)
    page = folder / PAGE
    write_text(page, page_of(found, sections, pictures, pages_of_runs(found, folder)))
    return page


def _clear(folder: Path) -> None:
    """Clears the folder of figures, findings and pages of runs, some of which the study may have no more, and of files
    that were never finished.
    """
    patterns = ("*.pdf", "*.png", "run-*.html", "*.partial", FINDINGS)
    for file in [file for pattern in patterns for file in folder.glob(pattern)]:
        file.unlink(missing_ok=True)


def _save(sections: Sequence[Section], folder: Path) -> dict[str, bytes]:
    """Saves figures; returns each PNG by the name of its figure."""
    pictures = {}
    for shown in (shown for section in sections for shown in section.figures):
        for ending in _FORMATS:
            save(shown.figure, folder / f"{shown.name}.{ending}")
            shown.figure.set_layout_engine("none")  # it has its layout, which takes most of the time
        pictures[shown.name] = (folder / f"{shown.name}.png").read_bytes()
    return pictures
