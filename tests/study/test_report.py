"""The page and figures of a study."""

import unittest

from pyroclast.study.report import write_report
from study_files import StudyTest

TWO = "[parameters.x]\nuniform = [0, 1]\n[parameters.y]\nuniform = [0, 2]\n"


class Report(StudyTest):
    def page(self, method: str, parameters: str = TWO, study: str = "seeds = 2", runs: bool = True, rest: str = "") -> str:
        made = self.study('title = "A <script> & more"\n' + self.of_function(method, parameters, study, rest))
        if runs:
            self.assertTrue(made.run(jobs=1))
        page = write_report(made)
        self.figures = sorted(file.name for file in page.parent.glob("*.png"))
        for figure in self.figures:
            self.assertGreater((page.parent / figure).stat().st_size, 2000, figure)
            self.assertTrue((page.parent / figure).with_suffix(".pdf").exists(), figure)
        return page.read_text()

    def test_methods_have_figures_and_a_page(self) -> None:
        for method in ('kind = "lhs"\nsamples = 12', 'kind = "morris"\ntrajectories = 4', 'kind = "grid"',
                       'kind = "sobol"\nsamples = 16'):
            with self.subTest(method):
                page = self.page(method, study=f"seeds = 2\nfolder = '{method.split()[2][1:-1]}'")
                self.assertTrue(self.figures)
                self.assertNotIn("<script>", page)
                self.assertIn("A &lt;script&gt; &amp; more", page)
                self.assertIn("seed", page)

    def test_an_ensemble(self) -> None:
        self.page('kind = "ensemble"', "# none", "seeds = 6")
        self.assertTrue(self.figures)

    def test_a_study_that_is_not_complete_says_so(self) -> None:
        page = self.page('kind = "lhs"\nsamples = 12', runs=False)
        self.assertIn("not complete", page)


if __name__ == "__main__":
    unittest.main()
