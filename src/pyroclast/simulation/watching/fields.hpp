#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/watching/items.hpp"

namespace pyroclast {

/// Kind of a field's values.
enum class ValueKind : std::uint8_t {
  number,
  vector,  ///< x, y; in 3D x, y, z
  tensor   ///< symmetric: XX, YY, ZZ, XY, YZ, XZ, the order of VTK; shears are those of tensors
};
/// Returns the count of numbers in a value.
/// \param dimension  dimension of the body, 2 or 3
int components_of(ValueKind kind, int dimension);

/// Field of the body: its name, unit and meaning.
struct FieldInfo {
  std::string name;  ///< name without unit
  Unit unit;
  Item item;
  ValueKind kind;
  std::string meaning;
  bool in_files = true;  ///< true for a field in the frames of a run; else it is for scripts alone
};

/// Returns a unit as a product, "W m-2 K-1": a slash would split the name of an array in files.
std::string product_of(const Unit& unit);
/// Returns the name with the unit, "stress_Pa", as in the history.
std::string name_with_unit(const FieldInfo& field);

/// Simulation while its fields are read, item by item. A value that several fields need of an item is
/// computed once.
class FieldReader {
 public:
  explicit FieldReader(const Simulation& simulation) : simulation_(simulation) {}

  const Simulation& simulation() const { return simulation_; }
  const Model& model() const { return simulation_.model(); }
  const Motion& motion() const { return simulation_.motion(); }
  /// Tells whether an item belongs to a block that has left the body, or joins one.
  bool is_gone(Item item, int number) const;
  const ContactState& contact(int contact);
  /// Returns the conductance of each contact to heat, W/(m2 K).
  const std::vector<double>& heat_conductances();

 private:
  const Simulation& simulation_;
  int contact_ = -1;
  ContactState state_;
  std::vector<double> heat_conductances_;
};

struct Field : FieldInfo {
  /// Function that writes the components of one item.
  std::function<void(FieldReader&, int item, double* to)> read;
};

/// Returns all fields that a simulation has, in the order of the files: a collective. Files, Python and docs
/// follow this list.
std::vector<Field> fields_of(const Simulation& simulation);
/// Returns all fields that simulations of the laws in this program may have.
std::vector<FieldInfo> possible_fields();

/// Returns the numbers that all components of fields take.
int width_of(const std::vector<Field>& fields, const Simulation& simulation);
/// Hands out the values of fields of one item slice by slice, on each rank those of its own items, see
/// in_own_slices. A row has the components of one field after the other.
void own_values_in_slices(
    const std::vector<Field>& fields, const Simulation& simulation,
    const std::function<void(std::int64_t first, const std::vector<float>& rows)>& take);
/// Returns the values of fields of one item, of each field item by item and component by component: a
/// collective. Where several ranks hold the body the first gets the values of the whole, others get none.
std::vector<std::vector<double>> values_of(const std::vector<Field>& fields, const Simulation& simulation);

}  // namespace pyroclast
