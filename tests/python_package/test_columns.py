"""What columns are is told by the program alone: Python and the scripts of pages know none of their names by parts."""

import ast
import os
import re
import subprocess
import unittest
from pathlib import Path

from pyroclast import _core

PACKAGE = Path(__file__).parents[2] / "python" / "pyroclast"
PARTS = ("dissipated_", "_damaged", "_broken", "_length_m", "_area_m2", "probe_", "energy_")


def listed() -> dict[str, str]:
    """The role of each column that `pyroclast list columns` prints, by its name."""
    printed = subprocess.run([os.environ["PYROCLAST"], "list", "columns"], capture_output=True, text=True, check=True)
    rows = [line.split() for line in printed.stdout.splitlines()]
    return {row[0]: next(word for word in row[1:] if word in ROLES) for row in rows}


ROLES = {role for _, _, _, _, role, *_ in _core.possible_columns()}


class Columns(unittest.TestCase):
    def test_each_has_a_unit_a_role_and_a_meaning(self):
        self.assertEqual(listed(), {name: role for name, _, _, _, role, *_ in _core.possible_columns()})
        for name, unit, _, meaning, role, *_ in _core.possible_columns():
            self.assertTrue(unit and meaning and role, name)

    def test_no_literal_of_python_or_of_a_script_is_the_name_of_an_energy(self):
        energies = {name for name, role in listed().items() if role.startswith(("energy.", "heat.")) and name.endswith("_J")}
        self.assertGreater(len(energies), 12)
        for path in PACKAGE.rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Constant) and isinstance(node.value, str):
                    self.assertNotIn(node.value, energies, path)
        for path in PACKAGE.rglob("*.js"):
            for name in energies:
                self.assertNotIn(name, path.read_text(encoding="utf-8"), path)

    def test_no_pattern_holds_a_part_of_the_name_of_a_column(self):
        for path in PACKAGE.rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                made = isinstance(node, ast.JoinedStr)
                asked = isinstance(node, ast.Call) and ast.unparse(node.func) in ("re.compile", "re.fullmatch",
                                                                                   "re.match", "re.search", "re.sub")
                if not made and not asked:
                    continue
                for part in ast.walk(node):
                    if isinstance(part, ast.Constant) and isinstance(part.value, str):
                        for known in PARTS:
                            self.assertNotIn(known, part.value, f"{path}:{node.lineno}")
        for path in PACKAGE.rglob("*.js"):
            for known in PARTS:
                for template in re.findall(r"`[^`]*`|/[^/\n]+/", path.read_text(encoding="utf-8")):
                    if "${" in template or template.startswith("/"):
                        self.assertNotIn(known, template, path)


if __name__ == "__main__":
    unittest.main()
