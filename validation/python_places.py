"""Where a Python file can be changed a little, as validation/mutations changes C++."""

import ast
from collections.abc import Iterator

NEIGHBOURS = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Mod: "*", ast.FloorDiv: "*", ast.Pow: "*"}
COMPARED = {ast.Lt: ["<=", ">"], ast.Gt: [">=", "<"], ast.LtE: ["<", ">="], ast.GtE: [">", "<="], ast.Eq: ["!="],
            ast.NotEq: ["=="], ast.In: ["not in"], ast.NotIn: ["in"], ast.Is: ["is not"], ast.IsNot: ["is"]}
PAIRS = {"min": "max", "max": "min", "minimum": "maximum", "maximum": "minimum", "any": "all", "all": "any",
         "nanargmin": "nanargmax"}
Change = tuple[int, int, str, str]  # begin and end in bytes, kind, what comes in its place


def changes(text: bytes) -> Iterator[Change]:
    """Changes within functions: operators, numbers, conditions, signs, smaller for larger, statements left out."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def span(node: ast.AST) -> tuple[int, int]:
        return starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset

    def source(node: ast.AST) -> str:
        begin, end = span(node)
        return text[begin:end].decode()

    module = ast.parse(text)
    named = {top.targets[0].id: top.value.value for top in module.body
             if isinstance(top, ast.Assign) and isinstance(top.targets[0], ast.Name)
             and isinstance(top.value, ast.Constant) and type(top.value.value) in (int, float)}

    def walk(node: ast.AST, inside: bool) -> Iterator[Change]:
        if isinstance(node, ast.FunctionDef):
            for child in [*node.args.defaults, *filter(None, node.args.kw_defaults), *node.body]:
                yield from walk(child, True)
            return
        if isinstance(node, ast.AnnAssign):
            if node.value is not None:
                yield from walk(node.value, inside)
                if inside:
                    yield from own(node)
            return
        if inside:
            yield from own(node)
        for child in ast.iter_child_nodes(node):
            if not isinstance(child, ast.JoinedStr):  # texts
                yield from walk(child, inside)

    def own(node: ast.AST) -> Iterator[Change]:
        if isinstance(node, ast.BinOp) and NEIGHBOURS.get(type(node.op)):
            yield *span(node), "operator", f"({source(node.left)}) {NEIGHBOURS[type(node.op)]} ({source(node.right)})"
        if isinstance(node, ast.Compare) and len(node.ops) == 1:
            for other in COMPARED[type(node.ops[0])]:
                yield *span(node), "operator", f"({source(node.left)}) {other} ({source(node.comparators[0])})"
        if isinstance(node, ast.BoolOp):
            other = " or " if isinstance(node.op, ast.And) else " and "
            yield *span(node), "operator", other.join(f"({source(value)})" for value in node.values)
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            after = f"({node.value} + 1)" if type(node.value) is int else f"(1.1 * {node.value!r})"
            yield *span(node), "number", "1.0" if node.value == 0.0 and type(node.value) is float else after
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id in named:
            after = f"({node.id} + 1)" if type(named[node.id]) is int else f"(1.1 * {node.id})"
            yield *span(node), "number", after
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not, ast.Invert)):
            yield *span(node), "sign", source(node.operand)
        if isinstance(node, (ast.If, ast.While, ast.IfExp)):
            yield *span(node.test), "condition", f"not ({source(node.test)})"
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name in PAIRS:
                end = span(node.func)[1]
                yield end - len(name), end, "pair", PAIRS[name]
        if isinstance(node, ast.AugAssign) and type(node.op) in NEIGHBOURS:
            yield (*span(node), "operator",
                   f"{source(node.target)} {NEIGHBOURS[type(node.op)]}= ({source(node.value)})")
        calls = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        set_in_place = isinstance(node, ast.Assign) and not isinstance(node.targets[0], (ast.Name, ast.Tuple))
        if calls or set_in_place or isinstance(node, ast.AugAssign):
            yield *span(node), "statement", "pass"

    for top in module.body:
        yield from walk(top, False)
