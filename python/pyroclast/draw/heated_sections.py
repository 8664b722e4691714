"""Pictures of the heated section: fracture at chosen temperatures, and the temperature field."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from ..errors import Error
from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.mesh import BlockMesh
from ..stored.results import Results
from ..stored.spalled import blocks_at
from . import style
from .fields import colours_of, draw_colour_bar, draw_field
from .fractures import Panel, Rows, broken_share
from .sections import draw_scale_bar, frame_section, height_over_width
from .solid_sections import View, draw_temperature_cut_open, view_of

TEMPERATURES = (300.0, 400.0, 500.0, 600.0, 800.0)
"""°C, near which fracture is drawn unless others are asked for."""
LEVEL_TEMPERATURES = (300.0, 400.0, 500.0, 600.0)
"""°C, the columns of `levels` unless others are asked for, before the last frame."""

_NEAR = 25.0  # K: a frame stands for a temperature that is not farther from its own
_NOTE = "Broken: share of the length, in space of the area, of all contacts that can break."
_MOST_PANELS = 5
_FIELDS = 4
_NARROWEST, _LEAST_WIDTH = 1.5, 0.85  # inches, of a panel in a column: as it stands well, and at least


def frame_near(frames: Sequence[Frame], temperature: float) -> Frame | None:
    """Returns the frame nearest to a temperature [°C] on the way up to the hottest; None when none is within 25 K.

    frames: heated ones, in order, at least one.
    """
    hottest = max(range(len(frames)), key=lambda i: frames[i].temperature)
    nearest = min(frames[:hottest + 1], key=lambda frame: abs(frame.temperature - temperature))
    return nearest if abs(nearest.temperature - temperature) <= _NEAR else None


def select_heated_frames(frames: Sequence[Frame], failed: bool) -> list[Frame]:
    """Selects at most five frames: those nearest to TEMPERATURES, the last, and, if the run failed, the one before.

    When these are too many, the coolest go.
    frames: heated ones, in order, at least one.
    """
    last = frames[-1]
    before = [frame for frame in frames if frame.step < last.step]
    ends = [*before[-1:], last] if failed else [last]
    choice = before if failed and before else [*before, last]
    near = [frame_near(choice, temperature) for temperature in TEMPERATURES]
    selected = {frame.step: frame for frame in [*near, *ends] if frame}
    return [selected[step] for step in sorted(selected)][-_MOST_PANELS:]


def heating_fracture(run: Results, temperatures: Sequence[float] | None = None) -> Rows:
    """Takes the deformed specimen with its cracks while heated (paper, Figures 13 to 16).

    temperatures [°C]: the frames nearest to them are drawn, and Error is raised when none is within 25 K;
    when None, as `select_heated_frames` has it.
    """
    hot = Heated(run)
    frames = hot.frames
    if temperatures is None:
        failed = hot.critical_temperature is not None
        selected = select_heated_frames(frames, failed) if hot.uniform else spread_frames(frames)
    else:
        selected = [_frame_asked_for(run, frames, temperature) for temperature in temperatures]
    panels = [_panel(run, frame) for frame in selected]
    return Rows([("", panels)], style.title_of(run), _NOTE)


def _frame_asked_for(run: Results, frames: Sequence[Frame], temperature: float) -> Frame:
    frame = frame_near(frames, temperature)
    if frame is None:
        reach = [frame.temperature for frame in frames]
        path = run.folder / "fields" / "frames.csv"
        raise Error(f"{path}: no frame within {_NEAR:g} K of {temperature:g} °C; "
                       f"frames of the heating are from {min(reach):.0f} to {max(reach):.0f} °C")
    return frame


def levels(runs: Sequence[Results], temperatures: Sequence[float] = LEVEL_TEMPERATURES) -> Rows:
    """Takes fracture patterns, a row for each run, lowest load first; columns are temperatures and the last frame.

    temperatures: °C; a panel stays empty where a run has no frame within 25 K.
    """
    if not runs:
        raise Error("levels: no runs were given")
    ordered = sorted(runs, key=lambda run: (Heated(run).load_level is None, Heated(run).load_level or 0.0))
    rows = [(label, _row(run, temperatures)) for run, label in zip(ordered, _row_labels(ordered))]
    return Rows(rows, "", _NOTE)


def _row_labels(runs: Sequence[Results]) -> list[str]:
    """Returns the load, with the folder where loads do not tell the runs apart, and then warnings."""
    loads = [style.load_label(run) for run in runs]
    labels = []
    for run, load in zip(runs, loads):
        told_apart = load and loads.count(load) == 1
        name = load if told_apart else ", ".join(filter(None, [load, run.folder.resolve().name]))
        labels.append("\n".join([name, *style.warnings_of(run)]))
    return labels


def _row(run: Results, temperatures: Sequence[float]) -> list[Panel]:
    hot = Heated(run)
    frames, failed = hot.frames, hot.critical_temperature is not None
    choice = frames[:-1] if failed else frames
    return [*(_panel_near(run, choice, temperature) for temperature in temperatures), _panel(run, frames[-1])]


def _panel_near(run: Results, frames: Sequence[Frame], temperature: float) -> Panel:
    hot = Heated(run)
    if frames and (frame := frame_near(frames, temperature)):
        return _panel(run, frame)
    missing = f"no frame within\n{_NEAR:g} K"
    if run.history.known("temperature_degC", hot.standing).max() < temperature - _NEAR:
        missing = "not reached" if hot.critical_temperature is None else "failed before"
    return Panel(run, None, f"{temperature:g} °C", missing)


def _panel(run: Results, frame: Frame) -> Panel:
    hot = Heated(run)
    last = frame.step == hot.frames[-1].step
    title, mean = f"{frame.temperature:.0f} °C", ""
    if not hot.uniform and frame.minutes is not None:
        title, mean = f"{frame.minutes:.0f} min", f"mean {title}\n"
    if last and hot.critical_temperature is not None:
        title = f"failed, {title}"
    elif last:
        title = f"end, {title}"
    stress = f"$\\sigma$ = {frame.stress:.1f} MPa\n" if hot.restrained else ""
    strain = "" if mean and stress else (f"$\\varepsilon_{{\\mathrm{{tot}}}} = "
                                         f"{style.PER_MILLE * hot.total_strain_at(frame):.2f}\\times 10^{{-3}}$\n")
    return Panel(run, frame, title, f"{mean}{strain}{stress}broken {100.0 * broken_share(run, frame):.2g} %")


@style.in_style
def temperature_field(run: Results) -> Figure:
    """Draws temperatures of the specimen at up to four times while heated, one scale for all, with isotherms."""
    blocks, page = run.mesh.blocks, style.page()
    frames = page.chosen(spread_frames(Heated(run).frames))
    fields = [run.gridpoint_temperature(frame) for frame in frames]
    parts = [blocks_at(run, frame) for frame in frames]
    within = [field[np.unique(part.zones[~part.of_bearing])] for part, field in zip(parts, fields)]
    colours = colours_of(within)
    across = min(page.fitting(_NARROWEST) if page.is_column else _FIELDS, len(frames))
    view = view_of(run)
    ratio = height_over_width(blocks, view=view)
    while page.is_column and across < len(frames) and page.width / (across + 1) >= _LEAST_WIDTH and \
            -(-len(frames) // across) * (page.width / (across + 0.4) * ratio + 0.75) + 0.6 > page.highest:
        across += 1
    lines = -(-len(frames) // across)
    panel_height = (page.width / (across + 0.4) - 0.12) * ratio
    figure = style.new_figure(lines * (panel_height + 0.75) + 0.35)
    all_axes = figure.subplots(lines, across, squeeze=False).ravel()
    for axes in all_axes[len(frames):]:
        axes.axis("off")
    for axes, frame, part, field, values in zip(all_axes, frames, parts, fields, within):
        _draw_temperature(axes, part, field, colours, view)
        mean = f"mean {frame.temperature:.0f} °C"
        axes.set_title(mean if frame.minutes is None else f"{frame.minutes:.0f} min", fontweight="bold")
        axes.set_xlabel(("" if frame.minutes is None else f"{mean}\n") + f"{values.min():.0f} to {values.max():.0f} °C",
                        fontsize=page.size(7.0), linespacing=1.4)
    draw_scale_bar(all_axes[0], blocks)
    draw_colour_bar(all_axes, colours, 0.02)
    figure.suptitle(style.title_of(run), fontsize=page.size(9.0))
    return figure


def draw_temperature(axes: Axes, run: Results, frame: Frame) -> ScalarMappable:
    """Draws the specimen's temperature, alone in its axes, coloured up to its hottest; returns what has the colours."""
    blocks = blocks_at(run, frame)
    field = run.gridpoint_temperature(frame)
    within = field[np.unique(blocks.zones[~blocks.of_bearing])]
    colours = colours_of([within])
    _draw_temperature(axes, blocks, field, colours, view_of(run))
    draw_scale_bar(axes, blocks)
    return colours


def spread_frames(frames: Sequence[Frame]) -> list[Frame]:
    """Chooses up to four of the frames, evenly among those of different temperature, the last among them."""
    different = [frame for before, frame in zip([None, *frames], frames)
                 if before is None or frame.temperature != before.temperature]
    steps = np.linspace(0, len(different) - 1, min(_FIELDS + 1, len(different)))[-_FIELDS:]
    return [different[round(step)] for step in steps]


def _draw_temperature(axes: Axes, blocks: BlockMesh, field: np.ndarray, colours: ScalarMappable, view: View) -> None:
    if blocks.dimension == 3:
        draw_temperature_cut_open(axes, blocks, field, colours, view)
    else:
        outlines, material = blocks.outlines
        of_bearing = np.isin(material, blocks.bearing_materials)
        bearings = [style.MILLI * blocks.points[outline] for outline, is_one in zip(outlines, of_bearing) if is_one]
        axes.add_collection(PolyCollection(bearings, color=style.PLATEN_COLOUR, linewidths=0.3, rasterized=True))
        draw_field(axes, colours, blocks.points, blocks.zones[~blocks.of_bearing], field, blocks.points)
    frame_section(axes, blocks, view=view)
