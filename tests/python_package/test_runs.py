"""Runs in this process: the program's run, looked at, stopped, changed, copied and gone on with."""

import contextlib
import gc
import json
import os
import pathlib
import signal
import subprocess
import threading
import time

import h5py
import numpy as np

import pyroclast
from pyroclast import MPa
from small import CASES, PROGRAM, Case, deck

COOLED = {"blocks.count": 100, "stages[1].ramp_time": "20 ms", "stages[2].to": "40 degC",
          "coupling.least_cycles": 200, "coupling.most_cycles": 400, "output.fields": False}


def heated() -> pyroclast.Deck:
    made = pyroclast.Deck(CASES / "transient_heating.toml")
    for key, value in COOLED.items():
        made[key] = value
    return made


def history(folder: pathlib.Path) -> bytes:
    return (folder / "history.csv").read_bytes()


class BodyOfAFolder(Case):
    """A body that the program made before, in the place of one that the run makes."""

    def made(self, of: pyroclast.Deck) -> pathlib.Path:
        folder = self.folder()
        of.save(folder / "deck.toml")
        subprocess.run([PROGRAM, "specimen", "deck.toml", "--out", "body", "--no-figures"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        return folder / "body"

    def test_gives_the_bytes_of_a_run_that_makes_its_body(self):
        """In the plane and in space, and of blocks that a script states."""
        solid = deck("starter_3d", blocks__count=60)
        solid["stages[1].stop_strain"] = 1e-4
        stated = deck()
        stated["specimen"] = deck().make_specimen()
        for name, of in (("plane", deck(output__fields=True)), ("solid", solid), ("stated", stated)):
            with self.subTest(name):
                folder, body = self.folder(), self.made(of)
                pyroclast.Run(of, out=folder / "made", threads=1).finish()
                pyroclast.Run(of, out=folder / "read", threads=1, body=body).finish()
                files = {path.relative_to(folder / "made") for path in (folder / "made").rglob("*") if path.is_file()}
                self.assertIn(pathlib.Path("history.csv"), files)
                for file in files:
                    if file.parts[0] not in ("checkpoints", "manifest.json", "summary.json", "deck.toml", "inputs"):
                        self.assertEqual((folder / "made" / file).read_bytes(), (folder / "read" / file).read_bytes(), file)
                self.assertEqual(json.loads((folder / "read/manifest.json").read_text())["body"]["folder"], str(body))

    def test_is_read_again_by_copies_and_resumed_runs(self):
        folder, body = self.folder(), self.made(deck())
        whole = pyroclast.Run(deck(), out=folder / "whole", threads=1).finish()
        run = pyroclast.Run(deck(), out=folder / "run", threads=1, body=body)
        run.until(strain=1e-4)
        copied = run.copy()
        run.checkpoint()
        del run
        for other in (copied, pyroclast.Run.resume(folder / "run", threads=1)):
            other.finish()
            np.testing.assert_array_equal(other.history["stress"], whole.history["stress"])

    def test_is_refused_where_it_is_of_other_inputs_or_not_there(self):
        body = self.made(deck())
        for call, named in ((lambda: pyroclast.Run(deck(), seed=2, body=body), "specimen.seed was 1, and is 2 here"),
                            (lambda: pyroclast.Run(deck(blocks__count=130), body=str(body)),
                             "blocks.count was 120, and is 130 here"),
                            (lambda: pyroclast.Run(deck(), body=body / "none"), "none/body.h5: there is no body")):
            with self.assertRaises(pyroclast.Error) as caught:
                call()
            self.assertIn(named, str(caught.exception))
            self.assertNotIn("--", str(caught.exception))

    def test_does_not_hold_the_specimen(self):
        run = pyroclast.Run(deck(), threads=1, body=self.made(deck()))
        with self.assertRaisesRegex(pyroclast.Error, "does not hold its specimen; Deck.make_specimen makes it"):
            _ = run.specimen


class Results(Case):
    def test_a_run_writes_what_the_program_writes(self):
        folder = self.folder()
        deck(output__fields=True).save(folder / "deck.toml")
        subprocess.run([PROGRAM, "run", "deck.toml", "--out", "program", "--no-figures", "--quiet", "--threads", "1"],
                       cwd=folder, check=True)
        run = pyroclast.Run(folder / "deck.toml", out=folder / "script", threads=1)
        looks = sum(1 for _ in run)
        written = {path.relative_to(folder / "program") for path in (folder / "program").rglob("*") if path.is_file()}
        mine = {path.relative_to(folder / "script") for path in (folder / "script").rglob("*") if path.is_file()}
        self.assertEqual(written - mine, {pathlib.Path("run.log")})
        for name in ("history.csv", "deck.toml", "fields/frames.csv", "specimen/aggregates.csv"):
            self.assertEqual((folder / "program" / name).read_bytes(), (folder / "script" / name).read_bytes(), name)
        self.assertEqual(looks, history(folder / "script").count(b"\n") - 1)
        manifest = json.loads((folder / "script" / "manifest.json").read_text())
        self.assertEqual((manifest["version"], manifest["commit"]), (pyroclast.version, pyroclast.commit))
        summaries = [json.loads((folder / name / "summary.json").read_text()) for name in ("program", "script")]
        for summary in summaries:
            del summary["wall_time_s"]
        self.assertEqual(*summaries)

    def test_history_and_state_have_the_columns_of_the_program(self):
        run = pyroclast.Run(deck(), threads=1)
        state = run.until(strain=1e-4)
        table = run.history
        self.assertEqual(table.units["stress_MPa"], "MPa")
        self.assertAlmostEqual(state.stress, 1e6 * state["stress_MPa"])
        self.assertEqual(table["stress_MPa"][-1], state["stress_MPa"])
        self.assertAlmostEqual(table["stress"][-1], state.stress)
        self.assertEqual(len(table["step"]), table.rows)
        self.assertEqual(table["step"][-1], state.step)
        self.assertIn("no 'colour'", self.message(lambda: state.colour, AttributeError))
        frame = run.to_pandas()
        self.assertEqual(list(frame.columns), list(table))
        self.assertEqual(frame["strain"].iloc[-1], state.strain)

    def message(self, call, kind) -> str:
        with self.assertRaises(kind) as caught:
            call()
        return str(caught.exception)

    def test_a_state_that_is_past_raises_and_a_copy_lasts(self):
        run = pyroclast.Run(deck(), threads=1)
        first = run.next()
        kept = first.copy()
        strain = first.strain
        run.next()
        with self.assertRaisesRegex(pyroclast.Error, "earlier sample"):
            first.strain
        self.assertEqual(kept.strain, strain)

    def test_results_tell_of_the_stages(self):
        run = pyroclast.Run(deck(**{"stages[1].stop_strain": 6e-3}), threads=1).finish()
        self.assertEqual(run.outcome, "the stress fell below the stated fraction of the peak")
        self.assertAlmostEqual(run.results["stress_max_MPa"], run.history["stress_MPa"].max(), places=6)
        self.assertEqual([stage["kind"] for stage in run.summary["stages"]], ["settle", "compress"])


class Going(Case):
    def test_until_stops_at_the_first_look_behind(self):
        run = pyroclast.Run(deck(), threads=1)
        state = run.until(strain=1e-4)
        strains = run.history["strain"]
        self.assertGreaterEqual(strains[-1], 1e-4)
        self.assertLess(strains[-2], 1e-4)
        self.assertGreaterEqual(run.until(stress=4 * MPa).stress, 4e6)
        self.assertGreaterEqual(run.until(quantity={"stress_MPa": 5.0})["stress_MPa"], 5.0)
        with self.assertRaisesRegex(pyroclast.Error, "ended .completed. before"):
            run.until(strain=0.5)
        with self.assertRaisesRegex(pyroclast.Error, "until needs a condition"):
            run.until()
        with self.assertRaisesRegex(pyroclast.Error, "no 'streß'"):
            run.until(quantity={"streß": 1.0})
        self.assertTrue(run.is_over)

    def test_until_a_number_of_steps_comes_to_the_step_and_changes_nothing(self):
        straight = pyroclast.Run(deck(), threads=1).finish()
        broken = pyroclast.Run(deck(), threads=1)
        broken.next()
        for steps in (1, 7, 433, 2000):
            before = broken.step
            self.assertEqual(broken.until(steps=steps).step, before + steps)
        broken.finish()
        np.testing.assert_array_equal(broken.history.to_pandas(), straight.history.to_pandas())

    def test_steps_that_were_not_reached_stop_nothing_later(self):
        run = pyroclast.Run(deck(), threads=1)
        before = run.until(strain=2e-5, steps=6000).step
        self.assertLess(before, 6000)
        run.finish()
        self.assertEqual(run.outcome, "completed")

    def test_until_equilibrium(self):
        run = pyroclast.Run(deck(), threads=1)
        self.assertLess(run.until(equilibrium=1e-2).unbalanced_ratio, 1e-2)

    def test_call_backs_come_at_looks_and_every_so_many_steps(self):
        run = pyroclast.Run(deck(), threads=1)
        looks, steps = [], []
        run.at_looks(lambda r: looks.append(r.history.rows))
        run.every(700, lambda r: steps.append(r.step) or r.measure().strain + r.history["strain"][-1])
        run.finish()
        self.assertEqual(looks, list(range(1, run.history.rows + 1)))
        self.assertEqual(steps, list(range(700, run.step + 1, 700)))

    def test_an_observer_is_begun_told_of_every_look_and_finished(self):
        class Keeps(pyroclast.Observer):
            def __init__(self):
                self.seen = []

            def begin(self, run):
                self.seen.append("begin")

            def look(self, run, state):
                self.seen.append(state.strain)

            def finish(self, run):
                self.seen.append(run.outcome)

        run, observer = pyroclast.Run(deck(), threads=1), Keeps()
        run.add_observer(observer)
        run.finish()
        self.assertEqual((observer.seen[0], observer.seen[-1]), ("begin", "completed"))
        np.testing.assert_array_equal(observer.seen[1:-1], run.history["strain"])

    def test_an_exception_of_a_call_back_is_raised_and_the_run_goes_on(self):
        run = pyroclast.Run(deck(), threads=1)

        def fails(_):
            raise ValueError("mine")

        run.call_at(2500, fails)
        with self.assertRaisesRegex(ValueError, "mine"):
            run.finish()
        self.assertEqual(run.step, 2500)
        run.finish()
        self.assertEqual(run.outcome, "completed")
        np.testing.assert_array_equal(run.history["stress_MPa"],
                                      pyroclast.Run(deck(), threads=1).finish().history["stress_MPa"])

    def test_a_call_back_between_steps_changes_nothing(self):
        run = pyroclast.Run(deck(), threads=1)
        run.call_at(2500, lambda r: r.change({"stages[1].stop_strain": 2e-4}))
        with self.assertRaisesRegex(pyroclast.Error, "change the run after it has stopped"):
            run.finish()
        run.finish()
        self.assertEqual(run.outcome, "completed")

    def test_a_call_back_can_stop_the_run(self):
        run = pyroclast.Run(deck(), threads=1)
        run.call_at(3000, lambda r: r.stop())
        run.finish()
        self.assertEqual((run.step, run.outcome), (3000, "stopped"))
        run.finish()
        self.assertEqual(run.outcome, "completed")

    def test_a_stop_at_a_look_is_heard_too(self):
        run = pyroclast.Run(deck(), threads=1)
        run.at_looks(lambda r: r.stop() if r.history.rows == 20 else None)
        self.assertEqual(sum(1 for _ in run), 20)
        self.assertEqual(run.outcome, "stopped")
        run.finish()
        self.assertEqual(run.outcome, "completed")

    def test_ctrl_c_stops_between_batches(self):
        out = self.folder() / "run"
        run = pyroclast.Run(deck(), out=out, threads=1)
        run.next()
        run.call_at(3000, lambda r: os.kill(os.getpid(), signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt):
            run.finish()
        self.assertGreaterEqual(run.step, 3000)
        self.assertEqual(json.loads((out / "summary.json").read_text())["outcome"], "stopped")
        self.assertTrue(list((out / "checkpoints").glob("*.state")))
        run.finish()
        self.assertEqual(run.outcome, "completed")
        self.assertEqual(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_another_thread_counts_on_while_a_run_advances(self):
        run = pyroclast.Run(deck(blocks__count=600), threads=1)
        run.next()
        counted, ends = [0], threading.Event()

        def count():
            while not ends.is_set():
                counted[0] += 1
                time.sleep(0.0005)

        counter = threading.Thread(target=count)
        counter.start()
        before = counted[0]
        began = time.monotonic()
        run.until(steps=4000)
        took = time.monotonic() - began
        gained = counted[0] - before
        ends.set()
        counter.join()
        self.assertGreater(gained, took / 0.0005 * 0.05)

    def test_stepping_belongs_to_one_thread(self):
        run = pyroclast.Run(deck(), threads=1)
        said = []

        def also(_):
            other = threading.Thread(target=lambda: said.append(_error(run.next)))
            other.start()
            other.join()

        run.call_at(1000, also)
        run.until(steps=2000)
        self.assertIn("another thread", said[0])

    def test_several_runs_take_turns(self):
        runs = [pyroclast.Run(deck(), seed=seed, threads=1) for seed in (1, 2)]
        stresses = [[], []]
        for states in zip(*runs):
            for stress, state in zip(stresses, states):
                stress.append(state.stress)
        self.assertNotEqual(*stresses)
        alone = pyroclast.Run(deck(), seed=2, threads=1).finish().history["stress"]
        np.testing.assert_array_equal(stresses[1], alone[:len(stresses[1])])


def _error(call) -> str:
    try:
        call()
    except pyroclast.Error as error:
        return str(error)
    return ""


class Changing(Case):
    def test_a_copy_in_the_middle_of_a_stage_goes_the_same_way(self):
        run = pyroclast.Run(heated(), threads=1)
        run.until(lambda state: state.stage == 2 and state.temperature > 25.0)
        copied = run.copy()
        np.testing.assert_array_equal(copied.finish().history.to_pandas(), run.finish().history.to_pandas())

    def test_a_copy_with_another_fire_is_the_run_of_that_deck(self):
        parent = pyroclast.Run(heated(), threads=1)
        while parent.summary["stages"][1]["outcome"] != "completed":
            parent.next()
        folder = self.folder()
        for to in ("30 degC", "36 degC"):
            other = heated()
            other["stages[2].to"] = to
            whole = pyroclast.Run(other, out=folder / f"whole {to}", threads=1).finish()
            copied = parent.copy({"stages[2].to": to}, out=folder / f"copy {to}").finish()
            self.assertEqual(history(folder / f"whole {to}"), history(folder / f"copy {to}"))
            self.assertEqual(copied.history["temperature"].max(), whole.history["temperature"].max())
        with self.assertRaisesRegex(pyroclast.Error, "the parent has done this stage"):
            parent.copy({"stages[0].most_steps": 10})

    def test_a_stage_that_is_appended_gives_the_run_of_the_whole_deck(self):
        unload = dict(velocity="0.8 mm/s", ramp_time="20 ms", to_stress="1 MPa")
        folder = self.folder()
        whole = deck()
        whole.append("stages", kind="compress", **unload)
        pyroclast.Run(whole, out=folder / "whole", threads=1).finish()
        run = pyroclast.Run(deck(), out=folder / "script", threads=1).finish()
        run.then("compress", **unload).finish()
        self.assertEqual(history(folder / "whole"), history(folder / "script"))
        self.assertLess(run.measure().stress, 1.1e6)
        again = pyroclast.Run(folder / "script" / "deck.toml", threads=1).finish()
        np.testing.assert_array_equal(again.history["stress"], run.history["stress"])

    def test_a_stage_can_be_ended_and_the_summary_says_so(self):
        out = self.folder() / "run"
        run = pyroclast.Run(deck(), out=out, threads=1)
        run.until(stress=3 * MPa)
        run.end_stage()
        run.then("compress", velocity="0.8 mm/s", ramp_time="20 ms", to_stress="0.5 MPa").finish()
        self.assertLess(run.history["stress"][-1], 0.6e6)
        self.assertTrue(any("not reproducible from the deck" in line for line in run.summary["warnings"]))
        self.assertIn("not_reproducible_from_the_deck", json.loads((out / "manifest.json").read_text()))
        del run
        gc.collect()
        with self.assertRaisesRegex(pyroclast.Error, "only the script"):
            pyroclast.Run.resume(out)

    def test_later_stages_change_and_take_their_columns_along(self):
        run = pyroclast.Run(heated(), threads=1)
        run.until(strain=1e-5)
        self.assertIn("exchange", run.history)
        run.change({"stages[2].to": "30 degC"}).finish()
        self.assertAlmostEqual(run.history["temperature"].max(), 30.0)
        whole = heated()
        whole["stages[2].to"] = "30 degC"
        straight = pyroclast.Run(whole, threads=1).finish()
        np.testing.assert_array_equal(run.history.to_pandas(), straight.history.to_pandas())
        with self.assertRaisesRegex(pyroclast.Error, "the parent has done this stage"):
            run.change({"stages[2].to": "50 degC"})

    def test_a_stage_can_be_ended_where_it_was_stopped(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=1e-4)
        run.until(steps=17)
        run.end_stage().then("compress", velocity="0.8 mm/s", ramp_time="20 ms", to_stress="0.5 MPa").finish()
        self.assertEqual(run.outcome, "completed")
        self.assertLess(run.history["stress"][-1], 0.6e6)

    def test_materials_change_and_energy_is_accounted(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=1.5e-4)
        stiff = np.polyfit(run.history["strain"][-6:], run.history["stress"][-6:], 1)[0]
        run.change({"materials.mortar.E": "15 GPa"})
        run.until(strain=2.5e-4)
        soft = np.polyfit(run.history["strain"][-6:], run.history["stress"][-6:], 1)[0]
        self.assertLess(soft, 0.9 * stiff)
        self.assertLess(run.history["energy_property_change_J"][-1], 0.0)
        self.assertLess(abs(run.summary["energy_J"]["error_over_turnover"]), 0.005)
        for change, told in (({"materials.mortar.density": "2000 kg/m3"}, "density"),
                             ({"specimen.width": "1 m"}, "before the end of stage")):
            with self.assertRaisesRegex(pyroclast.Error, told):
                run.change(change)
        with self.assertRaises(pyroclast.DeckError):
            run.change({"materials.mortar.E": "15 mm"})
        run.finish()

    def test_the_temperature_can_be_set(self):
        run = pyroclast.Run(heated(), threads=1)
        run.until(strain=1e-5)
        before = run.history["temperature"][-1]
        run.set_temperature("30 degC")
        self.assertEqual((before, run.measure().temperature), (20.0, 30.0))
        self.assertAlmostEqual(float(run.fields.temperature.max()), 30.0)
        run.next()

    def test_a_run_that_is_closed_leaves_its_folder(self):
        out = self.folder() / "run"
        with pyroclast.Run(deck(), out=out, threads=1) as run:
            run.until(strain=1e-4)
            view = run.views.displacement
        self.assertEqual(json.loads((out / "summary.json").read_text())["outcome"], "running")
        with self.assertRaisesRegex(pyroclast.Error, "closed"):
            run.next()
        np.testing.assert_array_equal(view[run.slot], run.fields.displacement)
        pyroclast.Run.resume(out, threads=1).finish()

    def test_a_folder_that_exists_or_is_held_is_told_in_words_of_a_script(self):
        out = self.folder() / "run"
        with pyroclast.Run(deck(), out=out, threads=1) as run:
            with self.assertRaisesRegex(pyroclast.Error, "another run of this process .*; close that run"):
                pyroclast.Run(deck(), out=out, threads=1)
            with self.assertRaisesRegex(pyroclast.Error, "another run of this process"):
                run.copy(out=out, overwrite=True)
            run.until(strain=1e-4)
            run.checkpoint()
        for call in (lambda: pyroclast.Run(deck(), out=out, threads=1), lambda: pyroclast.Run(deck(), threads=1).copy(out=out),
                     lambda: pyroclast.Run.fork(out, out=self.folder() / "none", from_stage=9),
                     lambda: pyroclast.Run.fork(out, out=out, from_stage=0)):
            with self.assertRaises(pyroclast.Error) as caught:
                call()
            self.assertNotIn("--", str(caught.exception))
        with self.assertRaisesRegex(pyroclast.Error, "exists already; .* overwrite=True"):
            pyroclast.Run(deck(), out=out, threads=1)

    def test_checkpoints_resume_and_fork(self):
        folder = self.folder()
        whole = pyroclast.Run(deck(), out=folder / "whole", threads=1).finish()
        run = pyroclast.Run(deck(), out=folder / "run", threads=1)
        run.until(strain=1e-4)
        run.checkpoint()
        with self.assertRaisesRegex(pyroclast.Error, "another"):
            pyroclast.Run.resume(folder / "run")
        del run
        gc.collect()
        resumed = pyroclast.Run.resume(folder / "run", threads=1).finish()
        self.assertEqual(history(folder / "whole"), history(folder / "run"))
        self.assertEqual(resumed.outcome, whole.outcome)
        forked = pyroclast.Run.fork(folder / "run", out=folder / "fork", from_stage=0, threads=1,
                                    changes={"stages[1].stop_strain": 0.0002}).finish()
        self.assertLess(forked.history["strain"][-1], 0.00025)
        with self.assertRaisesRegex(pyroclast.Error, "no folder"):
            pyroclast.Run(deck(), threads=1).checkpoint()


class Arrays(Case):
    def test_views_share_the_memory_of_the_run(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=1e-4)
        slot = run.slot
        for name, in_order in (("displacement", lambda v: v[slot]),
                               ("velocity", lambda v: v[slot // 8, :, slot % 8]),
                               ("force", lambda v: v[slot // 8, :, slot % 8])):
            view = getattr(run.views, name)
            self.assertTrue(np.shares_memory(view, getattr(run.views, name)), name)
            np.testing.assert_array_equal(in_order(view), getattr(run.fields, name), name)
            self.assertFalse(np.shares_memory(view, getattr(run.fields, name)))
            with self.assertRaises(ValueError):
                view[0] = 1.0
            self.assertGreater(np.abs(view).max(), 0.0, name)
        self.assertEqual(run.views.internals.shape[1], 8)

    def test_no_view_is_a_copy_or_can_be_written(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=1e-4)
        names = [name for name in dir(pyroclast.Views) if not name.startswith("_")]
        self.assertEqual(names, ["displacement", "force", "internals", "velocity"])
        for name in names:
            view = getattr(run.views, name)
            self.assertTrue(np.shares_memory(view, getattr(run.views, name)), name)
            before = view.copy()
            for write in (lambda v: v.__setitem__(0, 1.0), lambda v: v.fill(0.0), lambda v: v.sort(),
                          lambda v: np.add(v, 1.0, out=v), lambda v: v.setflags(write=True)):
                with self.assertRaises(ValueError, msg=name):
                    write(view)
            np.testing.assert_array_equal(view, before)

    def test_views_can_be_read_when_nothing_else_of_the_run_is_left(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=1e-4)
        views = [run.views.displacement, run.views.velocity, run.views.force, run.views.internals]
        sums = [float(view.sum()) for view in views]
        del run
        gc.collect()
        for other in range(3):  # takes what memory was given back
            pyroclast.Run(deck(), seed=2 + other, threads=1).next()
        while views:
            self.assertEqual(float(views.pop(0).sum()), sums.pop(0))
            gc.collect()

    def test_a_view_follows_the_run_and_outlives_its_name(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=5e-5)
        view = run.views.displacement
        before = view.copy()
        run.until(strain=1e-4)
        self.assertFalse(np.array_equal(view, before))
        now = view.copy()
        del run
        gc.collect()
        np.testing.assert_array_equal(view, now)

    def test_the_model_is_whole(self):
        run = pyroclast.Run(deck(), threads=1)
        corners = run.position[run.zones]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        of_specimen = run.block_material[run.zone_block] < len(run.material_names) - 1
        self.assertAlmostEqual(area[of_specimen].sum(), 0.15 * 0.3, places=9)
        self.assertEqual(run.fields.stress.shape, (len(run.zones), 6))
        self.assertEqual(run.fields["displacement_m"].shape, run.position.shape)
        self.assertEqual(list(run.fields), ["displacement_m", "velocity_m_s", "force_N", "stress_Pa", "strain",
                                            "temperature_degC"])
        with self.assertRaisesRegex(AttributeError, "no field 'stres'; it has displacement, .* temperature"):
            run.fields.stres
        with self.assertRaises(KeyError):
            run.fields["stress_MPa"]

    def test_zone_stresses_and_contacts_carry_the_load(self):
        run = pyroclast.Run(deck(), threads=1)
        state = run.until(strain=2e-4)
        corners = run.position[run.zones]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
        of_specimen = run.block_material[run.zone_block] < len(run.material_names) - 1
        mean = (run.fields.stress[of_specimen, 1] * area[of_specimen]).sum() / area[of_specimen].sum()
        self.assertAlmostEqual(-mean / state.stress, 1.0, delta=0.02)
        contacts = run.contacts()
        self.assertEqual(set(contacts["law"]), {"cohesive", "elastic", "frictional"})
        self.assertLess(contacts["normal_traction_Pa"].mean(), 0.0)

    def test_a_contact_keeps_the_step_of_the_row_that_found_it_cracked(self):
        run = pyroclast.Run(deck(**{"stages[1].stop_strain": 3e-3}), threads=1)
        expected = None
        for state in run:
            contacts = run.contacts()
            if expected is None:
                expected = np.full(len(contacts["crack"]), -1.0)
            expected[(contacts["crack"] > 0.5) & (expected < 0.0)] = state.step
            np.testing.assert_array_equal(contacts["crack_step"], expected)
        self.assertGreater(len(np.unique(expected)), 5)
        self.assertIn(-1.0, expected)

    def test_meshio_and_a_notebook_show_the_run(self):
        run = pyroclast.Run(deck(), threads=1)
        run.until(strain=1e-4)
        file = self.folder() / "body.vtk"
        mesh = run.to_meshio()
        mesh.write(file)
        self.assertGreater(file.stat().st_size, 1000)
        self.assertEqual([name for name, _ in sorted(mesh.field_data.items(), key=lambda entry: entry[1][0])],
                         run.material_names)
        self.assertLessEqual({"displacement_m", "velocity_m_s"}, set(mesh.point_data))
        self.assertLessEqual({"x_m", "area_m2", "opening_m", "normal_traction_Pa", "closure_m", "tension_damage",
                              "lost_tension_J_m2"}, set(run.contacts()))
        self.assertTrue(run._repr_png_().startswith(b"\x89PNG"))
        self.assertIn("data:image/png;base64,", run._repr_html_())

    def test_a_run_of_heat_alone_is_shown_too(self):
        wall = pyroclast.Deck(CASES / "thermal_wall.toml")
        wall.update(blocks={"count": 60}, output={"fields": False})
        wall["stages[0].duration"] = "5 min"
        run = pyroclast.Run(wall, threads=1)
        self.assertTrue(run._repr_png_().startswith(b"\x89PNG"))
        run.finish()
        self.assertGreater(run.fields.temperature.max(), 100.0)
        self.assertIn("temperature_degC", run.to_meshio().point_data)
        self.assertIn("data:image/png", run._repr_html_())
        self.assertEqual(list(run.fields), ["temperature_degC"])
        with self.assertRaisesRegex(pyroclast.Error, "nothing moves"):
            run.call_at(10, print)


class Creep(Case):
    """A specimen of one solid that creeps under a held load while it is heated to 60 degC."""

    STRAIN = 6e-3  # B at 60 degC
    F_C, NU = 35e6, 0.3

    def creeping(self) -> pyroclast.Deck:
        made = heated()
        for phase in ("aggregate", "mortar"):
            solid = made[f"materials.{phase}"]
            solid.pop("expansion")
            made[f"materials.{phase}"] = solid | {"E": "30 GPa", "creep": {
                "of": "phase", "strain": {"table": [["20 degC", 0], ["60 degC", self.STRAIN]]}}}
        for key, value in {"stages[1].level": 0.1, "stages[2].to": "60 degC", "coupling.platen_difference": "5 kPa",
                           "coupling.most_cycles": 3000, "output.fields": True}.items():
            made[key] = value
        return made

    def mean(self, run: pyroclast.Run, field: np.ndarray) -> np.ndarray:
        corners = run.position[run.zones]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        area[run.block_material[run.zone_block] == len(run.material_names) - 1] = 0.0
        return (field * area[:, None]).sum(axis=0) / area.sum()

    def test_a_half_goes_on_from_a_checkpoint(self):
        folder = self.folder()
        whole = pyroclast.Run(deck(specimen__symmetry=["left"]), out=folder / "whole", threads=1).finish()
        run = pyroclast.Run(deck(specimen__symmetry=["left"]), out=folder / "run", threads=1)
        run.until(strain=1e-4)
        run.checkpoint()
        run.close()
        run = pyroclast.Run.resume(folder / "run", threads=1).finish()
        self.assertEqual(history(folder / "whole"), history(folder / "run"))
        self.assertEqual(abs(run.fields.displacement[run.sets["left_symmetry"], 0]).max(), 0.0)
        self.assertEqual(run.outcome, whole.outcome)

    def test_what_crept_is_the_strain_of_the_load_in_arrays_and_fields_and_after_a_resume(self):
        folder = self.folder()
        whole = pyroclast.Run(self.creeping(), out=folder / "whole", threads=1)
        whole.finish()
        run = pyroclast.Run(self.creeping(), out=folder / "run", threads=1)
        run.until(temperature=40.0)
        half = run.fields.creep_strain
        run.checkpoint()
        run.close()
        run = pyroclast.Run.resume(folder / "run", threads=1)
        np.testing.assert_array_equal(run.fields.creep_strain, half)
        run.finish()
        np.testing.assert_array_equal(run.fields.creep_strain, whole.fields.creep_strain)
        # each stress creeps by the same law, so the mean creeps by the mean stress
        along = -0.1 * 33.9e6 / self.F_C * self.STRAIN
        np.testing.assert_allclose(self.mean(whole, whole.fields.creep_strain), [-self.NU * along, along, -self.NU * along,
                                                                              0.0, 0.0, 0.0], atol=0.02 * abs(along))
        self.assertEqual(np.abs(whole.fields.creep_strain[whole.block_material[whole.zone_block] == 2]).max(), 0.0)
        for name in ("whole", "run"):
            last = sorted((folder / name / "fields").glob("blocks_*.hdf"))[-1]
            with h5py.File(last) as file:
                field = file["VTKHDF/CellData/creep_strain [1]"][:]
            np.testing.assert_allclose(field, whole.fields.creep_strain, rtol=1e-6)

    def test_where_nothing_creeps_there_is_no_such_field(self):
        self.assertNotIn("creep_strain", pyroclast.Run(deck(), threads=1).fields)


class Threads(Case):
    def test_are_at_most_as_many_as_processors_are_free(self):
        run = pyroclast.Run(deck())
        free = run.threads
        self.assertLessEqual(free, len(os.sched_getaffinity(0)))
        for asked, taken in ((1, 1), (1000, free), (0, free)):
            run.threads = asked
            self.assertEqual(run.threads, taken)
        with self.assertRaisesRegex(pyroclast.Error, "-1"):
            run.threads = -1
        run = pyroclast.Run(deck(), threads=1000)
        self.assertEqual(run.threads, free)
        self.assertTrue(any("1000 were asked for" in warning for warning in run.warnings), run.warnings)


class Processes(Case):
    def test_after_fork_a_run_in_the_child_raises_at_once(self):
        run = pyroclast.Run(deck(), threads=2)
        run.until(strain=5e-5)
        read, write = os.pipe()
        child = os.fork()
        if child == 0:  # leaves without the tests' own end
            os.write(write, _error(run.next).encode())
            del run
            os._exit(0)
        os.close(write)
        with os.fdopen(read) as pipe:
            said = pipe.read()
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertIn("spawn", said)
        run.finish()
        self.assertEqual(run.outcome, "completed")

    def test_a_pool_runs_seeds_in_parallel(self):
        import pool
        runs = pyroclast.parallel.map_runs(pool.stress_at, [1, 2, 3], processes=2)
        alone = pool.stress_at(2)
        self.assertEqual(runs[1], alone)
        self.assertEqual(len(set(runs)), 3)
        with self.assertRaisesRegex(pyroclast.DeckError, "specimen.width"):
            pyroclast.parallel.map_runs(pool.wrong, [1])


class Numbers(Case):
    """What may be a number in the summary is known before a run begins; studies refuse outputs by it."""

    def named(self, case: str, **changes) -> tuple[set[str], set[str]]:
        """Before the run, and after a look of each stage."""
        made = pyroclast.Deck(CASES / f"{case}.toml")
        for key, value in changes.items():
            made[key.replace("__", ".")] = value
        run = pyroclast.Run(made, threads=1)
        before = set(run._core.summary_numbers())
        while run.next():
            with contextlib.suppress(pyroclast.Error):  # where that look was the last of its stage
                run.end_stage()
        self.assertNotIn("not begun", [stage["outcome"] for stage in run.summary["stages"]])
        numbers = {name for stage in run.summary["stages"] for name, value in stage["results"].items()
                   if not isinstance(value, str | None)}

        def paths(node: dict, path: str = "") -> None:
            for key, value in node.items():
                if isinstance(value, dict):
                    paths(value, f"{path}{key}.")
                elif isinstance(value, int | float):
                    numbers.add(path + key)

        paths({key: value for key, value in run.summary.items() if key != "stages"})
        return before, numbers

    def test_every_stage_names_its_results_before_it_begins(self):
        heats = {"coupling.exchange_increment": "20 K", "coupling.least_cycles": 200,
                 "coupling.most_cycles": 300}
        cases = {
            "hot_strength": {"blocks.count": 150, "stages[1].ramp_time": "20 ms", **heats},
            "cyclic": {"blocks.count": 150},
            "residual_capacity": {"blocks.count": 150, **heats},
            "fire_one_side": {"blocks.count": 200, "stages[1].ramp_time": "20 ms", **heats},
            "thermal_wall": {},
            "notched_beam": {"blocks.count": 250},
            "direct_tension": {"blocks.count": 100},
        }
        for case, changes in cases.items():
            with self.subTest(case):
                before, numbers = self.named(case, **changes)
                self.assertGreater(len(numbers), 20)
                self.assertEqual(numbers - before, set())
                self.assertNotIn("f_c_none_because", before)

    def test_a_run_that_is_not_begun_has_a_summary_without_numbers(self):
        run = pyroclast.Run(deck(), threads=1)
        self.assertIsNone(run.summary["energy_J"]["kinetic"])
        self.assertIsNone(run.summary["steps"])
        self.assertEqual(run.results, {})
