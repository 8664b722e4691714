#pragma once

#include "pyroclast/mechanics/state.hpp"

/// Packs of eight: functions that load, store and gather lanes, and ask for memory ahead.
namespace pyroclast {

/// Calls `f` with the body's kinematics as a constant.
template <int Dim, class F>
void with_kinematics(const State<Dim>& s, F f) {
  if (s.kinematics == Kinematics::finite) return f(std::integral_constant<Kinematics, Kinematics::finite>());
  f(std::integral_constant<Kinematics, Kinematics::small>());
}

/// Calls `f` with a constant that tells whether zones of the body creep.
template <int Dim, class F>
void with_creep(const State<Dim>& s, F f) {
  if (s.creep_strain.empty()) return f(std::false_type());
  f(std::true_type());
}

/// Calls `f` with a constant that tells whether a pass takes sums.
template <class F>
void with_measuring(Pass pass, F f) {
  if (pass == Pass::move) return f(std::false_type());
  f(std::true_type());
}

/// \tparam Set  an instruction set of base/lanes.hpp
template <int Dim, class Set>
struct Packs {
  using Real = Lanes<Set>;
  using Vector = Vec<Dim, Real>;

  static Vector load(const double (&c)[Dim][kLanes]) {
    Vector v;
    for (int i = 0; i < Dim; ++i) v[i] = Real::load(c[i]);
    return v;
  }
  static void store(const Vector& v, double (&c)[Dim][kLanes]) {
    for (int i = 0; i < Dim; ++i) v[i].store(c[i]);
  }
  /// Reads eight consecutive vectors.
  static Vector load(const Vec<Dim>* p) {
    Vector v;
    if constexpr (Dim == 2) {
      unroll<Real::kParts>(
          [&](auto i) { Set::load_pairs(p[i * Set::kWidth].c.data(), v[0].part[i], v[1].part[i]); });
    } else {
      unroll<Real::kParts>([&](auto i) {
        Set::load_triples(p[i * Set::kWidth].c.data(), v[0].part[i], v[1].part[i], v[2].part[i]);
      });
    }
    return v;
  }
  static void store(const Vector& v, Vec<Dim>* p) {
    if constexpr (Dim == 2) {
      unroll<Real::kParts>(
          [&](auto i) { Set::store_pairs(p[i * Set::kWidth].c.data(), v[0].part[i], v[1].part[i]); });
    } else {
      unroll<Real::kParts>([&](auto i) {
        Set::store_triples(p[i * Set::kWidth].c.data(), v[0].part[i], v[1].part[i], v[2].part[i]);
      });
    }
  }

  static Vector gather(ConstView<Vec<Dim>> vectors, const std::array<int, kLanes>& offset) {
    const double* const numbers = vectors.data()->c.data();
    Vector v;
    if constexpr (Dim == 2) {
      unroll<Real::kParts>([&](auto i) {
        Set::gather_pairs(numbers, offset.data() + i * Set::kWidth, v[0].part[i], v[1].part[i]);
      });
    } else {
      unroll<Real::kParts>([&](auto i) {
        const auto at = [&](int lane) { return numbers + offset[i * Set::kWidth + lane]; };
        Set::gather_triples(at, v[0].part[i], v[1].part[i], v[2].part[i]);
      });
    }
    return v;
  }
  static Vector gather_differences(ConstView<Vec<Dim>> vectors, const std::array<int, kLanes>& offset,
                                   const std::array<int, kLanes>& less) {
    const double* const numbers = vectors.data()->c.data();
    Vector v;
    if constexpr (Dim == 2) {
      unroll<Real::kParts>([&](auto i) {
        Set::gather_differences(numbers, offset.data() + i * Set::kWidth, less.data() + i * Set::kWidth,
                                v[0].part[i], v[1].part[i]);
      });
    } else {
      unroll<Real::kParts>([&](auto i) {
        const auto at = [&](int lane) { return numbers + offset[i * Set::kWidth + lane]; };
        const auto other = [&](int lane) { return numbers + less[i * Set::kWidth + lane]; };
        Set::gather_triple_differences(at, other, v[0].part[i], v[1].part[i], v[2].part[i]);
      });
    }
    return v;
  }

  /// Puts one vector into every lane.
  static Vector all(const Vec<Dim>& one) {
    Vector v;
    for (int i = 0; i < Dim; ++i) v[i] = one[i];
    return v;
  }
  /// Returns a vector where a condition is true, else zero.
  static Vector where(const typename Real::Truth& condition, const Vector& v) {
    Vector w;
    for (int i = 0; i < Dim; ++i) w[i] = select(condition, v[i], Real(0.0));
    return w;
  }
  /// Reads eight consecutive fours.
  static Vector load(const Four* p) {
    Vector v;
    unroll<Real::kParts>([&](auto i) {
      const auto at = [&](int lane) { return p[i * Set::kWidth + lane].c; };
      Set::gather_fours(at, v[0].part[i], v[1].part[i], v[2].part[i]);
    });
    return v;
  }
  static void store(const Vector& v, Four* p) {
    unroll<Real::kParts>([&](auto i) {
      const auto at = [&](int lane) { return p[i * Set::kWidth + lane].c; };
      Set::put_fours(at, v[0].part[i], v[1].part[i], v[2].part[i]);
    });
  }
  /// Returns fours as the array of numbers that they lie in: more than the four numbers of the first.
  static const double* numbers_of(const Four* fours) {
    return static_cast<const double*>(static_cast<const void*>(fours));
  }
  static double* numbers_of(Four* fours) { return static_cast<double*>(static_cast<void*>(fours)); }
  /// Reads fours by their places in an array of numbers.
  template <class Place>
  static Vector gather(const Four* fours, const std::array<Place, kLanes>& place) {
    Vector v;
    unroll<Real::kParts>([&](auto i) {
      const auto at = [&](int lane) { return numbers_of(fours) + place[i * Set::kWidth + lane]; };
      Set::gather_fours(at, v[0].part[i], v[1].part[i], v[2].part[i]);
    });
    return v;
  }
  /// Reads fours of gridpoints by the offsets of their vectors.
  static Vector gather_places(ConstView<Four> fours, const std::array<int, kLanes>& offset) {
    std::array<int, kLanes> place;
    for (int lane = 0; lane < kLanes; ++lane) place[lane] = 4 * (offset[lane] / offset_of<Dim>(1));
    return gather(fours.data(), place);
  }
  /// Adds vectors to fours, lane by lane: two lanes may have the same place.
  template <class Place>
  static void add(const Vector& v, Four* fours, const std::array<Place, kLanes>& place) {
    unroll<Real::kParts>([&](auto i) {
      const auto at = [&](int lane) { return numbers_of(fours) + place[i * Set::kWidth + lane]; };
      Set::add_to_fours(at, v[0].part[i], v[1].part[i], v[2].part[i]);
    });
  }

  // Processors do not foresee streams well among so much arithmetic; lines come best a few at a time, all
  // through the step.

  static constexpr int kPacksAhead = 16;      ///< lead over the present pack, in packs of gridpoints
  static constexpr int kZonePacksAhead = 32;  ///< lead in packs of zones, about as far
  static constexpr int kFacePacksAhead = 8;   ///< lead in packs of faces, about as far
  /// Lead for faces between chunks, in packs of faces. Their gridpoints stand anywhere, so they are asked for
  /// one by one, once the pack of points itself has come.
  static constexpr int kScatteredPacksAhead = 4;

  template <int kLines>
  static void fetch(const void* begin) {
    for (int i = 0; i < kLines; ++i) __builtin_prefetch(static_cast<const char*>(begin) + 64 * i);
  }
  template <class Pack>
  static void fetch(const Pack& pack) {
    fetch<(sizeof(Pack) + 63) / 64>(&pack);
  }
  static void fetch_ahead(ConstView<VectorPack<Dim>> vectors, int pack) {
    const auto ahead = static_cast<std::size_t>(pack) + kPacksAhead;
    if (ahead < vectors.size()) fetch(vectors[ahead]);
  }
  static void fetch_ahead(ConstView<double> numbers, int pack) {
    const auto ahead = static_cast<std::size_t>(slot_of(pack + kPacksAhead, 0));
    if (ahead < numbers.size()) fetch<1>(&numbers[ahead]);
  }
  static void fetch_ahead(ConstView<Four> fours, int pack) {
    const auto ahead = static_cast<std::size_t>(slot_of(pack + kPacksAhead, 0));
    if (ahead < fours.size()) fetch<4>(&fours[ahead]);
  }
  static void fetch_ahead(ConstView<RaggedCorners<Dim>> zones, int zone_pack) {
    const auto ahead = static_cast<std::size_t>(zone_pack + kZonePacksAhead);
    if (ahead < zones.size()) fetch<1>(&zones[ahead]);
  }
  static void fetch_scattered(const State<Dim>& s, int pack) {
    for (int point = s.layout.first_point_of(pack); point < s.layout.first_point_of(pack + 1); ++point)
      for (int lane = 0; lane < kLanes; ++lane) {
        const PointPack& points = s.layout.points[point];
        __builtin_prefetch(&s.displacement[points.a[lane] / offset_of<Dim>(1)]);
        __builtin_prefetch(&s.displacement[points.b[lane] / offset_of<Dim>(1)]);
      }
  }
  /// Asks memory for the internal variables and losses of a pack of faces of any law.
  [[gnu::noinline]] static void fetch_internals(const State<Dim>& s, int pack) {
    for (int i = s.first_internal[pack]; i < s.first_internal[pack + 1]; ++i) fetch(s.internals[i]);
    const int first = s.layout.first_point_of(pack), points = s.layout.first_point_of(pack + 1) - first;
    const int losses = (s.first_loss[pack + 1] - s.first_loss[pack]) / points;
    for (int point = 0; point < points; ++point)
      for (int i = 0; i < losses && s.losing[first + point]; ++i)
        fetch(s.loss[s.first_loss[pack] + point * losses + i]);
  }
  /// Asks memory for all that packs of faces ahead need, and for the displacements that no pack before them
  /// reads.
  /// \tparam kInternals, kLosses  lines of a point of the present pack; later packs of the same law have as
  ///                              many
  template <int kInternals, int kLosses>
  static void fetch_faces_ahead(const State<Dim>& s, int pack) {
    const auto& layout = s.layout;
    if (const int next = pack + kScatteredPacksAhead;
        next < static_cast<int>(layout.faces.size()) && layout.between_chunks[next])
      fetch_scattered(s, next);
    const int ahead = pack + kFacePacksAhead;
    if (ahead >= static_cast<int>(layout.faces.size())) return;
    fetch(layout.faces[ahead]);
    const bool same = s.law_of_faces[ahead] == s.law_of_faces[pack];
    const int first = layout.first_point_of(ahead), last = layout.first_point_of(ahead + 1);
    for (int point = first; point < last; ++point) {
      fetch(layout.points[point]);
      if (!same) continue;  // fetched below
      if constexpr (kInternals > 0)
        fetch<kInternals>(&s.internals[s.first_internal[ahead] + (point - first) * kInternals]);
      if constexpr (kLosses > 0)
        if (s.losing[point]) fetch<kLosses>(&s.loss[s.first_loss[ahead] + (point - first) * kLosses]);
    }
    if (!same) fetch_internals(s, ahead);
    for (int r = layout.packs_reached[ahead]; r < layout.packs_reached[ahead + 1]; ++r)
      fetch<Dim>(&s.displacement[slot_of(r, 0)]);
  }

  /// Displacements and sums of forces of a bundle during its step, one pack for each of its packs.
  struct Scratch {
    VectorPack<Dim>* displacement;
    VectorPack<Dim>* sum;
    Four* seen;    ///< displacements in a ragged bundle, seen from its centre, m
    Four* summed;  ///< sums of forces in a ragged bundle, while its zones add to them
  };
  /// \param memory  scratch of StepPasses::move_bundles
  static Scratch scratch_of(const Bundle& bundle, double* memory) {
    auto* packs = reinterpret_cast<VectorPack<Dim>*>(memory);
    auto* const fours = reinterpret_cast<Four*>(packs + 2 * bundle.packs);
    return {packs, packs + bundle.packs, fours, fours + slot_of(bundle.packs, 0)};
  }

  /// Sums that a step of a bundle books, still lane by lane; see BundleSums.
  struct Sums {
    Real stored = 0.0, kinetic = 0.0, applied = 0.0, unbalanced = 0.0;
    Real damping = 0.0, viscous = 0.0, begun_damping = 0.0, begun_viscous = 0.0;
    Real loading = 0.0, begun_loading = 0.0;
  };
};

}  // namespace pyroclast
