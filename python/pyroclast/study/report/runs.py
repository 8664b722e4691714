"""Pages of those runs of a study that a reader wants to see."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from ...errors import Error
from ...report import write_page
from ...results import is_of_run
from ..driver import NOT_RUN
from ..store import DONE
from .drawing import output_label
from .seen import Seen, number

_MOST_FAILED = 2


class RunPageLink(NamedTuple):
    """A page beside that of the study."""

    text: str
    file: str


def pages_of_runs(seen: Seen, folder: Path) -> list[RunPageLink]:
    """Writes into a folder the pages of the runs with the least and the greatest value of the first output, and of
    some that gave none; of runs of which the study keeps more than the summary.
    """
    links = []
    for text, row in _chosen(seen):
        run = seen.setup.folder / "runs" / str(row["run"])
        if not is_of_run(run) or not (run / "history.csv").exists():
            continue
        page = folder / f"run-{str(row['run'])[:12]}.html"
        try:
            write_page([run], page)
        except Error:  # a run that crashed may have left anything
            continue
        links.append(RunPageLink(text, page.name))
    return links


def _chosen(seen: Seen) -> list[tuple[str, dict[str, Any]]]:
    output = seen.setup.outputs[0]
    done = sorted((row for row in seen.rows if row["state"] == DONE and row[output.name] is not None),
                  key=lambda row: float(row[output.name]))
    label = output_label(output)
    ends = [("least", done[0]), ("greatest", done[-1])] if len(done) > 1 else []
    failed = [row for row in seen.rows if row["state"] not in (DONE, NOT_RUN)][:_MOST_FAILED]
    return [*((f"{what} {label}: {number(row[output.name])}, seed {row['seed']}", row) for what, row in ends),
            *((f"{row['state']}: {row['reason']}", row) for row in failed)]
