"""What a deck's [[record]] tables recorded: curves, and the specimen at their peak and end."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from matplotlib.figure import Figure

from ..errors import Error
from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.results import Results
from ..stored.run_facts import RECORD
from . import style
from .curves import draw_tables
from .fractures import Panel, Rows
from .progress import MINUTES_LABEL, Course

_SHOWN = {"m": ("mm", 1e3), "m2": ("cm²", 1e4), "N": ("kN", 1e-3), "degC": ("°C", 1.0)}
"""Unit of a column, how it is drawn where that is another, and what a value is multiplied by for that."""
_KINDS = {"displacement": "Displacement", "opening": "Opening", "force": "Force", "stress": "Stress",
          "temperature": "Temperature", "crack_length": "Length of cracks", "crack_area": "Area of cracks",
          "crack_opening": "Opening of cracks"}
_TIME_LABEL = "Time [s]"
_AT_PEAK = 0.95
"""Where a record has this share of its largest value, it is at its peak."""


_ALIKE, _ALIKE_ROWS = 0.01, 0.95
"""Share of its largest value by which a curve may leave another that is drawn in its place, and share of rows in which
it must not leave it farther: where a contact gives way, reactions differ for a row.
"""


class HasHistory(Protocol):
    @property
    def history(self) -> Any: ...


@dataclass(frozen=True)
class Record:
    """A column of the history that a deck asked for."""

    name: str
    kind: str
    column: str
    unit: str
    factor: float  #: from the history's unit to `unit`

    def of(self, run: HasHistory) -> np.ndarray:
        """Returns the record's values (rows,) in `unit`."""
        return self.factor * run.history[self.column]

    @property
    def label(self) -> str:
        return f"{_KINDS.get(self.kind, self.kind)} [{self.unit}]"

    @property
    def title(self) -> str:
        return f"{self.name}, {self.label[0].lower()}{self.label[1:]}"


def records_of(run: Results) -> list[Record]:
    """Returns the records of the deck that the run keeps, in its order."""
    return records_in(run.deck, {column.name: column.unit for column in run.facts.of_role(RECORD)})


def records_in(deck: Mapping[str, Any], units: Mapping[str, str]) -> list[Record]:
    """Returns the records of a deck that are among these columns, which have units, in its order."""
    columns = {name.removesuffix(f"_{unit}"): (name, *_SHOWN.get(unit, (unit, 1.0))) for name, unit in units.items()}
    asked = deck.get("record", [])
    records = []
    for record in asked if isinstance(asked, list) else []:
        name, kind = (record.get(key) for key in ("name", "kind")) if isinstance(record, dict) else (None, None)
        if name in columns:
            records.append(Record(str(name), str(kind), *columns[name]))
    return records


def leading(records: list[Record]) -> Record | None:
    """Returns what a test is about: the first force, else the first stress, else the first not drawn over."""
    over = _first(records, ("opening", "displacement"))
    return _first(records, ("force", "stress")) or next((record for record in records if record is not over), over)


def _first(records: list[Record], kinds: tuple[str, ...]) -> Record | None:
    return next((record for kind in kinds for record in records if record.kind == kind), None)


def abscissa(run: HasHistory, records: list[Record]) -> tuple[Record | None, np.ndarray, str]:
    """Returns what the others are drawn over: the first opening, else the first displacement, else time."""
    record = _first(records, ("opening", "displacement"))
    if record is None:
        return None, run.history["time_s"], _TIME_LABEL
    return record, record.of(run), record.title


def record_course(run: Results) -> Course:
    """Takes all rows in which the body moved, over what records are drawn over."""
    _, over, label = abscissa(run, records_of(run))
    rows = np.isfinite(over)
    return Course(run, rows, over[rows], label, start=float(min(0.0, over[rows].min())), ordered=False)


@dataclass(frozen=True)
class _Panel:
    """What stands in one panel of `records`."""

    records: list[Record]
    over: str  #: as references name it: a record, "time" or "heating_time"
    values: np.ndarray  #: (rows,) in the unit of the label
    label: str
    factor: float  #: from the history's unit to the label's


def _panels(run: Results) -> list[_Panel]:
    """Returns a panel for each kind of record, over what all are drawn over; more where a reference asks for others."""
    found = records_of(run)
    by_name = {record.name: record for record in found}
    common, over, label = abscissa(run, found)
    if common and len(found) == 1:  # nothing else is drawn over it
        common, over, label = None, run.history["time_s"], _TIME_LABEL
    drawn = [record for record in found if record is not common]
    over_name, factor = (common.name, common.factor) if common else ("time", 1.0)
    panels = [_Panel([record for record in drawn if record.kind == kind], over_name, over, label, factor)
              for kind in dict.fromkeys(record.kind for record in drawn)]
    asked = dict.fromkeys((table.of, table.over) for table in run.references.tables if table.of in by_name)
    for of, other in asked:
        if other == over_name or (other == "heating_time" and by_name[of].kind == "temperature" and Heated(run).heats):
            continue
        if other in by_name:
            record = by_name[other]
            panels.append(_Panel([by_name[of]], other, record.of(run), record.title, record.factor))
        elif other == "time":
            panels.append(_Panel([by_name[of]], other, run.history["time_s"], _TIME_LABEL, 1.0))
        else:
            minutes = run.history["heating_time_s"] / 60.0
            panels.append(_Panel([by_name[of]], other, minutes, MINUTES_LABEL, 1.0 / 60.0))
    return panels


@style.in_style
def records(run: Results) -> Figure:
    """Draws each kind of record in a panel of its own, over the first opening or displacement that there is. References
    stand beside them, those over something else in panels of their own.
    """
    panels = _panels(run)
    if not panels:
        raise Error(f"{run.folder / 'deck.toml'}: has no [[record]] to draw")
    figure, all_axes, _ = style.panels(0.9 + 2.2 * len(panels), [1.0] * len(panels))
    figure.suptitle(style.title_of(run), fontsize=style.page().size(9.0))
    last_of = {panel.label: axes for panel, axes in zip(panels, all_axes)}
    for panel, axes in zip(panels, all_axes):
        alike = _drawn_once(run, panel.records)
        for (record, *same), colour in zip(alike, _colours()):
            axes.plot(panel.values, record.of(run), color=colour, linewidth=1.5,
                      label="this run" if len(panel.records) == 1 else  # the axis names it
                      " and ".join(one.name for one in (record, *same)) + ", within 1 %" * bool(same))
        draw_tables(axes, [run], (panel.over, panel.factor), *((r.name, r.factor) for r in panel.records))
        axes.set_ylabel(panel.records[0].label if len(panel.records) > 1 else panel.records[0].title)
        axes.axhline(0.0, color=style.BLACK, linewidth=0.5)
        if len(axes.lines) > 2 or len(panel.records) > 1 or axes.collections:
            style.draw_own_legend(axes)
        below = last_of[panel.label]
        if axes is below:
            axes.set_xlabel(panel.label)
        else:
            axes.sharex(below)
            axes.tick_params(labelbottom=False)
    return figure


def _three_digits(value: float) -> str:
    return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"


def _drawn_once(run: Results, found: list[Record]) -> list[list[Record]]:
    """Returns the records by curve, those together whose curves lie on one another, but for a row here and there."""
    groups: list[list[Record]] = []
    for record in found:
        values = np.nan_to_num(record.of(run))
        near = _ALIKE * np.abs(values).max(initial=0.0)
        for group in groups:
            off = np.abs(values - np.nan_to_num(group[0].of(run)))
            if (off <= near).mean() >= _ALIKE_ROWS:
                group.append(record)
                break
        else:
            groups.append([record])
    return groups


def _colours() -> Iterator[str]:
    while True:
        yield from (style.BLUE, style.VERMILLION, style.ORANGE, style.PURPLE, style.BLACK)


def record_fracture(run: Results) -> Rows:
    """Takes the specimen where the first force, else the first stress, was largest, and at the end."""
    if not run.frames:
        raise Error(f"{run.folder / 'fields' / 'frames.csv'}: no frame; fracture cannot be drawn")
    found = records_of(run)
    loaded = _first(found, ("force", "stress"))
    marks = {"end": run.frames[-1]}
    if loaded is not None:
        values = np.abs(np.nan_to_num(loaded.of(run)))
        step = run.history["step"][int(values.argmax())]
        frame = min(run.frames, key=lambda frame: abs(frame.step - step))
        then = values[np.searchsorted(run.history["step"], frame.step)]
        is_peak = then >= _AT_PEAK * values.max()
        marks = {f"{'at' if is_peak else 'nearest to'} the largest {loaded.kind}": frame, **marks}
    panels = [Panel(run, frame, f"{letter}, {what}" if len(marks) > 1 else what, _caption(run, frame, found))
              for letter, (what, frame) in zip("ABC", marks.items())]
    return Rows([("", panels)], style.title_of(run))


def _caption(run: Results, frame: Frame, found: list[Record]) -> str:
    """Returns what the test is about, what it is drawn over, and the share of its largest value."""
    row = int(np.searchsorted(run.history["step"], frame.step))
    if row >= run.history.rows:
        return ""
    main, (over, *_) = leading(found), abscissa(run, found)
    told = [f"{record.name} {_three_digits(record.of(run)[row])} {record.unit}"
            for record in dict.fromkeys((main, over)) if record is not None]
    if main is not None and (largest := np.nanmax(np.abs(main.of(run)))) > 0.0:
        told.append(f"{100.0 * abs(main.of(run)[row]) / largest:.0f} % of the largest")
    return "\n".join(told)
