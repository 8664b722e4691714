"""What each parameter does alone, from a grid or a Latin hypercube."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import seeds

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Curve:
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
    standard_error: Array  #: of the coefficient, from the seeds: the seeds' scatter of it; NaN: one seed
    told_from_seeds: NDArray[np.bool_]  #: |coefficient| > 2 standard_error; False where that is unknown
    seed_share: seeds.Share
    points: int


def curve(u: Array, y: Array, most_classes: int = 10) -> Curve:
    """Mean output by classes of one parameter. u: (n,), y: (n, seeds) or (n,); missing points drop out.

    As many levels as a grid has are classes of their own up to most_classes; else classes of equal count are formed, at
    least five points in each.
    """
    raise NotImplementedError


def rank_effects(u: Array, y: Array, seed: int = 0, resamples: int = 1000) -> RankEffects:
    """Rank correlation and regression. u: (n, k), y: (n, seeds); missing points drop out.

    Raises `Error` with fewer than k + 2 points. (Saltelli, Sobol', Reliab. Eng. Syst. Saf. 50, 1995.)
    """
    raise NotImplementedError
