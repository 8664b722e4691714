"""Cells of a meshio mesh that can be blocks, and what labels them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import Error

if TYPE_CHECKING:
    import meshio

_IN_PLANE = {"triangle": 3, "quad": 4, "polygon": 0}  # how many of the points are corners; 0: all
_IN_SPACE = {"tetra": ("012", "013", "123", "023"), "pyramid": ("0123", "014", "124", "234", "034"),
             "wedge": ("012", "345", "0143", "1254", "2035"),
             "hexahedron": ("0123", "4567", "0154", "1265", "2376", "3047"),
             "polyhedron": ()}  # corners of each face; of a polyhedron the mesh says them
KINDS = (*_IN_PLANE, *_IN_SPACE)  #: types of cells that can be blocks
_LESS_THAN_CELLS = ("vertex", "line")
_PHYSICAL = "gmsh:physical"  # gmsh's cell data


def _kind(cell_type: str) -> str:
    """Returns a type of cells without the number of its points."""
    kind = re.fullmatch(r"([a-z]+?)(_?[a-z]*)(\d*)", cell_type)
    return kind[1] + kind[2] if kind else cell_type


def dimension_of(mesh: meshio.Mesh) -> int:
    """Returns 3 for a mesh with cells of space, else 2."""
    return 3 if any(_kind(block.type) in _IN_SPACE and len(block.data) for block in mesh.cells) else 2


def corners_of_type(cell_type: str) -> int | None:
    """Returns how many of its points are corners of a cell in the plane, 0: all; None: it is left out."""
    if (kind := _kind(cell_type)) in _LESS_THAN_CELLS:
        return None
    if kind not in _IN_PLANE:
        raise Error(f"the mesh has cells of type {cell_type!r}; blocks can be {', '.join(KINDS)}")
    return _IN_PLANE[kind]


def cells_in_space(mesh: meshio.Mesh) -> tuple[list[int], list[list[int]], list[list[int]]]:
    """Returns the cells of a mesh in space: the numbers of the mesh's blocks of cells that are taken, the points around
    each face, and the faces of each cell. Cells that have the same corners of a face share it; surfaces and lines are
    left out. Raises Error for other cells.
    """
    taken: list[int] = []
    faces: list[list[int]] = []
    cells: list[list[int]] = []
    known: dict[tuple[int, ...], int] = {}

    def number(corners: list[int]) -> int:
        place = known.setdefault(tuple(sorted(corners)), len(faces))
        if place == len(faces):
            faces.append(corners)
        return place

    for i, block in enumerate(mesh.cells):
        kind = _kind(block.type)
        if kind in _LESS_THAN_CELLS or kind in _IN_PLANE:
            continue
        if kind not in _IN_SPACE:
            raise Error(f"the mesh has cells of type {block.type!r}; blocks in space can be {', '.join(_IN_SPACE)}")
        taken.append(i)
        for cell in block.data:
            loops = cell if kind == "polyhedron" else [[cell[int(c)] for c in face] for face in _IN_SPACE[kind]]
            cells.append([number([int(point) for point in loop]) for loop in loops])
    return taken, faces, cells


def labels_of(mesh: meshio.Mesh, data: str | None, phases: Mapping[Any, str] | None,
              taken: Sequence[int], dimension: int = 2) -> tuple[list[Any], Mapping[Any, str] | None]:
    """Returns a label of each cell that is taken, and the names of the labels' phases.

    taken: numbers of the mesh's blocks of cells. Raises Error where there are no such labels.
    """
    sets = {name: parts for name, parts in mesh.cell_sets.items() if not name.startswith("gmsh:")
            and any(parts[i] is not None and len(parts[i]) for i in taken)}
    groups = {name: int(value[0]) for name, value in mesh.field_data.items() if int(value[1]) == dimension}
    if data is None and sets and (phases is None or any(name in sets for name in phases)):
        return _labels_of_sets(mesh, sets, phases, taken)
    if data is None and _PHYSICAL in mesh.cell_data:
        data = _PHYSICAL
    if data not in mesh.cell_data:
        there = [f"{kind} {', '.join(some)}" for kind, some in (("cell data", mesh.cell_data), ("cell sets", sets),
                                                                ("physical groups", groups)) if some]
        if data is not None:
            remedy = "; leave data out, and name the sets by phases={...}" if sets else ""
        elif mesh.cell_data:
            remedy = f"; data={next(iter(mesh.cell_data))!r} takes cell data"
        else:
            remedy = f"; phases has {', '.join(map(repr, phases))}" if phases else ""
        missing = "nothing that names the phases of its cells" if data is None else f"no cell data {data!r}"
        raise Error(f"the mesh has {missing}; it has "
                    f"{', '.join(there) or 'no cell data, cell sets or physical groups'}{remedy}")
    labels = [label for i in taken if len(mesh.cells[i].data)
              for label in np.asarray(mesh.cell_data[data][i]).reshape(len(mesh.cells[i].data), -1)]
    if any(len(label) != 1 for label in labels):
        raise Error(f"the cell data {data!r} have {len(labels[0])} numbers for each cell; labels are one")
    values = [label[0].item() for label in labels]
    if data == _PHYSICAL and groups:
        if phases is None:
            return values, {number: name for name, number in groups.items()}
        return values, {groups.get(label, label): name for label, name in phases.items()}
    return values, phases


def _labels_of_sets(mesh: meshio.Mesh, sets: Mapping[str, Sequence[Any]], phases: Mapping[Any, str] | None,
                    taken: Sequence[int]) -> tuple[list[Any], Mapping[Any, str] | None]:
    """Returns the labels of `labels_of` from cell sets."""
    unknown = [] if phases is None else [name for name in phases if name not in mesh.cell_sets]
    if unknown:
        raise Error(f"the mesh has no cell set {unknown[0]!r}; it has {', '.join(mesh.cell_sets)}")
    labels: list[str] = []
    for i in taken:
        of_block: list[str | None] = [None] * len(mesh.cells[i].data)
        for name in (sets if phases is None else phases):
            if name not in sets or sets[name][i] is None:
                continue
            for cell in np.asarray(sets[name][i], int).tolist():
                if (other := of_block[cell]) is not None:
                    raise Error(f"cell {len(labels) + cell} (from 0) is in the cell sets {other!r} and {name!r}; say "
                                "by phases={...} which sets are phases")
                of_block[cell] = name
        for cell, name in enumerate(of_block):
            if name is None:
                raise Error(f"cell {len(labels) + cell} (from 0) is in none of the cell sets "
                            f"{', '.join(sets if phases is None else phases)}; the mesh has {', '.join(sets)}")
        labels += [name for name in of_block if name is not None]
    return labels, phases
