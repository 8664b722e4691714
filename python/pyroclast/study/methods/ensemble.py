"""One point with many seeds: mean, spread and how well the mean is known."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike


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
        raise NotImplementedError


def summary(values: ArrayLike, level: float = 0.95, percentiles: Sequence[float] = (5, 50, 95)) -> Summary:
    """Of the values (seeds,), NaN where a run gave none. level: of the confidence interval."""
    raise NotImplementedError


def widest(summaries: Iterable[Summary]) -> float:
    """The largest relative width: what "widest interval" means in a criterion to stop."""
    raise NotImplementedError
