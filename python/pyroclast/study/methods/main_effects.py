"""What each parameter does alone, from a grid or a Latin hypercube."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import Error
from . import sampling, seeds

Array = NDArray[np.float64]
_LEAST_IN_CLASS = 5


@dataclass(frozen=True)
class ClassMeans:
    """Response to one parameter; arrays of shape (classes,)."""

    u: Array  #: mean of the parameter in the class
    mean: Array  #: of the output over all else
    low: Array  #: 95 % confidence interval of it, Student's t over the points
    high: Array
    count: NDArray[np.int64]  #: points in the class


@dataclass(frozen=True)
class RankEffects:
    """Monotone effects of each parameter on the mean over seeds; arrays of shape (parameters,)."""

    correlation: Array  #: Spearman's
    correlation_low: Array  #: 95 % interval, bootstrap over the points
    correlation_high: Array
    coefficient: Array  #: standardised rank regression coefficient
    coefficient_low: Array
    coefficient_high: Array
    r2: float  #: share of the ranks' variance that the regression explains
    standard_error: Array  #: of the coefficient, jackknife over the seeds; NaN: one seed
    told_from_seeds: seeds.Told  #: its interval holds no 0, nor does coefficient ± t standard_error
    seed_share: seeds.Share
    points: int


def curve(u: Array, y: Array, most_classes: int = 10, count: int | None = None) -> ClassMeans:
    """Returns the mean output by classes of one parameter. u: (n,), y: (n, seeds) or (n,); missing points drop out.

    count: values that the parameter has, each an even share of the range; None: any. Each value is a class of its own,
        in the middle of its share, and so are the levels of a grid up to most_classes; else classes of equal count are
        formed, at least five points in each.
    """
    from scipy.stats import t

    if count is not None:
        u = sampling.in_shares(u, count)
    u, means = np.asarray(u, float), seeds.over_seeds(np.atleast_2d(np.asarray(y, float).T).T)
    u, means = u[np.isfinite(means)], means[np.isfinite(means)]
    levels, member = np.unique(u, return_inverse=True)
    if len(levels) > most_classes and count is None:
        classes = max(1, min(most_classes, len(u) // _LEAST_IN_CLASS))
        member = np.empty(len(u), int)
        member[np.argsort(u, kind="stable")] = np.arange(len(u)) * classes // len(u)
    points = np.bincount(member)
    at = np.bincount(member, u) / points
    mean = np.bincount(member, means) / points
    half = np.full(len(points), np.nan)
    several = points > 1
    squares = np.bincount(member, (means - mean[member]) ** 2)[several]
    n = points[several]
    half[several] = t.ppf(0.5 * (1.0 + seeds.LEVEL), n - 1) * np.sqrt(squares / (n - 1) / n)
    return ClassMeans(at, mean, mean - half, mean + half, points)


def rank_effects(u: Array, y: Array, seed: int = 0, resamples: int = 1000) -> RankEffects:
    """Returns the rank correlation and regression. u: (n, k), y: (n, seeds); missing points drop out.

    Told from the seeds is a coefficient whose interval excludes 0, over the points and over the seeds: there it is beyond
    Student's t of 95 % times its standard error, twice it for many seeds, more for few. Raises `Error` with fewer than k + 2 points. (Saltelli, Sobol', Reliab. Eng. Syst. Saf. 50, 1995.)
    """
    from scipy.stats import t

    u, y = np.asarray(u, float), np.asarray(y, float)
    complete = np.isfinite(y).all(axis=1)
    u, y = u[complete], y[complete]
    (points, count), runs = u.shape, y.shape[1]
    if points < count + 2:
        raise Error(f"{points} complete points: the rank regression on {count} parameters needs at least {count + 2}")
    means = seeds.over_seeds(y)
    correlation, coefficient, r2 = _ranked(u, means)
    draws = np.random.default_rng(seed).integers(0, points, (resamples, points))
    resampled = np.array([_ranked(u[draw], means[draw])[:2] for draw in draws])
    low, high = seeds.interval(resampled, points)

    standard_error, limit = np.full(count, np.nan), float("nan")
    if runs > 1:
        # Jackknife: the coefficient of the mean over all seeds but one.
        without = np.array([_ranked(u, np.delete(y, s, axis=1).mean(axis=1))[1] for s in range(runs)])
        standard_error = np.sqrt((runs - 1) * without.var(axis=0))
        limit = float(t.ppf(0.5 * (1.0 + seeds.LEVEL), runs - 1))
    return RankEffects(correlation, low[0], high[0], coefficient, low[1], high[1], r2, standard_error,
                       seeds.told((low[1] * high[1] > 0.0) & (np.abs(coefficient) > limit * standard_error), runs),
                       seeds.share(y, seed), points)


def _ranked(u: Array, y: Array) -> tuple[Array, Array, float]:
    """Returns Spearman's correlations, standardised rank regression coefficients and R2."""
    from scipy.stats import rankdata

    ranks = rankdata(np.column_stack([u, y]), axis=0)
    ranks -= ranks.mean(axis=0)
    spread = ranks.std(axis=0)
    ranks /= np.where(spread > 0.0, spread, 1.0)
    inputs, output = ranks[:, :-1], ranks[:, -1]
    coefficient = np.linalg.lstsq(inputs, output, rcond=None)[0]
    correlation = inputs.T @ output / len(output)
    return correlation, coefficient, float(coefficient @ correlation)
