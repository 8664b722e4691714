"""Promise: a name of a type means one thing in the C++ headers."""

import collections
import pathlib
import re
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).parents[2] / "src" / "pyroclast"

_NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)
_BRACE = re.compile(
    r"(?P<namespace>namespace\s+[\w:]*\s*\{)"
    r"|\b(?:struct|class|enum(?:\s+class)?)\s+(?:\[\[[^\]]*\]\]\s*)?(?:alignas\(\w+\)\s+)?(?:PYROCLAST_\w+\s+)?"
    r"(?P<type>\w+)(?:\s+final)?\s*(?::[^;{()]*)?\{"
    r"|(?P<open>\{)|(?P<close>\})")


def types(text: str) -> list[str]:
    """Types that a header defines at the level of a namespace."""
    inside, found = [], []
    for brace in _BRACE.finditer(_NOT_CODE.sub(" ", text)):
        if brace["close"]:
            if inside:
                inside.pop()
            continue
        if brace["type"] and set(inside) <= {"namespace"}:
            found.append(brace["type"])
        inside.append("namespace" if brace["namespace"] else "")
    return found


def repeated(source: pathlib.Path) -> dict[str, list[str]]:
    """Types by name that more than one header defines."""
    places = collections.defaultdict(list)
    for path in sorted(source.rglob("*.hpp")):
        for name in types(path.read_text()):
            places[name].append(str(path.relative_to(source)))
    return {name: where for name, where in places.items() if len(where) > 1}


class Names(unittest.TestCase):
    def test_a_type_is_defined_once(self):
        self.assertEqual(repeated(SOURCE), {})

    def test_what_is_looked_for_is_found(self):
        text = '''#pragma once
namespace pyroclast {
template <int Dim>
struct alignas(64) Line { struct Inner {}; };  // struct Said {
class Load final : public Stage { enum class Kind : int { force }; };
enum class Pass : std::uint8_t { move };
namespace deep { struct PYROCLAST_LASTING Far { const char* text = "struct Quoted {"; }; }
class Declared;
}
'''
        self.assertEqual(types(text), ["Line", "Load", "Pass", "Far"])
        with tempfile.TemporaryDirectory() as folder:
            for name in ("one.hpp", "two.hpp"):
                (pathlib.Path(folder) / name).write_text(text)
            self.assertEqual(repeated(pathlib.Path(folder))["Load"], ["one.hpp", "two.hpp"])


if __name__ == "__main__":
    unittest.main()
