"""A Slurm that is none: sbatch, squeue, scontrol and scancel on the PATH, whose tasks are processes of this machine.

It answers as Slurm 22.05 does, as far as studies ask it. A test can let happen to its tasks what happens on clusters.
"""

from __future__ import annotations

import json
import os
import re
import signal
import socketserver
import subprocess
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

_CLIENT = '''#!/usr/bin/python3 -SE
import json, os, socket, sys, time
here = os.path.dirname(os.path.abspath(__file__))
text = sys.stdin.read() if os.path.basename(sys.argv[0]) == "sbatch" and len(sys.argv) > 2 else ""
with socket.socket(socket.AF_UNIX) as server:
    server.connect(here + "/socket")
    words = [os.path.basename(sys.argv[0]), *sys.argv[1:]]
    server.sendall(json.dumps([words, text, os.getcwd(), dict(os.environ)]).encode() + b"\\n")
    code, out, err = json.loads(server.makefile().read())
sys.stdout.write(out)
sys.stderr.write(err)
sys.stderr.flush()
if "sleeping and retrying" in err:
    time.sleep(60.0)
sys.exit(code)
'''


@dataclass
class Task:
    """One of an array. state: as squeue says it; empty where it is no longer in the queue."""

    state: str = "PENDING"
    process: subprocess.Popen | None = None
    starts: int = 0
    goes_back: bool = False


@dataclass
class Job:
    number: int
    options: dict[str, str]
    script: str
    folder: str
    environment: dict[str, str]
    tasks: list[Task]
    at_once: int

    @property
    def is_over(self) -> bool:
        return not any(task.state for task in self.tasks)


@dataclass
class FakeSlurm:
    """largest: MaxArraySize. refusals: what sbatch says, one after the other, instead of taking a job."""

    folder: Path
    largest: int = 1001
    refusals: list[str] = field(default_factory=list)
    is_deaf: bool = False  #: every command fails, as with a controller that is away
    has_requeue: bool = True
    jobs: list[Job] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        self.folder.mkdir()
        for name in ("sbatch", "squeue", "scontrol", "scancel"):
            (self.folder / name).write_text(_CLIENT)
            (self.folder / name).chmod(0o755)
        self._lock = threading.RLock()
        self._is_over = threading.Event()
        fake = self

        class Handler(socketserver.StreamRequestHandler):
            def handle(self) -> None:
                words, text, folder, environment = json.loads(self.rfile.readline())
                self.wfile.write(json.dumps(fake._answer(words, text, folder, environment)).encode())

        self._server = socketserver.ThreadingUnixStreamServer(str(self.folder / "socket"), Handler)
        self._threads = [threading.Thread(target=self._server.serve_forever, args=(0.05,)),
                         threading.Thread(target=self._schedule)]
        for thread in self._threads:
            thread.start()

    def close(self) -> None:
        self._is_over.set()
        self._server.shutdown()
        for thread in self._threads:
            thread.join()
        self._server.server_close()
        for job in self.jobs:
            for task in job.tasks:
                if task.process is not None and task.process.poll() is None:
                    task.process.kill()
                    task.process.wait()

    @property
    def running(self) -> list[tuple[Job, int]]:
        with self._lock:
            return [(job, i) for job in self.jobs for i, task in enumerate(job.tasks) if task.state == "RUNNING"]

    @property
    def is_idle(self) -> bool:
        with self._lock:
            return all(job.is_over for job in self.jobs)

    def cancel(self, job: Job, task: int) -> None:
        """As scancel does: SIGTERM to all its processes; the task is completing until they are gone."""
        with self._lock:
            if job.tasks[task].state == "RUNNING":
                job.tasks[task].state = "COMPLETING"
                worker = job.tasks[task].process
                children = Path(f"/proc/{worker.pid}/task/{worker.pid}/children").read_text().split()
                for pid in [*map(int, children), worker.pid]:
                    os.kill(pid, signal.SIGTERM)
            elif job.tasks[task].state == "PENDING":
                job.tasks[task].state = ""

    def vanish(self, job: Job, task: int) -> None:
        """As with a node that dies, of a task that does not go back into the queue."""
        with self._lock:
            job.tasks[task].process.kill()
            job.tasks[task].process.wait()
            job.tasks[task].process, job.tasks[task].state = None, ""

    def warn(self, job: Job, task: int) -> None:
        """As --signal=B:TERM does before the time limit: the batch script alone, in a task that runs."""
        with self._lock:
            assert job.options["signal"].startswith("B:TERM@")
            job.tasks[task].process.terminate()

    def _schedule(self) -> None:
        while not self._is_over.is_set():
            with self._lock:
                for job in self.jobs:
                    for task in job.tasks:
                        if task.process is not None and task.state and task.process.poll() is not None:
                            task.state, task.process, task.goes_back = "PENDING" if task.goes_back else "", None, False
                    self._begin(job)
            time.sleep(0.02)

    def _begin(self, job: Job) -> None:
        before = job.options.get("dependency", "").removeprefix("afterany:")
        if before and not next(j for j in self.jobs if j.number == int(before)).is_over:
            return
        for i, task in enumerate(job.tasks):
            if task.state == "PENDING" and sum(t.process is not None for t in job.tasks) < job.at_once:
                ids = {"SLURM_ARRAY_JOB_ID": str(job.number), "SLURM_ARRAY_TASK_ID": str(i)}
                with open(job.options["output"].replace("%a", str(i)).replace("%%", "%"), "ab") as log:
                    task.process = subprocess.Popen(["sh", "-c", job.script], cwd=job.folder, stdin=subprocess.DEVNULL,
                                                    env={**job.environment, **ids}, stdout=log, stderr=log,
                                                    start_new_session=True)
                task.state = "RUNNING"
                task.starts += 1

    def _answer(self, words: list[str], text: str, folder: str, environment: dict[str, str]) -> tuple[int, str, str]:
        if self.is_deaf:
            return 1, "", f"{words[0]}: error: Unable to contact slurm controller (connect failure)\n"
        with self._lock:
            return getattr(self, f"_{words[0]}")(words[1:], text, folder, environment)

    def _sbatch(self, words: list[str], text: str, folder: str, environment: dict[str, str]) -> tuple[int, str, str]:
        if words == ["--version"]:
            return 0, "slurm-wlm 22.05.8\n", ""
        if self.refusals:
            return 1, "", self.refusals.pop(0)
        options = dict(word.removeprefix("--").partition("=")[::2] for word in words)
        first, last, at_once = map(int, re.fullmatch(r"(\d+)-(\d+)%(\d+)", options["array"]).groups())
        if first != 0 or last >= self.largest:
            return 1, "", "sbatch: error: Batch job submission failed: Invalid job array specification\n"
        if "partition" in options:
            return 1, "", "sbatch: error: invalid partition specified: " + options["partition"] + "\nsbatch: error: Batch " \
                          "job submission failed: Invalid partition name specified\n"
        job = Job(len(self.jobs) + 1, options, text, folder, environment, [Task() for _ in range(last + 1)], at_once)
        self.jobs.append(job)
        return 0, f"{job.number}\n", ""

    def _squeue(self, words: list[str], *ignored: object) -> tuple[int, str, str]:
        options = dict(word.removeprefix("--").partition("=")[::2] for word in words)
        lines = []
        for job in self.jobs:
            for i, task in enumerate(job.tasks):
                if task.state and options.get("jobs", f"{job.number}_{i}") == f"{job.number}_{i}":
                    fields = {"%j": job.options["job-name"], "%F": str(job.number), "%K": str(i), "%T": task.state}
                    lines.append(re.sub("%[a-zA-Z]", lambda found: fields[found[0]], options["format"]) + "\n")
        return 0, "".join(lines), ""

    def _scontrol(self, words: list[str], *ignored: object) -> tuple[int, str, str]:
        if words == ["show", "config"]:
            return 0, f"JobRequeue              = 1\nMaxArraySize            = {self.largest}\n", ""
        if words[0] != "requeue" or not self.has_requeue:
            return 1, "", "Requested operation is presently disabled for job " + words[-1] + "\n"
        number, task = map(int, words[1].split("_"))
        self.jobs[number - 1].tasks[task].goes_back = True
        return 0, "", ""

    def _scancel(self, words: list[str], *ignored: object) -> tuple[int, str, str]:
        for word in words:
            job = self.jobs[int(word) - 1]
            for i in range(len(job.tasks)):
                self.cancel(job, i)
        return 0, "", ""


def on_path(folder: Path) -> str:
    """PATH with a folder in front."""
    return f"{folder}{os.pathsep}{os.environ['PATH']}"
