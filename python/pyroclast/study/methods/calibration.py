"""Parameters from targets: a misfit that knows the seeds' scatter, CMA-ES replayed, what the targets tell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
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


Outcome = NDArray[np.float64] | Infeasible | None
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
        raise NotImplementedError


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
        raise NotImplementedError


@dataclass(frozen=True)
class Uncertainty:
    """What the targets tell of the parameters at the best point, linearised."""

    jacobian: Array  #: (q, k), of the outputs in the unit cube
    residual: Array  #: (q,), root mean square of what the linear form leaves, in the outputs' units
    points: int  #: that it comes from
    covariance: Array  #: (k, k), in the unit cube, within it
    sd: Array  #: (k,)
    sd_ratio: Array  #: (k,), over the uniform prior's 1/sqrt(12)
    not_determined: NDArray[np.bool_]  #: (k,), sd_ratio > NOT_DETERMINED
    directions: Array  #: (k, k), a row each, from the best told to the least; unit vectors
    direction_ratio: Array  #: (k,), sd over the prior's in each direction, without the cube's sides
    direction_not_determined: NDArray[np.bool_]  #: (k,), direction_ratio > NOT_DETERMINED


def seed_covariance(outcomes: Sequence[Array]) -> tuple[Array, int]:
    """Covariance of single runs between seeds, pooled over points, and its degrees of freedom d.

    outcomes: (seeds, q) each; those with a missing value are left out. Towards its own diagonal it is shrunk by
    q/(q + d), as if q observations of independent outputs stood beside. All zero with d = 0.
    """
    raise NotImplementedError


def misfit_covariance(outcomes: Sequence[Array], targets: Targets, error: ArrayLike = 0.0) -> Array:
    """Covariance of mean over seeds minus target, (q, q): seeds' + measurement's + surrogate's (error, (q,), its sd).

    Raises `Error` where a target has no scatter at all.
    """
    raise NotImplementedError


def misfit(outputs: Array, targets: Targets, covariance: Array) -> Array:
    """r^T C^-1 r with r = outputs - targets. outputs: (points, q), result: (points,)."""
    raise NotImplementedError


def search(k: int, settings: Settings, judge: Callable[[Sequence[Array]], ArrayLike | None]) -> Search:
    """CMA-ES in the unit cube from its middle, replayed from the first generation on.

    judge: gets all generations so far, (population, k) each, and gives misfits of the last one, or None where they are
        not yet known. Infinite is infeasible. It must not depend on anything but these points and their results.

    The points depend on the settings and the judgements alone. They are rounded to 1e-9, so that another machine's last
    digits do not make other points. Each generation is ranked: only the order of its misfits counts. One parameter is
    searched with an idle second one beside. (Hansen, arXiv:1604.00772; python3-cmaes.)
    """
    raise NotImplementedError


def calibrate(k: int, targets: Targets, settings: Settings, outcome: Callable[[Array], Outcome]) -> Calibration:
    """The search for the targets so far, and its next generation.

    outcome: what is known of a point (k,).

    A generation is judged with the covariance of all points up to it, so that later results change nothing before. A
    point with a missing value counts as infeasible. Infeasible points are worse than all others, by how far they are
    outside.
    """
    raise NotImplementedError


def uncertainty(best: Array, u: Array, y: Array, targets: Targets, covariance: Array, seed: int = 0,
                neighbours: int | None = None, draws: int = 4000) -> Uncertainty:
    """Linear posterior around a best point, uniform prior in the unit cube.

    best: (k,). u: (n, k), y: (n, q) means over seeds; rows with NaN are left out. covariance: (q, q), of the misfit.
    neighbours: nearest points that enter; None: half of them, at least 3 (k + 1).

    The outputs are regressed on u with weights that fall to zero at the farthest neighbour. The truncated normal
    distribution is drawn from along the directions that the targets tell apart. Raises `Error` with fewer than k + 2
    points.
    """
    raise NotImplementedError
