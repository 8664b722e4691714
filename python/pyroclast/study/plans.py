"""What each method asks for and makes of the answers: the mathematics of `methods`, with a study's names."""

from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..errors import Error
from .file import StudySetup
from .methods import (calibration, ensemble, hsic, main_effects, morris, posterior, sampling, secant, seeds, sobol, surrogate)

Array = NDArray[np.float64]
_OF_HELD = 1  # beside the method's seed: the points that a surrogate is tried on are another sequence
_MOST_DRAWS = 4000  # of a chain that findings hold, evenly; its statistics are those of all
_MOST_CURVE = 40  # points of a response curve that a surrogate gives


@dataclass(frozen=True)
class Answers:
    """What is known of points. y: (points, seeds) by output, NaN without a value; others likewise, and (points,).

    doubts: by output and (point, seed): why its value is in doubt.
    """

    y: dict[str, Array]
    is_known: NDArray[np.bool_]
    is_feasible: NDArray[np.bool_]
    doubts: dict[str, dict[tuple[int, int], str]]

    def has_all(self) -> bool:
        """Returns whether each point is known or cannot be run."""
        return bool(np.all(self.is_known | ~self.is_feasible[:, None]))


Ask = Callable[[Array, Sequence[int]], Answers]
"""What is known of points of the unit cube (points, parameters), with these seeds."""


@dataclass(frozen=True)
class Proposal:
    """Points that are wanted so far, (points, parameters) in the unit cube, each with all of these seeds."""

    points: Array
    seeds: tuple[int, ...]
    is_complete: bool  #: no more will be asked for


class Plan(Protocol):
    """A method at work on a study. What it says depends on the study and the answers alone."""

    draws_as_it_goes: bool  #: points depend on answers; those that cannot be run count as infeasible then
    most_points: int | None  #: that a method which draws as it goes may come to ask for; None: it is not known

    def propose(self, ask: Ask) -> Proposal:
        """Returns all points that are wanted, given what is known."""

    def findings(self, ask: Ask) -> dict[str, Any]:
        """Returns what comes of the answers: numbers, texts, lists and dicts. Raises Error where nothing does yet."""


def plan_of(study: StudySetup) -> Plan:
    """Returns the plan of the study's method."""
    kinds: dict[str, type[_Plan]] = {"ensemble": _Ensemble, "grid": _Grid, "lhs": _LatinHypercube, "morris": _Morris,
                                     "sobol": _Sobol, "chaos": _Chaos, "calibrate": _Calibrate, "secant": _Secant,
                                     "posterior": _Posterior}
    return kinds[study.method.kind](study)


class _Plan:
    draws_as_it_goes = False
    most_points: int | None = None

    def __init__(self, study: StudySetup):
        self.study = study
        self.k = len(study.parameters)
        self.settings = study.method.settings
        self.seed = int(self.settings.get("seed", 1))
        self.outputs = [o.name for o in study.outputs]

    def propose(self, ask: Ask) -> Proposal:
        return Proposal(self.points(), self.study.seeds, True)

    def points(self) -> Array:
        raise NotImplementedError

    def findings(self, ask: Ask) -> dict[str, Any]:
        raise NotImplementedError

    def _by_output(self, answers: Answers, find: Callable[[Array], Any]) -> dict[str, Any]:
        """Returns for each output what `find` makes of its values, or why it makes nothing."""
        found: dict[str, Any] = {}
        for name in self.outputs:
            try:
                found[name] = plain(find(answers.y[name]))
            except Error as error:
                found[name] = {"none_because": str(error)}
        return found

    def _grown(self, first: int, enough: Callable[[int], bool | None]) -> tuple[int, bool]:
        """Returns how many samples, doubled until it is enough (None: not known yet), and whether it is complete."""
        n, most = first, max(int(self.settings.get("most", first)), first)
        while self.study.method.until is not None and n < most:
            is_enough = enough(n)
            if is_enough is None:
                return n, False
            if is_enough:
                break
            n = min(2 * n, most)
        return n, True

    def _mixed(self, v: Array, keep_columns: bool = False) -> Array:
        """Gives independent points the correlations of the study."""
        if not self.study.correlations:
            return v
        rank = np.eye(self.k)
        names = [p.name for p in self.study.parameters]
        for a, b, rho in self.study.correlations:
            i, j = names.index(a), names.index(b)
            rank[i, j] = rank[j, i] = rho
        return sampling.correlated(v, rank, keep_columns)

    @property
    def _has_ends(self) -> list[bool]:
        """Whether each parameter's range ends at 0 and 1 of the cube."""
        return [p.distribution.kind in ("uniform", "log_uniform", "truncated_normal") for p in self.study.parameters]

    def _pulled_in(self, u: Array, levels: int) -> Array:
        """Moves levels of parameters without ends into the middles of their classes."""
        for i, has_ends in enumerate(self._has_ends):
            if not has_ends:
                u[..., i] = sampling.inside(u[..., i], levels)
        return u


class _Ensemble(_Plan):
    def propose(self, ask: Ask) -> Proposal:
        n, is_complete = self._grown(len(self.study.seeds), lambda n: self._is_enough(ask, n))
        return Proposal(np.zeros((1, 0)), self._seeds(n), is_complete)

    def _seeds(self, n: int) -> tuple[int, ...]:
        return tuple(range(self.study.seeds[0], self.study.seeds[0] + n))

    def _is_enough(self, ask: Ask, n: int) -> bool | None:
        answers = ask(np.zeros((1, 0)), self._seeds(n))
        if not answers.has_all():
            return None
        assert self.study.method.until is not None
        must = [o for o in self.outputs if o not in self.study.may_lack] or self.outputs
        return ensemble.widest(ensemble.summary(answers.y[o][0]) for o in must) < self.study.method.until

    def findings(self, ask: Ask) -> dict[str, Any]:
        proposal = self.propose(ask)
        answers = ask(proposal.points, proposal.seeds)
        return {"outputs": self._by_output(answers, lambda y: ensemble.summary(y[0]))}


class _Sampled(_Plan):
    """Points whose answers show what each parameter does alone."""

    def findings(self, ask: Ask) -> dict[str, Any]:
        u = self.points()
        answers = ask(u, self.study.seeds)

        def find(y: Array) -> dict[str, Any]:
            curves = [main_effects.curve(u[:, j], y, count=p.distribution.count)
                      for j, p in enumerate(self.study.parameters)]
            return {"rank_effects": main_effects.rank_effects(u, y, self.seed), "curves": curves}

        return {"outputs": self._by_output(answers, find)}


class _Grid(_Sampled):
    def points(self) -> Array:
        return sampling.grid([p.levels for p in self.study.parameters], self._has_ends)


class _LatinHypercube(_Sampled):
    @functools.cache  # noqa: B019 - a plan lives as long as its study; 10,000 points take seconds
    def points(self) -> Array:
        return self._mixed(sampling.latin_hypercube(int(self.settings["samples"]), self.k, self.seed), True)


class _Morris(_Plan):
    def _design(self, trajectories: int) -> Array:
        levels = int(self.settings["levels"])
        return self._pulled_in(morris.design(self.k, trajectories, levels, self.seed), levels)

    def propose(self, ask: Ask) -> Proposal:
        n, is_complete = self._grown(int(self.settings["trajectories"]), lambda n: self._is_enough(ask, n))
        return Proposal(self._design(n).reshape(-1, self.k), self.study.seeds, is_complete)

    def _effects(self, ask: Ask, n: int) -> tuple[Answers, Callable[[Array], morris.Effects]]:
        design = self._design(n)
        answers = ask(design.reshape(-1, self.k), self.study.seeds)
        return answers, lambda y: morris.effects(design, y.reshape(n, self.k + 1, -1), self.seed)

    def _is_enough(self, ask: Ask, n: int) -> bool | None:
        answers, find = self._effects(ask, n)
        if not answers.has_all():
            return None
        found = [find(answers.y[o]) for o in self.outputs]
        assert self.study.method.until is not None
        return max(_widest(e.mu_star_low, e.mu_star_high, float(np.nanmax(e.mu_star))) for e in found) \
            < self.study.method.until

    def findings(self, ask: Ask) -> dict[str, Any]:
        n = len(self.propose(ask).points) // (self.k + 1)
        answers, find = self._effects(ask, n)
        return {"outputs": self._by_output(answers, lambda y: {"effects": find(y), "seed_share": seeds.share(y)})}


class _Sobol(_Plan):
    def propose(self, ask: Ask) -> Proposal:
        n, is_complete = self._grown(int(self.settings["samples"]), lambda n: self._is_enough(ask, n))
        return Proposal(self._points(n), self.study.seeds, is_complete)

    def _points(self, n: int) -> Array:
        return sobol.design(self.k, n, self.seed).reshape(-1, self.k)

    def _indices(self, y: Array) -> sobol.Indices:
        return sobol.indices(y.reshape(-1, self.k + 2, y.shape[1]), self.seed, bool(self.settings["allow_missing"]))

    def _is_enough(self, ask: Ask, n: int) -> bool | None:
        answers = ask(self._points(n), self.study.seeds)
        if not answers.has_all():
            return None
        found = [self._indices(answers.y[o]) for o in self.outputs]
        assert self.study.method.until is not None
        return max(max(_widest(i.first_low, i.first_high, 1.0), _widest(i.total_low, i.total_high, 1.0))
                   for i in found) < self.study.method.until

    def findings(self, ask: Ask) -> dict[str, Any]:
        answers = ask(self.propose(ask).points, self.study.seeds)
        return {"outputs": self._by_output(answers, self._indices)}


class _OnSurrogate(_Plan):
    """A surrogate of each output, fitted in independent coordinates and tried on points kept apart.

    Points kept apart that give no value are made up for by further ones, at most as many again as were asked for.
    """

    def propose(self, ask: Ask) -> Proposal:
        answers = self._answers(ask)
        return Proposal(self._mixed(self._independent(len(answers.is_known))), self.study.seeds, answers.has_all())

    def _answers(self, ask: Ask) -> Answers:
        """Returns the answers at all points that are wanted so far."""
        n, least = int(self.settings["samples"]), int(self.settings["held"])
        held = least
        while True:
            answers = ask(self._mixed(self._independent(n + held)), self.study.seeds)
            lost = max(int(np.isnan(y[n:]).any(axis=1).sum()) for y in answers.y.values())
            wanted = min(least + lost, 2 * least)
            if not answers.has_all() or wanted <= held:
                return answers
            held = wanted

    def _independent(self, count: int) -> Array:
        n = int(self.settings["samples"])
        return np.concatenate([sampling.sobol_sequence(n, self.k, self.seed),
                               sampling.sobol_sequence(count - n, self.k, self.seed + _OF_HELD)])

    def _surrogate(self, y: Array) -> tuple[surrogate.Surrogate, surrogate.Validation]:
        v, n = self._independent(len(y)), int(self.settings["samples"])
        fitted = surrogate.fit(v[:n], y[:n])
        return fitted, surrogate.validate(fitted, v[n:], y[n:])

    def _curves(self, fitted: surrogate.Surrogate) -> list[dict[str, Any]]:
        """Returns a curve of each parameter, all others in the middle."""
        u = np.linspace(0.0, 1.0, _MOST_CURVE)
        curves = []
        for i in range(self.k):
            points = np.full((_MOST_CURVE, self.k), 0.5)
            points[:, i] = u
            curves.append({"u": u, "y": fitted.predict(points)})
        return curves


class _Chaos(_OnSurrogate):
    def findings(self, ask: Ask) -> dict[str, Any]:
        return {"outputs": self._by_output(self._answers(ask), self._find)}

    def _find(self, y: Array) -> dict[str, Any]:
        fitted, validation = self._surrogate(y)
        found: dict[str, Any] = {"q2": validation.q2, "own_q2": validation.own_q2, "error": validation.error,
                                 "own_error": validation.own_error, "terms": fitted.terms, "degree": fitted.degree,
                                 "lost": fitted.lost, "seed_share": seeds.share(y)}
        if self.study.correlations:  # shares of the variance do not add up then
            found["dependence"] = hsic.dependence(self._mixed(self._independent(len(y))), y, self.seed)
            return found
        try:
            found["indices"] = surrogate.indices(fitted, validation, self.seed)
            found["curves"] = self._curves(fitted)
        except Error as error:
            found["none_because"] = str(error)
        return found


class _ToTargets(_Plan):
    @property
    def _targets(self) -> calibration.Targets:
        targets = self.study.targets
        return calibration.Targets(tuple(t.output for t in targets), np.array([t.value for t in targets]),
                                   np.array([t.sd for t in targets]))

    def _of_targets(self, answers: Answers) -> Array:
        """Returns the values (points, seeds, targets) of the targets."""
        return np.stack([answers.y[t.output] for t in self.study.targets], axis=2)

    def _answer(self, ask: Ask, u: Array) -> calibration.Answer:
        """Returns what is known of the targets at a point (k,)."""
        answers = ask(u[None, :], self.study.seeds)
        if not answers.is_feasible[0]:
            return calibration.Infeasible()
        return self._of_targets(answers)[0] if answers.has_all() else None

    def _doubts(self, ask: Ask, u: Array) -> dict[str, str]:
        """Returns by target not counted as met at a point (k,) how many seeds are in doubt, and why the first is."""
        answers = ask(u[None, :], self.study.seeds)
        doubts = {t.output: list(answers.doubts[t.output].values()) for t in self.study.targets}
        return {output: f"{len(texts)} of {len(self.study.seeds)} seeds {'is' if len(texts) == 1 else 'are'} in doubt: "
                        f"{texts[0]}" for output, texts in doubts.items() if texts}


class _Calibrate(_ToTargets):
    draws_as_it_goes = True

    def __init__(self, study: StudySetup):
        super().__init__(study)
        population = int(self.settings["population"]) or calibration.usual_population(self.k)
        self.most_points = int(self.settings["generations"]) * population

    def propose(self, ask: Ask) -> Proposal:
        found = self._search(ask)
        return Proposal(found.points, self.study.seeds, bool(found.search.finished))

    def _search(self, ask: Ask) -> calibration.Calibration:
        s = self.settings
        settings = calibration.Settings(seed=self.seed, population=int(s["population"]) or None,
                                        most_generations=int(s["generations"]), least_sigma=float(s["least_step"]),
                                        least_gain=float(s["least_gain"]), patience=int(s["patience"]))

        return calibration.calibrate(self.k, self._targets, settings, lambda u: self._answer(ask, u))

    def findings(self, ask: Ask) -> dict[str, Any]:
        found = self._search(ask)
        if found.best is None:
            raise Error("no point has all targets yet")
        u, answers = found.points, ask(found.points, self.study.seeds)
        y = self._of_targets(answers).mean(axis=1)
        targets = self._targets
        result: dict[str, Any] = {
            "finished": found.search.finished, "points": len(u), "best": {"u": u[found.best], "y": y[found.best],
                                                                         "misfit": found.misfits[found.best],
                                                                         "doubts": self._doubts(ask, u[found.best])},
            "targets": targets, "sd": np.sqrt(np.diag(found.covariance)), "misfits": found.misfits}
        try:
            result["uncertainty"] = calibration.uncertainty(u[found.best], u, y, targets, found.covariance, self.seed)
        except Error as error:
            result["uncertainty"] = {"none_because": str(error)}
        return _plain(result)


class _Secant(_ToTargets):
    """Parameters and targets are in the order of the parameters."""

    draws_as_it_goes = True

    def __init__(self, study: StudySetup):
        super().__init__(study)
        self.most_points = int(self.settings["rounds"])

    def propose(self, ask: Ask) -> Proposal:
        found = self._approach(ask)
        return Proposal(found.points, self.study.seeds, bool(found.finished))

    @property
    def _order(self) -> list[int]:
        """The target of each parameter."""
        by = [t.by for t in self.study.targets]
        return [by.index(p.name) for p in self.study.parameters]

    def _approach(self, ask: Ask) -> secant.Approach:
        targets, order = self._targets, self._order
        ordered = calibration.Targets(tuple(targets.names[i] for i in order), targets.values[order], targets.sd[order])
        slopes = []
        for p in self.study.parameters:  # an output that goes with its parameter, in the middle of the range
            low, high = p.distribution.numbers
            slopes.append(math.log(high / low) if p.distribution.kind == "log_uniform"
                          else 2.0 * (high - low) / (high + low))

        def answer(u: Array) -> calibration.Answer:
            known = self._answer(ask, u)
            return known[:, order] if isinstance(known, np.ndarray) else known

        return secant.approach(ordered, np.full(self.k, 0.5), np.array(slopes), int(self.settings["rounds"]), answer)

    def findings(self, ask: Ask) -> dict[str, Any]:
        found = self._approach(ask)
        if found.best is None:
            raise Error("no point has all targets yet" if not found.finished else found.finished)
        best = found.points[found.best]
        y = self._of_targets(ask(best[None, :], self.study.seeds))[0]
        n = len(y)
        error = y.std(axis=0, ddof=1) / math.sqrt(n) if n > 1 else np.full(y.shape[1], math.nan)
        back = np.argsort(self._order)  # from the order of the parameters to that of the targets
        doubts = self._doubts(ask, best)
        finished = found.finished
        if found.is_met and doubts:
            finished = "the means meet all targets, but some values are in doubt"
        return _plain({"finished": finished, "is_met": found.is_met and not doubts, "targets": self._targets,
                       "rounds": {"u": found.points, "y": found.means[:, back]},
                       "best": {"u": best, "y": y.mean(axis=0), "round": found.best, "error": error, "doubts": doubts}})


class _Posterior(_OnSurrogate, _ToTargets):
    draws_as_it_goes = True

    def __init__(self, study: StudySetup):
        super().__init__(study)
        self._sampled: tuple[bytes, tuple[posterior.Posterior, Any]] | None = None

    def propose(self, ask: Ask) -> Proposal:
        proposal = super().propose(ask)
        if proposal.is_complete:
            try:
                points = np.concatenate([proposal.points, self._checks(self._answers(ask))])
                return dataclasses.replace(proposal, points=points)
            except Error:
                pass  # findings say why there is no posterior to check
        return proposal

    def _checks(self, answers: Answers) -> Array:
        found, _ = self._sample(answers)
        return self._mixed(posterior.check_points(found, int(self.settings["checks"]), self.seed))

    def _sample(self, answers: Answers) -> tuple[posterior.Posterior, Any]:
        y = self._of_targets(answers)
        key = y.tobytes()
        if self._sampled is None or self._sampled[0] != key:
            pairs = [self._surrogate(y[:, :, i]) for i in range(y.shape[2])]
            covariance = calibration.misfit_covariance(list(y), self._targets)
            s = self.settings
            found = posterior.sample([p[0] for p in pairs], [p[1] for p in pairs], self._targets, covariance, self.seed,
                                     most_steps=int(s["steps"]))
            self._sampled = key, (found, pairs)
        return self._sampled[1]

    def findings(self, ask: Ask) -> dict[str, Any]:
        found, pairs = self._sample(self._answers(ask))
        v = posterior.check_points(found, int(self.settings["checks"]), self.seed)
        y = self._of_targets(ask(self._mixed(v), self.study.seeds))
        drawn = found.chain[::max(1, len(found.chain) // _MOST_DRAWS)]
        result = {"posterior": dataclasses.replace(found, chain=self._mixed(drawn)), "targets": self._targets,
                  **{name: [getattr(p[1], name) for p in pairs] for name in ("q2", "own_q2", "error", "own_error")}}
        if len(v):
            predicted = np.stack([p[0].predict(v) for p in pairs], axis=1)
            result["check"] = posterior.check(predicted, y, np.array([p[1].error for p in pairs]))
        return _plain(result)


def _widest(low: Array, high: Array, scale: float) -> float:
    width = float(np.nanmax(high - low, initial=0.0))
    return width / scale if scale > 0.0 else math.inf


def _plain(found: dict[str, Any]) -> dict[str, Any]:
    return {key: plain(value) for key, value in found.items()}


def plain(found: Any) -> Any:
    """Turns dataclasses and arrays into dicts, lists and numbers, with None for what is not finite."""
    if dataclasses.is_dataclass(found) and not isinstance(found, type):
        return {f.name: plain(getattr(found, f.name)) for f in dataclasses.fields(found)}
    if isinstance(found, dict):
        return {str(key): plain(value) for key, value in found.items()}
    if isinstance(found, (list, tuple)):
        return [plain(entry) for entry in found]
    if isinstance(found, np.ndarray):
        return plain(found.tolist())
    if isinstance(found, np.generic):
        return plain(found.item())
    if isinstance(found, float):
        return found if math.isfinite(found) else None
    return found
