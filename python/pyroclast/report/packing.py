"""Arrays of numbers as text for a page: whole steps, differences, bytes apart, deflate, base 64.

page/packing.js reads them. An array of frames holds differences from frame to frame, any other from row to row: both
are small where neighbours are alike. Sums of differences wrap around, so that a difference needs no more bits than a
value.
"""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

_LEVEL = 6  # of deflate: 9 takes four times as long for 1 % less
_LARGEST = {1: 127, 2: 32767, 4: 2**31 - 1}  # steps that so many bytes hold


def packed_steps(values: np.ndarray, step: float, size: int = 2) -> dict[str, Any]:
    """Packs values as whole steps in `size` bytes each (1, 2 or 4), differences along the first dimension.

    The step becomes larger where so few bytes would not hold the largest value. What is kept differs from the values
    by half a step at most. Values that are not finite count as 0.
    """
    values = np.nan_to_num(np.asarray(values, dtype=float), nan=0.0, posinf=0.0, neginf=0.0)
    largest = float(np.abs(values).max()) if values.size else 0.0
    step = max(step, largest / (_LARGEST[size] - 0.5))
    return {**packed_whole(np.rint(values / step), size), "step": step}


def packed_whole(values: np.ndarray, size: int) -> dict[str, Any]:
    """Packs whole numbers in `size` bytes each, differences along the first dimension."""
    kind = np.dtype(f"<i{size}")
    whole = np.ascontiguousarray(values).astype(np.int64).astype(kind)  # wraps around
    change = whole.copy()
    if len(whole):
        change[1:] -= whole[:-1]
    # 0, -1, 1, -2, 2 ... become 0, 1, 2, 3, 4 ...: the upper bytes of small differences are zero
    turned = np.where(change < 0, ~(change << 1), change << 1)
    return {"bytes": size, "shape": list(whole.shape), "data": _text_of(turned)}


def packed_floats(values: np.ndarray) -> dict[str, Any]:
    """Packs numbers in single precision, NaN among them."""
    values = np.ascontiguousarray(values, dtype="<f4")
    return {"bytes": 0, "shape": list(values.shape), "data": _text_of(values)}


def _text_of(values: np.ndarray) -> str:
    apart = values.reshape(-1).view(np.uint8).reshape(-1, values.itemsize).T
    return base64.b64encode(zlib.compress(np.ascontiguousarray(apart).tobytes(), _LEVEL)).decode("ascii")


def unpacked(array: dict[str, Any]) -> np.ndarray:
    """Returns what a page reads: of `packed_steps` the values, else the numbers themselves."""
    raw = np.frombuffer(zlib.decompress(base64.b64decode(array["data"])), np.uint8)
    size = array["bytes"] or 4
    apart = np.ascontiguousarray(raw.reshape(size, -1).T)
    if not array["bytes"]:
        return apart.view("<f4").reshape(array["shape"])
    turned = apart.view(f"<u{size}").astype(np.int64).reshape(array["shape"])
    change = (turned >> 1) ^ -(turned & 1)
    whole = np.cumsum(change, axis=0).astype(f"<i{size}") if len(change) else change
    return whole * array["step"] if "step" in array else whole
