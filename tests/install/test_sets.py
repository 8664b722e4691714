"""Which instruction sets a build holds, as CMake is told. PYROCLAST_BUILD names the build that is tested."""

import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).parents[2]
PROGRAM = pathlib.Path(os.environ["PYROCLAST_BUILD"]) / "bin/pyroclast"


class Sets(unittest.TestCase):
    def configure(self, *settings: str) -> subprocess.CompletedProcess:
        with tempfile.TemporaryDirectory() as build:
            return subprocess.run(["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", *settings], capture_output=True,
                                  text=True, check=False)

    def refusal_of(self, *settings: str) -> str:
        done = self.configure(*settings)
        self.assertNotEqual(done.returncode, 0)
        return " ".join(done.stderr.split())

    def test_a_set_that_there_is_not_is_refused_with_those_there_are(self):
        self.assertRegex(self.refusal_of("-DPYROCLAST_SETS=portable;sse9"),
                         '"sse9" is not all, native or a list of portable')

    def test_the_tests_need_all(self):
        if "portable, " not in self.version():
            self.skipTest("there is one set alone for this processor's architecture")
        self.assertIn("say PYROCLAST_SETS=all, or PYROCLAST_TESTS=OFF", self.refusal_of("-DPYROCLAST_SETS=portable"))

    def test_native_is_one_set(self):
        done = self.configure("-DPYROCLAST_SETS=native", "-DPYROCLAST_TESTS=OFF")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"Instruction sets: (portable|avx2|avx512)\n")

    def version(self) -> str:
        return subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout

    def test_the_program_names_its_sets(self):
        self.assertRegex(self.version(), r", instruction sets portable(, avx2, avx512)?\n$")


if __name__ == "__main__":
    unittest.main()
