"""An index of the runs in a folder: a picture of each, its results, and whether to believe them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from ..errors import Error
from ..stored.results import Results, read, runs_in
from .judging import BAD, Card, cards, verdict, worst
from .markup import Markup, picture
from .shell import page
from .thumbnail import thumbnail

_ID_LENGTH = 8  # characters of the name of a study's run that tell it


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
    """Returns the whole page. page_name: of the page of a run in its folder, which is linked where there is one.
    relative: the path from the index to a file.
    """
    entries = [_entry(run, name, page_name, relative) for run, name in _named(folder)]
    return page("index.html", "index.js", title=f"Runs in {folder.resolve().name}", entries=entries)


def _named(folder: Path) -> list[tuple[Path, str]]:
    """Runs of an index with their names. Those of a study are named by their seeds, in this order; one that was made
    again beside them for its pictures, such as the median of seeds, stands in the place of the first.
    """
    runs = runs_in(folder)
    of_study = [run for run in runs if run.parent != folder]
    made_from = {run: _made_from(run) for run in runs}
    alike = Counter(made_from[run] for run in of_study)
    again = {made_from[run]: run for run in runs if run.parent == folder and alike[made_from[run]] == 1}
    found: list[tuple[int, Path, str]] = []
    for run in of_study:
        _, seed = made_from[run]
        name = f"seed {seed}, {run.name[:_ID_LENGTH]}"
        twin = again.get(made_from[run])
        found.append((seed, twin or run, f"{name} ({twin.name})" if twin else name))
    alone = [run for run in runs if run.parent == folder and run not in again.values()]
    return [*((run, name) for _, run, name in sorted(found)), *((run, run.name) for run in alone)]


def _made_from(run: Path) -> tuple[str, int]:
    """Returns the name of the deck and seed; the folder's name where the manifest is damaged or missing."""
    try:
        manifest = Results(run).manifest
        return Path(manifest["deck"]).name, int(manifest["seed"])
    except (Error, KeyError, TypeError, ValueError):
        return run.name, 0


def _entry(folder: Path, name: str, page_name: str, relative: Callable[[Path], str]) -> _Entry:
    link = quote(relative(folder / page_name)) if (folder / page_name).exists() else ""
    try:
        run = read(folder)
        reasons = verdict(run)
        level = worst(reasons)
        said = next((reason.text for reason in reasons if reason.level == level), "")
        small = thumbnail(run)
        shown = picture(small, f"specimen of {name}") if small else Markup()
        return _Entry(name, run.title, link, shown, run.outcome, level, said, cards(run))
    except Error as error:  # a damaged run is listed as one
        return _Entry(name, "", link, Markup(), "cannot be read", BAD, str(error), [])
