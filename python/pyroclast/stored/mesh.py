"""Reader of mesh.h5: zones of all blocks and contact points, reference configuration, SI units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

from ..errors import Error
from .files import dataset, open_hdf, within

_VTK_LINE, _VTK_TRIANGLE, _VTK_QUAD, _VTK_TETRAHEDRON = 3, 5, 9, 10
_MEET = 1e-9  # of the size of a body: centres of sides so near to each other are one
_CORNERS = {_VTK_LINE: 2, _VTK_TRIANGLE: 3, _VTK_QUAD: 4, _VTK_TETRAHEDRON: 4}


@dataclass(frozen=True)
class BlockMesh:
    """Zones of all blocks, reference configuration: triangles in the plane, tetrahedra in space."""

    path: Path  #: file it was read from
    points: np.ndarray  #: (N, dimension) gridpoints, m
    zones: np.ndarray  #: (Z, dimension + 1) gridpoints of each zone, positively oriented
    block: np.ndarray  #: (Z,) block of each zone
    material: np.ndarray  #: (Z,) indices into `materials`
    materials: tuple[str, ...]  #: names of the phases, and last those of bearings
    of_bearing: np.ndarray  #: (Z,) bool: zones of platens and other bearings

    def of(self, zones: np.ndarray) -> BlockMesh:
        """Returns the mesh of some zones (Z,) alone, with all gridpoints."""
        return replace(self, zones=self.zones[zones], block=self.block[zones], material=self.material[zones],
                       of_bearing=self.of_bearing[zones])

    @property
    def dimension(self) -> int:
        """Dimension, 2 or 3."""
        return self.points.shape[1]

    @property
    def bearing_materials(self) -> list[int]:
        """Indices into `materials`."""
        return np.unique(self.material[self.of_bearing]).tolist()

    @cached_property
    def sizes(self) -> np.ndarray:
        """Sizes (Z,): area of each zone, m², in space its volume, m³."""
        return _sizes(self.points, self.zones)

    @cached_property
    def outlines(self) -> tuple[list[np.ndarray], np.ndarray]:
        """Gridpoints around each block of the plane, counter-clockwise, and the blocks' materials.

        Raises Error when a block's zones do not make one simple polygon.
        """
        return _outlines(self)

    @cached_property
    def sides(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Triangles around each block of space: their gridpoints (T, 3), right-handed about the way out of the block,
        the zone of each (T,), and whether no other block meets it (T,).
        """
        return _sides(self)


@dataclass(frozen=True)
class ContactMesh:
    """Each contact point as a cell: in the plane a line to the middle of its face, in space a quadrangle of the point,
    the middle of the next edge, that of the face, and that of the edge before.
    """

    points: np.ndarray  #: (2 or 4 C, dimension), m
    cells: np.ndarray  #: (C, 2 or 4) indices into points
    interface: np.ndarray  #: (C,) indices into `interfaces`
    interfaces: tuple[str, ...]  #: names, and last those of bearings
    extent: np.ndarray  #: (C,) tributary length, m, in space area, m²

    @cached_property
    def angle(self) -> np.ndarray:
        """Angle (C,) between each contact's face and y, the direction of a load by platens: 0 to 90 degrees."""
        corners = self.points[self.cells]
        if corners.shape[1] == 2:
            normal = (corners[:, 1] - corners[:, 0])[:, ::-1]  # but for signs
        else:
            normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        size = np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)
        return np.degrees(np.arcsin(np.minimum(np.abs(normal[:, 1]) / size, 1.0)))


@dataclass(frozen=True)
class Mesh:
    blocks: BlockMesh
    contacts: ContactMesh


def specimen_box(blocks: BlockMesh) -> tuple[np.ndarray, np.ndarray]:
    """Returns the lower and upper corner of the specimen without bearings, m."""
    points = blocks.points[blocks.zones[~blocks.of_bearing].ravel()]
    if not len(points):
        raise Error(f"{blocks.path}: /blocks/material has bearings only")
    return points.min(axis=0), points.max(axis=0)


def cells_of_contacts(points: np.ndarray, face: np.ndarray) -> np.ndarray:
    """Returns (C, 4, 3), m: the quadrangles of `ContactMesh`, of contact points of a solid that go around their faces.

    points: (C, 3), m. face: (C,), the face of each; the points of a face stand together.
    """
    first = np.r_[0, np.flatnonzero(np.diff(face)) + 1]
    count = np.diff(np.r_[first, len(face)])
    start, corners = np.repeat(first, count), np.repeat(count, count)
    place = np.arange(len(face)) - start
    after, before = start + (place + 1) % corners, start + (place - 1) % corners
    middle = np.repeat(np.add.reduceat(points, first) / count[:, None], count, axis=0)
    return np.stack([points, 0.5 * (points + points[after]), middle, 0.5 * (points + points[before])], axis=1)


def read_mesh(path: Path) -> Mesh:
    """Reads mesh.h5; raises Error when it is missing or its groups are not triangles and lines, or tetrahedra and
    quadrangles.
    """
    with open_hdf(path) as file:
        in_space = _type_of(file, "blocks") == _VTK_TETRAHEDRON
        of_zones, of_contacts = (_VTK_TETRAHEDRON, _VTK_QUAD) if in_space else (_VTK_TRIANGLE, _VTK_LINE)
        dimension = 3 if in_space else 2
        points, zones = _cells(file, "blocks", of_zones, "triangles or tetrahedra", dimension)
        blocks = BlockMesh(
            path,
            points,
            _positive(points, zones),
            _cell_values(file, "blocks/block", len(zones)),
            *_kinds(file, "blocks/material", len(zones)),
            _cell_values(file, "blocks/bearing", len(zones)) == 1,
        )
        points, cells = _cells(file, "contacts", of_contacts, "lines of two points, or quadrangles", dimension)
        contacts = ContactMesh(
            points,
            cells,
            *_kinds(file, "contacts/interface", len(cells)),
            _cell_values(file, "contacts/area" if in_space else "contacts/length", len(cells)),
        )
    return Mesh(blocks, contacts)


def _type_of(file: h5py.File, group: str) -> int:
    """Returns VTK's number of the first cell."""
    types = dataset(file, f"{group}/Types")
    return int(types[0]) if types.ndim == 1 and len(types) else 0


def _names(file: h5py.File, name: str) -> tuple[str, ...]:
    """Returns what the values of a dataset stand for."""
    names = within(file, f"{name}_names")
    if not isinstance(names, h5py.Dataset) or names.dtype.kind != "S" or names.ndim != 1:
        raise Error(f"{file.filename}: has no dataset /{name}_names of texts")
    try:
        texts = [text.decode() for text in names[()]]
    except UnicodeDecodeError:
        texts = ["\0"]
    if not "".join(texts).isprintable():
        raise Error(f"{file.filename}: /{name}_names holds no names")
    return tuple(texts)


def _cells(file: h5py.File, group: str, cell_type: int, name: str, dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns points (N, dimension) and corners of each cell, all cells of one type."""
    points = dataset(file, f"{group}/Points")
    if points.ndim != 2 or points.shape[1] != 3:
        raise Error(f"{file.filename}: /{group}/Points has shape {points.shape}; (N, 3) is expected")
    types = dataset(file, f"{group}/Types")
    corners = dataset(file, f"{group}/Connectivity")
    count = _CORNERS[cell_type]
    if (types.ndim != 1 or corners.shape != (count * len(types),) or corners.dtype.kind not in "iu"
            or (types != cell_type).any()):
        raise Error(f"{file.filename}: /{group} has cells that are not {name}")
    if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
        raise Error(f"{file.filename}: /{group}/Connectivity points outside the {len(points)} points")
    return points[:, :dimension], corners.astype(np.int64).reshape(-1, count)


def _cell_values(file: h5py.File, name: str, cells: int) -> np.ndarray:
    values = dataset(file, name)
    if values.shape != (cells,):
        raise Error(f"{file.filename}: /{name} has shape {values.shape} for {cells} cells")
    return values


def _kinds(file: h5py.File, name: str, cells: int) -> tuple[np.ndarray, tuple[str, ...]]:
    """Returns an index into the names for each cell, and the names."""
    values, names = _cell_values(file, name, cells), _names(file, name)
    if values.dtype.kind not in "iu" or cells and not 0 <= values.min() <= values.max() < len(names):
        raise Error(f"{file.filename}: /{name} holds numbers for which there is no name")
    return values, names


def _sizes(points: np.ndarray, zones: np.ndarray) -> np.ndarray:
    """Returns the sizes (Z,), m² or m³: negative where the corners are in the wrong order."""
    edges = [points[zones[:, i]] - points[zones[:, 0]] for i in range(1, zones.shape[1])]
    if len(edges) == 2:
        return 0.5 * (edges[0][:, 0] * edges[1][:, 1] - edges[0][:, 1] * edges[1][:, 0])
    return np.einsum("ij,ij->i", edges[0], np.cross(edges[1], edges[2])) / 6.0


def _positive(points: np.ndarray, zones: np.ndarray) -> np.ndarray:
    if zones.shape[1] == 3:
        return np.where((_sizes(points, zones) < 0.0)[:, None], zones[:, ::-1], zones)
    return np.where((_sizes(points, zones) < 0.0)[:, None], zones[:, [1, 0, 2, 3]], zones)


def _sides(mesh: BlockMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    # the sides of a positively oriented tetrahedron, each seen from outside
    corners = mesh.zones[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]].reshape(-1, 3)
    zone = np.repeat(np.arange(len(mesh.zones)), 4)
    _, first, count = np.unique(np.sort(corners, axis=1), axis=0, return_index=True, return_counts=True)
    around = np.sort(first[count == 1])  # two zones of a block have the other sides in common
    corners, zone = corners[around], zone[around]
    size = np.ptp(mesh.points, axis=0).max()
    centre = np.round(mesh.points[corners].mean(axis=1) / (_MEET * size)).astype(np.int64)
    _, place, count = np.unique(centre, axis=0, return_inverse=True, return_counts=True)
    return corners, zone, count[place.ravel()] == 1


def _outlines(mesh: BlockMesh) -> tuple[list[np.ndarray], np.ndarray]:
    if not len(mesh.zones):
        raise Error(f"{mesh.path}: /blocks has no zones")
    # A directed zone edge is on the outline when no zone of the block walks it the other way.
    size = len(mesh.points)
    start = mesh.zones.ravel()
    end = np.roll(mesh.zones, -1, axis=1).ravel()
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
