"""Sums over a body are taken by chunked_sum. tests/simulation/parts_test.cpp finds sums that are not; here stand the
files that may call the sums of the standard library, each over a few things of its own."""

import pathlib
import re
import unittest

SOURCES = pathlib.Path(__file__).parents[2] / "src/pyroclast"
SUM = re.compile(r"\bstd::(accumulate|reduce|transform_reduce|inner_product|partial_sum|inclusive_scan|exclusive_scan)\b"
                 r"|\bfetch_(add|sub)\b")
MAY = {
    "base/team.cpp",  # counts of threads and whole nanoseconds
    "deck/toml_characters.cpp",  # levels of a text
    "mechanics/totals.cpp",  # entries of one ledger, each a chunked sum
    "thermal/conduction.cpp",  # parts of one node
}


class Sums(unittest.TestCase):
    def test_only_these_files_call_sums_of_the_standard_library(self):
        found = {str(path.relative_to(SOURCES)) for path in SOURCES.rglob("*.?pp") if SUM.search(path.read_text())}
        self.assertEqual(found, MAY)


if __name__ == "__main__":
    unittest.main()
