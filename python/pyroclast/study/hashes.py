"""Hashes of texts and of files."""

from __future__ import annotations

import functools
import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..errors import Error


def hash_of(parts: Iterable[tuple[str, bytes]]) -> str:
    """Returns the SHA-256 of texts by name, in their order."""
    hashed = [(name, hashlib.sha256(text).hexdigest()) for name, text in parts]
    return hashlib.sha256(json.dumps(hashed).encode()).hexdigest()


def require_unchanged(files: Mapping[str, str]) -> None:
    """Raises Error where a file is another one than that of which the hash is known."""
    for file, known in files.items():
        if hash_of_file(Path(file)) != known:
            raise Error(f"{file} has changed since the study began; start it again")


def hash_of_file(file: Path) -> str:
    """Returns the SHA-256 of a file. Raises Error where it cannot be read."""
    try:
        known = os.stat(file)
        return _hash_at(str(file), (known.st_dev, known.st_ino, known.st_size, known.st_mtime_ns, known.st_ctime_ns))
    except OSError as error:
        raise Error(f"{file}: cannot be read: {error.strerror}") from error


@functools.cache
def _hash_at(file: str, state: tuple[int, ...]) -> str:
    """Hashes a file once for each of its states: some are large, and each run asks."""
    with open(file, "rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
