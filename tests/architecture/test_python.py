"""Imports of the Python package run one way, down its floors; a name of a class stands for one thing; docstrings of
functions begin with a verb."""

import ast
import pathlib
import re
import tempfile
import unittest

PACKAGE = pathlib.Path(__file__).parents[2] / "python" / "pyroclast"
FLOORS = (
    ("_core", "errors", "libraries", "parallel", "programs", "texts", "writing"),
    ("stored",),
    ("live",),
    ("draw",),
    ("display",),
    ("doctor", "figures", "manual", "report", "study", "watch"),
    ("",),  # the package itself, which hands names on
)
"""From the ground up: the files and folders of the package. A module imports from its own floor and from those below
it."""


NO_NOUNS = {"After", "Against", "As", "At", "Before", "Beside", "By", "For", "From", "In", "Of", "On", "Over", "Returns",
            "That", "Until", "With", "Without"}
NO_VERBS = {"As", "Columns", "Curves", "Files", "Fields", "Frames", "Its", "Lines", "Points", "Results", "Rows", "This",
            "Values"}


def modules(package: pathlib.Path) -> dict[str, pathlib.Path]:
    """Returns the files of a package, stubs of compiled modules among them, by names such as "study.file"; a package
    has the name of its folder, "" at the top.
    """
    found = {}
    for path in sorted([*package.rglob("*.py"), *package.rglob("*.pyi")]):
        parts = path.relative_to(package).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def statements(tree: ast.AST) -> list[ast.Import | ast.ImportFrom]:
    """Returns imports at any depth, those that only a type checker sees among them."""
    return [node for node in ast.walk(tree) if isinstance(node, (ast.Import, ast.ImportFrom))]


def imports(package: pathlib.Path) -> dict[str, list[str]]:
    """Returns the modules of the package that each of them imports, in its functions too."""
    there = modules(package)
    found = {}
    for name, path in there.items():
        own = name.split(".") if name else []
        folder = own if path.name == "__init__.py" else own[:-1]
        named = []
        for statement in statements(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(statement, ast.Import):
                bases = [alias.name.split(".") for alias in statement.names]
                named += [".".join(base[1:]) for base in bases if base[0] == package.name]
                continue
            module = statement.module.split(".") if statement.module else []
            if statement.level:
                module = [*folder[:len(folder) + 1 - statement.level], *module]
            elif module and module[0] == package.name:
                module = module[1:]
            else:
                continue
            below = [".".join([*module, alias.name]) for alias in statement.names]
            named += [entry if entry in there else ".".join(module) for entry in below]
        found[name] = sorted({entry for entry in named if entry in there})
    return found


def circles(package: pathlib.Path) -> list[str]:
    """Returns circles of imports, as "a -> b -> a": for each import that closes one, one of the shortest."""
    arrows = imports(package)
    found = set()
    for start, firsts in arrows.items():
        before = {first: start for first in firsts}
        queue = list(firsts)
        for module in queue:  # grows on the way
            for following in arrows[module]:
                if following not in before:
                    before[following] = module
                    queue.append(following)
        if start in before:
            circle = [before[start]]
            while circle[-1] != start:
                circle.append(before[circle[-1]])
            circle.reverse()
            least = circle.index(min(circle))
            circle = circle[least:] + circle[:least]
            found.add(" -> ".join([*circle, circle[0]]))
    return sorted(found)


def floor_of(module: str) -> int | None:
    """Returns the number of a module's floor; None where FLOORS does not have it."""
    return next((number for number, names in enumerate(FLOORS) if module.split(".")[0] in names), None)


def climbs(package: pathlib.Path) -> list[str]:
    """Returns modules without a floor, and imports from a floor above, as "a: above it stands b"."""
    found = []
    for module, named in imports(package).items():
        floor = floor_of(module)
        if floor is None:
            found.append(f"{module}: has no floor; name it in FLOORS")
            continue
        found += [f"{module}: above it stands {other}" for other in named if (floor_of(other) or 0) > floor]
    return found


def twice(package: pathlib.Path) -> list[str]:
    """Returns classes of one name, as "Name: file, file"; what begins with an underscore is its module's own."""
    files: dict[str, list[str]] = {}
    for path in sorted(package.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                files.setdefault(node.name, []).append(path.relative_to(package).as_posix())
    return [f"{name}: {', '.join(some)}" for name, some in sorted(files.items())
            if len(some) > 1]


def members(package: pathlib.Path, file: str, of: str) -> list[str]:
    """Returns the public members of a class: its functions, what its body names, and what its functions set."""
    tree = ast.parse((package / file).read_text(encoding="utf-8"))
    found = next(node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == of)
    names = {node.name for node in found.body if isinstance(node, ast.FunctionDef)}
    for node in ast.walk(found):
        if isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            names |= {target.id for target in targets if isinstance(target, ast.Name) and node in found.body}
            names |= {target.attr for target in targets if isinstance(target, ast.Attribute)
                      and isinstance(target.value, ast.Name) and target.value.id == "self"}
    return sorted(name for name in names if not name.startswith("_"))


def without_verb(package: pathlib.Path) -> list[str]:
    """Returns functions whose docstring begins with no word like "Returns", and properties and classes whose docstring
    begins with "Returns" or a preposition, as "file:line name".
    """
    found = []
    for path in [*package.rglob("*.py"), *package.rglob("*.pyi")]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, (ast.FunctionDef, ast.ClassDef)) or not (told := ast.get_docstring(node)):
                continue
            first = told.split()[0].rstrip(",;.:")
            is_function = isinstance(node, ast.FunctionDef) and not any("property" in ast.unparse(decorator)
                                                                        for decorator in node.decorator_list)
            if (first in NO_VERBS or not re.fullmatch("[A-Z][a-z]+s", first)) if is_function else first in NO_NOUNS:
                found.append(f"{path.relative_to(package).as_posix()}:{node.lineno} {node.name}")
    return sorted(found)


class Package(unittest.TestCase):
    def package(self, files: dict[str, str]) -> pathlib.Path:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        package = pathlib.Path(folder.name) / "pyroclast"
        for name, text in files.items():
            (package / name).parent.mkdir(parents=True, exist_ok=True)
            (package / name).write_text(text)
        return package

    def test_there_is_no_circle_of_imports(self):
        self.assertEqual(circles(PACKAGE), [])

    def test_a_circle_is_found(self):
        files = {"one.py": "from .two import f\n", "two.py": "def f():\n    from . import three\n",
                 "three.py": "import pyroclast.one\n", "four.py": "from .five import x\n",
                 "five.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .four import y\n"
                            "else:\n    from .part import z\n",
                 "part/__init__.py": "from . import inner\n", "part/inner.py": "from ..part.other import a\n",
                 "part/other.py": "from .inner import b\n"}
        self.assertEqual(circles(self.package(files)),
                         ["five -> four -> five", "one -> two -> three -> one",
                          "part.inner -> part.other -> part.inner"])

    def test_imports_go_down_the_floors(self):
        self.assertEqual(climbs(PACKAGE), [])

    def test_an_import_from_above_is_found_and_so_is_a_file_without_a_floor(self):
        files = {"errors.py": "", "stored/results.py": "def f():\n    from ..draw import style\n",
                 "draw/style.py": "from ..errors import Error\nfrom ..stored.results import f\n",
                 "live/run.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from ..watch import Watch\n",
                 "watch.py": "", "mine.py": "", "other/new.py": ""}
        self.assertEqual(climbs(self.package(files)),
                         ["live.run: above it stands watch", "mine: has no floor; name it in FLOORS",
                          "other.new: has no floor; name it in FLOORS", "stored.results: above it stands draw.style"])

    def test_figures_import_openly_what_they_draw(self):
        self.assertEqual([path.name for path in sorted((PACKAGE / "draw").glob("*.py"))
                          if "TYPE_CHECKING" in path.read_text(encoding="utf-8")], [])

    def test_results_are_what_is_in_the_folder(self):
        # what follows from it has classes of its own: Heated, Compressed
        self.assertLess(len(members(PACKAGE, "stored/results.py", "Results")), 30)

    def test_members_are_counted(self):
        files = {"one.py": "class Run:\n    kind = 1\n    _own: int = 2\n    def __init__(self):\n"
                           "        self.folder = self._secret = 3\n        local = 4\n    def walk(self): pass\n"}
        self.assertEqual(members(self.package(files), "one.py", "Run"), ["folder", "kind", "walk"])

    def test_docstrings_of_functions_begin_with_a_verb_and_others_with_a_noun(self):
        self.assertEqual(without_verb(PACKAGE), [])

    def test_a_docstring_without_a_verb_is_found(self):
        files = {"one.py": "def f():\n    'Of a run.'\ndef g():\n    'Returns a run.'\ndef h(): pass\n"
                           "class Run:\n    'A run.'\n    @property\n    def length(self):\n        'Its length.'\n"
                           "    @property\n    def title(self):\n        'Of the deck.'\n"
                           "    def walk(self):\n        'Rows of the table.'\n"}
        self.assertEqual(without_verb(self.package(files)), ["one.py:1 f", "one.py:12 title", "one.py:14 walk"])

    def test_no_class_has_the_name_of_another(self):
        self.assertEqual(twice(PACKAGE), [])

    def test_two_of_a_name_are_found(self):
        files = {"one.py": "class Run:\n    class Part: pass\n", "two.py": "class Run: pass\nclass _Own: pass\n",
                 "part/three.py": "class Part: pass\nclass _Own: pass\n"}
        self.assertEqual(twice(self.package(files)), ["Part: one.py, part/three.py", "Run: one.py, two.py"])


if __name__ == "__main__":
    unittest.main()
