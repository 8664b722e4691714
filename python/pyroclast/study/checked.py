"""Runs a command of a study as the study would: `python3 -m pyroclast.study.checked FILES WORD...`.

FILES is a JSON object, the SHA-256 of each file that the command runs by its name. Where one is another file, nothing
is run.
"""

from __future__ import annotations

import json
import subprocess
import sys

from ..errors import Error
from .hashes import require_unchanged
from .start import environment


def main(words: list[str]) -> int:
    files = json.loads(words[0])
    try:
        require_unchanged(files)
        return subprocess.run(words[1:], env=environment(files), check=False).returncode
    except (Error, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
