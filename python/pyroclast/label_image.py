"""Images of labels, such as a slice of a CT scan: from arrays and files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import Error

_FILES = (".npy", ".png", ".tif", ".tiff")
_LABEL_MODES = ("1", "L", "P", "I", "F")  # of PIL
_MOST_LABELS = 10  # that a message counts


def pixels_of(image: ArrayLike | str | Path) -> tuple[NDArray[Any], str]:
    """Pixels (rows, columns), and what messages of them begin with."""
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
    return np.asarray(pixels), source


def _read_image(file: Path) -> NDArray[Any]:
    if file.suffix.lower() not in _FILES:
        raise Error(f"{file}: an image is read from {', '.join(_FILES)}; others do not keep labels, or are arrays to "
                    "be read by hand")
    try:
        if file.suffix.lower() == ".npy":
            return np.asarray(np.load(file, allow_pickle=False))
        from PIL import Image
        with Image.open(file) as picture:
            if (pages := getattr(picture, "n_frames", 1)) > 1:
                raise Error(f"{file}: holds {pages} pages; an image is one")
            if picture.mode not in _LABEL_MODES and not picture.mode.startswith("I;16"):
                raise Error(f"{file}: its pixels are {picture.mode}; labels are grey values or numbers of a palette, "
                            "not colours")
            return np.asarray(picture)
    except ImportError:
        raise Error(f"{file}: reading it needs the package PIL (python3-pil); or give an array") from None
    except (OSError, ValueError) as error:
        raise Error(f"{file}: {error.strerror or error if isinstance(error, OSError) else error}") from None


def counted(pixels: NDArray[Any]) -> str:
    """The labels of an image, and how many pixels each has."""
    labels, counts = np.unique(pixels, return_counts=True)
    some = [f"{label!r} ({count} pixel{'' if count == 1 else 's'})"
            for label, count in list(zip(labels.tolist(), counts.tolist()))[:_MOST_LABELS]]
    return f"the label{'' if len(some) == 1 else 's'} {', '.join(some)}" + (
        f" and {len(labels) - len(some)} others" if len(labels) > len(some) else "")
