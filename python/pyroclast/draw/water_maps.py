"""Maps of the water in the pores of a heated body: its pressure, the saturation, and where the pressure would tear."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import BoundaryNorm, Normalize, to_rgb
from matplotlib.figure import Figure

from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.mesh import BlockMesh
from ..stored.results import Results
from ..stored.run_facts import WATER
from ..stored.spalled import blocks_at
from . import style
from .crack_styles import cracked, cracks_of
from .heated_sections import spread_frames
from .sections import cover_by_bearings, draw_blocks, draw_scale_bar, frame_section, height_over_width
from .solid_sections import View, crack_lines, fill_cut_open, flat, view_of
from .water import of_zones

BANDS = (0.25, 0.5, 0.75, 1.0)
"""Pressure over tensile strength, from which contacts are drawn in the next colour."""

_NARROWEST = 1.5  # inches, of a panel in a column
_WIDE = 1.0  # points, of contacts and cracks
_FIELDS = (("pore_pressure [Pa]", 1e-6, "Pore pressure [MPa]", "YlGnBu"),
           ("saturation [1]", 1.0, "Saturation", "Blues"))


@style.in_style
def water_maps(run: Results) -> Figure:
    """Draws pore pressure and saturation of the blocks and, where contacts bear the pressure, the contacts by the
    pressure over their tensile strength, with the broken ones, at up to four times; each row has one scale."""
    page, view = style.page(), view_of(run)
    frames = page.chosen(spread_frames(Heated(run).frames))
    if page.is_column:
        frames = frames[-page.fitting(_NARROWEST):]
    bears = bool(run.facts.of_role(WATER, "largest_pressure_over_strength"))
    rows = len(_FIELDS) + bears
    ratio = height_over_width(run.mesh.blocks, view=view)
    figure = style.new_figure(rows * ((page.width / (len(frames) + 0.6) - 0.12) * ratio + 0.25) + 0.6)
    grid = figure.subplots(rows, len(frames), squeeze=False)
    for row, (name, factor, label, colours) in zip(grid, _FIELDS):
        _draw_field(row, run, frames, view, name, factor, label, colours)
    if bears:
        _draw_strengths(grid[-1], run, frames, view)
    for axes, frame in zip(grid[0], frames):
        axes.set_title("" if frame.minutes is None else f"{frame.minutes:.3g} min", fontweight="bold")
    draw_scale_bar(grid[0, 0], run.mesh.blocks)
    figure.suptitle(style.title_of(run), fontsize=page.size(9.0))
    return figure


def _draw_field(row: np.ndarray, run: Results, frames: list[Frame], view: View, name: str, factor: float, label: str,
                colours: str) -> None:
    whole = run.mesh.blocks
    there = [np.isin(whole.block, blocks_at(run, frame).block) for frame in frames]
    fields = [factor * of_zones(run, frame, name) for frame in frames]
    most = max(float(field[part & ~whole.of_bearing].max()) for field, part in zip(fields, there))
    scale = ScalarMappable(Normalize(0.0, most if most > 0.0 else 1.0), colours)
    for axes, field, part in zip(row, fields, there):
        rgb = scale.to_rgba(field[part])[:, :3]
        blocks = whole.of(part)
        rgb[blocks.of_bearing] = to_rgb(style.PLATEN_COLOUR)
        _fill(axes, blocks, rgb, view)
        frame_section(axes, whole, view=view)
    row[0].figure.colorbar(scale, ax=list(row), label=label, shrink=0.9, pad=0.02)


def _fill(axes: Axes, blocks: BlockMesh, rgb: np.ndarray, view: View) -> None:
    """Fills zones, each with its colour (Z, 3); a solid lacks the quarter towards the eye."""
    if blocks.dimension == 3:
        fill_cut_open(axes, blocks, blocks.points, rgb, view)
    else:
        axes.add_collection(PolyCollection(style.MILLI * blocks.points[blocks.zones], facecolors=rgb, edgecolors=rgb,
                                           linewidths=0.3, rasterized=True))
        cover_by_bearings(axes, blocks, blocks.points)


def _draw_strengths(row: np.ndarray, run: Results, frames: list[Frame], view: View) -> None:
    contacts = run.mesh.contacts
    cells = contacts.points[contacts.cells]
    scale = ScalarMappable(BoundaryNorm(BANDS, 256, extend="max"), style.HEAT_MAP)
    for axes, frame in zip(row, frames):
        draw_blocks(axes, blocks_at(run, frame), run.mesh.blocks.points, view=view)
        share = run.contact_field(frame, "pressure_over_strength [1]")
        bands = [(scale.to_rgba(low + 1e-9), (share >= low) & (share < high))
                 for low, high in zip(BANDS, (*BANDS[1:], np.inf))]
        broken = np.any([cracked(run, frame, crack) for crack in cracks_of(run) if crack.broken], axis=0)
        for colour, which in (*bands, (style.BLACK, broken)):
            lines = crack_lines(run.mesh, cells, which, view)
            axes.add_collection(LineCollection(style.MILLI * flat(lines, view), colors=[colour], linewidths=_WIDE,
                                               rasterized=True))
        frame_section(axes, run.mesh.blocks, view=view)
    row[0].figure.colorbar(scale, ax=list(row), label="Pressure over f$_t$; broken: black", shrink=0.9, pad=0.02)
