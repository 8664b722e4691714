"""The reference that `pyroclast keys` prints has every key of the cases. PYROCLAST names the program."""

import os
import pathlib
import re
import subprocess
import tomllib
import unittest

ROOT = pathlib.Path(__file__).parents[2]
PROGRAM = os.environ["PYROCLAST"]
PAGE = subprocess.run([PROGRAM, "keys"], capture_output=True, text=True, check=True, encoding="utf-8").stdout
FORMS = re.compile(r"curve over the (?:time|temperature)")


def read_reference(page: str) -> dict[str, dict[str, str]]:
    """What each key of each table holds: {"specimen": {"width": "length", ...}, "": {"title": "text"}, ...}.

    The forms of curves stand under their names, in lower case.
    """
    tables: dict[str, dict[str, str]] = {}
    headings: list[str] = []
    for line in page.splitlines():
        if heading := re.match(r"## (.*)", line):
            names = [name.strip("`[]") for name in heading[1].split(", ")]
            headings = ["" if name == "At the top of the deck" else name for name in names]
            headings = [name.lower() if name.startswith("Curve") else name.replace("[]", "") for name in headings]
            for name in headings:
                tables.setdefault(name, {})
        elif row := re.match(r"\| `(\w+)` \| ([^|]*) \|", line):
            for name in headings:
                tables[name][row[1]] = row[2]
    return tables


def missing(tables: dict[str, dict[str, str]], name: str, values: dict) -> list[str]:
    """Full paths of keys that the table of this name does not have in the reference."""
    found = []
    for key, value in values.items():
        path = f"{name}.{key}" if name else key
        inner = value if isinstance(value, list) else [value]
        if all(isinstance(one, dict) for one in inner) and inner:
            forms = FORMS.search(tables.get(name, {}).get(key, ""))
            named = f"{name}.NAME"  # stands for tables of any name
            for one in inner:
                described = path if path in tables or named not in tables else named
                found += missing(tables, forms[0] if forms else described, one)
        elif key not in tables.get(name, {}):
            found.append(path)
    return found


class DeckReference(unittest.TestCase):
    maxDiff = None

    def test_has_every_key_of_every_case(self):
        tables = read_reference(PAGE)
        cases = sorted((ROOT / "cases").glob("*.toml"))
        self.assertTrue(cases)
        for case in cases:
            with self.subTest(case.name):
                self.assertEqual(missing(tables, "", tomllib.loads(case.read_text("utf-8"))), [])

    def test_a_key_that_no_deck_may_hold_is_found_missing(self):
        tables = read_reference(PAGE)
        deck = {"specimen": {"colour": 1, "width": "1 m"}, "stages": [{"kind": "settle", "tilt": 1}],
                "materials": {"mortar": {"E": {"value": "1 GPa", "with": 2}}}}
        self.assertEqual(missing(tables, "", deck),
                         ["specimen.colour", "stages.tilt", "curve over the temperature.with"])
