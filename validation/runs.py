"""Runs of the program that a study needs, and its table: what is done is not run again, what was broken off goes on."""

import concurrent.futures
import csv
import functools
import hashlib
import json
import math
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Callable, Sequence
from typing import Any

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = os.environ.get("PYROCLAST", str(ROOT / "build/release/bin/pyroclast"))
# A study takes the Python package that was built with the program, whatever other one is installed.
sys.path.insert(1, str(pathlib.Path(PROGRAM).resolve().parent.parent / "python"))

CONTROLLED = ["velocity=0.2 mm/s", "fastest_velocity=8 mm/s", "unbalanced_ratio=1e-4", "kinetic_over_strain=5e-3",
              "platen_difference=0.01", "dissipation_rate=1 1/s"]
"""Keys of a stage `compress` whose platen's velocity is controlled, so that fine specimens take minutes."""
_AT = 5000  # blocks of the cases, for which their time step is
_TIME_STEP = 10e-6  # s


def size_ratio(blocks: int) -> float:
    """Block size over that of the cases. Steps of an exchange go with its inverse, so that they take the same time."""
    return math.sqrt(_AT / blocks)


def time_step(blocks: int) -> str:
    """That goes with the block size, so that the mass that moves is the same."""
    return f"{_TIME_STEP * size_ratio(blocks):.6g} s"


def read_table(table: pathlib.Path) -> list[dict[str, str]]:
    if not table.exists():
        return []
    with open(table, newline="") as file:
        return list(csv.DictReader(file))


def write_table(table: pathlib.Path, columns: tuple[str, ...], rows: list[dict]) -> None:
    """In the place of the one that is there, which stays whole if this is broken off."""
    aside = table.with_suffix(".new")
    with open(aside, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    aside.rename(table)


def rounded(row: dict[str, Any]) -> dict[str, Any]:
    """A row whose floats are texts of five digits."""
    return {key: f"{value:.5g}" if isinstance(value, float) else value for key, value in row.items()}


def stands(table: list[dict[str, str]], key: dict[str, str]) -> bool:
    """Whether a table has a row with these values."""
    return any(key.items() <= row.items() for row in table)


def fill_table(table: pathlib.Path, columns: tuple[str, ...], makers: Sequence[Callable[[], dict]], jobs: int,
               place: tuple[str, ...], order: Callable[[dict], Any] | None = None) -> None:
    """Makes rows, some at once. Each is written as it comes, in the place of one that is alike in the columns `place`.

    order: key by which the rows of the table are sorted; without it the latest stands last. SystemExit at the end with
    what the rows that could not be made said; the others stand in the table.
    """
    failed = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done in concurrent.futures.as_completed([pool.submit(make) for make in makers]):
            if error := done.exception():
                failed.append(str(error))
                continue
            row = done.result()
            others = [old for old in read_table(table) if any(old[name] != str(row[name]) for name in place)]
            rows = [*others, row]
            write_table(table, columns, sorted(rows, key=order) if order else rows)
            print(row, flush=True)
    if failed:
        raise SystemExit("\n".join(failed))


@functools.cache
def physics_version(program: str = PROGRAM, kinds: frozenset[str] = frozenset()) -> str:
    """Of the program, for decks of some `kinds`: results of the same deck are the same with the same version. A version
    that changed other kinds alone left them as the version before has them."""
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    return _for_kinds(int(re.search(r"physics version (\d+)", version)[1]), kinds)


def kinds(deck: pathlib.Path, changes: Sequence[str] = ()) -> frozenset[str]:
    """Kinds of a deck with changes, by the names that `only` in [[changed]] of validation/reference.toml has: "finite"
    kinematics, these with the contacts of the start ("finite, first"), contacts "found in space", and stones in space
    that blocks have "followed"."""
    tables = tomllib.loads(deck.read_text())
    stated = dict(change.split("=", 1) for change in changes)
    specimen = tables.get("specimen", {})

    def value(table: str, key: str) -> str | None:
        return stated.get(f"{table}.{key}", tables.get(table, {}).get(key))

    is_in_space = "depth" in specimen or specimen.get("shape") in ("cylinder", "polyhedra")
    is_finite, are_found = value("mechanics", "kinematics") == "finite", value("mechanics", "contacts") == "found"
    has = {"finite": is_finite,
           "finite, first": is_finite and not are_found,
           "found in space": is_in_space and are_found,
           "followed": is_in_space and value("superposition", "rule") == "follow"}
    return frozenset(kind for kind, is_one in has.items() if is_one)


def _for_kinds(version: int, kinds: frozenset[str]) -> str:
    changes = tomllib.loads((ROOT / "validation/reference.toml").read_text())["changed"]
    while (only := {change.get("only") for change in changes if change["physics_version"] == version}) \
            and None not in only and not only & kinds:
        version -= 1
    return str(version)


def _same_run(folder: pathlib.Path, command: list[str]) -> bool:
    """Whether the folder holds a run of the same command, whatever the program's path."""
    manifest = folder / "manifest.json"
    if not manifest.exists():
        return False
    begun = json.loads(manifest.read_text())["command"]
    return shlex.split(begun)[1:] == command[1:]


def _has_ended(folder: pathlib.Path) -> bool:
    """Whether a run came to its own end; one that a signal stopped has a summary too."""
    summary = folder / "summary.json"
    return summary.exists() and json.loads(summary.read_text())["outcome_id"] != "stopped"


def broken_off(folder: pathlib.Path, command: list[str]) -> bool:
    """Whether the folder holds a run of the same command that has not come to its end but has a checkpoint."""
    return _same_run(folder, command) and not _has_ended(folder) and any(folder.glob("checkpoints/*.state"))


def part_of(text: str, begin: str, end: str) -> str:
    """The part of a deck from one line's beginning to another's. ValueError where it lacks one of them."""
    return text[text.index(begin):text.index(end)]


def deck_hash(deck: pathlib.Path, changes: Sequence[str] = ()) -> str:
    """Of the keys and values of a deck, and of changes to it: comments and blanks do not count."""
    meaning = "\n".join([json.dumps(tomllib.loads(deck.read_text()), sort_keys=True), *changes])
    return hashlib.sha256(meaning.encode()).hexdigest()[:8]


def _source(folder: pathlib.Path) -> pathlib.Path:
    """File beside a run with the hash of the deck that it was made from; the run has the deck with its changes."""
    return folder.parent / f"{folder.name}.source"


def finished(folder: pathlib.Path, command: list[str], deck: pathlib.Path) -> bool:
    """Whether the folder holds the results of this command with these values of the deck and this physics version."""
    if not _same_run(folder, command) or not _has_ended(folder) or not _source(folder).exists():
        return False
    manifest = json.loads((folder / "manifest.json").read_text())
    same_deck = _source(folder).read_text() == deck_hash(deck)
    of_run = kinds(folder / "deck.toml")
    return same_deck and _for_kinds(manifest["physics_version"], of_run) == physics_version(PROGRAM, of_run)


def run(deck: pathlib.Path, folder: pathlib.Path, seed: int, changes: list[str], again: bool = True) -> None:
    """Runs the deck with the changes in one thread, or goes on where such a run was broken off.

    again: also when the folder holds its results. SystemExit with what the program said when it fails; a specimen that
    fails is a result.
    """
    command = [PROGRAM, "run", str(deck), "--seed", str(seed), "--out", str(folder), "--overwrite", "--no-figures",
               "--threads", "1"]
    for change in changes:
        command += ["--set", change]
    if not again and finished(folder, command, deck):
        return
    source = deck_hash(deck)
    done = None
    if broken_off(folder, command):  # a checkpoint of another build may not fit this one
        resume = [PROGRAM, "resume", str(folder), "--no-figures", "--threads", "1"]
        done = subprocess.run(resume, capture_output=True, text=True)
    if done is None or done.returncode not in (0, 2):
        done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 2):
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    _source(folder).write_text(source)
