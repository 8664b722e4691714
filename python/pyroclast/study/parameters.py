"""What a study varies: a distribution, and what a value of it does to a deck."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Union

from ..errors import Error
from ..live.decks import toml

Value = Union[float, int, str, bool]
"""A value of a parameter: a number in its unit, or one of its choices."""

_DIGITS = 10  # of a value: a table gives it back exactly, and no mathematics library changes it
_CURVE = ("value", "table", "csv", "builtin", "expression", "from")  # keys, one of which each curve of a deck has


@dataclass(frozen=True)
class Distribution:
    """Distribution of one parameter: its inverse takes a number of [0, 1] to a value.

    kind: "uniform" and "log_uniform" between two numbers, "normal" and "truncated_normal" with mean and standard
        deviation (and two bounds), "integer" between two, both included, "choice" of a list.
    """

    kind: str
    numbers: tuple[float, ...] = ()
    choices: tuple[Value, ...] = ()

    @property
    def count(self) -> int | None:
        """Number of values, where they are countable."""
        if self.kind == "choice":
            return len(self.choices)
        return int(self.numbers[1] - self.numbers[0]) + 1 if self.kind == "integer" else None

    def at(self, u: float) -> Value:
        """Returns the value at a number of [0, 1]."""
        if (count := self.count) is not None:
            i = min(int(u * count), count - 1)
            return self.choices[i] if self.kind == "choice" else int(self.numbers[0]) + i
        return float(f"{self._inverse(u):.{_DIGITS}g}")

    def _inverse(self, u: float) -> float:
        low, high = self.numbers[0], self.numbers[1]
        if self.kind == "uniform":
            return low + u * (high - low)
        if self.kind == "log_uniform":
            return math.exp(math.log(low) + u * (math.log(high) - math.log(low)))
        return float(self._normal().ppf(min(max(u, 1e-9), 1.0 - 1e-9)))

    def _normal(self) -> Any:
        from scipy import stats  # takes longer than all else that a command of studies imports

        mean, sd, *bounds = self.numbers
        if not bounds:
            return stats.norm(mean, sd)
        return stats.truncnorm((bounds[0] - mean) / sd, (bounds[1] - mean) / sd, mean, sd)

    def ends(self) -> list[Value]:
        """Returns the least and largest values drawn, of a normal distribution all but one of 1,000; all choices."""
        if self.kind == "choice":
            return list(self.choices)
        tail = 1e-3 if self.kind == "normal" else 0.0
        return [self.at(tail), self.at(1.0 - tail)]


@dataclass(frozen=True)
class Parameter:
    """A parameter of a study.

    keys: of the deck, each with a factor that the value is multiplied with; none where a command or a function takes
        the value by the parameter's name.
    how: "value", or what is done to what the deck says: "scale" (a number), "shift" (of a curve, in K).
    unit: of values; empty for plain numbers and words.
    levels: values in a grid.
    """

    name: str
    distribution: Distribution
    keys: tuple[tuple[str, float], ...] = ()
    how: str = "value"
    unit: str = ""
    levels: int = 5

    @property
    def column(self) -> str:
        """Column of tables: name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    def changes(self, value: Value, deck: Mapping[str, Any]) -> list[tuple[str, str]]:
        """Returns keys with what is written there, as TOML. deck: as it stands. Raises Error for what must stay."""
        return [(self._key(path, deck), self._text(path, factor, value, deck)) for path, factor in self.keys]

    def _key(self, path: str, deck: Mapping[str, Any]) -> str:
        there = value_at(deck, path)
        if not _is_curve(there):
            if self.how == "shift":
                raise Error(f"{path} holds no curve over temperature that could be shifted")
            return path
        if self.how != "value":
            return f"{path}.{self.how}"
        if "value" not in there:
            raise Error(f'{path} holds a curve over temperature, which one value would replace; vary a "scale" or a '
                        f'"shift" of it: vary = "scale"')
        return f"{path}.value"

    def _text(self, path: str, factor: float, value: Value, deck: Mapping[str, Any]) -> str:
        if isinstance(value, (str, bool)):
            return toml(value)
        number = value if factor == 1.0 else float(f"{value * factor:.{_DIGITS}g}")
        if self.how == "scale" and not _is_curve(there := value_at(deck, path)):
            return toml(scaled(path, there, number))
        return toml(f"{number!r} {self.unit}" if self.unit else number)


def value_at(deck: Mapping[str, Any], path: str) -> Any:
    """Returns what stands at a path of a deck such as "stages[1].to"; None where there is nothing."""
    node: Any = deck
    for part in path.replace("]", "").replace("[", ".").split("."):
        if isinstance(node, Mapping):
            node = node.get(part)
        elif isinstance(node, Sequence) and not isinstance(node, str) and part.isdigit() and int(part) < len(node):
            node = node[int(part)]
        else:
            return None
    return node


def numbered(path: str, deck: Mapping[str, Any]) -> str:
    """Returns the path with numbers in the place of names of stages: "stages[heating].to" -> "stages[1].to".

    A stage is named by its `name`, or by its kind where no other is of that kind. Raises Error where none or several
    are called so.
    """
    if not path.startswith("stages["):
        return path
    name, _, rest = path.removeprefix("stages[").partition("]")
    if name.isdigit():
        return path
    stages = deck.get("stages", [])
    called = [i for i, s in enumerate(stages) if s.get("name") == name]
    called = called or [i for i, s in enumerate(stages) if s.get("kind") == name]
    if len(called) != 1:
        known = ", ".join(str(s.get("name", s.get("kind"))) for s in stages)
        raise Error(f"{path}: {'several stages are' if called else 'no stage is'} called {name!r}; there are {known}")
    return f"stages[{called[0]}]{rest}"


def _is_curve(there: Any) -> bool:
    return isinstance(there, Mapping) and any(key in there for key in _CURVE)


def scaled(path: str, there: Any, factor: float) -> str | float:
    """Returns a quantity of the deck times a factor."""
    if isinstance(there, (int, float)) and not isinstance(there, bool):
        return float(f"{there * factor:.{_DIGITS}g}")
    number, _, unit = str(there).partition(" ")
    try:
        return f"{float(f'{float(number) * factor:.{_DIGITS}g}')!r} {unit}".strip()
    except ValueError:
        raise Error(f"{path} is {there!r}, which has no number to scale") from None
