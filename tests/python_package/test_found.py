"""Promise: scripts and frames see the contacts that are found, with the forces that they bear."""

import tempfile
import unittest
from pathlib import Path

import numpy as np
import pyroclast

CASES = Path(__file__).resolve().parents[2] / "cases"


class Found(unittest.TestCase):
    def test_arrays_and_frames_hold_what_presses(self):
        deck = pyroclast.Deck(CASES / "drop.toml")
        for key, value in {"blocks.count": 60, "contacts.found.damping": 0.0, "mechanics.gravity": "0 m/s2",
                           "stages[0].duration": "1 ms", "stages[0].frame_interval": "0.1 ms"}.items():
            deck[key] = value
        with tempfile.TemporaryDirectory() as name:
            run = pyroclast.Run(deck, out=Path(name) / "run", threads=1)
            self.assertEqual(len(run.found_contacts()), 0)  # nothing touches yet
            seen = []
            for _ in run:
                found = run.found_contacts()
                plate = run.zone_block.max()
                meets = found[found["block_b"] == plate]
                seen.append(found)
                # zones of a block add none to the force on it
                force = -meets[["force_x_N", "force_y_N"]].to_numpy().sum(axis=0)
                on_plate = run.fields.force[run.sets["plate"]].sum(axis=0)
                np.testing.assert_allclose(force, on_plate, atol=0.01 * np.abs(on_plate).max())
            self.assertGreater(max(len(found) for found in seen), 0)
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
