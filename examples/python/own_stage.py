"""A stage written in Python: the platen goes up and down about its place, and leaves a loop."""

from pathlib import Path

import numpy as np
import pyroclast
from scipy.integrate import trapezoid


class Shake(pyroclast.Stage):
    kind, steps = "shake", 0
    velocity = pyroclast.Key("m/s", "of the platen")

    def advance(self, body: pyroclast.Body, most_steps: int) -> bool:
        body.drive(-self.velocity if self.steps // 1000 % 2 == 0 else self.velocity)  # turns every 1,000 steps
        body.advance(count := min(most_steps, 50 - self.steps % 50))
        self.steps += count
        return self.steps % 50 == 0

    def judge(self, body: pyroclast.Body) -> pyroclast.Verdict:
        return pyroclast.Verdict(over=self.steps == 4000)


deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml", stages_in_python=[Shake])
deck.append("stages", kind="shake", velocity="10 mm/s").update(blocks={"count": 200})
deck["stages[1].stop_strain"] = 5e-4
history = pyroclast.Run(deck).finish().history
strain, stress = (history[name][history["stage"] == 2] for name in ("strain", "stress"))
print(f"{np.ptp(stress) / 1e6:.1f} MPa for a strain of {np.ptp(strain):.6f}, loop {trapezoid(stress, strain):.3g} J/m3")
assert abs(np.ptp(strain) * 0.3 / (10e-3 * 1000 * 1e-5) - 1.0) < 0.1, "velocity times half a period"
