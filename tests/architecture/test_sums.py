"""Sums over a body are taken by chunked_sum: sums.py tells what is looked for, allowed_sums.py what is allowed."""

import unittest

import sums
from allowed_sums import ALLOWED, NOT_YET
from sums import Allowed, Finding


def lines_of(code: str) -> list[int]:
    """Lines of a file in which a sum is found."""
    source = sums.Source("a.cpp", code)
    return [f.number for f in sums.findings_in(source, sums.declared_types([source.text]))]


class Library(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.found = sums.findings(sums.ROOT)

    def test_sums_over_a_body_are_taken_by_chunked_sum(self):
        self.assertEqual(sums.faults(self.found, ALLOWED + NOT_YET), [])

    def test_each_entry_has_its_own_reason_to_be(self):
        entries = [(a.file, a.at) for a in ALLOWED + NOT_YET]
        self.assertEqual(sorted(set(entries)), sorted(entries))
        self.assertEqual([a for a in ALLOWED + NOT_YET if not a.reason], [])


class Found(unittest.TestCase):
    def found(self, body: str):
        self.assertEqual(lines_of("void f() {\n" + body + "\n}\n"), [2], body)

    def test_plain_loops(self):
        self.found("double sum = 0.0; for (int g : gridpoints) sum += mechanics.displacement(g)[component];")
        self.found("for (int g = 0; g < n; ++g) { if (moves(g)) total_ -= mass_[g]; }")
        self.found("while (more()) for (double m : masses) { real_mass_ += m; }")
        self.found("do { sum += next(); } while (more());")
        self.found("for (double way = 0.0; way < 1.0; way += velocity * time) step();")

    def test_members_of_structures(self):
        self.found("EnergyLedger e; for (const auto& s : face_sums) e.contacts += s.stored;")
        self.found("for (int i = 0; i < n; ++i) cracks.mean_opening += opening(i) * length;")
        self.found("for (int node : held) trial.heat.prescribed += increment[node];")

    def test_other_ways_to_add(self):
        self.found("double s = 0.0; for (double x : all) s = s + x;")
        self.found("double s = 0.0; for (double x : all) s = x * x + s;")
        self.found("double s = 0.0; for (double x : all) s = std::fma(x, x, s);")
        self.found("const double s = std::accumulate(a.begin(), a.end(), 0.0);")
        self.found("const double s = std::transform_reduce(a.begin(), a.end(), b.begin(), 0.0);")
        self.found("std::atomic<double> s; s.fetch_add(x);")
        self.assertEqual(lines_of("void f() {\n#pragma omp parallel for reduction(+ : s)\n}\n"), [2])

    def test_lambdas(self):
        self.found("double s = 0.0; for_each_zone([&](int z) { s += volume[z]; });")
        self.found("const auto add = [&](int z, double& s) { s += volume[z]; };")

    def test_other_names_of_a_sum(self):
        self.found("for (int z = 0; z < n; ++z) { double& s = sums.stored; s += volume[z]; }")
        self.found("for (int z = 0; z < n; ++z) { auto* s = &sums; s->stored += volume[z]; }")
        self.found("for (int step = 0; step < n; ++step) for (auto& total : totals) total += heat[step];")
        self.assertEqual(lines_of("void add(int z, Sums& sums) {\n  sums.stored += volume[z];\n}\n"), [2])

    def test_views(self):
        self.found("for (int z = 0; z < n; ++z) { auto s = state.sums; s[0] += volume[z]; }")
        self.found("for (int z = 0; z < n; ++z) { std::span<double> s = sums(); s[0] += volume[z]; }")

    def test_components_of_a_sum(self):
        self.found("for (int g = 0; g < n; ++g) for (int i = 0; i < Dim; ++i) sum[i] += force[g][i];")
        self.found("for (int z = 0; z < n; ++z) sum[material[z]] += volume[z];")
        self.found("for (int z = 0; z < n; ++z) { const int m = material[z]; sum[m] += volume[z]; }")

    def test_what_chunked_sum_does_not_hand_out(self):
        self.found("double s = 0.0; chunked_sum(chunks, [&](int z) { s += volume[z]; return 0.0; });")

    def test_a_sum_named_like_an_integer_elsewhere(self):
        self.assertEqual(lines_of("void f() { int sum = 0; for (int i : a) sum += i; }\n"
                                  "void g() { double sum = 0.0; for (double x : b) sum += x; }\n"), [2])


class NotFound(unittest.TestCase):
    def not_found(self, body: str):
        self.assertEqual(lines_of("void f() {\n" + body + "\n}\n"), [], body)

    def test_elements_of_arrays(self):
        self.not_found("for (int node = 0; node < n; ++node) enthalpy[node] += increment[node];")
        self.not_found("for (auto& x : positions) x += shift;")
        self.not_found("for (int z = 0; z < n; ++z) for (int i = 0; i < Dim; ++i) row[z].c[i] += drag[i];")

    def test_what_lives_for_one_turn(self):
        self.not_found("for (int g : all) { Vec<2> force = weight(g); force += load(g); store(g, force); }")
        self.not_found("for (int g : all) { double a = 0.0, b = 0.0; b += load(g); store(a, b); }")

    def test_integers_and_text(self):
        self.not_found("std::size_t bytes = 0; for (const auto& a : arrays) bytes += bytes_of(a);")
        self.not_found("std::string line; for (const auto& c : columns) line += c.name;")
        self.not_found("const int n = std::accumulate(a.begin(), a.end(), 0);")
        self.not_found("std::atomic<int> done; done.fetch_add(1);")

    def test_the_largest_and_comments(self):
        self.not_found("for (double x : all) largest = std::max(largest, std::abs(x - y));")
        self.not_found("for (double x : all) { /* s += x; */ } // s += x;")

    def test_chunked_sum(self):
        self.not_found("const double s = chunked_sum(chunks, [&](int z) { return volume[z]; });")
        self.not_found("const auto s = chunked_sum<Vec<Dim>>(chunks, [&](int g, Vec<Dim>& s) { s += force(g); });")
        self.not_found("const auto s = chunked_sum<Sums>(chunks, [&](int row, Sums& s) {"
                       " for (int lane = 0; lane < 8; ++lane) s += {loss[row][lane], area[row][lane]}; });")


class List(unittest.TestCase):
    FOUND = Finding("thermal/conduction.cpp", 7, "Conduction::ledger", "sum += heat[node];")

    def test_a_sum_that_no_entry_allows_is_a_fault(self):
        faults = sums.faults([self.FOUND], [])
        self.assertEqual(len(faults), 1)
        self.assertIn("thermal/conduction.cpp:7: Conduction::ledger: sum += heat[node];", faults[0])

    def test_an_entry_that_finds_nothing_is_a_fault(self):
        faults = sums.faults([], [Allowed("thermal/conduction.cpp", "sum +=", "why")])
        self.assertEqual(len(faults), 1)
        self.assertIn("thermal/conduction.cpp", faults[0])

    def test_entries_name_functions_and_parts_of_lines(self):
        for file, at in [("thermal/conduction.cpp", "Conduction::ledger()"), ("*", "heat[node]"), ("thermal/*", "")]:
            self.assertTrue(Allowed(file, at, "why").matches(self.FOUND), (file, at))
        for file, at in [("thermal/conduction.cpp", "ledger()"), ("conduction.cpp", ""), ("*", "heat(node)")]:
            self.assertFalse(Allowed(file, at, "why").matches(self.FOUND), (file, at))

    def test_a_file_that_cannot_be_read_is_named(self):
        with self.assertRaisesRegex(ValueError, r"a\.cpp:2: \{ stays open"):
            lines_of("void f();\nvoid g() {\n")


if __name__ == "__main__":
    unittest.main()
