"""Commands that the program proposes can be pasted into a shell, whatever the names of files. PYROCLAST names the
program.
"""

import json
import os
import pathlib
import re
import shlex
import subprocess
import tomllib
import unittest

from in_a_folder import PROGRAM, InAFolder
from sanitized import needs_studies

CASES = pathlib.Path(__file__).parents[2] / "cases"
NAMES = ("My deck", "it's mine", "-dash", 'say "hello"', "Prüfung 1", "a&b;c", "$HOME")


class CommandsToPaste(InAFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/pyroclast").symlink_to(PROGRAM)

    def pyroclast(self, *words, code: int = 0) -> str:
        """All that the program says."""
        done = super().pyroclast(*words, code=code)
        return done.stdout + done.stderr

    def paste(self, command: str, code: int = 0) -> str:
        """What comes of a line in a shell."""
        path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True, timeout=300, check=False,
                              env=os.environ | {"PATH": path})
        self.assertEqual(done.returncode, code, command + "\n" + done.stdout + done.stderr)
        return done.stdout + done.stderr

    def proposed(self, text: str, start: str) -> str:
        return re.search(rf"{start}[^`\n]*", text)[0]

    def test_a_new_deck_is_checked_by_the_line_that_new_prints(self):
        for name in NAMES:
            with self.subTest(name):
                said = self.pyroclast("new", "--from", "starter", "--", name)
                self.assertIn("valid", self.paste(self.proposed(said, "pyroclast check")))
                self.assertEqual(shlex.split(self.proposed(said, "pyroclast run"))[2].removeprefix("./"), f"{name}.toml")

    @needs_studies
    def test_the_calibration_of_a_concrete_is_found_from_its_message_and_from_its_files(self):
        for name in NAMES[1:5]:
            with self.subTest(name):
                said = self.pyroclast("concrete", "--f_c", "45 MPa", "--E", "32 GPa", "--aggregate", "limestone", "--fraction",
                                      "0.4", "--d_max", "20 mm", "--blocks", "300", "--hot", "400 degC", f"--out={name}.toml")
                study = self.folder / f"{name}-calibrate.toml"
                for text in (said, study.read_text(), (self.folder / f"{name}.toml").read_text()):
                    words = shlex.split(self.proposed(text, "pyroclast study run"))
                    self.assertEqual(words[3].removeprefix("./"), study.name)
                self.assertIn("is valid", self.paste(self.proposed(said, "pyroclast study run").replace("run", "check", 1)))
                best = shlex.split(self.proposed(said, "--from"))[1]
                self.assertEqual(best, f"{tomllib.loads(study.read_text())['study']['folder']}/best.toml")

    def test_the_best_deck_of_a_concrete_in_another_folder_is_named_from_here(self):
        (self.folder / "sub 1").mkdir()
        said = self.pyroclast("concrete", "--f_c", "45 MPa", "--E", "32 GPa", "--aggregate", "granite", "--fraction", "0.4",
                              "--d_max", "20 mm", "--blocks", "300", "--hot", "400 degC", "-o", "sub 1/mine.toml")
        self.assertEqual(shlex.split(self.proposed(said, "--from"))[1], "sub 1/runs/mine-calibrate/best.toml")

    def test_a_manifest_holds_its_command_and_a_run_that_is_over_is_forked_by_the_line_it_prints(self):
        (self.folder / "my wall.toml").write_text((CASES / "thermal_wall.toml").read_text())
        words = ["run", "my wall.toml", "--out", "it's out", "--no-figures", "--set", 'title="a \'b\' $c"', "--set",
                 'stages[0].duration="1 min"']
        self.pyroclast(*words)
        manifest = json.loads((self.folder / "it's out/manifest.json").read_text())
        self.assertEqual(shlex.split(manifest["command"])[1:], words)
        said = self.pyroclast("resume", "it's out", code=1)
        command = self.proposed(said, "pyroclast resume")
        self.assertEqual(shlex.split(command)[2], "it's out")
        (self.folder / "MORE.toml").write_text('[[stages]]\nkind = "conduct"\nduration = "1 min"\ninterval = "30 s"\n')
        self.paste(f"{command} --no-figures")

    @needs_studies
    def test_a_study_and_its_next_command(self):
        (self.folder / "model.py").write_text('def f(seed):\n    return {"z": seed}\n')
        for name in NAMES[:5]:
            with self.subTest(name):
                (self.folder / f"{name}.toml").write_text('[study]\nrunner = "function"\nfunction = "model.py:f"\n[method]\n'
                                                          'kind = "ensemble"\n[outputs]\nz = "z"\n')
                said = self.pyroclast("study", "table", f"./{name}.toml", code=2)
                done = self.paste(self.proposed(said, "pyroclast study run") + " --allow-code")
                report = shlex.split(self.proposed(done, "pyroclast study report"))
                self.assertEqual(pathlib.Path(report[3]), pathlib.Path(f"{name}.toml"))


if __name__ == "__main__":
    unittest.main()
