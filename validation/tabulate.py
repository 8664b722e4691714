"""Tabulates E, f_c and eps_ic of the compression runs in a folder: one line a run, then mean and spread by variant.

Usage: python3 validation/tabulate.py RUNS
"""

import json
import pathlib
import statistics
import sys

COLUMNS = ("E_GPa", "f_c_MPa", "stress_max_MPa", "strain_at_peak", "strain_ic")


def number(value: float | None) -> str:
    """A number of the table; nothing where a run has no peak and so no strength."""
    return "" if value is None else f"{value:.5g}"


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    runs: dict[str, list[dict]] = {}
    print("physics_version,variant,seed," + ",".join(COLUMNS) + ",kinetic_over_elastic,platen_difference_percent,"
          "ledger_error_percent,aggregate_fraction,steps,wall_time_s")
    for file in sorted(folder.glob("*/summary.json")):
        summary = json.loads(file.read_text())
        manifest = json.loads((file.parent / "manifest.json").read_text())
        variant = file.parent.name.rpartition("-")[0]
        result = next(stage["results"] for stage in summary["stages"] if stage["kind"] == "compress")
        kinetic, difference = result["kinetic_over_elastic_to_peak"], result["platen_difference_over_f_c_to_peak"]
        runs.setdefault(variant, []).append(result | {"version": manifest["physics_version"]})
        version = manifest["physics_version"]
        print(f"{version},{variant},{manifest['seed']}," + ",".join(number(result[c]) for c in COLUMNS) +
              f",{kinetic:.1e},{100 * difference:.2f},{100 * summary['energy_J']['error_over_turnover']:.3f}"
              f",{summary['specimen']['fraction_superposed']:.4f},{summary['steps']},"
              f"{summary['wall_time_s']:.0f}")
    for variant, results in runs.items():
        for name, of in (("mean", statistics.mean), ("spread", lambda v: statistics.stdev(v) if len(v) > 1 else 0.0)):
            columns = ([r[c] for r in results if r[c] is not None] for c in COLUMNS)
            versions = " and ".join(sorted({str(r["version"]) for r in results}))
            numbers = ",".join(number(of(values) if values else None) for values in columns)
            print(f"{versions},{variant},{name},{numbers},,,,,,")


if __name__ == "__main__":
    main()
