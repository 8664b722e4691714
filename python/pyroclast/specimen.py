"""Specimens from arrays, meshes and labelled images."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import Error
from .units import Quantity

if TYPE_CHECKING:
    import meshio

    from .decks import Deck

Label = Union[int, str]

_MESH_CELLS = ("triangle", "quad", "polygon")
_LESS_THAN_CELLS = ("vertex", "line")
_FLAT = 1e-9  # of the size of a mesh


class Specimen:
    """Blocks, and what each is made of. A deck takes one in the place of what it says of the specimen itself:

        deck["specimen"] = pyroclast.Specimen.from_arrays(vertices, cells, labels)

    Its run keeps the blocks in its folder, so that the deck there gives the same run without the script. Arrays are
    copies, in m.
    """

    def __init__(self, core: _core.Specimen, agreement: float | None = None):
        self._core = core
        self._agreement = agreement

    @classmethod
    def from_arrays(cls, vertices: ArrayLike, cells: Sequence[ArrayLike] | NDArray[Any], labels: Sequence[Label],
                    phases: Mapping[Any, str] | None = None) -> Specimen:
        """A specimen of cells that are made elsewhere.

        vertices: (n, 2), m.
        cells: for each the numbers of its vertices in turn, from 0, in either sense; neighbours share vertices.
        labels: of each cell, the name of its phase, or what `phases` has the name for.
        phases: the name of each label's phase, in the order that `phase` counts in; None: labels are names.

        Each phase needs its tables of [materials] and [contacts]. Where cells leave places free, there are holes;
        `sides` has what the sides are called.

        Raises Error, naming the cell, where one is not convex, names a vertex that there is not, has a label without a
        name or does not fit together with its neighbours; and where the cells are not one piece.
        """
        at = np.asarray(vertices, float)
        if at.ndim != 2 or at.shape[1] != 2:
            raise Error(f"vertices must be (n, 2), not {at.shape}")
        rows = [_corners(cell, number) for number, cell in enumerate(cells)]
        if not rows:
            raise Error("there are no cells")
        names, phase = _named(labels, phases)
        first = np.cumsum([0, *map(len, rows)]).astype(np.int32)
        return cls(_core.Specimen.from_cells(at, np.concatenate(rows), first, names, phase))

    @classmethod
    def from_meshio(cls, mesh: meshio.Mesh, data: str, phases: Mapping[Any, str]) -> Specimen:
        """A specimen of the triangles, quads and polygons of a mesh, in m; its lines and vertices are left out.

        data: name of the cell data that label the cells.
        phases: the name of each label's phase.

        Raises Error for other cells, for a mesh that does not lie in a plane z = const., for cell data that are not
        there, and as `from_arrays`.
        """
        points = np.asarray(mesh.points, float)
        size = float(np.ptp(points, axis=0).max())
        if points.shape[1] == 3 and np.ptp(points[:, 2]) > _FLAT * size:
            raise Error("the mesh does not lie in a plane z = const.")
        if data not in mesh.cell_data:
            raise Error(f"the mesh has no cell data {data!r}; it has {', '.join(mesh.cell_data) or 'none'}")
        cells: list[NDArray[Any]] = []
        labels: list[Any] = []
        for block, values in zip(mesh.cells, mesh.cell_data[data]):
            if block.type in _LESS_THAN_CELLS:
                continue
            if not block.type.startswith(_MESH_CELLS) or block.type[-1:].isdigit() and block.type[:4] != "poly":
                raise Error(f"the mesh has cells of type {block.type!r}; blocks can be {', '.join(_MESH_CELLS)}")
            cells += list(block.data)
            labels += np.asarray(values).tolist()
        used, numbers = np.unique(np.concatenate(cells) if cells else [], return_inverse=True)
        ends = np.cumsum([len(cell) for cell in cells])[:-1]
        return cls.from_arrays(points[used.astype(int), :2], np.split(numbers, ends) if cells else [], labels, phases)

    @classmethod
    def from_image(cls, image: ArrayLike, pixel: str | Quantity, phases: Mapping[Any, str | None], *, blocks: int,
                   seed: int = 1, shortest_edge: float = 0.2, relaxation: int = 0,
                   radius_spread: float = 0.0) -> Specimen:
        """A specimen of Voronoi blocks, each of the phase that most of its pixels are of.

        image: (rows, columns) of labels, the first row on top: the rectangle from [0, 0] to columns and rows times
            `pixel`.
        pixel: the side of one, with its unit ("0.2 mm").
        phases: the name of each label's phase; None: there is nothing, so that blocks there are left out, and pieces
            that do not hang together with the largest.
        blocks: their number in the rectangle.
        seed, shortest_edge, relaxation, radius_spread: as a deck's keys of these names.

        `agreement` tells which share of the image is of the phase of its block. Blocks must be smaller than what they
        shall show, and larger than a pixel; a smaller one is of the pixel in its middle.

        Raises Error for a label without a name, naming its pixel, and for an image without anything.
        """
        pixels = np.asarray(image)
        if pixels.ndim != 2:
            raise Error(f"an image must be (rows, columns), not {pixels.shape}")
        side = _length(pixel)
        names = list(dict.fromkeys(name for name in phases.values() if name is not None))
        shown = np.full(pixels.shape, -2)
        for label, name in phases.items():
            shown[pixels == label] = -1 if name is None else names.index(name)
        if (shown == -2).any():
            row, column = np.argwhere(shown == -2)[0]
            raise Error(f"pixel [{row}, {column}] has the label {pixels[row, column].item()!r}, for which there is no "
                        f"phase; there are {', '.join(map(repr, phases))}")
        rows, columns = shown.shape
        made = _core.Specimen.rectangle(columns * side, rows * side, blocks, shortest_edge, relaxation, radius_spread,
                                        seed)
        votes = _votes(made, shown, side, len(names))
        phase = votes.argmax(axis=1) - 1
        cells = made.cells
        if None in phases.values():
            phase = _one_piece(cells, phase, votes)
        kept = np.flatnonzero(phase >= 0)
        if not len(kept):
            raise Error("there is nothing in the image that is as large as a block")
        alike = float(np.take_along_axis(votes, phase[:, None] + 1, axis=1).sum() / votes.sum())
        used, numbers = np.unique(np.concatenate([cells[i] for i in kept]), return_inverse=True)
        ends = np.cumsum([len(cells[i]) for i in kept])[:-1]
        whole = cls.from_arrays(made.vertices[used], np.split(numbers, ends), phase[kept], dict(enumerate(names)))
        return cls(whole._core, alike)

    @classmethod
    def of(cls, deck: Deck | str | Path, seed: int | None = None) -> Specimen:
        """The specimen that a run of a deck has, with this seed or the deck's. Raises as `Run`."""
        from .decks import as_deck
        from .functions import Scratch
        return cls(_core.Specimen.of_deck(as_deck(deck)._resolved(Scratch()), seed))

    @classmethod
    def read(cls, file: str | Path) -> Specimen:
        """From a file as `save` writes it. Raises Error, which names the file."""
        return cls(_core.Specimen.read(str(file)))

    def save(self, file: str | Path) -> None:
        """Writes the blocks as JSON; a deck reads them by `[specimen] shape = "cells"` and `file`."""
        Path(file).write_text(self._core.text(), encoding="utf-8")

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(vertices, 2), m."""
        return self._core.vertices

    @property
    def cells(self) -> list[NDArray[np.int32]]:
        """For each block the numbers of its vertices, counter-clockwise."""
        return self._core.cells

    @property
    def phases(self) -> list[str]:
        """Names of what blocks can be made of."""
        return self._core.phases

    @property
    def phase(self) -> NDArray[np.int32]:
        """(blocks,): indices into `phases`."""
        return self._core.phase

    @property
    def shares(self) -> dict[str, float]:
        """Share of the area that each phase takes [1]."""
        return dict(zip(self._core.phases, self._core.shares))

    @property
    def area(self) -> float:
        """m²."""
        return self._core.area

    @property
    def sides(self) -> list[str]:
        """What the sides are called: `bottom`, `right`, `top`, `left` of a rectangle along the axes; of another outline
        `side_1`, `side_2`, ... from its lowest corner on, counter-clockwise; then `hole_1`, ...
        """
        return self._core.sides

    @property
    def agreement(self) -> float | None:
        """Share of an image that is of the phase of its block [1]; None where there was no image."""
        return self._agreement

    def to_meshio(self) -> meshio.Mesh:
        """As polygons in space, z = 0, with the cell data `phase`."""
        import meshio
        phase, cells = self.phase, self.cells
        size = np.array([len(cell) for cell in cells])
        of_size = [np.flatnonzero(size == n) for n in np.unique(size)]
        points = np.column_stack([self.vertices, np.zeros(len(self.vertices))])
        return meshio.Mesh(points, [("polygon", np.array([cells[i] for i in some])) for some in of_size],
                           cell_data={"phase": [phase[some] for some in of_size]})

    def __repr__(self) -> str:
        shares = ", ".join(f"{name} {share:.3f}" for name, share in self.shares.items())
        return f"<Specimen of {len(self._core.phase)} blocks: {shares}>"


def _corners(cell: ArrayLike, number: int) -> NDArray[np.int32]:
    corners = np.asarray(cell)
    if corners.ndim != 1 or corners.dtype.kind not in "iu":
        raise Error(f"cell {number} must be a list of vertices by their numbers")
    if len(corners) and not 0 <= corners.min() <= corners.max() < 2**31:
        raise Error(f"cell {number} names vertex {corners.min() if corners.min() < 0 else corners.max()}, which cannot "
                    "be")
    return corners.astype(np.int32)


def _named(labels: Sequence[Label], phases: Mapping[Any, str] | None) -> tuple[list[str], NDArray[np.int32]]:
    """Names of phases, and of each cell an index into them."""
    values: list[Any] = np.asarray(labels).tolist() if isinstance(labels, np.ndarray) else list(labels)
    names = list(dict.fromkeys(values if phases is None else phases.values()))
    for number, label in enumerate(values):
        if phases is None and not isinstance(label, str):
            raise Error(f"cell {number} has the label {label!r}; say by phases={{{label!r}: ...}} what it is called")
        if phases is not None and label not in phases:
            raise Error(f"cell {number} has the label {label!r}, for which there is no phase; there are "
                        f"{', '.join(map(repr, phases))}")
    place = {name: i for i, name in enumerate(names)}
    return names, np.array([place[label if phases is None else phases[label]] for label in values], np.int32)


def _length(pixel: str | Quantity) -> float:
    if isinstance(pixel, (int, float)):
        raise Error(f'pixel: a unit of length is needed, e.g. "0.2 mm"; got {pixel!r}')
    return _core.convert(str(pixel), "m")


def _votes(made: _core.Specimen, shown: NDArray[Any], side: float, phases: int) -> NDArray[np.int64]:
    """(blocks, 1 + phases): pixels of nothing and of each phase whose middle lies in each block; of a block without any
    that in its middle.
    """
    at, rows = made.vertices / side, shown.shape[0]
    votes = np.zeros((len(made.phase), 1 + phases), np.int64)
    for i, cell in enumerate(made.cells):
        corners = at[cell]
        low, high = np.floor(corners.min(axis=0)).astype(int), np.ceil(corners.max(axis=0)).astype(int)
        x, y = (np.arange(low[k], high[k]) + 0.5 for k in (0, 1))
        edge = np.roll(corners, -1, axis=0) - corners
        # left of every edge
        inside = (edge[:, 0, None, None] * (y[:, None] - corners[:, 1, None, None])
                  >= edge[:, 1, None, None] * (x[None, :] - corners[:, 0, None, None])).all(axis=0)
        part = shown[rows - high[1]:rows - low[1], low[0]:high[0]][::-1]
        found = part[inside]
        if not len(found):
            column, up = corners.mean(axis=0).astype(int)
            found = shown[rows - 1 - up, column:column + 1]
        votes[i] = np.bincount(found + 1, minlength=1 + phases)
    return votes


def _one_piece(cells: list[NDArray[np.int32]], phase: NDArray[Any], votes: NDArray[np.int64]) -> NDArray[Any]:
    """Phases of blocks, -1 for those left out: the largest piece that hangs together by edges. Where two parts of it
    meet in a point alone, the block between them that has most of a phase is filled in.
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
    """Into how many groups that hang together by edges the blocks around a vertex fall."""
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
