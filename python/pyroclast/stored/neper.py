"""Cells of a tessellation of Neper in space."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import Error

Cells = tuple[NDArray[Any], list[list[int]], list[list[int]], "list[int] | None"]


class _Words:
    """Words of a file, in turn, with their lines."""

    def __init__(self, text: str, file: Path):
        self._words: Iterator[tuple[int, str]] = ((number, word) for number, line in enumerate(text.splitlines(), 1)
                                                  for word in line.split())
        self._file, self._line = file, 0

    def next(self) -> str:
        """Returns the next word, "" at the end."""
        self._line, word = next(self._words, (self._line, ""))
        return word

    def numbers(self, count: int, what: str) -> list[float]:
        words = [self.next() for _ in range(count)]
        try:
            return [float(word) for word in words]
        except ValueError:
            raise self.wrong(f"{what} must be {count} number{'' if count == 1 else 's'}; got {' '.join(words[:5])}"
                             ) from None

    def integers(self, count: int, what: str) -> list[int]:
        return [int(number) for number in self.numbers(count, what)]

    def count(self, what: str) -> int:
        return self.integers(1, f"the number of {what}")[0]

    def wrong(self, what: str) -> Error:
        return Error(f"{self._file}: line {self._line}: {what}")


def read_tess(file: Path) -> Cells:
    """Reads a three-dimensional tessellation (.tess, format 2.0 to 3.x; Quey et al., CMAME 200, 2011).

    Returns vertices (n, 3) in the file's unit, the vertices around each face and the faces of each cell, from 0, and
    the group (`*group`) of each cell, None where there are no groups. Cells without faces are left out.

    Raises Error, with the line, for a file of another form or dimension, or a periodic one.
    """
    words = _Words(file.read_text(encoding="utf-8-sig"), file)
    if words.next() != "***tess":
        raise words.wrong("must begin with ***tess: it is no tessellation of Neper")
    at: dict[int, list[float]] = {}
    faces: dict[int, list[int]] = {}
    cells: list[list[int]] = []
    groups: list[int] | None = None
    count = 0
    while word := words.next():
        if word == "**general":
            (dimension,), kind = words.integers(1, "the dimension"), words.next()
            if dimension != 3:
                raise words.wrong(f"the tessellation is of dimension {dimension}; one of the plane is [blocks] file of "
                                  "a deck (see docs/do/bodies.md, Tessellations of Neper)")
            if kind != "standard":
                raise words.wrong(f"the tessellation is {kind}; only a standard one has an outline")
        elif word == "**cell":
            count = words.count("cells")
        elif word == "*group":
            groups = words.integers(count, "the groups of cells")
        elif word == "**vertex":
            for _ in range(words.count("vertices")):
                number, *place = words.numbers(4, "a vertex")
                at[int(number)] = place
                words.next()
        elif word == "**face":
            for _ in range(words.count("faces")):
                number, corners = words.integers(2, "a face")
                faces[number] = words.integers(corners, "the vertices of a face")
                words.integers(words.count("edges"), "the edges of a face")
                words.numbers(9, "the plane, state and point of a face")
        elif word == "**polyhedron":
            for _ in range(words.count("polyhedra")):
                _, its = words.integers(2, "a polyhedron")
                cells.append([abs(face) for face in words.integers(its, "the faces of a polyhedron")])
        elif word in ("**domain", "***end"):
            break
    if not at or not faces or not cells or len(cells) != count:
        raise words.wrong(f"has {len(at)} vertices, {len(faces)} faces and {len(cells)} polyhedra for {count} cells")
    vertex = {number: i for i, number in enumerate(at)}
    face = {number: i for i, number in enumerate(faces)}
    try:
        of_faces = [[vertex[v] for v in corners] for corners in faces.values()]
        of_cells = [[face[f] for f in its] for its in cells]
    except KeyError as error:
        raise words.wrong(f"names {error.args[0]}, which is no vertex or face") from None
    kept = [i for i, its in enumerate(of_cells) if its]
    return (np.array(list(at.values())), of_faces, [of_cells[i] for i in kept],
            None if groups is None else [groups[i] for i in kept])
