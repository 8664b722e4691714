"""Cases in their small forms: a run of the package writes what the program writes, byte by byte.

SMALL_FORMS names the folder of runs that `validation/reference check --keep FOLDER` left.
"""

import json
import os
import pathlib
import shutil
import tempfile
import tomllib
import unittest

import pyroclast
from pyroclast.study.outputs import unit_of_name

OF_THE_PROGRAM = pathlib.Path(os.environ["SMALL_FORMS"])
ROOT = pathlib.Path(__file__).parents[2]
SMALL = tomllib.loads((ROOT / "validation" / "reference.toml").read_text())["small"]
# Cases whose keys and words stand in others too.
ALIKE = {"anderberg_thelandersson", "biaxial_3d", "brazilian", "compression", "compression_3d", "cube_3d", "disc_3d",
         "fire_long", "fire_one_side", "hot_compression", "hot_strength", "hot_strength_3d",
         "residual_capacity", "spalling_slab_3d", "starter", "thermal_wall", "transient_heating_3d"}
_NAMES = {"title", "name", "set", "other", "faces", "side", "near", "record", "direction", "hold", "symmetry",
          "contacts", "within"}  # what these say is of one deck


def keys_and_words(value, key: str = "", last: str = "") -> set[str]:
    """Keys of a deck with their tables, and with the words that they may have."""
    if isinstance(value, dict):
        return set().union(*(keys_and_words(one, f"{key}.{name}", name) for name, one in value.items()))
    if isinstance(value, list):
        return set().union(*(keys_and_words(one, f"{key}[]", last) for one in value))
    has_word = isinstance(value, str) and last not in _NAMES and not any(letter.isdigit() for letter in value)
    return {f"{key} = {value}" if has_word else key}


def results(folder: pathlib.Path) -> dict[str, bytes]:
    """Contents of what must be the same, by name."""
    files = [folder / "history.csv", folder / "deck.toml"]
    files += [path for name in ("fields", "specimen") if (folder / name).is_dir() for path in (folder / name).iterdir()]
    summary = json.loads((folder / "summary.json").read_text())
    del summary["wall_time_s"]
    return {str(file.relative_to(folder)): file.read_bytes() for file in files} | {
        "summary.json": json.dumps(summary).encode()}


class Cases(unittest.TestCase):
    def test_those_that_are_not_run_say_nothing_that_no_other_says(self):
        said = {case: keys_and_words(tomllib.loads((ROOT / "cases" / f"{case}.toml").read_text())) for case in SMALL}
        run = set().union(*(said[case] for case in SMALL.keys() - ALIKE))
        for case in ALIKE:
            self.assertEqual({word for word in said[case] - run if not word.startswith((".title", ".output"))}, set(), case)

    def test_history_and_fields_are_those_of_the_program(self):
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        for case in sorted(SMALL.keys() - ALIKE):
            with self.subTest(case):
                file = ROOT / "cases" / f"{case}.toml"
                script = folder / case
                deck = pyroclast.Deck(file)
                for change in SMALL[case]:
                    key, value = change.split("=", 1)
                    deck[key.strip()] = tomllib.loads(f"v = {value}")["v"] if _is_toml(value) else value.strip()
                # bodies this small gain nothing by more threads
                pyroclast.Run(deck, out=script, threads=1).finish()
                of_program, of_script = results(OF_THE_PROGRAM / case), results(script)
                self.assertEqual(of_program.keys(), of_script.keys())
                for name, contents in of_program.items():
                    self.assertEqual(contents == of_script[name], True, name)


class Units(unittest.TestCase):
    def test_the_name_of_a_column_or_result_ends_on_its_unit(self):
        """A study counts in the unit on which the name of an output ends."""
        for file in OF_THE_PROGRAM.glob("*/run.json"):
            facts = json.loads(file.read_text())
            units = {column["name"]: column["unit"] for column in facts["columns"]}
            self.assertEqual(pyroclast.read(file.parent).history.units, units)
            for told in facts["columns"] + facts["results"]:
                if told["unit"]:  # a text has none
                    self.assertEqual(unit_of_name(told["name"]), told["unit"], told["name"])


def _is_toml(value: str) -> bool:
    try:
        tomllib.loads(f"v = {value}")
    except tomllib.TOMLDecodeError:
        return False
    return True
