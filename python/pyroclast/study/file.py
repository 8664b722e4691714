"""A study file: what is varied, what is taken of each run, and by which method."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from .. import _core
from ..errors import Error
from .outputs import QUANTITY, Output, number_in, with_plain_numbers
from .parameters import Distribution, Parameter, Value

FIRST_SEED = 1
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_UNTIL = re.compile(r"\s*widest interval\s*<\s*([0-9.eE+-]+)\s*(%?)\s*")
_DISTRIBUTIONS = ("uniform", "log_uniform", "normal", "integer", "choice")


@dataclass(frozen=True)
class Target:
    """What an output should be, and how well the experiment knows it. by: parameter that a secant meets it by."""

    output: str
    value: float
    sd: float
    by: str = ""


@dataclass(frozen=True)
class Runner:
    """Model that gives the numbers of a point.

    kind: "pyroclast" runs a deck, "command" runs a command line that leaves summary.json in {folder}, "function" calls
        a function of a Python file with the parameters and `seed` by name; it returns the outputs by name.
    """

    kind: str
    deck: Path = Path()
    changes: tuple[tuple[str, Any], ...] = ()
    command: str = ""
    file: Path = Path()
    function: str = ""


PLAIN_OPTIONS = ("partition", "account", "qos", "mem", "mem-per-cpu", "constraint", "gres", "nodelist", "exclude",
                 "reservation", "cpus-per-task", "mail-type", "mail-user")
"""Options of sbatch that run nothing. sbatch takes shortened names too; here a name counts only as a whole."""

_OF_STUDY = ("array", "job-name", "time", "signal", "output", "dependency", "requeue", "no-requeue", "open-mode")
_SHORT = {"a": "array", "J": "job-name", "t": "time", "o": "output", "d": "dependency"}
_OPTION = re.compile(r"--([a-z][a-z-]*)(?:=(.*))?", re.DOTALL)


def _check_option(option: str) -> None:
    if any(ord(c) < 32 or ord(c) == 127 for c in option):
        raise Error(f"option {option!r} has a line break or another control character")
    short = _SHORT.get(option[1:2]) if option.startswith("-") and not option.startswith("--") else None
    found = _OPTION.fullmatch(option)
    name = short or (found[1] if found else "")
    own = [whole for whole in _OF_STUDY if name and whole.startswith(name)]
    if name not in PLAIN_OPTIONS and own:
        raise Error(f"option {option!r}: the study says --{name if name in own else own[0]} itself")
    if found and found[1] in PLAIN_OPTIONS and (not found[2] or found[2].startswith("-")):
        raise Error(f"option {option!r}: is written as \"--{found[1]}=VALUE\", and VALUE begins with no -")


def _is_plain(option: str) -> bool:
    found = _OPTION.fullmatch(option)
    return found is not None and found[1] in PLAIN_OPTIONS and bool(found[2])


@dataclass(frozen=True)
class SlurmSettings:
    """How jobs of a study are asked for.

    slots: tasks at a time. time: of a task, s. points_per_task: runs that a task makes one after the other; 0: so many
    that it lasts some ten minutes. options: further ones of sbatch.

    Raises Error for an option that the study sets itself, and for one with a value that cannot be meant.
    """

    slots: int = 16
    time: float = 3600.0
    points_per_task: int = 0
    options: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for option in self.options:
            _check_option(option)

    @property
    def unusual(self) -> tuple[str, ...]:
        """Options that may run a program, or change what runs, so that the user has to allow them."""
        return tuple(option for option in self.options if not _is_plain(option))


@dataclass(frozen=True)
class Method:
    """Method that chooses the points and evaluates the runs. settings: keys of [method] but kind and until."""

    kind: str
    settings: Mapping[str, Any] = field(default_factory=dict)
    until: float | None = None  #: widest interval, as a share of the value


@dataclass(frozen=True)
class StudySetup:
    """All that a study file says."""

    file: Path
    title: str
    folder: Path
    runner: Runner
    method: Method
    seeds: tuple[int, ...]
    parameters: tuple[Parameter, ...]
    outputs: tuple[Output, ...]
    targets: tuple[Target, ...] = ()
    correlations: tuple[tuple[str, str, float], ...] = ()
    may_lack: tuple[str, ...] = ()  #: outputs by name without which a run counts as done
    keep: str = "summary"
    wall_limit: float = math.inf  #: of a run, s
    accept_version: int | None = None
    earlier: tuple[Path, ...] = ()
    slurm: SlurmSettings = SlurmSettings()
    ranks: int = 1  #: processes that share the body of a run

    def place(self, key: str) -> str:
        """Returns where a table or key of the study file stands, as "file:line"."""
        table, _, last = key.rpartition(".")
        node = _core.TomlFile(str(self.file)).root()
        for part in filter(None, table.split(".")):
            node = node.table(part, "")
        return node.where(last)


def read_setup(file: str | Path, functions: Sequence[str] = ()) -> StudySetup:
    """Reads a study file. Raises DeckError with everything that is wrong with it.

    functions: names of further outputs, which a script takes of each run.
    """
    toml = _core.TomlFile(str(file))
    study = _read(toml, Path(file), functions)
    toml.finish()
    return study


def reference() -> str:
    """Returns every table and key that a study file may hold, as Markdown."""
    return _core.reference_of(lambda toml: _read(toml, Path("study.toml")))


def schema() -> str:
    """Returns the JSON Schema (draft 4) of study files, for editors."""
    return _core.schema_of(lambda toml: _read(toml, Path("study.toml")), "Study file of Pyroclast")


def _read(toml: _core.TomlFile, file: Path, functions: Sequence[str] = ()) -> StudySetup:
    root = toml.root()
    title = root.text("title", "Heading of figures and of the report; without one the file's name.", file.stem)
    own = root.table("study", "Deck, number of runs, and the parts of a run that are kept.")
    runner = _runner(own, file.parent)
    ranks = own.integer("ranks", "Processes that share the body of each run, each with one thread; see [Studies]"
                        "(../do/studies.md#runs-on-several-ranks).", 1, None, 1)
    if ranks > 1 and runner.kind != "pyroclast":
        own.error("ranks", f'has no meaning with runner = "{runner.kind}"')
    count = own.integer("seeds", "Realisations of the specimen that each point is run with; the same for all points. "
                        "Results of a point are means over them.", 1, 10000, 1)
    first = own.integer("first_seed", "The first of them; the others follow.", 0, None, FIRST_SEED)
    keep = own.choice("keep", [("summary", "summary, manifest and deck"), ("history", "and the history"),
                               ("all", "all that a run writes")], True,
                              "Parts of a run that stay once its outputs are taken.")
    wall_limit = own.quantity("wall_limit", "s", "Wall time after which a run is stopped and counts as timed out; "
                              "that of attempts that were killed counts.", 0.0, None, 86400.0)
    accepted = own.integer("accept_version", "Physics version of earlier runs that count beside the program's own; a "
                           "column of the table tells them apart.", 0, None, 0) if own.has("accept_version") else None
    folder = own.text("folder", "Where runs and results go, taken from the place of this file; without it "
                      "STUDY-study beside STUDY.toml.", f"{file.stem}-study")
    may_lack = own.texts("may_lack", "Outputs, by name, without which a run counts as done if it has another one.",
                         is_optional=True)
    earlier = own.texts("earlier", "Tables of earlier studies (table.csv), whose runs are taken in as they are.",
                        is_optional=True)

    method = _method(root.table("method", "Method that chooses the points and evaluates the runs."))
    outputs = [Output.of_function(name) for name in functions]
    outputs += _outputs(root, not outputs, "Numbers that are taken of each run, by names of your own: a number of the "
                                  "summary by its name (`\"f_c_MPa\"`), or `\"history: COLUMN at COLUMN = NUMBER\"`; see "
                        "[Outputs](../do/studies.md#outputs).")
    parameters = []
    tables = root.optional_table("parameters", "Varied parameters.")
    if tables is not None:
        named = sorted(tables.named_tables("NAME", "A parameter."), key=lambda entry: _line(entry[1]))
        parameters = [_parameter(name, table, runner.kind) for name, table in named]
    targets = _targets(root, method.kind, outputs)
    correlations = _correlations(root, [p.name for p in parameters], method.kind)
    slurm = _slurm(root)
    for name in sorted(set(may_lack) - {o.name for o in outputs}):
        own.error("may_lack", f"no output is called {name!r}; there are {', '.join(o.name for o in outputs)}")
    _check_together(root, own, method, parameters, outputs, targets)
    return StudySetup(file, title, (file.parent / folder), runner, method, tuple(range(first, first + count)),
                      tuple(parameters), tuple(outputs), tuple(targets), tuple(correlations), tuple(may_lack), keep,
                      wall_limit or math.inf, accepted, tuple(file.parent / e for e in earlier), slurm,
                      ranks)


def _runner(own: _core.Table, folder: Path) -> Runner:
    kind = own.choice("runner", [
        ("pyroclast", "`pyroclast run` of a deck"),
        ("command", "a command line of your own; it leaves summary.json in {folder}"),
        ("function", "a function of a Python file"),
    ], True, "Model that gives the numbers of a point.")
    if kind == "command":
        return Runner(kind, command=own.text("command", "With {NAME} for each parameter, {seed} and {folder}."))
    if kind == "function":
        place = own.text("function", "FILE.py:NAME; it is called with the parameters and `seed` by name, and returns "
                         "the outputs by name.")
        path, colon, name = place.rpartition(":")
        if own.ok() and not (colon and path.endswith(".py") and name.isidentifier()):
            own.error("function", 'is written as FILE.py:NAME, such as "model.py:strength"')
        return Runner(kind, file=folder / path, function=name)
    deck = folder / own.text("deck", "Deck that every run is made from, taken from the place of this file.")
    changes: list[tuple[str, Any]] = []
    if own.has("changes"):
        found = json.loads(own.json("changes", "table of keys of the deck", "Changes of the deck that all runs have, as "
                                    "`--set` makes them: `{ \"blocks.count\" = 1500 }`."))
        if isinstance(found, dict):
            changes = [(path, value) for path, value in found.items()]
        elif found is not None:
            own.error("changes", 'must be a table of keys, such as { "blocks.count" = 1500 }')
    return Runner(kind, deck=deck, changes=tuple(changes))


_TO_TARGETS = ("calibrate", "secant", "posterior")

_METHODS = [
    ("ensemble", "one point with many seeds: how much the specimen scatters"),
    ("grid", "all combinations of the levels of parameters"),
    ("lhs", "Latin hypercube: response curves, rank correlations"),
    ("morris", "elementary effects: which of many parameters matter"),
    ("sobol", "shares of the variance, directly from runs"),
    ("chaos", "shares of the variance by a polynomial chaos surrogate with its own error"),
    ("calibrate", "parameters that meet targets, by CMA-ES"),
    ("secant", "a parameter for each target, changed until it is met: some four rounds"),
    ("posterior", "distribution of parameters that the targets allow, by MCMC on a surrogate"),
]


def _method(table: _core.Table) -> Method:
    kind = table.choice("kind", _METHODS, False, "")
    settings: dict[str, Any] = {}

    def integer(key: str, meaning: str, least: int, fallback: int) -> None:
        settings[key] = table.integer(key, meaning, least, None, fallback)

    if kind not in ("ensemble", "grid", "secant"):
        integer("seed", "Of the method's own draws; not that of specimens.", 0, 1)
    if kind == "lhs":
        integer("samples", "Points.", 2, 100)
    elif kind == "morris":
        integer("trajectories", "Each has a point more than there are parameters.", 2, 10)
        integer("levels", "Of each parameter, an even number.", 4, 4)
        if settings["levels"] % 2:
            table.error("levels", "must be even")
    elif kind == "sobol":
        integer("samples", "Rows; each has two points more than there are parameters. A power of 2 fills best.", 8, 128)
    elif kind in ("chaos", "posterior"):
        integer("samples", "Points that the surrogate is fitted to.", 10, 200)
        integer("held", "Further points for a trial of the surrogate. Points without a value are replaced, up to as "
                        "many again.", 30, 30)
    elif kind == "calibrate":
        integer("population", "Points of a generation; 0: 4 + 3 ln of the number of parameters.", 0, 0)
        integer("generations", "At most.", 1, 50)
        settings["least_step"] = table.number("least_step", "Ends when no parameter's step is longer than this share of "
                                              "its range ...", 0.0, 1.0, 0.01)
        settings["least_gain"] = table.number("least_gain", "... or when the best misfit, in squares of standard "
                                              "deviations, gains no more than this ...", 0.0, None, 0.1)
        integer("patience", "... in as many generations.", 1, 8)
    elif kind == "secant":
        integer("rounds", "At most; each is one point with all seeds.", 1, 10)
    if kind == "posterior":
        integer("steps", "Of each walker of the ensemble sampler, at most; it ends when it has converged.", 100, 50000)
        integer("checks", "Draws of the posterior that are run to check the surrogate.", 0, 5)
    if kind == "sobol":
        settings["allow_missing"] = table.flag("allow_missing", "Give indices even when more than 5 % of the rows are "
                                               "lost by runs without a value.", False)
    until = None
    if kind in ("ensemble", "morris", "sobol"):
        text = table.text("until", "`\"widest interval < 0.05\"`: twice as many samples until the widest 95 % interval is "
                          "narrower: of means as a share of the mean, of Morris' effects as a share of the largest, "
                          "of indices as it is.", "")
        settings["most"] = table.integer("most", "Seeds, trajectories or samples up to which `until` goes.", 1, None, 1000)
        if text:
            found = _UNTIL.fullmatch(text)
            until = float(found[1]) / (100.0 if found[2] else 1.0) if found else None
            if not found:
                table.error("until", 'is written as "widest interval < 0.05"')
    return Method(kind, settings, until)


def _outputs(root: _core.Table, is_needed: bool, meaning: str) -> list[Output]:
    outputs: list[Output] = []
    found = root.table("outputs", meaning) if is_needed else root.optional_table("outputs", meaning)
    if found is None:
        return outputs
    table: _core.Table = found
    for name in sorted(table.keys(), key=lambda key: _line(table, key)):
        what = json.loads(table.json(name, "text", ""))
        if not _NAME.fullmatch(name):
            table.error(name, "names of outputs have letters, digits and _ only")
        elif not isinstance(what, str) or not what.strip():
            table.error(name, 'must be a text that says where the number stands, such as "f_c_MPa"')
        else:
            try:
                outputs.append(Output(name, with_plain_numbers(what)))
            except Error as error:
                table.error(name, str(error))
    if is_needed and table.ok() and not outputs:
        table.error("", "a study takes one number of each run at least")
    return outputs


def _parameter(name: str, table: _core.Table, runner: str) -> Parameter:
    keys: list[tuple[str, float]] = []
    how = "value"
    if not _NAME.fullmatch(name) and name != "NAME":
        table.error("", "names of parameters have letters, digits and _ only")
    if runner == "pyroclast":
        keys = _keys(table)
        how = table.choice("vary", [("value", "the value itself; of a curve its `value`"),
                                    ("scale", "a factor of the deck's value, of curves too"),
                                    ("shift", "a shift of a curve over temperature, in K")], True,
                           "Varied part of the key's value.")
    elif table.has("key") or table.has("keys"):
        table.error("key" if table.has("key") else "keys", f'has no meaning with runner = "{runner}"')
    given = [kind for kind in _DISTRIBUTIONS if table.has(kind)]
    distribution, unit = Distribution("uniform", (0.0, 1.0)), ""
    forms: dict[str, tuple[str, str, Callable[[Any], tuple[Distribution, str]]]] = {
        "uniform": ("list of two quantities", "Least and largest value.", _between("uniform")),
        "log_uniform": ("list of two quantities", "The same, the logarithm evenly; both above 0.", _between("log_uniform")),
        "normal": ("table", "`{ mean = ..., sd = ... }`, with `between = [...]` where it is cut off.", _normal),
        "integer": ("list of two whole numbers", "Least and largest value, both drawn.", _integers),
        "choice": ("list", "Values, each as often as the others.", _choice),
    }
    for kind, (what, meaning, read) in forms.items():
        if table.has(kind):
            value = json.loads(table.json(kind, what, meaning))
            try:
                distribution, unit = read(value)
            except (Error, TypeError, ValueError, KeyError, IndexError) as error:
                table.error(kind, str(error) if isinstance(error, Error) else f"{what} is needed")
    if not given and table.ok():
        table.error("", f"needs one of {', '.join(_DISTRIBUTIONS)}")
    for other in given[1:]:
        table.error(other, f'has no meaning beside "{given[0]}"')
    if how == "shift" and table.ok() and _core.convert(f"1 {unit}", "K") != 1.0:
        table.error(given[0], 'a shift is in K, such as ["-20 K", "20 K"]')
    if how == "scale" and unit:
        table.error(given[0], "a scale is a plain number, such as [0.8, 1.2]")
    levels = table.integer("levels", "Values in a grid, from the least to the largest.", 1, None, 5)
    return Parameter(name, distribution, tuple(keys), how, unit, distribution.count or levels)


def _keys(table: _core.Table) -> list[tuple[str, float]]:
    if table.has("keys"):
        if table.has("key"):
            table.error("keys", 'has no meaning beside "key"')
        found = json.loads(table.json("keys", "table of keys of the deck and factors", "Several keys that get the value "
                                      "times a factor: `{ \"contacts.mortar_mortar.c_o\" = 1.5, ... }`."))
        if not isinstance(found, dict) or not found or not all(_is_number(v) for v in found.values()):
            table.error("keys", 'must be a table of keys with factors, such as { "contacts.mortar_mortar.f_t" = 1 }')
            return []
        return [(path, float(factor)) for path, factor in found.items()]
    return [(table.text("key", "Of the deck, by its path, as in `--set`; stages by name too: "
                        "`\"stages[heating].to\"`."), 1.0)]


def _line(table: _core.Table, key: str = "") -> int:
    """Returns where a key or table stands: what is named stays in the order of the file."""
    return int(table.where(key).rpartition(":")[2])


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _quantities(values: list[Any]) -> tuple[list[float], str]:
    """Returns numbers in the unit of the first."""
    numbers: list[float] = []
    unit = ""
    for i, value in enumerate(values):
        found = QUANTITY.fullmatch(value) if isinstance(value, str) else None
        if found is None and not _is_number(value):
            raise Error(f"{value!r} is no number with or without a unit")
        own = (found[2] or "") if found else ""
        number = float(found[1] if found else value)
        if not math.isfinite(number):
            raise Error(f"{value!r} is not finite")
        if i == 0:
            unit = own
        elif own != unit:
            if not own or not unit:
                raise Error(f"{values[0]!r} and {value!r} are not of one kind: one has no unit")
            number = _core.convert(value, unit)
        numbers.append(number)
    return numbers, unit


def _between(kind: str) -> Callable[[Any], tuple[Distribution, str]]:
    def read(value: Any) -> tuple[Distribution, str]:
        (low, high), unit = _quantities([*value] if isinstance(value, list) else [])
        if not low < high:
            raise Error(f"the range is empty: {value[0]!r} is not below {value[1]!r}")
        if kind == "log_uniform" and low <= 0.0:
            raise Error("both ends must be above 0")
        return Distribution(kind, (low, high)), unit

    return read


def _normal(value: Any) -> tuple[Distribution, str]:
    if not isinstance(value, dict) or not {"mean", "sd"} <= set(value) <= {"mean", "sd", "between"}:
        raise Error("is written as { mean = ..., sd = ..., between = [..., ...] }, the last if it is cut off")
    (mean, sd, *bounds), unit = _quantities([value["mean"], value["sd"], *value.get("between", [])])
    if sd <= 0.0:
        raise Error("sd must be above 0")
    if bounds and not (len(bounds) == 2 and bounds[0] < bounds[1]):
        raise Error("between must be two values, the first below the second")
    return Distribution("truncated_normal" if bounds else "normal", (mean, sd, *bounds)), unit


def _integers(value: Any) -> tuple[Distribution, str]:
    low, high = value
    if not all(isinstance(v, int) and not isinstance(v, bool) for v in (low, high)) or low >= high:
        raise Error("two whole numbers are needed, the first below the second")
    return Distribution("integer", (float(low), float(high))), ""


def _choice(value: Any) -> tuple[Distribution, str]:
    if not isinstance(value, list) or len(value) < 2 or not all(isinstance(v, (str, int, float, bool)) for v in value):
        raise Error("a list of two or more values is needed")
    values: tuple[Value, ...] = tuple(value)
    if len(set(values)) != len(values):
        raise Error("the values must differ")
    return Distribution("choice", choices=values), ""


def _targets(root: _core.Table, method: str, outputs: list[Output]) -> list[Target]:
    if method not in _TO_TARGETS:
        root.know(["targets"])
        return []
    targets = []
    tables = root.table("targets", "Values that outputs should reach.")
    units = {output.name: output.unit for output in outputs}
    for name, table in tables.named_tables("OUTPUT", "Of the output of that name. A bare number counts in the output's "
                                           "unit, as the name of the result or column ends on it."):
        unit = units.get(name, "1")
        value = _number_of_output(table, "value", unit, "Value that the output should reach: `25`, or `\"25 GPa\"`.")
        spread = "K" if unit == "degC" else unit  # a standard deviation is a difference
        sd = _number_of_output(table, "sd", spread, "Standard deviation by which the experiment is uncertain.")
        if name not in [o.name for o in outputs] and name != "OUTPUT":
            tables.error(name, f"no output is called so; there are {', '.join(o.name for o in outputs)}")
        by = ""
        if method == "secant":
            by = table.text("by", "Parameter that is changed until the output is within `sd` of the value, each of one "
                            "target.")
            if table.ok() and value <= 0.0:
                table.error("value", "must be greater than 0, as its logarithm is approached")
        else:
            table.know(["by"])
        if table.ok() and sd <= 0.0:
            table.error("sd", "must be greater than 0")
        targets.append(Target(name, value, sd, by))
    return targets


def _number_of_output(table: _core.Table, key: str, unit: str, meaning: str) -> float:
    """Returns a number in an output's unit, written without a unit or with another one of its kind."""
    value = json.loads(table.json(key, "number or quantity", meaning))
    if value is None:
        return 0.0
    try:
        return number_in(value, unit)
    except Error as error:
        table.error(key, str(error))
    return 0.0


def _correlations(root: _core.Table, names: list[str], method: str) -> list[tuple[str, str, float]]:
    found = []
    for table in root.optional_tables("correlations", "Between two parameters; they are independent without it."):
        between = table.texts("between", "Names of the two.", is_optional=False)
        rank = table.number("rank", "Spearman's correlation.", -0.99, 0.99)
        if table.ok() and (len(between) != 2 or any(name not in names for name in between)):
            table.error("between", f"two of {', '.join(names)} are needed")
        elif table.ok():
            found.append((between[0], between[1], rank))
        if method in ("morris", "sobol", "calibrate", "secant"):
            table.error("", f"{method} takes parameters to be independent; with correlation there are lhs, chaos and "
                        "posterior")
    return found


def _slurm(root: _core.Table) -> SlurmSettings:
    table = root.optional_table("slurm", "Jobs of `--executor slurm`.")
    if table is None:
        return SlurmSettings()
    settings = SlurmSettings(
        table.integer("slots", "Tasks at a time.", 1, None, 16),
        table.quantity("time", "s", "Of a task; runs that it cannot end go on in another.", 60.0, None, 3600.0),
        table.integer("points_per_task", "Runs that a task makes one after the other; 0: so many that it lasts some "
                      "ten minutes.", 0, None, 0))
    options = table.texts("options", "Further options of sbatch, such as [\"--partition=long\"]. Options that may run "
                          "a program need `--allow-code`; see [Studies on a cluster](../do/cluster.md).",
                          is_optional=True)
    try:
        return replace(settings, options=tuple(options))
    except Error as error:
        table.error("options", str(error))
        return settings


def _check_together(root: _core.Table, own: _core.Table, method: Method, parameters: list[Parameter],
                    outputs: list[Output], targets: list[Target]) -> None:
    if not root.ok():
        return
    names = [p.name for p in parameters]
    if method.kind == "ensemble":
        if parameters:
            root.error("parameters", 'have no meaning with kind = "ensemble", which has one point')
    elif not parameters:
        root.error("parameters", f'kind = "{method.kind}" needs one parameter at least')
    for name in {"seed", "folder"} & set(names):
        root.error(f"parameters.{name}", "is the name of something else")
    for output in outputs:
        if output.name in names:
            root.error("outputs", f"{output.name!r} is a parameter too")
    if method.kind in _TO_TARGETS:
        if not targets:
            root.error("targets", f'kind = "{method.kind}" needs one target at least')
        for p in parameters:
            if p.distribution.kind == "choice":
                root.error("parameters", f'{p.name} is a choice, which kind = "{method.kind}" cannot vary')
    if method.kind == "secant":
        for name in [p.name for p in parameters if p.distribution.kind not in ("uniform", "log_uniform")]:
            root.error(f"parameters.{name}", 'must be uniform or log_uniform with kind = "secant"')
        for p in parameters:
            if p.distribution.kind == "uniform" and p.distribution.numbers[0] <= 0.0:
                root.error(f"parameters.{p.name}", 'must be greater than 0 with kind = "secant"')
        if sorted(t.by for t in targets) != sorted(names):
            root.error("targets", f'kind = "secant" needs for each parameter one target that it is to meet; "by" names '
                       f"{', '.join(t.by for t in targets)}, the parameters are {', '.join(names)}")
