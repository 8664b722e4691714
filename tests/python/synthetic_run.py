"""Writes run and specimen folders of invented numbers in the layout of the program."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

PEAK_STRAIN, PEAK_STRESS, LAST_STRAIN = 0.003, 34.0, 0.006

HISTORY_COLUMNS = (
    "stage,step,time_s,strain,stress_MPa,stress_top_MPa,stress_bottom_MPa,lateral_strain,unbalanced_ratio,"
    "kinetic_over_strain,largest_jump,tension_am_softening,tension_am_broken,tension_am_length_m,"
    "tension_mm_softening,tension_mm_broken,tension_mm_length_m,shear_am_softening,shear_am_broken,"
    "shear_am_length_m,shear_mm_softening,shear_mm_broken,shear_mm_length_m,mean_opening_m,energy_loading_J,"
    "energy_gravity_J,energy_heat_J,energy_zones_J,energy_contacts_J,energy_kinetic_J,dissipated_tension_J,"
    "dissipated_shear_J,dissipated_friction_J,dissipated_compression_J,energy_local_damping_J,"
    "energy_viscous_damping_J,energy_error_J"
).split(",")


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
    folder: Path, columns: int = 4, rows: int = 5, strength_factor: float = 1.0, **summary
) -> Section:
    """A whole run folder; `summary` replaces entries of summary.json."""
    (folder / "fields").mkdir(parents=True)
    section = hexagonal_section(columns, rows)
    write_history(folder / "history.csv", strength_factor)
    facts = {
        "title": "Synthetic run",
        "quasi_static": True,
        "compression": {"E_GPa": 22.67, "f_c_MPa": PEAK_STRESS * strength_factor,
                        "strain_at_peak": PEAK_STRAIN, "strain_ic": 0.0015},
    }
    (folder / "summary.json").write_text(json.dumps(facts | summary))
    write_mesh(folder / "fields" / "mesh.h5", section)
    strains = [0.0, 0.0, *np.linspace(0.0005, LAST_STRAIN, 12)]
    frames = [(k, int(k > 0), 1000 * k, 0.1 * k, strain, strength_factor * stress(strain))
              for k, strain in enumerate(strains)]
    header = ["frame", "stage", "step", "time_s", "strain", "stress_MPa"]
    _write_csv(folder / "fields" / "frames.csv", header, frames)
    for frame in frames:
        write_fields(folder / "fields", frame[0], frame[4], section)
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
        for column, most in (("tension_am", 400), ("tension_mm", 700), ("shear_am", 300), ("shear_mm", 500)):
            row[f"{column}_softening"] = int(most * grown)
            row[f"{column}_broken"] = int(0.6 * most * grown**2)
        rows.append(row)
    _write_csv(path, HISTORY_COLUMNS, [[row.get(name, 0.0) for name in HISTORY_COLUMNS] for row in rows])


def write_mesh(path: Path, section: Section) -> None:
    with h5py.File(path, "w") as file:
        _write_cells(file.create_group("blocks"), section.points, section.triangles, 5)
        file["blocks/block"] = section.block.astype(np.int32)
        file["blocks/material"] = section.material.astype(np.uint8)
        lines = np.arange(len(section.line_points)).reshape(-1, 2)
        _write_cells(file.create_group("contacts"), section.line_points, lines, 3)
        file["contacts/interface"] = section.interface.astype(np.uint8)
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
        file["VTKHDF/PointData/displacement"] = _with_z(displacement)
        file["VTKHDF/CellData/stress"] = np.zeros((len(section.triangles), 3), np.float32)

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
        file["VTKHDF/PointData/displacement"] = _with_z(np.repeat(between, 2, axis=0))
        file["VTKHDF/CellData/tension_damage"] = tension.astype(np.float32)
        file["VTKHDF/CellData/shear_damage"] = shear.astype(np.float32)


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
        "fraction_placed": 0.338, "fraction_superposed": 0.312, "blocks": len(section.block_material)}))


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
