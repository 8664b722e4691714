"""The study's mathematics against functions whose answers are known.

Run from this folder, without the compiled part of the package:
    PYTHONPATH=../../python python3 -m unittest test_methods
"""

import inspect
import subprocess
import sys
import unittest
import warnings
from itertools import combinations
from unittest import mock

import numpy as np
from scipy.stats import chi2, norm, spearmanr, t

from pyroclast.errors import Error
from pyroclast.study.methods import (_needs, calibration, ensemble, hsic, main_effects, morris, posterior, sampling,
                                     seeds, sobol, surrogate)


def ishigami(u):
    """Ishigami, Homma 1990, with a = 7 and b = 0.1."""
    x = np.pi * (2.0 * np.asarray(u) - 1.0)
    return np.sin(x[..., 0]) + 7.0 * np.sin(x[..., 1]) ** 2 + 0.1 * x[..., 2] ** 4 * np.sin(x[..., 0])


def ishigami_indices():
    a, b = 7.0, 0.1
    first = 0.5 * (1.0 + b * np.pi**4 / 5.0) ** 2
    second = a**2 / 8.0
    both = b**2 * np.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    variance = first + second + both
    return np.array([first, second, 0.0]) / variance, np.array([first + both, second, both]) / variance


G = np.array([0.0, 1.0, 4.5, 9.0])


def g_function(u):
    """Sobol's g-function."""
    return np.prod((np.abs(4.0 * u - 2.0) + G) / (1.0 + G), axis=-1)


def g_indices():
    alone = 1.0 / (3.0 * (1.0 + G) ** 2)
    variance = np.prod(1.0 + alone) - 1.0
    return alone / variance, alone * np.prod(1.0 + alone) / (1.0 + alone) / variance


def morris_function(u, coefficient_seed=1):
    """The 20-parameter function of Morris, Technometrics 33, 1991; the coefficients left open are N(0, 1)."""
    random = np.random.default_rng(coefficient_seed)
    w = 2.0 * (u - 0.5)
    for i in (2, 4, 6):
        w[..., i] = 2.0 * (1.1 * u[..., i] / (u[..., i] + 0.1) - 0.5)
    one = np.where(np.arange(20) < 10, 20.0, random.normal(size=20))
    result = random.normal() + w @ one
    for i, j in combinations(range(20), 2):
        drawn = random.normal()
        result = result + (-15.0 if j < 6 else drawn) * w[..., i] * w[..., j]
    for i, j, m in combinations(range(5), 3):
        result = result - 10.0 * w[..., i] * w[..., j] * w[..., m]
    return result + 5.0 * w[..., 0] * w[..., 1] * w[..., 2] * w[..., 3]


def within(low, value, high):
    return bool(np.all((low <= value) & (value <= high)))


class Sampling(unittest.TestCase):
    def test_grid_has_all_combinations(self):
        points = sampling.grid([3, 2, 1])
        np.testing.assert_array_equal(points, [[0, 0, 0.5], [0, 1, 0.5], [0.5, 0, 0.5], [0.5, 1, 0.5], [1, 0, 0.5],
                                               [1, 1, 0.5]])
        np.testing.assert_allclose(sampling.grid([4, 2], ends=[False, True])[::2, 0], [0.125, 0.375, 0.625, 0.875])
        np.testing.assert_allclose(sampling.inside(np.array([0.0, 1 / 3, 1.0]), 4), [0.125, 0.375, 0.875])
        with self.assertRaises(Error):
            sampling.grid([3, 0])

    def test_shares_have_their_middles(self):
        np.testing.assert_allclose(sampling.in_shares(np.array([0.0, 0.24, 0.25, 0.6, 0.99, 1.0]), 4),
                                   [0.125, 0.125, 0.375, 0.625, 0.875, 0.875])
        np.testing.assert_allclose(sampling.grid([1, 2], ends=False), [[0.5, 0.25], [0.5, 0.75]])
        self.assertEqual(len(sampling.grid([1, 1])), 1)

    def test_the_best_of_many_latin_hypercubes_is_even(self):
        from scipy.stats import qmc
        found = qmc.discrepancy(sampling.latin_hypercube(20, 2, 3))
        others = [qmc.discrepancy(qmc.LatinHypercube(2, seed=seed).random(20)) for seed in range(100)]
        self.assertLess(found, np.percentile(others, 10))

    def test_the_best_is_the_best_of_a_hundred(self):
        from scipy.stats import qmc
        drawn = qmc.LatinHypercube(2, seed=np.random.default_rng(4))
        all_of_them = [drawn.random(12) for _ in range(100)]
        best = all_of_them[int(np.argmin([qmc.discrepancy(points) for points in all_of_them]))]
        np.testing.assert_array_equal(sampling.latin_hypercube(12, 2, 4), best)
        with mock.patch("scipy.stats.qmc.discrepancy", wraps=qmc.discrepancy) as asked:
            sampling.latin_hypercube(12, 2, 4)
        self.assertEqual(asked.call_count, 100)

    def test_points_of_the_sequence_are_no_ends(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # no power of two, and no warning
            points = sampling.sobol_sequence(100, 2, 1, first=7)
        self.assertTrue((points > 0.0).all() and (points < 1.0).all())
        from scipy.stats import qmc
        own = qmc.Sobol(2, scramble=True, bits=30, seed=np.random.default_rng(1)).random(128)
        np.testing.assert_array_equal(np.floor(sampling.sobol_sequence(128, 2, 1) * 2.0**30), own * 2.0**30)
        # to 30 bits, each in the middle of its place
        np.testing.assert_array_equal(np.mod(points * 2.0**31, 2.0), 1.0)

    def test_rank_correlations_need_their_form(self):
        u = np.full((5, 2), 0.5)
        for wrong in ([[1.0, 0.2]], [[1.0, 0.2], [0.2, 0.9]], [[1.0, 0.2], [0.3, 1.0]], np.eye(3)):
            with self.assertRaisesRegex(Error, "of 2 parameters: a symmetric matrix with ones on its diagonal"):
                sampling.correlated(u, wrong)
        points = sampling.sobol_sequence(64, 2, 1)
        moved = sampling.correlated(points, [[1.0, 0.5], [0.5, 1.0]])
        np.testing.assert_array_equal(moved[:, 0], points[:, 0])
        self.assertFalse(np.array_equal(np.sort(moved[:, 1]), np.sort(points[:, 1])))
        # a Gaussian copula: of independent normal scores a and b, r a + sqrt(1 - r^2) b
        r = 2.0 * np.sin(np.pi * 0.5 / 6.0)
        a, b = norm.ppf(points.T)
        np.testing.assert_allclose(moved[:, 1], norm.cdf(r * a + np.sqrt(1.0 - r**2) * b), atol=1e-12)

    def test_latin_hypercube_has_one_point_in_each_class(self):
        points = sampling.latin_hypercube(17, 3, 5)
        np.testing.assert_array_equal(np.sort(np.floor(17 * points), axis=0), np.tile(np.arange(17.0)[:, None], 3))
        np.testing.assert_array_equal(points, sampling.latin_hypercube(17, 3, 5))
        self.assertFalse(np.array_equal(points, sampling.latin_hypercube(17, 3, 6)))

    def test_sobol_sequence_extends(self):
        long = sampling.sobol_sequence(64, 4, 3)
        np.testing.assert_array_equal(long[:32], sampling.sobol_sequence(32, 4, 3))
        np.testing.assert_array_equal(long[32:], sampling.sobol_sequence(32, 4, 3, first=32))
        # One point in each of 64 classes: what independent random points do not give.
        np.testing.assert_array_equal(np.sort(np.floor(64 * long[:, 2])), np.arange(64))
        self.assertTrue(long.min() > 0.0 and long.max() < 1.0)

    def test_correlated_points(self):
        wanted = np.array([[1.0, 0.7, 0.0], [0.7, 1.0, -0.3], [0.0, -0.3, 1.0]])
        points = sampling.correlated(sampling.sobol_sequence(4096, 3, 2), wanted)
        np.testing.assert_allclose(spearmanr(points)[0], wanted, atol=0.005)
        even = (np.arange(4096.0)[:, None] + 0.5) / 4096
        np.testing.assert_allclose(np.sort(points, axis=0), np.tile(even, 3), atol=0.03)

    def test_correlated_latin_hypercube_remains_one(self):
        points = sampling.latin_hypercube(200, 2, 1)
        moved = sampling.correlated(points, [[1.0, -0.6], [-0.6, 1.0]], keep_columns=True)
        np.testing.assert_array_equal(np.sort(moved, axis=0), np.sort(points, axis=0))
        self.assertAlmostEqual(spearmanr(moved)[0], -0.6, delta=0.08)

    def test_impossible_correlations_are_refused(self):
        with self.assertRaisesRegex(Error, "not positive definite"):
            sampling.correlated(np.full((3, 3), 0.4), [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]])
        with self.assertRaisesRegex(Error, "symmetric"):
            sampling.correlated(np.full((3, 2), 0.4), [[1, 0.9], [0.1, 1]])


class Needs(unittest.TestCase):
    def test_openturns_is_silent_within_and_afterwards_as_before(self):
        import openturns
        before = openturns.Log.Flags()
        openturns.RandomGenerator.SetSeed(5)
        openturns.RandomGenerator.Generate()
        state = openturns.RandomGenerator.GetState()
        drawn = []
        for seed in (3, 3, 4):
            with _needs.openturns("a test", seed) as ot:
                self.assertEqual(ot.Log.Flags(), ot.Log.ERROR)
                drawn.append(ot.RandomGenerator.Generate())
        self.assertEqual(openturns.Log.Flags(), before)
        self.assertEqual(openturns.RandomGenerator.GetState().getIndex(), state.getIndex())
        self.assertEqual(drawn[0], drawn[1])
        self.assertNotEqual(drawn[0], drawn[2])

    def test_how_often_is_drawn_where_nothing_is_stated(self):
        for function, key, count in ((seeds.share, "resamples", 1000), (morris.effects, "resamples", 1000),
                                     (main_effects.rank_effects, "resamples", 1000), (sobol.indices, "resamples", 500),
                                     (surrogate.indices, "resamples", 500), (hsic.dependence, "permutations", 500),
                                     (calibration.uncertainty, "draws", 4000), (posterior.sample, "most_steps", 50000),
                                     (main_effects.curve, "most_classes", 10), (surrogate.fit, "most_degree", 10)):
            self.assertEqual(inspect.signature(function).parameters[key].default, count, function)


class SeedShare(unittest.TestCase):
    def test_known_variances(self):
        random = np.random.default_rng(2)
        point, seed, rest = 2.0, 1.0, 1.5
        y = (random.normal(0, point, (400, 1)) + random.normal(0, seed, (1, 40)) + random.normal(0, rest, (400, 40)))
        share = seeds.share(y)
        between = seed**2 + rest**2
        self.assertTrue(share.single_low <= between / (between + point**2) <= share.single_high, share)
        self.assertTrue(share.mean_low <= between / 40 / (between / 40 + point**2) <= share.mean_high, share)
        self.assertLess(share.single_high - share.single_low, 0.2)
        self.assertAlmostEqual(seeds.rest_variance(y), rest**2, delta=0.1)

    def test_seeds_alone_and_points_alone(self):
        noise = np.random.default_rng(3).normal(size=(200, 3))
        self.assertGreater(seeds.share(noise).single_low, 0.9)
        self.assertLess(seeds.share(np.arange(200.0)[:, None] + np.zeros((1, 3))).single, 1e-12)
        self.assertTrue(np.isnan(seeds.share(noise[:, :1]).single))
        two = seeds.share(noise[:, :2])
        self.assertGreater(two.single, 0.9)
        self.assertTrue(np.isnan([two.single_low, two.single_high, two.mean_low, two.mean_high]).all())


class Seeds(unittest.TestCase):
    """What stands behind every statement about noise, by hand."""

    def test_shares_by_hand(self):
        # Two points whose means are 0 and 4, three seeds that add -1, 0, 1: of them the variance between is 1, that of
        # the points 8; nothing is left over.
        y = np.array([[-1.0, 0.0, 1.0], [3.0, 4.0, 5.0]])
        share = seeds.share(y, resamples=50)
        self.assertAlmostEqual(share.single, 1.0 / 9.0)
        self.assertAlmostEqual(share.mean, (1.0 / 3.0) / (1.0 / 3.0 + 8.0))
        self.assertEqual((share.points, share.seeds), (2, 3))
        self.assertAlmostEqual(seeds.rest_variance(y), 0.0)
        # A rest of +-1 that is no seed's and no point's: 4 squares over one degree of freedom. It moves the points'
        # means by nothing here, so that their own variance is what is left of 8 without its third.
        rest = np.array([[1.0, -1.0], [-1.0, 1.0]])
        self.assertAlmostEqual(seeds.rest_variance(rest), 4.0)
        y = np.array([[0.0, 0.0], [4.0, 4.0]]) + rest
        share = seeds.share(y)
        self.assertAlmostEqual(share.single, 2.0 / (2.0 + 8.0 - 0.5 * 4.0))
        self.assertAlmostEqual(share.mean, 1.0 / (1.0 + 8.0 - 0.5 * 4.0))

    def test_what_is_missing_or_too_few(self):
        y = np.array([[-1.0, 0.0, 1.0], [3.0, 4.0, 5.0], [np.nan, 100.0, 7.0]])
        self.assertEqual(seeds.share(y, resamples=50), seeds.share(y[:2], resamples=50))
        self.assertAlmostEqual(seeds.rest_variance(y), 0.0)
        for few in (y[:1], y[:2, :1]):
            share = seeds.share(few)
            self.assertTrue(np.isnan([share.single, share.single_low, share.single_high, share.mean, share.mean_low,
                                      share.mean_high]).all())
            self.assertEqual((share.points, share.seeds), few.shape)
            self.assertTrue(np.isnan(seeds.rest_variance(few)))
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # no 0/0 on the way
            for few in (y[:1], y[:2, :1]):
                seeds.share(few)
                seeds.rest_variance(few)
            seeds.share(y[:2])  # of three seeds a ninth of the resamples has one seed alone
        np.testing.assert_array_equal(np.isnan(seeds.over_seeds(y)), [False, False, True])

    def test_intervals_hold_their_share_of_what_was_resampled(self):
        even = np.arange(1001.0)[:, None] * [1.0, -1.0]
        low, high = seeds.interval(even, 10**9)
        np.testing.assert_allclose(low, [25.0, -975.0], atol=0.01)
        np.testing.assert_allclose(high, [975.0, -25.0], atol=0.01)
        low, high = seeds.interval(even, 1)
        np.testing.assert_array_equal((low[0], high[0]), (0.0, 1000.0))
        # of two: Student's t of one degree is 12.71, times the root of 2, of which a normal has all
        self.assertAlmostEqual(seeds.level(2), 1.0)
        self.assertAlmostEqual(seeds.level(5), 0.99809, 4)  # 2.776 times the root of 5/4

    def test_intervals_are_those_of_resampled_seeds(self):
        """Of two points whose means differ by 8: a resample that has s seeds of three more than once is known."""
        y = np.array([[-3.0, 0.0, 3.0], [5.0, 8.0, 11.0]])
        found = seeds.share(y, resamples=4000)
        # all three: 9 of 9 + 32. Two of one and one of another seed: of these the variance is 4.5 or 18, the points' 32
        shares = np.repeat([9.0 / 41.0, 4.5 / 36.5, 18.0 / 50.0], [6, 12, 6])
        self.assertAlmostEqual(found.single, 9.0 / 41.0)
        self.assertAlmostEqual(found.single_low, shares.min())
        self.assertAlmostEqual(found.single_high, shares.max())
        means = shares / 3.0 / (shares / 3.0 + 1.0 - shares)
        self.assertAlmostEqual(found.mean_low, means.min())
        self.assertAlmostEqual(found.mean_high, means.max())

    def test_a_resample_of_some_seeds_is_the_share_of_these(self):
        """A seed that a resample does not have does not count, and one that it has twice is free of bias."""
        y = np.random.default_rng(5).normal(size=(6, 4)) + np.arange(6.0)[:, None] + [0.0, 3.0, -1.0, 5.0]
        some = np.array([[0.5, 0.5, 0.0, 0.0], [0.0, 1 / 3, 1 / 3, 1 / 3]])
        found, _ = seeds._shares(y, some)
        for got, kept in zip(found, ([0, 1], [1, 2, 3])):
            self.assertAlmostEqual(got, seeds._shares(y[:, kept], np.full((1, len(kept)), 1 / len(kept)))[0][0])

    def test_what_is_drawn_without_a_seed_repeats(self):
        y = np.random.default_rng(5).normal(size=(8, 4))
        self.assertEqual(seeds.share(y), seeds.share(y, 0))
        for function in (seeds.share, morris.effects, sobol.indices, surrogate.indices, hsic.dependence,
                         main_effects.rank_effects, posterior.sample, posterior.check_points, calibration.uncertainty):
            self.assertEqual(inspect.signature(function).parameters["seed"].default, 0, function)

    def test_contrasts_leave_out_what_seeds_share(self):
        found = seeds.contrasts(4, 7)
        self.assertEqual(found.shape, (4, 1000))
        np.testing.assert_allclose(found.sum(axis=0), 0.0, atol=1e-12)
        np.testing.assert_allclose((found**2).sum(axis=0), 0.25)  # as long as the mean of four
        np.testing.assert_allclose(found.mean(axis=1), 0.0, atol=0.05)  # no seed is preferred
        np.testing.assert_array_equal(found, seeds.contrasts(4, 7))
        self.assertFalse(np.array_equal(found, seeds.contrasts(4, 8)))

    def test_what_seeds_alone_give_is_a_quantile(self):
        """Of a single output with three seeds: the mixtures lie on a circle, so that their sizes follow a cosine."""
        y = np.array([[1.0, 0.0, -1.0], [2.0, 0.0, -2.0]])
        found = seeds.alone(np.abs, y, 1)
        # length of (1, 0, -1) times that of the mixtures, 1/sqrt(3), times cos(0.05 pi/2)
        expected = np.sqrt(2.0 / 3.0) * np.cos(0.025 * np.pi)
        np.testing.assert_allclose(found, [expected, 2.0 * expected], rtol=0.005)
        few = seeds.alone(np.abs, y[:, :2], 1)
        self.assertEqual(few.shape, (2,))
        self.assertTrue(np.isnan(few).all())

    def test_two_seeds_tell_nothing_and_three_do(self):
        told = np.array([True, False])
        self.assertEqual(seeds.told(told, 2).tolist(), [None, None])
        self.assertEqual(seeds.told(told, 3).tolist(), [True, False])


class Morris(unittest.TestCase):
    def test_by_hand(self):
        """Two trajectories, one parameter, two seeds: effects 2 and -1 of the means, over a step of 1."""
        design = np.array([[[0.0], [1.0]], [[1.0], [0.0]]])
        y = np.array([[[0.0, 0.0], [1.0, 3.0]], [[0.0, 0.0], [0.0, 2.0]]])
        found = morris.effects(design, y, resamples=20)
        np.testing.assert_allclose(found.elementary, [[2.0], [-1.0]])
        np.testing.assert_allclose(found.mu, 0.5)
        np.testing.assert_allclose(found.mu_star, 1.5)
        np.testing.assert_allclose(found.sigma, np.sqrt(4.5))
        # between seeds each step varies by 2; of the mean of two seeds half of that
        np.testing.assert_allclose(found.standard_error, 1.0)
        self.assertEqual((found.used.tolist(), found.planned), ([2], 2))
        np.testing.assert_allclose([found.mu_star_low, found.mu_star_high], [[1.0], [2.0]])
        one = morris.effects(design, y[..., :1], resamples=20)
        self.assertTrue(np.isnan(one.standard_error).all())

    def test_two_levels_are_the_fewest(self):
        self.assertEqual(np.unique(morris.design(3, 5, 2, 1)).tolist(), [0.0, 1.0])
        for levels in (0, 1, 3):
            with self.assertRaisesRegex(Error, f"{levels} levels"):
                morris.design(3, 5, levels, 1)
        # the step is levels/(2 (levels - 1)), up as often as down
        moves = np.diff(morris.design(4, 2000, 4, 1), axis=1)
        moves = moves[moves != 0.0]
        np.testing.assert_allclose(np.abs(moves), 2.0 / 3.0)
        self.assertAlmostEqual((moves > 0.0).mean(), 0.5, delta=0.02)

    def test_design(self):
        design = morris.design(5, 30, 6, 4)
        moves = np.diff(design, axis=1)
        np.testing.assert_allclose(np.sort(np.abs(moves).sum(axis=1)), 0.6)
        np.testing.assert_array_equal((np.abs(moves) > 0).sum(axis=2), 1)
        np.testing.assert_allclose(np.unique(design.round(12)), np.linspace(0, 1, 6), atol=1e-12)
        self.assertTrue((moves > 0).any() and (moves < 0).any())
        with self.assertRaises(Error):
            morris.design(5, 30, 5, 4)

    def test_more_trajectories_extend(self):
        np.testing.assert_array_equal(morris.design(3, 20, 4, 1)[:10], morris.design(3, 10, 4, 1))

    def test_linear_function_is_exact(self):
        design = morris.design(3, 6, 4, 1)
        found = morris.effects(design, (design @ [2.0, -1.0, 0.0])[..., None] + np.array([0.0, 5.0, 1.0]))
        np.testing.assert_allclose(found.mu, [2.0, -1.0, 0.0], atol=1e-12)
        np.testing.assert_allclose(found.mu_star, [2.0, 1.0, 0.0], atol=1e-12)
        np.testing.assert_allclose(found.sigma, 0.0, atol=1e-12)
        self.assertEqual(found.told_from_seeds.tolist(), [True, True, False])

    def test_morris_own_function(self):
        # Twice the four trajectories of Morris' paper would do for the ranking; 40 for the values.
        design = morris.design(20, 40, 4, 7)
        found = morris.effects(design, morris_function(design)[..., None])
        self.assertGreater(found.mu_star[:10].min(), 2.0 * found.mu_star[10:].max())
        # Exact mean effect of 8 to 10: the function is linear in each w, and all others stand at their means, which is
        # not the middle for the three that are curved.
        levels = np.linspace(0.0, 1.0, 4)
        curved = (1.1 * levels / (levels + 0.1)).mean()
        middle = np.full(20, 0.5)
        middle[[2, 4, 6]] = 0.1 * curved / (1.1 - curved)
        for i in (7, 8, 9):
            ends = np.stack([middle, middle])
            ends[:, i] = 0.0, 1.0
            mean = np.diff(morris_function(ends))[0]
            self.assertLess(abs(found.mu[i] - mean), 3.0 * found.sigma[i] / np.sqrt(40))
            self.assertGreater(mean, 30.0)
        self.assertGreater(found.sigma[:7].min(), 1.5 * found.sigma[7:].max())
        self.assertTrue(within(found.mu_star_low, found.mu_star, found.mu_star_high))

    def test_bootstrap_interval_holds_the_mean(self):
        # The effect of u0 is 1 + u1: mu* over all levels of u1 is 1.5.
        inside, width = 0, 0.0
        for repeat in range(40):
            design = morris.design(2, 20, 4, repeat)
            found = morris.effects(design, (design[..., 0] * (1.0 + design[..., 1]))[..., None], resamples=300)
            inside += found.mu_star_low[0] <= 1.5 <= found.mu_star_high[0]
            width += (found.mu_star_high[0] - found.mu_star_low[0]) / 40
        self.assertGreater(inside, 33)
        # sqrt(5)/6 is the standard deviation of four levels from 0 to 1.
        self.assertAlmostEqual(width, 2 * 1.96 * np.sqrt(5) / 6 / np.sqrt(20), delta=0.03)

    def test_intervals_of_few_trajectories_hold_the_mean(self):
        many = morris.design(20, 5000, 4, 1)
        exact = morris.effects(many, morris_function(many)[..., None], resamples=2).mu_star
        inside = 0
        for repeat in range(60):
            design = morris.design(20, 10, 4, 100 + repeat)
            found = morris.effects(design, morris_function(design)[..., None], repeat, resamples=300)
            inside += ((found.mu_star_low <= exact) & (exact <= found.mu_star_high)).sum()
        self.assertGreater(inside / 1200, 0.89, "0.86 without the correction")

    def test_level_of_few(self):
        self.assertEqual(seeds.level(1), 1.0)
        self.assertAlmostEqual(seeds.level(10), 0.9829, 4)  # t of 9 degrees is 2.262, times the root of 10/9
        self.assertAlmostEqual(seeds.level(10**6), 0.95, 5)

    def test_noise_is_no_effect(self):
        told = 0
        for repeat in range(20):
            design = morris.design(6, 10, 4, repeat)
            noise = np.random.default_rng(repeat).normal(size=(10, 7, 3))
            told += morris.effects(design, noise, resamples=200).told_from_seeds.sum()
        self.assertLess(told, 3, "of 120")

    def test_what_seeds_alone_give_is_what_noise_gives(self):
        """Of nothing but noise, mu* is above it as seldom as a 95 % quantile says."""
        above = 0
        for repeat in range(60):
            noise = np.random.default_rng(repeat).normal(size=(10, 7, 5))
            found = morris.effects(morris.design(6, 10, 4, repeat), noise, repeat, resamples=2)
            above += (found.mu_star > found.from_seeds).sum()
        self.assertTrue(within(9, above, 40), f"{above} of 360; 18 are expected")

    def test_what_seeds_do_to_an_effect_is_no_effect_of_all(self):
        """Each specimen has an effect of its own, whose mean is 0: three seeds are too few to say so each time."""
        told = 0
        for repeat in range(60):
            design = morris.design(1, 10, 4, repeat)
            own = np.random.default_rng(repeat).normal(size=3)
            told += bool(morris.effects(design, design[..., 0, None] * own, repeat, resamples=50).told_from_seeds[0])
        self.assertTrue(within(8, told, 27), f"{told} of 60; 18 are expected: Student's t of two degrees is above 1.41")

    def test_nothing_is_told_by_two_seeds(self):
        design = morris.design(2, 10, 4, 1)
        found = morris.effects(design, (design @ [2.0, 0.0])[..., None] + np.array([0.0, 5.0]))
        self.assertEqual(found.told_from_seeds.tolist(), [None, None])
        self.assertTrue(np.isnan(found.from_seeds).all())

    def test_effect_is_told_from_noise(self):
        design = morris.design(4, 10, 4, 1)
        noise = np.random.default_rng(1).normal(0.0, 0.3, (10, 5, 4))
        found = morris.effects(design, (design @ [2.0, 1.0, 0.0, 0.0])[..., None] + noise)
        self.assertEqual(found.told_from_seeds.tolist(), [True, True, False, False])
        # Two values of standard deviation 0.3 over a step of 2/3, four seeds.
        np.testing.assert_allclose(found.standard_error, 0.3 * np.sqrt(2.0) * 1.5 / 2.0, rtol=0.35)

    def test_steps_that_touch_a_missing_point_drop_out(self):
        design = morris.design(3, 5, 4, 1)
        y = (design @ [1.0, 2.0, 3.0])[..., None] * np.ones(2)
        y[2, 0, 1] = np.nan
        y[3, 1, 0] = np.nan
        found = morris.effects(design, y)
        lost = np.zeros(3, int)
        for trajectory, step in ((2, 0), (3, 0), (3, 1)):
            lost[np.flatnonzero(np.diff(design[trajectory], axis=0)[step])] += 1
        np.testing.assert_array_equal(found.used, 5 - lost)
        self.assertEqual((lost.sum(), found.planned), (3, 5))
        np.testing.assert_allclose(found.mu, [1.0, 2.0, 3.0])
        y[..., 0] = np.nan
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # nothing is left, which is no surprise
            nothing = morris.effects(design, y, resamples=5)
        self.assertEqual(nothing.used.tolist(), [0, 0, 0])
        self.assertTrue(np.isnan([nothing.mu, nothing.mu_star, nothing.mu_star_low, nothing.sigma]).all())


class Sobol(unittest.TestCase):
    def test_limits(self):
        y = ishigami(sobol.design(3, 100, 1))[..., None]
        y[:5, 0] = np.nan  # just what may be lost
        self.assertEqual(sobol.indices(y, resamples=20).rows, 95)
        y[5, 0] = np.nan
        with self.assertRaisesRegex(Error, "6.0% of the rows miss a value: no indices above 5%"):
            sobol.indices(y, resamples=20)
        y[1:] = np.nan
        with self.assertRaisesRegex(Error, "at least 8 complete rows"):
            sobol.indices(y, allow_missing=True)

    def test_a_twentieth_of_the_rows_may_be_lost(self):
        y = np.random.default_rng(1).random((1000, 3, 1))
        y[:50, 2] = np.nan
        self.assertEqual(sobol.indices(y, resamples=5).rows, 950)
        y[50, 2] = np.nan
        with self.assertRaisesRegex(Error, "5.1% of the rows"):
            sobol.indices(y, resamples=5)

    def test_intervals_hold_what_so_few_rows_need(self):
        import openturns
        y = np.random.default_rng(1).random((10, 3, 1))
        with mock.patch.object(openturns.MartinezSensitivityAlgorithm, "setConfidenceLevel", autospec=True) as asked:
            sobol.indices(y, resamples=5)
        self.assertAlmostEqual(asked.call_args.args[1], 0.9829, 4)  # as `Morris.test_level_of_few` has it
        coarse, fine = (sobol.indices(y, resamples=count) for count in (10, 500))
        self.assertFalse(np.array_equal(coarse.first_low, fine.first_low))

    def test_the_seeds_part_by_hand(self):
        """Two rows, eight times each, one parameter, two seeds: A, B, AB."""
        y = np.array([[[1.0, 3.0], [0.0, 0.0], [0.0, 0.0]], [[6.0, 6.0], [1.0, 1.0], [2.0, 6.0]]])
        found = sobol.indices(np.repeat(y, 8, axis=0), resamples=5)
        # steps (1, 3) and (4, 0): variances 2 and 8, whose mean is 5; the means of A are 2 and 6, their variance 4
        np.testing.assert_allclose(found.seed_part, [0.5 * 5.0 / 2.0 / 4.0])

    def test_what_seeds_add_to_a_total_index(self):
        """Each run has noise of its own, of variance 0.09 of single runs: Jansen's numerator is half of twice that."""
        clean = ishigami(sobol.design(3, 512, 1))[..., None]
        y = clean + np.random.default_rng(3).normal(0.0, 0.3, (512, 5, 4))
        found = sobol.indices(y, resamples=20)
        expected = 0.09 / 4 / y[:, 0].mean(axis=1).var()
        np.testing.assert_allclose(found.seed_part, expected, rtol=0.1)
        self.assertTrue((found.from_seeds > expected).all() and (found.from_seeds < 1.3 * expected).all())
        self.assertEqual(found.seed_share.points, 1024)  # A and B
        one = sobol.indices(clean, resamples=20)
        np.testing.assert_array_equal(one.seed_part, [np.nan] * 3)
        np.testing.assert_array_equal(one.from_seeds, [np.nan] * 3)

    def test_design(self):
        rows = sobol.design(3, 16, 2)
        self.assertEqual(rows.shape, (16, 5, 3))
        for i in range(3):
            expected = rows[:, 0].copy()
            expected[:, i] = rows[:, 1, i]
            np.testing.assert_array_equal(rows[:, i + 2], expected)
        np.testing.assert_array_equal(rows[:8], sobol.design(3, 8, 2))

    def test_ishigami(self):
        first, total = ishigami_indices()
        np.testing.assert_allclose(first, [0.3139, 0.4424, 0.0], atol=5e-5)
        np.testing.assert_allclose(total, [0.5576, 0.4424, 0.2437], atol=5e-5)
        found = sobol.indices(ishigami(sobol.design(3, 1024, 1))[..., None], resamples=200)
        self.assertTrue(within(found.first_low, first, found.first_high), found)
        self.assertTrue(within(found.total_low, total, found.total_high), found)
        np.testing.assert_allclose(found.first, first, atol=0.02)
        np.testing.assert_allclose(found.total, total, atol=0.02)
        self.assertEqual(found.told_from_seeds.tolist(), [None] * 3, "with one seed nothing can be told")

    def test_repeats_and_leaves_openturns_as_it_was(self):
        import openturns
        y = ishigami(sobol.design(3, 64, 1))[..., None]
        openturns.RandomGenerator.SetSeed(9)
        expected = openturns.RandomGenerator.Generate()
        openturns.RandomGenerator.SetSeed(9)
        first = sobol.indices(y, seed=4, resamples=50)
        self.assertEqual(openturns.RandomGenerator.Generate(), expected)
        np.testing.assert_array_equal(first.first_low, sobol.indices(y, seed=4, resamples=50).first_low)

    def test_noise_is_no_effect(self):
        random = np.random.default_rng(1)
        found = sobol.indices(random.normal(size=(256, 5, 3)), resamples=50)
        # The noise looks like an interaction of everything.
        self.assertGreater(found.total.min(), 0.8)
        np.testing.assert_allclose(found.seed_part, found.total, rtol=0.25)
        self.assertEqual(found.told_from_seeds.tolist(), [False] * 3)
        self.assertTrue((found.from_seeds > found.seed_part).all())
        self.assertGreater(found.seed_share.single_low, 0.9)

        y = ishigami(sobol.design(3, 256, 1))[..., None] + random.normal(0.0, 0.3, (256, 5, 3)) + random.normal(size=3)
        self.assertTrue(sobol.indices(y, resamples=50).told_from_seeds.all())

    def test_rows_with_missing_points(self):
        y = ishigami(sobol.design(3, 200, 1))[..., None] * np.ones(2)
        y[7, 3, 1] = y[7, 1, 0] = y[90, 0, 0] = np.nan
        found = sobol.indices(y, resamples=50)
        self.assertEqual((found.rows, found.lost), (198, 0.01))
        kept = np.delete(y, [7, 90], axis=0)
        np.testing.assert_allclose(found.total, sobol.indices(kept, resamples=50).total)
        y[:11, 0] = np.nan
        with self.assertRaisesRegex(Error, "6.0%"):
            sobol.indices(y)
        self.assertEqual(sobol.indices(y, allow_missing=True, resamples=50).rows, 188)

    def test_a_constant_output_is_refused(self):
        with self.assertRaisesRegex(Error, "does not vary"):
            sobol.indices(np.ones((10, 4, 1)))

    def test_without_openturns(self):
        with mock.patch.dict(sys.modules, openturns=None), self.assertRaisesRegex(Error, "python3-openturns"):
            sobol.indices(ishigami(sobol.design(3, 16, 1))[..., None])


class Surrogates(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.u, cls.held = sampling.sobol_sequence(200, 3, 1), sampling.sobol_sequence(50, 3, 9)
        cls.chaos = surrogate.fit(cls.u, ishigami(cls.u))
        cls.validation = surrogate.validate(cls.chaos, cls.held, ishigami(cls.held))

    def test_predicts_ishigami(self):
        other = np.random.default_rng(4).random((300, 3))
        error = self.chaos.predict(other) - ishigami(other)
        self.assertLess(error.var() / ishigami(other).var(), 0.01)
        self.assertGreater(self.validation.q2, 0.99)
        direct = ((self.chaos.predict(self.held) - ishigami(self.held)) ** 2).mean()
        self.assertAlmostEqual(self.validation.error, np.sqrt(direct))
        self.assertAlmostEqual(self.validation.q2, 1.0 - direct / ishigami(self.held).var())

    def test_indices(self):
        first, total = ishigami_indices()
        found = surrogate.indices(self.chaos, self.validation, resamples=200)
        np.testing.assert_allclose(found.first, first, atol=0.01)
        np.testing.assert_allclose(found.total, total, atol=0.01)
        self.assertTrue(within(found.first_low, found.first, found.first_high))
        self.assertTrue(within(found.total_low, found.total, found.total_high))

    def test_intervals_hold_the_indices_of_a_noisy_polynomial(self):
        # y = u0 + 0.5 u1 + noise: 4/5 and 1/5 of the variance.
        inside = 0
        for repeat in range(10):
            random = np.random.default_rng(repeat)
            u, held = random.random((80, 2)), random.random((40, 2))
            y = (u @ [1.0, 0.5])[:, None] + random.normal(0.0, 0.1, (80, 2))
            fitted = surrogate.fit(u, y, most_degree=3)
            judged = surrogate.validate(fitted, held, held @ [1.0, 0.5])
            found = surrogate.indices(fitted, judged, resamples=100)
            inside += bool(found.total_low[0] <= 0.8 <= found.total_high[0])
        self.assertGreaterEqual(inside, 7)

    def test_g_function(self):
        u, held = sampling.sobol_sequence(200, 4, 1), sampling.sobol_sequence(64, 4, 9)
        first, total = g_indices()
        fitted = surrogate.fit(u, g_function(u), most_degree=8)
        judged = surrogate.validate(fitted, held, g_function(held))
        self.assertGreater(judged.q2, 0.95)
        found = surrogate.indices(fitted, judged, resamples=50)
        # Its kinks are no polynomials: the indices miss by up to 0.02.
        np.testing.assert_allclose(found.first, first, atol=0.03)
        np.testing.assert_allclose(found.total, total, atol=0.03)

    def test_kriging(self):
        random = np.random.default_rng(5)

        def function(u):
            return 3.0 * u[:, 0] + np.sin(4.0 * u[:, 1])

        y = function(self.u[:60])[:, None] + random.normal(0.0, 0.1, (60, 4))
        fitted = surrogate.fit(self.u[:60], y, "kriging")
        true = function(self.held)
        judged = surrogate.validate(fitted, self.held, true)
        self.assertGreater(judged.q2, 0.995)
        # It smooths: nearer to the function than the noisy means that it is made from.
        at_its_points = fitted.predict(self.u[:60]) - function(self.u[:60])
        self.assertLess(at_its_points.std(), 0.8 * (y.mean(axis=1) - function(self.u[:60])).std())
        with self.assertRaisesRegex(Error, "Kriging"):
            surrogate.indices(fitted, judged)

    def test_seeds_scatter_is_taken_off_the_error(self):
        y = ishigami(self.held)[:, None] + np.random.default_rng(6).normal(0.0, 2.0, (50, 4))
        judged = surrogate.validate(self.chaos, self.held, y)
        rest = seeds.rest_variance(y)
        self.assertAlmostEqual(rest, 4.0, delta=0.8)
        self.assertAlmostEqual(judged.error**2 - judged.own_error**2, rest / 4.0)
        # The same of Q2: the function's own variance is what is left of that of the means over the seeds.
        means = y.mean(axis=1)
        self.assertAlmostEqual((1.0 - judged.own_q2) * (means.var() - rest / 4.0), judged.own_error**2)
        without = surrogate.validate(self.chaos, self.held, y[:, 0])
        self.assertEqual(without.error, without.own_error)
        self.assertEqual(without.q2, without.own_q2)

    def test_seeds_scatter_does_not_spoil_a_good_surrogate(self):
        """Of means over three seeds, a tenth of whose variance is the seeds' scatter (Ishigami's is 13.8)."""
        def of_seeds(u, seed):
            return ishigami(u)[:, None] + np.random.default_rng(seed).normal(0.0, np.sqrt(0.3 * 13.8), (len(u), 3))

        held = sampling.sobol_sequence(100, 3, 9)
        fitted = surrogate.fit(self.u[:150], of_seeds(self.u[:150], 1))
        judged = surrogate.validate(fitted, held, of_seeds(held, 2))
        true = surrogate.validate(fitted, held, ishigami(held))
        self.assertLess(judged.q2, surrogate.LEAST_Q2)
        self.assertGreater(true.q2, surrogate.LEAST_Q2)
        self.assertAlmostEqual(judged.own_q2, true.q2, delta=0.03)
        found = surrogate.indices(fitted, judged)
        first, total = ishigami_indices()
        inside = ((found.first_low <= first) & (first <= found.first_high)).sum() + \
            ((found.total_low <= total) & (total <= found.total_high)).sum()
        self.assertGreaterEqual(inside, 5)

    def test_scatter_alone_is_refused(self):
        """By luck the error can be smaller than the scatter, which makes own_q2 1: it tells nothing all the same."""
        judged = surrogate.Validation(q2=0.1, own_q2=1.0, error=1.0, own_error=0.0, points=30)
        with self.assertRaisesRegex(Error, "more seeds"):
            judged.require()
        random = np.random.default_rng(8)
        bad = surrogate.fit(sampling.sobol_sequence(100, 3, 2), random.normal(size=(100, 3)))
        for _ in range(20):
            with self.assertRaisesRegex(Error, "Q2"):
                surrogate.validate(bad, self.held, random.normal(size=(50, 3))).require()

    def test_refusals(self):
        noise = np.random.default_rng(7).normal(size=(100, 1))
        bad = surrogate.fit(sampling.sobol_sequence(100, 3, 2), noise)
        judged = surrogate.validate(bad, self.held, noise[:50])
        with self.assertRaisesRegex(Error, "Q2"):
            surrogate.indices(bad, judged)
        with self.assertRaisesRegex(Error, "at least 30"):
            surrogate.validate(self.chaos, self.held[:29], ishigami(self.held[:29]))
        with self.assertRaisesRegex(Error, "used to fit"):
            surrogate.validate(self.chaos, self.u[:40], ishigami(self.u[:40]))
        with self.assertRaisesRegex(Error, "does not vary"):
            surrogate.fit(self.u, np.ones(200))

    def test_missing_points_drop_out(self):
        y = ishigami(self.u)[:, None] * np.ones(2)
        y[3, 1] = np.nan
        self.assertEqual(surrogate.fit(self.u, y, most_degree=2).lost, 1)


class Judged(unittest.TestCase):
    """By what a surrogate is judged, by hand."""

    def test_bounds(self):
        def of(q2, own_q2):
            return surrogate.Validation(q2=q2, own_q2=own_q2, error=1.0, own_error=1.0, points=30)

        of(0.5, 0.9).require()
        for q2, own_q2, words in ((0.5, 0.899, "0.899 on 30 points.*below 0.9"), (0.499, 0.9, "0.499 on 30.*takes 0.5"),
                                  (0.9, float("nan"), "nan"), (float("nan"), 0.9, "nan")):
            with self.assertRaisesRegex(Error, words):
                of(q2, own_q2).require()

    def test_shares_of_an_expansion(self):
        # 5 + 3 a + 2 b + 1 ab: 9, 4 and 1 of 14
        degrees = np.array([[0, 0], [1, 0], [0, 2], [1, 1]])
        first, total = surrogate._shares(degrees, np.array([5.0, -3.0, 2.0, 1.0]))
        np.testing.assert_allclose(first, [9 / 14, 4 / 14])
        np.testing.assert_allclose(total, [10 / 14, 5 / 14])

    def test_q2(self):
        self.assertEqual(surrogate._q2(1.0, 4.0), 0.75)
        self.assertEqual(surrogate._q2(0.0, 0.0), -np.inf)
        self.assertEqual(surrogate._q2(0.0, -1.0), -np.inf)
        self.assertEqual(surrogate._q2(0.25, 0.5), 0.5)

    def test_complete_points_and_their_noise(self):
        u = np.arange(8.0).reshape(4, 2)
        y = np.array([[1.0, 3.0], [np.nan, 1.0], [3.0, 1.0], [2.0, 2.0]])
        kept, means, noise, lost = surrogate._complete(u, y)
        np.testing.assert_array_equal(kept, u[[0, 2, 3]])
        np.testing.assert_array_equal(means, [2.0, 2.0, 2.0])
        self.assertAlmostEqual(noise, seeds.rest_variance(y) / 2.0)
        self.assertAlmostEqual(noise, 1.0)  # of 4/2 in single runs
        self.assertEqual(lost, 1)
        kept, means, noise, lost = surrogate._complete(u, y[:, 1])
        self.assertEqual((len(kept), noise, lost), (4, 0.0, 0))

    def test_a_degree_is_found_and_few_points_are_refused(self):
        u = sampling.sobol_sequence(64, 2, 3)
        x = 2.0 * u - 1.0
        cubic = surrogate.fit(u, x[:, 0] ** 3 + x[:, 1])
        self.assertEqual(cubic.degree, 3)
        self.assertEqual((cubic.lost, cubic.kind), (0, "chaos"))
        np.testing.assert_allclose(cubic.predict(u), x[:, 0] ** 3 + x[:, 1], atol=1e-9)
        self.assertEqual(surrogate.fit(u, x[:, 0] ** 3, most_degree=2).degree <= 2, True)
        with self.assertRaisesRegex(Error, "3 complete points: a surrogate in 2 parameters needs at least 4"):
            surrogate.fit(u[:3], x[:3, 0])
        self.assertEqual(len(surrogate.fit(u[:4], x[:4, 0], most_degree=1).u), 4)
        kriging = surrogate.fit(u, x[:, 0], "kriging")
        self.assertEqual((kriging.degree, kriging.terms, kriging.kind), (0, 0, "kriging"))
        np.testing.assert_allclose(kriging.predict(u), x[:, 0], atol=1e-3)

    def test_three_degrees_without_gain_are_the_last(self):
        import openturns
        u = sampling.sobol_sequence(64, 2, 3)
        with mock.patch.object(openturns, "FunctionalChaosAlgorithm", wraps=openturns.FunctionalChaosAlgorithm) as made:
            degree = surrogate.fit(u, u[:, 0] + np.random.default_rng(2).normal(size=64)).degree
            self.assertLess(degree, 5)
            self.assertEqual(made.call_count, degree + 3)
            made.reset_mock()
            surrogate.fit(u, u[:, 0] + u[:, 1] ** 2, most_degree=3)
            self.assertEqual(made.call_count, 3)

    def test_any_point_may_be_drawn_again(self):
        u = sampling.sobol_sequence(20, 2, 3)
        fitted = surrogate.fit(u, u[:, 0], most_degree=1)
        fine = surrogate.Validation(1.0, 1.0, 0.0, 0.0, 30)
        with mock.patch.object(np.linalg, "lstsq", wraps=np.linalg.lstsq) as solved:
            surrogate.indices(fitted, fine, resamples=60)
        drawn = [call.args[1] for call in solved.call_args_list]
        self.assertEqual([len(values) for values in drawn], 60 * [20])
        self.assertEqual(set(np.concatenate(drawn)), set(u[:, 0]))

    def test_degrees_end_at_the_stated_one_and_at_the_most_terms(self):
        import openturns
        u = sampling.sobol_sequence(64, 2, 3)
        algorithm = openturns.FunctionalChaosAlgorithm
        with mock.patch.object(openturns, "FunctionalChaosAlgorithm", wraps=algorithm) as made, \
                mock.patch.object(surrogate, "_PATIENCE", 99):
            surrogate.fit(u, np.abs(u[:, 0] - 0.4))
            self.assertEqual(made.call_count, 10)
            for most, degree in ((10, 3), (9, 2), (11, 3)):  # 3, 6, 10 and 14 terms
                made.reset_mock()
                with mock.patch.object(surrogate, "_MOST_TERMS", most):
                    surrogate.fit(u, u[:, 0] ** 5, most_degree=5)
                self.assertEqual(made.call_count, degree)

    def test_kriging_is_matern_of_lengths_within_bounds(self):
        """A parameter that does nothing has the longest length, noise of which nothing is told the shortest."""
        u = sampling.sobol_sequence(30, 2, 3)
        covariance = surrogate.fit(u, np.sin(6.0 * u[:, 0]), "kriging").fitted.getCovarianceModel()
        self.assertEqual(covariance.getFullParameter()[-1], 2.5)
        self.assertAlmostEqual(covariance.getScale()[1], 20.0)
        noise = np.random.default_rng(1).normal(size=30)
        self.assertAlmostEqual(min(surrogate.fit(u, noise, "kriging").fitted.getCovarianceModel().getScale()), 0.02)

    def test_kriging_does_not_ask_for_the_unit_of_small_numbers(self):
        u = sampling.sobol_sequence(40, 2, 3)
        y = np.sin(3.0 * u[:, 0]) + u[:, 1]
        held = sampling.sobol_sequence(20, 2, 4)
        expected = surrogate.fit(u, y, "kriging").predict(held)
        for unit in (1e-6, 1e-3, 1e3):
            np.testing.assert_allclose(surrogate.fit(u, unit * y, "kriging").predict(held) / unit, expected, atol=0.005)

    def test_thirty_points_are_enough(self):
        u = sampling.sobol_sequence(64, 2, 3)
        fitted = surrogate.fit(u, u[:, 0], most_degree=2)
        held = sampling.sobol_sequence(30, 2, 4)
        y = held[:, 0] + np.where(np.arange(30) % 2, 0.1, -0.1)
        judged = surrogate.validate(fitted, held, y)
        self.assertEqual(judged.points, 30)
        self.assertAlmostEqual(judged.error, 0.1)
        self.assertAlmostEqual(judged.q2, 1.0 - 0.01 / y.var())
        self.assertAlmostEqual(judged.own_error, 0.1)
        # seeds that scatter while their mean is exact: the error is less than the scatter, so that none is its own
        scattered = held[:, :1] + np.where(np.arange(30) % 2, 0.1, -0.1)[:, None] * [1.0, -1.0]
        exact = surrogate.validate(fitted, held, scattered)
        self.assertAlmostEqual(exact.error, 0.0)
        self.assertEqual((exact.own_error, exact.own_q2), (0.0, 1.0))
        with self.assertRaisesRegex(Error, "used to fit"):  # one is enough
            surrogate.validate(fitted, np.vstack([held[:-1], u[:1]]), y)
        with self.assertRaisesRegex(Error, "29 complete runs"):
            surrogate.validate(fitted, held[:29], y[:29])


class Dependence(unittest.TestCase):
    def test_limits(self):
        u = sampling.sobol_sequence(20, 2, 1)
        with self.assertRaisesRegex(Error, "19 complete points"):
            hsic.dependence(u[:19], u[:19, 0])
        with self.assertRaisesRegex(Error, "does not vary"):
            hsic.dependence(u, np.ones(20))
        y = np.concatenate([u[:, 0], [np.nan]])
        found = hsic.dependence(np.vstack([u, [[0.5, 0.5]]]), y, permutations=20)
        self.assertEqual(found.points, 20)
        self.assertAlmostEqual(found.r2[0], 1.0, delta=1e-9)
        np.testing.assert_allclose(found.r2_high - found.r2, found.r2 - found.r2_low)

    def test_of_twenty_points_each_is_a_group(self):
        """The interval is Student's of 19 degrees about the jackknife that leaves out one point after the other."""
        import openturns
        u = np.random.default_rng(3).random((20, 2))
        y = u[:, 0] + 0.3 * u[:, 1] ** 2
        found = hsic.dependence(u, y, permutations=2)
        without = np.array([np.array(hsic._estimator(openturns, np.delete(u, i, axis=0), np.delete(y, i))
                                     .getR2HSICIndices()) for i in range(20)])
        half = t.ppf(0.975, 19) * np.sqrt(19.0 * without.var(axis=0))
        np.testing.assert_allclose(found.r2_high - found.r2, half)

    def test_groups_are_twenty_of_equal_count(self):
        u = np.random.default_rng(3).random((40, 2))
        with mock.patch.object(hsic, "_estimator", wraps=hsic._estimator) as made:
            found = hsic.dependence(u, u[:, 0], permutations=2)
        self.assertEqual([len(call.args[2]) for call in made.call_args_list], [40] + 20 * [38])
        left_out = [set(range(40)) - {int(np.flatnonzero(u[:, 0] == value)[0]) for value in call.args[2]}
                    for call in made.call_args_list[1:]]
        self.assertEqual(set.union(*left_out), set(range(40)))
        # the unit of the output does not matter: its kernel is as wide as it scatters
        np.testing.assert_allclose(hsic.dependence(u, 1e3 * u[:, 0], permutations=2).r2, found.r2)

    def test_a_p_value_counts_permutations(self):
        u = np.random.default_rng(3).random((40, 2))
        y = np.random.default_rng(4).normal(size=40)
        tenths = 10.0 * hsic.dependence(u, y, permutations=9).p_value
        np.testing.assert_allclose(tenths, np.round(tenths), atol=1e-9)
        finer = 10.0 * hsic.dependence(u, y, permutations=499).p_value
        self.assertGreater(np.abs(finer - np.round(finer)).max(), 1e-3)

    def test_intervals_are_a_jackknife_over_groups(self):
        """The error of a mean of groups is known: so must be that of the index of many points."""
        repeats = []
        for repeat in range(20):
            random = np.random.default_rng(repeat)
            u = random.random((60, 1))
            repeats.append(hsic.dependence(u, u[:, 0] + random.normal(0.0, 0.4, 60), permutations=2))
        spread = np.std([found.r2[0] for found in repeats], ddof=1)
        half = np.mean([found.r2_high[0] - found.r2[0] for found in repeats])
        self.assertGreater(half / spread, 1.4)  # 2.09 by Student's t
        self.assertLess(half / spread, 3.0)

    def test_tells_what_matters_and_what_is_correlated_with_it(self):
        u = sampling.correlated(sampling.sobol_sequence(100, 3, 1), [[1, 0.8, 0], [0.8, 1, 0], [0, 0, 1]])
        found = hsic.dependence(u, np.cos(6.0 * u[:, 0])[:, None] * np.ones(2), permutations=200)
        self.assertLess(found.p_value[:2].max(), 0.05)
        self.assertGreater(found.p_value[2], 0.1)
        self.assertGreater(found.r2[0], 2.0 * found.r2[1])
        self.assertLess(abs(found.r2[2]), 0.05)


class Ensemble(unittest.TestCase):
    def test_summary(self):
        found = ensemble.summary([4.0, 6.0, np.nan, 5.0, 9.0])
        self.assertEqual((found.n, found.missing, found.mean), (4, 1, 6.0))
        sd = np.sqrt((4 + 0 + 1 + 9) / 3)
        self.assertAlmostEqual(found.sd, sd)
        self.assertAlmostEqual(found.variation, sd / 6.0)
        # Student's t for 3 degrees of freedom, from a table.
        self.assertAlmostEqual(found.high - 6.0, 3.182 * sd / 2.0, places=3)
        self.assertAlmostEqual(found.relative_width, 3.182 * sd / 2.0 / 6.0, places=3)
        self.assertEqual(found.percentiles[50.0], 5.5)
        np.testing.assert_allclose([found.percentiles[share] for share in (5.0, 50.0, 95.0)], [4.15, 5.5, 8.55])
        self.assertEqual(list(ensemble.summary([]).percentiles), [5.0, 50.0, 95.0])

    def test_percentiles_and_level(self):
        found = ensemble.summary(np.arange(11.0), level=0.9, percentiles=(10, 75))
        self.assertEqual(dict(found.percentiles), {10.0: 1.0, 75.0: 7.5})
        # Student's t of ten degrees, 90 %, from a table; s is the root of 11.
        self.assertAlmostEqual(5.0 - found.low, 1.812, places=3)
        self.assertAlmostEqual(found.high - 5.0, 1.812, places=3)
        self.assertEqual(ensemble.summary([1.0, 3.0]).sd, np.sqrt(2.0))
        self.assertEqual(ensemble.widest([found, ensemble.summary([4.9, 5.0, 5.1])]), found.relative_width)
        around_nothing = ensemble.summary([-1.0, 1.0])
        self.assertTrue(np.isnan(around_nothing.variation) and around_nothing.relative_width == np.inf)
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # nothing is divided by nothing
            self.assertEqual(ensemble.summary([-1.0, 1.0]).relative_width, np.inf)
            # Student's t of one degree, 12.706, times a standard deviation of the root of 2, over the root of 2
            self.assertAlmostEqual(ensemble.summary([0.0, 2.0]).relative_width, 12.706, places=3)
        below = ensemble.summary([-4.0, -6.0])
        self.assertAlmostEqual(below.variation, np.sqrt(2.0) / 5.0)
        self.assertGreater(below.relative_width, 0.0)

    def test_too_few(self):
        one = ensemble.summary([3.0])
        self.assertTrue(one.mean == 3.0 and np.isnan(one.sd) and one.relative_width == np.inf)
        self.assertEqual(ensemble.summary([]).n, 0)
        self.assertEqual(ensemble.widest([one, ensemble.summary([1.0, 1.1])]), np.inf)
        self.assertEqual(ensemble.widest([]), np.inf)


class MainEffects(unittest.TestCase):
    def test_curve_of_a_grid(self):
        u = sampling.grid([3, 4])
        curve = main_effects.curve(u[:, 0], (u[:, 0] ** 2 + u[:, 1])[:, None] * np.ones(2))
        np.testing.assert_allclose(curve.u, [0.0, 0.5, 1.0])
        np.testing.assert_allclose(curve.mean, [0.5, 0.75, 1.5])
        self.assertEqual(curve.count.tolist(), [4, 4, 4])
        half = t.ppf(0.975, 3) * np.std([0, 1 / 3, 2 / 3, 1], ddof=1) / 2.0
        np.testing.assert_allclose(curve.high - curve.mean, half)

    def test_curve_of_a_hypercube(self):
        u = sampling.latin_hypercube(62, 2, 1)
        y = u[:, 0] ** 2
        y[5] = np.nan
        curve = main_effects.curve(u[:, 0], y)
        self.assertEqual((len(curve.u), curve.count.sum(), curve.count.min()), (10, 61, 6))
        np.testing.assert_allclose(curve.mean, curve.u**2, atol=0.004)

    def test_curve_of_few_values_and_of_classes(self):
        # Three values, each anywhere in its share: classes of their own, in the middle.
        curve = main_effects.curve(np.array([0.1, 0.3, 0.4, 0.5, 0.9]), np.array([1.0, 3.0, 5.0, 7.0, 9.0]), count=3)
        np.testing.assert_allclose(curve.u, [1 / 6, 0.5, 5 / 6])
        np.testing.assert_allclose(curve.mean, [2.0, 6.0, 9.0])
        self.assertEqual(curve.count.tolist(), [2, 2, 1])
        half = t.ppf(0.975, 1) * np.sqrt(2.0) / np.sqrt(2.0)
        np.testing.assert_allclose(curve.high - curve.mean, [half, half, np.nan])
        np.testing.assert_allclose(curve.mean - curve.low, [half, half, np.nan])
        # Of continuous values five points make a class at the least, and most_classes at the most; a grid has its own.
        even = np.linspace(0.0, 1.0, 24)
        self.assertEqual(main_effects.curve(even, even).count.tolist(), [6, 6, 6, 6])
        self.assertEqual(main_effects.curve(even, even, most_classes=3).count.tolist(), [8, 8, 8])
        np.testing.assert_allclose(main_effects.curve(even[::-1], even, most_classes=2).mean, [17.5 / 23, 5.5 / 23])
        self.assertEqual(len(main_effects.curve(np.arange(10.0) / 9, np.arange(10.0)).u), 10)
        self.assertEqual(len(main_effects.curve(np.arange(11.0) / 10, np.arange(11.0)).u), 2)
        self.assertEqual(len(main_effects.curve(np.arange(12.0) / 11, np.arange(12.0), count=12).u), 12)
        few = main_effects.curve(np.arange(4.0) / 3, np.arange(4.0), most_classes=2)
        self.assertEqual((few.count.tolist(), few.mean.tolist()), ([4], [1.5]), "one class at the least")

    def test_standard_error_is_the_jackknife_over_the_seeds(self):
        """Two parameters in order; each seed adds to one of them: the coefficients follow by hand."""
        u = sampling.latin_hypercube(30, 2, 3)
        random = np.random.default_rng(2)
        y = u @ [1.0, 0.5] + 0.3 * random.normal(size=(3, 30))
        found = main_effects.rank_effects(u, y.T, resamples=50)
        without = [main_effects.rank_effects(u, np.delete(y, s, axis=0).T, resamples=2).coefficient for s in range(3)]
        np.testing.assert_allclose(found.standard_error, np.sqrt(2.0 / 3.0 * ((without - np.mean(without, axis=0)) ** 2)
                                                                 .sum(axis=0)))
        self.assertEqual(found.points, 30)
        self.assertTrue(np.isnan(main_effects.rank_effects(u, y.T[:, :1], resamples=5).standard_error).all())

    def test_told_takes_students_t_of_the_seeds(self):
        """Of three seeds 4.30 standard errors are needed, though 2 would do for many."""
        u = sampling.latin_hypercube(40, 1, 3)
        for scatter in np.linspace(0.2, 6.0, 30):
            pattern = np.random.default_rng(4).normal(size=(40, 3))
            found = main_effects.rank_effects(u, u + scatter * pattern, resamples=100)
            ratio = np.abs(found.coefficient / found.standard_error)[0]
            by_points = (found.coefficient_low * found.coefficient_high > 0.0)[0]
            self.assertEqual(found.told_from_seeds[0], bool(by_points and ratio > 4.3027), scatter)

    def test_a_point_that_misses_a_seed_drops_out(self):
        u = sampling.latin_hypercube(20, 2, 3)
        y = u @ np.array([[1.0, 1.1, 0.9], [0.5, 0.6, 0.4]])
        y[3, 1] = np.nan
        found = main_effects.rank_effects(u, y, resamples=10)
        kept = main_effects.rank_effects(np.delete(u, 3, axis=0), np.delete(y, 3, axis=0), resamples=10)
        self.assertEqual(found.points, 19)
        np.testing.assert_array_equal(found.coefficient, kept.coefficient)
        with_gap = main_effects.curve(u[:, 0], y)
        self.assertEqual(with_gap.count.sum(), 19)

    def test_few_points_are_enough(self):
        u = sampling.latin_hypercube(4, 2, 3)
        self.assertEqual(main_effects.rank_effects(u, u[:, :1] * np.ones(3), resamples=5).points, 4)
        with self.assertRaisesRegex(Error, "3 complete points: the rank regression on 2 parameters needs at least 4"):
            main_effects.rank_effects(u[:3], u[:3, :1] * np.ones(3))

    def test_rank_effects(self):
        u = sampling.latin_hypercube(80, 3, 2)
        y = (np.exp(3.0 * u[:, 0] - 1.5 * u[:, 1]))[:, None] * (1.0 + np.random.default_rng(1).normal(0, 0.1, (80, 4)))
        found = main_effects.rank_effects(u, y, resamples=200)
        self.assertEqual(found.told_from_seeds.tolist(), [True, True, False])
        np.testing.assert_allclose(found.correlation, [spearmanr(u[:, i], y.mean(axis=1))[0] for i in range(3)])
        # On ranks it is nearly linear: coefficients as 2 to -1, all explained.
        np.testing.assert_allclose(found.coefficient, np.array([2.0, -1.0, 0.0]) / np.sqrt(5.0), atol=0.05)
        self.assertGreater(found.r2, 0.95)
        self.assertTrue(within(found.coefficient_low, found.coefficient, found.coefficient_high))
        self.assertLess(found.seed_share.single, 0.1)

    def test_what_does_not_vary_has_no_effect(self):
        u = sampling.latin_hypercube(20, 2, 3)
        u[:, 1] = 0.5
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = main_effects.rank_effects(u, u[:, :1] * [1.0, 2.0, 3.0], resamples=20)
        np.testing.assert_allclose(found.coefficient, [1.0, 0.0], atol=1e-12)
        np.testing.assert_allclose(found.correlation, [1.0, 0.0], atol=1e-12)
        self.assertAlmostEqual(found.r2, 1.0)

    def test_any_point_may_be_drawn_again(self):
        u = sampling.latin_hypercube(12, 1, 3)
        with mock.patch.object(main_effects, "_ranked", wraps=main_effects._ranked) as ranked:
            main_effects.rank_effects(u, u * [1.0, 2.0, 3.0], resamples=50)
        drawn = [call.args[0] for call in ranked.call_args_list[1:51]]
        self.assertEqual({len(points) for points in drawn}, {12})
        self.assertEqual(set(np.concatenate(drawn)[:, 0]), set(u[:, 0]))

    def test_intervals_are_a_bootstrap_over_the_points(self):
        """Of one parameter the coefficient is Spearman's correlation, whatever points are drawn how often."""
        u = sampling.latin_hypercube(30, 1, 3)
        y = u + np.random.default_rng(2).normal(0.0, 0.3, (30, 1))
        found = main_effects.rank_effects(u, y, resamples=3000)
        draws = np.random.default_rng(1).integers(0, 30, (3000, 30))
        expected = np.percentile([spearmanr(u[draw, 0], y[draw, 0])[0] for draw in draws], [2.05, 97.95])
        width = expected[1] - expected[0]  # of 30 points 95.9 %: t of 29 degrees is 2.045, times the root of 30/29
        for low, high in ((found.coefficient_low, found.coefficient_high),
                          (found.correlation_low, found.correlation_high)):
            np.testing.assert_allclose([low[0], high[0]], expected, atol=0.1 * width)

    def test_noise_is_no_effect(self):
        told = 0
        for repeat in range(20):
            noise = np.random.default_rng(repeat).normal(size=(40, 3))
            u = sampling.sobol_sequence(40, 4, repeat)
            told += main_effects.rank_effects(u, noise, resamples=100).told_from_seeds.sum()
        self.assertLess(told, 12, "of 80; 4 at most are expected")

    def test_what_points_do_not_tell_seeds_do_not_tell_either(self):
        """Without scatter between the seeds, few points of something else still make a coefficient by chance."""
        told = 0
        for repeat in range(40):
            random = np.random.default_rng(repeat)
            y = random.normal(size=(12, 1)) + 1e-3 * random.normal(size=(12, 3))
            told += main_effects.rank_effects(random.random((12, 2)), y, resamples=200).told_from_seeds.sum()
        self.assertLess(told, 12, "of 80; 4 are expected, and nearly all by the seeds alone")

    def test_two_seeds_tell_nothing(self):
        u = sampling.latin_hypercube(40, 2, 1)
        found = main_effects.rank_effects(u, u[:, :1] + np.array([0.0, 0.1]), resamples=50)
        self.assertEqual(found.told_from_seeds.tolist(), [None, None])

    def test_too_few_points(self):
        with self.assertRaises(Error):
            main_effects.rank_effects(np.ones((4, 3)), np.ones((4, 2)))


JACOBIAN = np.array([[1.0, 0.5], [0.3, -1.0], [1.0, 1.0]])
SEEDS = np.random.default_rng(4).normal(0.0, 0.02, (4, 3))
"""What each of four seeds adds to three outputs."""


def linear_targets(truth):
    return calibration.Targets(("a", "b", "c"), JACOBIAN @ truth + SEEDS.mean(axis=0), np.full(3, 0.02))


def linear(u):
    return JACOBIAN @ u + SEEDS


class Misfit(unittest.TestCase):
    def test_covariance_of_the_mean_over_seeds(self):
        random = np.random.default_rng(1)
        true = np.array([[4.0, 1.9], [1.9, 1.0]])
        outcomes = [random.multivariate_normal([point, -point], true, 5) for point in range(200)]
        single, freedom = calibration.seed_covariance(outcomes)
        self.assertEqual(freedom, 800)
        np.testing.assert_allclose(single, true, rtol=0.15)
        targets = calibration.Targets(("a", "b"), np.zeros(2), np.array([0.5, 0.0]))
        total = calibration.misfit_covariance(outcomes, targets, error=[0.0, 2.0])
        np.testing.assert_allclose(total, single / 5 + np.diag([0.25, 4.0]))
        np.testing.assert_allclose(calibration.misfit(np.array([[1.0, 1.0], [2.0, 0.0]]), targets, np.diag([4.0, 1.0])),
                                   [1.25, 1.0])

    def test_few_seeds_are_shrunk(self):
        # Two seeds of three outputs: rank one, of no use without shrinkage.
        single, freedom = calibration.seed_covariance([SEEDS[:2]])
        self.assertEqual(freedom, 1)
        self.assertLess(np.linalg.cond(single), 1e4)
        np.testing.assert_allclose(np.diag(single), SEEDS[:2].var(axis=0, ddof=1))
        np.testing.assert_allclose(single[0, 1], 0.25 * np.cov(SEEDS[:2].T)[0, 1])

    def test_what_misses_a_value_does_not_count_and_one_seed_tells_nothing(self):
        whole, broken = SEEDS[:2], np.array([[1.0, np.nan, 2.0], [5.0, 0.0, 9.0]])
        for outcomes in ([whole, broken], [broken, whole]):
            single, freedom = calibration.seed_covariance(outcomes)
            self.assertEqual(freedom, 1)
            np.testing.assert_array_equal(single, calibration.seed_covariance([whole])[0])
        single, freedom = calibration.seed_covariance([SEEDS[:1], SEEDS[1:2]])
        self.assertEqual(freedom, 0)
        np.testing.assert_array_equal(single, np.zeros((3, 3)))
        # of one output there is nothing to shrink: runs 0 and 2 have a variance of 2, their mean one of 1
        targets = calibration.Targets(("a",), np.zeros(1), np.array([0.5]))
        np.testing.assert_allclose(calibration.misfit_covariance([np.array([[0.0], [2.0]])], targets), [[1.25]])

    def test_no_scatter_at_all_is_refused(self):
        targets = calibration.Targets(("f_c",), np.zeros(1), np.zeros(1))
        with self.assertRaisesRegex(Error, "f_c"):
            calibration.misfit_covariance([np.ones((1, 1))], targets)


class NoiseLimit(unittest.TestCase):
    def test_is_the_quantile_of_a_mean_of_squares(self):
        """As many equal parts as outputs, whatever their size; one part that outweighs all others is one square."""
        for size in (1e-3, 1.0, 1e3):
            self.assertAlmostEqual(calibration._noise_limit(size * np.eye(3)), 7.8147 / 3.0, places=4)
            self.assertAlmostEqual(calibration._noise_limit(size * np.diag([1.0, 0.0, 0.0])), 3.8415, places=4)
        # 4 and 1: 25/17 degrees of freedom
        self.assertAlmostEqual(calibration._noise_limit(np.diag([2.0, 0.5])),
                               chi2.ppf(0.95, 25.0 / 17.0) / (25.0 / 17.0))
        self.assertAlmostEqual(calibration._noise_limit(np.zeros((2, 2))), 3.8415, places=4)


class LocalForm(unittest.TestCase):
    def test_is_exact_for_what_it_has_terms_for(self):
        u = sampling.sobol_sequence(40, 2, 3)
        best = np.array([0.4, 0.6])
        away = u - best
        y = np.column_stack([1.0 + away @ [2.0, -3.0] + 5.0 * away[:, 0] * away[:, 1], 4.0 - away[:, 1] ** 2])
        fit = calibration._local_form(best, u, y, 40)
        np.testing.assert_allclose(fit.at_best, [1.0, 4.0], atol=1e-9)
        np.testing.assert_allclose(fit.jacobian, [[2.0, -3.0], [0.0, 0.0]], atol=1e-8)
        np.testing.assert_allclose(fit.scatter, 0.0, atol=1e-15)
        self.assertEqual((fit.freedom, fit.points), (34, 40))
        # twelve points have quadratic terms, eleven have none
        self.assertEqual(calibration._local_form(best, u, y, 12).freedom, 6)
        self.assertEqual(calibration._local_form(best, u, y, 11).freedom, 8)

    def test_errors_are_those_of_noise(self):
        """Of many draws, derivatives scatter as their errors say, and residuals as the noise."""
        u = np.random.default_rng(1).random((60, 2))
        best = np.full(2, 0.5)
        fits = [calibration._local_form(best, u, np.random.default_rng(s).normal(0.0, [0.2, 0.5], (60, 2)), 60)
                for s in range(300)]
        spread = np.std([fit.jacobian for fit in fits], axis=0)
        np.testing.assert_allclose(np.sqrt(np.mean([fit.error**2 for fit in fits], axis=0)), spread, rtol=0.12)
        np.testing.assert_allclose(np.mean([np.diag(fit.scatter) for fit in fits], axis=0), [0.04, 0.25], rtol=0.05)

    def test_of_points_equally_far_it_is_ordinary_least_squares(self):
        """Two slopes and a mean from four points: one degree of freedom, whose residuals are +-c."""
        u, c = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]), 0.5
        y = 3.0 + u @ [[2.0], [4.0]] + c * np.array([[1.0], [1.0], [-1.0], [-1.0]])
        fit = calibration._local_form(np.zeros(2), u, y, 4)
        np.testing.assert_allclose(fit.at_best, [3.0])
        np.testing.assert_allclose(fit.jacobian, [[2.0, 4.0]])
        np.testing.assert_allclose(fit.scatter, [[4.0 * c**2]])
        np.testing.assert_allclose(fit.unit, 0.5 * np.eye(2), atol=1e-12)
        np.testing.assert_allclose(fit.error, [[np.sqrt(2.0) * c] * 2])
        self.assertEqual((fit.freedom, fit.points), (1, 4))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            at_best = calibration._local_form(np.zeros(2), np.zeros((4, 2)), y[:, :1], 4)
        np.testing.assert_allclose(at_best.at_best, [3.0])

    def test_weights_fall_to_the_farthest(self):
        """(1 - (d/1.1 farthest)^3)^3, of three points on a line: a mean by these weights where all else is even."""
        best, u = np.array([0.0]), np.array([[-0.5], [0.5], [-1.0], [1.0]])
        y = np.array([[1.0], [1.0], [0.0], [0.0]])
        near, far = (1.0 - (0.5 / 1.1) ** 3) ** 3, (1.0 - (1.0 / 1.1) ** 3) ** 3
        fit = calibration._local_form(best, u, y, 4)
        np.testing.assert_allclose(fit.at_best, near / (near + far))
        np.testing.assert_allclose(fit.jacobian, 0.0, atol=1e-12)
        self.assertEqual(calibration._local_form(best, u, y, 2).points, 2)


class Finished(unittest.TestCase):
    """When a search ends."""
    settings = calibration.Settings(most_generations=5, least_sigma=0.01, least_gain=0.1, patience=2)

    def why(self, misfits, sigma=0.5):
        known = [np.array(values) for values in misfits]
        return calibration._why_finished(self.settings, known, np.array([sigma, 0.0]))

    def test_short_steps(self):
        self.assertIn("no step is longer than 0.01", self.why([], 0.01))
        self.assertEqual(self.why([], 0.0101), "")

    def test_no_gain(self):
        self.assertEqual(self.why([[5.0, 9.0], [7.0]]), "", "not before it was patient")
        self.assertIn("2 generations gained no more than 0.1", self.why([[5.0, 9.0], [7.0], [4.91, 6.0]]))
        self.assertEqual(self.why([[5.0, 9.0], [7.0], [4.89, 6.0]]), "")
        self.assertIn("gained no more", self.why([[5.0], [4.0], [7.0], [6.0]]))
        self.assertEqual(self.why([[5.0], [4.8], [5.2]]), "", "either of the last two may have gained")
        self.assertEqual(self.why([[np.inf], [np.inf], [np.inf]]), "", "nothing feasible yet")
        self.assertEqual(self.why([[np.inf], [np.inf], [3.0]]), "")

    def test_generations(self):
        self.assertEqual(self.why([[9.0], [7.0], [5.0], [3.0]]), "")
        self.assertEqual(self.why([[9.0], [7.0], [5.0], [3.0], [1.0]]), "5 generations")


class Calibration(unittest.TestCase):
    def test_judged_by_hand(self):
        """Misfits of points whose outputs are known; infeasible, failed and unknown ones beside them."""
        targets = calibration.Targets(("a", "b"), np.array([1.0, 2.0]), np.array([0.5, 2.0]))
        outcomes = [np.array([[1.0, 2.0], [2.0, 6.0]]), calibration.Infeasible(0.1), None,
                    np.array([[1.0, np.nan], [1.0, 2.0]])]
        found = calibration._misfits_of(outcomes, targets, np.diag([0.25, 4.0]))
        np.testing.assert_allclose(found, [0.25 / 0.25 + 4.0 / 4.0, np.inf, np.nan, np.inf])
        np.testing.assert_allclose(calibration._covariance_of(outcomes[1:], targets), np.diag([0.25, 4.0]))
        np.testing.assert_allclose(calibration._covariance_of(outcomes, targets),
                                   calibration.misfit_covariance(outcomes[:1], targets))

    def test_too_few_points_tell_nothing(self):
        u = sampling.sobol_sequence(8, 2, 1)
        targets = calibration.Targets(("a",), np.array([0.5]), np.array([0.1]))
        y = u @ np.array([[1.0], [0.5]])
        y[4:] = np.nan
        told = calibration.uncertainty(np.full(2, 0.5), u, y, targets, np.eye(1), draws=5)
        self.assertEqual(told.points, 4)
        y[3] = np.nan
        with self.assertRaisesRegex(Error, "3 complete points: a linear form in 2 parameters needs at least 4"):
            calibration.uncertainty(np.full(2, 0.5), u, y, targets, np.eye(1))

    def test_a_slope_counts_beyond_what_noise_gives(self):
        """Student's t of 17 degrees: 2.110 for one output, and 2.458 for two, of which each may err half as often."""
        u = np.random.default_rng(2).random((20, 2))
        noise = np.random.default_rng(3).normal(0.0, 0.1, (20, 2))
        best = np.full(2, 0.5)
        pure = calibration._local_form(best, u, noise, 10)  # of ten points without quadratic terms: 7 degrees
        self.assertEqual(pure.freedom, 7)
        for outputs, limit in ((1, 2.3646), (2, 2.8412)):
            for factor, told in ((0.99, False), (1.01, True)):
                # so much slope of the first output along the first parameter makes just this ratio
                y = noise[:, :outputs].copy()
                y[:, 0] += (factor * limit * pure.error[0, 0] - pure.jacobian[0, 0]) * u[:, 0]
                targets = calibration.Targets(("a", "b")[:outputs], np.zeros(outputs), np.full(outputs, 0.1))
                covariance = np.diag(([1e-4, 1e4])[:outputs])
                found = calibration.uncertainty(best, u, y, targets, covariance, neighbours=10, draws=5)
                self.assertEqual((found.direction_ratio < 1.0).any(), told, (outputs, factor))
                self.assertEqual(found.points, 10)

    def test_what_is_not_determined(self):
        """Of a linear output of the first of two parameters: the posterior of the second is the prior."""
        u = sampling.sobol_sequence(64, 2, 1)
        for sd, determined in ((0.15, True), (0.6, False)):
            targets = calibration.Targets(("a",), np.array([0.5]), np.array([sd]))
            told = calibration.uncertainty(np.full(2, 0.5), u, u[:, :1], targets, np.array([[sd**2]]))
            self.assertEqual(told.not_determined.tolist(), [not determined, True])
            self.assertEqual(told.direction_not_determined.tolist(), [not determined, True])
            # without the cube's sides: 12 of the prior, 1/sd^2 of the target
            np.testing.assert_allclose(told.direction_ratio, [np.sqrt(12.0 / (12.0 + sd**-2)), 1.0], rtol=1e-6)
            np.testing.assert_allclose(np.abs(told.directions), np.eye(2), atol=1e-9)
            np.testing.assert_allclose(told.sd_ratio, told.sd * np.sqrt(12.0))
            np.testing.assert_allclose(told.sd[1], 12.0**-0.5, rtol=0.04)

    def test_linear_answer(self):
        truth = np.array([0.3, 0.7])
        targets = linear_targets(truth)
        found = calibration.calibrate(2, targets, calibration.Settings(), linear)
        self.assertTrue(found.search.finished)
        y = np.array([linear(point).mean(axis=0) for point in found.points])
        exact = np.linalg.inv(JACOBIAN.T @ np.linalg.inv(found.covariance) @ JACOBIAN)
        best = found.points[found.best]
        self.assertTrue((np.abs(best - truth) < np.sqrt(np.diag(exact))).all(), best)
        told = calibration.uncertainty(best, found.points, y, targets, found.covariance)
        np.testing.assert_allclose(told.jacobian, JACOBIAN, atol=1e-8)
        np.testing.assert_allclose(told.covariance, exact, atol=0.06 * exact.max())
        self.assertFalse(told.not_determined.any() or told.direction_not_determined.any())

    def test_only_a_product_matters(self):
        # In the logarithms that a log-uniform prior makes of them, a product is a sum.
        def outputs(u):
            product = np.exp(u.sum())
            return np.array([product, product**2, 1.0 / product]) + SEEDS

        targets = calibration.Targets(("a", "b", "c"), outputs(np.array([0.5, 0.5])).mean(axis=0), np.full(3, 0.02))
        found = calibration.calibrate(2, targets, calibration.Settings(), outputs)
        best = found.points[found.best]
        self.assertAlmostEqual(best.sum(), 1.0, delta=0.02)
        y = np.array([outputs(point).mean(axis=0) for point in found.points])
        told = calibration.uncertainty(best, found.points, y, targets, found.covariance)
        self.assertTrue(told.not_determined.all(), told.sd_ratio)
        self.assertEqual(told.direction_not_determined.tolist(), [False, True])
        np.testing.assert_allclose(np.abs(told.directions[1] @ [1.0, -1.0]) / np.sqrt(2.0), 1.0, atol=1e-3)
        self.assertLess(told.covariance[0, 1] / told.sd.prod(), -0.99)

    def test_noise_determines_nothing(self):
        # Only the first of three parameters has an effect. Each point has its own noise, and all lie close together, so
        # that the slopes are poorly known. One in twenty may be mistaken.
        mistaken = 0
        for repeat in range(20):
            random = np.random.default_rng(repeat)
            u = random.normal(0.5, 0.05, (60, 3))
            y = u[:, :1] * [1.0, 0.5, 0.5] + random.normal(0.0, 0.05, (60, 3))
            targets = calibration.Targets(("a", "b", "c"), np.array([0.5, 0.25, 0.25]), np.full(3, 0.01))
            told = calibration.uncertainty(np.full(3, 0.5), u, y, targets, np.eye(3) * 0.025**2, draws=500)
            self.assertFalse(told.not_determined[0], told.sd_ratio)
            mistaken += (~told.not_determined[1:]).sum()
        self.assertLessEqual(mistaken, 4, "of 40")

    def test_noise_does_not_tell_apart_what_only_acts_together(self):
        mistaken = 0
        for repeat in range(20):
            random = np.random.default_rng(repeat)
            u = random.normal(0.5, 0.08, (60, 2))
            y = u.sum(axis=1, keepdims=True) * [1.0, 1.5, 2.0] + random.normal(0.0, 0.05, (60, 3))
            targets = calibration.Targets(("a", "b", "c"), np.array([1.0, 1.5, 2.0]), np.full(3, 0.01))
            told = calibration.uncertainty(np.full(2, 0.5), u, y, targets, np.eye(3) * 0.025**2, draws=10)
            self.assertFalse(told.direction_not_determined[0])
            mistaken += not told.direction_not_determined[1]
        self.assertLessEqual(mistaken, 3, "of 20; 1 is expected")

    def test_truncated_by_the_cube(self):
        # Exact: a normal distribution cut to 0 ... 1, also far out in either tail.
        u = sampling.grid([9, 3])
        x = np.linspace(0.0, 1.0, 20001)
        for centre, sd in ((0.9, 0.5), (5.0, 0.3), (-4.0, 0.3)):
            targets = calibration.Targets(("a",), np.array([centre]), np.array([sd]))
            told = calibration.uncertainty(np.array([0.9, 0.2]), u, u[:, :1], targets, np.array([[sd**2]]))
            exponent = -0.5 * ((x - centre) / sd) ** 2
            density = np.exp(exponent - exponent.max())
            mean = (x * density).sum() / density.sum()
            cut = np.sqrt(((x - mean) ** 2 * density).sum() / density.sum())
            np.testing.assert_allclose(told.sd, [cut, calibration.UNIFORM_SD], rtol=0.04)

    def test_replay_with_results_in_any_order(self):
        targets = linear_targets(np.array([0.3, 0.7]))
        settings = calibration.Settings(seed=3, most_generations=6)
        straight = calibration.calibrate(2, targets, settings, linear)
        random = np.random.default_rng(8)
        table = {}
        for _ in range(1000):
            state = calibration.calibrate(2, targets, settings, lambda u: table.get(u.tobytes()))
            if state.search.finished:
                break
            waiting = [point for point in state.points if point.tobytes() not in table]
            np.testing.assert_array_equal(np.isnan(state.misfits), [u.tobytes() not in table for u in state.points])
            for row in random.permutation(len(waiting))[:2]:
                table[waiting[row].tobytes()] = linear(waiting[row])
        np.testing.assert_array_equal(state.points, straight.points)
        np.testing.assert_array_equal(state.misfits, straight.misfits)
        self.assertEqual((state.best, state.search.finished), (straight.best, "6 generations"))
        other = calibration.calibrate(2, targets, calibration.Settings(seed=4, most_generations=6), linear)
        self.assertFalse(np.array_equal(other.points, straight.points))

    def test_infeasible_and_failed_points(self):
        truth = np.array([0.6, 0.6])

        def outcome(u):
            if u[0] > 0.5:
                return calibration.Infeasible(u[0] - 0.5)
            return np.full((4, 3), np.nan) if u[1] < 0.1 else linear(u)

        found = calibration.calibrate(2, linear_targets(truth), calibration.Settings(), outcome)
        outside = (found.points[:, 0] > 0.5) | (found.points[:, 1] < 0.1)
        self.assertTrue(outside.any())
        np.testing.assert_array_equal(np.isinf(found.misfits), outside)
        self.assertAlmostEqual(found.points[found.best][0], 0.5, delta=0.03)
        self.assertTrue((np.abs(found.points[-6:, 0] - 0.5) < 0.1).all(), "the search goes along the border")

    def test_infeasible_points_are_ranked_by_their_distance(self):
        # Nothing feasible in the whole first generation: the distance alone must lead on.
        def judge(generations):
            return np.full(len(generations[-1]), np.inf), np.abs(generations[-1] - 0.9).sum(axis=1)

        found = calibration.search(2, calibration.Settings(most_generations=30), judge)
        np.testing.assert_allclose(found.mean, 0.9, atol=0.03)

    def test_begins_in_the_middle_with_its_step(self):
        found = calibration.search(2, calibration.Settings(sigma=0.2, most_generations=0), lambda _: None)
        np.testing.assert_allclose(found.mean, [0.5, 0.5])
        np.testing.assert_allclose(found.sigma, [0.2, 0.2])
        self.assertEqual((found.generations, found.misfits, found.finished), ([], [], "0 generations"))
        # 4 + 3 ln k points a generation; one parameter has an idle second one beside
        for k, count in ((1, 6), (2, 6), (3, 7)):
            found = calibration.search(k, calibration.Settings(), lambda _: None)
            self.assertEqual([points.shape for points in found.generations], [(count, k)])
            np.testing.assert_array_equal(found.points, found.points.round(9))
            self.assertEqual((found.misfits, found.finished), ([], ""))
        self.assertEqual(len(calibration.search(2, calibration.Settings(population=11), lambda _: None).points), 11)

    def test_a_search_that_only_shrinks_has_degenerated(self):
        def judge(generations):
            return np.abs(generations[-1] - 0.3).sum(axis=1), np.zeros(len(generations[-1]))

        endless = calibration.Settings(most_generations=5000, least_sigma=-1.0, patience=9999)
        found = calibration.search(2, endless, judge)
        self.assertEqual(found.finished, "the search has degenerated")
        self.assertLess(found.sigma.max(), 1e-9)

    def test_what_failed_is_infeasible_by_nothing(self):
        """Searched alike, whether a point is failed or infeasible by 0, beside ones that are infeasible by little."""
        def search_with(failed):
            def outcome(u):
                asked.append(u.tobytes())
                if u[0] > 0.55:
                    return calibration.Infeasible(0.01 * u[0])
                return failed if u[1] < 0.45 else linear(u)

            asked = []
            found = calibration.calibrate(2, targets, calibration.Settings(most_generations=8), outcome)
            self.assertEqual(len(asked), len(set(asked)), "each point is asked for once")
            return found.points

        targets = linear_targets(np.array([0.6, 0.6]))
        np.testing.assert_array_equal(search_with(np.full((4, 3), np.nan)), search_with(calibration.Infeasible(0.0)))
        self.assertEqual(calibration.Infeasible().by, 0.0)

    def test_one_parameter(self):
        targets = calibration.Targets(("a",), np.array([0.2]), np.array([0.01]))
        found = calibration.calibrate(1, targets, calibration.Settings(), lambda u: np.full((2, 1), u[0]))
        self.assertEqual(found.points.shape[1], 1)
        self.assertAlmostEqual(found.points[found.best, 0], 0.2, delta=0.005)

    def test_points_lie_in_the_cube(self):
        found = calibration.calibrate(2, linear_targets(np.array([0.0, 1.0])), calibration.Settings(), linear)
        self.assertTrue(found.points.min() >= 0.0 and found.points.max() <= 1.0)
        np.testing.assert_allclose(found.points[found.best], [0.0, 1.0], atol=0.03)


class Posterior(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        u, held = sampling.sobol_sequence(32, 2, 5), sampling.sobol_sequence(32, 2, 6)
        cls.y = np.array([linear(point) for point in u])
        held_y = np.array([linear(point) for point in held])
        cls.surrogates = [surrogate.fit(u, cls.y[:, :, i], most_degree=2) for i in range(3)]
        cls.validations = [surrogate.validate(cls.surrogates[i], held, held_y[:, :, i]) for i in range(3)]
        cls.targets = linear_targets(np.array([0.3, 0.7]))
        cls.covariance = calibration.misfit_covariance(list(cls.y), cls.targets)
        cls.found = posterior.sample(cls.surrogates, cls.validations, cls.targets, cls.covariance, 1, most_steps=2000)

    def test_linear_answer(self):
        exact = np.linalg.inv(JACOBIAN.T @ np.linalg.inv(self.covariance) @ JACOBIAN)
        sd = np.sqrt(np.diag(exact))
        np.testing.assert_allclose(self.found.mean, [0.3, 0.7], atol=4.0 * sd.max() / np.sqrt(self.found.effective))
        np.testing.assert_allclose(self.found.sd, sd, rtol=0.1)
        self.assertAlmostEqual(self.found.correlation[0, 1], exact[0, 1] / sd.prod(), delta=0.08)
        self.assertFalse(self.found.not_determined.any())
        self.assertGreater(self.found.effective, 300)

    def test_repeats(self):
        again = posterior.sample(self.surrogates, self.validations, self.targets, self.covariance, 1, most_steps=100)
        np.random.seed(5)  # the chain must not come from numpy's own state
        same = posterior.sample(self.surrogates, self.validations, self.targets, self.covariance, 1, most_steps=100)
        np.testing.assert_array_equal(again.chain, same.chain)
        self.assertFalse(again.converged)
        self.assertIn("not converged", again.statement)

    def test_one_output_cannot_tell_two_parameters(self):
        targets = calibration.Targets(("c",), np.array([1.0]), np.array([0.02]))
        found = posterior.sample(self.surrogates[2:], self.validations[2:], targets, np.array([[0.02**2]]), 2,
                                 most_steps=1000)
        self.assertTrue(found.not_determined.all(), found.sd_ratio)
        self.assertLess(found.correlation[0, 1], -0.95)
        self.assertTrue(found.chain.min() >= 0.0 and found.chain.max() <= 1.0)

    def test_its_numbers_are_those_of_its_chain(self):
        found = self.found
        np.testing.assert_allclose(found.mean, found.chain.mean(axis=0))
        np.testing.assert_allclose(found.sd, found.chain.std(axis=0, ddof=1))
        np.testing.assert_allclose(found.sd_ratio, found.sd * np.sqrt(12.0))
        self.assertEqual(found.not_determined.tolist(), (found.sd_ratio > 0.8).tolist())
        walkers = 16
        burn = found.steps - len(found.chain) // walkers
        self.assertEqual(burn, int(5.0 * found.autocorrelation.max()))  # five times are left out
        self.assertAlmostEqual(found.effective, len(found.chain) / found.autocorrelation.max())
        if found.converged:
            self.assertTrue((50.0 * found.autocorrelation < found.steps).all())
            self.assertTrue(found.statement.endswith("; converged"))

    def test_more_walkers_for_more_parameters(self):
        few = posterior.sample(self.surrogates, self.validations, self.targets, self.covariance, 1, most_steps=20)
        self.assertEqual((few.steps, len(few.chain)), (20, 10 * 16))  # half is left out while nothing is known
        stated = posterior.sample(self.surrogates, self.validations, self.targets, self.covariance, 1, walkers=8,
                                  most_steps=20)
        self.assertEqual(len(stated.chain), 10 * 8)

    def test_four_walkers_a_parameter(self):
        u = sampling.sobol_sequence(40, 5, 5)
        sums = [surrogate.fit(u, u.sum(axis=1), most_degree=1)]
        fine = [surrogate.Validation(1.0, 1.0, 0.0, 0.0, 40)]
        targets = calibration.Targets(("a",), np.array([2.5]), np.array([0.5]))
        found = posterior.sample(sums, fine, targets, np.array([[0.25]]), most_steps=4)
        self.assertEqual(len(found.chain), 2 * 20)

    def test_has_converged_when_long_enough_and_settled(self):
        """Looked at every 500 steps: fifty autocorrelation times, which have changed by less than 2 %."""
        import emcee
        for times, steps in (([9.0, 9.19, 9.37], 1500),  # by 2.07 %, then by 1.92 %
                             ([20.0, 20.0, 20.0], 1500), ([29.9, 29.9, 29.9], 1500), ([30.1] * 4, 2000)):
            asked = iter(times)
            with mock.patch.object(emcee.EnsembleSampler, "get_autocorr_time",
                                   lambda self, tol: np.array([1.0, next(asked)])), \
                    mock.patch.object(surrogate.Surrogate, "predict", lambda self, u: u[:, 0]):
                found = posterior.sample(self.surrogates, self.validations, self.targets, self.covariance, 1)
            self.assertEqual((found.steps, found.converged), (steps, True), times)
            self.assertEqual(len(found.chain), 16 * (steps - int(5.0 * times[-1])))
            self.assertAlmostEqual(found.effective, len(found.chain) / times[-1])

    def test_the_surrogates_own_errors_widen_it(self):
        wide = [surrogate.Validation(v.q2, v.own_q2, v.error, 0.3, v.points) for v in self.validations]
        found = posterior.sample(self.surrogates, wide, self.targets, self.covariance, 1, most_steps=1000)
        exact = np.linalg.inv(JACOBIAN.T @ np.linalg.inv(self.covariance + 0.09 * np.eye(3)) @ JACOBIAN)
        self.assertGreater(found.sd.min(), 3.0 * self.found.sd.max())
        self.assertLess((found.sd / np.sqrt(np.diag(exact))).max(), 1.1)

    def test_check_by_hand(self):
        y = np.array([[[1.0], [3.0]], [[0.0], [0.0]], [[8.0], [np.nan]]])  # (n, seeds, q)
        found = posterior.check(np.array([[1.0], [4.0], [0.0]]), y, np.array([0.5]))
        np.testing.assert_allclose(found.standardised, [[2.0], [-8.0], [np.nan]])
        np.testing.assert_allclose(found.rms, np.sqrt(34.0))
        self.assertEqual((found.within_two.tolist(), found.points.tolist()), ([0.5], [2]))
        near = posterior.check(np.zeros((4, 1)), np.array([-2.0, 2.0, 2.1, -2.1]).reshape(4, 1, 1), np.ones(1))
        self.assertEqual(near.within_two.tolist(), [0.5])

    def test_check(self):
        points = posterior.check_points(self.found, 8, 3)
        np.testing.assert_array_equal(points[:4], posterior.check_points(self.found, 4, 3))
        predicted = np.column_stack([entry.predict(points) for entry in self.surrogates])
        true = np.array([linear(point) for point in points])
        holds = posterior.check(predicted, true, np.full(3, 0.01))
        self.assertLess(holds.rms.max(), 0.01)
        true[:, :, 1] += 0.03
        true[0, 2, 0] = np.nan
        fails = posterior.check(predicted, true, np.full(3, 0.01))
        np.testing.assert_allclose(fails.rms[1], 3.0, rtol=0.01)
        self.assertEqual((fails.within_two.tolist(), fails.points.tolist()), ([1.0, 0.0, 1.0], [7, 8, 8]))

    def test_refusals(self):
        poor = [surrogate.Validation(0.95, 0.89, 1.0, 1.0, 40)] + self.validations[1:]
        with self.assertRaisesRegex(Error, "0.890"):
            posterior.sample(self.surrogates, poor, self.targets, self.covariance)
        with mock.patch.dict(sys.modules, emcee=None), self.assertRaisesRegex(Error, "python3-emcee"):
            posterior.sample(self.surrogates, self.validations, self.targets, self.covariance)


class WithoutTheCompiledPart(unittest.TestCase):
    def test_is_not_imported(self):
        told = "import sys, pyroclast.study.methods.calibration; sys.exit('pyroclast._core' in sys.modules)"
        subprocess.run([sys.executable, "-c", told], check=True)


if __name__ == "__main__":
    unittest.main()
