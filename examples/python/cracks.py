"""Orientations and openings of cracks behind the peak, to pandas."""

import sys
from pathlib import Path

import numpy as np

import pyroclast

deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
run = pyroclast.Run(deck)
run.until(lambda state: state.strain > 5e-4 and state.stress < 0.9 * run.history["stress"].max())
contacts = run.contacts()
open_ones = contacts[contacts["opening"] > 2e-6].copy()
along = np.degrees(np.arctan2(open_ones["normal_x"], -open_ones["normal_y"])) % 180.0  # 90: upright
open_ones["steepness"] = 90.0 - np.abs(along - 90.0)  # 90 degrees: along the load
print(open_ones[["opening", "steepness", "area"]].describe())
mean = np.average(open_ones["steepness"], weights=open_ones["area"] * open_ones["opening"])
print(f"{len(open_ones)} open contact points, {mean:.0f} degrees from the platens on the mean of their openings")
torn = contacts["lost_tension"].max()
print(f"a contact that is torn apart took {torn:.1f} J/m2, the fracture energy of mortar")
assert mean > 60.0, "concrete under compression splits along the load"
assert abs(torn / 60.0 - 1.0) < 0.01
