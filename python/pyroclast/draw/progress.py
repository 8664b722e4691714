"""How cracks and energy grow over a run."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain, cycle, islice

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..errors import Error
from ..stored.compressed import Compressed
from ..stored.heated import Heated
from ..stored.results import Results
from ..stored.run_facts import (BROKEN_EXTENT, DAMAGED_EXTENT, ENERGY_ERROR, HELD, LOST, OPENING, PUT_IN,
                                Column)
from . import style

_HELD = (("#9ecae1", None), (style.BLUE, None), (style.BLACK, None))  # colour and hatch of each energy, in order
_LOST = ((style.VERMILLION, None), (style.SHEAR_COLOUR, None), (style.ORANGE, "////"), (style.YELLOW, None))
_MORE_LOST = ((style.PURPLE, "++"), ("#8c6d31", "++"), ("#66c2a4", "++"))  # where laws lose more than the paper's
_DAMPED = (("#d9d9d9", "...."), (style.FAINT, "xxxx"))  # the last that are lost
_LEAST_SHARE = 5e-4  # of the energy turned over, that an energy needs to be drawn and listed
_MODE_COLOURS = {"tension": style.TENSION_COLOUR, "shear": style.SHEAR_COLOUR, "mixed": style.MIXED_COLOUR}
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

    @property
    def stress(self) -> np.ndarray:
        """Stress (n,) [MPa] between the platens."""
        return self[self.run.facts.press("stress")]

    @property
    def opening(self) -> np.ndarray:
        """Mean opening (n,) [m] of contacts damaged in tension or mixed mode."""
        return self[self.run.facts.of_role(OPENING)[0].name]

    def __getitem__(self, name: str) -> np.ndarray:
        """Returns (n,) a column of the history."""
        return self.run.history[name][self.rows]


def loading_course(run: Results) -> Course:
    """Takes the test, over strain."""
    test = Compressed(run)
    return Course(run, test.rows, style.PER_MILLE * test.strain, style.STRAIN_LABEL, start=0.0)


def heating_course(run: Results) -> Course:
    """Takes the heating, over temperature, or over time when the run is `timed` or also cools."""
    hot = Heated(run)
    temperature, known = hot.column("temperature_degC"), run.history.known("temperature_degC", hot.rows)
    if hot.timed or (known < np.maximum.accumulate(known) - _COOLED).any():
        start = run.history.known("heating_time_s", hot.rows)[0] / 60.0
        return Course(run, hot.rows, heating_minutes(run), MINUTES_LABEL, start, ordered=False)
    return Course(run, hot.rows, temperature, temperature_label(run), start=known.min())


def heating_minutes(run: Results) -> np.ndarray:
    """Returns the time of heating [min] over the rows of `Heated`."""
    return Heated(run).column("heating_time_s") / 60.0


def temperature_label(run: Results) -> str:
    return "Temperature [°C]" if Heated(run).uniform else "Mean temperature of the specimen [°C]"


@style.in_style
def cracks(run: Results) -> Figure:
    """Draws the length of cracks, of a solid their area, by mode over strain, the stress curve behind."""
    figure, (axes,), below = style.panels(4.8, below=0.16)
    axes.set_title(style.title_of(run))
    course = loading_course(run)
    run.history.known("strain", Compressed(run).rows)
    _draw_stress_behind(axes, course)
    _draw_extents(axes, course)
    axes.set_xlim(left=0.0)
    axes.set_xlabel(course.label)
    style.draw_legend(below, axes, loc="center", ncol=2)
    return figure


@style.in_style
def heating_cracks(run: Results) -> Figure:
    """Draws the length of cracks, of a solid their area, by mode, and the mean opening, while heated."""
    figure, (lengths, opening), below = style.panels(5.4, (1.0, 0.6), below=0.2)
    lengths.set_title(style.title_of(run))
    course = heating_course(run)
    _draw_extents(lengths, course)
    opening.plot(*style.thinned(course.over, 1e6 * course.opening), color=style.BLACK)
    opening.set_ylabel("Mean opening of contacts\ndamaged in tension or mixed mode [µm]")
    opening.set_ylim(bottom=0.0)
    opening.sharex(lengths)
    lengths.tick_params(labelbottom=False)
    lengths.set_xlim(course.start, np.nanmax(course.over))
    opening.set_xlabel(course.label)
    style.draw_legend(below, lengths, loc="center", ncol=2)
    return figure


def extent_of_cracks(run: Results) -> tuple[str, str]:
    """Returns the measure of cracks, "Length" or in space "Area", and its unit."""
    name, unit = run.facts.extent
    return name.capitalize(), unit.replace("2", "²")


def crack_extent(course: Course, mode: str, is_broken: bool) -> np.ndarray:
    """Returns length [m], in space area [m²], (n,) of all cracks of a mode: of the broken, or of all with damage."""
    columns = course.run.facts.of_role(BROKEN_EXTENT if is_broken else DAMAGED_EXTENT, mode=mode)
    return sum((course[column.name] for column in columns), np.zeros(len(course.over)))


def _draw_extents(axes: Axes, course: Course) -> None:
    """Draws extents on a logarithmic axis, which shows a tenth of all: broken as lines, damaged as light areas."""
    what, unit = extent_of_cracks(course.run)
    drawn = [(mode, is_broken, crack_extent(course, mode, is_broken)) for is_broken in (False, True)
             for mode in course.run.facts.crack_modes]
    drawn = [(mode, is_broken, values) for mode, is_broken, values in drawn if (values > 0.0).any()]
    axes.set_ylabel(f"{what} of cracks [{unit}]")
    if not drawn:
        axes.set_ylim(0.0, 1.0)
        axes.set_title(f"{axes.get_title()}\nno contact is damaged".lstrip())
        return
    axes.set_yscale("log")
    least = 0.7 * min(values[values > 0.0].min() for *_, values in drawn)
    for mode, is_broken, values in drawn:
        colour, seen = _MODE_COLOURS[mode], np.where(values > 0.0, values, np.nan)
        rows = style.kept(course.over, seen)
        if is_broken:
            axes.plot(course.over[rows], seen[rows], color=colour, linewidth=1.8,
                      label=f"{mode}, " + style.page().said("broken ($D=1$)", "broken"))
        else:
            axes.fill_between(course.over[rows], least, seen[rows], color=colour, alpha=0.18, linewidth=0.0,
                              label=style.page().said(f"{mode}, damaged ($D>0$), the broken among them",
                                                      f"{mode}, $D>0$"))
    axes.set_ylim(least, 1.5 * max(np.nanmax(values) for *_, values in drawn))


def _draw_stress_behind(axes: Axes, course: Course) -> None:
    behind = axes.twinx()
    behind.plot(*style.thinned(course.over, course.stress), color=style.FAINT, linewidth=0.8)
    behind.set_ylim(bottom=0.0)
    behind.set_ylabel("Axial stress [MPa]", color="#6a6a6a")
    behind.tick_params(axis="y", colors="#6a6a6a")
    behind.grid(False)
    behind.spines["right"].set_visible(True)
    axes.set_zorder(behind.get_zorder() + 1)
    axes.patch.set_visible(False)


@style.in_style
def energy(course: Course) -> Figure:
    """Draws where the work went, stacked, against the work put in; below, what the change of properties put in, where
    properties changed, and the ledger's error.

    Shares are of the energy turned over: all that was put in or taken out, each by its size.
    """
    changed = course.run.facts.column(PUT_IN, "property_change")
    changes = course[changed.name] if changed else np.zeros(len(course.over))
    heights = (1.0, 0.45, 0.3) if changes.any() else (1.0, 0.3)
    figure, all_axes, beside = style.panels(4.8 if len(heights) == 2 else 5.6, heights, beside=0.4)
    upper, lower = all_axes[0], all_axes[-1]
    for axes in all_axes[1:]:
        axes.sharex(upper)
    for axes in all_axes[:-1]:
        axes.tick_params(labelbottom=False)
    figure.suptitle(style.title_of(course.run), fontsize=style.page().size(9.0))
    parts = [course[name] for name in energies_in(course.run)]
    work_in = sum(parts)
    turned_over = sum(map(np.abs, parts))
    if not (np.isfinite(turned_over) & np.isfinite(course.over)).any():
        raise Error(f"{course.run.history.path}: no row has all energies that were put in")
    turnover = np.nanmax(turned_over) or 1.0  # heat takes out what a softening body stores
    _draw_stack(upper, course, turnover)
    upper.plot(course.over, work_in, color=style.BLACK, linewidth=1.4, linestyle=(0, (4, 2)),
               label=style.page().said("work put in (loading,\ngravity, change of\nproperties, mass scaling)",
                                       "work put in"))
    upper.set_xlim(course.start, np.nanmax(course.over))
    if not (work_in < 0.0).any():
        upper.set_ylim(bottom=0.0)
    upper.set_ylabel("Energy since the start [J]")
    handles, labels = upper.get_legend_handles_labels()
    style.draw_legend(beside, upper, handles[::-1], labels[::-1], loc="upper left", alignment="left",
                      title=style.page().said("at the end, share of\nthe energy turned over", "share at the end"))
    if len(all_axes) == 3:
        all_axes[1].plot(*style.thinned(course.over, changes), color=style.PURPLE, linewidth=1.4)
        all_axes[1].axhline(0.0, color=style.BLACK, linewidth=0.6)
        all_axes[1].set_ylabel(style.page().said("Put in by\nthe change of\nproperties [J]",
                                                 "Changed\nproperties\n[J]"))

    error = course.run.facts.of_role(ENERGY_ERROR)[0]
    lower.plot(course.over, 100.0 * course[error.name] / turnover, color=style.VERMILLION)
    lower.axhline(0.0, color=style.BLACK, linewidth=0.6)
    lower.set_ylabel(style.page().said("Ledger error\n[% of energy\nturned over]", "Ledger\nerror [%]"))
    lower.set_xlabel(course.label)
    return figure


def energies_in(run: Results) -> list[str]:
    """Returns the columns of energies that are put in."""
    return [column.name for column in run.facts.of_role(PUT_IN)]


def energies_out(run: Results) -> list[tuple[Column, str, str | None]]:
    """Returns the columns of energies that are held or lost, with colour and hatch."""
    held, lost = run.facts.of_role(HELD), run.facts.of_role(LOST)
    of_laws = islice(chain(_LOST, cycle(_MORE_LOST)), max(0, len(lost) - len(_DAMPED)))
    return [(column, *look) for column, look in zip(held + lost, [*_HELD, *of_laws, *_DAMPED])]


def _draw_stack(axes: Axes, course: Course, turnover: float) -> None:
    energies = energies_out(course.run)
    rows, top = np.zeros(len(course.over), dtype=bool), np.zeros_like(course.over)
    for column, *_ in energies:
        top = top + course[column.name]
        rows |= style.kept(course.over, top)
    over, below = course.over[rows], np.zeros(np.count_nonzero(rows))
    for column, colour, hatch in energies:
        values = course[column.name]
        if np.nanmax(np.abs(values), initial=0.0) < _LEAST_SHARE * turnover:
            continue
        known = values[np.isfinite(values)]
        name = style.page().said(column.label, column.label.removeprefix("stored ").removesuffix(" softening"))
        axes.fill_between(over, below, below + values[rows], facecolor=colour, hatch=hatch,
                          edgecolor="white", linewidth=0.3, label=f"{name}: {_share(known, turnover)}")
        below = below + values[rows]


def _share(known: np.ndarray, turnover: float) -> str:
    if not len(known):
        return "not known"
    share = known[-1] / turnover
    return f"{100.0 * share:.1f}\u00a0%" if abs(share) >= _LEAST_SHARE else "none left"
