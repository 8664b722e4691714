"""Tabulates E, f_c and eps_ic of the compression runs in a folder: one line a run, then mean and spread by variant.

Usage: python3 validation/tabulate.py RUNS
"""

import json
import pathlib
import statistics
import sys

COLUMNS = ("E_GPa", "f_c_MPa", "strain_at_peak", "strain_ic")


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    runs: dict[str, list[dict]] = {}
    print("variant,seed," + ",".join(COLUMNS) + ",quasi_static,ledger_error_percent,aggregate_fraction,steps,wall_time_s")
    for file in sorted(folder.glob("*/summary.json")):
        summary = json.loads(file.read_text())
        manifest = json.loads((file.parent / "manifest.json").read_text())
        variant = file.parent.name.rpartition("-")[0]
        result = summary["compression"]
        runs.setdefault(variant, []).append(result)
        print(f"{variant},{manifest['seed']}," + ",".join(f"{result[c]:.5g}" for c in COLUMNS) +
              f",{summary['quasi_static']},{100 * summary['energy_J']['error_over_work']:.3f}"
              f",{summary['specimen']['aggregate_fraction_superposed']:.4f},{summary['steps']},{summary['wall_time_s']:.0f}")
    for variant, results in runs.items():
        for name, of in (("mean", statistics.mean), ("spread", lambda v: statistics.stdev(v) if len(v) > 1 else 0.0)):
            print(f"{variant},{name}," + ",".join(f"{of([r[c] for r in results]):.5g}" for c in COLUMNS) + ",,,,,")


if __name__ == "__main__":
    main()
