"""The index of a folder of runs in Debian's Chromium.

SMALL_FORMS names the folder of runs that `validation/reference check --keep FOLDER` left.
"""

import io
import unittest

import numpy as np
from browser import RUNS, PageTest, begin, browser
from PIL import Image

import pyroclast
from pyroclast.report import write_page


def setUpModule():
    begin()


class Index(PageTest):
    def test_runs_are_listed_found_sorted_and_linked(self):
        folder = self.folder / "runs & <b>more"
        folder.mkdir()
        for name in ("compression", "starter", "thermal_wall", "starter_3d"):
            self.copy(RUNS / name, "report.html", name=f"{folder.name}/{name}")
        (folder / "broken").mkdir()
        (folder / "broken" / "history.csv").write_text("stage,step\n0,x\n")
        (folder / "notes").mkdir()
        write_page([folder / "starter"])
        browser.open(write_page([folder]))

        def names():
            return browser.run("return [...document.querySelectorAll('.run')].filter((r) => !r.hidden)"
                               ".map((r) => r.dataset.name)")

        self.assertEqual(names(), ["broken", "compression", "starter", "starter_3d", "thermal_wall"])
        self.assertEqual(browser.run("return document.querySelectorAll('.run img').length"), 3)
        links = browser.run("return [...document.querySelectorAll('.run a')].map((a) => a.getAttribute('href'))")
        self.assertEqual(links, ["starter/report.html"])
        browser.run("const s = document.getElementById('sort'); s.value = 'f_c'; s.onchange()")
        strengths = {name: pyroclast.read(folder / name).results["f_c_MPa"]
                     for name in ("compression", "starter", "starter_3d")}
        known = [name for name, strength in strengths.items() if strength is not None]
        self.assertTrue(known)
        self.assertEqual(names()[:len(known)], sorted(known, key=lambda name: -strengths[name]))
        browser.run("const f = document.getElementById('find'); f.value = 'SLAB fire'; f.oninput()")
        self.assertEqual(names(), ["thermal_wall"])
        browser.run("document.getElementById('find').value = ''; "
                    "const l = document.getElementById('level'); l.value = 'bad'; l.onchange()")
        self.assertIn("broken", names())
        self.assertNotIn("thermal_wall", names())
        self.assert_silent()

    def test_pictures_made_for_a_white_page_are_dark_on_a_dark_one(self):
        folder = self.folder / "runs"
        folder.mkdir()
        self.copy(RUNS / "starter", name="runs/starter")
        page = write_page([folder])
        means = {}
        for scheme in ("light", "dark"):
            browser.open(page, scheme=scheme)
            png = browser.driver.find_element("css selector", ".run img").screenshot_as_png
            means[scheme] = np.asarray(Image.open(io.BytesIO(png)).convert("L")).mean()
        self.assertGreater(means["light"], 140.0)
        self.assertLess(means["dark"], 110.0)
        self.assert_silent()


if __name__ == "__main__":
    unittest.main()
