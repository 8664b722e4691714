"""Numbers with units, for decks: `5 * MPa`, `10 * K / minute`."""

from __future__ import annotations

from .. import _core
from ..errors import Error


class Quantity:
    """A number with a unit. Decks take it wherever they take a text such as "5 MPa"."""

    __slots__ = ("powers", "value")

    def __init__(self, value: float, unit: str | dict[str, int]):
        self.value = float(value)
        self.powers = {unit: 1} if isinstance(unit, str) else {name: n for name, n in unit.items() if n}

    @property
    def unit(self) -> str:
        """Unit as decks write it: "MPa", "K min-1"; "1" without any."""
        return " ".join(name if n == 1 else f"{name}{n}" for name, n in self.powers.items()) or "1"

    def to(self, unit: str) -> float:
        """Returns the value in another unit of its dimension; a temperature in "degC". Raises Error for another."""
        return _core.convert(str(self), unit)

    def __str__(self) -> str:
        return repr(self.value) if not self.powers else f"{self.value!r} {self.unit}"

    def __repr__(self) -> str:
        return f"Quantity({self.value!r}, {self.unit!r})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Quantity) and (self.value, self.powers) == (other.value, other.powers)

    def __hash__(self) -> int:
        return hash((self.value, frozenset(self.powers.items())))

    def __mul__(self, other: Quantity | float) -> Quantity:
        return self._with(other, 1)

    __rmul__ = __mul__

    def __truediv__(self, other: Quantity | float) -> Quantity:
        return self._with(other, -1)

    def __rtruediv__(self, other: float) -> Quantity:
        return Quantity(other / self.value, {name: -n for name, n in self.powers.items()})

    def __pow__(self, power: int) -> Quantity:
        return Quantity(self.value**power, {name: n * power for name, n in self.powers.items()})

    def __neg__(self) -> Quantity:
        return Quantity(-self.value, self.powers)

    def _with(self, other: Quantity | float, sign: int) -> Quantity:
        if not isinstance(other, Quantity):
            return Quantity(self.value * other**sign, self.powers)
        powers = dict(self.powers)
        for name, n in other.powers.items():
            powers[name] = powers.get(name, 0) + sign * n
        return Quantity(self.value * other.value**sign, powers)


def in_si(value: Quantity | str | float, unit: str) -> float:
    """Returns a value in an SI unit, of temperature in degC: a number is taken to be in it already."""
    return float(value) if isinstance(value, (int, float)) else _core.convert(str(value), unit)


def length(name: str, value: object, example: str, *, is_size: bool = True) -> float:
    """Returns a length in m; that of a size is positive. Raises Error, which names it, for a number without a unit."""
    if not isinstance(value, (str, Quantity)):
        in_metres = f'; if it is in m, say "{value} m"' if isinstance(value, (int, float)) else ""
        raise Error(f'{name}: a unit of length is needed, e.g. "{example}"; got {value!r}{in_metres}')
    try:
        metres = _core.convert(str(value), "m")
    except Error as error:
        raise Error(f"{name}: {error}") from None
    if is_size and not metres > 0.0:
        raise Error(f"{name} is {value}; it must be greater than 0")
    return metres


m, cm, mm, um = (Quantity(1.0, name) for name in ("m", "cm", "mm", "um"))
s, ms, minute, hour = (Quantity(1.0, name) for name in ("s", "ms", "min", "h"))
K, degC, degree = (Quantity(1.0, name) for name in ("K", "degC", "deg"))
Pa, kPa, MPa, GPa = (Quantity(1.0, name) for name in ("Pa", "kPa", "MPa", "GPa"))
N, kN, MN = (Quantity(1.0, name) for name in ("N", "kN", "MN"))
J, kJ, W, kW = (Quantity(1.0, name) for name in ("J", "kJ", "W", "kW"))
kg, percent = (Quantity(1.0, name) for name in ("kg", "%"))
