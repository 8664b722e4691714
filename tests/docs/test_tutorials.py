"""Promise: the commands of docs/learn run as they stand there, one page after the other, and print what the page shows.

PYROCLAST names the program.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LEARN = ROOT / "docs" / "learn"
_BLOCK = re.compile(r"^```(sh|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def pages() -> list[pathlib.Path]:
    """The tutorials, in the order of their list."""
    names = re.findall(r"^\| \d\. \[[^\]]*\]\(([\w-]+\.md)\)", (LEARN / "index.md").read_text(), re.MULTILINE)
    return [LEARN / name for name in names]


def has(printed: str, shown: str) -> bool:
    """Whether the output has the line, but for blanks and for as much as 2 % in its numbers."""
    wanted = _NUMBER.sub("0", " ".join(shown.split()))
    for line in printed.splitlines():
        if _NUMBER.sub("0", " ".join(line.split())) == wanted:
            pairs = zip(_NUMBER.findall(line), _NUMBER.findall(shown))
            if all(abs(float(a) - float(b)) <= 0.02 * abs(float(b)) for a, b in pairs):
                return True
    return False


class Tutorials(unittest.TestCase):
    def test_their_commands_run_and_print_what_the_pages_show(self):
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        program = pathlib.Path(os.environ["PYROCLAST"]).resolve()
        (folder / "bin").mkdir()
        (folder / "bin" / "python3").symlink_to(sys.executable)
        package = program.parents[1] / "python"
        environment = {**os.environ, "PATH": f"{program.parent}:{folder / 'bin'}:{os.environ['PATH']}",
                       "PYTHONPATH": f"{package}:{os.environ.get('PYTHONPATH', '')}",
                       "PYROCLAST_CACHE": str(folder / "cache"), "XDG_CONFIG_HOME": str(folder / "config"),
                       "XDG_DATA_HOME": str(folder / "data"), "XDG_STATE_HOME": str(folder / "state")}
        self.assertEqual(len(pages()), 6)
        for page in pages():
            printed = ""
            for kind, text in _BLOCK.findall(page.read_text("utf-8")):
                with self.subTest(page.name, block=text[:60]):
                    if kind == "sh":
                        done = subprocess.run(["bash", "-e", "-c", text], cwd=folder, env=environment, text=True,
                                              capture_output=True, timeout=600, check=False)
                        self.assertEqual(done.returncode, 0, done.stdout[-1000:] + done.stderr[-2000:])
                        self.assertNotIn("no figures were drawn", done.stderr)
                        printed += done.stdout + done.stderr
                    else:
                        for line in filter(lambda shown: shown.strip() not in ("", "..."), text.splitlines()):
                            self.assertTrue(has(printed, line), f"not printed: {line}\n{printed[-1500:]}")
        for promised in ("compare.png", "figures-mine/stress_strain.svg", "runs/wall/figures/temperature_history.png",
                         "runs/four/figures/seeds.png", "matters-study/report/report.html", "runs/soft/summary.json",
                         "runs/tail/summary.json"):
            self.assertTrue((folder / promised).exists(), promised)

    def test_another_number_is_told(self):
        printed = "  f_c 29.3 MPa at strain 0.0025\n"
        self.assertTrue(has(printed, "f_c 29.4 MPa at strain 0.0025"))
        self.assertFalse(has(printed, "f_c 31.3 MPa at strain 0.0025"))
        self.assertFalse(has(printed, "f_c 29.3 GPa at strain 0.0025"))


if __name__ == "__main__":
    unittest.main()
