"""A specimen from a labelled image, such as a slice of a CT scan: the stiffness of a core with its own stones."""

import sys
from pathlib import Path

import numpy as np

import pyroclast
from pyroclast import mm

WIDTH = 100 * mm  # of the core, by a calliper
PIXEL = 0.5 * mm
y, x = np.mgrid[0:400, 0:200]
image = np.zeros(x.shape, int)  # here made up: 0 mortar, 1 stone, 2 pore
for label, count, size in ((1, 45, 25), (2, 6, 7)):
    for column, row, a, b in 0.1 + 0.8 * np.random.default_rng(label).random((count, 4)):
        image[np.hypot((x - 200 * column) / (0.3 + a), (y - 400 * row) / (0.3 + b)) < size] = label

deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
deck["specimen"] = slice_ = pyroclast.Specimen.from_image(
    image, PIXEL, {0: "mortar", 1: "aggregate", 2: None}, blocks=int(sys.argv[1]) if len(sys.argv) > 1 else 3000)
deck["contacts.aggregate_mortar.between_stones"] = []  # the image does not tell one stone from another
run = pyroclast.Run(deck)
before, after = (run.until(strain=strain).copy() for strain in (5e-5, 1e-4))
force = (after.stress - before.stress) * run.position[:, 0].max() * run.thickness
E = force / (WIDTH.to("m") * run.thickness * (after.strain - before.strain))
print(f"{slice_}; {slice_.agreement:.1%} of the pixels are of the phase of their block; E {E / 1e9:.1f} GPa")
assert 15e9 < E < 40e9, "between a weak mortar and dense stone"
