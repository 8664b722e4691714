"""What a report is made from: a study and all that is known of it at one time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import Error
from ..driver import StudyForecast
from ..file import StudySetup
from ..methods import sampling
from ..study import Study

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Seen:
    """A study as it stands.

    asked: all points that the method asked for, (points, parameters) in the unit cube. rows: a line for each run, as in
        the table. findings: None where there are none; `none_because` says why. missing: by output, why the runs that
        came to their end lack it.
    """

    setup: StudySetup
    forecast: StudyForecast
    asked: Array
    rows: list[dict[str, Any]]
    findings: dict[str, Any] | None
    none_because: str
    missing: dict[str, list[str]]

    @property
    def is_complete(self) -> bool:
        return self.forecast.is_complete and not self.forecast.left

    @property
    def method(self) -> str:
        return self.setup.method.kind

    def of_outputs(self) -> dict[str, dict[str, Any]]:
        """Returns findings by output; some may be no more than {"none_because": text}."""
        found = (self.findings or {}).get("outputs", {})
        return {output.name: found[output.name] for output in self.setup.outputs if output.name in found}

    @cached_property
    def u(self) -> Array:
        """The points, with integers and choices in the middles of their shares."""
        u = self.asked.copy()
        for column, parameter in enumerate(self.setup.parameters):
            if (count := parameter.distribution.count) is not None:
                u[:, column] = sampling.in_shares(u[:, column], count)
        return u

    @cached_property
    def _rows(self) -> dict[tuple[Any, ...], list[dict[str, Any]]]:
        """Rows by the values of the parameters."""
        found: dict[tuple[Any, ...], list[dict[str, Any]]] = {}
        for row in self.rows:
            found.setdefault(tuple(row[p.column] for p in self.setup.parameters), []).append(row)
        return found

    def means(self, output: str) -> Array:
        """Returns means of an output over the seeds, (points,); NaN where one of them has no value."""
        values = [tuple(p.distribution.at(float(x)) for p, x in zip(self.setup.parameters, u)) for u in self.u]
        return np.array([numbers(row[output] for row in self._rows.get(v, [{output: None}])).mean() for v in values])


def seen(study: Study) -> Seen:
    """Takes what one reading of the store shows, so that all of it belongs together while another process adds runs."""
    driver = study._driver()
    findings, none_because = _findings(driver.findings)
    asked = driver.plan.propose(driver._answers).points
    return Seen(study.setup, driver.forecast(), asked, driver.rows(), findings, none_because,
                driver.missing())


def _findings(find: Callable[[], dict[str, Any]]) -> tuple[dict[str, Any] | None, str]:
    try:
        return find(), ""
    except Error as error:
        return None, str(error)


def numbers(found: Any) -> Array:
    """Returns the numbers of findings, which hold None for what is not finite."""
    return np.array([np.nan if value is None else value for value in found], float)


def number(value: float | None, digits: int = 4) -> str:
    """Returns a number for a reader; a dash where there is none."""
    if value is None or not np.isfinite(value):
        return "–"
    return f"{value:.{digits}g}".replace("-", "−")


def between(low: float | None, high: float | None, digits: int = 4) -> str:
    """Returns an interval, for a reader."""
    unknown = low is None or high is None or not np.isfinite([low, high]).all()
    return "–" if unknown else f"{number(low, digits)} to {number(high, digits)}"


def percent(share: float | None) -> str:
    """Returns a share of 1, for a reader."""
    if share is None or not np.isfinite(share):
        return "–"
    return f"{100.0 * share:.{0 if abs(share) >= 0.0995 else 1}f} %".replace("-", "−")


def listed(words: ArrayLike) -> str:
    """Joins words: "a", "a and b", "a, b and c"."""
    named = [str(word) for word in np.atleast_1d(words)]
    return " and ".join(filter(None, [", ".join(named[:-1]), *named[-1:]]))
