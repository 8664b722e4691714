"""Three-point bending of a notched beam: its work of fracture over the ligament (RILEM TC 50), and where it goes."""

from pathlib import Path

import pyroclast
from pyroclast import N, m, mm
from scipy.integrate import trapezoid

G_f, LENGTH, DEPTH, NOTCH = 60 * N / m, 200 * mm, 50 * mm, 20 * mm
starter = pyroclast.Deck(Path(__file__).parents[2] / "cases" / "starter.toml")
bearings = [{"name": name, "at": [x * mm, y], "width": 16 * mm, "thickness": 8 * mm, "contact": "glued"}
            for name, x, y in (("left", 20, 0 * mm), ("right", 180, 0 * mm), ("load", 100, DEPTH))]
stage = {"kind": "drive", "duration": "0.6 s", "until": [{"record": "load", "share_of_peak": 0.05}], "drives": [
    {"set": "left_pivot", "hold": ["x", "y"]}, {"set": "right_pivot", "hold": ["y"]},
    {"set": "load_pivot", "velocity": "-0.5 mm/s", "direction": "y", "ramp_time": "20 ms"}]}
deck = pyroclast.Deck(
    title="Notched beam", stages=[stage], bearings=bearings, blocks={"count": 600, "shortest_edge": 0.2},
    specimen={"width": LENGTH, "height": DEPTH, "thickness": "0.1 m", "seed": 1,
              "notches": [{"mouth": [LENGTH / 2, 0 * mm], "tip": [LENGTH / 2, NOTCH]}]},
    record=[{"name": "load", "kind": "force", "set": "load_pivot", "direction": "-y"},
            {"name": "deflection", "kind": "displacement", "set": "load_pivot", "direction": "-y"}],
    materials={name: starter[f"materials.{name}"] for name in ("mortar", "platen")}, output={"fields": False},
    contacts={key: starter["contacts"][key] for key in ("t_b", "t_b_scaling", "t_b_block_size", "mortar_mortar")},
    mechanics=starter["mechanics"] | {"gravity": "0 m/s2"})
history = (run := pyroclast.Run(deck).finish()).history
ligament = 0.1 * (DEPTH.to("m") - NOTCH.to("m"))
W_f = trapezoid(history["load"], history["deflection"]) / ligament
tension, shear = (history[f"dissipated_{mode}"][-1] / ligament for mode in ("tension", "shear"))
print(f"{history['load'].max():.0f} N; work {W_f:.0f} J/m2, by tension {tension:.0f} and by shear {shear:.0f} J/m2")
assert 0.85 < tension / G_f.to("J/m2") < 1.4, "of a crack that goes around blocks"
