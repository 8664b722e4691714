"""The command line: `pyroclast report RUN`. Prints the path of the page.

Ends with 1 and one line on stderr when something is missing or malformed.
"""

from __future__ import annotations

import sys
import warnings

from ..errors import Error
from ..files import GapWarning
from ..interrupts import hear_ctrl_c
from . import write_page
from .command_line import parser


def main(words: list[str]) -> int:
    """Returns the exit code."""
    hear_ctrl_c()
    asked = parser().parse_args(words)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GapWarning)  # gaps of curves stay gaps
        try:
            print(write_page(asked.folders, asked.out))
        except Error as error:
            print(f"error: {error}", file=sys.stderr)
            return 1
        except OSError as error:
            print(f"error: {error.filename or ''}: {error.strerror or error}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
