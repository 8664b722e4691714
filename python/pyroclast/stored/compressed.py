"""The stage of a run that is its test."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Error
from .columns import Array
from .frames import Frame
from .heated import Heated
from .results import Results, number_of, results_with


@dataclass(frozen=True)
class Compressed:
    """What the stage of a run did that is the test. Strain and stress are positive in compression.

        test = pyroclast.Compressed(pyroclast.read("runs/compression"))
        plt.plot(test.strain, test.stress)

    It keeps nothing but the run: a run that goes on may be read further meanwhile.
    """

    run: Results

    @property
    def results(self) -> dict[str, Any]:
        """Results of the last compression that has a modulus, else of the last that has a strength: E_GPa, f_c_MPa,
        strain_at_peak, strain_ic, quasi_static; empty without one.
        """
        tests = results_with(self.run, "E_GPa") or results_with(self.run, "f_c_MPa")
        return tests[-1] if tests else {}

    @property
    def quasi_static(self) -> bool | None:
        """The verdict of the last compression; None without one."""
        verdicts: list[bool] = [results["quasi_static"] for results in results_with(self.run, "quasi_static")]
        return verdicts[-1] if verdicts else None

    @property
    def rows(self) -> NDArray[np.bool_]:
        """Rows (rows,) with a stress of the stage that is the test; before it, of the last stage that moves the body."""
        column, test = self.run.facts.press("stress"), self.run.facts.test_stage
        stage, is_there = self.run.history["stage"], np.isfinite(self.run.history[column])
        self.run.history.known(column)
        rows: NDArray[np.bool_] = (stage == (-1 if test is None else test)) & is_there
        if not rows.any():
            rows = (stage == stage[is_there].max()) & is_there
        return rows

    def column(self, name: str) -> Array:
        """Returns a column of the history, `rows` only."""
        return self.run.history[name][self.rows]

    @property
    def before(self) -> NDArray[np.bool_]:
        """Rows (rows,) of the stages that moved the platen before `rows`, since heat last changed the body."""
        stages = [number for number, stage in enumerate(self.run.deck_stages) if stage.get("kind") == "compress"]
        first, heated = int(self.rows.argmax()), np.flatnonzero(Heated(self.run).exchanged)
        row = np.arange(self.run.history.rows)
        since = heated[-1] + 1 if heated.size else 0
        before: NDArray[np.bool_] = np.isin(self.run.history["stage"], stages) & (since <= row) & (row < first)
        return before

    @property
    def stress(self) -> Array:
        """Stress [MPa] between the platens over `rows`."""
        return self.column(self.run.facts.press("stress"))

    @property
    def strain_before(self) -> float:
        """Strain from which the stage's is counted: that before it, if heat left one, else zero."""
        first = int(self.rows.argmax())
        if not Heated(self.run).exchanged[:first].any():
            return 0.0
        return float(self.run.history.known("strain", slice(first))[-1])

    @property
    def strain(self) -> Array:
        """Strain over `rows`, less `strain_before`."""
        return self.column("strain") - self.strain_before

    def _tested(self, name: str) -> float | None:
        """Returns a number among the results of the stage of `rows`."""
        stage, stages = int(self.column("stage")[0]), self.run.stage_results
        return number_of(self.run, stages[stage], name) if stage < len(stages) else None

    @property
    def has_peak(self) -> bool:
        """Whether the test has an f_c."""
        return self._tested("f_c_MPa") is not None

    @property
    def rise_again(self) -> float:
        """Rise of the stress above f_c behind it, over f_c; 0 where it does not, or there is no f_c."""
        strength, largest = self._tested("f_c_MPa"), self._tested("stress_max_MPa")
        return max(0.0, largest / strength - 1.0) if strength and largest else 0.0

    @property
    def peak(self) -> tuple[float, float]:
        """`strain` and stress [MPa] at f_c, as the summary has it. Where that has none, those where the history's stress
        is largest, even if it ended there.

        Raises Error where the specimen was never compressed.
        """
        strength, at = self._tested("f_c_MPa"), self._tested("strain_at_peak")
        if strength is not None and at is not None:
            before = 0.0
            if "stage_strain" in self.run.history:
                before = float(self.strain[0] - self.column("stage_strain")[0])
            return at + before, strength
        strain, stress = self.strain, self.stress
        self.run.history.known("strain", self.rows)
        row = int(np.where(np.isfinite(strain), stress, -np.inf).argmax())
        if stress[row] <= 0.0:
            path = self.run.history.path
            raise Error(f"{path}: the stress is never positive; the specimen was not compressed")
        return float(strain[row]), float(stress[row])

    @property
    def strength_retained(self) -> float | None:
        """Largest stress after heating over the strength before; None where the summary does not tell that."""
        hot = Heated(self.run)
        if hot.is_last or not hot.load_level or not hot.load_stress:
            return None
        return self.peak[1] * hot.load_level / hot.load_stress

    @property
    def frames(self) -> list[Frame]:
        """Frames of the stage, their strain less `strain_before`, but those of unknown strain or stress."""
        last, before = self.run.history["stage"][self.rows].max(), self.strain_before
        return [replace(frame, strain=frame.strain - before) for frame in self.run.frames
                if frame.stage == last and np.isfinite([frame.strain, frame.stress]).all()]
