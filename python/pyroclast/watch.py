"""Shows a run while another process writes it: its curve and its specimen with the cracks, as they grow.

    python3 -m pyroclast.watch RUN_DIR          until the run is over
    python3 -m pyroclast.watch RUN_DIR --once   what there is by now

It prints the curve in plain characters, and keeps a picture up to date, RUN_DIR/figures/watch.png; who may not write
there finds it at a place of their own, which is told. With a display it also keeps the page of the run up to date,
RUN_DIR/report.html, which loads itself anew until the run is over. It only reads what the run writes: however it ends,
the run goes on. Ends with 1 and one line on stderr when there is no run.

In a notebook:

    from pyroclast.watch import Watch
    watch = Watch("runs/mine")
    shown = display(watch, display_id=True)
    while watch.is_running:
        time.sleep(2.0)
        if watch.update():
            shown.update(watch)
"""

from __future__ import annotations

import argparse
import base64
import errno
import hashlib
import html
import os
import re
import shutil
import signal
import sys
import tempfile
import textwrap
import time
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .display import give_pictures
from .draw import style
from .draw.fields import draw_colour_bar
from .draw.fractures import draw_specimen, fracture_legend
from .draw.heated_sections import draw_temperature
from .draw.heating import THRUST_LABEL, TOTAL_STRAIN_LABEL
from .draw.progress import MINUTES_LABEL, Course, heating_course, loading_course
from .draw.records import leading, record_course, records_of
from .draw.style import save
from .draw.textplot import curve, plain_label
from .errors import Error
from .programs import complain, run_program, say
from .report import PAGE, write_page
from .stored.files import GapWarning, Lock, Writer, read_json
from .stored.frames import Frame
from .stored.heated import Heated
from .stored.results import GrowingResults, Results
from .stored.run_facts import BROKEN
from .texts import seen_on_a_line
from .writing import shell_path

PICTURE = Path("figures") / "watch.png"
"""The picture, within the run's folder."""

_NAME = "pyroclast watch"
_SIZE, _DPI = (9.0, 5.0), 110  # inches; dots per inch
_LOOK = 0.2  # s between two looks whether the run is over
_REFRESH = 1.0  # s between two drawings, at least
_SHARE = 0.2  # of a processor's time that goes into drawing, at most
_PICTURE_EVERY, _PAGE_EVERY = 5.0, 10.0  # s, at least
_FIRST_CURVE, _CURVE_AFTER = 10.0, 0.5  # s; of the time watched until the last curve, where curves follow one another
_CURVE_HEIGHT, _TERMINAL = 20, (80, 24)
_END_OF_LOG = 8192  # bytes
_NICENESS = 5
_REFUSED = (errno.EACCES, errno.EPERM, errno.EROFS)

give_pictures(Results)  # for the run of a Watch


@dataclass(frozen=True)
class _Curve:
    """What of a run is drawn over what: as its figures do."""

    course: Course
    values: np.ndarray  #: (n,) in `unit`
    label: str
    name: str
    unit: str  #: as it follows a number
    has_peak: bool = False  #: the largest value says something


def _record_curve(run: GrowingResults) -> _Curve:
    """Returns the curve of a body without platens."""
    course = heating_course(run) if Heated(run).is_last else record_course(run)
    record = leading(records_of(run))
    if record is None:
        return _Curve(course, course["unbalanced_ratio"], "Unbalanced ratio", "unbalanced ratio", "")
    return _Curve(course, record.of(run)[course.rows], record.title, record.name, f" {record.unit}", has_peak=True)


def _curve_of(run: GrowingResults) -> _Curve:
    hot = Heated(run)
    if not run.moves:
        rows = np.ones(run.history.rows, dtype=bool)
        course = Course(run, rows, run.history["heating_time_s"] / 60.0, MINUTES_LABEL, start=0.0)
        return _Curve(course, course["temperature_degC"], "Mean temperature [°C]", "mean temperature", " °C")
    if not run.has_platens:
        return _record_curve(run)
    if not hot.is_last:
        course = loading_course(run)
        return _Curve(course, course.stress, style.STRESS_LABEL, "stress", " MPa", has_peak=True)
    course = heating_course(run)
    if hot.restrained:
        return _Curve(course, course.stress, THRUST_LABEL, "stress", " MPa", has_peak=True)
    return _Curve(course, style.PER_MILLE * hot.total_strain, TOTAL_STRAIN_LABEL, "total strain", "·10⁻³")


class Watch:
    """A run as far as it has come; `update` reads on. Shows itself in a notebook.

    Raises Error when the folder holds no run.
    """

    def __init__(self, folder: str | Path, picture: str | Path | None = None):
        """Watches a run. picture: the file that `save` writes, its format by its ending; None: PICTURE there."""
        self.run = GrowingResults(folder)
        self.picture = Path(picture) if picture is not None else None
        self._lock = Lock(self.run.folder)
        self._seen: tuple | None = None
        if not self.is_running and not any((self.folder / name).exists() for name in ("history.csv", "manifest.json")):
            raise Error(f"{self.folder}: holds no run")
        self.update()

    @property
    def folder(self) -> Path:
        return self.run.folder

    @property
    def is_running(self) -> bool:
        """Whether a process is at work on the run."""
        return not self._is_over and self._lock.writer is Writer.THERE

    @property
    def _is_over(self) -> bool:
        """Whether the run came to an end of its own, or was stopped."""
        return (self.folder / "summary.json").exists()

    def update(self) -> bool:
        """Reads what the run wrote since; returns whether there is anything new to show. What cannot be read is taken
        as not yet written.
        """
        try:
            is_new = self.run.refresh()
            rows, frames = self.run.history.rows, len(self.run.frames)
        except Error:
            is_new, rows, frames = False, 0, 0
        seen = (self._state(), rows, frames)
        is_new = is_new or seen != self._seen
        self._seen = seen
        return is_new

    def headlines(self) -> list[str]:
        """Returns what the run is, how far it has come, and the latest numbers; a line each."""
        try:
            title = " ".join(self.run.title.split())
        except Error:
            title = self.folder.resolve().name
        try:
            numbers = ", ".join(self._numbers())
        except (Error, ValueError):
            numbers = ""
        return [line for line in (title, self._state(), numbers) if line]

    def _state(self) -> str:
        if self._is_over:
            try:
                outcome = str(read_json(self.folder / "summary.json").get("outcome", "over"))
            except Error:
                outcome = "over"
            return f"run ended: {outcome}"
        stage = self._stage()
        writer = self._lock.writer
        if writer is Writer.THERE:
            return stage or "begins"
        how = "run was killed" if writer is Writer.DIED else "run broke off"
        return f"{how}{f' in {stage}' if stage else ''}{self._way_on()}"

    def _way_on(self) -> str:
        """Returns why the run broke off, by its log, which says what helps; else how to go on from a checkpoint."""
        if error := re.search(r"^error: (.+)\Z", self._end_of_log(), re.MULTILINE | re.DOTALL):
            return ": " + "; ".join(error[1].split("\n")).rstrip("; ")
        if any((self.folder / "checkpoints").glob("*.state")):
            return f"; to go on: pyroclast resume {shell_path(self.folder)}"
        return "; it left no checkpoint: run its deck anew"

    def _stage(self) -> str:
        """Returns the number and kind of the stage, and what the log says of how far it is."""
        said = re.findall(r"^\d\d:\d\d:\d\d stage (\d+) of \d+ \((\w+)\) +(?:(\d+ %), +(\S[^,]*? left)?)?",
                          self._end_of_log(), re.MULTILINE)
        number, kind, share, left = said[-1] if said else ("", "", "", "")
        try:
            stages = self.run.deck_stages
            now = int(self.run.history["stage"][-1])
        except (Error, IndexError):
            return f"stage {number} ({kind})" if said else ""
        if str(now + 1) != number:
            share = left = ""
        kind = str(stages[now].get("kind", "")) if now < len(stages) else ""
        text = f"stage {now + 1}" + (f" of {len(stages)}" if stages else "") + (f" ({kind})" if kind else "")
        return ", ".join(filter(None, [text, share, left if self._lock.writer is Writer.THERE else ""]))

    def _end_of_log(self) -> str:
        try:
            with open(self.folder / "run.log", "rb") as file:
                file.seek(max(0, os.fstat(file.fileno()).st_size - _END_OF_LOG))
                return file.read().decode("utf-8", errors="replace")
        except OSError:
            return ""

    def _numbers(self) -> list[str]:
        drawn = _curve_of(self.run)
        parts = []
        known = drawn.values[np.isfinite(drawn.values)]
        if len(known) and self.run.moves:
            parts.append(f"{drawn.name} {known[-1]:.3g}{drawn.unit}")
            if drawn.has_peak:
                parts[-1] += f" (largest {known.max():.3g})"
        history = self.run.history
        if "temperature_degC" in history and np.isfinite(history["temperature_degC"]).any():
            row = int(np.flatnonzero(np.isfinite(history["temperature_degC"]))[-1])
            mean, low, high = (history[f"temperature_{name}degC"][row] for name in ("", "min_", "max_"))
            parts.append(f"{mean:.0f} °C" if Heated(self.run).uniform
                         else f"mean {mean:.0f} °C, {low:.0f} to {high:.0f} °C")
        broken = sum(history[column.name][-1] for column in self.run.facts.of_role(BROKEN))
        if np.isfinite(broken) and self.run.facts.crack_modes:
            parts.append(f"{broken:.0f} contact points broken")
        return parts

    @matplotlib.rc_context(style.STYLE)
    def draw(self, figure: Figure | None = None) -> Figure:
        """Draws curve and specimen, in place of what the figure held. Without one, makes it."""
        figure = figure or Figure(figsize=_SIZE, dpi=_DPI)
        figure.clear()
        title, *rest = map(style.plain, self.headlines())
        figure.suptitle("\n".join([title, *rest]), fontsize=9.0)
        grid = figure.add_gridspec(2, 2, width_ratios=[1.5, 1.0], height_ratios=[1.0, 0.13])
        axes, section, below = (figure.add_subplot(place) for place in (grid[0, 0], grid[0, 1], grid[1, :]))
        below.axis("off")
        try:
            frame = self.run.frames[-1] if self.run.frames else None
            self._draw_curve(axes, frame)
        except (Error, ValueError):
            _say_in(axes, "nothing to draw yet")
            frame = None
        try:
            self._draw_section(section, below, frame)
        except Error:
            _say_in(section, "the newest frame cannot be read")
        return style.thin(figure)

    def _draw_curve(self, axes: Axes, frame: Frame | None) -> None:
        drawn = _curve_of(self.run)
        over, values = drawn.course.over, drawn.values
        axes.plot(over, values, color=style.BLUE, linewidth=1.8)
        known = np.isfinite(over) & np.isfinite(values)
        axes.plot(over[known][-1:], values[known][-1:], "o", color=style.BLUE, markersize=5.0, label="now")
        if frame and frame.step:
            at = np.flatnonzero(known & (drawn.course["step"] == frame.step))[-1:]
            axes.plot(over[at], values[at], "o", color=style.VERMILLION, markerfacecolor="none", markersize=9.0,
                      linestyle="none", label="frame shown" if len(at) else None)
        if known.any() and over[known].max() > drawn.course.start:
            axes.set_xlim(left=drawn.course.start)
        axes.set_xlabel(drawn.course.label)
        axes.set_ylabel(drawn.label)
        if known.any() and values[known].min() >= 0.0 and values[known].max() > 0.0:
            axes.set_ylim(bottom=0.0)
        axes.legend(loc="best")

    def _draw_section(self, axes: Axes, below: Axes, frame: Frame | None) -> None:
        if frame is None:
            _say_in(axes, "no frame of the fields yet")
        elif not self.run.moves:
            colours = draw_temperature(axes, self.run, frame)
            draw_colour_bar([axes], colours)
            axes.set_title(f"mean {frame.temperature:.0f} °C")
        else:
            magnification = draw_specimen(axes, self.run, frame)
            axes.set_title(f"{self._place_of(frame)}displacements ×{magnification:g}", fontsize=8.0)
            handles = fracture_legend(self.run)
            style.legend_alone(below, handles, [handle.get_label() for handle in handles], loc="center", ncol=4)

    def _place_of(self, frame: Frame) -> str:
        """Returns at what state a frame was saved."""
        if frame.temperature is not None and np.isfinite(frame.temperature) and frame.heating_time:
            return f"{'' if Heated(self.run).uniform else 'mean '}{frame.temperature:.0f} °C, "
        if not np.isfinite(frame.strain):
            return ""
        return f"$\\varepsilon$ = {style.PER_MILLE * frame.strain:.2f}$\\times 10^{{-3}}$, "

    def text(self, columns: int, rows: int) -> list[str]:
        """Returns headlines and curve in plain characters, in at most so many columns and rows."""
        lines = [part for line in self.headlines() for part in textwrap.wrap(plain_label(line), columns)]
        try:
            drawn = _curve_of(self.run)
            size = (columns, max(rows - len(lines), 0))
            lines += curve(drawn.course.over, drawn.values, drawn.course.label, drawn.label, size)
        except (Error, ValueError):
            lines.append("nothing to draw yet")
        return [line[:columns] for line in lines[:rows]]

    def png(self) -> bytes:
        """Returns the picture."""
        return style.png(self.draw())

    def save(self) -> Path:
        """Writes the picture, whole or not at all. Returns its path: that which was asked for, or PICTURE in the folder,
        or where the folder may not be written a place of the user's own.
        """
        figure = self.draw()
        if self.picture is None:
            try:
                return save(figure, self.folder / PICTURE)
            except OSError as problem:
                if problem.errno not in _REFUSED:
                    raise
                self.picture = _own_place(self.folder)
        return save(figure, self.picture)

    def _repr_png_(self) -> bytes:
        return self.png()

    def _repr_html_(self) -> str:
        picture = base64.b64encode(self.png()).decode()
        told = html.escape("; ".join(self.headlines()), quote=True)
        return f'<img alt="{told}" src="data:image/png;base64,{picture}"/>'


def _own_place(folder: Path) -> Path:
    """Returns the place of a picture of a run whose folder is another's, or is on a disk that is only read."""
    try:
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:  # a user without a home
        cache = Path(tempfile.gettempdir()) / f"cache-{os.getuid()}"
    name = hashlib.sha256(str(folder.resolve()).encode()).hexdigest()[:12]
    return cache / "pyroclast" / "watch" / f"{folder.resolve().name}-{name}.png"


def _say_in(axes: Axes, text: str) -> None:
    axes.axis("off")
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color="#6a6a6a")


class _Kept:
    """A file that is written anew now and then, in a share of a processor's time. What hinders this is told once."""

    def __init__(self, what: str, every: float, write: Callable[[bool], None]):
        """Takes what writes. write: gets whether it is the last time."""
        self._what, self._every, self._write = what, every, write
        self._due, self._told = 0.0, False

    def keep(self, is_last: bool) -> None:
        """Writes the file where it is time."""
        if time.monotonic() < self._due and not is_last:
            return
        begun = time.process_time()
        try:
            self._write(is_last)
        except (Error, OSError) as problem:
            if not self._told:
                _tell(f"no {self._what}: {problem}")
            self._told = True
        self._due = time.monotonic() + max(self._every, (time.process_time() - begun) / _SHARE)


class _Nothing:
    """Shows nothing, but keeps the picture, and where it is asked for the page."""

    def __init__(self, watch: Watch, has_page: bool):
        self._watch, self._told = watch, False
        self._kept = [_Kept("picture", _PICTURE_EVERY, self._save_picture)]
        if has_page:
            self._kept.append(_Kept("page", _PAGE_EVERY, self._write_page))
            _tell(f"{watch.folder / PAGE} follows the run; open it in a browser")

    def show(self, is_last: bool) -> None:
        """Shows the run as it is."""
        for kept in self._kept:
            kept.keep(is_last)

    def _save_picture(self, _is_last: bool) -> None:
        asked = self._watch.picture
        file = self._watch.save()
        if file != asked and file != self._watch.folder / PICTURE and not self._told:
            _tell(f"{self._watch.folder} may not be written; the picture is {file}")
            self._told = True

    def _write_page(self, is_last: bool) -> None:
        write_page([self._watch.folder], reload_every=None if is_last else _PAGE_EVERY)


class _Lines(_Nothing):
    """Prints a curve now and then, each below the last and in one piece: others may print between two."""

    def __init__(self, watch: Watch, has_page: bool):
        super().__init__(watch, has_page)
        self._begun = time.monotonic()
        self._curve_due = self._begun + _FIRST_CURVE

    def show(self, is_last: bool) -> None:
        now = time.monotonic()
        if now >= self._curve_due or is_last:
            _print(["", *self._watch.text(shutil.get_terminal_size(_TERMINAL).columns - 1, _CURVE_HEIGHT), ""])
            self._curve_due = now + max(_FIRST_CURVE, _CURVE_AFTER * (now - self._begun))
        super().show(is_last)


class _Terminal(_Nothing):
    """Draws the curve anew where the last one stands. Nobody else may print there."""

    def __init__(self, watch: Watch, has_page: bool):
        super().__init__(watch, has_page)
        self._lines = 0
        signal.signal(signal.SIGTTOU, signal.SIG_IGN)  # beside a run it is in the background

    def show(self, is_last: bool) -> None:
        size = shutil.get_terminal_size(_TERMINAL)
        lines = self._watch.text(size.columns - 1, min(_CURVE_HEIGHT, size.lines - 1))
        back = f"\x1b[{self._lines}F\x1b[J" if self._lines else ""
        _print(lines, back)
        self._lines = len(lines)
        super().show(is_last)


_SCREENS = {"terminal": _Terminal, "lines": _Lines, "nothing": _Nothing}


def _screen(asked: str | None, has_page: bool | None, watch: Watch) -> _Nothing:
    """Chooses a screen. asked: one of _SCREENS; or what there is. has_page: None: where there is a display."""
    has_terminal = sys.stdout.isatty() and os.environ.get("TERM", "dumb") != "dumb"
    if asked is None or asked == "terminal" and not has_terminal:
        asked = "terminal" if has_terminal else "lines"
    if has_page is None:
        has_page = any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
    return _SCREENS[asked](watch, has_page)


def follow(watch: Watch, screen: _Nothing) -> None:
    """Shows the run until it is over."""
    is_new = True
    while True:
        begun = time.process_time()
        is_last = not watch.is_running
        is_new = watch.update() or is_new
        if is_new or is_last:
            screen.show(is_last)
        if is_last:
            return
        is_new = False
        due = time.monotonic() + max(_REFRESH, (time.process_time() - begun) / _SHARE)
        while watch.is_running and time.monotonic() < due:
            time.sleep(_LOOK)


def _once(watch: Watch) -> None:
    _print(watch.text(shutil.get_terminal_size(_TERMINAL).columns - 1, _CURVE_HEIGHT))
    asked = watch.picture
    try:
        file = watch.save()
        if file not in (asked, watch.folder / PICTURE):
            _tell(f"{watch.folder} may not be written; the picture is elsewhere:")
        say(file)
    except OSError as problem:
        if asked is not None or watch.picture is None:
            raise
        _tell(f"no picture: neither {watch.folder} nor a place of your own may be written; --out FILE says where")


def _print(lines: Sequence[str], before: str = "") -> None:
    """Prints a text in one piece, in the characters that the terminal has."""
    text = before + "".join(f"{seen_on_a_line(line)}\n" for line in lines)
    sys.stdout.flush()
    os.write(sys.stdout.fileno(), text.encode(sys.stdout.encoding or "ascii", errors="replace"))


def _tell(what: object) -> None:
    complain(what, _NAME)


def parser() -> argparse.ArgumentParser:
    """Reads the words behind `pyroclast watch`."""
    parser = argparse.ArgumentParser(prog="pyroclast watch",
                                     description="Shows a run while another process computes it.")
    parser.add_argument("folder", type=Path, metavar="RUN", help="folder of a run")
    parser.add_argument("--once", action="store_true", help="show the present state, and stop")
    parser.add_argument("--on", choices=_SCREENS,
                        help="the terminal, in place; lines, one curve below the other; or nothing "
                             f"but {PICTURE} in the folder (default: the first of these that works here)")
    parser.add_argument("--page", action=argparse.BooleanOptionalAction,
                        help=f"keep {PAGE} in the folder up to date, for a browser (default: where there is a display)")
    parser.add_argument("--out", type=Path, metavar="FILE",
                        help=f"file for the picture, instead of {PICTURE} in the folder (png, svg or pdf)")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit code."""
    return run_program(lambda: _show(arguments), _NAME)


def _show(arguments: Sequence[str] | None) -> int:
    options = parser()
    asked = options.parse_args(arguments)
    if asked.out is not None and asked.out.suffix.lower() not in (".png", ".svg", ".pdf"):
        options.error("--out: the file's ending must be .png, .svg or .pdf")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GapWarning)  # the figures tell of them
        watch = Watch(asked.folder, asked.out)
        if asked.once:
            _once(watch)
        else:
            os.nice(_NICENESS)
            follow(watch, _screen(asked.on, asked.page, watch))
    return 0


if __name__ == "__main__":
    sys.exit(main())
