"""Water in the pores of a heated run: pressures at the probes, over the time and over the temperature; amounts; and
pressures and saturation over the depth."""

from __future__ import annotations

from itertools import cycle

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from ..stored.files import read_array
from ..stored.frames import Frame
from ..stored.heated import Heated
from ..stored.mesh import specimen_box
from ..stored.results import Results
from ..stored.run_facts import WATER
from ..stored.spalled import blocks_at
from . import style
from .progress import MINUTES_LABEL

STEAM = ((100, 0.0), (120, 0.0972), (140, 0.2602), (160, 0.5169), (180, 0.9015), (200, 1.4536), (220, 2.2183),
         (240, 3.2456), (260, 4.5910), (280, 6.3153), (300, 8.4866), (320, 11.183), (340, 14.500))
"""Pressure of saturated steam by temperature, MPa by °C (IAPWS-IF97), less 0.1013 MPa of the atmosphere."""
_CURVES = 8
_SLABS = 50
_AXES = {"left": (0, False), "right": (0, True), "bottom": (1, False), "top": (1, True), "front": (2, False),
         "back": (2, True)}
"""Axis of each face of the specimen, and whether it is the upper one."""


@style.in_style
def water(run: Results) -> Figure:
    """Draws pore pressures at the probes over the time, and over the temperature beside that of saturated steam; and
    the water in the pores, with what hydrates gave back and what left."""
    minutes = run.history["heating_time_s"] / 60.0
    figure, (over_time, amounts, over_temperature), beside = style.panels(7.2, rows=(1.2, 0.8, 1.2), beside=0.3)
    style.number(figure, [over_time, amounts, over_temperature])
    over_time.set_title(style.title_of(run))
    over_time.plot(minutes, run.history[_column(run, "largest_pressure")], color=style.FAINT,
                   label="largest of all blocks")
    temperatures = run.probes
    highest = 1.0
    for (name, pressure), (colour, dashes) in zip(Heated(run).probe_pressures.items(), cycle(style.LOOKS)):
        over_time.plot(minutes, pressure, color=colour, linestyle=dashes, linewidth=1.0, label=f"probe {name}")
        over_temperature.plot(temperatures[name], pressure, color=colour, linestyle=dashes, linewidth=1.0)
        highest = max(highest, float(np.nanmax(pressure)))
    hot, steam = np.transpose(STEAM)
    over_temperature.plot(hot, steam, color=style.BLACK, linewidth=0.8)
    over_temperature.text(0.02, 0.95, "line: saturated steam", transform=over_temperature.transAxes, va="top")
    over_temperature.set(ylim=(0.0, 1.2 * highest), xlabel="Temperature [°C]", ylabel="Pore pressure [MPa]")
    for of, label, colour in (("held", "in the pores", style.BLUE), ("left", "left", style.VERMILLION),
                              ("released", "given back by hydrates", style.GREEN)):
        amounts.plot(minutes, run.history[_column(run, of)], color=colour, label=label)
    amounts.legend(loc="best")
    amounts.set(ylabel="Water [kg]", xlabel=MINUTES_LABEL)
    for axes in (over_time, amounts):
        axes.set_xlim(left=0.0)
        axes.set_ylim(bottom=0.0)
    over_time.set(ylabel="Pore pressure [MPa]", xlabel=MINUTES_LABEL)
    style.draw_legend(beside, over_time, loc="upper left")
    return figure


@style.in_style
def water_profile(run: Results) -> Figure:
    """Draws pore pressure and saturation over the depth below the heated face, as means over slabs of the specimen, at
    up to eight frames, evenly over the run, the last among them."""
    last_at = {frame.minutes or 0.0: frame for frame in run.frames}  # before heat flows all are alike
    frames = list(last_at.values())
    chosen = sorted({int(round(i)) for i in np.linspace(0, len(frames) - 1, _CURVES)})
    face = str(run.summary.get("heated_face", "left"))
    figure, panels, beside = style.panels(5.6, rows=(1.0, 0.8), beside=0.2)
    style.number(figure, panels)
    panels[0].set_title(style.title_of(run))
    shades = ScalarMappable(cmap="inferno").cmap
    for number, i in enumerate(chosen):
        for axes, (name, factor) in zip(panels, (("pore_pressure [Pa]", 1e-6), ("saturation [1]", 1.0))):
            depth, mean = _means_over_depth(run, frames[i], name, face)
            axes.plot(style.MILLI * depth, factor * mean, color=shades(0.85 * number / max(len(chosen) - 1, 1)),
                      label=f"{frames[i].minutes or 0.0:.3g} min")
            axes.set_xlim(0.0, style.MILLI * (depth[0] + depth[-1]))
    for axes in panels:
        axes.set_ylim(bottom=0.0)
    panels[0].set_ylabel("Pore pressure [MPa]")
    panels[1].set(ylabel="Saturation", xlabel=f"Depth below the {face} face [mm]")
    style.draw_legend(beside, panels[0], loc="upper left")
    return figure


def of_zones(run: Results, frame: Frame, name: str) -> np.ndarray:
    """Returns a field (Z,) of zones, by its name with unit."""
    return read_array(run.folder / "fields" / f"blocks_{frame.number:04d}.hdf", f"VTKHDF/CellData/{name}",
                      (len(run.mesh.blocks.zones),))


def _means_over_depth(run: Results, frame: Frame, name: str, face: str) -> tuple[np.ndarray, np.ndarray]:
    """Returns the middles (n,) of slabs below a face, m, and the mean of a field of zones in each, NaN in none."""
    blocks = run.mesh.blocks
    values = of_zones(run, frame, name)
    axis, is_upper = _AXES[face]
    low, high = specimen_box(blocks)
    place = blocks.points[blocks.zones, axis].mean(axis=1)
    depth = high[axis] - place if is_upper else place - low[axis]
    inner = ~blocks.of_bearing & np.isin(blocks.block, blocks_at(run, frame).block)
    edges = np.linspace(0.0, high[axis] - low[axis], _SLABS + 1)
    weight, of_slab = (np.histogram(depth[inner], edges, weights=weights)[0]
                       for weights in (blocks.sizes[inner], (blocks.sizes * values)[inner]))
    with np.errstate(invalid="ignore"):
        return 0.5 * (edges[1:] + edges[:-1]), of_slab / weight


def _column(run: Results, of: str) -> str:
    return next(column.name for column in run.facts.of_role(WATER, of))
