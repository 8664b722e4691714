"""Finds code of the library that adds up floating-point numbers over many items without chunked_sum.

    sums.py [--root FOLDER]     prints what it finds in FOLDER/src/pyroclast that allowed_sums.py does not allow,
                                and what that allows and is not found

It reads text, not types, and reports too much rather than too little. Reported are, in the header or body of a loop
and in the body of a lambda (which may be called many times):

- `x += ...`, `x -= ...`, `x = x + ...` and `x = std::fma(..., x)`, where x outlives one turn of the loop. References,
  pointers and the variables of range-based loops are followed to what they stand for.
- The same outside of loops where x is a parameter by reference or pointer: the caller may stand in a loop. (What a
  member function adds to a member, outside of loops, escapes.)
- Not an element of an array whose indices name a variable of each loop around it. An index that is looked up, as in
  `sum[material[z]]`, is none: many z may have one material.
- Not what chunked_sum hands to the lambda written in its call.
- Not integers and text, as far as declarations tell.

And anywhere: std::accumulate and its kin, unless they start from an integer; OpenMP's reductions with + and -;
fetch_add on anything but integers.
"""

import argparse
import bisect
import dataclasses
import fnmatch
import pathlib
import re
import sys


@dataclasses.dataclass(frozen=True)
class Finding:
    file: str  # below src/pyroclast
    number: int  # of the line
    function: str
    line: str

    def __str__(self) -> str:
        return f"{self.file}:{self.number}: {self.function}: {self.line}"


@dataclasses.dataclass(frozen=True)
class Allowed:
    file: str  # its path below src/pyroclast; * stands for any part of it
    at: str  # name of a function with (), or part of a line, or nothing for the whole file
    reason: str

    def matches(self, finding: Finding) -> bool:
        at_it = self.at[:-2] == finding.function if self.at.endswith("()") else self.at in finding.line
        return at_it and fnmatch.fnmatchcase(finding.file, self.file)


ROOT = pathlib.Path(__file__).parents[2]

COMMENT_OR_LITERAL = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
CLOSING = {")": "(", "]": "[", "}": "{"}
INTEGER = re.compile(r"((const|constexpr|static|inline|mutable) )*(std::atomic<)?(std::)?"
                     r"(u?int(\d+)?(_t)?|(unsigned )?(long|long long|short|char|int)|unsigned|bool|size_t|ptrdiff_t)>?")
TEXT = re.compile(r"((const|static|mutable) )*(std::)?(string|string_view|filesystem::path)")
TYPE = (r"(?P<type>(?!(?:return|throw|delete|new|else|case|goto|using|namespace|struct|class|enum|operator)\b)"
        r"(?:(?:const|constexpr|static|inline|mutable|unsigned|long)\s+)*[A-Za-z_][\w:]*"
        r"(?:<[^;{}()]*?>(?:::\w+)*)?)(?P<ref>\s*[&*]+\s*(?:const\s+)?|\s+)")
DECLARATION = re.compile(r"(?:(?<=[;{}(])|(?<=else)|^)\s*(?:" + TYPE + r"(?P<name>\w+)\s*(?=[=;{(,](?!=))"
                         r"|(?:const\s+)?auto\s*(?P<refs>&*)\s*\[(?P<names>[\w\s,]*)\]\s*(?==))")
MEMBER = re.compile(r"(?:(?<=[;{}(,])|^)\s*(?:alignas\(\w+\)\s*)?" + TYPE
                    + r"(?P<names>\w+\s*(?:[=;{,)][^;(){}]*)?)", re.MULTILINE)
SUMMING = re.compile(r"\b(accumulate|reduce|transform_reduce|inner_product|partial_sum"
                     r"|(?:transform_)?(?:in|ex)clusive_scan|fold_\w+)\s*(?:<[\w:]+>)?\s*\(")
NAME_BEFORE = re.compile(r"\w+$")
ACCESS_BEFORE = re.compile(r"(\.|->|::)$")
DEREFERENCE_BEFORE = re.compile(r"(?:^|[;{}()])\s*(\*+)\s*$")
STATEMENT = re.compile(r"[^;]*")
SPACE = re.compile(r"\s*")
ADDING = re.compile(r"(\+=|-=)|(?<![=!<>+\-*/%&|^])=(?!=)")


def blank(match: re.Match) -> str:
    """A comment or a literal as long as before, with its line ends."""
    text = match.group()
    filled = re.sub(r"[^\n]", " " if text[0] == "/" else "~", text)
    return filled if text[0] == "/" else '"' + filled[1:-1] + '"'


def split(text: str, separator: str) -> list[str]:
    """The parts of a text between separators that stand in no brackets."""
    parts, depth, begin = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "([{<") - (c in ")]}>" and text[i - 1:i] != "-")
        if c == separator and depth == 0 and (c != ":" or "::" not in text[max(0, i - 1):i + 2]):
            parts.append(text[begin:i])
            begin = i + 1
    return [*parts, text[begin:]]


@dataclasses.dataclass(frozen=True)
class Target:
    """What is added to: its first name and all its indices. `root` is None where that cannot be told."""

    root: str | None
    indices: tuple[str, ...]
    last: str = ""
    through_pointer: bool = False


def target_of(text: str) -> Target:
    """Of an expression such as `a.b[i]->c`, `*p` or `(rows)[i].x`."""
    text = text.strip()
    through_pointer = text.startswith("*")
    text = text.lstrip("*& ")
    indices, last, depth = [], "", 0
    m = re.match(r"\(\s*([\w.]+(?:\[\w+\])*)\s*\)", text)
    if m:
        text = m.group(1) + text[m.end():]
    m = re.match(r"(?:this\s*->\s*)?([A-Za-z_]\w*)", text)
    if not m:
        return Target(None, ())
    root = last = m.group(1)
    at = m.end()
    while at < len(text):
        if text[at].isspace():
            at += 1
            continue
        if text[at] in "([":
            begin = at
            for at in range(begin, len(text)):
                depth += (text[at] in "([{") - (text[at] in ")]}")
                if depth == 0:
                    break
            at += 1
            if text[begin] == "(" and last != "at" and not re.search(r"[.>]\s*\w+\s*$", text[:begin]):
                return Target(None, ())  # what a function returns
            indices.append(text[begin + 1:at - 1])
            continue
        m = re.compile(r"(\.|->)\s*(?:template\s+)?(\w+)").match(text, at)
        if not m:
            return Target(None, ())
        through_pointer |= m.group(1) == "->" and not indices
        last = m.group(2)
        at = m.end()
    return Target(root, tuple(indices), last, through_pointer)


@dataclasses.dataclass(frozen=True)
class Loop:
    """What stands in [begin, end) may happen many times: a loop or a lambda."""

    kind: str  # for, each (range-based), while, do, lambda
    begin: int
    header: str
    end: int
    chunked: bool = False  # a lambda written in the call of chunked_sum

    def names(self) -> list[str]:
        """Variables that differ from turn to turn."""
        if self.kind == "for":
            first, *_, last = self.header.split(";")
            return [name for name in re.findall(r"(\w+)\s*=(?!=)", first) if re.search(rf"\b{name}\b", last)]
        if self.kind == "each":
            return re.findall(r"\w+", split(self.header, ":")[-2])[-1:]
        if self.kind == "lambda":
            return [names[-1] for part in split(self.header, ",") if (names := re.findall(r"\w+", part))]
        return []

    def declares(self, name: str) -> tuple[str, str] | None:
        """'' and '', or & and what the name stands for, where the header declares it for one turn."""
        if name not in self.names() or self.kind not in ("each", "lambda"):
            return None
        if self.kind == "each":
            before, over = split(self.header, ":")[-2:]
            return ("&", f"({over.strip()})[{name}]") if "&" in before or "*" in before else ("", "")
        part = next(part for part in split(self.header, ",") if re.search(rf"\b{name}\s*$", part))
        return ("&", "") if ("&" in part or "*" in part) and not self.chunked else ("", "")


class Source:
    """One file."""

    def __init__(self, name: str, text: str):
        self.name = name
        self.lines = text.splitlines()
        self.text = COMMENT_OR_LITERAL.sub(blank, text)
        self.line_begins = [0] + [m.end() for m in re.finditer("\n", self.text)]
        self.partner: dict[int, int] = {}
        waiting: list[int] = []
        for m in re.finditer(r"[{}()\[\]]", self.text):
            if m.group() in "([{":
                waiting.append(m.start())
            elif waiting and self.text[waiting[-1]] == CLOSING[m.group()]:
                self.partner[m.start()] = waiting.pop()
                self.partner[self.partner[m.start()]] = m.start()
            else:
                raise ValueError(f"{name}:{self.number_of(m.start())}: {m.group()} closes nothing")
        if waiting:
            raise ValueError(f"{name}:{self.number_of(waiting[-1])}: {self.text[waiting[-1]]} stays open")
        self.blocks = sorted((b, e) for b, e in self.partner.items() if b < e and self.text[b] == "{")
        self.parentheses = sorted((b, e) for b, e in self.partner.items() if b < e and self.text[b] == "(")
        self.declarations = self.find_declarations()
        self.loops = [*self.find_loops(), *self.find_lambdas()]

    def number_of(self, at: int) -> int:
        """Of the line."""
        return bisect.bisect_right(self.line_begins, at)

    def after_space(self, at: int) -> int:
        return SPACE.match(self.text, at).end()

    def after_statement(self, at: int) -> int:
        at = self.after_space(at)
        if self.text[at:at + 1] == "{":
            return self.partner[at] + 1
        word = re.compile(r"\w*").match(self.text, at).group()
        if word in ("if", "for", "while", "switch"):
            end = self.after_statement(self.partner[self.text.index("(", at)] + 1)
            following = self.after_space(end)
            is_else = word == "if" and re.compile(r"else\b").match(self.text, following)
            return self.after_statement(following + 4) if is_else else end
        while at < len(self.text) and self.text[at] not in ";}":
            at = self.partner.get(at, at) + 1 if self.text[at] in "([{" else at + 1
        return at + 1

    def find_loops(self) -> list[Loop]:
        found = []
        for m in re.finditer(r"\b(?:(for|while)\s*\(|do\s*\{)", self.text):
            bracket = m.end() - 1
            if bracket not in self.partner:
                continue
            end = self.partner[bracket] + 1
            if not m.group(1):
                found.append(Loop("do", m.start(), "", end))
                continue
            header = self.text[bracket + 1:end - 1]
            ranged = m.group(1) == "for" and header.count(";") < 2
            found.append(Loop("each" if ranged else m.group(1), m.start(), header, self.after_statement(end)))
        return found

    def find_lambdas(self) -> list[Loop]:
        found = []
        for m in re.finditer(r"\[[\w\s&=*,.:()]*\]\s*(?:\(|\{|mutable)", self.text):
            before = self.text[max(0, m.start() - 60):m.start()]
            if re.search(r"[\w\])]\s*$", before) and not re.search(r"\breturn\s*$", before):
                continue  # an index
            at, parameters = m.end() - 1, ""
            if self.text[at] == "(":
                parameters = self.text[at + 1:self.partner[at]]
                at = self.partner[at] + 1
            body = re.compile(r"[\s\w]*(?:->[^;{}()]*)?\{").match(self.text, at - (self.text[at - 1] == "]"))
            if not body:
                continue
            call = max((b for b, e in self.parentheses if b < m.start() < e), default=0)
            chunked = (re.search(r"\bchunked_sum\s*(<[^;{}()]*>)?\s*$", self.text[max(0, call - 120):call]) is not None
                       and not any(call < b < m.start() < e for b, e in self.blocks))
            found.append(Loop("lambda", m.start(), parameters, self.partner[body.end() - 1] + 1, chunked))
        return found

    def function_at(self, at: int) -> tuple[str, str]:
        """Name and parameters of the outermost function around a place."""
        for begin, end in self.blocks:
            if begin < at < end:
                first = max(0, begin - 1000)
                head = re.split(r"[;}]|\b(?:public|private|protected)\s*:|\{(?=\s*\n)", self.text[first:begin])[-1]
                m = re.search(r"(?<![\w:])((?:\w+(?:<[\w, ]*>)?::)*(?:operator\s*\S+?|~?\w+))\s*\(",
                              re.sub(r"\btemplate\s*<[^()]*?>(?=\s*[\w\[])", lambda t: " " * len(t.group()), head))
                if m and ")" in head:
                    bracket = begin - len(head) + m.end() - 1
                    return re.sub(r"<[\w, ]*>", "", m.group(1)), self.text[bracket + 1:self.partner[bracket]]
        return "", ""

    def finding(self, at: int) -> Finding:
        number = self.number_of(at)
        return Finding(self.name, number, self.function_at(at)[0], self.lines[number - 1].strip())

    def find_declarations(self) -> dict[str, list[tuple[int, int, str, str, str]]]:
        """By name: where, until where it holds, type, & or * or nothing, and first value."""
        found: dict[str, list[tuple[int, int, str, str, str]]] = {}
        for m in DECLARATION.finditer(self.text):
            if self.text[m.end():m.end() + 1] == "," and self.text[max(0, m.start() - 1)] == "(":
                continue  # a parameter
            place = m.end()
            until = min((e for b, e in self.blocks if b < place < e), default=len(self.text))
            value = STATEMENT.match(self.text, m.end()).group()
            kind = re.sub(r"\s+", " ", m["type"] or "auto")
            ref = (m["ref"] or m["refs"] or "").replace("const", "").strip()
            names = [(m["name"], value)] if m["name"] else [(name, value) for name in re.findall(r"\w+", m["names"])]
            if m["name"]:  # double a = 0.0, b = 0.0;
                for more in split(value, ",")[1:]:
                    if another := re.match(r"\s*(\w+)\s*([={][^;]*)?$", more):
                        names.append((another.group(1), another.group(2) or ""))
            for name, first in names:
                found.setdefault(name, []).append((place, until, kind, ref, first))
        return found

    def declaration(self, name: str, begin: int, at: int) -> tuple[str, str, str] | None:
        """Type, & or * or nothing, and first value of the last declaration in [begin, at) that holds at `at`."""
        found = [d for d in self.declarations.get(name, []) if begin <= d[0] < at < d[1]]
        return found[-1][2:] if found else None

    def is_a_sum(self, target: Target, at: int, follow: int = 8) -> bool:
        """Whether what is added to outlives a turn of a loop around."""
        for loop in sorted((l for l in self.loops if l.begin <= at < l.end), key=lambda l: -l.begin):
            while True:
                if target.root is None or follow == 0:
                    return True
                local = loop.declares(target.root)
                if local is None:
                    if found := self.declaration(target.root, self.body_of(loop), at):
                        kind, ref, value = found
                        is_view = "span" in kind or "View" in kind or (kind.endswith("auto") and target.indices)
                        is_copy = not (ref or target.through_pointer or is_view)
                        local = ("", "") if is_copy else ("&", value.lstrip("= "))
                if local is None:
                    break
                if not local[0]:
                    return False
                follow -= 1
                beyond = target_of(local[1])
                target = Target(beyond.root, beyond.indices + target.indices, target.last)
            if any(l.chunked and l.begin <= at < l.end and target.root in l.names() for l in self.loops):
                return False
            indices = [re.sub(r"[\w.>-]*\w\s*[(\[].*", "", index) for index in target.indices]
            if not any(re.search(rf"\b{name}\b", index) for name in loop.names() for index in indices):
                return True
        return False

    def is_handed_in(self, target: Target, at: int) -> bool:
        """Whether what is added to is a parameter through which the function changes what its caller has."""
        parameters = split(self.function_at(at)[1], ",")
        return any(re.search(rf"[&*]\s*{target.root}\s*$", p) and "const " not in p for p in parameters)

    def body_of(self, loop: Loop) -> int:
        bracket = re.compile(r"[(\[{]").search(self.text, loop.begin).start()
        end = self.partner[bracket] + 1
        if loop.kind == "lambda":
            end = self.text.index("{", self.partner.get(self.after_space(end), end))
        return bracket if loop.kind == "do" else end

    def type_of(self, target: Target, at: int, members: dict[str, set[str]]) -> set[str]:
        """Types that what is added to may have."""
        if target.last == target.root and target.root:
            around = [b for b, e in self.blocks if b < at < e]
            found = self.declaration(target.root, around[0] if around else 0, at)
            if found:
                whole = re.fullmatch(r"=\s*(-?\d+|std::size_t\{\d+\})\s*", found[2])
                return {"int" if found[0] == "auto" and whole else found[0]}
        return members.get(target.last, set())


def is_known(types: set[str]) -> bool:
    """Whether a sum of these is exact, or text."""
    return bool(types) and all(INTEGER.fullmatch(t) or TEXT.fullmatch(t) for t in types)


def left_of(text: str, at: int, partner: dict[int, int]) -> str:
    """The expression that ends where an assignment's sign begins."""
    begin, wants_name = at, True
    while True:
        end = begin
        while end > 0 and text[end - 1].isspace():
            end -= 1
        if end and text[end - 1] in "])" and wants_name and end - 1 in partner:
            begin = partner[end - 1]
            if begin and not (text[begin - 1].isalnum() or text[begin - 1] in "_])>"):
                break
        elif wants_name and (m := NAME_BEFORE.search(text[max(0, end - 80):end])):
            begin, wants_name = end - len(m.group()), False
        elif not wants_name and (m := ACCESS_BEFORE.search(text[max(0, end - 2):end])):
            begin, wants_name = end - len(m.group()), True
        else:
            break
    star = DEREFERENCE_BEFORE.search(text[max(0, begin - 10):begin])
    return (star.group(1) if star else "") + text[begin:at]


def declared_types(texts: list[str]) -> dict[str, set[str]]:
    """Types that each name is declared with, anywhere."""
    types: dict[str, set[str]] = {}
    for text in texts:
        for m in MEMBER.finditer(text):
            kind = re.sub(r"\s+", " ", m["type"]).strip()
            names = re.match(r"\w+", m["names"]).group()
            types.setdefault(names, set()).add(kind)
            for name in re.findall(r",\s*(\w+)\s*(?:=|;|\{|$)", m["names"]):
                types.setdefault(name, set()).add(kind)
    return types


def findings_in(source: Source, members: dict[str, set[str]]) -> list[Finding]:
    found = []
    text = source.text
    for m in ADDING.finditer(text):
        at = m.start()
        in_loop = any(loop.begin <= at < loop.end for loop in source.loops)
        expression = left_of(text, at, source.partner)
        if not expression.strip() or not m.group(1) and expression.strip() not in text[at:text.find(";", at)]:
            continue
        end = at
        while end < len(text) and text[end] not in ";,)}":
            end = source.partner.get(end, end) + 1 if text[end] in "([{" else end + 1
        value = text[m.end():end].strip()
        if not m.group(1):
            again = rf"(?<![\w.>]){re.escape(expression.strip())}(?![\w\[.(])"
            if not re.search(rf"{again}\s*[+-]|[+-]\s*{again}|\bfma\s*\([^;]*,\s*{again}\s*\)", value):
                continue
        if re.fullmatch(r'\d+|".*|fmt::format\(.*|[\w.>-]+(?<!-)\.size\(\)', value, re.DOTALL):
            continue
        target = target_of(expression)
        is_a_sum = source.is_a_sum(target, at) if in_loop else source.is_handed_in(target, at)
        if is_a_sum and not is_known(source.type_of(target, at, members)):
            found.append(source.finding(at))
    for m in SUMMING.finditer(text):
        before = text[max(0, m.start() - 30):m.start()]
        if before[-1:] in (".", ">") or re.search(r"\b(?!return\b)[A-Za-z]\w*\s+$", before):  # another's, or declared
            continue
        arguments = split(text[m.end():source.partner[m.end() - 1]], ",")
        if not (m.group(1) == "accumulate" and len(arguments) > 2
                and re.fullmatch(r"\s*(\d+|(std::)?(size_t|int64_t)\{\d+\})\s*", arguments[2])):
            found.append(source.finding(m.start()))
    found += [source.finding(m.start()) for m in re.finditer(r"#\s*pragma\s+omp\b[^\n]*\breduction\s*\(\s*[+-]", text)]
    for m in re.finditer(r"(\w+)(?:\[[^\]]*\])?(?:\.|->)fetch_(?:add|sub)\b", text):
        if not is_known(members.get(m.group(1), set())):
            found.append(source.finding(m.start()))
    return sorted(set(found), key=lambda f: f.number)


def findings(root: pathlib.Path) -> list[Finding]:
    """All that is found below root/src/pyroclast."""
    folder = root / "src" / "pyroclast"
    paths = sorted(p for p in folder.rglob("*") if p.suffix in (".hpp", ".cpp", ".h", ".cuh", ".cu"))
    sources = [Source(p.relative_to(folder).as_posix(), p.read_text()) for p in paths]
    members = declared_types([s.text for s in sources])
    return [f for s in sources for f in findings_in(s, members)]


def faults(found: list[Finding], allowed: list[Allowed]) -> list[str]:
    """What is found and not allowed, and what is allowed and not found."""
    return ([f"{f} (take it through chunked_sum)" for f in found if not any(a.matches(f) for a in allowed)]
            + [f"allowed_sums.py: nothing is found any more in {a.file} at {a.at!r} ({a.reason}): take the entry out"
               for a in allowed if not any(a.matches(f) for f in found)])


def main() -> int:
    from allowed_sums import ALLOWED, NOT_YET

    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="folder that holds src/pyroclast")
    parser.add_argument("--all", action="store_true", help="print all that is found, allowed or not")
    options = parser.parse_args()
    found = findings(options.root)
    lines = [str(f) for f in found] if options.all else faults(found, ALLOWED + NOT_YET)
    print(*lines, sep="\n")
    return 1 if lines and not options.all else 0


if __name__ == "__main__":
    sys.exit(main())
