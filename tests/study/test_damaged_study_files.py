"""Study files that are damaged by lot: each is taken, or refused with an error that names it; nothing else happens.

PYROCLAST_DAMAGED: how many (default 300).
"""

import contextlib
import io
import os
import random
import re
import tempfile
import unittest
from pathlib import Path

from pyroclast.errors import Error
from pyroclast.study import store
from pyroclast.study.file import read_setup
from pyroclast.study.plans import plan_of
from study_files import StudyTest, of_deck

DAMAGED = int(os.environ.get("PYROCLAST_DAMAGED", "300"))
ODD_VALUES = ("-1", "0", "1e308", "nan", "inf", "9223372036854775807", '""', '"\\u0000"', "[]", "{}", "true",
              '"1 MPa"', "[1, 2, 3]", '[["1 MPa", 2]]', '"' + "x" * 5000 + '"', "[" * 200 + "]" * 200)
F_T = '[parameters.f_t]\nkey = "contacts.mortar_mortar.f_t"\nuniform = ["2 MPa", "3 MPa"]\n'
METHODS = ('kind = "ensemble"', 'kind = "grid"', 'kind = "lhs"\nsamples = 5', 'kind = "morris"\ntrajectories = 2',
           'kind = "sobol"\nsamples = 8', 'kind = "chaos"\nsamples = 9')


def damaged(text: str, lot: random.Random) -> str:
    lines = text.splitlines() or [""]
    place = lot.randrange(len(lines))
    how = lot.randrange(6)
    if how == 0 or not re.search(r"\d", text):
        return text[:lot.randrange(len(text) or 1)]
    if how == 1:
        del lines[place]
    elif how == 2:
        lines.insert(lot.randrange(len(lines) + 1), lines[place])
    elif how == 3:
        key = lines[place].split("=")[0]
        lines[place] = f"{key}= {lot.choice(ODD_VALUES)}"
    elif how == 4:
        numbers = list(re.finditer(r"\d+(\.\d+)?", text))
        number = lot.choice(numbers)
        return text[:number.start()] + lot.choice(ODD_VALUES) + text[number.end():]
    else:
        at = lot.randrange(len(text))
        return text[:at] + chr(lot.choice((0, 9, 34, 61, 91, 93, 127, 233, 0x1F600))) + text[at + 1:]
    return "\n".join(lines) + "\n"


class Damaged(StudyTest):
    def test_each_is_taken_or_refused(self) -> None:
        lot = random.Random(1)
        texts = [of_deck(method, F_T) for method in METHODS]
        taken = 0
        for number in range(DAMAGED):
            text = lot.choice(texts)
            for _ in range(lot.choice((1, 1, 2, 3))):
                text = damaged(text, lot) or "\n"
            file = self.folder / "study.toml"
            file.write_text(text, encoding="utf-8")
            with self.subTest(number=number, text=text):
                try:
                    plan_of(read_setup(file))
                    taken += 1
                except Error as error:
                    self.assertIn("study.toml", str(error))
        self.assertGreater(taken, 0)
        self.assertLess(taken, DAMAGED)


class Results(StudyTest):
    def test_each_is_taken_or_its_run_counts_as_not_made(self) -> None:
        lot = random.Random(2)
        study = self.study(self.of_function('kind = "lhs"\nsamples = 2'))
        study.run(jobs=1)
        file = min(study.setup.folder.glob("runs/*.json"))
        whole = file.read_text()
        with contextlib.redirect_stderr(io.StringIO()) as said:
            for number in range(DAMAGED):
                store._said.clear()
                said.truncate(0)
                content = damaged(whole, lot).encode()
                file.write_bytes(content)
                with self.subTest(number=number, content=content):
                    seen = study.forecast()
                    self.assertEqual(study.table_text().count("\n"), 3)
                    self.assertEqual(said.getvalue().count("its run counts as not made"), seen.left)


class Bytes(unittest.TestCase):
    def test_what_is_no_text_is_refused(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            for content in (b"", b"\xff\xfe\x00", bytes(1000), b"[study\n", b"\xef\xbb\xbf[study]\n"):
                file = Path(folder) / "study.toml"
                file.write_bytes(content)
                with self.subTest(content), self.assertRaises(Error) as caught:
                    read_setup(file)
                self.assertIn("study.toml", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
