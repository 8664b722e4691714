"""How the programs of the package speak, and how they end."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from .errors import CodeNotAllowed, Error
from .texts import seen, seen_on_a_line

INTERRUPTED = 130
"""Exit code of a program that Ctrl-C or SIGTERM ends."""

_PATIENCE = 2.0  # s from the first signal, after which another one ends a program at once


def load_libraries(is_alone: bool) -> None:
    """Loads Matplotlib with its own settings. Without this, Matplotlib would look for a matplotlibrc as it loads, in
    the current folder first.

    is_alone: nothing else runs in this process or is started by it; then HDF5 loads no filters, which are code.
    """
    if is_alone:
        os.environ["HDF5_PLUGIN_PRELOAD"] = "::"
    here, stated = os.open(".", os.O_PATH), os.environ.get("MATPLOTLIBRC")
    try:
        os.chdir("/")
        os.environ["MATPLOTLIBRC"] = os.devnull
        import matplotlib  # noqa: F401
    finally:
        os.fchdir(here)
        os.close(here)
        if stated is None:
            del os.environ["MATPLOTLIBRC"]
        else:
            os.environ["MATPLOTLIBRC"] = stated


def say(line: object) -> None:
    """Prints a line at once; what would act on a terminal is written out."""
    print(seen_on_a_line(str(line)), flush=True)


def complain(text: object, of: str = "error") -> None:
    """Writes a text of one or more lines to stderr, as `say` does. of: what it is, or whose."""
    print(seen(f"{of}: {text}"), file=sys.stderr)


def run_program(program: Callable[[], int], of: str = "error") -> int:
    """Runs a program and returns its exit code: 1 where it raises Error or OSError, which it complains of; 3 where code
    has to be allowed first; INTERRUPTED where it is ended.
    """
    try:
        with _ctrl_c_heard():
            return program()
    except KeyboardInterrupt:
        return INTERRUPTED
    except CodeNotAllowed as problem:
        complain(problem, of)
        return 3
    except BrokenPipeError:  # who read it has gone
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as problem:
        complain(f"{problem.filename}: {problem.strerror}" if problem.filename else problem, of)
    except Error as problem:
        complain(problem, of)
    return 1


@contextmanager
def _ctrl_c_heard() -> Iterator[None]:
    """Makes the first Ctrl-C or SIGTERM raise KeyboardInterrupt, upon which the program removes its unfinished files. A
    second signal ends the program at once, but only later than _PATIENCE. While modules load, Ctrl-C ends Python at
    once, because `pyroclast` starts it so.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    first: list[float] = []

    def end(number: int, frame: FrameType | None) -> None:
        if not first:
            first.append(time.monotonic())
            raise KeyboardInterrupt
        if time.monotonic() - first[0] > _PATIENCE:
            os._exit(INTERRUPTED)

    before = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)
              if signal.getsignal(each) in (signal.SIG_DFL, signal.default_int_handler)}
    for each in before:
        signal.signal(each, end)
    try:
        yield
    finally:
        if not first:
            for each, handler in before.items():
                signal.signal(each, handler)
