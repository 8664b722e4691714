"""Report of a secant: rounds towards the targets."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from ...draw import style
from .calibration import residuals_figure, standing
from .drawing import output_label, panels, parameter_label, value_text
from .section import PageTable, Section, Shown
from .seen import Seen, listed, number, numbers

_ROUNDS = ("Each round is one point with all seeds. Every parameter is changed until its own target is "
           "met; the study learns its effect on the other targets on the way.")
_ROUNDS_CAPTION = "Means over the seeds by round; band: the target and its standard deviation; vermilion: the best round."
_OPEN = ("As many targets as parameters are met by one point, whatever else the deck says. Numbers that no parameter "
         "changes are as the deck has them: these targets say nothing of them.")
_RESIDUALS_CAPTION = "Best round minus target, in standard deviations of the target; band: ± 2."


def sections(seen: Seen) -> list[Section]:
    found = seen.findings
    if found is None:
        return []
    targets, best = found["targets"], found["best"]
    labels = {o.name: output_label(o) for o in seen.setup.outputs}
    named = listed([f"{p.name} = {value_text(p, p.distribution.at(u))}" for p, u in zip(seen.setup.parameters, best["u"])])
    head = ["round", *map(parameter_label, seen.setup.parameters), *(labels[name] for name in targets["names"])]
    rows = [[str(i + 1), *(value_text(p, p.distribution.at(x)) for p, x in zip(seen.setup.parameters, u)),
             *(number(value) for value in y)]
            for i, (u, y) in enumerate(zip(found["rounds"]["u"], found["rounds"]["y"]))]
    residuals = (numbers(best["y"]) - numbers(targets["values"])) / numbers(targets["sd"])
    met = [[labels[name], number(value, 4), number(sd, 3), number(y), number(error, 2)]
           for name, value, sd, y, error
           in zip(targets["names"], targets["values"], targets["sd"], best["y"], best["error"])]
    return [Section("Rounds", [f"{standing(found)} Round {best['round'] + 1} comes nearest: {named}.", _ROUNDS],
                    [Shown("rounds", rounds_figure(seen, found), _ROUNDS_CAPTION)], [PageTable(head, rows)]),
            Section("Targets", [_OPEN],
                    [Shown("targets", residuals_figure(targets["names"], residuals), _RESIDUALS_CAPTION)],
                    [PageTable(["target", "value", "sd", "best round", "standard error over the seeds"], met)])]


@matplotlib.rc_context(style.STYLE)
def rounds_figure(seen: Seen, found: dict[str, Any]) -> Figure:
    """Draws each target's output by round."""
    targets, y = found["targets"], np.array([numbers(row) for row in found["rounds"]["y"]])
    labels = {o.name: output_label(o) for o in seen.setup.outputs}
    figure, every = panels(len(targets["names"]))
    rounds = 1 + np.arange(len(y))
    for i, (axes, name) in enumerate(zip(every, targets["names"])):
        value, sd = targets["values"][i], targets["sd"][i]
        axes.axhspan(value - sd, value + sd, color=style.GREEN, alpha=0.25, linewidth=0.0)
        axes.axhline(value, color=style.GREEN, linewidth=0.8)
        axes.plot(rounds, y[:, i], "o-", color=style.BLUE, markersize=4.0)
        axes.plot(rounds[found["best"]["round"]], y[found["best"]["round"], i], "o", color=style.VERMILLION, markersize=5.0)
        axes.xaxis.get_major_locator().set_params(integer=True)
        axes.set_xlabel("Round")
        axes.set_ylabel(labels[name])
    return figure
