"""Stones in space whose surfaces are known, from a volume of labels, such as a CT scan, or a signed distance, as a file
that decks read.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import Error
from ..writing import write_text
from .units import Quantity, length

_SMOOTH = 1.0  # voxels over which the staircase of a volume is smoothed
_REACH = 6  # voxels around a stone that smoothing takes in
_FEWEST_VOXELS = 27  # of a stone
_FILES = (".npy", ".tif", ".tiff", ".vti", ".vtk")
_BEYOND = 1e-3  # voxels beyond the side of a volume where a stone that it cuts has ended
_PATHS = tuple(itertools.permutations(range(3)))  # the six tetrahedra of a cube, as ways along its edges


@dataclass(frozen=True)
class Stone:
    """Stone in space by the triangles of its surface."""

    vertices: NDArray[np.float64]
    """Corners of the triangles, (n, 3), m."""
    triangles: NDArray[np.int64]
    """Vertices of each triangle, (m, 3), counter-clockwise seen from outside."""
    phase: str = "aggregate"
    """Its phase, a table of [materials] in the deck."""

    @property
    def volume(self) -> float:
        """Volume, m³."""
        a, b, c = (self.vertices[self.triangles[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

    @property
    def area(self) -> float:
        """Area of the surface, m²."""
        a, b, c = (self.vertices[self.triangles[:, i]] for i in range(3))
        return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def stones_of_labels(volume: ArrayLike | str | Path, voxel: str | Quantity, *, matrix: int = 0,
                     phases: Mapping[int, str | None] | str = "aggregate",
                     gap: str | Quantity = "0 mm") -> list[Stone]:
    """Makes stones of a volume of labels: each connected part of a label is one, smoothed over a voxel, with its own
    volume. Holes are filled. A stone that the side of the volume cuts ends there. Stones of two labels that touch share
    the surface in the middle between both, or keep a gap there.

    volume: (nz, ny, nx) of labels, whole numbers, as an array or a file (.npy, a .tif of pages, or .vti and .vtk of
        images, which need the package vtk); the first row of a slice is at the top, the first slice at z = 0
    voxel: edge of a voxel, with its unit ("0.5 mm")
    matrix: label of the matrix
    phases: the phase of all stones, or of each label by its number; None: it is matrix
    gap: distance between the faces of stones that touch, with its unit; at their rims it may be less
    Raises Error where there is no stone, labels are no whole numbers or have no phase. Warns of parts of less than 27
    voxels, which are left out.
    """
    from scipy import ndimage
    side = length("voxel", voxel, "0.5 mm")
    between = length("gap", gap, "0.2 mm", is_size=False) / side
    labels, source = _labels_of(volume)
    shapes = np.zeros(labels.shape, np.int64)  # number of the stone of each voxel, from 1
    found: list[tuple[tuple[slice, ...], str]] = []
    small = 0
    for label in np.unique(labels).tolist():
        phase = _phase_of(label, matrix, phases, source)
        if phase is None:
            continue
        parts, _ = ndimage.label(labels == label)
        for number, box in enumerate(ndimage.find_objects(parts), 1):
            mask = ndimage.binary_fill_holes(parts[box] == number)
            if np.count_nonzero(mask) < _FEWEST_VOXELS:
                small += 1
                continue
            found.append((box, phase))
            shapes[box][mask & ((shapes[box] == 0) | (parts[box] == number))] = len(found)
    if small:
        warnings.warn(f"{source}{small} part{'s are' if small > 1 else ' is'} of less than {_FEWEST_VOXELS} voxels and "
                      "left out", stacklevel=2)
    if not found:
        raise Error(f"{source}no part of a label is large enough to be a stone: {_FEWEST_VOXELS} voxels or more")
    return [stone for number, (box, phase) in enumerate(found, 1)
            for stone in _stones_of_shape(shapes, number, box, side, between, phase)]


def stones_of_distance(distance: Callable[[NDArray[np.float64]], ArrayLike], low: Sequence[str | Quantity],
                       high: Sequence[str | Quantity], spacing: str | Quantity,
                       phase: str = "aggregate") -> list[Stone]:
    """Makes stones where a signed distance is negative.

    distance: takes places (n, 3) in m and returns n distances, negative within a stone
    low, high: corners of the box in which it is asked, with their units; at its sides stones end
    spacing: distance of the places, with its unit: a tenth of a stone or less
    Raises Error where the distance is negative nowhere, or is not a number somewhere.
    """
    step = length("spacing", spacing, "0.5 mm")
    corners = [[length(name, value, "0 mm", is_size=False) for value in corner]
               for name, corner in (("low", low), ("high", high))]
    axes = [np.linspace(a, b, max(2, round((b - a) / step) + 1)) for a, b in zip(*corners)]
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    values = np.asarray(distance(np.column_stack([x.ravel(), y.ravel(), z.ravel()])), float)
    if values.shape != (x.size,) or not np.isfinite(values).all():
        raise Error(f"the distance must return a number for each of {x.size} places")
    if not (values < 0.0).any():
        raise Error("the distance is negative nowhere in the box: there are no stones")
    field = values.reshape(x.shape)
    ends = [_closed(axis, _BEYOND * step) for axis in axes]
    field = np.pad(field, 1, constant_values=step)
    vertices, triangles = _surface(field, *ends)
    vertices = np.clip(vertices, np.asarray(corners[0]), np.asarray(corners[1]))
    return _parts(vertices, triangles, phase, _FEWEST_VOXELS * step**3)


def write_stones(file: str | Path, stones: Sequence[Stone]) -> None:
    """Writes stones as the file that `[aggregates.surfaces] obj` of a deck reads, in m."""
    lines, first = ["# stones, in m: an object each, of the phase that usemtl names"], 1
    for number, stone in enumerate(stones):
        lines += [f"o stone_{number}", f"usemtl {stone.phase}", "s 1"]
        lines += [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in stone.vertices.tolist()]
        lines += [f"f {a} {b} {c}" for a, b, c in (stone.triangles + first).tolist()]
        first += len(stone.vertices)
    write_text(Path(file), "\n".join(lines) + "\n")


def _phase_of(label: int, matrix: int, phases: Mapping[int, str | None] | str, source: str) -> str | None:
    if label == matrix or isinstance(phases, str):
        return None if label == matrix else str(phases)
    if label not in phases:
        raise Error(f"{source}the label {label} has no phase; phases has {', '.join(map(repr, phases)) or 'none'}, and "
                    f"the matrix is {matrix}")
    return phases[label]


def _labels_of(volume: ArrayLike | str | Path) -> tuple[NDArray[np.int64], str]:
    """Returns labels (nz, ny, nx), and what messages of them begin with."""
    source = f"{volume}: " if isinstance(volume, (str, Path)) else ""
    labels = _read(Path(volume)) if isinstance(volume, (str, Path)) else np.asarray(volume)
    if labels.ndim != 3 or not labels.size:
        raise Error(f"{source}a volume must be (slices, rows, columns) of labels, not {labels.shape}")
    if labels.dtype.kind not in "biuf" or not np.array_equal(labels, np.floor(labels)):
        raise Error(f"{source}labels must be whole numbers: np.digitize(volume, bounds) numbers grey values between "
                    "bounds")
    return labels.astype(np.int64), source


def _read(file: Path) -> NDArray[Any]:
    kind = file.suffix.lower()
    if kind not in _FILES:
        raise Error(f"{file}: a volume is read from {', '.join(_FILES)}; others are arrays to be read by hand")
    try:
        if kind == ".npy":
            return np.asarray(np.load(file, allow_pickle=False))
        if kind in (".tif", ".tiff"):
            from PIL import Image, ImageSequence
            with Image.open(file) as pages:
                return np.stack([np.array(page) for page in ImageSequence.Iterator(pages)])
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
        reader = vtk.vtkXMLImageDataReader() if kind == ".vti" else vtk.vtkStructuredPointsReader()
        if not file.is_file():
            raise Error(f"{file}: there is no such file")
        reader.SetFileName(str(file))
        reader.Update()
        image = reader.GetOutput()
        scalars = image.GetPointData().GetScalars() or image.GetPointData().GetArray(0)
        size = image.GetDimensions()
        if scalars is None and image.GetCellData().GetNumberOfArrays():
            scalars = image.GetCellData().GetScalars() or image.GetCellData().GetArray(0)
            size = tuple(n - 1 for n in size)
        if scalars is None:
            raise Error(f"{file}: the image has no array of labels")
        # y goes up in VTK, rows go down in slices
        return np.asarray(vtk_to_numpy(scalars).reshape(size[::-1])[:, ::-1])
    except ImportError as error:
        raise Error(f"{file}: reading it needs the package {error.name}; or give an array") from None
    except (OSError, ValueError) as error:
        raise Error(f"{file}: {error}") from None


def _smoothed(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Returns the smoothed distance of voxels from a mask's surface, in voxels, negative within."""
    from scipy import ndimage
    # from the middle of a voxel to that of the nearest one on the other side; the surface lies half a voxel before
    signed = ndimage.distance_transform_edt(~mask) - ndimage.distance_transform_edt(mask) + mask - 0.5
    smoothed: NDArray[np.float64] = ndimage.gaussian_filter(signed, _SMOOTH, mode="nearest")
    return smoothed


def _stones_of_shape(shapes: NDArray[np.int64], number: int, box: tuple[slice, ...], side: float, gap: float,
                     phase: str) -> list[Stone]:
    """Returns the stone of a number: its surface moves evenly until its volume is that of its voxels. Beside other
    stones it stays half a gap before the middle. Smoothing may leave more than one part.
    """
    from scipy import optimize
    first = [own.start - _REACH for own in box]
    near = shapes[np.ix_(*(np.clip(np.arange(begin, own.stop + _REACH), 0, size - 1)
                           for begin, own, size in zip(first, box, shapes.shape)))]
    own = _smoothed(near == number)
    others = (near > 0) & (near != number)
    middle = np.full(near.shape, -np.inf)
    if others.any():
        middle = 0.5 * (own - _smoothed(others)) + 0.5 * gap
    kept = tuple(slice(max(-begin, 0), min(size - begin, count))
                 for begin, size, count in zip(first, shapes.shape, near.shape))
    own, middle = own[kept], middle[kept]
    axes = [np.arange(max(begin, 0), max(begin, 0) + count) + 0.5 for begin, count in zip(first, own.shape)]
    voxels = np.count_nonzero(near[kept] == number)

    def field(moved: float) -> NDArray[np.float64]:
        return np.maximum(own - moved, middle)

    def excess(moved: float) -> float:
        return float(np.clip(0.5 - field(moved), 0.0, 1.0).sum() - voxels)

    moved = optimize.brentq(excess, -2.0, 2.0, xtol=1e-6) if excess(-2.0) < 0.0 < excess(2.0) else 0.0
    # the side of the volume, half a voxel beyond the last places, and an end just outside
    values = np.pad(field(moved), 1, mode="edge")
    values = np.pad(values, 1, constant_values=1.0)
    ends = [_closed(np.concatenate([[axis[0] - 0.5], axis, [axis[-1] + 0.5]]), _BEYOND) for axis in axes]
    vertices, triangles = _surface(values, *ends[::-1])
    vertices = np.clip(vertices, 0.0, shapes.shape[::-1])
    vertices[:, 1] = shapes.shape[1] - vertices[:, 1]
    return _parts(side * vertices, triangles[:, ::-1], phase, _FEWEST_VOXELS * side**3)


def _closed(axis: NDArray[np.float64], beyond: float) -> NDArray[np.float64]:
    return np.concatenate([[axis[0] - beyond], axis, [axis[-1] + beyond]])


def _parts(vertices: NDArray[np.float64], triangles: NDArray[np.int64], phase: str, least: float) -> list[Stone]:
    """Returns the closed parts of a surface that hold a volume: inner ones are holes, which are filled."""
    from scipy import sparse
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]])
    graph = sparse.coo_matrix((np.ones(len(edges)), edges.T), (len(vertices), len(vertices)))
    count, part = sparse.csgraph.connected_components(graph, directed=False)
    stones = []
    for number in range(count):
        own = triangles[part[triangles[:, 0]] == number]
        used, renumbered = np.unique(own, return_inverse=True)
        stone = Stone(vertices[used], renumbered.reshape(own.shape), phase)
        if len(own) and stone.volume > least:
            stones.append(stone)
    return stones


def _surface(field: NDArray[np.float64], x: NDArray[np.float64], y: NDArray[np.float64],
             z: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Returns the surface where a field (nz, ny, nx) is 0, by tetrahedra: six in each cube, around one diagonal (A. Doi
    and A. Koide, IEICE Trans. E74 (1991) 214). It is closed, with the negative side within.
    """
    values = np.where(field == 0.0, np.finfo(float).tiny, field).ravel()
    nz, ny, nx = field.shape
    strides = (1, nx, nx * ny)
    base = np.arange(values.size).reshape(field.shape)[:-1, :-1, :-1].ravel()
    low = high = values[base]
    for corner in range(1, 8):
        at = values[base + sum(strides[d] for d in range(3) if corner >> d & 1)]
        low, high = np.minimum(low, at), np.maximum(high, at)
    base = base[(low < 0.0) & (high > 0.0)]
    pairs = []  # (n, 3, 2): the ends of the three edges on which the corners of a triangle lie
    for way in _PATHS:
        corners = base[:, None] + np.cumsum([0, *(strides[d] for d in way)])
        inside = values[corners] < 0.0
        for pattern in range(1, 15):
            chosen = corners[(inside == [bool(pattern >> i & 1) for i in range(4)]).all(axis=1)]
            if not len(chosen):
                continue
            ins = [i for i in range(4) if pattern >> i & 1]
            outs = [i for i in range(4) if not pattern >> i & 1]
            # corners as they follow one another tell the sense of a triangle, however flat it is
            turned = _is_odd(way) != _is_odd([*ins, *outs])
            if len(ins) == 2:
                (a, b), (c, d) = ins, outs
                found = [[(a, c), (a, d), (b, d)], [(a, c), (b, d), (b, c)]]
            else:
                found = [[(i, o) for i in ins for o in outs]]
            for triangle in found:
                edges = triangle[::-1] if turned else triangle
                pairs.append(np.stack([chosen[:, list(edge)] for edge in edges], axis=1))
    ends = np.sort(np.concatenate(pairs), axis=2)
    keys, numbers = np.unique(ends[..., 0] * values.size + ends[..., 1], return_inverse=True)
    triangles = numbers.reshape(-1, 3)

    def places(points: NDArray[np.int64]) -> NDArray[np.float64]:
        return np.column_stack([x[points % nx], y[points // nx % ny], z[points // (nx * ny)]])

    from_, to = keys // values.size, keys % values.size
    share = values[from_] / (values[from_] - values[to])
    vertices = places(from_) + share[:, None] * (places(to) - places(from_))
    return vertices, triangles


def _is_odd(order: Sequence[int]) -> bool:
    """Tells whether a permutation is odd."""
    return bool(sum(a > b for a, b in itertools.combinations(order, 2)) % 2)
