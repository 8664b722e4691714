"""A small picture of a specimen in its last frame."""

from __future__ import annotations

import io

import numpy as np
from PIL import Image, ImageDraw

from ..draw.crack_styles import cracked, cracks_of
from ..draw.style import phase_colours
from ..stored.results import Results
from .plane_body import outline_of

_HEIGHT = 132  # pixels
_FINER = 2  # it is drawn so many times as large


def thumbnail(run: Results) -> bytes:
    """Draws a PNG: blocks by material and broken contacts, empty without frames, or of a solid."""
    if not run.has_fields or not run.frames or run.mesh.blocks.dimension == 3:
        return b""
    blocks, contacts = run.mesh.blocks, run.mesh.contacts
    outline = outline_of(run.mesh)
    corner = blocks.points[outline.gridpoint]
    low, high = corner.min(axis=0), corner.max(axis=0)
    scale = _FINER * _HEIGHT / float((high - low).max())
    width, height = np.maximum(np.ceil(scale * (high - low)).astype(int), 1).tolist()
    picture = Image.new("RGB", (width, height), "white")
    draw = ImageDraw.Draw(picture)

    def placed(points: np.ndarray) -> list[tuple[float, float]]:
        return [(scale * (x - low[0]), height - scale * (y - low[1])) for x, y in points]

    fills = phase_colours(blocks.materials, blocks.bearing_materials)
    for start, end, material in zip(outline.first[:-1], outline.first[1:], outline.material):
        draw.polygon(placed(corner[start:end]), fill=fills[material])
    for crack in cracks_of(run) if run.moves else []:
        if crack.broken:
            for line in contacts.points[contacts.cells[cracked(run, run.frames[-1], crack)]]:
                draw.line(placed(line), fill=crack.colour, width=_FINER)
    data = io.BytesIO()
    small = picture.resize((max(1, width // _FINER), max(1, height // _FINER)), Image.LANCZOS)
    small.quantize(64).save(data, "PNG", optimize=True)
    return data.getvalue()
