"""Saved states of the fields."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .files import Table


@dataclass(frozen=True)
class Frame:
    """One saved state of the fields."""

    number: int
    stage: int
    step: int
    time: float  #: s
    strain: float  #: NaN where nothing moves
    stress: float  #: MPa; likewise
    temperature: float | None = None  #: °C, mean of the specimen; None when the run did not write it
    heating_time: float | None = None  #: s since heating began; None when the run did not write it

    @property
    def minutes(self) -> float | None:
        """Minutes since heating began; None when the run did not write them."""
        return None if self.heating_time is None or not np.isfinite(self.heating_time) else self.heating_time / 60.0


def frames_of(table: Table, moves: bool) -> list[Frame]:
    """Returns the frames that frames.csv lists. moves: whether the run has mechanics."""
    if not moves:
        return [Frame(number, stage, 0, time, np.nan, np.nan, temperature, time)
                for number, stage, time, temperature in zip(table.whole("frame").tolist(), table.whole("stage").tolist(),
                                                            table["heating_time_s"], table["temperature_degC"])]
    heat: list[Any] = [table[name] if name in table else [None] * table.rows
                       for name in ("temperature_degC", "heating_time_s")]
    whole = [table.whole(name, none=0).tolist() for name in ("frame", "stage", "step")]
    pressed: list[Any] = [table[name] if name in table else [np.nan] * table.rows for name in ("strain", "stress_MPa")]
    return [Frame(*values) for values in zip(*whole, table["time_s"], *pressed, *heat)]
