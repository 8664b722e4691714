"""Calls a function for a study: `python3 -m pyroclast.study.call FILE.py:NAME HASH VALUES SEED FILE`, or many times:
`python3 -m pyroclast.study.call FILE.py:NAME HASH`. That says "ready" once it has loaded the function, reads [values,
seed] as JSON, a line each, and answers each with a line: the outputs by name, or a text that says what went wrong.

HASH is that of the function's code. Other code is not run.
"""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import Error
from ..writing import write_text
from .modules import hash_of_function, imported, modules_of_function


def function_at(place: str, code: str = "") -> Callable[..., Any]:
    """Returns the function FILE.py:NAME. code: hash that it must have; "" for any.

    Raises Error where there is none, or it is other code.
    """
    path, _, name = place.rpartition(":")
    sources = modules_of_function(Path(path).resolve())
    if code and hash_of_function(sources, name) != code:
        raise Error(f"{path}, or a module that it imports, has changed since the study began; start it again")
    function: Callable[..., Any] | None = getattr(imported(sources), name, None)
    if not callable(function):
        raise Error(f"{path}: has no function {name}")
    return function


def answer(function: Callable[..., Any], values: Mapping[str, Any], seed: int) -> dict[str, float]:
    """Returns outputs by name. Raises Error where the function gives something else."""
    outputs = function(**values, seed=seed)
    if not isinstance(outputs, Mapping):
        raise Error(f"the function returned {type(outputs).__name__}, not a dict of outputs by name")
    return {str(name): float(value) for name, value in outputs.items()}


def _finite(outputs: dict[str, float]) -> dict[str, float | None]:
    return {name: value if math.isfinite(value) else None for name, value in outputs.items()}


def main(words: list[str]) -> int:
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what the function prints
    function = function_at(words[0], words[1])
    if len(words) > 2:
        outputs = answer(function, json.loads(words[2]), int(words[3]))
        write_text(Path(words[4]), json.dumps({"outcome": "completed", **_finite(outputs)}))
        return 0
    answers.write('"ready"\n')
    answers.flush()
    for line in sys.stdin:
        values, seed = json.loads(line)
        try:
            said: Any = _finite(answer(function, values, seed))
        except Exception as error:  # of the user's code: whatever it is, it is this point's
            said = f"{type(error).__name__}: {error}"
        answers.write(json.dumps(said) + "\n")
        answers.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
