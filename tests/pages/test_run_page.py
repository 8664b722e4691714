"""The page of a run in Debian's Chromium: its numbers are the run's, and it answers to mouse and keys.

SMALL_FORMS names the folder of runs that `validation/reference check --keep FOLDER` left.
"""

import fcntl
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np
from browser import RUNS, PageTest, begin, browser
from matplotlib.path import Path

import pyroclast
from pyroclast.draw.profiles import read_profile
from pyroclast.draw.properties import panels, read_properties
from pyroclast.report import write_page
from pyroclast.report.plane_body import outline_of

ROOT = pathlib.Path(__file__).parents[2]


def setUpModule():
    begin()


class PageOfRun(PageTest):
    def picture(self) -> str:
        return browser.run("return document.getElementById('body').toDataURL()")


class EveryCase(PageOfRun):
    def test_opens_without_a_word_and_shows_its_last_frame(self):
        for run in sorted(RUNS.iterdir()):
            with self.subTest(run.name):
                browser.open(self.page_of(run))
                browser.run("document.querySelectorAll('#tabs button').forEach((b) => b.click())")
                results = pyroclast.read(run)
                self.assertEqual(browser.run("return document.querySelector('h1').textContent"), results.title)
                if results.has_fields and results.mesh.blocks.dimension == 2:
                    self.assertEqual(browser.run("return pyroclast.scene.frames.length"), len(results.frames))
                    self.assertIn(f"frame {len(results.frames) - 1} of",
                                  browser.run("return document.getElementById('now').textContent"))
                if run.name in ("compression", "cyclic"):  # the first is brushed across, the other goes back
                    self.assertEqual(browser.run("return pyroclast.curve.chart.goesOneWay"), run.name == "compression")
                self.assert_silent()


class OfARunThatGoesOn(PageOfRun):
    def test_watch_keeps_the_page_of_a_run_and_the_page_loads_itself_anew_until_the_end(self):
        run = self.copy(RUNS / "compression", "summary.json")
        display = {**os.environ, "DISPLAY": ":7"}
        with open(run / "lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            lock.write(f"{os.getpid()}\n")
            lock.flush()
            watcher = subprocess.Popen([sys.executable, "-m", "pyroclast.watch", str(run)], env=display,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            self.addCleanup(watcher.kill)
            self.assertEqual(watcher.stderr.readline(),
                             f"pyroclast watch: {run}/report.html follows the run; open it in a browser\n")
            while not (run / "report.html").exists() and watcher.poll() is None:
                time.sleep(0.05)
            browser.open(run / "report.html")
            reloads = "return document.querySelector('meta[http-equiv=refresh]')?.content ?? null"
            self.assertEqual(browser.run(reloads), "10")
            shutil.copy(RUNS / "compression/summary.json", run)
        self.assertEqual((watcher.communicate()[1], watcher.returncode), ("", 0))
        browser.wait("return document.querySelector('meta[http-equiv=refresh]') === null && "
                     "document.querySelector('header .faint').textContent.startsWith('the stress fell')")
        self.assert_silent()


class OneRun(PageOfRun):
    @classmethod
    def setUpClass(cls):
        folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.run_ = pyroclast.read(RUNS / "compression")
        cls.page = write_page([cls.run_.folder], folder / "page.html")

    def setUp(self):
        super().setUp()
        browser.open(self.page)

    def kept(self, name: str, frame: int) -> np.ndarray:
        """Numbers of a frame as the page's script has them."""
        return np.array(browser.run(
            "const a = pyroclast.arrays[arguments[0]], from = a.row(arguments[1]); "
            "return Array.from(a.values.subarray(from, from + a.width), (v) => v * a.step)", name, frame))

    def cells(self, tables: str, which: int) -> list[list[str]]:
        """Texts of a table, row by row."""
        return browser.run("return [...document.querySelectorAll(arguments[0])[arguments[1]].tBodies[0].rows]"
                           ".map((r) => [...r.cells].map((c) => c.textContent))", tables, which)

    def step(self, name: str) -> float:
        return browser.run("return pyroclast.arrays[arguments[0]].step", name)

    def assert_within_step(self, name: str, frame: int, values: np.ndarray):
        # half a step, and single precision of the fields
        self.assertLessEqual(np.abs(self.kept(name, frame) - values).max(),
                             0.5 * self.step(name) * (1.0 + 1e-6) + 1e-6 * np.abs(values).max(), name)

    def test_a_platen_covers_cracks_unless_it_is_asked_to_show_them(self):
        covered = ("const s = pyroclast.specimen, found = [0, 0]; for (let i = 0; i < s.pixels.length; i += 7) {"
                   "const x = i % s.W, y = (i - x) / s.W, {block} = s.body.at(x, y, s.W, s.H, s.frame, s.magnification);"
                   "if (block >= 0 && s.isCovered([x, y, x, y])) found[s.body.bearing[block]]++;} return found")
        of_specimen, of_platens = browser.run(covered)
        self.assertEqual(of_specimen, 0)
        self.assertGreater(of_platens, 100)
        browser.run("document.getElementById('covered').click()")
        self.assertEqual(browser.run(covered), [0, 0])

    def test_numbers_are_those_of_the_fields_within_their_step(self):
        blocks = self.run_.mesh.blocks
        outline = outline_of(self.run_.mesh)
        for k in (1, 30, len(self.run_.frames) - 1):
            frame = self.run_.frames[k]
            moves = self.run_.gridpoint_displacement(frame)[outline.gridpoint]
            self.assert_within_step("move_x", k, moves[:, 0])
            self.assert_within_step("move_y", k, moves[:, 1])
            with h5py.File(self.run_.folder / "fields" / f"blocks_{frame.number:04d}.hdf") as file:
                stress = 1e-6 * file["VTKHDF/CellData/stress [Pa]"][:, 1].astype(float)
            block = np.unique(blocks.block, return_inverse=True)[1].ravel()
            mean = np.bincount(block, blocks.sizes * stress) / np.bincount(block, blocks.sizes)
            self.assert_within_step("stress_y", k, mean)
            damages = {mode: self.run_.contact_field(frame, f"{mode}_damage [1]") for mode in self.run_.facts.crack_modes}
            for mode, damage in damages.items():
                kept = self.kept(f"damage_{mode}", k)
                # the last step is kept for broken contacts, so one that is nearly so may be a whole step away
                self.assertLessEqual(np.abs(kept - damage).max(), 1.0 / 127.0)
                self.assertEqual((kept >= 1.0).tolist(), (damage >= 1.0).tolist())
            is_damaged = np.max(list(damages.values()), axis=0) > 0.0
            self.assert_within_step("opening", k, is_damaged * self.run_.contact_field(frame, "opening [m]"))
        corner = blocks.points[outline.gridpoint]
        kept = np.array(browser.run(
            "const a = pyroclast.arrays.corner; return Array.from(a.values, (v) => v * a.step)"))
        self.assertLessEqual(np.abs(kept - corner.ravel()).max(), 0.5001 * self.step("corner"))

    def test_pixels_know_their_blocks(self):
        frame = browser.run("return pyroclast.scene.frame")
        outline = outline_of(self.run_.mesh)
        magnification = browser.run("return pyroclast.specimen.magnification")
        moves = self.run_.gridpoint_displacement(self.run_.frames[frame])[outline.gridpoint]
        corner = self.run_.mesh.blocks.points[outline.gridpoint] + magnification * moves
        shown = browser.run("const s = pyroclast.specimen, b = s.body, {x0, x1, y0, y1} = b.box; "
                            "return [s.W, s.H, b.scale, x0, x1, y0, y1]")
        W, H, scale, x0, x1, y0, y1 = shown
        ids = browser.run("return Array.from(pyroclast.scene.body.ids)")
        tried = 0
        for share_x, share_y in ((0.5, 0.5), (0.3, 0.25), (0.7, 0.3), (0.35, 0.8), (0.62, 0.66), (0.5, 0.04)):
            px, py = int(share_x * W), int(share_y * H)
            x = x0 + (px + 0.5 - (W - scale * (x1 - x0)) / 2) / scale
            y = y0 + ((H + scale * (y1 - y0)) / 2 - py - 0.5) / scale
            inside = [b for b in range(len(outline.first) - 1)
                      if Path(corner[outline.first[b]:outline.first[b + 1]]).contains_point((x, y))]
            if len(inside) == 1:
                tried += 1
                self.assertEqual(ids[py * int(W) + px], inside[0])
        self.assertGreaterEqual(tried, 5)

    def test_scrubbing_keys_and_marks_change_the_picture(self):
        last = self.picture()
        browser.press("Home")
        first = self.picture()
        self.assertNotEqual(first, last)
        browser.press("ArrowRight")
        self.assertIn("frame 1 of", browser.run("return document.getElementById('now').textContent"))
        browser.run("const at = document.getElementById('at'); at.value = at.max; at.dispatchEvent(new Event('input'))")
        self.assertEqual(self.picture(), last)
        browser.run("document.querySelector('#marks [data-mark=peak]').click()")
        frame = browser.run("return pyroclast.scene.frame")
        self.assertGreaterEqual(self.run_.frames[frame].strain, pyroclast.Compressed(self.run_).peak[0] - 1e-9)
        self.assertLess(self.run_.frames[frame - 1].strain, pyroclast.Compressed(self.run_).peak[0])
        gap = 1e3 * (self.run_.frames[frame].strain - pyroclast.Compressed(self.run_).peak[0])
        told = browser.run("return pyroclast.specimen.caption")
        self.assertRegex(told, r"^frame at [\d.]+·10⁻³, [\d.]+·10⁻³ after the mark$")
        self.assertAlmostEqual(float(told.split(", ")[1].split("·")[0]), gap, delta=0.011)  # rows are 0.01 apart
        self.assertIn({"text": told, "align": "left"}, browser.run(
            "return pyroclast.specimen.labels().texts.map(({text, align}) => ({text, align}))"))
        browser.press("ArrowRight")
        self.assertEqual(browser.run("return pyroclast.specimen.caption"), "")
        self.assert_silent()

    def test_the_picture_tells_its_scale_and_magnification(self):
        magnification, texts, pixels, scale = browser.run(
            "const s = pyroclast.specimen, {texts, bar} = s.labels(); "
            "return [s.magnification, texts.map((t) => t.text), bar[0][2] - bar[0][0], s.body.scale]")
        self.assertIn(f"displacements ×{magnification}", texts)
        millimetres = next(float(text.split()[0]) for text in texts if text.endswith(" mm"))
        self.assertAlmostEqual(1e3 * pixels / scale, millimetres, delta=1e-6 * millimetres)

    def test_menus_have_no_temperature_of_a_cold_test(self):
        offered = browser.run("return [...document.getElementById('over').options].map((o) => o.value)")
        self.assertIn("strain", offered)
        self.assertFalse({"temperature", "minutes", "temperature_min", "temperature_max"} & set(offered))

    def test_the_first_broken_contact_is_ringed_and_damaged_ones_are_drawn(self):
        run = self.run_
        plain = [browser.run("pyroclast.scene.show(arguments[0]); "
                             "return document.getElementById('body').toDataURL()", k)
                 for k in browser.run("const {scene} = pyroclast; return ['first', 'extent'].map((id) => "
                                      "scene.frameAt(scene.course.about.marks.find((m) => m.id === id).rows[0]))")]
        browser.run("document.querySelector('#marks [data-mark=first]').click()")
        frame, ringed, now = browser.run("return [pyroclast.scene.frame, [...pyroclast.specimen.ringed], "
                                         "document.getElementById('now').textContent]")
        row = int((sum(run.history[name] for name in run.history.names if name.endswith("_broken")) > 0).argmax())
        kinds = {(mode, name) for mode, interfaces in run.facts.crack_modes.items() for name in interfaces
                 if run.history[f"{mode}_{name}_broken"][row] > 0}

        def broken(k):
            return {int(c) for mode, name in kinds for c in np.flatnonzero(
                (run.contact_field(run.frames[k], f"{mode}_damage [1]") >= 1.0)
                & (run.mesh.contacts.interface == run.mesh.contacts.interfaces.index(name)))}

        half = run.contact_field(run.frames[-1], "crack_step [1]")  # that it passed before it broke
        self.assertEqual(set(ringed), {c for c in broken(frame) - broken(frame - 1)
                                       if half[c] <= run.history["step"][row]})
        self.assertTrue(ringed)
        x, y = 1e3 * run.mesh.contacts.points[run.mesh.contacts.cells[ringed[0], 0]]
        self.assertIn(f"({x:.3g}, {y:.3g}) mm", now)
        self.assertNotEqual(self.picture(), plain[0])
        browser.run("document.querySelector('#marks [data-mark=extent]').click()")
        frame, now = browser.run("return [pyroclast.scene.frame, document.getElementById('now').textContent]")
        most = np.max([run.contact_field(run.frames[frame], f"{mode}_damage [1]") for mode in run.facts.crack_modes], axis=0)
        told = int(now.split("; ")[-1].split()[0])
        self.assertTrue((most > 0.0041).sum() <= told <= (most > 0.0038).sum(), told)  # half a step of damage
        self.assertNotEqual(self.picture(), plain[1])
        self.assert_silent()

    def test_a_halo_leaves_the_mode_to_be_seen(self):
        browser.run("document.querySelector('#marks [data-mark=steepest]').click()")
        colours = browser.run("const s = pyroclast.specimen; return s.strokes(s.theme()).map((g) => g.colour)")
        lit = colours.index("#d0006f")
        self.assertGreater(len(colours), lit + 2)
        self.assertFalse({"#d0006f", "#ffffff"} & set(colours[lit + 2:]))

    def test_displacements_do_not_lengthen_a_line_across(self):
        width = 1e3 * np.ptp(self.run_.mesh.blocks.points[self.run_.mesh.blocks.zones[
            ~self.run_.mesh.blocks.of_bearing]][..., 0])
        browser.run("document.querySelector('#marks [data-mark=peak]').click()")
        for magnification in (1, 50):
            browser.run("const m = document.getElementById('magnification'); m.value = arguments[0]; m.onchange()",
                        magnification)
            browser.press("l")
            x = browser.run("return pyroclast.probes.along.drawing.x")
            browser.press("l")
            self.assertTrue(0.93 * width < x[-1] <= 1.0001 * width, (magnification, x[-1], width))

    def test_a_mark_lights_the_contacts_that_are_new_in_its_frame(self):
        browser.run("document.querySelector('#marks [data-mark=peak]').click()")
        frame, lit = browser.run("return [pyroclast.scene.frame, [...pyroclast.specimen.lit]]")

        def beyond(k):
            return np.max([self.run_.contact_field(self.run_.frames[k], f"{mode}_damage [1]")
                           for mode in self.run_.facts.crack_modes], axis=0) > 0.5

        new = np.flatnonzero(beyond(frame) & ~beyond(frame - 1))
        self.assertTrue(len(new))
        self.assertEqual(set(lit), set(new.tolist()))

    def test_a_brushed_piece_tells_what_broke_in_it(self):
        box = browser.place("#curve svg")
        y = box["y"] + 0.4 * box["height"]
        browser.mouse("mousePressed", box["x"] + 0.5 * box["width"], y)
        browser.mouse("mouseMoved", box["x"] + 0.6 * box["width"], y)
        browser.mouse("mouseReleased", box["x"] + 0.8 * box["width"], y)
        a, b = browser.run("return pyroclast.scene.piece")
        self.assertLess(a, b)
        steps = browser.run("const s = pyroclast.scene.course.column('step'); "
                            "return Array.from(arguments, (i) => s[i])", a, b)
        shown = browser.run("const c = pyroclast.curve.chart; return arguments[0].map((i) => c.X(c.drawing.x[i]))",
                            [a - 1, a, b, b + 1])
        low, high = 0.5 * box["width"], 0.8 * box["width"]
        self.assertTrue(shown[0] < low <= shown[1] < shown[2] <= high < shown[3], (shown, low, high))
        rows = np.searchsorted(self.run_.history["step"], steps)
        told = {tuple(row[:2]): row[2:] for row in self.cells("#piece table", 0)}
        for mode, interfaces in self.run_.facts.crack_modes.items():
            for name in interfaces:
                broken = np.diff(self.run_.history[f"{mode}_{name}_broken"][rows])[0]
                self.assertEqual(float(told[mode, name.replace("_", "–")][1]), broken)
        cracked = self.run_.contact_field(self.run_.frames[-1], "crack_step [1]")
        lit = browser.run("return [...pyroclast.specimen.lit]")
        self.assertEqual(set(lit), set(np.flatnonzero((cracked > steps[0]) & (cracked <= steps[1])).tolist()))
        self.assertTrue(lit)
        energies = dict(self.cells("#piece table", 1))
        lost = np.diff(self.run_.history["dissipated_tension_J"][rows])[0]
        self.assertAlmostEqual(float(energies["tension softening"]), lost, delta=0.006 * lost)  # three digits
        browser.press("Escape")
        self.assertTrue(browser.run("return document.getElementById('piece').hidden"))
        self.assert_silent()

    def said_of_piece(self) -> str:
        return browser.run("return document.getElementById('piece').innerText")

    def test_a_piece_that_has_begun_keeps_its_start_and_an_empty_one_is_told(self):
        rows = {mark["id"]: mark["rows"] for mark in browser.run("return pyroclast.scene.course.about.marks")}
        browser.run("document.querySelector('#marks [data-mark=peak]').click()")
        browser.press("[")
        self.assertIn("A piece of the curve begins at axial strain", self.said_of_piece())
        browser.press("]")
        self.assertIn("This piece is empty", self.said_of_piece())
        browser.run("document.querySelector('#marks [data-mark=steepest]').click()")
        browser.press("]")
        self.assertEqual(browser.run("return pyroclast.scene.piece"), [rows["peak"][0], rows["steepest"][1]])
        self.assertIn("broke", self.said_of_piece())
        browser.run("document.querySelector('#marks [data-mark=extent]').click()")
        self.assertIsNone(browser.run("return pyroclast.scene.piece"))
        browser.press("]")
        browser.press("Home")
        browser.press("[")
        first = browser.run("return pyroclast.scene.frames[0].row")
        self.assertEqual(browser.run("return pyroclast.scene.piece"), [first, rows["extent"][0]])
        self.assert_silent()

    def test_the_fall_after_the_peak_says_why(self):
        browser.run("document.querySelector('#marks [data-mark=behind]').click()")
        ends = browser.run("const {course, piece} = pyroclast.scene, s = course.column('step'); "
                           "return piece.map((i) => s[i])")
        history = self.run_.history
        change = {name: np.diff(history[name][np.searchsorted(history["step"], ends)])[0] for name in history.names
                  if name.endswith(("_broken", "_J"))}
        why = browser.run("return document.querySelector('#piece .why').textContent")
        broken = {name: count for name, count in change.items() if name.endswith("_broken")}
        first = max(broken, key=broken.get)
        mode, interface = first.removesuffix("_broken").split("_", 1)
        self.assertIn(f"in {mode} at {interface.replace('_', '–')} ({broken[first]:.0f} of "
                      f"{sum(broken.values()):.0f})", why)
        leading = max(("friction", "compression", "shear", "tension"), key=lambda way: change[f"dissipated_{way}_J"])
        name = {"compression": "crushing"}.get(leading, leading)
        self.assertRegex(why, rf"; {name}[\w ]* \(\d")
        heads = browser.run("return [...document.querySelectorAll('#piece h4')].map((h) => h.textContent)")
        self.assertTrue(all("axial strain" in head for head in heads))
        self.assertRegex(heads[-1], r"rounded to frames \d+ to \d+: axial strain")
        lost = browser.run("return [...document.querySelectorAll('#piece table')[2].tHead.rows[0].cells]"
                           ".map((c) => c.textContent)")
        self.assertLessEqual(set(lost[1:]), {row[0] for row in self.cells("#piece table", 1)})
        self.assertTrue(browser.run("return [...document.querySelectorAll('#piece abbr')].every((a) => a.title)"))
        self.assert_silent()

    def test_pointing_tells_a_block_and_a_click_pins_it(self):
        box = browser.place("#body")
        x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
        browser.press("Home")  # no cracks yet
        browser.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": "mouseMoved", "x": x, "y": y})
        told = browser.run("return document.getElementById('tip').textContent")
        block = browser.run("const {W, H} = pyroclast.specimen; "
                            "return pyroclast.scene.body.at(W / 2, H / 2, W, H, 0, 0).block")
        self.assertTrue(told.startswith(f"block {block}, "), told)
        browser.mouse("mousePressed", x, y)
        browser.mouse("mouseReleased", x, y)
        self.assertIn(f"block {block}", browser.run("return document.getElementById('pinned_rows').textContent"))

    def test_all_of_it_goes_without_a_mouse(self):
        browser.press("Home")
        for _ in range(3):
            browser.press("ArrowDown", shiftKey=True)
        self.assertIn("block", browser.run("return document.getElementById('tip').textContent"))
        browser.press("p")
        self.assertEqual(browser.run("return document.getElementById('pinned_rows').rows.length"), 1)
        browser.press("[")
        browser.press("End")
        browser.press("]")
        self.assertFalse(browser.run("return document.getElementById('piece').hidden"))
        browser.press("Escape")
        browser.press("l")
        self.assertFalse(browser.run("return document.getElementById('along').hidden"))
        browser.press("Home")
        browser.press(" ")
        browser.wait("return pyroclast.scene.frame > 0")
        browser.press(" ")
        self.assert_silent()

    def test_colours_cracks_and_magnification_change_the_picture(self):
        seen = {self.picture()}
        for id_, value in (("colour", "stress_y"), ("colour", "displacement"), ("cracks", "opening"), ("cracks", "age"),
                           ("cracks", "none"), ("magnification", "1")):
            browser.run("const s = document.getElementById(arguments[0]); s.value = arguments[1]; s.onchange()",
                        id_, value)
            seen.add(self.picture())
        self.assertEqual(len(seen), 7)
        self.assert_silent()

    def test_dark_and_narrow(self):
        light = self.picture()
        browser.open(self.page, scheme="dark")
        self.assertNotEqual(self.picture(), light)
        self.assertEqual(browser.run("return getComputedStyle(document.body).backgroundColor"), "rgb(23, 24, 26)")
        browser.open(self.page, width=420, height=800)
        self.assertLessEqual(browser.run("return document.documentElement.scrollWidth"), 420)
        self.assert_silent()

    def test_print_gives_four_frames_and_all_tabs(self):
        browser.run("dispatchEvent(new Event('beforeprint'))")
        self.assertEqual(browser.run("return document.querySelectorAll('#four canvas').length"), 4)
        browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.addCleanup(browser.driver.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"media": ""})
        self.assertTrue(browser.run(
            "return [...document.querySelectorAll('.tab')].filter((t) => t.id !== 'tab_download')"
            ".every((t) => getComputedStyle(t).display === 'block')"))

    def test_downloads_hold_the_run(self):
        saved = browser.run("""
            const saved = {};
            URL.createObjectURL = (blob) => { saved.blob = blob; return 'blob:none'; };
            HTMLAnchorElement.prototype.click = function () { saved[this.download] = saved.blob; };
            for (const id of ['history', 'frames', 'deck', 'svg']) document.getElementById(`save_${id}`).onclick();
            window.saved = saved;
            return Object.keys(saved).filter((name) => name !== 'blob')""")
        self.assertEqual(len(saved), 4)
        texts = browser.driver.execute_async_script("""
            const done = arguments[0], names = Object.keys(saved).filter((n) => n !== 'blob');
            Promise.all(names.map((n) => saved[n].text())).then((texts) =>
                done(Object.fromEntries(names.map((n, i) => [n, texts[i]]))))""")
        deck = next(text for name, text in texts.items() if name.endswith(".toml"))
        self.assertEqual(deck, self.run_.deck_text)
        history = next(text for name, text in texts.items() if name.endswith("history.csv"))
        self.assertEqual(history.split("\n")[0].split(","), self.run_.history.names)
        picture = next(text for name, text in texts.items() if name.endswith(".svg"))
        self.assertEqual(picture.count("<polygon"), len(outline_of(self.run_.mesh).first) - 1)


class OtherRuns(PageOfRun):
    def test_hostile_titles_and_names_stay_text(self):
        run = self.copy(RUNS / "compression")
        bad = "</script><script>window.hacked = 1</script><img src=x onerror='window.hacked = 2'>\x1b[31m"
        for file in ("summary.json", "manifest.json"):
            known = json.loads((run / file).read_text())
            known |= {"title": bad, "warnings": [bad], "command": f"pyroclast --set '{bad}'"}
            (run / file).write_text(json.dumps(known))
        (run / "deck.toml").write_text((run / "deck.toml").read_text() + f"# {bad[:-6]}\n")
        browser.open(self.page_of(run))
        self.assertIsNone(browser.run("return window.hacked || null"))
        self.assertEqual(browser.run("return document.querySelector('h1').textContent"), bad.replace("\x1b", "\\x1b"))
        self.assert_silent()

    def test_the_policy_lets_nothing_else_in(self):
        browser.open(self.page_of(RUNS / "compression"))
        browser.run("const s = document.createElement('script'); s.textContent = 'window.hacked = 1'; "
                    "const i = new Image(); i.src = 'http://127.0.0.1:9/x.png'; document.body.append(s, i)")
        self.assertIsNone(browser.run("return window.hacked || null"))
        browser.wait("return true")
        said = browser.console()
        self.assertTrue(any("Content Security Policy" in text for text in said), said)

    def test_a_run_without_fields_has_its_curve_and_cards(self):
        browser.open(self.page_of(self.copy(RUNS / "compression", "fields")))
        self.assertTrue(browser.run("return document.querySelector('#curve path').getAttribute('d').length > 100"))
        self.assertTrue(browser.run("return document.querySelectorAll('.card').length >= 3"))
        self.assertIn("keeps no fields", browser.run("return document.querySelector('footer').textContent"))
        self.assert_silent()

    def test_a_fork_has_its_parent_behind(self):
        parent, fork = self.copy(RUNS / "starter", "fields"), self.copy(RUNS / "starter", "fields", name="fork")
        manifest = json.loads((fork / "manifest.json").read_text())
        (fork / "manifest.json").write_text(json.dumps(manifest | {"parent": {"folder": str(parent)}}))
        browser.open(self.page_of(fork))
        key = browser.run("return document.querySelector('#curve .key').textContent")
        self.assertIn("of which this run is a fork", key)
        self.assert_silent()

    def test_a_run_that_still_goes_has_a_page(self):
        words = [os.environ["PYROCLAST"], "run", ROOT / "cases" / "starter.toml", "--out", self.folder / "live",
                 "--quiet", "--no-figures", "--set", "blocks.count=400"]
        with subprocess.Popen(words) as run:
            try:
                frames = self.folder / "live" / "fields" / "frames.csv"
                while not frames.exists() or frames.read_text().count("\n") < 4:
                    self.assertIsNone(run.poll())
                    time.sleep(0.05)
                page = self.page_of(self.folder / "live")
            finally:
                run.kill()
        browser.open(page)
        self.assertIn("the run still goes on", browser.run("return document.querySelector('.reasons').textContent"))
        self.assertGreaterEqual(browser.run("return pyroclast.scene.frames.length"), 3)
        self.assert_silent()

    def test_a_run_that_broke_off_says_so(self):
        browser.open(self.page_of(self.copy(RUNS / "compression", "summary.json")))
        self.assertIn("broke off", browser.run("return document.querySelector('.reasons').textContent"))
        self.assertEqual(browser.run("return document.querySelectorAll('.card').length"), 0)
        self.assert_silent()

    def test_a_solid_is_cut_by_planes(self):
        run = pyroclast.read(RUNS / "starter_3d")
        browser.open(self.page_of(run.folder))
        blocks = run.mesh.blocks
        number = np.unique(blocks.block, return_inverse=True)[1].ravel()
        pictures = set()
        for axis, share in (("z", 0.5), ("y", 0.3), ("x", 0.7)):
            browser.run("document.getElementById('view').value = arguments[0]; "
                        "const p = document.getElementById('place'); p.value = arguments[1]; p.oninput()",
                        f"{axis} 0", 100 * share)
            cut = set(browser.run("return [...pyroclast.scene.body.owner]"))
            offset = browser.run("return pyroclast.scene.body.offset")
            height = blocks.points[blocks.zones][..., "xyz".index(axis)] - offset
            crossed = (height.max(axis=1) > 1e-6) & (height.min(axis=1) < -1e-6)
            self.assertEqual(cut ^ set(number[crossed].tolist()), set())
            pictures.add(self.picture())
        self.assertEqual(len(pictures), 3)
        size = 1e3 * np.ptp(blocks.points[blocks.zones[~blocks.of_bearing]], axis=(0, 1))
        browser.run("const m = document.getElementById('magnification'); m.value = 20; m.onchange()")
        for view, width in (("x 0", size[2]), ("z 1", size[0])):
            self.look(view)
            browser.press("l")
            length = browser.run("return pyroclast.probes.along.drawing.x.at(-1)")
            browser.press("l")
            self.assertTrue(0.85 * width < length <= 1.001 * width, (view, length, width))
        moves = run.gridpoint_displacement(run.frames[-1])
        block = int(number[~blocks.of_bearing][0])
        mean = moves[np.unique(blocks.sides[0][number[blocks.sides[1]] == block])].mean(axis=0)
        kept = browser.run("return pyroclast.scene.body.displacement(pyroclast.scene.frame, arguments[0])", block)
        step = browser.run("return pyroclast.arrays.shift_x.step")
        self.assertLessEqual(np.abs(np.array(kept) - mean).max(), step)
        self.assert_silent()

    def look(self, view: str):
        browser.run("const v = document.getElementById('view'); v.value = arguments[0]; v.onchange()", view)

    def test_the_outside_of_a_solid_is_painted_from_all_sides(self):
        run = pyroclast.read(RUNS / "starter_3d")
        browser.open(self.page_of(run.folder))
        blocks = run.mesh.blocks
        corners, zone, outer = blocks.sides
        owner = np.unique(blocks.block, return_inverse=True)[1].ravel()[zone][outer]
        at = blocks.points[corners[outer]]
        browser.press("Home")  # nothing has moved yet
        pictures, hit = set(), 0
        # to the right, up and towards the eye: axes and their signs
        for view, axes in (("x 1", (-3, 2, 1)), ("x -1", (3, 2, -1)), ("y 1", (1, -3, 2)), ("y -1", (1, 3, -2)),
                           ("z 1", (1, 2, 3)), ("z -1", (-1, 2, -3))):
            self.look(view)
            pictures.add(self.picture())
            self.assertIsNone(browser.run("return pyroclast.scene.body.raster"))  # WebGL is by the processor here
            seen = np.stack([np.sign(k) * (at - 0.5 * np.ptp(blocks.points, axis=0)
                                           - blocks.points.min(axis=0))[..., abs(k) - 1] for k in axes], axis=-1)
            shares = ((0.5, 0.5), (0.45, 0.6), (0.6, 0.45), (0.42, 0.42), (0.55, 0.7))
            told = browser.run(
                "const {W, H} = pyroclast.specimen, b = pyroclast.scene.body; return arguments[0].map(([x, y]) => {"
                "const i = Math.floor(x * W), j = Math.floor(y * H);"
                "return [b.ids[j * W + i], ...b.fromPixels(i + 0.5, j + 0.5, W, H)]; })", shares)
            for block, x, y in told:
                there = [k for k, three in enumerate(seen) if Path(three[:, :2]).contains_point((x, y))]
                if there:
                    hit += 1
                    self.assertEqual(block, owner[max(there, key=lambda k: seen[k, :, 2].mean())], view)
        self.assertEqual(len(pictures), 6)
        self.assertGreaterEqual(hit, 20)
        self.assert_silent()

    def test_the_outside_of_a_solid_turns_and_shows_its_cracks_as_webgl_does(self):
        browser.open(self.page_of(RUNS / "cube_3d"))
        self.look("turned")
        pictures = [self.picture()]
        box = browser.place("#body")
        x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
        browser.mouse("mousePressed", x, y)
        browser.mouse("mouseMoved", x + 40, y + 20)
        browser.mouse("mouseReleased", x + 40, y + 20)
        pictures.append(self.picture())
        self.assertEqual(browser.run("return pyroclast.probes.pins.length"), 0)
        for key in "aw+":
            browser.press(key)
            pictures.append(self.picture())
        browser.press("-")
        browser.press("ArrowLeft")
        pictures.append(self.picture())
        browser.press("End")
        browser.run("const {W, H} = pyroclast.specimen; pyroclast.scene.tell('probe', [W / 2, H / 2])")
        self.assertRegex(browser.run("return document.getElementById('tip').textContent"), "block|crack")
        lines = browser.run("const {body, frame} = pyroclast.scene; return body.cracks(frame).map((c) => body.line(c))")
        self.assertGreater(len(lines), 10)
        self.assertTrue(np.isfinite(lines).all())
        browser.run("const a = document.getElementById('alone'); a.checked = true; a.onchange()")
        pictures.append(self.picture())
        shown = browser.run("const b = pyroclast.scene.body; return [...new Set(b.ids)].filter((k) => k >= 0)"
                            ".map((k) => k < b.blocks ? NaN : b.crackStep[k - b.blocks])")
        self.assertGreater(len(shown), 20)
        self.assertTrue(all(step is not None and step >= 0 for step in shown))
        self.assertEqual(len(set(pictures)), len(pictures))
        self.assert_silent()
        differing, error = browser.run(
            "WebGL2RenderingContext.prototype.getExtension = () => null;"  # so that it is not known to be slow
            "const b = pyroclast.scene.body; b.alone = false; pyroclast.scene.tell('frame');"
            "const painted = b.ids.slice(); b.raster = undefined; pyroclast.scene.tell('frame');"
            "let n = 0; painted.forEach((id, k) => { if (id !== b.ids[k]) n++; });"
            "return [n / painted.filter((id) => id >= 0).length, b.raster.gl.getError()]")
        self.assertEqual(error, 0)
        # the painter goes by the middles of triangles, so a few of them stand in another order
        self.assertLess(differing, 0.03)
        self.assertEqual([text for text in browser.console() if "GL Driver Message" not in text], [])

    def test_energies_that_contacts_lost_are_those_of_the_history(self):
        run = pyroclast.read(RUNS / "compression")
        browser.open(self.page_of(run.folder))
        for name in ("tension", "shear", "friction", "compression"):
            sums = browser.run("const a = pyroclast.arrays[`lost_${arguments[0]}`]; return [10, 20, 30].map((f) => "
                               "{ let s = 0; for (let c = 0; c < a.width; c++) s += a.at(f, c); return s; })", name)
            rows = np.searchsorted(run.history["step"], [run.frames[f].step for f in (10, 20, 30)])
            step = browser.run("return pyroclast.arrays[`lost_${arguments[0]}`].step", name)
            # of each contact half a step, and single precision of the fields
            often = 0.5 * step * np.sqrt(len(run.mesh.contacts.cells)) * 4.0
            for told, lost in zip(sums, run.history[f"dissipated_{name}_J"][rows]):
                self.assertAlmostEqual(told, lost, delta=often + 1e-4 * lost)

    def test_properties_are_those_of_the_run_and_gas_is_beside_the_temperatures(self):
        run = RUNS / "fire_one_side"
        subprocess.run([os.environ["PYROCLAST"], "plot-properties", run / "deck.toml", "-o", self.folder],
                       check=True, stdout=subprocess.DEVNULL)
        every, few = (read_properties(folder / "properties.csv") for folder in (self.folder, run))
        rows = [sum(len(one.value) for one in table.values()) for table in (every, few)]
        self.assertLess(rows[1], 0.1 * rows[0])
        for name, one in few.items():
            values = np.interp(every[name].temperature, one.temperature, one.value)
            # 0.1 % that fewer rows may miss, and twelve digits
            self.assertLessEqual(np.abs(values - every[name].value).max(), 1.001e-3 * np.abs(every[name].value).max(),
                                 name)
        browser.open(self.page_of(run))
        browser.run("for (const tab of ['properties', 'heat']) "
                    "document.querySelector(`#tabs [data-tab=${tab}]`).click()")
        titles = browser.run("return [...document.querySelectorAll('#properties h3')].map((h) => h.textContent)")
        self.assertEqual(titles, [panel.title for panel in panels(few)])
        self.assertIn("hottest gas [°C]", browser.run("return document.getElementById('heat').textContent"))
        self.assert_silent()
        browser.open(self.page_of(RUNS / "compression"))
        self.assertIsNone(browser.run("return document.getElementById('properties')"))

    def test_a_solid_stays_closed_where_blocks_leave(self):
        browser.open(self.page_of(RUNS / "spalling_slab_3d"))
        self.look("turned")
        browser.press("End")
        left, bared, leak = browser.run(
            "const {body: b, frame} = pyroclast.scene, {values} = b.arrays.triangle, sum = [0, 0, 0]; let all = 0;"
            "b.place(frame, 0);"
            "for (const t of b.shown) {"
            "  const [p, q, r] = [0, 1, 2].map((e) => b.space.subarray(3 * values[3 * t + e], 3 * values[3 * t + e] + 3)),"
            "    [u, v] = [q, r].map((x) => x.map((c, k) => c - p[k])),"
            "    area = [0, 1, 2].map((k) => u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);"
            "  area.forEach((a, k) => { sum[k] += a; });"
            "  all += Math.hypot(...area); }"
            "return [[...Array(b.blocks).keys()].filter((k) => b.isGone(frame, k)).length, b.bared.of.length,"
            "        Math.hypot(...sum) / all];")
        self.assertGreater(left, 0)
        self.assertGreater(bared, left)
        self.assertLess(leak, 1e-5)  # single precision
        self.assert_silent()

    def test_water_has_pressures_amounts_and_fields(self):
        run = pyroclast.read(RUNS / "kalifa_m100")
        browser.open(self.page_of(run.folder))
        browser.run("document.querySelector('#tabs [data-tab=water]').click()")
        self.assertIn("largest pore pressure [MPa]",
                      browser.run("return document.getElementById('pore_pressures').textContent"))
        self.assertIn("water that left [kg]", browser.run("return document.getElementById('water').textContent"))
        last = len(run.frames) - 1
        told = browser.run("const a = pyroclast.arrays.pore_pressure; let m = 0; for (let b = 0; b < a.width; b++) "
                           "m = Math.max(m, a.at(arguments[0], b)); return m", last)
        row = np.searchsorted(run.history["heating_time_s"], run.frames[last].heating_time)
        self.assertAlmostEqual(told, run.history["pore_pressure_max_MPa"][row], delta=0.006)
        self.assert_silent()

    def test_heat_has_isotherms_and_a_line_across(self):
        run = pyroclast.read(RUNS / "thermal_wall")
        browser.open(self.page_of(run.folder))
        levels = browser.run("return pyroclast.specimen.levels")
        field = run.gridpoint_temperature(run.frames[-1])
        self.assertTrue(levels)
        self.assertTrue(all(field.min() < level < field.max() for level in levels))
        x = run.mesh.blocks.points[:, 0] - run.mesh.blocks.points[:, 0].min()
        order = np.argsort(-field)  # the wall is heated on the left, and its temperatures fall to the right
        side, depths = browser.run("const d = pyroclast.scene.body.depths(pyroclast.scene.frame, arguments[0]); "
                                   "return [d.side, d.depths]", levels)
        self.assertEqual((side, [level for level, _ in depths]), ("left side", levels))
        for level, depth in depths:
            self.assertAlmostEqual(depth, np.interp(-level, -field[order], x[order]), delta=0.03 * x.max())
        self.assertIn(" mm", browser.run("return document.getElementById('depths').textContent"))
        hottest = max(run.gridpoint_temperature(frame).max() for frame in run.frames)
        told = browser.run("return pyroclast.scene.body.range('temperature').high")
        self.assertAlmostEqual(told, hottest, delta=0.26)
        for width in (500, 110):  # where lines leave little room
            near = browser.run(
                "const s = pyroclast.specimen, f = pyroclast.scene.frame; "
                "s.size(arguments[0], 800); s.draw(); "
                "return s.named.map(([x, y]) => s.levels.map((level) => Math.min(...s.body.isotherms(f, level).map("
                "(l) => Math.hypot((l[0] + l[2]) / 2 - x, (l[1] + l[3]) / 2 - y)))))", width)
            self.assertTrue(near or width == 110)
            for distances in near:
                others = sorted(d for d in distances if d is not None)[1:]  # the nearest line is its own
                self.assertTrue(all(d > 8.0 for d in others), others)
        browser.press("l")
        values = browser.run("const s = pyroclast.specimen; "
                             "return s.valuesAt(s.samples(), 'temperature', pyroclast.scene.frame)")
        self.assertGreater(len(values), 50)
        falls = [later <= before + 0.5 for before, later in zip(values, values[1:])]
        self.assertTrue(all(falls), "from the hot face")
        self.assert_silent()

    def test_planes_through_a_hot_solid_have_isotherms_and_depths(self):
        deck = pyroclast.Deck(ROOT / "tests/hot_slab.toml")
        deck["heat.boundaries[0].faces"] = "front"
        with pyroclast.Run(deck, out=self.folder / "front") as run:
            run.finish()
        results = pyroclast.read(self.folder / "front")
        browser.open(self.page_of(results.folder))
        # the first plane goes into the depth below the heated face
        self.assertEqual(browser.run("return document.getElementById('view').value"), "x 0")
        self.assertTrue(browser.run("return pyroclast.specimen.levels"))
        self.assertAlmostEqual(browser.run("return pyroclast.scene.body.range('temperature').high"), 1000.0, delta=0.26)
        profile = read_profile(results)
        for view in ("x 0", "y 0"):
            self.look(view)
            side, depths = browser.run("const d = pyroclast.scene.body.depths(pyroclast.scene.frame, [500, 300]); "
                                       "return [d.side, d.depths]")
            self.assertEqual((side, [level for level, _ in depths]), ("front side", [500, 300]))
            for level, depth in depths:  # mean over blocks of 13 mm, and the profile is of one line
                told = np.interp(-level, -profile.temperature[-1], profile.depth)
                self.assertAlmostEqual(depth, told, delta=2e-3, msg=(view, level))
        self.look("x 0")
        browser.press("l")
        values = browser.run("const s = pyroclast.specimen; "
                             "return s.valuesAt(s.samples(), 'temperature', pyroclast.scene.frame)")
        self.assertGreater(len(values), 50)
        self.assertTrue(all(later <= before + 2.0 for before, later in zip(values, values[1:])), "from the hot face")
        self.look("z 0")  # along the heated face: no side is the hot one
        self.assertEqual(browser.run("return pyroclast.scene.body.depths(pyroclast.scene.frame, [100]).depths"), [])
        self.look("turned")  # from outside, at first from the side of the heated face; with the line across
        self.assertLess(browser.run("return pyroclast.scene.body.axes[2][2]"), 0.0)
        self.look("z -1")
        self.assert_silent()


if __name__ == "__main__":
    unittest.main()
