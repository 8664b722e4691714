"""What the bench's report promises, on invented measurements in the layout of Google Benchmark.

    python3 -m unittest discover -s tests/python
"""

from __future__ import annotations

import contextlib
import importlib.util
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
_SPEC = importlib.util.spec_from_file_location("bench_report", HERE.parents[1] / "bench" / "report.py")
report = importlib.util.module_from_spec(_SPEC)
sys.modules["bench_report"] = report
_SPEC.loader.exec_module(report)

CACHES = [{"type": "Data", "level": 1, "size": 32_000, "num_sharing": 1},
          {"type": "Instruction", "level": 1, "size": 32_000, "num_sharing": 1},
          {"type": "Unified", "level": 2, "size": 1_000_000, "num_sharing": 1},
          {"type": "Unified", "level": 3, "size": 32_000_000, "num_sharing": 2}]


CPU_TIME = 3.0  #: of measurements that other work does not disturb, as long as the time by the clock


def repetitions(name: str, counter: str, values: list[float], **counters: float) -> list[dict]:
    """The repetitions of one benchmark, and an aggregate that the report must not take for one."""
    runs = [{"run_name": f"{name}/real_time", "run_type": "iteration", counter: value, "real_time": 3.0,
             "cpu_time": CPU_TIME, "threads": int(name[-1]), **counters} for value in values]
    return [*runs, {"run_name": f"{name}/real_time", "run_type": "aggregate", counter: 1e30}]


def step(code: str, zones: int, threads: int, zone_steps: list[float], **cost: float) -> list[dict]:
    shared = {"zones": zones, "contacts": zones - 100, "damaged": 0.25, "contact_updates": 19e6}
    return repetitions(f"step/{code}/cracked/zones:{zones}/threads:{threads}", "zone_steps", zone_steps,
                       **shared, **cost)


def measured(**cost: float) -> dict:
    if cost:
        cost["memory"] = 21.6e6
    benchmarks = [
        *repetitions("peak/threads:1", "flops_per_s", [70e9]),
        *repetitions("peak/threads:2", "flops_per_s", [140e9]),
        *repetitions("triad/L2/threads:1", "bytes_per_s", [200e9]),
        *repetitions("triad/L3/threads:1", "bytes_per_s", [100e9]),
        *step("pyroclast", 27_000, 1, [20e6, 22e6, 90e6], **cost),
        *repetitions("triad/L3/threads:2", "bytes_per_s", [120e9]),
        *repetitions("kernel/zones/cracked/zones:27000/threads:1", "zone_steps", [50e6]),
        *repetitions("kernel/contacts/cracked/zones:27000/threads:1", "zone_steps", [40e6]),
        *repetitions("kernel/motion/intact/zones:27000/threads:1", "zone_steps", [40e6]),
        *step("pyroclast", 27_000, 2, [33e6], **cost),
        *step("textbook", 27_000, 1, [11e6]),
    ]
    return {"context": {"caches": CACHES, "load_avg": [0.5, 1.0, 1.0], "processor": "P", "compiler": "g++ 1"}, "benchmarks": benchmarks}


YADE = {"program": "Yade 1", "spheres": 25_000,
        "states": [{"state": "cracked", "interactions": 200_000, "damaged": [0.2, 0.3], "steps": 50,
                    "seconds": [2.0, 4.0, 5.0], "collider_runs": 1}]}


class Report(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name: str, content) -> Path:
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
        return path

    def read(self, content: dict, *peers: dict):
        return report.read_bench(self.write("bench.json", content),
                                 [self.write(f"yade{i}.json", peer) for i, peer in enumerate(peers)])

    def test_values_are_medians_of_repetitions_and_ratios_are_theirs(self) -> None:
        text = report.table(self.read(measured()))
        row = next(line for line in text.splitlines() if line.startswith("| 27,000"))
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        self.assertEqual(cells[:4], ["27,000", "26,900", "cracked", "25.0 %"])
        self.assertTrue(cells[4].startswith("22.0 ±"), cells)
        self.assertEqual(cells[7:9], ["2.00", "1.50"])

    def test_one_thread_is_rated_by_its_processor_time_but_a_speedup_by_the_clock(self) -> None:
        content = measured()
        for run in content["benchmarks"]:
            if run["run_type"] == "iteration":
                run["cpu_time"] = 1.5  # half of the time others ran
        text = report.table(self.read(content))
        row = next(line for line in text.splitlines() if line.startswith("| 27,000"))
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        self.assertTrue(cells[4].startswith("44.0 ±"), cells)
        self.assertTrue(cells[5].startswith("33.0 ±"), cells)
        self.assertEqual(cells[7:9], ["2.00", "1.50"])

    def test_bodies_in_space_have_tables_of_their_own(self) -> None:
        content = measured()
        self.assertNotIn("Bodies in space", report.table(self.read(content)))
        in_space = step("pyroclast", 43_000, 1, [8e6])
        for run in in_space:
            run["run_name"] = "solid/pyroclast/cracked/blocks:1000/threads:1/real_time"
        content["benchmarks"] += [*in_space, *repetitions("solid_kernel/zones/cracked/blocks:1000/threads:1", "zone_steps",
                                                          [16e6])]
        plane, _, space = report.table(self.read(content)).partition("Bodies in space")
        self.assertNotIn("| 43,000", plane)
        self.assertIn("| 43,000", space)
        self.assertNotIn("| 27,000", space)
        self.assertIn("| zones | cracked | 62.50 | 16.0", space)

    def test_without_counts_there_is_no_roofline(self) -> None:
        self.assertNotIn("roofline", report.table(self.read(measured())))

    def roofline(self, **cost: float) -> list[str]:
        """The cells of the one row about the roofline."""
        text = report.table(self.read(measured(**cost)))
        _, _, rows = text.partition("of roofline")
        row = next(line for line in rows.splitlines() if line.startswith("| 27,000"))
        return [cell.strip() for cell in row.strip("|").split("|")]

    def test_roofline_takes_the_level_that_holds_the_working_set(self) -> None:
        # 27,000 zones and 22e6 zone-steps/s are 814.8 steps/s. L3 allows 100e9 / 100e6 = 1000 steps/s.
        self.assertEqual(self.roofline(flops_per_step=1e6, bytes_per_step=100e6, working_set=20e6)[7:9],
                         ["81.5 %", "L3"])
        # L2 allows 200e9 / 100e6 = 2000.
        self.assertEqual(self.roofline(flops_per_step=1e6, bytes_per_step=100e6, working_set=0.9e6)[7:9],
                         ["40.7 %", "L2"])

    def test_where_bytes_are_few_the_peak_binds(self) -> None:
        # it allows 70e9 / 70e6 = 1000
        self.assertEqual(self.roofline(flops_per_step=70e6, bytes_per_step=1e6, working_set=20e6)[7:9],
                         ["81.5 %", "peak"])

    def test_two_threads_are_held_against_the_roofs_of_two(self) -> None:
        # 33e6 / 27,000 = 1222.2 steps/s; L3 gives two threads 120e9 / 80e6 = 1500
        self.assertEqual(self.roofline(flops_per_step=1e6, bytes_per_step=80e6, working_set=20e6)[9:],
                         ["81.5 %", "L3"])

    def test_counts_are_given_by_zone(self) -> None:
        self.assertEqual(self.roofline(flops_per_step=2.7e6, bytes_per_step=5.4e6, working_set=20e6)[2:7],
                         ["100", "200", "0.50", "800", "20.0"])

    def test_a_part_of_the_step_is_given_as_time_and_share(self) -> None:
        # 50e6 zone-steps/s are 20 ns each; the whole step makes 22e6
        text = report.table(self.read(measured()))
        self.assertIn("| zones | cracked | 20.00 | 50.0 ± 0 % | 44.0 % |", text)
        # no intact step was measured
        self.assertIn("| motion | intact | 25.00 | 40.0 ± 0 % | – |", text)

    def test_parts_stand_in_the_order_of_a_step(self) -> None:
        text = report.table(self.read(measured()))
        self.assertLess(text.index("| motion | intact |"), text.index("| contacts | cracked |"))
        self.assertLess(text.index("| contacts | cracked |"), text.index("| zones | cracked |"))

    def test_two_threads_have_two_private_caches_but_one_shared_one(self) -> None:
        machine = self.read(measured()).machine
        self.assertEqual(machine.level(1.5e6, 1), "L3")
        self.assertEqual(machine.level(1.5e6, 2), "L2")
        self.assertEqual(machine.level(40e6, 2), "memory")

    def test_the_peer_is_compared_by_updates_per_second_over_all_its_runs(self) -> None:
        # 200,000 x 50 over 2, 4, 5 s, twice: median 2.5e6/s; ours 19e6/s
        text = report.table(self.read(measured(), YADE, YADE))
        row = next(line for line in text.splitlines() if line.startswith("| cracked"))
        self.assertIn("| 25,000 | 200,000 | 30.0 % | 2 | 2.5 ±", row)
        self.assertTrue(row.endswith("| 7.6 |"), row)

    def test_writes_table_and_figure(self) -> None:
        path = self.write("bench.json", measured(flops_per_step=1e6, bytes_per_step=1e8, working_set=2e7))
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            self.assertEqual(report.main([str(path), "--out", str(self.folder / "out")]), 0)
        self.assertIn("| 27,000 |", printed.getvalue())
        self.assertEqual((self.folder / "out" / "performance.png").read_bytes()[:4], b"\x89PNG")
        self.assertIn("| 27,000 |", (self.folder / "out" / "table.md").read_text(encoding="utf-8"))

    def test_a_file_that_is_something_else_is_named(self) -> None:
        path = self.write("bench.json", {"benchmarks": []})
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.assertEqual(report.main([str(path), "--out", str(self.folder)]), 1)
        self.assertIn("bench.json", said.getvalue())


if __name__ == "__main__":
    unittest.main()
