"""Stages written in Python."""

from __future__ import annotations

import json
from typing import Any, ClassVar, NamedTuple

from .._core import Body
from ..errors import Error


class Verdict(NamedTuple):
    """What a stage says of the sample that was just taken."""

    over: bool = False  #: the stage is over
    last: bool = False  #: and the run with it
    frame: bool = False  #: the fields are worth keeping; they are at the end of a stage anyhow


class Key:
    """A key of a stage's table in the deck. In the class it stands under the key's name, and in a stage its value does.

    unit: SI unit of a quantity, which a deck writes with any unit of that dimension ("m/s"; of temperature "degC");
        "1" for a number, "integer" or "text".
    default: the value where the deck says nothing, in that unit; None: the deck must say it.
    """

    def __init__(self, unit: str, meaning: str, default: float | str | None = None):
        self.unit, self.meaning, self.default = unit, meaning, default
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, stage: object | None, owner: type | None = None) -> Any:
        if stage is None:
            return self
        return stage.__dict__[self.name]

    def __set__(self, stage: object, value: object) -> None:
        stage.__dict__[self.name] = value


class Stage:
    """Something that is done to a body until its verdict says that it is over; a deck asks for it by its kind.

    A run calls `begin`, then `advance` again and again until a sample is due, takes the sample, and asks `judge`. The
    body is lent for the time of a call. All is SI, temperatures in degC. A class is handed to a deck by
    `Deck(..., stages_in_python=[Mine])`, and must be made without arguments.

    Its runs are not reproducible from the deck alone: summary and manifest say so. Between two batches a stage is what
    `state` returns. Without that, a checkpoint or a copy in its middle is refused.
    """

    kind: ClassVar[str] = ""
    meaning: ClassVar[str] = "a stage written in Python"
    columns: ClassVar[dict[str, str]] = {}
    """Columns of its own in the history, with their units; the unit is the end of a name too, where there is one."""

    def begin(self, body: Body) -> None:
        """Prepares what acts on the body; moves nothing."""

    def advance(self, body: Body, most_steps: int) -> bool:
        """Moves on by at most so many steps; True when a sample is due."""
        raise NotImplementedError(f"stage {self.kind!r} has no advance()")

    def judge(self, body: Body) -> Verdict:
        """Judges each sample that `advance` asked for."""
        raise NotImplementedError(f"stage {self.kind!r} has no judge()")

    def progress(self) -> float:
        """Returns the share that is done, 0 to 1, as far as it can be foreseen."""
        return 0.0

    def values(self) -> list[float]:
        """Returns the values at a sample, in the order of `columns`."""
        return []

    def results(self) -> dict[str, float]:
        """Returns numbers for the summary, by names with their units at the end: {"loss_J": 3.0}."""
        return {}

    def state(self) -> dict[str, Any] | None:
        """Returns all that lasts from one batch to the next, as JSON can hold it; None: it cannot be told."""
        return None

    def take_state(self, state: dict[str, Any]) -> None:
        """Puts back what `state` told."""

    @classmethod
    def _keys(cls) -> list[Key]:
        return [key for owner in reversed(cls.__mro__) for key in vars(owner).values() if isinstance(key, Key)]

    def _state_text(self) -> str:
        state = self.state()
        if state is None:
            raise Error(f"stage {self.kind!r} does not tell its state, so in its middle there is no checkpoint and no "
                        "copy: give its class state() and take_state()")
        return json.dumps(state)

    def _take_state_text(self, text: str) -> None:
        if text:
            self.take_state(json.loads(text))
