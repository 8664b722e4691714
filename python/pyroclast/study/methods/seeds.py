"""The seed as an effect of its own: the spread between random specimens at the same point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Told = NDArray[np.object_]
"""Whether an effect is told from the seeds: True, False, or None where too few seeds are known to say."""
LEVEL = 0.95
"""Level of all intervals."""
LEAST = 3
"""Seeds without which nothing is told from them: two leave one difference, whose own spread is not known."""
_DRAWS = 1000


@dataclass(frozen=True)
class Share:
    """How much of an output's variance comes from the seed. NaN with fewer than two seeds or points."""

    single: float  #: of the variance of single runs
    single_low: float  #: 95 % interval, bootstrap over the seeds; NaN with two, of which there is one resample only
    single_high: float
    mean: float  #: of the variance of the mean over the seeds
    mean_low: float
    mean_high: float
    points: int  #: complete points used
    seeds: int


def over_seeds(y: Array) -> Array:
    """Returns the mean over the seeds, NaN where a point misses one. y: (..., seeds), result: (...)."""
    mean: Array = np.asarray(y, float).mean(axis=-1)
    return mean


def share(y: Array, seed: int = 0, resamples: int = 1000) -> Share:
    """Returns the seed's share of the variance of one output. y: (points, seeds).

    Two-way analysis of variance with points and seeds crossed: y = point + seed + rest. The variance between seeds is
    that of seed and rest together, averaged over the points; the points' own variance is free of the rest's part in it.
    """
    y = np.asarray(y, float)
    y = y[np.isfinite(y).all(axis=1)]
    points, count = y.shape
    if points < 2 or count < 2:
        nan = float("nan")
        return Share(nan, nan, nan, nan, nan, nan, points, count)
    single, mean = _shares(y, np.full((1, count), 1.0 / count))
    if count < 3:
        return Share(float(single[0]), np.nan, np.nan, float(mean[0]), np.nan, np.nan, points, count)
    weights = np.random.default_rng(seed).multinomial(count, np.full(count, 1.0 / count), resamples) / count
    singles, means = _shares(y, weights[weights.max(axis=1) < 1.0])
    (single_low, mean_low), (single_high, mean_high) = interval(np.stack([singles, means], axis=1), count)
    return Share(float(single[0]), single_low, single_high, float(mean[0]), mean_low, mean_high, points, count)


def _shares(y: Array, weights: Array) -> tuple[Array, Array]:
    """Returns shares in single runs and in the mean, one for each row of weights (resamples, seeds), the sum of each
    being 1.

    Variances are divided by what makes them free of bias for these weights: a resample has some seeds more than once.
    """
    points, count = y.shape
    y = y - y.mean()
    repeated = (weights**2).sum(axis=1)
    means = y @ weights.T
    between = np.maximum(y**2 @ weights.T - means**2, 0.0).mean(axis=0) / (1.0 - repeated)
    by_seed = y.mean(axis=0)
    shift = (weights @ by_seed**2 - (weights @ by_seed) ** 2) / (1.0 - repeated)
    rest = np.maximum(between - shift, 0.0) * points / (points - 1.0)
    own = np.maximum(means.var(axis=0, ddof=1) - repeated * rest, 0.0)
    with np.errstate(invalid="ignore"):
        return between / (between + own), between / count / (between / count + own)


def rest_variance(y: Array) -> float:
    """Returns the variance of what a seed does differently at each point, of single runs. y: (points, seeds).

    NaN with fewer than two complete points or seeds.
    """
    y = y[np.isfinite(y).all(axis=1)]
    points, count = y.shape
    if points < 2 or count < 2:
        return float("nan")
    rest = y - y.mean(axis=0) - y.mean(axis=1, keepdims=True) + y.mean()
    return float((rest**2).sum() / ((points - 1) * (count - 1)))


def contrasts(count: int, seed: int) -> Array:
    """Returns mixtures of the seeds in which all cancels that they have in common, each as long as their mean: (seeds,
    draws).

    Where seeds are alike, such a mixture scatters as the mean over them does around the true one. It is a permutation of
    the seeds, made continuous by rotations, as so few have few permutations (Langsrud, Stat. Comput. 15, 2005, 53-60).
    """
    drawn: Array = np.random.default_rng(seed).normal(size=(count, _DRAWS))
    drawn -= drawn.mean(axis=0)
    drawn /= np.linalg.norm(drawn, axis=0) * np.sqrt(count)
    return drawn


def alone(estimator: Callable[[Array], Any], y: Array, seed: int) -> Array:
    """Returns what the estimator gives, in LEVEL of the draws at most, for seeds alone; NaN with fewer than LEAST.

    y: (..., seeds). estimator: of as many outputs as its last axis has; (effects, outputs).
    """
    count = y.shape[-1]
    if count < LEAST:
        few: Array = estimator(y[..., :1])
        return np.full(len(few), np.nan)
    pieces = [estimator(y @ some) for some in np.array_split(contrasts(count, seed), _DRAWS // 50, axis=1)]
    found: Array = np.nanpercentile(np.concatenate(pieces, axis=1), 100.0 * LEVEL, axis=1)
    return found


def told(is_told: NDArray[np.bool_], count: int) -> Told:
    """Returns whether effects are told from the seeds; None of each with fewer seeds than LEAST."""
    found: Told = is_told.astype(object) if count >= LEAST else np.full(is_told.shape, None, dtype=object)
    return found


def level(count: int) -> float:
    """Returns which share of the resampled values an interval has to hold, for as many things as were resampled.

    Above LEVEL: a bootstrap of few is too narrow, as a normal distribution is beside Student's, and for its variance is
    that of n, not n - 1 (the expanded percentile interval: Hesterberg, Am. Stat. 69, 2015, 371-386). 1 for one thing.
    """
    from scipy.stats import norm, t

    if count < 2:
        return 1.0
    return float(1.0 - 2.0 * norm.sf(np.sqrt(count / (count - 1.0)) * t.ppf(0.5 * (1.0 + LEVEL), count - 1)))


def interval(resampled: Array, count: int) -> tuple[Array, Array]:
    """Returns the percentile interval of the resampled values (resamples, ...), ends of shape (...). count: see
    `level`.
    """
    share = level(count)
    low, high = np.nanpercentile(resampled, [50.0 * (1.0 - share), 50.0 * (1.0 + share)], axis=0)
    return low, high
