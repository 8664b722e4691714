"""Study files: what is wrong is refused before the first run, with its place."""

import json
import subprocess
import tomllib
import unittest

import jsonschema
from pyroclast.errors import DeckError, Error
from pyroclast.study.file import read_setup
from pyroclast.study.points import Points
from study_files import CASES, PROGRAM, StudyTest, of_deck

F_T = '[parameters.f_t]\nkey = "contacts.mortar_mortar.f_t"\nuniform = ["2 MPa", "3 MPa"]\n'
LHS = 'kind = "lhs"\nsamples = 5'


class WrongFiles(StudyTest):
    def refused(self, text: str, place: str, *words: str) -> None:
        """By the file itself; place: the line of the file that is named, by its text."""
        file = self.file(text)
        with self.assertRaises(DeckError) as caught:
            read_setup(file)
        self.named(text, place, str(caught.exception), *words)

    def refused_by_deck(self, text: str, place: str, *words: str) -> None:
        with self.assertRaises(Error) as caught:
            self.study(text).check()
        self.named(text, place, str(caught.exception), *words)

    def named(self, text: str, place: str, said: str, *words: str) -> None:
        number = next(i for i, line in enumerate(text.splitlines(), start=1) if place in line)
        self.assertIn(f"study.toml:{number}", said)
        for word in words:
            self.assertIn(word, said)

    def test_unknown_key_is_named_with_the_nearest(self) -> None:
        self.refused(of_deck(LHS.replace("samples", "sampels"), F_T), "sampels", "sampels", "samples")

    def test_unknown_method(self) -> None:
        self.refused(of_deck('kind = "morriss"', F_T), "morriss", "morris")

    def test_no_unit(self) -> None:
        self.refused_by_deck(of_deck(LHS, F_T.replace('"2 MPa", "3 MPa"', "2, 3")), "[parameters.f_t]", "no unit", "f_t")

    def test_one_end_without_unit(self) -> None:
        self.refused(of_deck(LHS, F_T.replace('"2 MPa"', "2")), "uniform", "no unit")

    def test_units_of_another_kind(self) -> None:
        self.refused(of_deck(LHS, F_T.replace('"3 MPa"', '"3 mm"')), "uniform", "mm")

    def test_empty_range(self) -> None:
        self.refused(of_deck(LHS, F_T.replace('"3 MPa"', '"1 MPa"')), "uniform", "empty")

    def test_two_distributions(self) -> None:
        self.refused(of_deck(LHS, F_T + 'choice = ["2 MPa", "3 MPa"]\n'), "choice", "uniform")

    def test_output_that_cannot_be_taken(self) -> None:
        self.refused(of_deck(LHS, F_T, outputs='f = "history: strain sometimes"'), "sometimes", "largest")

    def test_no_output(self) -> None:
        self.refused(of_deck(LHS, F_T, outputs=""), "[outputs]", "one number")

    def test_correlation_where_independence_is_needed(self) -> None:
        for kind in ("sobol", "morris"):
            text = of_deck(f'kind = "{kind}"', F_T + F_T.replace("parameters.f_t", "parameters.g")) + (
                '[[correlations]]\nbetween = ["f_t", "g"]\nrank = 0.5\n')
            self.refused(text, "[[correlations]]", "independent", "lhs")

    def test_target_without_output(self) -> None:
        text = of_deck('kind = "calibrate"', F_T) + "[targets.E]\nvalue = 20\nsd = 1\n"
        self.refused(text, "[targets.E]", "f_c")

    def test_a_target_takes_any_unit_of_its_output_and_a_bare_number_counts_in_that_unit(self) -> None:
        outputs = 'E = "E_GPa"\nT = "critical_temperature_degC"\nc = "history: energy_error_J last"\ns = "strain_at_peak"'
        for output, value, sd, wanted in (
                ("E", '"25 GPa"', '"500 MPa"', (25.0, 0.5)), ("E", "25", "0.5", (25.0, 0.5)),
                ("E", '"25e9 Pa"', '"0.5"', (25.0, 0.5)),
                ("T", '"873.15 K"', '"5 K"', (600.0, 5.0)), ("T", '"600 degC"', "5", (600.0, 5.0)),
                ("c", '"2 kJ"', '"1 N m"', (2000.0, 1.0)), ("s", '"0.3 %"', "1e-4", (0.003, 1e-4))):
            text = of_deck('kind = "calibrate"', F_T, outputs=outputs) + f"[targets.{output}]\nvalue = {value}\nsd = {sd}\n"
            (target,) = read_setup(self.file(text)).targets
            self.assertAlmostEqual(target.value, wanted[0], places=9)
            self.assertAlmostEqual(target.sd, wanted[1], places=9)

    def test_a_target_of_another_kind_is_refused_with_the_unit_of_its_output(self) -> None:
        outputs = 'E = "E_GPa"\nT = "critical_temperature_degC"\ns = "strain_at_peak"'
        for output, value, sd, place, unit in (
                ("E", '"25 mm"', "1", "value =", "GPa"), ("E", '"31 %"', "1", "value =", "GPa"),
                ("E", '"stiff"', "1", "value =", "GPa"),
                ("E", "true", "1", "value =", "GPa"), ("E", "25", '"5 K"', "sd =", "GPa"), ("T", "600", '"5 degC"', "sd =", "K"),
                ("s", '"25 GPa"', "1", "value =", "no unit")):
            text = of_deck('kind = "calibrate"', F_T, outputs=outputs) + f"[targets.{output}]\nvalue = {value}\nsd = {sd}\n"
            self.refused(text, place, f"counts in {unit}")

    def test_the_place_of_a_row_of_the_history_takes_a_unit(self) -> None:
        for what, wanted in (("stress_MPa at strain = 0.1 %", "stress_MPa at strain = 0.001"),
                             ("strain at stress_MPa = 2e4 kPa", "strain at stress_MPa = 20.0"),
                             ("strain at heating_time_s = 10 min", "strain at heating_time_s = 600.0")):
            setup = read_setup(self.file(of_deck(LHS, F_T, outputs=f'a = "history: {what}"')))
            self.assertEqual(setup.outputs[0].what, f"history: {wanted}")
        self.refused(of_deck(LHS, F_T, outputs='a = "history: strain at stress_MPa = 20 mm"'), "20 mm", "counts in MPa")

    def test_secant_without_a_target_for_each_parameter(self) -> None:
        of_f_c = 'kind = "secant"', F_T
        target = "[targets.f_c]\nvalue = 30\nsd = 1\n"
        self.refused(of_deck(*of_f_c) + target, "[targets.f_c]", "targets.f_c.by: missing")
        self.refused(of_deck(*of_f_c) + target + 'by = "other"\n', "[targets.f_c]", "for each parameter one target", "other", "f_t")
        self.refused(of_deck(*of_f_c) + target.replace("30", "0") + 'by = "f_t"\n', "value = 0", "greater than 0")
        self.refused(of_deck('kind = "calibrate"', F_T) + target + 'by = "f_t"\n', 'by = "f_t"', "no effect")

    def test_criterion_that_is_none(self) -> None:
        self.refused(of_deck('kind = "morris"\nuntil = "good enough"', F_T), "until", "widest interval < 0.05")

    def test_curve_replaced_by_a_constant(self) -> None:
        curve = '[parameters.E]\nkey = "materials.mortar.E"\nuniform = ["20 GPa", "30 GPa"]\n'
        text = of_deck(LHS, curve).replace("compression.toml", "transient_heating.toml").replace(
            'changes =', 'changes = { "materials.mortar.E" = { table = [["20 degC", "29 GPa"], ["900 degC", "1 GPa"]] } }\n#')
        self.refused_by_deck(text, "[parameters.E]", "curve", "scale")

    def test_key_that_the_deck_does_not_know(self) -> None:
        nu = '[parameters.nu]\nkey = "materials.mortar.nu"\nuniform = [0.2, 0.3]\n'
        text = of_deck(LHS, F_T.replace("f_t\"", "f_tt\"") + nu)
        self.refused_by_deck(text, "[parameters.f_t]", "f_tt")
        with self.assertRaises(Error) as caught:
            self.study(text).check()
        self.assertEqual(str(caught.exception).count("unknown key"), 1)

    def test_end_of_a_range_that_the_deck_refuses(self) -> None:
        self.refused_by_deck(of_deck(LHS, '[parameters.nu]\nkey = "materials.mortar.nu"\nuniform = [0.2, 0.6]\n'),
                             "[parameters.nu]", "nu = 0.6", "must be")

    def test_output_that_no_run_has(self) -> None:
        for what, *words in (("f_c_Mpa", "f_c_MPa"), ("energy_J.kinetik", "energy_J.kinetic"),
                             ("critical_temperature_degC",), ("expansion_reading",),
                             ("history: stres_MPa largest", "stress_MPa"),
                             ("history: stress_MPa at temperatur_degC = 400", "temperature_degC"),
                             ("history: stress_MPa where strian is largest", "strain")):
            with self.subTest(what):
                self.refused_by_deck(of_deck(LHS, F_T, outputs=f'E = "E_GPa"\nx = "{what}"'), "x = ", "no run", *words)

    def test_outputs_that_runs_have(self) -> None:
        outputs = ['f_c_MPa', 'quasi_static', 'energy_J.dissipated_shear', 'cracks.tension_mortar_mortar.length_m', 'steps',
                   'wall_time_s', 'specimen.mean_block_size_m', 'history: stress_MPa where strain is largest']
        self.study(of_deck(LHS, F_T, outputs="\n".join(f'o{i} = "{o}"' for i, o in enumerate(outputs)))).check()

    def test_distances_from_references_are_outputs(self) -> None:
        (self.folder / "press.csv").write_text("strain,stress_MPa\n0,0\n0.001,20\n")
        (self.folder / "deck.toml").write_text((CASES / "compression.toml").read_text() +
                                               '[[output.references]]\nfile = "press.csv"\nof = "stress"\n')
        own = f'"{self.folder / "deck.toml"}"'

        def asking(*outputs: str) -> str:
            asked = "\n".join(f'o{i} = "references.press.{o}"' for i, o in enumerate(outputs))
            return of_deck(LHS, F_T, outputs=asked).replace(f'"{CASES / "compression.toml"}"', own)

        self.study(asking("rms_over_greatest", "peak_difference", "area_between_MPa", "share_covered")).check()
        self.refused_by_deck(asking("rms"), "o0 = ", "no run", "references.press.rms")

    def test_stage_that_is_not_there(self) -> None:
        text = of_deck(LHS, '[parameters.v]\nkey = "stages[crush].velocity"\nuniform = ["1 mm/s", "2 mm/s"]\n')
        self.refused_by_deck(text, "[parameters.v]", "crush", "compress")

    def test_parameter_that_the_command_does_not_name(self) -> None:
        text = self.of_command("plain").replace("{x}", "{y}")
        self.refused_by_deck(text, "[parameters.x]", "y")

    def test_nothing_is_run_before_all_is_right(self) -> None:
        study = self.study(of_deck(LHS, '[parameters.nu]\nkey = "materials.mortar.nu"\nuniform = [0.2, 0.6]\n'))
        with self.assertRaises(Error):
            study.run(jobs=1)
        self.assertFalse(any((study.setup.folder / "runs").glob("*")))


class Parameters(StudyTest):
    def changes(self, parameters: str, values: list, deck: str = "compression.toml") -> dict[str, str]:
        setup = read_setup(self.file(of_deck(LHS, parameters).replace("compression.toml", deck)))
        return dict(Points(setup).changes(values)[3:])

    def test_several_keys_with_factors(self) -> None:
        keys = '{ "contacts.mortar_mortar.c_o" = 1, "contacts.mortar_mortar.c_res" = 0.01 }'
        self.assertEqual(self.changes(f'[parameters.c]\nkeys = {keys}\nuniform = ["3 MPa", "5 MPa"]\n', [4.0]),
                         {"contacts.mortar_mortar.c_o": '"4.0 MPa"', "contacts.mortar_mortar.c_res": '"0.04 MPa"'})

    def test_scale_of_a_number(self) -> None:
        self.assertEqual(self.changes('[parameters.E]\nkey = "materials.mortar.E"\nvary = "scale"\nuniform = [0.5, 2]\n',
                                      [0.5]), {"materials.mortar.E": '"14.7 GPa"'})

    def test_element_of_a_list(self) -> None:
        self.assertEqual(self.changes('[parameters.s]\nkey = "aggregates.sieves[2]"\nuniform = ["15 mm", "17 mm"]\n',
                                      [15.5]), {"aggregates.sieves[2]": '"15.5 mm"'})

    def test_choices_and_whole_numbers(self) -> None:
        two = ('[parameters.rule]\nkey = "superposition.rule"\nchoice = ["area", "centroid"]\n'
               '[parameters.n]\nkey = "blocks.relaxation"\ninteger = [0, 3]\n')
        self.assertEqual(self.changes(two, ["centroid", 2]),
                         {"superposition.rule": '"centroid"', "blocks.relaxation": "2"})

    def test_units_of_both_ends_may_differ(self) -> None:
        setup = read_setup(self.file(of_deck(LHS, F_T.replace('"2 MPa"', '"2000 kPa"'))))
        self.assertEqual(setup.parameters[0].distribution.numbers, (2000.0, 3000.0))

    def test_scale_and_shift_of_a_curve(self) -> None:
        for vary, ends, written in (("scale", "[0.9, 1.1]", "1.05"), ("shift", '["-20 K", "20 K"]', '"1.05 K"')):
            text = of_deck(LHS, f'[parameters.k]\nkey = "materials.mortar.E"\nvary = "{vary}"\nuniform = {ends}\n').replace(
                "compression.toml", "hot_strength.toml").replace(', "stages[compress].velocity" = "4 mm/s"', "").replace(
                    ', "stages[compress].stop_strain" = 0.003', "")
            points = Points(read_setup(self.file(text)))
            self.assertEqual(dict(points.changes([1.05]))[f"materials.mortar.E.{vary}"], written)
            self.assertEqual(points.at([1.05]).infeasible, "")


class Identity(StudyTest):
    def point(self, text: str, values=(2.5,)):
        return Points(read_setup(self.file(text))).at(values)

    def test_what_changes_no_result_changes_no_identity(self) -> None:
        deck = (CASES / "compression.toml").read_text()
        text = of_deck(LHS, F_T)
        before = self.point(text).ids(1)
        (self.folder / "other.toml").write_text("# mine\n" + deck.replace("Paper section 3", "Another title"))
        self.assertEqual(self.point(text.replace(str(CASES / "compression.toml"), "other.toml")).ids(1), before)

    def test_what_changes_a_result_changes_it(self) -> None:
        text = of_deck(LHS, F_T)
        point = self.point(text)
        self.assertNotEqual(point.ids(1), point.ids(2))
        self.assertNotEqual(point.ids(1), self.point(text, (2.6,)).ids(1))
        self.assertNotEqual(point.ids(1), self.point(text.replace("= 60", "= 61")).ids(1))
        deck = (CASES / "compression.toml").read_text()
        for change in (deck.replace("history_strain = 1e-5", "history_strain = 2e-5"), deck.replace("0.55", "0.56")):
            (self.folder / "other.toml").write_text(change)
            self.assertNotEqual(self.point(text.replace(str(CASES / "compression.toml"), "other.toml")).ids(1),
                                point.ids(1))

    def test_contents_of_files_count(self) -> None:
        (self.folder / "E.csv").write_text("temperature [degC], modulus [GPa]\n20, 29\n900, 2\n")
        deck = (CASES / "compression.toml").read_text().replace('E = "29.4 GPa"', 'E = { csv = "E.csv" }')
        (self.folder / "own.toml").write_text(deck)
        text = of_deck(LHS, F_T).replace(str(CASES / "compression.toml"), "own.toml")
        before = self.point(text).ids(1)
        (self.folder / "E.csv").write_text("temperature [degC], modulus [GPa]\n20, 28\n900, 2\n")
        self.assertNotEqual(self.point(text).ids(1), before)

    def test_another_version_is_another_run_unless_accepted(self) -> None:
        text = of_deck(LHS, F_T)
        accepted = self.point(of_deck(LHS, F_T, study="accept_version = 4")).ids(1)
        self.assertEqual(len(accepted), 2)
        self.assertEqual(accepted[0], self.point(text).ids(1)[0])
        self.assertNotEqual(accepted[0], accepted[1])


class Reference(unittest.TestCase):
    def test_the_reference_has_tables_methods_and_distributions(self) -> None:
        printed = subprocess.run([PROGRAM, "study", "keys"], capture_output=True, text=True, check=True).stdout
        for word in ("`[study]`", "`seeds`", "`trajectories`", "`uniform`", "[parameters.", "[targets."):
            self.assertIn(word, printed)

    def test_the_schema_takes_what_the_readers_take(self) -> None:
        printed = subprocess.run([PROGRAM, "study", "keys", "--schema"], capture_output=True, text=True, check=True).stdout
        editor = jsonschema.Draft4Validator(json.loads(printed))
        for file in (CASES.parent / "validation" / "studies").glob("*.toml"):
            study = tomllib.loads(file.read_text())
            self.assertEqual([error.message for error in editor.iter_errors(study)], [], file.name)
            for wrong in ({"seed": 3}, {"seeds": "three"}, {"seeds": 0}):
                self.assertFalse(editor.is_valid(study | {"study": study["study"] | wrong}), wrong)


if __name__ == "__main__":
    unittest.main()
