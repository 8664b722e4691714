"""A stage written in Python: the platen goes up and down about its place, and leaves a loop."""

import sys
from pathlib import Path

import numpy as np

import pyroclast


class Shake(pyroclast.Stage):
    kind = "shake"
    velocity = pyroclast.Key("m/s", "of the platen")
    steps = 0

    def advance(self, body: pyroclast.Body, most_steps: int) -> bool:
        body.drive(-self.velocity if self.steps // 1000 % 2 == 0 else self.velocity)  # turns every 1,000 steps
        count = min(most_steps, 50 - self.steps % 50)
        body.advance(count)
        self.steps += count
        return self.steps % 50 == 0

    def judge(self, body: pyroclast.Body) -> pyroclast.Verdict:
        return pyroclast.Verdict(over=self.steps == 4000)


deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml", stages_in_python=[Shake])
deck.update(blocks={"count": int(sys.argv[1]) if len(sys.argv) > 1 else 1000}, stages=[{"kind": "shake", "velocity": "1 mm/s"}])
deck["stages[1].stop_strain"] = 5e-4
history = pyroclast.Run(deck).finish().history
shaken = history["stage"] == 2
loop = float(np.trapz(history["stress"][shaken], history["strain"][shaken]))
print(f"two cycles between {history['stress'][shaken].min() / 1e6:.1f} and {history['stress'][shaken].max() / 1e6:.1f} MPa")
assert loop > 0.0, "the body takes work from the platen in every cycle"
