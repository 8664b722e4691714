"""Pictures of bodies in space: a quarter cut away, planes through them, and the cracks inside."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from ..errors import Error
from ..stored.cut import Plane, Polygons, joined, outline, section, surface, traces, without_corner
from ..stored.mesh import BlockMesh, Mesh, specimen_box
from ..stored.frames import Frame
from ..stored.results import Results
from ..stored.spalled import blocks_at
from . import style
from .crack_styles import can_crack, crack_legend, cracked, cracks_of, material_legend
from .fields import colours_of, draw_colour_bar, draw_field

_DARKEST = 0.62  # of a colour on a face that is seen from the side
_GHOST = 0.035  # opacity of the body around its cracks
_TENTHS = 10
_IN_PLANE = {"x": (2, 1), "y": (0, 2), "z": (0, 1)}
"""Axes to the right and upwards in the picture of a plane, by the axis across it."""
_NEAR = 3e-7  # of the size of a body: a point so near to a side lies on it
_WALL = 1e-3  # of the size of a body: what lies so far behind its surface is a wall of a hole or notch
_EDGE = 1e-3  # of the size of a body: a cut so narrow is an edge
_HOTTER = 0.05  # of the span of temperatures, and 1 K: a side is hotter than the one across by more
_OF_TRIAD = 0.13  # of the width of a body, length of the axes in its picture
_WITHIN = 1e-6
"""Share of the size of a body by which planes stand within its ends, where they cut its blocks and not a bearing."""


@dataclass(frozen=True)
class View:
    """Parallel projection along a direction, with y upwards."""

    towards_eye: np.ndarray  #: (3,), a unit vector

    @property
    def right(self) -> np.ndarray:
        """Direction (3,) to the right in the picture."""
        sideways = np.cross([0.0, 1.0, 0.0], self.towards_eye)
        return sideways / np.linalg.norm(sideways)

    @property
    def up(self) -> np.ndarray:
        """Direction (3,) upwards in the picture."""
        return np.cross(self.towards_eye, self.right)

    def flat(self, points: np.ndarray) -> np.ndarray:
        """Returns (..., 2), m: places in the picture."""
        return np.stack([points @ self.right, points @ self.up], axis=-1)


VIEW = View(np.array([0.60, 0.42, 0.68]) / np.linalg.norm([0.60, 0.42, 0.68]))
"""The view from the right, above and behind: x goes to the right, y upwards, and z towards the eye."""


def view_of(run: Results) -> View:
    """Returns the view from the sides of a body that are hotter than those across, at the frame with the hottest mean;
    of sides that are alike, as `VIEW` has it.
    """
    blocks = run.mesh.blocks
    frames = [frame for frame in run.frames if frame.temperature is not None and np.isfinite(frame.temperature)]
    if blocks.dimension == 2 or not frames:
        return VIEW
    field = run.gridpoint_temperature(max(frames, key=lambda frame: frame.temperature or 0.0))
    zones, weights = blocks.zones[~blocks.of_bearing], blocks.sizes[~blocks.of_bearing]
    heat, middles = field[zones].mean(axis=1), blocks.points[zones].mean(axis=1)
    middles = middles - np.average(middles, axis=0, weights=weights)
    low, high = specimen_box(blocks)
    # of the straight line over each axis that is nearest to the field
    rise = (high - low) * ((weights * heat) @ middles) / (weights @ middles**2)
    return View(np.where(rise < -max(_HOTTER * np.ptp(heat), 1.0), -1.0, 1.0) * VIEW.towards_eye)


def flat(points: np.ndarray, view: View = VIEW) -> np.ndarray:
    """Returns (..., 2), m: places in a picture, of points of the plane or of space."""
    return view.flat(points) if points.shape[-1] == 3 else points


def middle_planes(blocks: BlockMesh, at: tuple[float, float] = (0.5, 0.5), view: View = VIEW) -> tuple[Plane, Plane]:
    """Returns planes across x and across z, through the specimen's middle or at other shares of its width and depth;
    the eye is above both.
    """
    low, high = specimen_box(blocks)
    place = low + np.array([at[0], 0.0, at[1]]) * (high - low)
    first, second = (Plane(np.eye(3)[axis], float(place[axis])) for axis in (0, 2))
    return (first if view.towards_eye[0] > 0.0 else first.other_way,
            second if view.towards_eye[2] > 0.0 else second.other_way)


def _fills(blocks: BlockMesh) -> np.ndarray:
    """Returns (materials, 3): the colour of each."""
    return np.array([to_rgb(c) for c in style.phase_colours(blocks.materials, blocks.bearing_materials)])


def _seen(blocks: BlockMesh, view: View, points: np.ndarray | None = None) -> tuple[Polygons, np.ndarray]:
    """Returns polygons of a body without the quarter towards the eye that face the eye, the farthest first, and by how
    much their colours (P,) darken where they are seen from the side. points: as of `surface`.
    """
    whole, cuts = without_corner(blocks, middle_planes(blocks, view=view), points)
    away = cuts.area_vectors @ view.towards_eye < 0.0
    towards = Polygons(np.where(away[:, None, None], cuts.corners[:, ::-1], cuts.corners), cuts.owner)
    polygons = joined([whole, towards])
    normals = polygons.area_vectors
    area = np.linalg.norm(normals, axis=1)
    facing = np.divide(normals @ view.towards_eye, area, out=np.zeros_like(area), where=area > 0.0)
    seen = np.flatnonzero(facing > 0.0)
    seen = seen[np.argsort(polygons.corners[seen].mean(axis=1) @ view.towards_eye, kind="stable")]
    return polygons.of(seen), _DARKEST + (1.0 - _DARKEST) * facing[seen]


def _fill(axes: Axes, corners: np.ndarray, colours: np.ndarray) -> None:
    """Fills polygons (P, K, 2), m, each with its colour (P, 3 or 4), in turn."""
    axes.add_collection(PolyCollection(style.MILLI * corners, facecolors=colours, edgecolors=colours, linewidths=0.3,
                                       rasterized=True))


def fill_cut_open(axes: Axes, blocks: BlockMesh, points: np.ndarray, rgb: np.ndarray, view: View = VIEW) -> None:
    """Fills the zones of the body, each with its colour (Z, 3), without the quarter towards the eye."""
    polygons, shade = _seen(blocks, view, points)
    _fill(axes, view.flat(polygons.corners), shade[:, None] * rgb[polygons.owner])


def draw_cut_open(axes: Axes, blocks: BlockMesh, points: np.ndarray, edge: str | None = None,
                  view: View = VIEW) -> None:
    """Draws the body by material, without the quarter towards the eye.

    points: (N, 3), places of the gridpoints, m.
    """
    fill_cut_open(axes, blocks, points, _fills(blocks)[blocks.material], view)
    if edge is not None:
        lines = np.concatenate([_outer_edges(blocks, points, view), *_seams(blocks, points, view)])
        axes.add_collection(LineCollection(style.MILLI * view.flat(lines), colors=edge, linewidths=0.2,
                                           rasterized=True))
    draw_triad(axes, blocks, view)


def _outer_edges(blocks: BlockMesh, points: np.ndarray, view: View) -> np.ndarray:
    """Returns (L, 2, 3), m: edges between blocks on the sides that face the eye, without the quarter."""
    outer = outline(blocks, points)
    facing = outer.area_vectors @ view.towards_eye > 0.0
    facing[facing] = ~_is_hidden(outline(blocks).of(np.flatnonzero(facing)), blocks, view)
    corners, block = outer.corners[facing], blocks.block[outer.owner[facing]]
    start, end = corners.reshape(-1, 3), np.roll(corners, -1, axis=1).reshape(-1, 3)
    middle = np.round(0.5 * (start + end) / (1e-7 * np.ptp(blocks.points))).astype(np.int64)
    _, place, count = np.unique(np.c_[middle, np.repeat(block, 3)], axis=0, return_inverse=True, return_counts=True)
    alone = count[place.ravel()] == 1  # an edge within a block is that of two of its triangles
    return _outside_quarter(np.stack([start, end], axis=1)[alone], blocks, view)


def _is_hidden(facing: Polygons, blocks: BlockMesh, view: View) -> np.ndarray:
    """Returns (T,) bool, of triangles of the outline that face the eye: the body hides their middle, as it may hide the
    walls of holes and notches.
    """
    vectors, middles = facing.area_vectors, facing.corners.mean(axis=1)
    near = _WALL * float(np.ptp(blocks.points, axis=0).max())
    vertices = np.unique(facing.corners.reshape(-1, 3), axis=0)
    highest = np.einsum("ij,ij->i", vectors, facing.corners[:, 0]) + near * np.linalg.norm(vectors, axis=1)
    hidden = np.zeros(len(middles), bool)
    for some in np.array_split(np.arange(len(middles)), len(middles) // 200 + 1):
        hidden[some] = (vertices @ vectors[some].T).max(axis=0) > highest[some]  # may be hidden
    if not hidden.any():
        return hidden
    polygons, _ = _seen(blocks, view)
    before = polygons.corners.reshape(-1, 3)[polygons.triangles]
    corners, vectors = view.flat(before), Polygons(before, np.arange(len(before))).area_vectors
    depth, facing_eye = np.einsum("ij,ij->i", vectors, before[:, 0]), vectors @ view.towards_eye
    sides = np.roll(corners, -1, axis=1) - corners
    for wall in np.flatnonzero(hidden):
        there = view.flat(middles[wall]) - corners
        holds = (sides[..., 0] * there[..., 1] - sides[..., 1] * there[..., 0] > 0.0).all(axis=1)
        along = (depth[holds] - vectors[holds] @ middles[wall]) / facing_eye[holds]  # from the middle to the eye
        hidden[wall] = bool((along > near).any())
    return hidden


def _seams(blocks: BlockMesh, points: np.ndarray, view: View) -> Iterator[np.ndarray]:
    """Yields (L, 2, 3), m: lines in which the two planes of the quarter cut the sides of blocks."""
    sides = surface(blocks, points).corners
    quads = np.concatenate([sides, sides[:, -1:]], axis=1)
    first, second = middle_planes(blocks, view=view)
    for plane, other in ((first, second), (second, first)):
        lines, _ = traces(quads, plane)
        yield lines[(other.above(lines) > 0.0).all(axis=1)]


def _outside_quarter(lines: np.ndarray, blocks: BlockMesh, view: View) -> np.ndarray:
    first, second = middle_planes(blocks, view=view)
    middles = lines.mean(axis=1)
    return lines[~((first.above(middles) > 0.0) & (second.above(middles) > 0.0))]


def crack_lines(mesh: Mesh, cells: np.ndarray, which: np.ndarray, view: View = VIEW) -> np.ndarray:
    """Returns (L, 2, 3), m: where chosen contacts show on the sides and cuts of `draw_cut_open`. Of a plane body these
    are the chosen cells, (L, 2, 2).

    cells: (C, 4, 3), in the plane (C, 2, 2), places of the corners of contacts' cells, m. which: (C,) bool.
    """
    if cells.shape[-1] == 2:
        return cells[which]
    chosen = np.flatnonzero(which)
    if not len(chosen):
        return np.zeros((0, 2, 3))
    first, second = middle_planes(mesh.blocks, view=view)
    lines = []
    for plane, other in ((first, second), (second, first)):
        cut, _ = traces(cells[chosen], plane)
        lines.append(cut[(other.above(cut) > 0.0).all(axis=1)])
    # on the sides: the halves of the edges beside the contact point
    halves = np.concatenate([cells[chosen][:, [0, end]] for end in (1, 3)])
    at = mesh.contacts.points[mesh.contacts.cells[chosen]]
    middles = np.concatenate([0.5 * (at[:, 0] + at[:, end]) for end in (1, 3)])
    lines.append(_outside_quarter(halves[_lies_on_visible_side(mesh.blocks, middles, view)], mesh.blocks, view))
    return np.concatenate(lines)


def _lies_on_visible_side(blocks: BlockMesh, points: np.ndarray, view: View) -> np.ndarray:
    """Returns (n,) bool, of points in the reference configuration: on a side that faces the eye."""
    outer = outline(blocks)
    vectors = outer.area_vectors
    normals = vectors / np.linalg.norm(vectors, axis=1)[:, None]
    offsets = np.einsum("ij,ij->i", normals, outer.corners[:, 0])
    size = float(np.ptp(blocks.points, axis=0).max())
    facing = normals @ view.towards_eye > 0.0
    planes = np.unique(np.round(np.c_[normals, offsets / size][facing], 7), axis=0)
    lies = np.zeros(len(points), bool)
    for plane in planes:
        lies |= np.abs(points @ plane[:3] - plane[3] * size) < _NEAR * size
    return lies if style.page().has_covered else lies & ~_touches_bearing(blocks, points, _NEAR * size)


def _touches_bearing(blocks: BlockMesh, points: np.ndarray, within: float) -> np.ndarray:
    """Returns (n,) bool, of points in the reference configuration: on a zone of a bearing, by its box."""
    corners = blocks.points[blocks.zones[blocks.of_bearing]]
    touches = np.zeros(len(points), bool)
    for low, high in zip(corners.min(axis=1) - within, corners.max(axis=1) + within):
        touches |= ((points >= low) & (points <= high)).all(axis=1)
    return touches


def draw_triad(axes: Axes, blocks: BlockMesh, view: View = VIEW) -> None:
    """Draws where x, y and z go, below on the left."""
    points = view.flat(blocks.points)
    low, width = points.min(axis=0), np.ptp(points[:, 0])
    length = _OF_TRIAD * np.ptp(blocks.points[:, 0])
    start = low + np.array([-0.02, -0.07]) * width
    size = style.page().size(6.5)
    for axis, name in enumerate("xyz"):
        way = view.flat(length * np.eye(3)[axis])
        tip = style.MILLI * (start + way)
        axes.annotate("", tip, style.MILLI * start, annotation_clip=False,
                      arrowprops={"arrowstyle": "->", "linewidth": 0.7, "shrinkA": 0.0, "shrinkB": 0.0})
        axes.annotate(name, tip, 0.6 * size * way / np.linalg.norm(way), textcoords="offset points", fontsize=size,
                      ha="center", va="center", annotation_clip=False)


@dataclass(frozen=True)
class CrackFaces:
    """Contact points of a solid that are damaged, without those of bearings."""

    cells: np.ndarray  #: (n, 4, 3), corners in the reference configuration, m
    normal: np.ndarray  #: (n, 3), unit vectors, in either sense
    area: np.ndarray  #: (n,), m²
    damage: np.ndarray  #: (n,), the largest of any mode, 0 to 1
    mode: np.ndarray  #: (n,), the mode of that damage, "tension", "shear" or "mixed"

    def of(self, which: np.ndarray) -> CrackFaces:
        return CrackFaces(*(values[which] for values in (self.cells, self.normal, self.area, self.damage, self.mode)))

    @property
    def inclination(self) -> np.ndarray:
        """Inclination (n,), degrees, of the normal from the horizontal, 0 for an upright crack."""
        return np.degrees(np.arcsin(np.clip(np.abs(self.normal[:, 1]), 0.0, 1.0)))

    def upright_share(self, within: float = 30.0) -> float:
        """Returns the share of area with normals within an angle [degrees] of the horizontal; NaN without cracks."""
        return self._share(self.inclination <= within)

    def facing_share(self, axis: int, within: float = 30.0) -> float:
        """Returns the share of the area whose normals are within an angle of an axis, degrees; NaN without cracks."""
        return self._share(np.degrees(np.arccos(np.clip(np.abs(self.normal[:, axis]), 0.0, 1.0))) <= within)

    def _share(self, which: np.ndarray) -> float:
        whole = self.area.sum()
        return float(self.area[which].sum() / whole) if whole > 0.0 else float("nan")

    def damage_by_height(self, low: float, high: float, parts: int = _TENTHS) -> np.ndarray:
        """Returns (parts,): damaged area, each by its damage, over that of all, from the bottom up."""
        height = self.cells[:, 0, 1]
        sums, _ = np.histogram(height, bins=parts, range=(low, high), weights=self.area * self.damage)
        return sums / sums.sum() if sums.sum() > 0.0 else sums


def crack_faces(run: Results, frame: Frame, least: float = 0.0) -> CrackFaces:
    """Takes contact points of a solid whose damage is above `least`: none where no law of its contacts has a damage."""
    contacts = run.mesh.contacts
    modes = list(run.facts.crack_modes) or ["tension"]
    values = np.array([run.contact_field(frame, f"{mode}_damage [1]") for mode in run.facts.crack_modes]
                      or [np.zeros(len(contacts.cells))])
    interfaces = {name for names in run.facts.crack_modes.values() for name in names}
    largest = values.max(axis=0)
    which = can_crack(run, interfaces) & (largest > least)
    cells = contacts.points[contacts.cells[which]]
    across = np.cross(cells[:, 2] - cells[:, 0], cells[:, 3] - cells[:, 1])
    size = np.linalg.norm(across, axis=1)
    normal = np.divide(across, size[:, None], out=np.zeros_like(across), where=size[:, None] > 0.0)
    return CrackFaces(cells, normal, contacts.extent[which], largest[which],
                      np.array(modes)[values.argmax(axis=0)[which]])


@style.in_style
def cracks_inside(run: Results, frame: Frame, least: float = 0.5) -> Figure:
    """Draws the crack faces inside the ghost of the body, the rose and the inclination of their normals, and damage by
    height.

    least: damage from which a contact point is drawn, and counted in rose and inclination.
    """
    blocks = run.mesh.blocks
    drawn, all_damaged = crack_faces(run, frame, least), crack_faces(run, frame)
    ghost = outline(blocks)
    view = view_of(run)
    box = view.flat(blocks.points)
    ratio = np.ptp(box[:, 1]) / np.ptp(box[:, 0])
    figure, axes, (rose, inclination, heights) = _axes_inside(0.55 * style.page().width * min(ratio, 1.7))
    colours = {"tension": style.TENSION_COLOUR, "shear": style.SHEAR_COLOUR, "mixed": style.MIXED_COLOUR}
    axes.add_collection(PolyCollection(style.MILLI * view.flat(ghost.corners), facecolors=style.BLACK, alpha=_GHOST,
                                       edgecolors="none", rasterized=True))
    order = np.argsort(drawn.cells.mean(axis=1) @ view.towards_eye, kind="stable")
    facing = np.abs(drawn.normal @ view.towards_eye)
    shades = np.array([to_rgb(colours[mode]) for mode in drawn.mode]).reshape(-1, 3)
    shades = shades * (_DARKEST + (1.0 - _DARKEST) * facing)[:, None]
    axes.add_collection(PolyCollection(style.MILLI * view.flat(drawn.cells[order]), facecolors=shades[order],
                                       edgecolors="none", rasterized=True))
    draw_triad(axes, blocks, view)
    _frame(axes, box)
    column = style.page().is_column
    told = (style.page().said("crack faces, damaged by more than ", "faces with $D$ > ") if len(drawn.area) else
            style.page().said("no crack face is damaged by more than ", "no face with $D$ > ")) + f"{least:g}"
    if not column or not len(drawn.area):
        axes.set_title(told, fontsize=style.page().size(8.0))
    for mode in dict.fromkeys(drawn.mode.tolist()):
        axes.plot([], [], color=colours[mode], linewidth=4.0, label=mode)
    if len(drawn.area):
        above = {"loc": "upper left"}
        if column:
            above = {"title": told, "loc": "lower center", "bbox_to_anchor": (0.5, 1.0)}
        axes.legend(**above, title_fontsize=style.COLUMN_TEXT)
    _draw_rose(rose, drawn)
    _draw_inclination(inclination, drawn)
    _draw_heights(heights, all_damaged, blocks)
    figure.suptitle(style.title_of(run), fontsize=style.page().size(9.0))
    style.number(figure, [axes, rose, inclination, heights])
    return figure


def _axes_inside(height: float) -> tuple[Figure, Axes, tuple[Axes, Axes, Axes]]:
    """Makes a figure with axes for the body, and for rose, inclination and heights beside it."""
    figure = style.new_figure(style.page().highest if style.page().is_column else height + 0.5)
    grid = figure.add_gridspec(3, 2, width_ratios=[1.0 if style.page().is_column else 1.25, 1.0])
    places = [grid[:, 0], grid[0, 1], grid[1, 1], grid[2, 1]]
    rose = figure.add_subplot(places[1], projection="polar")
    return figure, figure.add_subplot(places[0]), (rose, figure.add_subplot(places[2]), figure.add_subplot(places[3]))


def _frame(axes: Axes, box: np.ndarray) -> None:
    margin = 0.08 * np.ptp(box[:, 0])
    low, high = style.MILLI * (box.min(axis=0) - margin), style.MILLI * (box.max(axis=0) + margin)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.axis("off")


def _draw_rose(axes: Axes, faces: CrackFaces) -> None:
    """Draws the area by the azimuth of the normal, in either sense."""
    azimuth = np.arctan2(faces.normal[:, 2], faces.normal[:, 0])
    both = np.concatenate([azimuth, azimuth + np.pi]) % (2.0 * np.pi)
    sums, edges = np.histogram(both, bins=24, range=(0.0, 2.0 * np.pi), weights=np.tile(faces.area, 2))
    axes.bar(edges[:-1], sums / max(sums.max(), 1e-300), width=np.diff(edges), align="edge", color=style.BLUE,
             edgecolor="white", linewidth=0.3)
    axes.set_yticks([])
    axes.set_xticks(np.radians([0, 90, 180, 270]))
    axes.set_xticklabels(["x", "z", "−x", "−z"], fontsize=style.page().size(6.5))
    axes.set_title(style.page().said("normals around the vertical, by area", "normals around y, by area"),
                   fontsize=style.page().size(7.0))


def _draw_inclination(axes: Axes, faces: CrackFaces) -> None:
    bins = np.linspace(0.0, 90.0, 10)
    sums, _ = np.histogram(faces.inclination, bins=bins, weights=faces.area)
    of_any = np.sin(np.radians(bins[1:])) - np.sin(np.radians(bins[:-1]))
    share = sums / sums.sum() if sums.sum() > 0.0 else sums
    axes.bar(bins[:-1], share, width=10.0, align="edge", color=style.BLUE, edgecolor="white", linewidth=0.3)
    axes.step(bins, [*of_any, of_any[-1]], where="post", color=style.BLACK, linewidth=0.9,
              label=style.page().said("if all ways alike", "all ways alike"))
    axes.set_xlim(0.0, 90.0)
    axes.set_xticks([0, 30, 60, 90])
    axes.set_xlabel("normal from the horizontal [°]", fontsize=style.page().size(7.0))
    axes.set_ylabel("share of area", fontsize=style.page().size(7.0))
    axes.set_ylim(top=(1.8 if style.page().is_column else 1.35) * max(*share, *of_any))
    axes.legend(loc="upper right", fontsize=style.page().size(6.5))


def _draw_heights(axes: Axes, faces: CrackFaces, blocks: BlockMesh) -> None:
    low, high = (corner[1] for corner in specimen_box(blocks))
    share = faces.damage_by_height(low, high)
    heights = style.MILLI * np.linspace(low, high, len(share) + 1)
    axes.barh(heights[:-1], share, height=np.diff(heights), align="edge", color=style.BLUE, edgecolor="white",
              linewidth=0.3)
    axes.set_ylabel("height [mm]", fontsize=style.page().size(7.0))
    axes.set_xlabel("share of the area, by its damage $D>0$", fontsize=style.page().size(7.0))


COLOURS = ("material", "temperature")
"""What a plane through a solid can be coloured by."""


@style.in_style
def plane_section(run: Results, frame: Frame, axis: str, at: float = 0.5, magnification: float = 1.0,
                  colour: str = "material") -> Figure:
    """Draws a plane through a solid at a frame.

    axis: "x", "y" or "z", across which the plane stands. at: its place, as a share of the specimen's size along the
    axis before it moved, 0 and 1 for its ends. colour: "material", with the cracks of each mode that the plane meets,
    or "temperature", with isotherms, where the body was before it moved. magnification: of displacements. The picture
    is as large as the specimen is along the other axes. Raises Error for another axis, share or colour.
    """
    blocks = blocks_at(run, frame)
    if axis not in _IN_PLANE:
        raise Error(f"axis is {axis!r}; it must be one of {', '.join(_IN_PLANE)}")
    if not 0.0 <= at <= 1.0:
        raise Error(f"at is {at:g}; a plane stands at a share between 0 and 1 of the specimen's size along {axis}")
    if colour not in COLOURS:
        raise Error(f"colour is {colour!r}; it must be one of {', '.join(COLOURS)}")
    named, plane = (axis_plane(blocks, axis, share) for share in (at, min(max(at, _WITHIN), 1.0 - _WITHIN)))
    is_heat = colour == "temperature"
    points = blocks.points
    if not is_heat:  # the plane goes with the body: only displacements along it move what it shows
        points = points + magnification * plane.along(run.gridpoint_displacement(frame))
    in_plane = list(_IN_PLANE[axis])
    cut = section(blocks, plane, points)
    shown = cut.corners[..., in_plane]
    extent = np.concatenate([shown.reshape(-1, 2), np.array(specimen_box(blocks))[:, in_plane]])
    low, high = extent.min(axis=0), extent.max(axis=0)
    ratio = min((high - low)[1] / (high - low)[0], 2.2)
    figure = style.new_figure(0.9 + 3.6 * ratio if is_heat else 1.6 + 4.0 * ratio, width=5.0)
    if is_heat:
        axes = figure.subplots()
        field = run.gridpoint_temperature(frame)
        colours = colours_of([field[np.unique(blocks.zones[~blocks.of_bearing])]])
        _draw_temperature(axes, blocks, field, colours, cut, shown, np.ones(len(shown)))
        draw_colour_bar([axes], colours)
    else:
        axes, below = figure.subplots(2, 1, gridspec_kw={"height_ratios": [1.0, 0.16]})
        _fill(axes, shown, _fills(blocks)[blocks.material[cut.owner]])
        _draw_traces(axes, run, frame, plane, magnification, in_plane)
        handles = crack_legend(run) + material_legend(blocks, cut.owner, "platen" if run.has_platens else "bearing")
        style.legend_alone(below, handles, [handle.get_label() for handle in handles], loc="center",
                           ncol=1 if style.page().is_column else 2)
    axes.update_datalim(style.MILLI * np.array([low, high]))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel(f"{'xyz'[in_plane[0]]} [mm]")
    axes.set_ylabel(f"{'xyz'[in_plane[1]]} [mm]")
    told = f"{axis} = {style.MILLI * named.offset:.4g} mm, frame {frame.number}"
    if is_heat and frame.minutes is not None:
        told += f", {frame.minutes:.3g} min"
    elif not is_heat:
        told += f", strain {style.PER_MILLE * frame.strain:.2f}×10⁻³" if np.isfinite(frame.strain) else ""
        told += f", displacements ×{magnification:g}"
    if np.ptp(shown.reshape(-1, 2), axis=0).min() < _EDGE * (high - low).min():
        told += ", where the body ends in an edge"
    axes.set_title("\n".join([style.title_of(run), *style.lines_of(told, style.page().letters)]),
                   fontsize=style.page().size(8.0))
    return figure


def _draw_traces(axes: Axes, run: Results, frame: Frame, plane: Plane, magnification: float,
                 in_plane: list[int]) -> None:
    """Draws the cracks of each mode that a plane meets."""
    contacts = run.mesh.contacts
    cells = (contacts.points + magnification * plane.along(run.contact_displacement(frame)))[contacts.cells]
    for crack in cracks_of(run):
        lines, _ = traces(cells[cracked(run, frame, crack)], plane)
        axes.add_collection(LineCollection(style.MILLI * lines[..., in_plane], colors=crack.colour,
                                           linewidths=crack.width, capstyle="round", rasterized=True))


def axis_plane(blocks: BlockMesh, axis: str, share: float = 0.5) -> Plane:
    """Returns a plane across an axis, "x", "y" or "z", at a share of the specimen's size along it.

    Raises KeyError for another axis.
    """
    number = {"x": 0, "y": 1, "z": 2}[axis]
    low, high = (corner[number] for corner in specimen_box(blocks))
    return Plane(np.eye(3)[number], float(low + share * (high - low)))


def _at_corners(polygons: Polygons, blocks: BlockMesh, field: np.ndarray) -> np.ndarray:
    """Returns (P, K): a field of gridpoints at the corners of polygons, each linear in the zone that it is of."""
    zones = blocks.zones[polygons.owner]
    at = blocks.points[zones]
    edges = np.swapaxes(at[:, 1:] - at[:, :1], 1, 2)
    share = np.linalg.solve(edges, np.swapaxes(polygons.corners - at[:, :1], 1, 2))
    values = field[zones]
    inside = values[:, :1] + np.einsum("pi,pik->pk", values[:, 1:] - values[:, :1], share)
    return np.clip(inside, values.min(axis=1)[:, None], values.max(axis=1)[:, None])


def _draw_temperature(axes: Axes, blocks: BlockMesh, field: np.ndarray, colours: ScalarMappable, polygons: Polygons,
                      shown: np.ndarray, shade: np.ndarray) -> None:
    """Draws polygons by the temperature within, with isotherms; bearings in the colour of platens.

    field: (N,), °C, of gridpoints. shown: (P, K, 2), m: corners in the picture. shade: (P,), factors on colours.
    """
    of_bearing = blocks.of_bearing[polygons.owner]
    _fill(axes, shown[of_bearing], shade[of_bearing, None] * np.array(to_rgb(style.PLATEN_COLOUR)))
    warm = polygons.of(~of_bearing)
    draw_field(axes, colours, warm.corners.reshape(-1, 3), warm.triangles, _at_corners(warm, blocks, field).ravel(),
               shown[~of_bearing].reshape(-1, 2), np.repeat(shade[~of_bearing], warm.corners.shape[1] - 2))


def draw_temperature_cut_open(axes: Axes, blocks: BlockMesh, field: np.ndarray, colours: ScalarMappable,
                              view: View) -> None:
    """Draws the temperature of a body without the quarter towards the eye, with isotherms. field: (N,), °C."""
    polygons, shade = _seen(blocks, view)
    _draw_temperature(axes, blocks, field, colours, polygons, view.flat(polygons.corners), shade)
    draw_triad(axes, blocks, view)
