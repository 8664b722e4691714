"""Images of labels, such as a slice of a CT scan: from arrays and files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import Error

_FILES = (".npy", ".png", ".tif", ".tiff")
_FORMATS = ("PNG", "TIFF")  # of PIL
_LABEL_MODES = ("1", "L", "P", "I", "F")  # of PIL
_MOST_LABELS = 10  # that a message counts
_EXACT = 2.0**53  # below it a float tells whole numbers apart
_SEVERAL = (range, tuple, frozenset)  # types of keys that name several labels


def pixels_of(image: ArrayLike | str | Path) -> tuple[NDArray[Any], str]:
    """Returns pixels (rows, columns), whole numbers or texts, and what messages of them begin with."""
    source = ""
    if isinstance(image, (str, Path)):
        source = f"{image}: "
        pixels = _read_image(Path(image))
    else:
        pixels = np.asanyarray(image)
    if pixels.ndim != 2 or not pixels.size:
        raise Error(f"{source}an image must be (rows, columns) of labels, not {pixels.shape}"
                    + ("" if pixels.ndim != 3 else "; the last may be its colours" if pixels.shape[2] in (3, 4) else
                       "; blocks are made of a slice, not of a body in space"))
    masked = np.broadcast_to(getattr(pixels, "mask", False), pixels.shape)
    for hidden, word, remedy in ((masked, "masked", "image.filled(label)"),
                                 (np.isnan(pixels) & ~masked if pixels.dtype.kind == "f" else None, "NaN",
                                  "np.where(np.isnan(image), label, image)")):
        if hidden is not None and np.any(hidden):
            row, column = np.argwhere(np.asarray(hidden))[0]
            count = np.count_nonzero(hidden)
            raise Error(f"{source}{count} of {pixels.size} pixels {'is' if count == 1 else 'are'} {word}, the first is "
                        f"[{row}, {column}]; give them a label of their own: {remedy}")
    return _whole(np.asarray(pixels), source), source


def _whole(pixels: NDArray[Any], source: str) -> NDArray[Any]:
    """Returns the pixels as whole numbers; texts stay. Raises Error for other numbers."""
    if pixels.dtype.kind in "biuU":
        return pixels
    if pixels.dtype.kind != "f":
        raise Error(f"{source}the pixels are of the type {pixels.dtype}; labels are whole numbers or texts")
    odd = (np.abs(pixels) >= _EXACT) | (pixels != np.floor(pixels))
    if odd.any():
        row, column = np.argwhere(odd)[0]
        count = np.count_nonzero(odd)
        raise Error(f"{source}pixel [{row}, {column}] is {pixels[row, column]:.6g}, but labels must be whole numbers; "
                    f"{count} of {pixels.size} pixels {'is none' if count == 1 else 'are none'}. Number what the image "
                    "shows: np.digitize(image, bounds) numbers grey values between bounds")
    return pixels.astype(np.int64)


def _read_image(file: Path) -> NDArray[Any]:
    if file.suffix.lower() not in _FILES:
        raise Error(f"{file}: an image is read from {', '.join(_FILES)}; others do not keep labels, or are arrays to "
                    "be read by hand")
    try:
        if file.suffix.lower() == ".npy":
            return np.asarray(np.load(file, allow_pickle=False))
        from PIL import Image, ImageOps
        with Image.open(file) as picture:
            if picture.format not in _FORMATS:
                raise Error(f"{file}: it holds {picture.format}; labels are read from {' and '.join(_FORMATS)}")
            if (pages := getattr(picture, "n_frames", 1)) > 1:
                raise Error(f"{file}: holds {pages} pages; an image is one")
            if picture.mode not in _LABEL_MODES and not picture.mode.startswith("I;16"):
                raise Error(f"{file}: its pixels are {picture.mode}; labels are grey values or numbers of a palette, "
                            "not colours")
            picture.load()  # PIL turns a TIFF by its tag Orientation here, and knows its size only then
            return np.asarray(picture if picture.format == "TIFF" else ImageOps.exif_transpose(picture))
    except ImportError:
        raise Error(f"{file}: reading it needs the package PIL (python3-pil); or give an array") from None
    except (OSError, ValueError) as error:
        raise Error(f"{file}: {error.strerror or error if isinstance(error, OSError) else error}") from None


def numbered(pixels: NDArray[Any]) -> tuple[list[Any], NDArray[Any]]:
    """Returns the labels of an image in ascending order, and each pixel's place among them (rows, columns)."""
    labels, place = np.unique(pixels, return_inverse=True)
    return labels.tolist(), place.reshape(pixels.shape)


def keys_of(labels: list[Any], place: NDArray[Any], phases: Mapping[Any, Any], source: str) -> list[Any]:
    """Returns for each label of an image the key of `phases` that stands for it: the label, several labels that hold
    it, or `...`.

    Raises Error where a label has none, or two.
    """
    several = [key for key in phases if isinstance(key, _SEVERAL)]
    keys = []
    for label in labels:
        own = [label] if label in phases else []
        own += [key for key in several if label in key]
        if len(own) > 1:
            raise Error(f"phases names the label {label!r} twice: by {own[0]!r} and by {own[1]!r}")
        keys.append(own[0] if own else ... if ... in phases else None)
    if None in keys:
        nameless = np.array([key is None for key in keys])[place]
        row, column = np.argwhere(nameless)[0]
        named = ", ".join("..." if key is ... else repr(key) for key in phases)
        raise Error(f"{source}pixel [{row}, {column}] has the label {labels[place[row, column]]!r}, for which there is "
                    f"no phase; {np.count_nonzero(nameless)} of {place.size} pixels have none. The image has "
                    f"{counted(labels, place)}; phases has {named or 'none'}. A key of phases is a label, a range or a "
                    "tuple of labels, or ... for all others")
    return keys


def are_of_stones(keys: list[Any], phases: Mapping[Any, Any]) -> NDArray[Any]:
    """Tells of each key whether its labels are stones: whether `phases` names several labels of that phase."""
    of = [phases[key] for key in phases]
    return np.array([phases[key] is not None and (key is ... or isinstance(key, _SEVERAL) or of.count(phases[key]) > 1)
                     for key in keys])


def counted(labels: list[Any], place: NDArray[Any]) -> str:
    """Returns the labels of an image, and how many pixels each has, for a message."""
    counts = np.bincount(place.ravel()).tolist()
    some = [f"{label!r} ({count} pixel{'' if count == 1 else 's'})"
            for label, count in list(zip(labels, counts))[:_MOST_LABELS]]
    return f"the label{'' if len(some) == 1 else 's'} {', '.join(some)}" + (
        f" and {len(labels) - len(some)} others" if len(labels) > len(some) else "")
