"""The assertion of each example fails when an input that it names is halved."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples" / "python"
BLOCKS = "120"
STRENGTHS = "".join(f'deck["contacts.mortar_mortar.{key}"] = "{value}"\n'
                    for key, value in (("f_t", "1.25 MPa"), ("c_o", "1.9 MPa"), ("f_cm", "15.5 MPa")))
MODULI = 'deck["materials.mortar.E"] = "14.7 GPa"\ndeck["materials.aggregate.E"] = "35 GPa"\n'

HALVED = {  # what stands in the script, and what is put in its place
    "compression": ("run = pyroclast.Run(deck)\n", STRENGTHS + "run = pyroclast.Run(deck)\n"),
    "cracks": ("in (300, 500):", "in (150, 250):"),
    "ct_slice": ("PIXEL = 0.5 * mm", "PIXEL = 0.25 * mm"),
    "live_curve": ("run = pyroclast.Run(deck)\n", MODULI + "run = pyroclast.Run(deck)\n"),
    "notched_beam": ("history = (run",
                     'deck["contacts.mortar_mortar.G_f1"] = "30 N/m"\nhistory = (run'),
    "own_law": ('"sigma_max": 2.5 * MPa', '"sigma_max": 1.25 * MPa'),
    "own_stage": ('velocity="10 mm/s"', 'velocity="5 mm/s"'),
    "parametric_fire": ("rise = 1325.0", "rise = 662.5"),
    "seeds": ('    deck["stages[1].stop', "".join(f"    {line}\n" for line in STRENGTHS.splitlines()) +
              '    deck["stages[1].stop'),
    "unload_reload": ("run = pyroclast.Run(deck)\n", MODULI + "run = pyroclast.Run(deck)\n"),
}


class Halved(unittest.TestCase):
    def test_every_example_has_an_input_that_is_halved(self):
        self.assertEqual(set(HALVED), {script.stem for script in EXAMPLES.glob("*.py")})

    def test_the_law_that_is_compiled_holds_its_own(self):
        with tempfile.TemporaryDirectory() as folder:  # other examples are run as they are with the package
            done = subprocess.run([sys.executable, EXAMPLES / "own_law.py", BLOCKS], capture_output=True, text=True,
                                  check=False, timeout=300, cwd=folder)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_its_assertion_fails(self):
        for name, (stands, instead) in HALVED.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                text = (EXAMPLES / f"{name}.py").read_text()
                self.assertEqual(text.count(stands), 1)
                halved = pathlib.Path(folder) / f"{name}.py"
                place = f"Path({str(EXAMPLES / name)!r})"
                halved.write_text(text.replace(stands, instead).replace("Path(__file__)", place))
                done = subprocess.run([sys.executable, halved, BLOCKS], capture_output=True, text=True, check=False,
                                      timeout=300, cwd=folder)
                self.assertEqual(done.returncode, 1, done.stdout)
                self.assertIn("AssertionError", done.stderr, done.stderr)
