"""What stands on a page: sections of texts, figures and tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure


@dataclass(frozen=True)
class Shown:
    """A figure. name: of its files. caption: what it shows, and how it is to be read."""

    name: str
    figure: Figure
    caption: str


HOW_TO_READ = "How to read it"
"""Title of a section that tells no finding."""


@dataclass(frozen=True)
class PageTable:
    """Texts in rows under a head. faint: rows that stand back, by their numbers."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""
    faint: frozenset[int] = frozenset()


@dataclass(frozen=True)
class Section:
    """A part of a page."""

    title: str
    texts: Sequence[str] = ()
    figures: Sequence[Shown] = ()
    tables: Sequence[PageTable] = ()


def nothing(title: str, why: str) -> Section:
    """Makes a section in the place of what could not be found."""
    return Section(title, [f"Nothing is said of this yet: {why}."])


def how_to_read(meaning: str) -> Section:
    """Returns what the numbers of a method mean, once for all outputs."""
    return Section(HOW_TO_READ, [meaning])
