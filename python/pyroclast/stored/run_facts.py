"""Facts of a run, run.json: what each column and result is, so that no reader has to know its name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

from ..errors import Error
from .files import read_json

PRESS, PROBE, RECORD = "press", "probe", "record"
PUT_IN, HELD, LOST, ENERGY_ERROR = "energy.put_in", "energy.held", "energy.lost", "energy.error"
DAMAGED, BROKEN = "crack.damaged", "crack.broken"
DAMAGED_EXTENT, BROKEN_EXTENT = "crack.damaged_extent", "crack.broken_extent"
OPENING, HEAT = "crack.opening", "heat.held"
WATER, PROBE_PRESSURE = "water", "probe.pressure"
SPALLING, BAR, BAR_UNSPALLED = "spalling", "bar", "bar_unspalled"


@dataclass(frozen=True)
class Column:
    """What a column of the history is."""

    name: str
    unit: str  #: "1" of a number
    label: str  #: few words for legends; of energies and heats
    meaning: str
    role: str  #: such as "press", "energy.held" or "crack.broken"
    of: str  #: quantity within the role, such as "stress", or the name of a record or probe
    mode: str = ""  #: of cracks: "tension", "shear" or "mixed"
    interface: str = ""  #: of cracks


@dataclass(frozen=True)
class ResultFacts:
    """What a result of a stage is."""

    name: str
    unit: str  #: "1" of a number; empty of a text
    label: str
    meaning: str
    of: str  #: "test", "computation", or a text: "reason", "doubt"
    digits: int | None  #: behind the point, in `shown_in`; None: up to four
    shown_in: str  #: unit in which a reader sees it
    about: str = ""  #: name of the result that this one belongs to


class RunFacts:
    """What a run is: run.json. What is missing or malformed raises Error, which names the file."""

    def __init__(self, path: Path):
        if not path.exists():
            raise Error(f"{path}: is missing: the run is of an older version or was not copied whole; "
                        "run its deck.toml again")
        self._path, self._facts = path, read_json(path)

    def _typed(self, name: str, *types: type) -> Any:
        value = self._facts.get(name)
        if not isinstance(value, types) or isinstance(value, bool) is not (bool in types):
            raise Error(f"{self._path}: {name!r} is missing or of a wrong kind")
        return value

    def _list(self, name: str, of: type, optional: tuple[str, ...]) -> list[Any]:
        found = []
        for entry in self._typed(name, list):
            known = {key.name: entry.get(key.name) for key in fields(of)} if isinstance(entry, Mapping) else {}
            known = {key: value for key, value in known.items() if value is not None or key not in optional}
            if not known or not all(isinstance(value, str) or key == "digits" for key, value in known.items()) \
                    or not isinstance(known.get("digits", 0), (int, type(None))):
                raise Error(f"{self._path}: {name!r} holds {entry!r:.60}, which does not say what it is")
            found.append(of(**known))
        return found

    @property
    def dimension(self) -> int:
        """Dimension of the body: 2 or 3."""
        return int(self._typed("dimension", int))

    @property
    def moves(self) -> bool:
        """Whether there are mechanics; else the run is of heat conduction alone."""
        return bool(self._typed("moves", bool))

    @property
    def has_press(self) -> bool:
        """Whether the body stood between platens, so that the test has a stress and a strain."""
        return bool(self._typed("has_press", bool))

    @property
    def test_stage(self) -> int | None:
        """Number of the stage that is the test, from 0; None without one."""
        return None if self._facts.get("test_stage") is None else int(self._typed("test_stage", int))

    @property
    def extent(self) -> tuple[str, str]:
        """Measure of cracks and its unit: "length" in "m", in space "area" in "m2"."""
        extent = self._typed("extent", dict)
        if not isinstance(extent.get("name"), str) or not isinstance(extent.get("unit"), str):
            raise Error(f"{self._path}: 'extent' has no name or no unit")
        return extent["name"], extent["unit"]

    @cached_property
    def columns(self) -> list[Column]:
        """Columns of the history, in its order."""
        return self._list("columns", Column, ("mode", "interface"))

    @cached_property
    def results(self) -> dict[str, ResultFacts]:
        """Results that the stages may have, by name."""
        return {result.name: result for result in self._list("results", ResultFacts, ("about",))}

    def of_role(self, role: str, of: str | None = None, mode: str | None = None) -> list[Column]:
        """Returns the columns of a role, in order, of a quantity or of a mode of cracks where one is asked for."""
        return [column for column in self.columns if column.role == role
                and of in (None, column.of) and mode in (None, column.mode)]

    def column(self, role: str, of: str | None = None) -> Column | None:
        """Returns the first column of a role, and of a quantity; None without one."""
        return next(iter(self.of_role(role, of)), None)

    def press(self, of: str) -> str:
        """Returns the name of the column of a quantity of the press, such as "stress". Raises Error without one."""
        column = self.column(PRESS, of)
        if column is None:
            raise Error(f"{self._path}: no column is the {of} between platens")
        return column.name

    @cached_property
    def crack_modes(self) -> dict[str, list[str]]:
        """Interfaces that can break, by the mode of their damage."""
        modes: dict[str, list[str]] = {}
        for column in self.of_role(BROKEN):
            modes.setdefault(column.mode, []).append(column.interface)
        return modes

    def text_about(self, result: str, kind: str) -> str:
        """Returns the name of the "reason" or "doubt" of a result; empty without one."""
        return next((each.name for each in self.results.values() if each.about == result and each.of == kind), "")
