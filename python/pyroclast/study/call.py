"""Calls a function for a study: `python3 -m pyroclast.study.call FILE.py:NAME VALUES SEED FILE`, or many times:
`python3 -m pyroclast.study.call FILE.py:NAME`. That says "ready" once it has loaded the function, reads [values, seed]
as JSON, a line each, and answers each with a line: the outputs by name, or a text that says what went wrong.
"""

from __future__ import annotations

import importlib.util
import json
import math
import os
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import Error
from ..writing import write_text


def function_at(place: str) -> Callable[..., Any]:
    """Of FILE.py:NAME. Raises Error where there is none."""
    path, _, name = place.rpartition(":")
    spec = importlib.util.spec_from_file_location("pyroclast_study_model", path)
    if spec is None or spec.loader is None or not Path(path).exists():
        raise Error(f"{path}: is no Python file")
    module = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(Path(path).resolve().parent))
    spec.loader.exec_module(module)
    function: Callable[..., Any] | None = getattr(module, name, None)
    if not callable(function):
        raise Error(f"{path}: has no function {name}")
    return function


def answer(function: Callable[..., Any], values: Mapping[str, Any], seed: int) -> dict[str, float]:
    """Outputs by name. Raises Error where the function gives something else."""
    outputs = function(**values, seed=seed)
    if not isinstance(outputs, Mapping):
        raise Error(f"the function returned {type(outputs).__name__}, not a dict of outputs by name")
    return {str(name): float(value) for name, value in outputs.items()}


def _finite(outputs: dict[str, float]) -> dict[str, float | None]:
    return {name: value if math.isfinite(value) else None for name, value in outputs.items()}


def main(words: list[str]) -> int:
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what the function prints
    function = function_at(words[0])
    if len(words) > 1:
        outputs = answer(function, json.loads(words[1]), int(words[2]))
        write_text(Path(words[3]), json.dumps({"outcome": "completed", **_finite(outputs)}))
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
