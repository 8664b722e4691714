"""Pages that need nothing else: shells by Jinja2, with style, script and data inside.

A page may load nothing: its policy allows the very style and script that it holds, and pictures that it holds as data.
Every text is escaped, with characters that would act unseen written out, unless it is markup made here.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
from functools import cache
from pathlib import Path
from typing import Any

from ..libraries import library
from ..texts import seen
from .markup import Markup

_HERE = Path(__file__).parent
_STYLE = "page.css"


def page(template: str, scripts: tuple[str, ...] = (), data: Any = None, **context: Any) -> str:
    """Returns a page from one of the templates.

    scripts: files of page/, one after the other. data: goes to the script as JSON; numbers that are not finite as null.
    """
    style = _part(_STYLE)
    script = "\n".join(['"use strict";', "(() => {", *(_part(name) for name in scripts), "})();"]) if scripts else ""
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
def _part(name: str) -> str:
    return (_HERE / "page" / name).read_text(encoding="utf-8")


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
