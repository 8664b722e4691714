"""Parameters from targets: a misfit that knows the seeds' scatter, CMA-ES replayed, what the targets tell."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import Error

Array = NDArray[np.float64]
UNIFORM_SD = 12.0**-0.5
"""Standard deviation of the uniform prior on 0 ... 1."""
_PRIOR_PRECISION = 12.0
_DIGITS = 9
_SWEEPS = 100
NOT_DETERMINED = 0.8
"""Posterior standard deviation over the prior's above which a parameter counts as not determined."""


@dataclass(frozen=True)
class Targets:
    """Measured values that the mean over seeds is to meet; q of them."""

    names: tuple[str, ...]
    values: Array  #: (q,)
    sd: Array  #: (q,), of the measured values; may be zero where the seeds' scatter is known


@dataclass(frozen=True)
class Infeasible:
    """A point that may not be run. by: how far it is outside, any measure; 0 where not known."""

    by: float = 0.0


Answer = NDArray[np.float64] | Infeasible | None
"""What is known of a point: its outputs (seeds, q) with NaN where a run gave none, infeasible, or not yet known."""


@dataclass(frozen=True)
class Settings:
    """How CMA-ES searches."""

    seed: int = 1
    population: int | None = None  #: None: 4 + 3 ln k
    sigma: float = 0.3  #: first step, in the unit cube
    most_generations: int = 50
    least_sigma: float = 0.01  #: done when no parameter's step is longer
    least_gain: float = 0.1  #: done when the best misfit gains no more than this ...
    patience: int = 8  #: ... in as many generations


@dataclass(frozen=True)
class Search:
    """The state of a search after all generations that are fully known."""

    generations: list[Array]  #: (population, k) each; the last one may be unknown yet
    misfits: list[Array]  #: (population,) each, as the search saw them; of the complete generations only
    mean: Array  #: (k,), where the search stands
    sigma: Array  #: (k,), step of each parameter
    finished: str  #: why it is done; empty while it goes on

    @property
    def points(self) -> Array:
        """All points so far, shape (points, k), in the order of their generations."""
        return np.concatenate(self.generations)


@dataclass(frozen=True)
class Calibration:
    """A search for targets, judged with all that is known now."""

    search: Search
    covariance: Array  #: (q, q), of the misfit
    misfits: Array  #: (points,), all with this covariance; infinite where infeasible or failed, NaN where not yet known
    best: int | None  #: row of the point with the least misfit; None while there is none

    @property
    def points(self) -> Array:
        """All points so far, shape (points, k)."""
        return self.search.points


@dataclass(frozen=True)
class Uncertainty:
    """What the targets tell of the parameters at the best point, linearised."""

    jacobian: Array  #: (q, k), of the outputs in the unit cube
    error: Array  #: (q, k), its standard error
    residual: Array  #: (q,), standard deviation of what the local form leaves, in the outputs' units
    points: int  #: that it comes from
    covariance: Array  #: (k, k), in the unit cube, within it
    sd: Array  #: (k,)
    sd_ratio: Array  #: (k,), over the uniform prior's 1/sqrt(12)
    not_determined: NDArray[np.bool_]  #: (k,), sd_ratio > NOT_DETERMINED
    directions: Array  #: (k, k), a row each, from the best told to the least; unit vectors
    direction_ratio: Array  #: (k,), sd over the prior's in each direction, without the cube's sides
    direction_not_determined: NDArray[np.bool_]  #: (k,), direction_ratio > NOT_DETERMINED


def seed_covariance(answers: Sequence[Array]) -> tuple[Array, int]:
    """Returns the covariance of single runs between seeds, pooled over points, and its degrees of freedom d.

    answers: (seeds, q) each; those with a missing value are left out. Towards its own diagonal it is shrunk by
    q/(q + d), as if q observations of independent outputs stood beside. All zero with d = 0.
    """
    complete = [np.asarray(values, float) for values in answers if np.isfinite(values).all()]
    q = np.shape(answers[0])[1]
    freedom = sum(len(values) - 1 for values in complete)
    if freedom == 0:
        return np.zeros((q, q)), 0
    departures = np.concatenate([values - values.mean(axis=0) for values in complete])
    pooled = departures.T @ departures / freedom
    shrinkage = q / (q + freedom)
    return (1.0 - shrinkage) * pooled + shrinkage * np.diag(np.diag(pooled)), freedom


def misfit_covariance(answers: Sequence[Array], targets: Targets, error: ArrayLike = 0.0) -> Array:
    """Returns the covariance of mean over seeds minus target, (q, q): seeds' + measurement's + surrogate's (error,
    (q,), its sd).

    Raises `Error` where a target has no scatter at all.
    """
    single, _ = seed_covariance(answers)
    runs = len(answers[0])
    covariance: Array = single / runs + np.diag(targets.sd**2 + np.broadcast_to(error, targets.sd.shape) ** 2)
    for name, variance in zip(targets.names, np.diag(covariance)):
        if not variance > 0.0:
            raise Error(f"target {name}: neither seeds nor a measured standard deviation give it a scatter")
    return covariance


def misfit(outputs: Array, targets: Targets, covariance: Array) -> Array:
    """Returns r^T C^-1 r with r = outputs - targets. outputs: (points, q), result: (points,)."""
    departure = outputs - targets.values
    squares: Array = np.einsum("pq,pq->p", departure, np.linalg.solve(covariance, departure.T).T)
    return squares


def usual_population(k: int) -> int:
    """Returns the points of a generation where none is stated, as CMA-ES has it by default."""
    return 4 + int(3.0 * math.log(max(k, 2)))


def search(k: int, settings: Settings, judge: Callable[[Sequence[Array]], tuple[Array, Array] | None]) -> Search:
    """Searches by CMA-ES in the unit cube from its middle, replayed from the first generation on.

    judge: gets all generations so far, (population, k) each. It gives the misfits of the last one, infinite where
        infeasible, and how far the infeasible points are outside, (population,) both; None where they are not yet
        known. It must depend on nothing but these points and their results.

    The points depend on the settings and the judgements alone. They are rounded to 1e-9, so that the last digits of a
    sum do not make other points. Each generation is ranked: only the order of its misfits counts. One parameter is
    searched with an idle second one beside. (Hansen, arXiv:1604.00772; python3-cmaes.)
    """
    from cmaes import CMA

    dimension = max(k, 2)
    optimizer = CMA(np.full(dimension, 0.5), settings.sigma, np.tile([0.0, 1.0], (dimension, 1)), seed=settings.seed,
                    population_size=settings.population)
    generations: list[Array] = []
    misfits: list[Array] = []
    finished = ""
    while True:
        # cmaes shows neither its mean nor its covariance by a public name.
        mean, sigma = optimizer._mean[:k].copy(), optimizer._sigma * np.sqrt(np.diag(optimizer._C))[:k]
        finished = _why_finished(settings, misfits, sigma)
        if not finished and optimizer.should_stop():
            finished = "the search has degenerated"
        if finished:
            break
        asked = np.array([optimizer.ask() for _ in range(optimizer.population_size)]).round(_DIGITS)
        generations.append(asked[:, :k])
        judged = judge(generations)
        if judged is None:
            break
        values, outside = judged
        misfits.append(np.asarray(values, float))
        order = np.lexsort((outside, misfits[-1]))
        optimizer.tell([(asked[row], float(rank)) for rank, row in enumerate(order)])
    return Search(generations, misfits, mean, sigma, finished)


def calibrate(k: int, targets: Targets, settings: Settings, answer: Callable[[Array], Answer]) -> Calibration:
    """Returns the search for the targets so far, and its next generation.

    answer: what is known of a point (k,).

    A generation is judged with the covariance of all points up to it, so that later results change nothing before. A
    point with a missing value counts as infeasible. Infeasible points are worse than all others, by how far they are
    outside.
    """
    known: dict[bytes, Answer] = {}

    def answers_of(points: Array) -> list[Answer]:
        for point in points:
            if point.tobytes() not in known:
                known[point.tobytes()] = answer(point)
        return [known[point.tobytes()] for point in points]

    def judge(generations: Sequence[Array]) -> tuple[Array, Array] | None:
        latest = answers_of(generations[-1])
        if any(entry is None for entry in latest):
            return None
        covariance = _covariance_of(answers_of(np.concatenate(generations)), targets)
        return _misfits_of(latest, targets, covariance), np.array([getattr(entry, "by", 0.0) for entry in latest])

    found = search(k, settings, judge)
    answers = answers_of(found.points)
    covariance = _covariance_of(answers, targets)
    misfits = _misfits_of(answers, targets, covariance)
    best = int(np.nanargmin(misfits)) if np.isfinite(misfits).any() else None
    return Calibration(found, covariance, misfits, best)


def uncertainty(best: Array, u: Array, y: Array, targets: Targets, covariance: Array, seed: int = 0,
                neighbours: int | None = None, draws: int = 4000) -> Uncertainty:
    """Returns the linear posterior around a best point, uniform prior in the unit cube.

    best: (k,). u: (n, k), y: (n, q) means over seeds; rows with NaN are left out. covariance: (q, q), of the misfit.
    neighbours: nearest points that enter; None: all, which steadies the derivatives where the outputs are noisy.

    The outputs are regressed on u, with quadratic terms where there are twice as many points as terms, and with weights
    that fall to zero beyond the farthest neighbour. A derivative counts as none where noise alone would give one as
    large to any of the q outputs in 5 % of cases (Student's t, Bonferroni). What noise adds to the information of the
    others is taken off, and a direction tells nothing where noise alone would tell as much in 5 % of cases: else noise
    would determine parameters. The truncated normal distribution is then drawn from by Gibbs steps along the
    eigenvectors of the information.

    Raises `Error` with fewer than k + 2 points.
    """
    from scipy.stats import t

    u, y = np.asarray(u, float), np.asarray(y, float)
    complete = np.isfinite(y).all(axis=1)
    u, y = u[complete], y[complete]
    k = len(best)
    if len(u) < k + 2:
        raise Error(f"{len(u)} complete points: a linear form in {k} parameters needs at least {k + 2}")
    fit = _local_form(best, u, y, neighbours or len(u))
    weight = np.linalg.inv(covariance)
    limit = t.ppf(1.0 - 0.025 / len(fit.jacobian), fit.freedom)
    told = np.where(np.abs(fit.jacobian) > limit * fit.error, fit.jacobian, 0.0)
    kept = (told != 0.0).astype(float)
    noise = fit.unit * (kept.T @ (weight * fit.scatter) @ kept)
    values, vectors = np.linalg.eigh(told.T @ weight @ told - noise)
    from_noise = np.einsum("ij,ik,kj->j", vectors, noise, vectors)
    values = np.where(values + from_noise > _noise_limit(weight @ fit.scatter) * from_noise, values, 0.0)
    order = np.argsort(values)[::-1]
    values, vectors = np.maximum(values[order], 0.0), vectors[:, order]
    pull = told.T @ weight @ (targets.values - fit.at_best)
    chains = _truncated_normal(best, values, vectors, pull, draws, np.random.default_rng(seed))
    spread = np.atleast_2d(np.cov(chains, rowvar=False))
    sd = np.sqrt(np.diag(spread))
    along = np.sqrt(_PRIOR_PRECISION / (values + _PRIOR_PRECISION))
    return Uncertainty(fit.jacobian, fit.error, np.sqrt(np.diag(fit.scatter)), fit.points, spread, sd, sd / UNIFORM_SD,
                       sd / UNIFORM_SD > NOT_DETERMINED, vectors.T, along, along > NOT_DETERMINED)


def _why_finished(settings: Settings, misfits: Sequence[Array], sigma: Array) -> str:
    if sigma.max() <= settings.least_sigma:
        return f"no step is longer than {settings.least_sigma:g} of a range"
    if len(misfits) > settings.patience:
        before = min(values.min() for values in misfits[:-settings.patience])
        lately = min(values.min() for values in misfits[-settings.patience:])
        if np.isfinite(before) and before - lately <= settings.least_gain:
            return f"{settings.patience} generations gained no more than {settings.least_gain:g} of misfit"
    if len(misfits) >= settings.most_generations:
        return f"{settings.most_generations} generations"
    return ""


def _covariance_of(answers: Sequence[Answer], targets: Targets) -> Array:
    """Adds up all covariances that are known; without any values the measurements' part alone, which judges nothing."""
    known = [entry for entry in answers if isinstance(entry, np.ndarray) and np.isfinite(entry).all()]
    return misfit_covariance(known, targets) if known else np.diag(targets.sd**2)


def _misfits_of(answers: Sequence[Answer], targets: Targets, covariance: Array) -> Array:
    """Returns misfits: infinite where infeasible or failed, NaN where not yet known."""
    misfits = np.array([np.nan if entry is None else np.inf for entry in answers])
    means = {row: entry.mean(axis=0) for row, entry in enumerate(answers) if isinstance(entry, np.ndarray)}
    means = {row: values for row, values in means.items() if np.isfinite(values).all()}
    if means:
        misfits[list(means)] = misfit(np.array(list(means.values())), targets, covariance)
    return misfits


def _noise_limit(product: Array) -> float:
    """Returns what noise's part of the information exceeds in 5 % of cases, over its mean.

    A sum of squares, taken as a chi square distribution of the same mean and variance (Satterthwaite, Biometrics Bull.
    2, 1946). product: C^-1 times the residuals' covariance.
    """
    from scipy.stats import chi2

    squares = np.trace(product @ product)
    freedom = np.trace(product) ** 2 / squares if squares > 0.0 else 1.0
    return float(chi2.ppf(0.95, freedom) / freedom)


@dataclass(frozen=True)
class _LocalForm:
    at_best: Array  #: (q,), outputs at the best point
    jacobian: Array  #: (q, k)
    error: Array  #: (q, k), standard errors of the jacobian
    scatter: Array  #: (q, q), covariance of the residuals
    unit: Array  #: (k, k), covariance of the derivatives of an output with residuals of variance 1
    freedom: int  #: points less terms
    points: int


def _local_form(best: Array, u: Array, y: Array, neighbours: int) -> _LocalForm:
    """Returns weighted least squares around the best point. (Cleveland, J. Am. Stat. Assoc. 74, 1979, weights.)"""
    k = len(best)
    distance = np.linalg.norm(u - best, axis=1)
    nearest = np.argsort(distance, kind="stable")[:neighbours]
    away, y, distance = (u - best)[nearest], y[nearest], distance[nearest]
    # 1.1: the farthest neighbour itself keeps some weight.
    weight = (1.0 - (distance / (1.1 * max(distance.max(), np.finfo(float).tiny))) ** 3) ** 3
    terms = np.column_stack([np.ones(len(away)), away])
    rows, columns = np.triu_indices(k)
    if len(away) >= 2 * (1 + k + len(rows)):
        terms = np.column_stack([terms, away[:, rows] * away[:, columns]])
    inverse = np.linalg.pinv(terms.T @ (weight[:, None] * terms), hermitian=True)
    coefficients = inverse @ terms.T @ (weight[:, None] * y)
    residuals = y - terms @ coefficients
    unit = inverse @ terms.T @ (weight[:, None] ** 2 * terms) @ inverse
    expected = weight.sum() - np.trace(inverse @ terms.T @ (weight[:, None] ** 2 * terms))
    scatter = residuals.T @ (weight[:, None] * residuals) / expected
    unit = unit[1:k + 1, 1:k + 1]
    error = np.sqrt(np.outer(np.diag(scatter), np.diag(unit)))
    return _LocalForm(coefficients[0], coefficients[1:k + 1].T, error, scatter, unit,
                      len(away) - terms.shape[1], len(away))


def _truncated_normal(best: Array, values: Array, vectors: Array, pull: Array, draws: int,
                      random: np.random.Generator) -> Array:
    """Draws as many chains as draws, each from the best point, of exp(pull.d - d.H d/2) with d = u - best, within the
    cube.

    values, vectors: of H.
    """
    from scipy.special import ndtr, ndtri

    u = np.tile(best, (draws, 1))
    for _ in range(_SWEEPS):
        for value, vector in zip(values, vectors.T):
            # How far it may go along the vector until it meets a side of the cube.
            with np.errstate(divide="ignore", invalid="ignore"):
                ends = np.stack([(0.0 - u) / vector, (1.0 - u) / vector])
            ends = np.where(np.abs(vector) > 1e-12, ends, np.array([-np.inf, np.inf])[:, None, None])
            low, high = ends.min(axis=0).max(axis=1), ends.max(axis=0).min(axis=1)
            chance = random.random(draws)
            step = low + chance * (high - low)
            if value > 1e-9:
                sd = value**-0.5
                centre = vector @ pull / value - (u - best) @ vector
                # The tail that is nearer is used: beyond the upper one the distribution function is 1.
                a, b = (low - centre) / sd, (high - centre) / sd
                sign = np.where(a > 0.0, -1.0, 1.0)
                start, end = ndtr(np.where(sign < 0.0, -b, a)), ndtr(np.where(sign < 0.0, -a, b))
                drawn = centre + sd * sign * ndtri(start + chance * (end - start))
                beyond = np.clip(centre, low, high)
                step = np.clip(np.where(np.isfinite(drawn), drawn, beyond), low, high)
            u = np.clip(u + step[:, None] * vector, 0.0, 1.0)
    return u
