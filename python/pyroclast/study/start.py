"""How a study starts Python."""

from __future__ import annotations

import atexit
import functools
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable

FOLDER = "\0"
"""The place in a word of a command where the folder of the run is put in: a character that no word can hold."""


def python(module: str, *words: str) -> list[str]:
    """Returns the command line of a module of this package; nothing of the current folder stands on its path."""
    return [sys.executable, "-P", "-m", module, *words]


@functools.cache
def _empty_folder() -> str:
    """Makes a folder of this process alone."""
    folder = tempfile.mkdtemp(prefix="pyroclast-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def environment(files: Iterable[str]) -> dict[str, str]:
    """Returns the environment of a run that runs `files`. Where one of them is a .py file, Python then takes no
    compiled module from a `__pycache__`, unless its options or the command ignore the environment.
    """
    is_python = any(file.endswith(".py") for file in files)
    return {**os.environ, "PYTHONPYCACHEPREFIX": _empty_folder()} if is_python else dict(os.environ)
