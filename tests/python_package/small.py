"""Small decks of the cases, for tests that run them."""

import pathlib
import shutil
import tempfile
import unittest

import pyroclast

CASES = pathlib.Path(__file__).parents[2] / "cases"
COMPRESSED = {"blocks.count": 120, "stages[1].stop_strain": 0.0004, "output.fields": False}


def deck(case="starter", **more) -> pyroclast.Deck:
    """A case with few blocks; more: other keys, with __ for a point."""
    made = pyroclast.Deck(CASES / f"{case}.toml")
    for key, value in ({**COMPRESSED} if case == "starter" else {}).items():
        made[key] = value
    for key, value in more.items():
        made[key.replace("__", ".")] = value
    return made


class Case(unittest.TestCase):
    def folder(self) -> pathlib.Path:
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        return folder
