"""What compression runs at room temperature are held against. Compression positive."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class CompressionValues:
    """Macroscopic response in uniaxial compression."""

    modulus: float  #: E, GPa
    strength: float  #: f_c, MPa
    inelastic_strain: float  #: eps_ic, strain at the peak less f_c / E

    @property
    def strain_at_peak(self) -> float:
        return self.strength / (1e3 * self.modulus) + self.inelastic_strain


# Table 3 of the paper.
EXPERIMENT = CompressionValues(modulus=21.5, strength=35.0, inelastic_strain=0.0015)
PAPER_DEM = CompressionValues(modulus=21.59, strength=34.30, inelastic_strain=0.00139)

AT_MODULUS = 21.5e3
"""E of the Anderberg and Thelandersson concrete, MPa (paper, section 3.2)."""
AT_STRENGTH = 35.0
"""f_c, MPa (paper, section 3.2)."""
AT_DESCENT = -880.0
"""Slope of the descending line, MPa. As commonly quoted; not checked against the original report."""

_AT_STRAIN_AT_PEAK = 2.0 * AT_STRENGTH / AT_MODULUS
_AT_STRAIN_AT_TANGENT = _AT_STRAIN_AT_PEAK * (1.0 - AT_DESCENT / AT_MODULUS)


def _parabola(strain):
    ratio = strain / _AT_STRAIN_AT_PEAK
    return AT_STRENGTH * ratio * (2.0 - ratio)


AT_LAST_STRAIN = _AT_STRAIN_AT_TANGENT - _parabola(_AT_STRAIN_AT_TANGENT) / AT_DESCENT
"""Strain at which the descending line reaches zero stress."""


def at_stress(strain):
    """Stress [MPa] of the Anderberg and Thelandersson law at room temperature, generated, not measured.

    A parabola with initial slope E and apex f_c at 2 f_c / E, continued by the line of slope AT_DESCENT that
    is tangent to it. Takes a number or an array within [0, AT_LAST_STRAIN]; throws ValueError outside.
    The law's own inelastic strain at the peak is f_c / E = 0.00163; the paper quotes 0.0015 for the
    experiment.
    """
    strain = np.asarray(strain, dtype=float)
    if (strain < 0.0).any() or (strain > AT_LAST_STRAIN).any():
        raise ValueError(f"strain outside [0, {AT_LAST_STRAIN:.4g}], where the law is defined")
    line = _parabola(_AT_STRAIN_AT_TANGENT) + AT_DESCENT * (strain - _AT_STRAIN_AT_TANGENT)
    return np.where(strain <= _AT_STRAIN_AT_TANGENT, _parabola(strain), line)
