#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/mechanics/found/found_points.hpp"
#include "pyroclast/mechanics/mechanics.hpp"

/// Motion of a body in the plane or in space, for all code that need not know which: stages, press, records,
/// gauges, results, session and bindings. Places, directions and tensors have all their components; in 2D
/// those across the plane are 0, but for the strain that plane stress leaves there. Calls come between
/// steps, never within one.
namespace pyroclast {

/// Velocities, ties and forces that act on gridpoints from the next step on, see Constraints.
class MotionConstraints {
 public:
  virtual ~MotionConstraints() = default;
  virtual void prescribe_velocity(int gridpoint, int component, double velocity) = 0;
  virtual void release(int gridpoint, int component) = 0;
  virtual void tie(std::vector<int> gridpoints, int component) = 0;
  virtual void untie() = 0;
  virtual void apply_force(int gridpoint, const Vec<3>& force) = 0;
};

/// State of each gridpoint, zone and contact, see Reader.
class MotionReader {
 public:
  virtual ~MotionReader() = default;
  virtual Vec<3> displacement(int gridpoint) const = 0;
  virtual Vec<3> velocity(int gridpoint) const = 0;
  virtual Vec<3> force(int gridpoint) const = 0;
  virtual bool is_prescribed(int gridpoint, int component) const = 0;
  virtual double real_mass(int gridpoint) const = 0;
  virtual double moving_mass(int gridpoint) const = 0;

  virtual SymmetricTensor<3> stress(int zone) const = 0;
  virtual SymmetricTensor<3> elastic_strain(int zone) const = 0;
  virtual SymmetricTensor<3> creep_strain(int zone) const = 0;
  virtual ZoneProperties properties_of_zone(int zone) const = 0;

  virtual ContactState contact(int contact) const = 0;
  virtual ContactFrame<3> frame_of_forces(int contact) const = 0;
  virtual double remembered(int contact, Remembers what) const = 0;
  virtual double damage(int contact) const = 0;
  virtual double crack_step(int contact) const = 0;
  virtual double opening(int contact) const = 0;
};

/// Sums over the body or a set of its gridpoints, see Totals.
class MotionTotals {
 public:
  virtual ~MotionTotals() = default;
  virtual Vec<3> mean_displacement(const GridpointSet& set) const = 0;
  virtual Vec<3> total_force(const GridpointSet& set) const = 0;
  virtual Vec<3> total_applied_force(const GridpointSet& set) const = 0;
  virtual Vec<3> total_weight(const GridpointSet& set) const = 0;
  virtual double total_moving_mass(const GridpointSet& set) const = 0;
  virtual double mobility(const GridpointSet& set, std::span<const double> weights) const = 0;
  virtual Vec<3> net_force() const = 0;
  virtual EnergyLedger energy() const = 0;
  virtual double unbalanced_ratio() const = 0;
  virtual double mean_unbalanced_force() const = 0;
  virtual double largest_relative_jump() const = 0;
  virtual Cracks count_cracks(const std::vector<CrackKind>& kinds) const = 0;
};

/// Array of the state as it stands in memory.
struct ArrayInMemory {
  const double* numbers = nullptr;
  std::vector<std::ptrdiff_t> shape;
};

/// Motion of a body. Functions without a comment are those of Mechanics and Body.
class Motion {
 public:
  virtual ~Motion() = default;

  virtual const Model& model() const = 0;
  virtual const MechanicsParameters& parameters() const = 0;
  virtual MotionConstraints& constraints() = 0;
  virtual const MotionReader& read() const = 0;
  virtual const MotionTotals& totals() const = 0;

  virtual void begin_moving(const std::vector<Vec<3>>& velocities) = 0;
  virtual void advance(int steps) = 0;
  virtual std::int64_t steps() const = 0;
  virtual double time_step() const = 0;
  double time() const { return static_cast<double>(steps()) * time_step(); }
  virtual double mass_ratio() const = 0;
  virtual TimeStepLimit real_mass_limit() const = 0;
  virtual BodyProperties set_properties(BodyProperties properties) = 0;
  virtual void remove(const std::vector<int>& blocks) = 0;
  virtual void commit_creep(const std::function<void()>& look) = 0;
  virtual void note_cracks() = 0;
  [[nodiscard]] virtual bool break_contact(int contact) = 0;
  virtual void visit_state(StateVisitor& visitor) = 0;

  virtual bool is_gone(int block) const = 0;  ///< Tells whether a block has left the body.
  virtual bool creeps() const = 0;            ///< Tells whether zones of this body can creep.
  /// Tells whether water in the pores presses on the contacts of this body.
  virtual bool has_pore_pressure() const = 0;
  /// Returns the laws of the contacts, each once, in the order of the interfaces.
  virtual const std::vector<const LawTable*>& laws() const = 0;
  virtual const LawTable& law_of(int contact) const = 0;
  /// Returns the names of the energies that the laws, and creep, dissipate.
  virtual const std::vector<std::string_view>& dissipations() const = 0;
  virtual std::vector<CrackKind> crack_kinds() const = 0;
  virtual std::vector<FoundPoint> found_points() const = 0;  ///< See found_points.hpp.
  /// Returns an array of the state: "displacement" by slot, "velocity" and "force" by pack, "internals" by
  /// line. Throws Error for another name.
  virtual ArrayInMemory array_of(std::string_view name) const = 0;
  virtual std::span<const int> gridpoint_slots() const = 0;  ///< Returns the slot of each gridpoint.
};

/// Motion of a body of a dimension: its mechanics behind the words of Motion.
template <int Dim>
class MotionOf final : public Motion {
 public:
  /// For the parameters see Mechanics.
  MotionOf(const ModelOf<Dim>& model, const std::vector<double>& densities, BodyProperties properties,
           const MechanicsParameters& parameters, std::shared_ptr<Team> team);

  Mechanics<Dim>& mechanics() { return mechanics_; }
  const Mechanics<Dim>& mechanics() const { return mechanics_; }

  const Model& model() const override { return mechanics_.model(); }
  const MechanicsParameters& parameters() const override { return mechanics_.body().parameters; }
  MotionConstraints& constraints() override { return constraints_; }
  const MotionReader& read() const override { return reader_; }
  const MotionTotals& totals() const override { return totals_; }
  void begin_moving(const std::vector<Vec<3>>& velocities) override {
    std::vector<Vec<Dim>> in_space;
    for (const Vec<3>& velocity : velocities) in_space.push_back(resized<Dim>(velocity));
    mechanics_.begin_moving(in_space);
  }
  void advance(int steps) override { mechanics_.advance(steps); }
  std::int64_t steps() const override { return mechanics_.steps(); }
  double time_step() const override { return mechanics_.time_step(); }
  double mass_ratio() const override { return mechanics_.mass_ratio(); }
  TimeStepLimit real_mass_limit() const override { return mechanics_.real_mass_limit(); }
  BodyProperties set_properties(BodyProperties properties) override {
    return mechanics_.set_properties(std::move(properties));
  }
  void remove(const std::vector<int>& blocks) override { mechanics_.remove(blocks); }
  void commit_creep(const std::function<void()>& look) override { mechanics_.commit_creep(look); }
  void note_cracks() override { mechanics_.note_cracks(); }
  [[nodiscard]] bool break_contact(int contact) override { return mechanics_.break_contact(contact); }
  void visit_state(StateVisitor& visitor) override { mechanics_.visit_state(visitor); }
  bool is_gone(int block) const override { return mechanics_.body().is_gone(block); }
  bool creeps() const override { return mechanics_.body().creeps(); }
  bool has_pore_pressure() const override { return mechanics_.body().has_pore_pressure(); }
  const std::vector<const LawTable*>& laws() const override { return mechanics_.body().laws; }
  const LawTable& law_of(int contact) const override { return mechanics_.body().law_of(contact); }
  const std::vector<std::string_view>& dissipations() const override {
    return mechanics_.body().dissipations;
  }
  std::vector<CrackKind> crack_kinds() const override { return pyroclast::crack_kinds(mechanics_.body()); }
  std::vector<FoundPoint> found_points() const override {
    return pyroclast::found_points(mechanics_.body());
  }
  ArrayInMemory array_of(std::string_view name) const override;
  std::span<const int> gridpoint_slots() const override {
    const auto& slots = mechanics_.body().layout.gridpoint_slot;
    return {slots.data(), slots.size()};
  }

 private:
  class ConstraintsOf final : public MotionConstraints {
   public:
    explicit ConstraintsOf(Mechanics<Dim>& of) : constraints_(of.constraints()) {}
    void prescribe_velocity(int gridpoint, int component, double velocity) override {
      constraints_.prescribe_velocity(gridpoint, component, velocity);
    }
    void release(int gridpoint, int component) override { constraints_.release(gridpoint, component); }
    void tie(std::vector<int> gridpoints, int component) override {
      constraints_.tie(std::move(gridpoints), component);
    }
    void untie() override { constraints_.untie(); }
    void apply_force(int gridpoint, const Vec<3>& force) override {
      constraints_.apply_force(gridpoint, resized<Dim>(force));
    }

   private:
    Constraints<Dim> constraints_;
  };

  class ReaderOf final : public MotionReader {
   public:
    explicit ReaderOf(const Mechanics<Dim>& of) : read_(of.read()) {}
    Vec<3> displacement(int gridpoint) const override { return resized<3>(read_.displacement(gridpoint)); }
    Vec<3> velocity(int gridpoint) const override { return resized<3>(read_.velocity(gridpoint)); }
    Vec<3> force(int gridpoint) const override { return resized<3>(read_.force(gridpoint)); }
    bool is_prescribed(int gridpoint, int component) const override {
      return read_.is_prescribed(gridpoint, component);
    }
    double real_mass(int gridpoint) const override { return read_.real_mass(gridpoint); }
    double moving_mass(int gridpoint) const override { return read_.moving_mass(gridpoint); }
    SymmetricTensor<3> stress(int zone) const override { return in_space(read_.stress(zone)); }
    SymmetricTensor<3> elastic_strain(int zone) const override { return read_.elastic_strain(zone); }
    SymmetricTensor<3> creep_strain(int zone) const override { return in_space(read_.creep_strain(zone)); }
    ZoneProperties properties_of_zone(int zone) const override { return read_.properties_of_zone(zone); }
    ContactState contact(int contact) const override { return read_.contact(contact); }
    ContactFrame<3> frame_of_forces(int contact) const override;
    double remembered(int contact, Remembers what) const override { return read_.remembered(contact, what); }
    double damage(int contact) const override { return read_.damage(contact); }
    double crack_step(int contact) const override { return read_.crack_step(contact); }
    double opening(int contact) const override { return read_.opening(contact); }

   private:
    Reader<Dim> read_;
  };

  class TotalsOf final : public MotionTotals {
   public:
    explicit TotalsOf(const Mechanics<Dim>& of) : body_(of.body()), totals_(of.totals()) {}
    Vec<3> mean_displacement(const GridpointSet& set) const override {
      return resized<3>(totals_.mean_displacement(set));
    }
    Vec<3> total_force(const GridpointSet& set) const override {
      return resized<3>(totals_.total_force(set));
    }
    Vec<3> total_applied_force(const GridpointSet& set) const override {
      return resized<3>(totals_.total_applied_force(set));
    }
    Vec<3> total_weight(const GridpointSet& set) const override {
      return resized<3>(totals_.total_weight(set));
    }
    double total_moving_mass(const GridpointSet& set) const override {
      return totals_.total_moving_mass(set);
    }
    double mobility(const GridpointSet& set, std::span<const double> weights) const override {
      return totals_.mobility(set, weights);
    }
    Vec<3> net_force() const override { return resized<3>(totals_.net_force()); }
    EnergyLedger energy() const override { return totals_.energy(); }
    double unbalanced_ratio() const override { return totals_.unbalanced_ratio(); }
    double mean_unbalanced_force() const override { return totals_.mean_unbalanced_force(); }
    double largest_relative_jump() const override { return totals_.largest_relative_jump(); }
    Cracks count_cracks(const std::vector<CrackKind>& kinds) const override {
      return pyroclast::count_cracks(body_, kinds);
    }

   private:
    const Body<Dim>& body_;
    Totals<Dim> totals_;
  };

  Mechanics<Dim> mechanics_;
  ConstraintsOf constraints_;
  ReaderOf reader_;
  TotalsOf totals_;
};

/// Makes the motion of a body of either dimension. `model` must outlive it. For the parameters see Mechanics.
std::unique_ptr<Motion> make_motion(const Model& model, const std::vector<double>& densities,
                                    BodyProperties properties, const MechanicsParameters& parameters,
                                    std::shared_ptr<Team> team);

extern template class MotionOf<2>;
extern template class MotionOf<3>;

}  // namespace pyroclast
