"""docs/lookup/python-reference.md is what scripts/python-reference prints, and has every public name."""

import pathlib
import re
import subprocess
import sys
import unittest

import pyroclast
from pyroclast import units

ROOT = pathlib.Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "lookup" / "python-reference.md").read_text()


class Reference(unittest.TestCase):
    def test_the_page_is_that_of_the_docstrings(self):
        script = ROOT / "scripts" / "python-reference"
        printed = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True).stdout
        self.assertEqual(printed, PAGE, "scripts/python-reference > docs/lookup/python-reference.md")

    def test_every_public_name_is_on_it(self):
        for names in pyroclast._PLACES.values():
            for name in names:
                if name not in ("commit", "instruction_sets", "version") and not isinstance(getattr(pyroclast, name), units.Quantity):
                    self.assertRegex(PAGE, rf"(?m)^### {re.escape(name)}$")

    def test_its_lines_are_not_too_long(self):
        self.assertLessEqual(max(map(len, PAGE.splitlines())), 120)
