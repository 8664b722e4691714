"""What contacts lost to cracks below the mesh, by laws that remember the load under which they were heated."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..errors import Error
from .results import Results

FIELD = "lost_strength [1]"
# faces by the angle between them and y, the direction of a load by platens
DIRECTIONS = {"along y": (0.0, 30.0), "leaning": (30.0, 60.0), "across y": (60.0, 90.0)}


class LostStrength(NamedTuple):
    """Mean over the contacts of an interface whose faces have a direction, weighted by their length or area."""

    interface: str
    direction: str  #: a key of DIRECTIONS
    share: float  #: of strength


def lost_strength(run: Results) -> list[LostStrength]:
    """Returns the means in the last frame; none of a run without fields, or without a law that remembers its load."""
    if not run.has_fields or not run.frames or not run.moves:
        return []
    try:
        lost = run.contact_field(run.frames[-1], FIELD)
    except Error:
        return []
    contacts = run.mesh.contacts
    angle = contacts.angle
    means = []
    for kind, interface in enumerate(contacts.interfaces):
        if not lost[contacts.interface == kind].any():
            continue  # of another law, or nothing has been lost yet
        for direction, (least, most) in DIRECTIONS.items():
            there = (contacts.interface == kind) & (angle >= least) & ((angle < most) | (most == 90.0))
            if contacts.extent[there].sum() > 0.0:
                share = np.average(lost[there], weights=contacts.extent[there])
                means.append(LostStrength(interface, direction, float(share)))
    return means
