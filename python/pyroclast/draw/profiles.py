"""Temperatures over the depth below the heated face, and how deep an isotherm has come, of runs that conduct heat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from ..errors import Error
from ..stored.files import Table
from ..stored.results import Results
from . import style

ISOTHERM = 500.0
"""°C, below which the reduced cross-section of EN 1992-1-2 takes concrete as whole."""
_CURVES = 8


@dataclass(frozen=True)
class Profile:
    """Temperatures on the line that crosses the specimen midway, from the heated face to the one across."""

    face: str  #: "left", "right", "bottom", "top", "front" or "back"; "heated" of a run without a summary
    depth: np.ndarray  #: (n,) below that face, m
    time: np.ndarray  #: (k,) of heating, s
    temperature: np.ndarray  #: (k, n) °C
    isotherm_time: np.ndarray  #: (m,) of heating, s, while the face is at ISOTHERM or hotter; none where it never is
    isotherm: np.ndarray  #: (m,) depth to which all of the line is at ISOTHERM or hotter, m

    def at(self, depth: float) -> np.ndarray:
        """Returns (k,) °C at a depth [m], linear between the points."""
        return np.array([np.interp(depth, self.depth, temperature) for temperature in self.temperature])


def read_profile(run: Results) -> Profile | None:
    """Reads temperature_profile.csv and isotherm.csv of a run; None where it has none. Raises Error where the first is
    no table of as many points for each time.
    """
    path = run.folder / "temperature_profile.csv"
    if not path.exists():
        return None
    table = Table(path, may_be_empty=True)
    if not table.rows:
        return None
    points = max(1, int((table["heating_time_s"] == table["heating_time_s"][0]).sum()))
    whole = table.rows // points * points  # a run that was killed may have written a part of the last time
    time, depth, temperature = (table[name][:whole].reshape(-1, points) for name in
                                ("heating_time_s", "depth_m", "temperature_degC"))
    if (depth != depth[0]).any():
        raise Error(f"{path}: is no table of the same {points} depths for each time")
    isotherm = Table(run.folder / "isotherm.csv", may_be_empty=True)
    return Profile(str(run.summary.get("heated_face", "heated")), depth[0], time[:, 0], temperature,
                   isotherm["heating_time_s"], isotherm[f"depth_{ISOTHERM:.0f}_degC_m"])


@style.in_style
def temperature_profile(run: Results, profile: Profile) -> Figure:
    """Draws the temperature over the depth at up to eight times, evenly over the run, the last among them."""
    figure, (axes,), beside = style.panels(3.8, beside=0.2)
    axes.set_title(style.title_of(run))
    chosen = sorted({int(np.abs(profile.time - time).argmin())
                     for time in np.linspace(profile.time[0], profile.time[-1], _CURVES)})
    shades = ScalarMappable(cmap="inferno").cmap
    times = profile.time[chosen] / 60.0
    digits = next((n for n in range(3) if len({f"{time:.{n}f}" for time in times}) == len(times)), 3)
    for number, i in enumerate(chosen):
        colour = shades(0.85 * number / max(len(chosen) - 1, 1))
        axes.plot(style.MILLI * profile.depth, profile.temperature[i], color=colour,
                  label=f"{times[number]:.{digits}f} min")
    axes.set_xlim(0.0, style.MILLI * profile.depth[-1])
    axes.set_xlabel(f"Depth below the {profile.face} face, midway [mm]")
    axes.set_ylabel("Temperature [°C]")
    style.draw_legend(beside, axes, loc="upper left")
    return figure


@style.in_style
def isotherm(run: Results, profile: Profile) -> Figure:
    """Draws how deep the isotherm of ISOTHERM has come, over the time."""
    figure, (axes,), _ = style.panels(3.2)
    axes.set_title(style.title_of(run))
    axes.plot(profile.isotherm_time / 60.0, style.MILLI * profile.isotherm, color=style.VERMILLION)
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("Time of heating [min]")
    axes.set_ylabel(f"Depth of the {ISOTHERM:.0f} °C isotherm\nbelow the {profile.face} face [mm]")
    return figure
