"""What law-coverage and law-mutations share: which laws there are, and how one is compiled with the kit alone."""

import os
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LAWS = ROOT / "src/pyroclast/laws"
COMPILER = os.environ.get("CXX", "g++")
FLAGS = ["-std=c++20", "-ffp-contract=off", "-fno-math-errno"]
# Of what does not depend on a law, compiled once.
SHARED = ["src/pyroclast/laws/kit.cpp", "src/pyroclast/laws/contact_properties.cpp", "src/pyroclast/base/range.cpp"]


def laws():
    """{name of the struct: its header} of the built-in laws."""
    text = re.sub(r"//.*", "", (LAWS / "built_in.hpp").read_text())
    listed = re.search(r"using BuiltInLaws = LawList<(.*?)>;", text, re.S).group(1)
    headers = {}
    for name in re.findall(r"\w+", listed):
        headers[name] = next(h for h in sorted(LAWS.glob("*.hpp")) if re.search(rf"^struct {name}\b.*{{", h.read_text(),
                                                                                re.M))
    return headers


def run(*words, **options):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, **options)


def compile_to(output, *words):
    done = run(COMPILER, *FLAGS, *words, "-I", ROOT / "src", "-o", output)
    if done.returncode:
        raise RuntimeError(done.stderr)


def shared_objects(folder):
    """Objects of what every law links, compiled into a folder."""
    objects = []
    for source in SHARED:
        objects.append(folder / (Path(source).stem + ".o"))
        compile_to(objects[-1], "-O2", "-c", ROOT / source)
    # The kit needs no rows of the step, but the tables of laws point at them.
    rows = folder / "no_rows.cpp"
    rows.write_text('#include "pyroclast/laws/built_in.hpp"\n#include "pyroclast/mechanics/compiled_for_sets.hpp"\n' +
                    "".join(f"const pyroclast::CompiledForSets pyroclast::{name}::compiled{{}};\n" for name in laws()))
    objects.append(folder / "no_rows.o")
    compile_to(objects[-1], "-O2", "-c", rows)
    return objects


def law_flags(name, header):
    return [f"-DLAW={name}", f'-DLAW_HEADER="pyroclast/laws/{header.name}"']
