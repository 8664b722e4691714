"""HTML in which every text is escaped, unless it was made here."""

from __future__ import annotations

import base64
import html

from ..texts import seen


class Markup(str):
    """Text that is HTML already; Jinja2 knows it by its method."""

    def __html__(self) -> str:
        return str(self)


def element(name: str, *inside: str, **attributes: str) -> Markup:
    """Returns an element; texts inside and attributes are escaped. `class_` is `class`."""
    said = "".join(f' {key.rstrip("_").replace("_", "-")}="{html.escape(value)}"' for key, value in attributes.items())
    return Markup(f"<{name}{said}>{together(*inside)}</{name}>")


def together(*inside: str) -> Markup:
    """Joins pieces one after the other; texts are escaped, with what cannot be seen written out."""
    return Markup("".join(part if isinstance(part, Markup) else html.escape(seen(part)) for part in inside))


def picture(png: bytes, alt: str, width: int | None = None) -> Markup:
    """Returns an image within the page; width: in its pixels, the picture's own where it is not said."""
    data = base64.b64encode(png).decode("ascii")
    wide = f' width="{width}"' if width else ""
    return Markup(f'<img alt="{html.escape(seen(alt))}"{wide} src="data:image/png;base64,{data}">')
