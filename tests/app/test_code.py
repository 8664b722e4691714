"""Code that came with a deck or a study runs after the user's word, by whatever command. PYROCLAST names the program."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from test_user import CARELESS_LAW, PROGRAM, deck_of_careless_law  # noqa: E402

MARK = """#include <cstdio>
[[gnu::constructor]] static void mark() {
  if (FILE* file = std::fopen("MARK", "w")) std::fclose(file);
}
"""
NOT_ALLOWED = 3
STUDY = """[study]
seeds = 1
{runner}
[method]
kind = "ensemble"
[outputs]
y = "y"
"""
FUNCTION = """import pathlib
import helper
pathlib.Path("{mark}").touch()
def model(seed):
    return {{"y": 1.0}}
"""


class CodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.common = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.common)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.mark = self.common / "mark"
        self.env = os.environ | {"PYROCLAST_CACHE": str(self.common / "cache"), "HOME": str(self.folder / "home"),
                                 "XDG_CONFIG_HOME": str(self.folder / "home"), "PYROCLAST_CODE": "ask"}
        (self.folder / "law.hpp").write_text(MARK.replace("MARK", str(self.mark)) + CARELESS_LAW)
        deck = deck_of_careless_law(1.0).replace('stop_strain = 2e-4', 'stop_strain = 2e-5').replace("count = 100", "count = 40")
        (self.folder / "header.toml").write_text(deck.replace("careless.hpp", "law.hpp"))
        (self.folder / "object.toml").write_text(deck.replace("careless.hpp", "law.so"))
        (self.folder / "plain.toml").write_text(deck.replace('law = "careless.hpp"', 'law = "elastic"').replace(
            'K = "18e12 Pa/m"', "").replace("times = 1.0", ""))

    def run_it(self, *words: str, **env: str) -> tuple[subprocess.CompletedProcess, bool]:
        """What the program says, and whether the code ran."""
        self.mark.unlink(missing_ok=True)
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, env=self.env | env, capture_output=True, text=True,
                              timeout=300, check=False)
        return done, self.mark.exists()

    def assert_refused(self, *words: str, says: str = "--allow-code", **env: str) -> subprocess.CompletedProcess:
        done, ran = self.run_it(*words, **env)
        self.assertEqual((done.returncode, ran), (NOT_ALLOWED, False), (words, done.stdout, done.stderr))
        self.assertIn(says, done.stdout + done.stderr)
        return done

    def assert_done(self, *words: str, runs: bool, codes: tuple = (0, 2), **env: str) -> subprocess.CompletedProcess:
        done, ran = self.run_it(*words, **env)
        self.assertIn(done.returncode, codes, (words, done.stdout, done.stderr))
        self.assertEqual(ran, runs, words)
        return done

    def make_object(self) -> None:
        """law.so: what the program compiles of the header."""
        self.assert_done("law", "--verify", "law.hpp", "--paths", "64", runs=True, codes=(0, 1))
        newest = max((self.common / "cache/laws").glob("*.so"), key=lambda file: file.stat().st_mtime)
        shutil.copy(newest, self.folder / "law.so")
        shutil.rmtree(self.folder / "home", ignore_errors=True)


class CodeOfADeck(CodeTest):
    PATH = "u_n [um]\n1\n"

    def commands(self, deck: str) -> dict[str, tuple[str, ...]]:
        """Of each command that reads a deck, one that needs its law."""
        (self.folder / "path.csv").write_text(self.PATH)
        return {
            "run": ("run", deck, "--out", "out", "--overwrite", "--no-figures"),
            "law": ("law", deck, "--path", "path.csv"),
            "check": ("check", deck),
        }

    def try_law(self, deck: str) -> None:
        for words in self.commands(deck).values():
            self.assert_refused(*words)
            self.assert_refused(*words, PYROCLAST_CODE="never", says="never")
        self.assertFalse((self.folder / "out").exists())
        # what needs no code is done without
        done = self.assert_done("specimen", deck, "--out", "specimen", "--no-figures", runs=False)
        self.assertIn("40 blocks", done.stdout)
        self.assertIn("not checked", self.assert_refused("check", deck).stdout)
        (self.folder / "wrong.toml").write_text((self.folder / deck).read_text().replace("count = 40", "count = -1"))
        wrong = self.assert_done("check", "wrong.toml", runs=False, codes=(1,))
        self.assertIn("blocks.count", wrong.stderr)
        # the user's word, once, for this code wherever it lies
        self.assert_done("check", deck, "--allow-code", runs=True)
        for words in self.commands(deck).values():
            self.assert_done(*words, runs=True)
        self.assert_refused("check", deck, PYROCLAST_CODE="never", says="never")
        self.assert_done("resume", "out", "--from-stage", "0", "--out", "fork", "--no-figures", runs=True)
        self.assert_done("watch", "out", "--once", runs=False)
        self.assert_done("figures", "run", "out", runs=False)
        # of somebody else: the same folders, another home
        shutil.rmtree(self.folder / "home")
        self.assert_refused("resume", "out", "--from-stage", "0", "--out", "other", "--no-figures")
        self.assert_refused("run", "out/deck.toml", "--out", "other", "--no-figures")
        self.assertFalse((self.folder / "other").exists())
        self.assert_done("figures", "run", "out", runs=False)
        self.assert_done("run", "out/deck.toml", "--out", "other", "--no-figures", runs=True, PYROCLAST_CODE="always")

    def test_a_header(self):
        self.assert_refused("run", "header.toml", "--out", "out", "--no-figures")
        self.assertIn("not checked", self.assert_refused("check", "header.toml").stdout)
        self.assert_done("run", "header.toml", "--out", "out", "--no-figures", "--allow-code", runs=True)
        self.assert_done("run", "out/deck.toml", "--out", "again", "--no-figures", runs=True)
        (self.folder / "law.hpp").write_text((self.folder / "law.hpp").read_text() + "// another\n")
        self.assert_refused("check", "header.toml")

    def test_a_shared_object(self):
        self.make_object()
        self.try_law("object.toml")

    def test_what_the_command_line_names_needs_no_word(self):
        self.make_object()
        self.assert_done("law", "--verify", "law.hpp", "--paths", "64", runs=True, codes=(0, 1))
        shutil.rmtree(self.folder / "home")
        self.assert_done("check", "object.toml", "--law-path", ".", runs=True)
        shutil.rmtree(self.folder / "home")
        named = [word for contact in ("mortar_mortar", "aggregate_mortar")
                 for word in ("--set", f"contacts.{contact}.law=law.so")]
        self.assert_done("check", "header.toml", *named, runs=True)
        shutil.rmtree(self.folder / "home")
        self.assert_refused("check", "header.toml", *named, "--of-study")

    def test_a_study_of_a_deck_with_a_law(self):
        self.make_object()
        (self.folder / "study.toml").write_text(STUDY.format(runner='deck = "object.toml"').replace(
            '[outputs]\ny = "y"', '[outputs]\nE = "E_GPa"'))
        self.assert_refused("study", "run", "study.toml", "--quiet")
        self.assert_done("study", "run", "study.toml", "--quiet", "--allow-code", runs=True, codes=(0, 1, 2))
        # a value of a study is no word of the user's
        (self.folder / "values.toml").write_text(STUDY.format(
            runner='deck = "plain.toml"\nchanges = { "contacts.mortar_mortar.law" = "law.so" }').replace(
                '[outputs]\ny = "y"', '[outputs]\nE = "E_GPa"'))
        shutil.rmtree(self.folder / "home")
        done, ran = self.run_it("study", "run", "values.toml", "--quiet")
        self.assertFalse(ran, done.stdout + done.stderr)
        self.assertNotEqual(done.returncode, 0)


class CodeOfAStudy(CodeTest):
    def try_study(self, runner: str, change) -> None:
        (self.folder / "study.toml").write_text(STUDY.format(runner=runner))
        self.assert_refused("study", "run", "study.toml")
        self.assert_refused("study", "run", "study.toml", PYROCLAST_CODE="never", says="never")
        for command in ("check", "status", "table"):
            done, ran = self.run_it("study", command, "study.toml")
            self.assertFalse(ran, (command, done.stderr))
        self.assert_done("study", "run", "study.toml", "--allow-code", runs=True)
        for command in ("status", "table", "report"):
            self.assert_done("study", command, "study.toml", runs=False)
        change()
        self.assert_refused("study", "run", "study.toml")
        self.assert_done("study", "run", "study.toml", runs=True, PYROCLAST_CODE="always")

    def test_a_function(self):
        (self.folder / "model.py").write_text(FUNCTION.format(mark=self.mark))
        (self.folder / "helper.py").write_text("")

        def change():
            (self.folder / "helper.py").write_text("# another\n")
            shutil.rmtree(self.folder / "study-study")

        self.try_study('runner = "function"\nfunction = "model.py:model"', change)

    def test_a_command(self):
        model = self.folder / "model.sh"
        model.write_text(f'#!/bin/sh\ntouch {self.mark}\necho \'{{"y": 1.0}}\' > "$1"/summary.json\n')
        model.chmod(0o755)

        def change():
            model.write_text(model.read_text() + "# another\n")
            shutil.rmtree(self.folder / "study-study")

        self.try_study('runner = "command"\ncommand = "./model.sh {folder}"', change)


if __name__ == "__main__":
    unittest.main()
