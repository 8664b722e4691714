"""Cells of a meshio mesh that can be blocks, and what labels them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import Error

if TYPE_CHECKING:
    import meshio

KINDS = {"triangle": 3, "quad": 4, "polygon": 0}  #: how many of the points are corners; 0: all
IN_SPACE = ('blocks in space come by [specimen] shape = "polyhedra" and file, which is JSON with their faces (see '
            "docs/do/bodies.md, Blocks made elsewhere)")
_LESS_THAN_CELLS = ("vertex", "line")
_OF_SPACE = ("tetra", "hexahedron", "wedge", "pyramid", "polyhedron", "penta_prism", "hexa_prism")
_PHYSICAL, _PLANE = "gmsh:physical", 2  # gmsh's cell data; the dimension of its groups of cells


def corners_of_type(cell_type: str) -> int | None:
    """Returns how many of its points are corners of a cell of a mesh, 0: all; None: it is left out."""
    kind = re.fullmatch(r"([a-z]+?)(\d*)", cell_type)
    name = kind[1] if kind else cell_type
    if name in _LESS_THAN_CELLS:
        return None
    if name not in KINDS:
        raise Error(f"the mesh has cells of type {cell_type!r}; blocks can be {', '.join(KINDS)}"
                    + (f". A specimen of a mesh is of the plane; {IN_SPACE}" if name in _OF_SPACE else ""))
    return KINDS[name]


def labels_of(mesh: meshio.Mesh, data: str | None, phases: Mapping[Any, str] | None,
              taken: Sequence[int]) -> tuple[list[Any], Mapping[Any, str] | None]:
    """Returns a label of each cell that is taken, and the names of the labels' phases.

    taken: numbers of the mesh's blocks of cells. Raises Error where there are no such labels.
    """
    sets = {name: parts for name, parts in mesh.cell_sets.items() if not name.startswith("gmsh:")
            and any(parts[i] is not None and len(parts[i]) for i in taken)}
    groups = {name: int(value[0]) for name, value in mesh.field_data.items() if int(value[1]) == _PLANE}
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
