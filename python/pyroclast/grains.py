"""Outlines of grains that are known, from a signed distance or an image of labels, as a table that decks read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Error
from .label_image import pixels_of
from .writing import write_text

_SMOOTH = 1.0  # pixels over which the staircase of an image is smoothed
_FEWEST_POINTS = 6


@dataclass(frozen=True)
class Grain:
    """Grain in the plane by the points of its outline."""

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


def grains_of_distance(distance: Callable[[NDArray[np.float64]], ArrayLike], low: Sequence[float],
                       high: Sequence[float], spacing: float, phase: int = 0) -> list[Grain]:
    """Grains where a signed distance is negative: a line around each, its holes filled.

    distance: takes places (n, 2) in m and returns n distances, negative within a grain. It is asked once, here: what a
    deck reads is the table of `write_grains`.
    low, high: corners of the box in which it is asked, m
    spacing: distance of the places, m: a tenth of a block size or less
    Raises Error where the function returns other shapes or values, or a grain reaches out of the box.
    """
    low, high = np.asarray(low, float), np.asarray(high, float)
    if low.shape != (2,) or high.shape != (2,) or not np.all(high > low) or not 0.0 < spacing < np.min(high - low):
        raise Error(f"low {low.tolist()}, high {high.tolist()} and spacing {spacing} are no grid: low must be below high, "
                    "and the spacing positive and below both widths")
    counts = np.ceil((high - low) / spacing).astype(int) + 1
    x, y = (np.linspace(low[i], high[i], counts[i]) for i in range(2))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    values = np.asarray(distance(places), float)
    if values.shape != (len(places),):
        raise Error(f"the distance returned an array of {values.shape} for {len(places)} places; it must be ({len(places)},)")
    if not np.all(np.isfinite(values)):
        raise Error(f"the distance is {values[~np.isfinite(values)][0]} at {places[~np.isfinite(values)][0].tolist()} m; it "
                    "must be finite")
    return _lines_around(x, y, values.reshape(len(y), len(x)), phase)


def grains_of_labels(image: ArrayLike | str | Path, pixel: float, *, matrix: int = 0) -> list[Grain]:
    """Grains of an image of labels: each connected part of a label is one, smoothed over a pixel, with its own area.

    A hole in a grain, as a pore is in a stone of a scan, is filled: grains are whole.
    image: (rows, columns) of labels, as an array or a file; row 0 is at the top
    pixel: edge of a pixel, m
    matrix: label of the matrix; the others are phases 0, 1, ... in ascending order
    Raises Error where there is no grain, a hole of one holds another label than the matrix, or the edge of a pixel is no
    positive number.
    """
    from scipy import ndimage
    if not 0.0 < pixel < np.inf:
        raise Error(f"the edge of a pixel is {pixel} m; it must be positive")
    pixels, source = pixels_of(image)
    labels = [int(label) for label in np.unique(pixels) if label != matrix]
    if not labels:
        raise Error(f"{source}all pixels are of the label {matrix}, the matrix: there are no grains")
    grains = []
    for phase, label in enumerate(labels):
        parts, count = ndimage.label(pixels == label)
        for part, box in zip(range(1, count + 1), ndimage.find_objects(parts)):
            whole = ndimage.binary_fill_holes(parts[box] == part)
            others = np.argwhere(whole & (pixels[box] != label) & (pixels[box] != matrix))
            if len(others):
                row, column = others[0] + (box[0].start, box[1].start)
                raise Error(f"{source}a grain of label {label} encloses the label {pixels[row, column]} at row {row}, "
                            f"column {column}; a grain can have no other inside")
            grains += _grain_of_mask(whole, (box[0].start, box[1].start), pixels.shape[0], pixel, phase)
    if not grains:
        raise Error(f"{source}no part of a label is large enough to be a grain: three pixels or more across")
    return grains


def write_grains(file: str | Path, grains: Sequence[Grain]) -> None:
    """Writes grains as the table that `[aggregates.outlines] csv` of a deck reads."""
    lines = ["grain,x_m,y_m,phase"]
    for number, grain in enumerate(grains):
        lines += [f"{number},{x:.9g},{y:.9g},{grain.phase}" for x, y in grain.outline]
    write_text(Path(file), "\n".join(lines) + "\n")


def _grain_of_mask(mask: NDArray[Any], first: tuple[int, int], rows: int, pixel: float, phase: int) -> list[Grain]:
    from scipy import ndimage
    margin = 3
    mask = np.pad(mask, margin)
    signed = ndimage.distance_transform_edt(~mask) - ndimage.distance_transform_edt(mask)
    signed = ndimage.gaussian_filter(signed, _SMOOTH)
    row = np.arange(mask.shape[0]) + first[0] - margin
    column = np.arange(mask.shape[1]) + first[1] - margin
    y = pixel * (rows - 0.5 - row[::-1])  # ascending
    found = _lines_around(pixel * (column + 0.5), y, signed[::-1], phase)
    if not found:
        return []
    largest = max(found, key=lambda grain: grain.area)
    middle = largest.outline.mean(axis=0)
    factor = np.sqrt(mask.sum() * pixel**2 / largest.area)  # smoothing takes a little off
    return [Grain(middle + factor * (largest.outline - middle), phase)]


def _signed_area(outline: NDArray[np.float64]) -> float:
    """Of a polygon, positive where its points run counter-clockwise."""
    x, y = outline.T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def _lines_around(x: NDArray[np.float64], y: NDArray[np.float64], values: NDArray[np.float64], phase: int) -> list[Grain]:
    from contourpy import contour_generator
    grains = []
    for line in contour_generator(x, y, values).lines(0.0):
        if np.any(line[0] != line[-1]):
            raise Error(f"a grain reaches out of the box, near ({line[0][0]:.6g}, {line[0][1]:.6g}) m")
        points = line[:-1]
        if _signed_area(points) > 0.0:  # higher values lie to the left of a line, so this one is around a hole
            continue
        apart = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1) > 1e-6 * (x[1] - x[0])
        if np.count_nonzero(apart) >= _FEWEST_POINTS:
            grains.append(Grain(points[apart], phase))
    return grains
