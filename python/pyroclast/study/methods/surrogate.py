"""Surrogates of one output: polynomial chaos and Kriging, and how good they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...errors import Error
from . import _needs, seeds

Array = NDArray[np.float64]
Kind = Literal["chaos", "kriging"]
_MOST_TERMS = 2000
_PATIENCE = 3
LEAST_HELD = 30
"""Points kept apart on which a surrogate is judged, at the least."""
LEAST_Q2 = 0.9
"""The least `Validation.own_q2`: below it no index and no posterior comes from a surrogate."""
LEAST_TOLD = 0.5
"""The least `Validation.q2`: below it most of what runs differ by is the seeds' scatter, or is not told at all."""


@dataclass(frozen=True)
class Surrogate:
    """A function of the unit cube that stands for the mean over seeds of one output."""

    kind: Kind
    u: Array  #: (n, k), the points it is made from
    y: Array  #: (n,), their means over seeds
    lost: int  #: points left out since they miss a value
    degree: int  #: of the polynomials; 0 for Kriging
    terms: int  #: of the expansion; 0 for Kriging
    fitted: Any  #: what openturns made of them

    def predict(self, u: Array) -> Array:
        """Returns the surrogate's values at u (m, k), shape (m,)."""
        with _needs.openturns("a surrogate") as ot:
            return np.array(self.fitted.getMetaModel()(ot.Sample(np.asarray(u, float))))[:, 0]


@dataclass(frozen=True)
class Validation:
    """How well a surrogate tells true runs that it has not seen."""

    q2: float  #: 1 - mean square error / variance of the true values, which are means over the seeds
    own_q2: float  #: without what the seeds' scatter adds to both: of means over many seeds; the same with one seed
    error: float  #: root mean square error, in the output's unit
    own_error: float  #: without what the seeds' scatter adds to it; the same with one seed
    points: int

    def require(self) -> None:
        """Raises `Error` where own_q2 is below LEAST_Q2, or q2 below LEAST_TOLD.

        A surrogate stands for the mean over many seeds. It cannot tell the scatter that few seeds leave in the true
        values, and is not to blame for it.
        """
        if not self.own_q2 >= LEAST_Q2:
            raise Error(f"the surrogate's Q2 without the seeds' scatter is {self.own_q2:.3f} on {self.points} points "
                        f"kept apart, and nothing is drawn from one below {LEAST_Q2}; more points or narrower ranges "
                        f"may help")
        if not self.q2 >= LEAST_TOLD:
            raise Error(f"the surrogate's Q2 is {self.q2:.3f} on {self.points} points kept apart: it says too little "
                        f"beside the seeds' scatter to be judged, which takes {LEAST_TOLD}; more seeds may help")


@dataclass(frozen=True)
class ChaosIndices:
    """Sobol' indices of an expansion; arrays of shape (parameters,)."""

    first: Array
    first_low: Array  #: 95 % interval, bootstrap over the training points
    first_high: Array
    total: Array
    total_low: Array
    total_high: Array


def fit(u: Array, y: Array, kind: Kind = "chaos", most_degree: int = 10) -> Surrogate:
    """Fits a surrogate of the mean over seeds. u: (n, k), y: (n, seeds) or (n,); missing points drop out.

    chaos: Legendre polynomials, sparse by least angle regression; of the degrees up to most_degree, the one with the
        least corrected leave-one-out error; three in a row without gain are the last. (Blatman, Sudret, J.
        Comput. Phys. 230, 2011.)
    kriging: Matérn 5/2 covariance with a length for each parameter, a linear trend, and the seeds' scatter as noise
        (none with one seed).

    It draws no random number. Raises `Error` where too few points are left or without openturns.
    """
    u, y, noise, lost = _complete(u, y)
    points, k = u.shape
    if points < k + 2:
        raise Error(f"{points} complete points: a surrogate in {k} parameters needs at least {k + 2}")
    if not y.std() > 0.0:
        raise Error("the output does not vary: it needs no surrogate")
    with _needs.openturns("a surrogate") as ot:
        if kind == "kriging":
            return Surrogate(kind, u, y, lost, 0, 0, _kriging(ot, u, y, noise))
        distribution = _uniform(ot, k)
        best: Any = None
        degree, least, worse = 0, np.inf, 0
        for candidate in range(1, most_degree + 1):
            enumerate_terms = _terms(ot, k)
            size = enumerate_terms.getBasisSizeFromTotalDegree(candidate)
            if best is not None and (size > _MOST_TERMS or worse == _PATIENCE):
                break
            basis = ot.OrthogonalProductPolynomialFactory([ot.LegendreFactory()] * k, enumerate_terms)
            selection = ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
            algorithm = ot.FunctionalChaosAlgorithm(ot.Sample(u), ot.Sample(y[:, None]), distribution,
                                                    ot.FixedStrategy(basis, size), ot.LeastSquaresStrategy(selection))
            algorithm.run()
            result = algorithm.getResult()
            error = result.getRelativeErrors()[0]
            worse += 1
            if best is None or error < least:
                best, degree, least, worse = result, candidate, error, 0
        return Surrogate(kind, u, y, lost, degree, len(best.getIndices()), best)


def validate(surrogate: Surrogate, u: Array, y: Array) -> Validation:
    """Compares with true runs kept apart. u: (m, k), y: (m, seeds) or (m,); missing points drop out.

    Raises `Error` with fewer than LEAST_HELD points, or where one of them was used in the fit.
    """
    y = np.asarray(y, float)
    rest = seeds.rest_variance(y) / y.shape[1] if y.ndim == 2 else float("nan")
    u, true, _, _ = _complete(u, y)
    if len(u) < LEAST_HELD:
        raise Error(f"{len(u)} complete runs kept apart: a surrogate is judged on at least {LEAST_HELD}")
    used = {point.tobytes() for point in surrogate.u}
    if any(point.tobytes() in used for point in u):
        raise Error("runs kept apart to judge a surrogate were used to fit it")
    square = float(((true - surrogate.predict(u)) ** 2).mean())
    variance = float(true.var())
    scatter = rest if np.isfinite(rest) else 0.0
    own = max(square - scatter, 0.0)
    return Validation(_q2(square, variance), _q2(own, variance - scatter), float(np.sqrt(square)),
                      float(np.sqrt(own)), len(u))


def indices(surrogate: Surrogate, validation: Validation, seed: int = 0, resamples: int = 500) -> ChaosIndices:
    """Returns Sobol' indices from the coefficients of a chaos expansion. (Sudret, Reliab. Eng. Syst. Saf. 93, 2008.)

    The bootstrap keeps the polynomials and fits their coefficients anew. (Marelli, Sudret, Struct. Saf. 75, 2018.)
    Raises `Error` for Kriging and where `Validation.require` does.
    """
    validation.require()
    if surrogate.kind != "chaos":
        raise Error("indices come from a chaos expansion, not from Kriging")
    with _needs.openturns("a surrogate's indices") as ot:
        result, k = surrogate.fitted, surrogate.u.shape[1]
        enumerate_terms = _terms(ot, k)
        degrees = np.array([list(enumerate_terms(i)) for i in result.getIndices()])
        at = result.getTransformation()(ot.Sample(surrogate.u))
        values = np.column_stack([np.array(term(at))[:, 0] for term in result.getReducedBasis()])
        coefficients = np.array(result.getCoefficients())[:, 0]
    first, total = _shares(degrees, coefficients)
    points = len(surrogate.y)
    draws = np.random.default_rng(seed).integers(0, points, (resamples, points))
    refitted = (np.linalg.lstsq(values[draw], surrogate.y[draw], rcond=None)[0] for draw in draws)
    low, high = seeds.interval(np.array([_shares(degrees, again) for again in refitted]), points)
    return ChaosIndices(first, low[0], high[0], total, low[1], high[1])


def _q2(square: float, variance: float) -> float:
    return 1.0 - square / variance if variance > 0.0 else float("-inf")


def _complete(u: Array, y: Array) -> tuple[Array, Array, float, int]:
    """Returns complete points, their means over seeds, the variance that seeds leave in these, and the number lost."""
    u, y = np.asarray(u, float), np.asarray(y, float)
    y = y[:, None] if y.ndim == 1 else y
    complete = np.isfinite(y).all(axis=1)
    rest = seeds.rest_variance(y) / y.shape[1]
    return u[complete], seeds.over_seeds(y[complete]), rest if np.isfinite(rest) else 0.0, int((~complete).sum())


def _uniform(ot: Any, k: int) -> Any:
    return ot.ComposedDistribution([ot.Uniform(0.0, 1.0)] * k)


def _terms(ot: Any, k: int) -> Any:
    """Returns the hyperbolic order of the polynomials: high degrees of one parameter come before high interactions."""
    return ot.HyperbolicAnisotropicEnumerateFunction(k, 0.75)


def _kriging(ot: Any, u: Array, y: Array, noise: float) -> Any:
    k = u.shape[1]
    covariance = ot.MaternModel([0.5] * k, [float(y.std())], 2.5)
    algorithm = ot.KrigingAlgorithm(ot.Sample(u), ot.Sample(y[:, None]), covariance, ot.LinearBasisFactory(k).build())
    # Noise of 1e-5 of the standard deviation keeps the matrix invertible.
    algorithm.setNoise([max(noise, 1e-10 * float(y.var()))] * len(y))
    algorithm.setOptimizationBounds(ot.Interval([0.02] * k, [20.0] * k))
    algorithm.run()
    return algorithm.getResult()


def _shares(degrees: Array, coefficients: Array) -> tuple[Array, Array]:
    """Returns first and total indices. degrees: (terms, k), of orthonormal polynomials; coefficients: (terms,)."""
    active = degrees > 0
    squares = coefficients**2
    variance = squares[active.any(axis=1)].sum()
    alone = active & (active.sum(axis=1, keepdims=True) == 1)
    with np.errstate(invalid="ignore"):
        return squares @ alone / variance, squares @ active / variance
