#include "pyroclast/laws/kit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/random.hpp"

namespace pyroclast {

namespace {

enum Property {
  at_rest,
  finite,
  damages,
  losses,
  stored_energy,
  repeated,
  lanes,
  frame,
  balance_on_one_axis,
  balance,
  steps_on_one_axis,
  steps,
  stiffness_bound,
  stiffness_reached,
  first_stiffness,
  continuity,
  objections,
  property_count
};

// Error by round-off that is allowed over a scale: K u of tractions, u of lengths, t u of energies. u is the
// largest jump and t the largest traction of the path so far, K the larger stiffness.
constexpr double kRoundOff = 1e-10;
/// Error of the balance on one axis that is allowed: the quadrature goes on until its own error is less.
constexpr double kBalance = 1e-8;
/// Least order in the number of cuts, of the sum over all legs, and the share of traction times way by which
/// energies of a leg may change where the order is taken.
constexpr double kOrder = 0.9, kLittleChange = 1e-3;
/// Share of a stiffness bound that must be reached: a bound that is higher costs steps for nothing.
constexpr double kReached = 0.5;

const std::array<KitFinding, property_count> kProperties{{
    {"rest", "a new contact without a jump carries, holds and loses nothing"},
    {"finite", "every number of an answer is finite"},
    {"damages", "a damage stays from 0 to 1 and never falls"},
    {"losses", "no loss is negative, each is added to earlier losses"},
    {"stored", "stored energy is not negative"},
    {"repeated", "the same jump again: same traction, same internals, nothing lost", 0, 0, 0.0, kRoundOff},
    {"lanes",
     "eight lanes give the bits of eight numbers (but for the sign of zero), and name the same changes"},
    {"frame", "turning the jump turns the answer; a plane path gives the same in 3D", 0, 0, 0.0, kRoundOff},
    {"balance, one axis", "work = change of stored energy + losses", 0, 0, 0.0, kBalance},
    {"balance", "the same on any leg: error of a step of second order in the step", 0, 0, 0.0, 1.0},
    {"steps, one axis", "the answer does not depend on how a leg is cut", 0, 0, 0.0, kRoundOff},
    {"steps", "on any leg the answer converges with the number of cuts, order 1 or better"},
    {"stiffness", "no step is answered more stiffly than the bound", 0, 0, 0.0, 1e-6},
    {"bound reached", "and the bound is no more than twice the stiffness that was found"},
    {"first stiffness", "a new contact is as stiff in compression as its property says", 0, 0, 0.0, 1e-6},
    {"continuity", "a small step changes tractions little, unless energy is lost"},
    {"objections", "name a property and, where they give a bound, the bound"},
}};

/// Jump of a point: opening and tangential components, m.
using Jump = std::array<double, 3>;

struct Point {
  Jump jump{};
  std::vector<double> internals;
  PointResponse response;
};

/// Properties at one temperature.
struct Material {
  std::vector<double> numbers;
  std::vector<int> choices;
  std::vector<std::byte> constants;
  ContactStiffness<double> stiffness;
};

double log_uniform(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}

int below(Random& random, int count) {
  return std::min(static_cast<int>(random.uniform() * count), count - 1);
}

/// Tells whether a new point may have other than 0 because its properties are those of a hot contact.
bool follows_properties(Remembers what) {
  return what == Remembers::lost_strength || what == Remembers::parameter;
}

bool same_unit(const Unit& a, const Unit& b) {
  return std::string_view(a.si) == b.si;
}

/// Tells whether two numbers are the same but for the sign of zero: in lanes a nothing may be added to -0.
bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

Jump between(const Jump& a, const Jump& b, double share) {
  if (share == 1.0) return b;
  Jump j;
  for (std::size_t i = 0; i < 3; ++i) j[i] = a[i] + share * (b[i] - a[i]);
  return j;
}

double length(const Jump& j) {
  return std::sqrt(j[0] * j[0] + j[1] * j[1] + j[2] * j[2]);
}

Jump difference(const Jump& a, const Jump& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Jump traction(const PointResponse& r) {
  return {r.normal_traction, r.shear_traction[0], r.shear_traction[1]};
}

double dot(const Jump& a, const Jump& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns the range of the numbers that decks hold for a property, by its unit.
std::pair<double, double> usual(const PropertyInfo& info) {
  const auto is = [&](const Unit& unit) { return same_unit(info.unit, unit); };
  if (is(unit::stiffness_per_area)) return {5e12, 5e13};
  if (is(unit::stress)) return {0.2e6, 60e6};
  if (is(unit::fracture_energy)) return {5.0, 1000.0};
  if (is(unit::length)) return {1e-6, 1e-4};
  if (is(unit::angle)) return {0.0, 1.0};
  if (is(unit::dimensionless)) return {0.0, 1.2};
  return {0.1, 10.0};
}

double draw(const PropertyInfo& info, Random& random) {
  auto [low, high] = usual(info);
  low = std::max(low, info.range.lower);
  high = std::min(high, info.range.upper);
  if (!(low < high)) {
    // none of the usual numbers are allowed
    low = std::isfinite(info.range.lower) ? info.range.lower : info.range.any_value() - 1.0;
    high = std::isfinite(info.range.upper) ? info.range.upper : low + std::abs(low) + 1.0;
  }
  if (random.uniform() < 0.05 && info.range.contains(info.range.lower) && std::isfinite(info.range.lower))
    return info.range.lower;
  for (int i = 0; i < 100; ++i) {
    const bool by_decades = low > 0.0 || (random.uniform() < 0.3 && low == 0.0);
    const double value =
        by_decades ? log_uniform(random, low > 0.0 ? low : 1e-3 * high, high) : random.uniform(low, high);
    if (info.range.contains(value)) return value;
  }
  return info.range.any_value();
}

class Kit {
 public:
  Kit(const LawTable& law, const KitOptions& options)
      : law_(law), options_(options), findings_(kProperties.begin(), kProperties.end()) {}

  KitReport run() {
    for (const int dim : options_.dimensions) {
      dim_ = dim;
      for (int first = 0; first < options_.paths; first += kLanes) travel(first);
    }
    judge_order();
    for (int i = 0; i < 2; ++i)
      note(stiffness_reached, stiffest_[i] >= kReached, [&] {
        return fmt::format("the {} bound: nothing stiffer than {:.3g} of it was found",
                           i == 0 ? "normal" : "shear", stiffest_[i]);
      });
    return {&law_, options_, findings_, order_};
  }

 private:
  static constexpr int kLegs = 12, kMaterials = 3;
  static constexpr int kFewestCuts = 256, kMostCuts = 1 << 18;

  enum class Kind { normal, shear, any };

  /// Path and its point.
  struct Path {
    Kind kind = Kind::any;
    std::vector<Material> materials;
    int material = 0;
    Point point;
    Point turned;  ///< same point in a frame turned by the next three:
    double cosine = 1.0, sine = 0.0;
    bool mirrored = false;
    Point in_space;                        ///< point of a plane path in 3D
    std::array<double, 2> line{1.0, 0.0};  ///< unit direction of the tangential jump
    Jump before_last{};
    double traction = 0.0, jump = 0.0;  ///< largest traction and jump so far, Pa, m
    double energy = 0.0;                ///< largest energy stored or lost in a step, J/m²
    std::vector<double> lengths;        ///< lengths that mean something to the law, m
    double deepest = 0.0;               ///< opening at the greatest pressure, m
  };

  // -- properties --------------------------------------------------------------------------------

  std::vector<int> draw_choices(Random& random) const {
    std::vector<int> choices;
    for (const ChoiceInfo& info : law_.choices) {
      int options = 0;
      while (options < ChoiceInfo::kMostOptions && info.options[options].name) ++options;
      choices.push_back(below(random, options));
    }
    return choices;
  }

  std::vector<double> draw_numbers(Random& random) const {
    std::vector<double> numbers;
    const auto& infos = law_.properties;
    for (std::size_t i = 0; i < infos.size(); ++i) {
      double value = draw(infos[i], random);
      // equal numbers are a case of their own
      for (std::size_t j = 0; j < i; ++j)
        if (same_unit(infos[i].unit, infos[j].unit) && random.uniform() < 0.1 &&
            infos[i].range.contains(numbers[j]))
          value = numbers[j];
      numbers.push_back(value);
    }
    return numbers;
  }

  /// Returns properties as at another temperature, by ratios that any user's curve could have.
  std::vector<double> warmed(const std::vector<double>& cold, Random& random) const {
    const double stiffness = log_uniform(random, 0.1, 1.3), one_for_all = log_uniform(random, 0.1, 1.3);
    const bool alike = random.uniform() < 0.5;
    std::vector<double> numbers = cold;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const PropertyInfo& info = law_.properties[i];
      switch (info.role) {
        case Role::normal_stiffness:
        case Role::shear_stiffness:
          numbers[i] *= stiffness;
          break;
        case Role::strength:
        case Role::energy:
        case Role::sliding_energy:
          numbers[i] *= alike ? one_for_all : log_uniform(random, 0.1, 1.6);
          break;
        case Role::plain:
        case Role::first_softening:
        case Role::second_slope:
        case Role::cold_strength:
        case Role::hidden_cracks:
          if (random.uniform() < 0.3) numbers[i] = draw(info, random);
      }
      if (!info.range.contains(numbers[i])) numbers[i] = cold[i];
    }
    return numbers;
  }

  template <class Draw>
  Material material(const std::vector<int>& choices, Draw draw_numbers_once) {
    for (int i = 0; i < 10000; ++i) {
      Material m{draw_numbers_once(), choices, std::vector<std::byte>(law_.constants_size), {}};
      const Objection objection = law_.check(m.numbers.data(), choices.data());
      if (objection.key) {
        check_objection(m, objection);
        continue;
      }
      law_.derive(m.numbers.data(), choices.data(), m.constants.data());
      m.stiffness = law_.stiffness(m.constants.data());
      return m;
    }
    throw Error(fmt::format("the law \"{}\" objects to all of 10000 drawn sets of properties", law_.name));
  }

  /// Checks that the law objects a little to one side of the bound of an objection, and not to the other.
  void check_objection(const Material& m, const Objection& objection) {
    const auto info = std::ranges::find_if(
        law_.properties, [&](const PropertyInfo& p) { return std::string_view(p.key) == objection.key; });
    bool right = info != law_.properties.end() && objection.wanted;
    if (right && std::string_view(objection.wanted).find('%') != std::string_view::npos) {
      const auto objects_at = [&](double value) {
        auto numbers = m.numbers;
        numbers[info - law_.properties.begin()] = value;
        const Objection again = law_.check(numbers.data(), m.choices.data());
        return again.key && std::string_view(again.key) == objection.key;
      };
      const double value = m.numbers[info - law_.properties.begin()];
      const double aside = 1e-6 * std::max(std::abs(objection.bound), std::abs(value));
      right = std::isfinite(objection.bound) &&
              objects_at(objection.bound + aside) != objects_at(objection.bound - aside);
    }
    note(objections, right, [&] {
      return fmt::format("{}; objection to \"{}\": {}, bound {:.17g}", properties_text(m), objection.key,
                         objection.wanted ? objection.wanted : "(nothing)", objection.bound);
    });
  }

  double greatest_strength(const Material& m) const {
    double greatest = 0.0;
    for (std::size_t i = 0; i < m.numbers.size(); ++i)
      if (law_.properties[i].role == Role::strength) greatest = std::max(greatest, m.numbers[i]);
    return greatest > 0.0 ? greatest : 30e6;
  }

  std::vector<double> lengths_of(const Material& m) const {
    std::vector<double> strengths, energies, all;
    for (std::size_t i = 0; i < m.numbers.size(); ++i) {
      const PropertyInfo& info = law_.properties[i];
      if (info.role == Role::strength && m.numbers[i] > 0.0) strengths.push_back(m.numbers[i]);
      if (is_energy(info.role) && m.numbers[i] > 0.0) energies.push_back(m.numbers[i]);
      if (same_unit(info.unit, unit::length) && m.numbers[i] > 0.0) all.push_back(m.numbers[i]);
    }
    if (strengths.empty()) strengths.push_back(greatest_strength(m));
    for (const double s : strengths) {
      for (const double k : {m.stiffness.normal, m.stiffness.shear}) all.push_back(s / k);
      for (const double g : energies) all.push_back(2.0 * g / s);
    }
    // a strength that is next to nothing would need metres
    for (double& l : all) l = std::min(l, 1e-2);
    return all;
  }

  /// Returns the opening at which a new contact presses with so much, m.
  double opening_at(const Material& m, double pressure) {
    Point p = new_point(dim_);
    double opening = -pressure / m.stiffness.normal;
    for (int i = 0; i < 24; ++i) {
      p = new_point(dim_);
      p.jump = {opening, 0.0, 0.0};
      std::vector<double> lost(law_.losses.size());
      p.response = law_.update(dim_)(m.constants.data(), p.jump.data(), p.internals.data(), lost.data());
      if (-p.response.normal_traction >= 0.99 * pressure) break;
      opening *= 1.5;
    }
    return opening;
  }

  // -- one update --------------------------------------------------------------------------------

  Point new_point(int dim) const { return {{}, std::vector<double>(law_.internals(dim).size()), {}}; }

  double energy(const std::vector<double>& lost) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < lost.size(); ++i)
      if (same_unit(law_.losses[i].unit, unit::fracture_energy)) sum += lost[i];
    return sum;
  }

  /// Takes a point of the path to a jump. Returns its losses.
  const std::vector<double>& go(Path& path, Point& p, const Jump& to, int dim) {
    const Material& m = path.materials[path.material];
    before_ = p;
    lost_.assign(law_.losses.size(), 0.0);
    p.jump = to;
    p.response = law_.update(dim)(m.constants.data(), to.data(), p.internals.data(), lost_.data());
    path.traction = std::max(path.traction, length(traction(p.response)));
    path.jump = std::max(path.jump, length(to));
    path.energy = std::max({path.energy, p.response.stored, energy(lost_)});
    ++updates_;

    const PointResponse& r = p.response;
    bool all_finite = std::isfinite(r.normal_traction) && std::isfinite(r.shear_traction[0]) &&
                      std::isfinite(r.shear_traction[1]) && std::isfinite(r.stored);
    for (const double v : p.internals) all_finite = all_finite && std::isfinite(v);
    for (const double v : lost_) all_finite = all_finite && std::isfinite(v);
    note(finite, all_finite, [&] { return step_text(path, p); });
    note(stored_energy, r.stored >= -kRoundOff * energies(path), [&] { return step_text(path, p); });
    bool grow = true;
    const auto infos = law_.internals(dim);
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const Remembers what = infos[i].what;
      if (what == Remembers::tension_damage || what == Remembers::shear_damage ||
          what == Remembers::mixed_damage || what == Remembers::lost_strength)
        grow = grow && p.internals[i] >= before_.internals[i] && p.internals[i] <= 1.0;
    }
    note(damages, grow, [&] { return step_text(path, p); });
    bool positive = true;
    for (const double v : lost_) positive = positive && v >= 0.0;
    note(losses, positive, [&] { return step_text(path, p); });
    return lost_;
  }

  /// Returns the largest difference of two points that should be the same, over its scale.
  double apart(const Path& path, const Point& a, const Point& b, int dim) const {
    const Material& m = path.materials[path.material];
    const double k = std::max(m.stiffness.normal, m.stiffness.shear);
    const double u = path.jump;
    double most = over(length(difference(traction(a.response), traction(b.response))), k * u);
    most = larger_or_nan(most, over(a.response.stored - b.response.stored, energies(path)));
    const auto infos = law_.internals(dim);
    for (std::size_t i = 0; i < infos.size(); ++i)
      most = larger_or_nan(most, over(a.internals[i] - b.internals[i], scale(path, infos[i].unit, k)));
    return most;
  }
  double apart(const Path& path, const std::vector<double>& lost_a, const std::vector<double>& lost_b) const {
    const Material& m = path.materials[path.material];
    const double k = std::max(m.stiffness.normal, m.stiffness.shear);
    double most = 0.0;
    for (std::size_t i = 0; i < lost_a.size(); ++i)
      most = larger_or_nan(most, over(lost_a[i] - lost_b[i], scale(path, law_.losses[i].unit, k)));
    return most;
  }
  /// Returns the scale of round-off in energies, J/m².
  static double energies(const Path& path) { return path.traction * path.jump + path.energy; }
  static double scale(const Path& path, const Unit& unit, double k) {
    if (same_unit(unit, unit::length)) return path.jump;
    if (same_unit(unit, unit::stress)) return k * path.jump;
    if (same_unit(unit, unit::fracture_energy)) return energies(path);
    return 1.0;
  }
  static double over(double difference, double scale) {
    return difference == 0.0 ? 0.0 : std::abs(difference) / scale;
  }
  static double larger_or_nan(double a, double b) { return b <= a ? a : b; }

  // -- what is checked at each leg ----------------------------------------------------------------

  void check_rest(Path& path) {
    for (path.material = 0; path.material < kMaterials; ++path.material) {
      for (const double zero : {0.0, -0.0}) {
        Point p = new_point(dim_);
        const auto& lost = go(path, p, {zero, zero, zero}, dim_);
        bool nothing = length(traction(p.response)) == 0.0 && p.response.stored == 0.0;
        const auto infos = law_.internals(dim_);
        for (std::size_t i = 0; i < infos.size(); ++i)
          nothing = nothing && (p.internals[i] == 0.0 || follows_properties(infos[i].what));
        for (const double v : lost) nothing = nothing && v == 0.0;
        note(at_rest, nothing, [&] { return step_text(path, p); });
      }
      for (std::size_t i = 0; i < law_.properties.size(); ++i) {
        if (law_.properties[i].role != Role::normal_stiffness) continue;
        Point p = new_point(dim_);
        const double k = path.materials[path.material].numbers[i];
        const double step = 1e-6 * *std::ranges::min_element(path.lengths);
        go(path, p, {-step, 0.0, 0.0}, dim_);
        note(first_stiffness, std::abs(-p.response.normal_traction / (k * step) - 1.0),
             [&] { return step_text(path, p); });
      }
    }
    path.material = 0;
  }

  void check_repeated(Path& path) {
    Point again = path.point;
    const auto& lost = go(path, again, again.jump, dim_);
    const double energy_again = energy(lost);
    note(repeated,
         larger_or_nan(apart(path, again, path.point, dim_),
                       larger_or_nan(apart(path, lost, nothing_lost()), over(energy_again, energies(path)))),
         [&] { return step_text(path, again); });
  }

  /// Checks that losses are added to the numbers that are there.
  void check_adding(Path& path, const Point& from, const std::vector<double>& lost) {
    const Material& m = path.materials[path.material];
    Point p = from;
    std::vector<double> sum(lost.size(), 1.0);
    law_.update(dim_)(m.constants.data(), path.point.jump.data(), p.internals.data(), sum.data());
    bool added = true;
    for (std::size_t i = 0; i < lost.size(); ++i)
      added = added && std::abs(sum[i] - (1.0 + lost[i])) <= 1e-12 * (1.0 + lost[i]);
    note(losses, added, [&] { return "not added: " + step_text(path, path.point); });
  }

  /// Returns a jump as the turned frame sees it.
  static Jump turn(const Path& path, const Jump& j, int dim) {
    const double sign = path.mirrored ? -1.0 : 1.0;
    if (dim == 2) return {j[0], -j[1], 0.0};
    const double a = j[1], b = sign * j[2];
    return {j[0], path.cosine * a - path.sine * b, path.sine * a + path.cosine * b};
  }
  static Jump into_space(const Path& path, const Jump& j) {
    return {j[0], j[1] * path.line[0], j[1] * path.line[1]};
  }

  /// Takes the twins of a point along, and compares their answers.
  void check_frame(Path& path, const std::vector<double>& lost) {
    const auto compare = [&](Point& twin, const Jump& jump, const Jump& expected, int dim) {
      const std::vector<double> twin_lost = go(path, twin, jump, dim);
      const Material& m = path.materials[path.material];
      const double k = std::max(m.stiffness.normal, m.stiffness.shear);
      double most = over(length(difference(traction(twin.response), expected)), k * path.jump);
      most = larger_or_nan(most, over(twin.response.stored - path.point.response.stored, energies(path)));
      most = larger_or_nan(most, apart(path, twin_lost, lost));
      note(frame, most,
           [&] { return step_text(path, twin) + "; the other frame: " + answer_text(path.point, lost); });
    };
    const Jump t = traction(path.point.response);
    compare(path.turned, turn(path, path.point.jump, dim_), turn(path, t, dim_), dim_);
    if (dim_ == 2 && std::ranges::count(options_.dimensions, 3) > 0)
      compare(path.in_space, into_space(path, path.point.jump), into_space(path, t), 3);
  }

  /// Checks small and large steps from where the point stands.
  void check_stiffness(Path& path, Random& random) {
    const Material& m = path.materials[path.material];
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Jump along = dim_ == 2 ? Jump{0.0, 1.0, 0.0} : Jump{0.0, std::cos(angle), std::sin(angle)};
    const double shortest = *std::ranges::min_element(path.lengths);
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    for (const double size : {1e-3 * shortest, random_length(path, random)}) {
      const double step = sign * size;
      const bool small = size < 0.01 * shortest;
      std::array<Jump, 2> change;
      for (int axis = 0; axis < 2; ++axis) {
        Point p = path.point;
        Jump to = p.jump;
        if (axis == 0)
          to[0] += step;
        else
          to = {to[0], to[1] + step * along[1], to[2] + step * along[2]};
        const double lost = energy(go(path, p, to, dim_));
        change[axis] = difference(traction(p.response), traction(path.point.response));
        check_secant(path, path.point, p);
        const double k = m.stiffness.normal + m.stiffness.shear;
        if (small)
          note(continuity, length(change[axis]) <= 10.0 * k * (size + 1e-12 * path.jump) || lost > 0.0,
               [&] { return step_text(path, p); });
      }
      if (small) check_spectrum(path, change, along, step);
    }
  }

  /// Checks the answers in the plane of opening and one tangential direction, over the bounds: no step may be
  /// answered along itself by more than 1. A law has corners, so a mode of the matrix from steps along the
  /// axes says nothing unless a step along the mode is answered along it. Else the matrix is taken anew
  /// beside that step.
  /// \param change  changes of the tractions in steps along the axes
  void check_spectrum(Path& path, const std::array<Jump, 2>& change, const Jump& along, double step) {
    using Pair = std::array<double, 2>;
    const Material& m = path.materials[path.material];
    const double noise = 1e-13 * path.jump / std::abs(step);
    const auto over_bounds = [&](const Jump& t, double size) {
      return Pair{t[0] / (size * m.stiffness.normal), dot(t, along) / (size * m.stiffness.shear)};
    };
    const std::array axes{over_bounds(change[0], step), over_bounds(change[1], step)};
    // without coupling both ways the steps along the axes say it all
    if (std::abs(axes[1][0]) < 1e-6 + noise || std::abs(axes[0][1]) < 1e-6 + noise) return;
    Point p;
    const auto answer = [&](const Pair& way) {
      const double opened = step * way[0], slid = step * way[1];
      p = path.point;
      const Jump& at = path.point.jump;
      go(path, p, {at[0] + opened, at[1] + slid * along[1], at[2] + slid * along[2]}, dim_);
      return over_bounds(difference(traction(p.response), traction(path.point.response)), step);
    };
    constexpr int kRounds = 8;
    constexpr double kAside = 1e-3, kArrived = 1e-7;
    for (const double sign : {1.0, -1.0}) {
      Pair x{1.0, 0.0}, y{0.0, 1.0};
      Pair of_x = axes[0], of_y = axes[1];
      for (int round = 0; round < kRounds; ++round) {
        const double a = of_x[0] * x[0] + of_x[1] * x[1], b = of_y[0] * x[0] + of_y[1] * x[1];
        const double c = of_x[0] * y[0] + of_x[1] * y[1], d = of_y[0] * y[0] + of_y[1] * y[1];
        const double split = 0.25 * (a - d) * (a - d) + b * c;
        if (split < 0.0) break;  // no such mode
        const double largest = 0.5 * (a + d) + std::sqrt(split);
        Pair mode =
            std::abs(largest - a) > std::abs(largest - d) ? Pair{b, largest - a} : Pair{largest - d, c};
        mode = {mode[0] * x[0] + mode[1] * y[0], mode[0] * x[1] + mode[1] * y[1]};
        const double size = std::copysign(std::hypot(mode[0], mode[1]), sign * mode[0]);
        if (size == 0.0) break;
        x = {mode[0] / size, mode[1] / size};
        y = {-x[1], x[0]};
        of_x = answer(x);
        const double found = of_x[0] * x[0] + of_x[1] * x[1];
        const double aside = std::abs(of_x[0] * y[0] + of_x[1] * y[1]);
        const double excess = std::max(0.0, found - 1.0 - 10.0 * (noise + aside));
        // where both modes are nearly alike, a little aside is much of the excess
        const bool goes_on = excess > 0.0 && aside > noise && round + 1 < kRounds;
        if (aside < kArrived + noise && !goes_on) {
          note(stiffness_bound, excess,
               [&] { return fmt::format("{:.9g} of both bounds together; {}", found, step_text(path, p)); });
          break;
        }
        const Pair beside = answer({x[0] + kAside * y[0], x[1] + kAside * y[1]});
        of_y = {(beside[0] - of_x[0]) / kAside, (beside[1] - of_x[1]) / kAside};
      }
    }
  }

  /// Checks the stiffness of a step along one axis.
  void check_secant(Path& path, const Point& from, const Point& to) {
    const Material& m = path.materials[path.material];
    const Jump step = difference(to.jump, from.jump);
    const bool normal = step[1] == 0.0 && step[2] == 0.0;
    if (length(step) == 0.0 || (!normal && step[0] != 0.0)) return;
    const double k = normal ? m.stiffness.normal : m.stiffness.shear;
    const double most = std::max(m.stiffness.normal, m.stiffness.shear);
    const double found =
        dot(difference(traction(to.response), traction(from.response)), step) / (dot(step, step) * k);
    const double noise = 1e-14 * most / k * path.jump / length(step);
    if (noise < 1e-3) stiffest_[normal ? 0 : 1] = std::max(stiffest_[normal ? 0 : 1], found);
    note(stiffness_bound, std::max(0.0, found - 1.0 - noise), [&] {
      return fmt::format("{:.9g} of the {} bound {:g}; {}", found, normal ? "normal" : "shear", k,
                         step_text(path, to));
    });
  }

  void check_lanes(const KitLanes& set, const std::array<Path, kLanes>& paths,
                   const std::array<Point, kLanes>& from, const std::array<std::vector<double>, kLanes>& lost,
                   bool one_set) {
    const auto infos = law_.internals(dim_);
    std::vector<Line> jump(dim_), internals(infos.size()), losses_of(law_.losses.size()),
        own(law_.constant_count);
    std::vector<double> mine(law_.constant_count);
    for (int l = 0; l < kLanes; ++l) {
      const Path& path = paths[l];
      for (int i = 0; i < dim_; ++i) jump[i].number[l] = path.point.jump[i];
      for (std::size_t i = 0; i < infos.size(); ++i) internals[i].number[l] = from[l].internals[i];
      law_.numbers_of(path.materials[path.material].constants.data(), mine.data(), 1);
      for (int i = 0; i < law_.constant_count; ++i) own[i].number[l] = mine[i];
    }
    const auto& constants = paths[0].materials[paths[0].material].constants;
    const LanesResponse r = set.update_of[dim_ - 2](constants.data(), one_set ? nullptr : own.data(),
                                                    jump.data(), internals.data(), losses_of.data());
    for (int l = 0; l < kLanes; ++l) {
      const PointResponse& one = paths[l].point.response;
      bool same = same_number(r.normal_traction.number[l], one.normal_traction) &&
                  same_number(r.stored.number[l], one.stored);
      for (int i = 0; i + 1 < dim_; ++i)
        same = same && same_number(r.shear_traction[i].number[l], one.shear_traction[i]);
      for (std::size_t i = 0; i < infos.size(); ++i)
        same = same && same_number(internals[i].number[l], paths[l].point.internals[i]);
      for (std::size_t i = 0; i < lost[l].size(); ++i)
        same =
            same && same_number(losses_of[i].number[l], lost[l][i]) && (r.changed != 0 || lost[l][i] == 0.0);
      note(lanes, same, [&] {
        return fmt::format(
            "lane {} of {}: sigma {:.17g}, tau {:.17g}, stored {:.17g}, changed {}; one number: {}", l,
            set.name, r.normal_traction.number[l], r.shear_traction[0].number[l], r.stored.number[l],
            r.changed, step_text(paths[l], paths[l].point));
      });
    }
  }

  // -- a leg in many steps -------------------------------------------------------------------------

  struct Cut {
    Point end;
    std::vector<double> lost;
  };

  /// Takes a point to a jump by way of the given shares of the leg.
  Cut cut(Path& path, const Point& from, const Jump& to, const std::vector<double>& shares) {
    Cut c{from, nothing_lost()};
    for (const double share : shares) {
      const auto& lost = go(path, c.end, between(from.jump, to, share), dim_);
      for (std::size_t i = 0; i < lost.size(); ++i) c.lost[i] += lost[i];
    }
    return c;
  }
  static std::vector<double> equal_shares(int count) {
    std::vector<double> shares;
    for (int i = 1; i <= count; ++i) shares.push_back(static_cast<double>(i) / count);
    return shares;
  }

  /// Checks a leg along which only one component of the jump acts.
  void check_on_one_axis(Path& path, const Point& from, const std::vector<double>& lost, Random& random) {
    const Point once = path.point;
    const double way = length(difference(once.jump, from.jump));
    if (way > 0.0) {
      most_updates_ = updates_ + 20000;
      double error = 0.0;
      Point p = from;
      for (const double share : equal_shares(4))
        error += quadrature_error(path, p, between(from.jump, once.jump, share), way, 0);
      note(balance_on_one_axis, over(error, energy_scale(path, way)), [&] {
        return fmt::format("work exceeds stored energy and losses by {:.9g} J/m2; {}", error,
                           step_text(path, once, from, lost));
      });
    }
    std::vector<double> shares{1.0};
    for (int i = 1 + below(random, 7); i > 0; --i) shares.push_back(random.uniform());
    std::ranges::sort(shares);
    const Cut c = cut(path, from, once.jump, shares);
    note(steps_on_one_axis, larger_or_nan(apart(path, once, c.end, dim_), apart(path, lost, c.lost)), [&] {
      return fmt::format("in steps to the shares {:.6g} of the leg: {}; at once: {}", fmt::join(shares, ", "),
                         answer_text(c.end, c.lost), step_text(path, once, from, lost));
    });
  }

  /// Returns the largest energy that a leg can take, with what round-off leaves of the energies of the path,
  /// J/m².
  static double energy_scale(const Path& path, double way) {
    return path.traction * (way + 1e-4 * path.jump);
  }

  /// Returns work less stored energy and losses on the way to a jump, by Simpson's rule on ever smaller
  /// parts.
  double quadrature_error(Path& path, Point& p, const Jump& to, double way, int depth) {
    const Point start = p;
    const Jump half = between(start.jump, to, 0.5);
    double lost = energy(go(path, p, half, dim_));
    const Jump middle = traction(p.response);
    lost += energy(go(path, p, to, dim_));
    const Jump step = difference(to, start.jump);
    const Jump a = traction(start.response), b = traction(p.response);
    const double work = (dot(a, step) + 4.0 * dot(middle, step) + dot(b, step)) / 6.0;
    const double error = work - (p.response.stored - start.response.stored + lost);
    if (std::abs(error) <= 0.005 * kBalance * energy_scale(path, way) || depth == 40 ||
        updates_ > most_updates_)
      return error;
    p = start;
    const double first = quadrature_error(path, p, half, way, depth + 1);
    return first + quadrature_error(path, p, to, way, depth + 1);
  }

  void check_on_any_leg(Path& path, const Point& from) {
    const Jump to = path.point.jump;
    const double way = length(difference(to, from.jump));
    if (way == 0.0) return;
    // a leg that is long beside the lengths of the law would need too many cuts to show the order
    if (way < 30.0 * *std::ranges::min_element(path.lengths)) add_changes(path, from, to, way);

    if (!failed_little(balance)) return;
    Point p = from;
    most_updates_ = updates_ + 20000;
    for (const double share : equal_shares(128))
      balance_of_step(path, p, between(from.jump, to, share), way, 0);
  }

  /// Adds the changes of the energies when a leg is cut finer, once it is cut so fine that little changes.
  void add_changes(Path& path, const Point& from, const Jump& to, double way) {
    const double scale = energy_scale(path, way);
    Cut coarse = cut(path, from, to, equal_shares(kFewestCuts));
    const auto change_at = [&](int cuts) {
      const Cut fine = cut(path, from, to, equal_shares(cuts));
      const double change = over(energy(coarse.lost) - energy(fine.lost), scale) +
                            over(coarse.end.response.stored - fine.end.response.stored, scale);
      coarse = fine;
      return change;
    };
    int cuts = 4 * kFewestCuts;
    double change = change_at(cuts);
    while (change > kLittleChange && cuts < kMostCuts) change = change_at(cuts *= 4);
    changes_[0] += change;
    changes_[1] += change_at(4 * cuts);
  }

  /// Checks that the work of the mean traction less stored energy and losses is at most of the order of the
  /// change of traction times the step. Where a step holds a corner or a fall of the law, its parts must show
  /// it.
  void balance_of_step(Path& path, Point& p, const Jump& to, double way, int depth) {
    const Material& m = path.materials[path.material];
    const Point start = p;
    const double lost = energy(go(path, p, to, dim_));
    const Jump step = difference(to, start.jump);
    const Jump a = traction(start.response), b = traction(p.response);
    const double work = 0.5 * (dot(a, step) + dot(b, step));
    const double error = std::abs(work - (p.response.stored - start.response.stored + lost));
    const double k = std::max(m.stiffness.normal, m.stiffness.shear);
    const double least = std::min(m.stiffness.normal, m.stiffness.shear);
    double allowed = (2.0 + k / least) * length(difference(a, b)) * length(step) +
                     1e-12 * path.traction * (way + path.jump);
    const bool last = depth == 20 || updates_ > most_updates_;
    if (last) allowed += k * dot(step, step);
    const double moved = std::abs(work) + std::abs(p.response.stored - start.response.stored) + lost;
    allowed = std::max(allowed, 1e-3 * moved);
    if (error <= allowed || last) {
      note(balance, error <= allowed && !last ? 0.0 : over(error, allowed), [&] {
        return fmt::format("work {:.9g} J/m2, off by {:.3g} with {:.3g} allowed; {}", work, error, allowed,
                           step_text(path, p, start, lost_));
      });
      return;
    }
    p = start;
    balance_of_step(path, p, between(start.jump, to, 0.5), way, depth + 1);
    balance_of_step(path, p, to, way, depth + 1);
  }

  void judge_order() {
    if (!(changes_.back() > 1e-9)) {
      order_ = std::numeric_limits<double>::quiet_NaN();
      note(steps, true, [] { return std::string(); });
      return;
    }
    order_ = std::log(changes_[0] / changes_[1]) / std::log(4.0);
    note(steps, order_ >= kOrder, [&] {
      return fmt::format(
          "order {:.3g}; when cut four times finer, and again, energies change by {:.4g} of traction times "
          "way, summed over all legs",
          order_, fmt::join(changes_, " and "));
    });
  }

  // -- paths ---------------------------------------------------------------------------------------

  static double random_length(const Path& path, Random& random) {
    const double l = path.lengths[below(random, static_cast<int>(path.lengths.size()))];
    return l * log_uniform(random, 0.02, 8.0);
  }

  static double draw_opening(const Path& path, Random& random) {
    const double u = random.uniform();
    const double now = path.point.jump[0];
    if (u < 0.06) return 0.0;
    if (u < 0.10) return -0.0;
    if (u < 0.16) return now + 1e-6 * random_length(path, random) * (random.uniform() - 0.5);
    if (u < 0.22) return path.before_last[0];
    if (u < 0.36) return now + random_length(path, random) * (random.uniform() - 0.5);
    if (u < 0.60) return path.deepest * log_uniform(random, 1e-4, 1.0);
    return random_length(path, random);
  }

  /// Draws a tangential jump along the path's line, or anywhere in the plane.
  static std::array<double, 2> draw_slip(const Path& path, int dim, Random& random) {
    const double u = random.uniform();
    const Jump& now = path.point.jump;
    if (u < 0.05) return {0.0, 0.0};
    if (u < 0.08) return {-0.0, -0.0};
    if (u < 0.14) return {path.before_last[1], path.before_last[2]};
    double size = random_length(path, random);
    if (u < 0.25) size *= 1e-6;
    if (u < 0.40) size = -path.deepest * log_uniform(random, 1e-3, 1.0);
    if (random.uniform() < 0.5) size = -size;
    const bool from_here = random.uniform() < 0.4;
    if (dim == 2) return {size + (from_here ? now[1] : 0.0), 0.0};
    std::array<double, 2> direction = path.line;
    double along = from_here ? now[1] * path.line[0] + now[2] * path.line[1] : 0.0;
    if (path.kind == Kind::any) {
      const double angle = random.uniform() < 0.2 ? 0.5 * std::numbers::pi * below(random, 4)
                                                  : random.uniform(0.0, 2.0 * std::numbers::pi);
      direction = {std::cos(angle), std::sin(angle)};
      if (from_here) return {now[1] + size * direction[0], now[2] + size * direction[1]};
    }
    return {(along + size) * direction[0], (along + size) * direction[1]};
  }

  Jump draw_target(const Path& path, int leg, Random& random) const {
    Jump to = path.point.jump;
    const double u = random.uniform();
    const bool opens = path.kind == Kind::normal || (path.kind == Kind::shear && leg == 0) ||
                       (path.kind == Kind::any && u < 0.7);
    const bool slides = (path.kind == Kind::shear && leg > 0) || (path.kind == Kind::any && u > 0.3);
    if (opens) to[0] = draw_opening(path, random);
    if (slides) {
      const auto slip = draw_slip(path, dim_, random);
      to[1] = slip[0];
      if (dim_ == 3) to[2] = slip[1];
    }
    return to;
  }

  /// Takes eight paths side by side through all legs.
  void travel(int first) {
    first_ = first;
    Random random(options_.seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(first) * 4U +
                  static_cast<std::uint64_t>(dim_));
    const bool one_set = random.uniform() < 0.3;
    const auto choices = draw_choices(random);
    std::array<Path, kLanes> paths;
    for (int l = 0; l < kLanes; ++l) {
      Path& path = paths[l];
      lane_ = l;
      const double u = random.uniform();
      path.kind = u < 0.15 ? Kind::normal : u < 0.4 ? Kind::shear : Kind::any;
      if (one_set && l > 0) {
        path.materials = paths[0].materials;
      } else {
        path.materials.push_back(material(choices, [&] { return draw_numbers(random); }));
        while (path.materials.size() < kMaterials)
          path.materials.push_back(
              material(choices, [&] { return warmed(path.materials[0].numbers, random); }));
      }
      path.point = path.turned = new_point(dim_);
      path.in_space = new_point(3);
      double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      path.cosine = std::cos(angle);
      path.sine = std::sin(angle);
      path.mirrored = random.uniform() < 0.5;
      angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      path.line = {std::cos(angle), std::sin(angle)};
      path.lengths = lengths_of(path.materials[0]);
      const double strength = greatest_strength(path.materials[0]);
      path.deepest = opening_at(path.materials[0], 20.0 * strength);
      leg_ = -1;
      check_rest(path);
    }
    for (leg_ = 0; leg_ < kLegs; ++leg_) {
      const bool all_warm = random.uniform() < 0.2;
      const int to_material = below(random, kMaterials);
      std::array<Point, kLanes> from;
      std::array<std::vector<double>, kLanes> lost;
      std::array<bool, kLanes> moved{};
      for (int l = 0; l < kLanes; ++l) {
        Path& path = paths[l];
        lane_ = l;
        from[l] = path.point;
        Jump to = path.point.jump;
        // other properties come with the jump frozen
        const bool warms = one_set ? all_warm : random.uniform() < 0.2;
        if (warms)
          path.material = one_set ? to_material : below(random, kMaterials);
        else
          to = draw_target(path, leg_, random);
        moved[l] = !warms;
        path.before_last = path.point.jump;
        lost[l] = go(path, path.point, to, dim_);
        if (!warms) check_secant(path, from[l], path.point);
      }
      for (const KitLanes& set : options_.lanes) check_lanes(set, paths, from, lost, one_set);
      for (int l = 0; l < kLanes; ++l) {
        Path& path = paths[l];
        lane_ = l;
        check_adding(path, from[l], lost[l]);
        check_repeated(path);
        check_frame(path, lost[l]);
        if (random.uniform() < 0.5) check_stiffness(path, random);
        if (!moved[l]) continue;
        const bool exact = path.kind == Kind::normal || (path.kind == Kind::shear && law_.exact_in_shear);
        if (exact && random.uniform() < 0.3 && failed_little(balance_on_one_axis))
          check_on_one_axis(path, from[l], lost[l], random);
        if (!exact && random.uniform() < 0.04) check_on_any_leg(path, from[l]);
      }
    }
  }

  // -- reports -------------------------------------------------------------------------------------

  /// Tells whether few checks of a property have failed. Legs that do not balance are cut ever finer; a few
  /// of them say it all.
  bool failed_little(Property property) const { return findings_[property].failures < 20; }

  template <class Text>
  void note(Property property, double error, Text text) {
    KitFinding& f = findings_[property];
    ++f.checks;
    if (!(error <= f.worst)) f.worst = error;
    if (error <= f.allowed) return;
    if (++f.failures == 1) f.first = text();
  }
  template <class Text>
  void note(Property property, bool right, Text text) {
    note(property, right ? 0.0 : 1.0, text);
  }

  const std::vector<double>& nothing_lost() {
    nothing_.assign(law_.losses.size(), 0.0);
    return nothing_;
  }

  std::string properties_text(const Material& m) const {
    std::string text;
    const auto add = [&](const std::string& word) { text += (text.empty() ? "" : ", ") + word; };
    for (std::size_t i = 0; i < m.numbers.size(); ++i)
      add(fmt::format("{} = {:.17g}", law_.properties[i].key, m.numbers[i]));
    for (std::size_t i = 0; i < m.choices.size(); ++i)
      add(fmt::format("{} = {}", law_.choices[i].key, law_.choices[i].options[m.choices[i]].name));
    return text;
  }
  static std::string point_text(const Point& p) {
    return fmt::format("jump ({:.17g}) m, internals ({:.17g})", fmt::join(p.jump, ", "),
                       fmt::join(p.internals, ", "));
  }
  static std::string answer_text(const Point& p, const std::vector<double>& lost) {
    return fmt::format("sigma {:.9g}, tau ({:.9g}) Pa, stored {:.9g} J/m2, internals ({:.9g}), lost ({:.9g})",
                       p.response.normal_traction, fmt::join(p.response.shear_traction, ", "),
                       p.response.stored, fmt::join(p.internals, ", "), fmt::join(lost, ", "));
  }
  /// Describes the last update.
  std::string step_text(const Path& path, const Point& to) const {
    return step_text(path, to, before_, lost_);
  }
  std::string step_text(const Path& path, const Point& to, const Point& from,
                        const std::vector<double>& lost) const {
    return fmt::format("{}D, seed {}, path {}, leg {}: with {}: from {} to {}: {}", dim_, options_.seed,
                       first_ + lane_, leg_ + 1, properties_text(path.materials[path.material]),
                       point_text(from), fmt::format("jump ({:.17g})", fmt::join(to.jump, ", ")),
                       answer_text(to, lost));
  }

  const LawTable& law_;
  const KitOptions& options_;
  std::vector<KitFinding> findings_;
  int dim_ = 2, first_ = 0, lane_ = 0, leg_ = 0;
  Point before_;              ///< point before the last update
  std::vector<double> lost_;  ///< losses in the last update
  std::vector<double> nothing_;
  std::int64_t updates_ = 0, most_updates_ = 0;
  std::array<double, 2> stiffest_{};  ///< greatest stiffness found, over the bound: normal, shear
  std::array<double, 2> changes_{};   ///< changes of energies between cuts, summed over legs
  double order_ = 0.0;
};

}  // namespace

bool KitReport::passed() const {
  return std::ranges::all_of(findings, &KitFinding::passed);
}

std::string KitReport::text() const {
  std::string text =
      fmt::format("{}: {} paths {}in {}D, seed {}: {}\n", law->name, options.paths,
                  options.dimensions.size() > 1 ? "each " : "", fmt::join(options.dimensions, "D and "),
                  options.seed, passed() ? "passed" : "FAILED");
  for (const KitFinding& f : findings) {
    text += fmt::format("  {:<18} {:>10} checks, {:>8} failed", f.property, f.checks, f.failures);
    if (f.allowed > 0.0) text += fmt::format(", worst {:8.2g} of {:g} allowed", f.worst, f.allowed);
    if (std::string_view(f.property) == kProperties[steps].property)
      text += std::isnan(order) ? ", exact" : fmt::format(", order {:.2f}", order);
    text += "\n";
  }
  for (const KitFinding& f : findings)
    if (!f.passed())
      text += fmt::format("{}: {}: {}\n    first: {}\n", law->name, f.property, f.meaning, f.first);
  return text;
}

KitReport verify(const LawTable& law, const KitOptions& options) {
  KitOptions tried = options;
  std::erase_if(tried.dimensions, [&](int dim) { return !law.update(dim); });
  if (tried.dimensions.empty())
    throw Error(fmt::format("the contact law \"{}\" is made for none of the dimensions that are to be tried",
                            law.name));
  return Kit(law, tried).run();
}

}  // namespace pyroclast
