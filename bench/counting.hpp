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

/// An instruction set of lanes (base/lanes.hpp) that takes one after the other.
/// \tparam Number  what takes the place of a double: arithmetic, <, <=, abs and sqrt, from and to double
template <class Number>
struct OneByOne {
  static constexpr int kWidth = 1;
  using Value = Number;
  using Truth = bool;
  static Value load(const double* p) { return Value{*p}; }
  static void store(double* p, Value v) { *p = static_cast<double>(v); }
  static Value all(double v) { return Value{v}; }
  static Value sqrt(Value v) {
    using std::sqrt;
    return sqrt(v);
  }
  static Value abs(Value v) {
    using std::abs;
    return abs(v);
  }
  /// v, not negative, with the sign of s; zero where s is zero.
  static Value signed_like(Value v, Value s) { return Value{0.0} < s ? v : s < Value{0.0} ? -v : Value{0.0}; }
  static Value smaller(Value a, Value b) { return b < a ? b : a; }
  static Value larger(Value a, Value b) { return a < b ? b : a; }
  static Value power_of_two(Value n) { return Value{pyroclast::power_of_two(static_cast<double>(n))}; }
  static Truth less(Value a, Value b) { return a < b; }
  static Truth less_equal(Value a, Value b) { return a <= b; }
  static Truth both(Truth a, Truth b) { return a && b; }
  static Truth either(Truth a, Truth b) { return a || b; }
  static Truth opposite(Truth a) { return !a; }
  static bool any(Truth a) { return a; }
  static Value select(Truth c, Value yes, Value no) { return c ? yes : no; }
  /// Lanes whose bit is set, the lowest bit first.
  static Truth from_bits(unsigned bits) { return (bits & 1U) != 0; }
  /// Pairs that stand one after the other, apart.
  static void load_pairs(const double* p, Value& x, Value& y) {
    x = load(p);
    y = load(p + 1);
  }
  static void store_pairs(double* p, Value x, Value y) {
    store(p, x);
    store(p + 1, y);
  }
  /// Pairs that stand at offsets, apart.
  static void gather_pairs(const double* p, const int* offset, Value& x, Value& y) {
    load_pairs(p + offset[0], x, y);
  }
  /// Pairs less those that stand at other offsets, apart.
  static void gather_differences(const double* p, const int* offset, const int* less, Value& x, Value& y) {
    x = load(p + offset[0]) - load(p + less[0]);
    y = load(p + offset[0] + 1) - load(p + less[0] + 1);
  }
  static void load_triples(const double* p, Value& x, Value& y, Value& z) {
    x = load(p);
    y = load(p + 1);
    z = load(p + 2);
  }
  static void store_triples(double* p, Value x, Value y, Value z) {
    store(p, x);
    store(p + 1, y);
    store(p + 2, z);
  }
  template <class At>
  static void gather_triples(At at, Value& x, Value& y, Value& z) {
    load_triples(at(0), x, y, z);
  }
  template <class At, class Less>
  static void gather_triple_differences(At at, Less less, Value& x, Value& y, Value& z) {
    x = load(at(0)) - load(less(0));
    y = load(at(0) + 1) - load(less(0) + 1);
    z = load(at(0) + 2) - load(less(0) + 2);
  }
  template <class At>
  static void gather_fours(At at, Value& x, Value& y, Value& z) {
    load_triples(at(0), x, y, z);
  }
  template <class At>
  static void put_fours(At at, Value x, Value y, Value z) {
    store_triples(at(0), x, y, z);
  }
  template <class At>
  static void add_to_fours(At at, Value x, Value y, Value z) {
    double* const p = at(0);
    store_triples(p, load(p) + x, load(p + 1) + y, load(p + 2) + z);
  }
};
using Counting = OneByOne<Counted>;

/// Operations in all lanes of the steps that were not measured, since the last reset.
struct Operations {
  std::int64_t faces = 0;    ///< frames, jumps, contact law, contact forces
  std::int64_t bundles = 0;  ///< sums of contact forces, zones, motion
};

/// The step on Counting, for one thread: it leaves the bits of every other step and adds to `operations()`.
template <int Dim>
pyroclast::StepFunctions<Dim> counting_step();
Operations operations();
void reset_operations();

/// Bytes that a step which nothing damages moves at least, each array that it reads counted once and each
/// that it writes once more, as long as they are, idle lanes with the rest.
///
/// Of the internal variables only the held slip is written always; writes of damages, closures and slips, and
/// losses altogether, which concern only packs where something breaks, yields or slides, are left out, and so
/// are scratch memory and the constants shared by many.
struct Traffic {
  double moved = 0.0;        ///< read plus written
  double working_set = 0.0;  ///< all that is read or written, once
};
template <int Dim>
Traffic traffic(const pyroclast::Mechanics<Dim>& body);

}  // namespace bench
