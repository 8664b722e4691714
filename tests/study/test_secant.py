"""A secant meets targets as a person calibrates; each of its rounds is what the rule of docs says, to the digit.

Run from this folder, without the compiled part of the package:
    PYTHONPATH=../../python python3 -m unittest test_secant
"""

import unittest

import numpy as np

from pyroclast.study.methods import calibration, secant


class Secant(unittest.TestCase):
    """A stiffness and a strength, each a power of its own factor and a little of the other."""

    TARGETS = calibration.Targets(("E", "f_c"), np.array([32.0, 45.0]), np.array([0.1, 0.2]))
    RANGE = np.log(4.0)  # factors from 1/2 to 2, evenly in their logarithms

    def approach(self, answer, targets=TARGETS, rounds=10):
        return secant.approach(targets, np.full(2, 0.5), np.full(2, self.RANGE), rounds, answer)

    def concrete(self, u, scatter=0.0):
        stiffness, strength = np.exp(self.RANGE * (u - 0.5))
        shaken = 1.0 + scatter * np.sin(1e4 * u[0])
        return np.array([[21.0 * stiffness**0.9, 34.0 * stiffness**0.2 * strength**0.95 * shaken]] * 3)

    def test_meets_both_in_a_few_rounds(self):
        found = self.approach(self.concrete)
        self.assertTrue(found.is_met)
        self.assertLessEqual(len(found.points), 4)
        self.assertEqual(found.finished, "all targets are met")
        np.testing.assert_allclose(found.means[found.best], self.TARGETS.values, atol=0.2)

    def test_a_strength_that_is_not_smooth_is_met_within_its_sd(self):
        targets = calibration.Targets(("E", "f_c"), np.array([32.0, 45.0]), np.array([0.3, 0.9]))
        found = self.approach(lambda u: self.concrete(u, 0.01), targets)
        self.assertTrue(found.is_met)
        self.assertLessEqual(len(found.points), 6)

    def test_says_that_a_target_is_out_of_reach_and_keeps_the_nearest(self):
        targets = calibration.Targets(("E", "f_c"), np.array([60.0, 45.0]), np.array([0.5, 0.5]))
        found = self.approach(self.concrete, targets)
        self.assertFalse(found.is_met)
        self.assertEqual(found.finished, "no value within the ranges comes nearer")
        self.assertEqual(found.points[found.best][0], 1.0)
        np.testing.assert_allclose(found.means[found.best], [21.0 * 2.0**0.9, 45.0], rtol=0.01)

    def test_goes_half_the_way_back_from_a_point_without_a_value(self):
        def answer(u):
            return calibration.Infeasible() if u[1] > 0.75 else self.concrete(u)

        targets = calibration.Targets(("E", "f_c"), np.array([21.0, 47.0]), np.array([0.2, 0.4]))
        found = self.approach(lambda u: self.concrete(u) * (1.0, 0.8) if u[1] <= 0.75 else answer(u), targets)
        self.assertTrue(np.isnan(found.means).any())
        self.assertFalse(found.is_met)
        self.assertGreater(found.means[found.best][1], 27.3)

    def test_without_a_first_value_there_is_nothing_to_go_on_from(self):
        found = self.approach(lambda u: np.full((3, 2), np.nan))
        self.assertIsNone(found.best)
        self.assertEqual(len(found.points), 1)
        self.assertEqual(found.finished, "the first point gives no value of all targets")

    def test_the_same_points_whatever_is_known_when(self):
        whole = self.approach(self.concrete)
        known: dict[bytes, np.ndarray] = {}
        for _ in range(len(whole.points)):
            state = self.approach(lambda u: known.get(u.tobytes()))
            self.assertFalse(state.finished)
            known[state.points[-1].tobytes()] = self.concrete(state.points[-1])
        np.testing.assert_array_equal(self.approach(lambda u: known.get(u.tobytes())).points, whole.points)

    def test_ends_after_its_rounds(self):
        found = self.approach(self.concrete, rounds=2)
        self.assertEqual((len(found.points), found.finished), (2, "2 rounds"))


class Rounds(unittest.TestCase):
    """Rounds whose outputs are given, over targets of 1: so their logarithms are what is left."""

    ROUNDING = 1e-9  # points have nine digits

    def of(self, *left, start=(0.5,), slopes=(1.0,), sd=1e-9):
        """Rounds after each of which so much was left of each target; the last one tells no point."""
        rest = iter(np.atleast_2d(np.exp(np.array(left, float).reshape(len(left), -1))))
        targets = calibration.Targets(tuple("ab"[:len(start)]), np.ones(len(start)), np.full(len(start), sd))
        return secant.approach(targets, np.array(start), np.array(slopes), len(left), lambda u: next(rest)[None, :])

    def assert_points(self, found, *points):
        np.testing.assert_allclose(found.points, np.array(points, float).reshape(len(points), -1),
                                   atol=self.ROUNDING, rtol=0.0)

    def test_the_first_step_is_that_of_the_stated_slopes(self):
        self.assert_points(self.of(0.1, 1.0, slopes=(2.0,)), 0.5, 0.45)
        self.assert_points(self.of((0.1, -0.1), (1.0, 1.0), start=(0.5, 0.5), slopes=(2.0, 4.0)),
                           (0.5, 0.5), (0.45, 0.525))

    def test_points_have_nine_digits(self):
        found = self.of(0.1, 1.0, start=(1 / 3,), slopes=(7.0,))
        self.assertEqual(found.points[0, 0], 0.333333333)
        self.assertEqual(found.points[1, 0], round(0.333333333 - 0.1 / 7.0, 9))

    def test_a_step_is_two_fifths_of_the_range_at_most_and_keeps_its_direction(self):
        for left, step in ((0.39, 0.39), (0.41, 0.4), (0.8, 0.4)):
            with self.subTest(left=left):
                self.assert_points(self.of(left, 1.0, start=(0.9,)), 0.9, 0.9 - step)
        self.assert_points(self.of((0.8, 0.4), (1.0, 1.0), start=(0.9, 0.9), slopes=(1.0, 1.0)),
                           (0.9, 0.9), (0.5, 0.7))

    def test_a_slope_is_learned_from_a_step_that_tells_more_than_scatter(self):
        # a step of -left, after which half of it is left: the slope is a half of the stated one
        self.assert_points(self.of(0.0205, 0.01025, 1.0), 0.5, 0.4795, 0.4795 - 0.0205)
        self.assert_points(self.of(0.0195, 0.00975, 1.0), 0.5, 0.4805, 0.4805 - 0.00975)

    def test_a_slope_stays_within_a_factor_of_three_of_the_stated_one(self):
        # a step of -0.1 after which 0.1 (1 - slope) is left
        for slope, learned in ((2.9, 2.9), (3.1, 1.0), (0.34, 0.34), (0.32, 1.0)):
            with self.subTest(slope=slope):
                left = 0.1 * (1.0 - slope)
                self.assert_points(self.of(0.1, left, 1.0), 0.5, 0.4, 0.4 - left / learned)
        # the same factors of another slope; and one of two is enough to learn neither
        left = 0.1 * (1.0 - 2.9)
        self.assert_points(self.of(0.1, left, 1.0, slopes=(2.0,)), 0.5, 0.45, 0.45 - left / 5.8)
        self.assert_points(self.of((0.05, 0.05), (-0.25, 0.025), (1.0, 1.0), start=(0.5, 0.5), slopes=(1.0, 1.0)),
                           (0.5, 0.5), (0.45, 0.45), (0.7, 0.425))  # told are slopes of 3.5 and 0.75

    def test_slopes_that_hardly_tell_both_parameters_apart_are_not_learned(self):
        # A step of -0.05 of the first alone, which changes the second output by 0.05 c: slopes [[1, 0], [c, 1]], of
        # condition c^2 + 2, beyond 1000 from c = 31.6 on.
        for c, learned in ((30.0, True), (33.0, False)):
            with self.subTest(c=c):
                slopes = np.array([[1.0, 0.0], [c if learned else 0.0, 1.0]])
                found = self.of((0.05, 0.0), (0.0, -0.05 * c), (1.0, 1.0), start=(0.5, 0.5), slopes=(1.0, 1.0))
                step = -np.linalg.solve(slopes, [0.0, -0.05 * c])
                step *= min(1.0, 0.4 / np.abs(step).max())
                self.assert_points(found, (0.5, 0.5), (0.45, 0.5), np.array([0.45, 0.5]) + step)

    def test_learned_slopes_are_broyden_s(self):
        slopes, step, left = np.diag([2.0, 1.0]), np.array([-0.05, 0.1]), np.array([0.03, 0.02])
        first = -slopes @ step
        slopes += np.outer(left - first - slopes @ step, step) / (step @ step)
        found = self.of(first, left, (1.0, 1.0), start=(0.5, 0.5), slopes=(2.0, 1.0))
        self.assert_points(found, (0.5, 0.5), (0.45, 0.6), np.array([0.45, 0.6]) - np.linalg.solve(slopes, left))

    def test_who_would_leave_the_range_stays_at_its_end_and_the_other_is_met_beside(self):
        for end, sign in ((1.0, 1.0), (0.0, -1.0)):
            with self.subTest(end=end):
                # a step of 0.1 of both, after which slopes are learned
                start = np.full(2, 0.5 + 0.35 * sign)
                first, left = sign * np.array([-0.1, -0.1]), sign * np.array([-0.1, 0.1])
                slopes = np.array([[0.5, -0.5], [0.5, 1.5]])
                found = self.of(first, left, (1.0, 1.0), start=start, slopes=(1.0, 1.0))
                at = start - first
                of_first = end - at[0]
                of_second = -(left[1] + slopes[1, 0] * of_first) / slopes[1, 1]
                self.assertTrue(abs(np.linalg.solve(slopes, -left)[0]) > abs(of_first))
                self.assert_points(found, start, at, (end, at[1] + of_second))

    def test_a_target_out_of_reach_is_given_up_at_the_very_end(self):
        for start, left in ((0.9, -0.3), (0.1, 0.3)):
            with self.subTest(start=start):
                found = self.of(left, left, 1.0, start=(start,))
                self.assert_points(found, start, 0.0 if left > 0.0 else 1.0)
                self.assertEqual(found.finished, "no value within the ranges comes nearer")
        # a millionth from the end is the end
        self.assertEqual(len(self.of(-0.3, -0.3, 1.0, start=(1.0 - 1.05e-6,)).points), 2)
        self.assertEqual(len(self.of(-0.3, -0.3, 1.0, start=(1.0 - 0.95e-6,)).points), 1)

    def test_one_at_its_end_goes_on_as_long_as_the_other_is_not_met(self):
        found = self.of((-0.3, 0.1), (-0.3, 0.0), (1.0, 1.0), start=(1.0, 0.5), slopes=(1.0, 1.0))
        self.assert_points(found, (1.0, 0.5), (1.0, 0.4))
        self.assertEqual(found.finished, "no value within the ranges comes nearer")

    def test_a_millionth_of_the_range_is_no_step(self):
        self.assertEqual(len(self.of(1.05e-6, 1.0).points), 2)
        found = self.of(0.95e-6, 1.0)
        self.assertEqual((len(found.points), found.finished), (1, "no value within the ranges comes nearer"))

    def test_goes_half_the_way_back_to_the_last_values_and_learns_from_there(self):
        gap = np.nan
        self.assert_points(self.of(0.2, gap, gap, 1.0), 0.5, 0.3, 0.4, 0.45)
        self.assert_points(self.of(0.2, gap, 0.1, 1.0), 0.5, 0.3, 0.4, 0.3)
        self.assert_points(self.of(0.2, gap, 0.15, 1.0), 0.5, 0.3, 0.4, 0.4 - 0.15 / 0.5)
        self.assert_points(self.of((0.2, 0.1), (0.1, gap), (1.0, 1.0), start=(0.5, 0.5), slopes=(1.0, 1.0)),
                           (0.5, 0.5), (0.3, 0.4), (0.4, 0.45))

    def approach(self, outputs, values, sd):
        """Rounds whose outputs are given, of one seed or several."""
        rest = iter(np.array(output, float).reshape(-1, len(values)) for output in outputs)
        targets = calibration.Targets(tuple("ab"[:len(values)]), np.array(values), np.array(sd))
        k = len(values)
        return secant.approach(targets, np.full(k, 0.5), np.ones(k), len(outputs), lambda u: next(rest))

    def test_an_output_of_nothing_is_no_value(self):
        for output in (0.0, -1.0):
            self.assertEqual(self.approach([[output]], [2.0], [0.1]).finished,
                             "the first point gives no value of all targets")
        self.assertEqual(self.approach([[0.5]], [2.0], [0.1]).finished, "1 rounds")

    def test_a_mean_that_is_off_by_just_its_sd_is_met(self):
        found = self.approach([[[30.0, 7.0], [36.0, 9.0]]], [32.0, 9.0], [1.0, 1.0])
        np.testing.assert_array_equal(found.means, [[33.0, 8.0]])
        self.assertEqual((found.best, found.is_met, found.finished), (0, True, "all targets are met"))
        for off in ([[33.5, 8.0]], [[33.0, 7.5]]):
            found = self.approach(off, [32.0, 9.0], [1.0, 1.0])
            self.assertEqual((found.best, found.is_met, found.finished), (0, False, "1 rounds"))

    def test_the_best_round_is_the_nearest_in_sds(self):
        found = self.approach([[33.0, 100.0], [np.nan, 100.0], [32.0, 120.0], [35.0, 100.0]], [32.0, 100.0],
                              [0.1, 10.0])
        self.assertEqual(found.best, 2)
        self.assertFalse(found.is_met)

    def test_what_is_not_known_yet_has_no_mean(self):
        answers = iter([np.array([[3.0]]), None])
        targets = calibration.Targets(("a",), np.array([2.0]), np.array([0.1]))
        found = secant.approach(targets, np.array([0.5]), np.array([1.0]), 5, lambda u: next(answers))
        np.testing.assert_array_equal(found.means, [[3.0], [np.nan]])
        self.assertEqual((len(found.points), found.finished), (2, ""))


if __name__ == "__main__":
    unittest.main()
