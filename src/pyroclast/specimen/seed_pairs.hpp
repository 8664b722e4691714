#pragma once

/// Seeds in pairs on both sides of a surface, so that the facet between their cells is a tangent. Lengths are
/// in spacings, the mean distances of seeds.
namespace pyroclast::specimen {

inline constexpr double kFromSurface = 0.4;   ///< distance of a seed from the surface
inline constexpr double kAlongSurface = 0.9;  ///< distance from seed to seed along the surface
/// Power of a point of the surface, in squared spacings: with it a seed at the offset has a radius of 0.5.
inline constexpr double kPower = 0.25 - kFromSurface * kFromSurface;

}  // namespace pyroclast::specimen
