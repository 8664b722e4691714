"""The package, installed by pip without a network: a wheel and an editable one, in environments of their own.

Both are of the build tree that PYROCLAST_BUILD names. Without it the first build takes as long as the library does; it
stays in build/ for the next one.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).parents[2]
SCRIPT = """
import pathlib, sys
import pyroclast
deck = pyroclast.Deck(sys.argv[1])
deck.update(blocks={"count": 60}, output={"fields": False})
deck["stages[0].duration"] = "1 min"
run = pyroclast.Run(deck).finish()
assert run.history["temperature"][-1] > 20.0
print(pathlib.Path(pyroclast.__file__).parent)
"""


class Installed(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def install(self, *options: str) -> pathlib.Path:
        environment = self.folder / "environment"
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", environment], check=True)
        nowhere = os.environ | {name: "http://127.0.0.1:9" for name in ("http_proxy", "https_proxy")}
        nowhere.pop("PYTHONPATH", None)
        done = subprocess.run([environment / "bin" / "pip", "install", "--no-index", *options, SOURCE], check=False,
                              capture_output=True, text=True, env=nowhere, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return environment

    def run_script(self, environment: pathlib.Path) -> pathlib.Path:
        (self.folder / "script.py").write_text(SCRIPT)
        own = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        done = subprocess.run([environment / "bin" / "python", "script.py", SOURCE / "cases" / "thermal_wall.toml"],
                              check=False, capture_output=True, text=True, env=own, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        return pathlib.Path(done.stdout.strip())

    def test_a_wheel_holds_package_program_and_headers(self):
        environment = self.install()
        self.assertIn(environment, self.run_script(environment).parents)
        program = environment / "bin" / "pyroclast"
        subprocess.run([program, "--version"], check=True, capture_output=True)
        figures = subprocess.run([program, "figures", "--help"], check=False, capture_output=True, text=True)
        self.assertEqual(figures.returncode, 0, figures.stderr)
        self.assertTrue((environment / "include" / "pyroclast" / "plugin" / "stamp.hpp").exists())
        subprocess.run([environment / "bin" / "pip", "uninstall", "-y", "pyroclast"], check=True, capture_output=True)
        self.assertFalse(program.exists())

    def test_an_editable_one_is_the_build_tree(self):
        self.assertIn(SOURCE / "build", self.run_script(self.install("-e")).parents)


if __name__ == "__main__":
    unittest.main()
