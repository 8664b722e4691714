"""Orientations and openings of cracks at 300 and 500 degC under a small load, to pandas."""

import sys
from pathlib import Path

import numpy as np
import pandas

import pyroclast

deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "transient_heating.toml")
deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
deck["stages[1].level"] = 0.1
deck.update(coupling={"exchange_increment": "10 K", "least_cycles": 300})
run = pyroclast.Run(deck)
found = {}
for temperature in (300, 500):  # degC
    run.until(temperature=temperature)
    cracks = run.contacts().query("opening_m > 2e-6")
    along = np.degrees(np.arctan2(cracks["normal_x"], -cracks["normal_y"])) % 180.0  # 90: upright
    found[temperature] = cracks.assign(steepness=90.0 - np.abs(along - 90.0))  # 90 degrees: along the load
table = pandas.concat(found, names=["temperature"])
print(table.groupby("temperature")[["opening_m", "steepness"]].describe().T)
share = (table["opening_m"] * table["area_m2"]).groupby("temperature").sum() / (run.specimen.extent * run.thickness)
steepness = np.average(table["steepness"], weights=table["area_m2"] * table["opening_m"])
print(f"cracks are {steepness:.0f} degrees steep on the mean; shares of the volume: {share.round(4).to_dict()}")
assert 0.006 < share.iloc[-1] < 0.02, "aggregate expands and mortar shrinks"
assert steepness > 50.0, "more along the load than across it"
