"""Runs and results as notebooks show them: the one module that knows both them and their figures."""

from __future__ import annotations

_SECTIONS = {"Results": "draw_last_frame", "Run": "draw_body"}
"""Functions of `draw.notebook` that draw a specimen, by the name of the class whose it is."""


def give_pictures(of: type) -> None:
    """Gives `Results` or `Run` the methods by which a notebook shows an object; they load Matplotlib when called."""
    section = _SECTIONS[of.__name__]

    def png(self: object) -> bytes:
        from .draw import notebook

        return notebook.png_of(self, getattr(notebook, section))

    def html(self: object) -> str:
        from .draw import notebook

        return notebook.html_of(self, getattr(notebook, section))

    setattr(of, "_repr_png_", png)
    setattr(of, "_repr_html_", html)
