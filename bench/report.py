#!/usr/bin/python3
"""Table and figure of the bench.

    bench/report.py BENCH.json [YADE.json...] --out DIR     DIR/table.md, DIR/performance.png

BENCH.json is Google Benchmark's output of pyroclast_bench, with repetitions; the others are what
yade_concrete.py wrote. Values are medians over the repetitions; ± is half their range. What runs on one thread is
rated by the processor time it took, which other work on the machine changes little; on two threads, by the clock.
"""

from __future__ import annotations

import argparse
import json
import statistics
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))

import matplotlib  # noqa: E402
import matplotlib.ticker  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402

from pyroclast.draw import style  # noqa: E402

_NANO, _MEGA, _GIGA = 1e-9, 1e6, 1e9
_CASE_ZONES = 27_000  #: as pyroclast_bench names the specimen of cases/compression.toml
_LOADINGS = ("intact", "cracked")
_PARTS = ("contacts", "gather", "zones", "motion")  #: in the order of a step


class BenchError(Exception):
    """Something is missing or malformed."""


@dataclass(frozen=True)
class Rate:
    """A rate, 1/s, over the repetitions of a measurement."""

    values: tuple[float, ...]

    @property
    def median(self) -> float:
        return statistics.median(self.values)

    @property
    def spread(self) -> float:
        """Half the range over the median."""
        return 0.5 * (max(self.values) - min(self.values)) / self.median


@dataclass(frozen=True)
class Cost:
    """What a step costs at least, as pyroclast_bench counts it."""

    flops: float
    bytes: float
    working_set: float  #: bytes
    memory: float  #: all arrays of the body, bytes


@dataclass(frozen=True)
class Step:
    """A timed step: one code, one state, one size, one number of threads."""

    zones: int
    contacts: int
    threads: int
    damaged: float  #: share of the contact points
    zone_steps: Rate
    zone_steps_by_clock: Rate  #: whatever the number of threads
    contact_updates: Rate
    cost: Cost | None


@dataclass(frozen=True)
class Kernel:
    """A timed part of the step, on one thread."""

    part: str
    loading: str
    size: int  #: number of zones or blocks in the name of the benchmark
    zone_steps: Rate


@dataclass(frozen=True)
class Roof:
    """What the machine allows a step."""

    steps: float  #: 1/s
    binds: str  #: what sets it: the peak, or the bandwidth of a level of memory


@dataclass(frozen=True)
class Machine:
    """What the machine gives at most, by number of threads."""

    processor: str
    compiler: str
    peak: dict[int, Rate]  #: flop/s
    bandwidth: dict[tuple[str, int], Rate]  #: B/s by level and threads
    capacity: dict[str, tuple[int, int]]  #: of each level of cache: bytes, threads that share one
    load: float  #: mean number of other running programs in the minute before

    def level(self, working_set: float, threads: int) -> str:
        """The first level of memory that holds a working set shared out among threads."""
        for level, (size, sharing) in self.capacity.items():
            if working_set <= size * max(1, threads // sharing):
                return level
        return "memory"

    def roofline(self, cost: Cost, threads: int) -> Roof | None:
        """The lower of the two roofs; None where the peak or that level was not measured."""
        level = self.level(cost.working_set, threads)
        bandwidth = self.bandwidth.get((level, threads))
        peak = self.peak.get(threads)
        if bandwidth is None or peak is None:
            return None
        return min(Roof(peak.median / cost.flops, "peak"), Roof(bandwidth.median / cost.bytes, level),
                   key=lambda roof: roof.steps)


@dataclass(frozen=True)
class Peer:
    """Yade's concrete model in one state."""

    program: str
    spheres: int
    interactions: int
    damaged: float
    collider_runs: int
    updates: Rate


@dataclass
class Bench:
    """All that was measured of specimens in the plane, or of bodies in space."""

    machine: Machine
    steps: dict[tuple[str, str, int, int], Step] = field(default_factory=dict)  #: by code, loading, size, threads
    kernels: list[Kernel] = field(default_factory=list)
    peers: dict[str, Peer] = field(default_factory=dict)  #: by loading
    in_space: Bench | None = None  #: beside that of specimens in the plane

    def sizes(self) -> list[int]:
        return sorted({size for _, _, size, _ in self.steps})


def read_bench(path: Path, peers: Sequence[Path] = ()) -> Bench:
    """Reads what was measured. Throws BenchError when a file is missing or malformed."""
    content = _read_json(path)
    try:
        bench = _bench_of(content)
        bench.peers = _peers_of([_read_json(peer) for peer in peers])
    except (KeyError, ValueError, TypeError, IndexError) as error:
        raise BenchError(f"{path}: is not what pyroclast_bench writes: {error!r}") from None
    return bench


def _read_json(path: Path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise BenchError(f"{path}: cannot be read: {error}") from error


def _bench_of(content: dict) -> Bench:
    runs: dict[str, list[dict]] = {}
    for run in content["benchmarks"]:
        if run["run_type"] == "iteration":
            runs.setdefault(run["run_name"].removesuffix("/real_time"), []).append(run)
    context = content["context"]
    capacity = {f"L{cache['level']}": (cache["size"], cache["num_sharing"])
                for cache in context["caches"] if cache["type"] != "Instruction"}
    machine = Machine(context.get("processor", "unknown"), context.get("compiler", "unknown"), {}, {}, capacity,
                      context["load_avg"][0])
    bench = Bench(machine)
    for name, repetitions in runs.items():
        kind, *parts = name.split("/")
        if kind == "peak":
            machine.peak[_number(parts[0])] = _rate(repetitions, "flops_per_s")
        elif kind == "triad":
            machine.bandwidth[parts[0], _number(parts[1])] = _rate(repetitions, "bytes_per_s")
        elif kind in ("step", "solid"):
            code, loading, size, threads = parts
            of = bench if kind == "step" else _in_space(bench)
            of.steps[code, loading, _number(size), _number(threads)] = _step_of(repetitions)
        elif kind in ("kernel", "solid_kernel"):
            part, loading, size, _ = parts
            of = bench if kind == "kernel" else _in_space(bench)
            of.kernels.append(Kernel(part, loading, _number(size), _rate(repetitions, "zone_steps")))
    return bench


def _in_space(bench: Bench) -> Bench:
    bench.in_space = bench.in_space or Bench(bench.machine)
    return bench.in_space


def _step_of(repetitions: list[dict]) -> Step:
    last = repetitions[-1]
    cost = None
    if "flops_per_step" in last:
        cost = Cost(last["flops_per_step"], last["bytes_per_step"], last["working_set"], last["memory"])
    return Step(round(last["zones"]), round(last["contacts"]), round(last["threads"]), last["damaged"],
                _rate(repetitions, "zone_steps"), _rate_by_clock(repetitions, "zone_steps"),
                _rate(repetitions, "contact_updates"), cost)


def _rate_by_clock(repetitions: list[dict], counter: str) -> Rate:
    return Rate(tuple(run[counter] for run in repetitions))


def _rate(repetitions: list[dict], counter: str) -> Rate:
    """By processor time on one thread: Google Benchmark's counters are by the clock."""
    if repetitions[0]["threads"] != 1:
        return _rate_by_clock(repetitions, counter)
    return Rate(tuple(run[counter] * run["real_time"] / run["cpu_time"] for run in repetitions))


def _number(text: str) -> int:
    return int(text.split(":")[1])


def _peers_of(contents: list[dict]) -> dict[str, Peer]:
    """One for each loading, repetitions of all runs together."""
    peers: dict[str, Peer] = {}
    for content in contents:
        for state in content["states"]:
            earlier = peers.get(state["state"])
            values = tuple(state["interactions"] * state["steps"] / seconds for seconds in state["seconds"])
            peers[state["state"]] = Peer(
                content["program"], content["spheres"], state["interactions"], state["damaged"][-1],
                state["collider_runs"] + (earlier.collider_runs if earlier else 0),
                Rate((earlier.updates.values if earlier else ()) + values))
    return peers


def table(bench: Bench) -> str:
    """All of it as Markdown."""
    parts = [f"Other work on the machine when it began: load {bench.machine.load:.1f}.",
             "\n".join(_machine_table(bench.machine)), *_tables(bench)]
    if bench.in_space:
        parts += ["Bodies in space:", *_tables(bench.in_space)]
    return "\n\n".join(parts) + "\n"


def _tables(bench: Bench) -> Iterator[str]:
    yield "\n".join(_step_table(bench))
    if any(step.cost for step in bench.steps.values()):
        yield "\n".join(_roofline_table(bench))
    if bench.kernels:
        yield "\n".join(_kernel_table(bench))
    if bench.peers:
        yield "\n".join(_peer_table(bench))


def _machine_table(machine: Machine) -> Iterator[str]:
    threads = sorted({*machine.peak, *(n for _, n in machine.bandwidth)})
    yield f"| {machine.processor}, {machine.compiler} | " + " | ".join(_threads(n) for n in threads) + " |"
    yield "|---|" + "---:|" * len(threads)
    yield "| peak, multiply-add, GFLOP/s | " + " | ".join(_giga(machine.peak.get(n)) for n in threads) + " |"
    for level in (*machine.capacity, "memory"):
        rates = [machine.bandwidth.get((level, n)) for n in threads]
        if any(rates):
            yield f"| triad, {level}, GB/s | " + " | ".join(map(_giga, rates)) + " |"


def _steps(bench: Bench):
    """Of each body that was timed: its state, and the step on one thread, on two (or none) and of the textbook (or none)."""
    for size in bench.sizes():
        for loading in _LOADINGS:
            if one := bench.steps.get(("pyroclast", loading, size, 1)):
                yield (loading, one, bench.steps.get(("pyroclast", loading, size, 2)),
                       bench.steps.get(("textbook", loading, size, 1)))


def _step_table(bench: Bench) -> Iterator[str]:
    yield ("| zones | contact points | state | damaged | Pyroclast, 1 thread | 2 threads | textbook, 1 thread | "
           "Pyroclast / textbook | 2 threads / 1 |")
    yield "|---:|---:|---|---:|---:|---:|---:|---:|---:|"
    for loading, one, two, textbook in _steps(bench):
        yield (f"| {one.zones:,} | {one.contacts:,} | {loading} | {_percent(one.damaged)} "
               f"| {_mega(one)} | {_mega(two)} | {_mega(textbook)} "
               f"| {_ratio(one, textbook)} | {_speedup(two, one)} |")


def _roofline_table(bench: Bench) -> Iterator[str]:
    yield ("| zones | state | flop / zone-step | bytes / zone-step | flop / byte | memory, bytes / zone "
           "| working set, MB | of roofline, 1 thread | what binds | 2 threads | what binds |")
    yield "|---:|---|---:|---:|---:|---:|---:|---:|---|---:|---|"
    for loading, one, two, _ in _steps(bench):
        if cost := one.cost:
            yield (f"| {one.zones:,} | {loading} | {cost.flops / one.zones:.0f} | {cost.bytes / one.zones:.0f} "
                   f"| {cost.flops / cost.bytes:.2f} | {cost.memory / one.zones:.0f} "
                   f"| {cost.working_set / _MEGA:.1f} "
                   f"| {_of_roofline(bench.machine, one)} | {_of_roofline(bench.machine, two)} |")


def _kernel_table(bench: Bench) -> Iterator[str]:
    yield "| part of the step, 1 thread | state | ns / zone-step | million zone-steps/s | of the step's time |"
    yield "|---|---|---:|---:|---:|"
    for kernel in sorted(bench.kernels, key=lambda k: (_LOADINGS.index(k.loading), _PARTS.index(k.part))):
        yield (f"| {kernel.part} | {kernel.loading} | {1.0 / (kernel.zone_steps.median * _NANO):.2f} "
               f"| {_number_and_spread(kernel.zone_steps, _MEGA)} "
               f"| {_share_of_step(kernel, bench.steps.get(('pyroclast', kernel.loading, kernel.size, 1)))} |")


def _peer_table(bench: Bench) -> Iterator[str]:
    program = next(iter(bench.peers.values())).program
    yield (f"| state | {program}, concrete model, -j1: spheres | interactions | damaged | collider runs "
           "| million interaction updates/s | Pyroclast, 1 thread: contact points | damaged "
           "| million contact-point updates/s | ratio |")
    yield "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    for loading, peer in bench.peers.items():
        ours = bench.steps.get(("pyroclast", loading, _CASE_ZONES, 1))
        if ours is None:
            continue
        yield (f"| {loading} | {peer.spheres:,} | {peer.interactions:,} | {_percent(peer.damaged)} "
               f"| {peer.collider_runs} | {_number_and_spread(peer.updates, _MEGA)} "
               f"| {ours.contacts:,} | {_percent(ours.damaged)} "
               f"| {_number_and_spread(ours.contact_updates, _MEGA)} "
               f"| {ours.contact_updates.median / peer.updates.median:.1f} |")


def _threads(number: int) -> str:
    return f"{number} thread" if number == 1 else f"{number} threads"


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f} %"


def _number_and_spread(rate: Rate, unit: float) -> str:
    return f"{rate.median / unit:.1f} ± {100.0 * rate.spread:.0f} %"


def _giga(rate: Rate | None) -> str:
    return "–" if rate is None else _number_and_spread(rate, _GIGA)


def _mega(step: Step | None) -> str:
    return "–" if step is None else _number_and_spread(step.zone_steps, _MEGA)


def _ratio(above: Step, below: Step | None) -> str:
    if below is None:
        return "–"
    return f"{above.zone_steps.median / below.zone_steps.median:.2f}"


def _speedup(two: Step | None, one: Step) -> str:
    if two is None:
        return "–"
    return f"{two.zone_steps_by_clock.median / one.zone_steps_by_clock.median:.2f}"


def _of_roofline(machine: Machine, step: Step | None) -> str:
    """Two cells: the share, and which roof it is of."""
    roof = machine.roofline(step.cost, step.threads) if step and step.cost else None
    if roof is None:
        return "– | –"
    return f"{_percent(step.zone_steps.median / (roof.steps * step.zones))} | {roof.binds}"


def _share_of_step(kernel: Kernel, step: Step | None) -> str:
    return "–" if step is None else _percent(step.zone_steps.median / kernel.zone_steps.median)


_CODES = {("pyroclast", 1): ("Pyroclast, 1 thread", style.BLUE, "o"),
          ("pyroclast", 2): ("Pyroclast, 2 threads", style.VERMILLION, "s"),
          ("textbook", 1): ("textbook, 1 thread", style.GREEN, "^")}
_DASHES = {"intact": (0, (5, 1.5)), "cracked": "-"}


@matplotlib.rc_context(style.STYLE)
def figure(bench: Bench) -> Figure:
    """Zone-steps per second over the number of zones."""
    drawn = style.new_figure(3.4)
    axes, beside = drawn.subplots(1, 2, width_ratios=(4, 1))
    for (code, threads), (_, colour, marker) in _CODES.items():
        for loading, dashes in _DASHES.items():
            _draw(axes, bench, (code, loading, threads), color=colour, linestyle=dashes, marker=marker)
    handles = [Line2D([], [], color=colour, marker=marker, markersize=4, label=label)
               for label, colour, marker in _CODES.values()]
    handles += [Line2D([], [], color=style.BLACK, linestyle=dashes, label=loading)
                for loading, dashes in _DASHES.items()]
    handles += list(_draw_rooflines(axes, bench))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axes.yaxis.set_minor_formatter(matplotlib.ticker.LogFormatter(minor_thresholds=(2, 0.4)))
    axes.set_xlabel("Number of zones")
    axes.set_ylabel("Million zone-steps per second")
    style.legend_alone(beside, handles, [handle.get_label() for handle in handles], loc="upper left")
    return drawn


def _draw(axes: Axes, bench: Bench, key: tuple[str, str, int], **look) -> None:
    code, loading, threads = key
    steps = [bench.steps[code, loading, zones, threads] for zones in bench.sizes()
             if (code, loading, zones, threads) in bench.steps]
    axes.plot([s.zones for s in steps], [s.zone_steps.median / _MEGA for s in steps], markersize=4, **look)


def _draw_rooflines(axes: Axes, bench: Bench) -> Iterator[Line2D]:
    """What the machine allows the library's step, where that was counted; yields the handles of the legend."""
    for threads, dashes in ((1, (0, (1.5, 1))), (2, (0, (5, 1.5, 1, 1.5)))):
        points = []
        for zones in bench.sizes():
            step = bench.steps.get(("pyroclast", "cracked", zones, threads))
            roof = bench.machine.roofline(step.cost, threads) if step and step.cost else None
            if roof is not None:
                points.append((step.zones, roof.steps * step.zones / _MEGA))
        if points:
            yield axes.plot(*zip(*points), color=style.FAINT, linestyle=dashes,
                            label=f"roofline, {_threads(threads)}")[0]


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(prog="bench/report.py", description="Table and figure of the bench.")
    parser.add_argument("bench", type=Path, metavar="BENCH.json")
    parser.add_argument("peers", type=Path, nargs="*", metavar="YADE.json")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    asked = parser.parse_args(arguments)
    try:
        bench = read_bench(asked.bench, asked.peers)
        text = table(bench)
        print(text)
        print(style.save(figure(bench), asked.out / "performance.png"))
        (asked.out / "table.md").write_text(text, encoding="utf-8")
    except (BenchError, OSError) as problem:
        print(f"bench report: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
