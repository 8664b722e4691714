"""Temperatures over the depth below the heated face, and how deep an isotherm has come, of runs that conduct heat."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from . import style
from .errors import Error
from .mesh import BlockMesh, specimen_box
from .writing import whole

if TYPE_CHECKING:
    from .results import Results

ISOTHERM = 500.0
"""°C, below which the reduced cross-section of EN 1992-1-2 takes concrete as whole."""
_POINTS = 121
_CURVES = 8
_FACES = {0: ("left", "right"), 1: ("lower", "upper")}  # by the axis across them


@dataclass(frozen=True)
class Profile:
    """Temperatures on the line that crosses the specimen midway, from the heated face to the one across."""

    face: str  #: "left", "right", "lower" or "upper", the hottest at the end along the line that differs most
    depth: np.ndarray  #: (n,) below that face, m
    time: np.ndarray  #: (k,) of heating, s, of each frame
    temperature: np.ndarray  #: (k, n) °C

    @property
    def isotherm(self) -> np.ndarray:
        """(k,) depth [m] to which all of the line is at ISOTHERM or hotter, linear between its points; 0: none is."""
        return np.array([_depth(self.depth, values) for values in self.temperature])


def _depth(depth: np.ndarray, temperature: np.ndarray) -> float:
    cooler = np.flatnonzero(temperature < ISOTHERM)
    if not len(cooler):
        return float(depth[-1])
    first = int(cooler[0])
    if first == 0:
        return 0.0
    share = (temperature[first - 1] - ISOTHERM) / (temperature[first - 1] - temperature[first])
    return float(depth[first - 1] + share * (depth[first] - depth[first - 1]))


def read_profile(run: Results) -> Profile:
    """Of all frames of the heating. Raises Error when a frame has no temperatures."""
    blocks = run.mesh.blocks
    low, high = specimen_box(blocks)
    frames = [frame for frame in run.heated_frames
              if frame.heating_time is not None and np.isfinite(frame.heating_time)]
    if not frames:
        raise Error(f"{run.folder / 'fields' / 'frames.csv'}: no frame of a heating stage has a time")
    fields = [run.gridpoint_temperature(frame) for frame in frames]
    lines = {}
    for axis in (0, 1):
        points = np.tile(0.5 * (low + high), (_POINTS, 1))
        points[:, axis] = np.linspace(low[axis], high[axis], _POINTS)
        corners, weights = _places(blocks, points)
        lines[axis] = np.array([(field[corners] * weights).sum(axis=1) for field in fields])
    axis = max(lines, key=lambda one: np.ptp(lines[one][-1]))
    temperature, depth = lines[axis], np.linspace(0.0, (high - low)[axis], _POINTS)
    far = bool(temperature[-1, -1] > temperature[-1, 0])
    return Profile(_FACES[axis][far], depth, np.array([frame.heating_time for frame in frames]),
                   temperature[:, ::-1] if far else temperature)


def _places(blocks: BlockMesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each point the gridpoints (n, 3) of the specimen's zone that holds it, or is nearest to holding it, and their
    weights (n, 3), which add up to 1."""
    zones = blocks.zones[~blocks.of_bearing]
    a, b, c = (blocks.points[zones[:, i]] for i in range(3))
    area = _cross(b - a, c - a)
    area = np.where(area > 0.0, area, np.inf)  # a zone without area holds nothing
    corners, weights = [], []
    for point in points:
        shares = np.column_stack([_cross(c - b, point - b), _cross(a - c, point - c), _cross(b - a, point - a)])
        shares /= area[:, None]
        shares[~np.isfinite(area)] = -np.inf
        best = int(shares.min(axis=1).argmax())
        corners.append(zones[best])
        weights.append(np.clip(shares[best], 0.0, 1.0) / np.clip(shares[best], 0.0, 1.0).sum())
    return np.array(corners), np.array(weights)


def _cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def write_profile(profile: Profile, folder: Path) -> None:
    """temperature_profile.csv and isotherm.csv, in SI units and °C."""
    _write(folder / "temperature_profile.csv", ("heating_time_s", "depth_m", "temperature_degC"),
           [(time, depth, value) for time, values in zip(profile.time, profile.temperature)
            for depth, value in zip(profile.depth, values)])
    _write(folder / "isotherm.csv", ("heating_time_s", f"depth_{ISOTHERM:.0f}_degC_m"),
           list(zip(profile.time, profile.isotherm)))


def _write(path: Path, header: tuple[str, ...], rows: list[tuple[float, ...]]) -> None:
    with whole(path) as aside, open(aside, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([f"{value:.9g}" for value in row] for row in rows)


@style.in_style
def temperature_profile(run: Results, profile: Profile) -> Figure:
    """Temperature over the depth at up to eight times, evenly among the frames, the last among them."""
    figure, (axes,), beside = style.panels(3.8, beside=0.2)
    axes.set_title(style.title_of(run))
    chosen = sorted({round(i) for i in np.linspace(0, len(profile.time) - 1, min(_CURVES, len(profile.time)))})
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
    """How deep the isotherm of ISOTHERM has come, over the time."""
    figure, (axes,), _ = style.panels(3.2)
    axes.set_title(style.title_of(run))
    axes.plot(profile.time / 60.0, style.MILLI * profile.isotherm, "o-", color=style.VERMILLION, markersize=3.0)
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("Time of heating [min]")
    axes.set_ylabel(f"Depth of the {ISOTHERM:.0f} °C isotherm\nbelow the {profile.face} face [mm]")
    return figure
