#pragma once

namespace pyroclast {

/// Raised by every change that alters a result (a cell of history.csv) of a deck in any bit, sums over the
/// body but for their last bits left aside. Such a change names its cases, columns and reason in
/// validation/reference.toml.
inline constexpr int kPhysicsVersion = 8;

}  // namespace pyroclast
