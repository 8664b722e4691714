"""The seed as an effect of its own: the spread between random specimens at the same point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LEVEL = 0.95
"""Of all intervals."""


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
    return np.asarray(y, float).mean(axis=-1)


def share(y: Array, seed: int = 0, resamples: int = 1000) -> Share:
    """The seed's share of the variance of one output. y: (points, seeds).

    Two-way analysis of variance with points and seeds crossed: y = point + seed + rest. The variance between seeds is
    that of seed and rest together, averaged over the points; the points' own variance is free of the rest's part in it.
    """
    y = np.asarray(y, float)
    y = y[np.isfinite(y).all(axis=1)]
    points, count = y.shape
    if points < 2 or count < 2:
        return Share(*[float("nan")] * 6, points, count)
    single, mean = _shares(y, np.ones((1, count)), 1.0 / count, 1.0)
    weights = np.random.default_rng(seed).multinomial(count, np.full(count, 1.0 / count), resamples)
    # A resample repeats seeds: its variances are (S - 1)/S of the sample's, and its means have more of the rest in them.
    singles, means = _shares(y, weights, (2.0 * count - 1.0) / count**2, count / (count - 1.0))
    return Share(float(single[0]), *interval(singles), float(mean[0]), *interval(means), points, count)


def _shares(y: Array, weights: Array, rest_in_mean: float, scale: float) -> tuple[Array, Array]:
    """Shares in single runs and in the mean, one for each row of weights (resamples, seeds)."""
    points, count = y.shape
    y = y - y.mean()
    means = y @ weights.T / count
    between = scale * (y**2 @ weights.T / count - means**2).mean(axis=0) * count / (count - 1.0)
    by_seed = y.mean(axis=0)
    shift = scale * (weights @ by_seed**2 / count - (weights @ by_seed / count) ** 2) * count / (count - 1.0)
    rest = np.maximum(between - shift, 0.0) * points / (points - 1.0)
    own = np.maximum(means.var(axis=0, ddof=1) - rest_in_mean * rest, 0.0)
    with np.errstate(invalid="ignore"):
        return between / (between + own), between / count / (between / count + own)


def rest_variance(y: Array) -> float:
    """Variance of what a seed does differently at each point: neither the point's own nor the seed's. y: (points, seeds).

    NaN with fewer than two complete points or seeds.
    """
    y = y[np.isfinite(y).all(axis=1)]
    points, count = y.shape
    if points < 2 or count < 2:
        return float("nan")
    rest = y - y.mean(axis=0) - y.mean(axis=1, keepdims=True) + y.mean()
    return float((rest**2).sum() / ((points - 1) * (count - 1)))


def interval(resampled: Array) -> tuple[Array, Array]:
    """Percentile interval of the resampled values (resamples, ...), both ends of shape (...)."""
    low, high = np.nanpercentile(resampled, [50.0 * (1.0 - LEVEL), 50.0 * (1.0 + LEVEL)], axis=0)
    return low, high
