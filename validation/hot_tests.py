"""Tests of concrete whose paste creeps, as validation/calibrate_paste and validation/hot_concrete need them.

Specimens are heated under load (cases/anderberg_thelandersson.toml), or heated then crushed (cases/hot_strength.toml); in
space likewise (validation/hot_solids). Each is loaded to a share of its own strength at 20 degC, which the second case
finds without heating; in space that is also the f_c over which its paste creeps.
"""

import dataclasses
import math
import pathlib
import re
import sys
import threading

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "validation")]

import runs  # noqa: E402
from studied_bodies import CONTACTS_OF_TWO_DAMAGES, of_two_damages  # noqa: E402
from pyroclast.stored.heated import Heated  # noqa: E402
from pyroclast.stored.reference import strain_band  # noqa: E402
from pyroclast.stored.results import Results  # noqa: E402

RUNS = ROOT / "runs/hot_concrete"
HEATED = ROOT / "cases/anderberg_thelandersson.toml"
CRUSHED = ROOT / "cases/hot_strength.toml"
SOLIDS = {HEATED: ROOT / "cases/transient_heating_3d.toml", CRUSHED: ROOT / "cases/hot_strength_3d.toml"}
HEIGHT = 0.3  # m, of the plane's specimens, 1 m thick
SEEDS = (1, 2, 3)
LEVELS = (0.0, 0.225, 0.445, 0.675)
TEMPERATURES = (100, 200, 300, 400, 500, 600, 700, 800)
COLUMNS = ("deck", "physics_version", "test", "concrete", "blocks", "seed", "level", "to_degC", "E_GPa", "f_c_MPa",
           "strain_at_peak", "quasi_static", *(f"strain_{t}_1e-3" for t in TEMPERATURES), "critical_degC",
           "largest_thrust_MPa", "thrust_at_degC", "lateral_400_1e-3", "cracks_400_m", "along_400",
           "across_400", "interface_400", "not_converged", "energy_error_percent", "steps")


def remembering(cracks: float, full_at: int = 400, closing: float | None = None,
                law: str = "remembers") -> tuple[str, ...]:
    """Contacts that remember their load: A without load from full_at (degC) on, none to 100 degC, a line between."""
    table = f'[["20 degC", 0], ["100 degC", 0], ["{full_at} degC", {cracks:g}], ["800 degC", {cracks:g}]]'
    own = (f"contacts.mortar_mortar.law={law}", f"contacts.mortar_mortar.cracks={{table={table}}}")
    return own + (() if closing is None else (f"contacts.mortar_mortar.p_close={closing:g} MPa",))


FITTED_A = 0.41  # fitted in the plane: validation/hot_concrete memory_fit
TWO_DAMAGES = "two damages"  # name of the concrete of solids whose contacts have the paper's law, recalibrated
REMEMBERS = {"concrete": "remembers", "changes": remembering(FITTED_A)}
REMEMBERS_IN_SPACE = {"concrete": "remembers", "changes": remembering(FITTED_A, law="remembers_mixed_mode")}


@dataclasses.dataclass(frozen=True)
class Specimen:
    """A specimen and its concrete."""

    seed: int
    blocks: int
    changes: tuple[str, ...] = ()  # of both decks, of what only heat brings out
    concrete: str = "as it stands"  # name of the changes
    body: tuple[str, ...] = ()  # changes that matter at 20 degC too
    in_space: bool = False

    @property
    def name(self) -> str:
        return f"{'solid-' if self.in_space else ''}{self.concrete.replace(' ', '-')}-{self.blocks}-{self.seed}"

    def deck(self, plane: pathlib.Path) -> pathlib.Path:
        """The deck for this specimen in the place of one of the plane."""
        if self.concrete == TWO_DAMAGES:
            return with_two_damages(SOLIDS[plane])
        return SOLIDS[plane] if self.in_space else plane

    def of_strength(self, level: float) -> list[str]:
        """What goes with the specimen's own strength where paste creeps."""
        if level == 0.0 and not self.in_space:
            return []
        own = f"{strength(self):.6g} MPa"
        return [f"stages[1].f_c={own}"] + ([f"materials.mortar.creep.f_c={own}"] if self.in_space else [])

    def settings(self, most_cycles: int) -> list[str]:
        """Time step and cycles go with the block size of the plane, as in validation/block_size; in space they are the
        deck's."""
        if self.in_space:
            return [f"blocks.count={self.blocks}", "output.fields=false", *self.body, *self.changes]
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
    changes += specimen.of_strength(level)
    kind = "heated" if platen == "force" else "restrained"
    deck = specimen.deck(HEATED) if platen == "force" else _without_reference(HEATED)
    return _run(deck, f"{kind}-{level:g}-{to:g}-{specimen.name}", specimen, changes)


def _without_reference(deck: pathlib.Path) -> pathlib.Path:
    """The deck without the reference of strains, which no figure of a restrained test draws."""
    text, found = re.subn(r"\[\[output\.references\]\].*?\n(?=\[|\Z)", "", deck.read_text(), flags=re.DOTALL)
    if not found:
        raise ValueError(f"{deck} names no reference any more")
    return _changed_deck(f"{deck.stem}_restrained", text)


def _changed_deck(name: str, text: str) -> pathlib.Path:
    """The file of a deck that is a case with changes that --set cannot make."""
    made = RUNS / f"{name}.toml"
    RUNS.mkdir(parents=True, exist_ok=True)
    made.write_text(text)
    return made


def with_two_damages(deck: pathlib.Path) -> pathlib.Path:
    """A hot solid with the paper's law, recalibrated, whose strengths and energies fade as those of its own contacts do."""
    text = deck.read_text().replace('"34.6 MPa"', '"35.2 MPa"')  # f_c of the body of seed 1, by its contacts
    fades = re.search(r"^temperature_ratio = .*$", text, re.MULTILINE)
    hot, count = re.subn(r'^(G_f[12]) = ("[^"]*")', r'\1 = { value = \2, times = "glasgow_fracture_energy" }',
                         CONTACTS_OF_TWO_DAMAGES, flags=re.MULTILINE)
    if fades is None or count != 2:
        raise ValueError(f"{deck} does not state its contacts as it did")
    return _changed_deck(f"{deck.stem}_two_damages", of_two_damages(text, hot + fades[0] + "\n\n"))


def _rim_heated() -> pathlib.Path:
    """The solid of the levels, heated by conduction from its rim at 2 K/min, with the heat properties of the slab strip."""
    text = _without_reference(SOLIDS[HEATED]).read_text()
    conducts = ('conductivity = { builtin = "en1992_conductivity_lower" }\n'
                'specific_heat = { builtin = "en1992_specific_heat_u1_5" }\n')
    fire = ('field = "conduction"\n\n[[heat.boundaries]]\nfaces = "rim"\nkind = "temperature"\n'
            'temperature = { table = [["0 s", "20 degC"], ["23400 s", "800 degC"]] }\n')  # to 800 degC at 2 K/min
    for was, now in ((r"(\[materials\.(?:aggregate|mortar)\]\n)", rf"\1{conducts}"),
                     (r'field = "uniform".*\n', fire),
                     (r'kind = "heat"\nto = .*\nrate = .*\n', 'kind = "expose"\nduration = "23400 s"\n')):
        text, found = re.subn(was, now, text)
        if not found:
            raise ValueError(f"{SOLIDS[HEATED]} has no {was} any more")
    return _changed_deck("transient_heating_3d_rim", text)


def _crosswise() -> pathlib.Path:
    """The deck of crushing with the load taken away after the heat, and the specimen pushed together by its sides."""
    text = CRUSHED.read_text()
    last = text.rindex("[[stages]]", 0, text.index('kind = "compress"'))
    after = text.index("[coupling]")
    return _changed_deck("hot_strength_crosswise", text[:last] + """[[stages]]
kind = "load"
stress = "0 MPa"
ramp_time = "200 ms"
unbalanced_ratio = 1e-3
most_steps = 100000

[[stages]]
kind = "drive"
duration = "2.4 s"
look_interval = "2 ms"

[[stages.until]]
record = "push"
share_of_peak = 0.95

[[stages.drives]]
set = "left"
hold = ["x"]

[[stages.drives]]
set = "right"
velocity = "-1 mm/s"
direction = "x"
ramp_time = "20 ms"

[[record]]
name = "push"
kind = "force"
set = "right"
direction = "-x"

""" + text[after:])


def crushed_across(specimen: Specimen, temperature: float, level: float) -> Results:
    """Heated under a share of its strength along y, then crushed along x."""
    changes = specimen.settings(9000) + [f"stages[1].level={level:g}", f"stages[2].to={temperature:g} degC",
                                         f"stages[3].to={temperature:g} degC", *specimen.of_strength(level)]
    return _run(_crosswise(), f"across-{level:g}-{temperature:g}-{specimen.name}", specimen, changes)


def _strength_in(run: Results, name: str, why_none: str | None) -> float:
    """A result of the last stage. Raises ValueError that says why where it has none: no strength is not one of 0."""
    value = run.summary["stages"][-1]["results"][name]
    if value is None:
        raise ValueError(f"{run.folder}: no {name}: {why_none}")
    return value


def rim_heated(specimen: Specimen, level: float) -> Results:
    """A solid heated from its rim under a share of its strength, which is held."""
    changes = specimen.settings(3000) + [f"stages[1].level={level:g}", *specimen.of_strength(level)]
    return _run(_rim_heated(), f"rim-{level:g}-{specimen.name}", specimen, changes)


def crushed(specimen: Specimen, temperature: float, level: float = 0.0, residual: bool = False) -> Crushed:
    """Crushed at a temperature, or at 20 degC after it, heated under a share of its strength."""
    at = 20.0 if residual else temperature
    changes = specimen.settings(9000) + [f"stages[1].level={level:g}", f"stages[2].to={temperature:g} degC",
                                         f"stages[3].to={at:g} degC"]
    if temperature > 20.0:
        changes += specimen.of_strength(level)
        if specimen.in_space:
            changes.append("stages[4].stop_fraction_of_peak=0.8")  # softened bodies fall slowly: minutes, and no new peak
    if residual and temperature > 500.0:
        changes.append("stages[4].stop_strain=0.03")  # the peak comes at strains up to 0.0162
    kind = "residual" if residual else "hot"
    run = _run(specimen.deck(CRUSHED), f"{kind}-{level:g}-{temperature:g}-{specimen.name}", specimen, changes)
    stages = run.summary["stages"]
    failed = next((s["results"].get("critical_temperature_degC") for s in stages
                   if s["results"].get("critical_temperature_degC") is not None), None)
    if stages[-1]["kind"] != "compress":
        return Crushed(0.0, None, None, failed, None, run)
    found = stages[-1]["results"]
    return Crushed(_strength_in(run, "f_c_MPa", found.get("f_c_none_because")), found["E_GPa"], found["strain_at_peak"], failed, found["quasi_static"], run)


def cold(specimen: Specimen) -> Crushed:
    """Crushed at 20 degC. What only heat brings out does not matter, so all concretes of the cases' body share the test;
    those of another body are tested under their own names."""
    if specimen.body or specimen.concrete == TWO_DAMAGES:
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


@dataclasses.dataclass(frozen=True)
class Test:
    """A run, and how its line of the table is known."""

    kind: str  # heated, rim, restrained, cold, hot, residual, across
    specimen: Specimen
    level: float = 0.0
    to: float = 800.0

    @property
    def key(self) -> dict[str, str]:
        deck = self.specimen.deck(HEATED if self.kind in ("heated", "rim", "restrained") else CRUSHED)
        own = {"deck": runs.deck_hash(deck), "physics_version": runs.physics_version(),
               "test": self.kind, "concrete": self.specimen.concrete, "blocks": self.specimen.blocks,
               "seed": self.specimen.seed, "level": f"{self.level:g}", "to_degC": f"{self.to:g}"}
        return {name: str(value) for name, value in own.items()}

    def row(self) -> dict[str, str]:
        """Runs the test; its line of the table."""
        row = self.key
        if self.kind == "rim":
            run = rim_heated(self.specimen, self.level)
            row.update(_of_heating(run, self.specimen.in_space))
        elif self.kind == "across":
            run = crushed_across(self.specimen, self.to, self.level)
            push = _strength_in(run, "peak_push_N", "the stage ended before a peak of the push")
            row.update(f_c_MPa=push / HEIGHT / 1e6)
        elif self.kind in ("heated", "restrained"):
            run = heated(self.specimen, self.level, self.to, "fixed" if self.kind == "restrained" else "force")
            row.update(_of_heating(run, self.specimen.in_space))
        else:
            temperature = 20.0 if self.kind == "cold" else self.to
            found = crushed(self.specimen, temperature, self.level, self.kind == "residual")
            run = found.run
            row.update(E_GPa=found.E, f_c_MPa=found.f_c, strain_at_peak=found.strain_at_peak,
                       quasi_static=found.quasi_static, critical_degC=found.failed_at)
        summary = run.summary
        row.update(not_converged=sum(s["results"].get("exchanges_not_converged", 0) for s in summary["stages"]),
                   energy_error_percent=100.0 * summary["energy_J"]["error_over_turnover"], steps=summary["steps"])
        return runs.rounded(row)


def _of_heating(run: Results, in_space: bool) -> dict:
    hot = Heated(run)
    strains = hot.standing_strain(TEMPERATURES)
    row = {f"strain_{t}_1e-3": 1e3 * e for t, e in zip(TEMPERATURES, strains.tolist()) if not math.isnan(e)}
    history, standing = run.history, hot.standing
    temperature, stress = history["temperature_degC"][standing], history["stress_MPa"][standing]
    row["critical_degC"] = hot.results["critical_temperature_degC"]
    if hot.restrained:
        largest = int(np.argmax(stress))
        row.update(largest_thrust_MPa=float(stress[largest]), thrust_at_degC=float(temperature[largest]))
    if temperature.max() >= 400.0:
        row["lateral_400_1e-3"] = 1e3 * float(np.interp(400.0, temperature, history["lateral_strain"][standing]))
        if not in_space:
            row.update(_cracks_at(run, 400.0))
    return row


def _cracks_at(run: Results, temperature: float) -> dict:
    """Length of contacts times their damage in tension, and shares of it: lines within 30 degrees of the load's direction,
    within 30 degrees across it, and at aggregates."""
    frame = next(f for f in Heated(run).frames if abs(f.temperature - temperature) < 1e-6)
    contacts = run.mesh.contacts
    cracked = run.contact_field(frame, "tension_damage [1]") * contacts.extent
    parts = {"along_400": contacts.angle <= 30.0, "across_400": contacts.angle >= 60.0,
             "interface_400": contacts.interface == contacts.interfaces.index("aggregate_mortar")}
    total = float(cracked.sum())
    return {"cracks_400_m": total, **{name: float(cracked[part].sum()) / total for name, part in parts.items()}}


def levels(blocks: int, in_space: bool = False) -> list[Test]:
    return [Test("heated", Specimen(seed, blocks, in_space=in_space), level) for level in LEVELS for seed in SEEDS]


def strengths(blocks: int, temperatures: tuple[int, ...], in_space: bool = False) -> list[Test]:
    specimens = [Specimen(seed, blocks, in_space=in_space) for seed in SEEDS]
    tests = [Test("cold", specimen, to=20.0) for specimen in specimens]
    for kind, level in (("hot", 0.0), ("hot", 0.4), ("residual", 0.0)):
        tests += [Test(kind, specimen, level, to) for to in temperatures for specimen in specimens]
    return tests


def fill(table: pathlib.Path, tests: list[Test], jobs: int) -> None:
    """Runs the tests that do not stand in a table, and puts their lines there."""
    wanted = [test.row for test in dict.fromkeys(tests) if not runs.stands(runs.read_table(table), test.key)]
    runs.fill_table(table, COLUMNS, wanted, jobs, ("test", "concrete", "blocks", "seed", "level", "to_degC"))


def glasgow(level: float, temperature):
    """Total strain of the Glasgow model (Pearce, Nielsen and Bicanic), f_c = 35 MPa and E = 21.5 GPa at 20 degC."""
    theta = (np.asarray(temperature, dtype=float) - 20.0) / 100.0
    creep = np.where(theta <= 4.5, 0.0005 * theta**2 + 0.00125 * theta, 0.0)
    beyond = theta - 4.5
    creep = np.where(theta > 4.5, 0.0005 * 4.5**2 + 0.00125 * 4.5 + 0.00575 * beyond + 0.0085 * beyond**2, creep)
    return free_strain(temperature) - level * creep - level * 35.0 / (21500.0 * (1.0 - 0.1 * theta) ** 2)


def of(rows: list[dict[str, str]], name: str, **conditions) -> np.ndarray:
    """A column of the lines that meet the conditions, those that have it."""
    return np.array([float(r[name]) for r in rows
                     if r[name] and all(r[key] == str(value) for key, value in conditions.items())])


def mean_and_range(values: np.ndarray, digits: int = 2) -> str:
    if not len(values):
        return "–"
    if len(values) == 1:
        return f"{values[0]:.{digits}f}"
    return f"{values.mean():.{digits}f} ({values.min():.{digits}f} … {values.max():.{digits}f})"


def print_table(head: list[str], lines: list[list[str]]) -> None:
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for line in lines:
        print("| " + " | ".join(map(str, line)) + " |")
    print()


def print_levels(rows: list[dict[str, str]], common: dict) -> dict[float, dict[int, float]]:
    """Prints strains beside the bands of tests; the means by level and temperature, 1e-3."""
    shown = [t for t in TEMPERATURES if t <= 600]
    lines, mean = [], {}
    print("Total strain in 1e-3, mean (least … most of three seeds)\n")
    for level in LEVELS:
        found = {t: of(rows, f"strain_{t}_1e-3", test="heated", level=f"{level:g}", **common) for t in shown}
        mean[level] = {t: values.mean() for t, values in found.items() if len(values)}
        band = strain_band(level)
        there = [t for t in shown if t <= band.temperature[-1]]
        low, central, high = (dict(zip(there, 1e3 * part)) for part in band.at(there))
        lines.append([f"{level:g}"] + [mean_and_range(found[t]) for t in shown])
        lines.append(["band"] + [f"{low[t]:.2f} … {high[t]:.2f}" if t in low else "–" for t in shown])
        lines.append(["centre"] + [f"{central[t]:.2f}" if t in low else "–" for t in shown])
        if level > 0.0:
            g = {t: 1e3 * float(glasgow(level, t)) for t in shown}
            at = {t: 2.0 * central[t] - g[t] for t in there if t <= 500}  # the centre is the mean of both
            lines.append(["less Anderberg and Thelandersson"]
                         + [f"{mean[level][t] - at[t]:+.2f}" if t in at and t in mean[level] else "–" for t in shown])
            lines.append(["less Glasgow"]
                         + [f"{mean[level][t] - g[t]:+.2f}" if t in mean[level] else "–" for t in shown])
    print_table(["level"] + [f"{t} °C" for t in shown], lines)
    return mean


def print_critical_temperatures(rows: list[dict[str, str]], common: dict) -> None:
    print("Critical temperatures, °C\n")
    print_table(["level", "ours"], [[f"{level:g}", mean_and_range(
        of(rows, "critical_degC", test="heated", level=f"{level:g}", **common), 0)] for level in LEVELS])


def retained(rows: list[dict[str, str]], name: str, kind: str, level: str, to: int, common: dict) -> np.ndarray:
    """Strength or modulus over that of the cold specimen, which concretes of the same contacts share, seed by seed;
    strain at the peak as it is."""
    shared = common if common.get("concrete") == TWO_DAMAGES else common | {"concrete": "as it stands"}
    hot = [of(rows, name, test=kind, level=level, to_degC=to, seed=s, **common) for s in SEEDS]
    cold = [of(rows, name, test="cold", seed=s, **shared) for s in SEEDS]
    return np.array([h[0] / (1.0 if name == "strain_at_peak" else c[0]) for h, c in zip(hot, cold) if len(h) and len(c)])


def print_strengths(rows: list[dict[str, str]], common: dict, temperatures: tuple[int, ...]) -> None:
    print("Strength and modulus over those at 20 °C of the same specimen\n")
    lines = []
    for name in ("f_c_MPa", "E_GPa", "strain_at_peak"):
        for kind, level in (("hot", "0"), ("hot", "0.4"), ("residual", "0")):
            lines.append([name, kind, level, *(mean_and_range(
                retained(rows, name, kind, level, to, common), 4 if name == "strain_at_peak" else 2) for to in temperatures)])
    print_table(["", "test", "level"] + [f"{to} °C" for to in temperatures], lines)
