"""What tests of pages share: the runs, a folder of their own, and the browser."""

from __future__ import annotations

import os
import pathlib
import shutil
import tempfile
import unittest

from chromium import begin, browser
from pyroclast.report import write_page

__all__ = ["RUNS", "FolderTest", "PageTest", "begin", "browser"]

RUNS = pathlib.Path(os.environ["SMALL_FORMS"])
"""Runs of the cases in their small forms, by name."""


class FolderTest(unittest.TestCase):
    """Has a folder of its own for pages and copies of runs."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def page_of(self, *folders: pathlib.Path) -> pathlib.Path:
        return write_page(folders, self.folder / "page.html")

    def copy(self, run: pathlib.Path, *without: str, name: str = "copy") -> pathlib.Path:
        """Of a run, without files of these names."""
        return pathlib.Path(shutil.copytree(run, self.folder / name,
                                            ignore=shutil.ignore_patterns(*without, "checkpoints")))


class PageTest(FolderTest):
    """Opens pages in the browser."""

    def setUp(self):
        super().setUp()
        browser.console()

    def assert_silent(self):
        self.assertEqual(browser.console(), [])
