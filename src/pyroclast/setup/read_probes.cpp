#include "pyroclast/setup/read_probes.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace pyroclast {

namespace {

/// A name is part of a column's name in history.csv.
bool is_name(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

std::vector<ProbePosition> read_probes(const Section& root, double width, double height) {
  std::vector<ProbePosition> probes;
  // What stands in for an error in the width refuses no probe.
  const bool known = root.section("specimen").ok();
  const auto within = [&](double length) { return known ? Range::between(0.0, length) : Range::any(); };
  for (const Section& s :
       root.optional_sections("probes", "places whose temperature is recorded, any number")) {
    ProbePosition probe;
    probe.name = s.text("name", "letters, digits and _; the column in history.csv is probe_<name>_degC");
    if (!is_name(probe.name)) s.error("name", "may hold letters, digits and _ only");
    if (std::any_of(probes.begin(), probes.end(), [&](const auto& p) { return p.name == probe.name; }))
      s.error("name", "is the name of another probe already");
    probe.position = {
        {s.quantity("x", unit::length, within(width), "from the lower left corner of the specimen"),
         s.quantity("y", unit::length, within(height), "from the lower left corner of the specimen")}};
    probes.push_back(std::move(probe));
  }
  return probes;
}

}  // namespace pyroclast
