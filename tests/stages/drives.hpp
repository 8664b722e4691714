#pragma once

#include <string>

#include "stages/small_runs.hpp"

namespace pyroclast {

inline constexpr double kWidth = 0.06, kHeight = 0.12;  // m, thickness 1 m

/// The small prism without platens, and without weight.
inline std::string free_deck(const std::string& rest) {
  std::string text = deck(rest);
  for (const char* gone : {"[platens]\nthickness = \"10 mm\"\n", "platen_friction = 0.0\n",
                           "[materials.platen]\nE = \"200 GPa\"\nnu = 0.3\ndensity = \"7850 kg/m3\"\n",
                           "[output]\nhistory_strain = 1e-5\nframe_strain = 1e-3\n"})
    text = with(text, gone, "");
  return with(text, "mass = \"scaled\"\n", "mass = \"scaled\"\ngravity = \"0 m/s2\"\n");
}

inline std::string drive(const std::string& keys, const std::string& drives) {
  return "[[stages]]\nkind = \"drive\"\n" + keys + "\n" + drives;
}

inline std::string does(const std::string& set, const std::string& what) {
  return "[[stages.drives]]\nset = \"" + set + "\"\n" + what + "\n";
}

inline std::string record(const std::string& name, const std::string& kind, const std::string& rest) {
  return "[[record]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\n" + rest + "\n";
}

}  // namespace pyroclast
