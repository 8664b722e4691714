"""The second compiler takes every module and the program: `scripts/test clang` and the sanitizers depend on it."""

import json
import os
import pathlib
import shlex
import subprocess
import unittest

BUILD = pathlib.Path(os.environ["PYROCLAST_BUILD"])
OF_GCC_ALONE = {"-Wno-subobject-linkage", "--param=ggc-min-heapsize=500000"}  # for units of many files


def units() -> list[list[str]]:
    """Returns the commands that check the units of the library's modules and of the program."""
    commands = []
    for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
        place = pathlib.Path(entry["file"])
        if "Unity" not in place.parts or not {"pyroclast.dir", "pyroclast_app.dir"} & set(place.parts):
            continue
        words = shlex.split(entry["command"])
        first = next(i for i, word in enumerate(words) if word.startswith("-"))  # behind the compiler and a cache of it
        options = [word for word in words[first : words.index("-o")] if word not in OF_GCC_ALONE]
        # in one unit a variable may hide a constant of another file
        commands.append(["clang++", *options, "-Wno-shadow", "-fsyntax-only", entry["file"]])
    return commands


def complaint(command: list[str]) -> str:
    """Returns what the compiler says against a unit."""
    done = subprocess.run(command, cwd=BUILD, capture_output=True, text=True)
    return done.stderr if done.returncode else ""


class Clang(unittest.TestCase):
    def test_takes_all_modules_and_the_program(self):
        commands = units()
        self.assertGreater(len(commands), 15)
        self.assertEqual([], [text for text in map(complaint, commands) if text])


if __name__ == "__main__":
    unittest.main()
