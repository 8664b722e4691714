"""Tabulates heated runs: total strain at every 100 degC beside the band of its load level, and critical temperature.

Usage: python3 validation/tabulate_heating.py RUNS
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))

from pyroclast.stored.heated import Heated  # noqa: E402
from pyroclast.stored.reference import strain_band  # noqa: E402
from pyroclast.stored.results import Results  # noqa: E402

TEMPERATURES = (100, 200, 300, 400, 500, 600, 700, 800)


def band(level: float) -> list[str]:
    """The level's band at each temperature, "low..high" in 1e-3; empty where it has none."""
    limits = strain_band(level)
    cells = []
    for temperature in TEMPERATURES:
        inside = limits is not None and limits.temperature[0] <= temperature <= limits.temperature[-1]
        low, _, high = limits.at(temperature) if inside else (0.0, 0.0, 0.0)
        cells.append(f"{1e3 * low:.2f}..{1e3 * high:.2f}" if inside else "")
    return cells


def main() -> None:
    runs = [Results(file.parent) for file in sorted(pathlib.Path(sys.argv[1]).glob("*/summary.json"))]
    names = [f"strain_{t}" for t in TEMPERATURES]
    print("physics_version,variant,level,seed," + ",".join(names) + ",critical_degC,exchanges,not_converged,"
          "worst_ratio,cycles,ledger_error_percent,wall_time_s")
    for level in sorted({Heated(run).load_level for run in runs}):
        print(f"none,band,{level:g},," + ",".join(band(level)) + ",,,,,,,")
    for run in runs:
        variant, level, seed = run.folder.name.rsplit("-", 2)
        strains = 1e3 * Heated(run).standing_strain(TEMPERATURES)
        heating = Heated(run).results
        critical = heating["critical_temperature_degC"]
        version = run.manifest["physics_version"]
        print(f"{version},{variant},{level},{seed}," + ",".join("" if np.isnan(s) else f"{s:.2f}" for s in strains)
              + f",{'' if critical is None else f'{critical:.0f}'},{heating['exchanges']:.0f},"
              f"{heating['exchanges_not_converged']:.0f},{heating['worst_unbalanced_ratio']:.1e},"
              f"{heating['cycles']:.0f},"
              f"{100.0 * run.summary['energy_J']['error_over_turnover']:.3f},{run.summary['wall_time_s']:.0f}")


if __name__ == "__main__":
    main()
