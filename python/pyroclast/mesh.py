"""Reader of mesh.h5: zones of all blocks and contact points, reference configuration, SI units."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

from .errors import Error
from .files import dataset, open_hdf

_VTK_LINE, _VTK_TRIANGLE = 3, 5


@dataclass(frozen=True)
class BlockMesh:
    """Zones of all blocks, reference configuration."""

    path: Path  #: file it was read from
    points: np.ndarray  #: (N, 2) gridpoints, m
    triangles: np.ndarray  #: (Z, 3) gridpoints of each zone, counter-clockwise
    block: np.ndarray  #: (Z,) block of each zone
    material: np.ndarray  #: (Z,) indices into `materials`
    materials: tuple[str, ...]  #: names of the phases, and last of the solids of bearings
    of_bearing: np.ndarray  #: (Z,) bool: zones of platens and other bearings

    @property
    def bearing_materials(self) -> list[int]:
        """Indices into `materials`."""
        return np.unique(self.material[self.of_bearing]).tolist()

    @cached_property
    def areas(self) -> np.ndarray:
        """(Z,), m²: area of each zone."""
        return 0.5 * _twice_areas(self.points, self.triangles)

    @cached_property
    def outlines(self) -> tuple[list[np.ndarray], np.ndarray]:
        """Gridpoints around each block, counter-clockwise, and the blocks' materials.

        Raises Error when a block's zones do not make one simple polygon.
        """
        return _outlines(self)


@dataclass(frozen=True)
class ContactMesh:
    """Each contact point as a line to the middle of its face."""

    points: np.ndarray  #: (2C, 2), m
    lines: np.ndarray  #: (C, 2) indices into points
    interface: np.ndarray  #: (C,) indices into `interfaces`
    interfaces: tuple[str, ...]  #: names, and last those of bearings
    length: np.ndarray  #: (C,) tributary length, m


@dataclass(frozen=True)
class Mesh:
    blocks: BlockMesh
    contacts: ContactMesh


def read_mesh(path: Path) -> Mesh:
    """Reads mesh.h5; raises Error when it is missing or its groups are not triangles and lines."""
    with open_hdf(path) as file:
        points, triangles = _cells(file, "blocks", _VTK_TRIANGLE, "triangles")
        blocks = BlockMesh(
            path,
            points,
            _counter_clockwise(points, triangles),
            _cell_values(file, "blocks/block", len(triangles)),
            *_kinds(file, "blocks/material", len(triangles)),
            _cell_values(file, "blocks/bearing", len(triangles)) == 1,
        )
        points, lines = _cells(file, "contacts", _VTK_LINE, "lines of two points")
        contacts = ContactMesh(
            points,
            lines,
            *_kinds(file, "contacts/interface", len(lines)),
            _cell_values(file, "contacts/length", len(lines)),
        )
    return Mesh(blocks, contacts)


def _names(file: h5py.File, name: str) -> tuple[str, ...]:
    """What the values of a dataset stand for."""
    names = file.get(f"{name}_names")
    if not isinstance(names, h5py.Dataset) or names.dtype.kind != "S" or names.ndim != 1:
        raise Error(f"{file.filename}: has no dataset /{name}_names of texts")
    try:
        texts = [text.decode() for text in names[()]]
    except UnicodeDecodeError:
        texts = ["\0"]
    if not "".join(texts).isprintable():
        raise Error(f"{file.filename}: /{name}_names holds no names")
    return tuple(texts)


def _cells(file: h5py.File, group: str, cell_type: int, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 2) and corners of each cell, all cells of one type."""
    points = dataset(file, f"{group}/Points")
    if points.ndim != 2 or points.shape[1] != 3:
        raise Error(f"{file.filename}: /{group}/Points has shape {points.shape}; (N, 3) is expected")
    types = dataset(file, f"{group}/Types")
    corners = dataset(file, f"{group}/Connectivity")
    sides = {_VTK_LINE: 2, _VTK_TRIANGLE: 3}[cell_type]
    if (types.ndim != 1 or corners.shape != (sides * len(types),) or corners.dtype.kind not in "iu"
            or (types != cell_type).any()):
        raise Error(f"{file.filename}: /{group} has cells that are not {name}")
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
        raise Error(f"{file.filename}: /{group}/Connectivity points outside the {len(points)} points")
    return points[:, :2], corners.astype(np.int64).reshape(-1, sides)


def _cell_values(file: h5py.File, name: str, cells: int) -> np.ndarray:
    values = dataset(file, name)
    if values.shape != (cells,):
        raise Error(f"{file.filename}: /{name} has shape {values.shape} for {cells} cells")
    return values


def _kinds(file: h5py.File, name: str, cells: int) -> tuple[np.ndarray, tuple[str, ...]]:
    """Of each cell an index into the names, and the names."""
    values, names = _cell_values(file, name, cells), _names(file, name)
    if values.dtype.kind not in "iu" or cells and not 0 <= values.min() <= values.max() < len(names):
        raise Error(f"{file.filename}: /{name} holds numbers for which there is no name")
    return values, names


def _twice_areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(Z,), m²: negative where the corners go clockwise."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]


def _counter_clockwise(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    return np.where((_twice_areas(points, triangles) < 0.0)[:, None], triangles[:, ::-1], triangles)


def _outlines(mesh: BlockMesh) -> tuple[list[np.ndarray], np.ndarray]:
    if not len(mesh.triangles):
        raise Error(f"{mesh.path}: /blocks has no zones")
    # A directed zone edge is on the outline when no zone of the block walks it the other way.
    size = len(mesh.points)
    start = mesh.triangles.ravel()
    end = np.roll(mesh.triangles, -1, axis=1).ravel()
    outer = ~np.isin(start * size + end, end * size + start)
    owner = np.repeat(mesh.block, 3)[outer]
    start, end = start[outer], end[outer]
    if not np.array_equal(np.unique(start), np.sort(end)):  # each gridpoint is left once and reached once
        raise Error(f"{mesh.path}: /blocks has a block whose zones do not make one simple polygon")
    following = dict(zip(start.tolist(), end.tolist()))

    _, first_edge = np.unique(owner, return_index=True)
    outlines = []
    for first in start[first_edge].tolist():
        loop = [first]
        while (gridpoint := following[loop[-1]]) != first:
            loop.append(gridpoint)
        outlines.append(np.array(loop))
    if sum(map(len, outlines)) != len(start):
        raise Error(f"{mesh.path}: /blocks has a block whose zones do not make one simple polygon")
    _, first_zone = np.unique(mesh.block, return_index=True)
    return outlines, mesh.material[first_zone]
