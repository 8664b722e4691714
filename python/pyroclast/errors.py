"""What goes wrong, with the same texts and places as in the program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Diagnostic:
    """One thing that is wrong with a deck, or that it is warned of."""

    file: str  #: as it was named; "--set" where it was a change
    line: int  #: from 1; 0 if it is the file's as a whole
    column: int  #: from 1, in characters
    key: str  #: full path, such as "contacts.mortar_mortar.f_t"; may be empty
    value: str  #: as written in the deck; may be empty
    message: str  #: what is wrong and what is allowed
    hint: str  #: what is probably meant; may be empty
    text: str  #: all of it on a line, as the program prints it

    def __str__(self) -> str:
        return self.text


class Error(Exception):
    """Something cannot be done, or a file is missing or malformed; the text says what, where and why."""


class CodeNotAllowed(Error):
    """A deck or a study names code that may not run before the user allows it."""


class DeckError(Error):
    """Everything that is wrong with a deck, a line each."""

    def __init__(self, diagnostics: Sequence[Diagnostic]):
        super().__init__("\n".join(map(str, diagnostics)))
        self.diagnostics = list(diagnostics)

    def __reduce__(self) -> tuple[type[DeckError], tuple[list[Diagnostic]]]:
        return DeckError, (self.diagnostics,)
