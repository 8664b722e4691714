#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/material/curve.hpp"
#include "pyroclast/stages/record_results.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

enum class ActionKind : std::uint8_t { hold, release, velocity, force, pressure };

/// Action of a drive on a set of gridpoints.
struct DriveAction {
  std::string set;
  ActionKind kind = ActionKind::hold;
  std::vector<int> components = {};  ///< components that are held, released or moved
  double amount = 0.0;               ///< velocity, m/s, force, N, or pressure, Pa
  Vec<3> direction{};                ///< unit direction of a force
  bool is_follower = false;          ///< true for a pressure that follows the faces
  double ramp_time = 0.0;            ///< time in which the amount comes evenly to its value, s
  std::optional<Curve> factor = {};  ///< factor of the amount, over the time since the stage began, s
  std::string place = "";            ///< place in the deck, for messages

  bool is_load() const { return kind == ActionKind::force || kind == ActionKind::pressure; }
};

/// Condition on a record that ends a drive.
struct EndCondition {
  /// Kind of condition. A rate is the size of the mean change since the look before.
  enum class Kind : std::uint8_t { above, below, share_of_peak, rate_above, rate_below };
  std::string record;
  Kind kind = Kind::above;
  double value = 0.0;                     ///< value in SI, or a share
  std::optional<double> least_peak = {};  ///< size above which a peak counts for share_of_peak, SI
  std::string place = "";
};

/// Control of a drive by an opening, see OpeningControl.
struct ControlKeys {
  std::string record;          ///< record of an opening
  double rate = 0.0;           ///< m/s
  double stiffness = 0.0;      ///< stiffness of the pair, N/m
  double response_time = 0.0;  ///< time in which the loads take over from the pair, s
  std::string place = "";
};

/// Keys of a stage of the kind "drive".
struct DriveKeys {
  double duration = 0.0;  ///< longest duration, s
  std::vector<DriveAction> actions;
  std::vector<EndCondition> until;
  std::optional<ControlKeys> control = {};
  /// Unbalanced ratio at which the body rests and the stage ends, once all ramps have ended.
  std::optional<double> unbalanced_ratio;
  double look_interval = 0.0, frame_interval = 0.0;  ///< s
  std::vector<RecordParameters> records = {};        ///< records of the run
  std::vector<RecordResult> results = {};

  /// Tells whether an action moves or loads a set.
  bool loads() const;
};

/// Reads the table of a drive. Errors are recorded in the deck.
DriveKeys read_drive_keys(const Section& s, const StageTables& tables);

}  // namespace pyroclast
