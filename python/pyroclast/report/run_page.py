"""The page of a run: how strong, whether to believe it, when and where it cracked, and why."""

from __future__ import annotations

import shlex
from dataclasses import asdict, replace
from typing import Any, NamedTuple

import numpy as np

from ..draw import style
from ..draw.progress import energies_out
from ..draw.properties import panels, read_properties
from ..errors import Error
from ..stored.heated import Heated
from ..stored.lost_strength import lost_strength
from ..stored.results import Results, SpecimenFolder
from .bodies import fitted
from .course import course_of, rows_of_frames
from .judging import Card, cards, stage_verdict, verdict, worst
from .shell import page

MOST_TEXT = 9_500_000  # characters of packed numbers on a page
_MOST_FACTS = 40
_SAME_TEMPERATURE = 0.5  # K


class RunData(NamedTuple):
    """A run as the script of a page has it."""

    data: dict[str, Any]
    notes: list[str]  #: what was left out


def run_data(run: Results, most: int = MOST_TEXT) -> RunData:
    """Packs the history and fields, the fields in about so many characters at most; none of them where that is 0."""
    course = course_of(run)
    notes = list(course.notes)
    data: dict[str, Any] = {
        "title": run.title, "name": run.folder.resolve().name, "moves": run.moves, "course": course.about,
        "arrays": {"history": course.array}, "parent": None, "body": None, "frames": []}
    if course.parent:
        data["parent"] = {"name": course.parent["name"], "columns": course.parent["columns"]}
        data["arrays"]["parent"] = course.parent["rows"]
    if not most:
        return RunData(data, notes)
    if not run.has_fields or not run.frames:
        yet = "has no fields yet" if run.outcome == "running" else "keeps no fields"
        notes.append(f"the run {yet}, so there is no specimen to look at")
        return RunData(data, notes)
    rows = rows_of_frames(run)
    row_of = {frame.number: row for frame, row in zip(run.frames, rows)}
    marked = {min((row for row in rows if row >= end), default=rows[-1]) for mark in course.marks for end in mark.rows}
    try:
        body = fitted(run, most, lambda frame: row_of[frame.number] in marked)
    except Error as error:
        return RunData(data, [*notes, f"the specimen cannot be shown: {error}"])
    if not body.frames:
        return RunData(data, notes + body.notes)
    place = dict(zip((frame.number for frame in run.frames), course.about["frames"]))
    data["frames"] = [{**asdict(frame), "row": place[frame.number]} for frame in body.frames]
    data["body"] = body.about
    data["arrays"].update(body.arrays)
    return RunData(data, notes + body.notes)


def run_page(run: Results, reload_every: float | None = None) -> str:
    """Returns all of the page. reload_every: seconds after which it loads itself anew; None: never."""
    data, notes = run_data(run)
    reasons = verdict(run)
    facts = [*map(_without_formulas, style.facts_of(run)), *_temperature(run), _tested(run)]
    body = data["body"]
    data["properties"] = _properties(run)
    return page("run.html", "run.js", data, reload_every=reload_every, title=run.title, outcome=run.outcome,
                facts=facts, level=worst(reasons), cards=_cards(run, data), reasons=reasons, notes=notes,
                stages=_stages(run), has_body=body is not None,
                is_solid=bool(body and body["solid"]), steps=_steps(run, body), specimen=_specimen(run),
                gradation=_gradation(run), deck=run.deck_text, changes=_changes(run), made=_made(run),
                can_crack=bool(run.moves and run.facts.crack_modes),
                lost=[(one.interface, one.direction, f"{one.share:.3f}") for one in lost_strength(run)],
                has_properties=bool(data["properties"]))


def _cards(run: Results, data: dict[str, Any]) -> list[Card]:
    """Returns the headlines of the run; only one whose place the curve has leads there."""
    places = {mark["id"] for mark in data["course"]["marks"]}
    return [replace(card, mark=card.mark if card.mark in places else "",
                    of=_tested(run) if card.mark == "peak" and card.unit == "MPa" else card.of) for card in cards(run)]


def _tested(run: Results) -> str:
    """Returns how much a number of the run stands for: one specimen, of so many blocks."""
    blocks = run.summary.get("specimen", {}).get("blocks")
    count = f", {blocks:,} blocks" if isinstance(blocks, int) else ""
    space = (", in space" if run.facts.dimension == 3 else ", in the plane") if run.facts.crack_modes else ""
    seed = run.manifest.get("seed")
    return f"one specimen{f' (seed {seed})' if seed is not None else ''}{count}{space}"


def _temperature(run: Results) -> list[str]:
    """Returns the temperature of a cold test; nothing of a heated one."""
    known = run.history["temperature_degC"]
    known = known[np.isfinite(known)]
    if not run.moves or not Heated(run).uniform or not len(known) or np.ptp(known) > _SAME_TEMPERATURE:
        return []
    return [f"{known[0]:.0f} °C throughout"]


def _without_formulas(fact: str) -> str:
    return fact.replace("$", "").replace("\\sigma", "σ")


def _stages(run: Results) -> list[dict[str, Any]]:
    """Returns what the summary says of each stage, with its numbers in short, and how it is judged."""
    said = []
    for number, stage in enumerate(run.stages, 1):
        results = {name: _shown(value) for name, value in stage.get("results", {}).items() if value is not None}
        said.append({"number": number, "kind": str(stage.get("kind", "")), "outcome": str(stage.get("outcome", "")),
                     "level": worst(stage_verdict(stage)), "results": results})
    return said


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _steps(run: Results, body: dict[str, Any] | None) -> list[tuple[str, str]]:
    """Returns what the page rounds, and to which step."""
    if body is None:
        return []
    names = {"corner": ("places", 1e6, "µm"), "point": ("places", 1e6, "µm"), "move_x": ("displacements", 1e6, "µm"),
             "shift_x": ("displacements of blocks", 1e6, "µm"), "temperature": ("temperatures", 1.0, "K"),
             "stress_y": ("stresses", 1.0, "MPa"), "opening": ("openings", 1e6, "µm"),
             "creep_y": ("creep strains", 1.0, ""), "pore_pressure": ("pore pressures", 1.0, "MPa"),
             "saturation": ("saturations", 1.0, ""), "gone": ("blocks that have left", 1.0, "")}
    found = [(label, f"{factor * body['steps'][name]:.3g} {unit}".strip())
             for name, (label, factor, unit) in names.items() if name in body["steps"]]
    called = {column.of: column.label for column, *_ in energies_out(run)}
    found += [(f"energies that contacts lost: {called[loss]}", f"{step:.3g} J")
              for name, step in body["steps"].items() if (loss := name.removeprefix("lost_")) != name]
    return [*found, ("damages", "1/127")] if body["modes"] else found


def _specimen(run: Results) -> list[tuple[str, str]]:
    facts = run.summary.get("specimen", {})
    shown = []
    for name, value in facts.items() if isinstance(facts, dict) else []:
        parts = value.items() if isinstance(value, dict) else [("", value)]
        shown += [(f"{name} {part}".replace("_", " ").strip(), _shown(inner)) for part, inner in parts]
    for name in ("estimated_E_GPa", "t_b_m", "time_step_s", "mass_over_real_mass", "steps"):
        if run.summary.get(name) is not None:
            shown.append((name.replace("_", " "), _shown(run.summary[name])))
    return shown[:_MOST_FACTS]


def _gradation(run: Results) -> list[tuple[str, str, str]]:
    """Returns the diameter, mm, and the percentages that were asked and placed below it."""
    try:
        table = SpecimenFolder(run.folder).gradation
        return [(f"{1e3 * d:.3g}", f"{asked:.1f}", f"{placed:.1f}") for d, asked, placed
                in zip(table["d_m"], table["asked_percent"], table["placed_percent"])][:_MOST_FACTS]
    except Error:
        return []  # a specimen without circles has none


def _properties(run: Results) -> list[dict[str, Any]]:
    """Returns panels of properties over the temperature; none where the temperature of the run stays."""
    path = run.folder / "properties.csv"
    if not path.exists():
        return []
    return [{"title": panel.title, "label": panel.label, "from0": panel.from_zero,
             "lines": [{"name": line.label, "x": line.curve.temperature.tolist(), "y": line.shown.tolist()}
                       for line in panel.lines]} for panel in panels(read_properties(path))]


def _changes(run: Results) -> list[str]:
    """Returns what `--set` and `--seed` of the command changed of the deck."""
    try:
        words = shlex.split(str(run.manifest.get("command", "")))
    except ValueError:
        return []
    found = []
    for i, word in enumerate(words):
        for option in ("--set", "--seed"):
            if word == option and i + 1 < len(words):
                found.append(words[i + 1] if option == "--set" else f"seed = {words[i + 1]}")
            elif word.startswith(f"{option}="):
                found.append(word[len(option) + 1:] if option == "--set" else f"seed = {word[len(option) + 1:]}")
    return found


def _made(run: Results) -> list[tuple[str, str]]:
    shown = []
    for name, value in run.manifest.items():
        if isinstance(value, (str, int, float)) and value != "":
            shown.append((name.replace("_", " "), str(value)))
    if isinstance(run.summary.get("wall_time_s"), (int, float)):
        shown.append(("wall time", f"{run.summary['wall_time_s']:.1f} s"))
    return shown[:_MOST_FACTS]
