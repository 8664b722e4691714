"""A body and its frames in as much room as a page has."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ..stored.frames import Frame
from ..stored.results import Results
from .plane_body import PackedBody, body_of
from .solid_body import solid_body_of

_TEXT_OF_BLOCK, _TEXT_OF_RIGID_BLOCK, _TEXT_OF_POLYHEDRON = 22.0, 11.0, 40.0
"""Characters of a page for each block and frame: the most that was measured."""


def fitted(run: Results, most: int, needed: Callable[[Frame], bool]) -> PackedBody:
    """Packs a body into about so many characters at most: where all is too much with rigid blocks, and then with fewer
    frames.

    needed: frames that are kept before others. Tells what was left out.
    """
    frames = run.frames
    blocks = len(np.unique(run.mesh.blocks.block))
    if run.mesh.blocks.dimension == 3:
        text, pack = _TEXT_OF_POLYHEDRON, solid_body_of
    elif run.moves and blocks * len(frames) * _TEXT_OF_BLOCK > most:
        text, pack = _TEXT_OF_RIGID_BLOCK, lambda run, frames: body_of(run, frames, rigid=True)
    else:
        text, pack = _TEXT_OF_BLOCK, body_of
    room = max(2, int(most / (blocks * text)))
    while True:
        chosen = chosen_frames(frames, room, needed)
        body = pack(run, chosen)
        if len(chosen) < len(frames):
            body.notes.append(f"the page keeps {len(chosen)} of {len(frames)} frames")
        if body.size <= 1.05 * most or len(chosen) <= 2:
            return body
        room = max(2, min(int(room * most / body.size), len(chosen) - 1))


def chosen_frames(frames: Sequence[Frame], most: int, needed: Callable[[Frame], bool]) -> list[Frame]:
    """Chooses so many of the frames at most: the first and the last, needed ones, and others evenly between them."""
    if len(frames) <= most:
        return list(frames)
    ends = [0, len(frames) - 1]
    wanted = [*ends, *(i for i, frame in enumerate(frames) if needed(frame) and i not in ends)][:most]
    for i in np.linspace(0, len(frames) - 1, most).round().astype(int).tolist():
        if len(wanted) < most and i not in wanted:
            wanted.append(i)
    return [frames[i] for i in sorted(wanted)]
