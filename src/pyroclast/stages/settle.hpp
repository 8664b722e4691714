#pragma once

#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Stage that lets the body come to rest under its weight, with the upper platen lying on it; then strains
/// count from there.
class Settle : public Stage {
 public:
  struct Keys {
    double unbalanced_ratio = 0.0;  ///< unbalanced ratio below which the body is at rest
    std::int64_t most_steps = 0;    ///< most steps; then the stage gives up, and says so
  };

  explicit Settle(const Keys& keys) : keys_(keys) {}

  const char* kind() const override { return "settle"; }
  StageNeeds needs() const override { return {}; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  void look(const Simulation& simulation) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation&) const override { return 0.0; }  // cannot be foreseen
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  Keys keys_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t steps = 0;  ///< steps since the stage began
    std::int64_t steps_to_look = 0;
  } kept_;
  double ratio_seen_ = 0.0;  ///< unbalanced ratio at the last look
};

StageKind settle_kind();

/// Meaning of `unbalanced_ratio` in stages that bring the body to rest.
inline constexpr Meaning kAtRest = "the body is at rest when unbalanced over applied forces are below this";

/// Returns the steps that a body will probably need to come to rest when its load has changed at once.
/// \param unbalanced_ratio  ratio at which the body counts as at rest
double steps_to_rest(double unbalanced_ratio);

}  // namespace pyroclast
