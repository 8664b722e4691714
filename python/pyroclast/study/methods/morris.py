"""Elementary effects.

Morris, Technometrics 33, 1991; Campolongo, Cariboni, Saltelli, Environ. Model. Softw. 22, 2007.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import Error
from . import seeds

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Effects:
    """Effects of each parameter on one output, over its whole range (unit of u); all of shape (parameters,).

    NaN where a parameter has no step left.
    """

    mu: Array  #: mean of the elementary effects, in the output's unit
    mu_star: Array  #: mean of their absolute values
    mu_star_low: Array  #: 95 % interval, bootstrap over the trajectories
    mu_star_high: Array
    sigma: Array  #: their standard deviation: curvature and interactions
    standard_error: Array  #: of one elementary effect of the mean over seeds, from its spread over them; NaN: one seed
    from_seeds: Array  #: mu_star of seeds alone, at most, see `seeds.alone`; NaN: fewer than three seeds
    told_from_seeds: seeds.Told  #: mu_star_low > from_seeds
    used: NDArray[np.int64]  #: elementary effects used
    planned: int  #: elementary effects of each parameter in the design
    elementary: Array  #: (trajectories, parameters), of the mean over seeds; NaN: dropped


def design(k: int, trajectories: int, levels: int, seed: int) -> Array:
    """Returns trajectories in which one parameter after the other makes one step, shape (trajectories, k + 1, k).

    levels: even, at least 2, from 0 to 1; the step is levels/(2 (levels - 1)) up or down. Trajectory t depends on
    (seed, t) alone, so that more trajectories extend the fewer.
    """
    if levels < 2 or levels % 2:
        raise Error(f"{levels} levels: Morris' design needs an even number of them")
    step = levels // 2
    points = np.empty((trajectories, k + 1, k))
    for t in range(trajectories):
        random = np.random.default_rng([seed, t])
        low = random.integers(0, step, k)
        starts_high = random.random(k) < 0.5
        order = random.permutation(k)
        at = low + step * starts_high
        points[t, 0] = at
        for s, parameter in enumerate(order):
            at[parameter] = low[parameter] + step * (not starts_high[parameter])
            points[t, s + 1] = at
    return points / (levels - 1)


def effects(design: Array, y: Array, seed: int = 0, resamples: int = 1000) -> Effects:
    """Returns the elementary effects of the mean over seeds. design: (T, k + 1, k), y: (T, k + 1, seeds).

    Steps that touch a missing point drop out. An absolute value makes an effect of noise, and more trajectories do not
    take it away: an effect is therefore told from the seeds where its interval is above what they alone give.
    """
    design, y = np.asarray(design, float), np.asarray(y, float)
    trajectories, count, runs = len(design), design.shape[2], y.shape[2]
    moves = np.diff(design, axis=1)
    moved = np.argmax(moves != 0.0, axis=2)
    step = np.take_along_axis(moves, moved[..., None], axis=2)
    by_seed = np.empty((trajectories, count, runs))
    np.put_along_axis(by_seed, moved[..., None], np.diff(y, axis=1) / step, axis=1)
    elementary = by_seed.mean(axis=2)
    used = np.isfinite(elementary).sum(axis=0)

    draws = np.random.default_rng(seed).integers(0, trajectories, (resamples, trajectories))
    with warnings.catch_warnings():
        # A parameter without a step left: NaN is the answer.
        warnings.simplefilter("ignore", RuntimeWarning)
        mu, mu_star = np.nanmean(elementary, axis=0), np.nanmean(np.abs(elementary), axis=0)
        sigma = np.nanstd(elementary, axis=0, ddof=1)
        resampled = np.nanmean(np.abs(elementary)[draws], axis=1)
        low, high = np.transpose([seeds.interval(of_one, n) for of_one, n in zip(resampled.T, used)])
        standard_error = np.full(count, np.nan)
        if runs > 1:
            standard_error = np.sqrt(np.nanmean(by_seed.var(axis=2, ddof=1), axis=0) / runs)
        from_seeds = seeds.alone(lambda y: np.nanmean(np.abs(y), axis=0), by_seed, seed)
    return Effects(mu, mu_star, low, high, sigma, standard_error, from_seeds, seeds.told(low > from_seeds, runs), used,
                   trajectories, elementary)
