"""A run and its results as a notebook shows them: the curve, the specimen, and what came of each stage."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from ..errors import Error
from ..stored.columns import Columns
from ..stored.mesh import BlockMesh, ContactMesh, Mesh, cells_of_contacts
from ..stored.results import Results
from . import style
from .fields import draw_colour_bar
from .fractures import draw_specimen
from .heated_sections import draw_temperature
from .records import abscissa, leading, records_in
from .sections import draw_blocks, frame_section
from .solid_sections import crack_lines, flat

_DPI = 110
_OPEN = 0.5  # damage from which a crack is drawn


class RunOrResults(Protocol):
    """What runs and results have in common."""

    @property
    def title(self) -> str: ...
    @property
    def outcome(self) -> str: ...
    @property
    def history(self) -> Columns: ...
    @property
    def deck(self) -> Mapping[str, Any]: ...
    @property
    def stages(self) -> Sequence[Mapping[str, Any]]: ...


class LiveRun(RunOrResults, Protocol):
    """What `pyroclast.Run` shows of its body, as it stands."""

    @property
    def moves(self) -> bool: ...
    @property
    def position(self) -> np.ndarray: ...
    @property
    def zones(self) -> np.ndarray: ...
    @property
    def zone_block(self) -> np.ndarray: ...
    @property
    def block_material(self) -> np.ndarray: ...
    @property
    def material_names(self) -> Sequence[str]: ...
    @property
    def sets(self) -> Mapping[str, np.ndarray]: ...
    def contacts(self) -> Any: ...


OfRun = TypeVar("OfRun", bound=RunOrResults)


@matplotlib.rc_context(style.STYLE)
def figure_of(run: OfRun, draw_section: Callable[[Axes, OfRun], None]) -> Figure:
    """Draws stress over strain, the first records of a body without platens, or temperature over time where nothing
    moves, beside the section.
    """
    figure = style.new_figure(3.6, dpi=_DPI)
    curve, section = figure.subplots(1, 2, gridspec_kw={"width_ratios": [1.5, 1.0]})
    _draw_curve(curve, run)
    draw_section(section, run)
    figure.suptitle(style.plain(_headline(run)))
    return figure


def _headline(run: RunOrResults) -> str:
    return f"{run.title}: {run.outcome}"


def _draw_curve(axes: Axes, run: RunOrResults) -> None:
    history = run.history
    if "strain" in history.names:
        axes.plot(style.PER_MILLE * history["strain"], history["stress_MPa"], color=style.BLUE)
        axes.set_xlabel(style.STRAIN_LABEL)
        axes.set_ylabel(style.STRESS_LABEL)
    elif record := leading(records := records_in(run.deck, history.units)):
        _, over, label = abscissa(run, records)
        axes.plot(over, record.of(run), color=style.BLUE)
        axes.set_xlabel(label)
        axes.set_ylabel(record.title)
    else:
        axes.plot(history["heating_time_s"] / 60.0, history["temperature_degC"], color=style.BLUE)
        axes.set_xlabel("Heating time [min]")
        axes.set_ylabel("Mean temperature [°C]")


def draw_body(axes: Axes, run: LiveRun) -> None:
    """Draws the blocks of a run as it stands, and their open cracks."""
    material = run.block_material[run.zone_block]
    of_bearing = ~np.isin(run.zones[:, 0], run.sets["specimen"])
    blocks = BlockMesh(Path(run.title), run.position, run.zones, run.zone_block, material, tuple(run.material_names),
                       of_bearing)
    draw_blocks(axes, blocks, blocks.points)
    if run.moves:
        lines = flat(_cracks(run) if blocks.dimension == 2 else _cracks_of_solid(run, blocks))
        axes.add_collection(LineCollection(style.MILLI * lines, colors=style.VERMILLION, linewidths=0.9))
    frame_section(axes, blocks)


def draw_last_frame(axes: Axes, results: Results) -> None:
    """Draws the specimen at the last frame, if any, with its cracks, or where nothing moves its temperatures."""
    if not results.frames:
        axes.axis("off")
    elif results.moves:
        magnification = draw_specimen(axes, results, results.frames[-1])
        axes.set_title(f"displacements ×{magnification:g}", fontsize=8.0)
    else:
        colours = draw_temperature(axes, results, results.frames[-1])
        draw_colour_bar([axes], colours)


def _cracks(run: LiveRun) -> np.ndarray:
    """Returns (cracks, 2, 2), m: contact points whose law says that they are damaged by half or more, as lines to the
    middle of their face.
    """
    contacts = run.contacts()
    damage = contacts[[name for name in contacts if "damage" in name]].max(axis=1)
    ends = contacts[["x_m", "y_m"]]
    middles = ends.groupby(contacts["face"]).transform("mean")
    return np.stack([ends, middles], axis=1)[damage >= _OPEN]


def _cracks_of_solid(run: LiveRun, blocks: BlockMesh) -> np.ndarray:
    """Returns (lines, 2, 3), m: where damaged contact points show on a solid that is cut open."""
    contacts = run.contacts()
    damage = contacts[[name for name in contacts if "damage" in name]].max(axis=1).to_numpy()
    cells = cells_of_contacts(contacts[["x_m", "y_m", "z_m"]].to_numpy(), contacts["face"].to_numpy())
    mesh = Mesh(blocks, ContactMesh(cells.reshape(-1, 3), np.arange(4 * len(cells)).reshape(-1, 4),
                                    np.zeros(len(cells), int), ("",), contacts["area_m2"].to_numpy()))
    return crack_lines(mesh, cells, damage >= _OPEN)


def png_of(run: OfRun, draw_section: Callable[[Axes, OfRun], None]) -> bytes:
    """Returns the figure as a PNG."""
    return style.png(figure_of(run, draw_section))


def html_of(run: OfRun, draw_section: Callable[[Axes, OfRun], None]) -> str:
    """Returns the figure, and what came of each stage so far; what cannot be read is told in its place."""
    try:
        headline = html.escape(_headline(run), quote=True)
        rows = "".join(_rows(number, stage) for number, stage in enumerate(run.stages))
    except Error as error:
        return f"<p>{html.escape(str(error))}</p>"
    try:
        picture = base64.b64encode(png_of(run, draw_section)).decode()
        shown = f'<img alt="{headline}" src="data:image/png;base64,{picture}">'
    except Error as error:
        shown = f"<p>{headline}</p><p>{html.escape(str(error))}</p>"
    return f"{shown}<table>{rows}</table>"


def _rows(number: int, stage: Mapping[str, Any]) -> str:
    """Returns rows of a table: the stage and how it ended, then its results."""
    told = f"stage {number} ({stage.get('kind', '')}): {stage.get('outcome', '')}"
    return f'<tr><th colspan="2">{html.escape(told)}</th></tr>' + "".join(
        f"<tr><td>{html.escape(name)}</td><td>{html.escape(_shown(value))}</td></tr>"
        for name, value in stage.get("results", {}).items() if value is not None)


def _shown(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
