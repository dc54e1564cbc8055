"""The statistics agree with textbooks, with scipy where there is one, and with their own laws."""

from __future__ import annotations

import itertools
import math
import random
import unittest

from routebench_plots import distributions, inference

try:
    from scipy import stats as scipy_stats
except ImportError:
    scipy_stats = None

needs_scipy = unittest.skipIf(scipy_stats is None, "python3-scipy is not installed")

# Accuracy of C4.5 and three of its variants on 14 data sets: J. Demšar, Statistical comparisons of
# classifiers over multiple data sets, JMLR 7, 2006, table 6. On the last but one the printed
# numbers of the last two tie at .975, but his ranks put the former first.
DEMSAR = {
    "C4.5": (.763, .599, .954, .628, .882, .936, .661, .583, .775, 1.0, .940, .619, .972, .957),
    "C4.5+m": (.768, .591, .971, .661, .888, .931, .668, .583, .838, 1.0, .962, .666, .981, .978),
    "C4.5+cf": (.771, .590, .968, .654, .886, .916, .609, .563, .866, 1.0, .965, .614, .9751, .946),
    "C4.5+m+cf": (.798, .569, .967, .657, .898, .931, .685, .625, .875, 1.0, .962, .669, .975, .970),
}  # fmt: skip


class DistributionTest(unittest.TestCase):
    """Tails and quantiles."""

    def test_nemenyi_quantiles_are_those_of_the_textbook(self) -> None:
        """Demšar 2006, table 5a."""
        for groups, expected in (
            (2, 1.960), (3, 2.343), (4, 2.569), (5, 2.728), (6, 2.850), (7, 2.949),
            (8, 3.031), (9, 3.102), (10, 3.164),
        ):  # fmt: skip
            found = distributions.studentized_range_quantile(0.95, groups) / math.sqrt(2)
            self.assertAlmostEqual(found, expected, delta=0.0011)

    def test_range_of_two_is_a_difference_of_two(self) -> None:
        for q in (0.1, 1.0, 2.77, 6.0):
            self.assertAlmostEqual(
                distributions.studentized_range_cdf(q, 2), math.erf(q / 2), places=12
            )

    def test_chi_squared_with_two_degrees_is_exponential(self) -> None:
        for x in (0.0, 0.3, 5.991, 40.0):
            self.assertAlmostEqual(distributions.chi_squared_tail(x, 2), math.exp(-x / 2))
        self.assertAlmostEqual(distributions.chi_squared_tail(3.841459, 1), 0.05, places=7)

    def test_student_textbook(self) -> None:
        for freedom, expected in ((1, 12.706), (2, 4.303), (5, 2.571), (30, 2.042)):
            found = distributions.student_quantile(0.975, freedom)
            self.assertAlmostEqual(found, expected, delta=0.0005)

    def test_no_quantile_of_nothing(self) -> None:
        for share, groups in ((0.95, 1), (0.0, 3), (1.0, 3)):
            with self.assertRaises(ValueError):
                distributions.studentized_range_quantile(share, groups)

    @needs_scipy
    def test_scipy_says_the_same(self) -> None:
        for freedom, x in itertools.product((1, 2, 3, 8, 15, 40), (0.01, 1.0, 7.7, 60.0)):
            self.assertAlmostEqual(
                distributions.chi_squared_tail(x, freedom),
                scipy_stats.chi2.sf(x, freedom),
                places=12,
            )
            self.assertAlmostEqual(
                distributions.student_cdf(x / 5, freedom),
                scipy_stats.t.cdf(x / 5, freedom),
                places=12,
            )
        for groups in (3, 17, 60):
            self.assertAlmostEqual(
                distributions.studentized_range_quantile(0.95, groups),
                scipy_stats.studentized_range.ppf(0.95, groups, 1e8),
                places=4,
            )


class SignedRankTest(unittest.TestCase):
    """Wilcoxon's test and Holm's correction."""

    # M. Hollander, D. A. Wolfe, Nonparametric statistical methods, table 3.1: Hamilton depression
    # scale before and after; T+ = 40 of 45, P = 0.0195 on one side.
    BEFORE = (1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30)
    AFTER = (0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29)

    def test_textbook(self) -> None:
        found = inference.signed_rank_p([a - b for a, b in zip(self.BEFORE, self.AFTER)])
        self.assertAlmostEqual(found, 2 * 0.01953125)

    def test_is_what_counting_all_signs_gives(self) -> None:
        """Ties or none: against the definition."""
        rng = random.Random(3)
        for _ in range(30):
            numbers = [rng.choice((-3, -2, -1, 1, 2, 3, 4)) for _ in range(rng.randint(1, 9))]
            ranks = inference.mean_ranks([abs(x) for x in numbers])
            observed = sum(r for r, x in zip(ranks, numbers) if x > 0)
            sums = [
                sum(r for r, sign in zip(ranks, signs) if sign)
                for signs in itertools.product((False, True), repeat=len(ranks))
            ]
            low = min(observed, sum(ranks) - observed)
            expected = min(1.0, 2 * sum(s <= low + 1e-9 for s in sums) / len(sums))
            self.assertAlmostEqual(inference.signed_rank_p(numbers), expected)

    def test_one_sign_alone_is_the_least(self) -> None:
        for n in (1, 5, 6, 50):
            found = inference.signed_rank_p([-1.0 - k for k in range(n)])
            self.assertAlmostEqual(found, min(1.0, 2.0 ** (1 - n)))

    def test_zeros_say_nothing(self) -> None:
        self.assertEqual(inference.signed_rank_p([]), 1.0)
        self.assertEqual(inference.signed_rank_p([0.0] * 9), 1.0)
        some = [1.0, 2.0, -3.0, 4.0, 5.0]
        self.assertEqual(
            inference.signed_rank_p(some), inference.signed_rank_p([0.0, *some, 0.0])
        )

    def test_symmetry(self) -> None:
        rng = random.Random(5)
        for n in (7, 80):
            some = [rng.gauss(0.2, 1) for _ in range(n)]
            self.assertAlmostEqual(
                inference.signed_rank_p(some), inference.signed_rank_p([-x for x in some])
            )

    @needs_scipy
    def test_scipy_says_the_same(self) -> None:
        rng = random.Random(1)
        for n in (6, 20, 50):
            some = [rng.gauss(0.3, 1) for _ in range(n)]
            self.assertAlmostEqual(
                inference.signed_rank_p(some), scipy_stats.wilcoxon(some).pvalue, places=12
            )
        # With ties and zeros scipy approximates, as we do for many pairs.
        for n in (60, 200):
            some = [float(rng.randint(-6, 8)) for _ in range(n)]
            expected = scipy_stats.wilcoxon(some, mode="approx", correction=False).pvalue
            self.assertAlmostEqual(inference.signed_rank_p(some), expected, places=12)

    def test_holm_textbook(self) -> None:
        """By hand: 4 x 0.005, 3 x 0.01, then 2 x 0.03 twice, for 0.04 must not come before."""
        self.assertEqual(
            [round(p, 12) for p in inference.holm([0.01, 0.04, 0.03, 0.005])],
            [0.03, 0.06, 0.06, 0.02],
        )
        self.assertEqual(inference.holm([]), [])
        self.assertEqual(inference.holm([0.7, 0.8]), [1.0, 1.0])


class RankTest(unittest.TestCase):
    """Friedman, Nemenyi and the groups they leave together."""

    def test_textbook(self) -> None:
        """Demšar's example: mean ranks 3.143, 2.000, 2.893, 1.964; χ² = 9.28; CD = 1.25."""
        found = inference.friedman([[-x for x in row] for row in zip(*DEMSAR.values())])
        assert found is not None
        for rank, expected in zip(found.mean_ranks, (3.143, 2.000, 2.893, 1.964)):
            self.assertAlmostEqual(rank, expected, delta=0.0006)
        # He takes the formula without the correction for ties.
        k, n = 4, 14
        squares = sum(rank * rank for rank in found.mean_ranks)
        plain = 12 * n / (k * (k + 1)) * (squares - k * (k + 1) ** 2 / 4)
        self.assertAlmostEqual(plain, 9.28, delta=0.01)
        self.assertGreater(found.chi_squared, plain)
        # He computes with the rounded quantile 2.569.
        self.assertAlmostEqual(found.critical_difference, 1.25, delta=0.005)

    @needs_scipy
    def test_scipy_says_the_same(self) -> None:
        rng = random.Random(9)
        for spread in (1000, 4):
            rows = [[rng.randint(0, spread) + column for column in range(5)] for _ in range(12)]
            found = inference.friedman(rows)
            assert found is not None
            expected = scipy_stats.friedmanchisquare(*zip(*rows))
            self.assertAlmostEqual(found.chi_squared, expected.statistic)
            self.assertAlmostEqual(found.p, expected.pvalue)

    def test_too_little_for_a_test(self) -> None:
        for rows in ([], [[1.0, 2.0]], [[1.0], [2.0]]):
            self.assertIsNone(inference.friedman(rows))

    def test_nothing_but_ties(self) -> None:
        found = inference.friedman([[1.0, 1.0, 1.0]] * 4)
        assert found is not None
        self.assertEqual((found.p, found.chi_squared), (1.0, 0.0))
        self.assertEqual(found.mean_ranks, [2.0, 2.0, 2.0])

    def test_ranks_share_their_mean(self) -> None:
        self.assertEqual(inference.mean_ranks([5, 1, 5, 9, 5]), [3, 1, 3, 5, 3])

    def test_groups(self) -> None:
        """A group is as long as it can be, and none lies within another."""
        self.assertEqual(inference.alike([1, 1.5, 2.9, 3.0, 5.1], 2.0), [(0, 3)])
        self.assertEqual(inference.alike([1, 2, 3, 4], 1.0), [(0, 1), (1, 2), (2, 3)])
        self.assertEqual(inference.alike([1, 3, 5], 1.0), [])
        self.assertEqual(inference.alike([1, 2, 3], 9.0), [(0, 2)])


class IntervalTest(unittest.TestCase):
    """Bootstrap intervals of the median."""

    def test_lies_within_the_data_around_the_median(self) -> None:
        rng = random.Random(2)
        for n in (1, 2, 3, 8, 31):
            some = [rng.lognormvariate(0, 1) for _ in range(n)]
            found = inference.median_interval(some)
            middle = sorted(some)[n // 2]
            self.assertLessEqual(min(some), found.low)
            self.assertLessEqual(found.low, middle)
            self.assertLessEqual(found.low, found.high)
            self.assertLessEqual(found.high, max(some))

    def test_equal_input_gives_equal_intervals(self) -> None:
        some = [0.5, 0.7, 0.9, 1.4, 2.0, 2.2, 0.1]
        self.assertEqual(inference.median_interval(some), inference.median_interval(some))
        pairs = [([[1.0, 1.1, 1.3]], [[2.0, 2.2]])] * 5
        self.assertEqual(
            inference.nested_median_interval(pairs), inference.nested_median_interval(pairs)
        )

    def test_holds_the_true_median_as_often_as_it_says(self) -> None:
        """95 % of 400 tries, give or take the spread of such a count; more with few models."""
        rng = random.Random(11)
        for models in (6, 8, 15, 30):
            held = 0
            for _ in range(400):
                found = inference.median_interval(
                    [rng.lognormvariate(0, 0.5) for _ in range(models)]
                )
                held += found.low <= 1 <= found.high
            with self.subTest(models=models, held=held):
                self.assertGreaterEqual(held / 400, 0.95 - 3 * math.sqrt(0.95 * 0.05 / 400))

    def test_repetitions_widen_it(self) -> None:
        """Models that all have the same ratio: what is left is the noise of repetitions."""
        steady = inference.nested_median_interval([([[2.0]], [[1.0]])] * 8)
        self.assertEqual((steady.low, steady.high), (2.0, 2.0))
        noisy = inference.nested_median_interval([([[1.8, 2.0, 2.2]], [[0.9, 1.0, 1.1]])] * 8)
        self.assertLess(noisy.low, 2.0)
        self.assertGreater(noisy.high, 2.0)

    def test_seeds_are_drawn_as_wholes(self) -> None:
        """Two seeds that differ much: the interval spans both."""
        found = inference.nested_median_interval([([[1.0, 1.0], [3.0, 3.0]], [[1.0]])])
        self.assertEqual((found.low, found.high), (1.0, 3.0))

    def test_shift_is_on_both_sides(self) -> None:
        found = inference.nested_median_interval([([[0.0]], [[1.0]])], shift=1.0)
        self.assertEqual((found.low, found.high), (0.5, 0.5))


class ProfileTest(unittest.TestCase):
    """Dolan and Moré's profiles."""

    COSTS = {1: [1.0, 4.0, None, 3.0], 2: [2.0, 2.0, 5.0, None], 3: [None] * 4}

    def test_failures_are_infinite(self) -> None:
        found = inference.performance_ratios(self.COSTS)
        self.assertEqual(found[1], [1.0, 2.0, math.inf, 1.0])
        self.assertEqual(found[2], [2.0, 1.0, 1.0, math.inf])
        self.assertEqual(found[3], [math.inf] * 4)

    def test_shares_rise_to_the_share_that_is_solved(self) -> None:
        found = inference.performance_ratios(self.COSTS)
        shares = [inference.profile(found[1], factor) for factor in (1, 1.9, 2, 1e9)]
        self.assertEqual(shares, [0.5, 0.5, 0.75, 0.75])
        self.assertEqual(inference.profile(found[3], 1e9), 0.0)

    def test_someone_is_best_where_anyone_is_valid(self) -> None:
        rng = random.Random(4)
        costs = {c: [rng.choice((None, rng.random())) for _ in range(40)] for c in range(4)}
        found = inference.performance_ratios(costs)
        for place in range(40):
            column = [costs[c][place] for c in costs]
            if any(cost is not None for cost in column):
                self.assertEqual(min(found[c][place] for c in costs), 1.0)

    def test_geometric_mean(self) -> None:
        self.assertAlmostEqual(inference.geometric_mean([0.5, 2.0, 4.0, 0.25]), 1.0)


if __name__ == "__main__":
    unittest.main()
