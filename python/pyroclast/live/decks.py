"""Decks as objects that know units."""

from __future__ import annotations

import contextlib
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, MutableMapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from .. import _core
from ..errors import DeckError, Diagnostic, Error
from . import functions
from .specimen import Specimen
from .stages import Stage
from .units import Quantity, in_si

Value = Union[str, bool, int, float, Quantity, Sequence[Any], Mapping[str, Any]]
"""What a key can hold; a function only where a curve can stand."""

_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s+(\S.*?)\s*")
_DOTS_OF_A_KEY = 2  # so many in a path: a table there is a value, such as a curve, and no table of keys
_CELLS = "cells.json"  # what the blocks of a specimen are kept in
_MADE_OTHERWISE = ("aggregates", "inclusions", "blocks", "superposition")  # tables that have no effect beside it
_PLAIN_KEY = re.compile(r"[A-Za-z0-9_-]+")


def toml(value: Value) -> str:
    """Returns a value as a deck writes it."""
    if isinstance(value, (np.ndarray, np.generic)):
        return toml(value.tolist())
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, Quantity)):
        text = str(value).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
        return f'"{text}"'
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(name)} = {toml(entry)}" for name, entry in value.items()) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    raise TypeError(f"a deck cannot hold {value!r}")


def table_text(name: str, table: Mapping[str, Any], is_listed: bool = False) -> str:
    """Returns a table with its header, tables below it with headers of their own."""
    lines = [f"[[{name}]]" if is_listed else f"[{name}]"]
    below = []
    for key, value in table.items():
        if isinstance(value, Mapping):
            below.append(table_text(f"{name}.{_key(key)}", value))
        elif is_list_of_tables(value):
            below += [table_text(f"{name}.{_key(key)}", entry, True) for entry in value]
        else:
            lines.append(f"{_key(key)} = {toml(value)}")
    return "\n".join([*lines, "", *below])


def _parts(path: str) -> list[str | int]:
    """Returns the parts of a path, of "stages[1].to": "stages", 1, "to"."""
    return [int(part[1:-1]) if part.startswith("[") else part for part in re.findall(r"[^.\[\]]+|\[\d+\]", path)]


def _renumbered(key: str, above: Sequence[str | int], gone: str | int) -> str:
    """Returns the path of a key when an entry of a list is taken out."""
    parts = _parts(key)
    n = len(above)
    if isinstance(gone, str) or len(parts) <= n or parts[:n] != list(above):
        return key
    number = parts[n]
    if not isinstance(number, int) or number < gone:
        return key
    parts[n] = number - 1
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in parts).removeprefix(".")


def _list_at(tables: dict[str, Any], path: str) -> list[Any]:
    """Returns the list at a path, which is added where it is missing."""
    *above, last = _parts(path)
    node: Any = tables
    for part in above:
        node = node.setdefault(part, {}) if isinstance(node, dict) else node[part]
    found: list[Any] = node.setdefault(last, [])
    return found


def is_list_of_tables(value: object) -> bool:
    """Returns whether a deck writes a value as a list of tables, each with a header of its own."""
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(entry, Mapping) for entry in value)


def _plain(value: Any) -> Any:
    """Returns a value with dicts in the place of tables of decks."""
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(entry) for entry in value]
    return value


def _key(name: str) -> str:
    return name if _PLAIN_KEY.fullmatch(name) else toml(name)


class Deck:
    """What a run is made from: a TOML file in which every value with a dimension carries its unit.

    Keys are named by their paths, as in `--set` of the program: "specimen.width", "stages[1].to". A value with a
    dimension is a text with its unit ("150 mm") or a Quantity (`150 * pyroclast.mm`); a bare number is refused. Where
    a curve can stand, so can a function: of the temperature [degC], or of the heating time [s] in
    `[[heat.boundaries]]`; what it returns is SI, of a temperature degC, or in the unit of a `pyroclast.Function`. The
    `factor` of a drive is a function of the time since its stage began [s]. "specimen" takes a `pyroclast.Specimen` too.

    Raises DeckError for a file that is no deck, or holds no TOML.
    """

    def __init__(self, file: str | Path | None = None, *, stages_in_python: Sequence[type[Stage]] = (),
                 laws: Sequence[str | Path] = (), **tables: Any):
        """Reads a deck, or takes one as tables.

        file: a deck; without one, `tables` are all of it.
        stages_in_python: classes of stages that the deck may ask for beside the program's.
        laws: folders of contact laws that are not part of the program.
        tables: the deck's tables, `specimen={"width": "150 mm"}`, and lists of tables, `stages=[{"kind": "settle"}]`.
            They add to a file, or change it.
        """
        self._stages = list(stages_in_python)
        self._laws = [str(folder) for folder in laws]
        self._changes: list[tuple[str, str]] = []
        self._functions: dict[str, functions.Function] = {}
        self._specimen: tuple[Specimen, functions.Scratch] | None = None
        self._name, self._folder, self._text = "deck", "", ""
        self._is_own = file is None  # the script's, not a file's: what it names, the script names
        if file is not None:
            self._name, self._folder = str(file), str(Path(file).parent)
            self._text = _read(file)
            self._written()
            self.update(**tables)
        else:
            self._set_tables(tables)

    @classmethod
    def from_text(cls, text: str, name: str = "deck", folder: str | Path = "", *,
                  stages_in_python: Sequence[type[Stage]] = (), laws: Sequence[str | Path] = ()) -> Deck:
        """Makes a deck from TOML. name: takes the file's place in messages. folder: where its file names begin."""
        deck = cls(stages_in_python=stages_in_python, laws=laws)
        deck._text, deck._name, deck._folder, deck._is_own = text, name, str(folder), False
        deck._written()
        return deck

    def _set_tables(self, tables: Mapping[str, Any]) -> None:
        """Sets all of a deck that has no file."""
        plain: list[str] = []
        headed: list[tuple[str, list[Mapping[str, Any]], bool]] = []
        for name, value in tables.items():
            if isinstance(value, Specimen):
                self._take(value)
                headed.append((name, [{"shape": value.shape, "file": _CELLS}], False))
            elif isinstance(value, Mapping):
                headed.append((name, [value], False))
            elif is_list_of_tables(value):
                headed.append((name, list(value), True))
            else:
                plain.append(f"{_key(name)} = {toml(value)}")
        found: dict[str, functions.Function] = {}
        blocks = [table_text(_key(name), without_functions(table, name + (f"[{i}]" if is_listed else ""), found),
                             is_listed)
                  for name, entries, is_listed in headed for i, table in enumerate(entries)]
        self._text = "\n".join([*plain, "", *blocks])
        self._functions |= found

    @property
    def text(self) -> str:
        """The deck with all changes in place, as TOML; a function is the number that it has at 20 degC or 0 s."""
        return self._written()

    def _written(self) -> str:
        return _core.written(self._raw(self._placeholders(), with_files=False))

    def __getitem__(self, path: str) -> Any:
        """Returns the value at a path: a Quantity for a text that is one, a `DeckTable` for a table, a tuple for a
        list, a function as it was given.

        Raises KeyError where there is none.
        """
        if path in self._functions:
            return self._functions[path]
        return self._wrapped(path, self._node(path))

    def _node(self, path: str) -> Any:
        """Returns the value at a path as TOML has it. Raises KeyError where there is none."""
        node: Any = tomllib.loads(self.text)
        for part in _parts(path):
            try:
                node = node[part]
            except (KeyError, IndexError, TypeError):
                raise KeyError(path) from None
        return node

    def _wrapped(self, path: str, node: Any) -> Any:
        """Returns a value so that none of its changes is lost: each reaches the deck, or is refused."""
        if isinstance(node, dict):
            return DeckTable(self, path)
        if isinstance(node, list):
            return tuple(self._wrapped(f"{path}[{i}]", entry) for i, entry in enumerate(node))
        if isinstance(node, str) and (match := _QUANTITY.fullmatch(node)) and _core.is_quantity(node):
            return Quantity(float(match[1]), match[2])
        return node

    def __iter__(self) -> Iterator[str]:
        """Returns the keys and tables at the top of the deck, in its order: `dict(deck)` has each with its value."""
        return iter(tomllib.loads(self.text))

    def keys(self) -> list[str]:
        """Returns the keys and tables at the top of the deck, in its order."""
        return list(self)

    def __contains__(self, path: str) -> bool:
        try:
            self[path]
        except KeyError:
            return False
        return True

    def __setitem__(self, path: str, value: Value | Callable[[float], float] | functions.Function | Specimen) -> None:
        """Sets a value; a key or table that is missing is added. A specimen takes the place of all that the deck says
        of it but for the thickness and the matrix.

        Raises DeckError for a bare number where a unit is needed, and Error where the deck has no place for the key.
        """
        if isinstance(value, Specimen):
            self._set_specimen(path, value)
            return
        if callable(value) or isinstance(value, functions.Function):
            function = value if isinstance(value, functions.Function) else functions.Function(value)
            functions.value_at(path, function, functions.first(functions.axis_of(path)))
            self._functions[path] = function
            self._written()
            return
        if isinstance(value, Mapping) and path.count(".") < _DOTS_OF_A_KEY:
            for name, entry in value.items():
                self[f"{path}.{_key(name)}"] = entry
            return
        if is_list_of_tables(value):
            entries: Any = _plain(value)  # views of this deck would change while it is written anew
            self._rebuild(lambda tables: _list_at(tables, path).__setitem__(slice(None), entries), path)
            return
        with self._as_it_was_on_error():
            if re.search(rf"^\[{re.escape(path)}\]", self._text, re.MULTILINE):
                del self[path]  # a value takes the place of a table
            self._functions.pop(path, None)
            self._changes.append((path, toml(value)))
            self._written()
            if isinstance(value, (int, float)) and not isinstance(value, bool) and self._needed_unit(path):
                raise DeckError([d for d in self._diagnostics() if d.key == path])

    @contextlib.contextmanager
    def _as_it_was_on_error(self) -> Iterator[None]:
        """Takes back a change that fails."""
        before = (self._text, dict(self._functions), list(self._changes))
        try:
            yield
        except Exception:
            self._text, self._functions, self._changes = before
            raise

    def __delitem__(self, path: str) -> None:
        """Takes a key, a table, or one of a list of tables out. Raises KeyError where there is none.

        The deck is then written anew, without comments: places in messages are those of `text`.
        """
        self[path]
        *above, last = _parts(path)

        def take_out(tables: dict[str, Any]) -> None:
            node: Any = tables
            for part in above:
                node = node[part]
            del node[last]

        moved = {_renumbered(key, above, last): function for key, function in self._functions.items()
                 if key != path and not key.startswith((f"{path}.", f"{path}["))}
        self._rebuild(take_out, path)
        self._functions = moved

    def _set_specimen(self, path: str, specimen: Specimen) -> None:
        if path != "specimen":
            raise Error(f'{path}: a specimen belongs to "specimen"')

        def replace(tables: dict[str, Any]) -> None:
            is_plane = specimen.dimension == 2
            kept = {key: value for key, value in tables.get("specimen", {}).items() if is_plane and key == "thickness"}
            matrix = tables.get("superposition", {}).get("matrix")
            for name in _MADE_OTHERWISE:
                tables.pop(name, None)
            tables["specimen"] = {"shape": specimen.shape, "file": _CELLS, **kept}
            if matrix is not None:
                tables["superposition"] = {"matrix": matrix}

        self._rebuild(replace, path)
        self._take(specimen)

    def _take(self, specimen: Specimen) -> None:
        scratch = functions.Scratch()
        specimen.save(Path(scratch.folder) / _CELLS)
        self._specimen = (specimen, scratch)

    def _rebuild(self, change: Callable[[dict[str, Any]], object], path: str) -> None:
        """Writes the deck anew; functions at the path and below it are dropped."""
        kept = {key: function for key, function in self._functions.items() if not key.startswith(path)}
        tables = tomllib.loads(self.text)
        change(tables)
        self._changes, self._functions = [], {}
        self._set_tables(tables)
        self._functions |= kept

    def update(self, **tables: Any) -> Deck:
        """Sets keys of several tables: `deck.update(specimen={"seed": 2}, blocks={"count": 200})`. Lists of tables
        are appended. Returns the deck.
        """
        for name, value in tables.items():
            if isinstance(value, Specimen):
                self[name] = value
            elif is_list_of_tables(value):
                for entry in value:
                    self.append(name, **entry)
            elif isinstance(value, Mapping):
                for key, entry in value.items():
                    self[f"{name}.{_key(key)}"] = entry
            else:
                self[name] = value
        return self

    def append(self, table: str, /, **keys: Any) -> Deck:
        """Appends a table to a list of tables: `deck.append("stages", kind="settle", ...)`, or to one in another:
        `deck.append("stages[1].drives", set="left", hold=["x"])`. Returns the deck.
        """
        keys = _plain(keys)
        number = len(self[table]) if table in self else 0
        if "[" in table:
            self._rebuild(lambda tables: _list_at(tables, table).append(keys), f"{table}[{number}]")
            return self
        found: dict[str, functions.Function] = {}
        plain = without_functions(keys, f"{table}[{number}]", found)
        with self._as_it_was_on_error():
            self._text += "\n" + table_text(table, plain, True)
            self._functions |= found
            self._written()
        return self

    def copy(self) -> Deck:
        """Returns another deck with the same contents."""
        other = Deck(stages_in_python=self._stages, laws=self._laws)
        other._text, other._name, other._folder = self._text, self._name, self._folder
        other._changes, other._functions = list(self._changes), dict(self._functions)
        other._specimen, other._is_own = self._specimen, self._is_own
        return other

    def check(self) -> list[Diagnostic]:
        """Reads all of the deck. Returns what it warns of; raises DeckError with every error."""
        tables = functions.Scratch()
        return _core.check(self._resolved(tables))

    def make_specimen(self, seed: int | None = None) -> Specimen:
        """Makes the specimen that a run of this deck has, with this seed or the deck's. Raises as `Run`."""
        tables = functions.Scratch()
        return Specimen(_core.Specimen.of_deck(self._resolved(tables), seed))

    def save(self, file: str | Path) -> None:
        """Writes the deck, and beside it tables of its functions and the blocks of its specimen, as files whose names
        begin with that of the deck: "wall.toml" has "wall_cells.json". Files that it names keep their names.
        """
        folder, owner = Path(file).resolve().parent, f"{Path(file).name.removesuffix('.toml')}_"
        named = [(path, f"{{ csv = {toml(table.name)} }}") for path, table in self._tables(folder, owner)]
        if self._specimen:
            self._specimen[0].save(folder / f"{owner}{_CELLS}")
            named.append(("specimen.file", toml(f"{owner}{_CELLS}")))
        Path(file).write_text(_core.written(self._raw(named, with_files=False)), encoding="utf-8")

    def _raw(self, more: Sequence[tuple[str, str]] = (), with_files: bool = True) -> _core.DeckText:
        files = [("specimen.file", toml(str(Path(self._specimen[1].folder) / _CELLS)))] if (
            with_files and self._specimen) else []
        changes = [f"{path}={value}" for path, value in (*self._changes, *files, *more)]
        return _core.DeckText(self._text, self._name, self._folder, changes, self._laws, self._stages,
                              self._is_own, True)

    def _diagnostics(self) -> list[Diagnostic]:
        try:
            _core.check(self._raw(self._placeholders()))
        except DeckError as error:
            return error.diagnostics
        return []

    def _needed_unit(self, path: str, value: float | None = None) -> str:
        more = self._placeholders(skip=path) if value is None else [*self._placeholders(skip=path), (path, repr(value))]
        return _core.needed_unit(self._raw(more), path)

    def _placeholders(self, skip: str = "") -> list[tuple[str, str]]:
        """Returns numbers in place of the functions."""
        numbers = []
        for path, function in self._functions.items():
            if path == skip:
                continue
            number = functions.value_at(path, function, functions.first(functions.axis_of(path)))
            unit = function.unit or _core.needed_unit(self._raw([(path, repr(number))]), path)
            numbers.append((path, toml(f"{number!r} {unit}") if unit else repr(number)))
        return numbers

    def _resolved(self, place: functions.Scratch) -> _core.DeckText:
        """Returns the deck with tables, written into a folder, in place of functions; blocks in a file there too."""
        tables = [(path, _csv(table)) for path, table in self._tables(Path(place.folder))]
        if self._specimen:
            self._specimen[0].save(Path(place.folder) / _CELLS)
            tables.append(("specimen.file", toml(str(Path(place.folder) / _CELLS))))
        return self._raw(tables, with_files=False)

    def _tables(self, folder: Path, owner: str = "") -> list[tuple[str, Path]]:
        """Writes the tables of the functions; their names begin with `owner`."""
        tables: list[tuple[str, Path]] = []
        for axis in (functions.TIME, functions.TEMPERATURE):  # the times say how hot the run becomes
            stand_in = [change for change in self._placeholders() if change[0] not in dict(tables)]
            for path, function in self._functions.items():
                if functions.axis_of(path) is not axis:
                    continue
                interval = function.interval or self._interval(path, [*stand_in, *((p, _csv(t)) for p, t in tables)])
                points = functions.tabulate(path, function, *interval)
                unit = function.unit or self._needed_unit(path, points[0][1])
                tables.append((path, functions.write_table(folder, path, unit, points, owner)))
        return tables

    def _interval(self, path: str, stand_in: Sequence[tuple[str, str]]) -> tuple[float, float]:
        """Returns all that a function is asked for."""
        if functions.is_of_drive(path):
            return 0.0, in_si(self[path.split(".")[0] + ".duration"], "s")
        low, high, begin, end = _core.ranges(self._raw(stand_in))
        return (begin, end) if functions.axis_of(path) is functions.TIME else (low, high)

    def __repr__(self) -> str:
        return f"<Deck {self._name}>"


class DeckTable(MutableMapping[str, Any]):
    """A table of a deck: `deck["specimen"]["seed"] = 2` and `deck["specimen"].update(seed=2)` change the deck.

    It holds no values of its own: each is read from the deck, and KeyError is raised once the deck has no such table.
    """

    def __init__(self, deck: Deck, path: str):
        self._deck, self._path = deck, path

    def __getitem__(self, key: str) -> Any:
        return self._deck[f"{self._path}.{key}"]

    def __setitem__(self, key: str, value: Any) -> None:
        self._deck[f"{self._path}.{_key(key)}"] = value

    def __delitem__(self, key: str) -> None:
        del self._deck[f"{self._path}.{key}"]

    def __iter__(self) -> Iterator[str]:
        return iter(self._deck._node(self._path))

    def __len__(self) -> int:
        return len(self._deck._node(self._path))

    def __repr__(self) -> str:
        return f"<DeckTable {self._path}: {self._deck._node(self._path)}>"

    def __or__(self, other: Mapping[str, Any]) -> dict[str, Any]:
        """Returns a table of its own, which changes nothing in the deck."""
        return {**self, **other}

    def __ror__(self, other: Mapping[str, Any]) -> dict[str, Any]:
        return {**other, **self}

    def __ior__(self, other: Mapping[str, Any]) -> DeckTable:
        self.update(other)
        return self


def without_functions(table: Mapping[str, Any], path: str, found: dict[str, functions.Function]) -> dict[str, Any]:
    """Takes the functions out of a table, into `found` by their paths; returns the rest."""
    plain: dict[str, Any] = {}
    for name, value in table.items():
        here = f"{path}.{name}" if path else name
        if isinstance(value, functions.Function) or callable(value):
            found[here] = value if isinstance(value, functions.Function) else functions.Function(value)
        elif isinstance(value, Mapping):
            plain[name] = without_functions(value, here, found)
        elif is_list_of_tables(value):
            plain[name] = [without_functions(entry, f"{here}[{i}]", found) for i, entry in enumerate(value)]
        else:
            plain[name] = value
    return plain


def _csv(table: Path) -> str:
    return f"{{ csv = {toml(str(table.resolve()))} }}"


def _read(file: str | Path) -> str:
    return _core.read(str(file))


def as_deck(deck: Deck | str | Path) -> Deck:
    """Returns a deck, or that of a file."""
    return deck if isinstance(deck, Deck) else Deck(deck)
