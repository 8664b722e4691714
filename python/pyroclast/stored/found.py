"""Contacts that were found, as a frame of a run has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from ..errors import Error
from ..libraries import library
from .files import open_hdf, within
from .frames import Frame
from .results import Results

if TYPE_CHECKING:
    import pandas

_WHOLE = ("block_a", "block_b", "face")
_NUMBERS = ("opening [m]", "tangential_jump [m]", "normal_traction [Pa]", "shear_traction [Pa]", "area [m2]")


def found_contacts(results: Results, frame: Frame) -> pandas.DataFrame:
    """Returns the contacts that are found and press in a frame, as `Run.found_contacts` does: a row for each
    contact point of a pair of facets. Raises Error where the run keeps none (docs/understand/found.md).
    """
    path = results.folder / "fields" / f"found_{frame.number:04d}.hdf"
    with open_hdf(path) as file:
        def array(name: str) -> Any:
            found = within(file, f"VTKHDF/{name}")
            if not isinstance(found, h5py.Dataset):
                raise Error(f"{path}: has no /VTKHDF/{name}")
            return found[()]

        names = [name.decode() for name in array("FieldData/interface_names")]
        columns: dict[str, Any] = {"interface": [names[i] for i in array("CellData/interface")]}
        columns |= {name: array(f"CellData/{name}") for name in _WHOLE}
        axes = "xyz"[:results.mesh.blocks.dimension]
        columns |= {f"{axis}_m": array("Points")[::2, i] for i, axis in enumerate(axes)}
        columns |= {f"normal_{axis}": array("CellData/normal [1]")[:, i] for i, axis in enumerate(axes)}
        columns |= {f"force_{axis}_N": array("CellData/force [N]")[:, i] for i, axis in enumerate(axes)}
        for name in _NUMBERS:
            columns[name[:-1].replace(" [", "_")] = array(f"CellData/{name}").astype(np.float64)
    table: pandas.DataFrame = library("pandas", "found_contacts").DataFrame(columns)
    return table
