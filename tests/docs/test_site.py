"""Promise: scripts/docs builds the site without a warning, no page asks another host for anything, no link is dead, and
the theme's script works in a browser.

Skipped where Sphinx, MyST or furo are missing (scripts/install-dependencies --docs). PYROCLAST names the program.
"""

import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "pages"))

from chromium import begin, browser  # noqa: E402  pylint: disable=wrong-import-position

NEEDED = ("sphinx", "myst_parser", "furo", "sphinx_copybutton", "sphinxcontrib.bibtex")
MISSING = [name for name in NEEDED if importlib.util.find_spec(name.split(".")[0]) is None]
_FETCHED = {**dict.fromkeys(("script", "img", "iframe", "source", "video", "audio", "embed"), "src"),
            "object": "data", "link": "href"}
_LINKED = {"canonical", "index", "search", "next", "prev", "license", "author", "help", "up"}  # of <link>: not fetched
_CSS = re.compile(r"url\(\s*['\"]?([^'\")]+)|@import\s+['\"]([^'\"]+)")


class Page(HTMLParser):
    """What a page fetches, where its links lead, and the anchors that it has."""

    def __init__(self, text: str):
        super().__init__()
        self.fetched, self.links, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.anchors |= {values[key] for key in ("id", "name") if values.get(key)}
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        target = values.get(_FETCHED.get(tag, ""))
        if target and not (tag == "link" and values.get("rel") in _LINKED):
            self.fetched.append(target)
        for style in (values.get("style") or "",):
            self.fetched += [a or b for a, b in _CSS.findall(style)]


def is_elsewhere(target: str) -> bool:
    return target.startswith("//") or urlsplit(target).scheme in ("http", "https", "ftp")


def setUpModule():
    """Builds the site, once for all tests."""
    if MISSING:
        raise unittest.SkipTest(f"not there: {', '.join(MISSING)}")
    folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
    unittest.addModuleCleanup(folder.cleanup)
    Built.done = subprocess.run([ROOT / "scripts" / "docs", "--out", folder.name], capture_output=True, text=True,
                                check=False)
    Built.html = pathlib.Path(folder.name) / "html"


class Built(unittest.TestCase):
    done: subprocess.CompletedProcess
    html: pathlib.Path


class Site(Built):
    @classmethod
    def setUpClass(cls):
        cls.pages = {path.resolve(): Page(path.read_text("utf-8")) for path in cls.html.rglob("*.html")}

    def test_is_built_without_a_warning(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr[-3000:])
        self.assertEqual(self.done.stderr, "")
        self.assertGreater(len(self.pages), 100)

    def test_no_page_asks_another_host_for_anything(self):
        for path, page in self.pages.items():
            self.assertEqual([target for target in page.fetched if is_elsewhere(target)], [], path.name)
        for path in self.html.rglob("*.css"):
            targets = [a or b for a, b in _CSS.findall(path.read_text("utf-8"))]
            self.assertEqual([target for target in targets if is_elsewhere(target)], [], path.name)
            for target in targets:
                self.assertTrue(target.startswith("data:") or (path.parent / urlsplit(target).path).exists(), target)

    def test_no_link_within_the_site_is_dead(self):
        for path, page in self.pages.items():
            for link in {link for link in page.links + page.fetched if not urlsplit(link).scheme}:
                to = urlsplit(link)
                file = (path.parent / unquote(to.path)).resolve() if to.path else path
                if file.is_dir():
                    file /= "index.html"
                with self.subTest(f"{path.relative_to(self.html.resolve())}: {link}"):
                    self.assertTrue(file.exists())
                    if to.fragment and file in self.pages:
                        self.assertIn(unquote(to.fragment), self.pages[file].anchors)

    def test_equations_are_equations(self):
        text = (self.html / "understand" / "theory.html").read_text("utf-8")
        self.assertEqual(sorted({int(number) for number in re.findall(r'class="number">\((\d+)\)', text)}),
                         list(range(1, 19)))
        self.assertGreater(text.count("<math"), 60)

    def test_every_block_of_code_has_a_language(self):
        for path in self.pages:
            self.assertNotRegex(path.read_text("utf-8"), "highlight-(default|none)", path.name)

    def test_the_landing_page_leads_to_install_and_says_version_and_home(self):
        text = (self.html / "index.html").read_text("utf-8")
        self.assertIn("do/install.html", self.pages[(self.html / "index.html").resolve()].links)
        citation = (ROOT / "CITATION.cff").read_text("utf-8")
        self.assertIn(f"describe version {re.search(r'^version: (.+)$', citation, re.MULTILINE)[1]}.", text)
        home = re.search(r"^repository-code: (.+)$", citation, re.MULTILINE)
        self.assertIn(home[1] if home else "names no public address", text)

    def test_what_another_host_has_is_found(self):
        page = Page('<link rel="stylesheet" href="https://a.b/c.css"><script src="//a.b/c.js"></script>'
                    '<img src="d.png"><a href="https://a.b">a</a>')
        elsewhere = [target for target in page.fetched if is_elsewhere(target)]
        self.assertEqual(elsewhere, ["https://a.b/c.css", "//a.b/c.js"])


class InBrowser(Built):
    @classmethod
    def setUpClass(cls):
        begin()

    def test_no_page_says_a_word_and_the_theme_s_script_works(self):
        browser.console()
        for page in ("index.html", "understand/theory.html", "lookup/deck/stages.html"):
            with self.subTest(page):
                browser.open(self.html / page)
                self.assertEqual(browser.console(), [])
                before = browser.run("return document.body.dataset.theme")
                browser.run("[...document.getElementsByClassName('theme-toggle')][0].click()")
                self.assertNotEqual(browser.run("return document.body.dataset.theme"), before)
                browser.console()  # the theme says there to which colours it changed
        browser.run("window.scrollTo({top: 2000, behavior: 'instant'})")
        browser.wait("return document.querySelectorAll('.scroll-current').length > 0")
        browser.wait("window.scrollBy({top: -20, behavior: 'instant'}); return document.documentElement.classList.contains('show-back-to-top')")


if __name__ == "__main__":
    unittest.main()
