"""One point with many seeds: mean, spread and how well the mean is known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike


_MOST_SEEDS = 1_000_000


@dataclass(frozen=True)
class Summary:
    """One output over the seeds. NaN where there are too few of them."""

    n: int  #: seeds with a value
    missing: int  #: seeds without
    mean: float
    sd: float  #: of single runs, with n - 1
    variation: float  #: coefficient of variation, sd/|mean|
    low: float  #: confidence interval of the mean, Student's t
    high: float
    percentiles: Mapping[float, float]  #: of single runs, linear between the values

    @property
    def relative_width(self) -> float:
        """Half-width of the confidence interval over |mean|: 0.05 says mean ± 5 %; infinite while unknown."""
        half = 0.5 * (self.high - self.low)
        return half / abs(self.mean) if np.isfinite(half) and self.mean != 0.0 else float("inf")


def summary(values: ArrayLike, level: float = 0.95, percentiles: Sequence[float] = (5, 50, 95)) -> Summary:
    """Returns the summary of the values (seeds,), NaN where a run gave none. level: of the confidence interval."""
    given = np.asarray(values, float)
    found = given[np.isfinite(given)]
    n = len(found)
    mean = float(found.mean()) if n else float("nan")
    sd = float(found.std(ddof=1)) if n > 1 else float("nan")
    half = _half_width(sd, n, level) if n > 1 else float("nan")
    places = {float(p): float(np.percentile(found, p)) if n else float("nan") for p in percentiles}
    variation = sd / abs(mean) if mean != 0.0 else float("nan")
    return Summary(n, len(given) - n, mean, sd, variation, mean - half, mean + half, places)


def seeds_for(share: float, variation: float, level: float = 0.95) -> int | None:
    """Returns how many seeds give the mean ± a share of it (Student's t), where single runs scatter by a coefficient of
    variation. None where that is not known, and beyond a million. level: of the confidence interval of the mean.
    """
    least, most = 2, _MOST_SEEDS
    if not _half_width(variation, most, level) <= share:
        return None
    while least < most:
        middle = (least + most) // 2
        if _half_width(variation, middle, level) > share:
            least = middle + 1
        else:
            most = middle
    return most


def _half_width(sd: float, n: int, level: float) -> float:
    """Returns the half-width of the confidence interval of a mean of n values."""
    from scipy.stats import t

    return float(t.ppf(0.5 * (1.0 + level), n - 1)) * sd / float(np.sqrt(n))


def widest(summaries: Iterable[Summary]) -> float:
    """Returns the largest relative width: what "widest interval" means in a criterion to stop."""
    return max((entry.relative_width for entry in summaries), default=float("inf"))
