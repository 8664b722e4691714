"""A run is the same whether it is watched or not, and whatever becomes of who watches. PYROCLAST names the program."""

import contextlib
import os
import pathlib
import pty
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest

PROGRAM = os.environ["PYROCLAST"]
CASE = str(pathlib.Path(__file__).parents[2] / "cases/compression.toml")
SMALL = ["run", CASE, "--no-figures", "--set", "blocks.count=200", "--set", "stages[1].velocity=0.3 mm/s"]  # seconds
LONG = ["run", CASE, "--no-figures", "--set", "blocks.count=800", "--set", "stages[1].velocity=0.05 mm/s"]  # minutes
PICTURE = "figures/watch.png"
BACK = re.compile(r"\x1b\[\d+F\x1b\[J")  # to where the last curve began


class Terminal:
    """The program on a terminal of its own, as in a shell; `shown` is what it printed there."""

    def __init__(self, words: list[str], folder: pathlib.Path):
        reading, writing = pty.openpty()
        environment = {**os.environ, "DISPLAY": "", "TERM": "xterm", "COLUMNS": "80", "LINES": "30"}
        self.process = subprocess.Popen([PROGRAM, *words], cwd=folder, env=environment, stdout=writing,
                                        stderr=subprocess.STDOUT, start_new_session=True)
        os.close(writing)
        self.shown = ""
        self._reader = threading.Thread(target=self._read, args=(reading,))
        self._reader.start()

    def _read(self, descriptor: int) -> None:
        with contextlib.suppress(OSError):  # the other end is closed
            while chunk := os.read(descriptor, 4096):
                self.shown += chunk.decode()
        os.close(descriptor)

    def wait_for(self, text: str) -> None:
        for _ in range(6000):
            if text in self.shown:
                return
            time.sleep(0.1)
        raise AssertionError(f"{text!r} was never shown, but {self.shown!r}")

    def end(self) -> int:
        """The exit code, when all that was started has ended."""
        code = self.process.wait(timeout=600)
        self._reader.join(timeout=120)
        assert not self._reader.is_alive(), "something still has the terminal"
        return code


def children(process: int) -> list[int]:
    return [int(word) for word in pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]


class Watched(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.unwatched = cls.pyroclast(*SMALL, "--out", "unwatched")
        assert cls.unwatched.returncode == 0, cls.unwatched.stderr

    @classmethod
    def pyroclast(cls, *words: str, **changes: str) -> subprocess.CompletedProcess:
        return subprocess.run([PROGRAM, *words], cwd=cls.folder, env={**os.environ, "DISPLAY": "", **changes},
                              capture_output=True, text=True, timeout=600, check=False)

    def assert_same_results(self, name: str) -> None:
        for file in ("history.csv", "fields/frames.csv", "deck.toml"):
            with self.subTest(file):
                self.assertEqual((self.folder / name / file).read_bytes(),
                                 (self.folder / "unwatched" / file).read_bytes())

    def test_results_and_words_are_the_same(self):
        done = self.pyroclast(*SMALL, "--out", "watched", "--watch")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assert_same_results("watched")
        self.assertEqual((self.folder / "watched" / PICTURE).read_bytes()[-8:-4], b"IEND")
        self.assertIn("Axial stress, compression positive [MPa]", done.stdout)
        self.assertLess(done.stdout.index("run ended:"), done.stdout.index("\nended "))
        again = self.pyroclast(*SMALL, "--set", "stages[1].velocity=2 mm/s", "--out", "watched", "--watch", "--quiet",
                               "--overwrite")
        self.assertEqual((again.returncode, again.stdout, again.stderr), (0, "", ""))
        self.assertTrue((self.folder / "watched" / PICTURE).exists())

    def test_without_a_python_that_works_the_run_goes_on(self):
        done = self.pyroclast(*SMALL, "--out", "alone", "--watch", PYTHONHOME="/nowhere")
        self.assertEqual(done.returncode, 0)
        told = [line for line in done.stderr.splitlines() if line.startswith("warning")]
        self.assertEqual(len(told), 1, done.stderr)
        self.assertIn("the watcher ended (exit code 1); the run does not", told[0])
        self.assert_same_results("alone")

    def test_a_terminal_has_one_writer_at_a_time(self):
        terminal = Terminal([*SMALL, "--out", "terminal", "--watch"], self.folder)
        self.assertEqual(terminal.end(), 0)
        self.assert_same_results("terminal")
        before, *curves = BACK.split(terminal.shown)
        self.assertTrue(curves, terminal.shown)
        self.assertIn("mechanics       time step", before)
        for text in curves[:-1]:  # in place: each is all that is printed until the next
            self.assertRegex(text.splitlines()[-1], "^ *Axial strain|nothing to draw yet")
        last, ended = curves[-1].split("\r\nended ")
        self.assertIn("run ended:", last)
        self.assertIn("stage 2", ended)
        progress = re.compile(r"^\d\d:\d\d:\d\d stage", re.MULTILINE)
        self.assertNotRegex(terminal.shown, progress)
        self.assertRegex((self.folder / "terminal/run.log").read_text(), progress)

    def test_who_watches_may_die(self):
        terminal = Terminal([*LONG, "--out", "left", "--watch"], self.folder)
        terminal.wait_for("Axial stress")
        watcher, = children(terminal.process.pid)
        os.kill(watcher, signal.SIGKILL)
        terminal.wait_for("the watcher ended (signal 9)")
        os.kill(terminal.process.pid, 0)
        terminal.wait_for("(compress)  ")  # progress is told on the terminal again
        os.killpg(terminal.process.pid, signal.SIGINT)
        self.assertEqual(terminal.end(), 130)

    def test_ctrl_c_stops_the_run_which_is_shown_a_last_time_and_resumed(self):
        terminal = Terminal([*LONG, "--out", "stopped", "--watch"], self.folder)
        terminal.wait_for("Axial stress")
        os.killpg(terminal.process.pid, signal.SIGINT)
        self.assertEqual(terminal.end(), 130)
        last, ended = BACK.split(terminal.shown)[-1].split("\r\nended ")
        self.assertIn("run ended: stopped", last)
        self.assertIn("to go on        pyroclast resume stopped", ended)
        terminal = Terminal(["resume", "stopped", "--no-figures", "--watch"], self.folder)
        terminal.wait_for("stage 2 of 2 (compress)")
        terminal.process.kill()
        terminal.end()  # who watches ends by itself
        self.assertIn("run was killed in stage 2", BACK.split(terminal.shown)[-1])
        shown = self.pyroclast("watch", "stopped", "--once")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        self.assertIn("run was killed in stage 2", shown.stdout)
        self.assertEqual(self.pyroclast("watch", "nowhere").returncode, 1)


if __name__ == "__main__":
    unittest.main()
