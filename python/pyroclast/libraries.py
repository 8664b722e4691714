"""Libraries that only some uses need."""

from __future__ import annotations

import importlib
import logging
import os
import sys
from typing import Any

from .errors import Error

MATPLOTLIB_TOLD = "PYROCLAST_MATPLOTLIB_TOLD"
"""A variable of the environment: a process before this one has told that Matplotlib has no folder."""


def library(name: str, purpose: str) -> Any:
    """Returns the library, or an `Error` that tells what to install and what for."""
    try:
        return importlib.import_module(name)
    except ImportError as missing:
        raise Error(f"{purpose} needs {name}: install the Debian package python3-{name}") from missing


def hear_matplotlib() -> None:
    """Tells in one line, once for all processes of a command, that Matplotlib has no folder for its list of fonts. Call
    it before Matplotlib is imported, which else says so in a line of 300 characters in each process.
    """
    is_without_folder = False

    def is_other(record: logging.LogRecord) -> bool:
        nonlocal is_without_folder
        if "MPLCONFIGDIR" not in record.getMessage():
            return not (is_without_folder and "font cache" in record.getMessage())
        is_without_folder = True
        if MATPLOTLIB_TOLD not in os.environ:
            print("warning: Matplotlib can keep no list of fonts under HOME, so that figures take some seconds longer; "
                  "name a folder for it by MPLCONFIGDIR", file=sys.stderr)
        return False

    for name in ("matplotlib", "matplotlib.font_manager"):
        logging.getLogger(name).addFilter(is_other)
