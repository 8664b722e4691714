"""The values in which decks differ, and names of runs by them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, Union

from .results import Results

DeckPath = tuple[Union[str, int], ...]

_MOST = 3  # differences that a name tells
_TELL_NOTHING = ("title", "output")  # tables and keys that change no result
_PLAIN = ("value", "builtin", "csv", "table")  # keys that say how a value is given, and not of what


def names_by_decks(runs: Sequence[Results]) -> list[str] | None:
    """Returns a name for each run: the values in which their decks differ, such as "E 50 GPa, seed 2".

    None where decks are missing, do not differ, differ in more than three values, or do not tell all runs apart.
    """
    decks = [{path: text for path, text in values_of(run.deck).items() if not tells_nothing(path)}
             for run in runs]
    if not all(decks):
        return None
    differing = differing_keys(decks)
    if not 0 < len(differing) <= _MOST:
        return None
    words = _short(differing)
    names = [", ".join(f"{word} {deck[key]}" if key in deck else f"no {word}" for key, word in zip(differing, words))
             for deck in decks]
    return names if len(set(names)) == len(names) else None


def values_of(deck: Any) -> dict[DeckPath, str]:
    """Returns the text of each value of a deck, by its path: keys, and numbers of tables of a list."""
    return dict(_values(deck))


def differing_keys(decks: Sequence[dict[DeckPath, str]]) -> list[DeckPath]:
    """Returns the keys whose values are not the same in all, or that some do not have; in the order of the decks."""
    keys = dict.fromkeys(key for deck in decks for key in deck)
    return [key for key in keys if len({deck.get(key) for deck in decks}) > 1]


def written(path: DeckPath) -> str:
    """Returns a path as messages have it, such as "stages[1].duration"."""
    text = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in path)
    return text.removeprefix(".")


def tells_nothing(path: DeckPath) -> bool:
    """Returns whether a value changes no result."""
    return path[0] in _TELL_NOTHING


def _values(node: Any, path: DeckPath = ()) -> Iterator[tuple[DeckPath, str]]:
    if isinstance(node, dict):
        for key, value in node.items():
            yield from _values(value, (*path, str(key)))
    elif isinstance(node, list) and any(isinstance(value, dict) for value in node):
        for number, value in enumerate(node):
            yield from _values(value, (*path, number))
    else:
        yield path, _text(node)


def _text(value: Any) -> str:
    if isinstance(value, list):
        return "[" + ", ".join(map(_text, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _short(paths: Sequence[DeckPath]) -> list[str]:
    """Returns the last word of each path, with that before it where two have the same."""
    told = [path[:-1] if path[-1] in _PLAIN and len(path) > 1 else path for path in paths]
    lasts = Counter(path[-1] for path in told)
    return [str(path[-1]) if lasts[path[-1]] == 1 else " ".join(map(str, path[-2:])) for path in told]
