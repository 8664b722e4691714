"""Cases beyond the paper's, in their small forms: what they show follows from what their decks say.

PYROCLAST names the program, SMALL_FORMS the folder of runs that `validation/reference check --keep FOLDER`
left.
"""

import csv
import functools
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "validation"))
import wall_1d  # noqa: E402
SMALL = tomllib.loads((ROOT / "validation" / "reference.toml").read_text())["small"]
HALF_STRENGTH = "contacts.mortar_mortar.f_t=1.25 MPa"
HALF_COHESION = "contacts.mortar_mortar.c_o=1.9 MPa"


class Finished:
    """Results of a run."""

    def __init__(self, folder: pathlib.Path):
        self.summary = json.loads((folder / "summary.json").read_text())
        with open(folder / "history.csv", newline="") as file:
            self.rows = list(csv.DictReader(file))

    def of(self, result: str) -> float:
        """Of the last stage."""
        return self.summary["stages"][-1]["results"][result]

    def column(self, name: str, stage: int = -1) -> list[float]:
        number = str(range(len(self.summary["stages"]))[stage])
        return [float(row[name]) for row in self.rows if row["stage"] == number]


@functools.cache
def finished(case: str, *changes: str) -> Finished:
    """A small form, with more changes."""
    if not changes:
        return Finished(pathlib.Path(os.environ["SMALL_FORMS"]) / case)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "run"
        words = [word for change in (*SMALL[case], *changes) for word in ("--set", change)]
        done = subprocess.run([os.environ["PYROCLAST"], "run", ROOT / "cases" / f"{case}.toml", "--out", folder,
                               "--no-figures", "--quiet", *words], capture_output=True, text=True, timeout=200,
                              check=False)
        if done.returncode != 0:
            raise AssertionError(f"{case}: {done.stdout}{done.stderr}")
        return Finished(folder)


class Cases(unittest.TestCase):
    def assert_between(self, low: float, value: float, high: float):
        self.assertGreater(value, low)
        self.assertLess(value, high)

    def test_each_completes_and_its_ledger_closes(self):
        for case in ("biaxial", "biaxial_3d", "brazilian", "column_fire_3d", "compression_3d", "cube_3d", "direct_tension",
                     "disc_3d", "drop", "drop_3d", "fire_long", "fire_one_side_3d", "hot_strength_3d",
                     "loose_splitting", "notched_beam", "ring_cooling", "spalling_slab_3d", "transient_heating_3d", "wall_bent"):
            with self.subTest(case):
                summary = finished(case).summary
                self.assertEqual({stage["outcome"] for stage in summary["stages"]}, {"completed"})
                self.assertLess(abs(summary["energy_J"]["error_over_turnover"]), 0.005)

    def test_creep_shortens_what_is_heated_under_load(self):
        def strain(*changes: str) -> float:
            return -finished("anderberg_thelandersson", *changes).column("specimen_strain")[-1]

        deck = tomllib.loads((ROOT / "cases" / "anderberg_thelandersson.toml").read_text())
        creep = deck["materials"]["mortar"]["creep"]
        free = 0.006 * math.log(7.0 / 3.2)  # glasgow_free_thermal_strain at 400 degC
        stress = finished("anderberg_thelandersson").of("load_stress_MPa")
        expected = creep["k2"] * free * stress / float(creep["f_c"].split()[0])
        less = strain("materials.mortar.creep.k2=1e-9") - strain()
        # aggregates of so few blocks lean on one another, and bear what the mortar sheds
        self.assert_between(0.5 * expected, less, expected)
        self.assert_between(0.9 * free, strain("stages[1].level=0"), 1.1 * free)

    def test_what_goes_with_the_block_size_is_a_stated_number_at_any_one(self):
        def stress(*changes: str) -> float:
            small = ("specimen.width=60 mm", "specimen.height=60 mm", "aggregates.d_max=16 mm",
                     'aggregates.sieves=["8 mm","12.5 mm"]', "blocks.count=100")  # of 6 mm, twice t_b_block_size
            return finished("compression", *small, *changes).column("stress_MPa")[-1]

        yields = ("contacts.mortar_mortar.f_cm=4 MPa", "stages[1].stop_strain=6e-4")
        slides = ("contacts.mortar_mortar.f_cm=100 MPa", "contacts.mortar_mortar.phi=10 deg",
                  "contacts.mortar_mortar.phi_res=10 deg", "stages[1].stop_strain=1.5e-3")
        for key, value, twice, where in (("second_slope", "fixed", "beta=0.1", yields),
                                         ("mode_2_energy", "block size", "G_f2=480 N/m", slides)):
            with self.subTest(key):
                with_size = stress(*where, f"contacts.{key}={value}")
                self.assertAlmostEqual(with_size / stress(*where, f"contacts.mortar_mortar.{twice}"), 1.0, delta=1e-6)
                self.assert_between(1.02, with_size / stress(*where), 2.0)

    def test_hot_concrete_is_weaker_by_its_curves(self):
        as_it_stands = finished("hot_strength")
        self.assertEqual([stage["kind"] for stage in as_it_stands.summary["stages"]],
                         ["settle", "load", "heat", "heat", "compress"])
        self.assertGreater(as_it_stands.summary["energy_J"]["dissipated_creep"], 0.0)
        # blocks as coarse as these pass no peak
        self.assertIsNone(as_it_stands.of("f_c_MPa"))
        borne, cold_bonds = (max(run.column("stress_MPa")) for run in (
            as_it_stands, finished("hot_strength", "contacts.mortar_mortar.temperature_ratio=1")))
        self.assertGreater(cold_bonds, 1.02 * borne)
        self.assertGreater(finished("hot_strength", "materials.mortar.E=29.4 GPa").of("E_GPa"),
                           1.05 * as_it_stands.of("E_GPa"))

    def test_no_compression_of_a_hot_body_without_load_ends_on_what_noise_the_heating_left(self):
        """Both ended, without an error, at 0.02 and 0.006 MPa: a stress that swings falls by half."""
        hot = ("stages[1].level=0", "stages[2].to=400 degC", "stages[3].to=400 degC", "coupling.exchange_increment=40 K",
               "stages[4].stop_strain=4e-4", "stages[4].stop_fraction_of_peak=0.6")
        for case, *changes in (
            ("hot_strength", "blocks.count=100", "stages[4].velocity=0.2 mm/s", "stages[4].ramp_time=200 ms"),
            ("hot_strength_3d", "blocks.count=200", "specimen.seed=3", "stages[4].velocity=0.5 mm/s",
             "stages[4].ramp_time=50 ms"),
        ):
            with self.subTest(case):
                run = finished(case, *hot, *changes)
                self.assertEqual(run.summary["stages"][-1]["outcome"], "completed")
                self.assertGreaterEqual(run.column("stage_strain")[-1], 4e-4)

    def test_a_plate_in_space_bears_its_stresses_in_their_ratio(self):
        plate = finished("biaxial_3d")
        self.assertAlmostEqual(plate.of("ratio"), 0.5, delta=0.01)
        self.assert_between(20.0, -plate.of("f_1_MPa"), 60.0)
        # free faces: the swelling is controlled, and grows evenly
        self.assertGreater(plate.column("swelling_m")[-1], 0.0)

    def test_reactions_of_the_beam_bear_load_and_weight(self):
        run = finished("notched_beam")
        beam = (0.5 * 0.15 - 0.005 * 0.075) * (0.34 * 2650.0 + 0.66 * 2200.0)
        weight = 9.81 * 0.15 * (beam + 3 * 0.02 * 0.01 * 7850.0)  # with its bearings
        at_rest = [run.column(name, 1)[-1] for name in ("left_reaction_N", "right_reaction_N")]
        self.assertAlmostEqual(sum(at_rest), weight, delta=0.03 * weight)
        # on its way it swings up and down about that
        load, left, right = (run.column(name) for name in ("load_N", "left_reaction_N", "right_reaction_N"))
        borne = (sum(left) + sum(right) - sum(load)) / len(load)
        self.assertAlmostEqual(borne, weight, delta=0.005 * run.of("peak_load_N"))

    def test_the_beam_needs_less_load_and_work_with_half_of_the_strength(self):
        whole, half = finished("notched_beam"), finished("notched_beam", HALF_STRENGTH)
        self.assert_between(0.4, half.of("P_N") / whole.of("P_N"), 0.95)
        net = 1.5 * whole.of("peak_load_N") * 0.45 / (0.15 * 0.075**2) * 1e-6
        self.assertAlmostEqual(whole.of("f_net_MPa"), net, delta=1e-6 * net)
        # the load alone moves the beam, but for its weight and what the pair of the control does
        self.assertAlmostEqual(whole.of("W_0_J"), whole.of("loading_work_J"), delta=0.1 * whole.of("W_0_J"))
        self.assertGreater(whole.of("G_F_N_m"), whole.of("W_0_J") / (0.15 * 0.075))

    def test_the_disc_splits_at_the_stress_of_its_load_and_its_strength(self):
        # tension alone does not split it: its blocks also slide on each other, under pressure
        whole, half = finished("brazilian"), finished("brazilian", HALF_STRENGTH, HALF_COHESION)
        stress = 2.0 * whole.of("peak_load_N") / (math.pi * 0.15 * 0.3) * 1e-6
        self.assertAlmostEqual(whole.of("f_t_split_MPa"), stress, delta=1e-9 * stress)
        # ... so weak it has not come to its peak where the run ends
        self.assertIsNone(half.of("f_t_split_MPa"))

        def load_at(run, widening: float) -> float:
            rows = zip(run.column("widening_m"), run.column("load_N"))
            return next(load for opened, load in rows if opened > widening)

        self.assert_between(0.4, load_at(half, 2e-5) / load_at(whole, 2e-5), 0.8)

    def test_loose_plates_split_a_disc_as_strips_do(self):
        run = finished("loose_splitting")
        plate = 9.81 * 0.08 * 0.02 * 0.3 * 7850.0
        self.assertAlmostEqual(run.column("load_N", 0)[-1], plate, delta=0.01 * plate)  # the disc is not there yet
        self.assert_between(0.6, run.of("f_t_split_MPa") / finished("brazilian").of("f_t_split_MPa"), 1.4)

    def test_what_falls_is_stopped_by_the_thrust_of_its_plate(self):
        run = finished("drop")
        mass = 0.01 * (0.34 * 2650.0 + 0.66 * 2200.0)
        times, thrust, fall = run.column("time_s"), run.column("thrust_N"), run.column("fall_m")
        plate = 9.81 * 0.3 * 0.03 * 7850.0
        impulse = sum((b - a) * (0.5 * (p + q) - plate) for a, b, p, q in
                      zip(times, times[1:], thrust, thrust[1:]))
        after = (fall[-1] - fall[-2]) / (times[-1] - times[-2])
        self.assertAlmostEqual(impulse / (mass * (after + 4.0 + 9.81 * times[-1])), 1.0, delta=0.05)
        self.assertGreater(after, -4.0)
        self.assertGreater(run.column("cracks_m")[-1], 0.1)
        self.assertNotIn("fall too slowly", str(run.summary["warnings"]))
        damped = finished("drop", "mechanics.local_damping=0.8", "stages[0].duration=0.1 ms")
        self.assertIn("is free, and falls too slowly", str(damped.summary["warnings"]))

    def test_rubble_stays_on_its_ground(self):
        run = finished("rubble")
        sinking = run.column("sinking_m")
        self.assertLess(sinking[-1], -0.01)
        self.assertGreater(sinking[-1], -0.08)  # the middle of the column at the start
        # friction that chatters is booked to the first order of the step
        self.assertLess(abs(run.summary["energy_J"]["error_over_turnover"]), 0.02)

    def test_the_prism_parts_at_half_of_the_load_with_half_of_the_strength(self):
        whole, half = finished("direct_tension"), finished("direct_tension", HALF_STRENGTH)
        self.assert_between(0.4, half.of("f_t_MPa") / whole.of("f_t_MPa"), 0.75)
        self.assert_between(1.0, whole.of("f_t_MPa"), 4.0)
        tough = finished("direct_tension", "contacts.mortar_mortar.G_f1=120 N/m")
        self.assertGreater(tough.of("G_F_N_m"), 1.3 * whole.of("G_F_N_m"))

    def test_tension_across_takes_compressive_strength(self):
        little = finished("biaxial", "stages[0].drives[4].force=7.5 kN")
        more = finished("biaxial")
        self.assertAlmostEqual(more.of("ratio"), -0.1, delta=0.02)
        self.assertAlmostEqual(little.of("ratio"), -0.05, delta=0.015)
        self.assertLess(more.of("f_1_MPa") / little.of("f_1_MPa"), 0.9)

    def test_the_wall_is_held_against_its_pressure_and_bows_to_the_fire(self):
        run = finished("wall_bent")
        held = run.column("reaction_foot_N", 0)[-1] + run.column("reaction_head_N", 0)[-1]
        self.assertAlmostEqual(held, 50e3 * 0.6, delta=100.0)
        hot = run.column("reaction_foot_N")[-1] + run.column("reaction_head_N")[-1]
        self.assertAlmostEqual(hot, 50e3 * 0.6, delta=1e3 * 0.3)  # platen_difference times the body's size
        self.assertGreater(run.column("bow_m")[-1], 2.0 * run.column("bow_m", 0)[-1])

    def test_the_ring_cracks_when_it_is_cooled_and_less_from_half_the_heat(self):
        table = 'gas_temperature={ table = [["0 h", "20 degC"], ["6 h", "85 degC"]'
        cooled = '["7 h", "85 degC"], ["7.01 h", "20 degC"], ["8 h", "20 degC"]] }'
        cooler = finished("ring_cooling", f'heat.boundaries[0].{table}, ["8 h", "85 degC"]] }}',
                          f"heat.boundaries[1].{table}, {cooled}")
        whole = finished("ring_cooling")
        time, cracks = whole.column("heating_time_s"), whole.column("cracks_m")
        before = max(crack for at, crack in zip(time, cracks) if at <= 7 * 3600.0)
        self.assertLess(before, 0.05 * cracks[-1])
        self.assertLess(cooler.column("mean_opening_m")[-1], 0.5 * whole.column("mean_opening_m")[-1])

    def test_a_wall_with_cracks_along_its_hot_face_heats_as_in_one_dimension(self):
        run = finished("delamination_heat")
        depths = [0.005, 0.018, 0.022, 0.05]
        whole = wall_1d.temperatures(None, 1800.0, depths)
        for crack, width, hindrance in (("narrow", 1e-4, 8.0), ("wide", 1e-3, 40.0)):
            expected = wall_1d.temperatures(width, 1800.0, depths)
            found = [run.column(f"probe_{crack}_{round(1e3 * depth)}mm_degC")[-1] for depth in depths]
            for depth, here, there in zip(depths, found, expected):
                self.assertAlmostEqual(here, there, delta=0.015 * there, msg=f"{crack}, {depth} m")
            self.assertGreater(found[1], whole[1] + hindrance / 2)
            self.assertLess(found[2], whole[2] - hindrance)


if __name__ == "__main__":
    unittest.main()
