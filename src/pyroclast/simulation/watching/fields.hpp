#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// Kind of items of which a field has one value each.
enum class Item : std::uint8_t {
  gridpoint,
  zone,
  contact,  ///< contact point
  /// Corners of the cell by which files show a contact point, see ends_of_contact.
  contact_end
};

/// Returns the number of corners of the cell by which files show a contact point. In the plane it is a line
/// from the point to the middle of its edge. In space it is a quadrangle: the point, the middle of the edge
/// to the next corner of its face, the middle of the face, the middle of the edge before. \param dimension
/// dimension of the body, 2 or 3
constexpr int ends_of_contact(int dimension) {
  return dimension == 2 ? 2 : 4;
}

/// Returns a vector at an end of a contact's cell, from its values at the contact points of a face.
template <class Value>
Vec<3> at_end(const Model& model, int contact, int end, Value value) {
  if (end == 0) return value(contact);
  const auto after = std::ranges::upper_bound(model.face_contacts, contact);
  const int first = *(after - 1), count = *after - first;
  const auto next_to = [&](int step) { return first + (contact - first + step + count) % count; };
  if (end != 2) return 0.5 * (value(contact) + value(next_to(end == 1 ? 1 : -1)));
  Vec<3> sum{};
  for (int i = 0; i < count; ++i) sum += value(first + i);
  return sum * (1.0 / count);
}

/// Returns the name of an item, such as "gridpoint".
const char* name_of(Item item);
/// Returns the item of a name. Throws Error for another name.
Item item_of(std::string_view name);
int count_of(Item item, const Model& model);

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

/// Returns the values of fields of one item, of each field item by item and component by component: a
/// collective. Where several ranks hold the body the first gets the values of the whole, others get none.
/// \tparam T  float, as in files, or double
template <class T>
std::vector<std::vector<T>> values_of(const std::vector<Field>& fields, const Simulation& simulation);

}  // namespace pyroclast
