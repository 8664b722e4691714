"""A body of the plane with the fields of its frames, packed for a page.

A page draws blocks as polygons and contacts as lines. Blocks keep the corners of their outlines; contacts point at four
of them. Stresses are means over blocks. Every kept number differs from that of the fields by half of its step at most;
`body_of` tells the steps.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Error
from ..stored.files import names_in, read_array
from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.mesh import Mesh
from ..stored.results import Results
from ..stored.run_facts import LOST
from .packing import packed_floats, packed_steps, packed_whole

MEET = 1e-9  # of the size of a body: points so near to each other are one
FINE = 1e-6  # of the size of a body: the step of places and displacements
STEPS = {"stress": 0.1, "temperature": 0.5, "opening": 1e-7, "creep": 1e-5, "pore": 0.01, "saturation": 0.005,
         "gone": 1.0}
"""Wanted steps: MPa, K, m, 1, MPa, 1."""
OF_BLOCKS = {"pore_pressure": ("pore_pressure [Pa]", 1e-6), "saturation": ("saturation [1]", 1.0),
             "gone": ("gone [1]", 1.0)}
"""Fields of zones that are alike in a block, and their factors to the units of the page."""
_LOST_SHARE = 1e-5  # of all energy that contacts lost: the step of what one of them lost
_LOST = re.compile(r"lost_(\w+) \[J m-2\]")
_MOST_LEFT_OUT = 4  # notes of frames
_COMPONENTS = 6  # of a tensor
_BROKEN = 127  # a damage of 1; everything below is at most 126


@dataclass(frozen=True)
class Outline:
    """Corners of all blocks, block after block."""

    gridpoint: np.ndarray  #: (n,)
    first: np.ndarray  #: (B + 1,) where the corners of each block begin
    material: np.ndarray  #: (B,)
    bearing: np.ndarray  #: (B,) bool
    side: np.ndarray  #: (C, 4): of each contact its corner on one block, the other end of that edge; on the other block

    @property
    def owner(self) -> np.ndarray:
        """Block (n,) of each corner."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))


def outline_of(mesh: Mesh) -> Outline:
    """Raises Error where a contact does not lie between two edges of blocks."""
    blocks = mesh.blocks
    loops, material = blocks.outlines
    gridpoint = np.concatenate(loops)
    first = np.r_[0, np.cumsum([len(loop) for loop in loops])]
    following = np.arange(1, len(gridpoint) + 1)
    following[first[1:] - 1] = first[:-1]
    return Outline(gridpoint, first, material, np.isin(material, blocks.bearing_materials),
                   _sides(mesh, blocks.points[gridpoint], following))


def _sides(mesh: Mesh, corner: np.ndarray, following: np.ndarray) -> np.ndarray:
    lines = mesh.contacts.points[mesh.contacts.cells]
    if not len(lines):
        return np.zeros((0, 4), int)
    middle = 0.5 * (corner + corner[following])
    tolerance = MEET * float(np.ptp(corner, axis=0).max())
    place = meeting(np.concatenate([middle, lines[:, 1]]), tolerance)
    of_edge, of_contact = place[:len(middle)], place[len(middle):]
    order = np.argsort(of_edge, kind="stable")
    start = np.searchsorted(of_edge[order], of_contact)
    if not (np.searchsorted(of_edge[order], of_contact, "right") - start == 2).all():
        raise Error(f"{mesh.blocks.path}: a contact does not lie between the edges of two blocks")
    ends = []
    for edge in (order[start], order[start + 1]):
        near, far = (np.linalg.norm(corner[end] - lines[:, 0], axis=1) for end in (edge, following[edge]))
        ends += [np.where(near < far, edge, following[edge]), np.where(near < far, following[edge], edge)]
    return np.column_stack(ends)


def meeting(points: np.ndarray, tolerance: float) -> np.ndarray:
    """Returns (n,) whole numbers, the same for points that meet."""
    place = np.zeros(len(points), np.int64)
    for values in points.T:
        order = np.argsort(values, kind="stable")
        rank = np.empty(len(values), np.int64)
        rank[order] = np.r_[0, np.cumsum(np.diff(values[order]) > tolerance)]
        place = place * (len(points) + 1) + rank
    return place


@dataclass
class PackedBody:
    """What a page needs of a body and its frames."""

    about: dict[str, Any]  #: names and numbers, for JSON
    arrays: dict[str, dict[str, Any]]  #: as `packing` makes them
    frames: list[Frame]  #: that are kept
    notes: list[str] = field(default_factory=list)  #: what was left out

    @property
    def size(self) -> int:
        """Size, characters."""
        return sum(len(array["data"]) for array in self.arrays.values())


def body_of(run: Results, frames: Sequence[Frame], rigid: bool = False) -> PackedBody:
    """Packs a body of the plane with some of its frames.

    rigid: keep one motion for each block (two displacements and a turn) in the place of displacements of its corners.
    """
    mesh = run.mesh
    outline = outline_of(mesh)
    shown = _Reader(run, outline)
    taken, columns, notes = read_finite(shown.read, frames)
    corner = mesh.blocks.points[outline.gridpoint]
    fine = FINE * float(np.ptp(corner, axis=0).max())
    arrays = {"corner": packed_steps(corner, fine, 4), "first": packed_whole(outline.first, 4),
              "material": packed_whole(outline.material, 1), "side": packed_whole(outline.side, 4),
              "interface": packed_whole(mesh.contacts.interface, 1), "extent": packed_floats(mesh.contacts.extent)}
    if "displacement" in columns:
        moves = columns.pop("displacement")
        if rigid:
            notes.append("blocks move as rigid bodies: the page keeps no displacements of their corners")
            shift, turn = rigid_motions(corner, outline, moves)
            arrays["shift_x"], arrays["shift_y"] = (packed_steps(shift[..., i], fine) for i in range(2))
            arrays["turn"] = packed_steps(turn, fine / _block_size(corner, outline))
        else:
            arrays["move_x"], arrays["move_y"] = (packed_steps(moves[..., i], fine) for i in range(2))
    if "crack_step" in columns:
        arrays["crack_step"] = packed_whole(exact_steps(run, columns.pop("crack_step")[-1]), 4)
    for name, column in columns.items():
        if name.startswith("damage_"):
            arrays[name] = packed_damage(column)
        elif not name.startswith("lost_"):
            arrays[name] = packed_steps(column, STEPS[name.split("_")[0]])
    lost = {name: column * mesh.contacts.extent for name, column in columns.items() if name.startswith("lost_")}
    arrays.update(_packed_losses(run, taken, lost))
    about = {**about_body(run), "solid": False,
             "steps": {name: array["step"] for name, array in arrays.items() if "step" in array}}
    return PackedBody(about, arrays, taken, notes)


def read_finite(read: Callable[[Frame], dict[str, np.ndarray]],
                frames: Sequence[Frame]) -> tuple[list[Frame], dict[str, np.ndarray], list[str]]:
    """Returns frames that are whole, with all numbers finite; these (frames, ...) by name; notes of other frames."""
    taken: list[Frame] = []
    found: list[dict[str, np.ndarray]] = []
    notes = []
    for frame in frames:
        try:
            values = read(frame)
        except Error as error:
            notes.append(f"frame {frame.number} is left out: {error}")
            continue
        if not all(np.isfinite(column).all() for column in values.values()):
            notes.append(f"frame {frame.number} is left out: it has numbers that are not finite")
        elif found and values.keys() != found[0].keys():
            notes.append(f"frame {frame.number} is left out: it has other fields than the frames before")
        else:
            taken.append(frame)
            found.append(values)
    columns = {name: np.array([values[name] for values in found]) for name in (found[0] if found else {})}
    return taken, columns, notes if len(notes) <= _MOST_LEFT_OUT else \
        [*notes[:_MOST_LEFT_OUT - 1], f"{len(notes) - _MOST_LEFT_OUT + 1} more frames are left out"]


def exact_steps(run: Results, found: np.ndarray) -> np.ndarray:
    """Returns steps of the history for those that the fields have in single precision; -1 where they are negative."""
    steps = run.history["step"]
    row = np.searchsorted(steps.astype(np.float32), found.astype(np.float32))
    return np.where(found < 0.0, -1.0, steps[np.minimum(row, len(steps) - 1)]).astype(np.int64)


def about_body(run: Results) -> dict[str, Any]:
    """Returns names of materials, interfaces and modes of cracks."""
    mesh = run.mesh
    modes = run.facts.crack_modes if run.moves else {}
    return {"materials": [{"name": name, "bearing": i in mesh.blocks.bearing_materials}
                          for i, name in enumerate(mesh.blocks.materials)],
            "interfaces": [_said(name) for name in mesh.contacts.interfaces],
            "modes": list(modes)}


def _packed_losses(run: Results, frames: list[Frame], lost: dict[str, np.ndarray]) -> dict[str, dict[str, Any]]:
    """Packs energies [J] (frames, contacts) over the thickness of the body, J/m; the history tells that thickness."""
    columns = {f"lost_{column.of}": column.name for column in run.facts.of_role(LOST)}
    there = [name for name in lost if name in columns]
    of_unit = sum(float(lost[name][-1].sum()) for name in there)
    if not of_unit > 0.0:
        return {}
    row = np.minimum(np.searchsorted(run.history["step"], frames[-1].step), run.history.rows - 1)
    whole = sum(float(run.history[columns[name]][row]) for name in there)
    return {name: packed_steps(whole / of_unit * lost[name], _LOST_SHARE * whole) for name in there}


def _said(interface: str) -> str:
    return interface.replace("_", "–")


def packed_damage(damage: np.ndarray) -> dict[str, Any]:
    """Damages in a byte each; only a broken contact has the last step."""
    steps = np.where(damage >= 1.0, _BROKEN, np.minimum(np.rint(_BROKEN * damage), _BROKEN - 1))
    return {**packed_whole(steps, 1), "step": 1.0 / _BROKEN}


def _block_size(corner: np.ndarray, outline: Outline) -> float:
    low = np.minimum.reduceat(corner, outline.first[:-1])
    high = np.maximum.reduceat(corner, outline.first[:-1])
    return float(np.median(high - low))


def rigid_motions(corner: np.ndarray, outline: Outline, moves: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns (frames, blocks, 2) mean displacements, m, and (frames, blocks) turns, radians, by least squares."""
    first, count = outline.first[:-1], np.diff(outline.first)
    middle = np.add.reduceat(corner, first) / count[:, None]
    arm = corner - middle[outline.owner]
    shift = np.add.reduceat(moves, first, axis=1) / count[None, :, None]
    there = arm + moves - shift[:, outline.owner]
    across = np.add.reduceat(arm[:, 0] * there[..., 1] - arm[:, 1] * there[..., 0], first, axis=1)
    along = np.add.reduceat((arm * there).sum(axis=-1), first, axis=1)
    return shift, np.arctan2(across, along)


def fields_of_blocks(path: Path, zones: int,
                   mean: Callable[[np.ndarray], np.ndarray]) -> Iterator[tuple[str, np.ndarray]]:
    """Reads the fields of a frame that are alike in a block, as far as the run has them.

    mean: from values (Z,) of zones to means (B,) of blocks.
    """
    there = names_in(path, "VTKHDF/CellData")
    for name, (field_name, factor) in OF_BLOCKS.items():
        if field_name in there:
            yield name, factor * mean(read_array(path, f"VTKHDF/CellData/{field_name}", (zones,)))


class _Reader:
    """Reads what a page keeps of a frame."""

    def __init__(self, run: Results, outline: Outline):
        self._folder = run.folder / "fields"
        self._run, self._outline = run, outline
        blocks = run.mesh.blocks
        self._block = np.unique(blocks.block, return_inverse=True)[1].ravel()
        self._share = blocks.sizes / np.bincount(self._block, blocks.sizes)[self._block]
        self._heated = not Heated(run).uniform or not run.moves

    def read(self, frame: Frame) -> dict[str, np.ndarray]:
        return {name: values.astype(float) for name, values in self._fields(frame)}

    def _fields(self, frame: Frame) -> Iterator[tuple[str, np.ndarray]]:
        run, outline = self._run, self._outline
        if self._heated:
            yield "temperature", run.gridpoint_temperature(frame)[outline.gridpoint]
        yield from fields_of_blocks(self._folder / f"blocks_{frame.number:04d}.hdf", len(self._share), self._mean)
        if not run.moves:
            return
        yield "displacement", run.gridpoint_displacement(frame)[outline.gridpoint]
        yield from self._of_zones(self._folder / f"blocks_{frame.number:04d}.hdf")
        damages = {mode: run.contact_field(frame, f"{mode}_damage [1]") for mode in run.facts.crack_modes}
        for mode, damage in damages.items():
            yield f"damage_{mode}", damage
        if damages:
            largest = np.max(list(damages.values()), axis=0)
            yield "opening", np.where(largest > 0.0, run.contact_field(frame, "opening [m]"), 0.0)
            yield "crack_step", run.contact_field(frame, "crack_step [1]")
        for name in names_in(self._folder / f"contacts_{frame.number:04d}.hdf", "VTKHDF/CellData"):
            if match := _LOST.fullmatch(name):
                yield f"lost_{match[1]}", run.contact_field(frame, name)

    def _of_zones(self, path: Path) -> Iterator[tuple[str, np.ndarray]]:
        shape = (len(self._share), _COMPONENTS)
        stress = read_array(path, "VTKHDF/CellData/stress [Pa]", shape)
        xx, yy, xy = (1e-6 * self._mean(stress[:, i]) for i in (0, 1, 3))
        middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
        yield "stress_y", yy
        yield "stress_1", middle + radius
        yield "stress_2", middle - radius
        if "creep_strain [1]" in names_in(path, "VTKHDF/CellData"):
            yield "creep_y", self._mean(read_array(path, "VTKHDF/CellData/creep_strain [1]", shape)[:, 1])

    def _mean(self, of_zones: np.ndarray) -> np.ndarray:
        """Returns the mean (B,) over the zones of each block, by area."""
        return np.bincount(self._block, self._share * of_zones)
