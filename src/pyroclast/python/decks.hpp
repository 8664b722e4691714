#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/plugin/find_law.hpp"

namespace pyroclast::python {

/// Deck as it is written, and the settings for reading it.
struct DeckText {
  std::string text, name;
  std::string folder;                             ///< folder from which its file names are taken
  std::vector<std::string> changes;               ///< changes, "key=value"
  std::vector<std::string> laws;                  ///< folders of laws
  pybind11::list stages;                          ///< classes of stages
  bool deck_names = false, changes_name = false;  ///< true where deck and changes name laws, see LawSources
};

Deck parse(const DeckText& text);
LawSources law_sources(const std::vector<std::string>& folders);
LawSources law_sources(const DeckText& text);

}  // namespace pyroclast::python
