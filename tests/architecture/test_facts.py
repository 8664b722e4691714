"""Facts that pages state and code or tables know: modules, versions of tables, and counts that soon are false."""

import csv
import pathlib
import re
import unittest

from test_includes import MODULES

ROOT = pathlib.Path(__file__).parents[2]
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
# What became of changes to the code, which no physics version tells.
_NO_RESULTS = {"mutations.d"}
_NUMBER = (r"(?:\d[\d,. ]*|two|three|four|five|six|seven|eight|nine|ten|eleven|twelve|(?:thir|four|fif|six|seven|eigh|nine)teen|"
           r"(?:twenty|thirty|forty|fifty)(?:-\w+)?)")


def tables() -> list[pathlib.Path]:
    """Committed tables of validation results."""
    return [path for path in sorted((ROOT / "validation").rglob("*.csv")) if not _NO_RESULTS & set(path.parts)]


def versions(table: pathlib.Path) -> set[str]:
    """Texts that a table has for the physics versions of its rows; "none" is a row that no run made."""
    with open(table, newline="", encoding="utf-8") as file:
        return {row.get("physics_version") or "" for row in csv.DictReader(file)} - {"none"}


def named(text: str) -> set[str]:
    """Numbers that a page names as physics versions."""
    said = r"\b(?:physics versions?|versions|(?:of|by|from) version) (\d+(?:(?:, | and | or | to )\d+)*)"
    found = re.findall(said, " ".join(text.split()))
    return {number for numbers in found for number in re.findall(r"\d+", numbers)}


def lines_with(pattern: str) -> list[str]:
    return [f"{page.relative_to(ROOT)}: {found[0]}" for page in PAGES
            for found in re.finditer(pattern, page.read_text(encoding="utf-8"), flags=re.IGNORECASE)]


class Modules(unittest.TestCase):
    def test_the_table_of_modules_is_the_list_that_includes_are_held_to(self):
        text = (ROOT / "docs/develop/architecture.md").read_text(encoding="utf-8")
        table = text.split("| module |")[1].split("\n\n")[0]
        self.assertEqual(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE), MODULES)


class Tests(unittest.TestCase):
    def test_their_page_has_each_folder_and_each_label(self):
        text = (ROOT / "tests/README.md").read_text(encoding="utf-8")
        kinds, folders = (re.findall(r"^\| (`.*?) \|", table, re.MULTILINE) for table in re.split(r"\|(?:---\|)+\n", text)[1:])
        told = {name for row in folders for name in re.findall(r"`(\w+)`", row)}
        self.assertEqual(told, {path.name for path in (ROOT / "tests").iterdir() if path.is_dir()} - {"__pycache__"})
        lists = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("CMakeLists.txt"))
        labels = {label for found in re.findall(r'LABELS\s+"([^"$]*)"', lists) for label in found.split(";")}
        of_folders = {label for row in re.findall(r"^\| `.*?\| (`.*?) \|", text, re.MULTILINE)
                      for label in re.findall(r"`(\w+)`", row)}
        of_kinds = {name.strip("`") for name in kinds}
        self.assertLessEqual(labels, told | of_folders | of_kinds)


class Tables(unittest.TestCase):
    def test_each_row_of_results_has_its_physics_version(self):
        for table in tables():
            with self.subTest(table.name):
                for version in versions(table):
                    self.assertRegex(version, r"^(before )?\d+(( and | or )\d+)*$")

    def test_a_page_names_the_physics_versions_of_the_tables_that_it_shows(self):
        shown = 0
        for page in (ROOT / "docs").rglob("*.md"):
            text = page.read_text(encoding="utf-8")
            for table in tables():
                if not re.search(rf"validation/(studies/)?{re.escape(table.name)}\b", text):
                    continue
                shown += 1
                with self.subTest(page=page.name, table=table.name):
                    wanted = {number for version in versions(table) for number in re.findall(r"\d+", version)}
                    self.assertLessEqual(wanted, named(text))
        self.assertGreater(shown, 20)


class Counts(unittest.TestCase):
    def test_no_page_counts_the_cases(self):
        self.assertEqual(lines_with(rf"\b(?:all|the) {_NUMBER} (?:shipped |committed )?cases\b"), [])

    def test_no_page_counts_lines_of_code(self):
        self.assertEqual(lines_with(rf"\b{_NUMBER}k? lines (?:of|executed)\b|\b(?:is|are|has|have) {_NUMBER}k? lines\b"), [])


class ObjectsOfTheMesh(unittest.TestCase):
    def test_are_the_same_for_both_readers_of_frames(self):
        def names(file: str, begin: str, end: str) -> set[str]:
            text = (ROOT / file).read_text(encoding="utf-8")
            return set(re.findall(r'"(\w+)"', text[text.index(begin):].partition(end)[0]))

        program = names("src/pyroclast/setup/hdf5_reader.cpp", "kInMesh[]", "};")
        self.assertGreater(len(program), 10)
        self.assertEqual(program, names("python/pyroclast/stored/files.py", "_IN_MESH = ", "))"))


if __name__ == "__main__":
    unittest.main()
