"""Places on the curve of a run that a reader looks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..stored.compressed import Compressed
from ..stored.heated import Heated
from ..stored.results import Results
from ..stored.run_facts import BROKEN, DAMAGED_EXTENT

_CRACK_LENGTH = 1.0  # m, of damaged contacts
_CRACK_SHARE = 0.01  # of the area of all contacts of a solid
_HIGHER = 1e-3  # of the peak: what counts as higher
_BACK = 0.1  # of the way on: what a test goes back at most where it goes on
_STRETCH = 0.01  # of the rows of the test, over which a drop is measured


@dataclass(frozen=True)
class Mark:
    id: str
    label: str
    row: int  #: of the history; of a fall its end
    start: int | None = None  #: row at which a fall begins; None of a place

    @property
    def rows(self) -> list[int]:
        """Row of a place, or both ends of a fall."""
        return [self.row] if self.start is None else [self.start, self.row]


def marks(run: Results, leading: np.ndarray | None, over: np.ndarray | None) -> list[Mark]:
    """Returns the marks in the order of the run.

    leading: (rows,) of what the curve is about, such as the stress; None without one. over: (rows,) of what it is drawn
        over and goes back where the test unloads, such as the strain; None where only the time is known.
    """
    hot = Heated(run)
    found = []
    history = run.history
    broken = _sum(run, BROKEN)
    if broken is not None and (broken > 0).any():
        found.append(Mark("first", "first contact broken", int((broken > 0).argmax())))
    extent = _sum(run, DAMAGED_EXTENT)
    if extent is not None and (asked := _least_extent(run)) is not None:
        least, label = asked
        if (extent >= least).any():
            found.append(Mark("extent", label, int((extent >= least).argmax())))
    if leading is not None and np.isfinite(leading).any() and _has_peak(run):
        largest = int(np.nanargmax(leading))
        peak = _peak_row(run, largest)
        if leading[largest] > 0.0:
            found.append(Mark("peak", "peak" if _is_peak(run, leading, peak) else "largest", peak))
            if leading[largest] > leading[peak] * (1.0 + _HIGHER):
                found.append(Mark("largest", "higher again", largest))
            found += _falls(run, leading, over, peak, _is_peak(run, leading, peak))
    if hot.critical_temperature is not None:
        found.append(Mark("end", "failure", int(np.flatnonzero(hot.exchanged)[-1])))
    return sorted(found, key=lambda mark: mark.row)


def _has_peak(run: Results) -> bool:
    hot = Heated(run)
    return run.moves and (not run.has_platens or not hot.is_last or hot.restrained)


def _peak_row(run: Results, largest: int) -> int:
    """Returns where f_c is, as the summary has it; without one the row of the largest value."""
    test = Compressed(run)
    if not run.has_platens or Heated(run).is_last or not test.has_peak:
        return largest
    rows = np.flatnonzero(test.rows)
    return int(rows[np.nanargmin(np.abs(test.strain - test.peak[0]))])


def _is_peak(run: Results, leading: np.ndarray, row: int) -> bool:
    """Returns whether the curve falls behind the row of its largest value: of a compression, whether it has an f_c."""
    if run.has_platens and not Heated(run).is_last:
        return Compressed(run).has_peak
    return row < int(np.flatnonzero(np.isfinite(leading))[-1])


def _least_extent(run: Results) -> tuple[float, str] | None:
    """Returns the length [m], of a solid area [m²], of damaged contacts that is marked, and how; None: not known."""
    if run.facts.dimension == 2:
        return _CRACK_LENGTH, "1 m of contacts damaged"
    if not run.has_fields:
        return None
    return _CRACK_SHARE * float(run.mesh.contacts.extent.sum()), "1 % of the contact area damaged"


def _sum(run: Results, role: str) -> np.ndarray | None:
    """Returns the sum (rows,) over all modes and interfaces; None where no column has the role."""
    columns = [run.history[column.name] for column in run.facts.of_role(role)]
    return np.nansum(columns, axis=0) if columns else None


def _falls(run: Results, values: np.ndarray, over: np.ndarray | None, peak: int,
           is_peak: bool) -> list[Mark]:
    """Finds the steepest fall, which is the largest within a short stretch in which the test goes on, and the fall
    after the peak, down to the least value that the test reached there as it went on.

    Empty where nothing falls, and where several stages move the body and nothing tells which of them unload.
    """
    stretch = max(1, int(_STRETCH * len(values)))
    if len(values) <= stretch:
        return []
    fall = np.nan_to_num(values[:-stretch] - values[stretch:])
    behind = np.where(np.arange(len(values)) > peak, values, np.nan)
    if over is not None:
        way = np.sign(over[np.nanargmax(values)] - over[np.isfinite(over).argmax()])
        change = np.nan_to_num(way * np.diff(over))
        on, back = (np.r_[0.0, np.cumsum(np.maximum(sign * change, 0.0))] for sign in (1.0, -1.0))
        fall[back[stretch:] - back[:-stretch] > _BACK * (on[stretch:] - on[:-stretch])] = 0.0
        behind[on - back < np.maximum.accumulate(on - back)] = np.nan
    elif sum(stage.get("kind") != "settle" for stage in run.deck_stages) > 1:
        return []
    found = []
    if is_peak and np.isfinite(behind).any() and np.nanmin(behind) < values[peak]:
        found.append(Mark("behind", "fall after the peak", int(np.nanargmin(behind)), peak))
    if fall.max() > 0.0:
        start = int(fall.argmax())
        found.append(Mark("steepest", "steepest fall", start + stretch, start))
    return found
