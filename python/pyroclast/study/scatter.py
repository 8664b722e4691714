"""`pyroclast run DECK --seeds N`: one deck with several seeds, each result with its mean and 95 % interval."""

from __future__ import annotations

import argparse
import csv
import io
import subprocess
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..draw.comparisons import compare_seeds
from ..draw.style import save
from ..errors import Error
from ..stored.results import Results
from ..writing import write_text
from .foresight import folder_of_runs, foresee
from .methods import ensemble
from .study import Study

_HEADLINE = ("f_c_MPa", "critical_temperature_degC")
_SHARE = 0.1  # of a mean: half of an interval that is narrow enough for a table


def run(options: argparse.Namespace, say: Callable[[str], None]) -> int:
    """Makes the runs that are missing, says mean and interval of each result, and draws the median specimen.

    Raises Error for a deck in error, and where no run gave a value.
    """
    deck = Path(options.study).resolve()
    with folder_of_runs(Path(options.out or Path("runs") / f"{deck.stem}-seeds"), not options.dry_run) as out:
        return _run_in(out, deck, options, say)


def _run_in(out: Path, deck: Path, options: argparse.Namespace, say: Callable[[str], None]) -> int:
    changes = options.set or []
    names = result_names(deck_text(deck, changes))
    if not names:
        raise Error(f"{options.study}: its run has no result that could scatter: state [[stages.results]], or a stage that "
                    "measures one")
    study = study_of_seeds(deck, out, f"Scatter of {deck.stem}", changes, names, options, keep="history")
    for warning in study.check():
        say(f"warning         {warning}")
    if options.dry_run:
        foresee(study, say)
        return 0
    if not study.run(jobs=options.jobs, say=say):
        say("stopped; to go on: the same command")
        return 130
    rows = study.rows()
    values = values_of(rows, names)
    found = {name: ensemble.summary(y) for name, y in values.items() if has_scatter(y)}
    if not found:
        reasons = sorted({str(row["reason"]) for row in rows})
        raise Error(f"no seed gave a result: {'; '.join(reasons[:3])}")
    for line in _lines(found, len(rows)):
        say(line)
    for name, reasons in study.missing().items():
        if reasons and not np.isfinite(values[name]).any():
            say(f"none            {name}: {reasons[0]}")
    for line in study.warnings():
        say(f"warning         {line}")
    write_text(out / "scatter.csv", _table(found))
    say(f"table           {out / 'scatter.csv'}; the runs: {out / 'table.csv'}")
    if not options.no_figures:
        _draw(study, rows, found, out, options, say)
    return 0


def deck_text(deck: Path, changes: Sequence[str]) -> _core.DeckText:
    """Returns a deck with changes as --set takes them."""
    return _core.DeckText(_core.read(str(deck)), str(deck), str(deck.parent), list(changes), [], [], False, False)


def result_names(deck: _core.DeckText) -> list[str]:
    """Returns names of the results of the test that a run of a deck may have."""
    session = _core.Session.begin(deck, None, 1, "", None, None, False, "")
    names = session.test_results()
    session.close()
    return names


def study_of_seeds(deck: Path, folder: Path, title: str, changes: Sequence[str], names: Sequence[str],
                   options: argparse.Namespace, **keys: str) -> Study:
    """Makes an ensemble of a deck in a folder. changes: as --set takes them; names: outputs; keys: more of [study]."""
    stated = dict(map(_change, changes))
    headline = next((name for name in _HEADLINE if name in names), "")
    return Study(folder / "study.toml", program=options.program, title=title,
                 study={"deck": str(deck), "folder": ".", "seeds": options.seeds, "first_seed": options.seed, **keys,
                        "may_lack": [name for name in names if name != headline],
                        **({"changes": stated} if stated else {})},
                 method={"kind": "ensemble"}, outputs={name: name for name in names})


def values_of(rows: Sequence[dict[str, Any]], names: Sequence[str]) -> dict[str, NDArray[np.float64]]:
    """Returns results by name, a number for each seed; NaN where it has none."""
    return {name: np.array([np.nan if row[name] is None else float(row[name]) for row in rows]) for name in names}


def has_scatter(y: NDArray[np.float64]) -> bool:
    """Returns whether a seed has the result, and it is not 0 in all of them."""
    return bool(np.isfinite(y).any() and np.nanmax(np.abs(y)) > 0.0)


def _change(text: str) -> tuple[str, Any]:
    """Returns a key and its value of `--set key=value`; what is no TOML is a text."""
    path, _, value = text.partition("=")
    try:
        return path.strip(), tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return path.strip(), value.strip()


def _lines(found: dict[str, ensemble.Summary], seeds: int) -> list[str]:
    lines = [f"result          mean of {seeds} seeds ± half its 95 % interval (Student's t), standard deviation of one "
             "specimen"]
    width = max(map(len, found))
    for name, s in found.items():
        digits = _digits(s)
        interval = f"± {0.5 * (s.high - s.low):.2g}" if s.n > 1 else "(one seed)"
        share = f" ({100.0 * s.variation:.1f} %)" if np.isfinite(s.variation) else ""
        spread = f"sd {s.sd:.2g}{share}" if s.n > 1 else ""
        missing = f"; {s.missing} of {seeds} seeds have none" if s.missing else ""
        wanted = ensemble.seeds_for(_SHARE, s.variation)
        more = f"; ± {100.0 * _SHARE:.0f} % takes about {wanted} seeds" if wanted is not None and wanted > s.n else ""
        lines.append(f"                {name:<{width}}  {s.mean:.{digits}g} {interval}  {spread}{more}{missing}")
    return lines


def _digits(s: ensemble.Summary) -> int:
    """Returns digits of a mean down to the first of its interval's half-width, and one more: three or four."""
    half = 0.5 * (s.high - s.low)
    if not np.isfinite(half) or half <= 0.0 or s.mean == 0.0:
        return 4
    return int(np.clip(2 + np.floor(np.log10(abs(s.mean))) - np.floor(np.log10(half)), 3, 4))


def _runs(study: Study, rows: Sequence[dict[str, Any]]) -> list[Results]:
    """Runs that came to an end."""
    folder = study.setup.folder / "runs"
    return [Results(folder / str(row["run"])) for row in rows if row["state"] in ("done", "no value")]


def _table(found: dict[str, ensemble.Summary]) -> str:
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["result", "mean", "low_95", "high_95", "sd", "seeds", "without"])
    for name, s in found.items():
        writer.writerow([name, *(repr(x) if np.isfinite(x) else "" for x in (s.mean, s.low, s.high, s.sd)), s.n, s.missing])
    return text.getvalue()


def _draw(study: Study, rows: Sequence[dict[str, Any]], found: dict[str, ensemble.Summary], out: Path,
          options: argparse.Namespace, say: Callable[[str], None]) -> None:
    """Draws the curves of all seeds with their band, and all pictures of the specimen in the middle."""
    try:
        say(f"figure          {save(compare_seeds(_runs(study, rows)), out / 'figures' / 'seeds.png')}")
    except Error as error:
        say(f"no band         {error}")
    name = next((key for key in _HEADLINE if key in found), next(iter(found)))
    known = sorted((float(row[name]), int(row["seed"])) for row in rows if row[name] is not None)
    seed = known[(len(known) - 1) // 2][1]
    say(f"median          seed {seed}, by {name}: runs again for its pictures, {out / 'median/figures'}")
    words = [options.program, "run", str(Path(options.study)), "--of-study", "--seed", str(seed), "--out", str(out / "median"),
             "--overwrite", "--quiet"]
    for change in options.set or []:
        words += ["--set", change]
    if (done := subprocess.run(words, check=False)).returncode not in (0, 2):
        raise Error(f"the run of seed {seed} ended with {done.returncode}")
