"""Writes run and specimen folders of invented numbers in the layout of the program."""

from __future__ import annotations

import csv
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

PEAK_STRAIN, PEAK_STRESS, LAST_STRAIN = 0.003, 34.0, 0.006

HISTORY_COLUMNS = (
    "stage,step,time_s,strain,stress_MPa,stress_top_MPa,stress_bottom_MPa,lateral_strain,unbalanced_ratio,"
    "kinetic_over_strain,largest_jump,tension_aggregate_mortar_damaged,tension_aggregate_mortar_broken,tension_aggregate_mortar_length_m,tension_aggregate_mortar_broken_length_m,"
    "tension_mortar_mortar_damaged,tension_mortar_mortar_broken,tension_mortar_mortar_length_m,"
    "tension_mortar_mortar_broken_length_m,shear_aggregate_mortar_damaged,shear_aggregate_mortar_broken,"
    "shear_aggregate_mortar_length_m,shear_aggregate_mortar_broken_length_m,shear_mortar_mortar_damaged,shear_mortar_mortar_broken,shear_mortar_mortar_length_m,"
    "shear_mortar_mortar_broken_length_m,mean_opening_m,energy_loading_J,"
    "energy_gravity_J,energy_property_change_J,energy_zones_J,energy_contacts_J,energy_kinetic_J,dissipated_tension_J,"
    "dissipated_shear_J,dissipated_friction_J,dissipated_compression_J,energy_local_damping_J,"
    "energy_viscous_damping_J,energy_error_J"
).split(",")
HEATED_COLUMNS = (
    HISTORY_COLUMNS[:3]
    + ["heating_time_s", "temperature_degC", "temperature_min_degC", "temperature_max_degC"]
    + ["exchange", "cycles", "converged", "strain", "specimen_strain"]
    + HISTORY_COLUMNS[4:]
)
LABELS = {"tension": "tension softening", "shear": "shear softening", "compression": "crushing",
          "zones": "stored in zones", "contacts": "stored in contacts"}
ROLES = {  # of columns, each with what it is of in brackets
    "clock": "(stage) (step) (time)_s (heating_time)_s",
    "temperature": "temperature_degC temperature_(min|max)_degC",
    "press": "(strain) (stage_strain) (specimen_strain) (stress)_MPa (stress_top|stress_bottom)_MPa (lateral_strain)",
    "rest": "(unbalanced_ratio) (kinetic_over_strain) (largest_jump)",
    "exchange": "(exchange) (cycles) (converged)",
    "energy.put_in": "energy_(loading|gravity|property_change|mass_scaling)_J",
    "energy.held": "energy_(zones|contacts|kinetic)_J",
    "energy.lost": "dissipated_(.+)_J energy_(local_damping|viscous_damping)_J",
    "energy.error": "energy_(error)_J",
    "crack.opening": "(mean)_opening_m",
    "heat.held": "heat_(stored)_J",
    "heat.put_in": "heat_(prescribed|flux|convection|radiation)_J",
    "heat.error": "heat_(error)_J",
    "heat.flow": "(rate)_K_s (gas)_max_degC",
    "probe": "probe_(.+)_degC",
}
RESULTS = (("E_GPa", "GPa", "E", 1, "GPa"), ("f_c_MPa", "MPa", "f_c", 1, "MPa"),
           ("strain_at_peak", "1", "strain at the peak", 2, "1e-3"), ("strain_ic", "1", "ε_ic", 2, "1e-3"),
           ("load_level", "1", "load level", 2, "of f_c"), ("load_stress_MPa", "MPa", "stress while heated", 1, "MPa"),
           ("critical_temperature_degC", "degC", "critical temperature", 0, "degC"),
           ("highest_temperature_degC", "degC", "highest temperature", 0, "degC"),
           ("largest_thrust_MPa", "MPa", "largest thrust", 1, "MPa"))
STRENGTH, MODULUS = 35.0, 21.5e3  # MPa
EXCHANGE, FRAME_EVERY = 5.0, 5  # K from exchange to exchange; exchanges from frame to frame


def column_facts(name: str) -> dict:
    """What run.json says of a column; of one that is not listed, that it is a record."""
    facts = {"name": name, "unit": "m", "label": "", "meaning": "", "role": "record", "of": name}
    if found := re.fullmatch(r"(tension|shear|mixed)_(.+?)_(damaged|broken|length_m|area_m2|broken_length_m|broken_area_m2)",
                             name):
        broken = "broken" if "broken" in found[3] else "damaged"
        role = f"crack.{broken}" + ("" if found[3] in ("damaged", "broken") else "_extent")
        return facts | {"role": role, "mode": found[1], "interface": found[2]}
    for role, names in ROLES.items():
        for pattern in names.split():
            if found := re.fullmatch(pattern, name):
                of = found[1] if found.groups() else name
                return facts | {"role": role, "of": of, "label": LABELS.get(of, of.replace("_", " "))}
    return facts


def write_facts(folder: Path, columns: list[str], test_stage: int | None = None) -> None:
    """Writes run.json of a plane run; its results are those of a compression and of a heating."""
    in_space = any(name.endswith("_area_m2") for name in columns)
    results = [{"name": name, "unit": unit, "label": label, "meaning": label, "of": "test", "digits": digits,
                "shown_in": shown} for name, unit, label, digits, shown in RESULTS]
    results += [{"name": f"{name}_none_because", "unit": "", "label": "", "meaning": "", "of": "reason",
                 "digits": None, "shown_in": "", "about": about} for name, about in (("E", "E_GPa"), ("f_c", "f_c_MPa"))]
    (folder / "run.json").write_text(json.dumps({
        "dimension": 3 if in_space else 2, "moves": "unbalanced_ratio" in columns, "has_press": "strain" in columns,
        "extent": {"name": "area", "unit": "m2"} if in_space else {"name": "length", "unit": "m"},
        "test_stage": test_stage, "columns": [column_facts(name) for name in columns], "results": results,
        "fields": [], "sets": []}))


def stress(strain: float) -> float:
    """MPa: a parabola to the peak, then a straight line to half of it at LAST_STRAIN."""
    if strain <= PEAK_STRAIN:
        return PEAK_STRESS * (2.0 - strain / PEAK_STRAIN) * strain / PEAK_STRAIN
    return PEAK_STRESS * (1.0 - 0.5 * (strain - PEAK_STRAIN) / (LAST_STRAIN - PEAK_STRAIN))


@dataclass
class Section:
    """Hexagonal blocks between two platens, each cut into triangles around its middle."""

    points: np.ndarray  # (N, 2), m
    triangles: np.ndarray  # (Z, 3)
    block: np.ndarray  # (Z,)
    material: np.ndarray  # (Z,)
    block_material: np.ndarray
    line_points: np.ndarray  # (2C, 2), m
    line_blocks: np.ndarray  # (C, 2) blocks on either side
    interface: np.ndarray  # (C,)
    length: np.ndarray  # (C,)
    width: float
    height: float
    circles: np.ndarray  # (n, 3) x, y, diameter, m


def hexagonal_section(columns: int, rows: int, width: float = 0.15) -> Section:
    side = width / (math.sqrt(3.0) * (columns + 0.5))
    height = side * (1.5 * rows + 0.5)
    circles = np.array([(x * width, y * height, d * width)
                        for x, y, d in ((0.3, 0.2, 0.2), (0.7, 0.35, 0.21), (0.28, 0.52, 0.15),
                                        (0.68, 0.68, 0.17), (0.35, 0.82, 0.2),
                                        (0.8, 0.88, 0.1), (0.12, 0.35, 0.08))])
    angles = np.radians(np.arange(6) * 60.0 + 30.0)
    corners = side * np.column_stack([np.cos(angles), np.sin(angles)])
    centres = np.array([((c + 0.5 + 0.5 * (r % 2)) * math.sqrt(3.0) * side, (1.5 * r + 1.0) * side)
                        for r in range(rows) for c in range(columns)])
    polygons = [centre + corners for centre in centres]
    material = [int(not any(np.hypot(*(centre - c[:2])) < 0.5 * c[2] for c in circles)) for centre in centres]
    for low in (-0.06 * height, height):
        high = low + 0.06 * height
        polygons.append(np.array([(0.0, low), (width, low), (width, high), (0.0, high)]))
        material.append(2)

    points, triangles, block = [], [], []
    for number, polygon in enumerate(polygons):
        first = len(points)
        points += [polygon.mean(axis=0), *polygon]
        n = len(polygon)
        triangles += [(first, first + 1 + i, first + 1 + (i + 1) % n) for i in range(n)]
        block += [number] * n

    shared: dict[tuple, list] = {}
    for number, polygon in enumerate(polygons):
        for a, b in zip(polygon, np.roll(polygon, -1, axis=0)):
            shared.setdefault(tuple(np.round(0.5 * (a + b) / side, 3)), []).append((number, a, b))
    line_points, line_blocks, interface, length = [], [], [], []
    for sides in shared.values():
        if len(sides) < 2:
            continue
        (one, a, b), (other, _, _) = sides
        for end in (a, b):
            line_points += [end, 0.5 * (a + b)]
            line_blocks.append((one, other))
            interface.append(material[one] + material[other])
            length.append(0.5 * side)
    for number, (centre, kind) in enumerate(zip(centres, material)):
        if centre[1] < 1.1 * side or centre[1] > height - 1.1 * side:
            platen = len(polygons) - 2 if centre[1] < 1.1 * side else len(polygons) - 1
            tip = centre + (corners[4] if centre[1] < 1.1 * side else corners[1])
            line_points += [tip, tip + (0.3 * side, 0.0)]
            line_blocks.append((number, platen))
            interface.append(3)
            length.append(0.3 * side)
    block_material = np.array(material)
    return Section(np.array(points), np.array(triangles), np.array(block), block_material[block],
                   block_material, np.array(line_points), np.array(line_blocks), np.array(interface),
                   np.array(length), width, height, circles)


def write_run(
    folder: Path, columns: int = 4, rows: int = 5, strength_factor: float = 1.0, **results
) -> Section:
    """A whole run folder; `results` replaces those of the compression in summary.json."""
    (folder / "fields").mkdir(parents=True)
    section = hexagonal_section(columns, rows)
    write_history(folder / "history.csv", strength_factor)
    compression = {"E_GPa": 22.67, "f_c_MPa": PEAK_STRESS * strength_factor, "strain_at_peak": PEAK_STRAIN,
                   "strain_ic": 0.0015, "quasi_static": True}
    write_summary(folder, "Synthetic run", [("settle", {}), ("compress", compression | results)])
    write_mesh(folder / "fields" / "mesh.h5", section)
    strains = [0.0, 0.0, *np.linspace(0.0005, LAST_STRAIN, 12)]
    frames = [(k, int(k > 0), 1000 * k, 0.1 * k, strain, strength_factor * stress(strain))
              for k, strain in enumerate(strains)]
    header = ["frame", "stage", "step", "time_s", "strain", "stress_MPa"]
    _write_csv(folder / "fields" / "frames.csv", header, frames)
    for frame in frames:
        write_fields(folder / "fields", frame[0], frame[4], section)
    return section


def write_summary(folder: Path, title: str, stages: list[tuple[str, dict]]) -> None:
    """`stages` are kinds and results."""
    stages = [{"kind": kind, "outcome": "completed", "results": results} for kind, results in stages]
    (folder / "summary.json").write_text(json.dumps(
        {"title": title, "outcome": "completed", "stages": stages, "warnings": []}))


@dataclass
class Heating:
    """What a heated run is like. Heating is at 5 K/min to `hottest`, or to the failure at `critical`."""

    level: float = 0.225
    hottest: float = 700.0
    critical: float | None = None
    restrained: bool = False
    spread: float = 0.0  # K from the coolest to the hottest gridpoint at `hottest`
    cooled: bool = False  # back to 20 degC, in a stage of its own
    compressed: bool = False  # afterwards, the load having been taken off
    unconverged: tuple[int, ...] = ()  # exchanges
    expansion: float = 1.0  # factor, for runs that differ

    def total_strain(self, temperature: float) -> float:
        """Expansion positive; that of the load at 20 degC."""
        theta = (temperature - 20.0) / 680.0
        thermal = self.expansion * (0.012 * theta**1.5 - 0.03 * self.level * theta**2)
        return thermal - self.level * STRENGTH / MODULUS


def write_heated_run(
    folder: Path, heating: Heating, /, columns: int = 4, rows: int = 5
) -> Section:
    """A run: settled, loaded, heated and what `heating` says."""
    (folder / "fields").mkdir(parents=True)
    section = hexagonal_section(columns, rows)
    history, stages = _heated_history(heating)
    _write_csv(folder / "history.csv", HEATED_COLUMNS,
               [[_heated_cell(row, name) for name in HEATED_COLUMNS] for row in history])
    write_summary(folder, "Synthetic heating",
                  [(kind, _heated_results(heating, kind, [row for row in history if row["stage"] == number]))
                   for number, kind in enumerate(stages)])
    if heating.spread:
        _write_profile_of(folder, [row for row in history if row["exchange"]])
    write_mesh(folder / "fields" / "mesh.h5", section)
    saved = [row for i, row in enumerate(history)
             if i == len(history) - 1 or not row["exchange"] or row["exchange"] % FRAME_EVERY == 0]
    names = ["stage", "step", "time_s", "strain", "stress_MPa", "temperature_degC", "heating_time_s"]
    _write_csv(folder / "fields" / "frames.csv", ["frame", *names],
               [[number, *(row.get(name, 0.0) for name in names)] for number, row in enumerate(saved)])
    for number, row in enumerate(saved):
        write_fields(folder / "fields", number, row["damaging_strain"], section)
        _write_temperature(folder / "fields", number, row, section)
    return section


def _heated_cell(row: dict, name: str) -> float | str:
    """Empty where the row's stage exchanges no temperatures."""
    return "" if name in ("exchange", "cycles", "converged") and not row["exchange"] else row.get(name, 0.0)


def _heated_results(heating: Heating, kind: str, rows: list[dict]) -> dict:
    """What the summary says of a stage."""
    if kind == "load":
        return {"load_stress_MPa": heating.level * STRENGTH, "load_level": heating.level}
    if kind == "compress":
        return {"E_GPa": 10.0, "f_c_MPa": 0.5 * STRENGTH, "strain_at_peak": PEAK_STRAIN, "strain_ic": 0.001,
                "quasi_static": True}
    if kind == "settle":
        return {}
    return {
        "field": "conduction" if heating.spread else "uniform",
        "load_stress_MPa": heating.level * STRENGTH, "critical_temperature_degC": heating.critical,
        "exchanges": len(rows), "exchanges_not_converged": sum(not row["converged"] for row in rows),
        "largest_exchange_increment_K": EXCHANGE, "cycles": sum(row["cycles"] for row in rows),
        "platen": "fixed" if heating.restrained else "force",
    }


def _heated_history(heating: Heating) -> tuple[list[dict], list[str]]:
    """Rows of the history and the kinds of the stages."""
    kinds = ["settle", "load", "heat"] + heating.cooled * ["heat"] + heating.compressed * ["compress"]
    end = heating.critical or heating.hottest
    warming = [20.0 + EXCHANGE * (i + 1) for i in range(round((end - 20.0) / EXCHANGE))]
    temperatures = [(2, t) for t in warming]
    if heating.cooled:
        temperatures += [(3, t) for t in [*warming[-2::-1], 20.0]]
    load = heating.level * STRENGTH
    rows = [_heated_row(heating, 0, 20.0, 0, strain=0.0, stress=0.0),
            _heated_row(heating, 1, 20.0, 0, strain=-heating.total_strain(20.0), stress=load)]
    hottest = 20.0
    for number, (stage, temperature) in enumerate(temperatures, start=1):
        hottest = max(hottest, temperature)
        # Of the strain of heating, 30 % stay when it is cooled.
        strain = -(0.7 * heating.total_strain(temperature) + 0.3 * heating.total_strain(hottest))
        axial = load
        if heating.restrained:
            strain = rows[1]["strain"]
            axial += 60.0 * (temperature - 20.0) / 680.0 * (1.2 - temperature / 800.0)
        if number == len(temperatures) and heating.critical:
            strain += 0.05
        rows.append(_heated_row(heating, stage, temperature, number, strain, axial, hottest))
    if heating.compressed:
        before = rows[-1]["strain"]
        for strain in np.linspace(0.0, LAST_STRAIN, 61)[1:]:
            rows.append(_heated_row(heating, len(kinds) - 1, rows[-1]["temperature_degC"], 0, before + strain,
                                    0.5 * STRENGTH / PEAK_STRESS * stress(strain), hottest))
    for i, row in enumerate(rows):
        row |= {"step": 1000 * i, "time_s": 0.1 * i,
                "heating_time_s": 60.0 / 5.0 * EXCHANGE * min(i - 1, len(temperatures)) if i else 0.0}
    return rows, kinds


def _heated_row(heating: Heating, stage: int, temperature: float, exchange: int, strain: float, stress: float,
                hottest: float = 20.0) -> dict:
    share = (temperature - 20.0) / (heating.hottest - 20.0)
    damage = ((hottest - 20.0) / 680.0) ** 2
    failing = exchange > 0 and temperature == heating.critical
    converged = not failing and exchange not in heating.unconverged
    row = {
        "stage": stage, "strain": strain, "specimen_strain": strain, "stress_MPa": stress,
        "stress_top_MPa": 1.01 * stress,
        "stress_bottom_MPa": 0.99 * stress, "lateral_strain": 0.3 * abs(strain) + 0.012 * share,
        "temperature_degC": temperature, "temperature_min_degC": temperature - 0.5 * heating.spread * share,
        "temperature_max_degC": temperature + 0.5 * heating.spread * share, "exchange": exchange,
        "converged": int(converged), "mean_opening_m": 4e-5 * damage,
        "cycles": (300 + int(1500 * damage) + 100 * (exchange % 7) if converged else 5000) * (exchange > 0),
        "unbalanced_ratio": 4e-3 if not converged else 9e-4 - 1e-5 * (exchange % 9),
        "energy_loading_J": 20.0 - 30.0 * share, "energy_gravity_J": 2.0, "energy_property_change_J": 120.0 * damage,
        "damaging_strain": 0.8 * LAST_STRAIN * damage**0.5 + (0.2 * LAST_STRAIN if failing else 0.0),
    }
    work = row["energy_loading_J"] + 2.0 + row["energy_property_change_J"]
    for column, part in (("energy_zones_J", 0.3), ("energy_contacts_J", 0.2), ("dissipated_tension_J", 0.25),
                         ("dissipated_shear_J", 0.1), ("dissipated_friction_J", 0.1),
                         ("energy_local_damping_J", 0.04)):
        row[column] = part * work
    row["energy_error_J"] = 0.01 * work
    for column, most in (("tension_aggregate_mortar", 400), ("tension_mortar_mortar", 700), ("shear_aggregate_mortar", 300), ("shear_mortar_mortar", 500)):
        row[f"{column}_damaged"] = int(most * damage)
        row[f"{column}_broken"] = int(0.6 * most * damage**2)
        row[f"{column}_length_m"] = 1e-3 * int(most * damage)
        row[f"{column}_broken_length_m"] = 1e-3 * row[f"{column}_broken"]
    return row


def _write_temperature(folder: Path, number: int, row: dict, section: Section) -> None:
    """Hotter towards the sides; platens at 20 degC."""
    off_middle = np.abs(section.points[:, 0] / section.width - 0.5) * 2.0
    low, high = row["temperature_min_degC"], row["temperature_max_degC"]
    temperature = low + (high - low) * off_middle**2
    temperature[np.unique(section.triangles[section.material == 2])] = 20.0
    with h5py.File(folder / f"blocks_{number:04d}.hdf", "a") as file:
        file["VTKHDF/PointData/temperature [degC]"] = temperature.astype(np.float32)


def write_profile(folder: Path, times: list[float], depth: np.ndarray, temperature: np.ndarray) -> None:
    """The tables of a heated line: (k, n) degC over its (n,) depth [m] at k times [s], and its isotherm of 500 degC."""
    _write_csv(folder / "temperature_profile.csv", ["heating_time_s", "depth_m", "temperature_degC"],
               [(time, one, value) for time, values in zip(times, temperature) for one, value in zip(depth, values)])
    hot = [(time, float(np.interp(-500.0, -values, depth))) for time, values in zip(times, temperature)
           if values[0] >= 500.0]
    _write_csv(folder / "isotherm.csv", ["heating_time_s", "depth_500_degC_m"], hot)


def _write_profile_of(folder: Path, rows: list[dict]) -> None:
    """Falling from the greatest temperature of each row at the face to the least across."""
    depth = np.linspace(0.0, 0.15, 121)
    write_profile(folder, [row["heating_time_s"] for row in rows], depth,
                  np.array([np.interp(depth, (0.0, 0.15), (row["temperature_max_degC"], row["temperature_min_degC"]))
                            for row in rows]))


def write_conduction(folder: Path) -> Section:
    """A run of heat conduction alone, its sides warming to 400 degC, with two probes."""
    (folder / "fields").mkdir(parents=True)
    section = hexagonal_section(4, 5)
    rows = [{"stage": 0, "heating_time_s": 60.0 * i, "temperature_degC": 20.0 + 5.0 * i,
             "temperature_min_degC": 20.0 + 1.0 * i,
             "temperature_max_degC": 20.0 + 19.0 * i, "heat_stored_J": 1e4 * i, "gas_max_degC": 20.0 + 30.0 * i,
             "probe_a_degC": 20.0 + 2.0 * i,
             "probe_b_degC": 20.0 + 9.0 * i} for i in range(21)]
    _write_csv(folder / "history.csv", list(rows[0]), [list(row.values()) for row in rows])
    write_summary(folder, "Synthetic conduction", [("conduct", {"steady": False})])
    _write_profile_of(folder, rows)
    write_mesh(folder / "fields" / "mesh.h5", section)
    frames = rows[::4]
    _write_csv(folder / "fields" / "frames.csv", ["frame", "stage", "temperature_degC", "heating_time_s"],
               [(number, 0, row["temperature_degC"], row["heating_time_s"]) for number, row in enumerate(frames)])
    for number, row in enumerate(frames):
        _write_temperature(folder / "fields", number, row, section)
    return section


def write_history(path: Path, strength_factor: float = 1.0) -> None:
    rows = [{"stage": 0, "step": 0}]
    work = 0.0
    strains = np.linspace(0.0, LAST_STRAIN, 241)[1:]
    for i, strain in enumerate(strains):
        now = strength_factor * stress(strain)
        work += now * 1e6 * (strains[1] - strains[0]) * 0.045
        grown = max(0.0, strain / LAST_STRAIN - 0.2) ** 2
        stored = 0.5 * (now * 1e6) ** 2 / 22e9 * 0.045
        lost = max(0.0, work - stored)
        row = {"stage": 1, "step": 1000 + i, "strain": strain, "stress_MPa": now,
               "stress_top_MPa": 1.01 * now, "stress_bottom_MPa": 0.99 * now,
               "energy_loading_J": work + 2.0, "energy_gravity_J": 2.0,
               "energy_zones_J": 0.7 * stored, "energy_contacts_J": 0.3 * stored, "energy_kinetic_J": 0.4}
        for column, share in (("dissipated_tension_J", 0.15), ("dissipated_shear_J", 0.25),
                              ("dissipated_friction_J", 0.3), ("dissipated_compression_J", 0.2),
                              ("energy_local_damping_J", 0.08)):
            row[column] = share * lost
        row["energy_error_J"] = 0.02 * lost
        for column, most in (("tension_aggregate_mortar", 400), ("tension_mortar_mortar", 700), ("shear_aggregate_mortar", 300), ("shear_mortar_mortar", 500)):
            row[f"{column}_damaged"] = int(most * grown)
            row[f"{column}_broken"] = int(0.6 * most * grown**2)
            for state, ending in (("damaged", "length_m"), ("broken", "broken_length_m")):
                row[f"{column}_{ending}"] = 1e-3 * row[f"{column}_{state}"]
        rows.append(row)
    _write_csv(path, HISTORY_COLUMNS, [[row.get(name, 0.0) for name in HISTORY_COLUMNS] for row in rows])


def write_mesh(path: Path, section: Section) -> None:
    with h5py.File(path, "w") as file:
        _write_cells(file.create_group("blocks"), section.points, section.triangles, 5)
        file["blocks/block"] = section.block.astype(np.int32)
        file["blocks/material"] = section.material.astype(np.uint8)
        file["blocks/bearing"] = (section.material == 2).astype(np.uint8)
        file["blocks/material_names"] = np.array(["aggregate", "mortar", "platen"], "S")
        lines = np.arange(len(section.line_points)).reshape(-1, 2)
        _write_cells(file.create_group("contacts"), section.line_points, lines, 3)
        file["contacts/interface"] = section.interface.astype(np.uint8)
        file["contacts/interface_names"] = np.array(
            ["aggregate_aggregate", "aggregate_mortar", "mortar_mortar", "platen"], "S")
        file["contacts/length"] = section.length


def write_fields(folder: Path, number: int, strain: float, section: Section) -> None:
    """Two halves part along an inclined band; damage grows beside it, tension first."""
    centres = np.array([section.points[section.triangles[section.block == b].ravel()].mean(axis=0)
                        for b in range(len(section.block_material))])
    centres[section.block_material == 2, 1] = (-0.03 * section.height, 1.03 * section.height)
    moved = _block_displacement(centres, strain, section)
    owner = np.zeros(len(section.points), dtype=int)
    owner[section.triangles.ravel()] = np.repeat(section.block, 3)
    displacement = moved[owner]
    with h5py.File(folder / f"blocks_{number:04d}.hdf", "w") as file:
        file["VTKHDF/PointData/displacement [m]"] = _with_z(displacement)
        file["VTKHDF/CellData/stress [Pa]"] = np.zeros((len(section.triangles), 6), np.float32)

    random = np.random.default_rng(1)
    middles = section.line_points[1::2]
    off_band = np.abs(_band(middles, section)) / section.height
    weakness = np.exp(-((off_band / 0.02) ** 2)) + random.uniform(0.0, 0.7, len(middles)) ** 3
    grown = 2.5 * max(0.0, strain / LAST_STRAIN - 0.15)
    tension = np.clip(grown * weakness * random.uniform(0.5, 1.0, len(middles)) - 0.3, 0.0, 1.0)
    shear = np.clip(grown * weakness * random.uniform(0.2, 1.0, len(middles)) - 0.4, 0.0, 1.0)
    for damage in (tension, shear):
        damage[section.interface == 0] = 0.0
        damage[section.interface == 3] = 1.0  # platen contacts start as broken
    with h5py.File(folder / f"contacts_{number:04d}.hdf", "w") as file:
        between = 0.5 * (moved[section.line_blocks[:, 0]] + moved[section.line_blocks[:, 1]])
        file["VTKHDF/PointData/displacement [m]"] = _with_z(np.repeat(between, 2, axis=0))
        file["VTKHDF/CellData/tension_damage [1]"] = tension.astype(np.float32)
        file["VTKHDF/CellData/shear_damage [1]"] = shear.astype(np.float32)
        file["VTKHDF/CellData/opening [m]"] = (1e-4 * tension).astype(np.float32)
        file["VTKHDF/CellData/tangential_jump [m]"] = (-2e-4 * shear).astype(np.float32)


def write_specimen(folder: Path, section: Section) -> None:
    (folder / "fields").mkdir(parents=True, exist_ok=True)
    if not (folder / "fields" / "mesh.h5").exists():
        write_mesh(folder / "fields" / "mesh.h5", section)
    _write_csv(folder / "aggregates.csv", ["x_m", "y_m", "diameter_m"], section.circles)
    sizes = np.array([0.00475, 0.008, 0.0125, 0.016, 0.02, 0.025, 0.032])
    asked = 100.0 * ((sizes / 0.032) ** 0.45 - (0.00475 / 0.032) ** 0.45) / (1.0 - (0.00475 / 0.032) ** 0.45)
    _write_csv(folder / "gradation.csv", ["d_m", "asked_percent", "placed_percent"],
               np.column_stack([sizes, asked, np.maximum(asked - 1.0, 0.0)]))
    (folder / "specimen.json").write_text(json.dumps({
        "width_m": section.width, "height_m": section.height, "fraction_asked": 0.34,
        "fraction_placed": 0.338, "fraction_superposed": 0.312, "blocks": len(section.block_material),
        "fraction": {"aggregate": 0.312, "mortar": 0.688}}))


def _band(points: np.ndarray, section: Section) -> np.ndarray:
    """Signed distance from an inclined line through the middle, m."""
    return (points - (0.5 * section.width, 0.5 * section.height)) @ (math.cos(0.4), -math.sin(0.4))


def _block_displacement(centres: np.ndarray, strain: float, section: Section) -> np.ndarray:
    moved = np.column_stack([0.2 * strain * (centres[:, 0] - 0.5 * section.width), -strain * centres[:, 1]])
    opened = max(0.0, strain - PEAK_STRAIN) * 0.35 * section.width
    right = _band(centres, section) > 0.0
    moved[right, 0] += opened
    moved[centres[:, 1] < 0.0] = 0.0
    moved[centres[:, 1] > section.height] = (0.0, -strain * section.height)
    return moved


def _with_z(vectors: np.ndarray) -> np.ndarray:
    return np.column_stack([vectors, np.zeros(len(vectors))]).astype(np.float32)


def _write_cells(group: h5py.Group, points: np.ndarray, cells: np.ndarray, cell_type: int) -> None:
    group["Points"] = np.column_stack([points, np.zeros(len(points))])
    group["Connectivity"] = cells.ravel().astype(np.int64)
    group["Offsets"] = np.arange(0, cells.size + 1, cells.shape[1], dtype=np.int64)
    group["Types"] = np.full(len(cells), cell_type, np.uint8)
    group["NumberOfPoints"] = np.array([len(points)])
    group["NumberOfCells"] = np.array([len(cells)])
    group["NumberOfConnectivityIds"] = np.array([cells.size])


def _write_csv(path: Path, header, rows) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)
    if path.name == "history.csv":
        write_facts(path.parent, list(header))
