#include "pyroclast/results/inputs.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/stages/run_verdict.hpp"

namespace pyroclast {

std::string Inputs::hash() const {
  std::string all = sha256(deck_text);
  for (const InputFile& file : files) all += fmt::format("\n{} {}", file.name, sha256(file.contents));
  return sha256(all);
}

Inputs inputs_of(const Deck& deck, const Setup& setup) {
  Inputs inputs;
  inputs.references = json_of(setup.references);
  std::vector<std::pair<std::string, std::string>> values;
  for (const DeckFile& named : deck.files()) {
    auto file = std::ranges::find(inputs.files, named.file, &InputFile::source);
    if (file == inputs.files.end()) {
      std::string name = fmt::format("inputs/{}", named.file.filename().string());
      for (int other = 2; std::ranges::find(inputs.files, name, &InputFile::name) != inputs.files.end();
           ++other)
        name = fmt::format("inputs/{}_{}", other, named.file.filename().string());
      file = inputs.files.insert(inputs.files.end(),
                                 {named.file, name, read_file(named.file), verdict_on_run_of(named.file)});
    }
    if (!named.key.empty()) values.emplace_back(named.key, fmt::format("\"{}{}\"", file->name, named.rest));
  }
  if (!setup.specimen.is_of_file()) {
    const auto seed = deck.root().section("specimen").integer("seed", Range::any(), "");
    if (std::cmp_not_equal(seed, setup.specimen.seed))
      values.emplace_back("specimen.seed", std::to_string(setup.specimen.seed));
  }
  inputs.deck_text = deck.with(values);
  return inputs;
}

}  // namespace pyroclast
