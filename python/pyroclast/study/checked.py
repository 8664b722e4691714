"""Runs a command of a study as the study would: `python3 -m pyroclast.study.checked FILES WORD...`.

FILES is a JSON object, the SHA-256 of each file that the command runs by its name. Where one is another file, nothing
is run.
"""

from __future__ import annotations

import json
import subprocess
import sys

from ..programs import run_program
from .hashes import require_unchanged
from .start import environment


def main(files: dict[str, str], command: list[str]) -> int:
    """Returns the exit code of the command."""
    require_unchanged(files)
    return subprocess.run(command, env=environment(files), check=False).returncode


if __name__ == "__main__":
    sys.exit(run_program(lambda: main(json.loads(sys.argv[1]), sys.argv[2:])))
