"""Heat through a wall with a gap along its faces, in one dimension: what cases/delamination_heat.toml is compared with.

Explicit finite volumes of even width, written apart from the library: its own curves of EN 1992-1-2, its own fire and
its own gap. The gap lies between two volumes; its faces have temperatures of their own.
"""

import math

import numpy as np

STEFAN_BOLTZMANN = 5.670374419e-8  # W/(m2 K4)
ZERO = 273.15


def iso834(t: float) -> float:
    """Gas temperature, degC, at a time in s."""
    return 20.0 + 345.0 * math.log10(8.0 * t / 60.0 + 1.0)


def conductivity(T):
    """Lower limit of EN 1992-1-2:2004 3.3.3, W/(m K)."""
    return 1.36 - 0.136 * T / 100.0 + 0.0057 * (T / 100.0) ** 2


def heat_capacity(T, density: float = 2300.0):
    """EN 1992-1-2:2004 3.3.2 with 1.5 % of moisture, per volume, J/(m3 K)."""
    return density * np.interp(T, [20.0, 100.0, 100.001, 115.0, 200.0, 400.0, 1200.0],
                               [900.0, 900.0, 1470.0, 1470.0, 1000.0, 1100.0, 1100.0])


def air(T: float) -> float:
    """Conductivity of air, W/(m K), by Sutherland's law."""
    return 0.0241 * ((T + ZERO) / 273.0) ** 1.5 * (273.0 + 194.0) / (T + ZERO + 194.0)


def gap_conductance(width: float, a: float, b: float, emissivity: float = 0.9, jump_distance: float = 2e-7) -> float:
    """Between two faces, W/(m2 K)."""
    A, B = a + ZERO, b + ZERO
    radiation = STEFAN_BOLTZMANN / (2.0 / emissivity - 1.0) * (A * A + B * B) * (A + B)
    return air(0.5 * (a + b)) / (width + jump_distance) + radiation


def temperatures(gap: float | None, until: float, at: list[float], length: float = 0.1, gap_at: float = 0.02,
                 dx: float = 5e-4) -> list[float]:
    """Of a wall in the ISO 834 fire, degC, at depths (m) after a time (s).

    gap: its width, m; None: there is none
    """
    cells = round(length / dx)
    T = np.full(cells, 20.0)
    before = round(gap_at / dx) - 1
    steps = math.ceil(until / (0.35 * dx * dx * 2300.0 * 900.0 / 1.36))
    dt = until / steps
    q = np.zeros(cells + 1)
    for step in range(steps):
        gas = iso834(step * dt)
        k = conductivity(T)
        q[1:-1] = (T[:-1] - T[1:]) * 2.0 / dx / (1.0 / k[:-1] + 1.0 / k[1:])
        if gap is not None:  # the faces of the gap follow from the flux through it
            flux = q[before + 1] if step == 0 else gap_flux
            half = 0.5 * dx / k[before], 0.5 * dx / k[before + 1]
            for _ in range(3):
                h = gap_conductance(gap, T[before] - flux * half[0], T[before + 1] + flux * half[1])
                flux = (T[before] - T[before + 1]) / (half[0] + half[1] + 1.0 / h)
            gap_flux = q[before + 1] = flux
        face = T[0]
        for _ in range(4):  # likewise of the heated face
            q[0] = 25.0 * (gas - face) + 0.7 * STEFAN_BOLTZMANN * ((gas + ZERO) ** 4 - (face + ZERO) ** 4)
            slope = 25.0 + 4.0 * 0.7 * STEFAN_BOLTZMANN * (face + ZERO) ** 3
            face += (q[0] - 2.0 * k[0] / dx * (face - T[0])) / (slope + 2.0 * k[0] / dx)
        q[0] = 2.0 * k[0] / dx * (face - T[0])
        q[-1] = (T[-1] - 20.0) / (1.0 / 9.0 + 0.5 * dx / k[-1])
        T = T + dt / dx * (q[:-1] - q[1:]) / heat_capacity(T)
    middle = (np.arange(cells) + 0.5) * dx
    values = []
    for depth in at:
        side = slice(None) if gap is None else slice(before + 1) if depth < gap_at else slice(before + 1, None)
        values.append(float(np.interp(depth, middle[side], T[side])))
    return values
