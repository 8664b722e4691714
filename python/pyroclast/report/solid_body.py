"""A solid with the fields of its frames, packed for a page: polyhedra that move as rigid bodies by small turns, and the
contacts that ever become cracks.

A page cuts the polyhedra, which are convex, by a plane across x, y or z: each cut is a convex polygon.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..files import read_array
from ..mesh import BlockMesh
from ..results import Frame, Results
from .packing import packed_floats, packed_steps, packed_whole
from .plane_body import FINE, PackedBody, STEPS, about_body, exact_steps, packed_damage, read_finite


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
    modes = list(run.crack_modes) if run.moves and taken else []
    arrays = {"point": packed_steps(point, fine, 4), "point_first": packed_whole(first, 4),
              "triangle": packed_whole(triangle, 4), "outer": packed_whole(is_outer, 1),
              "material": packed_whole(_of_blocks(blocks, number), 1)}
    size = float(np.median(np.maximum.reduceat(point, first[:-1]) - np.minimum.reduceat(point, first[:-1])))
    for name, column in columns.items():
        kind = name.split("_")[0]
        if kind in ("shift", "turn"):
            arrays[name] = packed_steps(column, fine if kind == "shift" else fine / size)
        elif kind not in ("damage", "opening", "move", "crack"):
            arrays[name] = packed_steps(column, STEPS[kind])
    if modes:
        damages = {mode: columns[f"damage_{mode}"] for mode in modes}
        steps = exact_steps(run, columns["crack_step"][-1])
        kept = np.flatnonzero(steps >= 0)
        arrays["crack_step"] = packed_whole(steps[kept], 4)
        arrays["interface"] = packed_whole(contacts.interface[kept], 1)
        arrays["extent"] = packed_floats(contacts.extent[kept])
        arrays["number"] = packed_whole(kept, 4)
        arrays["cell"] = packed_steps(contacts.points[contacts.cells[kept]].reshape(len(kept), 12), fine, 4)
        for mode, damage in damages.items():
            arrays[f"damage_{mode}"] = packed_damage(damage[:, kept])
        arrays["opening"] = packed_steps(columns["opening"][:, kept], STEPS["opening"])
        for i, axis in enumerate("xyz"):
            arrays[f"move_{axis}"] = packed_steps(columns["move"][:, kept, i], fine)
    about = {**about_body(run), "solid": True,
             "steps": {name: array["step"] for name, array in arrays.items() if "step" in array}}
    notes = ["blocks of a solid move as rigid bodies"] if run.moves else []
    return PackedBody(about, arrays, taken, notes + left_out)


def _of_blocks(blocks: BlockMesh, number: np.ndarray) -> np.ndarray:
    """(B,) material."""
    material = np.empty(number.max() + 1, int)
    material[number] = blocks.material
    return material


class _Reader:
    """Reads what a page keeps of a frame."""

    def __init__(self, run: Results, number: np.ndarray, used: np.ndarray, first: np.ndarray):
        self._run, self._used, self._first, self._number = run, used, first, number
        blocks = run.mesh.blocks
        self._share = blocks.sizes / np.bincount(number, blocks.sizes)[number]
        self._heated = not run.uniform or not run.moves
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

    def read(self, frame: Frame) -> dict[str, np.ndarray]:
        run, found = self._run, {}
        blocks, contacts = run.mesh.blocks, run.mesh.contacts
        if self._heated:
            of_zones = run.gridpoint_temperature(frame)[blocks.zones].mean(axis=1)
            found["temperature"] = np.bincount(self._number, self._share * of_zones)
        if not run.moves:
            return found
        moves = run.gridpoint_displacement(frame)[self._used].astype(float)
        shift = self._mean_of_points(moves)
        turn = np.einsum("ijk,ik->ij", self._inverse, np.add.reduceat(np.cross(self._arm, moves), self._first[:-1]))
        for i, axis in enumerate("xyz"):
            found[f"shift_{axis}"], found[f"turn_{axis}"] = shift[:, i], turn[:, i]
        path = run.folder / "fields" / f"blocks_{frame.number:04d}.hdf"
        stress = read_array(path, "VTKHDF/CellData/stress [Pa]", (len(blocks.zones), 6))
        xx, yy, zz, xy, yz, xz = (1e-6 * np.bincount(self._number, self._share * stress[:, i]) for i in range(6))
        principal = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1))
        found.update(stress_y=yy, stress_1=principal[:, 2], stress_2=principal[:, 0])
        for mode in run.crack_modes:
            found[f"damage_{mode}"] = run.contact_field(frame, f"{mode}_damage [1]")
        found["crack_step"] = run.contact_field(frame, "crack_step [1]")
        found["opening"] = run.contact_field(frame, "opening [m]")
        found["move"] = run.contact_displacement(frame)[contacts.cells[:, 0]]
        return found
