"""Posterior of the parameters from surrogates of the outputs. (Goodman, Weare, CAMCoS 5, 2010; python3-emcee.)"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _needs, seeds
from .calibration import NOT_DETERMINED, UNIFORM_SD, Targets, misfit
from .surrogate import Surrogate, Validation

Array = NDArray[np.float64]
_LEAST_WALKERS = 16
_BLOCK = 500
_LENGTHS = 50
_SETTLED = 0.02
_BURN = 5


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
           seed: int = 0, walkers: int | None = None, most_steps: int = 50000) -> Posterior:
    """Draws of the parameters, prior uniform in the unit cube.

    surrogates: one for each target, in their order. validations: theirs; the surrogates' own errors are added to the
        covariance.
    covariance: (q, q), that of the mean over seeds and of the measurements (`misfit_covariance`).
    walkers: None: 4 k, at least 16. The chain goes on until it is 50 autocorrelation times long and that time has
    settled to 2 %, or to most_steps; five times are burn-in.

    Raises `Error` where a surrogate tells too little (`Validation.require`), or without emcee.
    """
    emcee = _needs.library("emcee", "a posterior")
    for validation in validations:
        validation.require()
    total = covariance + np.diag([validation.own_error**2 for validation in validations])
    k = surrogates[0].u.shape[1]
    walkers = walkers or max(4 * k, _LEAST_WALKERS)

    def log_density(u: Array) -> Array:
        within = ((u >= 0.0) & (u <= 1.0)).all(axis=1)
        density = np.full(len(u), -np.inf)
        if within.any():
            outputs = np.column_stack([surrogate.predict(u[within]) for surrogate in surrogates])
            density[within] = -0.5 * misfit(outputs, targets, total)
        return density

    sampler = emcee.EnsembleSampler(walkers, k, log_density, vectorize=True)
    random = np.random.RandomState(seed)
    state = emcee.State(random.random_sample((walkers, k)), random_state=random.get_state())
    times = np.full(k, np.inf)
    while sampler.iteration < most_steps:
        state = sampler.run_mcmc(state, min(_BLOCK, most_steps - sampler.iteration))
        before, times = times, sampler.get_autocorr_time(tol=0)
        settled = bool((np.abs(times - before) < _SETTLED * times).all())
        if converged := settled and bool((_LENGTHS * times < sampler.iteration).all()):
            break

    steps, longest = sampler.iteration, float(np.max(times))
    burn = min(int(_BURN * longest), steps // 2) if np.isfinite(longest) else steps // 2
    chain = sampler.get_chain(discard=burn, flat=True)
    effective = len(chain) / longest
    statement = (f"{steps} steps of {walkers} walkers, the first {burn} left out; longest autocorrelation time "
                 f"{longest:.0f} steps, {effective:.0f} independent draws; ")
    statement += ("converged" if converged else
                  f"not converged: {_LENGTHS} such times, settled to {_SETTLED:.0%}, are needed")
    sd = chain.std(axis=0, ddof=1)
    ratio = sd / UNIFORM_SD
    return Posterior(chain, chain.mean(axis=0), sd, ratio, ratio > NOT_DETERMINED,
                     np.atleast_2d(np.corrcoef(chain, rowvar=False)), steps, times, effective, converged, statement)


def check_points(posterior: Posterior, n: int, seed: int = 0) -> Array:
    """Returns n draws from the posterior that true runs are to check, (n, k); more of them extend the fewer."""
    rows = np.random.default_rng(seed).permutation(len(posterior.chain))[:n]
    drawn: Array = posterior.chain[rows]
    return drawn


def check(predicted: Array, y: Array, errors: Array) -> Check:
    """Compares true runs with predictions. predicted: (n, q), y: (n, seeds, q), errors: (q,), `Validation.error` of the
    surrogates.

    These errors were measured on means over as many seeds, so that they hold the seeds' scatter.
    """
    y = np.asarray(y, float)
    standardised = (seeds.over_seeds(np.moveaxis(y, 1, 2)) - predicted) / np.asarray(errors, float)
    points = np.isfinite(standardised).sum(axis=0)
    with np.errstate(invalid="ignore"):
        rms = np.sqrt(np.nansum(standardised**2, axis=0) / points)
        within_two = (np.abs(standardised) <= 2.0).sum(axis=0) / points
    return Check(standardised, rms, within_two, points)
