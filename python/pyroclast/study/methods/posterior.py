"""Posterior of the parameters from surrogates of the outputs. (Goodman, Weare, CAMCoS 5, 2010; python3-emcee.)"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .calibration import Targets
from .surrogate import Surrogate, Validation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Posterior:
    """Draws in the unit cube and what they say."""

    chain: Array  #: (draws, k), burn-in left out
    mean: Array  #: (k,)
    sd: Array  #: (k,)
    sd_ratio: Array  #: (k,), over the uniform prior's
    not_determined: NDArray[np.bool_]  #: (k,)
    correlation: Array  #: (k, k)
    steps: int  #: of each walker, with the burn-in
    autocorrelation: Array  #: (k,), integrated time in steps
    effective: float  #: independent draws that the chain is worth, of the worst parameter
    converged: bool
    statement: str  #: whether and by what it has converged


@dataclass(frozen=True)
class Check:
    """True runs against predictions at points of the posterior."""

    standardised: Array  #: (n, q), (true - predicted)/sd of that difference; NaN where a run gave no value
    rms: Array  #: (q,), of the standardised differences; about 1 where the predictions hold
    within_two: Array  #: (q,), share of them within ±2; about 0.95
    points: Array  #: (q,), number of true values


def sample(surrogates: Sequence[Surrogate], validations: Sequence[Validation], targets: Targets, covariance: Array,
           seed: int = 0, walkers: int | None = None, most_steps: int = 5000) -> Posterior:
    """Draws of the parameters, prior uniform in the unit cube.

    surrogates: one for each target, in their order. validations: theirs; their errors are added to the covariance.
    covariance: (q, q), that of the mean over seeds and of the measurements (`misfit_covariance`).
    walkers: None: 4 k, at least 16. The chain goes on until it is 50 autocorrelation times long and that time has
    settled to 2 %, or to most_steps.

    Raises `Error` where a surrogate's Q2 is below its least, or without emcee.
    """
    raise NotImplementedError


def check_points(posterior: Posterior, n: int, seed: int = 0) -> Array:
    """n draws from the posterior that true runs are to check, (n, k); more of them extend the fewer."""
    raise NotImplementedError


def check(predicted: Array, y: Array, errors: Array) -> Check:
    """Compares true runs with predictions. predicted: (n, q), y: (n, seeds, q), errors: (q,) of the surrogates.

    The surrogates' errors were measured on means over as many seeds, so that they hold the seeds' scatter.
    """
    raise NotImplementedError
