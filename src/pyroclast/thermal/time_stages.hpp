#pragma once

#include <cstdint>
#include <vector>

namespace pyroclast {

/// Scheme by which heat conduction advances in time. Both schemes are explicit and safe up to the stable step
/// of the mesh times a factor that grows with the number of stages.
enum class HeatScheme : std::uint8_t {
  euler,  ///< forward Euler, first order: n stages for n stable steps
  /// Runge-Kutta-Legendre super-time-stepping, second order: about 2 sqrt(n) stages for n stable steps.
  /// Meyer, Balsara and Aslam, J. Comput. Phys. 257 (2014) 594-626.
  super_time_stepping
};

/// One stage of a step from y_0 at time t. With D the increment of y since t and M the rate dy/dt,
/// D_j = previous D_(j-1) + before D_(j-2) + step (rate M(y_(j-1)) + first_rate M(y_0)).
struct TimeStage {
  double previous, before, rate, first_rate;
  double begin, end;  ///< times of y_(j-1) and y_j since t, over the step
  double weight;      ///< weight of M(y_(j-1)) in the increment of the whole step, over the step
};

/// Returns the fewest stages that are stable for a step of `ratio` stable steps of forward Euler.
std::int64_t fewest_stages(HeatScheme scheme, double ratio);

/// Stages of one step. Those of Euler are computed as they are read: there may be very many.
class TimeStages {
 public:
  TimeStages() = default;
  /// \param count  number of stages, from `fewest_stages`
  TimeStages(HeatScheme scheme, std::int64_t count);

  std::int64_t count() const { return count_; }
  TimeStage operator[](std::int64_t j) const;

 private:
  std::int64_t count_ = 0;
  std::vector<TimeStage> legendre_;  ///< stages of the Legendre scheme; empty for Euler
};

}  // namespace pyroclast
