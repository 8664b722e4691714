"""Python files that import one another from one folder: which they are, their hash, and their import.

The function of a study runs from the texts that were hashed. Python reads no file beside the function itself: no
compiled `.pyc`, no `.so`, and no module that the hash does not cover.
"""

from __future__ import annotations

import ast
import importlib.abc
import importlib.machinery
import importlib.util
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

from ..errors import Error
from .hashes import hash_of

OWN = "pyroclast_study_model"
"""Name under which the file that a study names is imported."""

_COMPILED = (*importlib.machinery.EXTENSION_SUFFIXES, *importlib.machinery.BYTECODE_SUFFIXES)


@dataclass(frozen=True)
class SourceFile:
    """A file of Python as it was read. is_package: its modules lie in the folder of the file."""

    path: Path
    text: bytes
    is_package: bool = False


def hash_of_function(sources: Mapping[str, SourceFile], function: str) -> str:
    """Returns the hash of a study's function, which does not depend on where its files lie."""
    return hash_of([("function", function.encode()), *((name, source.text) for name, source in sources.items())])


def modules_of_function(file: Path) -> dict[str, SourceFile]:
    """Returns a file and the modules beside it that it imports, and so on, by the names under which they are imported.

    Raises Error where a file cannot be read, and where Python has another module of one of the names.
    """
    try:
        found = {OWN: SourceFile(file, file.read_bytes())}
    except OSError as error:
        raise Error(f"{file}: is no Python file that can be read: {error.strerror}") from error
    for importer in _growing(found):
        for name in _imported(importer, found[importer]):
            source = _source(file.parent, name)
            if name in found or source is None:
                continue
            top = name.partition(".")[0]
            if (other := _elsewhere(top, file.parent)) is not None:
                raise Error(f"{found[importer].path}: imports {name}, of which there are two: {source.path} and that "
                            f"of {other}; give the file another name")
            found[name] = source
    return found


def modules_of_script(file: Path | None, folder: Path, code: bytes = b"") -> list[Path]:
    """Returns files that Python may take from a folder, which stands first on its path, for a script.

    file: the script; None for `python -c`, which runs code. Compiled modules count, and modules that take the place of
    one of Python, whoever imports it.
    """
    main = SourceFile(file or folder / "-c", file.read_bytes() if file else code)
    found = {OWN: main}
    files: list[Path] = [] if file is None else [file]

    def take(name: str) -> None:
        base = folder / name.replace(".", "/")
        parts = [p for place in (base, base / "__init__", base / "__main__") for p in _files(place)]
        files.extend(p for p in parts if p not in files)
        source = _source(folder, name)
        if source is not None:
            found.setdefault(name, source)

    for entry in sorted(folder.iterdir()):
        name = entry.name.partition(".")[0]
        if name.isidentifier() and name != "__pycache__" and _is_module(entry) and _elsewhere(name, folder):
            take(name)
    for importer in _growing(found):
        for name in _imported(importer, found[importer]):
            take(name)
    return files


def imported(sources: Mapping[str, SourceFile]) -> ModuleType:
    """Imports the module of the file that a study names. It and what it imports beside it run from texts in memory."""
    finder = _Beside(sources)
    sys.meta_path.append(finder)  # last: what Python has comes first
    spec = finder.find_spec(OWN)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[OWN] = module
    spec.loader.exec_module(module)
    return module


class _Beside(importlib.abc.MetaPathFinder, importlib.abc.InspectLoader):
    """Imports modules from texts in memory."""

    def __init__(self, sources: Mapping[str, SourceFile]):
        self._sources = sources
        self._folder = sources[OWN].path.parent

    def find_spec(self, fullname: str, path: Sequence[str] | None = None,
                  target: ModuleType | None = None) -> importlib.machinery.ModuleSpec | None:
        if fullname in self._sources:
            source = self._sources[fullname]
            return importlib.util.spec_from_file_location(fullname, source.path, loader=self,
                                                          submodule_search_locations=[] if source.is_package else None)
        if any(name.startswith(f"{fullname}.") for name in self._sources):  # a folder without __init__.py
            return importlib.machinery.ModuleSpec(fullname, None, is_package=True)
        base = self._folder / fullname.replace(".", "/")
        if there := [*_files(base), *_files(base / "__init__")]:
            why = ("is compiled; only .py files beside the function of a study are imported"
                   if there[0].name.endswith(_COMPILED) else
                   f"is not in the hash of the study's code; write `import {fullname}` where the function can see it")
            raise ModuleNotFoundError(f"{there[0]}: {why}", name=fullname)
        return None

    def get_source(self, fullname: str) -> str:
        return importlib.util.decode_source(self._sources[fullname].text)

    def get_code(self, fullname: str) -> CodeType:
        source = self._sources[fullname]
        code: CodeType = compile(source.text, str(source.path), "exec", dont_inherit=True)
        return code

    def is_package(self, fullname: str) -> bool:
        return self._sources[fullname].is_package

    def get_filename(self, fullname: str) -> str:
        return str(self._sources[fullname].path)


def _growing(found: Mapping[str, Any]) -> Iterator[str]:
    """Yields the keys of a dict, with those that are added on the way."""
    done = 0
    while done < len(found):
        yield list(found)[done]
        done += 1


def _source(folder: Path, name: str) -> SourceFile | None:
    """Returns the package or the module of a name below a folder."""
    base = folder / name.replace(".", "/")
    for path in (base / "__init__.py", base.with_name(f"{base.name}.py")):
        if path.is_file():
            return SourceFile(path, path.read_bytes(), path.name == "__init__.py" and path.parent == base)
    return None


def _files(base: Path) -> list[Path]:
    """Returns what Python would take for a module, but for packages: its source and compiled forms."""
    named = [base.with_name(f"{base.name}{ending}") for ending in (*_COMPILED, ".py")]
    return [path for path in named if path.is_file()]


def _is_module(entry: Path) -> bool:
    return entry.name.endswith((".py", *_COMPILED)) or bool(entry.is_dir() and _files(entry / "__init__"))


def _elsewhere(name: str, folder: Path) -> str | None:
    """Returns the place of the module of Python, or of the installed module, that has a name; None without one."""
    if name in sys.builtin_module_names or name in sys.stdlib_module_names:
        return "Python"
    first = 0 if sys.flags.safe_path else 1  # the folder of the script that runs
    places = [place for place in sys.path[first:] if place and Path(place).resolve() != folder.resolve()]
    spec = importlib.machinery.PathFinder.find_spec(name, places)
    if spec is None:
        return None
    return spec.origin or ", ".join(spec.submodule_search_locations or ())


def _imported(name: str, source: SourceFile) -> Iterator[str]:
    """Yields full names of modules that a file imports by a statement, with the packages that hold them."""
    try:
        tree = ast.parse(source.text)
    except (SyntaxError, ValueError, RecursionError):
        return  # what Python says of it comes when it is called
    package = [] if name == OWN else name.split(".")[:None if source.is_package else -1]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name.split(".") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            whole = node.module.split(".") if node.module else []
            if node.level:
                whole = [*package[:len(package) + 1 - node.level], *whole]
            names = [whole, *([*whole, alias.name] for alias in node.names)]
        else:
            continue
        for parts in names:
            yield from (".".join(parts[:n]) for n in range(1, len(parts) + 1) if parts[n - 1].isidentifier())
