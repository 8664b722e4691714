"""Whether the results of a run may be believed, and why: as its summary judges outcomes, stages and ledgers.

The program judges (`is_good`, warnings, `quasi_static`); here its judgement is put in order for a reader.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from ..stored.heated import Heated
from ..stored.results import Results, results_with
from ..stored.run_facts import ResultFacts, RunFacts

GOOD, DOUBT, BAD = "good", "doubt", "bad"
_LEVELS = (GOOD, DOUBT, BAD)  # from good to bad
_MOST_CARDS = 8
STRENGTH = "strength"


class Reason(NamedTuple):
    level: str  #: GOOD, DOUBT or BAD
    text: str


class _Headline(NamedTuple):
    """A result that a reader looks for first."""

    result: str
    mark: str = ""  # of the curve, see `marks`
    platen: str = ""  # how the platen is held where the result says something; "": anyhow


_HEADLINES = (
    _Headline("E_GPa"),
    _Headline("f_c_MPa", "peak"),
    _Headline("strain_at_peak", "peak"),
    _Headline("strain_ic"),
    _Headline("load_level"),
    _Headline("load_stress_MPa", platen="force"),
    _Headline("critical_temperature_degC", "end"),
    _Headline("highest_temperature_degC"),
    _Headline("largest_thrust_MPa", "peak", "fixed"),
)
_MINOR = ("steps", "unbalanced_ratio", "exchanges", "cycles")
_SHOWN = {"1": ("", 1.0), "1e-3": ("10⁻³", 1e3), "J/m2": ("J/m²", 1.0), "Pa": ("MPa", 1e-6), "N": ("kN", 1e-3),
          "m2": ("cm²", 1e4), "m": ("mm", 1e3), "degC": ("°C", 1.0)}
"""Units of results as a page shows them, and the factor to that; others are shown as they are."""


@dataclass(frozen=True)
class Card:
    """A number at the head of a page, with the reason to believe it or not."""

    label: str
    value: str  #: "–" where there is none
    unit: str
    level: str
    reason: str
    mark: str = ""  #: id of the place on the curve that it belongs to
    number: float | None = None  #: in the unit
    of: str = ""  #: what was tested, where one has to know it to use the number


def worst(reasons: list[Reason]) -> str:
    return max((reason.level for reason in reasons), key=_LEVELS.index, default=GOOD)


def verdict(run: Results) -> list[Reason]:
    """Judges a run with all its stages; the worst comes first."""
    reasons = _of_end(run)
    for number, stage in enumerate(run.stages, 1):
        of = f"stage {number}, {stage.get('kind')}"
        reasons += [Reason(reason.level, f"{of}: {reason.text}") for reason in stage_verdict(stage)]
    reasons += _of_ledgers(run)
    return sorted(dict.fromkeys(reasons), key=lambda reason: -_LEVELS.index(reason.level))


def _of_end(run: Results) -> list[Reason]:
    """Returns what speaks against a run as a whole: how it ended, and its warnings."""
    if "outcome_id" not in run.summary:
        said = {"running": "the run still goes on: its numbers are of this moment",
                "killed": "the run was killed before it could sum up", "broken off": "the run broke off"}
        return [Reason(DOUBT if run.outcome == "running" else BAD,
                       said.get(run.outcome, "summary.json does not say whether the run is good"))]
    warnings = [Reason(DOUBT, text) for text in run.warnings]
    if run.summary.get("is_good"):
        return warnings
    return [Reason(BAD, f"the program does not count this run as good: {run.outcome}"), *warnings]


def _of_ledgers(run: Results) -> list[Reason]:
    """Returns how well ledgers close; the program warns where that is not well enough."""
    reasons = []
    for ledger, name in (("energy_J", "error_over_turnover"), ("heat_J", "error_over_largest")):
        error = run.summary.get(ledger, {}).get(name)
        if isinstance(error, (int, float)):
            of = "energy turned over" if ledger == "energy_J" else "largest term"
            within = f"{100.0 * abs(error):.2g} % of the {of}"
            reasons.append(Reason(GOOD, f"the {ledger[:-2]} ledger closes within {within}"))
    return reasons


def stage_verdict(stage: dict[str, Any]) -> list[Reason]:
    """Judges one stage of the summary."""
    results = stage.get("results", {})
    reasons = []
    if not stage.get("is_good", True):
        reasons.append(Reason(BAD, str(stage.get("outcome"))))
    static = results.get("quasi_static")
    if static is not None:
        kinetic = results.get("kinetic_over_elastic_to_peak")
        beside = f": kinetic over elastic energy {kinetic:.2g}" if isinstance(kinetic, float) else ""
        reasons.append(Reason(GOOD, f"quasi-static up to the peak{beside}") if static else
                       Reason(BAD, f"not quasi-static{beside}"))
    if missed := results.get("exchanges_not_converged"):
        reasons.append(Reason(DOUBT, f"{missed} of {results.get('exchanges')} exchanges did not come to rest"))
    elif results.get("exchanges"):
        reasons.append(Reason(GOOD, f"all {results['exchanges']} exchanges came to rest"))
    reasons += [Reason(DOUBT, str(text)) for text in stage.get("warnings", [])]
    return reasons


def cards(run: Results) -> list[Card]:
    """Returns the headlines of a run: of each result the last stage that has it."""
    whole = _of_end(run) + _of_ledgers(run)
    found: dict[str, Card] = {}
    for stage in run.stages:
        reasons = stage_verdict(stage)
        for card in _of_stage(run.facts, stage, reasons, whole):
            found.pop(card.label, None)  # the later one stands later
            found[card.label] = card
    if unmeasured := _unmeasured_strength(run, whole):
        found[unmeasured.label] = unmeasured
    known = run.facts.results
    order = {known[headline.result].label: i for i, headline in enumerate(_HEADLINES) if headline.result in known}
    order[STRENGTH] = -1
    place = {label: i for i, label in enumerate(found)}
    asked = _asked(run)

    def rank(card: Card) -> tuple[int, int]:
        """Returns a card's rank: known ones first, then the deck's own, its last following from others, then peaks."""
        if card.label in order:
            return 0, order[card.label]
        if card.label in asked:
            return 1, -asked.index(card.label)
        return (2 if card.label.startswith("peak_") else 3), place[card.label]

    return sorted(found.values(), key=rank)[:_MOST_CARDS]


def _unmeasured_strength(run: Results, whole: list[Reason]) -> Card | None:
    """Returns what the specimen bore in a test between platens that measures no strength; None of other tests."""
    hot = Heated(run)
    if not run.has_platens or not run.stages or not hot.is_last:
        return None
    if any("f_c_MPa" in stage.get("results", {}) for stage in run.stages):
        return None
    if hot.restrained:
        said = "the platens held the specimen in place while it was heated"
    elif hot.load_stress:
        said = f"{'no failure: held' if hot.critical_temperature is None else 'failed under'} {hot.load_stress:.3g} MPa"
        loads = [results for results in run.stage_results if results.get("f_c_of_level_MPa")]
        if hot.load_level and loads:
            said += f" = {hot.load_level:.2f} of f_c {loads[-1]['f_c_of_level_MPa']:.3g} MPa"
            said += f" {loads[-1].get('f_c_of_level_is', '')}"
        for failed in results_with(run, "critical_time_s"):
            said += f", after {failed['critical_time_s'] / 60.0:.3g} min of heating"
    else:
        said = "nothing loaded the specimen"
    return Card(STRENGTH, "not measured", "", worst(whole), said.strip(), of=_conditions(hot.results))


def _conditions(results: dict[str, Any]) -> str:
    """Returns the body and the conditions for which a failure in heat, or none, is the answer."""
    return str(results.get("answer_is") or "")


def _asked(run: Results) -> list[str]:
    """Returns labels of the results that the deck's stages work out, in its order; not of those that it only states."""
    asked = [result for stage in run.deck_stages if isinstance(stage.get("results"), list)
             for result in stage["results"] if isinstance(result, dict)]
    return [str(result.get("name")) for result in asked if result.get("kind") != "given"]


def _of_stage(facts: RunFacts, stage: dict[str, Any], own: list[Reason], whole: list[Reason]) -> Iterator[Card]:
    results = stage.get("results", {})
    known = {headline.result: headline for headline in _HEADLINES
             if headline.platen in ("", results.get("platen", headline.platen))}
    leads = any(name in known for name in results)
    for name, value in results.items():
        about = facts.results.get(name, ResultFacts(name, "1", name, "", "test", None, "1"))
        is_number = not isinstance(value, bool) and isinstance(value, (int, float))
        if name not in known and (leads or not is_number or name in _MINOR or about.about):
            continue
        because = results.get(facts.text_about(name, "reason")) or results.get("none_because")
        if not is_number:
            if because:
                yield Card(about.label, "–", "", BAD, str(because))
            continue
        reasons = own + whole
        level = worst(reasons)
        said = next((reason.text for reason in reasons if reason.level == level), "the stage came to its end")
        unit, factor = _SHOWN.get(about.shown_in, (about.shown_in, 1.0))
        yield Card(about.label, _number(factor * value, about.digits), unit, level, said,
                   known[name].mark if name in known else "", factor * value,
                   _conditions(results) if name == "critical_temperature_degC" else "")


def _number(value: float, digits: int | None) -> str:
    return f"{value:.4g}" if digits is None else f"{value:.{digits}f}"
