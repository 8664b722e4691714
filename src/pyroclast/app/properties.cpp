#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "pyroclast/app/open.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast::app {

namespace {

/// Temperatures that are drawn at least, as far as a curve has them: those of the paper's Figs. 10 and 11,
/// °C.
constexpr Interval kDrawn{20.0, 800.0};

/// Greatest distance of two rows, K: small enough to show the jump of the standards' specific heat at 100 °C.
constexpr double kTemperatureStep = 1.0;

/// Returns the phases as a run has them: those of the specimen, where they follow its composition.
std::vector<BlockMaterial> block_materials_of(const Setup& setup) {
  if (!setup.moving || !follows_composition(setup.block_materials, *setup.moving))
    return setup.block_materials;
  return make_materials(setup.block_materials, *setup.moving,
                        numbers_of(make_checked_specimen(setup.specimen)))
      .block_materials;
}

/// \param moves  true where the mechanical properties were read too
void add_material(const BlockMaterial& material, bool moves, std::vector<ReadCurve>& list) {
  const auto add = [&](const char* key, const Unit& unit, const Curve& curve) {
    list.push_back({fmt::format("materials.{}.{}", material.name, key), unit.si, curve});
  };
  if (moves) add("E", unit::stress, material.young);
  add("density", unit::density, material.density);
  if (moves) add("thermal_strain", unit::dimensionless, material.thermal_strain);
  if (moves && material.creep) add("creep.strain", unit::dimensionless, material.creep->strain);
  if (material.conductivity) add("conductivity", unit::conductivity, *material.conductivity);
  if (!material.specific_heat) return;
  add("specific_heat", unit::specific_heat, *material.specific_heat);
  list.push_back({fmt::format("materials.{}.heat_capacity", material.name), "J/m3/K",
                  material.density * *material.specific_heat});
}

void add_contact(const ContactMaterial& contact, const std::string& name, std::vector<ReadCurve>& list) {
  for (std::size_t i = 0; i < contact.numbers.size(); ++i) {
    const PropertyInfo& info = contact.law->properties[i];
    if (info.role == Role::plain) continue;
    list.push_back({fmt::format("contacts.{}.{}", name, info.key), info.unit.si, contact.numbers[i]});
  }
}

/// Returns the properties as a run has them, and whatever else the deck gives over the temperature, such as
/// an expansion coefficient.
std::vector<ReadCurve> properties_of(const Setup& setup) {
  std::vector<ReadCurve> list;
  const bool moves = setup.moving.has_value();
  for (const BlockMaterial& material : block_materials_of(setup))
    if (moves || !material.name.empty()) add_material(material, moves, list);
  if (moves) {
    const ContactParameters& contacts = setup.moving->contacts;
    const auto concrete =
        make_concrete(setup.block_materials, contacts, expected_block_size(setup.specimen, contacts));
    for (std::size_t i = 0; i + contacts.bearings.size() < concrete.contacts.size(); ++i)
      add_contact(concrete.contacts[i], concrete.interfaces[i], list);
  }
  for (const ReadCurve& read : setup.curves) {
    const bool listed =
        std::ranges::any_of(list, [&](const ReadCurve& other) { return other.path == read.path; });
    if (!listed) list.push_back(read);
  }
  return list;
}

Interval drawn_range(const ReadCurve& property, const Interval& run) {
  const Interval own = property.curve.range();
  return {std::max(own.lower, std::min(run.lower, kDrawn.lower)),
          std::min(own.upper, std::max(run.upper, kDrawn.upper))};
}

std::string rows(const ReadCurve& property, const Interval& range) {
  const Curve& curve = property.curve;
  const double reference = curve.holds(kReferenceTemperature) ? curve(kReferenceTemperature) : 0.0;
  const int steps = std::max(1, static_cast<int>(std::ceil((range.upper - range.lower) / kTemperatureStep)));
  std::string text;
  for (int i = 0; i <= steps; ++i) {
    const double T = i == steps ? range.upper : range.lower + i * (range.upper - range.lower) / steps;
    const double value = curve(T);
    const double ratio = reference != 0.0 ? value / reference : std::numeric_limits<double>::quiet_NaN();
    text += fmt::format("{},{},{:.12g},{:.12g},{:.12g}\n", property.path, property.unit, T, value, ratio);
  }
  return text;
}

/// Prints the curves that the deck gives, a line each.
void print(const std::vector<ReadCurve>& curves) {
  for (const auto& [path, unit, curve] : curves)
    fmt::print("{:<42}{} {}\n", path, curve.describe(), unit == "1" ? "" : "[" + unit + "]");
}

}  // namespace

int plot_properties(const PropertiesOptions& options) {
  const Deck deck = Deck::open(options.deck);
  const Setup setup = read_setup(deck, options.deck.parent_path());
  require_code(setup);
  std::string csv = "property,unit,temperature_degC,value,ratio_to_20_degC\n";
  for (const ReadCurve& property : properties_of(setup))
    csv += rows(property, drawn_range(property, setup.temperatures));
  const std::filesystem::path out =
      options.out.empty() ? std::filesystem::path("runs") / (options.deck.stem().string() + "-properties")
                          : options.out;
  std::filesystem::create_directories(out);
  write_text_file(out / "properties.csv", csv);
  print(setup.curves);
  fmt::print("{}\n", (out / "properties.csv").string());
  draw_figures("properties", out);
  return 0;
}

}  // namespace pyroclast::app
