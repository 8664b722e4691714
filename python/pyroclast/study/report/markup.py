"""HTML in which every text is escaped, unless it was made here."""

from __future__ import annotations

import base64
import html


class Markup(str):
    """Text that is HTML already."""


def element(name: str, *inside: str, **attributes: str) -> Markup:
    """An element; texts inside and attributes are escaped. `class_` is `class`."""
    said = "".join(f' {key.rstrip("_")}="{html.escape(value)}"' for key, value in attributes.items())
    return Markup(f"<{name}{said}>{together(*inside)}</{name}>")


def together(*inside: str) -> Markup:
    """One after the other; texts are escaped."""
    return Markup("".join(part if isinstance(part, Markup) else html.escape(part) for part in inside))


def picture(png: bytes, alt: str) -> Markup:
    """An image within the page."""
    data = base64.b64encode(png).decode("ascii")
    return Markup(f'<img alt="{html.escape(alt)}" src="data:image/png;base64,{data}">')
