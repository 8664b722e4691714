"""Code of a deck or a study runs with the user's permission, by whatever command. PYROCLAST names the program."""

import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from in_a_folder import InAFolder  # noqa: E402
from sanitized import needs_studies  # noqa: E402
from test_user import CARELESS_LAW, deck_of_careless_law, preprocessor  # noqa: E402

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
COMMON = tempfile.TemporaryDirectory()  # of all tests: what was compiled for one is there for others


class CodeTest(InAFolder):
    common = pathlib.Path(COMMON.name)

    def setUp(self):
        super().setUp()
        self.mark = self.common / "mark"
        compiler = self.common / "compiler"  # does not optimize: what runs counts here, and not how fast
        compiler.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >> {self.common / "words"}\nexec c++ "$@" -O0\n')
        compiler.chmod(0o755)
        self.env = os.environ | {"PYROCLAST_CACHE": str(self.common / "cache"), "HOME": str(self.folder / "home"),
                                 "XDG_CONFIG_HOME": str(self.folder / "home"), "PYROCLAST_CODE": "ask",
                                 "CXX": str(compiler)}
        (self.folder / "law.hpp").write_text(MARK.replace("MARK", str(self.mark)) + CARELESS_LAW)
        deck = deck_of_careless_law(1.0).replace('stop_strain = 2e-4', 'stop_strain = 2e-5').replace("count = 100", "count = 40")
        (self.folder / "header.toml").write_text(deck.replace("careless.hpp", "law.hpp"))
        (self.folder / "object.toml").write_text(deck.replace("careless.hpp", "law.so"))
        (self.folder / "plain.toml").write_text(deck.replace('law = "careless.hpp"', 'law = "elastic"').replace(
            'K = "18e12 Pa/m"', "").replace("times = 1.0", ""))

    def run_it(self, *words: str, **env: str) -> tuple[subprocess.CompletedProcess, bool]:
        """What the program says, and whether the code ran."""
        self.mark.unlink(missing_ok=True)
        return self.pyroclast(*words, code=None, env=self.env | env), self.mark.exists()

    def assert_refused(self, *words: str, says: str = "--allow-code", **env: str) -> subprocess.CompletedProcess:
        done, ran = self.run_it(*words, **env)
        self.assertEqual((done.returncode, ran), (NOT_ALLOWED, False), (words, done.stdout, done.stderr))
        self.assertIn(says, done.stdout + done.stderr)
        return done

    def assert_done(self, *words: str, runs: bool, codes: tuple = (0, 2), says: str = "",
                    **env: str) -> subprocess.CompletedProcess:
        done, ran = self.run_it(*words, **env)
        self.assertIn(done.returncode, codes, (words, done.stdout, done.stderr))
        self.assertIn(says, done.stdout + done.stderr)
        self.assertEqual(ran, runs, words)
        return done

    def write_script(self, name: str, y: float = 1.0) -> None:
        """A script that leaves y as its result."""
        script = self.folder / name
        script.write_text(f'#!/bin/sh\ntouch {self.mark}\necho \'{{"y": {y}}}\' > "$1"/summary.json\n')
        script.chmod(0o755)

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
        # the user's permission, once, for this code wherever it lies
        self.assert_done("check", deck, "--allow-code", runs=True)
        for words in self.commands(deck).values():
            self.assert_done(*words, runs=True)
        self.assert_refused("check", deck, PYROCLAST_CODE="never", says="never")
        self.assert_done("resume", "out", "--from-stage", "0", "--out", "fork", "--no-figures", runs=True)
        self.assert_done("watch", "out", "--once", runs=False)
        # of somebody else: the same folders, another home
        shutil.rmtree(self.folder / "home")
        self.assert_refused("resume", "out", "--from-stage", "0", "--out", "other", "--no-figures")
        self.assert_refused("run", "out/deck.toml", "--out", "other", "--no-figures")
        self.assertFalse((self.folder / "other").exists())
        self.assert_done("figures", "run", "out", "--only", "cracks", runs=False)
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

    def test_a_header_that_includes_files_by_odd_words(self):
        """A byte-order mark, or a backslash and a blank, hides no include from the hash. Nothing is compiled of it."""
        self.env["CXX"] = preprocessor(self.folder)
        allowed = {"runs": False, "codes": (1,), "says": "does not compile as the contact law"}
        for name in ("x.hpp", "y.hpp"):
            (self.folder / name).write_text("// one\n")
        (self.folder / "law.hpp").write_text('\ufeff#include "x.hpp"\n#inc\\ \nlude "y.hpp"\n' + CARELESS_LAW)
        self.assert_done("check", "header.toml", "--allow-code", **allowed)
        self.assert_done("check", "header.toml", **allowed)
        for name in ("x.hpp", "y.hpp"):
            (self.folder / name).write_text(MARK.replace("MARK", str(self.mark)))
            self.assert_refused("check", "header.toml")
            (self.folder / name).write_text("// one\n")
        self.assert_done("check", "header.toml", **allowed)

    def test_no_precompiled_header_is_taken(self):
        """A law.hpp.gch of other code beside law.hpp does not run, and does not get into the cache."""
        log = self.common / "words"
        log.unlink(missing_ok=True)
        law = self.folder / "law.hpp"
        law.write_text(CARELESS_LAW + "// of the test of precompiled headers\n")
        self.assert_refused("check", "header.toml")
        words = log.read_text().splitlines()
        flags = words[words.index("-std=c++20"):words.index("-E")]
        other = self.folder / "other.hpp"
        other.write_text(CARELESS_LAW + MARK.replace("MARK", str(self.mark)))
        subprocess.run(["c++", *flags, "-O0", "-x", "c++-header", other, "-o", f"{law}.gch"], check=True)
        self.assert_done("check", "header.toml", "--allow-code", runs=False, PYROCLAST_CACHE=str(self.folder / "cache"))

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

    @needs_studies
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


@needs_studies
class CodeOfAStudy(CodeTest):
    def try_study(self, runner: str, change, then: tuple = ()) -> None:
        """`then` are commands that run no code with the user's permission either."""
        (self.folder / "study.toml").write_text(STUDY.format(runner=runner))
        self.assert_refused("study", "run", "study.toml")
        self.assert_refused("study", "run", "study.toml", PYROCLAST_CODE="never", says="never")
        for command in ("check", "status", "table"):
            done, ran = self.run_it("study", command, "study.toml")
            self.assertFalse(ran, (command, done.stderr))
        self.assert_done("study", "run", "study.toml", "--allow-code", runs=True)
        for command in then:
            self.assert_done("study", command, "study.toml", runs=False)
        change()
        self.assert_refused("study", "run", "study.toml")
        self.assert_done("study", "run", "study.toml", runs=True, PYROCLAST_CODE="always")

    def test_a_function(self):
        (self.folder / "model.py").write_text(FUNCTION.format(mark=self.mark))
        (self.folder / "helper.py").write_text("")

        def change():
            (self.folder / "helper.py").write_text("# another\n")

        self.try_study('runner = "function"\nfunction = "model.py:model"', change, ("status", "table", "report"))

    def test_a_command(self):
        self.write_script("model.sh")

        def change():
            (self.folder / "model.sh").write_text((self.folder / "model.sh").read_text() + "# another\n")

        self.try_study('runner = "command"\ncommand = "./model.sh {folder}"', change)


@needs_studies
class HashOfAStudy(CodeTest):
    """What runs is what was hashed, and runs of other code do not count."""

    PYTHON = "/usr/bin/python3"

    def setUp(self):
        super().setUp()
        self.runs_script = False  # whether the study runs a script of write_script

    def write_script(self, name: str, y: float = 1.0) -> None:
        super().write_script(name, y)
        self.runs_script = True

    def write_function(self, model: str = "", helper: str = "def value():\n    return 1.0\n") -> None:
        """A study of model.py, which returns helper.value()."""
        (self.folder / "model.py").write_text(f'{model}\nimport helper\ndef model(seed):\n'
                                              '    return {"y": helper.value()}\n')
        (self.folder / "helper.py").write_text(helper)
        self.write_study('runner = "function"\nfunction = "model.py:model"')

    def write_command(self, command: str, more: str = "") -> None:
        self.write_study(f"runner = \"command\"\ncommand = '''{command}'''", more)

    def write_study(self, runner: str, more: str = "") -> None:
        text = STUDY.format(runner=runner) + more
        (self.folder / "study.toml").write_text(text.replace('"ensemble"', '"grid"') if more else text)

    def run_study(self, *words: str) -> tuple[list[float], str]:
        """y of each run after `study run`, and what it says."""
        done = self.assert_done("study", "run", "study.toml", *words, runs=self.runs_script)
        with open(self.folder / "study-study/table.csv", newline="") as table:
            return [float(row["y"]) for row in csv.DictReader(table)], done.stdout + done.stderr

    def compile_other(self, into: str) -> None:
        """Other code in the place of the compiled form of helper.py."""
        other = self.folder / "other.txt"
        other.write_text(f"import pathlib\npathlib.Path({str(self.mark)!r}).touch()\ndef value():\n    return 2.0\n")
        (self.folder / into).parent.mkdir(exist_ok=True)
        subprocess.run([self.PYTHON, "-c", "import py_compile, sys\npy_compile.compile(sys.argv[1], cfile=sys.argv[2], "
                        "invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH)", other, self.folder / into],
                       check=True)

    def test_no_compiled_module_runs_in_the_place_of_a_helper(self):
        self.write_function()
        for name in (f"__pycache__/helper.{sys.implementation.cache_tag}.pyc", "helper.pyc"):
            self.compile_other(name)
        (self.folder / "helper.abi3.so").write_text("no module")
        self.assertEqual(self.run_study("--allow-code")[0], [1.0])
        (self.folder / "helper.py").unlink()
        done, ran = self.run_it("study", "run", "study.toml", "--allow-code")
        self.assertFalse(ran)
        self.assertIn("helper.abi3.so: is compiled; only .py files", done.stderr)

    def test_no_compiled_module_runs_in_the_place_of_a_helper_of_a_command(self):
        (self.folder / "model.py").write_text('import helper, json, sys\njson.dump({"y": helper.value()}, '
                                              'open(sys.argv[1] + "/summary.json", "w"))\n')
        (self.folder / "helper.py").write_text("def value():\n    return 1.0\n")
        self.write_command(f"{self.PYTHON} model.py {{folder}}")
        self.compile_other(f"__pycache__/helper.{sys.implementation.cache_tag}.pyc")
        self.assertEqual(self.run_study("--allow-code")[0], [1.0])
        for planted in ("helper.pyc", "random.py", "helper.abi3.so"):
            shutil.copy(self.folder / "other.txt", self.folder / planted)
            self.assert_refused("study", "run", "study.toml")
            (self.folder / planted).unlink()

    def test_a_planted_module_does_not_take_the_place_of_one_of_python(self):
        self.write_function("import statistics, pathlib\nfrom numpy import random")
        for name in ("fractions", "secrets", "numbers", "sitecustomize", "numpy"):
            (self.folder / f"{name}.py").write_text(f"open({str(self.mark)!r}, 'w')\n")
        done = self.assert_done("study", "run", "study.toml", "--allow-code", runs=False, codes=(1,))
        self.assertIn("imports numpy, of which there are two", done.stderr)
        (self.folder / "numpy.py").unlink()
        self.assertEqual(self.run_study("--allow-code")[0], [1.0])

    def test_a_helper_with_the_name_of_a_module_of_python_is_refused(self):
        self.write_function("from queue import value")
        (self.folder / "queue.py").write_text("def value():\n    return 1.0\n")
        for command in ("run", "check"):
            done = self.assert_done("study", command, "study.toml", "--allow-code", runs=False, codes=(1,))
            for word in ("model.py", "queue.py", "give the file another name"):
                self.assertIn(word, done.stderr)

    def test_a_module_that_no_statement_imports_does_not_run(self):
        self.write_function("", "import importlib\ndef value():\n    return importlib.import_module('late').V\n")
        (self.folder / "late.py").write_text(f"open({str(self.mark)!r}, 'w')\nV = 1.0\n")
        done = self.assert_done("study", "run", "study.toml", "--allow-code", runs=False, codes=(1,))
        self.assertIn("late.py: is not in the hash of the study's code; write `import late`", done.stdout + done.stderr)

    def test_helpers_in_packages_and_folders_are_in_the_hash(self):
        self.write_function("", "from parts.deep import more\nimport whole.one\ndef value():\n"
                            "    return more.value() + whole.one.two.ZERO\n")
        for folder in ("parts", "whole"):
            (self.folder / folder).mkdir()
        (self.folder / "whole/__init__.py").touch()
        (self.folder / "whole/one.py").write_text("import whole.two as two\n")
        (self.folder / "whole/two.py").write_text("ZERO = 0.0\n")
        (self.folder / "parts/deep.py").write_text("from . import more\n")
        for y in (1.0, 7.0):
            (self.folder / "parts/more.py").write_text(f"def value():\n    return {y}\n")
            self.assert_refused("study", "run", "study.toml")
            self.assertEqual(self.run_study("--allow-code")[0], [y])
        (self.folder / "whole/two.py").write_text("ZERO = -0.0\n")
        self.assert_refused("study", "run", "study.toml")

    def test_runs_of_other_code_are_made_anew(self):
        """Whatever changed: a helper, a script that a command names in any way, a module, a link."""
        def helper(y: float) -> None:
            self.write_function("", f"def value():\n    return {y}\n")

        def script(y: float) -> None:
            self.write_script("w.sh", y)

        def link(y: float) -> None:
            self.write_script(f"of_{y:g}.sh", y)
            (self.folder / "link.sh").unlink(missing_ok=True)
            (self.folder / "link.sh").symlink_to(f"of_{y:g}.sh")

        def module(y: float) -> None:
            (self.folder / "one.py").write_text(f"Y = {y}\n")
            (self.folder / "run.py").write_text("import json, sys, one\njson.dump({'y': one.Y}, "
                                                "open(sys.argv[1] + '/summary.json', 'w'))\n")

        self.write_script("v.sh", 3.0)
        choice = '[parameters.name]\nchoice = ["w", "v"]\n'
        for change, command, more in [
                (helper, "", ""), (script, "./w.sh {folder}", ""), (script, "sh -c './w.sh \"{folder}\"'", ""),
                (script, "env -- sh w.sh {folder}", ""), (script, "./{name}.sh {folder}", choice),
                (link, "./link.sh {folder}", ""), (module, f"{self.PYTHON} run.py {{folder}}", ""),
                (module, f"{self.PYTHON} -m run {{folder}}", "")]:
            with self.subTest(command=command):
                shutil.rmtree(self.folder / "study-study", ignore_errors=True)
                if command:
                    self.write_command(command, more)
                others = [3.0] if more else []
                self.runs_script = False
                change(1.0)
                self.assertEqual(self.run_study("--allow-code")[0], [1.0, *others])
                change(7.0)
                values, said = self.run_study("--allow-code")
                self.assertEqual(values, [7.0, *others])
                self.assertIn("of other code", said)

    def test_runs_of_a_deck_are_made_anew_with_another_law(self):
        self.write_study('deck = "header.toml"')
        study, law, deck = self.folder / "study.toml", self.folder / "law.hpp", self.folder / "header.toml"
        text = deck.read_text()
        deck.write_text(text[:text.rindex("[[stages]]")] + text[text.index("[output]"):])  # so that it comes to rest
        study.write_text(study.read_text().replace('y = "y"', 'y = "energy_J.elastic_contacts"'))
        self.runs_script = True
        (first,), _ = self.run_study("--allow-code", "--quiet")
        self.assertEqual(self.run_study()[0], [first])
        law.write_text(law.read_text().replace("{ return p; }", "{ return {2.0 * p.stiffness, p.times}; }"))
        self.assert_refused("study", "run", "study.toml", "--quiet")
        (second,), said = self.run_study("--allow-code")
        self.assertIn("of other code", said)
        self.assertNotEqual(second, first)

    def test_code_that_the_hash_cannot_cover_needs_a_word_each_time(self):
        self.write_script("w.sh")
        (self.folder / "bin").mkdir()
        odd = self.folder / "odd.py"
        odd.write_text("#!/usr/bin/python3 -E\nimport sys, pathlib\n"
                       'pathlib.Path(sys.argv[1], "summary.json").write_text(\'{"y": 1.0}\')\n')
        odd.chmod(0o755)
        for command, why in [
                ("env PATH=bin:/usr/bin:/bin sh w.sh {folder}", "bin is a folder, and any file there may be code"),
                ("sh -c 'cd . && ./w.sh {folder}'", "it goes to another folder by cd"),
                ("sh -c './w*.sh {folder}'", "its shell makes words"),
                (f"{self.PYTHON} -m unknown_module w.sh {{folder}}", "the module unknown_module"),
                (f"{self.PYTHON} -I odd.py {{folder}}", "with -I, Python may take compiled modules"),
                (f"env -i {self.PYTHON} odd.py {{folder}}", "with env, Python may not get the study's environment"),
                (f"env PYTHONPYCACHEPREFIX= {self.PYTHON} odd.py {{folder}}", "it changes PYTHONPYCACHEPREFIX"),
                ("./odd.py {folder}", "the first line of ./odd.py gives options")]:
            with self.subTest(command=command):
                shutil.rmtree(self.folder / "study-study", ignore_errors=True)
                self.write_command(command)
                self.run_it("study", "run", "study.toml", "--allow-code")
                said = self.assert_refused("study", "run", "study.toml", says=why).stderr
                self.assertIn("It needs your permission each time, because ", said)
        self.assert_refused("study", "run", "study.toml", PYROCLAST_CODE="never", says="never")

    def test_code_that_changes_while_a_study_runs_ends_it(self):
        self.write_script("w.sh")
        self.write_command("sh w.sh {folder}")
        study = self.folder / "study.toml"
        study.write_text(study.read_text().replace("seeds = 1", "seeds = 3"))
        script = self.folder / "w.sh"
        script.write_text(script.read_text() + "echo '# another' >> w.sh\n")
        done = self.assert_done("study", "run", "study.toml", "--allow-code", "--jobs", "1", runs=True, codes=(1,))
        self.assertIn("w.sh has changed since the study began", done.stderr)


@needs_studies
class OptionsOfSlurm(CodeTest):
    """What sbatch gets from a study runs nothing without the user's permission."""

    def setUp(self):
        super().setUp()
        (self.folder / "model.py").write_text('def model(seed):\n    return {"y": 1.0}\n')
        tools = self.folder / "tools"
        tools.mkdir()
        for name in ("sbatch", "squeue", "scontrol"):
            (tools / name).write_text(f'#!/bin/sh\ncase "$*" in\n*--job-name*) touch {self.mark}; echo no >&2; exit 1;;\n'
                                      'esac\n')
            (tools / name).chmod(0o755)
        self.env["PATH"] = f"{tools}:{self.env['PATH']}"

    def write_options(self, *options: str) -> None:
        (self.folder / "study.toml").write_text(STUDY.format(runner='runner = "function"\nfunction = "model.py:model"')
                                                + f"[slurm]\noptions = {json.dumps(options)}\n")

    def test_plain_options_need_no_word(self):
        self.write_options(*(f"--{name}=1" for name in (
            "partition", "account", "qos", "mem", "mem-per-cpu", "constraint", "gres", "nodelist", "exclude",
            "reservation", "cpus-per-task", "mail-type", "mail-user")))
        self.assert_done("study", "check", "study.toml", runs=False)
        self.assert_done("study", "run", "study.toml", "--executor", "slurm", "--allow-code", runs=True, codes=(1,))

    def test_other_options_need_a_word(self):
        for option in ("--wrap=touch RAN", "script.sh"):
            with self.subTest(option=option):
                self.write_options("--partition=long", option)
                self.assert_refused("study", "check", "study.toml", says=option)
                self.assert_refused("study", "run", "study.toml", "--executor", "slurm")
                self.assertFalse((self.folder / "study-study").exists())
        self.assert_done("study", "run", "study.toml", "--allow-code", "--quiet", runs=False)  # here they are not used
        self.assert_refused("study", "run", "study.toml", "--executor", "slurm", says=option)
        self.assert_done("study", "check", "study.toml", "--allow-code", runs=False)
        shutil.rmtree(self.folder / "study-study")
        self.assert_done("study", "run", "study.toml", "--executor", "slurm", runs=True, codes=(1,))
        self.write_options("--partition=long", "--part=short")
        self.assert_refused("study", "run", "study.toml", "--executor", "slurm", says="--part=short")

    def test_values_that_cannot_be_meant_are_errors(self):
        self.write_options("--partition=a\n#SBATCH --wrap=x")
        done = self.assert_done("study", "check", "study.toml", runs=False, codes=(1,))
        self.assertIn("study.toml:", done.stderr)
        self.assertIn("line break", done.stderr)


if __name__ == "__main__":
    unittest.main()
