#!/usr/bin/env python3
"""Draws what `pyroclast law` wrote of a path: figure.py PATH.csv FIGURE.png"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

with open(sys.argv[1], newline="") as file:
    rows = list(csv.DictReader(file))
column = {name: [float(row[name]) for row in rows] for name in rows[0]}
figure, axes = plt.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
for axis, jump, traction, name in zip(axes, ("u_n_m", "u_s_m"), ("sigma_Pa", "tau_Pa"), "ns"):
    axis.plot([1e6 * u for u in column[jump]], [1e-6 * t for t in column[traction]])
    axis.set(xlabel=f"$u_{name}$ (µm)", ylabel="traction (MPa)")
    axis.axhline(0.0, color="0.7", linewidth=0.5, zorder=0)
figure.savefig(sys.argv[2], dpi=150)
