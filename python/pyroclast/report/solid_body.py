"""A solid with the fields of its frames, packed for a page: polyhedra that move as rigid bodies by small turns, and the
contacts that ever become cracks.

A page cuts the polyhedra, which are convex, by a plane across x, y or z: each cut is a convex polygon. From outside it
shows their triangles, contacts on the sides of the two blocks that they join, and the sides that come to light where
blocks leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..stored.files import read_array
from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.mesh import BlockMesh
from ..stored.results import Results
from .packing import packed_floats, packed_steps, packed_whole
from .plane_body import (FINE, MEET, PackedBody, STEPS, about_body, exact_steps, meeting, packed_damage, read_finite,
                         fields_of_blocks)

_OPENING = 1e-6  # m, wanted step: ten times that of the plane, as a solid has so many more contacts
_SAME = 1e-6  # cosines of one angle differ by less


def solid_body_of(run: Results, frames: Sequence[Frame]) -> PackedBody:
    """Packs a solid with some of its frames."""
    blocks, contacts = run.mesh.blocks, run.mesh.contacts
    number = np.unique(blocks.block, return_inverse=True)[1].ravel()
    count = int(number.max()) + 1
    corners, zone, is_outer = blocks.sides
    owner = number[zone]
    order = np.argsort(owner, kind="stable")
    corners, owner, is_outer = corners[order], owner[order], is_outer[order]
    used, triangle = np.unique(corners, return_inverse=True)  # each gridpoint is of one block
    triangle = triangle.reshape(-1, 3)
    of_point = np.empty(len(used), int)
    of_point[triangle.ravel()] = np.repeat(owner, 3)
    by_block = np.argsort(of_point, kind="stable")
    place = np.empty_like(by_block)
    place[by_block] = np.arange(len(used))
    used, triangle = used[by_block], place[triangle]
    first = np.r_[0, np.cumsum(np.bincount(of_point, minlength=count))]
    point = blocks.points[used]
    fine = FINE * float(np.ptp(point, axis=0).max())
    reader = _Reader(run, number, used, first)
    taken, columns, left_out = read_finite(reader.read, frames)
    modes = list(run.facts.crack_modes) if run.moves and taken else []
    arrays = {"point": packed_steps(point, fine, 4), "point_first": packed_whole(first, 4),
              "triangle": packed_whole(triangle, 4), "outer": packed_whole(is_outer, 1),
              "material": packed_whole(_of_blocks(blocks, number), 1)}
    size = float(np.median(np.maximum.reduceat(point, first[:-1]) - np.minimum.reduceat(point, first[:-1])))
    for name, column in columns.items():
        kind = name.split("_")[0]
        if kind == "temperature":
            # points whose temperatures are alike in all frames, such as corners that meet, share them
            values, node = np.unique(np.rint(column / STEPS[kind]), axis=1, return_inverse=True)
            arrays[name] = packed_steps(STEPS[kind] * values, STEPS[kind])
            arrays["node"] = packed_whole(node.ravel(), 4)
        elif kind in ("shift", "turn"):
            arrays[name] = packed_steps(column, fine if kind == "shift" else fine / size)
        elif kind not in ("damage", "opening", "crack"):
            arrays[name] = packed_steps(column, STEPS[kind])
    notes = ["blocks of a solid move as rigid bodies"] if run.moves else []
    inner, other = _across(point, triangle, owner, is_outer)
    if "gone" in columns:
        leaves = columns["gone"][-1] > 0.5
        bared = leaves[other] & ~leaves[owner[inner]]
        arrays["bared"], arrays["bared_by"] = packed_whole(inner[bared], 4), packed_whole(other[bared], 4)
    if modes:
        steps = exact_steps(run, columns["crack_step"][-1])
        kept = np.flatnonzero(steps >= 0)
        cells = contacts.points[contacts.cells[kept]]
        beside = _blocks_beside(cells, point, triangle[~is_outer], owner[~is_outer])
        if (lost := int((beside[:, 0] < 0).sum())):
            notes.append(f"{lost} cracks whose two blocks are not found")
            kept, cells, beside = (values[beside[:, 0] >= 0] for values in (kept, cells, beside))
        face, arrays["face_triangle"], arrays["triangle_face"] = _faces(count, beside, owner[inner], inner, other)
        first_of = np.unique(face, return_index=True)[1]
        arrays["face"] = packed_whole(face, 4)
        arrays["middle"] = packed_steps(cells[first_of, 2], fine, 4)
        arrays["cell"] = packed_whole(_cell_points(cells, point, of_point[by_block], beside[:, 0]), 4)
        arrays["trace"] = packed_whole(_traces(cells, point, triangle, is_outer), 4)
        arrays["crack_step"] = packed_whole(steps[kept], 4)
        arrays["interface"] = packed_whole(contacts.interface[kept], 1)
        arrays["extent"] = packed_floats(contacts.extent[kept])
        arrays["number"] = packed_whole(kept, 4)
        for mode in modes:
            arrays[f"damage_{mode}"] = packed_damage(columns[f"damage_{mode}"][:, kept])
        arrays["opening"] = packed_steps(columns["opening"][:, kept], _OPENING)
    about = {**about_body(run), "solid": True, "heated_face": run.summary.get("heated_face"),
             "steps": {name: array["step"] for name, array in arrays.items() if "step" in array}}
    return PackedBody(about, arrays, taken, notes + left_out)


def _of_blocks(blocks: BlockMesh, number: np.ndarray) -> np.ndarray:
    """Returns the material (B,) of blocks."""
    material = np.empty(number.max() + 1, int)
    material[number] = blocks.material
    return material


def _edges(point: np.ndarray, triangle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns, of the three edges of each triangle, one triangle after the other, (3 T, 3), m: their middles, and the
    ways from there to the third corner.
    """
    corners = point[triangle]
    middle = 0.5 * (corners + np.roll(corners, -1, axis=1))
    return middle.reshape(-1, 3), (np.roll(corners, -2, axis=1) - middle).reshape(-1, 3)


def _across(point: np.ndarray, triangle: np.ndarray, owner: np.ndarray,
            is_outer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the triangles (I,) between blocks, and the blocks (I,) on their other sides: their own where none is found.
    """
    inner = np.flatnonzero(~is_outer)
    centre = meeting(point[triangle[inner]].mean(axis=1), _near(point))
    order = np.argsort(centre, kind="stable")  # two blocks have each of these triangles
    same = np.flatnonzero(np.diff(centre[order]) == 0)
    one, two = order[same], order[same + 1]
    other = owner[inner].copy()
    other[one], other[two] = owner[inner][two], owner[inner][one]
    return inner, other


def _faces(blocks: int, beside: np.ndarray, own: np.ndarray, inner: np.ndarray,
           other: np.ndarray) -> tuple[np.ndarray, dict[str, Any], dict[str, Any]]:
    """Returns (K,) face of each contact; packed: (F,) triangles of such faces, on both blocks, and their faces.

    A face is where two blocks meet. blocks: their number. beside: (K, 2), those of each contact. own, inner, other:
    blocks, numbers and blocks across of the triangles between blocks.
    """

    def pair(blocks_: np.ndarray) -> np.ndarray:
        return blocks_.min(axis=1) * blocks + blocks_.max(axis=1)

    of_triangle = pair(np.c_[own, other])
    faces, face = np.unique(pair(beside), return_inverse=True)
    shown = np.isin(of_triangle, faces)
    return (face.ravel(), packed_whole(inner[shown], 4),
            packed_whole(np.searchsorted(faces, of_triangle[shown]), 4))


def _cell_points(cells: np.ndarray, point: np.ndarray, of_point: np.ndarray, block: np.ndarray) -> np.ndarray:
    """Returns (K, 3) gridpoints of a block at a contact's point, at the next one of the face and at the one before."""
    ends = np.stack([cells[:, 0], 2.0 * cells[:, 1] - cells[:, 0], 2.0 * cells[:, 3] - cells[:, 0]], axis=1)
    place = meeting(np.concatenate([point, ends.reshape(-1, 3)]), _near(point))
    count = int(of_point.max()) + 1
    known, wanted = place[:len(point)], place[len(point):].reshape(-1, 3)
    _, known = np.unique(np.r_[known, wanted.ravel()], return_inverse=True)
    key = known.ravel()[:len(point)] * count + of_point
    order = np.argsort(key, kind="stable")
    found = np.searchsorted(key[order], known.ravel()[len(point):].reshape(-1, 3) * count + block[:, None])
    return order[np.minimum(found, len(order) - 1)]


def _near(point: np.ndarray) -> float:
    """Returns the distance [m] within which points are one."""
    return MEET * float(np.ptp(point, axis=0).max())


def _blocks_beside(cells: np.ndarray, point: np.ndarray, triangle: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """Returns (K, 2) blocks that contacts join; -1 where they are not found.

    Both have a triangle on the edge behind the contact's point, and those two go from there as the contact's cell does.
    cells: (K, 4, 3), m. triangle: (T, 3), those between blocks. owner: (T,), their blocks.
    """
    middle, inward = _edges(point, triangle)
    place = meeting(np.concatenate([middle, cells[:, 1]]), _near(point))
    of_edge, of_cell = place[:len(middle)], place[len(middle):]
    order = np.argsort(of_edge, kind="stable")
    first = np.searchsorted(of_edge[order], of_cell)
    last = np.searchsorted(of_edge[order], of_cell, "right")
    count = last - first
    cell = np.repeat(np.arange(len(cells)), count)
    edge = order[np.arange(count.sum()) + np.repeat(first - np.cumsum(count) + count, count)]
    along = (cells[:, 1] - cells[:, 0])[cell]
    way, side = ((v - along * ((v * along).sum(axis=1) / (along**2).sum(axis=1))[:, None])
                 for v in ((cells[:, 2] - cells[:, 1])[cell], inward[edge]))
    cosine = (way * side).sum(axis=1) / np.sqrt((way**2).sum(axis=1) * (side**2).sum(axis=1))
    nearest = np.lexsort((-cosine, cell))
    beside = np.full((len(cells), 2), -1)
    begin = np.cumsum(count) - count
    several = np.flatnonzero(count > 1)
    one, other = nearest[begin[several]], nearest[begin[several] + 1]
    same = np.abs(cosine[one] - cosine[other]) < _SAME
    beside[several[same]] = owner[np.c_[edge[one], edge[other]][same] // 3]
    return beside


def _traces(cells: np.ndarray, point: np.ndarray, triangle: np.ndarray, is_outer: np.ndarray) -> np.ndarray:
    """Returns (K,) where contacts show outside: twice an outer triangle whose edge they lie on, and 1 more where that
    edge is the one before their point; -1 where they do not.
    """
    outer = np.flatnonzero(is_outer)
    middle = _edges(point, triangle[outer])[0]
    ends = cells[:, [1, 3]].reshape(-1, 3)
    place = meeting(np.concatenate([middle, ends]), _near(point))
    known, at = np.unique(place[:len(middle)], return_index=True)
    wanted = place[len(middle):].reshape(-1, 2)
    row = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    shows = known[row] == wanted
    half = shows.argmax(axis=1)
    found = 2 * outer[at[row[np.arange(len(cells)), half]] // 3] + half
    return np.where(shows.any(axis=1), found, -1)


class _Reader:
    """Reads what a page keeps of a frame."""

    def __init__(self, run: Results, number: np.ndarray, used: np.ndarray, first: np.ndarray):
        self._run, self._used, self._first, self._number = run, used, first, number
        blocks = run.mesh.blocks
        self._share = blocks.sizes / np.bincount(number, blocks.sizes)[number]
        self._heated = not Heated(run).uniform or not run.moves
        point = blocks.points[used]
        self._count = np.diff(first)
        self._owner = np.repeat(np.arange(len(self._count)), self._count)
        self._arm = point - self._mean_of_points(point)[self._owner]
        spread = np.einsum("ij,ik->ijk", self._arm, self._arm)
        inertia = -np.add.reduceat(spread, first[:-1])
        inertia[:, [0, 1, 2], [0, 1, 2]] -= inertia.trace(axis1=1, axis2=2)[:, None]
        self._inverse = np.linalg.inv(inertia)

    def _mean_of_points(self, values: np.ndarray) -> np.ndarray:
        return np.add.reduceat(values, self._first[:-1]) / self._count[:, None]

    def _mean(self, of_zones: np.ndarray) -> np.ndarray:
        """Returns the mean (B,) over the zones of each block, by volume."""
        return np.bincount(self._number, self._share * of_zones)

    def read(self, frame: Frame) -> dict[str, np.ndarray]:
        run = self._run
        found: dict[str, np.ndarray] = {}
        blocks = run.mesh.blocks
        if self._heated:
            found["temperature"] = run.gridpoint_temperature(frame)[self._used].astype(float)
        path = run.folder / "fields" / f"blocks_{frame.number:04d}.hdf"
        found.update(fields_of_blocks(path, len(blocks.zones), self._mean))
        if not run.moves:
            return found
        moves = run.gridpoint_displacement(frame)[self._used].astype(float)
        shift = self._mean_of_points(moves)
        turn = np.einsum("ijk,ik->ij", self._inverse, np.add.reduceat(np.cross(self._arm, moves), self._first[:-1]))
        for i, axis in enumerate("xyz"):
            found[f"shift_{axis}"], found[f"turn_{axis}"] = shift[:, i], turn[:, i]
        stress = read_array(path, "VTKHDF/CellData/stress [Pa]", (len(blocks.zones), 6))
        xx, yy, zz, xy, yz, xz = (1e-6 * self._mean(stress[:, i]) for i in range(6))
        principal = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1))
        found.update(stress_y=yy, stress_1=principal[:, 2], stress_2=principal[:, 0])
        damages = {f"damage_{mode}": run.contact_field(frame, f"{mode}_damage [1]") for mode in run.facts.crack_modes}
        if damages:
            is_damaged = np.max(list(damages.values()), axis=0) > 0.0
            found.update(damages, crack_step=run.contact_field(frame, "crack_step [1]"),
                         opening=np.where(is_damaged, run.contact_field(frame, "opening [m]"), 0.0))
        return found
