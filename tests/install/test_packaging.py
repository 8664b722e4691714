"""Scripts and recipes of packages, as far as they can be tried without a fresh system; scripts/release tries the rest."""

import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).parents[2]


class Packaging(unittest.TestCase):
    def test_scripts_are_whole(self):
        for script in ("packaging/debian", "packaging/tarball", "packaging/try-debian", "packaging/try-tarball",
                       "scripts/release"):
            subprocess.run(["bash", "-n", ROOT / script], check=True)

    def test_both_recipes_have_the_same_lines(self):
        docker = re.findall(r"^RUN (.*)$", (ROOT / "packaging/Dockerfile").read_text(), flags=re.MULTILINE)
        post = (ROOT / "packaging/apptainer.def").read_text().split("%post\n")[1].split("\n\n")[0]
        self.assertEqual(" && ".join(docker), " && ".join(line.strip() for line in post.splitlines()))

    def test_recipes_name_the_version(self):
        version = re.search(r"project\(pyroclast VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        for recipe in ("Dockerfile", "apptainer.def"):
            self.assertIn(f"build/release-{version}", (ROOT / "packaging" / recipe).read_text())


if __name__ == "__main__":
    unittest.main()
