"""Options of `pyroclast study`. The compiled part of the package is not needed here: the manual page reads them too."""

from __future__ import annotations

import argparse
from pathlib import Path

from .choices import EXECUTORS, KEEP

_OF_DECKS = ("scatter", "converge")  # commands that make a study of a deck


def parser() -> argparse.ArgumentParser:
    """Reads the words behind `pyroclast study`; `do` is the name of the command."""
    study = argparse.ArgumentParser(prog="pyroclast study", description="From one run to a thousand: sensitivity, "
                                    "scatter, calibration. docs/do/studies.md tells what a study file holds.")
    study.add_argument("--program", help=argparse.SUPPRESS)  # by which `pyroclast study` names itself
    commands = study.add_subparsers(required=True, metavar="COMMAND")

    def command(name: str, meaning: str) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=meaning, description=meaning)
        added.set_defaults(do=name, allow_code=False)
        if name != "keys":
            added.add_argument("--allow-code", action="store_true",
                               help="let code that the study and its deck name run, now and until it changes; read it "
                               "first")
            added.add_argument("study", metavar="DECK" if name in _OF_DECKS else "STUDY",
                               help=f"TOML file that describes the {'run' if name in _OF_DECKS else 'study'}")
        return added

    run = command("run", "Make the runs of a study that are missing; what is done is never run again")
    run.add_argument("--executor", choices=EXECUTORS, default="local", help="where the runs are made")
    run.add_argument("-j", "--jobs", type=_positive, help="runs at once on this machine (default: its cores)")
    run.add_argument("--keep", choices=KEEP, help="what stays of each run that is made now (default: as the file says)")
    run.add_argument("--dry-run", action="store_true", help="only say how many runs, how long and how much disk")
    run.add_argument("--again", action="store_true", help="make runs that crashed or timed out once more")
    run.add_argument("--quiet", action="store_true", help="print nothing but errors")
    command("check", "Check a study file, the ends of its ranges, and all points that are known beforehand")
    command("status", "Say what is done, what failed and why, and what is left")
    table = command("table", "Write the table of all runs as CSV")
    table.add_argument("-o", "--out", type=Path, help="file (default: table.csv in the folder of the study; -: here)")
    report = command("report", "Draw the figures of a study, and one page that gathers them")
    report.add_argument("-o", "--out", type=Path, metavar="FOLDER",
                        help="where they go (default: report in the folder of the study, which is then written to)")
    scatter = command("scatter", "Make several specimens of a deck, and say each result with its mean and interval; the same "
                      "as `pyroclast run DECK --seeds N`")
    scatter.add_argument("--seeds", type=_positive, default=5, help="number of specimens (default: 5)")
    scatter.add_argument("--no-figures", action="store_true", help="draw no figures")
    converge = command("converge", "Say what half the rate, half the exchange step, and half and double the block size move; "
                       "the same as `pyroclast converge DECK`")
    converge.add_argument("--seeds", type=_positive, default=3, help="number of specimens of each (default: 3)")
    converge.add_argument("--dry-run", action="store_true", help="only say how many runs, and how long")
    for several in (scatter, converge):
        several.add_argument("--seed", type=int, default=1, help="first seed (default: 1)")
        several.add_argument("--set", action="append", metavar="KEY=VALUE", help="another value for a key of the deck")
        several.add_argument("-o", "--out", type=Path, metavar="FOLDER",
                             help="where they go (default: runs/<deck>-seeds, runs/<deck>-converge)")
        several.add_argument("-j", "--jobs", type=_positive, help="runs at once on this machine (default: its cores)")
        several.add_argument("--quiet", action="store_true", help="print nothing but errors")
    keys = command("keys", "Print every key that a study file may hold, as Markdown")
    keys.add_argument("--schema", action="store_true",
                      help="as a JSON Schema (draft 4), with which editors complete and check study files")
    return study


def _positive(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("must be 1 or more")
    return number
