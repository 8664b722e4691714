"""Opens the folder of a run in ParaView: the specimen coloured, its cracks as lines, both deformed. The half of a
solid towards the eye is cut away, and all its cracks are faces.

    pvpython scripts/paraview_run.py RUN [--magnification 20] [--save picture.png]

In the Python shell of ParaView's window:

    import sys; sys.path.append("scripts"); import paraview_run; paraview_run.show("RUN")

docs/lookup/fields.md lists the arrays.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

DISPLACEMENT, TEMPERATURE, MATERIAL, CRACK = "displacement [m]", "temperature [degC]", "material", "crack [1]"
CRACKED = 0.5  # damage from which a contact is drawn as a crack
MAGNIFICATION = 20.0
TOWARDS_EYE = (0.45, 0.35, 1.0)  # of a solid: x goes to the right, y upwards, as in its figures


class Missing(Exception):
    """A file of the run is not there, or not readable; one line says which."""


def series_of(run: Path) -> dict[str, Path]:
    """The series of frames that the run has: "blocks", and "contacts" where the body moves. Throws Missing."""
    found = {}
    for part in ("blocks", "contacts"):
        path = run / "fields" / f"{part}.hdf.series"
        if part == "contacts" and not path.exists():
            continue
        try:
            files = json.loads(path.read_text(encoding="utf-8"))["files"]
            missing = [file["name"] for file in files if not (path.parent / file["name"]).exists()]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise Missing(f"{path}: cannot be read ({error})") from error
        if missing:
            raise Missing(f"{path.parent / missing[0]}: is not there, but {path.name} names it")
        found[part] = path
    return found


def show(run: str | Path, magnification: float = MAGNIFICATION):
    """Adds the run to the active view, at its last frame, and returns the view.

    magnification: of displacements.
    """
    from paraview import simple  # pylint: disable=import-outside-toplevel

    series = series_of(Path(run))
    view = simple.GetActiveViewOrCreate("RenderView")
    moves = "contacts" in series

    def deformed(source):
        if not moves:
            return source
        return simple.WarpByVector(Input=source, Vectors=["POINTS", DISPLACEMENT], ScaleFactor=magnification)

    whole = simple.OpenDataFile(str(series["blocks"]))
    blocks = deformed(whole)
    whole.UpdatePipeline()
    bounds = whole.GetDataInformation().GetBounds()
    middle = [0.5 * (bounds[i] + bounds[i + 1]) for i in (0, 2, 4)]
    is_solid = bounds[5] > bounds[4]
    if is_solid:
        blocks = simple.Clip(Input=blocks, ClipType="Plane", Invert=1)
        blocks.ClipType.Origin, blocks.ClipType.Normal = middle, [0.0, 0.0, 1.0]
    shown = simple.Show(blocks, view)
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    simple.GetAnimationScene().GoToLast()
    low, high = blocks.PointData[TEMPERATURE].GetRange()
    coloured = ("POINTS", TEMPERATURE) if high - low > 1.0 else ("CELLS", MATERIAL)
    simple.ColorBy(shown, coloured)
    shown.RescaleTransferFunctionToDataRange(False, True)
    shown.SetScalarBarVisibility(view, coloured[1] == TEMPERATURE)
    if moves:
        contacts = simple.OpenDataFile(str(series["contacts"]))
        cracks = simple.Threshold(Input=contacts, Scalars=["CELLS", CRACK], UpperThreshold=CRACKED,
                                  ThresholdMethod="Above Upper Threshold")
        lines = simple.Show(deformed(cracks), view)
        lines.ColorArrayName = ["CELLS", ""]  # one colour; ColorBy(lines, None) fails in ParaView 5.11
        lines.AmbientColor = lines.DiffuseColor = [0.84, 0.37, 0.0]
        lines.LineWidth = 3.0
    view.InteractionMode = "3D" if is_solid else "2D"
    if is_solid:
        view.CameraFocalPoint = middle
        view.CameraPosition = [at + along for at, along in zip(middle, TOWARDS_EYE)]
        view.CameraViewUp = [0.0, 1.0, 0.0]
    simple.ResetCamera(view)
    simple.Render(view)
    return view


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(description="Opens the folder of a run in ParaView.")
    parser.add_argument("run", type=Path, metavar="RUN")
    parser.add_argument("--magnification", type=float, default=MAGNIFICATION, help="of displacements")
    parser.add_argument("--save", type=Path, metavar="FILE", help="write a picture instead of opening a window")
    asked = parser.parse_args()
    try:
        view = show(asked.run, asked.magnification)
    except Missing as problem:
        print(f"paraview_run: {problem}", file=sys.stderr)
        return 1
    except ImportError:
        print("paraview_run: run it by pvpython, or in ParaView's Python shell", file=sys.stderr)
        return 1
    from paraview import simple  # pylint: disable=import-outside-toplevel

    if asked.save:
        simple.SaveScreenshot(str(asked.save), view, ImageResolution=[1200, 1200],
                              OverrideColorPalette="WhiteBackground")
    else:
        simple.Interact(view)
    return 0


if __name__ == "__main__":
    # ParaView 5.11 crashes in sys.exit once something was rendered
    if code := main():
        sys.exit(code)
