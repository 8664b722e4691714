"""The strength of several specimens, each in a process of its own: mean and scatter."""

import sys
from pathlib import Path

import numpy as np

import pyroclast


def strength(seed: int) -> float:
    """f_c [MPa] of the specimen of a seed."""
    deck = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
    deck["blocks.count"] = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    deck["stages[1].stop_fraction_of_peak"] = 0.95
    f_c: float = pyroclast.Run(deck, seed=seed, threads=1).finish().results["f_c_MPa"]
    return f_c


if __name__ == "__main__":
    strengths = np.array(pyroclast.parallel.map_runs(strength, range(1, 6)))
    print(f"f_c of five seeds {strengths.mean():.1f} MPa, scatter {strengths.std(ddof=1) / strengths.mean():.1%}")
    assert 25.0 < strengths.mean() < 45.0
    assert 0.0 < strengths.std(ddof=1) / strengths.mean() < 0.2
