"""The part of `pyroclast doctor` that is about Python: its packages, and what those that are missing are for."""

from __future__ import annotations

import importlib
import sys
from contextlib import suppress
from pathlib import Path

from .programs import load_libraries
from .writing import shell_path

_NEEDED = {"numpy": "figures", "h5py": "figures", "matplotlib": "figures", "scipy": "studies", "cmaes": "calibration",
           "jinja2": "pages of runs",
           "openturns": "Sobol' indices, polynomial chaos", "emcee": "posteriors", "pandas": "tables as DataFrames",
           "xarray": "fields as xarray", "meshio": "meshes from and to other programs", "PIL": "labelled images"}


def main() -> None:
    """Prints a line for each."""
    with suppress(Exception):  # what is missing is told below
        load_libraries(is_alone=True)
    _tell("Python", f"{sys.version.split()[0]}, {sys.executable}")
    for name, purpose in _NEEDED.items():
        try:
            module = importlib.import_module(name)
        except Exception as error:  # a package that is broken is told, too
            reason = "" if isinstance(error, ModuleNotFoundError) and error.name == name else f" ({error})"
            _tell(f"  {name}", f"missing{reason}: for {purpose}")
        else:
            _tell(f"  {name}", str(getattr(module, "__version__", "there")))
    try:
        from . import _core

        _tell("  compiled part", f"{_core.version}, {_core.commit}")
        package = shell_path(Path(_core.__file__).parents[1])
        _tell("  for scripts", f"import pyroclast, after export PYTHONPATH={package}")
    except ImportError:
        _tell("  compiled part", "missing: for studies and runs in Python")


def _tell(what: str, found: str) -> None:
    print(f"{what:<16}{found}")


if __name__ == "__main__":
    main()
