"""The commands of the README, as they stand there and in their order. PYROCLAST names the program."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]


def commands() -> list[str]:
    """Lines of the blocks of shell commands in the README's part "Use it"."""
    part = (ROOT / "README.md").read_text().partition("\n## Use it\n")[2].partition("\n## ")[0]
    blocks = re.findall(r"^```sh\n(.*?)^```$", part, re.MULTILINE | re.DOTALL)
    return [line for block in blocks for line in block.splitlines() if line.strip()]


class Readme(unittest.TestCase):
    def test_its_commands_run_one_after_the_other(self):
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        program = pathlib.Path(os.environ["PYROCLAST"]).resolve()
        environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}"}
        lines = commands()
        self.assertEqual(len(lines), 4)
        for line in lines:
            with self.subTest(line):
                done = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True,
                                      timeout=1200, check=False)
                self.assertEqual(done.returncode, 0, done.stdout[-1000:] + done.stderr)
                self.assertNotIn("no figures were drawn", done.stderr)
        for promised in ("mine.toml", "runs/mine/summary.json", "runs/mine/figures"):
            self.assertTrue((folder / promised).exists(), promised)

    def test_it_is_short(self):
        self.assertLessEqual((ROOT / "README.md").read_text().count("\n"), 100)


if __name__ == "__main__":
    unittest.main()
