"""All manifests state the same version, and the change log tells of it with its date."""

import pathlib
import re
import tomllib
import unittest

ROOT = pathlib.Path(__file__).parents[2]


def found(pattern: str, file: str) -> str:
    match = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert match, f"{file}: nothing matches {pattern}"
    return match[1]


class Versions(unittest.TestCase):
    def test_are_the_same_everywhere(self):
        version = found(r"^project\(pyroclast VERSION (\S+)", "CMakeLists.txt")
        self.assertEqual(tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"], version)
        self.assertEqual(found(r"^version: (\S+)$", "CITATION.cff"), version)
        self.assertEqual(found(r"^## (\d\S*) \(\d{4}-\d\d-\d\d\)$", "CHANGELOG.md"), version)

    def test_the_release_has_one_date(self):
        self.assertEqual(found(r"^date-released: (\S+)$", "CITATION.cff"), found(r"^## \d\S* \((\S+)\)$", "CHANGELOG.md"))


if __name__ == "__main__":
    unittest.main()
