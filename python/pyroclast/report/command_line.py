"""Options of `pyroclast report`. The compiled part of the package is not needed."""

from __future__ import annotations

import argparse
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """Reads the words behind `pyroclast report`."""
    report = argparse.ArgumentParser(
        prog="pyroclast report", description="Makes the page of a run: one HTML file for any browser, with the curve, "
        "the specimen in all frames, and the reasons for and against the results. Reads the run only, which may be in "
        "progress.")
    report.add_argument("folders", type=Path, nargs="+", metavar="RUN",
                        help="folder of a run; several for a comparison; a folder of runs for an index")
    report.add_argument("-o", "--out", type=Path, metavar="FILE",
                        help="file for the page (default: report.html in the given folder)")
    return report
