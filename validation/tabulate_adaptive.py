"""Compares runs whose loading follows the body with slow runs: writes one line a run, prints tables by seed.

Usage: python3 validation/tabulate_adaptive.py RUNS CSV
"""

import csv
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from pyroclast.stored.compressed import Compressed  # noqa: E402
from pyroclast.stored.heated import Heated  # noqa: E402
from pyroclast.stored.results import Results  # noqa: E402

COLUMNS = ("physics_version", "kind", "variant", "level", "seed", "steps", "E_GPa", "f_c_MPa", "strain_at_peak",
           "quasi_static", "strain_500", "critical_degC", "not_converged", "wall_time_s")


def row_of(folder: pathlib.Path) -> dict:
    """What a run came to; what it has not is empty."""
    summary = json.loads((folder / "summary.json").read_text())
    kind, variant, *level, seed = folder.name.split("-")
    version = json.loads((folder / "manifest.json").read_text())["physics_version"]
    row = dict.fromkeys(COLUMNS, "") | {"physics_version": version, "kind": kind, "variant": variant,
                                        "level": level[0] if level else "", "seed": seed,
                                        "steps": summary["steps"], "wall_time_s": round(summary["wall_time_s"])}
    if kind == "compression":
        result = Compressed(Results(folder)).results
        return row | {c: result[c] for c in ("E_GPa", "f_c_MPa", "strain_at_peak", "quasi_static")}
    heating = Heated(Results(folder)).results
    strain, critical = Heated(Results(folder)).standing_strain((500,))[0], heating["critical_temperature_degC"]
    return row | {"strain_500": "" if math.isnan(strain) else strain,
                  "not_converged": heating["exchanges_not_converged"],
                  "critical_degC": "" if critical is None else critical}


def against(name: str, value: float | str, reference: float | str) -> str:
    """Difference to the slow run: a temperature's in K, others' in %."""
    if "" in (value, reference):
        return "–"
    return f"{value - reference:+.0f} K" if name == "critical_degC" else f"{100.0 * (value / reference - 1.0):+.2f} %"


def table(rows: list[dict], kind: str, columns: dict[str, str]) -> None:
    """Prints one kind of run; each with its differences to the slow run of its level and seed."""
    titles = " | ".join(f"{title} | against slow" for title in columns.values())
    print(f"\n| level | seed | variant | steps | of slow | {titles} |")
    print("|" + "---|" * (5 + 2 * len(columns)))
    slow = {(r["level"], r["seed"]): r for r in rows if r["kind"] == kind and r["variant"] == "slow"}
    for r in sorted((r for r in rows if r["kind"] == kind), key=lambda r: (r["level"], r["seed"], r["variant"] != "slow")):
        reference = slow.get((r["level"], r["seed"]), dict.fromkeys(COLUMNS, ""))
        share = "–" if reference["steps"] == "" else f"{100.0 * r['steps'] / reference['steps']:.0f} %"
        cells = [r["level"], r["seed"], r["variant"], f"{r['steps']:,}", share]
        for name in columns:
            cells += ["–" if r[name] == "" else f"{r[name]:.5g}", against(name, r[name], reference[name])]
        print("| " + " | ".join(cells) + " |")


def main() -> None:
    rows = [row_of(file.parent) for file in sorted(pathlib.Path(sys.argv[1]).glob("*/summary.json"))]
    with open(sys.argv[2], "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows({k: f"{v:.5g}" if isinstance(v, float) else v for k, v in r.items()} for r in rows)
    table(rows, "compression", {"E_GPa": "E [GPa]", "f_c_MPa": "f_c [MPa]", "strain_at_peak": "strain at peak"})
    table(rows, "heating", {"strain_500": "strain at 500 °C [10⁻³]", "critical_degC": "critical [°C]"})


if __name__ == "__main__":
    main()
