#pragma once

#include "pyroclast/laws/law.hpp"
#include "pyroclast/mechanics/step/packs.hpp"
#include "pyroclast/mechanics/turning_frame.hpp"

/// Contact points: from jumps to tractions to forces, Eqs. (10)-(15), and the sums of the forces at the
/// gridpoints.
namespace pyroclast {

/// Sums of contact forces at gridpoints.
template <int Dim, class Set>
struct ContactForces {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;
  using Vector = typename R::Vector;

  /// Returns `total` plus the forces of the contact points on a pack of gridpoints. The two sides get
  /// opposite signs, or equal signs where stiffness stands in the place of the forces.
  template <Kinematics kKinematics, bool kOpposite>
  static Vector add_forces(const State<Dim>& s, int pack, Vector total) {
    const IndexRange range = s.layout.contacts_of_pack[pack];
    for (int k = range.first; k < range.last; ++k) {
      const ActingContacts& acting = s.layout.acting[k];
      const Vector force = R::gather(s.contact_force, acting.contact);
      if constexpr (kOpposite) {
        const auto side_b = Real::Truth::from_bits(acting.side_b);
        for (int i = 0; i < Dim; ++i) total[i] += select(side_b, -force[i], force[i]);
        if constexpr (kKinematics == Kinematics::finite) total += R::gather(s.turning_force, acting.contact);
      } else {
        total += force;
      }
    }
    return total;
  }
};

/// Directions of the faces of a pack, and with finite kinematics the forces of their turn.
template <int Dim, class Set>
struct FaceFrames {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;
  using Vector = typename R::Vector;

  template <Kinematics kKinematics>
  static auto of(const State<Dim>& s, int pack) {
    if constexpr (kKinematics == Kinematics::finite) {
      return TurningFrame<Dim, Real>(gradient(s, pack));
    } else {
      ContactFrame<Dim, Real> frame;
      for (int t = 0; t + 1 < Dim; ++t) frame.tangents[t] = R::load(s.layout.faces[pack].tangent[t]);
      if constexpr (Dim == 2)
        frame.normal = {{frame.tangents[0][1], -frame.tangents[0][0]}};
      else
        frame.normal = cross(frame.tangents[0], frame.tangents[1]);
      return frame;
    }
  }

  /// Calls `put(force, to)` with the force of the turn on each side of each point.
  template <class Put>
  static void turn(State<Dim>& s, int pack, const TurningFrame<Dim, Real>& frame,
                   const WorkOfTurn<Dim, Real>& work, Put put) {
    const auto by_gradient = frame.minus_derivative(work);
    const int first = s.layout.first_point_of(pack), last = s.layout.first_point_of(pack + 1);
    for (int at = first; at < last; ++at) {
      const auto weight = weights(s, at, first);
      Vector force = by_gradient[0] * weight[0];
      for (int t = 1; t + 1 < Dim; ++t) force += by_gradient[t] * weight[t];
      put(force, &s.turning_force[slot_of(at, 0)]);
    }
  }

  /// Returns by how many times the turn of a face's frame stiffens the face. Where its sides have slid on
  /// each other, a turn opens or closes its points: a side that moves one corner moves all points, the more
  /// so the longer the way against the face. So rows of (1 + way)² times the stiffness bound those of the
  /// face.
  static Real stiffening(const State<Dim>& s, int pack, const TurningFrame<Dim, Real>& frame) {
    const int first = s.layout.first_point_of(pack), last = s.layout.first_point_of(pack + 1);
    Real area = 0.0;
    for (int at = first; at < last; ++at) area += Real::load(s.layout.points[at].area);
    Real length = area / s.thickness, to_unit = 1.0;
    if constexpr (Dim == 2)
      to_unit = 1.0 / length;
    else
      length = sqrt(area);
    Real way = 0.0;
    for (int at = first; at < last; ++at) {
      const PointPack& point = s.layout.points[at];
      const Vector jump = R::gather_differences(s.displacement, point.b, point.a);
      Real of_all = 0.0, of_one = 0.0;
      for (int other = first; other < last; ++other) {
        const auto weight = weights(s, other, first);
        Real moved = 0.0;
        for (int t = 0; t + 1 < Dim; ++t) moved += weight[t] * dot(jump, frame.tangents[t]);
        of_all += abs(moved);
        of_one = larger(of_one, abs(moved) * (area / Real::load(s.layout.points[other].area)));
      }
      const auto is_near = dot(jump, frame.normal) < length * kNear;
      way = larger(way, select(is_near, larger(of_all, of_one) * to_unit, 0.0));
    }
    if (!s.left_out.empty()) way = select(Real::Truth::from_bits(s.left_out[pack]), Real(0.0), way);
    return (1.0 + way) * (1.0 + way);
  }

 private:
  /// Gap over the size of a face from which on its sides bear nothing soon.
  static constexpr double kNear = 0.01;

  /// Returns the weights of the gridpoints of a point in the gradient of their face.
  static std::array<Real, Dim - 1> weights(const State<Dim>& s, int at, [[maybe_unused]] int first) {
    if constexpr (Dim == 2)
      return {at == first ? -0.5 : 0.5};
    else
      return {Real::load(s.turning_weight[2 * at].number), Real::load(s.turning_weight[2 * at + 1].number)};
  }

  static std::array<Vector, Dim - 1> gradient(const State<Dim>& s, int pack) {
    const int first = s.layout.first_point_of(pack);
    if constexpr (Dim == 2) {
      const PointPack* const point = &s.layout.points[first];
      const auto at = [&](const std::array<int, kLanes>& offset) {
        return R::gather(s.gathered_position, offset) + R::gather(s.displacement, offset);
      };
      return {((at(point[1].a) - at(point[0].a)) + (at(point[1].b) - at(point[0].b))) * Real(0.5)};
    } else {
      std::array<Vector, 2> columns;
      for (int t : {0, 1}) columns[t] = R::load(s.face_gradient[pack].tangent[t]);
      for (int at = first; at < s.layout.first_point_of(pack + 1); ++at) {
        const PointPack& point = s.layout.points[at];
        const Vector both = R::gather(s.displacement, point.a) + R::gather(s.displacement, point.b);
        const auto weight = weights(s, at, first);
        for (int t : {0, 1}) columns[t] += both * weight[t];
      }
      return columns;
    }
  }
};

/// Pressure of pore water between the sides of contact points. It parts them by a traction beside that of the
/// law, which no jump changes, or which a further opening lowers.
template <int Dim, class Set>
struct PorePressure {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;

  /// Implements StepPasses::add_pore_pressure.
  static void add(State<Dim>& s, int first, int last) {
    with_kinematics(s, [&](auto kinematics) {
      s.pore_opening.empty() ? add_to<kinematics(), false>(s, first, last)
                             : add_to<kinematics(), true>(s, first, last);
    });
  }

 private:
  template <Kinematics kKinematics, bool kFalls>
  [[gnu::flatten, gnu::noinline]] static void add_to(State<Dim>& __restrict s, int first_pack,
                                                     int last_pack) {
    const auto put = [](const auto& more, Vec<Dim>* to) { R::store(R::load(to) + more, to); };
    using Frames = FaceFrames<Dim, Set>;
    for (int pack = first_pack; pack < last_pack; ++pack) {
      const auto frame = Frames::template of<kKinematics>(s, pack);
      const int first = s.layout.first_point_of(pack), last = s.layout.first_point_of(pack + 1);
      WorkOfTurn<Dim, Real> work;
      for (int at = first; at < last; ++at) {
        const PointPack& point = s.layout.points[at];
        Real force = Real::load(s.pore_pressure[at].number) * Real::load(point.area);
        Vec<Dim, Real> jump{};
        if constexpr (kFalls || kKinematics == Kinematics::finite)
          jump = R::gather_differences(s.displacement, point.b, point.a);
        if constexpr (kFalls) {
          const Real further = dot(jump, frame.normal) - Real::load(s.pore_opening[at].number);
          const Real reserve = s.pore_reserve;
          force = force * (reserve / (reserve + larger(further, Real(0.0))));
        }
        put(frame.normal * -force, &s.contact_force[slot_of(at, 0)]);
        if constexpr (kKinematics == Kinematics::finite)
          for (int t = 0; t + 1 < Dim; ++t) work.tilt[t] += force * dot(jump, frame.tangents[t]);
      }
      if constexpr (kKinematics == Kinematics::finite) Frames::turn(s, pack, frame, work, put);
    }
  }
};

/// Packs of faces that have one law.
template <int Dim, class Set, class Law>
struct Contacts {
  using R = Packs<Dim, Set>;
  using Real = typename R::Real;
  using Vector = typename R::Vector;
  using Frames = FaceFrames<Dim, Set>;
  using OneForAll = typename Law::template Constants<double>;
  using ForEach = typename Law::template Constants<Real>;
  using Internals = typename Law::template Internals<Dim, Real>;

  static constexpr int kInternals = count_of<Internals>();
  static constexpr int kLosses = count_of<typename Law::template Losses<double>>();
  static constexpr int kConstants = count_of<OneForAll>();

  /// Implements PackFunctions::update.
  static void update(State<Dim>& s, int first, int last, bool measure) {
    with_kinematics(s, [&](auto kinematics) {
      if (s.left_out.empty()) return update_packs<kinematics()>(s, first, last, measure);
      for (int pack = first; pack < last;) {
        const bool lacks_some = s.left_out[pack] != 0;
        int end = pack + 1;
        while (end < last && (s.left_out[end] != 0) == lacks_some) ++end;
        (lacks_some ? update_others<kinematics()> : update_packs<kinematics()>)(s, pack, end, measure);
        pack = end;
      }
    });
  }

  /// Implements PackFunctions::place_stiffness.
  static void place_stiffness(State<Dim>& s, int first, int last) {
    with_kinematics(s, [&](auto kinematics) { place_stiffness_of<kinematics()>(s, first, last); });
  }

  // flatten, because lanes that cross a call go through memory
  template <Kinematics kKinematics>
  [[gnu::flatten, gnu::noinline]] static void update_packs(State<Dim>& __restrict s, int first, int last,
                                                           bool measure) {
    for (int pack = first; pack < last; ++pack) {
      R::template fetch_faces_ahead<kInternals, kLosses>(s, pack);
      update_pack<kKinematics>(s, pack, measure, EveryFace());
    }
  }

  /// Updates packs of which some faces are left out: these keep their history, and bear nothing.
  template <Kinematics kKinematics>
  [[gnu::flatten, gnu::noinline]] static void update_others(State<Dim>& __restrict s, int first_pack,
                                                            int last_pack, bool measure) {
    for (int pack = first_pack; pack < last_pack; ++pack) {
      R::template fetch_faces_ahead<kInternals, kLosses>(s, pack);
      const OtherFaces faces{Real::Truth::from_bits(s.left_out[pack])};
      const int first = s.layout.first_point_of(pack);
      if (any(faces.area(s.layout.points[first]) > 0.0)) {
        update_pack<kKinematics>(s, pack, measure, faces);
        continue;
      }
      for (int at = first; at < s.layout.first_point_of(pack + 1); ++at) {
        R::store(Vector{}, &s.contact_force[slot_of(at, 0)]);
        if constexpr (kKinematics == Kinematics::finite) R::store(Vector{}, &s.turning_force[slot_of(at, 0)]);
      }
      if (measure) s.face_sums[pack] = {};
    }
  }

  /// Faces that an update takes through the law: all of a pack.
  struct EveryFace {
    static Real area(const PointPack& point) { return Real::load(point.area); }
    static void put(const Real& number, double* to) { number.store(to); }
    static Real lost(const Real& more) { return more; }
  };
  /// Faces of a pack that are not left out.
  struct OtherFaces {
    typename Real::Truth left_out = Real::Truth::from_bits(0);

    Real area(const PointPack& point) const { return select(left_out, Real(0.0), Real::load(point.area)); }
    void put(const Real& number, double* to) const { select(left_out, Real::load(to), number).store(to); }
    Real lost(const Real& more) const { return select(left_out, Real(0.0), more); }
  };

  /// Implements PackFunctions::update_lanes.
  static LanesResponse update_lanes(const void* constants, const Line* own, const Line* jump, Line* internals,
                                    Line* losses) {
    const auto& of_all = *static_cast<const OneForAll*>(constants);
    Tangential<Dim, Real> tangential;
    for (int t = 0; t + 1 < Dim; ++t) tangential[t] = Real::load(jump[t + 1].number);
    const auto respond = [&](const auto& with) {
      return update_lines(with, Real::load(jump[0].number), tangential, internals, losses, EveryFace());
    };
    const auto r = own ? respond(own_constants(of_all, own)) : respond(of_all);
    LanesResponse response;
    r.normal_traction.store(response.normal_traction.number);
    for (int t = 0; t + 1 < Dim; ++t) r.shear_traction[t].store(response.shear_traction[t].number);
    r.stored.store(response.stored.number);
    response.changed = r.changed;
    return response;
  }

 private:
  template <Kinematics kKinematics>
  [[gnu::flatten]] static void place_stiffness_of(State<Dim>& s, int first_pack, int last_pack) {
    for (int pack = first_pack; pack < last_pack; ++pack) {
      const auto frame = Frames::template of<kKinematics>(s, pack);
      Real stiffer = 1.0;
      if constexpr (kKinematics == Kinematics::finite) stiffer = Frames::stiffening(s, pack, frame);
      const int first = s.layout.first_point_of(pack), last = s.layout.first_point_of(pack + 1);
      for (int at = first; at < last; ++at) {
        const Real area = Real::load(s.layout.points[at].area) * stiffer;
        R::store(s.one_set[pack] ? stiffness(constants_of_set(s, pack), frame.normal, area)
                                 : stiffness(own_constants(s, pack, at - first), frame.normal, area),
                 &s.contact_force[slot_of(at, 0)]);
      }
    }
  }

  /// \param faces  the faces that go through the law: EveryFace or OtherFaces
  template <Kinematics kKinematics, class Faces>
  static void update_pack(State<Dim>& s, int pack, bool measure, const Faces& faces) {
    if (s.one_set[pack]) {
      const OneForAll& constants = constants_of_set(s, pack);
      respond_to_jumps<kKinematics>(
          s, pack, measure, faces,
          [&](int point, const Real& opening, const Tangential<Dim, Real>& tangential) {
            return update_point(s, pack, point, constants, opening, tangential, faces);
          });
    } else {
      respond_to_jumps<kKinematics>(
          s, pack, measure, faces,
          [&](int point, const Real& opening, const Tangential<Dim, Real>& tangential) {
            return update_point(s, pack, point, own_constants(s, pack, point), opening, tangential, faces);
          });
    }
  }

  /// \param faces    as of update_pack
  /// \param respond  function from (point, opening, tangential jump) to a ContactResponse
  template <Kinematics kKinematics, class Faces, class Respond>
  static void respond_to_jumps(State<Dim>& s, int pack, bool measure, const Faces& faces, Respond respond) {
    const auto frame = Frames::template of<kKinematics>(s, pack);
    const int first = s.layout.first_point_of(pack), last = s.layout.first_point_of(pack + 1);
    WorkOfTurn<Dim, Real> work;
    Real stored = 0.0, applied = 0.0, widest = 0.0;
    for (int at = first; at < last; ++at) {
      const PointPack& point = s.layout.points[at];
      const Real area = faces.area(point);
      const Vector jump = R::gather_differences(s.displacement, point.b, point.a);
      const Real opening = dot(jump, frame.normal);
      Tangential<Dim, Real> tangential;
      for (int t = 0; t + 1 < Dim; ++t) tangential[t] = dot(jump, frame.tangents[t]);
      const ContactResponse<Dim, Real> response = respond(at - first, opening, tangential);
      Vector force = frame.normal * (response.normal_traction * area);
      for (int t = 0; t + 1 < Dim; ++t) force += frame.tangents[t] * (response.shear_traction[t] * area);
      R::store(force, &s.contact_force[slot_of(at, 0)]);
      if constexpr (kKinematics == Kinematics::finite && Dim == 2)
        work.add(response.normal_traction, response.shear_traction, opening, tangential);
      if constexpr (kKinematics == Kinematics::finite && Dim == 3)
        work.add(response.normal_traction * area, response.shear_traction * area, opening, tangential);
      if (measure) {
        stored += response.stored * area;
        applied += 2.0 * norm(force);  // counts both sides
        widest = larger(widest, norm(jump));
      }
    }
    if constexpr (kKinematics == Kinematics::finite) {
      if constexpr (Dim == 2) work.tilt *= faces.area(s.layout.points[first]);  // both points share one
      Frames::turn(s, pack, frame, work, [](const Vector& force, Vec<Dim>* to) { R::store(force, to); });
    }
    if (measure) {
      FaceSums& sums = s.face_sums[pack];
      sums.stored = sum(stored);
      sums.applied = sum(applied);
      sums.jump = largest(
          select(faces.area(s.layout.points[first]) > 0.0, widest / size_against_jumps(s, first), 0.0));
    }
  }

  /// Returns the length of the edge in 2D; in 3D, where some faces are tiny, the size of a block.
  static Real size_against_jumps(const State<Dim>& s, int first) {
    if constexpr (Dim == 2) return Real::load(s.layout.points[first].area) * (Dim / s.thickness);
    return s.block_size;
  }

  static const OneForAll& constants_of_set(const State<Dim>& s, int pack) {
    return *reinterpret_cast<const OneForAll*>(&s.contact_constants[s.first_constant[pack]]);
  }

  /// Returns the constants of points that each have their own temperature.
  static ForEach own_constants(const State<Dim>& s, int pack, int point) {
    return own_constants(constants_of_set(s, pack),
                         &s.own_constants[s.first_own_constant[pack] + point * kConstants]);
  }
  /// \param of_set  constants of the set, of which only the choices count
  static ForEach own_constants(const OneForAll& of_set, const Line* line) {
    ForEach c;
    ForEach::each_choice([](const auto&, auto& mine, const auto& theirs) { mine = theirs; }, c, of_set);
    ForEach::each([&](const auto&, Real& number) { number = Real::load(line++->number); }, c);
    return c;
  }

  template <class Constants, class Faces>
  static ContactResponse<Dim, Real> update_point(State<Dim>& s, int pack, int point,
                                                 const Constants& constants, const Real& opening,
                                                 const Tangential<Dim, Real>& tangential,
                                                 const Faces& faces) {
    Line *internals = nullptr, *losses = nullptr;
    if constexpr (kInternals > 0) internals = &s.internals[s.first_internal[pack] + point * kInternals];
    if constexpr (kLosses > 0) losses = &s.loss[s.first_loss[pack] + point * kLosses];
    const auto response = update_lines(constants, opening, tangential, internals, losses, faces);
    if constexpr (kLosses > 0) s.losing[s.layout.first_point_of(pack) + point] = response.changed != 0;
    return response;
  }

  /// Takes eight points through the law. Internal variables are written only where the law says that they
  /// may have changed.
  template <class Constants, class Faces>
  static ContactResponse<Dim, Real> update_lines(const Constants& constants, const Real& opening,
                                                 const Tangential<Dim, Real>& tangential, Line* internals,
                                                 Line* losses, const Faces& faces) {
    Internals h;
    Internals::each(
        [&, line = internals](const auto&, Real& number) mutable { number = Real::load(line++->number); }, h);
    typename Law::template Losses<LineSum<Faces>> sums;
    sums.each(
        [&, line = losses](const auto&, LineSum<Faces>& sum) mutable {
          sum = {line++->number, faces};
        },
        sums);
    const auto response = Law::template update<Dim>(constants, opening, tangential, h, sums);
    Internals::each(
        [&, line = internals](const InternalInfo& info, const Real& number) mutable {
          if (info.when == 0 || (response.changed & info.when) != 0) faces.put(number, line->number);
          ++line;
        },
        h);
    return response;
  }

  /// Sum that adds to eight numbers in an array.
  template <class Faces>
  struct LineSum {
    double* number = nullptr;
    Faces faces{};
    void operator+=(const Real& more) const { (Real::load(number) + faces.lost(more)).store(number); }
  };

  /// Sums |stiffness| over the rows of a contact's matrix. The factor 2 counts the gridpoint itself and the
  /// one across.
  template <class Constants>
  static Vector stiffness(const Constants& constants, const Vector& normal, const Real& area) {
    const auto k = Law::stiffness(constants);
    Vector row;
    for (int i = 0; i < Dim; ++i) {
      Real sum = 0.0;
      for (int j = 0; j < Dim; ++j) {
        const Real nn = normal[i] * normal[j];
        sum += abs(k.normal * nn + k.shear * ((i == j ? 1.0 : 0.0) - nn));
      }
      row[i] = 2.0 * sum * area;
    }
    return row;
  }
};

}  // namespace pyroclast
