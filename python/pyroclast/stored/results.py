"""Results of runs, read from their folders, and specimens from theirs. The compiled part is not needed.

SI units, temperature in °C, stress in MPa where it says so. Strain and stress of the test are positive in compression;
only `Results.total_strain` is positive in expansion.
"""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Error
from ..libraries import library
from ..writing import shell_path
from .files import LARGEST, MESH, GrowingTable, Lock, Table, Writer, read_array, read_json
from .frames import Frame, frames_of
from .mesh import Mesh, read_mesh
from .reference import References, read_references

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # the tarball brings it along

if TYPE_CHECKING:
    import pandas
    import xarray

_UNIFORM = 1.0  # K


def read(folder: str | Path) -> Results:
    """The results of a run, from its folder: one that is over, is under way or broke off.

    Raises Error where the folder holds no run, and says what it holds.
    """
    place = Path(folder)
    if is_of_run(place):
        return Results(place)
    if not place.is_dir():
        raise Error(f"{place}: is not a folder")
    if runs := runs_in(place):
        raise Error(f"{place}: holds no run, but folders of runs: {runs[0].relative_to(place)}"
                    + (f" and {len(runs) - 1} more" if len(runs) > 1 else "")
                    + f"; name one of them, or list all by `pyroclast report {shell_path(place)}`")
    if Lock(place).writer is Writer.THERE:
        raise Error(f"{place}: the run in it has only begun: there is no history yet")
    if any((place / name).exists() for name in ("specimen/specimen.json", "specimen.json")):
        raise Error(f"{place}: holds a specimen and no run; pyroclast.SpecimenFolder reads it")
    raise Error(f"{place}: holds no run: there is neither history.csv nor summary.json")


def read_at_once(folder: str | Path) -> Results:
    """The same of a run that may go on: the end is read first and the history last, so that it has the row of each frame,
    and all that a summary tells.
    """
    run = read(folder)
    run._known_end = run._end
    run.summary, run._frames, run.history  # noqa: B018 - they keep what they read
    return run


def runs_in(folder: Path) -> list[Path]:
    """Returns folders of runs in a folder, and of those of a study or of seeds in it (`runs`), by name."""
    return sorted({path.parent for name in ("history.csv", "summary.json") for within in ("*", "runs/*")
                   for path in folder.glob(f"{within}/{name}")})


def is_of_run(folder: Path) -> bool:
    """Whether a folder is that of a run."""
    return any((folder / name).exists() for name in ("history.csv", "summary.json"))


class Results:
    """What came of a run, as its folder has it: `pyroclast.read` gives it.

        results = pyroclast.read("runs/compression")
        print(results.outcome, results.results["f_c_MPa"])
        results.history.to_pandas().plot("strain", "stress_MPa")

    Names are those of `pyroclast.Run`. Files are read when first asked for; what is missing or malformed raises Error,
    which names the file.
    """

    _table = Table
    _known_end: tuple[Writer, bool] | None = None

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise Error(f"{self.folder}: is not a folder")

    @cached_property
    def history(self) -> Table:
        """history.csv: all rows, a read-only array (rows,) for each column; NaN where a cell is empty.

        Under the program's name ("stress_MPa") a column is in the unit of its name; without it ("stress") in SI.
        """
        table = self._table(self.folder / "history.csv")
        table.whole("stage")
        return table

    def to_pandas(self) -> pandas.DataFrame:
        """The history as a DataFrame, with the units of its columns in `attrs["units"]`."""
        return self.history.to_pandas()

    @cached_property
    def crack_modes(self) -> dict[str, list[str]]:
        """Interfaces that can break, by the mode of their damage: "tension", "shear" or "mixed"."""
        modes: dict[str, list[str]] = {}
        for column in self.history.names:
            if match := re.fullmatch(r"(tension|shear|mixed)_(.+)_broken", column):
                modes.setdefault(match[1], []).append(match[2])
        return modes

    @cached_property
    def summary(self) -> dict:
        """summary.json; of a run that was killed and has none, one without results."""
        return read_json(self.folder / "summary.json") if self._end[1] else {"stages": []}

    @cached_property
    def manifest(self) -> dict:
        """manifest.json: the command, versions and files that the run was made of; empty without one."""
        path = self.folder / "manifest.json"
        return read_json(path) if path.exists() else {}

    @cached_property
    def parent(self) -> Results | None:
        """The run that this one is a fork of; None without one, or when its folder is gone."""
        parent = self.manifest.get("parent")
        if parent is None:
            return None
        folder = parent.get("folder") if isinstance(parent, dict) else None
        if not isinstance(folder, str) or "\0" in folder:
            raise Error(f"{self.folder / 'manifest.json'}: 'parent' has no 'folder' that is a path")
        return Results(folder) if (Path(folder) / "history.csv").exists() else None

    @cached_property
    def deck_text(self) -> str:
        """The deck that the run keeps; empty without one."""
        path = self.folder / "deck.toml"
        try:
            return path.read_text(encoding="utf-8") if path.exists() else ""
        except (OSError, ValueError) as error:
            raise Error(f"{path}: cannot be read: {' '.join(str(error).split())}") from error

    @cached_property
    def deck(self) -> dict:
        """The same as tables."""
        try:
            return tomllib.loads(self.deck_text)
        except (ValueError, RecursionError) as error:
            path = self.folder / "deck.toml"
            raise Error(f"{path}: cannot be read: {' '.join(str(error).split())}") from error

    @property
    def deck_stages(self) -> list[dict]:
        """What the deck says of each stage; empty without a deck."""
        stages = self.deck.get("stages")
        return [s if isinstance(s, dict) else {} for s in stages] if isinstance(stages, list) else []

    @cached_property
    def references(self) -> References:
        """What the deck of the run asks figures to draw beside the results."""
        return read_references(self.folder / "references.json")

    @property
    def title(self) -> str:
        """As the summary has it, else the deck, else the folder's name."""
        return str(self.summary.get("title") or self.deck.get("title") or self.folder.resolve().name)

    @property
    def outcome(self) -> str:
        """How the run ended; of one without a summary that it is running, or how it broke off."""
        writer, has_summary = self._end
        if has_summary:
            return str(self.summary.get("outcome", "over"))
        return {Writer.THERE: "running", Writer.DIED: "killed", Writer.NONE: "broken off"}[writer]

    @property
    def _end(self) -> tuple[Writer, bool]:
        """Who writes into the folder, and whether it has a summary: asked in this order, as a run leaves its folder
        behind its summary."""
        return self._known_end or (Lock(self.folder).writer, (self.folder / "summary.json").exists())

    @property
    def warnings(self) -> list[str]:
        """Of deck and choices, a line each."""
        told = self.summary.get("warnings", [])
        if not isinstance(told, list) or not all(isinstance(line, str) for line in told):
            raise Error(f"{self.folder / 'summary.json'}: 'warnings' is no list of texts")
        return told

    @property
    def results(self) -> dict[str, Any]:
        """Results of all stages, in the units of their names ("f_c_MPa"); where two have one, that of the later. None
        where a stage has no such value; empty of a run without a summary.
        """
        return {name: value for results in self.stage_results for name, value in results.items()}

    @cached_property
    def stages(self) -> list[dict[str, Any]]:
        """What the summary says of each stage, in order: `kind`, `outcome`, `results`, `warnings`."""
        path = self.folder / "summary.json"
        stages = self.summary.get("stages")
        if not isinstance(stages, list):
            raise Error(f"{path}: 'stages' is missing or not a list")
        if not all(isinstance(stage, dict) and isinstance(stage.get("results", {}), dict) for stage in stages):
            raise Error(f"{path}: 'stages' holds something without 'results'")
        return stages

    @property
    def stage_results(self) -> list[dict]:
        """The results of each stage, in order."""
        return [stage.get("results", {}) for stage in self.stages]

    def _results_with(self, name: str) -> list[dict]:
        """Results of the stages that have one of this name."""
        return [results for results in self.stage_results if results.get(name) is not None]

    @property
    def compression(self) -> dict:
        """E_GPa, f_c_MPa, strain_at_peak, strain_ic, quasi_static of the last compression that has a modulus; empty
        without one.
        """
        tests = self._results_with("E_GPa")
        return tests[-1] if tests else {}

    @property
    def heating(self) -> dict:
        """load_stress_MPa, critical_temperature_degC, platen, exchanges, ... over all stages that exchange
        temperatures; empty when never heated.
        """
        stages = self._results_with("exchanges")
        if not stages:
            return {}
        merged = dict(stages[0])
        for name in ("exchanges", "exchanges_not_converged", "cycles"):
            merged[name] = sum(self._number(results, name) for results in stages if name in results)
        worst = [self._number(results, "worst_unbalanced_ratio") for results in stages
                 if results.get("worst_unbalanced_ratio") is not None]
        merged["worst_unbalanced_ratio"] = max(worst, default=None)
        failures = self._results_with("critical_temperature_degC")
        return merged | {"critical_temperature_degC": failures[0]["critical_temperature_degC"] if failures else None}

    def _heating_number(self, name: str) -> float | None:
        return self._number(self.heating, name)

    def _number(self, results: dict, name: str) -> float | None:
        value = results.get(name)
        if value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= LARGEST:
            raise Error(f"{self.folder / 'summary.json'}: '{name}' is neither a finite number nor null")
        return float(value)

    @property
    def load_stress_MPa(self) -> float | None:
        """Compressive stress kept while heated."""
        return self._heating_number("load_stress_MPa")

    @property
    def load_level(self) -> float | None:
        """`load_stress_MPa` over the strength at 20 °C; None when that strength is not known."""
        if not self.heating:
            return None
        first = next(i for i, results in enumerate(self.stage_results) if results.get("exchanges") is not None)
        loads = [results for results in self.stage_results[:first] if "load_level" in results]
        level = self._number(loads[-1], "load_level") if loads else None
        return 0.0 if level is None and self.load_stress_MPa == 0.0 else level

    @property
    def critical_temperature(self) -> float | None:
        """Temperature [°C] at which the specimen failed under its load; None when it did not."""
        return self._heating_number("critical_temperature_degC")

    @property
    def restrained(self) -> bool:
        """Whether the platens were held in place while the specimen was heated. Without a summary the deck tells it."""
        if self.heating:
            return self.heating.get("platen") == "fixed"
        heated = self.history["stage"][self.exchanged].astype(int)
        stages = self.deck_stages[heated[0]:] if len(heated) else []
        return bool(stages) and stages[0].get("platen") == "fixed"

    @property
    def quasi_static(self) -> bool | None:
        """The verdict of the last compression; None when there is none."""
        verdicts = self._results_with("quasi_static")
        return verdicts[-1]["quasi_static"] if verdicts else None

    @cached_property
    def exchanged(self) -> np.ndarray:
        """(rows,) bool: rows of the history written after an exchange of temperatures."""
        if "exchange" not in self.history.names:
            return np.zeros(self.history.rows, dtype=bool)
        return self.history["exchange"] > 0

    @cached_property
    def heated(self) -> np.ndarray:
        """(rows,) bool: `exchanged` and the row before, from which heating started; none if never heated."""
        rows = self.exchanged.copy()
        if rows.any():
            rows[max(int(rows.argmax()) - 1, 0)] = True
        return rows

    @property
    def ends_heated(self) -> bool:
        """Whether the last stage heats the body, so that the test is the heating and not what follows it."""
        stage = self.history["stage"]
        return bool(self.exchanged[stage == stage.max()].any())

    @property
    def moves(self) -> bool:
        """Whether there are mechanics; else the run is of heat conduction alone."""
        return "unbalanced_ratio" in self.history.names

    @property
    def has_platens(self) -> bool:
        """Whether the body stood between platens, so that the test has a stress and a strain."""
        return "strain" in self.history.names

    @property
    def probes(self) -> dict[str, np.ndarray]:
        """Temperatures [°C] at the run's probes, (rows,) by name."""
        return {match[1]: self.history[name] for name in self.history.names
                if (match := re.fullmatch(r"probe_(\w+)_degC", name))}

    def heated_history(self, name: str) -> np.ndarray:
        """A column of the history, rows of `heated` only."""
        return self.history[name][self.heated]

    @property
    def standing(self) -> np.ndarray:
        """(rows,) bool: rows of `heated`, without that of the exchange at which the specimen failed."""
        return self.heated & ~self._failing

    @property
    def _failing(self) -> np.ndarray:
        rows = np.zeros(self.history.rows, dtype=bool)
        if self.critical_temperature is not None:
            rows[np.flatnonzero(self.exchanged)[-1:]] = True
            rows &= self.history["converged"] == 0
        return rows

    @property
    def total_strain(self) -> np.ndarray:
        """Axial strain of the specimen's own ends over the rows of `heated`, positive in expansion, that of the
        load included. Platens without load may have left the ends.
        """
        return -self.heated_history("specimen_strain")

    def standing_strain(self, temperatures) -> np.ndarray:
        """Axial strain at temperatures [°C] while the specimen stood, as `total_strain`; nan above what it reached."""
        reached, strain = (self.history[name][self.standing] for name in ("temperature_degC", "specimen_strain"))
        temperatures = np.asarray(temperatures, dtype=float)
        if not len(reached):
            return np.full(temperatures.shape, np.nan)
        return np.where(temperatures > reached.max() + 1e-6, np.nan, -np.interp(temperatures, reached, strain))

    def total_strain_at(self, frame: Frame) -> float:
        """`total_strain` when the frame was saved."""
        row = int(np.searchsorted(self.history["step"], frame.step))
        if row == self.history.rows or self.history["step"][row] != frame.step:
            raise Error(f"{self.history.path}: has no row of step {frame.step}, at which a frame was saved")
        return -float(self.history["specimen_strain"][row])

    @property
    def uniform(self) -> bool:
        """Whether the specimen's temperatures never differed by more than 1 K."""
        spread = self.history["temperature_max_degC"] - self.history["temperature_min_degC"]
        return not (spread > _UNIFORM).any()  # a gap tells nothing

    @property
    def heats(self) -> bool:
        """Whether its temperatures are drawn over the time: they differ within the specimen, or stand beside a
        reference.
        """
        if not self.uniform:
            return True
        return "heat_stored_J" in self.history and any(t.over == "heating_time" for t in self.references.tables)

    @property
    def timed(self) -> bool:
        """Whether its heating is drawn over minutes: it is not uniform, or stands beside a reference over time."""
        return not self.uniform or any(self.references.of(of, "heating_time") for of in ("stress", "total_strain"))

    @property
    def unconverged(self) -> np.ndarray:
        """(rows,) bool: exchanges whose cycles did not reach equilibrium, without that of the failure."""
        if not self.exchanged.any():
            return self.exchanged
        return self.exchanged & (self.history["converged"] == 0) & ~self._failing

    @cached_property
    def loaded(self) -> np.ndarray:
        """(rows,) bool: rows of the last stage in which the body moves, the test itself."""
        stage, is_there = self.history["stage"], np.isfinite(self.history["stress_MPa"])
        self.history.known("stress_MPa")
        return (stage == stage[is_there].max()) & is_there

    @property
    def loaded_before(self) -> np.ndarray:
        """(rows,) bool: rows of the stages that moved the platen before `loaded`, since heat last changed the body."""
        stages = [number for number, stage in enumerate(self.deck_stages) if stage.get("kind") == "compress"]
        row = np.arange(len(self.loaded))
        heated = row[self.exchanged]
        since = heated[-1] + 1 if heated.size else 0
        return np.isin(self.history["stage"], stages) & (since <= row) & (row < int(self.loaded.argmax()))

    def loaded_history(self, name: str) -> np.ndarray:
        """A column of the history, rows of `loaded` only."""
        return self.history[name][self.loaded]

    @property
    def strain_before(self) -> float:
        """Strain from which the last stage's is counted: that before it, if heat left one, else zero."""
        first = int(self.loaded.argmax())
        if not self.exchanged[:first].any():
            return 0.0
        return float(self.history.known("strain", slice(first))[-1])

    @property
    def loaded_strain(self) -> np.ndarray:
        """Strain over the rows of `loaded`, less `strain_before`."""
        return self.loaded_history("strain") - self.strain_before

    def _tested(self, name: str) -> float | None:
        """A number among the results of the stage of `loaded`."""
        stage = int(self.loaded_history("stage")[0])
        return self._number(self.stage_results[stage], name) if stage < len(self.stage_results) else None

    @property
    def has_peak(self) -> bool:
        """Whether the test has an f_c."""
        return self._tested("f_c_MPa") is not None

    @property
    def rise_again(self) -> float:
        """How far the stress rises above f_c behind it, over f_c; 0 where it does not, or there is no f_c."""
        strength, largest = self._tested("f_c_MPa"), self._tested("stress_max_MPa")
        return max(0.0, largest / strength - 1.0) if strength and largest else 0.0

    @property
    def peak(self) -> tuple[float, float]:
        """`loaded_strain` and stress [MPa] at f_c of the test, as the summary has it. Where that has none,
        those where the history's stress is largest, even if it ended there.

        Raises Error when the specimen was never compressed.
        """
        strength, at = self._tested("f_c_MPa"), self._tested("strain_at_peak")
        if strength is not None and at is not None:
            before = 0.0
            if "stage_strain" in self.history:
                before = float(self.loaded_strain[0] - self.loaded_history("stage_strain")[0])
            return at + before, strength
        strain, stress = self.loaded_strain, self.loaded_history("stress_MPa")
        self.history.known("strain", self.loaded)
        row = int(np.where(np.isfinite(strain), stress, -np.inf).argmax())
        if stress[row] <= 0.0:
            path = self.history.path
            raise Error(f"{path}: column 'stress_MPa' is never positive; the specimen was not compressed")
        return float(strain[row]), float(stress[row])

    @property
    def strength_retained(self) -> float | None:
        """Largest stress after heating over the strength before; None when the summary does not tell that."""
        if self.ends_heated or not self.load_level or not self.load_stress_MPa:
            return None
        return self.peak[1] * self.load_level / self.load_stress_MPa

    @property
    def has_fields(self) -> bool:
        """Whether the run keeps fields; its deck may say that it keeps none."""
        return (self.folder / "fields").exists()

    @cached_property
    def frames(self) -> list[Frame]:
        """Saved states of all stages, in order; none when the run saved no fields."""
        return frames_of(self._frames, self.moves) if self._frames is not None else []

    @cached_property
    def _frames(self) -> Table | None:
        path = self.folder / "fields" / "frames.csv"
        return self._table(path, may_be_empty=True) if path.exists() else None

    @property
    def loaded_frames(self) -> list[Frame]:
        """Frames of the history's last stage, their strain less `strain_before`; not those of unknown strain or
        stress.
        """
        last, before = self.history["stage"][self.loaded].max(), self.strain_before
        return [replace(frame, strain=frame.strain - before) for frame in self.frames
                if frame.stage == last and np.isfinite([frame.strain, frame.stress_MPa]).all()]

    @property
    def heated_frames(self) -> list[Frame]:
        """Frames of all stages that heat, not those of unknown temperature; raises Error when there is none."""
        path = self.folder / "fields" / "frames.csv"
        frames = self.frames
        if self.moves:
            stages = set(self.history["stage"][self.exchanged])
            frames = [frame for frame in frames if frame.stage in stages]
        if not frames:
            raise Error(f"{path}: no frame of a heating stage")
        if frames[0].temperature is None:
            raise Error(f"{path}: has no column 'temperature_degC'")
        frames = [frame for frame in frames if np.isfinite(frame.temperature)]
        if not frames:
            raise Error(f"{path}: column 'temperature_degC' has no finite value")
        return frames

    @cached_property
    def mesh(self) -> Mesh:
        """mesh.h5: the zones of all blocks and the contact points, where they were made."""
        return read_mesh(self.folder / "fields" / MESH)

    def gridpoint_displacement(self, frame: Frame) -> np.ndarray:
        """(N, dimension), m."""
        blocks = self.mesh.blocks
        return self._field("blocks", frame, "PointData/displacement [m]", (len(blocks.points), 3))[:, :blocks.dimension]

    def gridpoint_temperature(self, frame: Frame) -> np.ndarray:
        """(N,), °C."""
        return self._field("blocks", frame, "PointData/temperature [degC]", (len(self.mesh.blocks.points),))

    def contact_displacement(self, frame: Frame) -> np.ndarray:
        """Of the points of the contact mesh, m."""
        points = self.mesh.contacts.points
        return self._field("contacts", frame, "PointData/displacement [m]", (len(points), 3))[:, :points.shape[1]]

    def contact_field(self, frame: Frame, name: str) -> np.ndarray:
        """(C,), by its name with unit, for instance "tension_damage [1]" or "opening [m]"."""
        return self._field("contacts", frame, f"CellData/{name}", (len(self.mesh.contacts.cells),))

    def _field(self, kind: str, frame: Frame, name: str, shape: tuple[int, ...]) -> np.ndarray:
        return read_array(self.folder / "fields" / f"{kind}_{frame.number:04d}.hdf", f"VTKHDF/{name}", shape)

    @cached_property
    def fields(self) -> xarray.Dataset:
        """The fields of all frames: an array for each in the files (docs/lookup/fields.md), by its name without unit,
        which stands in its `attrs["units"]`. Stress and strain are positive in tension.

        A frame is read when values of it are asked for, and nothing is kept: `fields["stress"].isel(frame=-1)` takes
        the memory of a frame. `fields.load()` reads all of them, which takes `fields.nbytes`.

        Dimensions are `frame` and `gridpoint`, `zone` or `contact`; of vectors `component` (x, y, of a solid z), of
        tensors `tensor` (xx, yy, zz, xy, yz, xz). Displacements of contacts have the `end` of their cells too:
        `corner`, `middle`, and of a solid the middles of the edges beside, `edge_after` and `edge_before`. Fields of
        contacts that blocks have too begin with `contact_`. Where a stage has no such field, it is NaN.

        Coordinates of frames: `stage`, `step`, `time` and `heating_time` [s], `test_strain` and `test_stress` [Pa],
        positive in compression, and `mean_temperature` [degC]. Of gridpoints: `position` [m]. Of zones: `zones` (their
        gridpoints), `block`, `material`, `bearing` (whether they are of one), `area` [m²], of a solid `volume` [m³]. Of
        contacts: `contact_position` [m], `interface`, `length` [m], of a solid `contact_area` [m²].

        Raises Error where the run keeps no frames, or xarray is not installed.
        """
        library("xarray", "Results.fields")
        from .fields import fields_of
        return fields_of(self.folder, self.mesh, self.frames, self.moves).assign_attrs(title=self.title)

    @cached_property
    def block_fields(self) -> xarray.Dataset:
        """The fields of blocks, each the mean over a block's zones by area, of a solid by volume. Dimensions are
        `frame`, `block`, and `component` or `tensor`.

        Coordinates of frames as of `fields`. Of blocks: `material`, `bearing`, `area` [m²] or `volume` [m³],
        `position` [m] of the centre. It is read as `fields` are, a frame at a time.
        """
        library("xarray", "Results.block_fields")
        from .fields import block_fields_of
        return block_fields_of(self.folder, self.mesh, self.frames, self.moves).assign_attrs(title=self.title)

    def __repr__(self) -> str:
        return f"<Results of {self.folder}>"


class GrowingResults(Results):
    """A run that another process still writes: what is there by now, rows that are whole. `refresh` takes in more."""

    _table = GrowingTable
    _LASTING = frozenset({"folder", "history", "mesh", "deck_text", "deck", "references", "parent"})

    def refresh(self) -> bool:
        """Takes in what was written since; returns whether the rows that were there are others or have become more."""
        history = self.__dict__.get("history")
        begun_anew = history is not None and history.is_replaced
        lasting = {"folder"} if begun_anew else self._LASTING
        for name in self.__dict__.keys() - lasting:
            del self.__dict__[name]
        return begun_anew or (history is not None and history.grow())


class SpecimenFolder:
    """One specimen folder, or a run folder, whose specimen/ subfolder is then read."""

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise Error(f"{self.folder}: is not a folder")
        inner = self.folder / "specimen"
        self._tables = inner if inner.is_dir() else self.folder

    @cached_property
    def facts(self) -> dict:
        """specimen.json."""
        return read_json(self._tables / "specimen.json")

    def fact(self, name: str) -> float:
        """A number of specimen.json. Raises Error where there is none of that name."""
        value = self.facts.get(name)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= LARGEST:
            raise Error(f"{self._tables / 'specimen.json'}: '{name}' is missing or not a finite number")
        return value

    @property
    def shares(self) -> dict[str, float]:
        """Of the area, of a solid of the volume, by material."""
        shares = self.facts.get("fraction")
        if not isinstance(shares, dict) or not all(isinstance(v, (int, float)) and 0.0 <= v <= 1.0
                                                   for v in shares.values()):
            raise Error(f"{self._tables / 'specimen.json'}: 'fraction' is missing or no table of shares")
        return shares

    @cached_property
    def aggregates(self) -> Table:
        """Placed circles: x_m, y_m, diameter_m; of a solid the balls, with z_m."""
        return Table(self._tables / "aggregates.csv", may_be_empty=True)

    @cached_property
    def outlines(self) -> list[NDArray[np.float64]]:
        """Outlines of grains that are not round, each (n, 2) in m; empty where all are circles."""
        file = self._tables / "outlines.csv"
        if not file.exists():
            return []
        table = Table(file)
        begins = np.flatnonzero(np.diff(table["grain"], prepend=-1.0))
        return np.split(np.column_stack([table["x_m"], table["y_m"]]), begins[1:])

    @cached_property
    def gradation(self) -> Table:
        """d_m, asked_percent, placed_percent."""
        return Table(self._tables / "gradation.csv")

    @cached_property
    def mesh(self) -> Mesh:
        """mesh.h5: the zones of all blocks and the contact points."""
        return read_mesh(self.folder / "fields" / MESH)
