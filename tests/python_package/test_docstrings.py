"""Every public name of the package has a docstring, and stands on a page of docs/lookup/python."""

import inspect
import pathlib
import re
import unittest
from functools import cached_property

import pyroclast
from pyroclast import units

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = "".join(page.read_text() for page in (ROOT / "docs/lookup/python").glob("*.md"))
NAMED = re.findall(r"^\.\. auto(?:class|function):: (\S+)$", PAGES, re.MULTILINE)


def found(path: str) -> object:
    """What a dotted path names."""
    module, name = path.rsplit(".", 1)
    return getattr(__import__(module, fromlist=[name]), name)


def text(of: object) -> str:
    """The docstring, without the signature that the compiled part puts first."""
    doc = inspect.cleandoc(getattr(of, "__doc__", None) or "")
    return doc.partition("\n\n")[2] if re.match(r"\w+\(.*\)( -> .*)?$", doc.partition("\n")[0]) else doc


def undocumented(path: str) -> list[str]:
    """Names without a docstring: the thing itself and its public members."""
    thing = found(path)
    missing = [] if text(thing) else [path]
    for name, member in vars(thing).items() if inspect.isclass(thing) else ():
        is_code = callable(member) or isinstance(member, (property, cached_property, classmethod, staticmethod))
        if not name.startswith("_") and is_code and not text(getattr(member, "__func__", member)) and thing is not units.Quantity:
            missing.append(f"{path}.{name}")
    return missing


class Docstrings(unittest.TestCase):
    def test_every_public_name_stands_on_a_page(self):
        names = {path.rsplit(".", 1)[1] for path in NAMED}
        for of_module in pyroclast._PLACES.values():
            for name in of_module:
                if name not in ("commit", "instruction_sets", "version"):
                    if not isinstance(getattr(pyroclast, name), units.Quantity):
                        self.assertIn(name, names)

    def test_all_of_it_has_docstrings(self):
        self.assertGreater(len(NAMED), 25)
        for path in NAMED:
            with self.subTest(path):
                self.assertEqual(undocumented(path), [])

    def test_a_member_without_one_is_found(self):
        class Bare:
            """Has a docstring."""

            def walk(self):
                pass

        units.Bare = Bare
        self.addCleanup(delattr, units, "Bare")
        self.assertEqual(undocumented("pyroclast.live.units.Bare"), ["pyroclast.live.units.Bare.walk"])


if __name__ == "__main__":
    unittest.main()
