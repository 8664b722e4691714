"""The page of several runs: their curves together, their specimens at the same strain or temperature, and what of their
decks differs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from ..draw.curves import ends_apart
from ..draw.style import warnings_of
from ..errors import Error
from ..stored.deck_differences import DeckPath, differing_keys, tells_nothing, values_of, written
from ..stored.results import Results
from .course import OVER_LOAD
from .judging import Card, cards, verdict, worst
from .run_page import MOST_TEXT, run_data
from .shell import page

_MOST_BODIES = 6
"""Specimens that a page shows; of further runs it shows the curves."""


def compare_page(runs: Sequence[Results]) -> str:
    """Returns the whole page. Raises Error where the runs have nothing in common to be drawn over."""
    whole = [run_data(run, MOST_TEXT // min(len(runs), _MOST_BODIES) if i < _MOST_BODIES else 0)
             for i, run in enumerate(runs)]
    names = ends_apart([run.folder.resolve() for run in runs])
    notes = [f"{name}: {note}" for name, data in zip(names, whole) for note in data.notes]
    if len(runs) > _MOST_BODIES:
        notes.append(f"only the first {_MOST_BODIES} runs have specimens here")
    differences = deck_differences(runs)
    levels = [worst(verdict(run)) for run in runs]
    data = {"runs": [{**one.data, "name": name, "level": level} for name, one, level in zip(names, whole, levels)],
            "over": _common([one.data for one in whole], "over"), "of": _common([one.data for one in whole], "of"),
            "seeds": len(runs) > 2 and [one.key for one in differences] == ["seed"],
            "same": [list(pair) for pair in combinations(range(min(len(runs), _MOST_BODIES)), 2)
                     if all(whole[k].data["body"] for k in pair) and _is_same_specimen(*(runs[k] for k in pair))]}
    return page("compare.html", "compare.js", data, title=f"{len(runs)} runs compared", names=names,
                levels=levels, titles=[run.title for run in runs],
                warnings=[", ".join(warnings_of(run)) for run in runs],
                results=_results(runs), differences=differences, entangled=_entangled(differences), notes=notes,
                outcomes=[run.outcome for run in runs], has_body=any(one.data["body"] for one in whole))


def _common(runs: list[dict[str, Any]], what: str) -> str:
    """Returns the first quantity that all runs have, of those that their own curves show. what: "over" or "of"."""
    there = set.intersection(*({one["id"] for one in run["course"]["quantities"]} for run in runs))
    asked = [name for run in runs for name in ([run["course"]["over"]] if what == "over" else run["course"]["drawn"])]
    asked = [OVER_LOAD, *asked] if "strain" in asked and what == "over" else asked
    found = next((name for name in asked if name in there), None)
    if found is None:
        raise Error("report: the runs have nothing in common that a curve could be drawn "
                    f"{'over' if what == 'over' else 'of'}: {', '.join(dict.fromkeys(asked))}")
    return found


class Result(NamedTuple):
    """A headline of one run, beside that of the first."""

    card: Card | None
    change: str  #: against the first run, in per cent; "" where one of the two has no number


def _results(runs: Sequence[Results]) -> list[tuple[str, list[Result]]]:
    """Returns a row for each headline in which the runs differ: label with unit, and what each run has."""
    found = [{(card.label, card.unit): card for card in cards(run)} for run in runs]
    labels = dict.fromkeys(key for one in found for key, card in one.items() if card.unit or card.value != "–")
    units = {label for label, unit in labels if unit}
    shown = [key for key in labels if key[1] or key[0] not in units]
    rows = [(f"{label} [{unit}]" if unit else label,
             [one.get((label, unit)) or one.get((label, "")) for one in found]) for label, unit in shown]
    return [(label, [Result(card, _change(line[0], card) if i else "") for i, card in enumerate(line)])
            for label, line in rows if len({card and (card.value, card.level) for card in line}) > 1]


def _change(first: Card | None, other: Card | None) -> str:
    if first is None or other is None or not first.number or other.number is None:
        return ""
    return f"{100.0 * (other.number - first.number) / abs(first.number):+.1f} %".replace("-", "−")


class Difference(NamedTuple):
    """A key of the decks whose values are not all the same."""

    key: str  #: as messages have it
    values: list[str]  #: of each run; "–" where its deck does not have the key
    stage: str  #: the stage that the key belongs to, as the page counts them; "" of others
    changes_results: bool


def deck_differences(runs: Sequence[Results]) -> list[Difference]:
    """Returns the differences in the order of the decks."""
    decks = [values_of(run.deck) for run in runs]
    for run, values in zip(runs, decks):
        if "seed" in run.manifest:
            values["seed",] = str(run.manifest["seed"])
            values.pop(("specimen", "seed"), None)
    return [Difference(written(key), [values.get(key, "–") for values in decks], _stage_of(key, runs),
                       not tells_nothing(key)) for key in differing_keys(decks)]


def _stage_of(key: DeckPath, runs: Sequence[Results]) -> str:
    if len(key) < 2 or key[0] != "stages" or not isinstance(key[1], int):
        return ""
    kinds = dict.fromkeys(str(run.deck_stages[key[1]].get("kind", "")) for run in runs if key[1] < len(run.deck_stages))
    return ", ".join([f"stage {key[1] + 1}", *filter(None, kinds)])


def _entangled(differences: Sequence[Difference]) -> str:
    """Says so where keys differ together, so that nobody can tell which of them changed the results."""
    changing = [one for one in differences if one.changes_results]
    if len(changing) < 2:
        return ""
    patterns = Counter(tuple(one.values.index(value) for value in one.values) for one in changing)
    together = len(changing) if len(changing) >= len(changing[0].values) else max(patterns.values())
    if together < 2:
        return ""
    which = f"{together} keys differ" if together == len(changing) else f"{together} keys differ between the same runs"
    return f"{which}: their effects cannot be told apart"


def _is_same_specimen(one: Results, other: Results) -> bool:
    return all(np.array_equal(a, b) for a, b in ((one.mesh.blocks.points, other.mesh.blocks.points),
                                                 (one.mesh.contacts.points, other.mesh.contacts.points),
                                                 (one.mesh.contacts.interface, other.mesh.contacts.interface)))
