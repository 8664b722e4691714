"""Pages that need nothing else: shells by Jinja2, with style, script and data inside.

A page may load nothing: its policy allows the very style and script that it holds, and pictures that it holds as data.
Every text is escaped, with characters that would act unseen written out, unless it is markup made here.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path
from typing import Any

from ..libraries import library
from ..texts import seen
from .markup import Markup

_HERE = Path(__file__).parent
_IMPORT = re.compile(r'^import \{([^}]*)\} from "\./([^"]*)";$', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async function|function|class|const) ([\w$]+))", re.MULTILINE)


def page(template: str, script_name: str = "", data: Any = None, **context: Any) -> str:
    """Returns a page from one of the templates.

    script_name: the module of page/ that begins the script; none where it is empty. data: goes to the script as JSON;
    numbers that are not finite as null.
    """
    style = (_HERE / "page" / "page.css").read_text(encoding="utf-8")
    script = joined(script_name, _HERE / "page") if script_name else ""
    policy = [f"style-src {_hash_of(style)}", "img-src data:", "base-uri 'none'", "form-action 'none'"]
    if script:
        policy += [f"script-src {_hash_of(script)}", "media-src blob:"]
    text = _environment().get_template(template).render(
        policy="; ".join(["default-src 'none'", *policy]), style=Markup(style), script=Markup(script),
        data=Markup(_json(data)) if data is not None else "", **context)
    return str(text)


def _hash_of(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


@cache
def joined(first: str, folder: Path) -> str:
    """Joins ES modules of a folder into one script: a module, and all that it and they import, before it.

    Each module stands in a function that returns its exports, so names of two modules do not clash. A module may import
    names from files of the folder, and export functions, classes and constants where it declares them. Raises
    ValueError for any other import or export, a name that is not there, and modules that import one another in a circle.
    """
    texts: dict[str, str] = {}
    waiting = [first]
    while waiting:
        name = waiting.pop()
        if name not in texts:
            texts[name] = (folder / name).read_text(encoding="utf-8")
            waiting += [other for _, other in _IMPORT.findall(texts[name])]
    exports = {name: _EXPORT.findall(text) for name, text in texts.items()}
    script = ['"use strict";', "(() => {", "const modules = {};"]
    for name in TopologicalSorter({name: [other for _, other in _IMPORT.findall(text)]
                                   for name, text in texts.items()}).static_order():
        for names, other in _IMPORT.findall(texts[name]):
            if unknown := {one.strip() for one in names.split(",")} - {"", *exports[other]}:
                raise ValueError(f"{name} imports {', '.join(sorted(unknown))}, which {other} does not export")
        text = _EXPORT.sub("", _IMPORT.sub(r'const {\1} = modules["\2"];', texts[name]))
        if left := re.search(r"^\s*(?:import|export)\b.*", text, re.MULTILINE):
            raise ValueError(f"{name} has a line that cannot be joined: {left[0].strip()}")
        script.append(f'modules["{name}"] = (() => {{\n{text}return {{{", ".join(exports[name])}}};\n}})();')
    return "\n".join([*script, "})();"])


def _json(data: Any) -> str:
    """Returns JSON that ends no script element."""
    text = json.dumps(_finite(data), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")


def _finite(data: Any) -> Any:
    if isinstance(data, dict):
        return {str(key): _finite(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_finite(value) for value in data]
    if isinstance(data, float) and not math.isfinite(data):
        return None
    return data.encode("utf-8", "replace").decode() if isinstance(data, str) else data


@cache
def _environment() -> Any:
    jinja2 = library("jinja2", "a page")
    return jinja2.Environment(loader=jinja2.FileSystemLoader(_HERE / "templates"), autoescape=True,
                              undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True,
                              finalize=lambda value: seen(value) if type(value) is str else value)
