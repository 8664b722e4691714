#pragma once

#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Lets the body come to rest under its weight, the upper platen lying on it; then strains count from there.
class Settle : public Stage {
 public:
  struct Keys {
    double unbalanced_ratio = 0.0;  ///< at rest when below
    std::int64_t most_steps = 0;    ///< gives up, and says so, after as many
  };

  explicit Settle(const Keys& keys) : keys_(keys) {}

  const char* kind() const override { return "settle"; }
  StageNeeds needs() const override { return {}; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation&) const override { return 0.0; }  // cannot be foreseen
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  Keys keys_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t steps = 0;  ///< since the stage began
    std::int64_t steps_to_look = 0;
  } kept_;
};

StageKind settle_kind();

/// What `unbalanced_ratio` means in stages that bring the body to rest.
inline constexpr Meaning kAtRest = "the body is at rest when unbalanced over applied forces are below this";

/// Steps that a body will probably need to come to rest when its load has changed at once.
/// \param unbalanced_ratio  at which it counts as at rest
double steps_to_rest(double unbalanced_ratio);

}  // namespace pyroclast
