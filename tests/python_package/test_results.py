"""Results that are read from the folder of a run: they say what the run says, and the fields fit together."""

import subprocess
import unittest

import numpy as np
from small import CASES, COMPRESSED, PROGRAM, Case, deck, plate

import pyroclast

ALIKE = ("title", "outcome", "stages", "results", "deck_text", "deck", "moves", "folder")


class ResultsOfRuns(Case):
    def test_a_run_and_its_results_say_the_same_by_the_same_names(self):
        for made in (deck(), plate()):
            with pyroclast.Run(made, out=self.folder() / "run", threads=1) as run:
                run.finish()
            results = pyroclast.read(run.folder)
            for name in ALIKE:
                self.assertEqual(getattr(results, name), getattr(run, name), name)
            self.assertEqual(results.summary.keys(), run.summary.keys())
            self.assertEqual(results.history.units, run.history.units)
            self.assertEqual(set(results.history._names.bare), set(run.history._names.bare))
            np.testing.assert_array_equal(results.history["stress" if "stress_MPa" in run.history else "pull"],
                                          run.history["stress" if "stress_MPa" in run.history else "pull"])
            ours, theirs = results.to_pandas(), run.to_pandas()
            np.testing.assert_array_equal(ours, theirs)
            self.assertEqual(ours.attrs, theirs.attrs)

    def test_stress_of_the_blocks_carries_the_load_that_the_platens_measure(self):
        folder = self.folder() / "run"
        changes = [f"--set={key}={value}" for key, value in (COMPRESSED | {"output.fields": "true"}).items()]
        subprocess.run([PROGRAM, "run", CASES / "starter.toml", *changes, "--out", folder, "--threads", "1", "--quiet",
                        "--no-figures"], check=True)
        results = pyroclast.read(folder)
        blocks = results.block_fields
        weights = blocks["area"].where(~blocks["bearing"], 0.0)
        mean = blocks["stress"].sel(tensor="yy").weighted(weights).mean("block")
        last = mean.isel(frame=-1)
        # both are the load over the section, but for inertia, which the quasi-static test keeps small
        np.testing.assert_allclose(-last, last["test_stress"], rtol=1e-4)
        self.assertAlmostEqual(float(last["test_stress"]), results.history["stress"][-1], delta=1.0)
        of_zones = results.fields["stress"].isel(frame=-1).sel(tensor="yy")
        area = of_zones["area"].where(~of_zones["bearing"], 0.0)
        np.testing.assert_allclose(of_zones.weighted(area).mean(), last, rtol=1e-6)

    def test_fields_are_those_of_the_run_at_its_end(self):
        run = pyroclast.Run(deck(output__fields=True), out=self.folder() / "run", threads=1).finish()
        last = pyroclast.read(run.folder).fields.isel(frame=-1)
        np.testing.assert_array_equal(last["position"], run.position)
        np.testing.assert_array_equal(last["zones"], run.zones)
        np.testing.assert_array_equal(last["block"], run.zone_block)
        self.assertEqual(last["material"].values.tolist(),
                         [run.material_names[i] for i in run.block_material[run.zone_block]])
        self.assertEqual(int(last["step"]), run.step)
        # files have numbers of 32 bits
        np.testing.assert_allclose(last["displacement"], run.fields.displacement, rtol=1e-6, atol=1e-30)
        np.testing.assert_allclose(last["stress"].sel(tensor=["xx", "yy", "xy"]), run.fields.stress[:, [0, 1, 3]], rtol=1e-6, atol=1e-20)
        np.testing.assert_allclose(last["temperature"], run.fields.temperature, rtol=1e-6)
        contacts = run.contacts()
        self.assertEqual(last["interface"].values.tolist(), contacts["interface"].tolist())
        np.testing.assert_allclose(last["opening"], contacts["opening_m"], rtol=1e-6, atol=1e-30)
        np.testing.assert_allclose(last["normal_traction"], contacts["normal_traction_Pa"], rtol=1e-6, atol=1e-20)
        np.testing.assert_allclose(last["contact_position"].sel(end="corner"), contacts[["x_m", "y_m"]], atol=1e-12)
        run.close()


if __name__ == "__main__":
    unittest.main()
