"""Pieces that left the heated face of a specimen: depths and temperatures over the time, and the face that is left."""

from __future__ import annotations

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from ..stored.files import Table
from ..stored.mesh import specimen_box
from ..stored.results import Results
from ..stored.run_facts import BAR, BAR_UNSPALLED, SPALLING
from . import style
from .progress import MINUTES_LABEL

_TIMES = 6
_PLACES = 200
_ALONG = {"left": 1, "right": 1, "bottom": 0, "top": 0, "front": 0, "back": 0}
"""Axis along which each face is looked at."""


@style.in_style
def spalling(run: Results) -> Figure:
    """Draws the depth that pieces took off a heated face over the time, in the mean and at most; the temperature at the
    depths of bars, where the deck states some; and how deep the face stands along itself at up to six times."""
    minutes = run.history["heating_time_s"] / 60.0
    bars = run.facts.of_role(BAR)
    rows = (1.0, 0.9, 1.2) if bars else (1.0, 1.2)
    figure, panels, beside = style.panels(7.2 if bars else 5.4, rows=rows, beside=0.25)
    style.number(figure, panels)
    depths, profile = panels[0], panels[-1]
    depths.set_title(style.title_of(run))
    for of, label, colour in (("largest_depth", "at most", style.VERMILLION),
                              ("mean_depth", "in the mean", style.BLUE)):
        column = next(column.name for column in run.facts.of_role(SPALLING, of))
        depths.plot(minutes, style.MILLI * run.history[column], color=colour, label=label)
    depths.legend(loc="upper left")
    depths.set(ylabel="Depth lost [mm]", xlabel=MINUTES_LABEL, xlim=(0.0, float(np.nanmax(minutes))))
    depths.set_ylim(bottom=0.0)
    for bar, unspalled, (colour, dashes) in zip(bars, run.facts.of_role(BAR_UNSPALLED), style.LOOKS):
        panels[1].plot(minutes, run.history[bar.name], color=colour, linestyle=dashes, label=bar.of)
        panels[1].plot(minutes, run.history[unspalled.name], color=colour, linestyle=dashes, linewidth=0.7,
                       label="thin: no piece gone" if bar is bars[-1] else None)
    if bars:
        panels[1].legend(title="depth", loc="upper left")
        panels[1].set(ylabel="Temperature [°C]", xlabel=MINUTES_LABEL, xlim=depths.get_xlim())
    _draw_faces(profile, run)
    style.draw_legend(beside, profile, loc="upper left")
    return figure


def _draw_faces(axes: style.Axes, run: Results) -> None:
    face = str(run.summary.get("heated_face", "left"))
    axis = _ALONG[face]
    low, high = (corner[axis] for corner in specimen_box(run.mesh.blocks))
    places = np.linspace(low, high, _PLACES)
    lost = np.zeros(_PLACES)
    pieces, blocks = (Table(run.folder / name, may_be_empty=True) for name in ("spalls.csv", "spalled_blocks.csv"))
    times = pieces["heating_time_s"] if pieces.rows else np.zeros(0)
    shown = {int(i) for i in np.linspace(0, len(times) - 1, min(_TIMES, len(times)))}
    shades = ScalarMappable(cmap="inferno").cmap
    mesh = run.mesh.blocks
    for i, time in enumerate(times):
        for row in np.flatnonzero(blocks["piece"] == i + 1):
            corners = mesh.points[np.unique(mesh.zones[mesh.block == blocks["block"][row]]), axis]
            beside = (places >= corners.min()) & (places <= corners.max())
            lost[beside] = np.maximum(lost[beside], blocks["largest_depth_m"][row])
        if i in shown:
            axes.plot(style.MILLI * (places - low), style.MILLI * lost, color=shades(0.85 * i / max(len(times) - 1, 1)),
                      label=f"{time / 60.0:.3g} min")
    if not len(times):
        axes.text(0.5, 0.5, "no piece left", transform=axes.transAxes, ha="center")
    axes.set(xlabel=f"Along the {face} face [mm]", ylabel="Depth lost [mm]", xlim=(0.0, style.MILLI * (high - low)))
    axes.set_ylim(max(1.1 * style.MILLI * float(lost.max()), 1.0), 0.0)
