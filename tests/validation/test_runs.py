"""validation/runs: which runs of a study are done, and which go on."""

import json
import pathlib
import shlex
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "validation"))
import runs  # noqa: E402

COMMAND = ["/here/pyroclast", "run", "deck.toml", "--seed", "1", "--set", 'blocks.size="5 mm"', "--set", "blocks.count=300"]


class Runs(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.deck = pathlib.Path(holder.name) / "deck.toml"
        self.deck.write_text("title = \"one\"\n")
        self.folder = pathlib.Path(holder.name) / "run"
        (self.folder / "checkpoints").mkdir(parents=True)
        (self.folder / "checkpoints" / "1.state").touch()
        (self.folder / "manifest.json").write_text(json.dumps(
            {"command": shlex.join(["/there/pyroclast", *COMMAND[1:]]), "physics_version": 7}))
        (self.folder / "deck.toml").write_text(self.deck.read_text())
        self.folder.with_name("run.source").write_text(runs.deck_hash(self.deck))
        version = mock.patch.object(runs, "physics_version", lambda program, kinds: "7")
        version.start()
        self.addCleanup(version.stop)

    def end(self, outcome: str):
        (self.folder / "summary.json").write_text(json.dumps({"outcome_id": outcome}))

    def test_what_was_killed_or_stopped_goes_on(self):
        for outcome in (None, "stopped"):
            if outcome:
                self.end(outcome)
            self.assertTrue(runs.broken_off(self.folder, COMMAND))
            self.assertFalse(runs.finished(self.folder, COMMAND, self.deck))

    def test_what_came_to_its_end_is_done(self):
        self.end("completed")
        self.assertFalse(runs.broken_off(self.folder, COMMAND))
        self.assertTrue(runs.finished(self.folder, COMMAND, self.deck))
        self.deck.write_text("# another comment\ntitle = 'one'\n")
        self.assertTrue(runs.finished(self.folder, COMMAND, self.deck))

    def test_another_command_deck_or_physics_is_another_run(self):
        self.end("completed")
        other = [*COMMAND[:-1], "blocks.count=301"]
        self.assertFalse(runs.finished(self.folder, other, self.deck))
        with mock.patch.object(runs, "physics_version", lambda program, kinds: "8"):
            self.assertFalse(runs.finished(self.folder, COMMAND, self.deck))
        self.deck.write_text("title = \"another\"\n")
        self.assertFalse(runs.finished(self.folder, COMMAND, self.deck))
        (self.folder / "summary.json").unlink()
        self.assertFalse(runs.broken_off(self.folder, other))

    def test_a_version_that_changed_one_kind_of_deck_leaves_others_done(self):
        self.end("completed")
        rules = pathlib.Path(self.deck.parent) / "validation/reference.toml"
        rules.parent.mkdir()
        rules.write_text('[[changed]]\nphysics_version = 7\nonly = "finite"\n')
        for of_deck, version, is_done in (("small", "6", True), ("small", "7", False), ("finite", "7", True),
                                          ("finite", "6", False)):
            with self.subTest(kinematics=of_deck, version=version), mock.patch.object(runs, "ROOT", self.deck.parent), \
                    mock.patch.object(runs, "physics_version", lambda program, kinds: version):
                (self.folder / "deck.toml").write_text(f'[mechanics]\nkinematics = "{of_deck}"\n')
                self.assertEqual(runs.finished(self.folder, COMMAND, self.deck), is_done)

    def test_kinds_of_a_deck_are_those_of_its_changes_too(self):
        self.deck.write_text('[specimen]\nshape = "cylinder"\n[superposition]\nrule = "each"\n')
        self.assertEqual(runs.kinds(self.deck), frozenset())
        self.assertEqual(runs.kinds(self.deck, ["superposition.rule=follow", "mechanics.kinematics=finite"]),
                         {"followed", "finite", "finite, first"})
        self.deck.write_text('[superposition]\nrule = "follow"\n')
        self.assertEqual(runs.kinds(self.deck), frozenset())  # of the plane


if __name__ == "__main__":
    unittest.main()
