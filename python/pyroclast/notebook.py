"""A run as a notebook shows it: its curve and its specimen as they stand."""

from __future__ import annotations

import base64
import html
import io
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from . import style
from .mesh import BlockMesh
from .records import abscissa, leading, records_in
from .sections import draw_blocks, frame_section

if TYPE_CHECKING:
    from .session import Run

_DPI = 110
_OPEN = 0.5  # damage from which a crack is drawn


@matplotlib.rc_context(style.STYLE)
def figure_of(run: Run) -> Figure:
    """Stress over strain, the first records of a body without platens, or temperature over time where nothing moves,
    beside the blocks and their open cracks.
    """
    figure = style.new_figure(3.6, dpi=_DPI)
    curve, section = figure.subplots(1, 2, width_ratios=[1.5, 1.0])
    _draw_curve(curve, run)
    _draw_section(section, run)
    figure.suptitle(style.plain(f"{run.title}: {run.outcome}"))
    return figure


def _draw_curve(axes: Axes, run: Run) -> None:
    history = run.history
    if "strain" in history:
        axes.plot(style.PER_MILLE * history["strain"], history["stress_MPa"], color=style.BLUE)
        axes.set_xlabel(style.STRAIN_LABEL)
        axes.set_ylabel(style.STRESS_LABEL)
    elif record := leading(records := records_in(tomllib.loads(run.deck_text), history)):
        _, over, label = abscissa(run, records)
        axes.plot(over, record.of(run), color=style.BLUE)
        axes.set_xlabel(label)
        axes.set_ylabel(record.title)
    else:
        axes.plot(history["heating_time_s"] / 60.0, history["temperature_degC"], color=style.BLUE)
        axes.set_xlabel("Heating time [min]")
        axes.set_ylabel("Mean temperature [°C]")


def _draw_section(axes: Axes, run: Run) -> None:
    material = run.block_material[run.zone_block]
    of_bearing = ~np.isin(run.zones[:, 0], run.sets["specimen"])
    blocks = BlockMesh(Path(run.title), run.position, run.zones, run.zone_block, material, tuple(run.material_names),
                       of_bearing)
    draw_blocks(axes, blocks, blocks.points)
    if run.moves:
        axes.add_collection(LineCollection(style.MILLI * _cracks(run), colors=style.VERMILLION, linewidths=0.9))
    frame_section(axes, blocks)


def _cracks(run: Run) -> np.ndarray:
    """(cracks, 2, 2), m: contact points whose law says that they are damaged by half or more, as lines to the middle of
    their face.
    """
    contacts = run.contacts()
    damage = contacts[[name for name in contacts if "damage" in name]].max(axis=1)
    ends = contacts[["x_m", "y_m"]]
    middles = ends.groupby(contacts["face"]).transform("mean")
    return np.stack([ends, middles], axis=1)[damage >= _OPEN]


def png_of(run: Run) -> bytes:
    """The figure as a PNG."""
    picture = io.BytesIO()
    with matplotlib.rc_context(style.STYLE):
        figure_of(run).savefig(picture, format="png")
    return picture.getvalue()


def html_of(run: Run) -> str:
    """The figure and what came of the run so far."""
    rows = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(_shown(value))}</td></tr>"
                   for name, value in run.results.items() if value is not None)
    picture = base64.b64encode(png_of(run)).decode()
    return f'<img src="data:image/png;base64,{picture}"><table>{rows}</table>'


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
