"""The page of a study: one file that needs nothing else."""

from __future__ import annotations

import math
import statistics
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ... import _core
from ...decks import toml
from ..driver import duration
from ..store import DONE
from .drawing import parameter_label, value_text
from ...report.markup import Markup, element, picture, together
from .section import PageTable, Section, Shown
from .seen import Seen, number

_MOST_REASONS = 20
_STYLE = """
:root { color-scheme: light dark; --ink: #1c1c1c; --faint: #6b6b6b; --ground: #ffffff; --line: #d9d9d9; --box: #f5f5f3;
  --warn: #fdf0d5; --warn-line: #e69f00; --link: #0072b2; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e6e3; --faint: #a0a0a0; --ground: #17181a; --line: #3a3c40;
  --box: #212327; --warn: #3a2f14; --link: #56b4e9; } }
body { margin: 0 auto; max-width: 60rem; padding: 1.5rem 1rem 4rem; background: var(--ground); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .25rem; } h2 { font-size: 1.25rem; margin: 2.5rem 0 .5rem;
  border-bottom: 1px solid var(--line); padding-bottom: .2rem; } h3 { font-size: 1.05rem; margin: 1.75rem 0 .4rem; }
p { margin: .5rem 0; max-width: 46rem; } .faint, figcaption, .note { color: var(--faint); }
.warn { background: var(--warn); border-left: 4px solid var(--warn-line); padding: .6rem .9rem; white-space: pre-line; }
figure { margin: 1.25rem 0; break-inside: avoid; } figure img { display: block; max-width: 100%; background: #ffffff;
  padding: .5rem; box-sizing: border-box; border: 1px solid var(--line); border-radius: 3px; }
figcaption, .note { font-size: .875rem; max-width: 46rem; margin-top: .35rem; } a { color: var(--link); }
.scroll { overflow-x: auto; margin: .75rem 0; } table { border-collapse: collapse; font-size: .9rem;
  font-variant-numeric: tabular-nums; } th, td { text-align: left; padding: .25rem .9rem .25rem 0; vertical-align: top;
  border-bottom: 1px solid var(--line); } th { font-weight: 600; } tr.faint td { color: var(--faint); }
pre { background: var(--box); border: 1px solid var(--line); border-radius: 3px; padding: .7rem .9rem;
  font-size: .82rem; line-height: 1.4; white-space: pre-wrap; overflow-wrap: anywhere; }
@media print { :root { color-scheme: light; --ink: #000; --faint: #444; --ground: #fff; --line: #bbb; --box: #fff;
  --warn: #fff; --link: #000; } body { max-width: none; padding: 0; font-size: 10pt; } h2, h3 { break-after: avoid; }
  tr { break-inside: avoid; } .scroll { overflow: visible; } @page { margin: 18mm 16mm; } }
"""


def page_of(seen: Seen, sections: Sequence[Section], pictures: dict[str, bytes]) -> str:
    """All of the page. pictures: PNG files by the names of figures."""
    body = together(_head(seen), _warnings(seen),
                    element("h2", "What was found") if sections else Markup(),
                    *(_section(section, pictures) for section in sections),
                    element("h2", "What was run"), _run_table(seen), _varied(seen), _failures(seen),
                    element("h2", "One run again"), _again(seen),
                    element("h2", "The study file"), element("p", str(seen.setup.file.name), class_="faint"),
                    element("pre", _text(seen.setup.file)), _deck(seen))
    head = element("head", Markup('<meta charset="utf-8"><meta name="viewport" content="width=device-width">'),
                   element("title", seen.setup.title), Markup(f"<style>{_STYLE}</style>"))
    return f'<!DOCTYPE html>\n<html lang="en">{head}{element("body", body)}</html>\n'


def _head(seen: Seen) -> Markup:
    meaning = {"ensemble": "One point with many seeds", "grid": "Grid of parameters", "lhs": "Latin hypercube",
               "morris": "Elementary effects (Morris)", "sobol": "Shares of the variance (Sobol')",
               "chaos": "Shares of the variance by polynomial chaos", "calibrate": "Calibration (CMA-ES)",
               "secant": "Calibration (secant)",
               "posterior": "Posterior by MCMC on surrogates"}[seen.method]
    seeds = len({row["seed"] for row in seen.rows})
    return together(element("h1", seen.setup.title),
                    element("p", f"{meaning}: {_counted(seen.forecast.points, 'point')}, "
                                 f"{_counted(seeds, 'seed')} each", class_="faint"))


def _counted(number_of: int, what: str) -> str:
    return f"{number_of} {what}" if number_of == 1 else f"{number_of} {what}s"


def _warnings(seen: Seen) -> Markup:
    said = []
    if not seen.is_complete:
        more = "" if seen.forecast.is_complete else " More points may follow."
        left = "" if math.isnan(seen.forecast.seconds) or not seen.forecast.left else \
            f" About {duration(seen.forecast.seconds)} of one core are left."
        said.append(f"This study is not complete: {seen.forecast.known} of {seen.forecast.runs} runs are done."
                    f"{more}{left} What stands here is of these runs alone.")
    if seen.none_because:
        said.append(f"Nothing could be found yet: {seen.none_because}")
    if failed := sum(row["state"] not in (DONE, "not run") for row in seen.rows):
        said.append(f"{_counted(failed, 'run')} of {len(seen.rows)} gave no value; see below.")
    if len(versions := _versions(seen)) > 1:
        said.append(f"The runs are of several physics versions: {', '.join(versions)}.")
    return together(*(element("p", text, class_="warn") for text in said))


def _section(section: Section, pictures: dict[str, bytes]) -> Markup:
    return together(element("h3", section.title), *(element("p", text) for text in section.texts if text),
                    *(_figure(shown, pictures[shown.name]) for shown in section.figures),
                    *(_table(table) for table in section.tables))


def _figure(shown: Shown, png: bytes) -> Markup:
    pdf, png_file = (element("a", ending.upper(), href=f"{shown.name}.{ending}") for ending in ("pdf", "png"))
    width = shown.figure.get_figwidth()
    image = element("div", picture(png, shown.caption), style=f"max-width: {8.3 * width:.1f}rem")
    return element("figure", image, element("figcaption", shown.caption, " ", pdf, " ", png_file))


def _table(table: PageTable) -> Markup:
    head = element("tr", *(element("th", cell) for cell in table.head))
    rows = [element("tr", *(element("td", cell) for cell in row), **({"class_": "faint"} if i in table.faint else {}))
            for i, row in enumerate(table.rows)]
    note = element("p", table.note, class_="note") if table.note else Markup()
    whole = element("table", element("thead", head), element("tbody", *rows))
    return together(element("div", whole, class_="scroll"), note)


def _facts(facts: Sequence[tuple[str, str]]) -> Markup:
    rows = [element("tr", element("th", name), element("td", said)) for name, said in facts if said]
    return element("div", element("table", *rows), class_="scroll")


def _run_table(seen: Seen) -> Markup:
    setup, runner = seen.setup, seen.setup.runner
    made = {"pyroclast": f"deck {runner.deck}", "command": f"command {runner.command}",
            "function": f"function {runner.function} of {runner.file}"}[runner.kind]
    walls = [float(row["wall_s"]) for row in seen.rows if row["wall_s"]]
    time = f"{_duration(sum(walls))} in all, median {_duration(statistics.median(walls))} a run" if walls else ""
    settings = ", ".join(f"{key} = {toml(value)}" for key, value in setup.method.settings.items())
    until = f", until the widest interval is below {setup.method.until:g}" if setup.method.until is not None else ""
    seeds = sorted({row["seed"] for row in seen.rows})
    hosts = sorted({row["host"] for row in seen.rows if row["host"]})
    return _facts([
        ("made by", made),
        ("changes of the deck", ", ".join(f"{key} = {toml(value)}" for key, value in runner.changes)),
        ("method", f"{seen.method}{': ' if settings else ''}{settings}{until}"),
        ("points", f"{seen.forecast.points}" + (f", of which {seen.forecast.infeasible} are infeasible and were not run"
                                                if seen.forecast.infeasible else "")),
        ("seeds", _seeds(seeds)),
        ("runs", f"{seen.forecast.known} of {seen.forecast.runs} done"),
        ("outputs", "; ".join(f"{o.name}: {o.what}" for o in setup.outputs)),
        ("wall time", time),
        ("computers", ", ".join(hosts)),
        ("pyroclast", f"version {_core.version} drew this page"),
        ("physics version", ", ".join(_versions(seen)) if runner.kind == "pyroclast" else ""),
        ("correlations", "; ".join(f"{a} and {b}: rank {rho:g}" for a, b, rho in setup.correlations)),
    ])


def _duration(seconds: float) -> str:
    return duration(seconds) if seconds >= 10.0 else f"{number(seconds, 2)} s"


def _seeds(seeds: Sequence[int]) -> str:
    return ", ".join(map(str, seeds)) if len(seeds) <= 3 else f"{seeds[0]} to {seeds[-1]}, {len(seeds)} of them"


def _versions(seen: Seen) -> list[str]:
    return [str(v) for v in sorted({row["physics_version"] for row in seen.rows if row["physics_version"] is not None})]


def _varied(seen: Seen) -> Markup:
    if not seen.setup.parameters:
        return Markup()
    rows = []
    for p in seen.setup.parameters:
        d = p.distribution
        if d.kind == "choice":
            how = f"one of {', '.join(map(str, d.choices))}"
        elif d.kind in ("normal", "truncated_normal"):
            how = f"normal, mean {number(d.numbers[0])}, sd {number(d.numbers[1])}"
            how += f", between {number(d.numbers[2])} and {number(d.numbers[3])}" if d.kind != "normal" else ""
        else:
            how = f"{d.kind.replace('_', ' ')}, {value_text(p, d.ends()[0])} to {value_text(p, d.ends()[-1])}"
        keys = "; ".join(f"{path}{'' if factor == 1.0 else f' × {factor:g}'}" for path, factor in p.keys)
        rows.append([parameter_label(p), how, *([p.how, keys] if p.keys else [])])
    of_deck = ["as", "of the deck"] if seen.setup.runner.kind == "pyroclast" else []
    return _table(PageTable(["parameter", "drawn from", *of_deck], rows))


def _failures(seen: Seen) -> Markup:
    said = [(row["state"], row["reason"]) for row in seen.rows]
    found = Counter((state, reason) for state, reason in said if state != DONE or reason)
    if not found:
        return element("p", "All runs gave a value.")
    rows = [[state, str(count), reason] for (state, reason), count in found.most_common(_MOST_REASONS)]
    left = len(found) - len(rows)
    note = f"{left} more reasons stand in the table." if left > 0 else ""
    return _table(PageTable(["state", "runs", "reason"], [[DONE, str(said.count((DONE, ""))), ""], *rows], note))


def _again(seen: Seen) -> Markup:
    if not seen.rows:
        return element("p", "There is no run yet.")
    row = next((row for row in seen.rows if row["state"] == DONE), seen.rows[0])
    values = ", ".join(f"{p.name} = {value_text(p, row[p.column])}" for p in seen.setup.parameters)
    outputs = ", ".join(f"{o.name} = {number(row[o.name], 6)}" for o in seen.setup.outputs)
    return together(element("p", f"Run {row['run'][:12]}: {values + ', ' if values else ''}seed {row['seed']}. "
                                 + (f"It gave {outputs}." if row["state"] == DONE else f"It is {row['state']}.")
                                 + " table.csv has such a line for each run; FOLDER is where its results shall go."),
                    element("pre", row["command"]))


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        return f"cannot be read: {error.strerror}"


def _deck(seen: Seen) -> Markup:
    if seen.setup.runner.kind != "pyroclast":
        return Markup()
    return together(element("h2", "The deck"), element("p", seen.setup.runner.deck.name, class_="faint"),
                    element("pre", _text(seen.setup.runner.deck)))
