"""Every case in its small form: a run of the package writes what the program writes, byte by byte."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import tomllib
import unittest

import pyroclast

PROGRAM = os.environ["PYROCLAST"]
ROOT = pathlib.Path(__file__).parents[2]
SMALL = tomllib.loads((ROOT / "validation" / "reference.toml").read_text())["small"]


def results(folder: pathlib.Path) -> dict[str, bytes]:
    """Contents of what must be the same, by name."""
    files = [folder / "history.csv", folder / "deck.toml"]
    files += [path for name in ("fields", "specimen") if (folder / name).is_dir() for path in (folder / name).iterdir()]
    summary = json.loads((folder / "summary.json").read_text())
    del summary["wall_time_s"]
    return {str(file.relative_to(folder)): file.read_bytes() for file in files} | {
        "summary.json": json.dumps(summary).encode()}


class Cases(unittest.TestCase):
    def test_history_and_fields_are_those_of_the_program(self):
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        for case, changes in SMALL.items():
            with self.subTest(case):
                file = ROOT / "cases" / f"{case}.toml"
                program, script = folder / f"{case}-program", folder / f"{case}-script"
                words = [word for change in changes for word in ("--set", change)]
                # bodies this small gain nothing by more threads
                beside = subprocess.Popen([PROGRAM, "run", file, "--out", program, "--no-figures", "--quiet",
                                           "--threads", "1", *words])
                deck = pyroclast.Deck(file)
                for change in changes:
                    key, value = change.split("=", 1)
                    deck[key.strip()] = tomllib.loads(f"v = {value}")["v"] if _is_toml(value) else value.strip()
                pyroclast.Run(deck, out=script, threads=1).finish()
                beside.wait()
                of_program, of_script = results(program), results(script)
                self.assertEqual(of_program.keys(), of_script.keys())
                for name, contents in of_program.items():
                    self.assertEqual(contents == of_script[name], True, name)


def _is_toml(value: str) -> bool:
    try:
        tomllib.loads(f"v = {value}")
    except tomllib.TOMLDecodeError:
        return False
    return True
