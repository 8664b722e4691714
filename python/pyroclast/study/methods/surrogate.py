"""Surrogates of one output: polynomial chaos and Kriging, and how good they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Kind = Literal["chaos", "kriging"]
LEAST_HELD = 30
"""Points kept apart on which a surrogate is judged, at the least."""
LEAST_Q2 = 0.9
"""Below this no index and no posterior comes from a surrogate."""


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
        """Its values at u (m, k), shape (m,)."""
        raise NotImplementedError


@dataclass(frozen=True)
class Validation:
    """How well a surrogate tells true runs that it has not seen."""

    q2: float  #: 1 - mean square error / variance of the true values
    error: float  #: root mean square error, in the output's unit; it contains the seeds' scatter
    points: int

    def require(self) -> None:
        """Raises `Error` where Q2 is below LEAST_Q2."""
        raise NotImplementedError


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
    """A surrogate of the mean over seeds. u: (n, k), y: (n, seeds) or (n,); missing points drop out.

    chaos: Legendre polynomials, sparse by least angle regression; of the degrees up to most_degree, the one with the
        least corrected leave-one-out error. (Blatman, Sudret, J. Comput. Phys. 230, 2011.)
    kriging: Matérn 5/2 covariance with a length for each parameter, a linear trend, and the seeds' scatter as noise.

    It draws no random number. Raises `Error` where too few points are left or without openturns.
    """
    raise NotImplementedError


def validate(surrogate: Surrogate, u: Array, y: Array) -> Validation:
    """Compares with true runs kept apart. u: (m, k), y: (m, seeds) or (m,); missing points drop out.

    Raises `Error` with fewer than LEAST_HELD points, or where one of them was used in the fit.
    """
    raise NotImplementedError


def indices(surrogate: Surrogate, validation: Validation, seed: int = 0, resamples: int = 500) -> ChaosIndices:
    """Sobol' indices from the coefficients of a chaos expansion. (Sudret, Reliab. Eng. Syst. Saf. 93, 2008.)

    The bootstrap keeps the polynomials and fits their coefficients anew. (Marelli, Sudret, Struct. Saf. 75, 2018.)
    Raises `Error` for Kriging and where Q2 is below LEAST_Q2.
    """
    raise NotImplementedError
