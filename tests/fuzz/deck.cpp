#include <string>

#include "pyroclast/setup/setup.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

bool deck(std::string_view text) {
  return takes([&] {
    const Deck deck = Deck::parse(std::string(text), "deck.toml");
    LawSources laws;
    laws.may_compile = false;
    read_setup(deck, "/nowhere", {}, laws);
  });
}

}  // namespace pyroclast::fuzz
