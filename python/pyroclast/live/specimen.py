"""Specimens from arrays, meshes, tessellations and labelled images."""

from __future__ import annotations

import json
import warnings
from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..errors import Error
from ..libraries import library
from ..stored import mesh_cells, neper
from . import label_image
from .units import Quantity, length

if TYPE_CHECKING:
    import meshio

Label = Union[int, str]

_FLAT = 1e-6  # of the size of a mesh: coordinates in single precision are off by up to 6e-8 of it
_USUAL = (0.01, 10.0)  # width and height of a body, m, as for a deck


class Specimen:
    """Blocks in the plane or in space, and what each is made of. A deck takes one in the place of what it says of the
    specimen itself:

        deck["specimen"] = pyroclast.Specimen.from_arrays(vertices, cells, labels)

    Its run keeps the blocks in its folder, so that the deck there gives the same run without the script. An image makes
    a specimen of the plane, everything else one of either space. Arrays are copies, in m.
    """

    def __init__(self, core: _core.Specimen, agreement: float | None = None):
        self._core = core
        self._agreement = agreement

    @classmethod
    def from_arrays(cls, vertices: ArrayLike, cells: Sequence[ArrayLike] | NDArray[Any],
                    labels: Sequence[Label] | NDArray[Any], phases: Mapping[Any, str] | None = None, *,
                    faces: Sequence[ArrayLike] | None = None, block_size: ArrayLike | None = None,
                    stone: ArrayLike | None = None, unit: str | Quantity | None = None,
                    join: str | Quantity | None = None) -> Specimen:
        """Makes a specimen of cells that are made elsewhere.

        vertices: (n, 2), in space (n, 3), in `unit`.
        cells: for each the numbers of its vertices in turn, from 0, in either sense; neighbours share vertices. In
            space the numbers of its faces.
        faces: in space, for each the numbers of its vertices in turn, from 0, in either sense; two neighbours share
            one.
        labels: of each cell, the name of its phase, or what `phases` has the name for; an array may have any shape
            that has one label for each cell, such as (cells, 1).
        phases: the name of each label's phase, in the order that `phase` counts in; None: labels are names.
        block_size: (cells,), in `unit`: size that each was to have, which its contact stiffness follows; None: alike.
        stone: (cells,): number of the stone of each, from 0, -1: none; a deck's `between_stones` needs it.
        unit: of the vertices: "m", "mm", ...; None: they are taken in m, with a warning.
        join: vertices nearer to each other than this length become one, and those nearer to an edge of a cell that
            does not have them become corners of it ("1 um"); None: cells share the vertices that they name.

        In space the cells fill a box along the axes, whose lower left corner in front moves to (0, 0, 0); its sides are
        `bottom`, `right`, `top`, `left`, `front` and `back`.

        Each phase needs its tables of [materials] and [contacts]. Where cells leave places free, there are holes;
        `sides` has what the sides are called. Messages count cells and vertices from 0. Warns of an outline that is
        not 10 mm to 10 m wide and high.

        Raises Error, naming the cell, where one is not convex, names a vertex that there is not, has a label without a
        name or does not fit together with its neighbours; and where the cells are not one piece.
        """
        unit = _stated(unit, "the vertices")
        made = _from_cells(vertices, cells, labels, phases, unit, join, () if block_size is None else block_size,
                           () if stone is None else stone, faces)
        _warn_of_size(made, f"the vertices are in {_unit_name(unit)}")
        return cls(made)

    @classmethod
    def from_meshio(cls, mesh: meshio.Mesh, data: str | None = None, phases: Mapping[Any, str] | None = None, *,
                    unit: str | Quantity | None = None, join: str | Quantity | None = None) -> Specimen:
        """Makes a specimen of the cells of a mesh: in the plane its triangles, quads and polygons, in space its
        tetrahedra, pyramids, wedges, hexahedra and polyhedra, which fill a box as in `from_arrays`. What has fewer
        dimensions is left out. Of cells of a higher order the corners count, so that their sides are straight.

        data: name of the cell data that label the cells, such as "gmsh:physical"; None: the cell sets say what they
            are of (`*ELSET` of Abaqus), or where there are none the physical groups of gmsh.
        phases: the name of each label's phase; a label is a value of the cell data, the name of a cell set or that of
            a physical group. None: cell sets and physical groups are called as their phases are. Of cell sets those
            count that are named here.
        unit: of the points: "m", "mm", ...; a mesh does not say it. None: they are taken in m, with a warning.
        join: as for `from_arrays`: joins parts of a mesh that do not share points.

        Messages count from 0 the cells that are taken, in their order.

        Raises Error for other cells, for a mesh of the plane that does not lie at one z, for cell data or sets that are
        not there, for a cell in no set or in two, and as `from_arrays`.
        """
        points = np.asarray(mesh.points, float)
        if mesh_cells.dimension_of(mesh) == 3:
            blocks, faces, of_faces = mesh_cells.cells_in_space(mesh)
            labels, names = mesh_cells.labels_of(mesh, data, phases, blocks, 3)
            unit = _stated(unit, "the points of the mesh")
            return cls(_from_cells(points, of_faces, labels, names, unit, join, faces=faces))
        taken: list[int] = []
        cells: list[NDArray[Any]] = []
        for number, block in enumerate(mesh.cells):
            if (corners := mesh_cells.corners_of_type(block.type)) is None:
                continue
            taken.append(number)
            cells += [np.asarray(cell)[:corners or None] for cell in block.data]
        size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
        if points.ndim == 2 and points.shape[1] == 3 and len(points) and np.ptp(points[:, 2]) > _FLAT * size:
            raise Error(f"the mesh does not lie in a plane z = const., to {_FLAT:g} of its size: z goes from "
                        f"{points[:, 2].min():g} to {points[:, 2].max():g}; turn it into one")
        labels, names = mesh_cells.labels_of(mesh, data, phases, taken)
        if not cells:
            raise Error(f"the mesh has no cells that can be blocks: {', '.join(mesh_cells.KINDS)}")
        used, numbers = np.unique(np.concatenate(cells), return_inverse=True)
        ends = np.cumsum([len(cell) for cell in cells])[:-1]
        unit = _stated(unit, "the points of the mesh")
        made = _from_cells(points[used.astype(int), :2], np.split(numbers, ends), labels, names, unit, join)
        _warn_of_size(made, f"the points of the mesh are in {_unit_name(unit)}")
        return cls(made)

    @classmethod
    def from_image(cls, image: ArrayLike | str | Path, pixel: str | Quantity, phases: Mapping[Any, str | None], *,
                   blocks: int, seed: int = 1, shortest_edge: float = 0.2, relaxation: int = 0,
                   radius_spread: float = 0.0) -> Specimen:
        """Makes a specimen of Voronoi blocks, each of the phase that most of its pixels are of.

        image: (rows, columns) of labels, the first row on top: the rectangle from [0, 0] to columns and rows times
            `pixel`. Or the name of a file that holds it: .npy, or .png and .tif of one page whose grey values, or
            numbers of colours of a palette, are the labels; it is turned as its tag Orientation says. Labels are whole
            numbers, or texts.
        pixel: the side of one, with its unit ("0.2 mm").
        phases: the name of each label's phase. A key may be several labels, as a range, a tuple or a frozenset, or
            `...` for all labels that have no key: `{0: "mortar", ...: "aggregate"}` names the stones of a watershed.
            None: there is nothing, so that blocks there are left out, and pieces that do not hang together with the
            largest.
        blocks: their number in the rectangle.
        seed, shortest_edge, relaxation, radius_spread: as a deck's keys of these names.

        Labels that share a phase are stones, each with a number of its own in `stone`, by which a deck's
        `between_stones` knows them. The label of a phase of one label is none.

        `agreement` tells which share of the image is of the phase of its block. Blocks must be smaller than what they
        shall show, and larger than a pixel; a smaller one is of the pixel in its middle. Warns of a phase that pixels
        are of and no block, which keeps its place in `phases`, and of an image that is not 10 mm to 10 m wide and high.

        Raises Error for labels without a name, telling how many pixels have each label and where the first is, for
        numbers that are not whole, for pixels that are masked or NaN, for an image without anything, and for a file
        that is no such image.
        """
        pixels, source = label_image.pixels_of(image)
        side = length("pixel", pixel, "0.2 mm")
        for key, name in phases.items():
            if name is not None and not isinstance(name, str):
                raise Error(f"phases: {'...' if key is ... else repr(key)} has the phase {name!r}; it must be a "
                            "name, or None where there is nothing")
        names = list(dict.fromkeys(name for name in phases.values() if name is not None))
        labels, place = label_image.numbered(pixels)
        keys = label_image.keys_of(labels, place, phases, source)
        places: dict[str | None, int] = {None: -1} | {name: i for i, name in enumerate(names)}
        number = np.array([places[phases[key]] for key in keys])  # phase of each label
        rows, columns = place.shape
        made = _core.Specimen.rectangle(columns * side, rows * side, blocks, shortest_edge, relaxation, radius_spread,
                                        seed)
        seen = _pixels_of_blocks(made, place, side)
        votes = np.array([np.bincount(number[some] + 1, minlength=len(names) + 1) for some in seen])
        phase = votes.argmax(axis=1) - 1
        cells = made.cells
        if None in phases.values():
            phase = _one_piece(cells, phase, votes)
        kept = np.flatnonzero(phase >= 0)
        if not len(kept):
            raise Error(f"{source}there is nothing in the image that is as large as a block; it has "
                        f"{label_image.counted(labels, place)}")
        alike = float(np.take_along_axis(votes, phase[:, None] + 1, axis=1).sum() / votes.sum())
        used, numbers = np.unique(np.concatenate([cells[i] for i in kept]), return_inverse=True)
        ends = np.cumsum([len(cells[i]) for i in kept])[:-1]
        stone = _stones([seen[i] for i in kept], phase[kept], number, label_image.are_of_stones(keys, phases))
        whole = _from_cells(made.vertices[used], np.split(numbers, ends), phase[kept], dict(enumerate(names)), "m",
                            None, stone=stone)
        for i, name in enumerate(names):
            if (count := np.count_nonzero(number[place] == i)) and not (phase[kept] == i).any():
                warnings.warn(f"{source}phase {name!r} is of {count} pixel{'' if count == 1 else 's'} and of no block: "
                              f"its share is 0. Take more blocks, or another phase for its label", stacklevel=2)
        _warn_of_size(whole, f"{source}the image has {columns} x {rows} pixels of {pixel}")
        return cls(whole, alike)

    @classmethod
    def from_neper(cls, file: str | Path, phases: Mapping[int, str] | str, *, unit: str | Quantity | None = None,
                   join: str | Quantity | None = None) -> Specimen:
        """Makes a specimen of a three-dimensional tessellation of Neper (.tess), which fills a box as in `from_arrays`.
        One of the plane is `[blocks] file` of a deck.

        phases: the name of the phase of each group of cells (`*group`); of all cells, where it is one name.
        unit: of the file's coordinates: "m", "mm", ...; None: they are taken in m, with a warning.
        join: as for `from_arrays`.

        Raises Error, with the file, for one of another form, a periodic one, and as `from_arrays`.
        """
        vertices, faces, cells, groups = neper.read_tess(Path(file))
        if not isinstance(phases, str) and groups is None:
            raise Error(f"{file}: puts its cells into no groups (*group), so that phases is one name")
        labels: list[Any] = [phases] * len(cells) if isinstance(phases, str) or groups is None else groups
        names = None if isinstance(phases, str) else phases
        return cls(_from_cells(vertices, cells, labels, names, _stated(unit, "the vertices"), join, faces=faces))

    @classmethod
    def read(cls, file: str | Path, join: str | Quantity | None = None) -> Specimen:
        """Reads a specimen from a file as `save` writes it; in the plane the name of its vertices may have another unit
        (`vertices_mm`). It has no `stones`.

        join: as for `from_arrays`; in space vertices nearer to each other than this length become one, and faces that
            then have the same corners one face between two blocks.

        Raises Error, which names the file.
        """
        made = _core.Specimen.read(str(file), _join(join))
        _warn_of_size(made, str(file))
        return cls(made)

    def save(self, file: str | Path) -> None:
        """Writes the blocks as JSON; a deck reads them by `[specimen] file` and `shape`, as this specimen has it."""
        Path(file).write_text(self._core.text(), encoding="utf-8")

    @property
    def dimension(self) -> int:
        """2 in the plane, 3 in space."""
        return self._core.dimension

    @property
    def shape(self) -> str:
        """Shape in a deck that reads the file of `save`: `cells` in the plane, `polyhedra` in space."""
        return "cells" if self.dimension == 2 else "polyhedra"

    @property
    def phases(self) -> list[str]:
        """Names of the phases that blocks can be made of."""
        return self._core.phases

    @property
    def phase(self) -> NDArray[np.int32]:
        """Phase (blocks,) of each block, as indices into `phases`."""
        return self._core.phase

    @property
    def stone(self) -> NDArray[np.int32] | None:
        """Number (blocks,) of the stone of each block, -1: none; None where no stones are known."""
        return self._core.stone if len(self._core.stone) else None

    @property
    def stones(self) -> NDArray[np.float64]:
        """Stones (stones, dimension + 1): place of the centre, and diameter, of each as it was placed, m; none where
        blocks were read."""
        return self._core.stones

    @property
    def block_size(self) -> NDArray[np.float64] | None:
        """Size (blocks,) that each block was to have, m, as its contact stiffness follows; None where all are alike."""
        return np.array(self._core.block_size) if self._core.block_size else None

    @property
    def shares(self) -> dict[str, float]:
        """Share of `extent` that each phase takes [1]."""
        return dict(zip(self._core.phases, self._core.shares))

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices (vertices, dimension), m."""
        return self._core.vertices

    @property
    def cells(self) -> list[NDArray[np.int32]]:
        """Numbers of the vertices of each block, counter-clockwise; in space numbers of its `facets`."""
        return self._core.cells

    @property
    def facets(self) -> list[NDArray[np.int32]]:
        """Numbers of the vertices of each facet: of an edge with its first neighbour on the left, in space around a
        face, counter-clockwise seen from outside of its first neighbour."""
        return self._core.facets

    @property
    def neighbours(self) -> NDArray[np.int32]:
        """Blocks (facets, 2) on both sides of each facet; the second is -1 on the outline."""
        return self._core.neighbours

    @property
    def extent(self) -> float:
        """Area, m²; in space the volume, m³."""
        return self._core.extent

    @property
    def size(self) -> tuple[float, ...]:
        """Size of the box around the specimen along each axis, m."""
        return self._core.size

    @property
    def sides(self) -> list[str]:
        """Names of the sides: `bottom`, `right`, `top`, `left` of a rectangle along the axes; of another outline
        `side_1`, `side_2`, ... from its lowest corner on, counter-clockwise; then `hole_1`, ... In space those of the
        section, then `front` and `back`; of a cylinder `rim`, `bottom`, `top`.
        """
        return self._core.sides

    @property
    def agreement(self) -> float | None:
        """Share of an image that is of the phase of its block [1]; None where there was no image."""
        return self._agreement

    def to_meshio(self) -> meshio.Mesh:
        """Returns the blocks as polygons in space, z = 0, or polyhedra, with the cell data `phase`; meshio writes both
        as VTU. Blocks stand in the order of their number of vertices.
        """
        phase, cells, facets = self.phase, self.cells, self.facets
        by_size: dict[int, list[int]] = {}
        for block, cell in enumerate(cells):
            corners = cell if self.dimension == 2 else np.unique(np.concatenate([facets[i] for i in cell]))
            by_size.setdefault(len(corners), []).append(block)
        blocks: list[tuple[str, Any]] = [
            ("polygon", np.array([cells[i] for i in some])) if self.dimension == 2 else
            (f"polyhedron{size}", [[facets[i] for i in cells[block]] for block in some])
            for size, some in sorted(by_size.items())]
        points = np.column_stack([self.vertices, np.zeros((len(self.vertices), 3 - self.dimension))])
        mesh: meshio.Mesh = library("meshio", "to_meshio").Mesh(
            points, blocks, cell_data={"phase": [phase[some] for _, some in sorted(by_size.items())]})
        return mesh

    def __repr__(self) -> str:
        shares = ", ".join(f"{name} {share:.3f}" for name, share in self.shares.items())
        return f"<Specimen of {len(self._core.phase)} blocks: {shares}>"


def _from_cells(vertices: ArrayLike, cells: Sequence[ArrayLike] | NDArray[Any],
                labels: Sequence[Label] | NDArray[Any], phases: Mapping[Any, str] | None, unit: str | Quantity,
                join: str | Quantity | None, block_size: ArrayLike = (), stone: ArrayLike = (),
                faces: Sequence[ArrayLike] | None = None) -> _core.Specimen:
    metres = length("unit", unit if isinstance(unit, Quantity) else f"1 {unit}", "mm")
    at = np.asarray(vertices, float)
    dimension = 2 if faces is None else 3
    if at.ndim != 2 or at.shape[1] != dimension:
        raise Error(f"vertices must be (n, {dimension}), not {at.shape}"
                    + ("; in space, faces=[...] has the vertices of each face" if at.shape[1:] == (3,) else ""))
    sizes = np.asarray(block_size, float).ravel()
    if metres != 1.0:
        at, sizes = (x * metres if metres > 1.0 else x / (1.0 / metres) for x in (at, sizes))  # nearest double of mm
    stones = np.asarray(stone).ravel()
    if len(stones) and (stones.dtype.kind not in "iu" or stones.min() < -1 or stones.max() >= 2**31):
        raise Error("stone must be the number of a stone of each cell, from 0, or -1 for none")
    rows = [_numbers(cell, "cell", number, "vertex" if faces is None else "face") for number, cell in enumerate(cells)]
    if not rows:
        raise Error("there are no cells")
    if len(wrong := np.flatnonzero(~np.isfinite(at).all(axis=1))):
        raise Error(f"vertex {wrong[0]} (from 0) is not finite")
    names, phase = _named(labels, phases, len(rows))
    table: dict[str, Any] = {"phases": names, "cells": rows, "phase": phase.tolist()}
    if faces is not None:
        loops = table["faces"] = [_numbers(face, "face", number, "vertex") for number, face in enumerate(faces)]
        used = [v for v in {v for loop in loops for v in loop} if v < len(at)]
        low = at[used].min(axis=0) if used else np.zeros(3)
        at = at - low
        width, height, depth = at[used].max(axis=0).tolist() if used else (0.0, 0.0, 0.0)
        table["body"] = {"axis": "z", "length_m": depth, "sides": ["bottom", "right", "top", "left"],
                         "section_m": [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]}
    table["vertices_m"] = at.tolist()
    if len(sizes):
        table["block_size_m"] = sizes.tolist()
    if len(stones):
        table["stone"] = stones.tolist()
    return _core.Specimen.from_text(json.dumps(table), _join(join))


def _numbers(item: ArrayLike, what: str, number: int, of: str) -> list[int]:
    """Returns the numbers that a cell or a face names."""
    named = np.asarray(item)
    if named.ndim != 1 or named.dtype.kind not in "iu":
        raise Error(f"{what} {number} (from 0) must be a list of {'vertices' if of == 'vertex' else 'faces'} by their "
                    "numbers")
    if len(named) and not 0 <= named.min() <= named.max() < 2**31:
        raise Error(f"{what} {number} (from 0) names {of} {named.min() if named.min() < 0 else named.max()}, "
                    "which cannot be")
    return named.tolist()  # type: ignore[no-any-return]


def _named(labels: Sequence[Label] | NDArray[Any], phases: Mapping[Any, str] | None,
           cells: int) -> tuple[list[str], NDArray[np.int32]]:
    """Returns names of phases, and of each cell an index into them."""
    values: list[Any] = labels.ravel().tolist() if isinstance(labels, np.ndarray) else list(labels)
    if len(values) != cells:
        shape = f", in shape {labels.shape}" if isinstance(labels, np.ndarray) else ""
        raise Error(f"there are {cells} cells, but the labels of {len(values)}{shape}")
    values = [label.item() if isinstance(label, np.ndarray) and label.size == 1 else label for label in values]
    values = [label[0] if isinstance(label, (list, tuple)) and len(label) == 1 else label for label in values]
    names = list(dict.fromkeys(label for label in values if isinstance(label, str))
                 if phases is None else dict.fromkeys(phases.values()))
    for number, label in enumerate(values):
        if phases is None and not isinstance(label, str):
            raise Error(f"cell {number} (from 0) has the label {label!r}; say by phases={{{label!r}: ...}} its name")
        if phases is not None and (not isinstance(label, Hashable) or label not in phases):
            raise Error(f"cell {number} (from 0) has the label {label!r}, for which there is no phase; there are "
                        f"{', '.join(map(repr, phases)) or 'none'}")
    place = {name: i for i, name in enumerate(names)}
    return names, np.array([place[label if phases is None else phases[label]] for label in values], np.int32)


def _join(join: str | Quantity | None) -> float:
    return 0.0 if join is None else length("join", join, "1 um")


def _stated(unit: str | Quantity | None, what: str) -> str | Quantity:
    """Returns the unit of a size; m, with a warning, where nobody says it."""
    if unit is None:
        warnings.warn(f"{what} are taken in m, as no unit is stated; say unit=\"m\", or which it is", stacklevel=3)
    return unit or "m"


def _unit_name(unit: str | Quantity) -> str:
    return unit if isinstance(unit, str) else unit.unit if unit.value == 1.0 else str(unit)


def _warn_of_size(made: _core.Specimen, why: str) -> None:
    """Warns the caller's caller of an outline that is not as large as specimens are."""
    width, height = made.size[:2]
    if made.dimension == 2 and (min(width, height) < _USUAL[0] or max(width, height) > _USUAL[1]):
        warnings.warn(f"the outline is {width:.6g} m wide and {height:.6g} m high, but usually it is between "
                      f"{_USUAL[0]:g} and {_USUAL[1]:g} m: {why}", stacklevel=3)


def _pixels_of_blocks(made: _core.Specimen, image: NDArray[Any], side: float) -> list[NDArray[Any]]:
    """Returns for each block the pixels whose middle lies in it; of a block without any that in its middle."""
    at, rows = made.vertices / side, image.shape[0]
    seen = []
    for cell in made.cells:
        corners = at[cell]
        low, high = np.floor(corners.min(axis=0)).astype(int), np.ceil(corners.max(axis=0)).astype(int)
        x, y = (np.arange(low[k], high[k]) + 0.5 for k in (0, 1))
        edge = np.roll(corners, -1, axis=0) - corners
        # left of every edge
        inside = (edge[:, 0, None, None] * (y[:, None] - corners[:, 1, None, None])
                  >= edge[:, 1, None, None] * (x[None, :] - corners[:, 0, None, None])).all(axis=0)
        part = image[rows - high[1]:rows - low[1], low[0]:high[0]][::-1]
        found = part[inside]
        if not len(found):
            column, up = corners.mean(axis=0).astype(int)
            found = image[rows - 1 - up, column:column + 1]
        seen.append(found)
    return seen


def _stones(seen: list[NDArray[Any]], phase: NDArray[Any], number: NDArray[Any], of_stones: NDArray[Any]) -> ArrayLike:
    """Returns the stone of each block: the label that most of its pixels of its phase have, counted from 0 among the
    labels of stones, -1: none. Without such labels there are no stones.

    seen: of each block the places of its pixels' labels
    number: of each label its phase
    of_stones: of each label whether it is a stone
    """
    if not of_stones.any():
        return ()
    stone_of = np.where(of_stones, np.cumsum(of_stones) - 1, -1)
    stones = []
    for some, own in zip(seen, phase):
        labels, counts = np.unique(some[number[some] == own], return_counts=True)
        stones.append(stone_of[labels[counts.argmax()]] if len(labels) else -1)
    return np.array(stones)


def _one_piece(cells: list[NDArray[np.int32]], phase: NDArray[Any], votes: NDArray[np.int64]) -> NDArray[Any]:
    """Returns phases of blocks, -1 for those left out: the largest piece that hangs together by edges. Where two parts
    of it meet in a point alone, the block between them that has most of a phase is filled in.
    """
    phase = phase.copy()
    around: dict[int, list[int]] = {}
    sharing: dict[tuple[int, int], list[int]] = {}
    for i, cell in enumerate(cells):
        corners = [int(corner) for corner in cell]
        for a, b in zip(corners, corners[1:] + corners[:1]):
            around.setdefault(a, []).append(i)
            sharing.setdefault((min(a, b), max(a, b)), []).append(i)
    beside: list[set[int]] = [set() for _ in cells]
    on_edge = set()
    for (a, b), pair in sharing.items():
        if len(pair) == 1:
            on_edge |= {a, b}
        for i in pair:
            beside[i] |= set(pair) - {i}
    while True:
        seen, best = np.zeros(len(cells), bool), np.array([], int)
        for start in np.flatnonzero(phase >= 0):
            if seen[start]:
                continue
            seen[start], piece = True, [start]
            for i in piece:  # grows on the way
                for j in beside[i]:
                    if phase[j] >= 0 and not seen[j]:
                        seen[j] = True
                        piece.append(j)
            if len(piece) > len(best):
                best = np.array(piece)
        kept = np.zeros(len(cells), bool)
        kept[best] = True
        phase[~kept] = -1
        pinched = [v for v, some in around.items() if _fans(v, [i for i in some if kept[i]], cells) > 1]
        if not pinched:
            return phase
        void = [i for i in around[pinched[0]] if not kept[i]]
        filled = max(void, key=lambda i: int(votes[i, 1:].max()))
        if votes[filled, 1:].any():
            phase[filled] = votes[filled, 1:].argmax()
        else:
            phase[filled] = phase[next(i for i in around[pinched[0]] if kept[i])]


def _fans(vertex: int, some: list[int], cells: list[NDArray[np.int32]]) -> int:
    """Returns how many groups that hang together by edges the blocks around a vertex form."""
    ends = []
    for i in some:
        cell = [int(corner) for corner in cells[i]]
        k = cell.index(vertex)
        ends.append({cell[k - 1], cell[(k + 1) % len(cell)]})
    groups: list[set[int]] = []
    for pair in ends:
        met = [group for group in groups if group & pair]
        groups = [group for group in groups if not group & pair] + [pair.union(*met)]
    return len(groups)
