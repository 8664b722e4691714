"""The page and figures of a study."""

import json
import math
import pathlib
import re
import shutil
import unittest
from collections.abc import Callable, Sequence
from unittest import mock

from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from pyroclast.study.executors.local import Local
from pyroclast.study.report import _SECTIONS, write_report
from pyroclast.study.report.drawing import NOT_TOLD, SEED
from pyroclast.study.report.runs import _chosen
from pyroclast.study.report.seen import number, percent, seen
from pyroclast.study.store import RunResult
from pyroclast.study.study import Study
from pyroclast.study.work import Job
from study_files import StudyTest

MODEL = '''
import random

def model(seed, x=0.5, y=0.5, dull=0.5, kind="a"):
    """dull does nothing but draw another specimen's luck."""
    if x > 0.9 and seed == 2:
        raise ValueError("<b>no</b> strength")
    luck = random.Random(f"{seed} {dull}").gauss(0.0, 1.0)
    return {"f_c": 20.0 + 4.0 * x + 2.0 * y + 0.3 * luck + 0.1 * seed, "E": 30.0 + 3.0 * y * y + x}
'''
X = '[parameters.x]\nuniform = ["0 MPa", "0.9 MPa"]\nlevels = 4\n'
XY = f"{X}[parameters.y]\nlog_uniform = [0.1, 1]\nlevels = 4\n"
DULL = "[parameters.dull]\nuniform = [0, 1]\n"
KIND = '[parameters.kind]\nchoice = ["a", "<i>b</i>"]\n[parameters.dull]\ninteger = [1, 3]\n'
FAILING = "[parameters.x]\nuniform = [0, 1.8]\n"
TARGETS = "[targets.f_c]\nvalue = 23\nsd = 0.5\n[targets.E]\nvalue = 31\nsd = 0.2\n"
METHODS = {
    "ensemble": ('kind = "ensemble"', "", ""),
    "grid": ('kind = "grid"', XY, ""),
    "lhs": ('kind = "lhs"\nsamples = 12', XY + KIND, ""),
    "morris": ('kind = "morris"\ntrajectories = 4', XY + DULL, ""),
    "sobol": ('kind = "sobol"\nsamples = 16', XY + DULL, ""),
    "chaos": ('kind = "chaos"\nsamples = 30', XY, ""),
    "calibrate": ('kind = "calibrate"\ngenerations = 4', XY + DULL, TARGETS),
    "secant": ('kind = "secant"', XY.replace('"0 MPa"', '"0.1 MPa"'),
               TARGETS.replace("sd = 0.5", 'sd = 0.5\nby = "x"').replace("sd = 0.2", 'sd = 0.2\nby = "y"')),
    "posterior": ('kind = "posterior"\nsamples = 30\nsteps = 400\nchecks = 2', XY, TARGETS),
}
FIGURES = {
    "ensemble": ["E-seeds", "f_c-seeds"],
    "grid": ["E-contours", "E-curves", "E-effects", "f_c-contours", "f_c-curves", "f_c-effects"],
    "lhs": ["E-curves", "E-effects", "f_c-curves", "f_c-effects"],
    "morris": ["E-morris", "f_c-morris"],
    "sobol": ["E-curves", "E-indices", "f_c-curves", "f_c-indices"],
    "chaos": ["E-curves", "E-indices", "f_c-curves", "f_c-indices"],
    "calibrate": ["directions", "misfit", "parameters", "search", "targets"],
    "secant": ["rounds", "targets"],
    "posterior": ["check", "posterior", "spread"],
}


class First(Local):
    """Makes the first runs alone."""

    def __init__(self, most: int):
        super().__init__(1)
        self.most = most

    def run(self, jobs: Sequence[Job], runs: pathlib.Path, finished: Callable[[RunResult], None],
            stopped: Callable[[], bool]) -> None:
        super().run(jobs[:self.most], runs, finished, stopped)


class ReportTest(StudyTest):
    def setUp(self) -> None:
        super().setUp()
        self.model.write_text(MODEL)

    def of(self, method: str, parameters: str = "", rest: str = "", seeds: int = 3) -> Study:
        return self.study(f'''
title = "A <script>alert(1)</script> & more \\u001b[31m\\u202e"
[study]
runner = "function"
function = "model.py:model"
seeds = {seeds}
[method]
{method}
{parameters}
[outputs]
f_c = "f_c"
E = "E"
{rest}''')

    def made(self, method: str, parameters: str = "", rest: str = "", seeds: int = 3) -> Study:
        study = self.of(method, parameters, rest, seeds)
        self.assertTrue(study.run(jobs=1))
        return study

    def figures(self, study: Study) -> dict[str, Figure]:
        found = seen(study)
        return {shown.name: shown.figure for section in _SECTIONS[found.method](found) for shown in section.figures}


class Runs(ReportTest):
    def test_pages_of_runs_stand_beside_that_of_the_study(self) -> None:
        shutil.copy(pathlib.Path(__file__).parents[2] / "cases" / "starter.toml", self.folder / "deck.toml")
        study = self.study('''
title = "Seeds"
[study]
deck = "deck.toml"
seeds = 2
keep = "history"
changes = { "blocks.count" = 60, "stages[1].stop_strain" = 5e-4 }
[method]
kind = "ensemble"
[outputs]
E = "E_GPa"
''')
        self.assertTrue(study.run(jobs=1))
        page = write_report(study)
        links = re.findall(r'<a href="(run-[0-9a-f]+\.html)">(least|greatest) E', page.read_text())
        self.assertEqual([what for _, what in links], ["least", "greatest"])
        for file, _ in links:
            self.assertIn("Compression of a 1,000-block specimen", (page.parent / file).read_text())


    def test_with_targets_the_nearest_run_of_the_best_point_and_the_farthest_are_chosen(self) -> None:
        study = self.made(*METHODS["secant"])
        found = seen(study)
        (nearest, best), (farthest, worst) = _chosen(found)
        targets = study.setup.targets

        def misfit(row: dict) -> float:
            return sum(((row[t.output] - t.value) / (t.sd or abs(t.value))) ** 2 for t in targets)

        values = [p.distribution.at(u) for p, u in zip(study.setup.parameters, found.findings["best"]["u"])]
        at_best = [row for row in found.rows if [row[p.column] for p in study.setup.parameters] == values]
        self.assertEqual(misfit(best), min(map(misfit, at_best)))
        self.assertEqual(misfit(worst), max(map(misfit, found.rows)))
        self.assertTrue(nearest.startswith("at the best point, nearest to the targets: "), nearest)
        self.assertTrue(farthest.startswith("farthest from the targets: "), farthest)

    def test_failed_runs_are_chosen_behind_runs_not_yet_made(self) -> None:
        found = mock.Mock()
        found.setup.outputs = [mock.Mock(of_history=False, what="E_GPa")]
        found.setup.outputs[0].name = "E"
        found.setup.targets = ()
        found.rows = [{"state": state, "reason": "", "E": None, "run": str(number)} for number, state in
                      enumerate(("not run", "not run", "not run", "failed"))]
        self.assertEqual([row["run"] for _, row in _chosen(found)], ["3"])


class Elsewhere(ReportTest):
    def test_a_report_may_leave_the_study_as_it_is(self) -> None:
        study = self.made(*METHODS["ensemble"])
        out = self.folder / "drawn"
        out.mkdir()
        (out / "mine.png").write_text("mine")

        def contents() -> list[tuple[str, int]]:
            return sorted((str(file), file.stat().st_mtime_ns) for file in study.setup.folder.rglob("*"))

        before = contents()
        self.assertEqual(write_report(study, out), out / "report.html")
        self.assertEqual(contents(), before)
        self.assertEqual((out / "mine.png").read_text(), "mine")
        self.assertTrue((out / "findings.json").exists())


class Pages(ReportTest):
    def check(self, name: str, seeds: int = 3) -> None:
        page = write_report(self.made(*METHODS[name], seeds))
        text = page.read_text()
        self.assertEqual(sorted(file.stem for file in page.parent.glob("*.png")), FIGURES[name])
        for figure in FIGURES[name]:
            for ending in ("png", "pdf"):
                self.assertGreater((page.parent / f"{figure}.{ending}").stat().st_size, 1500, figure)
        self.assertEqual(text.count('src="data:image/png;base64,'), len(FIGURES[name]))
        said = re.sub('src="[^"]*"', "", text)
        self.assertNotRegex(said, "https?://|<script|<i>|<b>|nan")
        self.assertIn(r"A &lt;script&gt;alert(1)&lt;/script&gt; &amp; more \x1b[31m\u202e", said)
        self.assertNotIn("not complete", said)
        self.assertIn("-m pyroclast.study.call", said)
        json.loads((page.parent / "findings.json").read_text())

    def test_ensemble(self) -> None:
        self.check("ensemble", 6)

    def test_grid(self) -> None:
        self.check("grid")

    def test_latin_hypercube(self) -> None:
        self.check("lhs")

    def test_morris(self) -> None:
        self.check("morris")

    def test_sobol(self) -> None:
        self.check("sobol")

    def test_chaos(self) -> None:
        self.check("chaos", 2)

    def test_calibrate(self) -> None:
        self.check("calibrate")

    def test_secant(self) -> None:
        self.check("secant")

    def test_posterior(self) -> None:
        self.check("posterior", 2)


class Standing(ReportTest):
    """Studies that are not done, and runs without a value."""

    def test_a_study_without_a_run_says_so(self) -> None:
        for name, (method, parameters, rest) in METHODS.items():
            with self.subTest(name):
                page = write_report(self.of(method, parameters, rest)).read_text()
                self.assertIn("This study is not complete: 0 of ", page)
                self.assertNotIn("All runs gave a value", page)
                self.assertRegex(page, "Nothing is said of this yet|Nothing could be found yet|There are no effects yet")

    def test_a_study_that_was_stopped_shows_what_there_is(self) -> None:
        study = self.of('kind = "grid"', XY)
        self.assertFalse(study.run(First(9)))
        page = write_report(study)
        self.assertIn("There are no effects yet: 3 complete points", page.read_text())
        self.assertTrue((page.parent / "f_c-curves.png").exists())
        self.assertFalse(study.run(First(18)))
        page = write_report(study)
        self.assertIn("This study is not complete: 27 of 48 runs are done.", page.read_text())
        self.assertTrue((page.parent / "f_c-curves.png").exists())

    def test_an_earlier_report_leaves_nothing_behind(self) -> None:
        study = self.made('kind = "morris"\ntrajectories = 2', X)
        old = write_report(study).parent / "old.png"
        old.write_bytes(b"")
        write_report(study)
        self.assertFalse(old.exists())

    def test_runs_without_a_value_are_told_with_their_reasons(self) -> None:
        page = write_report(self.made('kind = "sobol"\nsamples = 8', FAILING)).read_text()
        self.assertIn("&lt;b&gt;no&lt;/b&gt; strength", page)
        self.assertIn("gave no value; see below", page)
        self.assertIn("of the rows miss a value: no indices", page)

    def test_one_seed_or_two_tell_nothing_from_the_seeds(self) -> None:
        for method, figure in (('kind = "morris"\ntrajectories = 3', "f_c-morris"), ("kind = \"lhs\"", "f_c-effects"),
                               ('kind = "sobol"\nsamples = 16', "f_c-indices")):
            with self.subTest(method):
                for count in (1, 2):
                    study = self.made(method, XY, seeds=count)
                    if count == 2:
                        page = write_report(study).read_text()
                        self.assertIn("With fewer than 3 seeds it is not known which effects", page)
                        self.assertIn("<td>unknown</td>", page)
                    self.assertNotIn(NOT_TOLD, _bars(self.figures(study)[figure].axes[0]).values())


class Figures(ReportTest):
    def test_seed_has_a_bar_and_what_is_not_told_is_grey(self) -> None:
        for name, figure in (("lhs", "f_c-effects"), ("morris", "f_c-morris"), ("sobol", "f_c-indices")):
            with self.subTest(name):
                drawn = self.figures(self.made(METHODS[name][0], X + DULL))[figure]
                bars = {bar: colour for axes in drawn.axes for bar, colour in _bars(axes).items()}
                seed = [bar for bar in bars if bar.startswith("seed, ")]
                self.assertEqual(seed, ["seed, mean of 3", "seed, single run"])
                self.assertEqual({bars[bar] for bar in seed}, {SEED})
                by_name = {bar.split()[0]: colour for bar, colour in bars.items()}
                self.assertEqual(by_name["dull"], NOT_TOLD)
                self.assertNotEqual(by_name["x"], NOT_TOLD)

    def test_bars_have_the_lengths_of_the_findings(self) -> None:
        study = self.made('kind = "morris"\ntrajectories = 4', XY)
        mu_star = study.findings["outputs"]["f_c"]["effects"]["mu_star"]
        axes = self.figures(study)["f_c-morris"].axes[0]
        drawn = sorted(patch.get_width() for patch in axes.patches if isinstance(patch, Rectangle))
        for length, found in zip(drawn, sorted(mu_star), strict=True):
            self.assertAlmostEqual(length, found, 12)

    def test_axes_have_names_and_units(self) -> None:
        drawn = self.figures(self.made('kind = "grid"', XY))
        self.assertEqual([axes.get_xlabel() for axes in drawn["f_c-curves"].axes], ["x [MPa]", "y"])
        self.assertEqual(drawn["f_c-curves"].axes[0].get_ylabel(), "f_c")
        self.assertEqual(drawn["f_c-curves"].axes[1].get_xscale(), "log")

    def test_integers_and_choices_are_classes_of_their_own(self) -> None:
        drawn = self.figures(self.made('kind = "lhs"\nsamples = 12', KIND + X))["f_c-curves"]
        of_curves = [[list(line.get_xdata()) for line in axes.lines] for axes in drawn.axes]
        self.assertIn([0.0, 1.0], of_curves[0])
        self.assertIn([1.0, 2.0, 3.0], of_curves[1])

    def test_curves_are_those_of_the_findings(self) -> None:
        study = self.made('kind = "lhs"\nsamples = 12', KIND + X)
        found = study.findings["outputs"]["f_c"]["curves"]
        self.assertEqual(found[0]["u"], [0.25, 0.75])
        for axes, curve in zip(self.figures(study)["f_c-curves"].axes, found, strict=True):
            self.assertIn(curve["mean"], [list(line.get_ydata()) for line in axes.lines])


class Texts(unittest.TestCase):
    def test_numbers_for_a_reader(self) -> None:
        self.assertEqual([number(None), number(math.nan), number(-0.123456, 2)], ["–", "–", "−0.12"])
        self.assertEqual([percent(0.256), percent(0.0123), percent(None)], ["26 %", "1.2 %", "–"])


def _bars(axes: Axes) -> dict[str, str]:
    """Colour by the name at which a bar lies; the last of several."""
    names = {round(tick): label.get_text() for tick, label in zip(axes.get_yticks(), axes.get_yticklabels())}
    return {names[round(patch.get_y() + 0.5 * patch.get_height())]: to_hex(patch.get_facecolor())
            for patch in axes.patches if isinstance(patch, Rectangle)}


if __name__ == "__main__":
    unittest.main()
