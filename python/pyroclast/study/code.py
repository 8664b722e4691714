"""What of a study is code, and the user's word on it."""

from __future__ import annotations

import ast
import shlex
from collections.abc import Iterator
from pathlib import Path

from .. import _core
from ..errors import Error
from .file import Runner


def require_code(runner: Runner, named: bool) -> None:
    """Returns where the function or the command of a study may run. named: a script names it, and no file.

    Raises CodeNotAllowed where the user has to allow it first.
    """
    if runner.kind == "function":
        texts = [file.read_bytes() for file in _modules(runner.file.resolve())]
        _core.require_code(f"{runner.file}:{runner.function}", [*texts, runner.function.encode()], named)
    elif runner.kind == "command":
        files = [Path(word) for word in words_of(runner.command)]
        texts = [file.read_bytes() for file in files if file.is_file()]
        _core.require_code(runner.command, [runner.command.encode(), *texts], named)


def words_of(command: str) -> list[str]:
    """Of a command line, before anything is put into its words. Raises Error where a quote stays open."""
    try:
        return shlex.split(command)
    except ValueError as error:
        raise Error(f"the command {command!r} has no words: {error}") from error


def _modules(file: Path) -> list[Path]:
    """A Python file, and those beside it that it imports, and so on."""
    found = [file]
    for module in found:
        for name in _imported(module):
            for other in (file.parent / f"{name}.py", file.parent / name / "__init__.py"):
                if other.is_file() and other not in found:
                    found.append(other)
    return found


def _imported(file: Path) -> Iterator[str]:
    """Names with slashes, of a package and of what is in it."""
    try:
        tree = ast.parse(file.read_bytes())
    except (OSError, SyntaxError, ValueError, RecursionError):
        return  # what Python says of it comes when it is called
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            whole = node.module or ""
            names = [whole, *(f"{whole}.{alias.name}".lstrip(".") for alias in node.names)]
        else:
            continue
        for name in names:
            parts = name.split(".")
            yield from ("/".join(parts[:n]) for n in range(1, len(parts) + 1))
