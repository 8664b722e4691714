"""Loads that give way to motions from stage to stage, and motions to loads. PYROCLAST names the program."""

import csv
import json
import unittest

from in_a_folder import InAFolder

E, NU = 30e9, 0.2  # Pa
SOFTER = 1e-3  # by contacts, see t_b below, and by what is left of the motion at rest
SIZE = {"x": 0.06, "y": 0.09, "z": 0.04}  # m
SPEED = 1e-3  # m/s
HELD = {"x": "left", "y": "bottom", "z": "front"}
PRESSED = {"x": "right", "y": "top", "z": "back"}

MORTAR = """
[blocks]
count = 4
{spread}
[materials.mortar]
density = "2200 kg/m3"
E = "30 GPa"
nu = 0.2
[contacts]
t_b = "20 um"  # two contacts over the height make it softer by 4e-4
t_b_scaling = "fixed"
[contacts.mortar_mortar]
law = "elastic"
[mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = "0 m/s2"
"""


def stage(keys: str, *drives: str) -> str:
    return f'[[stages]]\nkind = "drive"\n{keys}\n' + "".join(f"[[stages.drives]]\n{drive}\n" for drive in drives)


def to_rest(*drives: str) -> str:
    return stage('duration = "2 s"\nunbalanced_ratio = 1e-6\nlook_interval = "10 ms"', *drives)


def for_a_time(*drives: str) -> str:
    return stage('duration = "30 ms"\nlook_interval = "1 ms"', *drives)


def hold(name: str, component: str) -> str:
    return f'set = "{name}"\nhold = ["{component}"]'


def press(name: str, pressure: str = "5 MPa") -> str:
    return f'set = "{name}"\npressure = "{pressure}"\nramp_time = "10 ms"'


def push(name: str, force: str, direction: list[float]) -> str:
    return f'set = "{name}"\nforce = "{force}"\ndirection = {direction}'


def move(name: str, component: str = "y", speed: float = -SPEED) -> str:
    return f'set = "{name}"\nvelocity = "{speed} m/s"\ndirection = "{component}"\nramp_time = "10 ms"'


class BetweenStages(InAFolder):
    def deck(self, axes: str, stages: str, more: str = "") -> str:
        depth = f'depth = "{SIZE["z"]} m"\n' if "z" in axes else 'thickness = "40 mm"\n'
        records = "".join(f'[[record]]\nname = "{axis}"\nkind = "stress"\nset = "specimen"\ndirection = "{axis}"\n'
                          f'[[record]]\nname = "reaction_{axis}"\nkind = "force"\nset = "{PRESSED[axis]}"\n'
                          f'direction = "-{axis}"\n' for axis in axes)
        return (f'title = "between"\n[specimen]\nwidth = "{SIZE["x"]} m"\nheight = "{SIZE["y"]} m"\n{depth}seed = 1\n'
                + MORTAR.format(spread="radius_spread = 0.3" if "z" in axes else "shortest_edge = 0.3") + more + records
                + stages)

    def run_deck(self, text: str, code: int = 0) -> str:
        (self.folder / "deck.toml").write_text(text)
        done = self.pyroclast("run", "deck.toml", "-o", "out", "--overwrite", "--no-figures", "--quiet", code=code)
        return done.stderr

    def ends(self) -> list[dict[str, float]]:
        """The last row of each stage."""
        with open(self.folder / "out/history.csv", newline="", encoding="utf-8") as file:
            rows = {row["stage"]: row for row in csv.DictReader(file)}
        return [{name: float(cell) for name, cell in row.items() if cell} for row in rows.values()]

    def confined(self, axes: str) -> str:
        return to_rest(*(hold(HELD[axis], axis) for axis in axes), *(press(PRESSED[axis]) for axis in axes))

    def test_a_pressure_gives_way_to_a_velocity_in_the_plane_and_in_space(self):
        """The usual triaxial test: an elastic body under a pressure p all around is pressed on by u at one end. Its
        stress is there p + E u / h, in plane stress and in space, and p elsewhere; no energy comes from nowhere."""
        for axes in ("xy", "xyz"):
            with self.subTest(axes):
                driven = for_a_time(move("top")) + to_rest(hold("left", "x"))
                self.run_deck(self.deck(axes, self.confined(axes) + driven))
                confined, driven, rest = self.ends()
                for axis in axes:
                    self.assertAlmostEqual(confined[f"{axis}_MPa"], -5.0, delta=1e-4)
                way = SPEED * 0.025  # half of the ramp, then 20 ms
                stress = 5.0 + 1e-6 * E * way / SIZE["y"]
                self.assertAlmostEqual(rest["y_MPa"], -stress, delta=SOFTER * stress)
                for axis in axes.replace("y", ""):
                    self.assertAlmostEqual(rest[f"{axis}_MPa"], -5.0, delta=5e-4)
                # who drives the faces bears all that they bear: at once what the pressure bore, at rest p A + E u A / h
                area = SIZE["x"] * SIZE["z"]
                self.assertAlmostEqual(confined["reaction_y_N"], 5e6 * area, delta=1.0)
                self.assertAlmostEqual(rest["reaction_y_N"], 1e6 * stress * area, delta=SOFTER * 1e6 * stress * area)
                summary = json.loads((self.folder / "out/summary.json").read_text())
                self.assertLess(abs(summary["energy_J"]["error_over_turnover"]), 1e-3)
                self.assertEqual(summary["warnings"], [])

    def test_the_pressure_is_over_once_its_faces_are_let_go_again(self):
        axes = "xy"
        self.run_deck(self.deck(axes, self.confined(axes) + for_a_time(move("top"))
                                + to_rest('set = "top"\nrelease = ["y"]')))
        self.assertAlmostEqual(self.ends()[2]["y_MPa"], 0.0, delta=1e-4)
        self.assertAlmostEqual(self.ends()[2]["x_MPa"], -5.0, delta=5e-4)

    def test_a_pressure_all_around_stays_on_the_faces_that_are_not_driven(self):
        everywhere = '[[sets]]\nname = "around"\nof = "faces"\nbox = [["0 mm", "0 mm"], ["60 mm", "90 mm"]]\n'
        self.run_deck(self.deck("xy", to_rest(hold("left", "x"), hold("bottom", "y"), press("around"))
                                + for_a_time(move("top")) + to_rest(hold("left", "x")), everywhere))
        _, _, rest = self.ends()
        self.assertAlmostEqual(rest["x_MPa"], -5.0, delta=5e-4)
        self.assertAlmostEqual(rest["y_MPa"], -5.0 - 1e-6 * E * SPEED * 0.025 / SIZE["y"], delta=SOFTER * 13.3)

    def test_a_force_gives_way_along_the_motion_and_stays_across_it(self):
        forces = to_rest(hold("bottom", "x"), hold("bottom", "y"), push("top", "12 kN", [0, -1]),
                         push("top", "1.2 kN", [1, 0]))
        shear = '[[record]]\nname = "shear"\nkind = "force"\nset = "bottom"\ndirection = "-x"\n'
        self.run_deck(self.deck("xy", shear + forces + for_a_time(move("top")) + to_rest(hold("bottom", "x"))))
        loaded, _, rest = self.ends()
        self.assertAlmostEqual(loaded["reaction_y_N"], 12e3, delta=1.0)
        self.assertAlmostEqual(loaded["shear_N"], 1.2e3, delta=1.0)
        self.assertGreater(rest["reaction_y_N"], 12e3)
        self.assertAlmostEqual(rest["shear_N"], 1.2e3, delta=1.0)

    def test_what_is_held_takes_over_as_what_is_driven_does(self):
        self.run_deck(self.deck("xyz", self.confined("xyz") + to_rest(hold("top", "y"), hold("back", "z"))
                                + to_rest('set = "right"\npressure = "0 Pa"\nramp_time = "10 ms"')))
        _, held, free = self.ends()
        for axis in "xyz":
            self.assertAlmostEqual(held[f"{axis}_MPa"], -5.0, delta=1e-4)
        self.assertAlmostEqual(free["x_MPa"], 0.0, delta=1e-4)
        # y and z are held where they are: s_y = s_z = -5 + nu 5 / (1 - nu)
        self.assertAlmostEqual(free["y_MPa"], -5.0 + NU * 5.0 / (1.0 - NU), delta=1e-3)

    def test_a_load_on_what_is_driven_names_both_places_and_the_way_out(self):
        for load in (press("top"), push("top", "5 kN", [0, -1])):
            with self.subTest(load):
                driven = to_rest(hold("left", "x"), hold("bottom", "y")) + for_a_time(move("top"))
                said = self.run_deck(self.deck("xy", driven + to_rest(load)), code=1)
                self.assertRegex(said, r"deck\.toml:\d+: stages\[2\]\.drives\[0\]: a (pressure|force) acts")
                self.assertRegex(said, r"\(deck\.toml:\d+: stages\[1\]\.drives\[0\]\): (end the force by one of 0 N, or )?"
                                       r'let go of it in this stage, by a drive with set = "top", release = \["y"\]')
                self.run_deck(self.deck("xy", driven + to_rest(load, 'set = "top"\nrelease = ["y"]')))
                stress = 5.0 if "pressure" in load else 5e-3 / (SIZE["x"] * SIZE["z"])
                self.assertAlmostEqual(self.ends()[2]["y_MPa"], -stress, delta=1e-4 * stress)

    def test_a_load_on_what_the_same_stage_holds_is_refused_at_its_place(self):
        for load in (press("top"), push("top", "5 kN", [0, -1]),
                     push("top", "5 kN", [0, -1]) + '\nfactor = { table = [["0 s", 0], ["1 s", 1], ["2 s", 0]] }'):
            with self.subTest(load):
                said = self.run_deck(self.deck("xy", to_rest(hold("left", "x"), hold("bottom", "y"), hold("top", "y"),
                                                             load)), code=1)
                self.assertRegex(said, r"stages\[0\]\.drives\[3\]: a (pressure|force) acts")
                self.assertRegex(said, r"stages\[0\]\.drives\[2\]\): (end the force by one of 0 N, or )?leave one of the two")

    def test_a_force_of_which_a_part_comes_to_be_held_names_both_places_and_the_way_out(self):
        corner = '[[sets]]\nname = "corner"\nwithin = "top"\nnearest = ["0 mm", "90 mm"]\n'
        loaded = to_rest(hold("left", "x"), hold("bottom", "y"), push("top", "5 kN", [0, -1]))
        said = self.run_deck(self.deck("xy", loaded + for_a_time(move("corner")), corner), code=1)
        self.assertRegex(said, r'deck\.toml:\d+: stages\[1\]\.drives\[0\]: from here on a part of set "top" is held')
        self.assertRegex(said, r"\(deck\.toml:\d+: stages\[0\]\.drives\[2\]\): end the force in this stage, by one of 0 N")
        ended = push("top", "0 N", [0, -1])
        self.run_deck(self.deck("xy", loaded + for_a_time(move("corner"), ended), corner))
        self.run_deck(self.deck("xy", loaded + for_a_time(move("corner"), ended + '\nramp_time = "10 ms"'), corner), code=1)


if __name__ == "__main__":
    unittest.main()
