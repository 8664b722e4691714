"""Checkpoints whose hashes are right and whose numbers are not. PYROCLAST names the program.

Each number of a checkpoint is put to values that it cannot have, its hash is made anew, and the run resumed with little
time and memory. It goes on, or ends with an error that names the file: never by a signal, and never without an end.
PYROCLAST_EDITS: how many edits are drawn for each run (default 8; 0: all).
"""

import collections
import ctypes
import functools
import json
import math
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest
from collections.abc import Callable

from in_a_folder import PROGRAM, InAFolder
from sanitized import SANITIZED

EDITS = int(os.environ.get("PYROCLAST_EDITS", "8"))
CASES = pathlib.Path(__file__).parents[2] / "cases"
MEMORY = 2 << 30  # bytes, of address space
SECONDS = 1.5  # for which a run that goes on is watched
TRAILER = struct.Struct("<QQQ8s")

PRISM = ("specimen.width=50 mm", "specimen.height=100 mm", "aggregates.d_max=12 mm", 'aggregates.sieves=["8 mm"]')
RUNS = {
    "compression": ("starter", (*PRISM, "blocks.count=40", 'mechanics.kinematics="finite"', "stages[1].velocity=8 mm/s",
                                "stages[1].ramp_time=1 ms", "stages[1].stop_strain=3e-3",
                                "output.history_strain=4e-5", "output.frame_strain=1e-3")),
    "found": ("starter", (*PRISM, "blocks.count=40", 'mechanics.kinematics="finite"', 'mechanics.contacts="found"',
                          "stages[1].velocity=80 mm/s", "stages[1].ramp_time=1 ms", "stages[1].stop_strain=8e-3",
                          "stages[1].stop_fraction_of_peak=0.01", "output.history_strain=4e-5",
                          "output.frame_strain=1e-3")),
    "exchanges": ("transient_heating", (*PRISM, "blocks.count=40", "coupling.exchange_increment=10 K",
                                        "coupling.least_cycles=100", "coupling.most_cycles=500", "stages[1].level=0.2",
                                        "stages[1].ramp_time=2 ms", "stages[2].to=120 degC")),
    "conduction": ("delamination_heat", ("blocks.count=60", "stages[0].duration=10 min", "stages[0].interval=1 min")),
    "drive": ("notched_beam", ("blocks.count=300", "stages[0].unbalanced_ratio=0.1", "stages[1].unbalanced_ratio=0.1",
                               "stages[2].duration=0.5 s")),
}


def xxh3():
    for name in ("libxxhash.so.0", "libxxhash.so"):
        try:
            function = ctypes.CDLL(name).XXH3_64bits
        except OSError:
            continue
        function.restype, function.argtypes = ctypes.c_uint64, (ctypes.c_char_p, ctypes.c_size_t)
        return lambda data: function(data, len(data))
    raise unittest.SkipTest("there is no libxxhash to make hashes with")


class State:
    """A checkpoint's rows and table."""

    def __init__(self, file: pathlib.Path):
        content = file.read_bytes()
        begin, size, _, _ = TRAILER.unpack(content[-TRAILER.size:])
        self.table = json.loads(content[begin:begin + size])
        self.rows, self.by_chunk = {}, {}
        for name, at, item, count, _ in self.table["rows"]:
            if isinstance(count, list):
                self.by_chunk[name], count = count, sum(count)
            self.rows[name] = (item, content[at:at + item * count])

    def write(self, file: pathlib.Path, hash_of, name: str | None = None, data: bytes = b"", **changes) -> None:
        """With other bytes of a row, and other entries of the table; a row of `changes["row"]` stands as it is."""
        content, rows = bytearray(b"pyroclas"), []
        row = changes.pop("row", None)
        for each, (item, whole) in self.rows.items():
            kept = data if each == name and row is None else whole
            entry = [each, len(content), item, *self.counts_and_hashes(each, item, bytes(kept), hash_of)]
            if each == name and row is not None:
                entry = [value if value is not None else old for value, old in zip(row, entry)]
            rows.append(entry)
            content += kept
        table = json.dumps(self.table | {"rows": rows} | changes).encode()
        content += table + TRAILER.pack(len(content), len(table), hash_of(table), b"t-state2")
        file.write_bytes(content)


    def counts_and_hashes(self, name: str, item: int, data: bytes, hash_of) -> tuple:
        """Of all, or by chunk: what is more or less than there was is that of the last chunks."""
        if name not in self.by_chunk:
            return len(data) // item, hash_of(data)
        counts, hashes = [], []
        for count in self.by_chunk[name][:-1]:
            counts.append(min(count, len(data) // item - sum(counts)))
        counts.append(len(data) // item - sum(counts))
        for i, count in enumerate(counts):
            hashes.append(hash_of(data[item * sum(counts[:i]):item * (sum(counts[:i]) + count)]))
        return counts, hashes


def packed(data: bytes, form: str, place: int, value) -> bytes:
    changed = bytearray(data)
    struct.pack_into(form, changed, place * struct.calcsize(form), value)
    return bytes(changed)


def edits_of(item: int, data: bytes) -> list[tuple[str, Callable[[], bytes]]]:
    """What a row is made to hold: each as it is told, and what makes the bytes, of which there may be many."""
    found: list[tuple[str, Callable[[], bytes]]] = []

    def put(what: str, form: str, value) -> None:
        size = struct.calcsize(form)
        found.extend((f"{what} at {place}", functools.partial(packed, data, form, place, value))
                     for place in sorted({0, len(data) // size // 2, len(data) // size - 1})
                     if 0 <= place and (place + 1) * size <= len(data))

    if item % 8 == 0:
        for value in (math.nan, math.inf, 1e308, -1.0):
            put(repr(value), "<d", value)
        for value in (-1, 1 << 31, 1 << 62):
            put(f"long {value}", "<q", value)
    if item % 4 == 0:
        for value in (-1, (1 << 31) - 1, 1000):
            put(f"int {value}", "<i", value)
    if item < 4:
        for value in (255, 2):
            put(f"byte {value}", "<B", value)
    return found + [("nothing", lambda: b""), ("twice", lambda: 2 * data),
                    ("one less", lambda: data[:-item]), ("one more", lambda: data + bytes(item)),
                    ("a million", lambda: bytes(item) * 1_000_000)]


TABLES = [{"row": (None, None, None, count, None)} for count in (1 << 62, 1 << 31)] + [
    {"row": (None, None, item, None, None)} for item in (0, 1 << 40)] + [
    {"row": (None, begin, None, None, None)} for begin in (-1, 1 << 62)] + [
    {key: value} for key in ("number", "stage", "step", "log_bytes", "physics_version")
    for value in (-1, 1 << 31, 1 << 63, 1e308)] + [{"wall_time": -1.0}, {"wall_time": 7}, {"stage_kinds": 7}]


class Values(InAFolder):
    def setUp(self):
        super().setUp()
        self.hash_of = xxh3()

    def stopped(self, name: str) -> pathlib.Path:
        """A run that was stopped on its way, in its last stage."""
        case, changes = RUNS[name]
        out = self.folder / name
        words = [PROGRAM, "run", CASES / f"{case}.toml", "--out", out, "--no-figures", "--checkpoint", "0 s",
                 "--threads", "1", *(word for change in changes for word in ("--set", change))]
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
            for _ in range(6000):
                if process.poll() is not None:
                    self.fail(f"{name} was over before it was stopped: {process.stderr.read()}")
                files = sorted((out / "checkpoints").glob("0*.state")) if out.exists() else []
                if files and self.is_far(out):
                    break
                time.sleep(0.005)
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=120)
        return out

    @staticmethod
    def is_far(out: pathlib.Path) -> bool:
        history = out / "history.csv"
        lines = history.read_text().splitlines() if history.exists() else []
        kinds = (out / "deck.toml").read_text().count("[[stages]]")
        last = [line for line in lines[1:] if line.startswith(f"{kinds - 1},")]
        return len(last) >= 4

    def resumed(self, scratch: pathlib.Path, file: str, seconds: float = SECONDS) -> str:
        """What came of it: "refused", "ended" or "goes on"; else what is wrong."""
        def limit() -> None:
            if not SANITIZED:  # the address sanitizer reserves terabytes
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        words = [PROGRAM, "resume", scratch, "--no-figures", "--quiet", "--threads", "1"]
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
                              preexec_fn=limit) as process:
            try:
                said = process.communicate(timeout=seconds)[1]
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGTERM)
                try:
                    process.communicate(timeout=120)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.communicate()
                    return "does not end, and does not hear that it shall stop"
                if process.returncode == -signal.SIGTERM and seconds == SECONDS:  # perhaps it was not begun yet
                    return self.resumed(scratch, file, 12.0 * SECONDS)
                return "goes on" if process.returncode >= 0 else f"signal {-process.returncode}"
        if process.returncode < 0:
            return f"signal {-process.returncode}"
        if process.returncode == 1 and ("error: " not in said or "std::" in said):
            return f"an error that says nothing: {said!r}"
        if process.returncode != 1:  # 2: it ended, and is not as its deck asks
            return "ended"
        return "refused" if file in said else f"told: {said[:200]}"  # what is wrong after it was taken

    def try_run(self, name: str) -> None:
        out = self.stopped(name)
        newest = sorted((out / "checkpoints").glob("0*.state"))[-1]
        state = State(newest)
        tried = [(f"{row}: {what}", {"name": row, "make": make}) for row, (item, data) in state.rows.items()
                 for what, make in edits_of(item, data)]
        first = next(iter(state.rows))
        tried += [(f"table: {changes}", {"name": first, **changes}) for changes in TABLES]
        if EDITS:
            tried = random.Random(name).sample(tried, EDITS)
        came = collections.Counter()
        wrong = []
        scratch = self.folder / "scratch"
        for what, changes in tried:
            if make := changes.pop("make", None):
                changes["data"] = make()
                if changes["data"] == state.rows[changes["name"]][1]:
                    continue
            shutil.rmtree(scratch, ignore_errors=True)
            shutil.copytree(out, scratch)
            for file in (scratch / "checkpoints").iterdir():
                file.unlink()
            state.write(scratch / "checkpoints" / newest.name, self.hash_of, **changes)
            outcome = self.resumed(scratch, newest.name)
            came[outcome.split(":")[0]] += 1
            if "nan" in what and outcome != "refused":
                wrong.append(f"{what}: a NaN is taken ({outcome})")
            elif outcome not in ("refused", "ended", "goes on") and not outcome.startswith("told: "):
                wrong.append(f"{what}: {outcome}")
            if os.environ.get("PYROCLAST_TELL"):
                print(f"{name}: {what}: {outcome}", flush=True)
        print(f"{name}: {dict(came)}")
        self.assertEqual(wrong, [])

    def test_a_checkpoint_as_it_was_goes_on(self):
        for name in RUNS:
            with self.subTest(name):
                out = self.stopped(name)
                newest = sorted((out / "checkpoints").glob("0*.state"))[-1]
                State(newest).write(newest, self.hash_of)
                self.assertIn(self.resumed(out, newest.name), ("ended", "goes on"))

    def test_values_that_cannot_be(self):
        for name in RUNS:
            with self.subTest(name):
                self.try_run(name)

    def test_what_once_ended_by_a_signal_or_not_at_all(self):
        """Rows whose counts and indices were taken as they came."""
        out = self.stopped("compression")
        newest = sorted((out / "checkpoints").glob("0*.state"))[-1]
        state = State(newest)
        whole = {name: data for name, (_, data) in state.rows.items()}
        minus, many, large = struct.pack("<i", -1), struct.pack("<i", 1000), struct.pack("<q", 1 << 31)
        for name, data, says in (
                ("courses[0].first_row", large, "names rows"),
                ("history.is_there", whole["history.is_there"][1:], "entries"),
                ("history.columns", whole["history.columns"][:-1], "line's end"),
                ("mechanics.ties", struct.pack("<3i", 0, 0, -3), "is no list of ties"),
                ("mechanics.constrained_bundles", many + whole["mechanics.constrained_bundles"][4:],
                 "names one that is not there"),
                ("mechanics.set_of_contact", minus + whole["mechanics.set_of_contact"][4:], "must be 0 or greater"),
                ("mechanics.set_of_contact", many + whole["mechanics.set_of_contact"][4:], "names a set"),
                ("mechanics.laws_of_sets", many + whole["mechanics.laws_of_sets"][4:], "names a law"),
                ("mechanics.velocity", struct.pack("<d", math.nan) + whole["mechanics.velocity"][8:], "nan"),
                ("results.frame_rows", large + whole["results.frame_rows"][8:], "must be 0 to"),
                ("stage_is_over", b"\x07", "must be 0 to 1"),
                ("outcome", b"\xc8", "must be 0 to")):
            with self.subTest(name):
                state.write(newest, self.hash_of, name, data)
                done = self.pyroclast("resume", out, "--no-figures", code=1)
                at_fault = name.replace("courses[0].first_row", "courses")
                self.assertIn(f"{newest.name}: is not sound: \"{at_fault}\"", done.stderr)
                self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main()
