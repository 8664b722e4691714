"""Variance-based indices of independent parameters. (Sobol', Math. Comput. Simul. 55, 2001.)"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import seeds

Array = NDArray[np.float64]
MOST_LOST = 0.05
"""Share of the rows that may be lost before indices are refused."""


@dataclass(frozen=True)
class Indices:
    """First-order and total indices of the mean over seeds; arrays of shape (parameters,)."""

    first: Array
    first_low: Array  #: 95 % interval, bootstrap over the rows
    first_high: Array
    total: Array
    total_low: Array
    total_high: Array
    seed_part: Array  #: what the seeds' scatter adds to the total index; NaN: one seed
    told_from_seeds: NDArray[np.bool_]  #: total > 4 seed_part: twice the standard error, squared; False if unknown
    seed_share: seeds.Share  #: of the points A and B
    rows: int  #: used
    lost: float  #: share of the rows lost


def design(k: int, n: int, seed: int) -> Array:
    """Rows A, B, AB_1 ... AB_k, shape (n, k + 2, k); AB_i is A with parameter i from B.

    A and B are the halves of one Sobol' sequence in 2k dimensions, so that the first n of 2n rows are the same.
    """
    raise NotImplementedError


def indices(y: Array, seed: int = 0, allow_missing: bool = False, resamples: int = 500) -> Indices:
    """Indices of the mean over seeds by Martinez' correlation estimators. y: (n, k + 2, seeds), as `design` has them.

    A row with a missing point drops out as a whole. Raises `Error` where more than MOST_LOST of the rows are lost and
    that is not allowed, where fewer than two rows remain, where the output does not vary, or without openturns.
    (Baudin, Boumhaout, Delage, Iooss, Martinez, 2016; openturns MartinezSensitivityAlgorithm.)
    """
    raise NotImplementedError
