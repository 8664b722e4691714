"""A run while its body is heated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import Error
from .columns import Array
from .frames import Frame
from .results import Results, number_of, results_with
from .run_facts import HEAT, PROBE_PRESSURE

_UNIFORM = 1.0  # K


@dataclass(frozen=True)
class Heated:
    """What the stages of a run did that exchange temperatures, such as `heat` and `expose`.

        hot = pyroclast.Heated(pyroclast.read("runs/hot"))
        plt.plot(hot.column("temperature"), hot.total_strain)

    It keeps nothing but the run: a run that goes on may be read further meanwhile.
    """

    run: Results

    @property
    def results(self) -> dict[str, Any]:
        """Results of all these stages together: load_stress_MPa, critical_temperature_degC, platen, exchanges, ...; empty
        of a body that was never heated.
        """
        stages = results_with(self.run, "exchanges")
        if not stages:
            return {}
        merged = dict(stages[0])
        for name in ("exchanges", "exchanges_not_converged", "cycles"):
            merged[name] = sum(number_of(self.run, results, name) for results in stages if name in results)
        worst = [number_of(self.run, results, "worst_unbalanced_ratio") for results in stages
                 if results.get("worst_unbalanced_ratio") is not None]
        merged["worst_unbalanced_ratio"] = max(worst, default=None)
        failures = results_with(self.run, "critical_temperature_degC")
        return merged | {"critical_temperature_degC": failures[0]["critical_temperature_degC"] if failures else None}

    @property
    def load_stress(self) -> float | None:
        """Compressive stress kept meanwhile, MPa."""
        return number_of(self.run, self.results, "load_stress_MPa")

    @property
    def load_level(self) -> float | None:
        """`load_stress` over the strength at 20 °C; None where that strength is not known."""
        stages = self.run.stage_results
        heated = [number for number, results in enumerate(stages) if results.get("exchanges") is not None]
        if not heated:
            return None
        loads = [results for results in stages[:heated[0]] if "load_level" in results]
        level = number_of(self.run, loads[-1], "load_level") if loads else None
        return 0.0 if level is None and self.load_stress == 0.0 else level

    @property
    def critical_temperature(self) -> float | None:
        """Temperature [°C] at which the specimen failed under its load; None where it did not."""
        return number_of(self.run, self.results, "critical_temperature_degC")

    @property
    def restrained(self) -> bool:
        """Whether the platens were held in place; where there is no summary yet, the deck tells it."""
        if results := self.results:
            return results.get("platen") == "fixed"
        stages = self.run.history["stage"][self.exchanged].astype(int)
        later = self.run.deck_stages[stages[0]:] if len(stages) else []
        return bool(later) and later[0].get("platen") == "fixed"

    @property
    def exchanged(self) -> NDArray[np.bool_]:
        """Rows (rows,) of the history written after an exchange of temperatures."""
        history = self.run.history
        return np.greater(history["exchange"], 0) if "exchange" in history.names else np.zeros(history.rows, dtype=bool)

    @property
    def rows(self) -> NDArray[np.bool_]:
        """Rows (rows,): `exchanged` and the row before, from which heating started; none without heating."""
        rows = self.exchanged
        if rows.any():
            rows[max(int(rows.argmax()) - 1, 0)] = True
        return rows

    @property
    def is_last(self) -> bool:
        """Whether the last stage heats the body, so that the test is the heating and not what follows it."""
        stage = self.run.history["stage"]
        return bool(self.exchanged[stage == stage.max()].any())

    def column(self, name: str) -> Array:
        """Returns a column of the history, `rows` only."""
        return self.run.history[name][self.rows]

    @property
    def standing(self) -> NDArray[np.bool_]:
        """Rows (rows,): `rows` without that of the exchange at which the specimen failed."""
        return self.rows & ~self._failing

    @property
    def _failing(self) -> NDArray[np.bool_]:
        rows = np.zeros(self.run.history.rows, dtype=bool)
        if self.critical_temperature is not None:
            rows[np.flatnonzero(self.exchanged)[-1:]] = True
            rows &= self.run.history["converged"] == 0
        return rows

    @property
    def unconverged(self) -> NDArray[np.bool_]:
        """Rows (rows,) of exchanges whose cycles did not reach equilibrium, without that of the failure."""
        rows = self.exchanged
        if rows.any():
            rows &= (self.run.history["converged"] == 0) & ~self._failing
        return rows

    @property
    def stress(self) -> Array:
        """Stress [MPa] between the platens over `rows`."""
        return self.column(self.run.facts.press("stress"))

    @property
    def total_strain(self) -> Array:
        """Axial strain of the specimen's own ends over `rows`, positive in expansion, that of the load included. Platens
        without load may have left the ends.
        """
        return -self.column("specimen_strain")

    def standing_strain(self, temperatures: ArrayLike) -> Array:
        """Returns axial strain at temperatures [°C] while the specimen stood, as `total_strain`; nan above."""
        reached, strain = (self.run.history[name][self.standing] for name in ("temperature_degC", "specimen_strain"))
        asked = np.asarray(temperatures, dtype=float)
        if not len(reached):
            return np.full(asked.shape, np.nan)
        return np.where(asked > reached.max() + 1e-6, np.nan, -np.interp(asked, reached, strain))

    def total_strain_at(self, frame: Frame) -> float:
        """Returns `total_strain` when a frame was saved."""
        history = self.run.history
        row = int(np.searchsorted(history["step"], frame.step))
        if row == history.rows or history["step"][row] != frame.step:
            raise Error(f"{history.path}: has no row of step {frame.step}, at which a frame was saved")
        return -float(history["specimen_strain"][row])

    @property
    def uniform(self) -> bool:
        """Whether the specimen's temperatures never differed by more than 1 K."""
        spread = self.run.history["temperature_max_degC"] - self.run.history["temperature_min_degC"]
        return not (spread > _UNIFORM).any()  # a gap tells nothing

    @property
    def probe_pressures(self) -> dict[str, Array]:
        """Pore pressure at each probe [MPa, less that of the atmosphere], (rows,) by name; empty without water."""
        return {column.of: self.run.history[column.name] for column in self.run.facts.of_role(PROBE_PRESSURE)}

    @property
    def heats(self) -> bool:
        """Whether temperatures are drawn over the time: they differ within the specimen, or stand beside a reference."""
        if not self.uniform:
            return True
        return bool(self.run.facts.of_role(HEAT)) and any(table.over == "heating_time"
                                                          for table in self.run.references.tables)

    @property
    def timed(self) -> bool:
        """Whether heating is drawn over minutes: it is not uniform, or stands beside a reference over time."""
        return not self.uniform or any(self.run.references.of(of, "heating_time") for of in ("stress", "total_strain"))

    @property
    def frames(self) -> list[Frame]:
        """Frames of all these stages, but those of unknown temperature; raises Error where there is none."""
        path = self.run.folder / "fields" / "frames.csv"
        frames = self.run.frames
        if self.run.moves:
            stages = set(self.run.history["stage"][self.exchanged])
            frames = [frame for frame in frames if frame.stage in stages]
        if not frames:
            raise Error(f"{path}: no frame of a heating stage")
        if frames[0].temperature is None:
            raise Error(f"{path}: has no column 'temperature_degC'")
        frames = [frame for frame in frames if frame.temperature is not None and np.isfinite(frame.temperature)]
        if not frames:
            raise Error(f"{path}: column 'temperature_degC' has no finite value")
        return frames
