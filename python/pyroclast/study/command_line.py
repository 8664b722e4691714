"""Options of `pyroclast study`. The compiled part of the package is not needed here: the manual page reads them too."""

from __future__ import annotations

import argparse
from pathlib import Path

from .choices import EXECUTORS, KEEP

_OF_DECKS = ("scatter", "converge")  # commands that make a study of a deck


def parser() -> argparse.ArgumentParser:
    """Reads the words behind `pyroclast study`; `do` is the name of the command."""
    study = argparse.ArgumentParser(prog="pyroclast study", description="Makes many runs of a deck: scatter, "
                                    "sensitivity, calibration. docs/do/studies.md explains study files.")
    study.add_argument("--program", help=argparse.SUPPRESS)  # by which `pyroclast study` names itself
    commands = study.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, meaning: str) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=meaning, description=meaning)
        added.set_defaults(do=name, allow_code=False)
        if name != "keys":
            added.add_argument("--allow-code", action="store_true",
                               help="allow the code that the study and its deck name, until the code changes; read the "
                               "code first")
            added.add_argument("study", metavar="DECK" if name in _OF_DECKS else "STUDY",
                               help=f"TOML file that describes the {'run' if name in _OF_DECKS else 'study'}")
        return added

    run = command("run", "Make the missing runs of a study; finished runs are never made again")
    run.add_argument("--executor", choices=EXECUTORS, default="local", help="where the runs are made")
    run.add_argument("-j", "--jobs", type=_positive, help="runs at once on this machine (default: its cores, over the ranks of a run)")
    run.add_argument("--keep", choices=KEEP, help="files to keep of each new run (default: as the study file says)")
    run.add_argument("--dry-run", action="store_true",
                     help="tell the number of runs, their time and disk space; run nothing")
    run.add_argument("--again", action="store_true", help="make runs that crashed or timed out again")
    run.add_argument("--quiet", action="store_true", help="print errors only")
    command("check", "Check a study file, the ends of its ranges, and all points known in advance")
    command("status", "List the finished runs, the failed runs with reasons, and the missing runs")
    table = command("table", "Write the table of all runs as CSV")
    table.add_argument("-o", "--out", type=Path,
                       help="file (default: table.csv in the folder of the study; -: standard output)")
    report = command("report", "Draw the figures of a study, and one page with all of them")
    report.add_argument("-o", "--out", type=Path, metavar="FOLDER",
                        help="folder for the report; the study's own then stays as it is (default: report in the "
                        "folder of the study)")
    scatter = command("scatter", "Run several specimens of a deck, and print each result with its mean and interval; the "
                      "same as `pyroclast run DECK --seeds N`")
    scatter.add_argument("--seeds", type=_positive, default=5, help="number of specimens (default: 5)")
    scatter.add_argument("--no-figures", action="store_true", help="draw no figures")
    converge = command("converge", "Tell how far results move with half the rate, half the exchange step, and "
                       "half and double the block size; the same as `pyroclast converge DECK`")
    converge.add_argument("--seeds", type=_positive, default=3, help="number of specimens of each variant (default: 3)")
    for several in (scatter, converge):
        several.add_argument("--dry-run", action="store_true",
                             help="tell the number of runs and their time; run nothing")
        several.add_argument("--seed", type=int, default=1, help="first seed (default: 1)")
        several.add_argument("--set", action="append", metavar="KEY=VALUE",
                             help="change a key of the deck, or add a key")
        several.add_argument("-o", "--out", type=Path, metavar="FOLDER",
                             help="folder for the runs (default: runs/<deck>-seeds, runs/<deck>-converge)")
        several.add_argument("-j", "--jobs", type=_positive, help="runs at once on this machine (default: its cores)")
        several.add_argument("--quiet", action="store_true", help="print errors only")
    keys = command("keys", "Print all keys of study files, as Markdown")
    keys.add_argument("--schema", action="store_true",
                      help="print a JSON Schema (draft 4), with which editors complete and check study files")
    return study


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be 1 or more")
    return number
