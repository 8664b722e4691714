"""An index of the runs in a folder: a picture of each, its results, and whether to believe them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from ..errors import Error
from ..results import read
from .judging import BAD, Card, cards, verdict, worst
from .markup import Markup, picture
from .shell import page
from .thumbnail import thumbnail

_SCRIPTS = ("index.js",)


def runs_in(folder: Path) -> list[Path]:
    """Folders of runs in a folder, by name."""
    return sorted({path.parent for name in ("history.csv", "summary.json") for path in folder.glob(f"*/{name}")})


@dataclass(frozen=True)
class _Entry:
    name: str
    title: str
    link: str  # "" without a page
    picture: Markup
    outcome: str
    level: str
    reason: str
    results: list[Card]


def index_page(folder: Path, page_name: str, relative: Callable[[Path], str]) -> str:
    """All of the page. page_name: of the page of a run in its folder, which is linked where there is one. relative:
    the path from the index to a file."""
    entries = [_entry(run, page_name, relative) for run in runs_in(folder)]
    return page("index.html", _SCRIPTS, title=f"Runs in {folder.resolve().name}", entries=entries)


def _entry(folder: Path, page_name: str, relative: Callable[[Path], str]) -> _Entry:
    link = quote(relative(folder / page_name)) if (folder / page_name).exists() else ""
    try:
        run = read(folder)
        reasons = verdict(run)
        level = worst(reasons)
        said = next((reason.text for reason in reasons if reason.level == level), "")
        small = thumbnail(run)
        shown = picture(small, f"specimen of {folder.name}") if small else Markup()
        return _Entry(folder.name, run.title, link, shown, run.outcome, level, said, cards(run))
    except Error as error:  # a damaged run is listed as one
        return _Entry(folder.name, "", link, Markup(), "cannot be read", BAD, str(error), [])
