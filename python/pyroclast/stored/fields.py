"""Fields of all frames of a run as an xarray.Dataset, read from the files when their values are asked for."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import prod
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray
from numpy.typing import NDArray
from xarray.backends import BackendArray
from xarray.core import indexing

from ..errors import Error
from .files import open_hdf, read_array, within
from .frames import Frame
from .mesh import Mesh

_NAME = re.compile(r"(.+) \[(.+)\]")  # of an array in a file
_COMPONENTS = {3: ("component", ["x", "y", "z"]), 6: ("tensor", ["xx", "yy", "zz", "xy", "yz", "xz"])}
"""A dimension and its labels, by the length of an array's rows."""
_ENDS = {2: ["corner", "middle"], 4: ["corner", "edge_after", "middle", "edge_before"]}
"""Names of the corners of a contact's cell, by their number."""
_OF_CONTACTS = "contact_"  # before the names of contacts' fields that blocks have too
_PA = 1e6  # from MPa

Array = NDArray[Any]
Variable = tuple[tuple[str, ...], Any, dict[str, str]]
"""Dimensions, values and attributes."""


@dataclass(frozen=True)
class _Field:
    """An array that each frame has in a file of its own."""

    part: str  #: of the mesh: "blocks" or "contacts"
    path: str  #: in the file
    shape: tuple[int, ...]  #: in the file
    dtype: np.dtype[Any]
    is_optional: bool  #: some frames may be without it, where it is NaN
    dimension: int  #: of the body; the third component of a vector in the plane is zero and left out

    @property
    def name(self) -> str:
        return _NAME.sub(r"\1", self.path.split("/")[-1])

    @property
    def unit(self) -> str:
        return _NAME.sub(r"\2", self.path.split("/")[-1])

    @property
    def on(self) -> str:
        """Kind of item that the rows are of."""
        if self.part == "contacts":
            return "end" if "PointData" in self.path else "contact"
        return "gridpoint" if "PointData" in self.path else "zone"

    @property
    def components(self) -> dict[str, int]:
        """The dimension along a row with its size, where it is one."""
        return {name: len(labels) for name, labels in (_labels(n, self.dimension) for n in self.shape[1:])}

    def read(self, folder: Path, frame: int) -> Array:
        """Returns (rows, components) of a frame."""
        path = folder / f"{self.part}_{frame:04d}.hdf"
        if self.is_optional and not _has(path, self.path):
            values: Array = np.full(self.shape, np.nan, self.dtype)
        else:
            values = read_array(path, self.path, self.shape)
        return values if len(self.shape) == 1 else values[:, :len(_labels(self.shape[1], self.dimension)[1])]


def _labels(length: int, dimension: int) -> tuple[str, list[str]]:
    """Returns those of `_COMPONENTS` that a body has."""
    name, labels = _COMPONENTS[length]
    return name, labels[:dimension] if name == "component" else labels


class _OfFrames(BackendArray):  # type: ignore[misc]
    """An array (frames, ...) of which a frame is read when values of it are asked for, and nothing is kept."""

    def __init__(self, read: Callable[[int], Array], frames: list[int], shape: tuple[int, ...], dtype: np.dtype[Any]):
        """Takes a reader of frames. shape: of one frame."""
        self._read, self._frames = read, np.array(frames)
        self.shape, self.dtype = (len(frames), *shape), dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        if isinstance(key, indexing.VectorizedIndexer):
            return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.OUTER, self._taken)
        return self._taken(key.tuple)  # the adapter of xarray 2023.01 takes slices with negative steps for others

    def _taken(self, key: tuple[Any, ...]) -> Array:
        frames, within = self._frames[key[0]], key[1:]
        if frames.ndim == 0:
            return np.asarray(_part(self._read(int(frames)), within))
        like = _part(np.broadcast_to(self.dtype.type(0), self.shape[1:]), within)
        values = np.empty((len(frames), *like.shape), self.dtype)
        for place, frame in zip(values, frames):
            place[...] = _part(self._read(int(frame)), within)
        return values


def fields_of(run: Path, mesh: Mesh, frames: list[Frame], moves: bool) -> xarray.Dataset:
    """Returns `Results.fields` of a run's folder. moves: whether the run has mechanics."""
    fields, sizes = _listed(run, mesh, frames, moves), _sizes(mesh)

    def read(field: _Field, frame: int) -> Array:
        values = field.read(run / "fields", frame)
        if field.on == "end":
            values = values[mesh.contacts.cells]
        return values

    of_blocks = {field.name for field in fields if field.part == "blocks"}
    variables = {}
    for field in fields:
        name = _OF_CONTACTS + field.name if field.part == "contacts" and field.name in of_blocks else field.name
        variables[name] = _variable(frames, field, sizes[field.on] | field.components, partial(read, field),
                                    field.dtype)
    coordinates = _of_frames(frames, moves) | _of_components(fields, mesh) | _of_zones(mesh)
    if any(field.part == "contacts" for field in fields):
        coordinates |= _of_contacts(mesh)
    return xarray.Dataset(variables, coordinates)


def block_fields_of(run: Path, mesh: Mesh, frames: list[Frame], moves: bool) -> xarray.Dataset:
    """Returns `Results.block_fields`, of what `fields_of` takes."""
    zones, size = mesh.blocks.zones, mesh.blocks.sizes
    numbers, first, block = np.unique(mesh.blocks.block, return_index=True, return_inverse=True)

    def mean(of_zones: Array) -> Array:
        columns = of_zones.reshape(len(size), -1).T
        sums = np.stack([np.bincount(block, size * column) for column in columns], axis=1)
        means: Array = sums / np.bincount(block, size)[:, None]
        return means.reshape(-1, *of_zones.shape[1:])

    def read(field: _Field, frame: int) -> Array:
        values = field.read(run / "fields", frame)
        return mean(values[zones].mean(axis=1, dtype=float) if field.on == "gridpoint" else values)

    fields = [field for field in _listed(run, mesh, frames, moves) if field.part == "blocks"]
    variables = {field.name: _variable(frames, field, {"block": len(numbers)} | field.components,
                                       partial(read, field), np.dtype(float)) for field in fields}
    coordinates: dict[str, Variable] = {
        "block": (("block",), numbers, {}),
        "material": (("block",), np.array(mesh.blocks.materials)[mesh.blocks.material[first]], {}),
        "bearing": (("block",), mesh.blocks.of_bearing[first], {}),
        **_size_of(mesh, "block", np.bincount(block, size)),
        "position": (("block", "component"), mean(mesh.blocks.points[zones].mean(axis=1)), {"units": "m"}),
    }
    return xarray.Dataset(variables, _of_frames(frames, moves) | _of_components(fields, mesh) | coordinates)


def _part(values: Array, key: tuple[Any, ...]) -> Array:
    """Returns what a key has for each axis by itself."""
    for axis in reversed(range(len(key))):
        values = values[(slice(None),) * axis + (key[axis],)]
    return values


def _listed(run: Path, mesh: Mesh, frames: list[Frame], moves: bool) -> list[_Field]:
    """Returns the arrays of the first frame, and those that only the last one has."""
    if not frames:
        raise Error(f"{run}: keeps no frame of its fields")
    first, last = (frame.number for frame in (frames[0], frames[-1]))
    sizes, dimension = _sizes(mesh), mesh.blocks.dimension
    found: dict[tuple[str, str], _Field] = {}
    for part in ("blocks", "contacts") if moves else ("blocks",):
        for number in (first, last):
            file = run / "fields" / f"{part}_{number:04d}.hdf"
            for path, shape, dtype in _arrays(file):
                field = found.setdefault((part, path), _Field(part, path, shape, dtype, number != first, dimension))
                if shape[0] != (rows := prod(sizes[field.on].values())):
                    raise Error(f"{file}: /{path} has shape {shape}, but the mesh asks for {rows} rows")
    return list(found.values())


def _sizes(mesh: Mesh) -> dict[str, dict[str, int]]:
    """Returns dimensions of the rows of fields, with their sizes, by what they are on."""
    contacts, ends = ({name: length} for name, length in zip(("contact", "end"), mesh.contacts.cells.shape))
    return {"gridpoint": {"gridpoint": len(mesh.blocks.points)}, "zone": {"zone": len(mesh.blocks.zones)},
            "contact": contacts, "end": contacts | ends}


def _arrays(path: Path) -> list[tuple[str, tuple[int, ...], np.dtype[Any]]]:
    """Returns the path, shape and type of what is of a frame alone: not a link into the mesh."""
    found = []
    with open_hdf(path) as file:
        for kind in ("PointData", "CellData"):
            group = within(file, f"VTKHDF/{kind}")
            for name in group if isinstance(group, h5py.Group) else ():
                if _NAME.fullmatch(name) and isinstance(group.get(name, getlink=True), h5py.HardLink):
                    array = group[name]
                    if not array.shape or array.shape[1:] not in [(), *((n,) for n in _COMPONENTS)]:
                        raise Error(f"{path}: /VTKHDF/{kind}/{name} has shape {array.shape}")
                    found.append((f"VTKHDF/{kind}/{name}", array.shape, array.dtype))
    return found


def _has(path: Path, name: str) -> bool:
    with open_hdf(path) as file:
        return within(file, name) is not None


def _variable(frames: list[Frame], field: _Field, sizes: Mapping[str, int], read: Callable[[int], Array],
              dtype: np.dtype[Any]) -> Variable:
    """Makes a variable of a field. sizes: of a frame, by dimensions."""
    of_frames = _OfFrames(read, [frame.number for frame in frames], tuple(sizes.values()), dtype)
    values = indexing.LazilyIndexedArray(of_frames)
    return ("frame", *sizes), values, {"units": field.unit}


def _of_frames(frames: list[Frame], moves: bool) -> dict[str, Variable]:
    """Returns what frames.csv has of each frame, in SI; not what it has of none."""
    columns: Mapping[str, tuple[list[Any], str]] = {
        "stage": ([frame.stage for frame in frames], "1"),
        "step": ([frame.step for frame in frames], "1"),
        "time": ([frame.time for frame in frames], "s"),
        "heating_time": ([frame.heating_time for frame in frames], "s"),
        "test_strain": ([frame.strain for frame in frames], "1"),
        "test_stress": ([_PA * frame.stress for frame in frames], "Pa"),
        "mean_temperature": ([frame.temperature for frame in frames], "degC"),
    }
    found: dict[str, Variable] = {"frame": (("frame",), [frame.number for frame in frames], {})}
    for name, (values, unit) in columns.items():
        known = np.array(values, dtype=None if name in ("stage", "step") else float)
        if not np.isnan(known).all() and (name != "step" or moves):
            found[name] = (("frame",), known, {} if unit == "1" else {"units": unit})
    return found


def _of_components(fields: list[_Field], mesh: Mesh) -> dict[str, Variable]:
    there = {3, *(n for field in fields for n in field.shape[1:])}  # positions have components
    return {name: ((name,), labels, {})
            for name, labels in (_labels(n, mesh.blocks.dimension) for n in sorted(there))}


def _size_of(mesh: Mesh, on: str, sizes: Array) -> dict[str, Variable]:
    """Returns areas, or in space volumes, of zones or blocks."""
    if mesh.blocks.dimension == 2:
        return {"area": ((on,), sizes, {"units": "m2"})}
    return {"volume": ((on,), sizes, {"units": "m3"})}


def _of_zones(mesh: Mesh) -> dict[str, Variable]:
    blocks = mesh.blocks
    return {
        "position": (("gridpoint", "component"), blocks.points, {"units": "m"}),
        "zones": (("zone", "corner"), blocks.zones, {}),
        "block": (("zone",), blocks.block, {}),
        "material": (("zone",), np.array(blocks.materials)[blocks.material], {}),
        "bearing": (("zone",), blocks.of_bearing, {}),
        **_size_of(mesh, "zone", blocks.sizes),
    }


def _of_contacts(mesh: Mesh) -> dict[str, Variable]:
    contacts = mesh.contacts
    return {
        "end": (("end",), _ENDS[contacts.cells.shape[1]], {}),
        "contact_position": (("contact", "end", "component"), contacts.points[contacts.cells], {"units": "m"}),
        "interface": (("contact",), np.array(contacts.interfaces)[contacts.interface], {}),
        **({"length": (("contact",), contacts.extent, {"units": "m"})} if mesh.blocks.dimension == 2 else
           {"contact_area": (("contact",), contacts.extent, {"units": "m2"})}),
    }
