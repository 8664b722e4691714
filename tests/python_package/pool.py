"""What the processes of a pool do."""

import pyroclast
from small import deck


def stress_at(seed: int) -> float:
    return pyroclast.Run(deck(), seed=seed, threads=1).until(strain=1e-4).stress


def wrong(_: int) -> None:
    pyroclast.Run(deck(specimen__width="1 s"))
