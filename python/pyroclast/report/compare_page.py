"""The page of several runs: their curves together, their specimens at the same strain or temperature, and what of their
decks differs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np

from ..curves import names_apart
from ..deck_differences import differing_keys, values_of, written
from ..errors import Error
from ..results import Results
from ..style import visible
from .judging import cards, verdict, worst
from .run_page import MOST_TEXT, run_data
from .shell import page

_SCRIPTS = ("packing.js", "curves.js", "body.js", "solid.js", "specimen.js", "common.js", "compare.js")
_MOST_BODIES = 6
"""Specimens that a page shows; of further runs it shows the curves."""


def compare_page(runs: Sequence[Results]) -> str:
    """All of the page. Raises Error where the runs have nothing in common to be drawn over."""
    whole = [run_data(run, MOST_TEXT // min(len(runs), _MOST_BODIES) if i < _MOST_BODIES else 0)
             for i, run in enumerate(runs)]
    names = names_apart(runs, visible)
    notes = [f"{name}: {note}" for name, data in zip(names, whole) for note in data.notes]
    if len(runs) > _MOST_BODIES:
        notes.append(f"only the first {_MOST_BODIES} runs have specimens here")
    differences = deck_differences(runs)
    data = {"runs": [{**one.data, "name": name} for name, one in zip(names, whole)],
            "over": _common([one.data for one in whole], "over"), "of": _common([one.data for one in whole], "of"),
            "seeds": len(runs) > 2 and [key for key, _ in differences] == ["seed"],
            "same": [list(pair) for pair in combinations(range(min(len(runs), _MOST_BODIES)), 2)
                     if all(whole[k].data["body"] for k in pair) and _is_same_specimen(*(runs[k] for k in pair))]}
    return page("compare.html", _SCRIPTS, data, title=f"{len(runs)} runs compared", names=names,
                levels=[worst(verdict(run)) for run in runs], results=_results(runs), differences=differences,
                notes=notes, outcomes=[run.outcome for run in runs], has_body=any(one.data["body"] for one in whole))


def _common(runs: list[dict[str, Any]], what: str) -> str:
    """Of what the runs' own curves are drawn over, or of, the first that all runs have."""
    there = set.intersection(*({one["id"] for one in run["course"]["quantities"]} for run in runs))
    asked = [name for run in runs for name in ([run["course"]["over"]] if what == "over" else run["course"]["drawn"])]
    found = next((name for name in asked if name in there), None)
    if found is None:
        raise Error("report: the runs have nothing in common that a curve could be drawn "
                    f"{'over' if what == 'over' else 'of'}: {', '.join(dict.fromkeys(asked))}")
    return found


def _results(runs: Sequence[Results]) -> list[tuple[str, list[Any]]]:
    """A row for each headline: label with unit, and a card for each run, None where it has none."""
    found = [{(card.label, card.unit): card for card in cards(run)} for run in runs]
    labels = dict.fromkeys(key for one in found for key, card in one.items() if card.unit or card.value != "–")
    units = {label for label, unit in labels if unit}
    shown = [key for key in labels if key[1] or key[0] not in units]
    return [(f"{label} [{unit}]" if unit else label,
             [one.get((label, unit)) or one.get((label, "")) for one in found]) for label, unit in shown]


def deck_differences(runs: Sequence[Results]) -> list[tuple[str, list[str]]]:
    """Keys of the decks whose values are not all the same, and these; "–" where a deck does not have the key."""
    decks = [values_of(run.deck) for run in runs]
    for run, values in zip(runs, decks):
        if "seed" in run.manifest:
            values["seed",] = str(run.manifest["seed"])
            values.pop(("specimen", "seed"), None)
    return [(written(key), [values.get(key, "–") for values in decks]) for key in differing_keys(decks)]


def _is_same_specimen(one: Results, other: Results) -> bool:
    return all(np.array_equal(a, b) for a, b in ((one.mesh.blocks.points, other.mesh.blocks.points),
                                                 (one.mesh.contacts.points, other.mesh.contacts.points),
                                                 (one.mesh.contacts.interface, other.mesh.contacts.interface)))
