"""What a point's runs are made from, and by what they are known."""

from __future__ import annotations

import functools
import hashlib
import json
import re
import string
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

from .. import _core
from ..errors import CodeNotAllowed, DeckError, Diagnostic, Error
from ..live.decks import toml
from .code import StudyCode, code_of, words_of
from .file import StudySetup
from .outputs import Offer, Output
from .parameters import Parameter, Value, numbered
from .start import FOLDER

_ID_LENGTH = 16  # hexadecimal digits: two of a million points are the same by chance once in 10^7 studies
_LONGEST_NUMBER = 3  # digits: of the width, or the precision, of a field in a command
_NO_RESULT = ("fields", "checkpoint", "keep_stage_checkpoints")  # keys of [output] that change none


class Point:
    """A value for each parameter, in their order, and the runs that it asks for."""

    def __init__(self, values: tuple[Value, ...], hashes: Sequence[Callable[[int], str]], infeasible: str = ""):
        """Takes the deck of a point. hashes: identity of the run with a seed, and that by an earlier physics version
        which counts too.
        """
        self.values = values
        self.infeasible = infeasible  #: why it cannot be run; empty if it can
        self._hashes = hashes

    @functools.cache  # noqa: B019 - a point lives as long as its study
    def ids(self, seed: int) -> tuple[str, ...]:
        """Returns the identities of the run with a seed: the first is that of this program."""
        return tuple(hashed(seed) for hashed in self._hashes)


class Points:
    """Makes the points of a study. Those whose deck is refused are infeasible."""

    def __init__(self, study: StudySetup, code: StudyCode | None = None):
        """Takes the points of a study. code: of the study, where it is known already. Raises Error where a file of the
        code cannot be read.
        """
        self._study = study
        self.code = code or code_of(study)
        self._made: dict[tuple[Value, ...], Point] = {}

    def at(self, values: Sequence[Value]) -> Point:
        """Returns the point of these values, made once."""
        key = tuple(values)
        if key not in self._made:
            self._made[key] = self._make(key)
        return self._made[key]

    def _make(self, values: tuple[Value, ...]) -> Point:
        runner = self._study.runner
        if runner.kind != "pyroclast":
            named = dict(zip((p.name for p in self._study.parameters), values))
            return Point(values, [lambda seed: _hash([self.code.hash, named, seed])])
        try:
            text, files, _ = self.resolve(values)
        except CodeNotAllowed:
            raise
        except Error as error:
            return Point(values, [], str(error))
        tables = tomllib.loads(text)
        versions = [v for v in (_core.physics_version, self._study.accept_version) if v is not None]
        return Point(values, [functools.partial(run_id, tables, files, version=v) for v in versions])

    def resolve(self, values: Sequence[Value]) -> tuple[str, dict[str, str], list[Diagnostic]]:
        """Resolves the deck of a point; returns it, hashes of its files, and warnings. Raises Error or DeckError."""
        return _core.resolve(self._deck_text(values))

    def text(self, values: Sequence[Value]) -> str:
        """Returns the deck of a point."""
        return _core.written(self._deck_text(values))

    def _deck_text(self, values: Sequence[Value]) -> _core.DeckText:
        changes = [f"{path}={value}" for path, value in self.changes(values)]
        deck = self._study.runner.deck
        return _core.DeckText(self._text, str(deck), str(deck.parent), changes, [], [], False, False)

    def changes(self, values: Sequence[Value]) -> list[tuple[str, str]]:
        """Returns keys of the deck and what a point writes there, as `--set` takes them."""
        own = (self._changes_of(p, value) for p, value in zip(self._study.parameters, values))
        return [*self._common, *(change for changes in own for change in changes)]

    def _changes_of(self, parameter: Parameter, value: Value) -> list[tuple[str, str]]:
        keys = tuple((numbered(path, self._tables), factor) for path, factor in parameter.keys)
        return replace(parameter, keys=keys).changes(value, self._tables) if keys else []

    def command(self, program: str, values: Sequence[Value], seed: int, folder: Path | None = None) -> list[str]:
        """Returns the command line of a run; a folder where its results go."""
        runner = self._study.runner
        if runner.kind == "function":
            return [f"{runner.file}:{runner.function}"]
        if runner.kind == "command":
            fields: dict[str, Any] = {p.name: _plain(v, p) for p, v in zip(self._study.parameters, values)}
            fields |= {"seed": seed, "folder": str(folder or FOLDER)}
            try:
                # Words first: what is put into one stays in it, whatever it holds.
                return [_filled(word, fields) for word in words_of(runner.command)]
            except (Error, KeyError, ValueError) as error:
                named = f"{{{error.args[0]}}} is no parameter" if isinstance(error, KeyError) else str(error)
                raise Error(f"{self._study.place('study.command')}: {named}") from error
        words = [program, "run", str(runner.deck), "--of-study"]
        for path, value in self.changes(values):
            words += ["--set", f"{path}={value}"]
        seeded = ["--seed", str(seed)] if self.has_seed else []
        return [*words, *seeded] + (["--out", str(folder)] if folder else [])

    @property
    def has_seed(self) -> bool:
        """Whether runs with other seeds are other runs: not where the blocks of a deck come from a file of cells."""
        if self._study.runner.kind != "pyroclast":
            return True
        specimen = self._tables.get("specimen", {})
        return not (isinstance(specimen, Mapping) and specimen.get("shape") in ("cells", "polyhedra"))

    @cached_property
    def _text(self) -> str:
        return _core.read(str(self._study.runner.deck))

    @cached_property
    def _common(self) -> list[tuple[str, str]]:
        deck = tomllib.loads(self._text)
        try:
            return [(numbered(path, deck), toml(value)) for path, value in self._study.runner.changes]
        except Error as error:
            raise Error(f"{self._study.place('study.changes')}: {error}") from error

    @cached_property
    def _tables(self) -> Mapping[str, Any]:
        """The deck as it stands, with the changes that all points have."""
        changes = [f"{path}={value}" for path, value in self._common]
        return tomllib.loads(_core.written(_core.DeckText(self._text, str(self._study.runner.deck), "", changes, [], [], False, False)))

    @property
    def middle(self) -> list[Value]:
        """Middle of all ranges."""
        return [p.distribution.at(0.5) for p in self._study.parameters]

    def check_ends(self) -> list[str]:
        """Returns what is wrong at the middle and at the ends of each parameter's range; empty where all can be run."""
        middle = self.middle
        if self._study.runner.kind == "pyroclast":
            try:
                self._tables
            except Error as error:
                return [str(error)]
        wrong = self._wrong_keys(middle)
        if wrong or self._study.runner.kind != "pyroclast":
            return wrong
        said: dict[str, str] = {}  # by what is wrong, once: an unknown key is so at both ends
        for place, values in self._ends(middle):
            try:
                self.resolve(values)
            except CodeNotAllowed:
                raise
            except DeckError as error:
                for d in error.diagnostics:
                    said.setdefault(f"{d.key}: {d.message}", f"{place}{d}")
            except Error as error:
                said.setdefault(str(error), f"{place}{error}")
        return list(said.values())

    def warnings(self) -> list[Diagnostic]:
        """Returns what the check of the deck in the middle of all ranges warns of."""
        if self._study.runner.kind != "pyroclast":
            return []
        return self.resolve(self.middle)[2]

    def seconds_of_run(self, seed: int) -> float:
        """Returns the wall time of a run of the middle of all ranges, s, by its first steps. Of decks."""
        return _core.seconds_of_run(self._deck_text(self.middle), seed if self.has_seed else None)

    def check_outputs(self, outputs: Iterable[Output]) -> list[str]:
        """Returns which of these no run has, by a run of the middle that is not begun. Of decks, not of functions."""
        outputs = [o for o in outputs if not o.is_function]
        if not outputs or self._study.runner.kind != "pyroclast":
            return []
        run = _core.Session.begin(self._deck_text(self.middle), None, 1, "", None, None, False, "")
        offer = Offer(run.summary_numbers(), [name for name, _ in run.columns])
        run.close()
        return [f"{self._study.place(f'outputs.{o.name}')}: {o.name} = {o.what!r}: {why}" for o in outputs
                if (why := offer.lacks(o))]

    def _wrong_keys(self, middle: Sequence[Value]) -> list[str]:
        """Returns errors of parameters whose keys, or whose place in the command, do not exist."""
        wrong = []
        if self._study.runner.kind == "command":
            try:
                self.command("", middle, 1)
            except Error as error:
                wrong.append(str(error))
            for parameter in self._study.parameters:
                if any("\0" in str(end) for end in parameter.distribution.ends()):
                    place = self._study.place(f"parameters.{parameter.name}")
                    wrong.append(f"{place}: no word of a command can hold the character NUL, \\u0000")
            unnamed = [p.name for p in self._study.parameters if f"{{{p.name}" not in self._study.runner.command]
            wrong += [f"{self._study.place(f'parameters.{name}')}: the command has no {{{name}}}" for name in unnamed]
        for parameter, value in zip(self._study.parameters, middle):
            try:
                self._changes_of(parameter, value)
            except Error as error:
                wrong.append(f"{self._study.place(f'parameters.{parameter.name}')}: {error}")
        return wrong

    def _ends(self, middle: Sequence[Value]) -> Iterator[tuple[str, list[Value]]]:
        for i, parameter in enumerate(self._study.parameters):
            for end in parameter.distribution.ends():
                unit = f" {parameter.unit}" if parameter.unit else ""
                yield (f"{self._study.place(f'parameters.{parameter.name}')}: {parameter.name} = {end}{unit}: ",
                       [*middle[:i], end, *middle[i + 1:]])
        yield f"{self._study.place('study')}: in the middle of all ranges: ", list(middle)


def run_id(tables: Mapping[str, Any], files: Mapping[str, str], seed: int, version: int) -> str:
    """Returns the identity of a run: the hash of its deck with all that it names, its seed and the physics version."""
    specimen = {**tables.get("specimen", {}), "seed": seed}
    output = {key: value for key, value in tables.get("output", {}).items() if key not in _NO_RESULT}
    deck = {key: value for key, value in tables.items() if key != "title"}
    return _hash([{**deck, "specimen": specimen, "output": output}, files, version])


def _hash(what: Any) -> str:
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()[:_ID_LENGTH]


def _filled(word: str, fields: Mapping[str, Any]) -> str:
    """Returns a word of a command with fields in the place of `{name}` or `{name:format}`.

    Raises Error for other fields, and for formats that may ask for all memory; and what str.format raises.
    """
    for _, name, form, _ in string.Formatter().parse(word):
        if name is None:
            continue
        if not name.isidentifier():
            raise Error(f"{{{name:.40}}}: a field is the name of a parameter, seed or folder")
        if "{" in (form or "") or any(len(number) > _LONGEST_NUMBER for number in re.findall(r"\d+", form or "")):
            raise Error(f"{{{name:.40}:{form:.40}}}: the width in a format is a number of at most {_LONGEST_NUMBER} "
                        "digits")
    return word.format(**fields)


def _plain(value: Value, parameter: Parameter) -> str:
    return f"{value!r}" if isinstance(value, float) else str(value)
