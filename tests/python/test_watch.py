"""What is shown of a run while another process writes it; that process is played by this one.

    SMALL_FORMS=build/strict/small_forms python3 -m unittest discover -s tests/python -p test_watch.py
"""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from contextlib import contextmanager
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1] / "python"
sys.path[:0] = [str(HERE), str(PACKAGE)]

import small_forms  # noqa: E402
from test_figures import png_size  # noqa: E402
from pyroclast.draw import style  # noqa: E402
from pyroclast.draw.textplot import curve  # noqa: E402
from pyroclast.errors import Error  # noqa: E402
from pyroclast.stored.files import GrowingTable, Lock, Writer  # noqa: E402
from pyroclast.stored.heated import Heated  # noqa: E402
from pyroclast.stored.results import Results  # noqa: E402
from pyroclast.watch import PICTURE, Watch  # noqa: E402

def environment(**changes: str) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(PACKAGE), "DISPLAY": "", "WAYLAND_DISPLAY": "", **changes}


class WatchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.whole = small_forms.copy("starter", Path(temporary.name) / "whole")
        (cls.whole / "run.log").unlink()
        cls.rows = (cls.whole / "history.csv").read_text().splitlines(keepends=True)

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name)
        self.folder = self.root / "run"

    def begin(self, rows: int) -> None:
        """A run that has come to so many rows, and is not over."""
        shutil.copytree(self.whole, self.folder)
        (self.folder / "summary.json").unlink()
        (self.folder / "history.csv").write_text("".join(self.rows[:rows + 1]))

    def add(self, text: str) -> None:
        with open(self.folder / "history.csv", "a", encoding="utf-8") as file:
            file.write(text)

    def end(self) -> None:
        """Whole or not at all, as the program writes it."""
        shutil.copy(self.whole / "summary.json", self.folder / "aside")
        (self.folder / "aside").rename(self.folder / "summary.json")

    @contextmanager
    def writer(self):
        """Holds the folder as the program does."""
        self.folder.mkdir(exist_ok=True)
        with open(self.folder / "lock", "w", encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.write(f"{os.getpid()}\n")
            file.flush()
            yield

    def command(self, *words, **changes) -> subprocess.CompletedProcess:
        return subprocess.run([sys.executable, "-m", "pyroclast.watch", *map(str, words)], env=environment(**changes),
                              capture_output=True, text=True, timeout=60, check=False)

    def refused(self, *words) -> str:
        """The one line that it ends with."""
        done = self.command(*words)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr


class Reading(WatchTest):
    def test_rows_come_as_they_are_whole(self):
        self.begin(rows=100)
        table = GrowingTable(self.folder / "history.csv")
        self.assertEqual(table.rows, 100)
        self.assertFalse(table.grow())
        half = self.rows[101][:-5]  # all cells, but the last number is not all there
        self.add(half)
        self.assertFalse(table.grow())
        self.add(self.rows[101][len(half):] + self.rows[102])
        self.assertTrue(table.grow())
        self.assertEqual(table.rows, 102)
        whole = Results(self.whole).history
        for name in table.names:
            np.testing.assert_array_equal(table[name], whole[name][:102])

    def test_a_history_that_is_cut_off_or_begun_anew_is_read_anew(self):
        self.begin(rows=100)
        with self.writer():
            watch = Watch(self.folder)
            (self.folder / "history.csv").write_text("".join(self.rows[:41]))
            self.assertTrue(watch.update())
            self.assertEqual(watch.run.history.rows, 40)
            (self.folder / "aside").write_text("".join(self.rows[:201]))
            (self.folder / "aside").rename(self.folder / "history.csv")
            self.assertTrue(watch.update())
            self.assertEqual(watch.run.history.rows, 200)

    def test_update_tells_whether_there_is_anything_new(self):
        self.begin(rows=100)
        with self.writer():
            watch = Watch(self.folder)
            self.assertFalse(watch.update())
            self.add(self.rows[101][:20])
            self.assertFalse(watch.update())
            self.add(self.rows[101][20:])
            self.assertTrue(watch.update())
            self.assertTrue(watch.is_running)
            self.end()
            self.assertTrue(watch.update())
            self.assertFalse(watch.is_running)
            self.assertFalse(watch.update())

    def test_a_run_without_fields_is_new_only_when_it_grows(self):
        self.begin(rows=100)
        shutil.rmtree(self.folder / "fields")
        with self.writer():
            watch = Watch(self.folder)
            self.assertFalse(watch.update())
            self.add(self.rows[101])
            self.assertTrue(watch.update())
            self.assertEqual(watch.draw().axes[1].texts[0].get_text(), "no frame of the fields yet")

    def test_looking_at_a_lock_keeps_nobody_from_taking_it(self):
        self.folder.mkdir()
        lock = Lock(self.folder)
        self.assertIs(lock.writer, Writer.NONE)
        (self.folder / "lock").touch()  # about to be taken
        self.assertIs(lock.writer, Writer.THERE)
        with self.writer():
            self.assertIs(lock.writer, Writer.THERE)
        self.assertIs(lock.writer, Writer.DIED)
        with open(self.folder / "lock", "rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)  # raises when the look still holds it
            self.assertIs(lock.writer, Writer.DIED, "a file that was free is not tried again before it changes")

    def test_the_deck_tells_what_a_run_without_summary_does_not(self):
        small_forms.copy("restrained_heating", self.folder)
        self.assertTrue(Heated(Results(self.folder)).restrained)
        (self.folder / "summary.json").unlink()
        stages = '[[stages]]\nkind = "settle"\n[[stages]]\nkind = "load"\n[[stages]]\nkind = "heat"\nplaten = '
        (self.folder / "deck.toml").write_text(f'title = "Of the deck"\n{stages}"fixed"\n')
        self.assertTrue(Heated(Results(self.folder)).restrained)
        self.assertEqual(Results(self.folder).title, "Of the deck")
        (self.folder / "deck.toml").write_text(f'{stages}"force"\n')
        self.assertFalse(Heated(Results(self.folder)).restrained)


class Told(WatchTest):
    """Headlines."""

    def test_stage_and_progress(self):
        self.begin(rows=100)
        (self.folder / "run.log").write_text(
            "model           100 zones\n"
            "10:00:00 stage 1 of 2 (settle)   3 %,                 strain 0.0\n"
            "10:00:05 stage 2 of 2 (compress)  38 %,      1 min 2 s left  strain 0.00123  stress  20.00 MPa\n")
        with self.writer():
            title, stage, numbers = Watch(self.folder).headlines()
        self.assertEqual(title, Results(self.whole).title)
        self.assertEqual(stage, "stage 2 of 2 (compress), 38 %, 1 min 2 s left")
        last = Results(self.whole).history["stress_MPa"][99]
        self.assertIn(f"stress {last:.3g} MPa", numbers)

    def test_what_the_log_said_of_an_earlier_stage_is_not_said_of_this_one(self):
        self.begin(rows=100)
        (self.folder / "run.log").write_text("10:00:00 stage 1 of 2 (settle)  97 %,       2 s left  strain 0.0\n")
        with self.writer():
            self.assertEqual(Watch(self.folder).headlines()[1], "stage 2 of 2 (compress)")

    def test_before_the_first_row(self):
        with self.writer():
            watch = Watch(self.folder)
            self.assertTrue(watch.is_running)
            self.assertIn("nothing to draw yet", "\n".join(watch.text(79, 20)))
            self.assertGreater(len(watch.png()), 1000)
            self.begin_in_place()
            self.assertTrue(watch.update())
            self.assertNotIn("nothing to draw yet", "\n".join(watch.text(79, 20)))

    def begin_in_place(self) -> None:
        shutil.copytree(self.whole, self.folder, ignore=shutil.ignore_patterns("summary.json"), dirs_exist_ok=True)

    def test_ends(self):
        self.begin(rows=100)
        with self.writer():
            watch = Watch(self.folder)
        self.assertIn("run was killed in stage 2 of 2 (compress); it left no checkpoint", watch.headlines()[1])
        (self.folder / "checkpoints").mkdir()
        (self.folder / "checkpoints/000001.state").touch()
        self.assertIn("run was killed in stage 2 of 2 (compress); to go on: pyroclast resume", watch.headlines()[1])
        (self.folder / "lock").unlink()
        self.assertIn("run broke off in stage 2", watch.headlines()[1])
        with open(self.folder / "run.log", "a") as log:
            log.write("error: too hot\nchange the deck\n")
        self.assertEqual(watch.headlines()[1], "run broke off in stage 2 of 2 (compress): too hot; change the deck")
        (self.folder / "summary.json").write_text(json.dumps({"outcome": "stopped by the user", "stages": []}))
        self.assertEqual(watch.headlines()[1], "run ended: stopped by the user")


class Drawn(WatchTest):
    def test_each_kind_of_run_is_drawn_over_what_its_figures_are(self):
        records = {"cmod": "opening", "load": "force"}
        for form, kept, over, values in (
            ("starter", None, "Axial strain", "Axial stress"),
            ("anderberg_thelandersson", None, "Temperature", "Total axial strain"),
            ("fire_one_side", None, "Time of heating", "Total axial strain"),
            ("restrained_heating", None, "Temperature", "Axial stress"),
            ("hot_strength", None, "Axial strain", "Axial stress"),
            ("thermal_wall", None, "Time of heating", "Mean temperature"),
            ("notched_beam", records, "cmod, opening [mm]", "load, force [kN]"),
            ("notched_beam", ["cmod"], "cmod, opening [mm]", "cmod, opening [mm]"),
            ("notched_beam", [], "Time [s]", "Unbalanced ratio"),
        ):
            with self.subTest(over + values):
                shutil.rmtree(self.folder, ignore_errors=True)
                small_forms.copy(form, self.folder)
                if kept is not None:
                    (self.folder / "deck.toml").write_text("".join(
                        f'[[record]]\nname = "{name}"\nkind = "{records[name]}"\n' for name in kept))
                watch = Watch(self.folder)
                axes, section, *_ = watch.draw().axes
                self.assertTrue(axes.get_xlabel().startswith(over), axes.get_xlabel())
                self.assertTrue(axes.get_ylabel().startswith(values), axes.get_ylabel())
                self.assertGreater(len(axes.lines[0].get_xdata()), 10)
                self.assertGreater(len(section.collections), 1)
                text = watch.text(79, 20)
                self.assertTrue(all(line.isascii() and len(line) <= 79 for line in text), text)
                self.assertLessEqual(len(text), 20)
                self.assertIn("o", "".join(text[4:-3]))

    def test_the_specimen_is_that_of_the_newest_frame_that_is_there(self):
        self.begin(rows=100)
        frames = (self.folder / "fields" / "frames.csv").read_text().splitlines(keepends=True)
        (self.folder / "fields" / "frames.csv").write_text("".join(frames[:6]) + frames[6][:-4])
        with self.writer():
            watch = Watch(self.folder)
            strain = 1e3 * Results(self.whole).frames[4].strain
            self.assertIn(f"{strain:.2f}", watch.draw().axes[1].get_title())
            (self.folder / "fields" / "frames.csv").write_text("".join(frames[:7]))
            self.assertTrue(watch.update())
            self.assertIn(f"{1e3 * Results(self.whole).frames[5].strain:.2f}", watch.draw().axes[1].get_title())
            (self.folder / "fields" / "contacts_0005.hdf").write_bytes(b"half a file")
            self.assertEqual(watch.draw().axes[1].texts[0].get_text(), "the newest frame cannot be read")

    def test_a_notebook_gets_picture_and_words(self):
        watch = Watch(self.whole)
        self.assertTrue(watch._repr_png_().startswith(b"\x89PNG"))
        begin = rf'^<img alt="{Results(self.whole).title}; run ended: [^"]*" src="data:image/png;base64,'
        self.assertRegex(watch._repr_html_(), begin)

    def test_watching_needs_no_compiled_module(self):
        self.assertNotIn("pyroclast._core", sys.modules)


class Text(unittest.TestCase):
    def places(self, lines: list[str], character: str) -> list[tuple[int, int]]:
        """Columns and rows from below, of the picture alone."""
        rows = [re.split("[|+]", line, maxsplit=1)[1] for line in lines[1:-3]]
        return [(column, row) for row, line in enumerate(reversed(rows)) for column, mark in enumerate(line)
                if mark == character]

    def test_a_curve_goes_through_its_points_and_ends_with_the_last(self):
        lines = curve(np.array([0.0, 1.0, 2.0]), np.array([0.0, 40.0, 10.0]), "x [mm]", "y [MPa]", (70, 20))
        self.assertEqual(len(lines), 20)
        rows = 16
        last, = self.places(lines, "o")
        self.assertLessEqual(abs(last[1] - 0.25 * (rows - 1)), 1)
        self.assertEqual(max(row for mark in ".-':" for _, row in self.places(lines, mark)), rows - 1)
        self.assertEqual(lines[0], "y [MPa]")
        self.assertTrue(lines[-1].endswith("x [mm]"))
        ticks = [word for line in lines for word in re.findall(r"^ *(\d+) \+", line)]
        self.assertEqual(ticks, ["40", "30", "20", "10", "0"])

    def test_what_has_no_extent_is_drawn_too(self):
        for x, y in (([], []), ([1.0], [5.0]), ([0.0, 0.0], [0.0, 0.0]), ([1.0, 2.0], [np.nan, np.nan]),
                     ([0.0, 1e-9], [-3e9, 2e-12]), ([1.0, np.nan, 3.0], [1.0, 2.0, -1.0])):
            with self.subTest(x=x, y=y):
                lines = curve(np.array(x), np.array(y), "x", "y", (50, 12))
                self.assertEqual(len(lines), 12)
                self.assertTrue(all(len(line) <= 50 for line in lines))

    def test_a_gap_stays_one(self):
        x = np.arange(9.0)
        y = np.where((x > 2.0) & (x < 6.0), np.nan, 1.0 + x)
        columns = {column for mark in ".-':" for column, _ in self.places(curve(x, y, "x", "y", (60, 14)), mark)}
        self.assertFalse(columns & set(range(16, 40)))


class Command(WatchTest):
    def test_once(self):
        self.begin(rows=100)
        with self.writer():
            done = self.command(self.folder, "--once", COLUMNS="60")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("stage 2 of 2 (compress)", done.stdout)
        self.assertIn("Axial stress, compression positive [MPa]", done.stdout)
        self.assertTrue(all(len(line) < 60 for line in done.stdout.splitlines()[:-1]))
        width, height = png_size(self.folder / PICTURE)
        self.assertGreater(min(width, height), 400)
        self.assertEqual([path.name for path in (self.folder / "figures").iterdir()], ["watch.png"])

    def test_what_is_no_run_is_refused_in_a_line(self):
        self.assertIn("is not a folder", self.refused(self.root / "nowhere"))
        self.folder.mkdir()
        with self.assertRaisesRegex(Error, "holds no run"):
            Watch(self.folder)
        (self.folder / "notes.txt").write_text("mine")
        self.assertIn("holds no run", self.refused(self.folder))

    def test_a_killed_run_is_shown_and_said_to_be(self):
        self.begin(rows=100)
        with self.writer():
            pass
        done = self.command(self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("run was killed in stage 2", done.stdout)
        png_size(self.folder / PICTURE)

    def test_it_follows_a_run_to_its_end_and_no_picture_is_ever_half_there(self):
        self.begin(rows=60)
        reading, writing = pty.openpty()
        words = [sys.executable, "-m", "pyroclast.watch", str(self.folder)]
        shell = environment(TERM="xterm", COLUMNS="70", LINES="24")
        with self.writer(), subprocess.Popen(words, stdout=writing, env=shell) as process:
            os.close(writing)
            pictures = set()
            self.wait_for(self.folder / PICTURE)
            for row in range(61, len(self.rows)):
                self.add(self.rows[row])
                time.sleep(0.02)
                if (self.folder / PICTURE).exists():
                    picture = (self.folder / PICTURE).read_bytes()
                    self.assertEqual(picture[-8:-4], b"IEND")
                    pictures.add(picture)
            self.end()
            shown = b""
            while chunk := self.read(reading):
                shown += chunk
            self.assertEqual(process.wait(timeout=120), 0)
        os.close(reading)
        text = shown.decode()
        self.assertGreaterEqual(text.count("Axial stress"), 2)
        self.assertRegex(text, r"\x1b\[20F\x1b\[J")  # back to where the last one began
        self.assertIn("run ended: the stress fell", text.split("\x1b[J")[-1])
        self.assertTrue(pictures)
        self.assertNotIn((self.folder / PICTURE).read_bytes(), pictures)  # the last one is of the whole run

    def wait_for(self, file: Path):
        """A busy machine may take long to start a watcher."""
        end = time.monotonic() + 120.0
        while not file.exists():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    @staticmethod
    def read(descriptor: int) -> bytes:
        try:
            return os.read(descriptor, 1 << 16)
        except OSError:  # the other end is closed
            return b""

    def test_no_page_without_a_display_or_where_it_is_not_wanted(self):
        self.begin(rows=100)
        for words, display in (((), ""), (("--no-page",), ":7")):
            self.assertEqual(self.command(self.folder, *words, DISPLAY=display).stderr, "")
            self.assertFalse((self.folder / "report.html").exists())


class Readers(WatchTest):
    """Several at once, and those who may not write."""

    def test_three_at_once(self):
        self.begin(rows=100)
        with self.writer():
            all_of_them = [subprocess.Popen([sys.executable, "-m", "pyroclast.watch", str(self.folder), "--once"],
                                            env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                            text=True)
                           for _ in range(3)]
            for process in all_of_them:
                said, wrong = process.communicate(timeout=300)
                self.assertEqual((process.returncode, wrong), (0, ""))
                self.assertEqual(said.splitlines()[-1], str(self.folder / PICTURE))
        self.assertEqual([file.name for file in (self.folder / "figures").iterdir()], ["watch.png"])
        self.assertGreater(png_size(self.folder / PICTURE)[0], 100)

    def as_reader(self, home: Path, module: str, *words) -> subprocess.CompletedProcess:
        """By a user who may not write into the run's folder."""
        for place in (self.root, self.folder, *self.folder.rglob("*")):
            place.chmod(0o555 if place.is_dir() else 0o444)
        self.addCleanup(lambda: [place.chmod(0o755) for place in (self.root, self.folder, *self.folder.rglob("*"))])
        own = {"user": 65534, "group": 65534, "extra_groups": []} if os.getuid() == 0 else {}
        home.chmod(0o777)
        return subprocess.run([sys.executable, "-m", f"pyroclast.{module}", *map(str, words)],
                              env=environment(HOME=str(home), XDG_CACHE_HOME="", MPLCONFIGDIR=str(home / "mpl")),
                              capture_output=True, text=True, timeout=120, check=False, **own)

    def home(self) -> Path:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        return Path(temporary.name)

    def test_who_may_not_write_watches_and_has_the_picture_elsewhere(self):
        self.begin(rows=100)
        before = sorted(self.folder.rglob("*"))
        home = self.home()
        done = self.as_reader(home, "watch", self.folder, "--once")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Axial strain", done.stdout)
        self.assertIn(f"{self.folder} may not be written; the picture is elsewhere", done.stderr)
        picture = Path(done.stdout.splitlines()[-1])
        self.assertTrue(picture.is_relative_to(home), picture)
        self.assertGreater(png_size(picture)[0], 100)
        done = self.as_reader(home, "watch", self.folder, "--once", "--out", home / "mine.svg")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue((home / "mine.svg").exists())
        done = self.as_reader(home, "watch", self.folder, "--on", "nothing")  # nobody writes, so it ends at once
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("may not be written; the picture is", done.stderr)
        self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_who_may_write_nowhere_is_told_in_a_sentence(self):
        self.begin(rows=100)
        home = self.home()
        (home / ".cache").write_text("no folder")
        done = self.as_reader(home, "watch", self.folder, "--once")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no picture: neither", done.stderr)

    def test_who_may_not_write_draws_elsewhere(self):
        shutil.copytree(self.whole, self.folder)
        before = sorted(self.folder.rglob("*"))
        home = self.home()
        done = self.as_reader(home, "figures", "run", self.folder, "--out", home / "drawn")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(file.name for file in (home / "drawn").iterdir()),
                         ["cracks.png", "energy.png", "fracture.csv", "fracture.png", "stress_strain.png"])
        self.assertEqual(sorted(self.folder.rglob("*")), before)


class Long(WatchTest):
    """A history of very many rows."""

    ROWS = int(os.environ.get("PYROCLAST_ROWS", "200000"))

    def setUp(self):
        super().setUp()
        shutil.copytree(self.whole, self.folder)
        header, *rows = self.rows
        cells = np.genfromtxt(rows, delimiter=",")
        names = header.strip().split(",")
        places = np.linspace(0, len(rows) - 1, self.ROWS)
        columns = [np.interp(places, np.arange(len(rows)), column) for column in cells.T]
        for name in ("stage", "exchange"):
            if name in names:
                columns[names.index(name)] = np.round(columns[names.index(name)])
        columns[names.index("step")] = np.arange(self.ROWS)
        with open(self.folder / "history.csv", "w", encoding="utf-8") as file:
            file.write(header)
            for first in range(0, self.ROWS, 10000):
                np.savetxt(file, np.column_stack([column[first:first + 10000] for column in columns]), "%.12g", ",")

    def used(self, module: str, *words) -> tuple[float, float]:
        """Processor time, s, and the most memory, MB."""
        program = ("import resource, runpy, sys\nsys.argv = sys.argv[1:]\n"
                   "try:\n    runpy.run_module(sys.argv[0], run_name='__main__', alter_sys=False)\n"
                   "except SystemExit as end:\n    assert not end.code, end.code\n"
                   "used = resource.getrusage(resource.RUSAGE_SELF)\n"
                   "print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3)\n")
        done = subprocess.run([sys.executable, "-c", program, f"pyroclast.{module}", *map(str, words)],
                              env=environment(), capture_output=True, text=True, timeout=600, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        seconds, megabytes = map(float, done.stdout.splitlines()[-1].split())
        return seconds, megabytes

    def test_its_rows_cost_little_more_than_to_read_them(self):
        """The rows' own time is compared with that of NumPy's reader (in C) of this moment: 2.4 to 3.2 times that."""
        def commands(folder):
            return ("watch", folder, "--once"), ("figures", "run", folder, "--out", self.root / "drawn")

        begun = time.process_time()
        np.loadtxt(self.folder / "history.csv", delimiter=",", skiprows=1)
        reading = time.process_time() - begun
        for long, short in zip(commands(self.folder), commands(self.whole), strict=True):
            with self.subTest(long[0]):
                base, _ = self.used(*short)
                seconds, megabytes = self.used(*long)
                self.assertLess(seconds - base, 8.0 * reading)
                self.assertLess(megabytes, 300.0 + 700.0 * self.ROWS / 1e6)  # without the compiled part


class Thinned(unittest.TestCase):
    def test_what_is_left_of_a_line_has_its_extremes_and_gaps(self):
        random = np.random.default_rng(1)
        x = np.arange(300_000.0)
        y = random.normal(size=len(x)).cumsum()
        y[123_456], y[200_000], y[250_000:250_100] = 1e6, -1e6, np.nan
        for thin_x, thin_y in (style.thinned(x, y), style.thinned(x, y, 1000)):
            self.assertLess(len(thin_x), 21_000)
            self.assertEqual((np.nanmin(thin_y), np.nanmax(thin_y)), (-1e6, 1e6))
            self.assertEqual((thin_x[0], thin_x[-1]), (x[0], x[-1]))
            self.assertTrue(np.isnan(thin_y).any())
            self.assertTrue((np.diff(thin_x) > 0.0).all())
        short = x[:100], y[:100]
        np.testing.assert_array_equal(style.thinned(*short), short)


if __name__ == "__main__":
    unittest.main()
