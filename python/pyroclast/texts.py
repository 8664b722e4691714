"""Texts of others, which may hold anything, as readers may see them."""

import unicodedata


def seen(text: str, kept: str = "\n\t") -> str:
    """Returns a text in which characters that would act unseen are written out, such as \\x1b. Blanks of any width
    stay. kept: others that stay.
    """
    return "".join(c if c.isprintable() or unicodedata.category(c) == "Zs" or c in kept
                   else c.encode("unicode_escape").decode() for c in text)


def seen_on_a_line(text: str) -> str:
    """Returns a text as `seen` does, with line breaks and tabs written out too."""
    return seen(text, "")
