"""Code that runs for a study: its hash, by which runs and the user's permission are known."""

from __future__ import annotations

import itertools
import re
import shlex
import shutil
import string
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from .. import _core
from ..errors import Error
from .file import StudySetup
from .hashes import hash_of, hash_of_file
from .modules import hash_of_function, modules_of_function, modules_of_script
from .parameters import Parameter

_PYTHON = re.compile(r"(?:python|pypy)[\d.]*")
_IGNORES_ENVIRONMENT = re.compile(r"-[a-zA-Z]*[EI][a-zA-Z]*")
_DROPS_ENVIRONMENT = re.compile(r"-|-[a-zA-Z]*[iu].*|--ignore-environment|--unset.*")  # of `env`
_SHELL = re.compile(r"(?:ba|da|z|k|c|tc)?sh")
_ASSIGNS = re.compile(r"[A-Z_][A-Z0-9_]*=")
_WRITES = re.compile(r"\d?>>?\s*[^\s;&|]+")  # a file that a shell writes
_BETWEEN = re.compile(r"[\s;&|<>()`'\"=,:]+")  # in a word: what may stand between names of files
_GOES_ELSEWHERE = ("cd", "pushd", "-C", "--directory", "--chdir")
_SYSTEM = ("/usr/", "/bin/", "/sbin/", "/lib/", "/lib64/", "/dev/", "/proc/", "/sys/")
_COMPILED = "Python may take compiled modules that lie beside others"
_MOST_FORMS = 10000  # of a command, by the choices of its parameters


@dataclass(frozen=True)
class StudyCode:
    """Code of a function or a command.

    hash: of all its texts. files: that a command runs, with the SHA-256 of each. unknown: reason why the hash does not
    cover all that runs; empty where it does.
    """

    what: str = ""
    hash: str = ""
    files: Mapping[str, str] = field(default_factory=dict)
    unknown: str = ""


def code_of(study: StudySetup) -> StudyCode:
    """Returns the code of a study as it stands now; without a name where runs are those of a deck.

    Raises Error where a file cannot be read, and where a module has the name of another one.
    """
    runner = study.runner
    if runner.kind == "function":
        sources = modules_of_function(runner.file.resolve())
        return StudyCode(f"{runner.file}:{runner.function}", hash_of_function(sources, runner.function))
    if runner.kind == "command":
        return _Command(study).code()
    return StudyCode()


def require_code(code: StudyCode, named: bool) -> None:
    """Returns where the code may run. named: a script names it, and no file.

    Raises CodeNotAllowed where the user has to allow it first.
    """
    if code.what:
        _core.require_code(code.what, code.hash, code.unknown, named)


def require_options(study: StudySetup, named: bool) -> None:
    """Returns where sbatch may get the options of a study; see `require_code`."""
    options = study.slurm.unusual
    if options:
        what = f"{study.place('slurm.options')}: {', '.join(options)} for sbatch, which may run any program"
        _core.require_code(what, hash_of(("option of sbatch", option.encode()) for option in options), "", named)


def words_of(command: str) -> list[str]:
    """Splits a command line into words, before anything is put into these. Raises Error where a quote stays open."""
    try:
        return shlex.split(command)
    except ValueError as error:
        raise Error(f"the command {command!r} has no words: {error}") from error


class _Command:
    """Looks for the files that a command names, and for reasons why they may not be all that runs."""

    def __init__(self, study: StudySetup):
        self._study = study
        self._folders = (Path(), study.file.parent)  # the commands run in the first, other commands also elsewhere
        self._files: dict[str, Path] = {}  # by the names that the command gives them
        self._unknown: list[str] = []

    def code(self) -> StudyCode:
        command = self._study.runner.command
        for words in self._forms(words_of(command)):
            self._look_at(words)
        hashes = {name: hash_of_file(file) for name, file in self._files.items()}
        parts = [("command", command.encode()), *((name, known.encode()) for name, known in hashes.items())]
        return StudyCode(command, hash_of(parts), {str(file.absolute()): hashes[name] for name, file in
                                                   self._files.items()}, "; ".join(dict.fromkeys(self._unknown)))

    def _forms(self, words: Sequence[str]) -> Iterator[list[str]]:
        """Yields the command by values of its parameters that are choices or whole numbers: these may name files."""
        used = {name for word in words for name in _fields(word)}
        countable = [p for p in self._study.parameters if p.name in used and p.distribution.count is not None]
        count = 1
        for parameter in countable:
            count *= parameter.distribution.count or 1
        if count > _MOST_FORMS:
            self._unknown.append(f"its parameters {', '.join(p.name for p in countable)} give it too many forms to "
                                 "look for files in each")
            countable = [p for p in countable if p.distribution.kind == "choice"][:1]
        for values in itertools.product(*(_values(p) for p in countable)):
            filled = dict(zip((p.name for p in countable), values))
            yield [_fill(word, filled) for word in words]

    def _look_at(self, words: Sequence[str]) -> None:
        """Takes in the files of one form of the command, or of what a shell gets to run."""
        if not words:
            return
        if "{" in words[0]:
            self._unknown.append(f"its program {words[0]} depends on a run")
        code = None  # what a shell gets to run
        for number, word in enumerate(words):
            program = Path(word).name
            if _PYTHON.fullmatch(program):
                self._look_at_python(words[number + 1:])
            options = itertools.takewhile(lambda left: left.startswith("-"), words[number + 1:])
            if program == "env" and any(map(_DROPS_ENVIRONMENT.fullmatch, options)):
                self._unknown.append(f"with {word}, Python may not get the study's environment, and {_COMPILED}")
            if _SHELL.fullmatch(program) and (code := _code_of_shell(words[number + 1:])) is not None:
                self._look_at_shell(code)
            if word is code:
                continue
            for piece in dict.fromkeys([word, *_BETWEEN.split(word)]):
                self._look_at_piece(piece, _ASSIGNS.match(word) is not None)

    def _look_at_piece(self, piece: str, is_assigned: bool) -> None:
        if not piece or "{" in piece:
            return
        if piece == "PYTHONPYCACHEPREFIX":
            self._unknown.append(f"it changes {piece}, and {_COMPILED}")
        if piece in _GOES_ELSEWHERE:
            self._unknown.append(f"it goes to another folder by {piece}, where its names may mean other files")
        file = self._find(piece)
        if file is None and "/" not in piece and (found := shutil.which(piece)):
            file = Path(found)
        if file is not None and not file.is_dir():
            self._take(piece, file)
        elif file is not None and is_assigned and not _is_of_system(file):
            self._unknown.append(f"{piece} is a folder, and any file there may be code")
        elif file is None and piece.startswith(("./", "../")) and not _BETWEEN.search(piece):
            self._unknown.append(f"there is no file {piece} yet")

    def _look_at_python(self, words: Sequence[str]) -> None:
        left = iter(words)
        for word in left:
            if word in ("-X", "-W"):
                next(left, None)
            elif word.startswith(("-m", "-c")):
                rest = word[2:] or next(left, "")
                self._take_modules(word, None, Path(), f"import {rest}" if word.startswith("-m") else rest)
                places = (f"{rest.replace('.', '/')}.py", rest.replace(".", "/"))
                if (word.startswith("-m") and rest.partition(".")[0] not in sys.stdlib_module_names and
                        all(self._find(place) is None for place in places)):
                    self._unknown.append(f"the module {rest} does not lie in the current folder")
                return
            elif _IGNORES_ENVIRONMENT.fullmatch(word):
                self._unknown.append(f"with {word}, {_COMPILED}")
            elif not word.startswith("-"):
                if (script := self._find(word)) is not None and script.is_dir():
                    self._take_modules(word, script / "__main__.py", script)
                return

    def _look_at_shell(self, code: str) -> None:
        if re.search(r"[$~*?`\[]", code):
            self._unknown.append("its shell makes words that the command does not hold")
        read = _WRITES.sub(" ", code)
        try:
            self._look_at(shlex.split(read))
        except ValueError:
            self._unknown.append("its shell gets a quote that stays open")
        for simple in re.split(r"[;&|()\n]+", read):
            self._look_at(simple.split())

    def _find(self, name: str) -> Path | None:
        try:
            return next((folder / name for folder in self._folders if (folder / name).exists()), None)
        except (OSError, ValueError):  # a word that is no name of a file
            return None

    def _take(self, name: str, file: Path) -> None:
        if name in self._files or _is_of_system(file) or not file.is_file():
            return
        self._files[name] = file
        interpreter = _interpreter_of(file)
        is_python = any("python" in word for word in interpreter)
        if is_python and len(interpreter) > (2 if Path(interpreter[0]).name == "env" else 1):
            self._unknown.append(f"the first line of {name} gives options, with which {_COMPILED}")
        if file.suffix == ".py" or is_python:
            real = file.resolve()
            self._take_modules(name, real, real.parent)

    def _take_modules(self, name: str, script: Path | None, folder: Path, code: str = "") -> None:
        if script is not None and not script.is_file():
            return
        for file in modules_of_script(script, folder, code.encode()):
            self._files.setdefault(f"{name}: {file.relative_to(folder)}", file)


def _code_of_shell(words: Sequence[str]) -> str | None:
    """Returns the code that `sh -c` gets to run; None where there is no -c."""
    for word, code in zip(words, words[1:]):
        if not word.startswith("-"):
            break
        if not word.startswith("--") and "c" in word:
            return code
    return None


def _fields(word: str) -> list[str]:
    try:
        return [name for _, name, _, _ in string.Formatter().parse(word) if name]
    except ValueError:  # the check of the study says it
        return []


def _values(parameter: Parameter) -> Sequence[object]:
    distribution = parameter.distribution
    if distribution.kind == "choice":
        return distribution.choices
    return range(int(distribution.numbers[0]), int(distribution.numbers[1]) + 1)


def _fill(word: str, values: Mapping[str, object]) -> str:
    """Returns a word with some of its fields filled in."""
    text = ""
    for before, name, form, _ in string.Formatter().parse(word) if _fields(word) else ():
        text += before
        if name is not None:
            try:
                text += format(str(values[name]), form or "") if name in values else f"{{{name}}}"
            except ValueError:  # a form that no text has, which the check of the study says
                return word
    return text or word


def _is_of_system(file: Path) -> bool:
    real = str(file.resolve())
    return real.startswith(_SYSTEM) and not real.startswith("/usr/local/")


def _interpreter_of(file: Path) -> list[str]:
    """Returns the words by which the first line of a script names its interpreter; none where it names none."""
    with open(file, "rb") as opened:
        first = opened.readline(200)
    return first[2:].decode(errors="replace").split() if first.startswith(b"#!") else []
