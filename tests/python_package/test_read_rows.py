"""The compiled reader of rows gives what the package's own gives."""

import unittest

import numpy as np

from pyroclast import _core
from pyroclast.stored import files


class Rows(unittest.TestCase):
    def test_both_agree(self):
        random = np.random.default_rng(2)
        rows = [[*map(repr, map(float, random.normal(size=3) * 10.0 ** random.integers(-12, 12))),
                 "" if i % 7 == 0 else "3", str(i), ""] for i in range(2000)]
        text = "".join(",".join(row) + "\n" for row in rows).encode()
        wanted = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows]).T
        np.testing.assert_array_equal(_core.read_rows(text, 6, files.LARGEST), wanted)
        np.testing.assert_array_equal(files.read_rows(text, 6), wanted)

    def test_both_leave_the_same_to_the_slow_way(self):
        for lines in (b"1,2\n3\n", b"1,2,3\n", b"1,x\n", b"1,2", b"1,inf\n", b"1,nan\n", b"1,1e31\n", b'"1",2\n',
                      b"1,2\r\n", b"1, 2\n", b"\n", b"1-2,3\n", b"1,2\n\n", b"1_0,2\n", b"\xff,1\n", b"1,2\n3,4,5\n6\n",
                      b"e,1\n", b""):
            with self.subTest(lines):
                self.assertIsNone(_core.read_rows(lines, 2, files.LARGEST))
                self.assertIsNone(files.read_rows(lines, 2))


if __name__ == "__main__":
    unittest.main()
