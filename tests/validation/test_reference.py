"""validation/reference: what counts as the same result, and what does not."""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import pathlib
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "validation" / "reference"
loader = importlib.machinery.SourceFileLoader("reference", str(SCRIPT))
reference = importlib.util.module_from_spec(importlib.util.spec_from_loader("reference", loader))
loader.exec_module(reference)

KINDS = ["settle", "heat"]
HISTORY = {
    "stage": ["0", "0", "1", "1"],
    "step": ["0", "200", "400", "600"],
    "cycles": ["0", "0", "200", "200"],
    "largest_jump": ["0", "0.125", "0.333333333", "0.5"],
    "stress_MPa": ["0", "10.1234567", "30.1234567", "1e-05"],
    "energy_zones_J": ["0", "1000", "4000", "5000"],
    "energy_error_J": ["0", "1e-07", "2e-07", "3e-07"],
}


class Reference(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.count = 0  # of histories made
        # the rules of a test are its own
        rules = json.loads(json.dumps(reference.RULES))
        self.addCleanup(setattr, reference, "RULES", reference.RULES)
        reference.RULES = rules
        reference.RULES["renamed"] = {}
        reference.RULES["changed"] = []

    def made(self, name, history, version=1, keep_history=True):
        """What `make` would write of one case with this history."""
        self.count += 1
        path = self.folder / f"{name}_{self.count}"
        path.mkdir()
        rows = zip(*history.values())
        text = "\n".join([",".join(history), *(",".join(row) for row in rows)])
        (path / "case.csv").write_text(text + "\n")
        case = reference.describe_case(reference.read_history(path / "case.csv", KINDS), KINDS)
        case["deck"] = "deck"
        if not keep_history:
            (path / "case.csv").unlink()
        file = path.with_suffix(".json")
        reference.write(file, {"form": "small", "commit": "abc", "physics_version": version,
                               "machine": {"processor": "p", "libc": "l", "libm": "m"}, "cases": {"case": case}})
        return file

    def differences(self, old, new, keep_history=True):
        a = reference.read(self.made("a", old, keep_history=keep_history))
        b = reference.read(self.made("b", new))
        return reference.compare_case(a, b, "case")

    def with_cell(self, column, row, cell):
        return HISTORY | {column: [*HISTORY[column][:row], cell, *HISTORY[column][row + 1:]]}

    def test_equal_histories_do_not_differ(self):
        self.assertEqual(self.differences(HISTORY, HISTORY), ([], []))

    def test_one_digit_of_a_value_that_is_no_sum_is_a_difference_with_its_place(self):
        found, _ = self.differences(HISTORY, self.with_cell("largest_jump", 2, "0.333333334"))
        self.assertEqual(found, [("largest_jump", "stage 1 (heat), row 0: 0.333333333 / 0.333333334")])

    def test_the_difference_shows_in_the_hash_where_no_history_is_kept(self):
        found, _ = self.differences(HISTORY, self.with_cell("largest_jump", 2, "0.333333334"), keep_history=False)
        self.assertEqual(found, [("largest_jump", "stage 1 (heat), hashes differ")])

    # 30.1234567 is the largest stress, known to 5e-8; the last digits of two sums may be one apart, not two.
    def test_a_sum_of_nine_digits_may_differ_by_its_rounding(self):
        self.assertEqual(self.differences(HISTORY, self.with_cell("stress_MPa", 2, "30.1234568")), ([], []))

    def test_a_sum_of_nine_digits_may_not_differ_by_more(self):
        for keep_history in (True, False):
            with self.subTest(keep_history=keep_history):
                found, _ = self.differences(HISTORY, self.with_cell("stress_MPa", 2, "30.1234569"), keep_history)
                self.assertEqual(found, [("stress_MPa", "stage 1 (heat), row 0: 30.1234567 / 30.1234569")])

    def test_a_sum_of_all_digits_is_held_to_the_tolerance_of_its_largest(self):
        old = HISTORY | {"stress_MPa": ["0", "10.123456700000001", "30.123456700000002", "1e-05"]}
        for cell, same in (("1.0000029e-05", True), ("1.0000031e-05", False)):
            found, _ = self.differences(old, old | {"stress_MPa": [*old["stress_MPa"][:3], cell]})
            self.assertEqual(found == [], same, cell)

    def test_more_digits_of_the_same_numbers_are_no_difference(self):
        new = HISTORY | {"largest_jump": ["0", "0.125", "0.33333333333333331", "0.5"],
                         "stress_MPa": ["0", "10.123456712345678", "30.123456749999999", "1.0000000000000001e-05"]}
        self.assertEqual(self.differences(HISTORY, new), ([], []))
        other = new | {"largest_jump": ["0", "0.125", "0.33333333433333331", "0.5"]}
        self.assertEqual([column for column, _ in self.differences(HISTORY, other)[0]], ["largest_jump"])

    # The error of a ledger is a small difference of large sums: 1e-12 of 5000 J, not of 3e-7 J.
    def test_the_error_of_a_ledger_is_measured_against_what_it_sums(self):
        self.assertEqual(self.differences(HISTORY, self.with_cell("energy_error_J", 3, "3.04e-07")), ([], []))

    def test_the_error_of_a_ledger_is_held_to_that(self):
        found, _ = self.differences(HISTORY, self.with_cell("energy_error_J", 3, "3.06e-07"))
        self.assertEqual([column for column, _ in found], ["energy_error_J"])

    def test_a_sum_that_is_no_number_is_a_difference(self):
        found, _ = self.differences(HISTORY, self.with_cell("stress_MPa", 2, "nan"))
        self.assertEqual([column for column, _ in found], ["stress_MPa"])

    def test_a_row_more_is_a_difference(self):
        new = {column: [*cells, cells[-1]] for column, cells in HISTORY.items()}
        found, _ = self.differences(HISTORY, new)
        self.assertIn(("rows", "stage 1 (heat): 2 / 3"), found)

    def test_results_of_the_summary_are_held_too(self):
        def compared(old: dict, new: dict):
            return reference.compare_results({"cases": {"case": {"results": old}}}, {"cases": {"case": {"results": new}}},
                                             "case")

        old = {"1.outcome": "completed", "1.f_c_MPa": 30.0, "1.quasi_static": True}
        self.assertEqual(compared(old, old | {"1.f_c_MPa": 30.0 + 1e-9, "1.new": 1}), ([], ["1.new"]))
        self.assertEqual(compared(old, old | {"1.f_c_MPa": 30.0 + 1e-6})[0], [("1.f_c_MPa", "30.0 / 30.000001")])
        self.assertEqual(compared(old, old | {"1.f_c_MPa": None})[0], [("1.f_c_MPa", "30.0 / None")])
        self.assertEqual(compared(old, old | {"1.quasi_static": False})[0], [("1.quasi_static", "True / False")])
        self.assertEqual(compared(old, {"1.outcome": "completed"})[0],
                         [("1.f_c_MPa", "30.0 / none"), ("1.quasi_static", "True / none")])
        self.assertEqual(compared({}, old), ([], []))  # a reference of before results were kept

    def test_a_column_that_vanished_is_a_difference_and_a_new_one_is_named(self):
        new = {column: cells for column, cells in HISTORY.items() if column != "largest_jump"} | {"opening": ["0"] * 4}
        found, added = self.differences(HISTORY, new)
        self.assertEqual({text for _, text in found},
                         {"stage 0 (settle): no column largest_jump", "stage 1 (heat): no column largest_jump"})
        self.assertEqual(added, ["opening"])

    def test_a_renamed_column_is_compared_under_its_new_name(self):
        reference.RULES["renamed"] = {"largest_jump": "jump"}
        new = {{"largest_jump": "jump"}.get(column, column): cells for column, cells in HISTORY.items()}
        self.assertEqual(self.differences(HISTORY, new), ([], []))

    def test_a_quantity_may_be_empty_only_where_its_stage_has_none(self):
        self.assertEqual(self.differences(HISTORY, HISTORY | {"cycles": ["", "", "200", "200"]}), ([], []))

    def test_a_quantity_may_not_be_empty_where_its_stage_has_it(self):
        found, _ = self.differences(HISTORY, HISTORY | {"largest_jump": ["", "", "0.333333333", "0.5"]})
        self.assertEqual(found, [("largest_jump", "stage 0 (settle): empty in the second")])

    def renew(self, made):
        options = type("Options", (), {"file": made})
        with contextlib.redirect_stdout(io.StringIO()):
            return reference.run_renew(options)

    def test_a_stored_value_is_renewed_only_if_its_change_is_listed(self):
        committed, reference.COMMITTED = reference.COMMITTED, self.folder / "reference_small.json"
        self.addCleanup(setattr, reference, "COMMITTED", committed)
        self.renew(self.made("first", HISTORY))
        stored = (self.folder / "reference_small.json").read_bytes()
        changed = self.made("second", self.with_cell("largest_jump", 2, "0.3"), version=2)
        with self.assertRaisesRegex(reference.Fault, "case, largest_jump"):
            self.renew(changed)
        reference.RULES["changed"] = [
            {"physics_version": 1, "cases": ["*"], "columns": ["*"], "reason": "another version"},
            {"physics_version": 2, "cases": ["case"], "columns": ["step"], "reason": "another column"}]
        with self.assertRaisesRegex(reference.Fault, "case, largest_jump"):
            self.renew(changed)
        self.assertEqual((self.folder / "reference_small.json").read_bytes(), stored)
        reference.RULES["changed"] = [
            {"physics_version": 2, "cases": ["case"], "columns": ["largest_*"], "reason": "mended"}]
        self.renew(changed)
        renewed = (self.folder / "reference_small.json").read_bytes()
        self.assertNotEqual(renewed, stored)
        full = json.loads(renewed) | {"form": "full"}
        (self.folder / "full.json").write_text(json.dumps(full))
        with self.assertRaisesRegex(reference.Fault, "is of full forms"):
            self.renew(self.folder / "full.json")
        self.assertEqual((self.folder / "reference_small.json").read_bytes(), renewed)


if __name__ == "__main__":
    unittest.main()
