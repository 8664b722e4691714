"""Runs of studies: made once, judged, taken up again after a kill, never left behind."""

import contextlib
import dataclasses
import errno
import io
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

from pyroclast.errors import Error
from pyroclast.study import store, work
from pyroclast.study.driver import _cell, _text
from pyroclast.study.executors.local import Local
from pyroclast.study.outputs import Output
from pyroclast.study.report import write_report
from pyroclast.study.store import (CRASHED, DONE, RunResult, Store, begun_file, read_result, result_file,
                                   write_result)
from pyroclast.study.study import Study
from pyroclast.study.work import Job, judge
from study_files import PROGRAM, StudyTest, of_deck


def states(study: Study) -> list[str]:
    return [row["state"] for row in study.rows()]


def alive(word: str) -> list[str]:
    """Processes with the word in their command line."""
    found = subprocess.run(["pgrep", "-f", word], capture_output=True, text=True).stdout.split()
    return [pid for pid in found if int(pid) != os.getpid()]


class States(StudyTest):
    def one(self, mode: str, study: str = "") -> dict:
        made = self.study(self.of_command(mode, study=study))
        self.assertTrue(made.run(jobs=2))
        return made.rows()[0]

    def test_done(self) -> None:
        row = self.one("plain")
        self.assertEqual((row["state"], row["reason"]), ("done", ""))
        self.assertAlmostEqual(row["z"], 2.0 * row["x"] + 0.01, 12)

    def test_crashed_says_why(self) -> None:
        row = self.one("crash")
        self.assertEqual(row["state"], "crashed")
        self.assertIn("exit code 3: error: the mortar is missing; with mortar: the same again", row["reason"])
        self.assertIsNone(row["z"])

    def test_no_cell_of_the_table_is_a_formula(self) -> None:
        made = self.study(self.of_command("formula"))
        self.assertTrue(made.run(jobs=2))
        self.assertIn('exit code 3: error: =HYPERLINK("x")', made.rows()[0]["reason"])
        reasons = ["=1+1", "+1", "-1", "@x", "plain"]
        self.assertEqual([_cell(text) for text in reasons], ["'=1+1", "'+1", "'-1", "'@x", "plain"])
        self.assertEqual([_text(_cell(text)) for text in reasons], reasons)
        self.assertEqual(_cell(-1.5), -1.5)

    def test_a_word_of_a_command_stays_one_whatever_is_put_into_it(self) -> None:
        file = self.folder / "words.toml"
        file.write_text(f"""[study]
seeds = 1
runner = "command"
command = "{sys.executable} words.py {{kind}} {{folder}}"
[parameters.kind]
choice = ["fine sand", "a; touch gone", "$(touch gone)", "FOLDER", "{{folder}}"]
[method]
kind = "grid"
[outputs]
z = "z"
""")
        (self.folder / "words.py").write_text("import json, sys\nkind, folder = sys.argv[1:]\n"
                                              "open(folder + '/summary.json', 'w').write(json.dumps({'z': len(kind)}))\n")
        study = Study(file)
        here = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, here)
        self.assertTrue(study.run(jobs=1))
        self.assertEqual([row["z"] for row in study.rows()], [9.0, 13.0, 13.0, 6.0, 8.0])
        self.assertFalse((self.folder / "gone").exists())
        self.assertIn("words.py FOLDER FOLDER", study.rows()[3]["command"])

    def test_a_field_of_a_command_that_may_ask_for_all_memory_is_refused(self) -> None:
        fields = ("{seed:>3000000000}", "{seed:<30000}", "{seed:.9999d}", "{seed:{x}}", "{x!r:>{seed}}", "{0}", "{}",
                  "{x.real}", "{folder[0]}", "{unknown}")
        for field in fields:
            with self.subTest(field):
                text = self.of_command("plain").replace("{seed}", f"{{seed}} {field}")
                with self.assertRaisesRegex(Error, r"study\.toml:4: \{.*\}"):
                    self.study(text).check()
        self.study(self.of_command("plain").replace("{seed}", "{seed:>05} {x:>999}")).check()

    def test_a_choice_with_a_character_that_no_argument_can_hold_is_refused(self) -> None:
        text = self.of_command("plain", 'kind = "grid"').replace("uniform = [0, 1]", r'choice = ["a", "b\u0000c"]')
        with self.assertRaisesRegex(Error, r"study\.toml:8: .*NUL"):
            self.study(text).check()

    def test_control_characters_are_written_out_on_terminals_and_in_tables(self) -> None:
        odd = "\x1b[31mred\x07\u202e\x9b\nline\ttab"
        self.model.write_text(f"def line(kind, seed):\n    if kind == 'end':\n        raise ValueError({odd!r})\n"
                              "    return {'z': 1.0}\n")
        named = json.dumps(odd).replace("\x9b", "\\u009b")
        file = self.file(self.of_function('kind = "grid"', f'[parameters.kind]\nchoice = [{named}, "end"]'))
        env = os.environ | {"PYROCLAST_CODE": "always"}
        said = [subprocess.run([PROGRAM, "study", *words], cwd=self.folder, env=env, capture_output=True, text=True)
                for words in (("run", str(file)), ("status", str(file)), ("table", str(file), "--out", "-"))]
        shown = r"\x1b[31mred\x07\u202e\x9b\nline\ttab"
        self.assertIn(f"crashed: ValueError: {shown}", said[1].stdout)
        self.assertEqual(said[2].stdout.count(shown), 2, said[2].stdout)  # the value and the reason
        self.assertEqual(len(said[2].stdout.splitlines()), 3)
        for done in said:
            self.assertNotRegex(done.stdout + done.stderr, "[\x1b\x07\u202e\x9b\t]")
        table = self.folder / "study-study/table.csv"
        self.assertEqual(table.read_text(), said[2].stdout)
        earlier = self.study(file.read_text().replace("[study]", f'[study]\nfolder = "later"\nearlier = ["{table}"]'))
        self.assertEqual([row["reason"] for row in earlier.rows()], ["", f"ValueError: {shown}"])

    def test_timed_out(self) -> None:
        row = self.one("slow", 'wall_limit = "0.5 s"')
        self.assertEqual(row["state"], "timed out")
        self.assertIn("0.5 s", row["reason"])

    def test_not_settled(self) -> None:
        self.assertEqual(self.one("restless")["state"], "not settled")

    def test_not_quasi_static(self) -> None:
        row = self.one("fast")
        self.assertEqual((row["state"], row["z"]), ("not quasi-static", None))

    def test_no_value_says_why(self) -> None:
        row = self.one("silent")
        self.assertEqual(row["state"], "no value")
        self.assertIn("no number called 'z'", row["reason"])

    def test_a_run_may_lack_an_output_but_not_all(self) -> None:
        self.model.write_text("def line(x, seed):\n    return {'a': 1.0, 'b': float('nan')} if x < 0.6 else {}\n")
        text = self.of_function('kind = "grid"', study='may_lack = ["b", "a"]').replace('z = "z"', 'a = "a"\nb = "b"')
        study = self.study(text)
        self.assertTrue(study.run(jobs=1))
        self.assertEqual(states(study), ["done"] * 3 + ["no value"] * 2)
        self.assertEqual(study.rows()[0]["reason"], "b: is not finite")
        self.assertEqual(study.missing()["b"][0], "is not finite")
        self.assertEqual(study.count_values(), 3)
        must = self.study(text.replace('"b", "a"', '"a"'))
        self.assertEqual(states(must), ["no value"] * 5)  # the same runs, judged by what is asked for now
        with self.assertRaisesRegex(Error, "study.may_lack.* no output is called 'c'; there are a, b"):
            self.study(text.replace('"b", "a"', '"c"'))

    def test_a_function_that_raises_is_its_points_affair(self) -> None:
        self.model.write_text("def line(x, seed):\n    return {'z': 1.0 / round(x)}\n")
        study = self.study(self.of_function('kind = "grid"'))
        self.assertTrue(study.run(jobs=1))
        self.assertEqual(states(study).count("done"), 2)
        self.assertIn("ZeroDivisionError", study.rows()[0]["reason"])

    def test_a_function_that_does_not_end(self) -> None:
        self.model.write_text("import time\ndef line(x, seed):\n    time.sleep(60 * (x < 0.3))\n    return {'z': x}\n")
        study = self.study(self.of_function('kind = "grid"', study='wall_limit = "1 s"'))
        self.assertTrue(study.run(jobs=2))
        self.assertEqual(sorted(states(study)), ["done"] * 3 + ["timed out"] * 2)


BAR = """
title = "bar"
[specimen]
shape = "cells"
file = "bar.json"
[materials.mortar]
E = "30 GPa"
nu = 0.2
density = "2200 kg/m3"
[contacts]
t_b = "1.6 mm"
t_b_scaling = "fixed"
[contacts.mortar_mortar]
law = "elastic"
[mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = "0 m/s2"
[output]
fields = false
[[record]]
name = "top"
kind = "displacement"
set = "top"
direction = "y"
[[stages]]
kind = "drive"
duration = "20 ms"
[[stages.drives]]
set = "bottom"
hold = ["x", "y"]
[[stages.drives]]
set = "top"
pressure = "1 MPa"
"""


class Windows(unittest.TestCase):
    """Between the end of a run and its result a driver may be killed at any place: what is whole is taken."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.runs = pathlib.Path(folder.name)
        (self.runs / "r").mkdir()
        self.job = Job("r", 1, "pyroclast", ("pyroclast", "run", "deck.toml"), {"x": 1.0},
                       ("f_c_MPa", "history: strain where stress_MPa is largest"), "summary", 60.0, 1.0, 6)
        self.begun = begun_file(self.runs, "r")
        write_result(self.begun, RunResult("r", 1, work.BEGUN, values={"x": 1.0}, version=6, wall=0.0))

    def leave(self, outcome: str = "completed", whole: bool = True) -> None:
        (self.runs / "r/history.csv").write_text("stage,strain,stress_MPa\n0,0,0\n0,0.001,30\n0,0.002,20\n")
        text = json.dumps({"outcome": outcome, "outcome_id": outcome, "wall_time_s": 2.5, "stages": [{"results": {"f_c_MPa": 30.0}}]})
        (self.runs / "r/summary.json").write_text(text if whole else text[:20])

    def test_before_the_summary_there_is_nothing_to_take(self):
        self.assertIsNone(work.made(self.job, self.runs))
        self.leave(whole=False)
        self.assertIsNone(work.made(self.job, self.runs))
        self.leave("stopped")
        self.assertIsNone(work.made(self.job, self.runs))
        self.assertTrue((self.runs / "r/history.csv").exists())

    def test_after_the_summary_the_run_counts_with_all_its_numbers(self):
        self.leave()
        result = work.made(self.job, self.runs)
        self.assertEqual((result.state, result.wall), ("done", 2.5))
        self.assertEqual([value for value, _ in result.outputs.values()], [30.0, 0.001])
        self.assertFalse(self.begun.exists())
        self.assertEqual(work.made(self.job, self.runs), result)  # it is written down
        self.assertFalse((self.runs / "r/history.csv").exists())  # and it is thinned

    def test_between_its_result_and_thinning(self):
        self.leave()
        with unittest.mock.patch.object(work, "thin", side_effect=KeyboardInterrupt), self.assertRaises(KeyboardInterrupt):
            work.made(self.job, self.runs)
        self.assertTrue((self.runs / "r/history.csv").exists())
        self.assertEqual(read_result(result_file(self.runs, "r")).state, "done")
        self.assertEqual(work.made(self.job, self.runs).state, "done")
        self.assertFalse((self.runs / "r/history.csv").exists() or self.begun.exists())

    def test_who_comes_second_takes_what_is_written_down(self):
        """The driver of an array takes a run in that its task is about to, and has thinned its folder."""
        self.leave()
        first = work.made(self.job, self.runs)
        write_result(self.begun, RunResult("r", 1, work.BEGUN))
        self.assertEqual(work.given_up(self.job, self.runs, "is late"), first)
        self.assertEqual(read_result(result_file(self.runs, "r")), first)

    def test_what_is_made_again_for_further_outputs_is_not_lost_meanwhile(self):
        self.leave()
        work.made(self.job, self.runs)
        more = dataclasses.replace(self.job, outputs=(*self.job.outputs, "E_GPa"))
        self.assertIsNone(work.made(more, self.runs))
        shutil.rmtree(self.runs / "r")
        write_result(self.begun, RunResult("r", 1, work.BEGUN))
        self.assertIsNone(work.made(more, self.runs))
        self.assertEqual(work.known_result(self.job, self.runs).state, "done")


class Links(StudyTest):
    """Links that somebody else laid in the folder of a study."""

    def setUp(self) -> None:
        super().setUp()
        self.mine = self.folder / "thesis.tex"
        self.mine.write_text("precious")
        self.elsewhere = self.folder / "elsewhere"
        self.elsewhere.mkdir()

    def check_untouched(self) -> None:
        self.assertEqual((self.mine.read_text(), list(self.elsewhere.iterdir())), ("precious", []))

    def test_what_would_be_written_through_is_refused(self) -> None:
        for name, target in (("lock", self.mine), ("runs", self.elsewhere), ("report", self.elsewhere)):
            with self.subTest(name):
                study = self.study(self.of_command("plain", 'kind = "grid"', f'folder = "of_{name}"'))
                study.setup.folder.mkdir()
                (study.setup.folder / name).symlink_to(target)
                with self.assertRaises(OSError) as caught:
                    study.run(jobs=1)
                    write_report(study)
                self.assertEqual(caught.exception.filename, str(study.setup.folder / name))
                self.assertIn("is a link", str(caught.exception))
                self.check_untouched()

    def test_a_file_that_has_another_name_is_not_written_either(self) -> None:
        study = self.study(self.of_command("plain", 'kind = "grid"'))
        runs = study.setup.folder / "runs"
        runs.mkdir(parents=True)
        for place in (study.setup.folder / "lock", runs / f"{study.rows()[0]['run']}.log"):
            with self.subTest(place.name):
                place.hardlink_to(self.mine)
                with self.assertRaises(OSError) as caught:
                    study.run(jobs=1)
                self.assertEqual(caught.exception.filename, str(place))
                self.assertIn("copied by links (cp -l, rsync --link-dest); copy the folder whole",
                              str(caught.exception))
                self.check_untouched()
                place.unlink()

    def test_what_is_made_whole_takes_the_place_of_the_link(self) -> None:
        study = self.study(self.of_command("plain", 'kind = "grid"'))
        study.run(jobs=1)
        for name in ("table.csv", "report/report.html"):
            file = study.setup.folder / name
            file.unlink(missing_ok=True)
            file.parent.mkdir(exist_ok=True)
            file.symlink_to(self.mine)
        study.run(jobs=1)
        write_report(study)
        for name in ("table.csv", "report/report.html"):
            file = study.setup.folder / name
            self.assertTrue(file.is_file() and not file.is_symlink(), name)
        self.check_untouched()
        self.assertEqual(list(study.setup.folder.glob("**/*.partial")), [])


class Again(StudyTest):
    def test_a_run_is_made_once(self) -> None:
        study = self.study(self.of_command("plain"))
        study.run(jobs=2)
        before = self.made(study)
        self.assertEqual(len(before), 4)
        study.run(jobs=2)
        self.assertEqual(self.made(study), before)

    def test_failures_are_made_again_when_asked_for(self) -> None:
        study = self.study(self.of_command("crash"))
        study.run(jobs=2)
        study.forget_failures()
        study.run(jobs=2)
        self.assertEqual(len(self.made(study)), 8)

    def test_more_seeds_extend(self) -> None:
        text = self.of_command("plain", study='seeds = 1\nfolder = "here"')
        self.study(text).run(jobs=2)
        study = self.study(text.replace("seeds = 1", "seeds = 2"))
        study.run(jobs=2)
        self.assertEqual(len(self.made(study)), 8)

    def test_another_study_shares_the_folder(self) -> None:
        self.study(self.of_command("plain", 'kind = "grid"', 'folder = "here"')).run(jobs=2)
        study = self.study(self.of_command("plain", 'kind = "morris"\ntrajectories = 2', 'folder = "here"'))
        study.run(jobs=2)
        self.assertLess(len(self.made(study)), 9)

    def test_points_that_come_again_count_once(self) -> None:
        foreseen = self.study(self.of_command("plain", 'kind = "morris"\ntrajectories = 10\nlevels = 4')).forecast()
        self.assertEqual((foreseen.points, foreseen.runs), (4, 4))

    def test_a_table_alone_is_enough(self) -> None:
        study = self.study(self.of_command("plain"))
        study.run(jobs=2)
        table = study.setup.folder / "table.csv"
        (self.folder / "old.csv").write_bytes(table.read_bytes())
        fresh = self.study(self.of_command("plain", study='folder = "new"\nearlier = ["old.csv"]'))
        self.assertTrue(fresh.run(jobs=2))
        self.assertEqual(self.made(fresh), [])
        self.assertEqual([row["z"] for row in fresh.rows()], [row["z"] for row in study.rows()])

    def test_a_damaged_result_is_said_once_and_its_run_is_made_again(self) -> None:
        study = self.study(self.of_command("plain"))
        study.run(jobs=2)
        before = [row["z"] for row in study.rows()]
        file, other = sorted(study.setup.folder.glob("runs/*.json"))[:2]
        whole = file.read_bytes()
        spoilt = {"garbage": b"not a result" * 100, "cut": whole[:len(whole) // 2], "of zeros": bytes(len(whole)),
                  "empty": b"", "deep": b"[" * 100000, "of another program": b'{"id": 3, "outputs": {}}',
                  "of another run": other.read_bytes(),
                  "of none that is over": whole.replace(b'"done"', b'"begun"'),
                  "endless": re.sub(rb'"wall": [0-9.]+', b'"wall": 1e999', whole),
                  "tried without end": re.sub(rb'"attempts": [0-9]+', b'"attempts": 1e999', whole)}
        for count, (what, content) in enumerate(spoilt.items(), 1):
            with self.subTest(what), contextlib.redirect_stderr(io.StringIO()) as said:
                store._said.clear()
                file.write_bytes(content)
                self.assertEqual(sorted(states(study)), [*["done"] * 3, "not run"])
                self.assertEqual(sorted(states(Study(study.setup.file))), [*["done"] * 3, "not run"])
                self.assertTrue(study.run(jobs=2))
                self.assertEqual(said.getvalue().count(f"{file} cannot be read"), 1)
                self.assertEqual([row["z"] for row in study.rows()], before)
                self.assertEqual(len(self.made(study)), 4 + count)

    def test_every_command_says_which_result_is_damaged(self) -> None:
        text = self.file(self.of_command("plain"))
        study = self.study(self.of_command("plain"))
        study.run(jobs=2)
        file = min(study.setup.folder.glob("runs/*.json"))
        file.write_bytes(b"not a result" * 100)
        for words, code, says in ((("status",), 2, "3 of 4 done"), (("table", "-o", "-"), 0, "not run"),
                                  (("report",), 0, "report.html"), (("run",), 0, "1 of 1 runs")):
            done = subprocess.run([PROGRAM, "study", words[0], str(text), *words[1:]], capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(says, done.stdout)
            self.assertEqual(done.stderr.count(f"{file} cannot be read"), 1, done.stderr)

    def test_what_other_processes_write_and_forget_is_seen(self) -> None:
        study = self.study(self.of_command("plain"))
        self.assertEqual(states(study), ["not run"] * 4)
        driver = study._driver()
        subprocess.run([PROGRAM, "study", "run", str(study.setup.file), "--quiet"], check=True)
        self.assertEqual(states(study), ["done"] * 4)
        file = min(study.setup.folder.glob("runs/*.json"))
        write_result(file, dataclasses.replace(read_result(file), state=CRASHED))
        self.assertEqual(sorted(states(study)), ["crashed", *["done"] * 3])
        study.forget_failures()
        self.assertEqual(sorted(states(study)), [*["done"] * 3, "not run"])
        self.assertIs(study._driver(), driver)

    def test_another_model_makes_other_runs(self) -> None:
        study = self.study(self.of_function('kind = "lhs"\nsamples = 2'))
        study.run(jobs=1)
        self.assertEqual(states(study), ["done"] * 2)
        self.model.write_text(self.model.read_text().replace("2.0 * x", "3.0 * x"))
        self.assertEqual(states(study), ["not run"] * 2)

    def test_before_the_first_run_there_is_no_table(self) -> None:
        text = self.file(self.of_command("plain"))
        for more in ((), ("-o", "-"), ("-o", str(self.folder / "mine.csv"))):
            done = subprocess.run([PROGRAM, "study", "table", str(text), *more], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn("there is no table yet, for no run is done", done.stderr)
        self.assertEqual(list(self.folder.glob("**/*.csv")), [])

    def test_a_new_output_is_taken_of_what_is_kept(self) -> None:
        text = self.of_command("plain", study='folder = "here"')
        self.study(text).run(jobs=2)
        study = self.study(text + 'again = "z"\nother = "summary: z"\n')
        study.run(jobs=2)
        self.assertEqual(len(self.made(study)), 4)
        self.assertEqual([r["again"] for r in study.rows()], [r["other"] for r in study.rows()])

    def test_any_function_of_a_run_is_an_output(self) -> None:
        study = self.study(self.of_command("plain"), functions={"twice": lambda run: 2.0 * run.summary["z"]})
        study.run(jobs=2)
        for row in study.rows():
            self.assertEqual(row["twice"], 2.0 * row["z"])
        self.assertEqual(len(study.samples), 4)
        self.assertEqual(list(study.results.columns), ["x", "twice", "z"])


class Kills(StudyTest):
    def test_a_killed_run_goes_on(self) -> None:
        study = self.study(self.of_command("brief"))
        killed: list[int] = []

        def kill() -> None:
            until = time.monotonic() + 120.0
            while len(killed) < 5 and time.monotonic() < until:
                for pid in alive(str(self.model))[:1]:
                    os.kill(int(pid), signal.SIGKILL)
                    killed.append(int(pid))
                time.sleep(0.05)

        killer = threading.Thread(target=kill)
        killer.start()
        self.assertTrue(study.run(jobs=2))
        killer.join()
        self.assertEqual(len(killed), 5)
        self.assertEqual(states(study), ["done"] * 4)

    def test_what_is_killed_all_the_time_crashed(self) -> None:
        self.model.write_text("import os\nos.kill(os.getpid(), 9)\n")
        study = self.study(self.of_command("plain", 'kind = "lhs"\nsamples = 2'))
        self.assertTrue(study.run(jobs=2))
        self.assertEqual(states(study), ["crashed"] * 2)
        self.assertIn("memory", study.rows()[0]["reason"])

    def test_a_killed_driver_leaves_no_run_behind(self) -> None:
        text = self.file(self.of_command("slow"))
        driver = subprocess.Popen([sys.executable, "-m", "pyroclast.study", "run", str(text), "--jobs", "2"],
                                  stdout=subprocess.DEVNULL)
        until = time.monotonic() + 120.0
        while len(alive(str(self.model))) < 2 and time.monotonic() < until:
            time.sleep(0.05)
        self.assertEqual(len(alive(str(self.model))), 2)
        driver.kill()
        driver.wait()
        until = time.monotonic() + 30.0  # half of how long its runs sleep
        while alive(str(self.model)) and time.monotonic() < until:
            time.sleep(0.05)
        self.assertEqual(alive(str(self.model)), [])

    def test_a_killed_drivers_last_runs_are_not_made_again(self) -> None:
        study = self.study(self.of_command("plain"))

        class Deaf(Local):
            """Its driver is killed before it writes down what it hears."""

            def run(self, jobs, runs, finished, stopped) -> None:
                super().run(jobs, runs, lambda result: None, stopped)

        study.run(Deaf(2))
        before = self.made(study)
        self.assertEqual(len(before), 4)
        self.assertTrue(study.run(jobs=2))
        self.assertEqual(self.made(study), before)

    def test_ctrl_c_stops_and_goes_on(self) -> None:
        text = self.file(self.of_command("brief", 'kind = "lhs"\nsamples = 12'))
        words = [sys.executable, "-m", "pyroclast.study", "run", str(text), "--jobs", "2"]
        driver = subprocess.Popen(words, stdout=subprocess.PIPE, text=True)
        study = Study(text)
        until = time.monotonic() + 120.0
        while len(self.made(study)) < 3 and time.monotonic() < until:
            time.sleep(0.02)
        driver.send_signal(signal.SIGINT)
        said, _ = driver.communicate(timeout=120)
        self.assertEqual(driver.returncode, 130)
        self.assertIn("to go on", said)
        self.assertEqual(subprocess.run(words, stdout=subprocess.DEVNULL).returncode, 0)
        self.assertEqual(states(study), ["done"] * 12)
        self.assertLess(len(self.made(study)), 15)

    def test_results_are_written_down_while_others_are_waited_for(self) -> None:
        study = self.study(self.of_function('kind = "lhs"\nsamples = 2'))
        known = []

        class Slow:
            name = "slow"

            def run(self, jobs, runs, finished, stopped) -> None:
                for job in jobs:
                    finished(RunResult(job.id, job.seed, DONE, outputs={"z": (1.0, "")}))
                until = time.monotonic() + 120.0
                while len(known) < 2 and time.monotonic() < until:
                    stopped()
                    known[:] = list(Store(study.setup.folder))
                    time.sleep(0.05)

        self.assertTrue(study.run(Slow()))
        self.assertEqual(len(known), 2)

    def test_a_full_disk_is_no_fault_of_the_runs(self) -> None:
        study = self.study(self.of_command("full"))
        with self.assertRaisesRegex(Error, "No space left on device.*goes on"):
            study.run(jobs=2)
        self.assertLessEqual(len(self.made(study)), 3)
        self.assertEqual(states(study), ["not run"] * 4)
        (study.setup.folder / "room").touch()
        self.assertTrue(study.run(jobs=2))
        self.assertEqual(states(study), ["done"] * 4)

    def test_a_disk_that_is_full_when_a_result_is_written(self) -> None:
        study = self.study(self.of_function('kind = "lhs"\nsamples = 20'))
        write_text, left = store.write_text, 7

        def write(file: pathlib.Path, text: str) -> None:
            nonlocal left
            left -= 1
            if left < 0:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(file))
            write_text(file, text)

        with unittest.mock.patch.object(store, "write_text", write), self.assertRaisesRegex(OSError, "No space left"):
            study.run(jobs=1)
        self.assertEqual(states(Study(study.setup.file)).count("done"), 7)
        self.assertTrue(study.run(jobs=1))
        self.assertEqual(states(study), ["done"] * 20)

    def test_a_killed_driver_has_written_down_what_functions_gave(self) -> None:
        self.model.write_text("import os, time\ndef line(x, seed):\n    open('called', 'a').write(f'{x}\\n')\n"
                              "    time.sleep(0.02)\n    return {'z': x}\n")
        text = self.file(self.of_function('kind = "lhs"\nsamples = 60'))
        called, words = self.folder / "called", [sys.executable, "-m", "pyroclast.study", "run", str(text), "-j", "2"]
        for kill_at in (15, 30, 45):
            driver = subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL)
            until = time.monotonic() + 120.0
            while time.monotonic() < until and (not called.exists() or called.read_text().count("\n") < kill_at):
                time.sleep(0.005)
            driver.kill()
            driver.wait()
        subprocess.run(words, cwd=self.folder, stdout=subprocess.DEVNULL, check=True)
        self.assertEqual(states(Study(text)), ["done"] * 60)
        self.assertLessEqual(called.read_text().count("\n"), 60 + 3 * 2 * 2)

    def test_two_drivers_are_one_too_many(self) -> None:
        study = self.study(self.of_command("brief"))

        class Second:
            name = "second"

            def run(self, jobs, runs, finished, stopped) -> None:
                with outer.assertRaises(Error) as caught:
                    Study(study.setup.file).run(jobs=1)
                outer.assertIn("another process", str(caught.exception))

        outer = self
        self.assertFalse(study.run(Second()))


class OfDecks(StudyTest):
    TWO = '[parameters.f_t]\nkey = "contacts.mortar_mortar.f_t"\nuniform = ["2 MPa", "3 MPa"]\nlevels = 2\n'
    OUTPUTS = 'f_c = "f_c_MPa"\npeak = "history: strain where stress_MPa is largest"\nwork = "energy_J.loading"'

    def test_runs_are_those_of_their_command_lines_and_killed_ones_too(self) -> None:
        study = self.study(of_deck('kind = "grid"', self.TWO, 'keep = "history"', self.OUTPUTS))
        killed = random.Random(1)

        class Killer(Local):
            def run(self, jobs, runs, finished, stopped) -> None:
                end = time.monotonic() + 1.5

                def asked() -> bool:
                    if time.monotonic() < end and killed.random() < 0.3:
                        subprocess.run(["pkill", "-9", "-f", f"out {runs}"])
                    return stopped()

                super().run(jobs, runs, finished, asked)

        self.assertTrue(study.run(Killer(2)))
        rows = study.rows()
        self.assertEqual([row["state"] for row in rows], ["done", "done"])
        again = self.folder / "again"
        command = rows[1]["command"].replace("FOLDER", str(again))
        subprocess.run(command, shell=True, check=True, stdout=subprocess.DEVNULL)
        kept = study.setup.folder / "runs" / rows[1]["run"]
        self.assertEqual((again / "history.csv").read_bytes(), (kept / "history.csv").read_bytes())
        self.assertFalse((kept / "checkpoints").exists())
        summary = json.loads((again / "summary.json").read_text())
        self.assertEqual(rows[1]["work"], summary["energy_J"]["loading"])
        self.assertEqual(rows[1]["f_c"], summary["stages"][1]["results"]["f_c_MPa"])
        self.assertAlmostEqual(rows[1]["peak"], summary["stages"][1]["results"]["strain_at_peak"], 5)

    def test_the_command_line(self) -> None:
        text = self.file(of_deck('kind = "grid"', self.TWO))

        def said(*words: str, code: int = 0) -> str:
            done = subprocess.run([PROGRAM, "study", *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            return done.stdout

        self.assertIn("2 points, 2 runs", said("check", str(text)))
        slow = text.with_name("slow.toml")
        slow.write_text(text.read_text().replace('"4 mm/s"', '"20 mm/s"'))
        warned = subprocess.run([PROGRAM, "study", "check", str(slow)], capture_output=True, text=True).stderr
        self.assertRegex(warned, "warning: .*velocity")
        far = text.with_name("far.toml")
        far.write_text(text.read_text().replace("[method]", 'folder = "not/there/yet"\n[method]'))
        foreseen = said("run", str(far), "--dry-run")
        self.assertIn("2 left", foreseen)
        self.assertRegex(foreseen, r"time +\d")
        self.assertIn("GB are free", foreseen)
        self.assertFalse((self.folder / "not").exists())
        self.assertIn("not run", said("status", str(text), code=2))
        said("run", str(text), "--executor", "commands")
        lines = (self.folder / "study-study" / "commands.txt").read_text().splitlines()
        self.assertEqual(len(lines), 2)
        for line in lines:
            subprocess.run(line, shell=True, check=True, stdout=subprocess.DEVNULL)
        said("run", str(text), "--executor", "commands")
        self.assertIn("2 of 2 done", said("status", str(text)))
        self.assertNotIn("time", said("run", str(text), "--dry-run"))
        said("run", str(far), "--jobs", "2", "--keep", "history")
        self.assertEqual(len(list((self.folder / "not/there/yet/runs").glob("*/history.csv"))), 2)
        self.assertEqual(list((self.folder / "study-study/runs").glob("*/history.csv")), [])
        self.assertEqual(said("table", str(text), "-o", "-").count("\n"), 3)


class Lists(StudyTest):
    def test_a_line_of_the_list_runs_no_other_script_than_the_one_that_was_hashed(self) -> None:
        study = self.study(self.of_command("plain"))
        study.run("commands")
        line = (study.setup.folder / "commands.txt").read_text().splitlines()[0]
        self.model.write_text(f"{self.model.read_text()}\n# changed\n")
        done = subprocess.run(line, shell=True, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"error: {self.model} has changed since the study began; start it again", done.stderr)
        self.assertEqual(self.made(study), [])

    def test_a_list_of_commands_makes_what_the_program_does_not(self) -> None:
        for text in (self.of_command("plain"), self.of_function('kind = "lhs"\nsamples = 4', rest="")):
            study = self.study(text)
            self.assertFalse(study.run("commands"))
            for line in (study.setup.folder / "commands.txt").read_text().splitlines():
                subprocess.run(line, shell=True, check=True, stdout=subprocess.DEVNULL)
            self.assertTrue(study.run("commands"))
            self.assertEqual({row["state"] for row in study.rows()}, {"done"})
            shutil.rmtree(study.setup.folder)

    def test_its_script_makes_all_runs_as_tasks_of_a_slurm_array(self) -> None:
        study = self.study(self.of_function('kind = "lhs"\nsamples = 5', rest="""
[slurm]
slots = 3
time = "90 s"
points_per_task = 2
options = ["--partition=long", "--wrap=true"]
"""))
        self.assertFalse(study.run("commands"))
        script = (study.setup.folder / "commands.sbatch").read_text()
        asked = re.findall(r"^#SBATCH (.*)$", script, re.MULTILINE)
        self.assertEqual(asked, ["--array=1-3%3", "--time=1:30", "--ntasks=1", "--cpus-per-task=1", "--partition=long"])
        self.assertIn("# left out, as it may run a program: --wrap=true", script)
        for task in ("1", "2", "3"):
            self.assertEqual(len(list(study.setup.folder.glob("runs/*/summary.json"))), 2 * (int(task) - 1))
            subprocess.run(["sh"], input=script, text=True, check=True, env=os.environ | {"SLURM_ARRAY_TASK_ID": task})
        self.assertTrue(study.run("commands"))
        self.assertFalse((study.setup.folder / "commands.sbatch").exists())


TWO_AS_ONE = '''
def model(seed, a, b, c, d):
    """Of a and b only their product is seen, of d nothing."""
    shift = 0.002 * (seed - 2)
    return {"stiffness": a * b + shift, "strength": c ** 1.5 + a * b - shift}
'''


class Calibration(StudyTest):
    def test_finds_the_parameters_of_a_target_and_says_what_it_cannot_tell_apart(self) -> None:
        self.model.write_text(TWO_AS_ONE)
        parameters = "".join(f"[parameters.{name}]\nuniform = [1, 3]\n" for name in "abcd")
        truth = {"ab": 2.6, "c": 2.7}
        targets = {"stiffness": truth["ab"], "strength": truth["c"] ** 1.5 + truth["ab"]}
        study = self.study(f'''
[study]
runner = "function"
function = "model.py:model"
seeds = 3
[method]
kind = "calibrate"
generations = 60
{parameters}
[outputs]
stiffness = "stiffness"
strength = "strength"
''' + "".join(f"[targets.{name}]\nvalue = {value}\nsd = 0.02\n" for name, value in targets.items()))
        self.assertTrue(study.run(jobs=1))
        found = study.findings
        best = [1.0 + 2.0 * u for u in found["best"]["u"]]
        self.assertAlmostEqual(best[0] * best[1], truth["ab"], delta=0.03)
        self.assertAlmostEqual(best[2], truth["c"], delta=0.02)
        told = found["uncertainty"]
        self.assertLess(told["sd_ratio"][2], 0.1)
        self.assertTrue(told["not_determined"][3], told["sd_ratio"])
        free = [v for v, is_free in zip(told["directions"], told["direction_not_determined"]) if is_free]
        self.assertEqual(len(free), 2)
        self.assertLess(max(abs(v[2]) for v in free), 0.05)  # c is told
        along = [best[0], -best[1]]  # a and b against each other, by which the product stays
        length = sum(x * x for x in along) ** 0.5
        inside = sum((v[0] * along[0] + v[1] * along[1]) ** 2 for v in free) ** 0.5 / length
        self.assertGreater(inside, 0.97)


class Secant(StudyTest):
    """By its command, on a deck: E by the stiffness of the mortar."""

    def run_for(self, modulus: float | str) -> subprocess.CompletedProcess:
        self.text = self.file(of_deck(
            'kind = "secant"', '[parameters.stiffness]\nkey = "materials.mortar.E"\nvary = "scale"\n'
            'log_uniform = [0.7, 1.43]\n', outputs='E = "E_GPa"')
            + f'[targets.E]\nvalue = {json.dumps(modulus)}\nsd = 0.1\nby = "stiffness"\n')
        return subprocess.run([PROGRAM, "study", "run", str(self.text)], capture_output=True, text=True, check=False)

    def test_its_best_deck_gives_what_it_says(self) -> None:
        done = self.run_for("19000 MPa")
        self.assertEqual(done.returncode, 0, done.stderr)
        # before the first run: how long one takes, those of the first round, and all that may be asked for
        self.assertRegex(done.stdout.splitlines()[0], r"^time +\S+ s a run, .* to begin with; .* at most, for 10 runs$")
        said = re.search(r"E (\S+) GPa, wanted 19 GPa: ([+-]\d\.\d) %", done.stdout)
        self.assertLess(abs(float(said[1]) - 19.0), 0.1)
        best = Study(self.text, program=PROGRAM).setup.folder / "best.toml"
        self.assertIn(str(best), done.stdout)
        subprocess.run([PROGRAM, "run", str(best), "--out", self.folder / "best", "--no-figures", "--quiet"], check=True)
        stages = json.loads((self.folder / "best/summary.json").read_text())["stages"]
        self.assertAlmostEqual(stages[-1]["results"]["E_GPa"], float(said[1]), delta=5e-3)

    def test_a_target_out_of_reach_is_an_error_with_the_nearest(self) -> None:
        done = self.run_for(60.0)
        self.assertEqual(done.returncode, 1)
        self.assertIn("the targets are not met", done.stderr)
        self.assertIn("stiffness = 1.43: at the end of the range", done.stderr)
        self.assertIn("best.toml", done.stdout)
        self.assertNotIn("another unit", done.stderr)
        best = Study(self.text, program=PROGRAM).setup.folder / "best.toml"
        self.assertRegex(best.read_text(), r"\n# The targets are not met: E is \S+, wanted 60\.\n")

    def test_a_target_in_another_unit_than_its_output_is_told_with_that_unit(self) -> None:
        done = self.run_for(19e9)
        self.assertEqual(done.returncode, 1)
        self.assertIn("targets.E counts in GPa", done.stderr)
        self.assertIn("wanted 1.9e+10 GPa", done.stdout)


class KeptApart(StudyTest):
    METHOD = 'kind = "chaos"\nsamples = 20\nheld = 30'

    def points(self, lost: str) -> list[str]:
        """States of the points of a study that loses those."""
        self.model.write_text(f"def line(x, seed):\n    return {{'z': 1.0 / (not {lost}) * x}}\n")
        study = self.study(self.of_function(self.METHOD))
        self.assertFalse(study.forecast().is_complete)
        self.assertTrue(study.run(jobs=1))
        self.found = study.findings["outputs"]["z"]
        return states(study)

    def test_points_without_a_value_are_made_up_for(self) -> None:
        made = self.points("0.4 < x < 0.6")
        kept_apart = made[20:]
        self.assertGreater(len(kept_apart), 30)
        self.assertEqual(kept_apart.count("done"), 30)
        self.assertGreater(self.found["q2"], 0.999)

    def test_up_to_as_many_again(self) -> None:
        self.assertEqual(len(self.points("x > 0.2")), 20 + 60)
        self.assertIn("at least 30", self.found["none_because"])


class NoValues(StudyTest):
    def test_a_study_without_any_value_ends_with_an_error(self) -> None:
        (self.folder / "study.toml").write_text("""
[study]
runner = "command"
command = "false {x} {folder}"
[method]
kind = "grid"
[parameters.x]
uniform = [0, 1]
[outputs]
z = "z"
""")
        done = subprocess.run([PROGRAM, "study", "run", self.folder / "study.toml", "--quiet"], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("error: no run gave a value: exit code 1", done.stderr)

    def test_the_blocks_of_a_file_have_no_seed(self) -> None:
        corners = [[0, 0], [0.05, 0], [0.05, 0.05], [0, 0.05], [0.05, 0.1], [0, 0.1]]
        (self.folder / "bar.json").write_text(json.dumps(
            {"phases": ["mortar"], "vertices_m": corners, "cells": [[0, 1, 2, 3], [3, 2, 4, 5]], "phase": [0, 0]}))
        (self.folder / "bar.toml").write_text(BAR)
        text = """
[study]
deck = "bar.toml"
seeds = SEEDS
[method]
kind = "grid"
[parameters.p]
key = "stages[0].drives[1].pressure"
uniform = ["1 MPa", "2 MPa"]
[outputs]
top = "history: top_m last"
"""
        study = self.study(text.replace("SEEDS", "1"))
        self.assertTrue(study.run(jobs=1))
        self.assertEqual(study.count_values(), len(study.rows()))
        with self.assertRaisesRegex(Error, "study.toml:4: .*so a seed has no meaning"):
            self.study(text.replace("SEEDS", "2")).check()


class Judgements(StudyTest):
    def test_outcomes(self) -> None:
        self.assertEqual(judge({"outcome": "completed"})[0], "done")
        self.assertEqual(judge({"outcome_id": "unstable", "outcome": "so"}), ("crashed", "so"))
        stages = [{"outcome_id": "not_settled", "outcome": "why"}]
        self.assertEqual(judge({"outcome_id": "completed", "stages": stages}), ("not settled", "why"))
        stages = [{"is_good": True}, {"kind": "drive", "is_good": False, "outcome_id": "not_reached", "outcome": "why"}]
        self.assertEqual(judge({"outcome_id": "completed", "stages": stages}), ("done", "stage 2 (drive): why"))

    def test_numbers_of_a_summary(self) -> None:
        summary = {"steps": 5, "energy_J": {"kinetic": 2.5}, "stages": [
            {"results": {"f_c_MPa": 30.0}}, {"results": {"f_c_MPa": None, "f_c_none_because": "it was not loaded"}}]}
        facts = {"results": [{"name": "f_c_none_because", "of": "reason", "about": "f_c_MPa"}]}
        self.assertEqual(Output("n", "steps").of(self.folder, summary, facts), (5.0, ""))
        self.assertEqual(Output("k", "energy_J.kinetic").of(self.folder, summary, facts), (2.5, ""))
        value, why = Output("f", "f_c_MPa").of(self.folder, summary, facts)
        self.assertTrue(math.isnan(value))
        self.assertEqual(why, "it was not loaded")


class Histories(StudyTest):
    def test_places(self) -> None:
        (self.folder / "history.csv").write_text("strain,stress_MPa\n0,0\n1,10\n2,30\n3,20\n4,\n")
        for what, value in (("stress_MPa at strain = 1.5", 20.0), ("strain at stress_MPa = 25", 1.75),
                            ("strain where stress_MPa is largest", 2.0), ("stress_MPa largest", 30.0),
                            ("stress_MPa least", 0.0), ("stress_MPa last", 20.0), ("strain", 4.0)):
            self.assertEqual(Output("y", f"history: {what}").of(self.folder, {}, {}), (value, ""), what)
        for what, why in (("stress at strain = 1", "no column 'stress'"), ("strain at stress_MPa = 40", "never")):
            value, said = Output("y", f"history: {what}").of(self.folder, {}, {})
            self.assertTrue(math.isnan(value))
            self.assertIn(why, said)


if __name__ == "__main__":
    unittest.main()
