"""Points in the unit cube."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def grid(levels: Sequence[int], ends: bool | Sequence[bool] = True) -> Array:
    """All combinations of evenly spaced levels, shape (product of levels, parameters), the last parameter fastest.

    levels: how many of each parameter; a single one lies at 0.5.
    ends: whether the levels reach from 0 to 1; if not, they are the middles of equal classes, (i + 0.5)/n, as a
        distribution without ends needs it. One for all parameters, or one each.

    Raises `Error` where a parameter has no level.
    """
    raise NotImplementedError


def inside(u: Array, levels: int) -> Array:
    """Levels that reach from 0 to 1 moved to the middles of equal classes: i/(n - 1) becomes (i + 0.5)/n."""
    raise NotImplementedError


def latin_hypercube(n: int, k: int, seed: int) -> Array:
    """n points, one in each of n equal classes of every parameter; of low centred discrepancy. Shape (n, k).

    It cannot be extended: another n gives other points. (McKay, Beckman, Conover, Technometrics 21, 1979; columns
    permuted at random as in scipy.stats.qmc.)
    """
    raise NotImplementedError


def sobol_sequence(n: int, k: int, seed: int, first: int = 0) -> Array:
    """Points first to first + n of the scrambled Sobol' sequence in k dimensions, shape (n, k), never 0 or 1.

    Extendable: the first n of 2n points are the same. Best balanced where n is a power of two. (Joe, Kuo, SIAM J. Sci.
    Comput. 30, 2008; scrambled as in Matoušek, J. Complexity 14, 1998.)
    """
    raise NotImplementedError


def correlated(u: Array, rank_correlation: ArrayLike, keep_columns: bool = False) -> Array:
    """Independent points given a Spearman correlation by a Gaussian copula. u: (n, k), inside the open cube.

    rank_correlation: (k, k), symmetric, ones on the diagonal.
    keep_columns: give each column exactly its old values in their new order, so that a Latin hypercube remains one
        (Iman, Conover, Commun. Stat. B 11, 1982). Not for points that are to be extended.

    Pearson's correlation of the normal scores is 2 sin(pi rho/6). The first column is as before. Raises `Error` where
    no joint distribution has these correlations.
    """
    raise NotImplementedError
