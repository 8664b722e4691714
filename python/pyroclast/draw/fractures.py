"""Fractured specimens side by side: which frames are drawn, with which cracks, and how many cracks these are."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.patches import Rectangle

from ..errors import Error
from ..stored.compressed import Compressed
from ..stored.frames import Frame
from ..stored.mesh import BlockMesh, ContactMesh, specimen_box
from ..stored.results import Results
from ..stored.spalled import blocks_at
from ..writing import whole
from . import style
from .crack_styles import can_crack, count_cracks, crack_legend, cracked, cracks_of, material_legend, size_of_cracks
from .sections import (MARGIN, block_box, cover_by_bearings, draw_blocks, draw_scale_bar, frame_box, frame_section,
                       height_over_width, panel_box)
from .solid_sections import VIEW, View, crack_lines, flat, view_of

_BEFORE_PEAK = 0.85  # strain of frame A over that of the peak: the first cracks have opened
_AFTER_PEAK = 0.8  # stress of frame C over that of the peak
_AT_PEAK = 0.98  # of the largest stress, that a frame has to have to be called the peak
_MAGNIFICATIONS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
_LARGEST_MOVE_DRAWN = 0.06  # of the specimen's height
_LARGEST_MARGIN = 0.3  # for blocks that have moved out
_OF_SCALE_BAR = np.array([[0.0, 0.2], [0.0, 0.0]])  # that the bar's text needs in a column
_PANELS, _PANELS_OF_SQUARE = 4, 2
"""Least number of panels for which a page has room side by side, and that of bodies hardly higher than wide."""
_SQUARE = 1.45  # height over width, with platens and margins, up to which a body is one of these
_TITLE_HEIGHT, _CAPTION_LINE, _HEADING_LINE, _LEGEND_LINE = 0.3, 0.125, 0.17, 0.16  # in print, inches
_NOTE_LETTERS = 125  # of a line below a figure on a page of two columns
_NARROWEST, _LEAST_WIDTH = 1.55, 0.85  # inches, of a panel in a column: as it stands well, and with a short caption
_EDGE_OF_FULL_WIDTH, _LEAST_THINNING = 5.0, 0.45  # edge in print, points; factor on line widths
_BOLD_LETTER = 0.07  # inches, mean width in a title of a panel
_SYMBOL = re.compile(r"^\$\\\w+\$ = |(?<=^\$)\\varepsilon_\{\\mathrm\{tot\}\} = ", re.MULTILINE)
"""Symbol before a number of a caption, whose unit tells what it is."""
_THINNEST = 0.4  # width of a crack that has just opened over that of the widest
_WIDE = 0.65  # height over width, below which panels are stacked
_BODY_SHARE = 0.66  # of the page, where an enlargement stands beside a wide body
_ENLARGEMENTS = (5, 4, 3, 2)
_LOCAL = 0.4  # of the body's width: cracks that reach farther are not enlarged
_BOTH = 0.45  # width of tension on a contact that broke in shear too


def select_frames(frames: Sequence[Frame], peak_strain: float, peak_stress: float) -> dict[str, Frame]:
    """Returns frames A to D, by letter: before the peak, at it, after it, and the end.

    B is the frame nearest to the peak, by strain and stress, each over that of the peak; A, among those before, the
    one nearest to 85 % of its strain; D the last; C, between B and D, the one whose stress is nearest to 80 % of the
    peak, or halfway down to D when D is above 60 %. A letter is left out when no frame is there for it.
    frames: those of the loading stage, in order, at least one. peak_stress: MPa.
    """
    peak = min(range(len(frames)), key=lambda i: abs(frames[i].strain / peak_strain - 1.0)
               + abs(frames[i].stress / peak_stress - 1.0))
    selected = {}
    if before := frames[:peak]:
        selected["A"] = min(before, key=lambda frame: abs(frame.strain - _BEFORE_PEAK * peak_strain))
    selected["B"] = frames[peak]
    after = [frame for frame in frames[peak + 1:] if frame.step > frames[peak].step]
    if after:
        end = after[-1]
        wanted = max(_AFTER_PEAK * peak_stress, 0.5 * (peak_stress + end.stress))
        if falling := [frame for frame in after if frame.step < end.step]:
            selected["C"] = min(falling, key=lambda frame: abs(frame.stress - wanted))
        selected["D"] = end
    return selected


@dataclass(frozen=True)
class Panel:
    """One fractured specimen in a figure; without a frame only the caption is drawn, in its place."""

    run: Results
    frame: Frame | None
    title: str
    caption: str  #: at most three numbers, a line each


@dataclass(frozen=True)
class Rows:
    """What a figure of fractured specimens shows: labelled rows of panels; some have a frame."""

    rows: Sequence[tuple[str, Sequence[Panel]]]
    heading: str
    note: str = ""  #: on the numbers in the captions

    @property
    def panels(self) -> list[Panel]:
        """All panels that have a frame."""
        return [panel for _, panels in self.rows for panel in panels if panel.frame]


def fracture(run: Results, marks: Mapping[str, Frame]) -> Rows:
    """Takes the deformed specimen with its cracks at the marked frames (paper, Figure 9).

    marks: as `select_frames` gives them.
    """
    test = Compressed(run)
    strength = test.peak[1]
    panels = []
    for letter, frame in marks.items():
        is_peak = test.has_peak and letter == "B" and frame.stress >= _AT_PEAK * strength
        caption = (f"$\\varepsilon$ = {style.PER_MILLE * frame.strain:.2f}$\\times 10^{{-3}}$\n"
                   f"$\\sigma$ = {frame.stress:.1f} MPa\n"
                   f"{100.0 * frame.stress / strength:.0f} % of {'$f_c$' if test.has_peak else 'the largest'}")
        panels.append(Panel(run, frame, f"{letter}, peak" if is_peak else letter, caption))
    return Rows([("", panels)], style.title_of(run))


def broken_share(run: Results, frame: Frame) -> float:
    """Returns the extent of broken contact points, by any mode, over that of all that can break."""
    inner = can_crack(run, {name for names in run.facts.crack_modes.values() for name in names})
    broken = np.zeros(len(inner), dtype=bool)
    for crack in cracks_of(run):
        if crack.broken:
            broken |= cracked(run, frame, crack)
    extent = run.mesh.contacts.extent
    return float(extent[broken].sum() / extent[inner].sum()) if inner.any() else 0.0


def write_counts(path: Path, drawn: Rows) -> None:
    """Writes a row for each panel: its frame, and by mode how many contact points are broken, or damaged by more than
    half and not broken, and the extent of both: lengths in m, of a solid areas in m².
    """
    runs = [panel.run for panel in drawn.panels]
    modes = list(dict.fromkeys(mode for run in runs for mode in run.facts.crack_modes))
    unit = "_".join(runs[0].facts.extent)
    columns = [f"{mode}_{state}{ending}" for mode in modes for state in ("broken", "damaged_above_half")
               for ending in ("", f"_{unit}")]
    with whole(path) as aside, open(aside, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["run", "panel", "frame", "stage", "step", "time_s", "strain", "stress_MPa", "temperature_degC",
                         "broken_share", *columns])
        for panel in drawn.panels:
            run, frame = panel.run, panel.frame
            counts, extents = count_cracks(run, frame), size_of_cracks(run, frame)
            numbers = [f"{values[mode, is_broken]:.9g}" if (mode, is_broken) in counts else ""
                       for mode in modes for is_broken in (True, False) for values in (counts, extents)]
            writer.writerow([run.folder.resolve().name, panel.title, frame.number, frame.stage, frame.step, frame.time,
                             frame.strain, frame.stress, "" if frame.temperature is None else frame.temperature,
                             f"{broken_share(run, frame):.6g}", *numbers])


@dataclass(frozen=True)
class _Look:
    """How all panels of a figure are drawn."""

    magnification: float  # of displacements
    margin: np.ndarray  # (2, 2), see MARGIN
    full: float  # m: size of the jump at a broken crack of full width
    across: int  # panels side by side on the page
    enlarged: tuple[np.ndarray, np.ndarray] | None  # corners of what is drawn larger too, m
    view: View = VIEW  # of solids


@style.in_style
def fracture_panels(drawn: Rows, magnification: float | None = None) -> Figure:
    """Draws deformed specimens with their cracks. Panels of a body that is wide stand one below the other, each with
    its cracks enlarged.

    magnification of displacements: the same in all panels; when None, the largest round one at which, in the
    last panel of each row, 95 % of the gridpoints move by less than 6 % of the height.
    """
    drawn = _chosen(drawn, style.page())
    lasts = [[panel for panel in panels if panel.frame][-1] for _, panels in drawn.rows]
    if magnification is None:
        magnification = min(_visible_magnification(last.run, last.frame) for last in lasts)
    view = view_of(lasts[0].run)  # of all panels, which can so be compared
    margin = _margin(((panel.run.mesh.blocks, _moved(panel, magnification))
                      for _, panels in drawn.rows for panel in panels), view)
    is_wide = all(height_over_width(last.run.mesh.blocks, margin, view) < _WIDE for last in lasts)
    page, most = style.page(), max(len(panels) for _, panels in drawn.rows)
    full = _full_width(lasts)
    narrowest = max(_LEAST_WIDTH, _BOLD_LETTER * max(len(panel.title) for _, panels in drawn.rows for panel in panels))
    for across in range(1 if is_wide else min(most, page.fitting(_NARROWEST)) if page.is_column else most, most + 1):
        look = _Look(magnification, margin, full, across, None, view)
        lines = [(label if not first else "", panels[first:first + across]) for label, panels in drawn.rows
                 for first in range(0, len(panels), across)]
        if is_wide or page.width / (across + 1) < narrowest or _height(drawn, lines, look) <= page.highest:
            break
    if is_wide and (box := _crack_box(lasts, magnification)):
        return _draw_stacked(drawn, lines, look, box)
    return _draw_lines(drawn, lines, look)


def _chosen(drawn: Rows, page: style.Page) -> Rows:
    """Returns what the page wants of each row. Raises Error where nothing with a frame is left in one."""
    rows = [(label, page.kept(panels)) for label, panels in drawn.rows]
    if not all(any(panel.frame for panel in panels) for _, panels in rows):
        raise Error(f"a row has {max(len(panels) for _, panels in drawn.rows)} panels, and none of the numbers "
                    f"{', '.join(map(str, page.panels))}")
    return replace(drawn, rows=rows)


def _body_heights(lines: Sequence[tuple[str, Sequence[Panel]]], look: _Look) -> list[float]:
    """Returns heights of the bodies of each line, inches, as wide as their panels are."""
    page = style.page()
    ratio = height_over_width(lines[0][1][0].run.mesh.blocks, look.margin, look.view)
    least = 1 if page.is_column or ratio < _WIDE else _PANELS_OF_SQUARE if ratio < _SQUARE else _PANELS
    width = page.width / max(look.across, least) - 0.12
    return [width * height_over_width(panels[0].run.mesh.blocks, look.margin, look.view) for _, panels in lines]


def _height(drawn: Rows, lines: Sequence[tuple[str, Sequence[Panel]]], look: _Look) -> float:
    """Returns the height of the whole figure, inches, with bodies as wide as their panels."""
    heights = _body_heights(lines, look)
    return sum(heights) + sum(_text_heights(drawn, lines, look, heights))


def _draw_lines(drawn: Rows, lines: Sequence[tuple[str, Sequence[Panel]]], look: _Look) -> Figure:
    figure, grid = _figure(drawn, lines, look, _body_heights(lines, look), [1.0] * look.across)
    for row, (label, panels) in enumerate(lines):
        all_axes = [figure.add_subplot(grid[row, column]) for column in range(len(panels))]
        for axes, panel in zip(all_axes, panels):
            _draw_panel(axes, panel, look)
        all_axes[0].set_ylabel(label)
        if row == 0:
            draw_scale_bar(all_axes[0], panels[0].run.mesh.blocks)
    _draw_legend(figure, grid, drawn, look)
    return figure


def _draw_stacked(drawn: Rows, lines: Sequence[tuple[str, Sequence[Panel]]], look: _Look,
                  box: tuple[np.ndarray, np.ndarray]) -> Figure:
    """Draws each panel on a line of its own: the body, and beside it what is enlarged."""
    page = style.page()
    blocks = lines[0][1][0].run.mesh.blocks
    body = _BODY_SHARE * page.width - 0.12
    height = body * height_over_width(blocks, look.margin)
    room = (page.width - body - 0.24, max(height, 0.3 * page.width))
    low, high = panel_box(blocks, look.margin)
    factor, look = _enlarged(box, body / (high - low)[0], room, look)
    figure, grid = _figure(drawn, lines, look, [room[1]] * len(lines), [body, room[0]])
    for row, (label, (panel,)) in enumerate(lines):
        axes, beside = (figure.add_subplot(grid[row, column]) for column in range(2))
        _draw_panel(axes, replace(panel, caption=panel.caption.replace("\n", ", ")), look)
        axes.set_ylabel(label)
        if row == 0:
            draw_scale_bar(axes, blocks)
        corner, opposite = look.enlarged
        axes.add_patch(Rectangle(style.MILLI * corner, *(style.MILLI * (opposite - corner)), fill=False,
                                 edgecolor=style.BLACK, linewidth=0.7))
        _draw_fractured(beside, panel, look)
        frame_box(beside, corner, opposite)
        for spine in beside.spines.values():
            spine.set_visible(True)
        beside.set_title(f"enlarged ×{factor:.2g}")
    _draw_legend(figure, grid, drawn, look)
    return figure


def _figure(drawn: Rows, lines: Sequence[tuple[str, Sequence[Panel]]], look: _Look, heights: Sequence[float],
            widths: Sequence[float]) -> tuple[Figure, GridSpec]:
    """Makes a figure with a heading, and a grid for panels of these heights, inches, and relative widths, with a row
    for the legend below. Panels are lower where the figure would be too high.
    """
    page = style.page()
    texts, legend = _text_heights(drawn, lines, look, heights)
    share = min(1.0, max(0.2, (page.highest - texts - legend) / sum(heights)))
    figure = style.new_figure(share * sum(heights) + texts + legend, dpi=2 * style.DPI)
    figure.suptitle(_heading(drawn, look), fontsize=page.size(9.0))
    return figure, figure.add_gridspec(len(heights) + 1, len(widths),
                                       height_ratios=[*(share * height for height in heights), legend],
                                       width_ratios=widths)


def _heading(drawn: Rows, look: _Look) -> str:
    return "\n".join(filter(None, [drawn.heading, f"displacements ×{look.magnification:g}"]))


def _text_heights(drawn: Rows, lines: Sequence[tuple[str, Sequence[Panel]]], look: _Look,
                  heights: Sequence[float]) -> tuple[float, float]:
    """Returns heights, inches, of titles, captions and heading, and of the legend."""
    larger = style.page().size(6.5) / 6.5
    captions = [(2 if style.page().is_column else 1) if look.enlarged else
                max(panel.caption.count("\n") + 1 for panel in panels) for _, panels in lines]
    handles, columns, note = _legend(drawn, look)
    legend = _LEGEND_LINE * larger * (-(-len(handles) // columns) + note.count("\n") + 1.5)
    texts = (_TITLE_HEIGHT * len(heights) + _CAPTION_LINE * larger * sum(captions)
             + _HEADING_LINE * (_heading(drawn, look).count("\n") + 1))
    return texts, legend


def _legend(drawn: Rows, look: _Look) -> tuple[list, int, str]:
    """Returns handles, in how many columns they stand, and what stands above them."""
    page = style.page()
    columns = max(2, page.fitting(1.6)) if page.is_column else 4
    return fracture_legend(drawn.panels[0].run), columns, _note(drawn, look)


def _draw_legend(figure: Figure, grid: GridSpec, drawn: Rows, look: _Look) -> None:
    handles, columns, note = _legend(drawn, look)
    below = figure.add_subplot(grid[-1, :])
    style.legend_alone(below, handles, [handle.get_label() for handle in handles], loc="center", ncol=columns,
                       title_fontsize=style.page().size(7.0), title=note)
    below.get_legend().set_in_layout(False)  # it is as wide as the page, and would make the panels narrower


def _note(drawn: Rows, look: _Look) -> str:
    widths = ""
    if all(panel.run.mesh.blocks.dimension == 2 for panel in drawn.panels) and look.full > 0.0:
        widths = ("A broken crack is the wider the more it has opened or slipped, up to "
                  f"{1e6 * look.full:.0f} µm. Broken in both modes: tension on shear.")
    letters = style.page().letters if style.page().is_column else _NOTE_LETTERS
    return "\n".join(line for text in (drawn.note, widths) if text for line in style.lines_of(text, letters))


def draw_specimen(axes: Axes, run: Results, frame: Frame) -> float:
    """Draws the deformed specimen with its cracks, alone in its axes; returns how far displacements are magnified."""
    magnification = _visible_magnification(run, frame)
    panel, view = Panel(run, frame, "", ""), view_of(run)
    margin = _margin([(run.mesh.blocks, _moved(panel, magnification))], view)
    _draw_fractured(axes, panel, _Look(magnification, margin, _full_width([panel]), 1, None, view))
    frame_section(axes, run.mesh.blocks, margin, view)
    draw_scale_bar(axes, run.mesh.blocks)
    return magnification


def fracture_legend(run: Results) -> list:
    """Returns handles of the cracks and materials that `fracture_panels` and `draw_specimen` draw."""
    return crack_legend(run) + material_legend(run.mesh.blocks, bearing="platen" if run.has_platens else "bearing")


def _moved(panel: Panel, magnification: float) -> np.ndarray:
    """Returns (N, 2), m: gridpoints where they are drawn."""
    points = panel.run.mesh.blocks.points
    return points + magnification * panel.run.gridpoint_displacement(panel.frame) if panel.frame else points


def _draw_panel(axes: Axes, panel: Panel, look: _Look) -> None:
    if panel.frame:
        _draw_fractured(axes, panel, look)
        is_narrow = style.page().is_column and style.page().width / look.across < _NARROWEST
        caption = _SYMBOL.sub("", panel.caption) if is_narrow else panel.caption
        axes.set_xlabel(caption, fontsize=style.page().size(6.5), linespacing=1.4)
    else:
        axes.text(0.5, 0.5, panel.caption, transform=axes.transAxes, ha="center", va="center",
                  fontsize=style.page().size(7.0), color="#6a6a6a")
    axes.set_title(panel.title, fontweight="bold")
    frame_section(axes, panel.run.mesh.blocks, look.margin, look.view)


def _margin(panels: Iterable[tuple[BlockMesh, np.ndarray]], view: View) -> np.ndarray:
    """Returns the box that holds all blocks where they are drawn, as far as _LARGEST_MARGIN allows.

    panels: blocks, and where their gridpoints are drawn, m.
    """
    margin = MARGIN
    for blocks, drawn in panels:
        low, high = block_box(blocks, view)
        places = flat(drawn, view)
        reach = np.array([low - places.min(axis=0), places.max(axis=0) - high]) / (high - low)[0]
        margin = np.maximum(margin, 0.2 * MARGIN + reach)
    margin = np.minimum(margin, _LARGEST_MARGIN)
    return np.maximum(margin, _OF_SCALE_BAR) if style.page().is_column else margin


def _visible_magnification(run: Results, frame: Frame) -> float:
    low, high = specimen_box(run.mesh.blocks)
    moved = np.percentile(np.linalg.norm(run.gridpoint_displacement(frame), axis=1), 95)
    fitting = [m for m in _MAGNIFICATIONS if m * moved <= _LARGEST_MOVE_DRAWN * (high - low)[1]]
    return fitting[-1] if fitting and moved > 0.0 else 1


def _jumps(run: Results, frame: Frame) -> np.ndarray:
    """Returns (C,), m: how far the sides of contact points have come apart or slipped, whichever is more."""
    opening, slip = (run.contact_field(frame, name) for name in ("opening [m]", "tangential_jump [m]"))
    return np.maximum(opening, np.abs(slip))


def _full_width(panels: Sequence[Panel]) -> float:
    """Returns the jump [m] from which a broken crack has full width: the median of the broken, to two digits."""
    sizes = [_jumps(panel.run, panel.frame)[cracked(panel.run, panel.frame, crack)] for panel in panels
             for crack in cracks_of(panel.run) if crack.broken]
    sizes = np.concatenate([np.zeros(0), *sizes])
    return float(f"{np.median(sizes):.1e}") if len(sizes) else 0.0


def _crack_box(lasts: Sequence[Panel], magnification: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Returns the corners [m] of a box around cracks of the last panels; None without, or where they are all over."""
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for panel in lasts:
        blocks, contacts = panel.run.mesh.blocks, panel.run.mesh.contacts
        if blocks.dimension != 2:
            return None
        which = np.zeros(len(contacts.cells), dtype=bool)
        for crack in cracks_of(panel.run):
            which |= cracked(panel.run, panel.frame, crack)
        if not which.any():
            return None
        points = contacts.points + magnification * panel.run.contact_displacement(panel.frame)
        places, before = (of[contacts.cells[which, 0]] for of in (points, contacts.points))
        box = specimen_box(blocks)
        if np.ptp(np.percentile(before[:, 0], (1, 99))) > _LOCAL * (box[1] - box[0])[0]:
            return None
        low = np.minimum(low, np.percentile(places, 1, axis=0))
        high = np.maximum(high, np.percentile(places, 99, axis=0))
    return low, high


def _enlarged(box: tuple[np.ndarray, np.ndarray], scale: float, room: tuple[float, float],
              look: _Look) -> tuple[float, _Look]:
    """Returns the largest round enlargement at which a box stands in a room, inches, and the look with what it shows.

    scale: inches on paper over metres of the body that is enlarged.
    """
    low, high = box
    size = 1.08 * (high - low)
    fitting = [f for f in _ENLARGEMENTS if (f * scale * size <= room).all()]
    factor = fitting[0] if fitting else float(np.min(np.array(room) / (scale * size)))
    middle, half = 0.5 * (low + high), 0.5 * np.array(room) / (factor * scale)
    return factor, replace(look, enlarged=(middle - half, middle + half))


def _draw_fractured(axes: Axes, panel: Panel, look: _Look) -> None:
    run, frame = panel.run, panel.frame
    blocks, contacts = blocks_at(run, frame), run.mesh.contacts
    draw_blocks(axes, blocks, _moved(panel, look.magnification), view=look.view)
    cells = (contacts.points + look.magnification * run.contact_displacement(frame))[contacts.cells]
    thinning = _thinning(blocks, contacts, look.across if style.page().is_column else max(look.across, _PANELS))
    in_plane = blocks.dimension == 2
    widths = np.ones(len(cells))
    if in_plane and look.full > 0.0:
        widths = _THINNEST + (1.0 - _THINNEST) * np.clip(_jumps(run, frame) / look.full, 0.0, 1.0)
    sheared = np.zeros(len(cells), dtype=bool)
    for crack in cracks_of(run):
        which = cracked(run, frame, crack)
        drawn = style.MILLI * flat(crack_lines(run.mesh, cells, which, look.view), look.view)
        of_lines = np.ones(len(drawn))
        if in_plane and crack.broken:
            of_lines = widths[which] * np.where(sheared[which], _BOTH, 1.0)
            sheared |= which & (crack.mode == "shear")
        axes.add_collection(LineCollection(drawn, colors=crack.colour, linewidths=thinning * crack.width * of_lines,
                                           capstyle="round", rasterized=True))
    if in_plane and blocks.bearing_materials and not style.page().has_covered:
        cover_by_bearings(axes, blocks, _moved(panel, look.magnification))


def _thinning(blocks: BlockMesh, contacts: ContactMesh, columns: int) -> float:
    """Returns the factor on line widths that keeps cracks apart where blocks are small in print."""
    low, high = panel_box(blocks)
    points_per_metre = 72.0 * style.page().width / columns / (high - low)[0]
    # the extent of a contact point is half of an edge, or the part of a face at a corner
    sizes = 2.0 * contacts.extent if blocks.dimension == 2 else 2.0 * np.sqrt(contacts.extent)
    edge = points_per_metre * np.median(sizes) if len(sizes) else np.inf
    return float(np.clip(edge / _EDGE_OF_FULL_WIDTH, _LEAST_THINNING, 1.0))
