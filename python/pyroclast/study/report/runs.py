"""Pages of those runs of a study that a reader wants to see."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from ...errors import Error
from ...report import write_page
from ...stored.results import is_of_run
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
    """Writes into a folder the pages of the best and the worst run, and of some that gave no value; of runs of which
    the study keeps more than the summary. With targets the runs are ordered by their misfit, else by the first output.
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
    done = [row for row in seen.rows if row["state"] == DONE]
    ends = _by_targets(seen, done) if seen.setup.targets else _by_first_output(seen, done)
    failed = [row for row in seen.rows if row["state"] not in (DONE, NOT_RUN)][:_MOST_FAILED]
    return [*((f"{what}, seed {row['seed']}", row) for what, row in ends),
            *((f"{row['state']}: {row['reason']}", row) for row in failed)]


def _by_first_output(seen: Seen, done: list[dict[str, Any]]) -> list[tuple[str, dict[str, Any]]]:
    output = seen.setup.outputs[0]
    rows = sorted((row for row in done if row[output.name] is not None), key=lambda row: float(row[output.name]))
    label = output_label(output)
    return [(f"{what} {label}: {number(row[output.name])}", row)
            for what, row in (("least", rows[0]), ("greatest", rows[-1]))] if len(rows) > 1 else []


def _by_targets(seen: Seen, done: list[dict[str, Any]]) -> list[tuple[str, dict[str, Any]]]:
    """Returns the runs nearest to the targets, at the best point where the method has one, and the farthest."""
    targets = seen.setup.targets
    rows = [row for row in done if all(row[target.output] is not None for target in targets)]
    if len(rows) < 2:
        return []
    findings = seen.findings or {}
    scales = findings.get("sd") or [target.sd or abs(target.value) or 1.0 for target in targets]

    def misfit(row: dict[str, Any]) -> float:
        return sum(((row[t.output] - t.value) / scale) ** 2 for t, scale in zip(targets, scales))

    def said(what: str, row: dict[str, Any]) -> tuple[str, dict[str, Any]]:
        return f"{what}: {', '.join(f'{t.output} = {number(row[t.output])}' for t in targets)}", row

    best = [row for row in rows if _is_at(seen, row, findings["best"]["u"])] if "best" in findings else []
    nearest = min(best or rows, key=misfit)
    what = "at the best point, nearest to the targets" if best else "nearest to the targets"
    return [said(what, nearest), said("farthest from the targets", max(rows, key=misfit))]


def _is_at(seen: Seen, row: dict[str, Any], u: list[float]) -> bool:
    return all(row[p.column] == p.distribution.at(float(x)) for p, x in zip(seen.setup.parameters, u))
