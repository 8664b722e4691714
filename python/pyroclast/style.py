"""One look for all figures: print sizes, colours that differ in grey and for colour-blind readers."""

from __future__ import annotations

import textwrap
from collections.abc import Container, Iterator, Sequence
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from .writing import whole

WIDTH = 7.2
"""Width of a page of two columns, inches."""
DPI = 300

_MOST_POINTS = 20_000  # of a line in a figure: more than its width has dots
_TITLE_WIDTH = 100  # characters that fit a page
_MOST_OF_A_TEXT = 200  # characters of a user's text

STYLE = {
    "font.size": 8.0,
    "axes.titlesize": 9.0,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "figure.constrained_layout.use": True,
    "svg.fonttype": "none",
    "svg.hashsalt": "pyroclast",  # the same figure gives the same file
}

# Colours of Okabe and Ito, with greys for the materials.
BLACK, ORANGE, SKY, GREEN = "#000000", "#e69f00", "#56b4e9", "#009e73"
YELLOW, BLUE, VERMILLION, PURPLE = "#f0e442", "#0072b2", "#d55e00", "#cc79a7"
AGGREGATE_COLOUR, MORTAR_COLOUR, PLATEN_COLOUR = "#b4b4b4", "#f4f0e6", "#5a5a5a"
_MORE_PHASE_COLOURS = ("#8fa9c4", "#c9b48c", "#9dbf9e", "#b79bb8")
TENSION_COLOUR, SHEAR_COLOUR = VERMILLION, "#10245e"
TENSION_TINT, SHEAR_TINT = "#f2a566", "#7787bd"
MIXED_COLOUR, MIXED_TINT = PURPLE, "#e3bdd2"
FAINT = "#9a9a9a"

# One colour and dash after the other, for curves that stand side by side.
LOOKS = tuple((colour, dashes) for dashes in ("-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (5, 1.5, 1, 1.5)))
              for colour in (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY))

STRAIN_LABEL = "Axial strain, compression positive [$10^{-3}$]"
STRESS_LABEL = "Axial stress, compression positive [MPa]"
PER_MILLE = 1e3
MILLI = 1e3  # metres to millimetres


def phase_colours(names: Sequence[str], bearings: Container[int]) -> list[str]:
    """A fill for each material of a mesh: aggregate and mortar as ever, bearings (by their places) dark, others in
    turn."""
    known = {"aggregate": AGGREGATE_COLOUR, "mortar": MORTAR_COLOUR}
    more = cycle(_MORE_PHASE_COLOURS)
    return [PLATEN_COLOUR if i in bearings else known.get(name) or next(more) for i, name in enumerate(names)]


def new_figure(height: float, width: float = WIDTH, dpi: int | None = None) -> Figure:
    """Empty figure; inches, dots per inch (DPI where it is not stated)."""
    return Figure(figsize=(width, height), dpi=dpi or DPI)


def legend_alone(axes: Axes, handles: list, labels: list[str], alignment: str = "center", **options) -> None:
    """Makes the axes hold nothing but a legend, so that it covers no curve; `alignment` is that of its title."""
    axes.axis("off")
    legend = axes.legend(handles, labels, borderaxespad=0.0, **options)
    if hasattr(legend, "set_alignment"):  # since Matplotlib 3.6
        legend.set_alignment(alignment)


def plain(text: str) -> str:
    """Text of the user's, as it stands: on one line, and no formula."""
    return visible(text).replace("$", r"\$")


def visible(text: str) -> str:
    """On one line, with what cannot be seen written out, such as \\x1b, and cut where it is long."""
    line = " ".join("".join(c if c.isprintable() or c.isspace() else c.encode("unicode_escape").decode()
                            for c in text).split())
    return line if len(line) <= _MOST_OF_A_TEXT else f"{line[:_MOST_OF_A_TEXT]}… ({len(line)} characters)"


def draw_parent(axes: Axes, parent, over, values) -> None:
    """A curve of the run that the one in the figure is a fork of, behind that one's."""
    axes.plot(over, values, color=FAINT, linewidth=1.2,
              label=f"{plain(parent.folder.name)}, of which this run is a fork")


def title_of(run) -> str:
    """A run's title, what was done to it as it came out, and its warnings, in lines that fit a page."""
    return "\n".join(line for text in (plain(run.title), *facts_of(run), *warnings_of(run))
                     for line in textwrap.wrap(text, _TITLE_WIDTH))


def facts_of(run) -> list[str]:
    """Load and temperatures of a heated run, which the deck's title may not tell or may tell wrong."""
    if not run.moves or not run.exchanged.any():
        return []
    temperatures = run.history.known("temperature_degC", run.heated)
    mean = "" if run.uniform else "mean "
    if run.ends_heated:
        held = "between fixed platens" if run.restrained else load_label(run)
        failed = "" if run.critical_temperature is None else f"failed at {run.critical_temperature:.0f} °C"
        return [", ".join(filter(None, [held, f"{mean}{temperatures[0]:.0f} to {temperatures.max():.0f} °C", failed]))]
    now = run.history.known("temperature_degC", run.loaded)[0]
    told = [f"heated to {mean}{temperatures.max():.0f} °C, compressed at {mean}{now:.0f} °C"]
    if (retained := run.strength_retained) is not None:
        told.append(f"largest stress {retained:.2f} of the strength before heating")
    return ["; ".join(told)]


def warnings_of(run) -> list[str]:
    """That a run is not quasi-static or does not say, and how many exchanges did not converge."""
    warnings = []
    if run.quasi_static is None and run.has_platens and not run.ends_heated:
        warnings.append("not stated whether quasi-static")
    elif run.quasi_static is False:
        warnings.append("NOT QUASI-STATIC")
    if missed := int(run.unconverged.sum()):
        warnings.append(f"{missed} OF {int(run.exchanged.sum())} EXCHANGES NOT CONVERGED")
    return warnings


def load_label(run) -> str:
    """Load kept while heated, as level where that is known, else as stress; empty when none was kept."""
    if run.restrained:
        return ""
    if run.load_level is not None:
        return f"$\\sigma/f_c$ = {run.load_level:g}"
    return "" if run.load_stress_MPa is None else f"$\\sigma$ = {run.load_stress_MPa:g} MPa"


def kept(x: np.ndarray, *values: np.ndarray, most: int = _MOST_POINTS) -> np.ndarray:
    """(n,) bool: about so many points at most of a curve, or of several over the same x, that look the same: of each
    stretch its ends, the extremes of all and the first gap of each.
    """
    if len(x) <= most:
        return np.ones(len(x), dtype=bool)
    length = -(-len(x) // max(most // (3 * len(values) + 4), 1))
    whole = len(x) // length * length
    first = np.arange(0, whole, length)
    rows = np.zeros(len(x), dtype=bool)
    rows[whole:] = rows[first] = rows[first + length - 1] = True
    for y in (x, *values):
        stretches = y[:whole].reshape(-1, length)
        for at in (np.argmin(np.where(np.isfinite(stretches), stretches, np.inf), axis=1),
                   np.argmax(np.where(np.isfinite(stretches), stretches, -np.inf), axis=1),
                   np.argmin(np.isfinite(stretches), axis=1)):
            rows[first + at] = True
    return rows


def thinned(x: np.ndarray, y: np.ndarray, most: int = _MOST_POINTS) -> tuple[np.ndarray, np.ndarray]:
    """A curve of which `kept` is left."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    rows = kept(x, y, most=most)
    return x[rows], y[rows]


def thin(figure: Figure) -> Figure:
    """Lines and areas of a figure with few enough points to be drawn in no time. Returns the figure."""
    for axes in figure.axes:
        for line in axes.lines:
            x, y = line.get_xdata(orig=False), line.get_ydata(orig=False)
            if len(x) > _MOST_POINTS:
                line.set_data(*thinned(x, y))
        for area in axes.collections:
            if isinstance(area, PolyCollection) and any(len(p.vertices) > 3 * _MOST_POINTS for p in area.get_paths()):
                area.set_verts([np.column_stack(thinned(*p.vertices.T)) for p in area.get_paths()])
    return figure


@contextmanager
def _laid_out_once(figure: Figure) -> Iterator[None]:
    """Saving draws twice, first without ink for the layout. The second layout would find the same again."""
    engine = figure.get_layout_engine() if hasattr(figure, "get_layout_engine") else None  # since Matplotlib 3.6
    if engine is None:
        yield
        return
    execute = engine.execute

    def first(of: Figure) -> None:
        execute(of)
        engine.execute = lambda _: None

    engine.execute = first
    try:
        yield
    finally:
        del engine.execute


@matplotlib.rc_context(STYLE)
def save(figure: Figure, path: Path) -> Path:
    """Writes the figure, its format by the file's ending; makes the folder. Returns the path.

    The file is there whole or not at all: it is written aside, then takes its name.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    ending = path.suffix.lower()
    undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with whole(path) as aside, _laid_out_once(figure):
        thin(figure).savefig(aside, format=ending[1:], metadata=undated.get(ending))
    return path
