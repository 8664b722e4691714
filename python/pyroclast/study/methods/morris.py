"""Elementary effects.

Morris, Technometrics 33, 1991; Campolongo, Cariboni, Saltelli, Environ. Model. Softw. 22, 2007.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
    told_from_seeds: NDArray[np.bool_]  #: mu_star > 2 standard_error; False where that is unknown
    used: NDArray[np.int64]  #: elementary effects used
    planned: int  #: elementary effects of each parameter in the design
    elementary: Array  #: (trajectories, parameters), of the mean over seeds; NaN: dropped


def design(k: int, trajectories: int, levels: int, seed: int) -> Array:
    """Trajectories in which one parameter after the other makes one step, shape (trajectories, k + 1, k).

    levels: even, at least 2, from 0 to 1; the step is levels/(2 (levels - 1)) up or down. Trajectory t depends on
    (seed, t) alone, so that more trajectories extend the fewer.
    """
    raise NotImplementedError


def effects(design: Array, y: Array, seed: int = 0, resamples: int = 1000) -> Effects:
    """Elementary effects of the mean over seeds. design: (T, k + 1, k), y: (T, k + 1, seeds).

    Steps that touch a missing point drop out. An absolute value makes an effect of noise, and more trajectories do not
    take it away: an effect is therefore measured by the standard error of one elementary effect, not of their mean.
    """
    raise NotImplementedError
