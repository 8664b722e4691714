"""Water in the pores of a heated run: pressures at the probes, over the time and over the temperature, and amounts."""

from __future__ import annotations

from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from ..stored.heated import Heated
from ..stored.results import Results
from ..stored.run_facts import WATER
from . import style
from .progress import MINUTES_LABEL

STEAM = ((100, 0.0), (120, 0.0972), (140, 0.2602), (160, 0.5169), (180, 0.9015), (200, 1.4536), (220, 2.2183),
         (240, 3.2456), (260, 4.5910), (280, 6.3153), (300, 8.4866), (320, 11.183), (340, 14.500))
"""Pressure of saturated steam by temperature, MPa by °C (IAPWS-IF97), less 0.1013 MPa of the atmosphere."""


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


def _column(run: Results, of: str) -> str:
    return next(column.name for column in run.facts.of_role(WATER, of))
