"""Draws the figures of runs and specimens.

    python3 -m pyroclast.figures run RUN_DIR        RUN_DIR/figures/..., or with --out FOLDER there; of a folder of
                                                    `pyroclast run --seeds`, figures/seeds.png
    python3 -m pyroclast.figures plane RUN_DIR --axis z --at 0.5    RUN_DIR/figures/plane_z_0.5.png, of a solid; with
                                                    --colour temperature plane_z_0.5_temperature.png
    python3 -m pyroclast.figures specimen DIR       DIR/figures/{gradation,morphology}.png
    python3 -m pyroclast.figures compare RUN_DIR... --out FILE
    python3 -m pyroclast.figures levels RUN_DIR... --out FILE
    python3 -m pyroclast.figures properties DIR     DIR/figures/properties.png, from DIR/properties.csv

A run that was heated gets total_strain.png (thrust.png when its platens were fixed), heating_cracks.png,
heating_energy.png and heating_fracture.png, and convergence.png where the body did not come to rest at an exchange;
a run whose last stage compresses gets stress_strain.png, cracks.png, energy.png and fracture.png; one with [[record]]
tables gets records.png; one without platens gets energy.png and fracture.png beside it; one of
heat conduction alone gets neither. A run that computes its temperatures gets temperature_history.png,
temperature.png, temperature_profile.png and, if it comes to 500 °C, isotherm.png; one with water in its pores
water.png and, with fields, water_profile.png and water_maps.png; one that pieces may leave spalling.png, with fields.
A run that keeps no fields gets those of them that are drawn from its history. Of a solid that moves,
cracks_inside.png stands beside fracture.png, unless no law of its contacts has a damage.

Prints the path of each figure. Ends with 1 and a line on stderr for each thing that is missing or malformed; figures
that need none of these are drawn.
"""

from __future__ import annotations

import argparse
import csv
import gc
import re
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from .draw.comparisons import KINDS, compare_runs, compare_seeds
from .draw.curves import stress_strain
from .draw.fractures import Rows, fracture, fracture_panels, select_frames, write_counts
from .draw.heated_sections import LEVEL_TEMPERATURES, heating_fracture, levels, temperature_field
from .draw.heating import convergence, temperature_history, thrust, total_strain
from .draw.profiles import isotherm, read_profile, temperature_profile
from .draw.progress import cracks, energy, heating_course, heating_cracks, loading_course
from .draw.properties import properties, read_properties
from .draw.records import record_course, record_fracture, records, records_of
from .draw.sections import gradation, morphology
from .draw.solid_sections import COLOURS, cracks_inside, plane_section
from .draw.style import page_of, save
from .draw.spalling import spalling
from .draw.water import water, water_profile
from .draw.water_maps import water_maps
from .errors import Error
from .programs import complain, run_program, say
from .stored.compressed import Compressed
from .stored.files import GapWarning
from .stored.heated import Heated
from .stored.results import Results, SpecimenFolder
from .stored.run_facts import SPALLING, WATER
from .writing import make_folder, shell_path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # the tarball brings it along

_FORMATS = ("png", "svg", "pdf")
_NAME = "pyroclast figures"
_PER_INCH = {"mm": 25.4, "cm": 2.54, "in": 1.0}
NARROWEST, WIDEST = 70.0 / 25.4, 400.0 / 25.4
"""Inches: widths for which figures can be drawn."""


@dataclass(frozen=True)
class Picture:
    """A figure that a run has."""

    name: str
    draw: Callable[[], Figure]
    write: Callable[[Path], object] | None = None
    """Writes the table that comes with it into the folder of the figures."""


def figures_of(run: Results, magnification: float | None = None,
               temperatures: Sequence[float] | None = None) -> Iterator[Picture]:
    """Yields the figures that a run has; the arguments are those of `draw_run`."""
    hot = Heated(run)
    if temperatures is not None and not run.has_fields:
        raise Error(f"{run.folder}: keeps no fields, so --temperatures asks for nothing")
    if run.moves and not run.has_platens:
        yield from _of_records(run, magnification)
        return
    if hot.exchanged.any():
        yield from _of_heating(run, magnification, temperatures)
    elif temperatures is not None:
        raise Error(f"{run.folder}: was never heated with mechanics, so --temperatures asks for nothing")
    if not run.moves:
        yield from _of_conduction(run)
    elif not hot.is_last:
        yield from _of_compression(run, magnification)
    if run.moves and records_of(run):
        yield Picture("records", lambda: records(run))


def _fractured(name: str, drawn: Rows, magnification: float | None) -> Picture:
    return Picture(name, lambda: fracture_panels(drawn, magnification),
                   lambda figures: write_counts(figures / f"{name}.csv", drawn))


def _inside(run: Results) -> Iterator[Picture]:
    """Yields the cracks inside of a solid whose contacts can break."""
    if run.frames and run.facts.crack_modes and run.mesh.blocks.dimension == 3:
        yield Picture("cracks_inside", lambda: cracks_inside(run, run.frames[-1]))


def _of_heating(run: Results, magnification: float | None, temperatures: Sequence[float] | None) -> Iterator[Picture]:
    hot = Heated(run)
    if hot.restrained:
        yield Picture("thrust", lambda: thrust(run))
    else:
        yield Picture("total_strain", lambda: total_strain(run))
    yield Picture("heating_cracks", lambda: heating_cracks(run))
    yield Picture("heating_energy", lambda: energy(heating_course(run)))
    if hot.unconverged.any():
        yield Picture("convergence", lambda: convergence(run))
    if hot.heats:
        yield from _of_conduction(run)
    if run.has_fields:
        yield _fractured("heating_fracture", heating_fracture(run, temperatures), magnification)
        if hot.is_last:
            yield from _inside(run)


def _of_records(run: Results, magnification: float | None) -> Iterator[Picture]:
    hot = Heated(run)
    if records_of(run):
        yield Picture("records", lambda: records(run))
        yield Picture("energy", lambda: energy(record_course(run)))
    if hot.unconverged.any():
        yield Picture("convergence", lambda: convergence(run))
    if hot.heats:
        yield from _of_conduction(run)
    if run.has_fields:
        yield _fractured("fracture", record_fracture(run), magnification)
        yield from _inside(run)


def _of_conduction(run: Results) -> Iterator[Picture]:
    profile = read_profile(run)
    yield Picture("temperature_history", lambda: temperature_history(run, profile))
    if run.has_fields:
        yield Picture("temperature", lambda: temperature_field(run))
    if run.facts.of_role(WATER):
        yield Picture("water", lambda: water(run))
        if run.has_fields:
            yield Picture("water_profile", lambda: water_profile(run))
            yield Picture("water_maps", lambda: water_maps(run))
    if run.facts.of_role(SPALLING) and run.has_fields:
        yield Picture("spalling", lambda: spalling(run))
    if profile is not None:
        yield Picture("temperature_profile", lambda: temperature_profile(run, profile))
        if len(profile.isotherm):
            yield Picture("isotherm", lambda: isotherm(run, profile))


def _of_compression(run: Results, magnification: float | None) -> Iterator[Picture]:
    test = Compressed(run)
    marks = select_frames(test.frames, *test.peak) if test.frames else {}
    yield Picture("stress_strain", lambda: stress_strain(run, marks))
    yield Picture("cracks", lambda: cracks(run))
    yield Picture("energy", lambda: energy(loading_course(run)))
    if not run.has_fields:
        return
    if not marks:
        path = run.folder / "fields" / "frames.csv"
        raise Error(f"{path}: no frame of the loading stage; fracture cannot be drawn")
    yield _fractured("fracture", fracture(run, marks), magnification)
    yield from _inside(run)


def draw_run(folder: Path, file_format: str = "png", magnification: float | None = None,
             temperatures: Sequence[float] | None = None, out: Path | None = None,
             only: Sequence[str] = ()) -> Iterator[Path]:
    """Draws all figures of a run into its figures/ folder; yields each path once written. Beside a figure of fracture
    stands a table of its cracks.

    out: folder for all of these in the place of the run's own, which is then only read.

    temperatures [°C]: of the fracture patterns of a heated run, see `heating_fracture`.

    only: names of the figures to draw, such as "energy"; empty: all.

    Of a folder of `pyroclast run --seeds` the one figure is the band of its specimens, seeds.png.

    Raises Error at the end, with a line for each reason, where figures could not be drawn: a run of an older program
    lacks a column that one figure needs, and has those of the others.
    """
    if (folder / "study.toml").is_file() and not (folder / "history.csv").exists():
        yield _draw_seeds(folder, file_format, out)
        return
    run = Results(folder)
    reasons, names = [], []
    try:
        for picture in figures_of(run, magnification, temperatures):
            names.append(picture.name)
            if only and picture.name not in only:
                continue
            place = out or make_folder(run.folder / "figures")
            try:
                if picture.write is not None:
                    place.mkdir(parents=True, exist_ok=True)
                    picture.write(place)
                path = save(picture.draw(), place / f"{picture.name}.{file_format}")
            except Error as error:
                said = str(error)
                reasons.append(said if str(folder) in said else f"{folder}: {picture.name}: {said}")
                continue
            yield path
            gc.collect()  # a figure refers to itself; of a long history it holds much
    except Error as error:
        reasons.append(str(error))
    if unknown := [name for name in only if name not in names]:
        reasons.append(f"{folder}: has no figure {', '.join(unknown)}; its figures are {', '.join(names)}")
    if reasons:
        raise Error("\n".join(dict.fromkeys(reasons)))


def _draw_seeds(folder: Path, file_format: str, out: Path | None) -> Path:
    """Draws the band of the runs of `pyroclast run --seeds` that came to an end; returns the path."""
    method = tomllib.loads((folder / "study.toml").read_text("utf-8")).get("method", {})
    if method.get("kind") != "ensemble":
        raise Error(f"{folder}: is the folder of a study of the kind {method.get('kind')!r}, which "
                    f"`pyroclast study report {shell_path(folder / 'study.toml')}` draws")
    table = folder / "table.csv"
    rows = list(csv.DictReader(table.read_text("utf-8").splitlines())) if table.is_file() else []
    runs = [Results(folder / "runs" / row["run"]) for row in rows if row["state"] in ("done", "no value")]
    if not runs:
        raise Error(f"{folder}: has no finished run yet")
    return save(compare_seeds(runs), (out or make_folder(folder / "figures")) / f"seeds.{file_format}")


def draw_properties(folder: Path, file_format: str = "png") -> Iterator[Path]:
    """Draws the properties over the temperature into the folder's figures/; yields the path once written."""
    table = read_properties(folder / "properties.csv")
    yield save(properties(table), make_folder(folder / "figures") / f"properties.{file_format}")


def draw_specimen(folder: Path, file_format: str = "png") -> Iterator[Path]:
    """Draws the figures of a specimen into its figures/ folder; yields each path once written. A specimen without
    circles has no gradation.
    """
    specimen = SpecimenFolder(folder)
    place = make_folder(specimen.folder / "figures")
    if specimen.aggregates.rows:
        yield save(gradation(specimen), place / f"gradation.{file_format}")
    yield save(morphology(specimen), place / f"morphology.{file_format}")


def draw_plane(folder: Path, axis: str, at: float, file_format: str = "png", magnification: float | None = None,
               frame: int | None = None, out: Path | None = None, colour: str | None = None) -> Iterator[Path]:
    """Draws a plane through a solid into the figures/ folder of its run; yields the path.

    frame: number of a frame; None: the last. out: folder in the place of the run's own, which is then only read.
    colour, magnification: see `plane_section`; None: the material, or the temperature where nothing moves; 1.
    """
    run = Results(folder)
    if not run.has_fields or not run.frames or run.mesh.blocks.dimension != 3:
        raise Error(f"{folder}: a plane is drawn through a solid that keeps frames; this run has none")
    if colour == "material" and not run.moves:
        raise Error(f"{folder}: conducts heat alone, and its planes are drawn by --colour temperature")
    colour = colour or ("material" if run.moves else "temperature")
    if colour == "temperature" and magnification is not None:
        raise Error("--magnification asks for nothing: temperatures are drawn where the body was before it moved")
    found = run.frames[-1:] if frame is None else [one for one in run.frames if one.number == frame]
    if not found:
        raise Error(f"{folder}: has no frame {frame}; its frames are 0 to {run.frames[-1].number}")
    figure = plane_section(run, found[0], axis, at, magnification or 1.0, colour)
    name = f"plane_{axis}_{at:g}{'' if colour == 'material' else '_temperature'}"
    yield save(figure, (out or make_folder(run.folder / "figures")) / f"{name}.{file_format}")


def draw_comparison(folders: Sequence[Path], out: Path, what: str | None = None) -> Iterator[Path]:
    """Draws the curves of several runs into one file, its format by its ending; what: see `compare_runs`."""
    _check_ending(out)
    yield save(compare_runs([Results(folder) for folder in folders], what), out)


def draw_levels(folders: Sequence[Path], out: Path, temperatures: Sequence[float] = LEVEL_TEMPERATURES,
                magnification: float | None = None) -> Iterator[Path]:
    """Draws the fracture patterns of several heated runs into one file, its format by its ending, and beside it
    a table of their cracks.
    """
    _check_ending(out)
    drawn = levels([Results(folder) for folder in folders], temperatures)
    yield save(fracture_panels(drawn, magnification), out)
    write_counts(out.with_suffix(".csv"), drawn)


def _check_ending(out: Path) -> None:
    if out.suffix.lower().lstrip(".") not in _FORMATS:
        raise Error(f"{out}: the file's ending must be one of {', '.join('.' + f for f in _FORMATS)}")


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value


def _width(text: str) -> float:
    """Returns the inches of a length such as 90mm."""
    match = re.fullmatch(r"\s*([0-9]*\.?[0-9]+)\s*(mm|cm|in)\s*", text)
    inches = float(match[1]) / _PER_INCH[match[2]] if match else 0.0
    if not NARROWEST <= inches <= WIDEST:
        raise argparse.ArgumentTypeError(
            f"{text} is not a length from {_PER_INCH['mm'] * NARROWEST:.0f}mm to {_PER_INCH['mm'] * WIDEST:.0f}mm "
            f"with its unit, {', '.join(_PER_INCH)}, such as 90mm")
    return inches


def _share(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError(f"{text} is not a share between 0 and 1")
    return value


def _panel_numbers(text: str) -> list[int]:
    """Returns numbers of panels, or letters: A is 1."""
    try:
        return [ord(part.upper()) - ord("A") + 1 if part.isalpha() and len(part) == 1 else _positive_whole(part)
                for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is not a list of panels like 1,3 or A,D") from None


def _positive_whole(text: str) -> int:
    if (number := int(text)) < 1:
        raise ValueError
    return number


def _temperatures(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is not a list like 300,400,500") from None


def parser() -> argparse.ArgumentParser:
    """Reads the words behind `pyroclast figures`."""
    parser = argparse.ArgumentParser(prog="pyroclast figures",
                                     description="Draws the figures of runs and specimens.")
    commands = parser.add_subparsers(dest="command", required=True)

    run = commands.add_parser("run", help="all figures of a run, or the band of a folder of run --seeds")
    run.add_argument("folder", type=Path, metavar="RUN_DIR")
    run.add_argument("--format", choices=_FORMATS, default="png")
    run.add_argument("--magnification", type=_positive, metavar="FACTOR",
                     help="magnification of displacements in fracture (default: from the last frame, and stated)")
    run.add_argument("--temperatures", type=_temperatures, metavar="T,T,...",
                     help="temperatures of the fracture patterns of a heated run, °C (default: from its frames)")
    run.add_argument("--out", type=Path, metavar="FOLDER",
                     help="folder for the figures; the run is then read only (default: its figures/)")
    run.add_argument("--only", type=lambda text: text.split(","), default=[], metavar="NAME,NAME,...",
                     help="figures to draw, such as energy,fracture (default: all)")
    run.set_defaults(draw=lambda asked: draw_run(asked.folder, asked.format, asked.magnification,
                                                 asked.temperatures, asked.out, asked.only))

    plane = commands.add_parser("plane", help="a plane through a solid, with its cracks or temperatures")
    plane.add_argument("folder", type=Path, metavar="RUN_DIR")
    plane.add_argument("--axis", choices=("x", "y", "z"), default="z", help="axis across the plane (default: z)")
    plane.add_argument("--at", type=_share, default=0.5, metavar="SHARE",
                       help="place of the plane, as a share of the specimen's size along the axis (default: 0.5)")
    plane.add_argument("--colour", choices=COLOURS,
                       help="what the blocks are coloured by (default: material; temperature where nothing moves)")
    plane.add_argument("--magnification", type=_positive, metavar="FACTOR",
                       help="magnification of displacements (default: 1)")
    plane.add_argument("--frame", type=int, metavar="NUMBER", help="frame of the run (default: the last)")
    plane.add_argument("--format", choices=_FORMATS, default="png")
    plane.add_argument("--out", type=Path, metavar="FOLDER",
                       help="folder for the figures; the run is then read only (default: its figures/)")
    plane.set_defaults(draw=lambda asked: draw_plane(asked.folder, asked.axis, asked.at, asked.format,
                                                     asked.magnification, asked.frame, asked.out, asked.colour))

    for name, draw, help_text in (("specimen", draw_specimen, "morphology and gradation of a specimen"),
                                  ("properties", draw_properties, "properties over the temperature")):
        command = commands.add_parser(name, help=help_text)
        command.add_argument("folder", type=Path, metavar="DIR")
        command.add_argument("--format", choices=_FORMATS, default="png")
        command.set_defaults(draw=lambda asked, draw=draw: draw(asked.folder, asked.format))

    comparison = commands.add_parser("compare", help="curves of several runs in one figure")
    comparison.add_argument("folders", type=Path, nargs="+", metavar="RUN_DIR")
    comparison.add_argument("--out", type=Path, required=True, metavar="FILE")
    comparison.add_argument("--what", choices=KINDS, help="kind of curve (default: the first that all runs have)")
    comparison.set_defaults(draw=lambda asked: draw_comparison(asked.folders, asked.out, asked.what))

    patterns = commands.add_parser("levels", help="fracture patterns of several heated runs, a row for each")
    patterns.add_argument("folders", type=Path, nargs="+", metavar="RUN_DIR")
    patterns.add_argument("--out", type=Path, required=True, metavar="FILE")
    patterns.add_argument("--temperatures", type=_temperatures, default=LEVEL_TEMPERATURES, metavar="T,T,...",
                          help="temperatures of the columns before the last frame, °C (default: 300,400,500,600)")
    patterns.add_argument("--magnification", type=_positive, metavar="FACTOR",
                          help="magnification of displacements (default: from the last frames, and stated)")
    patterns.set_defaults(draw=lambda asked: draw_levels(asked.folders, asked.out, asked.temperatures,
                                                         asked.magnification))
    for command in commands.choices.values():
        command.add_argument("--width", type=_width, metavar="LENGTH",
                             help="width of the figures, such as 90mm, with all text of 8 pt, legends in the axes and "
                                  "a height of 4/3 of the width at most (default: a page of two columns, 183mm)")
        command.add_argument("--panels", type=_panel_numbers, default=(), metavar="N,N,...",
                             help="panels to draw of each figure that has several, from the top left: 1,3 or A,D "
                                  "(default: all)")
        command.add_argument("--no-title", action="store_true",
                             help="draw no titles; then say in the caption what they say")
        command.add_argument("--cracks-under-platens", action="store_true",
                             help="draw cracks also where a platen covers them in the picture")
        command.add_argument("--no-table", action="store_true", help="draw no table beside a stress-strain curve")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit code."""
    return run_program(lambda: _draw(parser().parse_args(arguments)), _NAME)


def _draw(asked: argparse.Namespace) -> int:
    gc.freeze()  # collections after each figure look through figures alone, not through all that was imported
    with warnings.catch_warnings():
        warnings.simplefilter("always", GapWarning)
        warnings.showwarning = lambda message, *_: _tell(message)
        try:
            with page_of(asked.width, panels=asked.panels, title=not asked.no_title, table=not asked.no_table,
                         cracks_under_platens=asked.cracks_under_platens):
                for path in asked.draw(asked):
                    say(path)
        except Error as problem:
            _tell(problem)
            return 1
        finally:
            gc.unfreeze()
    return 0


def _tell(what: object) -> None:
    for line in str(what).splitlines():
        complain(line, _NAME)


if __name__ == "__main__":
    sys.exit(main())
