"""Stages written in Python."""

import json
from typing import Any

import numpy as np

import pyroclast
from small import CASES, Case


class Shake(pyroclast.Stage):
    """Moves the platen up and down about its place."""

    kind = "shake"
    columns = {"turn": "1"}
    velocity = pyroclast.Key("m/s", "of the platen")
    half_period = pyroclast.Key("integer", "steps between two turns", 200)

    def __init__(self):
        self.steps = 0

    @property
    def turn(self) -> int:
        return self.steps // self.half_period

    def begin(self, body):
        body.drive(0.0)

    def advance(self, body, most_steps):
        body.drive(-self.velocity if self.turn % 2 == 0 else self.velocity)
        count = min(self.half_period - self.steps % self.half_period, most_steps)
        body.advance(count)
        self.steps += count
        return self.steps % self.half_period == 0

    def judge(self, body):
        return pyroclast.Verdict(over=self.turn == 6)

    def values(self):
        return [float(self.turn)]

    def results(self):
        return {"turns": float(self.turn)}

    def state(self) -> dict[str, Any]:
        return {"steps": self.steps}

    def take_state(self, state):
        self.steps = state["steps"]


class Mute(Shake):
    kind = "mute"

    def state(self):
        return None


class Failing(Shake):
    kind = "failing"

    def advance(self, body, most_steps):
        raise ZeroDivisionError("mine")


class Short(Shake):
    kind = "short"

    def values(self):
        return []


def deck(stage: type[Shake], **keys) -> pyroclast.Deck:
    made = pyroclast.Deck(CASES / "starter.toml", stages_in_python=[stage])
    for key, value in {"blocks.count": 100, "stages[1].stop_strain": 1e-4, "output.fields": False}.items():
        made[key] = value
    return made.append("stages", **{"kind": stage.kind, "velocity": "1 mm/s", **keys})


class Stages(Case):
    def test_a_stage_runs_with_its_keys_columns_and_results(self):
        run = pyroclast.Run(deck(Shake, half_period=150), threads=1).finish()
        mine = run.history["stage"] == 2
        np.testing.assert_array_equal(run.history["turn"][mine], [1, 2, 3, 4, 5, 6])
        self.assertTrue(np.isnan(run.history["turn"][~mine]).all())
        np.testing.assert_array_equal(np.diff(run.history["step"][mine]), 150)
        self.assertEqual(run.results["turns"], 6.0)
        strain = run.history["strain"][mine]
        self.assertLess(strain[0], strain[1])
        self.assertGreater(strain[1], strain[2])

    def test_its_keys_are_checked_like_any_other(self):
        for keys, told in (({"velocity": "1 mm"}, r"stages\[2\].velocity"), ({"colour": "red"}, "colour"),
                           ({"velocity": 1.0}, "a unit of velocity")):
            with self.assertRaisesRegex(pyroclast.DeckError, told):
                pyroclast.Run(deck(Shake, **keys))
        with self.assertRaisesRegex(pyroclast.DeckError, "shake"):
            made = pyroclast.Deck(CASES / "starter.toml")
            made.append("stages", kind="shake", velocity="1 mm/s").check()

    def test_a_copy_in_its_middle_goes_on_from_its_state(self):
        run = pyroclast.Run(deck(Shake), threads=1)
        run.until(lambda state: state.turn >= 2)
        copied = run.copy()
        np.testing.assert_array_equal(copied.finish().history.to_pandas(), run.finish().history.to_pandas())
        self.assertEqual(copied.results["turns"], 6.0)

    def test_a_checkpoint_in_its_middle_resumes_with_the_class(self):
        out = self.folder() / "run"
        run = pyroclast.Run(deck(Shake), out=out, threads=1)
        run.until(lambda state: state.turn >= 2)
        run.checkpoint()
        straight = run.finish().history.to_pandas()
        whole = (out / "history.csv").read_bytes()
        checkpoint = sorted((out / "checkpoints").glob("0*.state"))[-1]
        (out / "summary.json").unlink()
        del run
        resumed = pyroclast.Run.resume(out, checkpoint=checkpoint, stages_in_python=[Shake], threads=1).finish()
        self.assertEqual((out / "history.csv").read_bytes(), whole)
        np.testing.assert_array_equal(resumed.history.to_pandas(), straight)

    def test_without_a_state_its_middle_cannot_be_copied(self):
        run = pyroclast.Run(deck(Mute), threads=1)
        run.until(lambda state: state.turn >= 1)
        with self.assertRaisesRegex(pyroclast.Error, "does not tell its state"):
            run.copy()
        run.finish()
        self.assertEqual(run.outcome, "completed")
        self.assertEqual(run.copy().history.rows, run.history.rows)

    def test_its_runs_say_that_they_need_the_script(self):
        out = self.folder() / "run"
        run = pyroclast.Run(deck(Shake), out=out, threads=1).finish()
        self.assertTrue(any("written in Python" in line for line in run.summary["warnings"]))
        (said,) = json.loads((out / "manifest.json").read_text())["not_reproducible_from_the_deck"]
        self.assertIn("shake", said["why"])

    def test_what_it_raises_ends_the_run(self):
        run = pyroclast.Run(deck(Failing), threads=1)
        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            run.finish()
        with self.assertRaisesRegex(pyroclast.Error, "ended by an error"):
            run.next()
        self.assertGreater(run.history.rows, 2)
        with self.assertRaisesRegex(pyroclast.Error, "0 numbers for 1 columns"):
            pyroclast.Run(deck(Short), threads=1).finish()

    def test_the_body_is_lent_for_a_call(self):
        kept = []

        class Keeps(Shake):
            kind = "keeps"

            def begin(self, body):
                kept.append(body)

        pyroclast.Run(deck(Keeps), threads=1).finish()
        with self.assertRaisesRegex(pyroclast.Error, "lent"):
            kept[0].strain
