"""Pictures of the section: its blocks, the morphology of a specimen, and its gradation."""

from __future__ import annotations


import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Polygon

from ..stored.mesh import BlockMesh, specimen_box
from ..stored.results import SpecimenFolder
from . import style
from .crack_styles import material_legend
from .solid_sections import VIEW, View, draw_cut_open, flat

MARGIN = np.full((2, 2), 0.08)
"""Margin around what is drawn, over its width: below (x, y) and above."""


def panel_box(blocks: BlockMesh, margin: np.ndarray = MARGIN, view: View = VIEW) -> tuple[np.ndarray, np.ndarray]:
    """Returns corners of what a panel shows: all blocks, and a margin, m."""
    low, high = block_box(blocks, view)
    width = (high - low)[0]
    return low - margin[0] * width, high + margin[1] * width


def block_box(blocks: BlockMesh, view: View = VIEW) -> tuple[np.ndarray, np.ndarray]:
    """Returns lower left and upper right of the picture of all blocks, bearings too, as they were at first, m."""
    points = flat(blocks.points, view)
    return points.min(axis=0), points.max(axis=0)


def height_over_width(blocks: BlockMesh, margin: np.ndarray = MARGIN, view: View = VIEW) -> float:
    """Returns the height over the width of what `frame_section` shows."""
    low, high = panel_box(blocks, margin, view)
    return (high - low)[1] / (high - low)[0]


def draw_blocks(axes: Axes, blocks: BlockMesh, points: np.ndarray, edge: str | None = None,
                view: View = VIEW) -> None:
    """Fills the blocks; without an edge colour their seams are closed. A solid lacks the quarter towards the eye."""
    if blocks.dimension == 3:
        draw_cut_open(axes, blocks, points, edge, view)
        return
    outlines, material = blocks.outlines
    for kind, colour in enumerate(style.phase_colours(blocks.materials, blocks.bearing_materials)):
        polygons = [style.MILLI * points[outlines[i]] for i in np.flatnonzero(material == kind)]
        axes.add_collection(PolyCollection(polygons, facecolors=colour, edgecolors=edge or colour,
                                           linewidths=0.15, rasterized=True))


def cover_by_bearings(axes: Axes, blocks: BlockMesh, points: np.ndarray) -> None:
    """Draws the bearings of a plane body again, over its cracks."""
    outlines, material = blocks.outlines
    of_bearings = np.flatnonzero(np.isin(material, blocks.bearing_materials))
    over = [style.MILLI * points[outlines[i]] for i in of_bearings]
    axes.add_collection(PolyCollection(over, facecolors=style.PLATEN_COLOUR, edgecolors=style.PLATEN_COLOUR,
                                       linewidths=0.15, rasterized=True, zorder=2.5))


def frame_section(axes: Axes, blocks: BlockMesh, margin: np.ndarray = MARGIN, view: View = VIEW) -> None:
    """Sets limits that hold all blocks, millimetres of one size on both axes, and neither ticks nor frame."""
    frame_box(axes, *panel_box(blocks, margin, view))


def frame_box(axes: Axes, low: np.ndarray, high: np.ndarray) -> None:
    """Sets the limits of `frame_section` by the corners of a box, m."""
    axes.set_xlim(style.MILLI * low[0], style.MILLI * high[0])
    axes.set_ylim(style.MILLI * low[1], style.MILLI * high[1])
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def draw_scale_bar(axes: Axes, blocks: BlockMesh) -> None:
    """Draws a round length below the specimen's left side; nothing in the picture of a solid, which has its axes."""
    if blocks.dimension == 3:
        return
    low, high = specimen_box(blocks)
    width = style.MILLI * (high - low)[0]
    length = max(step for step in (1, 2, 5, 10, 20, 50, 100, 200, 500) if step <= max(0.4 * width, 1))
    x, y = style.MILLI * low[0], np.mean([axes.get_ylim()[0], style.MILLI * blocks.points[:, 1].min()])
    axes.plot([x, x + length], [y, y], color=style.BLACK, linewidth=2.0, solid_capstyle="butt", clip_on=False)
    axes.text(x + length + 0.03 * width, y, f"{length} mm", va="center", fontsize=style.page().size(7.0))


@style.in_style
def morphology(specimen: SpecimenFolder) -> Figure:
    """Draws blocks by material and the circles that were placed (paper, Figure 7); a solid cut open."""
    blocks, circles = specimen.mesh.blocks, specimen.aggregates
    low, high = panel_box(blocks)
    ratio = (high - low)[1] / (high - low)[0]
    figure, axes, place = _axes_of_morphology(ratio)
    draw_blocks(axes, blocks, blocks.points, edge="#7d7d7d")
    if blocks.dimension == 3:
        frame_section(axes, blocks)
    else:
        _draw_stones(axes, specimen)
        axes.set_xlim(style.MILLI * low[0], style.MILLI * high[0])
        axes.set_ylim(style.MILLI * low[1], style.MILLI * high[1])
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_xlabel("x [mm]")
        axes.set_ylabel("y [mm]")
    told = f"{specimen.fact('blocks'):.0f} blocks{_shares(specimen)}"
    axes.set_title("\n".join(style.lines_of(told, style.page().letters)) if style.page().is_column else told)
    handles: list[Artist] = list(material_legend(blocks))
    if circles.rows and blocks.dimension == 2:
        handles.append(Line2D([], [], color=style.BLUE, marker="o", markerfacecolor="none", linestyle="none",
                              label="placed stone" if specimen.outlines else "placed circle"))
    column = style.page().is_column
    style.legend_alone(place, handles, [handle.get_label() for handle in handles],
                       loc="center" if column else "upper left", ncol=2 if column else 1)
    return figure


def _axes_of_morphology(ratio: float) -> tuple[Figure, Axes, Axes]:
    """Makes a figure with axes for a body of a height over width, and for its legend: beside it, in a column below."""
    if style.page().is_column:
        height = 0.85 * style.page().width * ratio
        figure = style.new_figure(1.2 + height)
        return figure, *figure.subplots(2, 1, gridspec_kw={"height_ratios": [height, 0.5]})
    figure = style.new_figure(height=1.0 + 4.0 * ratio, width=6.0)
    return figure, *figure.subplots(1, 2, gridspec_kw={"width_ratios": [1.0, 0.32]})


def _draw_stones(axes: Axes, specimen: SpecimenFolder) -> None:
    """Draws the surfaces of the stones as they were placed."""
    circles = specimen.aggregates
    outlines: list[Patch] = [Polygon(style.MILLI * outline) for outline in specimen.outlines]
    if not outlines:
        places = style.MILLI * np.column_stack([circles["x_m"], circles["y_m"]])
        outlines = [Circle(place, radius) for place, radius in zip(places, 0.5 * style.MILLI * circles["diameter_m"])]
    axes.add_collection(PatchCollection(outlines, facecolors="none", edgecolors=style.BLUE, linewidths=0.9))


def _shares(specimen: SpecimenFolder) -> str:
    """Returns shares of the aggregates, where there are circles; else of the materials, where there are several."""
    if specimen.aggregates.rows:
        return (f", {specimen.aggregates.rows} aggregates; aggregate fraction\n"
                f"asked {specimen.fact('fraction_asked'):.3f}, placed {specimen.fact('fraction_placed'):.3f}, "
                f"after superposition {specimen.fact('fraction_superposed'):.3f}")
    shares = {name: share for name, share in specimen.shares.items() if share > 0.0}
    if len(shares) < 2:
        return ""
    of_what = "area" if specimen.mesh.blocks.dimension == 2 else "volume"
    told = (f"{style.plain(name)} {100.0 * share:.1f} %" for name, share in shares.items())
    return f"; of the {of_what} " + ", ".join(told)


@style.in_style
def gradation(specimen: SpecimenFolder) -> Figure:
    """Draws the cumulative passing in the coarse range: asked and placed (paper, Figure 5)."""
    table = specimen.gradation
    figure, (axes,), _ = style.panels(3.8)
    diameter = style.MILLI * table["d_m"]
    axes.plot(diameter, table["asked_percent"], color=style.BLACK, label="asked, Fuller")
    axes.plot(diameter, table["placed_percent"], color=style.BLUE, linestyle=(0, (5, 1.5)),
              marker="o", markersize=3.5, label="placed")
    axes.set_xscale("log")
    ticks = [d for d in (1, 2, 4, 4.75, 8, 12.5, 16, 20, 25, 32, 63) if diameter.min() <= d <= diameter.max()]
    axes.set_xticks(ticks)
    axes.set_xticklabels([f"{d:g}" for d in ticks])
    axes.set_xticks([], minor=True)
    axes.set_ylim(0.0, 102.0)
    axes.set_xlabel("Aggregate diameter [mm]")
    by = "volume" if "z_m" in specimen.aggregates else "area"
    axes.set_ylabel(f"Passing, by {by}, within the coarse range [%]")
    style.draw_own_legend(axes)
    return figure
