"""A curve that grows with its run: in a window where there is a display, else in a picture."""
import os
import sys
from pathlib import Path

import numpy as np
import pyroclast
from matplotlib import pyplot

deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
deck["stages[1].stop_strain"] = 0.0015
figure, axes = pyplot.subplots()
(line,) = axes.plot([], [])
axes.set(xlabel="Strain [10⁻³]", ylabel="Stress [MPa]")


def draw(run: pyroclast.Run) -> None:
    line.set_data(1e3 * run.history["strain"], run.history["stress_MPa"])
    axes.relim()
    axes.autoscale_view()
    pyplot.pause(0.001) if os.environ.get("DISPLAY") else figure.savefig("live_curve.png")


run = pyroclast.Run(deck)
run.at_looks(lambda run: draw(run) if run.history.rows % 25 == 0 else None)
draw(run.finish())
strain, stress = np.asarray(line.get_data())
print(f"{len(strain)} points, the last {stress[-1]:.1f} MPa at a strain of {strain[-1]:.2f}e-3")
assert 18.0 < stress[strain > 0.4][0] / strain[strain > 0.4][0] < 26.0, "GPa"
