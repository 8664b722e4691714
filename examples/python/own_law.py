"""A contact law from a header, driven at a point: what it takes to tear it apart."""

from pathlib import Path

import numpy as np

import pyroclast
from pyroclast import MPa, N, m

G_n = 60 * N / m
law = pyroclast.Law(Path(__file__).parents[1] / "own_law" / "ppr.hpp", G_n=G_n, G_t="240 N/m", sigma_max=2.5 * MPa,
                    tau_max="4 MPa", alpha=5, beta=2, lambda_n=0.01, lambda_t=0.01, friction=0.6)
answer = law.drive(opening=[0.0, 2e-4], steps=4000)
work = np.trapz(answer["sigma_Pa"], answer["u_n_m"])
print(f"{law.name}: strength {answer['sigma_Pa'].max() / 1e6:.2f} MPa, work {work:.2f} J/m2")
assert abs(answer["sigma_Pa"].max() / 2.5e6 - 1.0) < 0.01
assert abs(work / G_n.to("J/m2") - 1.0) < 0.01
