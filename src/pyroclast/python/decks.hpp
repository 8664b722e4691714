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
  std::string folder;                ///< that its file names are taken from
  std::vector<std::string> changes;  ///< "key=value"
  std::vector<std::string> laws;     ///< folders
  pybind11::list stages;             ///< classes
};

Deck parse(const DeckText& text);
LawSources law_sources(const std::vector<std::string>& folders);

}  // namespace pyroclast::python
