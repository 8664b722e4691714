"""Stops behind the peak, unloads, and loads again: how much stiffness is left."""

import sys
from pathlib import Path

import numpy as np

import pyroclast

deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
deck["stages[1].stop_fraction_of_peak"] = 0.0
run = pyroclast.Run(deck)
run.until(strain=2e-4)
E = np.polyfit(run.history["strain"][-10:], run.history["stress"][-10:], 1)[0]
run.until(lambda state: state.strain > 5e-4 and state.stress < 0.9 * run.history["stress"].max())
run.end_stage()
platen = {"velocity": "0.8 mm/s", "ramp_time": "20 ms"}
left = run.then("compress", to_stress="1 MPa", **platen).finish().measure().strain
reached = run.then("compress", to_stress="10 MPa", **platen).finish().measure()
softer = (reached.stress - 1e6) / (reached.strain - left)
print(f"E {E / 1e9:.1f} GPa; unloaded: strain {left:.5f}; loaded again {softer / 1e9:.1f} GPa")
assert 18e9 < E < 26e9
assert left > 1e-4, "a permanent strain is left"
assert 0.1 < softer / E < 0.95, "cracks have taken stiffness"
