"""Studies of bodies: cases with changes, each run with some seeds, and one table of what they bear."""

import argparse
import dataclasses
import functools
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import runs


CONTACTS_OF_TWO_DAMAGES = """[contacts.mortar_mortar]
f_t = "2.5 MPa"
G_f1 = "60 N/m"
f_cm = "100 MPa"
beta = 0.05
c_o = "6 MPa"
c_res = "0.06 MPa"
phi = "8 deg"
phi_res = "8 deg"
G_f2 = "380 N/m"
"""
"""The paper's law, recalibrated in space: all cases in space had it before one damage."""
GLUED = """[[bearings]]
name = "lower_end"
side = "bottom"
thickness = "20 mm"
contact = "glued"

[[bearings]]
name = "upper_end"
side = "top"
thickness = "20 mm"
contact = "glued"
"""
"""Instead of the platens of cube_3d."""
PULL = """
[[record]]
name = "grip"
kind = "displacement"
set = "upper_end_support"
direction = "y"

[[record]]
name = "load"
kind = "force"
set = "upper_end_support"
direction = "y"

[[stages]]
kind = "drive"
duration = "4 s"
look_interval = "5 ms"

[[stages.drives]]
set = "lower_end_support"
hold = ["x", "y", "z"]

[[stages.drives]]
set = "upper_end_support"
hold = ["x", "z"]

[[stages.drives]]
set = "upper_end_support"
velocity = "0.2 mm/s"
direction = "y"
ramp_time = "100 ms"

[[stages.until]]
record = "load"
share_of_peak = 0.1

[[stages.until]]
record = "grip"
above = "0.4 mm"

[[stages.results]]
name = "P"
kind = "peak"
record = "load"

[[stages.results]]
name = "side"
kind = "given"
value = "80 mm"

[[stages.results]]
name = "f_t"
kind = "formula"
formula = "P / (side * side)"
unit = "MPa"
"""
"""Instead of the stages of cube_3d: the glued ends part a prism."""
PRISM = ["specimen.width=80 mm", "specimen.height=120 mm", "specimen.depth=80 mm", "blocks.count=1445",
         "mechanics.gravity=0 m/s2"]
"""Of 80 mm x 120 mm x 80 mm, with blocks as large as those of the cube."""


@dataclasses.dataclass(frozen=True)
class Body:
    """A case with changes, and the seeds that it is run with."""

    case: str
    changes: list[str] = dataclasses.field(default_factory=list)
    seeds: tuple[int, ...] = (1, 2, 3)

    def but(self, *changes: str) -> "Body":
        """The same with more changes."""
        return dataclasses.replace(self, changes=[*self.changes, *changes])


def with_properties(**values: str) -> list[str]:
    """Changes of the mortar's contacts."""
    return [f"contacts.mortar_mortar.{key}={value}" for key, value in values.items()]


def of_two_damages(case: str, contacts: str = CONTACTS_OF_TWO_DAMAGES + "\n") -> str:
    """The text of a case of space with the paper's law in the place of one damage."""
    text = re.sub(r"^mode_2_energy.*\n", "", case, flags=re.MULTILINE)
    return re.sub(r"^\[contacts\.mortar_mortar\].*?(?=^\[contacts\.)", lambda _: contacts, text,
                  flags=re.MULTILINE | re.DOTALL)


def pulled(text: str) -> str:
    """A prism of the cube's concrete between glued ends."""
    contacts = text.index("[contacts]")
    lines = text[contacts:text.index("[[stages]]")].splitlines()
    return "\n".join([text[:text.index("[platens]")] + GLUED,
                      *(line for line in lines if not line.startswith("platen_friction")), PULL])


def without_covered_fraction(text: str) -> str:
    """Blocks that follow the stones need no share of a block that decides."""
    return "".join(line for line in text.splitlines(True) if not line.startswith("covered_fraction"))


@dataclasses.dataclass(frozen=True)
class Studies:
    """Bodies by study and name, the table of their rows, and what a row has beside the key by which it is known.

    deck_of: the deck of a case. told_of: what a run's folder tells of a body beside its summary, by column.
    """

    table: Path
    folder: Path
    columns: tuple[str, ...]
    bodies: dict[str, dict[str, Body]]
    deck_of: Callable[[str], Path]
    told_of: Callable[[Body, Path], dict[str, Any]]

    def run(self, study: str, only: list[str] | None, seeds: list[int] | None, jobs: int) -> None:
        """Runs each body of a study with each seed that the table lacks. A run that fails is told; the others go on."""
        bodies = self.bodies[study]
        for name in only or ():
            if name not in bodies:
                raise SystemExit(f"{name!r} is no body of {study}; there are: {', '.join(map(repr, bodies))}")
        wanted = [(name, body, seed) for name, body in bodies.items() if not only or name in only
                  for seed in body.seeds if not seeds or seed in seeds]
        table = runs.read_table(self.table)
        makers = [functools.partial(self._row, study, *what) for what in wanted
                  if not runs.stands(table, self._key(study, *what))]
        runs.fill_table(self.table, self.columns, makers, jobs, ("study", "body", "seed"), self._order)

    def rows(self, study: str, name: str) -> list[dict[str, str]]:
        return [row for row in runs.read_table(self.table) if (row["study"], row["body"]) == (study, name)]

    def _row(self, study: str, name: str, body: Body, seed: int) -> dict[str, str]:
        folder, deck = self.folder / f"{study}-{_slug(name)}-{seed}", self.deck_of(body.case)
        runs.run(deck, folder, seed, body.changes, again=False)
        summary = json.loads((folder / "summary.json").read_text())
        results = summary["stages"][-1]["results"]
        told = summary | summary["specimen"] | results | self.told_of(body, folder)
        row = self._key(study, name, body, seed) | {key: told[key] for key in self.columns if key in told}
        return runs.rounded(row)

    def _key(self, study: str, name: str, body: Body, seed: int) -> dict[str, str]:
        deck = self.deck_of(body.case)
        version = runs.physics_version(kinds=runs.kinds(deck, body.changes))
        return {"deck": runs.deck_hash(deck, body.changes), "physics_version": version, "study": study, "body": name,
                "seed": str(seed)}

    def _order(self, row: dict[str, str]) -> tuple[int, int, int]:
        study = list(self.bodies).index(row["study"])
        return study, list(self.bodies[row["study"]]).index(row["body"]), int(row["seed"])


def numbers(rows: list[dict[str, str]], column: str) -> np.ndarray:
    return np.array([float(row[column]) for row in rows if row[column]])


def mean_and_spread(values: np.ndarray, digits: int, of: int) -> str:
    """Mean, standard deviation over seeds, and how many of the rows have a value where some lack one."""
    if not len(values):
        return "none"
    spread = f" ± {values.std(ddof=1):.{digits}f}" if len(values) > 1 else ""
    return f"{values.mean():.{digits}f}{spread}" + (f" ({len(values)} of {of})" if len(values) < of else "")


def ask(description: str, studies: Studies, **shown: Callable[[], None]) -> None:
    """Reads the command line: a study, or something to show of what stands in the table."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=(*studies.bodies, *shown))
    parser.add_argument("--only", nargs="+", metavar="NAME", help="bodies of the study")
    parser.add_argument("--seeds", type=int, nargs="+")
    parser.add_argument("--jobs", type=int, default=2)
    asked = parser.parse_args()
    studies.folder.mkdir(parents=True, exist_ok=True)
    if asked.what in shown:
        shown[asked.what]()
    else:
        studies.run(asked.what, asked.only, asked.seeds, asked.jobs)


def _slug(name: str) -> str:
    return "".join(c if c.isalnum() or c == "." else "-" for c in name)
