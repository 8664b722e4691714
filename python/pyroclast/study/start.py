"""How a study starts Python."""

from __future__ import annotations

import atexit
import functools
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

from ..errors import Error

_OF_MPIRUN = {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
              "OMPI_MCA_mpi_yield_when_idle": "0", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
              "PRTE_MCA_hwloc_default_binding_policy": "none"}
"""Settings of Open MPI 4 and 5: the study counts the cores, and each mpirun would tie its ranks to the same ones."""

FOLDER = "\0"
"""The place in a word of a command where the folder of the run is put in: a character that no word can hold."""


def python(module: str, *words: str) -> list[str]:
    """Returns the command line of a module of this package; nothing of the current folder stands on its path."""
    return [sys.executable, "-P", "-m", module, *words]


@functools.cache
def _empty_folder() -> str:
    """Makes a folder of this process alone."""
    folder = tempfile.mkdtemp(prefix="pyroclast-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def environment(files: Iterable[str]) -> dict[str, str]:
    """Returns the environment of a run that runs `files`. Where one of them is a .py file, Python then takes no
    compiled module from a `__pycache__`, unless its options or the command ignore the environment.
    """
    is_python = any(file.endswith(".py") for file in files)
    return {**_OF_MPIRUN, **os.environ, **({"PYTHONPYCACHEPREFIX": _empty_folder()} if is_python else {})}


def on_ranks(ranks: int, words: list[str]) -> list[str]:
    """Returns the command line by which several processes make a run: by srun within a job of Slurm, else by mpirun."""
    if ranks == 1:
        return words
    launcher = ["srun", "--mpi=pmix", "--exact"] if "SLURM_JOB_ID" in os.environ else ["mpirun"]
    return [*launcher, "-n", str(ranks), *words, "--mpi"]


def require_mpi(program: str) -> None:
    """Raises Error where a program was built without MPI."""
    found = Path(shutil.which(program) or program).resolve()
    if not (found.parents[1] / "lib/pyroclast/pyroclast_mpi.so").exists():
        raise Error(f"{found} was built without MPI: configure it with -DPYROCLAST_MPI=ON, or leave ranks out")
