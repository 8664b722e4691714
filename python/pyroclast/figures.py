"""Draws the figures of runs and specimens.

    python3 -m pyroclast.figures run RUN_DIR        RUN_DIR/figures/{stress_strain,cracks,energy,fracture}.png
    python3 -m pyroclast.figures specimen DIR       DIR/figures/{gradation,morphology}.png
    python3 -m pyroclast.figures compare RUN_DIR... --out FILE
    python3 -m pyroclast.figures properties DIR     DIR/figures/properties.png, from DIR/properties.csv

Prints the path of each figure. Ends with 1 and one line on stderr when something is missing or malformed.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from .curves import compare, stress_strain
from .progress import cracks, energy
from .properties import properties, read_properties
from .run import Run, RunError, Specimen
from .sections import fracture, gradation, morphology, select_frames
from .style import save

_FORMATS = ("png", "svg", "pdf")


def draw_run(folder: Path, file_format: str = "png", magnification: float | None = None) -> Iterator[Path]:
    """Draws all figures of a compression run into its figures/ folder; yields each path once written."""
    run = Run(folder)
    marks = select_frames(run.loaded_frames, *run.peak) if run.loaded_frames else {}
    place = run.folder / "figures"
    yield save(stress_strain(run, marks), place / f"stress_strain.{file_format}")
    yield save(cracks(run), place / f"cracks.{file_format}")
    yield save(energy(run), place / f"energy.{file_format}")
    if not marks:
        path = run.folder / "fields" / "frames.csv"
        raise RunError(f"{path}: no frame of the loading stage; fracture cannot be drawn")
    yield save(fracture(run, marks, magnification), place / f"fracture.{file_format}")


def draw_properties(folder: Path, file_format: str = "png") -> Iterator[Path]:
    """Draws the properties over the temperature into the folder's figures/; yields the path once written."""
    table = read_properties(folder / "properties.csv")
    yield save(properties(table), folder / "figures" / f"properties.{file_format}")


def draw_specimen(folder: Path, file_format: str = "png") -> Iterator[Path]:
    """Draws the figures of a specimen into its figures/ folder; yields each path once written."""
    specimen = Specimen(folder)
    place = specimen.folder / "figures"
    yield save(gradation(specimen), place / f"gradation.{file_format}")
    yield save(morphology(specimen), place / f"morphology.{file_format}")


def draw_comparison(folders: Sequence[Path], out: Path) -> Iterator[Path]:
    """Draws the curves of several runs into one file, its format by its ending."""
    if out.suffix.lower().lstrip(".") not in _FORMATS:
        raise RunError(f"{out}: the file's ending must be one of {', '.join('.' + f for f in _FORMATS)}")
    yield save(compare([Run(folder) for folder in folders]), out)


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m pyroclast.figures",
                                     description="Draws the figures of runs and specimens.")
    commands = parser.add_subparsers(dest="command", required=True)

    run = commands.add_parser("run", help="all figures of a compression run")
    run.add_argument("folder", type=Path, metavar="RUN_DIR")
    run.add_argument("--format", choices=_FORMATS, default="png")
    run.add_argument("--magnification", type=_positive, metavar="FACTOR",
                     help="of displacements in fracture (default: chosen from the last frame, and stated)")
    run.set_defaults(draw=lambda asked: draw_run(asked.folder, asked.format, asked.magnification))

    specimen = commands.add_parser("specimen", help="morphology and gradation of a specimen")
    specimen.add_argument("folder", type=Path, metavar="DIR")
    specimen.add_argument("--format", choices=_FORMATS, default="png")
    specimen.set_defaults(draw=lambda asked: draw_specimen(asked.folder, asked.format))

    comparison = commands.add_parser("compare", help="stress-strain curves of several runs in one figure")
    comparison.add_argument("folders", type=Path, nargs="+", metavar="RUN_DIR")
    comparison.add_argument("--out", type=Path, required=True, metavar="FILE")
    comparison.set_defaults(draw=lambda asked: draw_comparison(asked.folders, asked.out))

    properties_command = commands.add_parser("properties", help="properties over the temperature")
    properties_command.add_argument("folder", type=Path, metavar="DIR")
    properties_command.add_argument("--format", choices=_FORMATS, default="png")
    properties_command.set_defaults(draw=lambda asked: draw_properties(asked.folder, asked.format))
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit code."""
    asked = _parser().parse_args(arguments)
    try:
        for path in asked.draw(asked):
            print(path)
    except (RunError, OSError) as problem:
        print(f"pyroclast figures: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
