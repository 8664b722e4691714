#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/base/unit.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast {

/// What a field has a value of each of.
enum class Item : std::uint8_t {
  gridpoint,
  zone,
  contact,     ///< a contact point
  contact_end  ///< ends of the line by which files show a contact point: there, and towards the face's middle
};

/// "gridpoint".
const char* name_of(Item item);
/// Throws Error for another name.
Item item_of(std::string_view name);
int count_of(Item item, const Model<2>& model);

/// What a value of a field is.
enum class ValueKind : std::uint8_t {
  number,
  vector,  ///< x, y
  tensor   ///< symmetric: XX, YY, ZZ, XY, YZ, XZ, the order of VTK; shears are those of tensors
};
/// Numbers of a value.
int components_of(ValueKind kind);

/// A field of the body: what it is called and means.
struct FieldInfo {
  std::string name;  ///< without unit
  Unit unit;
  Item item;
  ValueKind kind;
  std::string meaning;
  bool in_files = true;  ///< frames of a run hold it; else it is for scripts alone
};

/// A unit as a product, "W m-2 K-1": a slash would part the name of an array in files.
std::string product_of(const Unit& unit);
/// "stress_Pa", as in the history.
std::string name_with_unit(const FieldInfo& field);

/// A simulation while its fields are read, item by item. What several fields need of an item is worked out
/// once.
class FieldReader {
 public:
  explicit FieldReader(const Simulation& simulation) : simulation_(simulation) {}

  const Simulation& simulation() const { return simulation_; }
  const Model<2>& model() const { return simulation_.model(); }
  const Mechanics<2>& mechanics() const { return simulation_.mechanics(); }
  const ContactState<2>& contact(int contact);
  const SymmetricTensor<2>& stress(int zone);
  /// Conductance of each contact to heat, W/(m2 K).
  const std::vector<double>& heat_conductances();

 private:
  const Simulation& simulation_;
  int contact_ = -1, zone_ = -1;
  ContactState<2> state_;
  SymmetricTensor<2> stress_{};
  std::vector<double> heat_conductances_;
};

struct Field : FieldInfo {
  /// Writes the components of one item.
  std::function<void(FieldReader&, int item, double* to)> read;
};

/// All fields that a simulation has, in the order of the files. Files, Python and docs follow this list.
std::vector<Field> fields_of(const Simulation& simulation);
/// All fields that simulations of the laws in this program may have.
std::vector<FieldInfo> possible_fields();

/// Values of fields of one item, of each field item by item and component by component.
/// \tparam T  float, as in files, or double
template <class T>
std::vector<std::vector<T>> values_of(const std::vector<Field>& fields, const Simulation& simulation);

}  // namespace pyroclast
