"""The examples, at small size: they run, and their types fit the stubs."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
PACKAGE = pathlib.Path(os.environ["PYTHONPATH"].split(":")[0])
CONFIGURATION = EXAMPLES.parents[1] / "pyproject.toml"
BOUND = ("Body", "DeckText", "Session", "Specimen", "Table", "TomlFile")
BLOCKS = "120"
COMPILES = ("own_law",)  # takes a minute where nothing is cached


class Examples(unittest.TestCase):
    def test_each_runs_and_its_assertion_holds(self):
        for script in sorted(EXAMPLES.glob("*.py")):
            if script.stem in COMPILES:
                continue
            with self.subTest(script.stem), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([sys.executable, script, BLOCKS], capture_output=True, text=True, check=False,
                                      timeout=300, cwd=folder)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                self.assertTrue(done.stdout)

    def test_each_has_thirty_lines_at_most(self):
        for script in EXAMPLES.glob("*.py"):
            self.assertLessEqual(len(script.read_text().splitlines()), 30, script.name)

    def test_strict_types_hold(self):
        # not PYTHONPATH, or the package itself would go unread as an installed one
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        environment["MYPYPATH"] = str(PACKAGE)
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--config-file", CONFIGURATION,
                               "--cache-dir", os.devnull, *sorted(EXAMPLES.glob("*.py"))],
                              capture_output=True, text=True, check=False, env=environment)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_stub_of_the_compiled_part_is_what_it_has(self):
        with tempfile.TemporaryDirectory() as folder:
            # mypy reads the stub and its imports; with the package it would read all of it
            stubs = pathlib.Path(folder) / "pyroclast"
            stubs.mkdir()
            (stubs / "__init__.pyi").touch()
            for name in ("_core.pyi", "errors.py"):
                shutil.copy(PACKAGE / "pyroclast" / name, stubs)
            # the classes of pybind11 have a metaclass of theirs, and take anything where they cannot be made
            allowed = pathlib.Path(folder) / "allowed.txt"
            allowed.write_text("".join(f"pyroclast._core.{name}\npyroclast._core.{name}.__init__\n" for name in BOUND))
            done = subprocess.run([sys.executable, "-m", "mypy.stubtest", "pyroclast._core", "--ignore-missing-stub",
                                   "--ignore-unused-allowlist", "--allowlist", allowed],
                                  capture_output=True, text=True, check=False,
                                  env=os.environ | {"MYPYPATH": folder}, cwd=folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


class Figures(unittest.TestCase):
    def test_figures_do_not_need_the_compiled_part(self):
        code = ("import sys; sys.modules['pyroclast._core'] = None\n"
                "import pyroclast.figures, pyroclast.stored.results\n"
                "try:\n    import pyroclast; pyroclast.Deck\nexcept ImportError: print('no core')")
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.strip(), "no core")
