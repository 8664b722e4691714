"""`pyroclast converge DECK`: what the numbers of the computation move, beside the scatter of specimens."""

from __future__ import annotations

import argparse
import csv
import io
import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..errors import Error
from ..live.decks import toml
from ..writing import make_folder, write_text
from .driver import duration
from .foresight import folder_of_runs
from .parameters import scaled, value_at
from .scatter import deck_text, has_scatter, result_names, study_of_seeds, values_of

_AS_IT_STANDS = "as it stands"
# Of a stage, by its kind: keys that say how fast it goes, and keys that say for how long.
_RATES = {"compress": ("velocity", "fastest_velocity"), "drive": ("control.rate",)}
_TIMES = {"drive": ("duration",)}
_FEWEST_BLOCKS = 20


@dataclass(frozen=True)
class Variant:
    """A deck with another number of the computation. same_specimens: a seed makes the same blocks as before."""

    name: str
    changes: tuple[str, ...]  #: as --set takes them
    same_specimens: bool = True


def run(options: argparse.Namespace, say: Callable[[str], None]) -> int:
    """Makes the runs that are missing and says the table. Raises Error for a deck in error."""
    deck = Path(options.study).resolve()
    with folder_of_runs(Path(options.out or Path("runs") / f"{deck.stem}-converge"), not options.dry_run) as out:
        return _run_in(out, deck, options, say)


def _run_in(out: Path, deck: Path, options: argparse.Namespace, say: Callable[[str], None]) -> int:
    given = list(options.set or [])
    text = deck_text(deck, given)
    variants = [Variant(_AS_IT_STANDS, ()), *variants_of(tomllib.loads(_core.written(text)))]
    names = result_names(text)
    studies = [study_of_seeds(deck, make_folder(out / variant.name.replace(" ", "_")), f"{deck.stem}: {variant.name}",
                              [*given, *variant.changes], names, options) for variant in variants]
    for variant, study in zip(variants, studies):
        study.check()
        if options.dry_run:
            seconds = study.time_of_a_run() or math.nan
            say(f"{variant.name:<24} {options.seeds} runs of about {duration(seconds)}")
    if options.dry_run:
        return 0
    values: dict[str, dict[str, NDArray[np.float64]]] = {}
    for variant, study in zip(variants, studies):
        say(variant.name)
        if not study.run(jobs=options.jobs, say=say):
            say("stopped; to go on: the same command")
            return 130
        rows = study.rows()
        if all(row[name] is None for row in rows for name in names):
            say(f"                no result: {rows[0]['reason']}")
        values[variant.name] = values_of(rows, names)
    found = [effect(name, variant, values[_AS_IT_STANDS][name], values[variant.name][name])
             for variant in variants[1:] for name in names if has_scatter(values[_AS_IT_STANDS][name])]
    if not found:
        raise Error("no seed gave a result as the deck stands")
    for line in _lines(values[_AS_IT_STANDS], found):
        say(line)
    write_text(out / "converge.csv", _table(found))
    say(f"table           {out / 'converge.csv'}")
    return 0


def variants_of(deck: Mapping[str, Any]) -> list[Variant]:
    """Returns what can be halved or doubled in a deck."""
    rates: list[str] = []
    times: list[str] = []
    for number, stage in enumerate(deck.get("stages", [])):
        path = f"stages[{number}]"
        slowed = _found(deck, [f"{path}.{key}" for key in _RATES.get(stage.get("kind"), ())])
        slowed += _found(deck, [f"{path}.drives[{i}].velocity" for i in range(len(stage.get("drives", [])))])
        rates += slowed
        if slowed:
            times += _found(deck, [f"{path}.{key}" for key in _TIMES.get(stage.get("kind"), ())])
    variants = []
    if rates:
        variants.append(Variant("half the rate", (*_scaled(deck, rates, 0.5), *_scaled(deck, times, 2.0))))
    if increments := _found(deck, ["coupling.exchange_increment"]):
        variants.append(Variant("half the exchange step", _scaled(deck, increments, 0.5)))
    steps = _found(deck, ["mechanics.time_step"])
    for name, factor in (("half the block size", 0.5), ("double the block size", 2.0)):
        if blocks := _blocks_of_size(deck, factor):
            variants.append(Variant(name, (*blocks, *_scaled(deck, steps, factor)), False))
    return variants


def _blocks_of_size(deck: Mapping[str, Any], factor: float) -> tuple[str, ...]:
    """Returns what makes blocks so many times as large; none where they were made elsewhere or are too few."""
    if found := _found(deck, ["blocks.size"]):
        return _scaled(deck, found, factor)
    count = deck.get("blocks", {}).get("count", 0) / factor ** _dimension(deck)
    return (f"blocks.count={round(count)}",) if count >= _FEWEST_BLOCKS else ()


def _dimension(deck: Mapping[str, Any]) -> int:
    specimen = deck.get("specimen", {})
    return 3 if "depth" in specimen or specimen.get("shape") == "cylinder" else 2


def _found(deck: Mapping[str, Any], paths: Sequence[str]) -> list[str]:
    return [path for path in paths if value_at(deck, path) is not None]


def _scaled(deck: Mapping[str, Any], paths: Sequence[str], factor: float) -> tuple[str, ...]:
    return tuple(f"{path}={toml(scaled(path, value_at(deck, path), factor))}" for path in paths)


@dataclass(frozen=True)
class Effect:
    """What a variant moves a result by, over its mean as the deck stands."""

    result: str
    variant: str
    share: float  #: NaN where no seed has both
    half: float  #: half-width of the 95 % interval; NaN with one seed
    seeds: int

    @property
    def is_told(self) -> bool:
        """Whether the interval excludes none."""
        return bool(abs(self.share) > self.half)


def effect(result: str, variant: Variant, before: NDArray[np.float64], after: NDArray[np.float64]) -> Effect:
    """Returns an effect from values by seed. Seeds of the same specimens are paired; else Welch's interval."""
    from scipy.stats import t

    mean = float(np.nanmean(before))
    if variant.same_specimens:
        change = (after - before)[np.isfinite(after - before)]
        n, moved = len(change), float(change.mean()) if len(change) else math.nan
        half = float(t.ppf(0.975, n - 1) * change.std(ddof=1) / math.sqrt(n)) if n > 1 else math.nan
    else:
        a, b = before[np.isfinite(before)], after[np.isfinite(after)]
        n, moved = min(len(a), len(b)), float(b.mean() - a.mean()) if len(b) else math.nan
        half = math.nan
        if n > 1:
            va, vb = a.var(ddof=1) / len(a), b.var(ddof=1) / len(b)
            if va + vb > 0.0:
                freedom = (va + vb) ** 2 / (va**2 / (len(a) - 1) + vb**2 / (len(b) - 1))
                half = float(t.ppf(0.975, freedom) * math.sqrt(va + vb))
            else:
                half = 0.0
    size = abs(mean) if mean != 0.0 else math.nan
    return Effect(result, variant.name, moved / size, half / size, n)


def _lines(before: Mapping[str, NDArray[np.float64]], found: Sequence[Effect]) -> list[str]:
    results = list(dict.fromkeys(e.result for e in found))
    width = max(map(len, results))
    lines = ["what moves       by how much of the mean, with the 95 % interval; *: told from the scatter of the specimens"]
    for result in results:
        y = before[result][np.isfinite(before[result])]
        spread = f", one specimen scatters by {100.0 * y.std(ddof=1) / abs(y.mean()):.1f} %" if len(y) > 1 and y.mean() else ""
        lines.append(f"{result:<{width}}  {y.mean():.4g} as it stands, mean of {len(y)} seeds{spread}")
        for e in (e for e in found if e.result == result):
            if math.isnan(e.share):
                lines.append(f"    {e.variant:<24} no seed has both")
            else:
                half = "" if math.isnan(e.half) else f" ± {100.0 * e.half:.1f} %"
                lines.append(f"    {e.variant:<24} {100.0 * e.share:+.1f} %{half}{' *' if e.is_told else ''}")
    return lines


def _table(found: Sequence[Effect]) -> str:
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["result", "variant", "change", "half_width_95", "seeds", "is_told"])
    for e in found:
        writer.writerow([e.result, e.variant, *(repr(x) if math.isfinite(x) else "" for x in (e.share, e.half)), e.seeds,
                         str(e.is_told).lower()])
    return text.getvalue()
