"""Draws fields of temperature, with isotherms: of the plane, and on what is seen of a solid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import TriMesh
from matplotlib.colors import Normalize
from matplotlib.contour import ContourSet
from matplotlib.tri import Triangulation

from . import style

ISOTHERMS = (300.0, 500.0, 700.0)
"""°C, of the lines in fields of temperature."""

_ROOM = 20.0  # °C, from which the colours of temperatures start
_MEET = 1e-6  # of the size of a body: corners so near to each other are one
_COLOURS = 12  # into so many parts of the scale a triangle is split: between its corners colours are mixed
_MOST_TRIANGLES = 200_000
_NAMED = 3.0  # of the size of letters, for each line and one more: lines that are shorter have no room for names


def colours_of(fields: Sequence[np.ndarray]) -> ScalarMappable:
    """Returns colours from room temperature, or what is cooler, to the hottest of these temperatures, °C."""
    coolest, hottest = min(field.min() for field in fields), max(field.max() for field in fields)
    return ScalarMappable(Normalize(min(_ROOM, coolest), max(_ROOM + 1.0, hottest)), style.HEAT_MAP)


def draw_field(axes: Axes, colours: ScalarMappable, points: np.ndarray, triangles: np.ndarray, field: np.ndarray,
               shown: np.ndarray, shade: np.ndarray | None = None) -> None:
    """Draws temperatures that are linear in triangles, one triangle after the other, and lines of ISOTHERMS.

    points: (N, 2 or 3), m. triangles: (T, 3), their corners. field: (N,), °C. shown: (N, 2), m: points in the picture.
    shade: (T,), factors on colours.
    """
    corners = np.concatenate([style.MILLI * shown, field[:, None]], axis=1)[triangles]
    of_corners, triangle = _split(corners, np.ptp(np.array(colours.get_clim())) / _COLOURS)
    rgb = colours.to_rgba(of_corners[..., 2])[..., :3]
    if shade is not None:
        rgb = rgb * shade[triangle, None, None]
    x, y = of_corners[..., :2].reshape(-1, 2).T
    axes.add_collection(TriMesh(Triangulation(x, y, np.arange(len(x)).reshape(-1, 3)), facecolors=rgb.reshape(-1, 3),
                                rasterized=True))
    _draw_isotherms(axes, points, triangles, field, shown)


def draw_colour_bar(all_axes: Sequence[Axes], colours: ScalarMappable, pad: float = 0.05) -> None:
    """Draws what the colours stand for beside axes, with lines at ISOTHERMS. pad: room, of the width of the axes."""
    bar = all_axes[0].figure.colorbar(colours, ax=list(all_axes), label="Temperature [°C]", shrink=0.8, pad=pad)
    low, high = colours.get_clim()
    bar.ax.hlines([level for level in ISOTHERMS if low < level < high], 0.0, 1.0, colors=style.BLACK, linewidths=0.6,
                  transform=bar.ax.get_yaxis_transform())


def _split(corners: np.ndarray, most: float) -> tuple[np.ndarray, np.ndarray]:
    """Splits triangles (T, 3, 3) by the middles of their sides, until the last coordinate differs by no more than
    `most` within each, or they are many; returns parts, in the order of their triangles, and the triangle of each.
    """
    triangle = np.arange(len(corners))
    while (coarse := np.ptp(corners[..., 2], axis=1) > most).any() and len(corners) < _MOST_TRIANGLES:
        whole = corners[coarse]
        middles = 0.5 * (whole + np.roll(whole, -1, axis=1))
        parts = [np.stack([whole[:, i], middles[:, i], middles[:, i - 1]], axis=1) for i in range(3)]
        triangle = np.concatenate([triangle[~coarse], np.tile(triangle[coarse], 4)])
        order = np.argsort(triangle, kind="stable")
        corners, triangle = np.concatenate([corners[~coarse], *parts, middles])[order], triangle[order]
    return corners, triangle


def _draw_isotherms(axes: Axes, points: np.ndarray, triangles: np.ndarray, field: np.ndarray,
                    shown: np.ndarray) -> None:
    """Draws lines of ISOTHERMS with their temperatures, on through all triangles whose corners meet."""
    within = field[np.unique(triangles)]
    passed = [level for level in ISOTHERMS if within.min() < level < within.max()]
    if not passed:
        return
    # blocks have corners of their own: those in one place become one, so that lines run on from block to block
    cell = _MEET * np.ptp(points, axis=0).max()
    _, first, joined = np.unique(np.round(points / cell).astype(np.int64), axis=0, return_index=True,
                                 return_inverse=True)
    joined = joined.ravel()
    mean = np.bincount(joined, weights=field) / np.bincount(joined)
    x, y = style.MILLI * shown[first].T
    corners = joined[triangles]
    apart = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
    lines = axes.tricontour(Triangulation(x, y, corners[apart]), mean, levels=passed, colors=style.BLACK,
                            linewidths=0.6)
    size = style.page().size(6.0)
    points_of_width = 72.0 * axes.bbox.width / axes.figure.dpi
    places = list(_places_of_names(lines, _NAMED * (len(passed) + 1) * size / points_of_width * np.ptp(x)))
    for label in axes.clabel(lines, fmt="%g", fontsize=size, inline_spacing=1, manual=places):
        label.set_clip_on(True)


def _places_of_names(lines: ContourSet, least: float) -> Iterator[tuple[float, float]]:
    """Yields a place on each line that is at least so long: farther along for higher levels, as lines lie close."""
    for number, pieces in enumerate(lines.allsegs):
        for piece in pieces:
            along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(piece, axis=0), axis=1))]
            if along[-1] >= least:
                wanted = along[-1] * (number + 1) / (len(lines.allsegs) + 1)
                yield float(np.interp(wanted, along, piece[:, 0])), float(np.interp(wanted, along, piece[:, 1]))
