"""Curves of one heated run: total strain beside the references, thrust of a restrained one, convergence;
temperatures over time where heat is conducted alone."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from ..stored import reference
from ..stored.heated import Heated
from ..stored.results import Results
from . import style
from .curves import draw_tables
from .profiles import Profile
from .progress import MINUTES_LABEL, heating_course, heating_minutes, temperature_label
from .records import records_of

TOTAL_STRAIN_LABEL = "Total axial strain, expansion\npositive, load included [$10^{-3}$]"
DEPTHS = (0.010, 0.020, 0.030, 0.050)
"""m below the heated face, at which temperatures are drawn over the time."""
GAS = "gas_max_degC"
"""Column of the temperature of the hottest gas, where the deck has one."""
_FALLING = 8.0  # times the usual change of strain from row to row: the specimen fails
_TOLD = 0.01  # of the range of a curve, within which another tells the same
THRUST_LABEL = "Axial stress, compression\npositive [MPa]"
_BAND_LABEL = ("range of models calibrated on Anderberg &\nThelandersson's tests, not measured points;\n"
               f"dashed: its centre; pale above {reference.TRUSTED_TO:g} °C: order only")


@style.in_style
def total_strain(run: Results) -> Figure:
    """Draws the total and lateral strain over temperature; the reference's range where it has the run's load level."""
    hot = Heated(run)
    figure, over, upper, lower, below = _two_while_heated(run)
    strain = style.PER_MILLE * hot.total_strain
    band = None
    if not hot.timed and reference.TRANSIENT_STRAIN in run.references.builtin:
        band = reference.strain_band(hot.load_level)
    if band:
        draw_band(upper, band, style.ORANGE,
                  style.page().said(_BAND_LABEL, "models calibrated on Anderberg & Thelandersson"))
    _draw_heated_parent(upper, run, "specimen_strain", -style.PER_MILLE)
    draw_tables(upper, [run], over_minutes(hot.timed), ("total_strain", style.PER_MILLE))
    label = f"this run, {style.load_label(run)}".rstrip(", ")
    upper.plot(over, strain, color=style.BLUE, linewidth=1.8, label=label)
    upper.axhline(0.0, color=style.BLACK, linewidth=0.6)
    shown = [run, run.parent] if run.parent and Heated(run.parent).rows.any() else [run]
    upper.set_ylim(*strain_limits(shown, [band] if band else []))
    mark_leaving(upper, over, strain, style.BLUE)
    upper.set_ylabel(TOTAL_STRAIN_LABEL)
    _mark_unconverged(upper, run, over, strain)
    _mark_failure(upper, run, over)
    style.draw_legend(below, upper, loc="center", ncol=2)
    return figure


@style.in_style
def thrust(run: Results) -> Figure:
    """Draws the stress that a restrained specimen builds up against its platens, and lateral strain."""
    hot = Heated(run)
    figure, over, upper, lower, below = _two_while_heated(run)
    stress = hot.stress
    top, bottom = hot.column("stress_top_MPa"), hot.column("stress_bottom_MPa")
    _draw_heated_parent(upper, run, run.facts.press("stress"), 1.0)
    draw_tables(upper, [run], over_minutes(hot.timed), ("stress", 1.0))
    upper.fill_between(over, top, bottom, color=style.SKY, alpha=0.5, linewidth=0.0,
                       label=style.page().said("between its upper and lower platen", "between its platens"))
    upper.plot(over, stress, color=style.BLUE, linewidth=1.8,
               label=style.page().said("this run, mean of both platens", "this run"))
    if run.history.known(run.facts.press("stress"), hot.rows).min() >= 0.0:
        upper.set_ylim(bottom=0.0)
    upper.set_ylabel(THRUST_LABEL)
    _mark_unconverged(upper, run, over, stress)
    _mark_failure(upper, run, over)
    style.draw_legend(below, upper, loc="center", ncol=2)
    return figure


def _draw_heated_parent(axes: Axes, run: Results, column: str, factor: float) -> None:
    """Draws a column of the run that this one is a fork of, where that was heated too."""
    if run.parent and Heated(run.parent).rows.any():
        history, rows = run.parent.history, Heated(run.parent).standing
        over = history["heating_time_s"] / 60.0 if Heated(run).timed else history["temperature_degC"]
        style.draw_parent(axes, run.parent, over[rows], factor * history[column][rows])


def _two_while_heated(run: Results) -> tuple[Figure, np.ndarray, Axes, Axes, Axes | None]:
    """Makes a figure with room for a curve, the lateral strain below it, and axes for a legend; and what curves are
    drawn over: the temperature, or minutes where the run is `timed`.
    """
    hot = Heated(run)
    over = heating_minutes(run) if hot.timed else hot.column("temperature_degC")
    figure, (upper, lower), below = style.panels(5.2, (1.0, 0.5), below=0.26)
    upper.set_title(style.title_of(run))
    lower.sharex(upper)
    upper.tick_params(labelbottom=False)
    lateral = style.PER_MILLE * hot.column("lateral_strain")
    lower.plot(over, lateral, color=style.BLUE)
    lower.axhline(0.0, color=style.BLACK, linewidth=0.6)
    lower.set_ylim(*_padded(style.PER_MILLE * run.history.known("lateral_strain", hot.standing)))
    lower.set_ylabel("Lateral strain,\nexpansion\npositive [$10^{-3}$]")
    lower.set_xlabel(MINUTES_LABEL if hot.timed else temperature_label(run))
    _mark_failure(lower, run, over)
    return figure, over, upper, lower, below


def over_minutes(timed: bool) -> tuple[str, float]:
    """Returns what references of a heating are drawn over, see draw_tables: minutes, or the temperature."""
    return ("heating_time", 1.0 / 60.0) if timed else ("temperature", 1.0)


def draw_band(axes: Axes, band: reference.StrainBand, colour: str, label: str | None = None) -> None:
    """Draws the band's range, paler where it is not to be trusted, and its centre."""
    trusted = band.temperature <= reference.TRUSTED_TO
    beyond = band.temperature >= reference.TRUSTED_TO
    low, central, high = (style.PER_MILLE * values for values in (band.low, band.central, band.high))
    axes.fill_between(band.temperature, low, high, where=trusted, color=colour, alpha=0.28, linewidth=0.0,
                      label=label)
    axes.fill_between(band.temperature, low, high, where=beyond, color=colour, alpha=0.1, linewidth=0.0)
    axes.plot(band.temperature, central, color=colour, linewidth=0.8, linestyle=(0, (4, 2)))


def mark_leaving(axes: Axes, x: np.ndarray, y: np.ndarray, colour: str) -> None:
    """Draws an arrow where a curve leaves the axes downwards for good, with how far it goes."""
    low, high = axes.get_ylim()
    known = np.isfinite(x) & np.isfinite(y)
    x, y = x[known], y[known]
    inside = np.flatnonzero(y >= low)
    if not len(inside) or inside[-1] == len(y) - 1:
        return
    i = inside[-1]
    at = x[i] + (x[i + 1] - x[i]) * (y[i] - low) / (y[i] - y[i + 1])
    axes.annotate(f"to {y[i + 1:].min():.0f}".replace("-", "−"), (at, low), xytext=(at, low + 0.16 * (high - low)),
                  ha="center", va="bottom", color=colour, fontsize=style.page().size(7.0), zorder=5,
                  arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 0.8, "shrinkA": 0.0, "shrinkB": 0.0},
                  bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5})


def _before_failing(run: Results) -> np.ndarray:
    """Returns (n,) total strain while the specimen stood, without the rows at the end in which it fell by far more each
    than before, where it failed.
    """
    hot = Heated(run)
    strain = hot.total_strain[hot.standing[hot.rows]]
    if hot.critical_temperature is None or len(strain) < 3:
        return strain
    steps = np.abs(np.diff(strain))
    usual = np.nanmedian(steps)
    last = len(strain)
    while last > 2 and steps[last - 2] > _FALLING * usual:
        last -= 1
    return strain[:last]


def strain_limits(runs: Sequence[Results], bands: Sequence[reference.StrainBand]) -> tuple[float, float]:
    """Returns limits [10^-3] that show bands, tables and total strains to failure, but not how far a specimen falls."""
    tables = [values for run in runs for own in run.references.tables if own.of == "total_strain"
              for values in (own.low, own.high)]
    strains = [_before_failing(run) for run in runs]
    for run in runs:
        run.history.known("specimen_strain", Heated(run).standing)
    return _padded(style.PER_MILLE * np.concatenate([*strains, *tables,
                                                     *(x for b in bands for x in (b.low, b.high))]))


def _padded(values: np.ndarray) -> tuple[float, float]:
    values = values[np.isfinite(values)]
    margin = 0.06 * (np.ptp(values) or 1.0)
    return float(values.min() - margin), float(values.max() + margin)


def _mark_unconverged(axes: Axes, run: Results, over: np.ndarray, values: np.ndarray) -> None:
    hot = Heated(run)
    rows = hot.unconverged[hot.rows]
    if rows.any():
        axes.plot(over[rows], values[rows], "x", color=style.VERMILLION,
                  markersize=4.0, linestyle="none", label=f"not converged ({rows.sum()} exchanges)")


def _mark_failure(axes: Axes, run: Results, over: np.ndarray) -> None:
    """Marks the failure. over: temperatures or minutes of the rows of the heating; the last is that of the failure."""
    hot = Heated(run)
    if hot.critical_temperature is None or not np.isfinite(over[-1]):
        return
    at = f"{over[-1]:.0f} min" if hot.timed else f"{hot.critical_temperature:.0f} °C"
    axes.axvline(over[-1], color=style.VERMILLION, linewidth=1.0, linestyle=(0, (1, 1.5)), label=f"failed at {at}")


@style.in_style
def convergence(run: Results) -> Figure:
    """Draws the cycles that the mechanics took after each exchange of temperatures, and the unbalanced ratio then."""
    course = heating_course(run)
    exchanged = course["exchange"] > 0
    over, converged = course.over[exchanged], course["converged"][exchanged] > 0
    figure, (upper, lower), below = style.panels(4.2, (1.0, 1.0), below=0.14)
    lower.sharex(upper)
    upper.set_title(style.title_of(run))
    for axes, name, label in ((upper, "cycles", "Cycles after\nthe exchange"),
                              (lower, "unbalanced_ratio", "Unbalanced ratio\nreached [–]")):
        values = course[name][exchanged]
        axes.plot(over, values, color=style.FAINT, linewidth=0.5, zorder=1)
        axes.plot(over[converged], values[converged], "o", color=style.BLUE, markersize=2.5, linestyle="none",
                  label=f"converged ({converged.sum()} exchanges)")
        if not converged.all():
            axes.plot(over[~converged], values[~converged], "x", color=style.VERMILLION, markersize=5.0,
                      linestyle="none", label=f"not converged ({(~converged).sum()} exchanges)")
        axes.set_ylabel(label)
        if course.ordered or Heated(run).timed:
            _mark_failure(axes, run, course.over)
    upper.set_ylim(bottom=0.0)
    lower.set_yscale("log")
    lower.set_xlabel(course.label)
    upper.tick_params(labelbottom=False)
    style.draw_legend(below, upper, loc="center", ncol=3,
                      title=f"{np.nansum(course['cycles'][exchanged]):,.0f} cycles in all")
    return figure


@style.in_style
def temperature_history(run: Results, profile: Profile | None = None) -> Figure:
    """Draws the least, mean and greatest temperature of the specimen, its probes and records of temperature,
    temperatures at DEPTHS, and of the hottest gas, over the time.

    profile: temperatures over the depth, see `read_profile`; None: none at DEPTHS.
    """
    minutes = run.history["heating_time_s"] / 60.0
    figure, (axes,), beside = style.panels(3.8, beside=0.3)
    axes.set_title(style.title_of(run))
    if GAS in run.history:
        axes.plot(minutes, run.history[GAS], color=style.FAINT, linestyle=(0, (4, 2)), label="gas")
    axes.fill_between(minutes, run.history["temperature_min_degC"], run.history["temperature_max_degC"],
                      color=style.FAINT, alpha=0.25, linewidth=0.0, label="least to greatest")
    axes.plot(minutes, run.history["temperature_degC"], color=style.BLACK, label="mean")
    records = {record.name: record.of(run) for record in records_of(run) if record.kind == "temperature"}
    watched = [*((name, f"probe {name}", values) for name, values in run.probes.items()),
               *((name, name, values) for name, values in records.items())]
    for (_, label, values), (colour, dashes) in zip(watched, cycle(style.LOOKS)):
        axes.plot(minutes, values, color=colour, linestyle=dashes, linewidth=1.0, label=label)
    if profile is not None:
        _draw_depths(axes, profile, minutes, [values for *_, values in watched])
    draw_tables(axes, [run], over_minutes(True), *((name, 1.0) for name in ["temperature", *(w[0] for w in watched)]))
    axes.set_xlim(left=0.0)
    axes.set_xlabel("Time [min]")
    axes.set_ylabel("Temperature [°C]")
    style.draw_legend(beside, axes, loc="upper left")
    return figure


def _draw_depths(axes: Axes, profile: Profile, minutes: np.ndarray, watched: Sequence[np.ndarray]) -> None:
    """Draws temperatures at DEPTHS, but none that a curve of the deck's own tells already."""
    heated = ScalarMappable(Normalize(-15.0, 65.0), "inferno_r")
    for depth in DEPTHS:
        if depth >= profile.depth[-1]:
            continue
        values = profile.at(depth)
        known = [np.interp(profile.time / 60.0, minutes[rows], own[rows]) for own in watched
                 for rows in [np.isfinite(minutes) & np.isfinite(own)] if rows.any()]
        if any(np.abs(values - own).max() < _TOLD * (np.ptp(values) or 1.0) for own in known):
            continue
        axes.plot(profile.time / 60.0, values, color=heated.to_rgba(style.MILLI * depth), linewidth=1.0,
                  label=f"{style.MILLI * depth:.0f} mm below\nthe {profile.face} face")
