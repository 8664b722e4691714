"""Tests of concrete whose paste creeps, as validation/calibrate_paste and validation/hot_concrete need them.

Specimens are heated under load (cases/anderberg_thelandersson.toml), or heated then crushed (cases/hot_strength.toml).
Each is loaded to a share of its own strength at 20 degC, which the second case finds without heating.
"""

import dataclasses
import pathlib
import re
import sys
import threading

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "validation")]

import runs  # noqa: E402
from pyroclast.stored.results import Results  # noqa: E402

RUNS = ROOT / "runs/hot_concrete"
HEATED = ROOT / "cases/anderberg_thelandersson.toml"
CRUSHED = ROOT / "cases/hot_strength.toml"


@dataclasses.dataclass(frozen=True)
class Specimen:
    """A specimen and its concrete."""

    seed: int
    blocks: int
    changes: tuple[str, ...] = ()  # of both decks, of what only heat brings out
    concrete: str = "as it stands"  # name of the changes
    body: tuple[str, ...] = ()  # changes that matter at 20 degC too

    @property
    def name(self) -> str:
        return f"{self.concrete.replace(' ', '-')}-{self.blocks}-{self.seed}"

    def settings(self, most_cycles: int) -> list[str]:
        """Time step and cycles go with the block size, as in validation/block_size."""
        ratio = runs.size_ratio(self.blocks)
        least, most = round(1000 / ratio), round(most_cycles / ratio)
        stated = {change.split("=")[0] for change in self.changes}
        own = {"blocks.count": self.blocks, "mechanics.time_step": runs.time_step(self.blocks),
               "coupling.least_cycles": least, "coupling.most_cycles": most}
        return [f"{key}={value}" for key, value in own.items() if key not in stated] + [*self.body, *self.changes]


@dataclasses.dataclass(frozen=True)
class Crushed:
    """What crushing gave; zeros where the specimen failed before."""

    f_c: float  # MPa
    E: float | None  # GPa; None where the curve has none
    strain_at_peak: float | None
    failed_at: float | None  # degC, while it was heated or cooled
    quasi_static: bool | None
    run: Results


def heated(specimen: Specimen, level: float, to: float = 800.0, platen: str = "force") -> Results:
    """Heated under a share of its strength, which is held, or with the platens fixed after it was brought up."""
    changes = specimen.settings(3000) + [f"stages[1].level={level:g}", f"stages[2].to={to:g} degC"]
    if platen != "force":
        changes.append(f"stages[2].platen={platen}")
    if level > 0.0:
        changes.append(f"stages[1].f_c={strength(specimen):.6g} MPa")
    kind = "heated" if platen == "force" else "restrained"
    deck = HEATED if platen == "force" else _without_reference(HEATED)
    return _run(deck, f"{kind}-{level:g}-{to:g}-{specimen.name}", specimen, changes)


def _without_reference(deck: pathlib.Path) -> pathlib.Path:
    """The deck without the reference of strains, which no figure of a restrained test draws."""
    text, found = re.subn(r"\[\[output\.references\]\].*?\n(?=\[|\Z)", "", deck.read_text(), flags=re.DOTALL)
    if not found:
        raise ValueError(f"{deck} names no reference any more")
    made = RUNS / f"{deck.stem}_restrained.toml"
    RUNS.mkdir(parents=True, exist_ok=True)
    made.write_text(text)
    return made


def crushed(specimen: Specimen, temperature: float, level: float = 0.0, residual: bool = False) -> Crushed:
    """Crushed at a temperature, or at 20 degC after it, heated under a share of its strength."""
    at = 20.0 if residual else temperature
    changes = specimen.settings(9000) + [f"stages[1].level={level:g}", f"stages[2].to={temperature:g} degC",
                                         f"stages[3].to={at:g} degC"]
    if level > 0.0:
        changes.append(f"stages[1].f_c={strength(specimen):.6g} MPa")
    kind = "residual" if residual else "hot"
    run = _run(CRUSHED, f"{kind}-{level:g}-{temperature:g}-{specimen.name}", specimen, changes)
    stages = run.summary["stages"]
    failed = next((s["results"].get("critical_temperature_degC") for s in stages
                   if s["results"].get("critical_temperature_degC") is not None), None)
    if stages[-1]["kind"] != "compress":
        return Crushed(0.0, None, None, failed, None, run)
    found = stages[-1]["results"]
    return Crushed(found["f_c_MPa"] or 0.0, found["E_GPa"], found["strain_at_peak"], failed, found["quasi_static"], run)


def cold(specimen: Specimen) -> Crushed:
    """Crushed at 20 degC. What only heat brings out does not matter, so all concretes of the cases' body share the test;
    those of another body are tested under their own names."""
    if specimen.body:
        return crushed(specimen, 20.0)
    return crushed(dataclasses.replace(specimen, changes=(), concrete="as it stands"), 20.0)


def strength(specimen: Specimen) -> float:
    """At 20 degC, MPa."""
    return cold(specimen).f_c


def free_strain(temperatures) -> np.ndarray:
    """glasgow_free_thermal_strain, the concrete's in both decks."""
    theta = (np.asarray(temperatures, dtype=float) - 20.0) / 100.0
    return 0.006 * np.log(7.0 / (7.0 - np.minimum(theta, 6.0)))


_locks: dict[str, threading.Lock] = {}
_lock = threading.Lock()


def _run(deck: pathlib.Path, name: str, specimen: Specimen, changes: list[str]) -> Results:
    folder = RUNS / name
    with _lock:
        own = _locks.setdefault(name, threading.Lock())
    with own:  # two tests may ask for the same strength at once
        runs.run(deck, folder, specimen.seed, changes, again=False)
    return Results(folder)
