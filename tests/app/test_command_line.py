"""Words of the command line: what is unknown is named, and what each command ends with. PYROCLAST names the program."""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time
import tomllib
import unittest

from in_a_folder import PROGRAM, InAFolder

CASES = pathlib.Path(__file__).parents[2] / "cases"

NUMBERS = (
    ("stiffness_factor = 0.8", "stiffness_factor = 1e308", "is too large"),
    ("strength_factor = 0.8", "strength_factor = -1e308", "is too large"),
    ("fuller_exponent = 0.45", "fuller_exponent = 1e-320", "is too small"),
    ("fuller_exponent = 0.45", "fuller_exponent = 2.0", "must be greater than 0 and at most 1"),
    ("fuller_exponent = 0.45", "fuller_exponent = 1e-29", "take up a fraction of 0.0000"),
    ('thickness = "20 mm"', 'thickness = "1e-300 mm"', "is too small"),
    ('thickness = "20 mm"', 'thickness = "1e-20 mm"', "must be at least 2.1e-10 m beside this specimen"),
    ('thickness = "1 m"', 'thickness = "1e308 m"', "no number of a run is beyond 1e+30 m"),
    ('t_b = "1.6 mm"', 't_b = "1e-320 m"', "write 0, or a number of at least 1e-30 m"),
    ('t_b_block_size = "3 mm"', 't_b_block_size = "1e308 mm"', "is too large"),
    ('d_min = "4.75 mm"', 'd_min = "1e-300 mm"', "is too small"),
    ('density = "2650 kg/m3"', 'density = "1e308 kg/m3"', "is too large"),
    ('E = "70 GPa"', 'E = { value = "1e30 GPa", times = "glasgow_modulus" }', "is too large"),
    ("beta = 0.05", "beta = 0.361", "at 20 degC it must be greater than 0 and less than 1; it is 2.55"),
)


class CommandLine(InAFolder):
    def error(self, *words) -> str:
        """The one line that a command ends with that comes to nothing."""
        done = self.pyroclast(*words, code=1)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def test_every_column_of_every_case_is_listed(self):
        listed = [line.split()[0] for line in self.pyroclast("list", "columns").stdout.splitlines()]
        names = "|".join(re.sub("NAME|MODE|INTERFACE|UNIT", r"\\w+", name) for name in listed if name != "NAME_UNIT")
        cases = json.loads((CASES.parent / "validation" / "reference_small.json").read_text())["cases"]
        self.assertGreater(len(cases), 15)
        for case, kept in cases.items():
            deck = tomllib.loads((CASES / f"{case}.toml").read_text())
            records = [record["name"] for record in deck.get("record", [])]
            for column in kept["columns"]:
                is_record = any(re.fullmatch(rf"{record}_\w+", column) for record in records)
                self.assertTrue(is_record or re.fullmatch(names, column), f"{case}: {column}")

    def test_lists_say_what_the_code_computes_in_both_dimensions(self):
        columns, fields = (self.pyroclast("list", what).stdout for what in ("columns", "fields"))
        self.assertRegex(columns, r"mean_opening_m .*contacts damaged in tension or mixed mode, by extent\n")
        self.assertRegex(columns, r"largest_jump .*edge; of a solid over the mean block size\n")
        for name in ("slip", "tangential_jump", "shear_traction"):  # two components in a solid
            self.assertRegex(fields, rf"\n{name} .*of a solid its size\n")

    def test_an_unknown_word_is_named_with_the_nearest(self):
        self.assertIn('"rnu" is no command; did you mean "run"?', self.error("rnu", "x.toml"))
        self.assertIn('"--treads" is no option of run; did you mean "--threads"?', self.error("run", "x", "--treads", "3"))
        self.assertIn("a command is needed: run, check", self.error())
        self.assertIn('did you mean "curves"?', self.error("list", "curvs"))
        self.assertIn('did you mean "hot_compression"?', self.error("new", "x", "--from", "hot_compresion"))

    WALL = """title = "Wall"
[specimen]
width = "100 mm"
height = "100 mm"
seed = 1
[blocks]
count = 60
shortest_edge = 0.3
[materials.mortar]
density = "2200 kg/m3"
conductivity = "1.5 W/(m K)"
specific_heat = "900 J/(kg K)"
[heat]
field = "conduction"
[[heat.boundaries]]
faces = "left"
kind = "temperature"
temperature = "120 degC"
[[stages]]
kind = "conduct"
duration = "2 min"
interval = "1 min"
change = "0.5 K"
[output]
frame_interval = "30 s"
"""

    def test_check_forecasts_rows_and_disk_of_conduction(self):
        (self.folder / "wall.toml").write_text(self.WALL)

        def foreseen(*changes: str) -> tuple[float, float, str]:
            words = [word for change in changes for word in ("--set", change)]
            said = self.pyroclast("check", "wall.toml", *words).stdout
            rows, size, unit = re.search(r"results +about (\S+) rows of history\.csv.*; (\S+) (\wB) of disk", said).groups()
            return float(rows), float(size) * {"kB": 1e3, "MB": 1e6, "GB": 1e9}[unit], said

        self.pyroclast("run", "wall.toml", "-o", "wall", "--no-figures", "--quiet")
        rows = (self.folder / "wall/history.csv").read_bytes().count(b"\n") - 1
        files = [*(self.folder / "wall/fields").glob("*_*.hdf"), self.folder / "wall/history.csv",
                 self.folder / "wall/temperature_profile.csv"]
        size = sum(file.stat().st_size for file in files)
        forecast = foreseen()
        self.assertLess(abs(forecast[0] / rows - 1.0), 0.5, (forecast[0], rows))
        self.assertLess(abs(forecast[1] / size - 1.0), 0.5, (forecast[1], size))
        more = foreseen("stages[0].change=1e-9 K")
        self.assertGreater(more[0], 1e10)
        self.assertGreater(more[1], 1e12)
        self.assertRegex(more[2], r"; about (more than a hundred years|\d{2,} h)")
        self.assertGreater(forecast[1], foreseen("output.fields=false")[1])
        self.assertLess(foreseen("stages[0].interval=1 h", "stages[0].change=1000 K")[0], 3)

    def test_check_foretells_what_ranks_hold_and_send(self):
        chunks = {**os.environ, "PYROCLAST_CHUNK_BLOCKS": "25"}
        words = ("check", CASES / "fire_one_side.toml", "--set", "blocks.count=100")
        said = self.pyroclast(*words, "--ranks", 4, env=chunks).stdout
        self.assertIn("ranks           4 share 6 chunks", said)  # platens are chunks of their own
        rows = {what.strip(): (float(mean), float(most)) for what, mean, most in
                re.findall(r"\n {16}(\S.+?) +([\d.]+) +([\d.]+)(?=\n)", said[said.index("\nranks  "):])}
        self.assertEqual(list(rows), ["blocks", "zones over the mean", "blocks of other ranks that it holds too",
                                      "neighbours", "sent after each step [kB]",
                                      "sent after each stage of the heat solver [kB]", "memory [MB]"])
        self.assertEqual(rows["zones over the mean"][0], 1.0)
        self.assertAlmostEqual(4 * rows["blocks"][0], 102, delta=2)
        for mean, most in rows.values():
            self.assertLessEqual(mean, most)
            self.assertGreater(mean, 0.0)
        self.assertNotIn("ranks  ", self.pyroclast(*words).stdout)
        refused = self.pyroclast(*words, "--ranks", 7, env=chunks, code=1)
        self.assertEqual((refused.stdout, refused.stderr), ("", "error: 7 ranks cannot share a body of 6 chunks: "
                                                                "take 6 ranks at most, or more blocks\n"))

    def test_time_without_a_processor_does_not_lengthen_the_time_that_check_tells(self):
        def foreseen(rest: float) -> float:
            """Seconds that check tells, where it stands still for `rest` seconds behind each 5 ms of its work."""
            with subprocess.Popen([PROGRAM, "check", str(CASES / "starter.toml")], cwd=self.folder, text=True,
                                  stdout=subprocess.PIPE) as check:
                while rest and check.poll() is None:
                    time.sleep(0.005)
                    check.send_signal(signal.SIGSTOP)
                    time.sleep(rest)
                    check.send_signal(signal.SIGCONT)
                said = check.communicate(timeout=120)[0]
            told = re.search(r"steps; about (?:(\d+) h ?)?(?:(\d+) min ?)?(?:(\d+) s)?", said)
            hours, minutes, seconds = map(int, told.groups("0"))
            return 3600.0 * hours + 60.0 * minutes + seconds

        told = [foreseen(rest) for rest in (0.0, 0.02, 0.02, 0.02)]  # by the clock a step takes up to five times as long
        # the smallest, since noise of the machine lengthens one now and then
        self.assertLess(min(told[1:]), 2.0 * told[0])

    def test_a_text_in_the_place_of_a_list_is_proposed_as_a_list(self):
        (self.folder / "wall.toml").write_text(self.WALL)
        said = self.error("check", "wall.toml", "--set", 'specimen.symmetry="left"')
        self.assertIn('specimen.symmetry = "left": must be a list of texts: ["left"]', said)
        self.assertIn("must be a list of texts, each in quotation marks",
                      self.error("check", "wall.toml", "--set", "specimen.symmetry=3"))
        said = self.error("check", "wall.toml", "--set", "specimen.symmetry=[1]")
        self.assertIn("must hold texts only", said)
        self.assertNotIn("aggregate", said)

    def test_where_nothing_more_can_be_written_the_exit_code_tells(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "list", "cases"], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr.count("No space left on device")), (1, 1))
            for words in (["rnu"], ["list", "cases"], ["law", "--verify", "elastic", "--paths", "1"]):
                with self.subTest(words):
                    done = subprocess.run([PROGRAM, *words], stdout=full, stderr=full, check=False)
                    self.assertEqual(done.returncode, 1)

    def test_a_value_that_cannot_be_is_refused_with_what_can(self):
        case = str(CASES / "starter.toml")
        for option, word, least, most in (("--seed", "-3", 0, 9000000000000000), ("--threads", "5000", 1, 1024),
                                          ("--threads", "0", 1, 1024), ("--threads", "two", 1, 1024),
                                          ("--threads", "2.5", 1, 1024)):
            self.assertIn(f"{option}: {word} is not a whole number from {least} to {most};",
                          self.error("check", case, option, word))
        self.assertIn("--steps: 0 is not a whole number from 1 to", self.error("law", case, "--steps", "0"))
        self.assertIn("--paths: 0 is not a whole number from 1 to", self.error("law", "--verify", "--paths", "0"))

    def test_what_set_broke_is_told_of_set(self):
        case = str(CASES / "starter.toml")
        self.assertIn('--set: blocks.cuont = 300: unknown key; did you mean "count"?',
                      self.error("check", case, "--set", "blocks.cuont=300"))
        self.assertIn("--set title=??: not valid TOML: the text is not UTF-8 here",
                      self.error("check", case, "--set", b"title=\xff\xfe"))

    def test_the_true_error_is_alone(self):
        line = self.error("check", str(CASES / "hot_compression.toml"), "--set", "stages[1].to=400 C")
        self.assertIn('--set: stages[1].to = "400 C"', line)
        self.assertIn('did you mean "degC"?', line)

    def test_lists_name_what_there_is(self):
        self.assertEqual({line.split()[0] for line in self.pyroclast("list", "cases").stdout.splitlines()},
                         {path.stem for path in CASES.glob("*.toml")})
        for what, word in (("curves", "en1992_siliceous_strength"), ("fires", "iso834"), ("units", "stress"),
                           ("keys", "specimen.width"), ("laws", "cohesive")):
            self.assertIn(word, self.pyroclast("list", what).stdout)
        self.assertIn("cases, columns, curves", self.error("list").replace('"', ""))

    def test_new_gives_every_case_as_it_is(self):
        for case in CASES.glob("*.toml"):
            self.pyroclast("new", f"my_{case.stem}", "--from", case.stem)
            line, rest = (self.folder / f"my_{case.stem}.toml").read_text().split("\n", 1)
            self.assertEqual(line, "#:schema ./deck.schema.json")  # which holds on any machine
            self.assertEqual(rest, case.read_text())

    def test_the_time_left_is_that_of_the_stages_to_come_too(self):
        words = [PROGRAM, "run", CASES / "hot_strength.toml", "--set", "blocks.count=100", "--set", "stages[1].level=0.1",
                 "--no-figures", "--verbose", "-t", "1"]
        with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, text=True) as run:
            left = []
            for line in run.stdout:
                if "stage 3 of" in line:
                    break
                left += re.findall(r"stage 2 of 5 \(load\) .*?%, +(.*?) left(?! of the stage)", line)
            run.kill()
        self.assertGreater(len(left), 3)
        self.assertNotRegex(left[-1], r"^[01] s$")  # of the load alone nothing is left, of heating and crushing all

    def test_manual_and_completion_have_every_command_and_option(self):
        manual, bash = self.pyroclast("manual").stdout, self.pyroclast("completion").stdout
        zsh = self.pyroclast("completion", "zsh").stdout
        of_program = ("run", "resume", "plot-properties", "--law-path", "--from-stage", "--no-fields", "--watch")
        of_package = ("--magnification", "--temperatures", "--once", "--executor", "--dry-run", "compare", "report")
        for word in of_program + of_package:
            self.assertIn(word.replace("-", "\\-"), manual)
            self.assertIn(word, bash)
            self.assertIn(word, zsh)
        for text in (bash, zsh):
            self.assertIn("contacts.mortar_mortar.f_t", text)
            self.assertNotIn("contacts.NAME", text)
        self.assertIn("bash, zsh", self.error("completion", "fish"))
        for code in (0, 1, 2, 130):
            self.assertIn(f".TP\n{code}\n", manual)
        if shutil.which("bash"):
            for words, completed in (("run --ov", "--overwrite"), ("run mine.toml --set blocks.co", "blocks.count="),
                                     ("study re", "report"), ("study run --exec", "--executor"), ("list fi", "fields fires"),
                                     ("study run --executor sl", "slurm"), ("figures compare --wh", "--what"),
                                     ("watch --on", "--once --on"), ("new --from hot_c", "hot_compression")):
                script = (f"{bash}\nCOMP_WORDS=(pyroclast {words}) COMP_CWORD={len(words.split())}; _pyroclast; "
                          "echo ${COMPREPLY[@]}")
                done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
                self.assertEqual(done.stdout.strip(), completed, words)
        if shutil.which("zsh"):
            subprocess.run(["zsh", "-n"], input=zsh, capture_output=True, text=True, check=True)

    def test_doctor_tells_what_is_there_and_what_is_missing(self):
        told = self.pyroclast("doctor").stdout
        for what in ("pyroclast", "program", "system", "processor", "instructions", "threads", "memory", "disk", "compiler",
                     "Slurm", "Python", "  numpy", "  h5py", "  matplotlib", "  compiled part"):
            self.assertRegex(told, rf"(?m)^{what} +\S")
        self.assertNotRegex(told, "(?m)^(memory|disk|system) +unknown")
        elsewhere = subprocess.run([PROGRAM, "doctor"], capture_output=True, text=True, check=True,
                                   env=os.environ | {"PYROCLAST_PYTHON": "/nowhere/python3", "PATH": "/nowhere"}).stdout
        for what in ("compiler", "Slurm", "Python"):
            self.assertRegex(elsewhere, rf"(?m)^{what} +missing: ")

    def test_exit_codes_speech_and_fields(self):
        self.pyroclast("new", "mine")
        small = ["run", "mine.toml", "--no-figures", "--set", "blocks.count=60", "--set", "stages[1].stop_strain=2e-4"]
        drawing = [word for word in small if word != "--no-figures"]
        quiet = self.pyroclast(*drawing, "--out", "quiet", "--quiet", "--no-fields", "--no-report")
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))
        self.assertIn("ended           completed", (self.folder / "quiet/run.log").read_text())
        self.assertFalse((self.folder / "quiet/fields").exists())
        self.assertTrue((self.folder / "quiet/figures/stress_strain.png").exists())
        self.assertFalse((self.folder / "quiet/report.html").exists())
        drawn = self.pyroclast(*drawing, "--out", "drawn", "--quiet")
        self.assertEqual((drawn.stdout, drawn.stderr), ("", ""))
        self.assertTrue((self.folder / "drawn/figures/stress_strain.png").exists())
        self.assertTrue((self.folder / "drawn/report.html").exists())
        self.pyroclast(*small, "--out", "without", "--quiet")
        self.assertFalse((self.folder / "without/report.html").exists())
        self.pyroclast("report", "drawn", "--out", "elsewhere.html")
        self.assertIn("Content-Security-Policy", (self.folder / "elsewhere.html").read_text())
        self.pyroclast("report", "nowhere", code=1)
        verbose = self.pyroclast(*small, "--out", "verbose", "--verbose")
        self.assertGreater(verbose.stdout.count("(compress)"), 15)  # 20 looks
        self.assertTrue((self.folder / "verbose/fields/mesh.h5").exists())
        # 2: the run ended without what it was for
        self.pyroclast(*small, "--out", "two", "--set", "stages[0].most_steps=10", code=2)

    def test_a_number_that_cannot_be_is_refused_at_its_place_with_its_key(self):
        deck = (CASES / "starter.toml").read_text().replace("count = 1000", "count = 100").replace(
            "[contacts]", '[contacts]\nsecond_slope = "fixed"')
        for old, new, said in NUMBERS:
            with self.subTest(new):
                self.assertIn(old, deck)
                (self.folder / "deck.toml").write_text(deck.replace(old, new))
                error = self.pyroclast("check", "deck.toml", code=1).stderr
                self.assertRegex(error, r"^error: (deck\.toml:\d+:(\d+:)? .*\n)+$")
                self.assertIn(new.split(" = ")[0].replace("fuller_exponent" if "fraction" in said else "", ""), error)
                self.assertIn(said, error)


if __name__ == "__main__":
    unittest.main()
