"""Numbers as a page keeps them come back within half a step; what a page cannot show is left out and told."""

import base64
import unittest
import zlib

import numpy as np

from pyroclast.report.bodies import chosen_frames
from pyroclast.report.packing import packed_floats, packed_steps, packed_whole, unpacked
from pyroclast.stored.frames import Frame


class Packing(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(7)

    def test_steps_come_back_within_half_a_step(self):
        values = np.cumsum(self.random.normal(scale=1e-5, size=(30, 400)), axis=0)
        for size in (1, 2, 4):
            with self.subTest(size=size):
                packed = packed_steps(values, 1e-7, size)
                # beside half a step, rounding of the largest number in steps
                self.assertLessEqual(np.abs(unpacked(packed) - values).max(), packed["step"] * (0.5 + 1e-9))

    def test_the_step_grows_where_so_few_bytes_hold_no_more(self):
        values = np.array([[0.0, 1.0], [2.0, -3.0]])
        self.assertEqual(packed_steps(values, 0.5, 1)["step"], 0.5)
        packed = packed_steps(values, 1e-3, 1)
        self.assertGreater(packed["step"], 3.0 / 127.0)
        self.assertLessEqual(np.abs(unpacked(packed) - values).max(), 0.5 * packed["step"] * (1.0 + 1e-9))

    def test_the_largest_value_fills_the_bytes(self):
        for size, steps in ((1, 126.5), (2, 32766.5), (4, 2147483646.5)):
            with self.subTest(size=size):
                packed = packed_steps(np.array([-3.0, 1.0]), 0.0, size)
                self.assertEqual((packed["step"], packed["bytes"]), (3.0 / steps, size))
                self.assertAlmostEqual(unpacked(packed)[0], -3.0, delta=packed["step"])
        self.assertEqual(packed_steps(np.array([1.0]), 0.5)["bytes"], 2)

    def test_values_that_are_not_finite_count_as_0(self):
        packed = packed_steps(np.array([np.nan, 2.0, np.inf, -np.inf]), 0.5)
        self.assertEqual(unpacked(packed).tolist(), [0.0, 2.0, 0.0, 0.0])
        self.assertEqual(packed["step"], 0.5)

    def test_nothing_comes_back_as_nothing(self):
        packed = packed_steps(np.empty((0, 3)), 1e-7)
        self.assertEqual((packed["shape"], packed["step"]), ([0, 3], 1e-7))
        self.assertEqual(unpacked(packed).shape, (0, 3))
        self.assertEqual(unpacked(packed_floats(np.empty((2, 0)))).shape, (2, 0))

    def test_bytes_stand_apart_the_lowest_first_and_are_deflated(self):
        def raw(packed):
            data = base64.b64decode(packed["data"])
            self.assertEqual(data[:2], b"\x78\x9c", "the level that RFC 1950 calls the default")
            return list(zlib.decompress(data))

        # differences 0, -1, 1, -2, 2, 300 as 0, 1, 2, 3, 4, 600 = 2 * 256 + 88
        self.assertEqual(raw(packed_whole(np.array([0, -1, 0, -2, 0, 300]), 2)), [0, 1, 2, 3, 4, 88] + [0] * 5 + [2])
        self.assertEqual(raw(packed_whole(np.array([[5, -1], [5, 1]]), 1)), [10, 1, 0, 4])
        self.assertEqual(raw(packed_floats(np.array([1.0, -2.0]))), [0, 0, 0, 0, 128, 0, 63, 192])

    def test_differences_wrap_around(self):
        values = np.array([[-32768, 32767], [32767, -32768], [0, 1]])
        self.assertEqual(unpacked(packed_whole(values, 2)).tolist(), values.tolist())
        self.assertEqual(unpacked(packed_whole(values + 65536, 2)).tolist(), values.tolist())

    def test_numbers_in_single_precision_keep_gaps(self):
        values = np.array([[1.5, np.nan], [-2e-30, 4e10]], dtype=np.float32)
        np.testing.assert_array_equal(unpacked(packed_floats(values)), values)


class Frames(unittest.TestCase):
    def test_needed_frames_stay_when_there_is_no_room_for_all(self):
        frames = [Frame(i, 0, 10 * i, 0.1 * i, 1e-4 * i, 1.0) for i in range(100)]
        chosen = [frame.number for frame in chosen_frames(frames, 8, lambda frame: frame.number in (41, 43))]
        self.assertEqual(len(chosen), 8)
        self.assertTrue({0, 41, 43, 99} <= set(chosen))
        self.assertEqual(chosen, sorted(chosen))


if __name__ == "__main__":
    unittest.main()
