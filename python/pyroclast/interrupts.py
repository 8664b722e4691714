"""Ctrl-C in the programs of the package."""

import signal


def hear_ctrl_c() -> None:
    """Makes Ctrl-C raise KeyboardInterrupt. `pyroclast` starts Python so that it ends at once while modules load."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
        signal.signal(signal.SIGINT, signal.default_int_handler)
