"""Reads the folders that pyroclast writes and draws their figures.

    python3 -m pyroclast.figures run RUN_DIR
    python3 -m pyroclast.figures specimen DIR
    python3 -m pyroclast.figures compare RUN_DIR... --out FILE
    python3 -m pyroclast.figures levels RUN_DIR... --out FILE
    python3 -m pyroclast.watch RUN_DIR

In a script:

    from pyroclast.run import Run
    run = Run("runs/compression")
    print(run.peak, run.history["stress_MPa"].max())
"""
