#include "pyroclast/setup/read_spalling.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace pyroclast {

std::optional<SpallingRule> read_spalling(const Section& root,
                                          const std::vector<std::unique_ptr<Stage>>& stages) {
  const auto s =
      root.optional_section("spalling",
                            "pieces that come off leave the body in stages that exchange temperatures, see "
                            "[Spalling](../understand/spalling.md); without this table all blocks stay");
  if (!s) return std::nullopt;
  if (std::ranges::none_of(stages, [](const auto& stage) { return stage->needs().exchanges; }))
    s->error("has no meaning: no stage exchanges temperatures with the body, as \"expose\" and \"heat\" do");
  SpallingRule rule;
  rule.bond = s->number("bond", Range::inside(0.0, 1.0).usually(0.001, 0.5), rule.bond,
                        "share of its strength up to which a damaged contact holds nothing any more");
  rule.rim_opening =
      s->quantity("rim_opening", unit::length, Range::positive().usually(1e-5, 5e-3), rule.rim_opening,
                  "mean opening around a loose piece, or way that it has gone, from which it "
                  "leaves; 5 % of its edges where that is less");
  if (s->has("bars")) {
    rule.bars = s->quantities("bars", unit::length, Range::positive().usually(0.005, 0.2),
                              "depths of steel bars below the heated faces: the summary tells when pieces "
                              "bare them, and how hot it is there. The bars themselves are not in the body");
    rule.bars_place = fmt::format("{}: {}.bars", s->where("bars"), s->path());
    std::ranges::sort(rule.bars);
  }
  return rule;
}

}  // namespace pyroclast
