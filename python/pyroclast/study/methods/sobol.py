"""Variance-based indices of independent parameters. (Sobol', Math. Comput. Simul. 55, 2001.)"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import Error
from . import _needs, sampling, seeds

Array = NDArray[np.float64]
_MOST_LEVEL = 1.0 - 1e-6  # OpenTURNS takes none of 1
FEWEST = 8
"""Rows. Intervals come of draws with replacement, and of fewer rows some of the draws are of one row alone."""
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
    from_seeds: Array  #: total index of seeds alone, at most, see `seeds.alone`; NaN: fewer than three seeds
    told_from_seeds: seeds.Told  #: total_low > from_seeds
    seed_share: seeds.Share  #: of the points A and B
    rows: int  #: used
    lost: float  #: share of the rows lost


def design(k: int, n: int, seed: int) -> Array:
    """Returns rows A, B, AB_1 ... AB_k, shape (n, k + 2, k); AB_i is A with parameter i from B.

    A and B are the halves of one Sobol' sequence in 2k dimensions, so that the first n of 2n rows are the same.
    """
    both = sampling.sobol_sequence(n, 2 * k, seed)
    first, second = both[:, :k], both[:, k:]
    rows = np.repeat(first[:, None, :], k + 2, axis=1)
    rows[:, 1] = second
    for i in range(k):
        rows[:, i + 2, i] = second[:, i]
    return rows


def indices(y: Array, seed: int = 0, allow_missing: bool = False, resamples: int = 500) -> Indices:
    """Returns indices of the mean over seeds by Martinez' correlation estimators. y: (n, k + 2, seeds), as `design` has
    them.

    A row with a missing point drops out as a whole. Raises `Error` where more than MOST_LOST of the rows are lost and
    that is not allowed, where fewer than FEWEST rows remain, where the output does not vary, or without openturns.
    (Baudin, Boumhaout, Delage, Iooss, Martinez, 2016; openturns MartinezSensitivityAlgorithm.)
    """
    y = np.asarray(y, float)
    complete = np.isfinite(y).all(axis=(1, 2))
    lost = float((~complete).mean())
    if lost > MOST_LOST and not allow_missing:
        raise Error(f"{lost:.1%} of the rows miss a value: no indices above {MOST_LOST:.0%}, unless that is allowed")
    if complete.sum() < FEWEST:
        raise Error(f"Sobol' indices need at least {FEWEST} complete rows")
    y = y[complete]
    rows, blocks, runs = y.shape
    means = seeds.over_seeds(y)
    variance = means[:, 0].var()
    if not variance > 0.0:
        raise Error("the output does not vary: it has no Sobol' indices")

    with _needs.openturns("Sobol' indices", seed) as ot:
        outputs = ot.Sample(np.ascontiguousarray(means.T).reshape(-1, 1))
        # The estimator reads no inputs; it only wants their number.
        algorithm = ot.MartinezSensitivityAlgorithm(ot.Sample(len(outputs), blocks - 2), outputs, rows)
        algorithm.setBootstrapSize(resamples)
        algorithm.setConfidenceLevel(min(seeds.level(rows), _MOST_LEVEL))
        algorithm.setUseAsymptoticDistribution(False)
        first, total = np.array(algorithm.getFirstOrderIndices()), np.array(algorithm.getTotalOrderIndices())
        intervals = algorithm.getFirstOrderIndicesInterval(), algorithm.getTotalOrderIndicesInterval()
        ends = [np.array(end) for both in intervals for end in (both.getLowerBound(), both.getUpperBound())]

    # Jansen's numerator of the total index, over the variance of the means: of each seed's departure from the mean ...
    steps = y[:, :1] - y[:, 2:]
    seed_part = np.full(blocks - 2, np.nan)
    if runs > 1:
        seed_part = 0.5 * steps.var(axis=2, ddof=1).mean(axis=0) / runs / variance
    from_seeds = seeds.alone(lambda y: 0.5 * (y**2).mean(axis=0) / variance, steps, seed)  # ... and of seeds alone
    return Indices(first, ends[0], ends[1], total, ends[2], ends[3], seed_part, from_seeds,
                   seeds.told(ends[2] > from_seeds, runs), seeds.share(y[:, :2].reshape(-1, runs), seed), rows, lost)
