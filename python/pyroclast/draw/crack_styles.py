"""How cracks are drawn: colours and widths by their mode, and which contact points a frame shows so."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..stored.mesh import BlockMesh
from ..stored.frames import Frame
from ..stored.results import Results
from . import style

_HALF = 0.5  # damage from which a crack is drawn


@dataclass(frozen=True)
class CrackStyle:
    mode: str
    broken: bool
    colour: str
    width: float  # points, at most

    @property
    def label(self) -> str:
        return f"{self.mode}, " + (style.page().said("broken ($D=1$)", "broken") if self.broken else
                                   style.page().said(f"damaged (${_HALF}<D<1$)", f"${_HALF}<D<1$"))

    def holds(self, damage: np.ndarray) -> np.ndarray:
        return damage >= 1.0 if self.broken else (damage > _HALF) & (damage < 1.0)


# Drawn in this order: where a contact broke in both modes, tension is drawn on shear, see `fractures`.
CRACKS = (
    CrackStyle("mixed", False, style.MIXED_TINT, 0.7),
    CrackStyle("shear", False, style.SHEAR_TINT, 0.7),
    CrackStyle("tension", False, style.TENSION_TINT, 0.7),
    CrackStyle("mixed", True, style.MIXED_COLOUR, 1.8),
    CrackStyle("shear", True, style.SHEAR_COLOUR, 1.8),
    CrackStyle("tension", True, style.TENSION_COLOUR, 1.8),
)


def can_crack(run: Results, interfaces: Collection[str]) -> np.ndarray:
    """Returns (C,) bool: contact points of these interfaces."""
    contacts = run.mesh.contacts
    return np.isin(contacts.interface, [i for i, name in enumerate(contacts.interfaces) if name in interfaces])


def cracked(run: Results, frame: Frame, crack: CrackStyle) -> np.ndarray:
    """Returns (C,) bool: contact points that are drawn so."""
    damage = run.contact_field(frame, f"{crack.mode}_damage [1]")
    return can_crack(run, run.facts.crack_modes[crack.mode]) & crack.holds(damage)


def count_cracks(run: Results, frame: Frame) -> dict[tuple[str, bool], int]:
    """Counts the cracked contact points of a figure, by mode (of `RunFacts.crack_modes`) and whether broken."""
    return {(crack.mode, crack.broken): int(cracked(run, frame, crack).sum()) for crack in cracks_of(run)}


def size_of_cracks(run: Results, frame: Frame) -> dict[tuple[str, bool], float]:
    """Returns the length [m], in space area [m²], of the contact points that `count_cracks` counts."""
    extent = run.mesh.contacts.extent
    return {(crack.mode, crack.broken): float(extent[cracked(run, frame, crack)].sum()) for crack in cracks_of(run)}


def cracks_of(run: Results) -> list[CrackStyle]:
    return [crack for crack in CRACKS if crack.mode in run.facts.crack_modes]


def crack_legend(run: Results) -> list[Artist]:
    """Returns a handle for each way in which the run's cracks are drawn."""
    return [Line2D([], [], color=crack.colour, linewidth=crack.width, label=crack.label) for crack in cracks_of(run)]


def material_legend(blocks: BlockMesh, zones: np.ndarray | None = None, bearing: str = "platen") -> list[Artist]:
    """Returns a handle for each material of some zones; None: of all. bearing: the name of bearings without one."""
    shown = blocks.material if zones is None else blocks.material[zones]
    colours = style.phase_colours(blocks.materials, blocks.bearing_materials)
    names = [bearing if kind in blocks.bearing_materials and name == "platen" else name
             for kind, name in enumerate(blocks.materials)]
    return [Patch(facecolor=colour, edgecolor=style.FAINT, linewidth=0.4, label=name)
            for kind, (name, colour) in enumerate(zip(names, colours)) if (shown == kind).any()]
