"""Points in the unit cube."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import Error

Array = NDArray[np.float64]
_BITS = 30
_DESIGNS = 100


def grid(levels: Sequence[int], ends: bool | Sequence[bool] = True) -> Array:
    """Returns all combinations of evenly spaced levels, shape (product of levels, parameters), the last parameter
    fastest.

    levels: how many of each parameter; a single one lies at 0.5.
    ends: whether the levels reach from 0 to 1; if not, they are the middles of equal classes, (i + 0.5)/n, as a
        distribution without ends needs it. One for all parameters, or one each.

    Raises `Error` where a parameter has no level.
    """
    if any(count < 1 for count in levels):
        raise Error("a grid needs at least one level of each parameter")
    reach = [ends] * len(levels) if isinstance(ends, bool) else list(ends)
    columns = [np.linspace(0.0, 1.0, count) if full and count > 1 else (np.arange(count) + 0.5) / count
               for count, full in zip(levels, reach, strict=True)]
    return np.stack([column.ravel() for column in np.meshgrid(*columns, indexing="ij")], axis=1)


def inside(u: Array, levels: int) -> Array:
    """Moves levels that reach from 0 to 1 to the middles of equal classes: i/(n - 1) becomes (i + 0.5)/n."""
    return (np.asarray(u, float) * (levels - 1) + 0.5) / levels


def in_shares(u: Array, count: int) -> Array:
    """Moves a point in one of `count` equal shares to the middle of its share, (i + 0.5)/n."""
    shares: Array = np.minimum(np.floor(np.asarray(u, float) * count), count - 1)
    return (shares + 0.5) / count


def latin_hypercube(n: int, k: int, seed: int) -> Array:
    """Returns n points, one in each of n equal classes of every parameter, shape (n, k).

    Of 100 such designs it is the one with the least centred discrepancy. It cannot be extended: another n gives other
    points. (McKay, Beckman, Conover, Technometrics 21, 1979; Hickernell, Math. Comput. 67, 1998.)
    """
    from scipy.stats import qmc

    sampler = qmc.LatinHypercube(k, seed=np.random.default_rng(seed))
    return min((np.asarray(sampler.random(n)) for _ in range(_DESIGNS)), key=qmc.discrepancy)


def sobol_sequence(n: int, k: int, seed: int, first: int = 0) -> Array:
    """Returns points first to first + n of the scrambled Sobol' sequence in k dimensions, shape (n, k), never 0 or 1.

    Extendable: the first n of 2n points are the same. Best balanced where n is a power of two. (Joe, Kuo, SIAM J. Sci.
    Comput. 30, 2008; scrambled as in Matoušek, J. Complexity 14, 1998.)
    """
    from scipy.stats import qmc

    sequence = qmc.Sobol(k, scramble=True, bits=_BITS, seed=np.random.default_rng(seed))
    if first:
        sequence.fast_forward(first)
    with warnings.catch_warnings():
        # It warns where n is no power of two; the docstring says so.
        warnings.simplefilter("ignore", UserWarning)
        return np.asarray(sequence.random(n)) + 0.5**(_BITS + 1)


def correlated(u: Array, rank_correlation: ArrayLike, keep_columns: bool = False) -> Array:
    """Gives independent points a Spearman correlation by a Gaussian copula. u: (n, k), inside the open cube.

    rank_correlation: (k, k), symmetric, ones on the diagonal.
    keep_columns: give each column exactly its old values in their new order, so that a Latin hypercube remains one
        (Iman, Conover, Commun. Stat. B 11, 1982). Not for points that are to be extended.

    Pearson's correlation of the normal scores is 2 sin(pi rho/6). The first column is as before. Raises `Error` where
    no such copula has these correlations.
    """
    from scipy.special import ndtr, ndtri
    from scipy.stats import rankdata

    u = np.asarray(u, float)
    ranks = np.asarray(rank_correlation, float)
    count = u.shape[1]
    if ranks.shape != (count, count) or not np.allclose(ranks, ranks.T) or not np.allclose(np.diag(ranks), 1.0):
        raise Error(f"rank correlations of {count} parameters: a symmetric matrix with ones on its diagonal is needed")
    try:
        factor = np.linalg.cholesky(2.0 * np.sin(np.pi / 6.0 * ranks))
    except np.linalg.LinAlgError:
        raise Error("no Gaussian copula has these rank correlations: their matrix is not positive definite") from None
    joint = np.asarray(ndtr(ndtri(u) @ factor.T))
    joint[:, 0] = u[:, 0]
    if keep_columns:
        order = rankdata(joint, method="ordinal", axis=0).astype(int) - 1
        joint = np.take_along_axis(np.sort(u, axis=0), order, axis=0)
    return joint
