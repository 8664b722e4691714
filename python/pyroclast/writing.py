"""Files and folders of fixed names that others may have laid links in: nothing is written through a link. Paths in
commands.
"""

from __future__ import annotations

import errno
import os
import secrets
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .texts import seen_on_a_line


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Lends a file beside `path` to be written, which then takes its place; where something goes wrong there is none.

    It is made under a name that was free. A link at `path` is replaced and not followed. `--overwrite` knows its
    ending.
    """
    aside = path.with_name(f"{path.name}.{secrets.token_hex(4)}.partial")
    os.close(os.open(aside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    try:
        yield aside
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Writes a text: its file is there whole or not at all."""
    with whole(path) as aside:
        aside.write_text(text, encoding="utf-8", newline="")


def make_folder(path: Path) -> Path:
    """Makes a folder of a fixed name, where there is none. Raises OSError where it is a link."""
    path.mkdir(parents=True, exist_ok=True)
    refuse_link(path)
    return path


def refuse_link(path: Path) -> None:
    """Raises OSError where `path` is a link. A file that has another name (a hard link) is one: that name may lie
    elsewhere.
    """
    if path.is_symlink():
        raise OSError(errno.ELOOP, "is a link, and nothing is written through it; remove it", str(path))
    if path.is_file() and path.stat().st_nlink > 1:
        raise OSError(errno.EMLINK, "is a link, and nothing is written through it: the same file has another name, as "
                      "where a folder is copied by links (cp -l, rsync --link-dest); copy the folder whole (cp -r), "
                      "and use the copy", str(path))


def shell_path(path: str | Path) -> str:
    """Returns a path as a shell takes it for a command that is to be given next: quoted, and no option where it begins
    with a dash. Characters that a terminal does not show are written by their bytes, in quotes of bash: $'\\033'.
    """
    text = str(path)
    text = f"./{text}" if text.startswith("-") else text
    if seen_on_a_line(text) == text:
        return shlex.quote(text)
    plain = (c if seen_on_a_line(c) == c and c not in "'\\" else "".join(f"\\{byte:03o}" for byte in os.fsencode(c))
             for c in text)
    return f"$'{''.join(plain)}'"
