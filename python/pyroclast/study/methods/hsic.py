"""Dependence of an output on parameters that may be correlated, by the Hilbert-Schmidt independence criterion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Dependence:
    """Arrays of shape (parameters,)."""

    r2: Array  #: HSIC(u_i, y) normed to 0 ... 1
    r2_low: Array  #: 95 % interval, bootstrap over the points
    r2_high: Array
    p_value: Array  #: of independence, by permutations
    points: int


def dependence(u: Array, y: Array, seed: int = 0, permutations: int = 500, resamples: int = 100) -> Dependence:
    """How strongly the mean over seeds depends on each parameter. u: (n, k), y: (n, seeds) or (n,).

    Gaussian kernels of the sample's standard deviation. Nothing is assumed of the dependence between parameters: a
    parameter without effect that is correlated with one that has one shows dependence too. (Gretton et al., 2005; Da
    Veiga, J. Stat. Comput. Simul. 85, 2015; openturns HSICEstimatorGlobalSensitivity.) Raises `Error` without
    openturns.
    """
    raise NotImplementedError
