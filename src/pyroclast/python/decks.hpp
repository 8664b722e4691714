#pragma once

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/plugin/find_law.hpp"

namespace pyroclast::python {

/// A deck as it is written, and what belongs to reading it.
struct DeckText {
  std::string text, name;
  std::string folder;                             ///< that its file names are taken from
  std::vector<std::string> changes;               ///< "key=value"
  std::vector<std::string> laws;                  ///< folders
  pybind11::list stages;                          ///< classes
  bool deck_names = false, changes_name = false;  ///< laws, see LawSources
};

Deck parse(const DeckText& text);
LawSources law_sources(const std::vector<std::string>& folders);
LawSources law_sources(const DeckText& text);

}  // namespace pyroclast::python
