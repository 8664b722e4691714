"""How cracks and energy grow over a run."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .errors import Error

if TYPE_CHECKING:
    from .results import Results

_ENERGY_IN = ("energy_loading_J", "energy_gravity_J", "energy_property_change_J",
              "energy_mass_scaling_J")
_ENERGY_OUT = (
    ("energy_zones_J", "stored in zones", "#9ecae1", None),
    ("energy_contacts_J", "stored in contacts", style.BLUE, None),
    ("energy_kinetic_J", "kinetic", style.BLACK, None),
    ("dissipated_tension_J", "tension softening", style.VERMILLION, None),
    ("dissipated_shear_J", "shear softening", style.SHEAR_COLOUR, None),
    ("dissipated_friction_J", "friction", style.ORANGE, "////"),
    ("dissipated_compression_J", "crushing", style.YELLOW, None),
    ("energy_local_damping_J", "local damping", "#d9d9d9", "...."),
    ("energy_viscous_damping_J", "viscous damping", style.FAINT, "xxxx"),
)
_LEAST_SHARE = 5e-4  # of the energy turned over, that an energy needs to be drawn and listed
_MORE_LOSSES = (style.PURPLE, "#8c6d31", "#66c2a4")  # colours
_DASHES = ("-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (5, 1.5, 1, 1.5)))  # by interface
_MODE_COLOURS = {"tension": style.TENSION_COLOUR, "shear": style.SHEAR_COLOUR, "mixed": style.MIXED_COLOUR}
_COUNTS_NOTE = "broken: $D=1$; damaged: $D>0$, the broken among them"
MINUTES_LABEL = "Time of heating [min]"
_COOLED = 1.0  # K below the hottest before, from which temperature no longer orders the rows


@dataclass(frozen=True)
class Course:
    """Rows of a run's history, and what they are drawn over."""

    run: Results
    rows: np.ndarray  #: (rows of the history,) bool
    over: np.ndarray  #: (n,) in the unit of the label
    label: str
    start: float  #: left end of the axis
    ordered: bool = True  #: False when time stands in for a temperature that also falls

    def __getitem__(self, name: str) -> np.ndarray:
        """(n,) a column of the history."""
        return self.run.history[name][self.rows]


def loading_course(run: Results) -> Course:
    """The last stage, over strain."""
    return Course(run, run.loaded, style.PER_MILLE * run.loaded_strain, style.STRAIN_LABEL, start=0.0)


def heating_course(run: Results) -> Course:
    """The heating, over temperature, or over time when the run is `timed` or also cools."""
    temperature, known = run.heated_history("temperature_degC"), run.history.known("temperature_degC", run.heated)
    if run.timed or (known < np.maximum.accumulate(known) - _COOLED).any():
        start = run.history.known("heating_time_s", run.heated)[0] / 60.0
        return Course(run, run.heated, heating_minutes(run), MINUTES_LABEL, start, ordered=False)
    return Course(run, run.heated, temperature, temperature_label(run), start=known.min())


def heating_minutes(run: Results) -> np.ndarray:
    """Time of heating [min] over the rows of `heated`."""
    return run.heated_history("heating_time_s") / 60.0


def temperature_label(run: Results) -> str:
    return "Temperature [°C]" if run.uniform else "Mean temperature of the specimen [°C]"


@matplotlib.rc_context(style.STYLE)
def cracks(run: Results) -> Figure:
    """Cracked contact points by mode and interface over strain, the stress curve behind."""
    modes = list(run.crack_modes) or ["tension"]
    figure = style.new_figure(1.2 + 1.8 * len(modes))
    *panels, below = figure.subplots(len(modes) + 1, 1, gridspec_kw={"height_ratios": [1.0] * len(modes) + [0.3]})
    panels[0].set_title(style.title_of(run))
    course = loading_course(run)
    run.history.known("strain", run.loaded)
    for axes, mode in zip(panels, modes):
        axes.sharex(panels[0]) if axes is not panels[0] else None
        _draw_stress_behind(axes, course)
        _draw_counts(axes, course, mode)
        axes.tick_params(labelbottom=axes is panels[-1])
    panels[0].set_xlim(left=0.0)
    panels[-1].set_xlabel(course.label)
    style.legend_alone(below, *_legends(*panels), loc="center", ncol=2, title=_COUNTS_NOTE, title_fontsize=7.0)
    return figure


@matplotlib.rc_context(style.STYLE)
def heating_cracks(run: Results) -> Figure:
    """Cracked contact points and crack length, of a solid area, by mode and interface, and the mean opening, while heated."""
    figure = style.new_figure(5.4)
    figure.suptitle(style.title_of(run), fontsize=9.0)
    modes = list(run.crack_modes) or ["tension"]
    rows = figure.add_gridspec(3, 1, height_ratios=[1.0, 1.0, 0.32])
    upper, lower = rows[0].subgridspec(1, len(modes)), rows[1].subgridspec(1, 2)
    counts = [figure.add_subplot(upper[i]) for i in range(len(modes))]
    length, opening = (figure.add_subplot(lower[i]) for i in range(2))
    panels = [*counts, length, opening]
    course = heating_course(run)
    in_space = any(name.endswith("_area_m2") for name in run.history.names)
    extent, label = ("area_m2", "Area of all cracks, $D>0$ [m²]") if in_space else (
        "length_m", "Length of all cracks, $D>0$ [m]")
    for axes, mode in zip(counts, modes):
        _draw_counts(axes, course, mode)
        for interface, dashes in zip(run.crack_modes.get(mode, []), cycle(_DASHES)):
            length.plot(*style.thinned(course.over, course[f"{mode}_{interface}_{extent}"]), color=_MODE_COLOURS[mode],
                        linestyle=dashes, linewidth=0.7)
    length.set_ylabel(label)
    opening.plot(*style.thinned(course.over, 1e6 * course["mean_opening_m"]), color=style.BLACK)
    opening.set_ylabel("Mean opening of contacts\ndamaged in tension [µm]")
    for axes in panels:
        axes.set_xlim(course.start, np.nanmax(course.over))
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(course.label)
    style.legend_alone(figure.add_subplot(rows[2]), *_legends(*counts), loc="center", ncol=2, title=_COUNTS_NOTE,
                       title_fontsize=7.0)
    return figure


def _draw_stress_behind(axes: Axes, course: Course) -> None:
    behind = axes.twinx()
    rows = style.kept(course.over, course["stress_MPa"])
    behind.fill_between(course.over[rows], course["stress_MPa"][rows], color="#ededed", linewidth=0.0)
    behind.plot(*style.thinned(course.over, course["stress_MPa"]), color=style.FAINT, linewidth=0.8)
    behind.set_ylim(bottom=0.0)
    behind.set_ylabel("Axial stress [MPa]", color="#6a6a6a")
    behind.tick_params(axis="y", colors="#6a6a6a")
    behind.grid(False)
    behind.spines["right"].set_visible(True)
    axes.set_zorder(behind.get_zorder() + 1)
    axes.patch.set_visible(False)


def _draw_counts(axes: Axes, course: Course, mode: str) -> None:
    colour = _MODE_COLOURS[mode]
    for interface, dashes in zip(course.run.crack_modes.get(mode, []), cycle(_DASHES)):
        name = interface.replace("_", "–")
        axes.plot(*style.thinned(course.over, course[f"{mode}_{interface}_broken"]), color=colour, linestyle=dashes,
                  linewidth=1.8, label=f"{mode}, {name}: broken")
        axes.plot(*style.thinned(course.over, course[f"{mode}_{interface}_damaged"]), color=colour, linestyle=dashes,
                  linewidth=0.7, label=f"{mode}, {name}: damaged")
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel(f"Cracked contact points,\n{mode}")


def _legends(*all_axes: Axes) -> tuple[list, list[str]]:
    handles, labels = [], []
    for axes in all_axes:
        more_handles, more_labels = axes.get_legend_handles_labels()
        handles += more_handles
        labels += more_labels
    return handles, labels


@matplotlib.rc_context(style.STYLE)
def energy(course: Course) -> Figure:
    """Where the work went, stacked, against the work put in; below, the ledger's error.

    Shares are of the energy turned over: all that was put in or taken out, each by its size.
    """
    figure = style.new_figure(4.8)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 0.3], width_ratios=[1.0, 0.4])
    upper, beside, lower = (figure.add_subplot(grid[place]) for place in ((0, 0), (0, 1), (1, 0)))
    lower.sharex(upper)
    figure.suptitle(style.title_of(course.run), fontsize=9.0)
    parts = [course[name] for name in _ENERGY_IN if name in course.run.history]
    work_in = sum(parts)
    turned_over = sum(map(np.abs, parts))
    if not (np.isfinite(turned_over) & np.isfinite(course.over)).any():
        raise Error(f"{course.run.history.path}: no row has all energies that were put in")
    turnover = np.nanmax(turned_over) or 1.0  # heat takes out what a softening body stores
    _draw_stack(upper, course, turnover)
    upper.plot(course.over, work_in, color=style.BLACK, linewidth=1.4, linestyle=(0, (4, 2)),
               label="work put in (loading,\ngravity, change of\nproperties, mass scaling)")
    if course["energy_property_change_J"].any():
        upper.plot(*style.thinned(course.over, course["energy_property_change_J"]), color=style.PURPLE, linewidth=1.4,
                   linestyle=(0, (1.5, 1)), label="put in by the change of\nproperties alone")
    upper.set_xlim(course.start, np.nanmax(course.over))
    upper.tick_params(labelbottom=False)
    if not (work_in < 0.0).any() and not (course["energy_property_change_J"] < 0.0).any():
        upper.set_ylim(bottom=0.0)
    upper.set_ylabel("Energy since the start [J]")
    handles, labels = upper.get_legend_handles_labels()
    style.legend_alone(beside, handles[::-1], labels[::-1], loc="upper left", alignment="left",
                       title="at the end, share of\nthe energy turned over")

    lower.plot(course.over, 100.0 * course["energy_error_J"] / turnover, color=style.VERMILLION)
    lower.axhline(0.0, color=style.BLACK, linewidth=0.6)
    lower.set_ylabel("Ledger error\n[% of energy\nturned over]")
    lower.set_xlabel(course.label)
    return figure


def _energies(run: Results) -> list[tuple[str, str, str, str | None]]:
    """Columns of energies that the run has, with name, colour and hatch: a law may lose others than the paper's."""
    known = [entry for entry in _ENERGY_OUT if entry[0] in run.history]
    others = [name for name in run.history.names
              if name.startswith("dissipated_") and name not in {column for column, *_ in _ENERGY_OUT}]
    return known + [(name, name.removeprefix("dissipated_").removesuffix("_J").replace("_", " "), colour, "++")
                    for name, colour in zip(others, cycle(_MORE_LOSSES))]


def _draw_stack(axes: Axes, course: Course, turnover: float) -> None:
    energies = _energies(course.run)
    rows, top = np.zeros(len(course.over), dtype=bool), np.zeros_like(course.over)
    for column, *_ in energies:
        top = top + course[column]
        rows |= style.kept(course.over, top)
    over, below = course.over[rows], np.zeros(np.count_nonzero(rows))
    for column, name, colour, hatch in energies:
        values = course[column]
        if np.nanmax(np.abs(values), initial=0.0) < _LEAST_SHARE * turnover:
            continue
        known = values[np.isfinite(values)]
        share = f"{100.0 * known[-1] / turnover:.1f} %" if len(known) else "not known"
        axes.fill_between(over, below, below + values[rows], facecolor=colour, hatch=hatch,
                          edgecolor="white", linewidth=0.3, label=f"{name}: {share}")
        below = below + values[rows]
