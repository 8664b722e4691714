"""Outlines of stones that are known, from a signed distance or an image of labels, as a table that decks read."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import Error
from ..writing import write_text
from .label_image import counted, keys_of, numbered, pixels_of
from .units import Quantity, length

_SMOOTH = 1.0  # pixels over which the staircase of an image is smoothed
_REACH = 6  # pixels around a stone that smoothing takes in
_GAP = 1.0  # pixels: a gap between two stones stays one where the smoothed distance from both is above minus this
_FEWEST_POINTS = 6


@dataclass(frozen=True)
class FlatStone:
    """Stone in the plane by the points of its outline."""

    outline: NDArray[np.float64]
    """Points of the outline, (n, 2), m; the last joins the first."""
    phase: int = 0
    """Number of its phase, as `phases` of a deck's [aggregates.outlines] counts from 0."""

    @property
    def area(self) -> float:
        """Area, m²."""
        return abs(_signed_area(self.outline))

    @property
    def perimeter(self) -> float:
        """Length of the outline, m."""
        return float(np.linalg.norm(np.roll(self.outline, -1, axis=0) - self.outline, axis=1).sum())


def stones_of_distance(distance: Callable[[NDArray[np.float64]], ArrayLike], low: Sequence[str | Quantity],
                       high: Sequence[str | Quantity], spacing: str | Quantity, phase: int = 0) -> list[FlatStone]:
    """Makes stones where a signed distance is negative: a line around each, its holes filled.

    distance: takes places (n, 2) in m and returns n distances, negative within a stone, in any unit. It is asked once,
    here: what a deck reads is the table of `write_stones`.
    low, high: corners of the box in which it is asked, with their units (["0 mm", "0 mm"])
    spacing: distance of the places, with its unit: a tenth of a block size or less
    Raises Error where the function returns other shapes or values, is negative nowhere, is a mask of two values, or is
    negative on the edge of the box, as where a stone reaches out or the distance is positive in stones. Warns of stones
    that are too small for the spacing; they are left out.
    """
    if not callable(distance):
        raise Error(f"the distance is of the type {type(distance).__name__}, not a function of places; an image of "
                    "labels, or a mask, belongs to stones_of_labels")
    corners = [[length(f"{name}[{i}]", value, "0 mm", is_size=False) for i, value in enumerate(corner)]
               for name, corner in (("low", low), ("high", high))]
    step = length("spacing", spacing, "0.2 mm")
    lows, highs = np.array(corners[0]), np.array(corners[1])
    if lows.shape != (2,) or highs.shape != (2,) or not np.all(highs > lows) or not step < np.min(highs - lows):
        raise Error(f"low {corners[0]} m, high {corners[1]} m and spacing {step} m are no grid: low must be below "
                    "high, and the spacing below both widths")
    counts = np.ceil((highs - lows) / step).astype(int) + 1
    x, y = (np.linspace(lows[i], highs[i], counts[i]) for i in range(2))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    values = np.asarray(distance(places))
    if values.shape != (len(places),):
        raise Error(f"the distance returned an array of {values.shape} for {len(places)} places; it must be "
                    f"({len(places)},)")
    return _stones_below(x, y, _distances(values, places).reshape(len(y), len(x)), phase)


def _distances(values: NDArray[Any], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns what a function returned as distances. Raises Error where they cannot be."""
    if values.dtype.kind not in "biuf":
        raise Error(f"the distance returned values of the type {values.dtype}; they must be numbers")
    odd = ~np.isfinite(values)
    if odd.any():
        raise Error(f"the distance is {values[odd][0]} at {places[odd][0].tolist()} m; it must be finite")
    few = np.unique(values)
    if len(few) <= 2:
        raise Error(f"the distance has the value{'s' if len(few) > 1 else ''} {' and '.join(map(str, few.tolist()))} "
                    "alone, as a mask has; a distance tells how far the surface is. Hand a mask to stones_of_labels, "
                    "as an image of labels, or make a distance of it by edt = scipy.ndimage.distance_transform_edt: "
                    "edt(~mask) - edt(mask)")
    if not few[0] < 0:
        raise Error(f"the distance is negative nowhere, the least is {few[0]:.6g}: there is no stone. It must be "
                    "negative within stones")
    return values.astype(float)


def _stones_below(x: NDArray[np.float64], y: NDArray[np.float64], values: NDArray[np.float64],
                  phase: int) -> list[FlatStone]:
    """Returns the stones where values on a grid are negative. Raises Error where they are on its edge."""
    on_edge = np.ones(values.shape, bool)
    on_edge[1:-1, 1:-1] = False
    out = np.argwhere(on_edge & (values < 0.0))
    if len(out):
        row, column = out[0]
        turned = "" if np.any(values[on_edge] >= 0.0) else " all along"
        raise Error(f"the distance is negative on the edge of the box{turned}, at ({x[column]:.6g}, {y[row]:.6g}) m. "
                    "Either a stone reaches out of the box: make the box larger. Or the distance is positive within "
                    "stones: give its negative, lambda places: -distance(places)")
    found = _outlines_below(x, y, values)
    stones = [FlatStone(outline, phase) for outline in found if len(outline) >= _FEWEST_POINTS]
    if len(stones) < len(found):
        places = [outline.mean(axis=0) for outline in found if len(outline) < _FEWEST_POINTS]
        warnings.warn(f"{len(places)} stone{' is' if len(places) == 1 else 's are'} too small for the spacing and left "
                      f"out, the first near ({places[0][0]:.6g}, {places[0][1]:.6g}) m: take a smaller spacing",
                      stacklevel=3)
    return stones


def stones_of_labels(image: ArrayLike | str | Path, pixel: str | Quantity, *, matrix: int = 0,
                     phases: Mapping[Any, int | None] | None = None) -> list[FlatStone]:
    """Makes stones of an image of labels: each connected part of a label is one, smoothed over a pixel, with its own
    area.

    A hole in a stone, as a pore is in a stone of a scan, is filled: stones are whole. Smoothing cuts a neck of one
    pixel, as segmentation leaves between stones that nearly touch: both sides become stones, and each gets the nearer
    half of the neck's pixels. A stone that reaches the edge of the image ends there, on a straight line. Stones of two
    labels that touch, as of a watershed, share the line between them; where other stones surround a small one, its area
    may be some percent less than that of its pixels.

    image: (rows, columns) of labels, whole numbers, as an array or a file; row 0 is at the top
    pixel: edge of a pixel, with its unit ("50 um")
    matrix: label of the matrix
    phases: the number of each other label's phase. A key may be several labels, as a range, a tuple or a frozenset, or
    `...` for all that have no key: `{...: 0}` makes all stones of a watershed one phase. None as a number: the label
    counts as matrix. Without `phases` the labels are phases 0, 1, ... in ascending order.
    Raises Error where there is no stone, labels are no whole numbers or have no phase, a hole of a stone holds another
    label than the matrix, or a label fills all of the image. Warns of parts that are too small to be stones, under some
    three pixels across; they are left out.
    """
    side = length("pixel", pixel, "50 um")
    pixels, source = pixels_of(image)
    if pixels.dtype.kind == "U":
        raise Error(f"{source}the labels are texts, such as {str(pixels[0, 0])!r}; labels of stones must be whole "
                    "numbers")
    parts = [part for stone in _stones_of(pixels, matrix, phases, source) for part in _parts_of(stone, pixels)]
    kept = [part for part in parts if not part.is_small]
    if not kept:
        raise Error(f"{source}no part of a label is large enough to be a stone: three pixels or more across")
    if len(kept) < len(parts):
        small = [part for part in parts if part.is_small]
        row, column = small[0].first
        warnings.warn(f"{source}{len(small)} part{' is' if len(small) == 1 else 's are'} too small to be stones and "
                      f"left out, the first at row {row}, column {column}: {sum(part.pixels for part in small):.0f} "
                      "pixels together. A stone is three pixels or more across", stacklevel=2)
    shapes = np.zeros(pixels.shape, np.int64)  # number of the stone of each pixel, from 1
    for number, part in enumerate(kept, 1):
        shapes[part.box][part.mask] = number
    return [_stone_of_shape(shapes, number, part, side) for number, part in enumerate(kept, 1)]


def write_stones(file: str | Path, stones: Sequence[FlatStone]) -> None:
    """Writes stones as the table that `[aggregates.outlines] csv` of a deck reads."""
    lines = ["grain,x_m,y_m,phase"]
    for number, stone in enumerate(stones):
        lines += [f"{number},{x:.9g},{y:.9g},{stone.phase}" for x, y in stone.outline]
    write_text(Path(file), "\n".join(lines) + "\n")


@dataclass(frozen=True)
class _Part:
    """Part of an image that becomes a stone."""

    mask: NDArray[np.bool_]  # of its box
    box: tuple[slice, slice]  # rows and columns of the image
    pixels: float  # area of its stone
    phase: int
    label: int
    source: str
    free: NDArray[np.bool_]  # of its box: pixels of the matrix, which it may enclose
    is_small: bool = False  # smoothing leaves nothing of it

    @property
    def first(self) -> tuple[int, int]:
        """Row and column of its first pixel."""
        row, column = np.argwhere(self.mask)[0]
        return int(row) + self.box[0].start, int(column) + self.box[1].start


def _stones_of(pixels: NDArray[Any], matrix: int, phases: Mapping[Any, int | None] | None, source: str) -> list[_Part]:
    """Returns each connected part of each label, its holes filled."""
    from scipy import ndimage
    labels, place = numbered(pixels)
    if phases is None:
        phases = {label: number for number, label in enumerate(label for label in labels if label != matrix)}
    for key, number in phases.items():
        if number is not None and not (isinstance(number, (int, np.integer)) and number >= 0):
            raise Error(f"phases: {'...' if key is ... else repr(key)} has the phase {number!r}; it must be a number "
                        "from 0, which `phases` of [aggregates.outlines] in the deck names, or None for matrix")
    phases = {matrix: None, **phases}
    of_label = [phases[key] for key in keys_of(labels, place, phases, source)]
    if all(phase is None for phase in of_label):
        raise Error(f"{source}all pixels are of the matrix: there are no stones. The image has "
                    f"{counted(labels, place)}")
    is_free = np.array([phase is None for phase in of_label])[place]
    stones = []
    for number, (phase, around) in enumerate(zip(of_label, ndimage.find_objects(place + 1))):
        if phase is None:
            continue
        parts, count = ndimage.label(place[around] == number)
        for part, inner in zip(range(1, count + 1), ndimage.find_objects(parts)):
            rows, columns = (slice(a.start + b.start, a.start + b.stop) for a, b in zip(around, inner))
            own = parts[inner] == part
            mask = ndimage.binary_fill_holes(own)
            stone = _Part(mask, (rows, columns), float(np.count_nonzero(mask)), phase, labels[number], source,
                          is_free[rows, columns])
            _require_free(stone, mask & ~own, pixels)
            if mask.size == pixels.size and mask.all():
                raise Error(f"{source}the label {labels[number]} fills all of the image or surrounds the others, as a "
                            f"matrix does; if it is the matrix, say matrix={labels[number]}")
            stones.append(stone)
    return stones


def _require_free(part: _Part, enclosed: NDArray[np.bool_], pixels: NDArray[Any]) -> None:
    """Raises Error where a part encloses another label than its own and the matrix."""
    others = np.argwhere(enclosed & ~part.free & (pixels[part.box] != part.label))
    if len(others):
        row, column = others[0] + (part.box[0].start, part.box[1].start)
        raise Error(f"{part.source}a stone of label {part.label} encloses the label {pixels[row, column]} at row "
                    f"{row}, column {column}; a stone can have no other inside")


def _parts_of(stone: _Part, pixels: NDArray[Any]) -> list[_Part]:
    """Returns the parts that smoothing leaves of a stone, without hairs, each with its share of the stone's pixels."""
    from scipy import ndimage
    todo, done = [stone], []
    while todo:
        part = todo.pop()
        inner = _smoothed(_extended(part, pixels.shape))[_REACH:-_REACH, _REACH:-_REACH] < 0.0
        closed = ndimage.binary_fill_holes(inner) & ~inner & ~part.mask  # where the mouth is one pixel wide
        if closed.any():
            _require_free(part, closed, pixels)
            todo.append(replace(part, mask=part.mask | closed, pixels=part.pixels + np.count_nonzero(closed)))
            continue
        cores, count = ndimage.label(inner)
        if not count:
            done.append(replace(part, is_small=True))
            continue
        nearest = ndimage.distance_transform_edt(cores == 0, return_distances=False, return_indices=True)
        owner = np.where(part.mask, cores[tuple(nearest)], 0)
        for core in range(1, count + 1):
            own = owner == core
            mask = own & ndimage.binary_dilation(cores == core, np.ones((3, 3)))
            share = np.count_nonzero(own) / np.count_nonzero(part.mask)
            smaller = replace(part, mask=mask, pixels=part.pixels * share)
            (done if np.array_equal(mask, part.mask) else todo).append(smaller)
    return done


def _extended(part: _Part, size: tuple[int, ...]) -> NDArray[np.bool_]:
    """Returns the mask of a part with free pixels around; beyond the edge of the image the part goes on."""
    mask = part.mask
    for axis, (own, end) in enumerate(zip(part.box, size)):
        for side, is_cut in enumerate((own.start == 0, own.stop == end)):
            width = [(0, 0), (0, 0)]
            width[axis] = (0, _REACH) if side else (_REACH, 0)
            mask = np.pad(mask, width, mode="edge" if is_cut else "constant")
    return mask


def _smoothed(mask: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Returns the smoothed distance of pixels from a mask's surface, in pixels, negative within."""
    from scipy import ndimage
    signed = ndimage.distance_transform_edt(~mask) - ndimage.distance_transform_edt(mask)
    smoothed: NDArray[np.float64] = ndimage.gaussian_filter(signed, _SMOOTH, mode="nearest")
    return smoothed


def _stone_of_shape(shapes: NDArray[np.int64], number: int, part: _Part, side: float) -> FlatStone:
    """Returns the stone of a part: its outline moves evenly until its area is that of its pixels. Beside another stone
    it stays on the line in the middle between both, which both have.
    """
    from scipy import optimize
    most = 2.0 + 2.0 * (math.sqrt(part.pixels / math.pi) - math.sqrt(np.count_nonzero(part.mask) / math.pi))
    margin = _REACH + math.ceil(most)
    first = [own.start - margin for own in part.box]
    near = shapes[np.ix_(*(np.clip(np.arange(begin, own.stop + margin), 0, size - 1)
                           for begin, own, size in zip(first, part.box, shapes.shape)))]
    fields = np.full((2, *near.shape), -np.inf)  # distance from the surface, and from the middle to other stones
    fields[0] = _smoothed(near == number)
    if others := set(np.unique(near).tolist()) - {0, number}:
        fields[1] = 0.5 * (fields[0] - np.min([_smoothed(near == other) for other in others], axis=0))
        # smoothing rounds corners where three stones meet: no matrix comes about there
        fields[0] = np.minimum(fields[0], _smoothed(near > 0) + _GAP)
    fields, row = _within_image(fields, 1, first[0], shapes.shape[0])
    fields, column = _within_image(fields, 2, first[1], shapes.shape[1])
    y, fields = shapes.shape[0] - row[::-1], fields[:, ::-1]

    def outline(moved: float) -> NDArray[np.float64]:
        found = _outlines_below(column, y, np.maximum(fields[0] - moved, fields[1]))
        return max(found, key=_signed_area, default=np.zeros((0, 2)))

    def excess(moved: float) -> float:
        return _signed_area(outline(moved)) - part.pixels

    # a stone among others has no room for more than its pixels
    moved = optimize.brentq(excess, -most, most, xtol=1e-6) if excess(-most) < 0.0 < excess(most) else 0.0
    return FlatStone(side * outline(moved), part.phase)


def _within_image(fields: NDArray[np.float64], axis: int, first: int,
                  size: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Returns the part of fields of pixels that lies in the image, which has so many along an axis, up to the image's
    edge, and the places, in pixels.
    """
    count = fields.shape[axis]
    low, high = max(-first, 0), min(size - first, count)
    parts, places = [fields.take(range(low, high), axis)], [first + np.arange(low, high) + 0.5]
    for is_beyond, inner, edge in ((low > 0, low, 0.0), (high < count, high, float(size))):
        if is_beyond:
            on_edge = fields.take([inner - 1, inner], axis).mean(axis=axis, keepdims=True)
            at = 0 if edge == 0.0 else len(parts)
            parts.insert(at, on_edge)
            places.insert(at, np.array([edge]))
    return np.concatenate(parts, axis), np.concatenate(places)


def _signed_area(outline: NDArray[np.float64]) -> float:
    """Returns the area of a polygon, positive where its points run counter-clockwise."""
    x, y = outline.T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def _outlines_below(x: NDArray[np.float64], y: NDArray[np.float64],
                    values: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Returns the outer lines around places of a grid where values are negative, counter-clockwise, up to its edge."""
    from contourpy import FillType, contour_generator
    generator = contour_generator(x, y, values, fill_type=FillType.OuterOffset)
    outlines = []
    for points, ends in zip(*generator.filled(min(float(values.min()), 0.0) - 1.0, 0.0)):
        line = points[:ends[1] - 1]  # the last point of each line is its first; lines around holes follow
        apart = np.linalg.norm(np.roll(line, -1, axis=0) - line, axis=1) > 1e-6 * (x[-1] - x[0]) / len(x)
        outlines.append(line[apart])
    return outlines
