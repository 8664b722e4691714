"""Options of `pyroclast report`. The compiled part of the package is not needed."""

from __future__ import annotations

import argparse
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """Reads the words behind `pyroclast report`."""
    report = argparse.ArgumentParser(
        prog="pyroclast report", description="Makes a page of a run: one HTML file with its curve, its specimen in all "
        "frames and the reasons to believe it, which needs nothing but a browser. It only reads the run, which may "
        "still go on.")
    report.add_argument("folders", type=Path, nargs="+", metavar="RUN",
                        help="folder of a run; of several runs the page compares them, of a folder of runs it is an "
                        "index")
    report.add_argument("-o", "--out", type=Path, metavar="FILE",
                        help="the page (default: report.html in the folder that is given)")
    return report
