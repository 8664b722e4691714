"""Sphinx's settings; scripts/docs calls it. No page makes a request to another host."""

from __future__ import annotations

import functools
import pathlib
import re
from typing import Any

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.builders.html import StandaloneHTMLBuilder
from sphinx.environment.adapters.toctree import TocTree
from sphinx.writers.html import HTMLTranslator

_CITATION = (pathlib.Path(__file__).resolve().parents[1] / "CITATION.cff").read_text("utf-8")


def _of_citation(key: str) -> str:
    """Returns a value of CITATION.cff, empty where the key is not there."""
    found = re.search(rf"^{key}: *[\"']?([^\"'\n]+)", _CITATION, re.MULTILINE)
    return found[1].strip() if found else ""


project = "Pyroclast"
release = version = _of_citation("version")
author = "the Pyroclast authors"
copyright = author  # pylint: disable=redefined-builtin
extensions = ["myst_parser", "sphinx_copybutton", "sphinxcontrib.bibtex", "sphinx.ext.autodoc"]
myst_enable_extensions = ["dollarmath", "colon_fence", "substitution"]
_HOME = _of_citation("repository-code")
myst_substitutions = {
    "version": version,
    "home": f"The project lives at <{_HOME}>." if _HOME else
    "This copy names no public address of the project. Ask those who gave you the program.",
}
myst_heading_anchors = 4
myst_dmath_double_inline = True
myst_dmath_allow_digits = False
bibtex_bibfiles = ["references.bib"]
bibtex_reference_style = "author_year"
bibtex_default_style = "unsrt"
exclude_patterns = ["lookup/printed"]
html_theme = "furo"
html_title = "Pyroclast"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_math_renderer = "mathml"
copybutton_exclude = ".linenos, .gp, .go"
suppress_warnings = ["myst.header"]  # a table's page begins with the table
highlight_language = "python"  # of examples in docstrings; every block of a page names its own
smartquotes = False  # --set is no dash
default_role = "code"
nitpick_ignore_regex = [(r"py:.*", r".*")]  # types of signatures, such as np.ndarray: no inventory is fetched
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_default_options = {"members": True, "special-members": "__getitem__, __setitem__, __delitem__, __contains__"}
latex_engine = "xelatex"  # letters such as λ stand in the text
latex_documents = [("understand/theory", "theory.tex", "Pyroclast: theory manual", author, "howto")]
latex_elements = {"papersize": "a4paper", "pointsize": "10pt", "figure_align": "H"}
latex_show_urls = "no"

_IMPORT = "@import url(/javascript/normalize.css/normalize.css);"
_NORMALIZE = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")
_MODULE = 'import Gumshoe from "./gumshoe-patched.js";\n'
_DARK = re.compile(r'body\[data-theme="dark"\] (\{[^{}]*--color[^{}]*\})')
_TAG = re.compile(r"\s*\\tag\{([^}]*)\}")
_PARAMETER = re.compile(r"^((?:\w+, )*\w+): ")


def _mathml(self: HTMLTranslator, node: nodes.Element) -> None:
    self.body.append(tex2mathml(node.astext()))
    raise nodes.SkipNode


def _mathml_block(self: HTMLTranslator, node: nodes.Element) -> None:
    """An equation with its number, the paper's or its source, at the right."""
    text = node.astext()
    number = _TAG.search(text)
    self.body.append(self.starttag(node, "div", CLASS="equation"))
    equation = tex2mathml(_TAG.sub("", text).strip())
    self.body.append(equation.replace("<math", '<math display="block"', 1))
    if number:
        self.body.append(f'<span class="number">({number[1]})</span>')
    self.body.append("</div>\n")
    raise nodes.SkipNode


def _keep_number(app: Sphinx, tree: nodes.document, name: str) -> None:
    """LaTeX takes a stated number only in an environment of its own."""
    if app.builder.format == "latex":
        for node in tree.findall(nodes.math_block):
            if _TAG.search(node.astext()):
                node["nowrap"] = True
                node[:] = [nodes.Text(f"\\begin{{equation*}}{node.astext().strip()}\\end{{equation*}}")]


@functools.lru_cache(maxsize=None)
def _navigation(builder: StandaloneHTMLBuilder, folder: str) -> str:
    """All of the navigation as pages of a folder link it, with no page current."""
    tree = TocTree(builder.env).get_toctree_for(f"{folder}-", builder, collapse=False, titles_only=True, maxdepth=-1)
    return builder.render_partial(tree)["fragment"]


def _share_navigation(app: Sphinx, name: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """The theme has Sphinx make the navigation anew for every page, which is half of the build. Here pages of a folder
    share one, in which the entries of the page and of the pages above it are marked as Sphinx marks them.
    """
    if "toctree" not in context:
        return
    text = _navigation(app.builder, name[: name.rfind("/") + 1])
    for page in TocTree(app.env).get_toctree_ancestors(name):
        link = app.builder.get_relative_uri(f"{name}-", page)
        plain = f'"><a class="reference internal" href="{link}"'
        marked = '"><a class="current reference internal" href="#"' if page == name else plain
        text = text.replace(plain, f" current{marked}", 1)
    context["toctree"] = lambda **asked: text


def _list_parameters(app: Sphinx, what: str, name: str, of: object, options: object, lines: list[str]) -> None:
    """Lines of a docstring that begin with "width: " tell what a parameter means; they become a list."""
    told, in_list = [], False
    for i, line in enumerate(lines):
        if line.endswith(":") and "\n".join(lines[i + 1 : i + 3]).startswith("\n    "):
            line += ":"  # code follows
        if found := _PARAMETER.match(line):
            names = ", ".join(f"``{each}``" for each in found[1].split(", "))
            told += ([] if in_list or not told or not told[-1] else [""]) + [f"- {names}: {line[found.end():]}"]
            in_list = True
        elif in_list and line.strip() and not line.startswith("    "):
            told.append(f"  {line}")
        else:
            told.append(line)
            in_list = in_list and bool(line.strip())
    lines[:] = told


def _complete_theme(app: Sphinx, error: Exception | None) -> None:
    """Debian's furo fetches one style from the root of the host, does not follow the dark mode of the system, and
    imports a script into another, which a browser takes neither as a plain script nor from a file.
    """
    if error or app.builder.format != "html":
        return
    static = pathlib.Path(app.outdir) / "_static"
    script = static / "scripts" / "furo.js"
    text = script.read_text("utf-8")
    if text.startswith(_MODULE):
        spy = (script.parent / "gumshoe-patched.js").read_text("utf-8")
        script.write_text(spy + text[len(_MODULE):], "utf-8")
    style = static / "styles" / "furo.css"
    text = style.read_text("utf-8")
    if _IMPORT in text:
        text = text.replace(_IMPORT, _NORMALIZE.read_text("utf-8"))
    if "prefers-color-scheme" not in text and (dark := _DARK.search(text)):
        text += f'\n@media (prefers-color-scheme: dark) {{ body:not([data-theme="light"]) {dark[1]} }}\n'
    style.write_text(text, "utf-8")


def setup(app: Sphinx) -> None:
    app.add_html_math_renderer("mathml", (_mathml, None), (_mathml_block, None))
    app.connect("doctree-resolved", _keep_number)
    app.connect("html-page-context", _share_navigation, priority=400)  # before the theme's
    app.connect("build-finished", _complete_theme)
    app.connect("autodoc-process-docstring", _list_parameters)
