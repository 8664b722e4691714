"""One look for all figures: print sizes, colours that differ in grey and for colour-blind readers."""

from __future__ import annotations

import io
import re
import textwrap
import warnings
from collections.abc import Callable, Container, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import wraps
from itertools import cycle
from pathlib import Path
from typing import Any, TypeVar

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.text import Text

from ..errors import Error
from ..stored.compressed import Compressed
from ..stored.heated import Heated
from ..texts import seen_on_a_line
from ..writing import whole

Made = TypeVar("Made")
_T = TypeVar("_T")

WIDTH = 7.2
"""Width of a page of two columns, inches."""
DPI = 300

COLUMN_TEXT = 8.0
"""Points, of all text where a width is asked for."""
_LABELS, _HANDLE = 0.9, 0.36  # inches: labels beside axes, about, and the sign before a text of a legend
_LETTER = 0.062  # inches, mean width of a letter of such text
_PLOT = 0.5  # of the width: height of a panel of a column without the legend in it
_LEAST_SHARE_OF_PLOT = 0.3  # of that height, where panels and legends are many
_HIGHEST, _HIGHEST_OF_WIDTH = 240.0 / 25.4, 4.0 / 3.0  # inches; over the width: of a picture of a column
_SHORT_TITLE = 25  # letters: a longer one is that of the figure
_LOWEST = 0.42  # height of a panel over that of the highest
_LEGEND_GAP = 4.0  # points between a legend and curves below it
_MOST_POINTS = 20_000  # of a line in a figure: more than its width has dots
_TITLE_WIDTH = 100  # characters that fit a page of two columns
_MOST_LETTERS = 20  # that a warning names
_MOST_OF_A_TEXT = 200  # characters of a user's text

_OF_PROGRAMS = ("backend", "interactive", "toolbar", "webagg", "tk.", "keymap.")  # settings that no figure shows

STYLE = {
    # All settings as Matplotlib comes: a figure is the same whatever a matplotlibrc says.
    **{key: value for key, value in matplotlib.rcParamsDefault.items() if not key.startswith(_OF_PROGRAMS)},
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


@dataclass(frozen=True)
class Page:
    """What figures are drawn for."""

    width: float = WIDTH  #: inches
    is_column: bool = False  #: a width was asked for: all text has 8 pt, and legends stand in the axes
    panels: tuple[int, ...] = ()  #: numbers, from 1, of the panels that are drawn; empty: all
    has_title: bool = True
    has_covered: bool = False  #: cracks are drawn that a platen covers in the picture
    has_table: bool = True  #: of values, beside a stress-strain curve

    def size(self, points: float) -> float:
        """Returns the size of a text, which has these points unless a width is asked for."""
        return COLUMN_TEXT if self.is_column else points

    @property
    def highest(self) -> float:
        """Greatest height of a picture, inches."""
        return min(_HIGHEST, _HIGHEST_OF_WIDTH * self.width) if self.is_column else float("inf")

    def kept(self, panels: Sequence[_T]) -> list[_T]:
        """Returns those panels of a figure that the page wants."""
        return [panel for i, panel in enumerate(panels, 1) if not self.panels or i in self.panels]

    def chosen(self, panels: Sequence[_T]) -> list[_T]:
        """Returns `kept`. Raises Error where the page wants others alone."""
        kept = self.kept(panels)
        if self.panels and not kept:
            raise Error(f"has {len(panels)} panels, and none of the numbers {', '.join(map(str, self.panels))}")
        return kept

    def said(self, text: str, short: str) -> str:
        """Returns what a legend says: a short text in a column, where its axes or the caption say the rest."""
        return short if self.is_column else text

    @property
    def letters(self) -> int:
        """Letters that fit a line of a title."""
        return int((self.width - 0.65) / _LETTER) if self.is_column else _TITLE_WIDTH

    def fitting(self, least: float) -> int:
        """Returns how many panels of a width, inches, stand side by side."""
        return max(1, int(self.width / least))


_page: ContextVar[Page] = ContextVar("page", default=Page())


def page() -> Page:
    """Returns what figures are drawn for now."""
    return _page.get()


@contextmanager
def page_of(width: float | None, *, panels: Sequence[int] = (), title: bool = True,
            table: bool = True, cracks_under_platens: bool = False) -> Iterator[None]:
    """Draws figures for a width, inches; None: for a page of two columns, as they are drawn without this.

    panels: numbers, from 1, of the panels to draw of figures that have several; empty: all. title, table: False draws
    figures without their title, and a stress-strain curve without its table. cracks_under_platens: draws cracks also
    where a platen covers them in the picture.
    """
    choices = {"panels": tuple(panels), "has_title": title, "has_table": table, "has_covered": cracks_under_platens}
    before = _page.set(Page(**choices) if width is None else Page(width, is_column=True, **choices))
    try:
        yield
    finally:
        _page.reset(before)


def in_style(draw: Callable[..., Made]) -> Callable[..., Made]:
    """Makes a function draw in the look of all figures."""
    @wraps(draw)
    def drawn(*arguments: Any, **options: Any) -> Made:
        sizes = {"axes.titlesize": COLUMN_TEXT, "legend.fontsize": COLUMN_TEXT} if page().is_column else {}
        with matplotlib.rc_context({**STYLE, **sizes}):
            return draw(*arguments, **options)

    return drawn


# Colours of Okabe and Ito, with greys for the materials.
BLACK, ORANGE, SKY, GREEN = "#000000", "#e69f00", "#56b4e9", "#009e73"
YELLOW, BLUE, VERMILLION, PURPLE = "#f0e442", "#0072b2", "#d55e00", "#cc79a7"
AGGREGATE_COLOUR, MORTAR_COLOUR, PLATEN_COLOUR = "#b4b4b4", "#f4f0e6", "#5a5a5a"
_MORE_PHASE_COLOURS = ("#8fa9c4", "#c9b48c", "#9dbf9e", "#b79bb8")
TENSION_COLOUR, SHEAR_COLOUR = VERMILLION, "#10245e"
TENSION_TINT, SHEAR_TINT = "#f2a566", "#7787bd"
MIXED_COLOUR, MIXED_TINT = PURPLE, "#e3bdd2"
FAINT = "#9a9a9a"
HEAT_MAP = "YlOrRd"
"""Colours of temperatures, from cool to hot: cool ones are light."""

# One colour and dash after the other, for curves that stand side by side.
LOOKS = tuple((colour, dashes) for dashes in ("-", (0, (5, 1.5)), (0, (1.5, 1)), (0, (5, 1.5, 1, 1.5)))
              for colour in (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY))

STRAIN_LABEL = "Axial strain, compression positive [$10^{-3}$]"
STRESS_LABEL = "Axial stress, compression positive [MPa]"
PER_MILLE = 1e3
MILLI = 1e3  # metres to millimetres


def phase_colours(names: Sequence[str], bearings: Container[int]) -> list[str]:
    """Returns a fill for each material: aggregate and mortar as ever, bearings (by place) dark, others in turn."""
    known = {"aggregate": AGGREGATE_COLOUR, "mortar": MORTAR_COLOUR}
    more = cycle(_MORE_PHASE_COLOURS)
    return [PLATEN_COLOUR if i in bearings else known.get(name) or next(more) for i, name in enumerate(names)]


def new_figure(height: float, width: float = WIDTH, dpi: int | None = None) -> Figure:
    """Makes an empty figure for the page; inches, dots per inch (else DPI). width: the most that it takes."""
    figure = Figure(figsize=(page().width if width == WIDTH else min(width, page().width), min(height, page().highest)),
                    dpi=dpi or DPI)
    figure.of_page = page()  # type: ignore[attr-defined]
    return figure


def number(figure: Figure, all_axes: Sequence[Axes]) -> None:
    """Numbers the panels of a figure, by which its page chooses among them."""
    figure.numbered = list(all_axes)  # type: ignore[attr-defined]


def panels(height: float, rows: Sequence[float] = (1.0,), beside: float | None = None,
           below: float | None = None) -> tuple[Figure, list[Axes], Axes | None]:
    """Makes a figure of panels, one below the other, and axes for a legend, see `draw_legend`; None for these where
    legends stand in the panels.

    height: inches, of the figure on a page of two columns. rows: heights of the panels, one over the other.
    beside, below: width of the axes for the legend over that of the panels, or height over the panels'.
    """
    if page().is_column:
        rows = [max(_LOWEST * max(rows), row) for row in rows]
        plots = [_PLOT * page().width * row / max(rows) for row in rows]
        figure = new_figure(sum(plots) + 0.5 + 0.3 * len(rows))
        grid = figure.add_gridspec(len(rows), 1, height_ratios=plots)
        all_axes = [figure.add_subplot(grid[i]) for i in range(len(rows))]
        figure.plots = dict(zip(all_axes, plots))  # type: ignore[attr-defined]
        number(figure, all_axes)
        return figure, all_axes, None
    figure = new_figure(height)
    columns = [1.0] if beside is None else [1.0, beside]
    grid = figure.add_gridspec(len(rows) + (below is not None), len(columns), width_ratios=columns,
                               height_ratios=[*rows] if below is None else [*rows, below])
    all_axes = [figure.add_subplot(grid[i, 0]) for i in range(len(rows))]
    number(figure, all_axes)
    if beside is None and below is None:
        return figure, all_axes, None
    return figure, all_axes, figure.add_subplot(grid[-1, 0] if beside is None else grid[:, 1])


def draw_legend(place: Axes | None, axes: Axes, handles: Sequence | None = None, labels: Sequence[str] | None = None,
                alignment: str = "center", **options: Any) -> None:
    """Draws a legend in the place that `panels` left for it, or in the axes, above all that they show."""
    if handles is None or labels is None:
        handles, labels = axes.get_legend_handles_labels()
    if place is not None:
        legend_alone(place, list(handles), list(labels), alignment, **options)
    elif handles:
        _draw_on_top(axes, list(handles), list(labels), options.get("title"), page().width - _LABELS)


def draw_own_legend(axes: Axes) -> None:
    """Draws a legend of the axes in them: where it covers least, or above all that they show."""
    if page().is_column:
        draw_legend(None, axes)
    else:
        axes.legend(loc="best")


def _draw_on_top(axes: Axes, handles: list, labels: list[str], title: str | None, width: float) -> None:
    """Draws a legend at the upper end of axes of this width, inches: in one column, or in two where these are lower."""
    one, two = ([_lines(label, max(10, int((width / columns - _HANDLE) / _LETTER))) for label in labels]
                for columns in (1, 2))
    half = -(-len(labels) // 2)
    heights = [sum(label.count("\n") + 1 for label in part) for part in (one, two[:half], two[half:])]
    in_two = max(heights[1:]) < heights[0]
    legend = axes.legend(handles, two if in_two else one, loc="upper left", borderaxespad=0.2, ncol=2 if in_two else 1,
                         columnspacing=0.8, handlelength=1.4, handletextpad=0.5, title=title and _lines(title, 40),
                         title_fontsize=COLUMN_TEXT, fontsize=COLUMN_TEXT, frameon=False)
    legend.set_in_layout(False)  # it would make axes narrower that are hardly wider
    legend.on_top = handles, labels, title


def lines_of(text: str, letters: int) -> list[str]:
    """Returns a text in lines of at most so many letters, longer words apart."""
    words = re.split("[ \t\n]+", text.strip())
    return textwrap.wrap(" ".join(words), letters, break_long_words=False, break_on_hyphens=False)


def _lines(text: str, letters: int) -> str:
    return "\n".join(lines_of(text, letters))


def settle(figure: Figure) -> Figure:
    """Makes room in a figure of a column: breaks labels that are longer than their axes, and lifts the upper ends of
    axes that have a legend on top until it covers nothing. Returns the figure.
    """
    of_page = getattr(figure, "of_page", Page())
    _choose_panels(figure, of_page)
    if not of_page.is_column:
        _lay_out(figure)  # panels of one scale on both axes shrink, and the next finds room for the rest
        return figure
    renderer = FigureCanvasAgg(figure).get_renderer()
    for _ in range(4):
        _lay_out(figure)
        _break_labels(figure, renderer)
        _lay_out(figure)
        for axes in _with_legend_on_top(figure):
            _draw_on_top(axes, *axes.get_legend().on_top, axes.bbox.width / figure.dpi)
        if not _share_height(figure, of_page.highest, renderer):
            break
    for axes in _with_legend_on_top(figure):
        share = min(0.8, _room_of_legend(axes, renderer) / axes.bbox.height)
        for one in figure.axes:
            if one.bbox.bounds == axes.bbox.bounds:
                _lift(one, share)
    _lay_out(figure)
    _break_labels(figure, renderer)  # axes may have become narrower
    return figure


def _choose_panels(figure: Figure, of_page: Page) -> None:
    """Takes away the panels that the page does not want, and their share of the height. Raises Error where the figure
    has none of those that it wants.
    """
    listed: list[Axes] = getattr(figure, "numbered", [])
    if not of_page.panels or len(listed) < 2:
        return
    kept = of_page.chosen(listed)
    for above, axes in zip(listed, listed[1:] + [listed[-1]]):  # a label below serves all panels above it
        if above in kept and not above.get_xlabel():
            follows = next(one for one in listed[listed.index(axes):] if one.get_xlabel() or one is listed[-1])
            if not any(one in kept for one in listed[listed.index(axes):listed.index(follows) + 1]):
                above.set_xlabel(follows.get_xlabel())
                above.tick_params(labelbottom=True)
    if listed[0] not in kept and not kept[0].get_title():
        kept[0].set_title(listed[0].get_title())
    grid = listed[0].get_gridspec()
    heights, widths = list(grid.get_height_ratios()), list(grid.get_width_ratios())
    before = sum(heights)
    gone = [axes.get_subplotspec() for axes in listed if axes not in kept]
    has_first = listed[0] in kept
    for one in [one for one in figure.axes if one.get_subplotspec() in gone or not (has_first or one.axison)]:
        one.remove()  # with what stands behind it, and a legend of the first panel
    filled = [axes.get_subplotspec() for axes in kept]
    for ratios, side in ((heights, "rowspan"), (widths, "colspan")):
        for i in {i for place in gone for i in getattr(place, side)}:
            if not any(i in getattr(place, side) for place in filled):
                ratios[i] *= 1e-3
    grid.set_height_ratios(heights)
    grid.set_width_ratios(widths)
    figure.set_figheight(figure.get_figheight() * sum(heights) / before)


def _share_height(figure: Figure, highest: float, renderer: Any) -> bool:
    """Gives each panel of a column its plot and the room of its legend; plots get lower where the picture would become
    too high. Returns whether the layout changes.
    """
    plots = {axes: height for axes, height in getattr(figure, "plots", {}).items() if axes in figure.axes}
    if not plots:
        return False
    legends = {axes: _room_of_legend(one, renderer) / figure.dpi for one in _with_legend_on_top(figure)
               for axes in plots if axes.bbox.bounds == one.bbox.bounds}
    now = figure.get_figheight()
    rest = now - sum(axes.bbox.height for axes in plots) / figure.dpi
    room = highest - rest - sum(legends.values())
    share = min(1.0, max(_LEAST_SHARE_OF_PLOT, room / sum(plots.values())))
    heights = {axes: share * height + legends.get(axes, 0.0) for axes, height in plots.items()}
    wanted = min(highest, rest + sum(heights.values()))
    grid = next(iter(plots)).get_gridspec()
    ratios = list(grid.get_height_ratios())
    for axes, height in heights.items():
        ratios[axes.get_subplotspec().rowspan.start] = height
    off = max(abs(axes.bbox.height / figure.dpi - height) for axes, height in heights.items())
    grid.set_height_ratios(ratios)
    figure.set_figheight(wanted)
    return max(off, abs(wanted - now)) > 1.0 / 72.0


def _with_legend_on_top(figure: Figure) -> list[Axes]:
    return [axes for axes in figure.axes if hasattr(axes.get_legend(), "on_top")]


def _room_of_legend(axes: Axes, renderer: Any) -> float:
    """Returns the height of a legend, pixels."""
    return axes.get_legend().get_window_extent(renderer).height + _LEGEND_GAP * axes.figure.dpi / 72.0


def _lift(axes: Axes, share: float) -> None:
    """Moves the upper end of an axis up, so that a share of it above what it shows is empty."""
    transform = axes.yaxis.get_transform()
    low, high = transform.transform(np.array(axes.get_ylim()))
    axes.set_ylim(top=float(transform.inverted().transform(np.array([low + (high - low) / (1.0 - share)]))[0]))


def _break_labels(figure: Figure, renderer: Any) -> None:
    """Breaks titles and labels that are too long, and puts titles over the middle of the figure."""
    room = figure.bbox.width - figure.dpi / 9.0
    titles = [axes.title for axes in figure.axes if axes.axison and len(axes.title.get_text()) > _SHORT_TITLE]
    for title in [*titles, *filter(None, [figure._suptitle])]:
        taken = title.get_window_extent(renderer).width
        letters = max(map(len, title.get_text().split("\n")))
        if taken > room:
            title.set_text("\n".join(line for text in title.get_text().split("\n")
                                     for line in lines_of(text, int(letters * room / taken))))
    for title in titles:
        box = title.axes.bbox
        title.set_x((0.5 * figure.bbox.width - box.x0) / box.width)
    for axes in figure.axes:
        if not axes.axison:
            continue
        for label, room, side in ((axes.xaxis.label, min(axes.bbox.width * 1.1, figure.bbox.width), "width"),
                                  (axes.yaxis.label, axes.bbox.height, "height")):
            _break(label, room, getattr(label.get_window_extent(renderer), side))


def _break(label: Text, room: float, taken: float) -> None:
    text = " ".join(label.get_text().split())
    if not text or taken <= room:
        return
    longest = max(map(len, label.get_text().split("\n")))
    label.set_text(_lines(text, max(8, int(longest * room / taken))))


def legend_alone(axes: Axes, handles: list, labels: list[str], alignment: str = "center", **options) -> None:
    """Makes the axes hold nothing but a legend, so that it covers no curve; `alignment` is that of its title."""
    axes.axis("off")
    legend = axes.legend(handles, labels, borderaxespad=0.0, **options)
    if hasattr(legend, "set_alignment"):  # since Matplotlib 3.6
        legend.set_alignment(alignment)


def plain(text: str) -> str:
    """Returns a user's text, as it stands: on one line, and no formula."""
    return visible(text).replace("$", r"\$")


def visible(text: str) -> str:
    """Returns a text on one line, with what cannot be seen written out, such as \\x1b, and cut where it is long."""
    line = seen_on_a_line(" ".join(text.split()))
    return line if len(line) <= _MOST_OF_A_TEXT else f"{line[:_MOST_OF_A_TEXT]}… ({len(line)} characters)"


def draw_parent(axes: Axes, parent, over, values) -> None:
    """Draws a curve of the run that the one in the figure is a fork of, behind that one's."""
    axes.plot(over, values, color=FAINT, linewidth=1.2,
              label=f"{plain(parent.folder.name)}, of which this run is a fork")


def title_of(run) -> str:
    """Returns a run's title, what was done to it as it came out, and its warnings, in lines that fit a page; empty on a
    page without titles.
    """
    if not page().has_title:
        return ""
    return "\n".join(line for text in (plain(run.title), *facts_of(run), *warnings_of(run))
                     for line in textwrap.wrap(text, page().letters))


def facts_of(run) -> list[str]:
    """Returns the load and temperatures of a heated run, which the deck's title may not tell or may tell wrong."""
    test = Compressed(run)
    hot = Heated(run)
    if not run.moves or not hot.exchanged.any():
        return []
    temperatures = run.history.known("temperature_degC", hot.rows)
    mean = "" if hot.uniform else "mean "
    if hot.is_last:
        held = "between fixed platens" if hot.restrained else load_label(run)
        failed = "" if hot.critical_temperature is None else f"failed at {hot.critical_temperature:.0f} °C"
        return [", ".join(filter(None, [held, f"{mean}{temperatures[0]:.0f} to {temperatures.max():.0f} °C", failed]))]
    now = run.history.known("temperature_degC", test.rows)[0]
    told = [f"heated to {mean}{temperatures.max():.0f} °C, compressed at {mean}{now:.0f} °C"]
    if (retained := test.strength_retained) is not None:
        told.append(f"largest stress {retained:.2f} of the strength before heating")
    return ["; ".join(told)]


def warnings_of(run) -> list[str]:
    """Returns warnings that a run is not quasi-static or does not say, and how many exchanges did not converge."""
    test = Compressed(run)
    hot = Heated(run)
    warnings = []
    if test.quasi_static is None and run.has_platens and not hot.is_last:
        warnings.append("not stated whether quasi-static")
    elif test.quasi_static is False:
        warnings.append("NOT QUASI-STATIC")
    if missed := int(hot.unconverged.sum()):
        warnings.append(f"{missed} OF {int(hot.exchanged.sum())} EXCHANGES NOT CONVERGED")
    return warnings


def load_label(run) -> str:
    """Returns the load kept while heated, as level where that is known, else as stress; empty when none was kept."""
    hot = Heated(run)
    if hot.restrained:
        return ""
    if hot.load_level is not None:
        return f"$\\sigma/f_c$ = {hot.load_level:g}"
    return "" if hot.load_stress is None else f"$\\sigma$ = {hot.load_stress:g} MPa"


def kept(x: np.ndarray, *values: np.ndarray, most: int = _MOST_POINTS) -> np.ndarray:
    """Returns (n,) bool: about so many points at most of a curve, or of several over the same x, that look the same: of
    each stretch its ends, the extremes of all and the first gap of each.
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
    """Returns what `kept` leaves of a curve."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    rows = kept(x, y, most=most)
    return x[rows], y[rows]


def thin(figure: Figure) -> Figure:
    """Thins the lines and areas of a figure to so few points that it is drawn in no time; returns the figure."""
    for axes in figure.axes:
        for line in axes.lines:
            x, y = line.get_xdata(orig=False), line.get_ydata(orig=False)
            if len(x) > _MOST_POINTS:
                line.set_data(*thinned(x, y))
        for area in axes.collections:
            if isinstance(area, PolyCollection) and any(len(p.vertices) > 3 * _MOST_POINTS for p in area.get_paths()):
                area.set_verts([np.column_stack(thinned(*p.vertices.T)) for p in area.get_paths()])
    return figure


def _layout_of(figure: Figure):
    return figure.get_layout_engine() if hasattr(figure, "get_layout_engine") else None  # since Matplotlib 3.6


def _lay_out(figure: Figure) -> None:
    """Lays a figure out without drawing it, which takes as long again."""
    if (engine := _layout_of(figure)) is not None:
        engine.execute(figure)


@contextmanager
def _laid_out_once(figure: Figure) -> Iterator[None]:
    """Lays a settled figure out once. Saving draws twice, first without ink for the layout; the second layout would
    find the same again.
    """
    engine = _layout_of(figure)
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


_NO_GLYPH = re.compile(r"Glyph (\d+) .*missing from")
_told: list[str] = []  # characters that a warning named


@contextmanager
def letters_told_once() -> Iterator[None]:
    """Warns once in a process, in one line, of letters that the font lacks: Matplotlib warns of each at each drawing.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        yield
    lacking = ""
    for warning in caught:
        if (match := _NO_GLYPH.match(str(warning.message))) is None:
            warnings.warn_explicit(warning.message, warning.category, warning.filename, warning.lineno)
        elif (letter := chr(int(match[1]))) not in lacking:
            lacking += letter
    if lacking and not _told:
        _told.append(lacking)
        warnings.warn(f"the font {FontProperties().get_name()} has no {lacking[:_MOST_LETTERS]}: figures show boxes in "
                      "their place; write titles and names in letters that it has", stacklevel=3)


@matplotlib.rc_context(STYLE)
def png(figure: Figure) -> bytes:
    """Returns the figure as a PNG."""
    into = io.BytesIO()
    with letters_told_once():
        figure.savefig(into, format="png")
    return into.getvalue()


@matplotlib.rc_context(STYLE)
def save(figure: Figure, path: Path) -> Path:
    """Writes the figure, its format by the file's ending; makes the folder. Returns the path.

    The file is there whole or not at all: it is written aside, then takes its name.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    ending = path.suffix.lower()
    undated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    with whole(path) as aside, letters_told_once(), _laid_out_once(settle(thin(figure))):
        figure.savefig(aside, format=ending[1:], metadata=undated.get(ending))
    return path
