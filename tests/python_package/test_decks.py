"""Decks as objects."""

import math
import pickle
import tomllib

import pyroclast
from pyroclast import GPa, K, MPa, degC, m, minute, mm
from small import CASES, Case, deck


class Units(Case):
    def test_quantities_become_what_decks_write(self):
        self.assertEqual(str(5 * MPa), "5.0 MPa")
        self.assertAlmostEqual((10 * K / minute).to("K/s"), 10 / 60)
        self.assertAlmostEqual((3 * mm**2).to("m2"), 3e-6)
        self.assertAlmostEqual((2 * MPa * mm / mm).to("Pa"), 2e6)
        with self.assertRaisesRegex(pyroclast.Error, "stress"):
            (5 * mm).to("Pa")


class Decks(Case):
    def test_a_file_is_read_and_keys_are_got_by_their_paths(self):
        starter = pyroclast.Deck(CASES / "starter.toml")
        self.assertEqual(starter["specimen.width"], 150 * mm)
        self.assertEqual(starter["stages[1].kind"], "compress")
        self.assertEqual(starter["aggregates.sieves"][0], 8 * mm)
        starter["title"] = "2 fires"
        self.assertEqual(starter["title"], "2 fires")
        self.assertIn("contacts.mortar_mortar.f_t", starter)
        self.assertNotIn("contacts.mortar_mortar.f_x", starter)
        with self.assertRaises(KeyError):
            starter["stages[7].kind"]

    def test_a_deck_lists_its_keys(self):
        made = deck()
        keys = list(tomllib.loads(made.text))
        self.assertEqual(list(made), keys)
        self.assertEqual([key for key in made], keys)
        self.assertEqual(sorted(made), sorted(keys))
        self.assertEqual({key: dict(value) for key, value in dict(made).items() if key in ("specimen", "blocks")},
                         {key: dict(made[key]) for key in ("specimen", "blocks")})
        self.assertEqual({**made}["title"], made["title"])

    def test_values_are_set_with_units_and_bare_numbers_refused_as_in_decks(self):
        made = deck()
        made["contacts.mortar_mortar.f_t"] = 3 * MPa
        made["specimen.width"] = "0.1 m"
        self.assertEqual(tomllib.loads(made.text)["contacts"]["mortar_mortar"]["f_t"], "3.0 MPa")
        with self.assertRaises(pyroclast.DeckError) as caught:
            made["specimen.width"] = 0.1
        (told,) = caught.exception.diagnostics
        self.assertEqual((told.file, told.key, told.value), ("--set", "specimen.width", "0.1"))
        self.assertIn("a unit of length (m) is needed", told.message)
        self.assertEqual(str(made["specimen.width"]), "0.1 m")  # as it was
        made["blocks.count"] = 130
        made["stages[1].stop_strain"] = 0.0005
        made.check()

    def test_no_change_of_a_table_is_lost(self):
        made = deck()
        table = made["specimen"]
        self.assertEqual((table | {"seed": 9})["seed"], 9)  # a table of its own
        self.assertEqual(({"seed": 9} | table)["seed"], table["seed"])
        self.assertNotEqual(table["seed"], 9)
        table |= {"seed": 8}
        self.assertEqual(made["specimen.seed"], 8)
        table.update(seed=7, width=120 * mm)
        table["height"] = "0.2 m"
        made["stages"][1]["stop_strain"] = 0.0005
        del made["stages"][1]["stop_fraction_of_peak"]
        told = tomllib.loads(made.text)
        self.assertEqual((told["specimen"]["seed"], told["specimen"]["width"]), (7, "120.0 mm"))
        self.assertEqual((table["height"], dict(table)["seed"], len(table)), (0.2 * m, 7, len(told["specimen"])))
        self.assertEqual(told["stages"][1]["stop_strain"], 0.0005)
        self.assertNotIn("stop_fraction_of_peak", told["stages"][1])
        with self.assertRaisesRegex(pyroclast.DeckError, "a unit of length"):
            table["width"] = 0.1
        with self.assertRaises(AttributeError):
            made["stages"].append({"kind": "settle"})  # deck.append("stages", ...) is the way
        other = pyroclast.Deck(CASES / "starter.toml")
        other["stages"] = (made["stages"][0], *made["stages"])
        self.assertEqual([stage["kind"] for stage in other["stages"]], ["settle", "settle", "compress"])
        other["stages"] = other["stages"][1:]  # tables of its own
        self.assertEqual(other["stages"], made["stages"])
        other["materials.mortar"]["E"] = {"table": [["20 degC", "30 GPa"], ["900 degC", "3 GPa"]]}
        other["materials.mortar"].update(density="2300 kg/m3")
        del other["materials.aggregate.nu"]  # the deck is written anew, and the curve with it
        with self.assertRaises(pyroclast.Error):
            other["materials.mortar.E"] = 30.0
        self.assertEqual(other["materials.mortar.E.table"][1][0], 900 * degC)
        other["materials.mortar.E"] = "30 GPa"
        self.assertEqual(other["materials.mortar.E"], 30 * GPa)
        del made["platens"]
        with self.assertRaises(KeyError):
            made["platens"]["height"]

    def test_errors_have_the_texts_and_places_of_the_program(self):
        text = (CASES / "starter.toml").read_text().replace("count = 1000", "cuont = 1000")
        file = self.folder() / "wrong.toml"
        file.write_text(text)
        with self.assertRaises(pyroclast.DeckError) as caught:
            pyroclast.Run(file)
        error = pickle.loads(pickle.dumps(caught.exception))
        unknown = [d for d in error.diagnostics if d.key == "blocks.cuont"][0]
        self.assertEqual(unknown.file, str(file))
        self.assertEqual(text.splitlines()[unknown.line - 1], "cuont = 1000")
        self.assertEqual(unknown.hint, 'did you mean "count"?')
        self.assertIn(str(unknown), str(error))
        with self.assertRaisesRegex(pyroclast.DeckError, "no such file"):
            pyroclast.Deck(file.with_name("none.toml"))

    def test_tables_make_a_deck(self):
        tables = tomllib.loads((CASES / "starter.toml").read_text())
        made = pyroclast.Deck(**tables)
        self.assertEqual(tomllib.loads(made.text), tables)
        made.check()
        made.append("stages", kind="compress", velocity="1 mm/s", ramp_time="20 ms", to_stress="0 MPa")
        self.assertEqual(len(made["stages"]), 3)
        made.check()

    def test_keys_are_taken_out_and_lists_of_tables_replaced(self):
        made = deck()
        del made["stages[1].stop_fraction_of_peak"]
        self.assertNotIn("stages[1].stop_fraction_of_peak", made)
        self.assertEqual(made["blocks.count"], 120)
        made.check()
        with self.assertRaises(KeyError):
            del made["stages[1].stop_fraction_of_peak"]
        made["stages"] = [made["stages[0]"]]
        self.assertEqual(len(made["stages"]), 1)
        made.check()
        wall = pyroclast.Deck(CASES / "thermal_wall.toml")
        wall["heat.boundaries[0].gas_temperature"] = lambda t: 20.0 + t
        del wall["title"]
        self.assertIn("heat.boundaries[0].gas_temperature", wall)
        with self.assertRaisesRegex(pyroclast.DeckError, "title"):
            wall.check()

    def test_a_copy_goes_its_own_way(self):
        made = deck()
        other = made.copy()
        other["specimen.seed"] = 9
        self.assertEqual((made["specimen.seed"], other["specimen.seed"]), (1, 9))

    def test_warnings_are_returned(self):
        self.assertTrue(any(d.key == "blocks.count" for d in deck().check()))


class Functions(Case):
    def wall(self, gas):
        made = pyroclast.Deck(CASES / "thermal_wall.toml")
        for key, value in {"blocks.count": 60, "stages[0].duration": "10 min"}.items():
            made[key] = value
        made["heat.boundaries[0].gas_temperature"] = gas
        return made

    def test_the_gas_in_cracks_conducts_by_a_function_of_the_temperature(self):
        made = self.wall("500 degC")
        asked = []

        def conductivity(T):
            asked.append(T)
            return 0.025 + 6e-5 * (T - 20.0)

        made["heat.cracks"] = {}
        made["heat.cracks.gas_conductivity"] = conductivity
        made.check()
        self.assertGreaterEqual(min(asked), 20.0)  # a time would begin at 0
        self.assertGreater(max(asked), 499.0)

    def test_a_gas_temperature_is_tabulated_and_the_table_is_in_the_folder(self):
        def gas(t):
            return 20.0 + 800.0 * (1.0 - math.exp(-t / 300.0)) * (1.0 + 0.1 * math.sin(t / 50.0))

        made = self.wall(gas)
        self.assertIs(made["heat.boundaries[0].gas_temperature"].call, gas)
        made.check()
        out = self.folder() / "run"
        run = pyroclast.Run(made, out=out, threads=1).finish()
        table = next((out / "inputs").glob("*.csv")).read_text().splitlines()
        self.assertRegex(table[0], r"time \[s\], .* \[degC\]")
        points = [tuple(map(float, line.split(","))) for line in table[1:]]
        worst = max(abs(gas(0.5 * (a + b)) - 0.5 * (u + v)) for (a, u), (b, v) in zip(points, points[1:]))
        values = [gas(x) for x, _ in points]
        self.assertLess(worst, 1e-6 * (max(values) - min(values)))
        again = pyroclast.Run(out / "deck.toml", out=out.with_name("again"), threads=1).finish()
        self.assertEqual((out / "history.csv").read_bytes(), (out.with_name("again") / "history.csv").read_bytes())
        self.assertEqual(again.outcome, run.outcome)

    def test_a_run_that_is_copied_or_changed_still_has_its_functions(self):
        run = pyroclast.Run(self.wall(pyroclast.Function(lambda t: 20.0 + t, "degC", (0.0, 3600.0))), threads=1)
        run.next()
        copied = run.copy()
        run.then("conduct", duration="2 min", interval="1 min").finish()
        self.assertGreater(run.history["temperature"][-1], copied.finish().history["temperature"][-1])

    def test_a_function_that_fails_is_told_before_any_step(self):
        with self.assertRaisesRegex(pyroclast.Error, r"gas_temperature: the function, at time 0 s, raises ZeroDiv"):
            self.wall(lambda t: 1 / 0)
        late = self.wall(lambda t: 20.0 if t < 400.0 else math.nan)
        out = self.folder() / "run"
        with self.assertRaisesRegex(pyroclast.Error, r"gas_temperature: the function, at time 4\d\d.* s, gives nan"):
            pyroclast.Run(late, out=out)
        self.assertFalse(out.exists())

    def test_a_property_over_the_temperature_in_a_stated_unit(self):
        made = deck()
        made["materials.mortar.E"] = pyroclast.Function(lambda T: 30.0 - 0.01 * (T - 20.0), "GPa", (0.0, 900.0))
        made.check()
        same = deck(materials__mortar__E="30 GPa")
        E = [pyroclast.Run(d, threads=1).until(strain=1e-4).stress for d in (made, same)]
        self.assertEqual(*E)
        softer = deck()
        softer["materials.mortar.E"] = lambda T: 15e9
        self.assertLess(pyroclast.Run(softer, threads=1).until(strain=1e-4).stress, 0.9 * E[0])
