#pragma once

namespace pyroclast {

/// Version of the physics, raised by every change that alters any bit of a result (a cell of history.csv) of
/// a deck. The last bits of sums over the body do not count. Such a change names its cases, columns and
/// reason in validation/reference.toml.
inline constexpr int kPhysicsVersion = 15;

}  // namespace pyroclast
