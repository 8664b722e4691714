"""A compression test beside the reference: the specimen's strength against that of the experiment."""

import sys
from pathlib import Path

import pyroclast
from pyroclast.stored.reference import EXPERIMENT

deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
deck.update(blocks={"count": int(sys.argv[1]) if len(sys.argv) > 1 else 1000})
deck["stages[1].stop_fraction_of_peak"] = 0.9  # as soon as the peak is passed

run = pyroclast.Run(deck)
for state in run:
    if run.history.rows % 50 == 0:
        print(f"strain {state.strain:.5f}  stress {state.stress / 1e6:5.2f} MPa")

f_c, E = run.results["f_c_MPa"], run.results["E_GPa"]
print(f"f_c {f_c:.1f} MPa, the experiment's {EXPERIMENT.strength:.1f} MPa; E {E:.1f} GPa, {EXPERIMENT.modulus:.1f} GPa")
assert 0.75 < f_c / EXPERIMENT.strength < 1.25
