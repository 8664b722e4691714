"""Promise: what a page links is there, down to the heading; so is every page that a file of the tree names.

Pages are those that scripts/docs gives to Sphinx, with what the program prints. PYROCLAST names the program.
"""

import pathlib
import re
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
_BLOCK = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)
_LINK = re.compile(r"\]\(([^)\s#]*)(?:#([^)\s]*))?\)")
_NAMED = re.compile(r"(?<![\w/.-])docs/[\w/-]+\.md\b")
_HISTORY = "CHANGELOG.md"  # tells of pages as they were called


def tracked() -> list[pathlib.Path]:
    """The files of the tree; in an unpacked source without its history all that are there."""
    told = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    names = told.stdout.splitlines() if told.returncode == 0 else [path.relative_to(ROOT) for path in ROOT.rglob("*")]
    return [ROOT / name for name in names if (ROOT / name).is_file()]


def slug(heading: str) -> str:
    """The anchor of a heading, as the site and the forge make it."""
    shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", shown.strip().lower()).replace(" ", "-")


def anchors(page: pathlib.Path) -> set[str]:
    text = _BLOCK.sub("", page.read_text("utf-8"))
    return {slug(heading) for heading in re.findall(r"^#{1,6} (.+)$", text, re.MULTILINE)}


def dead(page: pathlib.Path) -> list[str]:
    """Links of a page that lead nowhere."""
    found = []
    for target, anchor in _LINK.findall(_BLOCK.sub("", page.read_text("utf-8"))):
        if "://" in target or target.startswith("mailto:"):
            continue
        file = page if not target else (page.parent / target)
        if not file.exists() or anchor and file.suffix == ".md" and anchor not in anchors(file):
            found.append(f"{target}#{anchor}" if anchor else target)
    return found


class Links(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        cls.addClassCleanup(folder.cleanup)
        cls.tree = pathlib.Path(folder.name)
        subprocess.run([ROOT / "scripts" / "docs", "--pages", cls.tree], check=True)

    def test_every_link_of_a_page_leads_somewhere(self):
        pages = [*(self.tree / "docs").rglob("*.md"), *self.tree.glob("*.md")]
        self.assertGreater(len(pages), 100)
        for page in pages:
            with self.subTest(page.relative_to(self.tree)):
                self.assertEqual(dead(page), [])

    def test_every_page_that_a_file_names_is_there(self):
        for path in tracked():
            if path.name == _HISTORY or path.suffix in (".png", ".svg"):
                continue
            try:
                text = path.read_text("utf-8")
            except UnicodeDecodeError:
                continue
            for name in set(_NAMED.findall(text)):
                with self.subTest(f"{path.relative_to(ROOT)}: {name}"):
                    self.assertTrue((self.tree / name).exists())

    def test_a_dead_link_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text("# Made up\n[a](nowhere.md) [b](#made-up) [c](#down) [d](page.md#down) [e](https://a.b)\n")
            self.assertEqual(dead(page), ["nowhere.md", "#down", "page.md#down"])


if __name__ == "__main__":
    unittest.main()
