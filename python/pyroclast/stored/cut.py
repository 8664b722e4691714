"""Cuts a body of tetrahedra: polygons of its surface, of planes through it, and of what a corner cut away leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .mesh import BlockMesh


@dataclass(frozen=True)
class Plane:
    """Points x with dot(normal, x) = offset, m."""

    normal: np.ndarray  #: (3,), a unit vector
    offset: float

    def above(self, points: np.ndarray) -> np.ndarray:
        """Returns the distance along the normal, m."""
        return points @ self.normal - self.offset

    def along(self, vectors: np.ndarray) -> np.ndarray:
        """Returns (n, 3): the parts of vectors that lie in the plane."""
        return vectors - (vectors @ self.normal)[:, None] * self.normal

    @property
    def other_way(self) -> Plane:
        return Plane(-self.normal, -self.offset)


@dataclass(frozen=True)
class Polygons:
    """Convex polygons in space, each with the number of what it is of. Short ones repeat their last corner."""

    corners: np.ndarray  #: (P, K, 3), m
    owner: np.ndarray  #: (P,)

    def of(self, which: np.ndarray) -> Polygons:
        return Polygons(self.corners[which], self.owner[which])

    @property
    def triangles(self) -> np.ndarray:
        """Triangles (P (K - 2), 3) that fill the polygons: their corners, counted through all polygons."""
        count, corners = self.corners.shape[:2]
        after = np.arange(1, corners - 1)
        fan = np.stack([np.zeros_like(after), after, after + 1], axis=1)
        return (corners * np.arange(count)[:, None, None] + fan).reshape(-1, 3)

    @property
    def area_vectors(self) -> np.ndarray:
        """Areas (P, 3), m², along the normals."""
        from_first = self.corners - self.corners[:, :1]
        return 0.5 * np.cross(from_first[:, 1:-1], from_first[:, 2:]).sum(axis=1)


def joined(parts: list[Polygons]) -> Polygons:
    """Joins all of these, in turn."""
    most = max(part.corners.shape[1] for part in parts)
    padded = [np.concatenate([part.corners, np.repeat(part.corners[:, -1:], most - part.corners.shape[1], axis=1)],
                             axis=1) for part in parts]
    return Polygons(np.concatenate(padded), np.concatenate([part.owner for part in parts]))


def surface(blocks: BlockMesh, points: np.ndarray | None = None) -> Polygons:
    """Returns the sides of all blocks, also where they meet: triangles that look out of their block, each of a zone.

    points: (N, 3), places of the gridpoints, m; None: the reference configuration.
    """
    corners, zone, _ = blocks.sides
    return Polygons((blocks.points if points is None else points)[corners], zone)


def outline(blocks: BlockMesh, points: np.ndarray | None = None) -> Polygons:
    """Returns triangles of `surface` that no other block meets."""
    return surface(blocks, points).of(blocks.sides[2])


def clip(polygons: Polygons, plane: Plane) -> Polygons:
    """Returns what of the polygons lies below a plane."""
    here = polygons.corners
    if not len(here):
        return polygons
    after = np.roll(here, -1, axis=1)
    height, height_after = plane.above(here), plane.above(after)
    inside = height <= 0.0
    crosses = inside != (height_after <= 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(crosses, height / (height - height_after), 0.0)
    between = here + share[..., None] * (after - here)
    candidates = np.stack([here, between], axis=2).reshape(len(here), -1, 3)
    kept = np.stack([inside, crosses], axis=2).reshape(len(here), -1)
    return _packed(candidates, kept, polygons.owner)


def _packed(corners: np.ndarray, kept: np.ndarray, owner: np.ndarray) -> Polygons:
    """Returns polygons of the corners that are kept, in their order."""
    count = kept.sum(axis=1)
    whole = count >= 3
    corners, kept, owner, count = corners[whole], kept[whole], owner[whole], count[whole]
    if not len(corners):
        return Polygons(np.zeros((0, 3, 3)), owner)
    order = np.argsort(~kept, axis=1, kind="stable")[:, :count.max()]
    sorted_corners = np.take_along_axis(corners, order[..., None], axis=1)
    place = np.minimum(np.arange(order.shape[1]), count[:, None] - 1)
    return Polygons(np.take_along_axis(sorted_corners, place[..., None], axis=1), owner)


def section(blocks: BlockMesh, plane: Plane, points: np.ndarray | None = None) -> Polygons:
    """Returns the polygons of the zones that a plane cuts, triangles and quadrangles, each of a zone.

    points: as of `surface`.
    """
    at = (blocks.points if points is None else points)[blocks.zones]
    height = plane.above(at)
    above = (height > 0.0).sum(axis=1)
    cut = np.flatnonzero((above > 0) & (above < 4))
    order = np.argsort(height[cut], axis=1, kind="stable")
    at = np.take_along_axis(at[cut], order[..., None], axis=1)
    height = np.take_along_axis(height[cut], order, axis=1)

    def between(low: int, high: int) -> np.ndarray:
        share = height[:, low] / (height[:, low] - height[:, high])
        return at[:, low] + share[:, None] * (at[:, high] - at[:, low])

    corners = np.empty((len(cut), 4, 3))
    for number, pairs in ((1, ((0, 3), (1, 3), (2, 3), (2, 3))), (2, ((0, 2), (0, 3), (1, 3), (1, 2))),
                          (3, ((0, 1), (0, 2), (0, 3), (0, 3)))):
        of_kind = above[cut] == number
        with np.errstate(divide="ignore", invalid="ignore"):
            corners[of_kind] = np.stack([between(*pair) for pair in pairs], axis=1)[of_kind]
    return Polygons(corners, cut)


def traces(cells: np.ndarray, plane: Plane) -> tuple[np.ndarray, np.ndarray]:
    """Returns lines (L, 2, 3) in which a plane cuts quadrangles (C, 4, 3), and the quadrangle of each."""
    after = np.roll(cells, -1, axis=1)
    height, height_after = plane.above(cells), plane.above(after)
    crosses = (height <= 0.0) != (height_after <= 0.0)
    cut = np.flatnonzero(crosses.sum(axis=1) == 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(crosses[cut], height[cut] / (height[cut] - height_after[cut]), 0.0)
    between = cells[cut] + share[..., None] * (after[cut] - cells[cut])
    ends = np.argsort(~crosses[cut], axis=1, kind="stable")[:, :2]
    return np.take_along_axis(between, ends[..., None], axis=1), cut


def without_corner(blocks: BlockMesh, planes: tuple[Plane, Plane],
                   points: np.ndarray | None = None) -> tuple[Polygons, Polygons]:
    """Cuts the corner above two planes away from a body; returns what is left of its outline, and the two cuts.

    points: as of `surface`.
    """
    first, second = planes
    outer = outline(blocks, points)
    left = joined([clip(outer, first), clip(clip(outer, first.other_way), second)])
    cuts = joined([clip(section(blocks, first, points), second.other_way),
                   clip(section(blocks, second, points), first.other_way)])
    return left, cuts
