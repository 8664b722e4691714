"""What a page says of a run's results is what the program judged.

SMALL_FORMS names the folder of runs that `validation/reference check --keep FOLDER` left.
"""

import json
import os
import pathlib
import shutil
import tempfile
import unittest

import numpy as np

import pyroclast
from pyroclast.report.course import course_of
from pyroclast.report.judging import BAD, DOUBT, GOOD, cards, verdict, worst
from pyroclast.report.marks import marks
from pyroclast.report.run_page import _cards, _stages, _temperature, _tested, run_page

RUNS = pathlib.Path(os.environ["SMALL_FORMS"])


class Judging(unittest.TestCase):
    def changed(self, case: str, **changes) -> pyroclast.Results:
        """A run whose summary says something else. results: of its last stage."""
        folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, folder)
        for name in ("run.json", "history.csv", "deck.toml", "summary.json", "references.json"):
            if (RUNS / case / name).exists():
                shutil.copy(RUNS / case / name, folder)
        summary = json.loads((folder / "summary.json").read_text())
        summary["warnings"] = []
        summary["stages"][-1]["warnings"] = []
        summary["stages"][-1]["results"] |= changes.pop("results", {})
        summary["stages"][-1] |= changes.pop("stage", {})
        (folder / "summary.json").write_text(json.dumps(summary | changes))
        return pyroclast.read(folder)

    def card(self, run: pyroclast.Results, label: str):
        return next(card for card in cards(run) if card.label == label)

    def test_a_good_quasi_static_run_is_good(self):
        run = self.changed("starter", results={"quasi_static": True, "f_c_MPa": 33.33})
        self.assertEqual(worst(verdict(run)), GOOD)
        card = self.card(run, "f_c")
        self.assertEqual((card.value, card.unit, card.level), ("33.3", "MPa", GOOD))
        self.assertIn("quasi-static", card.reason)

    def test_warnings_make_doubt(self):
        run = self.changed("starter", results={"quasi_static": True}, warnings=["coarse blocks"])
        self.assertEqual((worst(verdict(run)), verdict(run)[0].text), (DOUBT, "coarse blocks"))
        self.assertEqual((self.card(run, "E").level, self.card(run, "E").reason), (DOUBT, "coarse blocks"))

    def test_what_the_program_does_not_count_as_good_is_bad(self):
        for changes, said in (({"results": {"quasi_static": False}}, "not quasi-static"),
                              ({"is_good": False, "outcome": "unsound"}, "unsound"),
                              ({"stage": {"is_good": False, "outcome": "stopped"}}, "stopped")):
            with self.subTest(said):
                run = self.changed("starter", **{"results": {"quasi_static": True}, **changes})
                self.assertEqual(worst(verdict(run)), BAD)
                self.assertEqual(self.card(run, "E").level, BAD)
                self.assertIn(said, self.card(run, "E").reason)

    def test_a_result_that_is_missing_says_why(self):
        run = self.changed("starter", results={"f_c_MPa": None, "f_c_none_because": "it ended too soon"})
        self.assertEqual((self.card(run, "f_c").value, self.card(run, "f_c").reason), ("–", "it ended too soon"))

    def test_a_warning_of_the_run_is_on_its_cards_whatever_its_first_word(self):
        run = self.changed("starter", results={"quasi_static": True}, warnings=["stage 1 began late"])
        self.assertEqual((self.card(run, "E").level, self.card(run, "E").reason), (DOUBT, "stage 1 began late"))

    def test_a_stage_is_signed_as_it_is_judged(self):
        for is_static, level in ((True, GOOD), (False, BAD)):
            run = self.changed("starter", results={"quasi_static": is_static})
            self.assertEqual(_stages(run)[-1]["level"], level)

    def test_a_summary_that_does_not_judge_says_so(self):
        run = self.changed("starter")
        path = run.folder / "summary.json"
        summary = json.loads(path.read_text())
        for key in ("outcome_id", "is_good"):
            del summary[key]
        path.write_text(json.dumps(summary))
        first = verdict(pyroclast.read(run.folder))[0]
        self.assertEqual((first.level, first.text), (BAD, "summary.json does not say whether the run is good"))

    def test_a_card_leads_to_no_place_that_the_curve_has_not(self):
        run = self.changed("starter", results={"f_c_MPa": 33.33})
        self.assertEqual(self.card(run, "f_c").mark, "peak")
        self.assertEqual({card.mark for card in _cards(run, {"course": {"marks": []}})}, {""})

    def test_without_a_strength_the_largest_stress_is_no_peak(self):
        for strength, label in ((33.33, "peak"), (None, "largest")):
            run = self.changed("starter", results={"f_c_MPa": strength})
            found = {mark.id: mark.label for mark in marks(run, run.history["stress_MPa"], None)}
            self.assertEqual(found["peak"], label)

    def test_where_a_test_unloads_by_command_nothing_drops(self):
        run = pyroclast.read(RUNS / "cyclic")
        place = np.linspace(0.0, 4.0, run.history.rows)
        strain = np.interp(place, [0.0, 1.0, 1.2, 2.0, 4.0], [0.0, 1.0, 0.8, 1.0, 2.0])
        stress = np.interp(place, [0.0, 1.0, 1.2, 2.0, 3.0, 3.2, 4.0], [0.0, 10.0, 1.0, 10.0, 12.0, 10.0, 9.0])
        rows = {way: {mark.id: mark.rows for mark in marks(run, stress, way * strain)} for way in (1.0, -1.0)}
        start, end = place[rows[1.0]["steepest"]]
        self.assertTrue(2.99 < start < end < 3.21)  # not from 1 to 1.2, where it falls four times as fast
        self.assertEqual(rows[1.0], rows[-1.0])
        self.assertFalse({"steepest", "behind"} & {mark.id for mark in marks(run, stress, None)})

    def test_the_fall_after_the_peak_ends_at_the_least_stress_that_the_test_reached_as_it_went_on(self):
        run = pyroclast.read(RUNS / "compression")
        stress, strain = run.history["stress_MPa"].copy(), run.history["strain"].copy()
        found = {mark.id: mark for mark in marks(run, stress, strain)}
        peak, fall = found["peak"].row, found["behind"]
        self.assertEqual(fall.rows, [peak, peak + 1 + int(np.argmin(stress[peak + 1:]))])
        self.assertGreater(stress[found["steepest"].start], stress[found["steepest"].row])
        stress[-4:], strain[-4:] = 0.0, strain[-5] - 1e-4  # it unloads
        again = {mark.id: mark for mark in marks(run, stress, strain)}["behind"]
        self.assertLess(again.row, len(stress) - 4)
        self.assertGreater(stress[again.row], 0.0)

    def test_a_test_that_measures_no_strength_says_what_it_bore(self):
        card = cards(pyroclast.read(RUNS / "fire_one_side"))[0]
        self.assertEqual((card.label, card.value), ("strength", "not measured"))
        self.assertRegex(card.reason, r"^no failure: held [\d.]+ MPa = 0\.\d\d of f_c [\d.]+ MPa as the deck states it$")
        failed = cards(pyroclast.read(RUNS / "transient_heating"))[0]
        self.assertRegex(failed.reason, r"^failed under [\d.]+ MPa = .* as the deck states it, after 26 min of heating$")
        self.assertNotIn("strength", {card.label for card in cards(pyroclast.read(RUNS / "compression"))})

    def test_a_failure_in_heat_and_none_say_for_which_body_they_hold(self):
        told = "of this one specimen of plain concrete in plane stress: no steel, no spalling, no member"
        for case, label in (("fire_one_side", "strength"), ("transient_heating", "critical temperature")):
            with self.subTest(case):
                run = pyroclast.read(RUNS / case)
                self.assertEqual({card.label: card.of for card in _cards(run, {"course": {"marks": []}})}[label], told)
                self.assertIn(told, run_page(run))

    def test_the_first_lines_say_how_much_was_tested_and_how_hot_a_cold_test_was(self):
        run = pyroclast.read(RUNS / "compression")
        said = f"one specimen (seed {run.manifest['seed']}), {run.summary['specimen']['blocks']:,} blocks, in the plane"
        data = {"course": {"marks": []}}
        self.assertEqual({card.label: card.of for card in _cards(run, data)}["f_c"], said)
        self.assertEqual((_tested(run), _temperature(run)), (said, ["20 °C throughout"]))
        self.assertEqual(_temperature(pyroclast.read(RUNS / "fire_one_side")), [])
        self.assertTrue(_tested(pyroclast.read(RUNS / "starter_3d")).endswith("blocks, in space"))

    def test_a_verdict_against_the_results_stands_by_the_curve_too(self):
        for is_static in (True, False):
            html = run_page(self.changed("starter", results={"quasi_static": is_static}))
            self.assertEqual('id="verdict"' in html, not is_static)

    def test_energies_lost_in_ways_of_their_own_are_told(self):
        run = pyroclast.read(RUNS / "anderberg_thelandersson")
        lost = {name for name in run.history.names if name.startswith("dissipated_")}
        self.assertIn("dissipated_creep_J", lost)
        self.assertLessEqual(lost, {energy["column"] for energy in course_of(run).about["energy_out"]})

    def test_results_of_a_deck_come_first(self):
        found = [card.label for card in cards(pyroclast.read(RUNS / "notched_beam"))]
        self.assertLess(found.index("G_F"), found.index("peak_load"))
        self.assertFalse({"span", "peak_load_time"} & set(found))

    def test_marks_stand_at_the_first_row_of_their_kind(self):
        run = pyroclast.read(RUNS / "compression")
        history = run.history
        broken = sum(history[name] for name in history.names if name.endswith("_broken"))
        length = sum(history[f"{mode}_{interface}_length_m"] for mode, interfaces in run.facts.crack_modes.items()
                     for interface in interfaces)
        found = {mark.id: mark.row for mark in marks(run, history["stress_MPa"], history["strain"])}
        self.assertGreater(broken[found["first"]], 0)
        self.assertEqual(broken[found["first"] - 1], 0)
        self.assertGreaterEqual(length[found["extent"]], 1.0)
        self.assertLess(length[found["extent"] - 1], 1.0)
        self.assertAlmostEqual(history["strain"][found["peak"]], pyroclast.Compressed(run).peak[0],
                               delta=2e-5)  # rows are 1e-5 apart
        self.assertEqual(sorted(found.values()), list(found.values()))


if __name__ == "__main__":
    unittest.main()
