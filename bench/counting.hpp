#pragma once

#include <cmath>
#include <cstdint>

#include "pyroclast/mechanics/step_state.hpp"

/// Counts what a step of the library does, by doing it with numbers that count.
namespace bench {

/// A double that counts the operations that make it: + - * / and square roots, one each. Signs, magnitudes,
/// the smaller and the larger, comparisons and choices are free.
struct Counted {
  double value;

  static inline std::int64_t operations = 0;  ///< of all, by the one thread that counts

  friend Counted operator+(Counted a, Counted b) { return made(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return made(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return made(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return made(a.value / b.value); }
  static Counted made(double value) {
    ++operations;
    return {value};
  }
};

/// An instruction set of base/lanes.hpp: Portable with numbers that count.
struct Counting {
  static constexpr int kWidth = 1;
  using Value = Counted;
  using Truth = bool;
  static Value load(const double* p) { return {*p}; }
  static void store(double* p, Value v) { *p = v.value; }
  static Value all(double v) { return {v}; }
  static Value sqrt(Value v) { return Counted::made(std::sqrt(v.value)); }
  static Value abs(Value v) { return {std::abs(v.value)}; }
  static Value signed_like(Value v, Value s) {
    return {s.value > 0.0 ? v.value : s.value < 0.0 ? -v.value : 0.0};
  }
  static Value smaller(Value a, Value b) { return b.value < a.value ? b : a; }
  static Value larger(Value a, Value b) { return a.value < b.value ? b : a; }
  static Truth less(Value a, Value b) { return a.value < b.value; }
  static Truth less_equal(Value a, Value b) { return a.value <= b.value; }
  static Truth both(Truth a, Truth b) { return a && b; }
  static Truth either(Truth a, Truth b) { return a || b; }
  static Truth opposite(Truth a) { return !a; }
  static bool any(Truth a) { return a; }
  static Value select(Truth c, Value yes, Value no) { return c ? yes : no; }
  static Truth from_bits(unsigned bits) { return (bits & 1U) != 0; }
  static void load_pairs(const double* p, Value& x, Value& y) {
    x = {p[0]};
    y = {p[1]};
  }
  static void store_pairs(double* p, Value x, Value y) {
    p[0] = x.value;
    p[1] = y.value;
  }
  static void gather_pairs(const double* p, const int* offset, Value& x, Value& y) {
    load_pairs(p + offset[0], x, y);
  }
};

/// Operations in all lanes of the steps that were not measured, since the last reset.
struct Operations {
  std::int64_t faces = 0;    ///< frames, jumps, contact law, contact forces
  std::int64_t bundles = 0;  ///< sums of contact forces, zones, motion
};

/// The step on Counting, for one thread: it leaves the bits of every other step and adds to `operations()`.
pyroclast::StepFunctions<2> counting_step();
Operations operations();
void reset_operations();

/// Bytes that a step which nothing damages moves at least, each array that it reads counted once and each
/// that it writes once more, as long as they are, idle lanes with the rest.
///
/// Of the history the slips are written always; damages, closures and losses, which are written only in rows
/// where something breaks or yields, are left out, and so are scratch memory and the constants shared by
/// many.
struct Traffic {
  double moved = 0.0;        ///< read plus written
  double working_set = 0.0;  ///< all that is read or written, once
};
Traffic traffic(const pyroclast::StepState<2>& state);

}  // namespace bench
