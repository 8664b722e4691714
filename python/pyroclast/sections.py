"""Pictures of the section: fracture of a run, morphology of a specimen, and its gradation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from . import style
from .crack_styles import count_cracks, crack_legend, cracked, cracks_of, material_legend
from .mesh import BlockMesh, ContactMesh, specimen_box
from .solid_sections import crack_lines, draw_cut_open, flat

if TYPE_CHECKING:
    from .files import Table
    from .results import Frame, Results, SpecimenFolder

_BEFORE_PEAK = 0.85  # strain of frame A over that of the peak: the first cracks have opened
_AFTER_PEAK = 0.8  # stress of frame C over that of the peak
_MAGNIFICATIONS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
_LARGEST_MOVE_DRAWN = 0.06  # of the specimen's height
_MARGIN = np.full((2, 2), 0.08)  # around what is drawn, of its width: below (x, y) and above
_LARGEST_MARGIN = 0.3  # for blocks that have moved out
_PANELS = 4
_TITLE_HEIGHT, _CAPTION_LINE, _HEADING_LINE, _LEGEND_HEIGHT = 0.3, 0.125, 0.17, 0.65  # in print, inches
_EDGE_OF_FULL_WIDTH, _LEAST_THINNING = 5.0, 0.45  # edge in print, points; factor on line widths


def select_frames(frames: Sequence[Frame], peak_strain: float, peak_stress: float) -> dict[str, Frame]:
    """Frames A to D, by letter: before the peak, at it, after it, and the end.

    B is the frame nearest to the peak strain; A, among those before, the one nearest to 85 % of it; D the
    last; C, between B and D, the one whose stress is nearest to 80 % of the peak, or halfway down to D when D
    is above 60 %. A letter is left out when no frame is there for it.
    frames: those of the loading stage, in order, at least one. peak_stress: MPa.
    """
    peak = min(range(len(frames)), key=lambda i: abs(frames[i].strain - peak_strain))
    selected = {}
    if before := frames[:peak]:
        selected["A"] = min(before, key=lambda frame: abs(frame.strain - _BEFORE_PEAK * peak_strain))
    selected["B"] = frames[peak]
    after = [frame for frame in frames[peak + 1:] if frame.step > frames[peak].step]
    if after:
        end = after[-1]
        wanted = max(_AFTER_PEAK * peak_stress, 0.5 * (peak_stress + end.stress_MPa))
        if falling := [frame for frame in after if frame.step < end.step]:
            selected["C"] = min(falling, key=lambda frame: abs(frame.stress_MPa - wanted))
        selected["D"] = end
    return selected


@dataclass(frozen=True)
class Panel:
    """One fractured specimen in a figure; without a frame only the caption is drawn, in its place."""

    run: Results
    frame: Frame | None
    title: str
    caption: str


def fracture(run: Results, marks: Mapping[str, Frame], magnification: float | None = None) -> Figure:
    """The deformed specimen with its cracks at the marked frames (paper, Figure 9).

    marks: as `select_frames` gives them. magnification of displacements: as `fracture_panels` takes it.
    """
    panels = [Panel(run, frame, letter, _caption(run, frame)) for letter, frame in marks.items()]
    return fracture_panels([("", panels)], style.title_of(run), magnification,
                           f"Counts are contact points ({points_of_contact(run)}) of A–M and M–M contacts.")


def points_of_contact(run: Results) -> str:
    """How many contact points two blocks have."""
    return "two an edge" if run.mesh.blocks.dimension == 2 else "one a corner of a face"


@matplotlib.rc_context(style.STYLE)
def fracture_panels(rows: Sequence[tuple[str, Sequence[Panel]]], heading: str, magnification: float | None,
                    note: str) -> Figure:
    """Deformed specimens with their cracks, in labelled rows of equally many panels; some have a frame.

    magnification of displacements: the same in all panels; when None, the largest round one at which, in the
    last panel of each row, 95 % of the gridpoints move by less than 6 % of the height. note: on the counts.
    """
    if magnification is None:
        lasts = [[panel for panel in panels if panel.frame][-1] for _, panels in rows]
        magnification = min(_visible_magnification(last.run, last.frame) for last in lasts)
    moved = [[_moved(panel, magnification) for panel in panels] for _, panels in rows]
    margin = _margin((panel.run.mesh.blocks, points) for (_, panels), row in zip(rows, moved)
                     for panel, points in zip(panels, row))
    columns = max(len(panels) for _, panels in rows)
    panel_width = style.WIDTH / max(columns, _PANELS) - 0.12
    panel_heights = [panel_width * height_over_width(panels[0].run.mesh.blocks, margin) for _, panels in rows]
    lines = [max(panel.caption.count("\n") + 1 for panel in panels) for _, panels in rows]
    heading = f"{heading}\ndisplacements ×{magnification:g}".lstrip()
    texts = sum(_TITLE_HEIGHT + _CAPTION_LINE * n for n in lines) + _HEADING_LINE * (heading.count("\n") + 1)
    figure = style.new_figure(sum(panel_heights) + texts + _LEGEND_HEIGHT, dpi=2 * style.DPI)
    grid = figure.add_gridspec(len(rows) + 1, columns, height_ratios=[*panel_heights, _LEGEND_HEIGHT])
    for row, (label, panels) in enumerate(rows):
        all_axes = [figure.add_subplot(grid[row, column]) for column in range(len(panels))]
        for axes, panel, points in zip(all_axes, panels, moved[row]):
            _draw_panel(axes, panel, points, magnification, columns)
            frame_section(axes, panel.run.mesh.blocks, margin)
        all_axes[0].set_ylabel(label)
        if row == 0:
            draw_scale_bar(all_axes[0], panels[0].run.mesh.blocks)
    figure.suptitle(heading, fontsize=9.0)
    handles = fracture_legend(rows[0][1][0].run)
    below = figure.add_subplot(grid[-1, :])
    style.legend_alone(below, handles, [handle.get_label() for handle in handles], loc="center", ncol=4 if columns < 5 else 3,
                       title_fontsize=7.0, title=note)
    below.get_legend().set_in_layout(False)  # it is as wide as the page, and would make the panels narrower
    return figure


def draw_specimen(axes: Axes, run: Results, frame: Frame) -> float:
    """The deformed specimen with its cracks, alone in its axes. Returns the magnification of its displacements."""
    magnification = _visible_magnification(run, frame)
    panel = Panel(run, frame, "", "")
    points = _moved(panel, magnification)
    _draw_fractured(axes, run, frame, points, magnification, columns=1)
    frame_section(axes, run.mesh.blocks, _margin([(run.mesh.blocks, points)]))
    draw_scale_bar(axes, run.mesh.blocks)
    return magnification


def _moved(panel: Panel, magnification: float) -> np.ndarray:
    """(N, 2), m: gridpoints where they are drawn."""
    points = panel.run.mesh.blocks.points
    return points + magnification * panel.run.gridpoint_displacement(panel.frame) if panel.frame else points


def _draw_panel(axes: Axes, panel: Panel, points: np.ndarray, magnification: float, columns: int) -> None:
    if panel.frame:
        _draw_fractured(axes, panel.run, panel.frame, points, magnification, columns)
        axes.set_xlabel(panel.caption, fontsize=6.5, linespacing=1.4)
    else:
        axes.text(0.5, 0.5, panel.caption, transform=axes.transAxes, ha="center", va="center", fontsize=7.0,
                  color="#6a6a6a")
    axes.set_title(panel.title, fontweight="bold")


def _panel_box(blocks: BlockMesh, margin: np.ndarray = _MARGIN) -> tuple[np.ndarray, np.ndarray]:
    """Corners of what a panel shows: all blocks, and a margin, m."""
    low, high = _block_box(blocks)
    width = (high - low)[0]
    return low - margin[0] * width, high + margin[1] * width


def _block_box(blocks: BlockMesh) -> tuple[np.ndarray, np.ndarray]:
    """Lower left and upper right corner in the picture of all blocks, bearings too, where they were at first, m."""
    points = flat(blocks.points)
    return points.min(axis=0), points.max(axis=0)


def _margin(panels: Iterable[tuple[BlockMesh, np.ndarray]]) -> np.ndarray:
    """What holds all blocks where they are drawn, as far as _LARGEST_MARGIN allows.

    panels: blocks, and where their gridpoints are drawn, m.
    """
    margin = _MARGIN
    for blocks, drawn in panels:
        low, high = _block_box(blocks)
        places = flat(drawn)
        reach = np.array([low - places.min(axis=0), places.max(axis=0) - high]) / (high - low)[0]
        margin = np.maximum(margin, 0.2 * _MARGIN + reach)
    return np.minimum(margin, _LARGEST_MARGIN)


def _visible_magnification(run: Results, frame: Frame) -> float:
    low, high = specimen_box(run.mesh.blocks)
    moved = np.percentile(np.linalg.norm(run.gridpoint_displacement(frame), axis=1), 95)
    fitting = [m for m in _MAGNIFICATIONS if m * moved <= _LARGEST_MOVE_DRAWN * (high - low)[1]]
    return fitting[-1] if fitting and moved > 0.0 else 1


def height_over_width(blocks: BlockMesh, margin: np.ndarray = _MARGIN) -> float:
    """Of what `frame_section` shows."""
    low, high = _panel_box(blocks, margin)
    return (high - low)[1] / (high - low)[0]


def _draw_fractured(axes: Axes, run: Results, frame: Frame, points: np.ndarray, magnification: float,
                    columns: int) -> None:
    blocks, contacts = run.mesh.blocks, run.mesh.contacts
    draw_blocks(axes, blocks, points)
    cells = (contacts.points + magnification * run.contact_displacement(frame))[contacts.cells]
    thinning = _thinning(blocks, contacts, max(columns, _PANELS))
    for crack in cracks_of(run):
        which = cracked(run, frame, crack)
        lines = cells[which] if blocks.dimension == 2 else crack_lines(run.mesh, cells, which)
        drawn = style.MILLI * flat(lines)
        axes.add_collection(LineCollection(drawn, colors=crack.colour, linewidths=thinning * crack.width,
                                           capstyle="round", rasterized=True))


def _thinning(blocks: BlockMesh, contacts: ContactMesh, columns: int) -> float:
    """Factor on line widths that keeps cracks apart where blocks are small in print."""
    low, high = _panel_box(blocks)
    points_per_metre = 72.0 * style.WIDTH / columns / (high - low)[0]
    # the extent of a contact point is half of an edge, or the part of a face at a corner
    sizes = 2.0 * contacts.extent if blocks.dimension == 2 else 2.0 * np.sqrt(contacts.extent)
    edge = points_per_metre * np.median(sizes) if len(sizes) else np.inf
    return float(np.clip(edge / _EDGE_OF_FULL_WIDTH, _LEAST_THINNING, 1.0))


def draw_blocks(axes: Axes, blocks: BlockMesh, points: np.ndarray, edge: str | None = None) -> None:
    """Fills the blocks; without an edge colour their seams are closed. A solid lacks the quarter towards the eye."""
    if blocks.dimension == 3:
        draw_cut_open(axes, blocks, points, edge)
        return
    outlines, material = blocks.outlines
    for kind, colour in enumerate(style.phase_colours(blocks.materials, blocks.bearing_materials)):
        polygons = [style.MILLI * points[outlines[i]] for i in np.flatnonzero(material == kind)]
        axes.add_collection(PolyCollection(polygons, facecolors=colour, edgecolors=edge or colour,
                                           linewidths=0.15, rasterized=True))


def frame_section(axes: Axes, blocks: BlockMesh, margin: np.ndarray = _MARGIN) -> None:
    """Limits that hold all blocks, millimetres of one size on both axes, and neither ticks nor frame."""
    low, high = _panel_box(blocks, margin)
    axes.set_xlim(style.MILLI * low[0], style.MILLI * high[0])
    axes.set_ylim(style.MILLI * low[1], style.MILLI * high[1])
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _caption(run: Results, frame: Frame) -> str:
    counts = count_cracks(run, frame)
    return (
        f"$\\varepsilon$ = {style.PER_MILLE * frame.strain:.2f}$\\times 10^{{-3}}$\n"
        f"$\\sigma$ = {frame.stress_MPa:.1f} MPa,\n{100.0 * frame.stress_MPa / run.peak[1]:.0f} % of peak\n"
        f"broken:\n{_listed(counts, True)}\n"
        f"damaged by more than half:\n{_listed(counts, False)}"
    )


def _listed(counts: dict[tuple[str, bool], int], broken: bool) -> str:
    return ", ".join(f"{count} {mode}" for (mode, is_broken), count in counts.items() if is_broken == broken)


def draw_scale_bar(axes: Axes, blocks: BlockMesh) -> None:
    """A round length below the specimen's left side; nothing in the picture of a solid, which has its axes."""
    if blocks.dimension == 3:
        return
    low, high = specimen_box(blocks)
    width = style.MILLI * (high - low)[0]
    length = max(step for step in (1, 2, 5, 10, 20, 50, 100, 200, 500) if step <= max(0.4 * width, 1))
    x, y = style.MILLI * low[0], np.mean([axes.get_ylim()[0], style.MILLI * blocks.points[:, 1].min()])
    axes.plot([x, x + length], [y, y], color=style.BLACK, linewidth=2.0, solid_capstyle="butt", clip_on=False)
    axes.text(x + length + 0.03 * width, y, f"{length} mm", va="center", fontsize=7.0)


def fracture_legend(run: Results) -> list:
    """Handles of the cracks and materials that `fracture` and `draw_specimen` draw."""
    return crack_legend(run) + material_legend(run.mesh.blocks)


@matplotlib.rc_context(style.STYLE)
def morphology(specimen: SpecimenFolder) -> Figure:
    """Blocks by material and the circles that were placed (paper, Figure 7); a solid cut open."""
    blocks, circles = specimen.mesh.blocks, specimen.aggregates
    low, high = _panel_box(blocks)
    figure = style.new_figure(height=1.0 + 4.0 * (high - low)[1] / (high - low)[0], width=6.0)
    axes, beside = figure.subplots(1, 2, gridspec_kw={"width_ratios": [1.0, 0.32]})
    draw_blocks(axes, blocks, blocks.points, edge="#7d7d7d")
    if blocks.dimension == 3:
        frame_section(axes, blocks)
    else:
        _draw_circles(axes, circles)
        axes.set_xlim(style.MILLI * low[0], style.MILLI * high[0])
        axes.set_ylim(style.MILLI * low[1], style.MILLI * high[1])
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_xlabel("x [mm]")
        axes.set_ylabel("y [mm]")
    axes.set_title(f"{specimen.fact('blocks'):.0f} blocks{_shares(specimen)}")
    handles: list[Artist] = list(material_legend(blocks))
    if circles.rows and blocks.dimension == 2:
        handles.append(Line2D([], [], color=style.BLUE, marker="o", markerfacecolor="none", linestyle="none",
                              label="placed circle"))
    style.legend_alone(beside, handles, [handle.get_label() for handle in handles], loc="upper left")
    return figure


def _draw_circles(axes: Axes, circles: Table) -> None:
    places = style.MILLI * np.column_stack([circles["x_m"], circles["y_m"]])
    outlines = [Circle(place, radius) for place, radius in zip(places, 0.5 * style.MILLI * circles["diameter_m"])]
    axes.add_collection(PatchCollection(outlines, facecolors="none", edgecolors=style.BLUE, linewidths=0.9))


def _shares(specimen: SpecimenFolder) -> str:
    """Of the aggregates, where there are circles; else of the materials, where there are several."""
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


@matplotlib.rc_context(style.STYLE)
def gradation(specimen: SpecimenFolder) -> Figure:
    """Cumulative passing in the coarse range: asked and placed (paper, Figure 5)."""
    table = specimen.gradation
    figure = style.new_figure(3.8)
    axes = figure.add_subplot()
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
    axes.legend(loc="upper left")
    return figure
