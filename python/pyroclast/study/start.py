"""How a study starts Python."""

from __future__ import annotations

import sys

FOLDER = "\0"
"""In a word of a command, where the folder of the run is put in: a character that no word can hold."""


def python(module: str, *words: str) -> list[str]:
    """The command line of a module of this package; nothing of the current folder stands on its path."""
    return [sys.executable, "-P", "-m", module, *words]
