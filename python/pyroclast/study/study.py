"""A study as an object."""

from __future__ import annotations

import json
import re
import shutil
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..errors import Diagnostic, Error
from ..live.decks import is_list_of_tables, table_text, toml
from .choices import EXECUTORS
from .code import StudyCode, code_of, require_code, require_options
from .driver import Driver, StudyForecast, free_cores
from .executors import Executor
from .executors.commands import Commands
from .executors.local import Local
from .executors.slurm import Slurm
from .file import StudySetup, read_setup
from .store import CRASHED, TIMED_OUT, Store, only_writer

if TYPE_CHECKING:
    import pandas

_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?")


class Study:
    """Many runs, and what comes of them.

        study = pyroclast.Study("strength.toml")
        study.run(jobs=4)
        study.table.plot.scatter("f_t [MPa]", "f_c")
        print(study.findings["outputs"]["f_c"])

    A study goes on where it stopped: runs that are done are never made again. What other processes write in its folder
    is seen; files that the deck names are read again by `check` and `run`. Raises DeckError for a file that is none.
    """

    def __init__(self, file: str | Path, *, program: str | None = None,
                 functions: Mapping[str, Callable[[Any], float]] | None = None, **tables: Any):
        """Reads a study.

        file: a study file. With tables, it is written from these first: `study={"deck": "starter.toml"}`, ...
        program: pyroclast itself; None: that on the PATH.
        functions: further outputs, by names of their own: of a `pyroclast.Results`, called once for each run. What they
            need of the run has to be kept (`keep`).
        """
        self._is_own = bool(tables)  # the script's, not a file's: what it names, the script names
        if tables:
            _write(Path(file), tables)
        self.setup: StudySetup = read_setup(file, list(functions or ()))
        self._functions = dict(functions or {})
        needs_program = self.setup.runner.kind == "pyroclast"
        self._program = program or (_program() if needs_program else "")
        self._held: Driver | None = None
        self._made_from: tuple[StudySetup, list[int], StudyCode] | None = None  # and when the deck was written

    def check(self) -> list[Diagnostic]:
        """Returns what the check of the deck in the middle of all ranges warns of.

        Raises Error with all that is wrong at the ends of ranges and at points that are known beforehand, and with
        outputs that no run has.
        """
        self._held = None  # all that the deck names is read again
        driver = self._driver()
        driver.check()
        return driver.points.warnings()

    def forecast(self) -> StudyForecast:
        """Returns what is left to run."""
        return self._driver().forecast()

    def run(self, executor: str | Executor = "local", jobs: int | None = None,
            say: Callable[[str], None] | None = None) -> bool:
        """Makes all runs that are missing; whether the study is complete.

        executor: "local", "slurm", "commands", or one of your own (`pyroclast.study.executors`).
        jobs: runs at once; None: as many as there are cores for their ranks.
        say: gets lines of progress; `print` will do.

        Ctrl-C stops it: each run keeps its state and goes on the next time.
        """
        code = code_of(self.setup)
        require_code(code, self._is_own)
        chosen = self.executor(executor, jobs) if isinstance(executor, str) else executor
        if isinstance(chosen, Slurm):
            require_options(self.setup, self._is_own)
        with only_writer(self.setup.folder) as store, _interrupts() as stopped:
            return self._hold(store, code).run(chosen, stopped, say or (lambda line: None))

    def executor(self, name: str, jobs: int | None = None) -> Executor:
        """Returns an executor by its name. Raises Error for another one."""
        if name == "local":
            return Local(jobs or max(1, free_cores() // self.setup.ranks))
        if name == "commands":
            return Commands(self.setup.folder / "commands.txt", self.setup.slurm)
        if name == "slurm":
            return Slurm(self.setup.slurm if jobs is None else replace(self.setup.slurm, slots=jobs))
        raise Error(f"executor {name!r}: must be one of {', '.join(EXECUTORS)}")

    @property
    def table(self) -> pandas.DataFrame:
        """A line for each run: parameters in their units, state, outputs, command."""
        import pandas

        return pandas.DataFrame(self.rows())

    @property
    def samples(self) -> pandas.DataFrame:
        """The points: a line each, the parameters in their units."""
        columns = [p.column for p in self.setup.parameters]
        return self.table[columns].drop_duplicates(ignore_index=True)

    @property
    def results(self) -> pandas.DataFrame:
        """Means of the outputs over the seeds, a line for each point; NaN where one seed gave no value."""
        columns = [p.column for p in self.setup.parameters]
        outputs = [o.name for o in self.setup.outputs]
        table = self.table
        if not columns:
            return table[outputs].mean(skipna=False).to_frame().T
        return table.groupby(columns, sort=False)[outputs].agg(lambda y: np.mean(y.to_numpy(float))).reset_index()

    @property
    def findings(self) -> dict[str, Any]:
        """Findings that the method makes of the results; docs/do/studies.md tells what stands where."""
        return self._driver().findings()

    def count_values(self) -> int:
        """Runs that gave a value of every output that they must have."""
        return self._driver().count_values()

    def warnings(self) -> list[str]:
        """Returns warnings of the runs whose summaries are kept: of each kind how many runs have it, and how the first
        says it.

        Warnings are of one kind where they are alike up to the first colon, but for numbers.
        """
        kinds: dict[str, list[str]] = {}
        files = [self.setup.folder / "runs" / str(row["run"]) / "summary.json" for row in self.rows()]
        summaries = [json.loads(file.read_text(encoding="utf-8")) for file in files if file.exists()]
        for summary in summaries:
            of_stages = (text for stage in summary.get("stages", []) for text in stage.get("warnings", []))
            told = [*summary.get("warnings", []), *of_stages]
            for head, text in {_NUMBER.sub("#", text.partition(":")[0]): text for text in reversed(told)}.items():
                kinds.setdefault(head, []).append(text)
        return [f"{len(texts)} of {len(summaries)} runs: {texts[0]}" for texts in kinds.values()]

    def count_outdated(self) -> int:
        """Runs that are there and do not count: of other code, another deck or another version."""
        return self._driver().count_outdated()

    def require_options(self) -> None:
        """Returns where sbatch may get the options of the study. Raises CodeNotAllowed where they need a word."""
        require_options(self.setup, self._is_own)

    def count_begun(self) -> int:
        """Runs that are under way or were broken off: begun, without a result."""
        return self._driver().count_begun()

    def rows(self) -> list[dict[str, Any]]:
        """Returns the table as it is written: None where there is no value."""
        return self._driver().rows()

    def forget_failures(self) -> None:
        """Runs that crashed or timed out are made again."""
        with only_writer(self.setup.folder) as store:
            store.drop([r.id for r in store if r.state in (CRASHED, TIMED_OUT)])

    def time_of_a_run(self) -> float | None:
        """Returns the time of a run of the middle of all ranges on one thread, by its first steps, s; None where runs
        are not those of a deck.
        """
        if self.setup.runner.kind != "pyroclast":
            return None
        return self._driver().points.seconds_of_run(self.setup.seeds[0])

    def missing(self) -> dict[str, list[str]]:
        """Returns, by output, why the runs that came to their end lack it."""
        return self._driver().missing()

    def write_best(self) -> Path | None:
        """Writes best.toml in the folder of the study: the deck with the parameters that come nearest to the targets,
        of `calibrate` and `secant`; None of other methods, and where runs have no deck. File names in it are taken from
        the place of the study's deck. Raises Error where no point has all targets yet.
        """
        return self._driver().write_best()

    def write_table(self) -> Path:
        """Writes table.csv in the folder of the study."""
        return self._driver().write_table()

    def table_text(self) -> str:
        """Returns what table.csv would hold now; nothing is written."""
        return self._driver().table_text()

    def _driver(self) -> Driver:
        """Returns a driver that knows what any process has written by now; made anew where the setup, the deck or the
        model changed.
        """
        code = code_of(self.setup)
        if self._held is None or self._made_from != self._sources(code):
            return self._hold(Store(self.setup.folder), code)
        self._held.store.look()
        return self._held

    def _hold(self, store: Store, code: StudyCode) -> Driver:
        sources = self._sources(code)
        self._held = Driver(self.setup, store, self._program, self._functions, code)
        self._made_from = sources
        return self._held

    def _sources(self, code: StudyCode) -> tuple[StudySetup, list[int], StudyCode]:
        deck = self.setup.runner.deck
        return self.setup, [deck.stat().st_mtime_ns] if deck.is_file() else [], code

    def __repr__(self) -> str:
        return f"<Study {self.setup.file}: {self.setup.method.kind}>"


def _write(file: Path, tables: Mapping[str, Any]) -> None:
    plain = [f"{key} = {toml(value)}" for key, value in tables.items() if not isinstance(value, (Mapping, list))]
    blocks = []
    for key, value in tables.items():
        if is_list_of_tables(value):
            blocks += [table_text(key, entry, True) for entry in value]
        elif isinstance(value, Mapping):
            blocks.append(table_text(key, value))
    file.write_text("\n".join([*plain, "", *blocks]), encoding="utf-8")


def _program() -> str:
    """Finds the program: beside the package where it was built or installed, else on the PATH."""
    package = Path(_core.__file__).parent
    for folder in (package.parents[1], package.parents[3], Path(sys.prefix)):  # of a build, of cmake, of pip
        if (folder / "bin" / "pyroclast").exists():
            return str(folder / "bin" / "pyroclast")
    found = shutil.which("pyroclast")
    if found is None:
        raise Error("pyroclast is not on the PATH; name it: Study(..., program=...)")
    return found


@contextmanager
def _interrupts() -> Iterator[Callable[[], bool]]:
    """Lets Ctrl-C and SIGTERM ask to stop; a second one raises KeyboardInterrupt."""
    asked = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield asked.is_set
        return

    def ask(number: int, frame: Any) -> None:
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()

    before = {number: signal.signal(number, ask) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield asked.is_set
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
