"""Results of runs, read from their folders, and specimens from theirs. The compiled part is not needed.

SI units, temperature in °C, stress in MPa where it says so. Strain and stress of the test are positive in compression;
only `Heated.total_strain` is positive in expansion.
"""

from __future__ import annotations

import sys
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Error
from ..libraries import library
from ..writing import shell_path
from .files import MESH, GrowingTable, Lock, Table, Writer, is_number, read_array, read_json
from .frames import Frame, frames_of
from .mesh import Mesh, read_mesh
from .reference import References, read_references
from .run_facts import PROBE, RunFacts

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # the tarball brings it along

if TYPE_CHECKING:
    import pandas
    import xarray


def read(folder: str | Path) -> Results:
    """Returns the results of a run, from its folder: one that is over, is under way or broke off.

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
    """Reads the results of a run that may go on: the end first and the history last, so that it has the row of each
    frame, and all that a summary tells.
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
    """Returns whether a folder is that of a run."""
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
        """Returns the history as a DataFrame, with the units of its columns in `attrs["units"]`."""
        return self.history.to_pandas()

    @cached_property
    def facts(self) -> RunFacts:
        """run.json: what the run is, and what each of its columns and results is."""
        return RunFacts(self.folder / "run.json")

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
        """The deck as tables."""
        try:
            return tomllib.loads(self.deck_text)
        except (ValueError, RecursionError) as error:
            path = self.folder / "deck.toml"
            raise Error(f"{path}: cannot be read: {' '.join(str(error).split())}") from error

    @property
    def deck_stages(self) -> list[dict]:
        """Table of each stage in the deck; empty without a deck."""
        stages = self.deck.get("stages")
        return [s if isinstance(s, dict) else {} for s in stages] if isinstance(stages, list) else []

    @cached_property
    def references(self) -> References:
        """References that the deck of the run asks figures to draw beside the results."""
        return read_references(self.folder / "references.json")

    @property
    def title(self) -> str:
        """Title as the summary has it, else the deck, else the folder's name."""
        return str(self.summary.get("title") or self.deck.get("title") or self.folder.resolve().name)

    @property
    def outcome(self) -> str:
        """Outcome: how the run ended; of one without a summary that it is running, or how it broke off."""
        writer, has_summary = self._end
        if has_summary:
            return str(self.summary.get("outcome", "over"))
        return {Writer.THERE: "running", Writer.DIED: "killed", Writer.NONE: "broken off"}[writer]

    @property
    def _end(self) -> tuple[Writer, bool]:
        """Writer of the folder, and whether it has a summary: asked in this order, as a run leaves its folder behind
        its summary.
        """
        return self._known_end or (Lock(self.folder).writer, (self.folder / "summary.json").exists())

    @property
    def warnings(self) -> list[str]:
        """Warnings of deck and choices, a line each."""
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
        """Summary of each stage, in order: `kind`, `outcome`, `results`, `warnings`."""
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

    @property
    def moves(self) -> bool:
        """Whether there are mechanics; else the run is of heat conduction alone."""
        return self.facts.moves

    @property
    def has_platens(self) -> bool:
        """Whether the body stood between platens, so that the test has a stress and a strain."""
        return self.facts.has_press

    @property
    def probes(self) -> dict[str, np.ndarray]:
        """Temperatures [°C] at the run's probes, (rows,) by name."""
        return {column.of: self.history[column.name] for column in self.facts.of_role(PROBE)}

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

    @cached_property
    def mesh(self) -> Mesh:
        """mesh.h5: the zones of all blocks and the contact points, where they were made."""
        return read_mesh(self.folder / "fields" / MESH)

    def gridpoint_displacement(self, frame: Frame) -> np.ndarray:
        """Returns the displacement (N, dimension), m."""
        blocks = self.mesh.blocks
        return self._field("blocks", frame, "PointData/displacement [m]", (len(blocks.points), 3))[:, :blocks.dimension]

    def gridpoint_temperature(self, frame: Frame) -> np.ndarray:
        """Returns the temperature (N,), °C."""
        return self._field("blocks", frame, "PointData/temperature [degC]", (len(self.mesh.blocks.points),))

    def contact_displacement(self, frame: Frame) -> np.ndarray:
        """Returns the displacement of the points of the contact mesh, m."""
        points = self.mesh.contacts.points
        return self._field("contacts", frame, "PointData/displacement [m]", (len(points), 3))[:, :points.shape[1]]

    def contact_field(self, frame: Frame, name: str) -> np.ndarray:
        """Returns a field (C,) of contacts, by its name with unit, such as "tension_damage [1]" or "opening [m]"."""
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


def results_with(run: Results, name: str) -> list[dict]:
    """Returns results of the stages of a run that have one of this name."""
    return [results for results in run.stage_results if results.get(name) is not None]


def number_of(run: Results, results: dict, name: str) -> float | None:
    """Returns a number among results of stages of a run; None without one."""
    value = results.get(name)
    if value is not None and not is_number(value):
        raise Error(f"{run.folder / 'summary.json'}: '{name}' is neither a finite number nor null")
    return None if value is None else float(value)


class GrowingResults(Results):
    """A run that another process still writes: what is there by now, rows that are whole. `refresh` takes in more."""

    _table = GrowingTable
    _LASTING = frozenset({"folder", "facts", "history", "mesh", "deck_text", "deck", "references", "parent"})

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
        """Returns a number of specimen.json. Raises Error where there is none of that name."""
        value = self.facts.get(name)
        if not is_number(value):
            raise Error(f"{self._tables / 'specimen.json'}: '{name}' is missing or not a finite number")
        return value

    @property
    def shares(self) -> dict[str, float]:
        """Share of the area, of a solid of the volume, by material; a sum of blocks may round to more than 1."""
        shares = self.facts.get("fraction")
        if not isinstance(shares, dict) or not all(isinstance(v, (int, float)) and 0.0 <= v <= 1.0 + 1e-9
                                                   for v in shares.values()):
            raise Error(f"{self._tables / 'specimen.json'}: 'fraction' is missing or no table of shares")
        return shares

    @cached_property
    def aggregates(self) -> Table:
        """Placed circles: x_m, y_m, diameter_m; of a solid the balls, with z_m."""
        return Table(self._tables / "aggregates.csv", may_be_empty=True)

    @cached_property
    def outlines(self) -> list[NDArray[np.float64]]:
        """Outlines of stones that are not round, each (n, 2) in m; empty where all are circles."""
        file = self._tables / "outlines.csv"
        if not file.exists():
            return []
        table = Table(file)
        begins = np.flatnonzero(np.diff(table["grain"], prepend=-1.0))
        return np.split(np.column_stack([table["x_m"], table["y_m"]]), begins[1:])

    @cached_property
    def gradation(self) -> Table:
        """Columns d_m, asked_percent, placed_percent."""
        return Table(self._tables / "gradation.csv")

    @cached_property
    def mesh(self) -> Mesh:
        """mesh.h5: the zones of all blocks and the contact points."""
        return read_mesh(self.folder / "fields" / MESH)
