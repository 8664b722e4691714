"""No result depends on the layout of a body in memory. LAYOUT_RUN names the program of layout_run.cpp."""

import importlib.machinery
import importlib.util
import os
import pathlib
import tempfile
import types
import unittest
from unittest import mock

SCRIPT = pathlib.Path(__file__).parents[2] / "validation" / "reference"
loader = importlib.machinery.SourceFileLoader("reference", str(SCRIPT))
reference = importlib.util.module_from_spec(importlib.util.spec_from_loader("reference", loader))
loader.exec_module(reference)

CASES = ["starter", "transient_heating", "fire_one_side"]


class Layout(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_with(self, fewest_blocks: int, chunk_blocks: int) -> dict:
        options = types.SimpleNamespace(cases="small", only=CASES, changes=[], jobs=2)
        out = self.folder / f"{fewest_blocks}-{chunk_blocks}.json"
        with mock.patch.dict(os.environ, {"FEWEST_BLOCKS": str(fewest_blocks),
                                          "PYROCLAST_CHUNK_BLOCKS": str(chunk_blocks)}):
            reference.make(options, out, os.environ["LAYOUT_RUN"])
        return reference.read(out)

    def test_bundles_and_chunks_change_sums_only(self):
        usual = self.run_with(4, 1024)
        for fewest, chunk in ((1, 1024), (9, 1024), (4, 128), (4, 30), (4, 100000)):
            other = self.run_with(fewest, chunk)
            for case in CASES:
                with self.subTest(fewest=fewest, chunk=chunk, case=case):
                    self.assertEqual(reference.compare_case(usual, other, case)[0], [])


if __name__ == "__main__":
    unittest.main()
