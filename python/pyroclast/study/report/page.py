"""The page of a study: one file that needs nothing else."""

from __future__ import annotations

import math
import statistics
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from ... import _core
from ...live.decks import toml
from ...report.markup import Markup, element, picture, together
from ...report.shell import page
from ..driver import NOT_RUN, duration
from ..store import DONE
from .drawing import parameter_label, value_text
from .runs import RunPageLink
from .section import HOW_TO_READ, PageTable, Section, Shown
from .seen import Seen, number

_MOST_REASONS = 20
_PIXELS = 133  # of a page, for an inch of a figure


def page_of(seen: Seen, sections: Sequence[Section], pictures: dict[str, bytes],
            runs: Sequence[RunPageLink]) -> str:
    """Returns the whole page. pictures: PNG files by the names of figures. runs: pages beside this one."""
    body = together(_warnings(seen), _in_short(sections), _contents(sections),
                    _heading("Findings", "found") if sections else Markup(),
                    *(_section(section, pictures, _place(i)) for i, section in enumerate(sections)),
                    _heading("Runs", "run"), _run_table(seen), _run_pages(runs), _varied(seen), _failures(seen),
                    _heading("One run again", "again"), _again(seen),
                    _heading("The study file", "file"), element("p", str(seen.setup.file.name), class_="faint"),
                    element("pre", _text(seen.setup.file)), _deck(seen))
    return page("study.html", title=seen.setup.title, subtitle=_subtitle(seen), body=body)


def _heading(title: str, place: str) -> Markup:
    return element("h2", title, id=place)


def _place(section: int) -> str:
    return f"found-{section}"


def _in_short(sections: Sequence[Section]) -> Markup:
    """Returns how each section begins that tells a finding."""
    found = [(i, section) for i, section in enumerate(sections)
             if section.texts and section.title != HOW_TO_READ]
    if not found:
        return Markup()
    lines = [element("li", element("a", section.title, href=f"#{_place(i)}"), ": ", _beginning(section.texts[0]))
             for i, section in found]
    return element("ul", *lines, class_="headline")


def _beginning(text: str) -> str:
    """Returns the finding's first two sentences."""
    return ". ".join(text.split(". ")[:2]).rstrip(".") + "."


def _contents(sections: Sequence[Section]) -> Markup:
    places = [*((section.title, _place(i)) for i, section in enumerate(sections)), ("Runs", "run"),
              ("One run again", "again"), ("The study file", "file")]
    links = [element("li", element("a", title, href=f"#{place}")) for title, place in places]
    return element("nav", element("ul", *links, class_="contents"), aria_label="Contents")


def _subtitle(seen: Seen) -> str:
    meaning = {"ensemble": "One point with many seeds", "grid": "Grid of parameters", "lhs": "Latin hypercube",
               "morris": "Elementary effects (Morris)", "sobol": "Shares of the variance (Sobol')",
               "chaos": "Shares of the variance by polynomial chaos", "calibrate": "Calibration (CMA-ES)",
               "secant": "Calibration (secant)",
               "posterior": "Posterior by MCMC on surrogates"}[seen.method]
    seeds = len({row["seed"] for row in seen.rows})
    return f"{meaning}: {_counted(seen.forecast.points, 'point')}, {_counted(seeds, 'seed')} each"


def _counted(number_of: int, what: str) -> str:
    return f"{number_of} {what}" if number_of == 1 else f"{number_of} {what}s"


def _warnings(seen: Seen) -> Markup:
    said = []
    if not seen.is_complete:
        more = "" if seen.forecast.is_complete else " More points may follow."
        left = "" if math.isnan(seen.forecast.seconds) or not seen.forecast.left else \
            f" About {duration(seen.forecast.seconds)} of one core are left."
        said.append(f"This study is not complete: {seen.forecast.known} of {seen.forecast.runs} runs are done."
                    f"{more}{left} The results below come from these runs alone.")
    if seen.none_because:
        said.append(f"Nothing could be found yet: {seen.none_because}")
    if failed := sum(row["state"] not in (DONE, NOT_RUN) for row in seen.rows):
        said.append(f"{_counted(failed, 'run')} of {len(seen.rows)} gave no value; see below.")
    for name in seen.setup.may_lack:
        if reasons := seen.missing[name]:
            said.append(f"{name} is missing in {_counted(len(reasons), 'run')} of {len(seen.rows)}: "
                        f"{Counter(reasons).most_common(1)[0][0]}.")
    if doubted := [row["reason"] for row in seen.rows if row["state"] == DONE and row["reason"]]:
        said.append(f"{_counted(len(doubted), 'run')} of {len(seen.rows)} gave values to be looked at first: "
                    f"{doubted[0]}.")
    if len(versions := _versions(seen)) > 1:
        said.append(f"The runs are of several physics versions: {', '.join(versions)}.")
    return together(*(element("p", text, class_="warn") for text in said))


def _section(section: Section, pictures: dict[str, bytes], place: str) -> Markup:
    return together(element("h3", section.title, id=place), *(element("p", text) for text in section.texts if text),
                    *(_figure(shown, pictures[shown.name]) for shown in section.figures),
                    *(_table(table) for table in section.tables))


def _figure(shown: Shown, png: bytes) -> Markup:
    pdf, png_file = (element("a", ending.upper(), href=f"{shown.name}.{ending}") for ending in ("pdf", "png"))
    image = picture(png, shown.caption, width=round(_PIXELS * shown.figure.get_figwidth()))
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


def _run_pages(runs: Sequence[RunPageLink]) -> Markup:
    links = [element("li", element("a", link.text, href=link.file)) for link in runs]
    return together(element("p", "Pages of runs:"), element("ul", *links)) if links else Markup()


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
        return element("p", "All runs gave a value.") if said else Markup()
    rows = [[state, str(count), reason] for (state, reason), count in found.most_common(_MOST_REASONS)]
    left = len(found) - len(rows)
    note = f"{left} more reasons stand in the table." if left > 0 else ""
    return _table(PageTable(["state", "runs", "reason"], [[DONE, str(said.count((DONE, ""))), ""], *rows], note))


def _again(seen: Seen) -> Markup:
    if not seen.rows:
        return element("p", "There is no run yet.")
    row = next((row for row in seen.rows if row["state"] == DONE), seen.rows[0])
    values = ", ".join(f"{p.name} = {value_text(p, row[p.column])}" for p in seen.setup.parameters)
    outputs = ", ".join(f"{o.name} = {number(row[o.name])}" for o in seen.setup.outputs)
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
