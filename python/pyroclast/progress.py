"""How cracks and energy grow over a run."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import style
from .run import Run

_ENERGY_IN = ("energy_loading_J", "energy_gravity_J", "energy_heat_J")
_ENERGY_OUT = (
    ("energy_zones_J", "stored in zones", "#9ecae1", None),
    ("energy_contacts_J", "stored in contacts", style.BLUE, None),
    ("energy_kinetic_J", "kinetic", style.BLACK, None),
    ("dissipated_tension_J", "tension softening", style.VERMILLION, None),
    ("dissipated_shear_J", "shear softening", style.SHEAR_COLOUR, None),
    ("dissipated_friction_J", "friction", style.ORANGE, "////"),
    ("dissipated_compression_J", "compression", style.YELLOW, None),
    ("energy_local_damping_J", "local damping", "#d9d9d9", "...."),
    ("energy_viscous_damping_J", "viscous damping", style.FAINT, "xxxx"),
)


@matplotlib.rc_context(style.STYLE)
def cracks(run: Run) -> Figure:
    """Cracked contact points by mode and interface over strain, the stress curve behind."""
    figure = style.new_figure(4.8)
    upper, lower, below = figure.subplots(3, 1, height_ratios=[1.0, 1.0, 0.3])
    lower.sharex(upper)
    upper.set_title(style.title_of(run))
    for axes in (upper, lower):
        _draw_stress_behind(axes, run)
    _draw_counts(upper, run, "tension", style.TENSION_COLOUR)
    _draw_counts(lower, run, "shear", style.SHEAR_COLOUR)
    upper.set_xlim(left=0.0)
    upper.tick_params(labelbottom=False)
    lower.set_xlabel(style.STRAIN_LABEL)
    style.legend_alone(below, *_both_legends(upper, lower), loc="center", ncols=2)
    return figure


def _draw_stress_behind(axes: Axes, run: Run) -> None:
    behind = axes.twinx()
    behind.fill_between(style.PER_MILLE * run.loaded_history("strain"), run.loaded_history("stress_MPa"),
                        color="#ededed", linewidth=0.0)
    behind.plot(style.PER_MILLE * run.loaded_history("strain"), run.loaded_history("stress_MPa"),
                color=style.FAINT, linewidth=0.8)
    behind.set_ylim(bottom=0.0)
    behind.set_ylabel("Axial stress [MPa]", color="#6a6a6a")
    behind.tick_params(axis="y", colors="#6a6a6a")
    behind.grid(False)
    behind.spines["right"].set_visible(True)
    axes.set_zorder(behind.get_zorder() + 1)
    axes.patch.set_visible(False)


def _draw_counts(axes: Axes, run: Run, mode: str, colour: str) -> None:
    strain = style.PER_MILLE * run.loaded_history("strain")
    for interface, name, dashes in (("am", "A–M", "-"), ("mm", "M–M", (0, (5, 1.5)))):
        axes.plot(strain, run.loaded_history(f"{mode}_{interface}_broken"), color=colour, linestyle=dashes,
                  linewidth=1.8, label=f"{mode}, {name}: broken ($D=1$)")
        axes.plot(strain, run.loaded_history(f"{mode}_{interface}_softening"), color=colour, linestyle=dashes,
                  linewidth=0.7, label=f"{mode}, {name}: damaged ($D>0$), broken among them")
    axes.set_ylim(bottom=0.0)
    axes.set_ylabel(f"Cracked contact points,\n{mode}")


def _both_legends(*all_axes: Axes) -> tuple[list, list[str]]:
    handles, labels = [], []
    for axes in all_axes:
        more_handles, more_labels = axes.get_legend_handles_labels()
        handles += more_handles
        labels += more_labels
    return handles, labels


@matplotlib.rc_context(style.STYLE)
def energy(run: Run) -> Figure:
    """Where the work went, stacked over strain, against the work put in; below, the ledger's error."""
    figure = style.new_figure(4.8)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 0.3], width_ratios=[1.0, 0.4])
    upper, beside, lower = (figure.add_subplot(grid[place]) for place in ((0, 0), (0, 1), (1, 0)))
    lower.sharex(upper)
    upper.set_title(style.title_of(run))
    strain = style.PER_MILLE * run.loaded_history("strain")
    work_in = sum(run.loaded_history(name) for name in _ENERGY_IN)
    largest = np.abs(work_in).max() or 1.0
    _draw_stack(upper, run, strain, largest)
    upper.plot(strain, work_in, color=style.BLACK, linewidth=1.4, linestyle=(0, (4, 2)),
               label="work put in\n(loading, gravity, heat)")
    upper.set_xlim(0.0, strain.max())
    upper.tick_params(labelbottom=False)
    if work_in.min() >= 0.0:
        upper.set_ylim(bottom=0.0)
    upper.set_ylabel("Energy since the start [J]")
    handles, labels = upper.get_legend_handles_labels()
    style.legend_alone(beside, handles[::-1], labels[::-1], loc="upper left", alignment="left",
                       title="at the end, share of\nthe largest work in")

    lower.plot(strain, 100.0 * run.loaded_history("energy_error_J") / largest, color=style.VERMILLION)
    lower.axhline(0.0, color=style.BLACK, linewidth=0.6)
    lower.set_ylabel("Ledger error\n[% of largest\nwork in]")
    lower.set_xlabel(style.STRAIN_LABEL)
    return figure


def _draw_stack(axes: Axes, run: Run, strain: np.ndarray, largest: float) -> None:
    below = np.zeros_like(strain)
    for column, name, colour, hatch in _ENERGY_OUT:
        values = run.loaded_history(column)
        axes.fill_between(strain, below, below + values, facecolor=colour, hatch=hatch, edgecolor="white",
                          linewidth=0.3, label=f"{name}: {100.0 * values[-1] / largest:.1f} %")
        below = below + values
