"""Two functions whose sensitivities are known, as commands and as functions of a study.

    functions.py ishigami SEED FOLDER X1 X2 X3
    functions.py morris SEED FOLDER X1 ... X20

leaves FOLDER/summary.json with "y". Without NumPy, for a command of a study starts a process for each point.
"""

import functools
import itertools
import json
import math
import pathlib
import sys
from collections.abc import Iterator

A, B = 7.0, 0.1
CURVED = (3, 5, 7)  # inputs of Morris' function, from 1


def ishigami(x: list[float]) -> float:
    """Of three inputs in -pi to pi. Ishigami, Homma, First Int. Symp. Uncertainty Modelling and Analysis, 1990."""
    return math.sin(x[0]) + A * math.sin(x[1]) ** 2 + B * x[2] ** 4 * math.sin(x[0])


@functools.cache
def coefficients() -> dict[tuple[int, ...], float]:
    """Of Morris' function, by the inputs, from 1, whose weights they multiply.

    Morris draws those of the first and second order that he does not state from a normal distribution; here they are
    1 and -1 in turn.
    """
    def of(inputs: tuple[int, ...]) -> float:
        stated = [(10, 20.0), (6, -15.0), (5, -10.0), (4, 5.0)][len(inputs) - 1]
        if inputs[-1] <= stated[0]:
            return stated[1]
        return (-1.0) ** sum(inputs) if len(inputs) < 3 else 0.0

    def sets() -> Iterator[tuple[int, ...]]:
        for order in range(1, 5):
            yield from itertools.combinations(range(1, 21), order)

    return {inputs: value for inputs in sets() if (value := of(inputs)) != 0.0}


def weight(i: int, x: float) -> float:
    """Of an input in 0 to 1; of an array too."""
    return 2.0 * (1.1 * x / (x + 0.1) - 0.5) if i in CURVED else 2.0 * (x - 0.5)


def morris(x: list[float]) -> float:
    """Of twenty inputs in 0 to 1. Morris, Technometrics 33, 1991, Section 4."""
    w = [weight(i, value) for i, value in enumerate(x, start=1)]
    return sum(value * math.prod(w[i - 1] for i in inputs) for inputs, value in coefficients().items())


def ishigami_of_study(seed: int, **inputs: float) -> dict[str, float]:
    return {"y": ishigami(list(inputs.values()))}


def morris_of_study(seed: int, **inputs: float) -> dict[str, float]:
    return {"y": morris(list(inputs.values()))}


if __name__ == "__main__":
    name, _, folder, *values = sys.argv[1:]
    y = {"ishigami": ishigami, "morris": morris}[name]([float(value) for value in values])
    summary = {"outcome": "completed", "y": y, "stages": []}
    (pathlib.Path(folder) / "summary.json").write_text(json.dumps(summary))
