"""The loop of a study: ask the method for points, check them, run what is missing, and ask again."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import shlex
import statistics
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..errors import Error
from ..stored.results import Results
from ..texts import seen_on_a_line
from ..writing import write_text
from .code import StudyCode
from .executors import Executor
from .file import FIRST_SEED, StudySetup
from .outputs import Output, read_facts, read_summary
from .parameters import Value
from .plans import Answers, Plan, Proposal, plan_of
from .points import Point, Points
from .start import require_mpi
from .store import DONE, FAILED, NO_VALUE, RunResult, Store, judged
from .work import Job, made

NOT_RUN = "not run"
WITH_A_BEST = ("calibrate", "secant")
"""Methods that look for the point nearest to the targets."""
NOT_MET = "# The targets are not met"
"""Begins a line of best.toml, which `pyroclast concrete --from` hands on (app/concrete.cpp)."""

_LEAST_CHECKPOINT = 1.0  # s
_SHARE_OF_CHECKPOINTS = 0.02  # of the expected time of a run
_FEW = 30  # runs of which each is told when it is done
_PROGRESS = 1.0  # s between two lines of progress
_BEGINS_FORMULA = ("=", "+", "-", "@")  # in a cell of a spreadsheet


@dataclass(frozen=True)
class Wanted:
    """A run that the method asks for."""

    point: Point
    seed: int

    @property
    def ids(self) -> tuple[str, ...]:
        return self.point.ids(self.seed)


@dataclass(frozen=True)
class StudyForecast:
    """What a study asks for, and what is left of it."""

    points: int  #: that the method asks for so far, each once
    runs: int  #: of these points, one for each seed
    known: int  #: runs of which it is known what came of them
    infeasible: int  #: points whose deck is refused
    seconds: float  #: of one core, for what is left; NaN where no run has told yet how long it takes
    is_complete: bool  #: whether these are all points that the method will ask for
    most: int | None  #: runs that it may come to ask for at most; None: not known

    def time(self, seconds: float) -> str:
        """Says how long the runs that are left take, of which one takes so many seconds."""
        said = f"{duration(seconds)} a run, {duration(seconds * self.left)} of one core "
        if self.is_complete:
            return said + "in all"
        more = "more may follow" if self.most is None else \
            f"{duration(seconds * (self.most - self.known))} at most, for {self.most} runs"
        return f"{said}to begin with; {more}"

    @property
    def left(self) -> int:
        """Runs that are still to be made."""
        return self.runs - self.known


class Driver:
    """Brings a study to its end, from what its store knows."""

    def __init__(self, study: StudySetup, store: Store, program: str = "pyroclast",
                 functions: Mapping[str, Callable[[Results], float]] = MappingProxyType({}),
                 code: StudyCode | None = None):
        """Takes a study.

        program: makes the runs, and is what the command line of each names.
        functions: outputs by name that are taken of what is kept of a run.
        code: of the study, where it is known already.

        Raises Error for earlier tables that cannot be read.
        """
        self.study, self.store, self.program, self.functions = study, store, program, functions
        self.points = Points(study, code)
        self.plan: Plan = plan_of(study)
        self._may_lack = {o.what for o in study.outputs if o.name in study.may_lack}
        self._take_in_earlier()

    def check(self) -> None:
        """Raises Error with all that is wrong; see `Study.check`."""
        if self.study.ranks > 1:
            try:
                require_mpi(self.program)
            except Error as error:
                raise Error(f"{self.study.place('study.ranks')}: {error}") from error
        wrong = self.points.check_ends()
        if not self.points.has_seed:
            stated = {"seeds": len(self.study.seeds) > 1, "first_seed": self.study.seeds[0] != FIRST_SEED}
            wrong += [f"{self.study.place('study.' + key)}: the blocks of the deck come from a file, so a seed has no "
                      "meaning; each point has one run" for key, is_stated in stated.items() if is_stated]
        if not wrong and not self.plan.draws_as_it_goes:
            for point in self._points(self.plan.propose(self._answers).points):
                if point.infeasible:
                    named = ", ".join(f"{p.name} = {v}{' ' if p.unit else ''}{p.unit}"
                                      for p, v in zip(self.study.parameters, point.values))
                    wrong.append(f"{self.study.place('method')}: at {named}: {point.infeasible}")
        wrong = wrong or self.points.check_outputs(self._not_seen())
        if wrong:
            raise Error("\n".join(dict.fromkeys(wrong)))

    def _not_seen(self) -> list[Output]:
        """Returns outputs that no run has had yet."""
        seen = {what for r in self.store for what, (value, _) in r.outputs.items() if value is not None}
        return [o for o in self.study.outputs if o.what not in seen]

    def forecast(self) -> StudyForecast:
        """Foresees what the method asks for now."""
        proposal = self.plan.propose(self._answers)
        wanted = self._wanted(proposal)
        known = sum(self._result(w) is not None for w in wanted)
        points = set(self._points(proposal.points))
        return StudyForecast(len(points), len(wanted), known, sum(bool(p.infeasible) for p in points),
                        (len(wanted) - known) * self.expected * self.study.ranks, proposal.is_complete,
                        len(wanted) if proposal.is_complete else
                        self.plan.most_points and self.plan.most_points * len(proposal.seeds))

    @property
    def expected(self) -> float:
        """Wall time of a run, s: the median of those that came to their end; NaN without one."""
        walls = [r.wall for r in self.store if r.state in (DONE, NO_VALUE) and r.wall > 0.0]
        return statistics.median(walls) if walls else math.nan

    def run(self, executor: Executor, stopped: Callable[[], bool] = lambda: False,
            say: Callable[[str], None] = lambda line: None) -> bool:
        """Makes all runs that the method asks for; whether it has them all. say: gets lines of progress."""
        self.check()
        if outdated := self.count_outdated():
            said = "1 earlier run is" if outdated == 1 else f"{outdated} earlier runs are"
            say(f"{said} of other code, another deck or another version: they stay, and do not count")
        if self.plan.most_points and self.study.runner.kind == "pyroclast" and math.isnan(self.expected):
            say(f"time            {self.forecast().time(self.points.seconds_of_run(self.study.seeds[0]))}")
        while True:
            proposal = self.plan.propose(self._answers)
            missing = self._missing(proposal)
            if missing:
                count = "1 run" if len(missing) == 1 else f"{len(missing)} runs"
                say(f"{count} to make" + ("" if proposal.is_complete else "; further runs depend on their results"))
                progress = _Progress(len(missing), say)

                def finished(result: RunResult, progress: _Progress = progress) -> None:
                    self.store.put(result)
                    progress.count(result)

                executor.run(self._jobs(missing), self.store.runs, finished, stopped)
                progress.end()
            if stopped() or any(self._result(w) is None for w in missing):
                self.write_table()
                return False
            if proposal.is_complete:
                break
        self.write_table()
        return True

    def _missing(self, proposal: Proposal) -> list[Wanted]:
        """Runs of which it is not known what came of them. What a killed driver left undone is done first."""
        wanted = self._wanted(proposal)
        begun = self.store.begun()
        for job in self._jobs(w for w in wanted if w.ids[0] in begun):
            if (result := made(job, self.store.runs)) is not None:
                self.store.put(result)
        return [w for w in wanted if self._result(w) is None]

    def count_values(self) -> int:
        """Runs that gave a value of every output that they must have."""
        return sum(result is not None and result.state == DONE
                   for result in map(self._result, self._wanted(self.plan.propose(self._answers))))

    def count_outdated(self) -> int:
        """Runs whose values and seed the method asks for, made of another deck, other code or another version."""
        wanted = self._wanted(self.plan.propose(self._answers))
        known = {run for w in wanted for run in w.ids}
        asked = {_of_point(dict(zip((p.name for p in self.study.parameters), w.point.values)), w.seed) for w in wanted}
        return sum(r.id not in known and _of_point(r.values, r.seed) in asked for r in self.store)

    def count_begun(self) -> int:
        """Runs that were begun and have no result."""
        return sum(self.store.get(run) is None for run in self.store.begun())

    def rows(self) -> list[dict[str, Any]]:
        """Returns a line for each run that the method asked for: what it was, what came of it, how to make it again."""
        rows = []
        for wanted in self._wanted(self.plan.propose(self._answers)):
            result = self._result(wanted)
            row: dict[str, Any] = {"run": wanted.ids[0], "seed": wanted.seed}
            row.update({p.column: v for p, v in zip(self.study.parameters, wanted.point.values)})
            row["state"] = result.state if result else NOT_RUN
            for output in self.study.outputs:
                number = result.number(output.what) if result else math.nan
                row[output.name] = None if math.isnan(number) else number
            row["reason"] = seen_on_a_line(result.reason) if result else ""
            row["physics_version"] = result.version if result else None
            row["host"] = result.host if result else ""
            row["wall_s"] = result.wall if result else None
            row["command"] = shlex.join(self._job(wanted).line(Path("FOLDER")))
            rows.append(row)
        return rows

    def missing(self) -> dict[str, list[str]]:
        """Returns, by output, why the runs that came to their end lack it."""
        found: dict[str, list[str]] = {output.name: [] for output in self.study.outputs}
        for result in map(self._result, self._wanted(self.plan.propose(self._answers))):
            for output in self.study.outputs:
                value, why = result.outputs.get(output.what, (None, "")) if result else (None, "")
                if value is None and why:
                    found[output.name].append(why)
        return found

    def write_table(self) -> Path:
        """Writes table.csv in the folder of the study, in the place of an earlier one."""
        file = self.store.folder / "table.csv"
        write_text(file, self.table_text())
        return file

    def table_text(self) -> str:
        """Returns `rows` as CSV."""
        rows = self.rows()
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(map(_cell, rows[0] if rows else ["run"]))
        writer.writerows(map(_cell, row.values()) for row in rows)
        return text.getvalue()

    def write_best(self) -> Path | None:
        """Writes best.toml in the folder of the study: the deck with the parameters that come nearest to the targets.
        None where the method has no such point, or runs have no deck. Raises Error where there is no such point yet.
        """
        if self.study.method.kind not in WITH_A_BEST or self.study.runner.kind != "pyroclast":
            return None
        file = self.store.folder / "best.toml"
        findings = self.findings()
        values = self.values(findings["best"]["u"])
        found = ", ".join(f"{p.name} = {v:g} {p.unit}".rstrip() for p, v in zip(self.study.parameters, values))
        doubts = findings["best"]["doubts"]
        missed = "" if findings.get("is_met", not doubts) else f"{NOT_MET}: " + ", ".join(
            f"{target.output} is {y:.4g}, wanted {target.value:g}"
            for target, y in zip(self.study.targets, findings["best"]["y"])) + "".join(
            f"; {output} does not count: {seen_on_a_line(why)}" for output, why in doubts.items()) + ".\n"
        write_text(file, f"# Best point of the study \"{self.study.title}\": {found}.\n{missed}"
                         "# The comments below come from the first deck.\n" + self.points.text(values))
        return file

    def findings(self) -> dict[str, Any]:
        """Returns what the method makes of the results; numbers, texts, lists and dicts only."""
        return self.plan.findings(self._answers)

    def _points(self, cube: NDArray[np.float64]) -> list[Point]:
        return [self.points.at(self.values(u)) for u in cube]

    def values(self, u: Iterable[float]) -> list[Value]:
        """Returns the values of the parameters at a point of the unit cube."""
        return [p.distribution.at(float(x)) for p, x in zip(self.study.parameters, u)]

    def _wanted(self, proposal: Proposal) -> list[Wanted]:
        """Returns each run once."""
        found: dict[tuple[str, ...], Wanted] = {}
        for point in self._points(proposal.points):
            if not point.infeasible:
                for seed in proposal.seeds:
                    wanted = Wanted(point, seed)
                    found.setdefault(wanted.ids, wanted)
        return list(found.values())

    def _answers(self, cube: NDArray[np.float64], seeds: Sequence[int]) -> Answers:
        points = self._points(cube)
        shape = (len(points), len(seeds))
        y: dict[str, NDArray[np.float64]] = {o.name: np.full(shape, math.nan) for o in self.study.outputs}
        is_known = np.zeros(shape, dtype=bool)
        doubts: dict[str, dict[tuple[int, int], str]] = {o.name: {} for o in self.study.outputs}
        is_feasible = np.array([not p.infeasible for p in points], dtype=bool)
        for i, point in enumerate(points):
            for j, seed in enumerate(seeds):
                result = None if point.infeasible else self._result(Wanted(point, seed))
                if result is not None:
                    is_known[i, j] = True
                    for output in self.study.outputs:
                        y[output.name][i, j] = result.number(output.what)
                        if doubt := result.doubt(output.what):
                            doubts[output.name][i, j] = doubt
        return Answers(y, is_known, is_feasible, doubts)

    def _result(self, wanted: Wanted) -> RunResult | None:
        """Returns what is known of a run with outputs that the study has only now; None: it must be made for them."""
        result = self.store.get(*wanted.ids)
        if result is None or result.state not in (DONE, NO_VALUE):
            return result
        lacking = [o for o in self.study.outputs if o.what not in result.outputs]
        result = self._with(result, lacking) if lacking else result
        return result and judged(result, (o.what for o in self.study.outputs), self._may_lack)

    def _with(self, result: RunResult, outputs: Sequence[Output]) -> RunResult | None:
        folder = self.store.runs / result.id
        summary = read_summary(folder)
        if summary is None or any(o.of_history for o in outputs) and not (folder / "history.csv").exists():
            return None
        found, facts = dict(result.outputs), read_facts(folder)
        for output in outputs:
            value, why = self._call(output.name, folder) if output.is_function else output.of(folder, summary, facts)
            found[output.what] = (None if math.isnan(value) else value, why)
        result = judged(replace(result, outputs=found), found)
        self.store.put(result)
        return result

    def _call(self, name: str, folder: Path) -> tuple[float, str]:
        try:
            value = float(self.functions[name](Results(folder)))
        except Exception as error:  # of the user's code: whatever it is, it is this run's
            return math.nan, f"{type(error).__name__}: {error}"
        return value, "" if math.isfinite(value) else "is not finite"

    def _jobs(self, wanted: Iterable[Wanted]) -> list[Job]:
        expected = 0.0 if math.isnan(self.expected) else self.expected
        return [self._job(w, expected) for w in wanted]

    def _job(self, wanted: Wanted, expected: float = 0.0) -> Job:
        study = self.study
        values = wanted.point.values
        return Job(wanted.ids[0], wanted.seed, study.runner.kind,
                   tuple(self.points.command(self.program, values, wanted.seed)),
                   dict(zip((p.name for p in study.parameters), values)),
                   tuple(o.what for o in study.outputs if not o.is_function), study.keep,
                   study.wall_limit, max(_LEAST_CHECKPOINT, _SHARE_OF_CHECKPOINTS * expected),
                   _core.physics_version if study.runner.kind == "pyroclast" else 0, expected,
                   self.points.code.hash, dict(self.points.code.files), study.ranks)

    def _take_in_earlier(self) -> None:
        """Runs of earlier tables, by their identity."""
        for file in self.study.earlier:
            try:
                with open(file, newline="", encoding="utf-8") as text:
                    results = [_result_of(row, self.study.outputs) for row in csv.DictReader(text)
                               if row["state"] in (DONE, *FAILED) and self.store.get(row["run"]) is None]
            except (OSError, KeyError, ValueError, csv.Error) as error:
                raise Error(f"{self.study.place('study.earlier')}: {file} is no table of a study: {error!r}") from error
            for result in results:
                self.store.put(result)


class _Progress:
    """Lines that say how many runs are done, how many gave no value at all, and what time is left."""

    def __init__(self, total: int, say: Callable[[str], None]):
        self._total, self._say = total, say
        self._done = self._failed = self._said = 0
        self._begun = self._last = time.monotonic()

    def count(self, result: RunResult) -> None:
        self._done += 1
        has_value = any(value is not None for value, _ in result.outputs.values())
        self._failed += result.state in FAILED and not has_value
        if self._total <= _FEW or time.monotonic() - self._last > _PROGRESS:
            self.end()

    def end(self) -> None:
        """Says how it stands, unless that was said already."""
        if self._said == self._done:
            return
        self._last, self._said = time.monotonic(), self._done
        left = (self._total - self._done) * (self._last - self._begun) / max(self._done, 1)
        failed = f", {self._failed} without a value" if self._failed else ""
        self._say(f"{self._done} of {self._total} runs{failed}" + (f", about {duration(left)} left" if left else ""))


def _of_point(values: Mapping[str, Any], seed: int) -> str:
    return json.dumps([values, seed], sort_keys=True)


def _cell(value: Any) -> Any:
    """Returns a cell that no spreadsheet takes for a formula and that acts on no terminal: a text that would be a
    formula stands behind an apostrophe, and control characters are written out.
    """
    if not isinstance(value, str):
        return value
    shown = seen_on_a_line(value)
    return f"'{shown}" if shown.startswith(_BEGINS_FORMULA) else shown


def _text(cell: str) -> str:
    """Returns the text that `_cell` made a cell of."""
    return cell[1:] if cell.startswith("'") and cell[1:].startswith(_BEGINS_FORMULA) else cell


def _result_of(row: dict[str, str], outputs: Sequence[Output]) -> RunResult:
    found: dict[str, tuple[float | None, str]] = {}
    for output in outputs:
        if output.name in row:
            found[output.what] = (float(row[output.name]), "") if row[output.name] else (None, _text(row["reason"]))
    version = row.get("physics_version") or "0"
    return RunResult(row["run"], int(row["seed"]), row["state"], _text(row["reason"]), found, {}, row["host"],
                     wall=float(row["wall_s"] or 0.0), version=int(version))


def duration(seconds: float) -> str:
    """Returns a duration for a reader: "45 s", "3 min", "2 h 10 min"."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"


def free_cores() -> int:
    """Returns how many cores this process may use."""
    return len(os.sched_getaffinity(0))
