"""Promise: scripts and frames see the contacts that are found, with the forces that they bear."""

import tempfile
import unittest
from pathlib import Path

import numpy as np
import pandas
import pyroclast

CASES = Path(__file__).resolve().parents[2] / "cases"
FRICTION = 0.3  # of the plate
PLATE_AT = -1e-3  # m


def fallen(case: str, out: Path) -> pyroclast.Run:
    """A run of few blocks without weight and damping, just before they hit the plate."""
    deck = pyroclast.Deck(CASES / f"{case}.toml")
    for key, value in {"blocks.count": 60, "contacts.found.damping": 0.0, "mechanics.gravity": "0 m/s2",
                       "stages[0].duration": "1 ms", "stages[0].frame_interval": "0.1 ms"}.items():
        deck[key] = value
    return pyroclast.Run(deck, out=out, threads=1)


class Found(unittest.TestCase):
    def check_points(self, found: pandas.DataFrame, axes: str) -> None:
        """What each point says of itself holds together."""
        normal = found[[f"normal_{axis}" for axis in axes]].to_numpy()
        force = found[[f"force_{axis}_N" for axis in axes]].to_numpy()
        area = found["area_m2"].to_numpy()
        self.assertTrue((area > 0.0).all())
        np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-12)
        pressed = found["normal_traction_Pa"] * area
        np.testing.assert_allclose((force * normal).sum(axis=1), pressed, rtol=1e-9, atol=1e-9)
        self.assertTrue((found["stored_J_m2"] >= 0.0).all())
        self.assertTrue((found["block_a"] != found["block_b"]).all())
        if axes == "xyz":
            self.assertTrue((found["tangential_jump_m"] >= 0.0).all())  # the size of a vector along the facets
            self.assertTrue((found["shear_traction_Pa"] >= 0.0).all())

    def check_on_plate(self, meets: pandas.DataFrame, run: pyroclast.Run, axes: str) -> None:
        """Points on the plate lie midway between it and the block that presses it, rub by its friction, and bear
        together the force on it.
        """
        self.assertTrue((np.abs(meets["y_m"] - PLATE_AT) <= 0.5 * np.abs(meets["opening_m"]) + 1e-9).all())
        held = -FRICTION * meets["normal_traction_Pa"]
        self.assertTrue((meets["shear_traction_Pa"].abs() <= held * (1.0 + 1e-9)).all())
        # zones of a block add none to the force on it; the change of areas adds some 4 % in space
        force = -meets[[f"force_{axis}_N" for axis in axes]].to_numpy().sum(axis=0)
        on_plate = run.fields.force[run.sets["plate"]].sum(axis=0)
        np.testing.assert_allclose(force, on_plate, atol=(0.01 if axes == "xy" else 0.05) * np.abs(on_plate).max())

    def test_arrays_and_frames_hold_what_presses(self):
        for case, axes in (("drop", "xy"), ("drop_3d", "xyz")):
            with self.subTest(case), tempfile.TemporaryDirectory() as name:
                run = fallen(case, Path(name) / "run")
                # nothing touches yet; corners of neighbours on the outline of a solid do by rounding
                before = run.found_contacts()
                self.assertLess(np.abs(before["normal_traction_Pa"]).sum(), 1e-3)
                plate, seen = run.zone_block.max(), []
                for _ in run:
                    found = run.found_contacts()
                    seen.append(found)
                    self.check_points(found, axes)
                    self.check_on_plate(found[found["block_b"] == plate], run, axes)
                self.assertGreater(max((found["block_b"] == plate).sum() for found in seen), 0)
                self.assertGreater(max((found["face"] >= 0).sum() for found in seen), 0)  # pieces have parted
                results = pyroclast.read(Path(name) / "run")
                kept = pyroclast.found_contacts(results, results.frames[-1])
                self.assertEqual(list(kept), [column for column in seen[-1] if column != "stored_J_m2"])
                for column in kept:
                    if kept[column].dtype == object:
                        self.assertEqual(list(kept[column]), list(seen[-1][column]))
                    else:
                        np.testing.assert_allclose(kept[column], seen[-1][column], rtol=1e-6, atol=1e-12)
                run.finish()


if __name__ == "__main__":
    unittest.main()
