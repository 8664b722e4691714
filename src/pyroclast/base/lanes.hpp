#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#if defined(__AVX2__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// Lanes: eight numbers that go through the same arithmetic together, one cache line of doubles.
///
/// A law is written once as a template of its number type `Real`. With Real = double the law computes one
/// point, with Real = Lanes<...> eight points. Only conditions differ: for lanes a condition is a mask. Both
/// branches are then computed and `select` takes one of them lane by lane; `any` tells whether a branch is
/// needed at all.
///
/// Each lane computes as a double does, IEEE 754, operation by operation: every instruction set gives the
/// same bits.
namespace pyroclast {

inline constexpr int kLanes = 8;

/// One number of each of eight things, such as contact points, in memory: a cache line.
struct alignas(64) Line {
  double number[kLanes];
};

// One number

inline double select(bool condition, double yes, double no) {
  return condition ? yes : no;
}
inline bool any(bool condition) {
  return condition;
}
inline double smaller(double a, double b) {
  return b < a ? b : a;
}
inline double larger(double a, double b) {
  return a < b ? b : a;
}

/// Returns v, which is not negative, with the sign of s; zero where s is zero.
inline double signed_like(double v, double s) {
  return s > 0.0 ? v : s < 0.0 ? -v : 0.0;
}

/// Number that, added to a whole number n in [-1022, 1023], leaves n + 1023 in the lowest bits of the sum. A
/// double writes the exponent of 2^n as n + 1023.
inline constexpr double kToExponent = 0x1.8p52 + 1023.0;

/// Returns 2^n for a whole number n in [-1022, 1023].
inline double power_of_two(double n) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(n + kToExponent) << 52);
}

// Instruction sets. A file that names one other than Portable is compiled with that set's options.

/// Instruction set with two lanes in a vector of the compiler: SSE2 on x86-64, NEON on aarch64, elsewhere
/// whatever the compiler makes of the vector. Conditions are vectors of all ones and all zeros, so that
/// choices are bits.
struct Portable {
  static constexpr int kWidth = 2;
  using Value = double __attribute__((vector_size(16)));
  using Truth = decltype(Value{} < Value{});
  using InMemory = double __attribute__((vector_size(16), may_alias));

  static Value load(const double* p) {
    return *static_cast<const InMemory*>(__builtin_assume_aligned(p, sizeof(Value)));
  }
  static void store(double* p, Value v) {
    *static_cast<InMemory*>(__builtin_assume_aligned(p, sizeof(Value))) = v;
  }
  static Value all(double v) { return Value{v, v}; }
  static Value sqrt(Value v) {
#ifdef __SSE2__
    return _mm_sqrt_pd(v);
#else
    return Value{std::sqrt(v[0]), std::sqrt(v[1])};
#endif
  }
  static Value abs(Value v) {
    return reinterpret_cast<Value>(bits_of(v) & ~kSign);
  }
  static Value signed_like(Value v, Value s) {
    const Truth moves = (s < 0.0) | (s > 0.0);
    return reinterpret_cast<Value>(moves & (bits_of(v) ^ (bits_of(s) & kSign)));
  }
  static Value smaller(Value a, Value b) {
    return b < a ? b : a;
  }
  static Value larger(Value a, Value b) {
    return a < b ? b : a;
  }
  static Value power_of_two(Value n) {
    return reinterpret_cast<Value>(bits_of(n + kToExponent) << 52);
  }
  static Truth less(Value a, Value b) {
    return a < b;
  }
  static Truth less_equal(Value a, Value b) {
    return a <= b;
  }
  static Truth both(Truth a, Truth b) {
    return a & b;
  }
  static Truth either(Truth a, Truth b) {
    return a | b;
  }
  static Truth opposite(Truth a) {
    return ~a;
  }
  static bool any(Truth a) {
#ifdef __SSE2__
    return _mm_movemask_pd(reinterpret_cast<Value>(a)) != 0;
#else
    return (a[0] | a[1]) != 0;
#endif
  }
  static Value select(Truth c, Value yes, Value no) {
    return reinterpret_cast<Value>((c & bits_of(yes)) | (~c & bits_of(no)));
  }
  /// Returns a condition that is true in the lanes whose bit is set, the lowest bit first.
  static Truth from_bits(unsigned bits) {
    return Truth{-static_cast<Bits>(bits & 1U), -static_cast<Bits>((bits >> 1U) & 1U)};
  }
  /// Reads consecutive pairs and puts their first numbers into x and their second into y.
  static void load_pairs(const double* p, Value& x, Value& y) {
    part_pairs(load(p), load(p + 2), x, y);
  }
  static void store_pairs(double* p, Value x, Value y) {
    store(p, __builtin_shufflevector(x, y, 0, 2));
    store(p + 2, __builtin_shufflevector(x, y, 1, 3));
  }
  /// Reads pairs that stand at offsets and puts their first numbers into x and their second into y.
  static void gather_pairs(const double* p, const int* offset, Value& x, Value& y) {
    part_pairs(load(p + offset[0]), load(p + offset[1]), x, y);
  }
  /// Reads pairs less the pairs at other offsets and puts the differences apart into x and y.
  static void gather_differences(const double* p, const int* offset, const int* less, Value& x, Value& y) {
    part_pairs(load(p + offset[0]) - load(p + less[0]), load(p + offset[1]) - load(p + less[1]), x, y);
  }
  /// Reads consecutive triples and puts their numbers apart into x, y and z.
  static void load_triples(const double* p, Value& x, Value& y, Value& z) {
    const Value xy = load(p), zx = load(p + 2), yz = load(p + 4);
    x = __builtin_shufflevector(xy, zx, 0, 3);
    y = __builtin_shufflevector(xy, yz, 1, 2);
    z = __builtin_shufflevector(zx, yz, 0, 3);
  }
  static void store_triples(double* p, Value x, Value y, Value z) {
    store(p, __builtin_shufflevector(x, y, 0, 2));
    store(p + 2, __builtin_shufflevector(z, x, 0, 3));
    store(p + 4, __builtin_shufflevector(y, z, 1, 3));
  }
  /// Reads triples, that of lane i at at(i), and puts their numbers apart into x, y and z. Some sets read
  /// four numbers, of which the last is left out: one number more must stand behind the last triple of an
  /// array (FlatArray has it).
  template <class At>
  static void gather_triples(At at, Value& x, Value& y, Value& z) {
    const double *const p = at(0), *const q = at(1);
    x = Value{p[0], q[0]};
    y = Value{p[1], q[1]};
    z = Value{p[2], q[2]};
  }
  /// Reads triples less other triples and puts the differences apart into x, y and z.
  template <class At, class Less>
  static void gather_triple_differences(At at, Less less, Value& x, Value& y, Value& z) {
    Value a, b, c;
    gather_triples(at, x, y, z);
    gather_triples(less, a, b, c);
    x -= a;
    y -= b;
    z -= c;
  }
  /// Reads fours, that of lane i at at(i), and puts their first three numbers apart.
  template <class At>
  static void gather_fours(At at, Value& x, Value& y, Value& z) {
    part_pairs(load(at(0)), load(at(1)), x, y);
    z = __builtin_shufflevector(load(at(0) + 2), load(at(1) + 2), 0, 2);
  }
  /// Writes x, y and z, and a number that means nothing, as fours, that of lane i to at(i).
  template <class At>
  static void put_fours(At at, Value x, Value y, Value z) {
    store(at(0), __builtin_shufflevector(x, y, 0, 2));
    store(at(0) + 2, z);
    store(at(1), __builtin_shufflevector(x, y, 1, 3));
    store(at(1) + 2, __builtin_shufflevector(z, z, 1, 1));
  }
  /// Adds x, y and z to the first three numbers of fours, those of lane i to the four at at(i), lane by lane.
  template <class At>
  static void add_to_fours(At at, Value x, Value y, Value z) {
    const auto add = [](double* p, Value xy, double last) {
      store(p, load(p) + xy);
      p[2] += last;
    };
    add(at(0), __builtin_shufflevector(x, y, 0, 2), z[0]);
    add(at(1), __builtin_shufflevector(x, y, 1, 3), z[1]);
  }

 private:
  using Bits = std::remove_reference_t<decltype(Truth{}[0])>;
  static constexpr Truth kSign{std::numeric_limits<Bits>::min(), std::numeric_limits<Bits>::min()};

  static Truth bits_of(Value v) {
    return reinterpret_cast<Truth>(v);
  }
  static void part_pairs(Value first, Value second, Value& x, Value& y) {
    x = __builtin_shufflevector(first, second, 0, 2);
    y = __builtin_shufflevector(first, second, 1, 3);
  }
};

#ifdef __AVX2__
/// Fours of sets that make them one by one: `Set::for_each_four` calls f(i, four) for the lanes in turn, with
/// x, y, z and a number that means nothing.
template <class Set>
struct FoursOneByOne {
  template <class At, class Value>
  static void put_fours(At at, Value x, Value y, Value z) {
    Set::for_each_four(x, y, z, [&](int i, __m256d four) { _mm256_store_pd(at(i), four); });
  }
  template <class At, class Value>
  static void add_to_fours(At at, Value x, Value y, Value z) {
    Set::for_each_four(x, y, z,
                       [&](int i, __m256d four) { _mm256_store_pd(at(i), _mm256_load_pd(at(i)) + four); });
  }
};

struct Avx2 : FoursOneByOne<Avx2> {
  static constexpr int kWidth = 4;
  using Value = __m256d;
  using Truth = __m256d;
  static Value load(const double* p) { return _mm256_load_pd(p); }
  static void store(double* p, Value v) { _mm256_store_pd(p, v); }
  static Value all(double v) { return _mm256_set1_pd(v); }
  static Value sqrt(Value v) { return _mm256_sqrt_pd(v); }
  static Value abs(Value v) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), v); }
  static Value signed_like(Value v, Value s) {
    const Value sign = _mm256_and_pd(_mm256_set1_pd(-0.0), s);
    const Value moves = _mm256_cmp_pd(s, _mm256_setzero_pd(), _CMP_NEQ_OQ);
    return _mm256_and_pd(moves, _mm256_xor_pd(v, sign));
  }
  static Value smaller(Value a, Value b) { return _mm256_min_pd(b, a); }
  static Value larger(Value a, Value b) { return _mm256_max_pd(b, a); }
  static Value power_of_two(Value n) {
    const __m256i bits = _mm256_castpd_si256(_mm256_add_pd(n, _mm256_set1_pd(kToExponent)));
    return _mm256_castsi256_pd(_mm256_slli_epi64(bits, 52));
  }
  static Truth less(Value a, Value b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
  static Truth less_equal(Value a, Value b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
  static Truth both(Truth a, Truth b) { return _mm256_and_pd(a, b); }
  static Truth either(Truth a, Truth b) { return _mm256_or_pd(a, b); }
  static Truth opposite(Truth a) { return _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))); }
  static bool any(Truth a) { return _mm256_movemask_pd(a) != 0; }
  static Value select(Truth c, Value yes, Value no) { return _mm256_blendv_pd(no, yes, c); }
  static Truth from_bits(unsigned bits) {
    const __m256i lane = _mm256_setr_epi64x(1, 2, 4, 8);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi64x(bits), lane);
    return _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, lane));
  }
  static void load_pairs(const double* p, Value& x, Value& y) {
    const Value v01 = _mm256_load_pd(p), v23 = _mm256_load_pd(p + 4);
    const Value v02 = _mm256_permute2f128_pd(v01, v23, 0x20), v13 = _mm256_permute2f128_pd(v01, v23, 0x31);
    x = _mm256_unpacklo_pd(v02, v13);
    y = _mm256_unpackhi_pd(v02, v13);
  }
  static void store_pairs(double* p, Value x, Value y) {
    const Value v02 = _mm256_unpacklo_pd(x, y), v13 = _mm256_unpackhi_pd(x, y);
    _mm256_store_pd(p, _mm256_permute2f128_pd(v02, v13, 0x20));
    _mm256_store_pd(p + 4, _mm256_permute2f128_pd(v02, v13, 0x31));
  }
  static void gather_pairs(const double* p, const int* offset, Value& x, Value& y) {
    const Value even = two_pairs(p, offset[0], offset[2]), odd = two_pairs(p, offset[1], offset[3]);
    x = _mm256_unpacklo_pd(even, odd);
    y = _mm256_unpackhi_pd(even, odd);
  }
  static void gather_differences(const double* p, const int* offset, const int* less, Value& x, Value& y) {
    const Value even = two_pairs(p, offset[0], offset[2]) - two_pairs(p, less[0], less[2]);
    const Value odd = two_pairs(p, offset[1], offset[3]) - two_pairs(p, less[1], less[3]);
    x = _mm256_unpacklo_pd(even, odd);
    y = _mm256_unpackhi_pd(even, odd);
  }
  /// Reads two pairs by single loads, which cost less than the gather instruction.
  static Value two_pairs(const double* p, int i, int j) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(p + i)), _mm_load_pd(p + j), 1);
  }
  static void load_triples(const double* p, Value& x, Value& y, Value& z) {
    const Value a = _mm256_load_pd(p), b = _mm256_load_pd(p + 4), c = _mm256_load_pd(p + 8);
    const Value xy = _mm256_blend_pd(a, b, 0b1100);       // x0 y0 x2 y2
    const Value zx = _mm256_permute2f128_pd(a, c, 0x21);  // z0 x1 z2 x3
    const Value yz = _mm256_blend_pd(b, c, 0b1100);       // y1 z1 y3 z3
    x = _mm256_shuffle_pd(xy, zx, 0b1010);
    y = _mm256_shuffle_pd(xy, yz, 0b0101);
    z = _mm256_shuffle_pd(zx, yz, 0b1010);
  }
  static void store_triples(double* p, Value x, Value y, Value z) {
    const Value xy = _mm256_unpacklo_pd(x, y), zx = _mm256_shuffle_pd(z, x, 0b1010);
    const Value yz = _mm256_unpackhi_pd(y, z);
    _mm256_store_pd(p, _mm256_permute2f128_pd(xy, zx, 0x20));
    _mm256_store_pd(p + 4, _mm256_blend_pd(yz, xy, 0b1100));
    _mm256_store_pd(p + 8, _mm256_permute2f128_pd(zx, yz, 0x31));
  }
  template <class At>
  static void gather_triples(At at, Value& x, Value& y, Value& z) {
    part_fours(_mm256_loadu_pd(at(0)), _mm256_loadu_pd(at(1)), _mm256_loadu_pd(at(2)), _mm256_loadu_pd(at(3)),
               x, y, z);
  }
  template <class At, class Less>
  static void gather_triple_differences(At at, Less less, Value& x, Value& y, Value& z) {
    const auto difference = [&](int i) { return _mm256_loadu_pd(at(i)) - _mm256_loadu_pd(less(i)); };
    part_fours(difference(0), difference(1), difference(2), difference(3), x, y, z);
  }
  template <class At>
  static void gather_fours(At at, Value& x, Value& y, Value& z) {
    part_fours(_mm256_load_pd(at(0)), _mm256_load_pd(at(1)), _mm256_load_pd(at(2)), _mm256_load_pd(at(3)), x,
               y, z);
  }
  /// Puts the first three numbers of the fours of four lanes apart.
  static void part_fours(Value a, Value b, Value c, Value d, Value& x, Value& y, Value& z) {
    const Value xz01 = _mm256_unpacklo_pd(a, b), xz23 = _mm256_unpacklo_pd(c, d);
    x = _mm256_permute2f128_pd(xz01, xz23, 0x20);
    y = _mm256_permute2f128_pd(_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d), 0x20);
    z = _mm256_permute2f128_pd(xz01, xz23, 0x31);
  }
  template <class F>
  [[gnu::always_inline]] static void for_each_four(Value x, Value y, Value z, F f) {
    const Value xy02 = _mm256_unpacklo_pd(x, y), xy13 = _mm256_unpackhi_pd(x, y);
    const Value z13 = _mm256_unpackhi_pd(z, z);
    f(0, _mm256_permute2f128_pd(xy02, z, 0x20));
    f(1, _mm256_permute2f128_pd(xy13, z13, 0x20));
    f(2, _mm256_permute2f128_pd(xy02, z, 0x31));
    f(3, _mm256_permute2f128_pd(xy13, z13, 0x31));
  }
};
#endif

#ifdef __AVX512F__
struct Avx512 : FoursOneByOne<Avx512> {
  static constexpr int kWidth = 8;
  using Value = __m512d;
  using Truth = __mmask8;
  static Value load(const double* p) { return _mm512_load_pd(p); }
  static void store(double* p, Value v) { _mm512_store_pd(p, v); }
  static Value all(double v) { return _mm512_set1_pd(v); }
  static Value sqrt(Value v) { return _mm512_sqrt_pd(v); }
  static Value abs(Value v) { return _mm512_abs_pd(v); }
  static Value signed_like(Value v, Value s) {
    const Value sign = _mm512_and_pd(_mm512_set1_pd(-0.0), s);
    return _mm512_maskz_xor_pd(_mm512_cmp_pd_mask(s, _mm512_setzero_pd(), _CMP_NEQ_OQ), v, sign);
  }
  static Value smaller(Value a, Value b) { return _mm512_min_pd(b, a); }
  static Value larger(Value a, Value b) { return _mm512_max_pd(b, a); }
  static Value power_of_two(Value n) {
    const __m512i bits = _mm512_castpd_si512(_mm512_add_pd(n, _mm512_set1_pd(kToExponent)));
    return _mm512_castsi512_pd(_mm512_slli_epi64(bits, 52));
  }
  static Truth less(Value a, Value b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static Truth less_equal(Value a, Value b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
  static Truth both(Truth a, Truth b) { return _kand_mask8(a, b); }
  static Truth either(Truth a, Truth b) { return _kor_mask8(a, b); }
  static Truth opposite(Truth a) { return _knot_mask8(a); }
  static bool any(Truth a) { return a != 0; }
  static Value select(Truth c, Value yes, Value no) { return _mm512_mask_blend_pd(c, no, yes); }
  static Truth from_bits(unsigned bits) { return static_cast<Truth>(bits); }
  static void load_pairs(const double* p, Value& x, Value& y) {
    const Value low = _mm512_load_pd(p), high = _mm512_load_pd(p + 8);
    x = _mm512_permutex2var_pd(low, _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14), high);
    y = _mm512_permutex2var_pd(low, _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15), high);
  }
  static void store_pairs(double* p, Value x, Value y) {
    _mm512_store_pd(p, _mm512_permutex2var_pd(x, _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11), y));
    _mm512_store_pd(p + 8, _mm512_permutex2var_pd(x, _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15), y));
  }
  static void gather_pairs(const double* p, const int* offset, Value& x, Value& y) {
    const Value even = every_other_pair(p, offset), odd = every_other_pair(p, offset + 1);
    x = _mm512_unpacklo_pd(even, odd);
    y = _mm512_unpackhi_pd(even, odd);
  }
  static void gather_differences(const double* p, const int* offset, const int* less, Value& x, Value& y) {
    const Value even = every_other_pair(p, offset) - every_other_pair(p, less);
    const Value odd = every_other_pair(p, offset + 1) - every_other_pair(p, less + 1);
    x = _mm512_unpacklo_pd(even, odd);
    y = _mm512_unpackhi_pd(even, odd);
  }
  /// Reads every other pair by single loads and a few shuffles, which cost less than the gather instruction.
  static Value every_other_pair(const double* p, const int* offset) {
    const auto two = [&](int i, int j) {
      return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(p + offset[i])),
                                  _mm_load_pd(p + offset[j]), 1);
    };
    return _mm512_insertf64x4(_mm512_castpd256_pd512(two(0, 2)), two(4, 6), 1);
  }
  static void load_triples(const double* p, Value& x, Value& y, Value& z) {
    const Value a = _mm512_load_pd(p), b = _mm512_load_pd(p + 8), c = _mm512_load_pd(p + 16);
    const auto pick = [&](__m512i of_ab, __m512i of_abc) {
      return _mm512_permutex2var_pd(_mm512_permutex2var_pd(a, of_ab, b), of_abc, c);
    };
    x = pick(_mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0), _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13));
    y = pick(_mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0), _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14));
    z = pick(_mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0), _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15));
  }
  static void store_triples(double* p, Value x, Value y, Value z) {
    const auto pick = [&](__m512i of_xy, __m512i of_xyz) {
      return _mm512_permutex2var_pd(_mm512_permutex2var_pd(x, of_xy, y), of_xyz, z);
    };
    _mm512_store_pd(
        p, pick(_mm512_setr_epi64(0, 8, 0, 1, 9, 0, 2, 10), _mm512_setr_epi64(0, 1, 8, 3, 4, 9, 6, 7)));
    _mm512_store_pd(p + 8, pick(_mm512_setr_epi64(0, 3, 11, 0, 4, 12, 0, 5),
                                _mm512_setr_epi64(10, 1, 2, 11, 4, 5, 12, 7)));
    _mm512_store_pd(p + 16, pick(_mm512_setr_epi64(13, 0, 6, 14, 0, 7, 15, 0),
                                 _mm512_setr_epi64(0, 13, 2, 3, 14, 5, 6, 15)));
  }
  template <class At>
  static void gather_triples(At at, Value& x, Value& y, Value& z) {
    part_fours(two_fours(at, 0, 2), two_fours(at, 1, 3), two_fours(at, 4, 6), two_fours(at, 5, 7), x, y, z);
  }
  template <class At, class Less>
  static void gather_triple_differences(At at, Less less, Value& x, Value& y, Value& z) {
    const auto difference = [&](int i, int j) { return two_fours(at, i, j) - two_fours(less, i, j); };
    part_fours(difference(0, 2), difference(1, 3), difference(4, 6), difference(5, 7), x, y, z);
  }
  template <class At>
  static void gather_fours(At at, Value& x, Value& y, Value& z) {
    gather_triples(at, x, y, z);
  }
  /// Reads the fours of two lanes into one vector.
  template <class At>
  static Value two_fours(At at, int i, int j) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(at(i))), _mm256_loadu_pd(at(j)), 1);
  }
  /// Puts the first three numbers of the fours of eight lanes apart: 0 and 2, 1 and 3, 4 and 6, 5 and 7.
  static void part_fours(Value a, Value b, Value c, Value d, Value& x, Value& y, Value& z) {
    const Value xz0 = _mm512_unpacklo_pd(a, b), xz4 = _mm512_unpacklo_pd(c, d);
    x = _mm512_shuffle_f64x2(xz0, xz4, 0b10001000);
    y = _mm512_shuffle_f64x2(_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d), 0b10001000);
    z = _mm512_shuffle_f64x2(xz0, xz4, 0b11011101);
  }
  template <class F>
  [[gnu::always_inline]] static void for_each_four(Value x, Value y, Value z, F f) {
    const Value xy_even = _mm512_unpacklo_pd(x, y), xy_odd = _mm512_unpackhi_pd(x, y);
    const Value z_odd = _mm512_unpackhi_pd(z, z);
    const auto low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11),
               high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    const Value f02 = _mm512_permutex2var_pd(xy_even, low, z), f46 = _mm512_permutex2var_pd(xy_even, high, z);
    const Value f13 = _mm512_permutex2var_pd(xy_odd, low, z_odd),
                f57 = _mm512_permutex2var_pd(xy_odd, high, z_odd);
    f(0, _mm512_castpd512_pd256(f02));
    f(1, _mm512_castpd512_pd256(f13));
    f(2, _mm512_extractf64x4_pd(f02, 1));
    f(3, _mm512_extractf64x4_pd(f13, 1));
    f(4, _mm512_castpd512_pd256(f46));
    f(5, _mm512_castpd512_pd256(f57));
    f(6, _mm512_extractf64x4_pd(f46, 1));
    f(7, _mm512_extractf64x4_pd(f57, 1));
  }
};
#endif

// Eight numbers

/// Calls `f(i)` for i from 0 to kCount - 1, with a constant i in each call. With a loop the compiler would
/// unroll late and leave lanes in memory until then, which doubles the time of a law on lanes.
template <int kCount, class F>
[[gnu::always_inline]] inline void unroll(F&& f) {
  if constexpr (kCount > 1) unroll<kCount - 1>(f);
  f(std::integral_constant<int, kCount - 1>());
}

/// Condition in each lane.
template <class Set>
struct Mask {
  static constexpr int kParts = kLanes / Set::kWidth;
  typename Set::Truth part[kParts];

  /// Returns the mask whose part i is f(i).
  template <class F>
  [[gnu::always_inline]] static Mask of_parts(F f) {
    Mask m;
    unroll<kParts>([&](auto i) { m.part[i] = f(i); });
    return m;
  }
  /// Returns the mask that is true in the lanes whose bit is set, the lowest bit first.
  static Mask from_bits(unsigned bits) {
    return of_parts(
        [&](auto i) { return Set::from_bits((bits >> (i * Set::kWidth)) & ((1U << Set::kWidth) - 1U)); });
  }
  friend Mask operator&(const Mask& a, const Mask& b) {
    return of_parts([&](auto i) { return Set::both(a.part[i], b.part[i]); });
  }
  friend Mask operator|(const Mask& a, const Mask& b) {
    return of_parts([&](auto i) { return Set::either(a.part[i], b.part[i]); });
  }
  friend Mask operator!(const Mask& a) {
    return of_parts([&](auto i) { return Set::opposite(a.part[i]); });
  }
  friend bool any(const Mask& a) {
    auto sum = a.part[0];
    unroll<kParts>([&](auto i) {
      if constexpr (i > 0) sum = Set::either(sum, a.part[i]);
    });
    return Set::any(sum);
  }
};

template <class Set>
struct Lanes {
  static constexpr int kParts = kLanes / Set::kWidth;
  using Truth = Mask<Set>;
  typename Set::Value part[kParts];

  Lanes() = default;
  /// Puts the same number into every lane.
  Lanes(double v) {  // NOLINT(google-explicit-constructor): a number is a number
    unroll<kParts>([&](auto i) { part[i] = Set::all(v); });
  }
  /// Returns the lanes whose part i is f(i).
  template <class F>
  [[gnu::always_inline]] static Lanes of_parts(F f) {
    Lanes r;
    unroll<kParts>([&](auto i) { r.part[i] = f(i); });
    return r;
  }
  /// Reads eight numbers.
  /// \param p  the numbers, aligned to 64 bytes
  static Lanes load(const double* p) {
    return of_parts([&](auto i) { return Set::load(p + i * Set::kWidth); });
  }
  void store(double* p) const {
    unroll<kParts>([&](auto i) { Set::store(p + i * Set::kWidth, part[i]); });
  }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return of_parts([&](auto i) { return a.part[i] + b.part[i]; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return of_parts([&](auto i) { return a.part[i] - b.part[i]; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return of_parts([&](auto i) { return a.part[i] * b.part[i]; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return of_parts([&](auto i) { return a.part[i] / b.part[i]; });
  }
  friend Lanes operator-(const Lanes& a) { return Lanes(0.0) - a; }
  Lanes& operator+=(const Lanes& o) { return *this = *this + o; }
  Lanes& operator-=(const Lanes& o) { return *this = *this - o; }
  Lanes& operator*=(const Lanes& o) { return *this = *this * o; }
  Lanes& operator/=(const Lanes& o) { return *this = *this / o; }

  friend Truth operator<(const Lanes& a, const Lanes& b) {
    return Truth::of_parts([&](auto i) { return Set::less(a.part[i], b.part[i]); });
  }
  friend Truth operator<=(const Lanes& a, const Lanes& b) {
    return Truth::of_parts([&](auto i) { return Set::less_equal(a.part[i], b.part[i]); });
  }
  friend Truth operator>(const Lanes& a, const Lanes& b) { return b < a; }
  friend Truth operator>=(const Lanes& a, const Lanes& b) { return b <= a; }

  friend Lanes select(const Truth& c, const Lanes& yes, const Lanes& no) {
    return of_parts([&](auto i) { return Set::select(c.part[i], yes.part[i], no.part[i]); });
  }
  friend Lanes sqrt(const Lanes& a) {
    return of_parts([&](auto i) { return Set::sqrt(a.part[i]); });
  }
  friend Lanes abs(const Lanes& a) {
    return of_parts([&](auto i) { return Set::abs(a.part[i]); });
  }
  /// Returns v, which is not negative, with the sign of s; zero where s is zero.
  friend Lanes signed_like(const Lanes& v, const Lanes& s) {
    return of_parts([&](auto i) { return Set::signed_like(v.part[i], s.part[i]); });
  }
  /// Returns b where it is smaller, else a: also where the two cannot be compared.
  friend Lanes smaller(const Lanes& a, const Lanes& b) {
    return of_parts([&](auto i) { return Set::smaller(a.part[i], b.part[i]); });
  }
  friend Lanes larger(const Lanes& a, const Lanes& b) {
    return of_parts([&](auto i) { return Set::larger(a.part[i], b.part[i]); });
  }
  /// Returns 2^n for whole numbers n in [-1022, 1023].
  friend Lanes power_of_two(const Lanes& n) {
    return of_parts([&](auto i) { return Set::power_of_two(n.part[i]); });
  }
  /// Sums all lanes in the order of a tree that does not depend on the instruction set.
  friend double sum(const Lanes& a) {
    alignas(64) double v[kLanes];
    a.store(v);
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
  }
  friend double largest(const Lanes& a) {
    alignas(64) double v[kLanes];
    a.store(v);
    double m = v[0];
    for (int i = 1; i < kLanes; ++i) m = larger(m, v[i]);
    return m;
  }
};

/// Numbers of one part of lanes, with their arithmetic alone. A long computation that goes part by part keeps
/// its numbers in registers.
template <class Set>
struct PartOfLanes {
  typename Set::Value value;

  PartOfLanes() = default;
  PartOfLanes(double v) : value(Set::all(v)) {}  // NOLINT(google-explicit-constructor): a number is a number
  static PartOfLanes of(const typename Set::Value& value) {
    PartOfLanes part;
    part.value = value;
    return part;
  }
  friend PartOfLanes operator+(const PartOfLanes& a, const PartOfLanes& b) { return of(a.value + b.value); }
  friend PartOfLanes operator-(const PartOfLanes& a, const PartOfLanes& b) { return of(a.value - b.value); }
  friend PartOfLanes operator*(const PartOfLanes& a, const PartOfLanes& b) { return of(a.value * b.value); }
  friend PartOfLanes operator/(const PartOfLanes& a, const PartOfLanes& b) { return of(a.value / b.value); }
  PartOfLanes& operator+=(const PartOfLanes& o) { return *this = *this + o; }
  PartOfLanes& operator*=(const PartOfLanes& o) { return *this = *this * o; }
};

}  // namespace pyroclast
