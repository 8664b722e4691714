"""Runs in this process.

This holds for all of it. Arrays, results, and columns without a unit in their names are SI, temperatures degC. Stress
and strain of a test are positive in compression; stresses of zones and tractions of contacts in tension. An array is a
copy, in the order of the model, but for `Run.views`. Of the mechanics, displacements are those at the end of the last
step, velocities those half a step before, and forces and stresses those at the displacements before that step. Where
nothing moves, what is of the mechanics raises Error. Error says what cannot be done; DeckError, which is one, what is
wrong with a deck.
"""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..errors import Error
from ..libraries import library
from ..stored.columns import Array, ColumnNames, Columns
from . import functions
from .decks import Deck, Value, as_deck, table_text, toml, without_functions
from .specimen import Specimen
from .stages import Stage
from .units import Quantity, in_si

if TYPE_CHECKING:
    import meshio
    import pandas

Indices = NDArray[np.int32]


class History(Columns):
    """All rows of a history so far, a read-only array (rows,) for each column; NaN where a cell is empty.

    Under the program's name ("stress_MPa") a column is in the unit of its name; without it ("stress") in SI. A
    snapshot: later rows are not in it. A name that there is not raises KeyError.
    """

    def __init__(self, names: ColumnNames, cells: Array):
        super().__init__(names)
        self._rows = cells

    def _cells(self, column: int) -> Array:
        return self._rows[:, column]

    @property
    def rows(self) -> int:
        """Samples so far, the one at the start included."""
        return len(self._rows)


class State:
    """What was measured at a look: any column of the history by its name without unit (`state.strain`, `state.stress`,
    `state.temperature`, a record's), or as `state["stress_MPa"]`. NaN where the stage does not have the quantity; a
    name that there is not raises AttributeError, or KeyError.

    A light handle: once the run has gone on, it raises Error. `copy()` lasts.
    """

    __slots__ = ("_columns", "_lasts", "_look", "_run", "_values")

    def __init__(self, run: Run, columns: ColumnNames, values: Array, look: int):
        self._run, self._columns, self._values, self._look, self._lasts = run, columns, values, look, False

    def __getitem__(self, name: str) -> float:
        """Returns a column; raises KeyError where there is none."""
        if not self._lasts and self._look != self._run._look:
            raise Error("this state is of an earlier sample: the run has gone on; keep state.copy() instead")
        i, factor = self._columns.place(name)
        return float(self._values[i]) * factor

    def __getattr__(self, name: str) -> float:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"the history has no {name!r}; it has {', '.join(self._columns.bare)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._columns.bare]

    @property
    def step(self) -> int:
        """Steps of the mechanics so far; 0 where nothing moves."""
        return int(self["step"]) if "step" in self._columns.units else 0

    @property
    def stage(self) -> int:
        """Number of the stage, from 0."""
        return int(self["stage"])

    def copy(self) -> State:
        """Returns the same numbers, for good."""
        self["stage"]
        lasting = State(self._run, self._columns, self._values, self._look)
        lasting._lasts = True
        return lasting

    def __repr__(self) -> str:
        shown = [f"{name}={self[name]:.6g}" for name in ("stage", "step", "strain", "stress", "temperature")
                 if name in self._columns.bare]
        return f"<State {', '.join(shown)}>"


class Views:
    """Arrays of the mechanics as they lie in memory: no copies, and read-only.

    They change as the run steps, so read them at looks. Each keeps the memory of its run alive, also after `del run`.
    They stand by slot, or in packs of eight slots: slot i is [i // 8, :, i % 8]. `run.slot` says where a gridpoint of
    the model stands.
    """

    def __init__(self, core: _core.Session):
        self._core = core

    @property
    def displacement(self) -> Array:
        """Displacement (slots, dimension), m."""
        return self._core.view("displacement")

    @property
    def velocity(self) -> Array:
        """Velocity (packs, dimension, 8), m/s."""
        return self._core.view("velocity")

    @property
    def force(self) -> Array:
        """Force (packs, dimension, 8), N: sums of all forces."""
        return self._core.view("force")

    @property
    def internals(self) -> Array:
        """Internal variables (lines, 8) of contact points, a line for each number of eight of them, in the order of the
        layout. `run.contacts()` has them by name and contact.
        """
        return self._core.view("internals")


class Fields(Mapping[str, Array]):
    """Fields of gridpoints and zones now, by name with unit, `run.fields["stress_Pa"]`, or without,
    `run.fields.stress`: (items,) numbers, (items, dimension) vectors x, y and of a solid z, (items, 6) symmetric
    tensors xx, yy, zz, xy, yz, xz. Each is a copy. A name that there is not raises KeyError, or AttributeError.
    docs/lookup/fields.md lists them.
    """

    def __init__(self, core: _core.Session):
        self._core = core
        infos = [info for info in core.field_infos() if info[3] in ("gridpoint", "zone")]
        self._names = ColumnNames([(name, unit) for name, _, unit, *_ in infos], lambda unit: 1.0)
        self._fields = [(item, bare) for _, bare, _, item, *_ in infos]

    def __getitem__(self, name: str) -> Array:
        item, bare = self._fields[self._names.place(name)[0]]
        return next(iter(self._core.fields(item, [bare]).values()))

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"this run has no field {name!r}; it has {', '.join(self._names.bare)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._names.bare]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names.names)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"<Fields {', '.join(self)}>"


class Sets(Mapping[str, Indices]):
    """Named parts of the body, fixed when it was made: (members,) each, ascending. They are indices:
    `run.fields.displacement[run.sets["left"]]`. A name that there is not raises KeyError.
    """

    def __init__(self, core: _core.Session, of_contacts: bool):
        self._core, self._of_contacts = core, of_contacts
        self._names = core.set_names(of_contacts)

    def __getitem__(self, name: str) -> Indices:
        if name not in self._names:
            raise KeyError(name)
        return self._core.members(name, self._of_contacts)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<Sets {', '.join(self._names)}>"


class Observer:
    """Follows a run. A run calls `begin` once, `look` at every sample after its row is written, and `finish` when it is
    over or stopped.
    """

    def begin(self, run: Run) -> None:
        """Begins to follow the run, before its next look."""

    def look(self, run: Run, state: State) -> None:
        """Takes in a look, after its row is written."""

    def finish(self, run: Run) -> None:
        """Ends to follow the run; is called again where a run that was stopped goes on."""


class Run:
    """A run in this process, from sample to sample:

        run = pyroclast.Run("compression.toml")
        for state in run:
            print(state.strain, state.stress)
        print(run.results["f_c_MPa"])

    It is the run of the program: the same steps and, with `out`, the same files. Stepping belongs to one thread at a
    time, and to the process that made the run; elsewhere it raises Error.
    """

    def __init__(self, deck: Deck | str | Path, *, seed: int | None = None, out: str | Path | None = None,
                 overwrite: bool = False, threads: int = 0, instructions: str = "",
                 checkpoint: float | str | Quantity | None = None, body: str | Path | None = None):
        """Makes the specimen and all that the run needs; nothing moves yet.

        deck: or its file.
        seed: of the specimen, instead of the deck's.
        out: folder of the results; None: nothing is written.
        overwrite: the results of an earlier run there.
        threads: at most; 0: as many as processors are free for this process, and never more. Small bodies, and runs
            beside other work, take fewer. Results do not depend on them.
        instructions: "portable", "avx2" or "avx512"; empty: the best that there is.
        checkpoint: wall time between two checkpoints ("5 min"; a number: s) instead of the deck's.
        body: folder into which `pyroclast specimen` wrote the body; None: the body is made here. The results are the
            same to the bit.

        Raises DeckError for what is wrong with the deck; Error for what cannot be made, and for a body that is damaged
        or not the deck's.
        """
        of = as_deck(deck)
        tables = functions.Scratch()
        core = _core.Session.begin(
            of._resolved(tables), seed, threads, instructions,
            None if checkpoint is None else in_si(checkpoint, "s"), None if out is None else str(out), overwrite,
            str(body or ""))
        self._hold(core, of._stages, of._laws, [tables])

    def _hold(self, core: _core.Session, classes: Sequence[type[Stage]], laws: Sequence[str],
              kept: Sequence[functions.Scratch] = ()) -> None:
        self._core = core
        self._classes, self._laws = list(classes), list(laws)
        self._kept = list(kept)  # files of functions and blocks, as long as the deck may be read again
        self._look = 0
        self._at_looks: list[Callable[[Run], object]] = []
        self._observers: list[Observer] = []
        self._columns = ColumnNames(core.columns, _core.si_factor)
        self._finished = False
        known = {stage.kind for stage in classes}
        for kind, *_ in core.stages:
            if kind in known:
                core.depart(f'stage "{kind}" is written in Python')

    @classmethod
    def _of(cls, core: _core.Session, classes: Sequence[type[Stage]], laws: Sequence[str],
            kept: Sequence[functions.Scratch] = ()) -> Run:
        run = cls.__new__(cls)
        run._hold(core, classes, laws, kept)
        return run

    @classmethod
    def resume(cls, folder: str | Path, *, checkpoint: str | Path | None = None, threads: int = 0,
               laws: Sequence[str | Path] = (), stages_in_python: Sequence[type[Stage]] = ()) -> Run:
        """Goes on with a run that was broken off, in its folder, from its newest checkpoint or a stated one.

        laws, stages_in_python: as a Deck has them.

        Raises Error where it is over, where another process holds it, or the checkpoint is not one of this program and
        these inputs.
        """
        places = [str(law) for law in laws]
        core = _core.Session.resume(str(folder), str(checkpoint or ""), threads, places, list(stages_in_python))
        return cls._of(core, stages_in_python, places)

    @classmethod
    def fork(cls, folder: str | Path, *, out: str | Path, from_stage: int | str | None = None,
             more: str | Path | None = None, changes: Mapping[str, Value] | None = None, overwrite: bool = False,
             threads: int = 0, laws: Sequence[str | Path] = (),
             stages_in_python: Sequence[type[Stage]] = ()) -> Run:
        """Begins a new run that has its first stages in common with that of a folder, which is only read.

        from_stage: number or name of the last stage in common; None: the last of all.
        more: a file with stages to append.
        changes: of keys of later stages, by their paths.
        laws, stages_in_python: as a Deck has them.

        Raises Error where that stage has no checkpoint, or a change would act earlier.
        """
        places = [str(law) for law in laws]
        core = _core.Session.fork(str(folder), "" if from_stage is None else str(from_stage), str(more or ""),
                                  _changes(changes), str(out), overwrite, threads, places, list(stages_in_python))
        return cls._of(core, stages_in_python, places)

    # From sample to sample

    def __iter__(self) -> Run:
        return self

    def __next__(self) -> State:
        state = self.next()
        if state is None:
            raise StopIteration
        return state

    def next(self) -> State | None:
        """Goes on to the next look: what it measured; None when the run is over, or was stopped on the way.

        Other Python threads go on meanwhile. Ctrl-C stops it between two batches of steps, raises KeyboardInterrupt,
        and leaves a run that can go on.
        """
        self._look += 1
        try:
            is_there = self._core.next()
        except KeyboardInterrupt:
            if self.folder is not None:
                self._core.finish()
            raise
        if not is_there:
            self._finish()
            return None
        self._finished = False
        state = State(self, self._columns, self._core.row(), self._look)
        for observer in self._observers:
            observer.look(self, state)
        for call in self._at_looks:
            call(self)
        if self._core.is_over:
            self._finish()
        return state

    def _finish(self) -> None:
        if self._finished:
            return
        self._finished = True
        self._core.finish()
        for observer in self._observers:
            observer.finish(self)

    def finish(self) -> Run:
        """Goes on to the end of the run; returns it."""
        while self.next() is not None:
            continue
        return self

    def until(self, condition: Callable[[State], bool] | None = None, /, *, strain: float | None = None,
              stress: float | str | Quantity | None = None, temperature: float | str | Quantity | None = None,
              quantity: Mapping[str, float] | None = None, steps: int | None = None,
              equilibrium: float | None = None) -> State:
        """Goes on until the first of these holds at a sample, and returns what was measured there.

        condition: of the state.
        strain, stress, temperature: of the specimen, passed up or down from where it is now; numbers are Pa and degC.
        quantity: the same for any columns by their names, in the unit of the name, or SI without it.
        equilibrium: the unbalanced ratio is below this.
        steps: so many steps of the mechanics from now on, to the step; the state is then measured there, and is no row
            of the history.

        Raises Error when the run ends before.
        """
        passed: dict[str, float] = dict(quantity or {})
        if strain is not None:
            passed["strain"] = strain
        if stress is not None:
            passed["stress"] = in_si(stress, "Pa")
        if temperature is not None:
            passed["temperature"] = in_si(temperature, "degC")
        for name in passed:
            if name not in self._columns.bare and name not in self._columns.units:
                raise Error(f"the history has no {name!r}; it has {', '.join(self._columns.bare)}")
        if condition is None and not passed and steps is None and equilibrium is None:
            raise Error("until needs a condition: strain, stress, temperature, quantity, steps or equilibrium")
        now = self.measure()
        stops = [True]  # taken back where another condition comes first
        rising = {name: not now[name] > value for name, value in passed.items()}  # NaN: comes from below
        if steps is not None:
            if steps < 1:
                raise Error(f"steps: {steps} is not at least 1")
            self._core.call_at(self._core.step + steps, lambda: self._core.stop() if stops[0] else None)
        goal = self._core.step + steps if steps is not None else None
        try:
            return self._go_until(condition, passed, rising, equilibrium, goal)
        finally:
            stops[0] = False
            self._core.stop(False)  # where the last step was that of a sample

    def _go_until(self, condition: Callable[[State], bool] | None, passed: Mapping[str, float],
                  rising: Mapping[str, bool], equilibrium: float | None, goal: int | None) -> State:
        while True:
            state = self.next()
            if state is None:
                if goal is not None and self._core.step >= goal and not self._core.is_over:
                    return self.measure()
                raise Error(f"the run ended ({self.outcome}) before it met the condition")
            if any(state[name] >= value if rising[name] else state[name] <= value for name, value in passed.items()):
                return state
            if condition is not None and condition(state):
                return state
            if equilibrium is not None and state["unbalanced_ratio"] < equilibrium:
                return state
            if goal is not None and self._core.step >= goal:
                return state

    def measure(self) -> State:
        """Measures what a sample would, now; adds no row to the history."""
        return State(self, self._columns, self._core.measure(), self._look)

    def stop(self) -> None:
        """Stops the run before its next batch of steps. The loop over it ends; another one goes on."""
        self._core.stop()

    def at_looks(self, call: Callable[[Run], object]) -> None:
        """Calls back at every sample, after its row is written. The call may change the run. What it raises, `next`
        raises; the run can go on.
        """
        self._at_looks.append(call)

    def add_observer(self, observer: Observer) -> None:
        """Lets an observer follow the run from now on."""
        observer.begin(self)
        self._observers.append(observer)

    def call_at(self, step: int, call: Callable[[Run], object]) -> None:
        """Calls back once, when the mechanics has done so many steps since its beginning; a batch ends there.

        Raises Error when that step is past, or nothing moves. An exception of the call stops the run there and is
        raised by `next`; the run can go on.
        """
        self._core.call_at(step, lambda: call(self))

    def every(self, steps: int, call: Callable[[Run], object]) -> None:
        """Calls back every so many steps of the mechanics from now on; see `call_at`."""
        if steps < 1:
            raise Error(f"every: {steps} steps are not at least 1")

        def again() -> None:
            self._core.call_at(self._core.step + steps, again)
            call(self)

        self._core.call_at(self._core.step + steps, again)

    def close(self) -> None:
        """Writes the summary of the rows so far and gives the folder back. The run can be read, and goes on no more.
        The end of `with Run(...) as run:` does the same.
        """
        self._core.close()

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Other ways to go on

    def copy(self, changes: Mapping[str, Value] | None = None, *, out: str | Path | None = None,
             overwrite: bool = False) -> Run:
        """Makes a run that stands where this one does and goes its own way: one loaded specimen, three fires.

        changes: of keys of stages that have not begun, by their paths.
        out: a folder, into which it writes all rows, and frames as far as this one has them.

        Call-backs are not copied.

        Raises Error for a change that would act on what is done already.
        """
        core = self._core.copy(_changes(changes), None if out is None else str(out), overwrite)
        return Run._of(core, self._classes, self._laws, self._kept)

    def then(self, kind: str, /, **keys: Any) -> Run:
        """Appends a stage to the run: `run.then("compress", velocity="0.8 mm/s", ...)`. The run is then that of its
        deck with this stage behind the others. The `factor` of a drive may be a function. Returns the run.

        Raises DeckError for what is wrong with the stage; Error where it contradicts a support, or would let the body
        fly away. The run is then as it was.
        """
        found: dict[str, functions.Function] = {}
        plain = without_functions({"kind": kind, **keys}, f"stages[{len(self._core.stages)}]", found)
        text = table_text("stages", plain, True)
        self._core.change_stages(_changes(self._tabulated(found, text)), text)
        return self._renewed()

    def _tabulated(self, found: Mapping[str, functions.Function], more: str = "") -> dict[str, Value]:
        """Returns tables of functions, by the paths of their keys in the deck and text that is appended to it."""
        if not found:
            return {}
        deck = Deck.from_text(self.deck_text + "\n" + more, folder=self._core.deck_folder, laws=self._laws,
                              stages_in_python=self._classes)
        deck._functions.update(found)
        self._kept.append(functions.Scratch())
        return {path: {"csv": str(table)} for path, table in deck._tables(Path(self._kept[-1].folder))}

    def change(self, changes: Mapping[str, Value | Callable[[float], float] | functions.Function]) -> Run:
        """Sets other values from now on, by the paths of the deck: of stages that have not begun, or of [materials] and
        [contacts], which act as a change of temperature does. Functions stand where they can in a deck. Returns the
        run.

        With materials or contacts the run is no longer that of its deck: summary and manifest say so, and only the
        script can make it again. Raises DeckError or Error for what cannot be or cannot change; the run is then as it
        was.
        """
        found: dict[str, functions.Function] = {}
        changes = without_functions(changes, "", found)
        changes |= self._tabulated(found)
        of_materials = {key: value for key, value in changes.items() if key.split(".")[0] in ("materials", "contacts")}
        later = {key: value for key, value in changes.items() if key not in of_materials}
        if later:
            self._core.change_stages(_changes(later), "")
        if of_materials:
            self._core.change_materials(_changes(of_materials))
        return self._renewed()

    def drive(self, to: str, /, *, hold: Sequence[str] | None = None, release: Sequence[str] | None = None,
              velocity: str | Quantity | None = None, force: str | Quantity | None = None,
              pressure: str | Quantity | None = None, direction: str | Sequence[float] | None = None,
              follower: bool | None = None) -> Run:
        """Holds, moves or loads a set of gridpoints from now on, by the keys of a drive in a deck:

            run.drive("left", hold=["x", "y"])          # where they are
            run.drive("left", release=["x"])
            run.drive("load_pivot", velocity="-0.3 mm/s", direction="y")
            run.drive("right", force="10 kN", direction=[1, 0])
            run.drive("right", pressure="2 MPa", follower=True)

        It lasts until another drive changes it. Returns the run, which is then no longer that of its deck, as with
        `change`; `then("drive", ...)` does the same as a stage, with ramps, and leaves it that of its deck.

        Raises DeckError for what is wrong with the keys; Error for a set that is not there, where the run has not
        begun, the press works the set, the drive contradicts a support or the stage under way, or the body could fly
        away. The run is then as it was.
        """
        keys = {"set": to, "hold": hold, "release": release, "velocity": velocity, "force": force,
                "pressure": pressure, "direction": direction, "follower": follower}
        self._core.drive(table_text("drives", {key: value for key, value in keys.items() if value is not None}, True))
        return self

    def end_stage(self) -> Run:
        """Ends the stage that is under way at the last sample; the next one begins there. Returns the run.

        The run is then no longer that of its deck, as with `change`.
        """
        self._core.end_stage()
        return self

    def set_temperature(self, temperature: float | str | Quantity) -> Run:
        """Sets another temperature of the whole specimen at once ("300 degC"; a number: degC); the body comes to rest
        in what follows. Returns the run, which is then no longer that of its deck, as with `change`.

        Raises Error where the temperatures are a computed field, or properties are not known at this one.
        """
        self._core.set_temperature(in_si(temperature, "degC"))
        return self

    def checkpoint(self) -> None:
        """Writes a checkpoint into the folder now. Raises Error without a folder."""
        self._core.write_checkpoint()

    def _renewed(self) -> Run:
        self._columns = ColumnNames(self._core.columns, _core.si_factor)
        return self

    # What came of it

    @property
    def history(self) -> History:
        """All rows so far."""
        return History(self._columns, self._core.history())

    @property
    def summary(self) -> dict[str, Any]:
        """Contents of summary.json for the rows so far, in the units of the names."""
        summary: dict[str, Any] = json.loads(self._core.summary())
        return summary

    @property
    def stages(self) -> list[dict[str, Any]]:
        """Summary of each stage, in order: `kind`, `outcome`, `results`, `warnings`."""
        stages: list[dict[str, Any]] = self.summary["stages"]
        return stages

    @property
    def results(self) -> dict[str, Any]:
        """Results of stages so far, in the units of their names ("f_c_MPa"); where two have one, that of the later."""
        return {name: value for stage in self.stages for name, value in stage["results"].items()}

    @property
    def outcome(self) -> str:
        """Outcome: how the run ended, or that it is running."""
        return self._core.outcome

    @property
    def is_over(self) -> bool:
        """Whether all stages are done, or one ended the run; not where it was stopped."""
        return self._core.is_over

    @property
    def stage(self) -> int:
        """Number of the stage of the last sample, from 0."""
        return self._core.stage

    @property
    def step(self) -> int:
        """Steps of the mechanics so far; 0 where nothing moves."""
        return self._core.step

    @property
    def title(self) -> str:
        """Title of the deck."""
        return self._core.title

    @property
    def seed(self) -> int:
        """Seed of the specimen; 0 where its blocks come from a file."""
        return self._core.seed

    @property
    def deck_text(self) -> str:
        """The deck as it stands, with what was changed since."""
        return self._core.deck_text

    @property
    def deck(self) -> dict[str, Any]:
        """The same as tables."""
        return tomllib.loads(self.deck_text)

    @property
    def warnings(self) -> list[str]:
        """Warnings of deck and choices, a line each."""
        return self._core.warnings

    @property
    def moves(self) -> bool:
        """Whether there are mechanics; else the run is of heat conduction alone."""
        return self._core.moves

    @property
    def thickness(self) -> float:
        """Thickness out of plane, m."""
        return self._core.thickness

    @property
    def folder(self) -> Path | None:
        """Folder of the results; None where nothing is written."""
        return Path(self._core.folder) if self._core.folder else None

    @property
    def threads(self) -> int:
        """Largest number of threads that the run takes its steps with, never more than processors are free; may be set
        at a look.
        """
        return self._core.threads

    @threads.setter
    def threads(self, threads: int) -> None:
        self._core.threads = threads

    # Arrays

    @property
    def specimen(self) -> Specimen:
        """Specimen of the run, without bearings. Raises Error where the run took its body from a folder."""
        return Specimen(self._core.specimen)

    @property
    def sets(self) -> Sets:
        """Sets of gridpoints: `specimen`, phases, sides, those of bearings and slits, and the deck's own."""
        return Sets(self._core, False)

    @property
    def contact_sets(self) -> Sets:
        """Sets of contact points, as rows of `contacts()`: slits, and the deck's own."""
        return Sets(self._core, True)

    @property
    def views(self) -> Views:
        """Arrays without a copy."""
        return Views(self._core)

    @property
    def slot(self) -> Indices:
        """Place (gridpoints,) of each gridpoint in `views`."""
        return self._core.copied("slot")

    @property
    def position(self) -> Array:
        """Position (gridpoints, dimension), m, when the body was made."""
        return self._core.copied("position")

    @property
    def zones(self) -> Indices:
        """Gridpoints (zones, 3) of each zone, counter-clockwise."""
        return self._core.copied("zones")

    @property
    def zone_block(self) -> Indices:
        """Block (zones,) of each zone."""
        return self._core.copied("zone_block")

    @property
    def block_material(self) -> Indices:
        """Material (blocks,) of each block, as indices into `material_names`."""
        return self._core.copied("block_material")

    @property
    def material_names(self) -> list[str]:
        """Names of the phases, and behind them of the materials of platens and other bearings."""
        return self._core.material_names

    @property
    def fields(self) -> Fields:
        """Fields of gridpoints and zones now."""
        return Fields(self._core)

    def contacts(self) -> pandas.DataFrame:
        """Returns the state of all contact points, a row each: `interface` and `law` (names), `x_m` and `y_m`, the
        number of the `face`, `area_m2`, `normal_x` and `normal_y`, of a solid also `z_m` and `normal_z`, and fields of
        contacts that are numbers (docs/lookup/fields.md): `opening_m`, what their laws remember (`closure_m`), what
        they lost (`lost_tension_J_m2`), ...
        """
        columns = {**self._core.contact_points(), **_of_item(self._core, "contact", components=1)}
        table: pandas.DataFrame = library("pandas", "contacts").DataFrame(columns)
        return table.astype({"face": int})

    def found_contacts(self) -> pandas.DataFrame:
        """Returns the contacts that are found and press now (docs/understand/found.md), a row for each contact point
        of a pair of facets: `interface` (name), `block_a` and `block_b`, the number of the `face` whose sides press
        each other after it broke, else -1, its place `x_m` to `z_m`, `normal_x` to `normal_z` from a to b,
        `force_x_N` to `force_z_N` on a, and their fields that are numbers (docs/lookup/fields.md): `area_m2`,
        `opening_m`, ...
        """
        table: pandas.DataFrame = library("pandas", "found_contacts").DataFrame(self._core.found_points())
        return table

    def to_pandas(self) -> pandas.DataFrame:
        """Returns the history as a DataFrame, with the units of its columns in `attrs["units"]`."""
        return self.history.to_pandas()

    def to_meshio(self) -> meshio.Mesh:
        """Returns the body now as a mesh of triangles in space, z = 0, or of tetrahedra, in m, with its fields
        (`displacement_m`, `stress_Pa`, ...), and `block` and `material` of zones. `field_data` has the names of the
        materials: their number and the dimension of their zones, as meshes of gmsh do.
        """
        block = self.zone_block
        points = {name: _in_space(values) if values.ndim > 1 else values
                  for name, values in self._core.fields("gridpoint", []).items()}
        cells: dict[str, Any] = {"block": block, "material": self.block_material[block], **self._core.fields("zone", [])}
        dimension = self.position.shape[1]
        names = {name: np.array([number, dimension]) for number, name in enumerate(self.material_names)}
        mesh: meshio.Mesh = library("meshio", "to_meshio").Mesh(
            _in_space(self.position), [("triangle" if dimension == 2 else "tetra", self.zones)], point_data=points,
            cell_data={name: [values] for name, values in cells.items()}, field_data=names)
        return mesh

    def __repr__(self) -> str:
        return f"<Run {self.title!r}: {self.outcome}, {self._core.rows} rows>"


def _of_item(core: _core.Session, item: str, components: int) -> dict[str, Array]:
    """Returns its fields of so many components, by name with unit."""
    names = [bare for _, bare, _, of, count, _ in core.field_infos() if of == item and count == components]
    return core.fields(item, names) if names else {}


def _in_space(vectors: Array) -> Array:
    """Returns (n, 3), as most formats of meshes want them."""
    return np.column_stack([vectors, np.zeros(len(vectors))]) if vectors.shape[1] == 2 else vectors


def _changes(changes: Mapping[str, Value] | None) -> list[str]:
    return [f"{key}={toml(value)}" for key, value in (changes or {}).items()]
