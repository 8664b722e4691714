"""A page's shell: texts and data inside it, and modules that are joined into its one script."""

import graphlib
import pathlib
import re
import tempfile
import unittest

from pyroclast.report import shell
from pyroclast.report.shell import joined, page

PANES = {"curve_pane.js", "specimen_pane.js", "piece_table.js", "probes.js", "tabs.js"}
MODULES = pathlib.Path(shell.__file__).parent / "page"


class Shell(unittest.TestCase):
    def test_texts_are_escaped_and_unseen_characters_written_out(self):
        made = page("index.html", title="<b>\x1b[31m</b>", entries=[])
        self.assertIn("&lt;b&gt;\\x1b[31m&lt;/b&gt;", made)
        self.assertNotIn("\x1b", made)

    def test_data_end_no_script_and_gaps_are_null(self):
        made = page("run.html", "packing.js", {"a": "</script><script>", "b": float("nan")}, title="t", outcome="",
                    facts=[], level="good", cards=[], reasons=[], notes=[], stages=[], has_body=False, steps=[],
                    specimen=[], gradation=[], deck="", changes=[], made=[], can_crack=False,
                    has_properties=False, is_solid=False)
        self.assertIn('{"a":"\\u003c/script>\\u003cscript>","b":null}', made)


class Modules(unittest.TestCase):
    def joined(self, first: str, **modules: str) -> str:
        """Returns the script of modules, by name without ending."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for name, text in modules.items():
            (pathlib.Path(folder.name) / f"{name}.js").write_text(text, encoding="utf-8")
        return joined(first, pathlib.Path(folder.name))

    def test_a_module_stands_once_behind_all_that_it_imports_and_exports_what_it_says(self):
        script = self.joined(
            "page.js",
            page='import {a} from "./one.js";\nimport {\n  $,\n  Two,\n} from "./two.js";\nnew Two($(a));\n',
            one="export const a = 1;\nconst hidden = 2;\n",
            two='import {a} from "./one.js";\nexport class Two {}\nexport async function $() {}\n',
            other="never;\n")
        self.assertEqual(re.findall(r'modules\["(\w+)\.js"\] = \(', script), ["one", "two", "page"])
        self.assertEqual(re.findall(r"^return (.*);$", script, re.MULTILINE), ["{a}", "{Two, $}", "{}"])
        self.assertIn('const {a} = modules["one.js"];\nconst {\n  $,\n  Two,\n} = modules["two.js"];', script)
        self.assertNotIn("never", script)
        self.assertNotRegex(script, r"\b(import|export)\b")

    def test_what_cannot_be_joined_is_refused(self):
        with self.assertRaisesRegex(graphlib.CycleError, r"'one\.js', 'two\.js'|'two\.js', 'one\.js'"):
            self.joined("one.js", one='import {b} from "./two.js";\nexport const a = 1;\n',
                        two='import {a} from "./one.js";\nexport const b = 1;\n')
        with self.assertRaisesRegex(FileNotFoundError, r"gone\.js"):
            self.joined("one.js", one='import {a} from "./gone.js";\n')
        for line in ('import {a, hidden} from "./two.js";', 'import {a as hidden} from "./two.js";'):
            with self.assertRaisesRegex(ValueError, r"one\.js imports .*hidden, which two\.js does not export"):
                self.joined("one.js", one=f"{line}\n", two="export const a = 1;\nconst hidden = 1;\n")
        for line in ('import "./two.js";', 'import * as two from "./two.js";', "export let a = 1;", "export default 1;",
                     'import {a} from "https://example.org/two.js";'):
            with self.assertRaisesRegex(ValueError, rf"one\.js has a line .*: {re.escape(line)}"):
                self.joined("one.js", one=f"{line}\n", two="export const a = 1;\n")

    def test_panes_know_nothing_of_one_another_and_every_import_is_used(self):
        for path in MODULES.glob("*.js"):
            text = path.read_text(encoding="utf-8")
            imports = re.findall(r'^import \{([^}]*)\} from "\./(.*)";$', text, re.MULTILINE)
            if path.name in PANES:
                self.assertFalse(PANES & {name for _, name in imports}, path.name)
            for name in (name.strip() for names, _ in imports for name in names.split(",")):
                self.assertGreater(len(re.findall(rf"(?<![\w$]){re.escape(name)}(?![\w$])", text)), 1,
                                   f"{path.name} imports {name}")


if __name__ == "__main__":
    unittest.main()
