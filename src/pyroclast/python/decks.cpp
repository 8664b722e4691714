#include "pyroclast/python/decks.hpp"

#include <algorithm>
#include <string_view>

#include <pybind11/stl.h>

#include "pyroclast/base/sha256.hpp"
#include "pyroclast/base/unit.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/errors.hpp"
#include "pyroclast/results/inputs.hpp"

namespace pyroclast::python {

namespace {

/// Returns the SI unit that a value lacks, at a key where a deck was refused for that; empty elsewhere.
std::string needed_unit(const DeckText& text, const std::string& key) {
  try {
    const Deck deck = parse(text);
    read_setup(deck, text.folder, kinds_with(text.stages), law_sources(text));
  } catch (const DeckError& error) {
    for (const Diagnostic& d : error.diagnostics())
      for (const Unit* unit : unit::all)
        if (d.key == key && d.message.find(requirement(*unit)) != std::string::npos) return unit->si;
  }
  return "";
}

/// True once this process lets the code that it meets run.
bool allows_code = false;

CodePermission code_permission() {
  CodePermission permission = CodePermission::of_environment();
  permission.allow = allows_code;
  return permission;
}

/// Tells whether a text is a number with a unit of any quantity that decks hold.
bool is_quantity(const std::string& text) {
  return std::ranges::any_of(unit::all, [&](const Unit* kind) {
    try {
      parse_quantity(text, *kind);
      return true;
    } catch (const QuantityError&) {
      return false;
    }
  });
}

/// Returns the value in SI of one of a unit, as columns of results have units; a unit that no deck holds is
/// SI.
double si_factor(const std::string& unit) {
  for (const Unit* kind : unit::all) {
    if (unit == kind->si) return 1.0;
    try {
      return parse_quantity("1 " + unit, *kind);
    } catch (const QuantityError&) {
      continue;
    }
  }
  return 1.0;
}

}  // namespace

Deck parse(const DeckText& text) {
  return Deck::parse(text.text, text.name, text.changes);
}

LawSources law_sources(const std::vector<std::string>& folders) {
  auto sources = LawSources::of_environment();
  sources.permission = code_permission();
  sources.folders.insert(sources.folders.begin(), folders.begin(), folders.end());
  sources.compiler.poll = [] {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  };
  return sources;
}

LawSources law_sources(const DeckText& text) {
  LawSources sources = law_sources(text.laws);
  sources.deck_names = text.deck_names;
  sources.changes_name = text.changes_name;
  return sources;
}

void bind_decks(py::module_& m) {
  py::class_<DeckText>(m, "DeckText", "A deck as written, with its place for messages.")
      .def(py::init([](std::string text, std::string name, std::string folder,
                       std::vector<std::string> changes, std::vector<std::string> laws, py::list stages,
                       bool deck_names, bool changes_name) {
             return DeckText{std::move(text), std::move(name),   std::move(folder), std::move(changes),
                             std::move(laws), std::move(stages), deck_names,        changes_name};
           }),
           py::arg("text"), py::arg("name"), py::arg("folder"), py::arg("changes"), py::arg("laws"),
           py::arg("stages"), py::arg("deck_names"), py::arg("changes_name"));
  m.def(
      "allow_code", [] { allows_code = true; },
      "Lets code that decks and studies name run in this process, until the code changes.");
  m.def(
      "require_code",
      [](const std::string& what, const std::string& hash, const std::string& unknown, bool named) {
        code_permission().require({what, hash, {}, unknown}, named);
      },
      py::arg("what"), py::arg("hash"), py::arg("unknown"), py::arg("named"),
      "Returns where code may run; raises CodeNotAllowed elsewhere. unknown: reason why the hash does not "
      "cover "
      "all that runs, or \"\"; such code needs the user's permission each time.");
  m.def(
      "written", [](const DeckText& text) { return parse(text).text(); }, py::arg("deck"),
      "The text of a deck with its changes in place.");
  m.def(
      "check",
      [](const DeckText& text) {
        const Deck deck = parse(text);
        Setup setup = read_setup(deck, text.folder, kinds_with(text.stages), law_sources(text));
        for (const std::string& code : setup.code_not_allowed)
          setup.warnings.push_back(
              {.file = deck.name(), .message = "keys of a law are not checked: " + code});
        return diagnostics(setup.warnings);
      },
      py::arg("deck"), "Reads a deck; returns its warnings.");
  m.def(
      "resolve",
      [](const DeckText& text) {
        const Deck deck = parse(text);
        const Setup setup = read_setup(deck, text.folder, kinds_with(text.stages), law_sources(text));
        require_code(setup);
        const Inputs inputs = inputs_of(deck, setup);
        py::dict files;
        for (const InputFile& file : inputs.files) files[py::str(file.name)] = sha256(file.contents);
        return py::make_tuple(inputs.deck_text, files, diagnostics(setup.warnings));
      },
      py::arg("deck"),
      "Reads a deck; returns its text as the folder of a run keeps it, the SHA-256 of each file that it "
      "names, and its warnings.");
  m.def(
      "read", [](const std::string& file) { return Deck::open(file).text(); }, py::arg("file"),
      "The text of a file that is a deck.");
  m.def("needed_unit", &needed_unit, py::arg("deck"), py::arg("key"),
        "The SI unit that the value at a key lacks; empty where it lacks none.");
  m.def(
      "ranges",
      [](const DeckText& text) {
        const Deck deck = parse(text);
        const Setup setup = read_setup(deck, text.folder, kinds_with(text.stages), law_sources(text));
        return py::make_tuple(setup.temperatures.lower, setup.temperatures.upper, 0.0, setup.exposure);
      },
      py::arg("deck"), "Temperatures [degC] and heating times [s] that the run of a deck may come to.");
  m.def(
      "convert",
      [](const std::string& text, const std::string& unit) {
        for (const Unit* kind : unit::all)
          if (unit == kind->si) return parse_quantity(text, *kind);
        return parse_quantity(text, Unit{unit.c_str(), "such quantity", ("1 " + unit).c_str()});
      },
      py::arg("text"), py::arg("unit"), "The value of a quantity in a unit.");
  m.def("is_quantity", &is_quantity, py::arg("text"),
        "Whether a text is a number with a unit that decks know.");
  m.def("si_factor", &si_factor, py::arg("unit"), "Value in SI of one of a unit of the results.");
}

}  // namespace pyroclast::python
