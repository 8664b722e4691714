"""Promise: docs/lookup/fields.md lists what the library's one list of fields has, in its words."""

import pathlib
import re
import unittest

from pyroclast import _core

ROOT = pathlib.Path(__file__).resolve().parents[2]
_MESH = {"block", "material", "bearing", "interface", "length [m]", "area [m2]", "block_a", "block_b", "face"}


class Docs(unittest.TestCase):
    def test_the_tables_are_those_of_the_list(self):
        text = (ROOT / "docs/lookup/fields.md").read_text()
        tables = [re.findall(r"^\| `([^`]+)` \| (points|cells) \| (.*) \|$", table, re.MULTILINE)
                  for table in text.split("\n| array |")[1:]]
        self.assertEqual(len(tables), 3)
        for items, table in zip((("gridpoint", "zone"), ("contact_end", "contact"), ("found",)), tables):
            listed = [(f"{name} [{unit}]", "points" if item in ("gridpoint", "contact_end") else "cells", meaning)
                      for name, unit, item, _, meaning, in_files in _core.possible_fields()
                      if in_files and item in items]
            of_mesh = _MESH - {name for name, *_ in listed}
            told = [row for row in table if row[0] not in of_mesh]
            self.assertEqual(sorted(told), sorted(listed))


if __name__ == "__main__":
    unittest.main()
