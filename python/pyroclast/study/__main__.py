"""The command line: `pyroclast study run|check|status|table|report|keys STUDY.toml`."""

from __future__ import annotations

import argparse
import collections
import math
import sys
from collections.abc import Callable
from dataclasses import replace

from .. import _core
from ..errors import Error
from ..programs import INTERRUPTED, complain, load_libraries, run_program, say
from ..writing import shell_path
from .command_line import parser
from .driver import NOT_RUN, WITH_A_BEST, duration
from .executors.commands import Commands
from .file import reference, schema
from .foresight import foresee, say_time
from .parameters import Value
from .study import Study

_INTRODUCTION = """# Study reference

Every table and key that a study file may hold, printed by the code that reads study files (`pyroclast study keys`).
[Studies](../do/studies.md) tells what they are for. A value with a dimension is written with its unit; a default of "–"
means: the key may be left out, and nothing takes its place.

"""
_FAR = 30.0  # distance of an output from its target, over the smaller of both, that tells of another unit


def main(words: list[str]) -> int:
    """Runs the program; returns the exit code: 0 done, 2 runs are missing, 3 code must be allowed, 1 another error."""
    return run_program(lambda: _do(words))


def _do(words: list[str]) -> int:
    options = parser().parse_args(words)
    if options.allow_code:
        _core.allow_code()
    return _COMMANDS[options.do](options)


def _speech(options: argparse.Namespace) -> Callable[[str], None]:
    """Prints lines of progress, or nothing where that was asked for."""
    return (lambda line: None) if options.quiet else say


def _study(options: argparse.Namespace) -> Study:
    return Study(options.study, program=options.program)


def _run(options: argparse.Namespace) -> int:
    study = _study(options)
    if options.keep:
        study.setup = replace(study.setup, keep=options.keep)
    if options.dry_run:
        return _foresee(study)
    if options.again:
        study.forget_failures()
    say = _speech(options)
    executor = study.executor(options.executor, options.jobs)
    is_complete = study.run(executor, say=say)
    table = study.setup.folder / "table.csv"
    if isinstance(executor, Commands) and executor.written:
        say(f"{executor.written} commands are in {executor.file}, and for Slurm in {executor.script}; when they are "
            "done, the same command takes them in")
        return 0
    if not is_complete:
        say(f"stopped; to go on: pyroclast study run {shell_path(options.study)}")
        return INTERRUPTED
    say(f"table           {table}")
    if not study.count_values():
        reasons = {str(row["reason"]) for row in study.rows()}
        complain(f"no run gave a value: {'; '.join(sorted(reasons)[:3])}")
        return 1
    for line in study.warnings():
        say(f"warning         {line}")
    is_met = _say_best(study, say) if study.setup.method.kind in WITH_A_BEST else True
    say(f"to draw it      pyroclast study report {shell_path(options.study)}")
    return 0 if is_met else 1


def _say_best(study: Study, say: Callable[[str], None]) -> bool:
    """Says which point comes nearest to the targets, and writes its deck; whether a secant met them, by values that no
    run puts in doubt.
    """
    setup = study.setup
    try:
        found = study.findings
    except Error as error:
        complain(error)
        return False
    values = [p.distribution.at(u) for p, u in zip(setup.parameters, found["best"]["u"])]
    say("best point      " + ", ".join(f"{p.name} = {_shown(v)} {p.unit}".rstrip()
                                       for p, v in zip(setup.parameters, values)))
    units = {output.name: "" if output.unit == "1" else f" {output.unit}" for output in setup.outputs}
    far, doubts = [], found["best"]["doubts"]
    for target, y in zip(setup.targets, found["best"]["y"]):
        value, unit = target.value, units[target.output]
        off = f": {100.0 * (y / value - 1.0):+.1f} %" if value else ""
        say(f"                {target.output} {y:.4g}{unit}, wanted {value:g}{unit}{off}"
            f"{', does not count as met' if target.output in doubts else ''}")
        if unit and abs(y - value) > _FAR * min(abs(y), abs(value)) > 0.0:
            far.append(f"targets.{target.output} counts in{unit} and is far from all that the runs gave: is another "
                       f"unit meant, write it, as in \"{y:.3g}{unit}\"")
    if deck := study.write_best():
        say(f"its deck        {deck}")
    if found.get("is_met", not doubts):
        for line in far:
            say(f"warning         {line}")
        return True
    at_end = [f"{p.name} = {_shown(v)}" for p, v, u in zip(setup.parameters, values, found["best"]["u"])
              if not 0.0 < u < 1.0]
    end = [f"{' and '.join(at_end)}: at the end of the range"] if at_end else []
    in_doubt = [f"{output}: {why}" for output, why in doubts.items()]
    complain(f"the targets are not met: {'; '.join([found['finished'], *end, *far, *in_doubt])}")
    return False


def _shown(value: Value) -> str:
    return f"{value:d}" if isinstance(value, int) else f"{value:.4g}"


def _checked(study: Study) -> None:
    for warning in study.check():
        complain(warning, "warning")


def _foresee(study: Study) -> int:
    _checked(study)
    foresee(study, say)
    return 0


def _check(options: argparse.Namespace) -> int:
    study = _study(options)
    _checked(study)
    study.require_options()
    seen = study.forecast()
    say(f"{options.study} is valid: {study.setup.title}; {_counted(seen.points, 'point')}, {_counted(seen.runs, 'run')}"
          + ("" if seen.is_complete else " to begin with"))
    if seen.left and study.setup.runner.kind == "pyroclast":
        say_time(study, seen, say)
    return 0


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def _status(options: argparse.Namespace) -> int:
    study = _study(options)
    seen = study.forecast()
    say(f"study           {study.setup.title} ({study.setup.method.kind})")
    say(f"runs            {seen.known} of {seen.runs} done" + ("" if seen.is_complete else "; more points may follow"))
    if not math.isnan(seen.seconds) and seen.left:
        say(f"left            {duration(seen.seconds)} of one core")
    if outdated := study.count_outdated():
        say(f"outdated        {outdated}, made of other code, another deck or another version")
    if begun := study.count_begun():
        say(f"begun           {begun}, under way or broken off")
    table = study.rows()
    states = collections.Counter(row["state"] for row in table)
    for state, count in states.most_common():
        say(f"{state:<15} {count}")
    reasons = collections.Counter((row["state"], row["reason"]) for row in table if row["reason"])
    for (state, reason), count in reasons.most_common(10):
        say(f"{count:>6} x {state}: {reason}")
    return 0 if seen.is_complete and not seen.left else 2


def _table(options: argparse.Namespace) -> int:
    study = _study(options)
    if all(row["state"] == NOT_RUN for row in study.rows()):
        complain("there is no table yet, for no run is done; to make them: pyroclast study run "
                 f"{shell_path(options.study)}", str(study.setup.folder))
        return 2
    if options.out is None:
        say(study.write_table())
    elif str(options.out) == "-":
        sys.stdout.write(study.table_text())
    else:
        options.out.write_text(study.table_text(), encoding="utf-8")
    return 0


def _report(options: argparse.Namespace) -> int:
    load_libraries(is_alone=False)
    from .report import write_report

    say(write_report(_study(options), options.out))
    return 0


def _keys(options: argparse.Namespace) -> int:
    print(schema() if options.schema else f"{_INTRODUCTION}{reference()}", end="")
    return 0


def _scatter(options: argparse.Namespace) -> int:
    load_libraries(is_alone=False)
    from . import scatter

    return scatter.run(options, _speech(options))


def _converge(options: argparse.Namespace) -> int:
    load_libraries(is_alone=False)
    from . import converge

    return converge.run(options, _speech(options))


_COMMANDS = {"run": _run, "scatter": _scatter, "converge": _converge, "check": _check, "status": _status,
             "table": _table, "report": _report, "keys": _keys}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
