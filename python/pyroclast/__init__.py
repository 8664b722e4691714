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
    from ._core import Body as Body
    from ._core import commit as commit
    from ._core import instruction_sets as instruction_sets
    from ._core import version as version
    from .errors import DeckError as DeckError
    from .errors import Diagnostic as Diagnostic
    from .errors import Error as Error
    from .live import stones as stones
    from .live import units as units
    from .live import volumes as volumes
    from .live.decks import Deck as Deck
    from .live.functions import Function as Function
    from .live.laws import Law as Law
    from .live.run import Fields as Fields
    from .live.run import History as History
    from .live.run import Observer as Observer
    from .live.run import Run as Run
    from .live.run import Sets as Sets
    from .live.run import State as State
    from .live.run import Views as Views
    from .live.specimen import Specimen as Specimen
    from .live.stages import Key as Key
    from .live.stages import Stage as Stage
    from .live.stages import Verdict as Verdict
    from .live.units import GPa as GPa
    from .live.units import K as K
    from .live.units import MPa as MPa
    from .live.units import N as N
    from .live.units import Pa as Pa
    from .live.units import Quantity as Quantity
    from .live.units import degC as degC
    from .live.units import hour as hour
    from .live.units import kN as kN
    from .live.units import m as m
    from .live.units import minute as minute
    from .live.units import mm as mm
    from .live.units import s as s
    from .stored.compressed import Compressed as Compressed
    from .stored.found import found_contacts as found_contacts
    from .stored.heated import Heated as Heated
    from .stored.results import Results as Results
    from .stored.results import SpecimenFolder as SpecimenFolder
    from .stored.results import read as read
    from .stored.run_facts import RunFacts as RunFacts
    from .study.study import Study as Study
else:
    # Imported when first asked for: figures must not need the compiled part.
    _MODULES = {"stones": "live.stones", "parallel": "parallel", "units": "live.units", "volumes": "live.volumes"}
    _PLACES = {
        "_core": ("Body", "commit", "instruction_sets", "version"),
        "errors": ("DeckError", "Diagnostic", "Error"),
        "stored.compressed": ("Compressed",),
        "stored.found": ("found_contacts",),
        "stored.heated": ("Heated",),
        "stored.results": ("Results", "SpecimenFolder", "read"),
        "stored.run_facts": ("RunFacts",),
        "live.decks": ("Deck",),
        "live.functions": ("Function",),
        "live.laws": ("Law",),
        "live.run": ("Fields", "History", "Observer", "Run", "Sets", "State", "Views"),
        "live.specimen": ("Specimen",),
        "live.stages": ("Key", "Stage", "Verdict"),
        "live.units": ("GPa", "K", "MPa", "N", "Pa", "Quantity", "degC", "hour", "kN", "m", "minute", "mm", "s"),
        "study.study": ("Study",),
    }

    def __getattr__(name):
        import importlib

        if name in _MODULES:
            return importlib.import_module(f".{_MODULES[name]}", __name__)
        for place, names in _PLACES.items():
            if name in names:
                module = importlib.import_module(f".{place}", __name__)
                for pictured in {"Results", "Run"}.intersection(names):
                    importlib.import_module(".display", __name__).give_pictures(getattr(module, pictured))
                return getattr(module, name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__():
        return sorted([*globals(), *_MODULES, *(name for names in _PLACES.values() for name in names)])
