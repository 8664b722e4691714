"""Bodies other than prisms: their sets and records, and drives, in stages and at run time."""

import gc

import numpy as np

import pyroclast
from pyroclast import MPa, kN, mm, s
from small import Case, plate

PULL = {"set": "right", "velocity": "1 mm/s", "direction": "x", "ramp_time": "1 ms"}


class Bodies(Case):
    def test_a_body_is_made_by_keyword_arguments_and_arrays(self):
        corners = np.array([[0, 0], [60, 0], [60, 20], [30, 40], [0, 40]]) * mm
        made = plate(specimen={"shape": "polygon", "corners": corners, "thickness": "0.1 m", "seed": 2,
                               "holes": [{"centre": [20 * mm, 20 * mm], "diameter": "12 mm"}]},
                     record=[{"name": "pull", "kind": "force", "set": "side_5", "direction": "x"}],
                     stages=[{"kind": "drive", "duration": "1 ms",
                              "drives": [{"set": "side_5", "hold": ["x", "y"]}]}])
        run = pyroclast.Run(made, threads=1)
        self.assertIn("hole_1", run.sets)
        corners = run.position[run.zones]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()
        self.assertAlmostEqual(area / (60e-3 * 40e-3 - 0.5 * 30e-3 * 20e-3 - np.pi * 6e-3**2), 1.0, places=9)
        self.assertAlmostEqual(run.specimen.extent, area, places=12)

    def test_sets_are_indices_and_records_columns(self):
        made = plate(sets=[{"name": "halves", "of": "contacts", "box": [["25 mm", "0 mm"], ["35 mm", "40 mm"]]}],
                     record=[{"name": "stretch", "kind": "opening", "set": "left", "other": "right", "direction": "x"},
                             {"name": "pull", "kind": "force", "set": "right", "direction": "x"},
                             {"name": "across", "kind": "stress", "set": "specimen", "direction": "x"},
                             {"name": "cracks", "kind": "crack_length", "set": "halves"}])
        run = pyroclast.Run(made, threads=1)
        state = run.until(quantity={"stretch": 1e-6})
        left, right = run.sets["left"], run.sets["right"]
        np.testing.assert_array_equal(run.position[left, 0], 0.0)
        np.testing.assert_array_equal(run.position[right, 0], 60e-3)
        self.assertEqual(run.sets["specimen"].size, len(run.position))
        self.assertEqual(len(np.unique(left)), len(left))
        moved = run.fields.displacement[:, 0]
        self.assertAlmostEqual(state.stretch / (moved[right].mean() - moved[left].mean()), 1.0, delta=0.01)
        self.assertAlmostEqual(state.pull / (state.across * 40e-3 * 0.1), 1.0, delta=0.05)
        self.assertEqual(run.history.units["pull_N"], "N")
        x = run.contacts()["x_m"].to_numpy()[run.contact_sets["halves"]]
        self.assertTrue(len(x) and (x >= 25e-3 - 1e-12).all() and (x <= 35e-3 + 1e-12).all())
        with self.assertRaises(KeyError):
            run.sets["nowhere"]

    def test_a_factor_is_a_function_of_the_time_of_its_stage(self):
        made = plate()
        made["stages[0].duration"] = "2 ms"
        made.append("stages[0].drives", set="right", force="2 kN", direction=[1, 0],
                    factor=lambda t: np.sin(np.pi * t / 2e-3)**2)
        del made["stages[0].drives[1]"]
        made["stages[0].look_interval"] = "0.1 ms"
        out = self.folder() / "run"
        run = pyroclast.Run(made, out=out, threads=1)
        for _ in run:
            pass
        load = run.history["pull"][1:]
        time = np.arange(1, len(load) + 1) * 0.1e-3
        np.testing.assert_allclose(load, 2e3 * np.sin(np.pi * time / 2e-3)**2, atol=60.0)
        run.then("drive", duration="0.4 ms", drives=[{"set": "right", "force": "1 kN", "direction": [1, 0],
                                                     "factor": lambda t: t / 4e-4}]).finish()
        self.assertAlmostEqual(run.history["pull"][-1], 1e3, delta=40.0)
        again = pyroclast.Run(out / "deck.toml", threads=1).finish()
        np.testing.assert_array_equal(again.history["pull"], run.history["pull"])


    def test_a_function_that_fails_leaves_the_run_as_it_was(self):
        run = pyroclast.Run(plate(), threads=1)
        run.next()
        for factor, told in ((lambda t: 1 / 0, "raises ZeroDiv"), (lambda t: np.nan, "gives nan")):
            with self.assertRaisesRegex(pyroclast.Error, rf"stages\[1\].drives\[0\].factor: the function, .* {told}"):
                run.then("drive", duration="1 ms", drives=[{"set": "right", "velocity": "1 mm/s", "direction": "x",
                                                            "factor": factor}])
        run.finish()
        self.assertEqual((run.outcome, len(run.summary["stages"])), ("completed", 1))

    def test_properties_become_functions_in_a_run(self):
        run = pyroclast.Run(plate(), threads=1)
        run.until(quantity={"pull_N": 1500.0})
        before = np.diff(run.history["pull"])[-1]
        run.change({"materials.mortar.E": lambda T: 15e9 - 1e6 * (T - 20.0)})
        run.next()
        run.next()
        self.assertLess(np.diff(run.history["pull"])[-1], 0.8 * before)
        self.assertIn("csv", run.deck_text)


class Drives(Case):
    """At run time."""

    def run_(self, **tables) -> pyroclast.Run:
        run = pyroclast.Run(plate(**tables), threads=1)
        run.next()
        run.next()
        return run

    def test_a_force_a_pressure_and_a_velocity_act_from_now_on(self):
        for keys in ({"force": 4 * kN, "direction": [1, 0]}, {"pressure": -1 * MPa}):
            run = self.run_(stages=[{"kind": "drive", "duration": "6 ms", "look_interval": "0.5 ms",
                                     "drives": [{"set": "left", "hold": ["x", "y"]}]}])
            run.drive("right", **keys)
            run.finish()
            self.assertAlmostEqual(run.history["pull"][-1], 4e3, delta=5.0)
            self.assertAlmostEqual(run.history["across"][-1], 1e6, delta=0.05e6)
        run = self.run_(stages=[{"kind": "drive", "duration": "4 ms", "look_interval": "0.5 ms",
                                 "drives": [{"set": "left", "hold": ["x", "y"]}]}])
        run.drive("right", velocity=1 * mm / s, direction="x")
        before = run.fields.displacement[run.sets["right"], 0].mean()
        steps = run.step
        run.until(steps=100)
        self.assertAlmostEqual(run.fields.displacement[run.sets["right"], 0].mean() - before,
                               1e-3 * 1e-6 * (run.step - steps), places=12)

    def test_supports_are_taken_and_given_back(self):
        run = self.run_()
        run.finish()
        run.then("drive", duration="1 ms", drives=[{"set": "right", "hold": ["x"]}])
        before = run.next().pull
        run.drive("right", release=["x"])
        run.finish()
        self.assertGreater(before, 1e3)
        self.assertAlmostEqual(run.history["pull"][-1] / before, 0.0, delta=0.01)
        warned = [line for line in run.summary["warnings"] if "not reproducible from the deck" in line]
        self.assertTrue(any('"right"' in line and "release" in line for line in warned), warned)

    def test_what_cannot_be_is_told_and_the_run_goes_on(self):
        run = self.run_()
        step = run.step
        for keys, told in (
                ({"to": "nowhere", "hold": ["x"]}, 'no set "nowhere"; there are'),
                ({"to": "left", "force": 1 * kN, "direction": [1, 0]}, "held or driven along x"),
                ({"to": "right", "velocity": 2 * mm / s, "direction": "x"}, "the stage under way moves or loads"),
                ({"to": "left", "release": ["x", "y"]}, "nothing holds the body against moving along y"),
                ({"to": "left", "velocity": "1 mm", "direction": "x"}, "drives.0..velocity"),
                ({"to": "left"}, "one of hold, release, velocity, force and pressure is needed"),
                ({"to": "left", "velocity": 1e-3, "direction": "x"}, "a unit of velocity"),
                ({"to": "specimen", "hold": ["z"]}, "in the plane has no z"),
                ({"to": "specimen", "hold": ["w"]}, "list of .x., .y. and in a solid .z.")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                run.drive(keys.pop("to"), **keys)
        self.assertEqual(run.step, step)
        self.assertFalse(run.summary["warnings"])
        run.finish()
        self.assertEqual(run.outcome, "completed")
        straight = pyroclast.Run(plate(), threads=1).finish()
        np.testing.assert_array_equal(run.history["pull"], straight.history["pull"])

    def test_the_platens_are_the_press_s(self):
        from small import deck
        run = pyroclast.Run(deck(), threads=1)
        with self.assertRaisesRegex(pyroclast.Error, "has not begun"):
            run.drive("left", hold=["x"])
        run.next()
        with self.assertRaisesRegex(pyroclast.Error, "which the press works"):
            run.drive("top_platen", hold=["x"])
        run.drive("left", hold=["x"])
        run.until(strain=5e-5)
        np.testing.assert_array_equal(run.fields.displacement[run.sets["left"], 0], 0.0)

    def test_a_run_that_was_driven_is_only_the_script_s(self):
        out = self.folder() / "run"
        run = pyroclast.Run(plate(), out=out, threads=1)
        run.next()
        run.drive("top", hold=["y"])
        run.finish()
        del run
        gc.collect()
        with self.assertRaisesRegex(pyroclast.Error, "only the script"):
            pyroclast.Run.resume(out)


class Wrong(Case):
    def test_what_is_wrong_with_sets_and_drives_is_told_before_any_step(self):
        held = {"set": "left", "hold": ["x", "y"]}
        for tables, told in (
                ({"sets": [{"name": "spot", "box": [["1 m", "1 m"], ["2 m", "2 m"]]}]}, '"spot" is empty'),
                ({"stages": [{"kind": "drive", "duration": "1 ms", "drives": [held, {**PULL, "set": "left"}]}]},
                 "is held, driven or released along x twice in one stage"),
                ({"stages": [{"kind": "drive", "duration": "1 ms",
                              "drives": [{"set": "left", "hold": ["x"]}, PULL]}]},
                 "nothing holds the body against moving along y"),
                ({"record": [{"name": "pull", "kind": "force", "set": "nowhere", "direction": "x"}]}, "nowhere")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                pyroclast.Run(plate(**tables))

    def test_a_later_stage_is_checked_when_it_is_appended(self):
        run = pyroclast.Run(plate(), threads=1)
        run.next()
        for drives, told in (
                ([{"set": "left", "release": ["x", "y"]}, {"set": "right", "release": ["x"]}], "nothing holds"),
                ([{"set": "left", "force": "1 kN", "direction": [0, 1]}], "held or driven along y")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                run.then("drive", duration="1 ms", drives=drives)
        self.assertEqual(len(run.summary["stages"]), 1)
        run.finish()
        self.assertEqual(run.outcome, "completed")
