"""The seed as an effect of its own: the spread between random specimens at the same point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Share:
    """How much of an output's variance comes from the seed. NaN with fewer than two seeds or points."""

    single: float  #: of the variance of single runs
    single_low: float  #: 95 % interval, bootstrap over the seeds
    single_high: float
    mean: float  #: of the variance of the mean over the seeds
    mean_low: float
    mean_high: float
    points: int  #: complete points used
    seeds: int


def over_seeds(y: Array) -> Array:
    """Mean over the seeds, NaN where a point misses one. y: (..., seeds), result: (...)."""
    raise NotImplementedError


def share(y: Array, seed: int = 0, resamples: int = 1000) -> Share:
    """The seed's share of the variance of one output. y: (points, seeds).

    Two-way analysis of variance with points and seeds crossed: y = point + seed + rest. The variance between seeds is
    that of seed and rest together, averaged over the points; the points' own variance is free of the rest's part in it.
    """
    raise NotImplementedError
