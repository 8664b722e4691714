"""Which module of src/pyroclast may include which."""

import pathlib
import re
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).parents[2] / "src" / "pyroclast"

# A module is a folder of src/pyroclast. It may include itself and the modules above it in this list.
MODULES = [
    "base",
    "laws",
    "units",
    "deck",
    "tables",
    "specimen",
    "material",
    "model",
    "thermal",
    "moisture",
    "mechanics",
    "plugin",
    "simulation",
    "stages",
    "setup",
    "results",
    "session",
    "parallel",
    "app",
    "python",
]

# Exceptions: what a module must not include all the same, and the files of it that may.
# What computes knows no deck: it can be used without one.
NEVER = {
    "tables": {"deck": ["read_choice.hpp", "read_choice.cpp"]},
    "specimen": {"units": [], "deck": []},
    "material": {"deck": ["curve_reader.hpp", "curve_reader.cpp"]},
    "model": {"units": [], "deck": []},
    "thermal": {"units": [], "deck": []},
    "moisture": {"units": [], "deck": []},
    "mechanics": {"units": [], "deck": []},
    "plugin": {"units": [], "deck": []},
    "simulation": {"units": [], "deck": []},
    "python": {"app": []},
}

# Written by the build.
GENERATED = {"version.hpp": "results"}  # a module that may include it, and all below

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def faults(source: pathlib.Path) -> list[str]:
    """Every include below a folder that breaks the rules, as 'file: what is wrong'."""
    found = []
    files = sorted(path for path in source.rglob("*") if re.search(r"\.[chi]pp(\.in)?$|\.h$|\.cuh?$", path.name))
    for path in files:
        name = path.relative_to(source)
        module = name.parts[0]
        if module not in MODULES:
            found.append(f"{name}: its folder is not in the list of modules")
            continue
        for quote, included in INCLUDE.findall(path.read_text()):
            if not included.startswith("pyroclast/"):
                if quote == '"':
                    found.append(f'{name}: "{included}" should be "pyroclast/...", so that its module shows')
                continue
            other = included.split("/")[1]
            if other in GENERATED:
                other = GENERATED[other]
            if other not in MODULES:
                found.append(f"{name}: {included} is of no module in the list")
            elif MODULES.index(other) > MODULES.index(module):
                found.append(f"{name}: {included} is of a module below {module}")
            elif path.name not in NEVER.get(module, {}).get(other, [path.name]):
                found.append(f"{name}: {module} must not include {other} ({included})")
    return found


class Includes(unittest.TestCase):
    def test_the_modules_include_only_what_they_may(self):
        self.assertEqual(faults(SOURCE), [])

    def faults_of(self, file: str, text: str) -> list[str]:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / file
            path.parent.mkdir(parents=True)
            path.write_text(text)
            return faults(pathlib.Path(folder))

    def test_a_module_may_include_itself_what_is_above_it_and_other_libraries(self):
        text = '#pragma once\n#include <vector>\n#include "pyroclast/mechanics/b.hpp"\n#include "pyroclast/base/c.hpp"\n'
        self.assertEqual(self.faults_of("mechanics/step/a.hpp", text), [])

    def test_a_module_must_not_include_what_is_below_it(self):
        self.assertEqual(self.faults_of("model/a.cpp", '#include "pyroclast/mechanics/b.hpp"\n'),
                         ["model/a.cpp: pyroclast/mechanics/b.hpp is of a module below model"])
        self.assertEqual(self.faults_of("model/a.cpp", "  # include <pyroclast/mechanics/b.hpp>\n"),
                         ["model/a.cpp: pyroclast/mechanics/b.hpp is of a module below model"])

    def test_what_computes_must_not_include_the_deck(self):
        self.assertEqual(self.faults_of("mechanics/a.hpp", '#include "pyroclast/deck/deck.hpp"\n'),
                         ["mechanics/a.hpp: mechanics must not include deck (pyroclast/deck/deck.hpp)"])

    def test_of_the_material_only_the_reader_of_curves_may_include_the_deck(self):
        text = '#include "pyroclast/deck/deck.hpp"\n'
        self.assertEqual(self.faults_of("material/curve_reader.hpp", text), [])
        self.assertEqual(self.faults_of("material/concrete.hpp", text),
                         ["material/concrete.hpp: material must not include deck (pyroclast/deck/deck.hpp)"])

    def test_a_folder_that_is_not_in_the_list_is_refused(self):
        self.assertEqual(self.faults_of("rubble/a.hpp", ""),
                         ["rubble/a.hpp: its folder is not in the list of modules"])
        self.assertEqual(self.faults_of("app/a.cpp", '#include "pyroclast/rubble/a.hpp"\n'),
                         ["app/a.cpp: pyroclast/rubble/a.hpp is of no module in the list"])

    def test_an_include_that_hides_its_module_is_refused(self):
        self.assertEqual(len(self.faults_of("base/a.cpp", '#include "../app/b.hpp"\n')), 1)


if __name__ == "__main__":
    unittest.main()
