"""Several runs at once, each in a process of its own."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")


def map_runs(function: Callable[[T], R], items: Iterable[T], processes: int | None = None) -> list[R]:
    """Returns what the function makes of each item, in their order; every call in a process that is started by spawn.

    function: of a module, so that another process finds it; it makes the runs, best with `threads=1`, and returns what
        can be pickled. A script guards its own calls by `if __name__ == "__main__":`.
    processes: at once; None: as many as processors are free for this process.

    The first error of a call is raised here.
    """
    work = list(items)
    most = processes or len(os.sched_getaffinity(0))
    with ProcessPoolExecutor(max(1, min(most, len(work))), multiprocessing.get_context("spawn")) as pool:
        return list(pool.map(function, work))
