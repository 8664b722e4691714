"""Libraries that only some methods need, and openturns without its global state."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ...libraries import library as library


@contextmanager
def openturns(purpose: str, seed: int = 0) -> Iterator[Any]:
    """Lends openturns with its random numbers from `seed` and without warnings; both are afterwards as before."""
    ot = library("openturns", purpose)
    state, flags = ot.RandomGenerator.GetState(), ot.Log.Flags()
    ot.RandomGenerator.SetSeed(seed)
    ot.Log.Show(ot.Log.ERROR)
    try:
        yield ot
    finally:
        ot.RandomGenerator.SetState(state)
        ot.Log.Show(flags)
