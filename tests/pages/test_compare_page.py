"""The page of several runs in Debian's Chromium.

SMALL_FORMS names the folder of runs that `validation/reference check --keep FOLDER` left.
"""

import json
import re
import unittest

import h5py
import numpy as np
from browser import RUNS, PageTest, begin, browser

import pyroclast
from pyroclast.errors import Error
from pyroclast.report import write_page
from pyroclast.report.compare_page import compare_page, deck_differences


def setUpModule():
    begin()


class Compared(PageTest):
    def test_cracks_of_one_alone_and_of_both_are_told_apart(self):
        other = self.copy(RUNS / "compression")
        run = pyroclast.read(RUNS / "compression")
        last = run.frames[-1]
        damages = [f"{mode}_damage [1]" for mode in run.facts.crack_modes]
        broken = [c for c in range(len(run.mesh.contacts.cells))
                  if max(run.contact_field(last, name)[c] for name in damages) > 0.55]
        healed = broken[:7]
        for frame in run.frames:
            with h5py.File(other / "fields" / f"contacts_{frame.number:04d}.hdf", "r+") as file:
                for name in damages:
                    values = file[f"VTKHDF/CellData/{name}"][()]
                    values[healed] = 0.0
                    file[f"VTKHDF/CellData/{name}"][...] = values
                steps = file["VTKHDF/CellData/crack_step [1]"]
                steps[...] = np.where(np.isin(np.arange(len(steps)), healed), -1.0, steps[()])
        browser.open(self.page_of(run.folder, other))
        only_first, only_other, both = browser.run("return pyroclast.counts")
        self.assertEqual((only_first, only_other), (7, 0))
        self.assertGreaterEqual(both, len(broken) - 7)
        modes, sets = browser.run(
            "const v = (n) => getComputedStyle(document.documentElement).getPropertyValue(n).trim();"
            "return [pyroclast.shown[0].body.modes.flatMap((m) => [v(`--${m}`), v(`--${m}-tint`)]), "
            "pyroclast.bothColours.map((name) => v(name.slice(4, -1)))]")
        self.assertEqual(len(set(modes + sets)), len(modes) + 3)
        self.assert_silent()

    def test_specimens_stand_at_the_same_strain(self):
        browser.open(self.page_of(RUNS / "compression", RUNS / "starter"))
        browser.run("const at = document.getElementById('at'); at.value = 100; at.oninput()")
        strains = browser.run("return pyroclast.shown.map((r) => r.frames[r.frame].strain)")
        place = 1e-3 * float(browser.run("return document.getElementById('now').textContent").split(": ")[-1])
        for run, strain in zip((RUNS / "compression", RUNS / "starter"), strains):
            nearest = min((frame.strain for frame in pyroclast.read(run).frames), key=lambda own: abs(own - place))
            self.assertAlmostEqual(strain, nearest, delta=1e-9)
        self.assert_silent()

    def test_strains_are_counted_from_the_start_of_loading(self):
        runs = [RUNS / "compression", RUNS / "hot_compression"]
        browser.open(self.page_of(*runs))
        self.assertEqual(browser.run("return document.getElementById('over').value"), "strain_of_load")
        drawn = browser.run("return pyroclast.runs.map((r) => r.course.of('strain_of_load').filter(isFinite))")
        for strains, run in zip(drawn, map(pyroclast.read, runs)):
            self.assertAlmostEqual(1e-3 * strains[-1], pyroclast.Compressed(run).strain[-1], delta=1e-8)
            self.assertLess(abs(strains[0]), 0.05)  # heated to 100 degC it had grown by 0.6
        self.assert_silent()

    def test_no_row_has_equal_values(self):
        browser.open(self.page_of(RUNS / "compression", self.copy(RUNS / "compression", "fields")))
        rows = browser.run("return [...document.querySelector('table').tBodies[0].rows].map((r) => r.cells[0].textContent)")
        self.assertEqual(rows, [""])  # the verdicts alone
        browser.open(self.page_of(RUNS / "compression", RUNS / "starter"))
        for row in browser.run("return [...document.querySelector('table').tBodies[0].rows].slice(2)"
                               ".map((r) => [...r.cells].slice(1).map((c) => c.textContent.trim()))"):
            self.assertGreater(len(set(row)), 1)

    def test_seeds_get_a_band(self):
        runs = []
        for seed in (1, 2, 3):
            run = self.copy(RUNS / "starter", "fields", name=f"seed_{seed}")
            manifest = json.loads((run / "manifest.json").read_text())
            (run / "manifest.json").write_text(json.dumps(manifest | {"seed": seed}))
            runs.append(run)
        found, = deck_differences([pyroclast.read(run) for run in runs])
        self.assertEqual((found.key, found.values), ("seed", ["1", "2", "3"]))
        browser.open(self.page_of(*runs))
        key = browser.run("return document.querySelector('#curve .key').textContent")
        self.assertIn("3 seeds: least to greatest", key)
        self.assert_silent()

    def test_a_title_stands_as_it_is(self):
        run = self.copy(RUNS / "starter", "fields")
        summary = json.loads((run / "summary.json").read_text())
        (run / "summary.json").write_text(json.dumps(summary | {"title": "costs 3 $ & <b>more"}))
        html = compare_page([pyroclast.read(run), pyroclast.read(RUNS / "compression")])
        self.assertIn("<td>costs 3 $ &amp; &lt;b&gt;more</td>", html)

    def test_runs_have_the_names_of_their_folders_and_keys_that_differ_together_are_told(self):
        one, other = (self.copy(RUNS / "starter", "fields", name=name) for name in ("slow", "fast"))
        for run, strength in ((one, 30.0), (other, 33.0)):
            known = json.loads((run / "summary.json").read_text())
            known["stages"][-1]["results"]["f_c_MPa"] = strength
            (run / "summary.json").write_text(json.dumps(known))

        def differences(**changes):
            text = (one / "deck.toml").read_text()
            for key, value in changes.items():
                text, count = re.subn(rf'(?m)^{key} = "[^"]*"', f'{key} = "{value}"', text)
                self.assertTrue(count, key)
            (other / "deck.toml").write_text(text)
            return compare_page([pyroclast.read(run) for run in (one, other)])

        html = differences(velocity="7 mm/s", c_res="0.01 MPa", title="changes nothing")
        self.assertRegex(html, r"</span> slow</th><th>.*</span> fast</th>")
        self.assertIn("+10.0 %", html)
        self.assertRegex(html, r'stages\[1\]\.velocity <span class="faint">\(stage 2, compress\)')
        self.assertRegex(html, r"\d keys differ: their effects cannot be told apart")
        self.assertNotIn("cannot be told apart", differences(velocity="7 mm/s", title="changes nothing"))

    def test_runs_alike_are_no_seeds(self):
        runs = [pyroclast.read(self.copy(RUNS / "starter", "fields", name=f"run_{number}")) for number in (1, 2, 3)]
        data = re.search('id="data">(.*?)</script>', compare_page(runs))[1]
        self.assertFalse(json.loads(data)["seeds"])

    def test_runs_with_nothing_in_common_are_refused(self):
        with self.assertRaisesRegex(Error, "nothing in common"):
            write_page([RUNS / "compression", RUNS / "brazilian"], self.folder / "page.html")
        with self.assertRaisesRegex(Error, "needs --out FILE"):
            write_page([RUNS / "compression", RUNS / "starter"])


if __name__ == "__main__":
    unittest.main()
