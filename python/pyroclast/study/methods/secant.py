"""A parameter for each target, changed until the target is met: a secant in logarithms, as a person calibrates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .calibration import Answer, Array, Targets

_DIGITS = 9
_MOST_STEP = 0.4  # of a range, between two rounds
_LEAST_LEARNED = 0.02  # change of an output, as a logarithm, from which on a slope is learned from it: above scatter
_MOST_LEARNED = 3.0  # a parameter's own slope stays within this factor of the first one
_SAME = 1e-6  # of a range


@dataclass(frozen=True)
class Approach:
    """The rounds of a secant so far; a round is one point with all its seeds."""

    points: Array  #: (rounds, k), in the unit cube
    means: Array  #: (rounds, k), outputs over the seeds; NaN where a seed has none, and of a round not yet known
    best: int | None  #: round that is nearest to the targets; None while none has all outputs
    is_met: bool  #: whether each mean of the best round is within its target's sd
    finished: str  #: why it is done; empty while it goes on


def approach(targets: Targets, start: Array, slopes: Array, rounds: int,
             answer: Callable[[Array], Answer]) -> Approach:
    """Changes parameter i until target i is met, all at once, by Broyden's method (Math. Comp. 19, 1965) in the
    logarithms of the outputs.

    start: (k,), in the unit cube. slopes: (k,), d ln(output i) / d u_i that the first step takes; other parameters have
    no effect at first. The targets are positive. A round without a value is followed by one half the way back.
    """
    jacobian = np.diag(np.asarray(slopes, float))
    u = np.asarray(start, float).round(_DIGITS)
    points: list[Array] = []
    means: list[Array] = []
    finished = ""
    last: tuple[Array, Array] | None = None  # the last round with values, and the logarithms of outputs over targets
    while not finished:
        points.append(u)
        entry = answer(u)
        means.append(entry.mean(axis=0) if isinstance(entry, np.ndarray) else np.full(len(targets.values), np.nan))
        if entry is None:
            break
        if not (np.isfinite(means[-1]) & (means[-1] > 0.0)).all():
            if last is None:
                finished = "the first point gives no value of all targets"
                break
            following = 0.5 * (last[0] + u)
        else:
            is_met = np.abs(means[-1] - targets.values) <= targets.sd
            if is_met.all():
                finished = "all targets are met"
                break
            left = np.log(means[-1] / targets.values)
            if last is not None:
                jacobian = _learned(jacobian, u - last[0], left - last[1], slopes)
            last = u, left
            step, is_at_end = _step(jacobian, left, u)
            if (is_met | is_at_end & (np.abs(step) < _SAME)).all():
                finished = "no value within the ranges comes nearer"
                break
            following = u + step * (_MOST_STEP / max(float(np.abs(step).max()), _MOST_STEP))
        following = following.round(_DIGITS)
        if np.abs(following - u).max() < _SAME:
            finished = "no value within the ranges comes nearer"
        elif len(points) >= rounds:
            finished = f"{rounds} rounds"
        u = following
    away = (np.array(means) - targets.values) / targets.sd
    distance = np.linalg.norm(away, axis=1)
    best = int(np.nanargmin(distance)) if np.isfinite(distance).any() else None
    return Approach(np.array(points), np.array(means), best, best is not None and bool((np.abs(away[best]) <= 1.0).all()),
                    finished)


def _step(jacobian: Array, left: Array, u: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Returns the step that meets all targets, and which parameters it takes to an end of their range: their own
    targets are given up, and the others are met beside.
    """
    step, is_at_end = np.zeros_like(u), np.zeros(len(u), bool)
    while not is_at_end.all():
        free = ~is_at_end
        step[free] = -np.linalg.solve(jacobian[np.ix_(free, free)],
                                      left[free] + jacobian[np.ix_(free, is_at_end)] @ step[is_at_end])
        outside = free & ((u + step < 0.0) | (u + step > 1.0))
        if not outside.any():
            break
        step[outside] = np.clip(u + step, 0.0, 1.0)[outside] - u[outside]
        is_at_end |= outside
    return step, is_at_end


def _learned(jacobian: Array, step: Array, change: Array, slopes: Sequence[float] | Array) -> Array:
    """Returns the slopes with what a step told of them; unchanged where it told less than scatter, or no sense."""
    if np.abs(jacobian @ step).max() < _LEAST_LEARNED:
        return jacobian
    told = jacobian + np.outer(change - jacobian @ step, step) / (step @ step)
    own = np.diag(told) / np.asarray(slopes)
    is_sensible = ((own > 1.0 / _MOST_LEARNED) & (own < _MOST_LEARNED)).all() and np.linalg.cond(told) < 1e3
    return told if is_sensible else jacobian
