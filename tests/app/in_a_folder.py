"""A test that runs the program in a folder of its own."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from sanitized import SANITIZED

PROGRAM = os.environ["PYROCLAST"]
LONGEST = 3000 if SANITIZED else 300  # s, far more than any command takes


class InAFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def pyroclast(self, *words, code: int | None = 0, **options) -> subprocess.CompletedProcess:
        """Runs the program, which must exit with the code. code: None for any."""
        told = [word if isinstance(word, bytes) else str(word) for word in words]
        done = subprocess.run([PROGRAM, *told], cwd=self.folder, capture_output=True, encoding="utf-8",
                              errors="replace", timeout=LONGEST, check=False, **options)
        if code is not None:
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done
