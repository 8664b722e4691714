"""The history of a run for a page: its columns, and what may be drawn over what."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ..draw import style
from ..draw.heating import GAS
from ..draw.progress import energies_in, energies_out
from ..draw.records import abscissa, leading, records_of
from ..stored.compressed import Compressed
from ..stored.heated import Heated
from ..stored.reference import TRANSIENT_STRAIN, strain_band
from ..stored.results import Results
from ..stored.run_facts import (BAR, BROKEN, DAMAGED, DAMAGED_EXTENT, HELD, OPENING, PROBE, PROBE_PRESSURE, SPALLING,
                                WATER)
from .marks import Mark, marks
from .packing import packed_floats

OVER_LOAD = "strain_of_load"
"""Quantity over which runs are compared: heat before the load has moved the strain of each by its own amount."""
_MOST_CELLS = 40_000  # of the history that a page keeps
_MOST_ROWS_OF_PARENT = 400
_WATER = {"largest_pressure": "largest pore pressure [MPa]",
          "largest_pressure_ratio": "largest vapour pressure over saturation [–]",
          "largest_pressure_over_strength": "largest pore pressure over tensile strength, intact contacts [–]",
          "held": "water in the pores [kg]",
          "left": "water that left [kg]", "released": "water that hydrates gave back [kg]"}
"""Labels of columns on water, by their meaning."""
_SPALLING = {"pieces": ("pieces that left", 1.0), "mass": ("mass that left [kg]", 1.0),
             "mean_depth": ("depth lost in the mean [mm]", 1e3), "largest_depth": ("largest depth lost [mm]", 1e3),
             "lost_section": ("share of the section lost [–]", 1.0)}
"""Labels of columns on pieces that left, by their meaning, and factors to their units."""


@dataclass(frozen=True)
class CurveQuantity:
    """A column that curves are drawn of or over. The name of a reference is that of decks."""

    id: str
    label: str
    column: str
    factor: float = 1.0
    reference: str = ""
    offset: float = 0.0  #: taken off, in the unit of the label
    stage: int = 0  #: from which the quantity has values


def quantities(run: Results) -> list[CurveQuantity]:
    """Returns all quantities that a run has."""
    return [one for one in _all(run) if one.column in run.history.names]


def _all(run: Results) -> Iterator[CurveQuantity]:
    test = Compressed(run)
    hot = Heated(run)
    yield CurveQuantity("strain", "axial strain, compression positive [10⁻³]", "strain", 1e3, "strain")
    if run.moves and run.has_platens and not hot.is_last and np.isfinite(run.history[run.facts.press("stress")]).any():
        before = test.strain_before
        yield CurveQuantity(OVER_LOAD, "axial strain since loading began, compression positive [10⁻³]", "strain", 1e3,
                            offset=1e3 * before, stage=int(run.history["stage"][test.rows][0]) if before else 0)
    if run.has_platens:
        yield CurveQuantity("stress", "axial stress, compression positive [MPa]", run.facts.press("stress"), 1.0,
                            "stress")
    yield CurveQuantity("total_strain", "total axial strain, expansion positive [10⁻³]", "specimen_strain", -1e3,
                   "total_strain")
    yield CurveQuantity("lateral_strain", "lateral strain, expansion positive [10⁻³]", "lateral_strain", 1e3)
    for record in records_of(run):
        yield CurveQuantity(f"record_{record.name}", record.title, record.column, record.factor, record.name)
    mean = "" if hot.uniform else "mean "
    yield CurveQuantity("temperature", f"{mean}temperature [°C]", "temperature_degC", 1.0, "temperature")
    yield CurveQuantity("minutes", "time of heating [min]", "heating_time_s", 1.0 / 60.0, "heating_time")
    yield CurveQuantity("temperature_min", "least temperature [°C]", "temperature_min_degC")
    yield CurveQuantity("temperature_max", "greatest temperature [°C]", "temperature_max_degC")
    yield CurveQuantity("gas", "hottest gas [°C]", GAS)
    for probe in run.facts.of_role(PROBE):
        yield CurveQuantity(f"probe {probe.of}", f"probe {probe.of} [°C]", probe.name, 1.0, probe.of)
    water = {column.of: column.name for column in run.facts.of_role(WATER)}
    for of, label in _WATER.items():
        if of in water:
            yield CurveQuantity(f"water_{of}", label, water[of])
    for probe in run.facts.of_role(PROBE_PRESSURE):
        yield CurveQuantity(f"pore {probe.of}", f"pore pressure at probe {probe.of} [MPa]", probe.name)
    spalling = {column.of: column.name for column in run.facts.of_role(SPALLING)}
    for of, (label, factor) in _SPALLING.items():
        if of in spalling:
            yield CurveQuantity(f"spalled_{of}", label, spalling[of], factor)
    for bar in run.facts.of_role(BAR):
        yield CurveQuantity(f"bar {bar.of}", f"at the depth of {bar.of} [°C]", bar.name)
    yield CurveQuantity("time", "time of the mechanics [s]", "time_s", 1.0, "time")
    yield CurveQuantity("step", "step", "step")
    for opening in run.facts.of_role(OPENING):
        yield CurveQuantity("mean_opening", "mean opening of contacts damaged in tension or mixed mode [µm]",
                            opening.name, 1e6)
    yield CurveQuantity("unbalanced", "unbalanced ratio [–]", "unbalanced_ratio")
    yield CurveQuantity("kinetic", "kinetic over strain energy [–]", "kinetic_over_strain")
    yield CurveQuantity("cycles", "cycles after the exchange", "cycles")


def _drawn(run: Results) -> tuple[str, list[str]]:
    """Returns ids of what the first curve is drawn over, and of what."""
    hot = Heated(run)
    if not run.moves:
        return "minutes", ["temperature", "temperature_min", "temperature_max",
                           *(f"probe {name}" for name in run.probes)]
    if not run.has_platens:
        records = records_of(run)
        over, _, _ = abscissa(run, records)
        about = leading(records)
        return f"record_{over.name}" if over else "time", [f"record_{about.name}"] if about else ["kinetic"]
    if hot.exchanged.any() and hot.is_last:
        return "minutes" if hot.timed else "temperature", ["stress" if hot.restrained else "total_strain"]
    return "strain", ["stress"]


@dataclass(frozen=True)
class PackedCourse:
    about: dict[str, Any]  #: for JSON
    array: dict[str, Any]  #: (rows, columns)
    parent: dict[str, Any] | None  #: the same of the run that this one is a fork of
    marks: list[Mark]  #: their rows are of the whole history
    notes: list[str]


def course_of(run: Results) -> PackedCourse:
    """Packs the history: where it is long, the rows that a curve needs, marks and ends of stages."""
    history = run.history
    there = quantities(run)
    by_id = {one.id: one for one in there}
    over, drawn = _drawn(run)
    over = over if over in by_id else next(iter(by_id), "")
    drawn = [name for name in drawn if name in by_id]
    first = history[by_id[drawn[0]].column] * by_id[drawn[0]].factor if drawn else None
    goes_back = over not in ("", "time", "minutes", "temperature")
    found = marks(run, first, history[by_id[over].column] * by_id[over].factor if goes_back else None)
    stage = history["stage"]
    frames = rows_of_frames(run)
    needed = {row for mark in found for row in mark.rows} | set(frames) | {0, history.rows - 1}
    needed |= set((np.flatnonzero(np.diff(stage)) + 1).tolist())
    rows = _kept(run, [by_id[name].column for name in [over, *drawn] if name], sorted(needed))
    place = {row: i for i, row in enumerate(rows.tolist())}
    about = {
        "columns": history.names,
        "quantities": [asdict(one) for one in there],
        "over": over, "drawn": drawn,
        "marks": [{"id": mark.id, "label": mark.label, "rows": [place[row] for row in mark.rows]} for mark in found],
        "frames": [place[row] for row in frames],
        "stages": _stages(run, stage[rows]),
        "energy_in": energies_in(run),
        "energy_out": [{"column": column.name, "of": column.of, "label": column.label, "colour": colour,
                        "is_held": column.role == HELD} for column, colour, _ in energies_out(run)],
        "references": list(_references(run)),
        "cracks": _cracks(run),
        "extent_unit": run.facts.extent[1],
    }
    notes = [] if len(rows) == history.rows else \
        [f"the page keeps {len(rows)} of {history.rows} rows of history.csv"]
    values = np.column_stack([history[name][rows] for name in history.names])
    return PackedCourse(about, packed_floats(values), _parent(run, there), found, notes)


def _cracks(run: Results) -> list[dict[str, str]]:
    """Returns the columns of the cracks of each mode and interface."""
    roles = {"damaged": DAMAGED, "broken": BROKEN, "extent": DAMAGED_EXTENT}
    return [{"mode": mode, "interface": interface}
            | {name: column.name for name, role in roles.items() for column in run.facts.of_role(role, mode=mode)
               if column.interface == interface}
            for mode, interfaces in run.facts.crack_modes.items() for interface in interfaces]


def rows_of_frames(run: Results) -> list[int]:
    """Returns the row of the history of each frame."""
    if run.moves:
        rows = np.searchsorted(run.history["step"], [frame.step for frame in run.frames])
    else:
        rows = np.searchsorted(run.history["heating_time_s"], [frame.time * (1.0 - 1e-9) for frame in run.frames])
    return np.minimum(rows, run.history.rows - 1).tolist()


def _kept(run: Results, columns: list[str], needed: list[int]) -> np.ndarray:
    history = run.history
    most = max(200, _MOST_CELLS // len(history.names))
    kept = style.kept(np.arange(history.rows), *(history[name] for name in columns), most=most)
    kept[needed] = True
    return np.flatnonzero(kept)


def _stages(run: Results, stage: np.ndarray) -> list[dict[str, Any]]:
    """Returns the kind, and first and last of the kept rows, of each stage that has rows."""
    kinds = [str(one.get("kind", "")) for one in run.deck_stages]
    found = []
    for number in np.unique(stage[np.isfinite(stage)]).astype(int).tolist():
        rows = np.flatnonzero(stage == number)
        found.append({"number": number, "kind": kinds[number] if number < len(kinds) else "",
                      "first": int(rows[0]), "last": int(rows[-1])})
    return found


def _references(run: Results) -> Iterator[dict[str, Any]]:
    hot = Heated(run)
    for table in run.references.tables:
        yield {"name": table.name, "of": table.of, "over": table.over, "x": table.x.tolist(),
               "low": table.low.tolist(), "high": table.high.tolist()}
    if TRANSIENT_STRAIN in run.references.builtin and run.moves and run.has_platens and not hot.timed:
        if band := strain_band(hot.load_level):
            yield {"name": "range of models calibrated on tests", "of": "total_strain", "over": "temperature",
                   "x": band.temperature.tolist(), "low": band.low.tolist(), "high": band.high.tolist()}


def _parent(run: Results, there: list[CurveQuantity]) -> dict[str, Any] | None:
    parent = run.parent
    if parent is None:
        return None
    columns = [one.column for one in there if one.column in parent.history.names]
    rows = style.kept(np.arange(parent.history.rows), most=_MOST_ROWS_OF_PARENT)
    values = np.column_stack([parent.history[name][rows] for name in columns])
    return {"columns": columns, "name": parent.folder.name, "rows": packed_floats(values)}
