"""A contact law from a header: what it takes to tear a point apart, and a specimen whose mortar follows it."""

import sys
from pathlib import Path
from typing import Any

from scipy.integrate import trapezoid

import pyroclast
from pyroclast import MPa, N, m

header, G_n = Path(__file__).parents[1] / "own_law" / "ppr.hpp", 60 * N / m
mine: dict[str, Any] = {"G_n": G_n, "G_t": "240 N/m", "sigma_max": 2.5 * MPa, "tau_max": "4 MPa", "alpha": 5,
                        "beta": 2, "lambda_n": 0.01, "lambda_t": 0.01, "friction": 0.6}
law = pyroclast.Law(header, **mine)
answer = law.drive(opening=[0.0, 2e-4], steps=4000)
work = trapezoid(answer["sigma_Pa"], answer["u_n_m"])
print(f"{law.name}: strength {answer['sigma_Pa'].max() / 1e6:.2f} MPa, work {work:.2f} J/m2")
assert abs(answer["sigma_Pa"].max() / 2.5e6 - 1.0) < 0.01
assert abs(work / G_n.to("J/m2") - 1.0) < 0.01
deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
for key in ("compression", "mortar_mortar", "aggregate_mortar"):
    del deck[f"contacts.{key}"]
deck["contacts.mortar_mortar"] = {"law": str(header), **mine}
deck["contacts.aggregate_mortar"] = {"like": "mortar_mortar", "strength_factor": 0.8}
state = (run := pyroclast.Run(deck)).until(strain=2e-4)
assert (run.contacts().query("interface == 'mortar_mortar'")["law"] == law.name).all()
print(f"a specimen of it: {state.stress / 1e6:.2f} MPa at a strain of {state.strain:.5f}")
assert 22e9 < state.stress / state.strain < 36e9, "Young's modulus"
