#pragma once

#include <cmath>
#include <cstdint>

#include "pyroclast/mechanics/mechanics.hpp"

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
  friend Counted sqrt(Counted a) { return made(std::sqrt(a.value)); }
  friend Counted operator-(Counted a) { return {-a.value}; }
  friend Counted abs(Counted a) { return {std::abs(a.value)}; }
  friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
  friend bool operator<=(Counted a, Counted b) { return a.value <= b.value; }
  explicit operator double() const { return value; }
  static Counted made(double value) {
    ++operations;
    return {value};
  }
};

using Counting = pyroclast::OneByOne<Counted>;

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
/// Of the history only the held slip is written always; writes of damages, closures and slips, and losses
/// altogether, which concern only rows where something breaks, yields or slides, are left out, and so are
/// scratch memory and the constants shared by many.
struct Traffic {
  double moved = 0.0;        ///< read plus written
  double working_set = 0.0;  ///< all that is read or written, once
};
Traffic traffic(const pyroclast::Mechanics<2>& body);

}  // namespace bench
