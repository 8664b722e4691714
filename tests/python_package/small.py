"""Small decks of the cases, for tests that run them."""

import os
import pathlib
import shutil
import tempfile
import unittest

import pyroclast

PROGRAM = os.environ["PYROCLAST"]
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


def plate(**tables) -> pyroclast.Deck:
    """A plate of 40 blocks of mortar without weight, by keyword arguments alone: its left side is held, its right one
    pulled. tables: in the place of others.
    """
    starter = deck()
    mechanics = starter["mechanics"] | {"gravity": "0 m/s2", "time_step": "1 us"}
    contacts = {key: starter["contacts"][key] for key in ("t_b", "t_b_scaling", "t_b_block_size", "mortar_mortar")}
    pull = {"name": "pull", "kind": "force", "set": "right", "direction": "x"}
    return pyroclast.Deck(**{
        "title": "plate", "specimen": {"width": "60 mm", "height": "40 mm", "thickness": "0.1 m", "seed": 1},
        "blocks": {"count": 40, "shortest_edge": 0.2}, "materials": {"mortar": starter["materials.mortar"]},
        "contacts": contacts, "mechanics": mechanics, "output": {"fields": False},
        "record": [pull, {"name": "across", "kind": "stress", "set": "specimen", "direction": "x"}],
        "stages": [{"kind": "drive", "duration": "6 ms", "look_interval": "0.5 ms",
                    "drives": [{"set": "left", "hold": ["x", "y"]},
                               {"set": "right", "velocity": "1 mm/s", "direction": "x", "ramp_time": "2 ms"}]}],
        **tables})


class Case(unittest.TestCase):
    def folder(self) -> pathlib.Path:
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        return folder
