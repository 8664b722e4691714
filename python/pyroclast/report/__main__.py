"""The command line: `pyroclast report RUN`. Prints the path of the page.

Ends with 1 and one line on stderr when something is missing or malformed.
"""

from __future__ import annotations

import sys
import warnings

from ..programs import run_program, say
from ..stored.files import GapWarning
from . import write_page
from .command_line import parser


def main(words: list[str]) -> int:
    """Returns the exit code."""
    return run_program(lambda: _make(words))


def _make(words: list[str]) -> int:
    asked = parser().parse_args(words)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GapWarning)  # gaps of curves stay gaps
        say(write_page(asked.folders, asked.out))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
