"""Numbers out of the folder of a run."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import Error

if TYPE_CHECKING:
    from ..stored.files import Table

_HISTORY = re.compile(r"(?P<column>\S+)"
                      r"(?: (?P<place>last|largest|least)"
                      r"| at (?P<at>\S+) = (?P<value>[-+0-9.eE]+)"
                      r"| where (?P<of>\S+) is (?P<extreme>largest|least))?")

_FUNCTION = "python: "
QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?:\s+(\S.*?))?\s*")  #: a number, and its unit
_UNIT_IN_NAME = re.compile(r"_([kMG]?Pa(?:_[sm])?|[munkMG]?N(?:_(?:s|m?m2?))?|[munkM]?J(?:_(?:m2|kg|kg_K))?|"
                           r"[mkM]?W(?:_(?:m2|m2_K|m_K))?|K(?:_(?:s|min|h))?|[munck]?m(?:_(?:s2?|min|h))?|"
                           r"[munck]?m[23](?:_s)?|k?g(?:_m3)?|1_[sK]|[mun]?s|min|h|Hz|deg|rad|degC|percent)$")


@dataclass(frozen=True)
class Output:
    """A number that a study takes of each run.

    what: "f_c_MPa", a number of the summary, by its name among the results of the stages (the last that has it), or by
        its path ("energy_J.elastic_zones"); or "history: COLUMN", with a place: "last" (without one), "largest",
        "least", "at COLUMN = NUMBER" (where that is first passed, linear between rows), or
        "where COLUMN is largest" (or "least").
    """

    name: str
    what: str

    def __post_init__(self) -> None:
        if self.of_history and not _HISTORY.fullmatch(self._place):
            raise Error(f'{self.what!r}: a column of the history is taken "last", "largest", "least", '
                        f'"at COLUMN = NUMBER", "where COLUMN is largest" or "where COLUMN is least"')

    @classmethod
    def of_function(cls, name: str) -> Output:
        """Returns an output that a script takes of each run."""
        return cls(name, f"{_FUNCTION}{name}")

    @property
    def is_function(self) -> bool:
        return self.what.startswith(_FUNCTION)

    @property
    def of_history(self) -> bool:
        return self.what.startswith("history:")

    @property
    def unit(self) -> str:
        """Unit that the number counts in, as the name of a result or column ends on it; "1" where none is told."""
        if self.of_history:
            return unit_of_name(self.columns[0])
        units = (unit_of_name(part) for part in reversed(self.summary_name.split(".")))
        return next((unit for unit in units if unit != "1"), "1")

    @property
    def _place(self) -> str:
        return " ".join(self.what.removeprefix("history:").split())

    @property
    def columns(self) -> list[str]:
        """Columns of the history that it needs."""
        found = _HISTORY.fullmatch(self._place) if self.of_history else None
        return [c for c in (found["column"], found["at"], found["of"]) if c] if found else []

    @property
    def summary_name(self) -> str:
        """Name of a number of the summary: a name, or a path."""
        return self.what.removeprefix("summary:").strip()

    def of(self, folder: Path, summary: dict[str, Any], facts: dict[str, Any]) -> tuple[float, str]:
        """Returns the number, and why there is none (NaN) or why it is in doubt; empty where nothing is against it. Not
        of functions. summary, facts: summary.json and run.json of the run.
        """
        return self._of_history(folder) if self.of_history else self._of_summary(summary, facts)

    def _of_summary(self, summary: dict[str, Any], facts: dict[str, Any]) -> tuple[float, str]:
        name = self.summary_name
        results = [s.get("results", {}) for s in summary.get("stages", []) if isinstance(s, dict)]
        with_it = [r for r in results if name in r]
        node: Any = with_it[-1][name] if with_it else summary
        if not with_it:
            for part in name.split("."):
                node = node.get(part) if isinstance(node, dict) else None
        own = with_it[-1] if with_it else summary
        if isinstance(node, (int, float)) and math.isfinite(node):
            return float(node), str(own.get(_text_about(facts, name, "doubt")) or "")
        why = own.get(_text_about(facts, name, "reason"))
        return math.nan, str(why or ("the test came to none" if with_it else f"the summary has no number called {name!r}"))

    def _of_history(self, folder: Path) -> tuple[float, str]:
        from ..stored.files import Table  # numpy and h5py, which a task that takes no history does without

        found = _HISTORY.fullmatch(self._place)
        assert found
        try:
            table = Table(folder / "history.csv", may_be_empty=False)
        except Error as error:
            return math.nan, str(error)
        for column in self.columns:
            if column not in table.names:
                return math.nan, f"the history has no column {column!r}"
        return _at_place(table, found)


@dataclass(frozen=True)
class Offer:
    """What the runs of a deck have, that an output can be."""

    numbers: Sequence[str]  #: of the summary: results by name, others by path
    columns: Sequence[str]  #: of the history

    def lacks(self, output: Output) -> str:
        """Returns why no run has an output, with the nearest name; empty where runs may have it. Not of functions."""
        if not output.of_history:
            name = output.summary_name
            if name in self.numbers:
                return ""
            return _unknown(f"no run of this deck has a number {name!r}", name, self.numbers)
        for column in output.columns:
            if column not in self.columns:
                return _unknown(f"no run of this deck has a column {column!r} in its history", column, self.columns)
        return ""


def _unknown(what: str, name: str, known: Sequence[str]) -> str:
    from .. import _core  # which a task does without

    if hint := _core.did_you_mean(name, known):
        return f"{what}; {hint}"
    short = [n for n in known if "." not in n]
    more = ", and others by their path, such as energy_J.kinetic" if len(short) < len(known) else ""
    return f"{what}; there are {', '.join(short)}{more}"


def unit_of_name(name: str) -> str:
    """Returns the unit on which the name of a result or column ends: of "rate_K_s" "K/s"; "1" where it ends on none."""
    found = _UNIT_IN_NAME.search(name)
    return found[1].replace("_", "/") if found else "1"


def number_in(value: Any, unit: str) -> float:
    """Returns the number of a value in a unit: a bare number counts in it, a quantity with a unit is converted. "1" is
    no unit.

    Raises Error, which names the unit, where the value is no number, is not finite, or is a quantity of another kind.
    """
    from .. import _core  # which a task does without

    number = math.nan
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        number = float(value)
    elif isinstance(value, str) and (plain := QUANTITY.fullmatch(value)) and not plain[2]:
        number = float(plain[1])
    elif isinstance(value, str):
        for spelt in dict.fromkeys((unit, unit.replace("/", " "))):  # a name ends on "N_m" for N/m and for N m
            try:
                number = _core.convert(value, spelt)
                break
            except Error:
                pass
    if math.isfinite(number):
        return number
    if unit == "1":
        raise Error("counts in no unit, as the name of the output tells none: a plain number is needed, or "
                    "e.g. \"31 %\"")
    raise Error(f"counts in {unit}: a number is needed, or a quantity of that kind, such as \"1 {unit}\"")


def with_plain_numbers(what: str) -> str:
    """Returns an output whose "at COLUMN = QUANTITY" is a number in that column's unit. Raises as number_in."""
    found = re.fullmatch(r"(history:.* at (\S+) = )(\S.*)", " ".join(what.split()))
    if not found:
        return what
    try:
        return f"{found[1]}{number_in(found[3], unit_of_name(found[2]))!r}"
    except Error as error:
        raise Error(f"{found[3]} does not belong to {found[2]}, which {error}") from None


def _text_about(facts: dict[str, Any], result: str, kind: str) -> str:
    """Returns the name of the result that is the "reason" or "doubt" of another, as run.json tells; empty without one."""
    known = facts.get("results")
    about = [each for each in known if isinstance(each, dict)] if isinstance(known, list) else []
    return next((str(each.get("name")) for each in about if each.get("about") == result and each.get("of") == kind), "")


def _at_place(table: Table, found: re.Match[str]) -> tuple[float, str]:
    column = table[found["column"]]
    if found["at"]:
        along, value = table[found["at"]], float(found["value"])
        for i in range(1, len(along)):
            a, b = along[i - 1], along[i]
            if (a - value) * (b - value) <= 0.0 and a != b:
                return float(column[i - 1] + (value - a) / (b - a) * (column[i] - column[i - 1])), ""
        return math.nan, f"{found['at']} never is {found['value']}"
    of = table[found["of"]] if found["of"] else column
    rows = [i for i in range(len(of)) if math.isfinite(of[i]) and math.isfinite(column[i])]
    if not rows:
        return math.nan, f"{found['column']} has no value"
    place = found["extreme"] or found["place"] or "last"
    size = [float(of[i]) for i in rows]
    row = rows[-1] if place == "last" else rows[size.index(max(size) if place == "largest" else min(size))]
    return float(column[row]), ""


def read_summary(folder: Path) -> dict[str, Any] | None:
    """Reads summary.json; None where there is none that is whole."""
    return _json_in(folder / "summary.json") or None


def read_facts(folder: Path) -> dict[str, Any]:
    """Reads run.json; empty where there is none that is whole."""
    return _json_in(folder / "run.json")


def _json_in(path: Path) -> dict[str, Any]:
    """Reads an object, with the standard library alone; empty where there is none that is whole."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
