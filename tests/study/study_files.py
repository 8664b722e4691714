"""Small studies for the tests."""

import os
import pathlib
import sys
import tempfile
import textwrap
import unittest
from unittest import mock

from pyroclast.study.study import Study

CASES = pathlib.Path(__file__).parents[2] / "cases"
PROGRAM = os.environ["PYROCLAST"]
os.environ["PYROCLAST_CODE"] = "always"  # tests/app/test_code.py tries the others

MODEL = '''
import json, math, os, pathlib, sys, time

def line(seed, x=0.0, y=0.0):
    """Straight, with a scatter between seeds."""
    return {"z": 2.0 * x + y + 0.01 * seed}

def main(x, seed, folder, mode="plain"):
    folder = pathlib.Path(folder)
    count = folder.parent.parent / "made"
    with open(count, "a") as file:
        file.write(f"{x} {seed}\\n")
    if mode == "crash":
        print("error: the mortar is missing\\nwith mortar: the same again", file=sys.stderr)
        sys.exit(3)
    if mode == "formula":
        print('error: =HYPERLINK("x")', file=sys.stderr)
        sys.exit(3)
    if mode == "full" and not (folder.parent.parent / "room").exists():
        print("error: history.csv: cannot be written (No space left on device)\\nto go on: make room", file=sys.stderr)
        sys.exit(1)
    if mode == "slow":
        time.sleep(60.0)
    if mode == "brief":
        time.sleep(0.3)
    summary = {"outcome": "completed", "z": 2.0 * float(x) + 0.01 * int(seed), "stages": []}
    if mode == "restless":
        summary["outcome"], summary["outcome_id"] = "the body did not come to rest", "not_settled"
    if mode == "fast":
        summary["stages"] = [{"kind": "compress", "outcome": "completed", "results": {"quasi_static": False}}]
    if mode == "silent":
        del summary["z"]
    (folder / "summary.json").write_text(json.dumps(summary))

if __name__ == "__main__":
    main(*sys.argv[1:])
'''


class StudyTest(unittest.TestCase):
    """A folder of its own, with a model."""

    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        dots = mock.patch("pyroclast.draw.style.DPI", 40)  # quicker
        dots.start()
        self.addCleanup(dots.stop)
        self.folder = pathlib.Path(scratch.name)
        self.model = self.folder / "model.py"
        self.model.write_text(MODEL)

    def file(self, text: str, name: str = "study.toml") -> pathlib.Path:
        file = self.folder / name
        file.write_text(textwrap.dedent(text))
        return file

    def study(self, text: str, **options) -> Study:
        return Study(self.file(text), program=PROGRAM, **options)

    def of_function(self, method: str, parameters: str = "", study: str = "", rest: str = "") -> str:
        return f'''
[study]
runner = "function"
function = "model.py:line"
{study}
[method]
{method}
{parameters or """[parameters.x]
uniform = [0, 1]"""}
[outputs]
z = "z"
{rest}
'''

    def of_command(self, mode: str, method: str = 'kind = "lhs"\nsamples = 4', study: str = "") -> str:
        return f'''
[study]
runner = "command"
command = "{sys.executable} -S {self.model} {{x}} {{seed}} {{folder}} {mode}"
{study}
[method]
{method}
[parameters.x]
uniform = [0, 1]
[outputs]
z = "z"
'''

    def made(self, study: Study) -> list[str]:
        """What the command was called with."""
        file = study.setup.folder / "made"
        return file.read_text().splitlines() if file.exists() else []


def of_deck(method: str, parameters: str, study: str = "", outputs: str = 'f_c = "f_c_MPa"') -> str:
    """Of a compression test that takes about a second."""
    return f'''
[study]
deck = "{CASES / "compression.toml"}"
changes = {{ "blocks.count" = 60, "stages[compress].velocity" = "4 mm/s", "stages[compress].stop_strain" = 0.003 }}
{study}
[method]
{method}
{parameters}
[outputs]
{outputs}
'''
