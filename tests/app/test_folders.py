"""Folders of others: what stands in one acts on nothing outside of it, nor does the current folder act on anything.
PYROCLAST names the program.
"""

import errno
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from sanitized import needs_studies  # noqa: E402
from test_user import CARELESS_LAW, PROGRAM, UserTest, deck_of_careless_law, preprocessor, small_deck  # noqa: E402

FRAME = "fields/blocks_0001.hdf"
ARRAY = "VTKHDF/PointData/displacement [m]"
SECRET = b"a word that is nobody's business; "


def keep_outside(frame: h5py.File, folder: pathlib.Path) -> None:
    shape = frame[ARRAY].shape
    del frame[ARRAY]
    frame.create_dataset(ARRAY, shape, "u1", external=[(str(folder / "secret.txt"), 0, shape[0] * shape[1])])


def put_together(frame: h5py.File, folder: pathlib.Path) -> None:
    shape = frame[ARRAY].shape
    del frame[ARRAY]
    layout = h5py.VirtualLayout(shape, "f4")
    layout[:] = h5py.VirtualSource(folder / "secret.h5", "a", shape)
    frame.create_virtual_dataset(ARRAY, layout)


def link(name: str, to: object):
    def change(frame: h5py.File, folder: pathlib.Path) -> None:
        del frame[name]
        frame[name] = to(folder) if callable(to) else to
    return change


def pack_by_another_filter(frame: h5py.File, folder: pathlib.Path) -> None:
    shape = frame[ARRAY].shape
    del frame[ARRAY]
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    made.set_chunk(shape)
    made.set_filter(32001, h5py.h5z.FLAG_OPTIONAL, (1,))
    space = h5py.h5s.create_simple(shape)
    h5py.h5d.create(frame.id, ARRAY.encode(), h5py.h5t.NATIVE_FLOAT, space, dcpl=made)


ELSEWHERE = {
    "external storage": keep_outside,
    "virtual dataset": put_together,
    "link to a file": link(ARRAY, lambda folder: h5py.ExternalLink(str(folder / "secret.h5"), "/a")),
    "link to another object of the mesh": link(ARRAY, h5py.ExternalLink("mesh.h5", "/blocks/Points")),
    "link by a path": link("VTKHDF/Points", h5py.ExternalLink("../fields/mesh.h5", "/blocks/Points")),
    "linked group": link("VTKHDF/PointData", h5py.ExternalLink("mesh.h5", "/blocks/PointData")),
    "soft link": link(ARRAY, h5py.SoftLink("/VTKHDF/Points")),
    "filter that is code": pack_by_another_filter,
}


class FolderTest(UserTest):
    """Each test has a copy of a small run, `out`."""

    @classmethod
    def setUpClass(cls):
        cls.common = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.common)
        (cls.common / "deck.toml").write_text(small_deck())
        done = subprocess.run([PROGRAM, "run", "deck.toml", "--out", "out", "--no-figures", "--quiet"], cwd=cls.common,
                              capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr

    def setUp(self):
        super().setUp()
        self.out = shutil.copytree(self.common / "out", self.folder / "out")

    def break_off(self) -> None:
        """Makes the run one that was killed."""
        (self.out / "summary.json").unlink()
        newest = max((self.out / "checkpoints").glob("*.state"))
        self.assertTrue(newest.exists())

    def assert_says(self, done: subprocess.CompletedProcess, code: int, *words: str) -> None:
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        for word in words:
            self.assertIn(word, done.stdout + done.stderr)


class Links(FolderTest):
    def assert_refused(self, name: str, lay, words: tuple, says: str) -> None:
        """A link to a file of mine is not written through."""
        mine = self.write("precious", "thesis.tex")
        place = self.out / name
        kept = place.read_bytes() if place.is_file() else None
        place.unlink(missing_ok=True)
        lay(place, mine)
        self.assert_says(self.pyroclast(*words), 1, f"{name}: is a link", says)
        self.assertEqual(mine.read_text(), "precious")
        place.unlink()
        if kept is not None:
            place.write_bytes(kept)

    def test_nothing_is_written_through_a_link(self):
        for name, words in (("lock", ("figures", "run", "out")),
                            ("lock", ("run", "deck.toml", "--out", "out", "--overwrite")),
                            ("run.log", ("resume", "out")), ("history.csv", ("resume", "out")),
                            ("fields/frames.csv", ("resume", "out"))):
            self.write(small_deck())
            for says, lay in (("remove it", pathlib.Path.symlink_to),
                              ("copied by links (cp -l, rsync --link-dest)", pathlib.Path.hardlink_to)):
                with self.subTest(f"{name}, {says}"):
                    self.assert_refused(name, lay, words, says)

    def test_nor_is_a_figure_drawn_into_a_linked_folder(self):
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        (self.out / "figures").symlink_to(elsewhere)
        for words in ((), ("--format", "svg")):
            self.assert_says(self.pyroclast("figures", "run", "out", *words), 1, "figures: is a link")
        self.assertEqual(list(elsewhere.iterdir()), [])

    def test_a_new_run_does_not_empty_the_file_that_its_lock_is_a_link_to(self):
        mine = self.write("precious", "thesis.tex")
        (self.folder / "new").mkdir()
        (self.folder / "new/lock").hardlink_to(mine)
        done = self.pyroclast("run", self.write(small_deck()), "--out", "new", "--no-figures")
        self.assert_says(done, 1, "new/lock: is a link")
        self.assertEqual((mine.read_text(), self.files("new")), ("precious", {"lock"}))

    def test_a_run_that_was_copied_by_links_is_not_resumed_and_its_copy_is(self):
        self.break_off()
        subprocess.run(["cp", "-al", "out", "snapshot"], cwd=self.folder, check=True)
        before = (self.folder / "snapshot/run.log").read_bytes()
        self.assert_says(self.pyroclast("resume", "out"), 1, "copy the folder whole (cp -r)")
        self.assertEqual((self.folder / "snapshot/run.log").read_bytes(), before)
        subprocess.run(["cp", "-r", "out", "whole"], cwd=self.folder, check=True)
        self.assertEqual(self.pyroclast("resume", "whole", "--no-figures").returncode, 0)
        self.assertEqual((self.folder / "snapshot/run.log").read_bytes(), before)


class FieldsElsewhere(FolderTest):
    """The data of a run lie in its folder: a frame that takes them from elsewhere is damaged."""

    def setUp(self):
        super().setUp()
        (self.folder / "secret.txt").write_bytes(1000 * SECRET)
        with h5py.File(self.folder / "secret.h5", "w") as file:
            with h5py.File(self.out / FRAME) as frame:
                file["a"] = np.full(frame[ARRAY].shape, 77.0, "f4")

    def damage(self, change, frame: str = FRAME) -> None:
        shutil.copy(self.common / "out" / frame, self.out / frame)
        with h5py.File(self.out / frame, "r+") as file:
            change(file, self.folder)

    def test_a_page_leaves_the_frame_out_and_says_so(self):
        """Four frames are damaged at once, each in another way: a page names as many."""
        ways = list(ELSEWHERE)
        while ways:
            damaged = {f"fields/blocks_{number:04}.hdf": ways.pop() for number in range(1, 5) if ways}
            for frame, way in damaged.items():
                self.damage(ELSEWHERE[way], frame)
            self.assert_says(self.pyroclast("report", "out"), 0)
            page = (self.out / "report.html").read_text()
            for number, (frame, way) in enumerate(damaged.items(), 1):
                with self.subTest(way):
                    self.assertIn(f"frame {number} is left out: out/{frame}: is a damaged HDF5 file: ", page)

    def test_resume_counts_the_frame_as_lost(self):
        self.break_off()
        for name, change in ELSEWHERE.items():
            with self.subTest(name):
                self.damage(change)
                (self.out / "summary.json").unlink(missing_ok=True)
                done = self.pyroclast("resume", "out", "--no-figures")
                self.assert_says(done, 0, f"a frame is lost: {FRAME} is missing")

    def test_a_deck_does_not_take_temperatures_from_it(self):
        deck = self.write(small_deck() + f'\n[coupling]\nstress_free = {{ frame = "out/{FRAME}" }}\n')
        for change in (None, keep_outside, put_together, link("VTKHDF/Points", h5py.ExternalLink("secret.h5", "/a"))):
            self.damage(change or (lambda frame, folder: None))
            done = self.pyroclast("check", deck)
            said = re.findall(r"deck\.toml:\d+:\d+: coupling\.stress_free\.frame = .*", done.stderr)
            if change is None:
                self.assertEqual(said, [], done.stderr)
            else:
                self.assertIn(f"out/{FRAME}: is damaged: /VTKHDF/", said[0])
                self.assertEqual(done.returncode, 1)

    def test_figures_name_the_frame(self):
        for path in self.out.glob("fields/blocks_*.hdf"):
            with h5py.File(path, "r+") as frame:
                keep_outside(frame, self.folder)
        done = self.pyroclast("figures", "run", "out")
        self.assert_says(done, 1, ".hdf: is a damaged HDF5 file", "lie in its folder")

    def test_frames_as_they_were_written_are_whole(self):
        self.break_off()
        done = self.pyroclast("resume", "out", "--no-figures")
        self.assertNotIn("lost", done.stdout)
        self.assertNotIn("left out", self.page())

    def page(self) -> str:
        self.assertEqual(self.pyroclast("report", "out").returncode, 0)
        return (self.out / "report.html").read_text()

    def test_a_mesh_that_is_a_link_is_not_shown(self):
        mesh = self.out / "fields/mesh.h5"
        mesh.rename(self.folder / "mesh.h5")
        mesh.symlink_to(self.folder / "mesh.h5")
        self.assertIn("the specimen cannot be shown: out/fields/mesh.h5: is a link", self.page())

    def test_the_mesh_of_the_current_folder_does_not_stand_in_for_a_run_s_own(self):
        shutil.move(self.out / "fields/mesh.h5", self.folder / "mesh.h5")
        self.assertIn("the specimen cannot be shown: out/fields/mesh.h5: does not exist", self.page())


class CurrentFolder(FolderTest):
    """What a library, the compiler or Python looks for in the current folder is not taken from there."""

    MARK = "open('{mark}', 'w')\nraise SystemExit(7)\n"

    def setUp(self):
        super().setUp()
        self.here = self.folder / "here"
        self.here.mkdir()
        self.mark = self.folder / "taken"

    def plant(self, name: str, text: str, mode: int = 0o644) -> None:
        file = self.here / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text.replace("{mark}", str(self.mark)), encoding="latin-1")
        file.chmod(mode)

    def in_folder(self, folder: pathlib.Path, *words: str, **env: str) -> subprocess.CompletedProcess:
        done = subprocess.run([PROGRAM, *words], cwd=folder, env=os.environ | env, capture_output=True, text=True,
                              timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertFalse(self.mark.exists(), f"{words}: {self.mark.read_text() if self.mark.exists() else ''}")
        return done

    def pictures(self, folder: pathlib.Path, **env: str) -> dict[str, bytes]:
        """What figures, watch, plot-properties and report draw of the run, from a current folder."""
        for name in ("figures", "properties"):
            shutil.rmtree(self.folder / "out" / name, ignore_errors=True)
        deck = str(self.folder / "out/deck.toml")
        for words in (("figures", "run", str(self.out), "--only", "stress_strain"),
                      ("watch", str(self.out), "--once"), ("report", str(self.out)),
                      ("plot-properties", deck, "--out", str(self.out / "properties"))):
            self.assertEqual(self.in_folder(folder, *words, **env).stderr, "")
        return {str(file.relative_to(self.out)): file.read_bytes() for file in self.out.rglob("*")
                if file.suffix in (".png", ".html")}

    def test_pictures_are_the_same_whatever_lies_there(self):
        expected = self.pictures(self.folder)
        self.assertEqual(len(expected), 4)
        for name in ("random.py", "numpy.py", "matplotlib.py", "sitecustomize.py", "usercustomize.py",
                     "h5py/__init__.py", "PIL/__init__.py", "pyroclast/__init__.py"):
            self.plant(name, self.MARK)
        for name in ("latex", "fc-list", "c++", "python3"):
            self.plant(name, "#!/bin/sh\necho $0 > {mark}\nexit 1\n", 0o755)
        self.plant("matplotlibrc", "text.usetex: True\nsavefig.dpi: 20\nfont.size: 20\nno_such_key: 1\n")
        named = {name: ":" for name in ("PATH", "PYTHONPATH", "HDF5_PLUGIN_PATH", "HDF5_EXT_PREFIX", "CPATH")}
        named |= {"PATH": f":.:{os.environ['PATH']}", "MATPLOTLIBRC": "matplotlibrc", "MPLCONFIGDIR": ".",
                  "XDG_CONFIG_HOME": ".", "PYTHONUSERBASE": ".", "HDF5_DRIVER": "nothing"}
        self.assertEqual(self.pictures(self.here, **named), expected)
        self.plant("matplotlibrc", "savefig.dpi: 20\n\xff\xfe")
        picture = self.out / "figures/stress_strain.png"
        picture.unlink()
        self.in_folder(self.folder, "figures", "run", str(self.out), "--only", picture.stem,
                       MATPLOTLIBRC=str(self.here / "matplotlibrc"))
        self.assertEqual(picture.read_bytes(), expected["figures/stress_strain.png"])

    def test_the_compiler_takes_neither_headers_nor_programs_from_there(self):
        self.write(CARELESS_LAW, "careless.hpp")
        for name in ("cmath", "vector", "array", "stdint.h"):
            self.plant(name, "#error taken from the current folder\n")
        for name in ("as", "ld", "cc1plus", "collect2", "c++"):
            self.plant(name, "#!/bin/sh\necho $0 > {mark}\nexit 1\n", 0o755)
        places = {"CPATH": f":{os.environ.get('CPATH', '')}", "CPLUS_INCLUDE_PATH": ".", "C_INCLUDE_PATH": "./",
                  "COMPILER_PATH": ".:", "LIBRARY_PATH": ":", "GCC_EXEC_PREFIX": "./",
                  "PATH": f".:{os.environ['PATH']}"}
        done = self.in_folder(self.here, "check", str(self.write(deck_of_careless_law(1.0))), PYROCLAST_CODE="always",
                              PYROCLAST_CACHE=str(self.folder / "cache"), **places)
        self.assertIn("compiling a law: ", done.stderr)

    def test_a_list_of_allowed_code_there_allows_nothing(self):
        self.write(CARELESS_LAW, "careless.hpp")
        deck = self.write(deck_of_careless_law(1.0))
        env = os.environ | {"PYROCLAST_CODE": "ask", "XDG_CONFIG_HOME": str(self.here), "HOME": str(self.folder),
                            "PYROCLAST_CACHE": str(self.folder / "cache"), "CXX": preprocessor(self.folder)}
        words = [PROGRAM, "check", str(deck)]
        subprocess.run([*words, "--allow-code"], env=env, capture_output=True, check=False)
        self.assertTrue((self.here / "pyroclast/allowed-code").exists())
        done = subprocess.run(words, env=env | {"XDG_CONFIG_HOME": "."}, cwd=self.here, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 3, done.stderr)
        (self.here / "pyroclast").chmod(0o770)
        done = subprocess.run(words, env=env, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r"here/pyroclast: others than you may write there.* chmod 0700 .*/pyroclast")

    def test_a_table_that_is_no_regular_file_is_refused(self):
        os.mkfifo(self.folder / "pipe")
        for file in ("/dev/zero", "pipe"):
            deck = self.write(small_deck().replace('E = "29.4 GPa"', f'E = {{ csv = "{file}" }}'))
            done = subprocess.run([PROGRAM, "check", deck], cwd=self.folder, capture_output=True, text=True,
                                  timeout=120, check=False)
            self.assert_says(done, 1, f"{file}: is no regular file")


class Texts(FolderTest):
    """A terminal obeys no text of others."""

    def test_paths_are_written_out(self):
        odd = "a\x1b[31mb\x07\u202e\x9bc"
        self.out.rename(self.folder / f"{odd}\nd")
        for words in (("report", f"{odd}\nd"), ("figures", "run", f"{odd}\nd", "--only", "cracks"),
                      ("watch", f"{odd}\nd", "--once"), ("report", odd), ("figures", "run", odd),
                      ("watch", odd, "--once"), ("resume", odd)):
            done = self.pyroclast(*words)
            said = done.stdout + done.stderr
            self.assertIn(r"a\x1b[31mb\x07\u202e\x9bc" + (r"\nd" if "\n" in "".join(words) else ""), said, words)
            self.assertNotRegex(said, "[\x1b\x07\u202e\x9b]", words)

    def test_a_name_that_is_no_text_is_written_out_too(self):
        odd = os.fsencode(self.folder) + b"/a\xffb"
        os.rename(self.out, odd)
        done = subprocess.run([os.fsencode(PROGRAM), b"report", odd], capture_output=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(rb"/a\udcffb/report.html", done.stdout)

    def test_a_long_formula_is_shortened(self):
        long = " + ".join(["T"] * 100_000)
        for formula in (f"{long} + nothing_of_this_name", f"{long} = 1", f"{long}, 1", f"({long}", f"1 / 0 * ({long})"):
            deck = self.write(small_deck().replace(
                'E = "29.4 GPa"', f'E = {{ expression = "{formula}", unit = "GPa", range = ["20 degC", "800 degC"] }}'))
            done = self.pyroclast("check", deck)
            self.assertEqual(done.returncode, 1)
            self.assertIn("deck.toml:", done.stderr)
            self.assertLess(len(done.stderr), 1500)
            self.assertRegex(done.stderr, r"\.\.\. \(\d+ characters\)")


class Interrupted(FolderTest):
    """Ctrl-C ends a program with 130 and no more than a line. It stands at a pipe that nobody writes."""

    def interrupted(self, *words: str, pipe: str, by: signal.Signals = signal.SIGINT) -> str:
        with subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True, start_new_session=True) as process:
            end = self.write_end(self.folder / pipe)
            os.killpg(process.pid, by)
            _, said = process.communicate(timeout=120)
            os.close(end)
        self.assertEqual(process.returncode, 130, said)
        self.assertNotIn("Traceback", said)
        self.assertLessEqual(said.count("\n"), 1, said)
        return said

    def write_end(self, pipe: pathlib.Path) -> int:
        """Waits until a program reads the pipe."""
        for _ in range(1200):
            try:
                return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
            except OSError as error:
                self.assertEqual(error.errno, errno.ENXIO)
            time.sleep(0.05)
        self.fail("nobody reads the pipe")

    def test_within_a_program_of_the_package(self):
        (self.out / "history.csv").unlink()
        os.mkfifo(self.out / "history.csv")
        for words in (("report", "out"), ("figures", "run", "out"), ("watch", "out", "--once")):
            for by in (signal.SIGINT, signal.SIGTERM):
                with self.subTest(f"{words[0]}, {by.name}"):
                    self.interrupted(*words, pipe="out/history.csv", by=by)
        self.assertFalse((self.out / "lock").exists())
        self.assertEqual(list(self.out.rglob("*.partial")), [])

    @needs_studies
    def test_within_the_report_of_a_study(self):
        os.mkfifo(self.folder / "pipe")
        self.write('[study]\ndeck = "out/deck.toml"\nearlier = ["pipe"]\n[method]\nkind = "ensemble"\n'
                   '[outputs]\nf_c = "f_c_MPa"\n', "study.toml")
        self.interrupted("study", "report", "study.toml", pipe="pipe")


class LeftOver(FolderTest):
    def test_overwriting_clears_what_was_never_finished(self):
        (self.out / "figures").mkdir()
        for name in ("figures/cracks.png.5dd098b8.partial", "figures/plane_z_0.5.pdf.00000000.partial",
                     "figures/fracture.csv.0a1b2c3d.partial", "report.html.deadbeef.partial",
                     "figures/watch.png.12345678.partial", "temperature_profile.csv.ffffffff.partial",
                     "history.csv.partial", "checkpoints/000009.state.partial"):
            (self.out / name).write_text("half")
        self.assert_that_overwriting_clears("out")

    def test_but_not_files_of_the_user(self):
        (self.out / "figures").mkdir()
        mine = {"figures/mine.png.5dd098b8.partial", "figures/cracks.png.5dd098b.partial",
                "figures/cracks.png.5dd098bg.partial", "thesis.5dd098b8.partial", "5dd098b8.partial"}
        for name in mine:
            (self.out / name).write_text("mine")
        done = self.pyroclast("specimen", self.write(small_deck()), "--out", "out", "--overwrite", "--no-figures")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLessEqual(mine, self.files("out"))

    def test_figures_of_a_leg_go_when_the_run_is_resumed(self):
        """A leg draws what the whole run does not, as where it was ended before it was heated."""
        self.break_off()
        (self.out / "figures").mkdir()
        for name in ("figures/total_strain.png", "figures/heating_fracture.csv", "figures/plane_z_0.5.svg",
                     "report.html", "figures/watch.png", "figures/cracks.png.5dd098b8.partial", "history.csv.partial",
                     "figures/mine.png", "notes.txt", "figures/morphology.png"):
            (self.out / name).write_text("old")
        before = self.files("out")
        self.assert_says(self.pyroclast("resume", "out", "--no-figures"), 0)
        self.assertEqual(before - self.files("out"), {
            "figures/total_strain.png", "figures/heating_fracture.csv", "figures/plane_z_0.5.svg", "report.html",
            "figures/watch.png", "figures/cracks.png.5dd098b8.partial", "history.csv.partial"})
        # a run that is over has the figures of its end
        (self.out / "report.html").write_text("new")
        self.assert_says(self.pyroclast("resume", "out"), 1, "the run is over")
        self.assertTrue((self.out / "report.html").exists())

    def test_a_resumed_run_has_the_figures_of_a_whole_one(self):
        self.break_off()
        (self.out / "figures").mkdir()
        (self.out / "figures/thrust.png").write_text("of a leg")
        self.assert_says(self.pyroclast("resume", "out"), 0)
        drawn = {name for name in self.files("out") if re.fullmatch(r"figures/.*|report\.html", name)}
        self.assertEqual(drawn, {"report.html", "figures/fracture.csv", *(
            f"figures/{name}.png" for name in ("stress_strain", "cracks", "energy", "fracture"))})


if __name__ == "__main__":
    unittest.main()
