"""Libraries that only some uses need."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import Error


def library(name: str, purpose: str) -> Any:
    """The library, or an `Error` that tells what to install and what for."""
    try:
        return importlib.import_module(name)
    except ImportError as missing:
        raise Error(f"{purpose} needs {name}: install the Debian package python3-{name}") from missing
