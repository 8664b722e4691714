#include <sstream>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {
namespace {

/// A small deck that has what a change may aim at: tables, a table in a line, an array of tables, lists.
constexpr const char* kDeck = R"(title = "a"  # note
list = [1, [2, 3]]
[specimen]
width = "150 mm"
E = { value = "70 GPa", times = { table = [["20 degC", 1], ["800 degC", 0]] } }
[specimen.deep]
on = true
[[stages]]
kind = "settle"
[[stages]]
kind = "heat"
to = "500 degC"
"é µ" = "ü"
)";

}  // namespace

bool changes(std::string_view text) {
  std::vector<std::string> lines;
  std::istringstream stream{std::string(text)};
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return takes([&] {
    const Deck deck = Deck::parse(kDeck, "deck.toml", lines);
    require(takes([&] { Deck::parse(deck.text(), "deck.toml"); }), "the text of a changed deck is a deck");
  });
}

}  // namespace pyroclast::fuzz
