"""Blocks that have left the body of a run."""

from __future__ import annotations

from .files import read_array
from .frames import Frame
from .mesh import BlockMesh
from .results import Results
from .run_facts import SPALLING


def blocks_at(run: Results, frame: Frame) -> BlockMesh:
    """Returns the blocks of the mesh without those that have left the body by a frame, with all gridpoints."""
    blocks = run.mesh.blocks
    if not run.facts.of_role(SPALLING):
        return blocks
    gone = read_array(run.folder / "fields" / f"blocks_{frame.number:04d}.hdf", "VTKHDF/CellData/gone [1]",
                      (len(blocks.zones),)) > 0.5
    return blocks.of(~gone) if gone.any() else blocks
