"""Dependence of an output on parameters that may be correlated, by the Hilbert-Schmidt independence criterion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import Error
from . import _needs, seeds

Array = NDArray[np.float64]
_GROUPS = 20


@dataclass(frozen=True)
class Dependence:
    """Arrays of shape (parameters,)."""

    r2: Array  #: HSIC(u_i, y) normed to 1 at most; about 0, also below it, where independent
    r2_low: Array  #: 95 % interval, jackknife over groups of points; too narrow about 0, where the p-value tells
    r2_high: Array
    p_value: Array  #: of independence, by permutations
    points: int


def dependence(u: Array, y: Array, seed: int = 0, permutations: int = 500) -> Dependence:
    """Returns how strongly the mean over seeds depends on each parameter. u: (n, k), y: (n, seeds) or (n,).

    Gaussian kernels of the sample's standard deviation, U-statistics. Nothing is assumed of the dependence between
    parameters: a parameter without effect that is correlated with one that has one shows dependence too. (Gretton,
    Bousquet, Smola, Schölkopf, ALT 2005; Da Veiga, J. Stat. Comput. Simul. 85, 2015; openturns
    HSICEstimatorGlobalSensitivity.)

    Raises `Error` with fewer than 20 complete points, where the output does not vary, and without openturns.
    """
    from scipy.stats import t

    u, y = np.asarray(u, float), np.asarray(y, float)
    means = y if y.ndim == 1 else seeds.over_seeds(y)
    u, means = u[np.isfinite(means)], means[np.isfinite(means)]
    if len(means) < _GROUPS:
        raise Error(f"{len(means)} complete points: the dependence needs at least {_GROUPS}")
    if not means.std() > 0.0:
        raise Error("the output does not vary: it depends on nothing")
    with _needs.openturns("HSIC indices", seed) as ot:
        every = _estimator(ot, u, means)
        every.setPermutationSize(permutations)
        r2, p_value = np.array(every.getR2HSICIndices()), np.array(every.getPValuesPermutation())
        group = np.random.default_rng(seed).permutation(len(means)) % _GROUPS
        without = np.array([_estimator(ot, u[group != left], means[group != left]).getR2HSICIndices()
                            for left in range(_GROUPS)])
    half = t.ppf(0.5 * (1.0 + seeds.LEVEL), _GROUPS - 1) * np.sqrt((_GROUPS - 1) * without.var(axis=0))
    return Dependence(r2, r2 - half, r2 + half, p_value, len(means))


def _estimator(ot: Any, u: Array, y: Array) -> Any:
    inputs, output = ot.Sample(u), ot.Sample(y[:, None])
    kernels = []
    for sample in [inputs.getMarginal(i) for i in range(u.shape[1])] + [output]:
        kernel = ot.SquaredExponential(1)
        kernel.setScale(sample.computeStandardDeviation())
        kernels.append(kernel)
    return ot.HSICEstimatorGlobalSensitivity(kernels, inputs, output, ot.HSICUStat())
