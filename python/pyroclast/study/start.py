"""How a study starts Python."""

from __future__ import annotations

import sys


def python(module: str, *words: str) -> list[str]:
    """The command line of a module of this package; nothing of the current folder stands on its path."""
    return [sys.executable, "-P", "-m", module, *words]
