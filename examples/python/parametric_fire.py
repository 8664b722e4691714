"""A wall in a fire that is a function: the parametric fire of EN 1991-1-2, with its decay."""

import sys
from math import exp
from pathlib import Path

import pyroclast

HEATED = 900.0  # s


def gas(time: float) -> float:
    """Temperature [degC] after a time [s], opening factor and thermal inertia those of the standard fire."""
    hours = min(time, HEATED) / 3600.0
    rise = 1325.0 * (1.0 - 0.324 * exp(-0.2 * hours) - 0.204 * exp(-1.7 * hours) - 0.472 * exp(-19.0 * hours))
    return 20.0 + max(rise - 625.0 / 3600.0 * max(time - HEATED, 0.0), 0.0)


deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "thermal_wall.toml")
deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
deck["stages[0].duration"] = "1 h"
for boundary in (0, 1):  # convection and radiation
    deck[f"heat.boundaries[{boundary}].gas_temperature"] = gas
run = pyroclast.Run(deck).finish()
hottest = run.history["temperature_max"]
print(f"gas {gas(HEATED):.0f} degC at most, wall {hottest.max():.0f} degC, at the end {hottest[-1]:.0f} degC")
assert hottest[-1] < hottest.max() < gas(HEATED), "the wall follows the gas up and down"
assert hottest.max() > 500.0
