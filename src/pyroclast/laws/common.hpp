#pragma once

#include "pyroclast/laws/law.hpp"

/// Parts that several laws share: infos of numbers, and parts of an update.
namespace pyroclast {

namespace info {

inline constexpr PropertyInfo normal_stiffness{"K_n", "normal stiffness", unit::stiffness_per_area,
                                               Range::positive().usually(1e9, 1e17), Role::normal_stiffness};
inline constexpr PropertyInfo shear_stiffness{"K_s", "shear stiffness", unit::stiffness_per_area,
                                              Range::positive().usually(1e9, 1e17), Role::shear_stiffness};

inline constexpr Range kAngles{.lower = 0.0, .upper = 1.57, .upper_inclusive = false};  // rad
inline constexpr PropertyInfo tensile_strength{"f_t", "tensile strength", unit::stress,
                                               Range::positive().usually(1e4, 50e6), Role::strength};
inline constexpr PropertyInfo mode_1_energy{"G_f1", "mode I fracture energy", unit::fracture_energy,
                                            Range::positive().usually(0.1, 1e4), Role::energy};
inline constexpr PropertyInfo compressive_limit{"f_cm", "compression at which the second slope begins",
                                                unit::stress, Range::positive().usually(1e5, 1e9),
                                                Role::strength};
inline constexpr PropertyInfo hardening{"beta", "second slope in compression over the first",
                                        unit::dimensionless, Range::inside(0.0, 1.0), Role::second_slope};
inline constexpr PropertyInfo cohesion{"c_o", "cohesion", unit::stress, Range::positive().usually(1e4, 1e8),
                                       Role::strength};
inline constexpr PropertyInfo friction_angle{"phi", "friction angle", unit::angle, kAngles};
inline constexpr PropertyInfo mode_2_energy{"G_f2", "mode II fracture energy", unit::fracture_energy,
                                            Range::positive().usually(0.1, 1e5), Role::sliding_energy};

/// Choice of a Compression.
inline constexpr ChoiceInfo compression{"compression",
                                        "how contacts unload from compression",
                                        {{"irreversible", "unloading has slope K_n and leaves a closure"},
                                         {"reversible", "unloading retraces the bilinear curve"}}};

// Bits of ContactResponse::changed.
inline constexpr unsigned kSlid = 1;     ///< the slip changed
inline constexpr unsigned kDamaged = 2;  ///< a damage or the closure changed

inline constexpr InternalInfo closure{"closure", "irreversible, in compression; never decreases",
                                      unit::length, Remembers::closure, kDamaged};
inline constexpr InternalInfo slip{
    "slip", "irreversible part of the tangential jump", unit::length, Remembers::other, kSlid, false};
inline constexpr InternalInfo held_jump{
    "held_jump", "length of the elastic part of the tangential jump", unit::length, Remembers::other, 0,
    false};

inline constexpr LossInfo slip_path{"slip_path", "length of the slip's path", unit::length};
inline constexpr LossInfo lost_in_compression{"compression", "irreversible closure", unit::fracture_energy,
                                              "crushing"};

}  // namespace info

/// Reading of the compression law, Eq. (15).
enum class Compression : std::uint8_t {
  irreversible,  ///< unloading has slope K_n and leaves a closure
  reversible     ///< unloading retraces the bilinear curve
};

/// Returns the same constants as numbers of another kind.
template <class To, class Real, class From>
To same_constants(const From& from) {
  To to;
  To::each([](const auto&, Real& mine, const auto& theirs) { mine = Real(theirs); }, to, from);
  To::each_choice([](const auto&, auto& mine, const auto& theirs) { mine = theirs; }, to, from);
  return to;
}

/// Computes compression with unloading along K_n, which leaves a closure; the yield stress is f_cm + H u_p.
/// \return the opening beyond the closure left behind, m
template <int Dim, class Real, class Constants, class Sum>
Real yield_in_compression(const Constants& c, const Real& opening, Real& closure,
                          ContactResponse<Dim, Real>& r, Sum& loss) {
  Real elastic = opening + closure;  // the traction is zero where the elastic opening is zero
  const Real yielded = c.share_left * (-opening - c.closure_at_limit);
  const auto yields = yielded > closure;
  if (any(yields)) {
    loss += select(
        yields, (yielded - closure) * (c.compressive_limit + 0.5 * c.hardening_slope * (yielded + closure)),
        Real(0.0));
    closure = select(yields, yielded, closure);
    elastic = opening + closure;
    r.changed |= info::kDamaged;
  }
  const Real pressed = smaller(elastic, Real(0.0));
  r.normal_traction = c.normal_stiffness * pressed;
  r.stored = 0.5 * r.normal_traction * pressed;
  return elastic;
}

/// Computes compression that retraces the bilinear curve (15).
template <int Dim, class Real, class Constants>
void follow_compression(const Constants& c, const Real& opening, ContactResponse<Dim, Real>& r) {
  const auto k = c.normal_stiffness;
  const Real pressed = smaller(opening, Real(0.0));
  const Real beyond = larger(-pressed - c.closure_at_limit, Real(0.0));
  const Real within = -pressed - beyond;
  r.normal_traction = k * (pressed + c.share_left * beyond);
  const Real yielded = beyond * (c.compressive_limit + 0.5 * (1.0 - c.share_left) * k * beyond);
  r.stored = 0.5 * k * within * within + select(beyond > 0.0, yielded, Real(0.0));  // f_cm may be infinite
}

/// Computes bilinear compression, Eq. (15): sets the normal traction and the stored energy.
/// \param closure  in and out: closure left behind, m
/// \param loss     gains the energy that yielding dissipates, J/m²
/// \return the opening beyond the closure left behind, m
template <int Dim, class Real, class Constants, class Sum>
Real compress(const Constants& c, const Real& opening, Real& closure, ContactResponse<Dim, Real>& r,
              Sum& loss) {
  if (c.compression == Compression::irreversible)
    return yield_in_compression<Dim, Real>(c, opening, closure, r, loss);
  follow_compression<Dim, Real>(c, opening, r);
  return opening + closure;
}

/// Slides a point by a length along the elastic part of its tangential jump.
/// \param slips    true where the point slides; elsewhere `length` is zero
/// \param elastic  in and out, m
/// \param held     in and out: length of `elastic`, m
template <int Dim, class Truth, class Real>
void slide(const Truth& slips, const Real& length, Tangential<Dim, Real>& slip,
           Tangential<Dim, Real>& elastic, Real& held) {
  Tangential<Dim, Real> step;
  if constexpr (Dim == 2)
    step[0] = signed_like(length, elastic[0]);
  else
    step = elastic * select(slips, length / held, Real(0.0));
  slip += step;
  elastic -= step;
  held = norm(elastic);
}

/// Lets go of the shear that a point still carried, where it is open: the slip follows the jump.
/// \param stiffness  stiffness of the shear that was carried, Pa/m
/// \param held_jump  length of `elastic` after the last update, m
/// \param loss       gains the energy that was held, J/m²
template <int Dim, class Truth, class Real, class Number, class Sum>
void let_go(const Truth& open, const Number& stiffness, const Tangential<Dim, Real>& jump,
            const Real& held_jump, Tangential<Dim, Real>& slip, Tangential<Dim, Real>& elastic, Real& held,
            Sum& loss) {
  const Real released = select(open, 0.5 * stiffness * held_jump * held_jump, Real(0.0));
  if (any(released > 0.0)) loss += released;
  held = select(open, Real(0.0), held);
  for (int i = 0; i + 1 < Dim; ++i) {
    slip[i] = select(open, jump[i], slip[i]);
    elastic[i] = select(open, Real(0.0), elastic[i]);
  }
}

}  // namespace pyroclast
