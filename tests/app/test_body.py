"""A body that `specimen` wrote gives a run the bytes of one that makes its body; any other body is refused.

PYROCLAST names the program.
"""

import csv
import json
import os
import pathlib
import random
import shutil
import subprocess
import unittest

from in_a_folder import PROGRAM, InAFolder
from test_checkpoint_values import TRAILER, xxh3
from test_ranks import MPI, NEEDS_MPI

ROOT = pathlib.Path(__file__).parents[2]
CHUNKS = {**os.environ, "PYROCLAST_CHUNK_BLOCKS": "32"}
PRESS = ["--set", "blocks.count=150", "--set", "stages[1].velocity=8 mm/s", "--set", "stages[1].stop_strain=0.0002"]
QUIET = ["--no-figures", "-t", "1"]


def case(name: str) -> str:
    return str(ROOT / f"cases/{name}.toml")


class Body(InAFolder):
    def specimen(self, deck: str, *changes, out: str = "body"):
        self.pyroclast("specimen", deck, *changes, *QUIET, "--out", out, env=CHUNKS)

    def results(self, run: str) -> dict[str, bytes | dict]:
        """The files of a run by name, but for times and places."""
        files = {str(file.relative_to(self.folder / run)): file.read_bytes()
                 for file in (self.folder / run).rglob("*") if file.is_file()}
        kept = {name: text for name, text in files.items()
                if not name.startswith("checkpoints") and name not in ("manifest.json", "run.log", "summary.json")}
        summary = json.loads(files["summary.json"])
        del summary["wall_time_s"]
        return {**kept, "summary.json": summary}

    def assert_same(self, one: str, other: str):
        first, second = self.results(one), self.results(other)
        self.assertEqual(first.keys(), second.keys())
        for name, content in first.items():
            self.assertTrue(content == second[name], name)

    def refused(self, *words, **options) -> str:
        done = self.pyroclast("run", *words, *QUIET, "--out", "refused", code=1, **options)
        self.assertFalse((self.folder / "refused/history.csv").exists())
        self.assertEqual(done.stderr.count("error:"), 1, done.stderr)
        return done.stderr

    def test_a_run_of_a_body_has_the_bytes_of_one_that_makes_it(self):
        """In the plane and in space, with platens, bearings, a notch, sets and heat."""
        for name, *changes in (("starter", *PRESS), ("starter_3d", "--set", "blocks.count=60", *PRESS[2:]),
                               ("notched_beam", "--set", "blocks.count=200", "--set", "stages[0].duration=20 ms", "--set",
                                "stages[1].most_steps=100", "--set", "stages[2].duration=20 ms"),
                               ("thermal_wall", "--set", "blocks.count=100")):
            with self.subTest(name):
                self.specimen(case(name), *changes, out=f"body_{name}")
                self.pyroclast("run", case(name), *changes, *QUIET, "--out", f"made_{name}", env=CHUNKS, code=None)
                self.pyroclast("run", case(name), *changes, *QUIET, "--body", f"body_{name}", "--out", f"read_{name}",
                               env=CHUNKS, code=None)
                self.assert_same(f"made_{name}", f"read_{name}")

    def test_holes_and_notches_of_a_solid_go_through_a_whole_run(self):
        """A bore burns, bore and notch sink under the load, and the body's file gives the same bytes."""
        text = (ROOT / "cases/fire_one_side_3d.toml").read_text().replace('faces = "front"', 'faces = "bore"')
        cuts = ('[[specimen.holes]]\nname = "bore"\ncentre = ["45 mm", "45 mm"]\ndiameter = "24 mm"\n\n'
                '[[specimen.notches]]\nname = "saw"\nmouth = ["0 mm", "20 mm"]\ntip = ["24 mm", "20 mm"]\n'
                'width = "3 mm"\n\n'
                '[[record]]\nname = "bore"\nkind = "displacement"\nset = "bore"\ndirection = "y"\n\n'
                '[[record]]\nname = "saw"\nkind = "displacement"\nset = "saw"\ndirection = "y"\n\n')
        text = text.replace("[aggregates] ", cuts + "[aggregates] ").replace('x = "40 mm"\ny = "40 mm"\nz = "5 mm"',
                                                                            'x = "60 mm"\ny = "45 mm"\nz = "24 mm"')
        text = text.replace('x = "40 mm"\ny = "40 mm"\nz = "24 mm"', 'x = "5 mm"\ny = "75 mm"\nz = "24 mm"')
        (self.folder / "bored.toml").write_text(text)
        changes = ["--set", "blocks.count=200", "--set", "aggregates.fraction=0.2", "--set", "stages[1].duration=3 min",
                   "--set", "coupling.exchange_increment=40 K"]
        self.pyroclast("run", "bored.toml", *changes, *QUIET, "--out", "whole", env=CHUNKS)
        summary = self.results("whole")["summary.json"]
        with open(self.folder / "whole/history.csv", newline="") as file:
            *_, last = csv.DictReader(file)
        near, far = (float(last[f"probe_{name}_degC"]) for name in ("at_5_mm", "in_the_middle"))
        self.assertGreater(near, far + 40.0)  # 3 mm and 45 mm from the bore
        self.assertLess(summary["heat_J"]["error_over_largest"], 1e-9)
        self.assertLess(summary["energy_J"]["error_over_turnover"], 1e-3)
        self.assertLess(float(last["bore_m"]), float(last["saw_m"]))  # both sink under the upper platen
        self.assertLess(float(last["saw_m"]), 0.0)
        self.specimen("bored.toml", *changes)
        self.pyroclast("run", "bored.toml", *changes, *QUIET, "--body", "body", "--out", "of_body", env=CHUNKS)
        self.assert_same("whole", "of_body")

    @NEEDS_MPI
    def test_ranks_read_their_chunks_and_give_the_bytes_of_one_process(self):
        """A press in the plane and in space, and heat alone, whose nodes ranks share."""
        for name, *changes in (("starter", *PRESS), ("starter_3d", "--set", "blocks.count=120", *PRESS[2:]),
                               ("thermal_wall", "--set", "blocks.count=150")):
            with self.subTest(name):
                self.specimen(case(name), *changes, out=f"body_{name}")
                self.pyroclast("run", case(name), *changes, *QUIET, "--out", f"one_{name}", env=CHUNKS, code=None)
                done = subprocess.run(["mpirun", "-n", "3", PROGRAM, "run", case(name), *changes, *QUIET,
                                       "--mpi", "--body", f"body_{name}", "--out", f"{name}_3"],
                                      cwd=self.folder, env={**MPI, **CHUNKS}, capture_output=True, text=True,
                                      timeout=300, check=False)
                self.assertIn(done.returncode, (0, 2), done.stdout + done.stderr)
                self.assert_same(f"one_{name}", f"{name}_3")

    def test_other_stages_and_numbers_of_materials_take_the_same_body(self):
        self.specimen(case("starter"), *PRESS)
        deck = [case("starter"), *PRESS, "--set", "stages[1].velocity=9 mm/s", "--set", "contacts.mortar_mortar.f_t=3 MPa"]
        self.pyroclast("run", *deck, *QUIET, "--body", "body", "--out", "run", env=CHUNKS, code=None)
        # a resume finds it from any directory
        kept = json.loads((self.folder / "run/manifest.json").read_text())["body"]["folder"]
        self.assertEqual(kept, str((self.folder / "body").resolve()))

    def test_a_run_of_a_body_goes_on_with_and_without_it(self):
        """Both ends have the bytes of a run that was not broken off."""
        self.specimen(case("starter"), *PRESS)
        self.pyroclast("run", case("starter"), *PRESS, *QUIET, "--body", "body", "--out", "whole", env=CHUNKS,
                       code=None)
        for name in ("with", "without"):
            shutil.copytree(self.folder / "whole", self.folder / name)
            (self.folder / name / "summary.json").unlink()
            if name == "without":
                shutil.rmtree(self.folder / "body")
            self.pyroclast("resume", name, "--checkpoint-file", f"{name}/checkpoints/stage_0.state", *QUIET,
                           env=CHUNKS, code=None)
            self.assert_same("whole", name)

    def test_a_body_of_other_inputs_is_refused_by_what_differs(self):
        self.specimen(case("starter"), *PRESS)
        deck = [case("starter"), *PRESS, "--body", "body"]
        for change, named in (("specimen.seed=77", "specimen.seed was 1, and is 77 here"),
                              ("blocks.count=151", "blocks.count was 150, and is 151 here"),
                              ("platens.thickness=9 mm", "platens.thickness")):
            self.assertIn(named, self.refused(*deck, "--set", change, env=CHUNKS))
        self.assertIn("PYROCLAST_CHUNK_BLOCKS) was 32, and is 16 here",
                      self.refused(*deck, env={**CHUNKS, "PYROCLAST_CHUNK_BLOCKS": "16"}))

    def test_a_body_with_any_byte_changed_or_cut_is_refused(self):
        """Every flip and every cut is one error that names the file, and the chunk where it is one of an array."""
        self.specimen(case("starter"), *PRESS)
        file = self.folder / "body/body.h5"
        whole = file.read_bytes()
        chance = random.Random(1)
        chunks_named = 0
        for i in range(50):
            at = chance.randrange(len(whole))
            file.write_bytes(whole[:at] if i % 5 == 0 else whole[:at] + bytes([whole[at] ^ 1 << i % 8]) + whole[at + 1:])
            with self.subTest(i=i, at=at):
                said = self.refused(case("starter"), *PRESS, "--body", "body", env=CHUNKS)
                self.assertIn("body/body.h5: ", said)
                chunks_named += "is damaged: chunk " in said
        self.assertGreater(chunks_named, 10)

    def put_into_table(self, body: str, entry: str, other: str):
        """Replaces a text of the table of a body, whose hash is then made anew."""
        file = self.folder / body / "body.h5"
        content = file.read_bytes()
        begin, size, _, end = TRAILER.unpack(content[-TRAILER.size:])
        table = content[begin:begin + size].replace(entry.encode(), other.encode())
        self.assertNotEqual(table, content[begin:begin + size])
        file.write_bytes(content[:begin] + table + TRAILER.pack(begin, len(table), xxh3()(table), end))

    def test_a_body_of_another_format_is_refused_by_it(self):
        self.specimen(case("starter"), *PRESS)
        self.put_into_table("body", '"format":1,', '"format":0,')
        self.assertIn("has format 0, and this program reads format 1; make it anew: pyroclast specimen",
                      self.refused(case("starter"), *PRESS, "--body", "body", env=CHUNKS))

    @NEEDS_MPI
    def test_ranks_that_read_other_bodies_are_refused(self):
        self.specimen(case("starter"), *PRESS)
        shutil.copytree(self.folder / "body", self.folder / "other")
        self.put_into_table("other", '"format":1,', '"format":1,"more":0,')
        run = [PROGRAM, "run", case("starter"), *PRESS, *QUIET, "--mpi", "--out", "refused", "--body"]
        done = subprocess.run(["mpirun", "-n", "1", *run, "body", ":", "-n", "1", *run, "other"], cwd=self.folder,
                              env={**MPI, **CHUNKS}, capture_output=True, text=True, timeout=300, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stderr.count("error:"), 1, done.stderr)
        self.assertIn("rank 1 reads another body than rank 0: all ranks need the same", done.stderr)
        self.assertFalse((self.folder / "refused/history.csv").exists())

    def test_a_folder_without_a_body_is_refused(self):
        self.assertIn("there is no body", self.refused(case("starter"), *PRESS, "--body", "nowhere"))
        (self.folder / "other").mkdir()
        (self.folder / "other/body.h5").write_text("something else\n")
        self.assertIn("is no body of pyroclast", self.refused(case("starter"), *PRESS, "--body", "other"))


if __name__ == "__main__":
    unittest.main()
