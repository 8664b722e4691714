"""Runs of pyroclast in this process, and the results and figures of the folders that it writes.

    import pyroclast
    run = pyroclast.Run("compression.toml", seed=2)
    for state in run:
        print(state.strain, state.stress)

docs/do/python.md tells how to script it. Results and figures need no more than a folder, and not the compiled part of
the package:

    python3 -m pyroclast.figures run RUN_DIR
    python3 -m pyroclast.figures specimen DIR
    python3 -m pyroclast.figures compare RUN_DIR... --out FILE
    python3 -m pyroclast.figures levels RUN_DIR... --out FILE
    python3 -m pyroclast.watch RUN_DIR

In a script:

    results = pyroclast.read("runs/compression")
    print(results.outcome, results.history["stress_MPa"].max())
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import parallel as parallel
    from . import units as units
    from ._core import Body as Body
    from ._core import commit as commit
    from ._core import instruction_sets as instruction_sets
    from ._core import version as version
    from .decks import Deck as Deck
    from .errors import DeckError as DeckError
    from .errors import Diagnostic as Diagnostic
    from .errors import Error as Error
    from .functions import Function as Function
    from .laws import Law as Law
    from .results import Results as Results
    from .results import SpecimenFolder as SpecimenFolder
    from .results import read as read
    from .session import Fields as Fields
    from .session import History as History
    from .session import Observer as Observer
    from .session import Run as Run
    from .session import Sets as Sets
    from .session import State as State
    from .session import Views as Views
    from .specimen import SolidSpecimen as SolidSpecimen
    from .specimen import Specimen as Specimen
    from .stages import Key as Key
    from .stages import Stage as Stage
    from .stages import Verdict as Verdict
    from .study.study import Study as Study
    from .units import GPa as GPa
    from .units import K as K
    from .units import MPa as MPa
    from .units import N as N
    from .units import Pa as Pa
    from .units import Quantity as Quantity
    from .units import degC as degC
    from .units import hour as hour
    from .units import kN as kN
    from .units import m as m
    from .units import minute as minute
    from .units import mm as mm
    from .units import s as s
else:
    # Imported when first asked for: figures must not need the compiled part.
    _PLACES = {
        "_core": ("Body", "commit", "instruction_sets", "version"),
        "decks": ("Deck",),
        "errors": ("DeckError", "Diagnostic", "Error"),
        "functions": ("Function",),
        "laws": ("Law",),
        "results": ("Results", "SpecimenFolder", "read"),
        "session": ("Fields", "History", "Observer", "Run", "Sets", "State", "Views"),
        "specimen": ("SolidSpecimen", "Specimen"),
        "stages": ("Key", "Stage", "Verdict"),
        "study.study": ("Study",),
        "units": ("GPa", "K", "MPa", "N", "Pa", "Quantity", "degC", "hour", "kN", "m", "minute", "mm", "s"),
    }

    def __getattr__(name):
        import importlib

        if name in ("parallel", "units"):
            return importlib.import_module(f".{name}", __name__)
        for module, names in _PLACES.items():
            if name in names:
                return getattr(importlib.import_module(f".{module}", __name__), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__():
        return sorted([*globals(), "parallel", *(name for names in _PLACES.values() for name in names)])
