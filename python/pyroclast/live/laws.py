"""Contact laws at a point."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .units import Quantity

_REFERENCE = 20.0  # degC


class Law:
    """A contact law with its properties, to be driven at one contact point.

    law: "cohesive" or another one that is part of the program, a shared object, or a header ("mine.hpp"), which is
        compiled first.
    folders: of laws that are not part of the program.
    properties: by the keys of a deck, with units (`G_n="60 N/m"` or `60 * N / m`).

    Raises Error where there is no such law, it does not compile, or a property is missing or cannot be.
    """

    def __init__(self, law: str | Path, *, folders: Sequence[str | Path] = (),
                 **properties: str | float | Quantity):
        self._law, self._folders = str(law), [str(folder) for folder in folders]
        self.name: str = _core.law_name(self._law, "", self._folders)
        self._values = [f"{key}={value}" for key, value in properties.items()]
        self.drive([0.0])

    @staticmethod
    def properties_of(law: str | Path, *, folders: Sequence[str | Path] = ()) -> dict[str, tuple[str, str]]:
        """Returns the SI unit and meaning of each property that a law has, by its key."""
        return {key: (unit, meaning) for key, unit, meaning in
                _core.law_properties(str(law), "", [str(folder) for folder in folders])}

    def drive(self, opening: ArrayLike, slip: ArrayLike = 0.0, temperature: ArrayLike = _REFERENCE,
              steps: int = 1) -> dict[str, NDArray[np.float64]]:
        """Takes a new point along a path and returns what it answers, by column, (points * steps,) each.

        opening, slip: of the path's points, m; one number stands for all points.
        temperature: likewise, degC.
        steps: into which each leg of the path is cut.

        The columns are those of `pyroclast law`, in SI: u_n_m, u_s_m, T_degC, sigma_Pa
        (tension positive), tau_Pa, stored_J_m2, what the law remembers, and what it lost.
        """
        path = np.column_stack(np.broadcast_arrays(np.atleast_1d(np.asarray(opening, float)),
                                                   np.asarray(slip, float), np.asarray(temperature, float)))
        return _core.law_along_path(self._law, "", self._folders, self._values, path, steps)

    def __repr__(self) -> str:
        return f"<Law {self.name}>"
