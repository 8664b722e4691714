"""The schema that editors read takes every deck that the readers take, and refuses what it can see as they do.

PYROCLAST_DECKS: how many random decks and how many with one fault are tried (default 250). PYROCLAST
names the program.
"""

import collections
import copy
import json
import os
import pathlib
import random
import re
import subprocess
import tomllib
import unittest
from collections.abc import Iterator
from typing import Any

import jsonschema
from pyroclast import Error, _core

PROGRAM = os.environ["PYROCLAST"]
ROOT = pathlib.Path(__file__).parents[2]
DECKS = int(os.environ.get("PYROCLAST_DECKS", "250"))
SCHEMA = json.loads(subprocess.run([PROGRAM, "keys", "--schema"], capture_output=True, check=True).stdout)
KEYS = json.loads(subprocess.run([PROGRAM, "keys", "--json"], capture_output=True, check=True).stdout)
EDITOR = jsonschema.Draft4Validator(SCHEMA)
FILES = sorted((ROOT / "cases").glob("*.toml")) + sorted((ROOT / "tests/fuzz/seeds/deck/taken").glob("*.toml"))
TABLES = {table["path"]: table for table in KEYS["tables"]}
UNITS = {  # some of each kind, with what a number in SI is multiplied with
    "length": {"m": 1, "mm": 1e3, "cm": 1e2, "inch": 1 / 0.0254, "km": 1e-3}, "area": {"m2": 1, "cm2": 1e4, "mm²": 1e6},
    "stress": {"Pa": 1, "MPa": 1e-6, "N/mm2": 1e-6, "kN/m2": 1e-3, "psi": 1 / 6894.757293168361},
    "time": {"s": 1, "ms": 1e3, "min": 1 / 60, "h": 1 / 3600}, "velocity": {"m/s": 1, "mm/s": 1e3, "m s-1": 1},
    "force": {"N": 1, "kN": 1e-3, "lbf": 1 / 4.4482216152605}, "density": {"kg/m3": 1, "t/m3": 1e-3, "g cm-3": 1e-3},
    "angle": {"deg": 57.29577951308232, "rad": 1}, "fracture energy": {"J/m2": 1, "N/m": 1, "N/mm": 1e-3},
    "thermal conductivity": {"W/m/K": 1, "W/(m K)": 1, "kW m-1 K-1": 1e-3}, "specific heat": {"J/kg/K": 1, "kJ/(kg K)": 1e-3},
    "contact stiffness": {"Pa/m": 1, "GPa/m": 1e-9, "N/mm3": 1e-9}, "temperature difference": {"K": 1, "mK": 1e3},
    "heating rate": {"K/s": 1, "K/min": 60, "K/h": 3600}, "thermal expansion coefficient": {"1/K": 1, "um/m/K": 1e6}}
OTHER_UNITS = ("mm", "kg", "MPa", "kN", "s", "1/s", "W/m/K", "J/kg/K", "kg/m3", "degC", "GPa/m", "N/m", "m2", "deg", "K/min", "%")


def refusal(deck: dict[str, Any], folder: pathlib.Path) -> str:
    """What the readers say of a deck; empty if they take it."""
    text = "\n".join(f"{json.dumps(key)} = {written(value)}" for key, value in deck.items())
    try:
        _core.resolve(_core.DeckText(text, "deck.toml", str(folder), [], [], [], True, True))
    except Error as error:
        return str(error)
    return ""


def written(value: Any) -> str:
    """A value as TOML has it."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {written(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return json.dumps(value, ensure_ascii=False) if not isinstance(value, float) else repr(value)


def tables_of(deck: dict[str, Any], path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Each table of a deck that the readers describe, with its path there."""
    if path in TABLES:
        yield path, deck
    for key, value in deck.items():
        inner = f"{path}.{key}" if path else key
        if isinstance(value, dict):
            named = inner if inner in TABLES or f"{path}.NAME" not in TABLES else f"{path}.NAME"
            yield from tables_of(value, named)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for one in value:
                yield from tables_of(one, inner + "[]")


def places_of(deck: dict[str, Any]) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Each value that the readers describe: its table, and what is known of its key."""
    return [(table, key) for path, table in tables_of(deck) for key in TABLES[path]["keys"] if key["key"] in table]


def quantity(draw: random.Random, kind: str, value: float) -> Any:
    if kind == "dimensionless number":
        return draw.choice([value, f"{100 * value!r} %", f"{value!r}"])
    if kind == "temperature":
        return draw.choice([f"{value!r} degC", f"{value + 273.15!r} K", f"{1.8 * value + 32!r} degF"])
    unit, factor = draw.choice(list(UNITS.get(kind, {SI[kind]: 1}).items()))
    return draw.choice([f"{value * factor!r} {unit}", f"{value * factor:.3e} {unit}", f"{value * factor!r}{unit}"])


SI = {kind: key["unit"] for table in KEYS["tables"] for key in table["keys"] for kind in key["kinds"]}


def drawn_value(draw: random.Random, key: dict[str, Any]) -> Any:
    """A value that is perhaps taken."""
    if key["words"]:
        return json.loads(draw.choice([w["word"] for w in key["words"] if w["word"].startswith('"')]))
    if key["form"] == "flag":
        return draw.choice([True, False])
    low, high = (key["range"][end] for end in ("lower", "upper"))
    usual = key["range"]["usual_lower"], key["range"]["usual_upper"]
    low = usual[0] if usual[0] is not None else low if low is not None else 0.0
    high = usual[1] if usual[1] is not None else high if high is not None else max(2.0 * low, 1.0)
    value = draw.uniform(low, min(high, low + 1e4))
    if key["form"] == "integer":
        return round(value)
    if key["form"] == "quantity":
        one = quantity(draw, key["kinds"][0], value)
        return [one] if key["is_list"] else one
    return "a text"


def change(draw: random.Random, deck: dict[str, Any]) -> None:
    """Leaves a key out, puts another value to it, or adds a key that may stand in its table."""
    path, table = draw.choice(list(tables_of(deck)))
    keys = TABLES[path]["keys"]
    here = [key for key in keys if key["key"] in table]
    what = draw.random()
    if here and what < 0.6:
        key = draw.choice(here)
        if not isinstance(table[key["key"]], (dict, list)):
            table[key["key"]] = drawn_value(draw, key)
    elif here and what < 0.8:
        del table[draw.choice(here)["key"]]
    elif keys:
        key = draw.choice(keys)
        table[key["key"]] = drawn_value(draw, key)


def unknown_key(draw: random.Random, deck: dict[str, Any]) -> str:
    path, table = draw.choice(list(tables_of(deck)))
    known = [key["key"] for key in TABLES[path]["keys"]]
    name = draw.choice(["colour", "f_tt", "x1", (draw.choice(known) if known else "a") + "_"])
    if name not in known:
        table[name] = draw.choice([1, "2 mm", True])
    return f"{path}.{name}"


def wrong_type(draw: random.Random, deck: dict[str, Any]) -> str:
    table, key = draw.choice(places_of(deck))
    wrong = {"text": [1, True, ["a"]], "word": [1, True, "no such word"], "word or text": [1, False],
             "flag": [1, "yes", "true"], "integer": [1.5, "7", True], "quantity": [True, "many", [["1"]], {}],
             "place": [1, "left", [1]], "place in space": [1, "left", True], "points": [1, "a", [[1]]]}
    if key["form"] in wrong and not (key["forms"] and isinstance(table[key["key"]], dict)):
        table[key["key"]] = draw.choice(wrong[key["form"]])
    return f"{key['key']} = {table[key['key']]!r}"


def is_of_kind(unit: str, kinds: list[str]) -> bool:
    """Whether a unit is one of those that a key takes; a value that only a law refuses is no fault of the unit."""
    for kind in kinds:
        try:
            _core.convert(f"1 {unit}", SI[kind])
        except Error:
            continue
        return True
    return False


def other_unit(draw: random.Random, deck: dict[str, Any]) -> str:
    table, key = draw.choice(places_of(deck))
    value = table[key["key"]]
    if key["form"] == "quantity" and isinstance(value, str):
        number = re.match(r"[-+0-9.eE]*", value)
        unit = draw.choice(OTHER_UNITS)
        if not is_of_kind(unit, key["kinds"]):
            table[key["key"]] = f"{number[0]} {unit}"
    return f"{key['key']} = {table[key['key']]!r}"


def out_of_range(draw: random.Random, deck: dict[str, Any]) -> str:
    table, key = draw.choice(places_of(deck))
    low, high = key["range"]["lower"], key["range"]["upper"]
    ends = [-2.0 * abs(low) - 3.0] if low is not None else []
    ends += [0.0] if low == 0.0 and not key["range"]["lower_inclusive"] else []
    ends += [2.0 * abs(high) + 3.0] if high is not None else []
    if ends and not isinstance(table[key["key"]], (dict, list)):
        value = draw.choice(ends)
        if key["form"] == "quantity":
            table[key["key"]] = quantity(draw, key["kinds"][0], value)
        elif key["form"] == "integer":
            table[key["key"]] = round(value)
    return f"{key['key']} = {table[key['key']]!r}"


def missing_key(draw: random.Random, deck: dict[str, Any]) -> str:
    path, table = draw.choice(list(tables_of(deck)))
    key = draw.choice(list(table)) if table else ""
    table.pop(key, None)
    return f"without {path}.{key}"


FAULTS = (unknown_key, wrong_type, other_unit, out_of_range, missing_key)
# Faults that the readers alone can see (docs/do/editors.md).
READERS_ALONE = re.compile(r"""
    missing_key:\ without\ (materials|contacts)\.\w+$            # tables that the deck names
    | missing_key:\ without\ \.materials$                         # ... and their table
    | missing_key:\ without\ \.(record|platens|output|superposition|aggregates|bearings|sets|heat|coupling|inclusions)$  # for others
    | missing_key:\ without\ materials\.\w+\.(conductivity|specific_heat)$  # needed by what another stage does
    | missing_key:\ without\ specimen\.depth$                    # thickness is the other
    | missing_key:\ without\ concrete\.thermal_strain$          # expansion is the other
    | missing_key:\ without\ stages\[\]\.drives\[\]\.\w+$
    | wrong_type:\ (hold|release)\ =                            # components, which a body in the plane has fewer of
    | wrong_type:\ between_stones\ =                            # names, which must be of phases of the deck
    | other_unit:\ (above|below)\ =                              # the kind is that of a record
    | out_of_range:\ .*\d[eE][-+]?\d                             # a number with an exponent
    """, re.VERBOSE)


class EditorSchema(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls) -> None:
        cls.taken = []
        for file in FILES:
            deck = tomllib.loads(file.read_text("utf-8-sig"))
            if refused := refusal(deck, file.parent):
                raise AssertionError(f"{file}: {refused}")
            cls.taken.append((file, deck))

    def test_is_a_schema_of_draft_4(self) -> None:
        jsonschema.Draft4Validator.check_schema(SCHEMA)

    def assert_takes(self, deck: dict[str, Any], what: object) -> None:
        errors = [f"{list(error.absolute_path)}: {error.message[:200]}" for error in EDITOR.iter_errors(deck)]
        self.assertEqual(errors, [], what)

    def test_takes_the_cases(self) -> None:
        for file, deck in self.taken:
            with self.subTest(file.name):
                self.assert_takes(deck, file.name)

    def test_takes_random_decks_that_the_readers_take(self) -> None:
        draw = random.Random(1)
        count = 0
        while count < DECKS:
            file, deck = draw.choice(self.taken)
            deck = copy.deepcopy(deck)
            for _ in range(draw.randint(1, 4)):
                change(draw, deck)
            if not refusal(deck, file.parent):
                count += 1
                self.assert_takes(deck, written(deck))

    def test_refuses_one_fault_as_the_readers_do(self) -> None:
        draw = random.Random(2)
        missed = []
        tried: collections.Counter[str] = collections.Counter()
        while sum(tried.values()) < DECKS:
            fault = FAULTS[sum(tried.values()) % len(FAULTS)]
            file, deck = draw.choice(self.taken)
            deck = copy.deepcopy(deck)
            told = fault(draw, deck)
            if not refusal(deck, file.parent):
                continue
            tried[fault.__name__] += 1
            if EDITOR.is_valid(deck):
                missed.append(f"{fault.__name__}: {told}")
        self.assertEqual([fault for fault in missed if not READERS_ALONE.match(fault)], [], tried)
        self.assertLess(len(missed), 0.05 * DECKS)


if __name__ == "__main__":
    unittest.main()
