#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pyroclast::app {

/// Options of `concrete`.
struct ConcreteOptions {
  // quantities as typed; empty where they are not stated
  std::string strength, modulus, rock, fraction, stones, d_max, hot;
  std::string d_min = "4.75 mm", width, height;
  std::vector<std::string> passing;  ///< points of a grading, "8 mm=45 %", or a file
  std::string fire, minutes, faces = "left,right", level = "0.3";
  std::vector<std::string> columns;  ///< columns of a furnace record: time, temperature
  std::int64_t blocks = 0;           ///< 0: by the largest aggregate
  bool cylinder = false;             ///< true for a body in space
  std::filesystem::path from;        ///< deck whose mortar and contacts are taken; empty: they are guessed
  std::filesystem::path out;
  bool overwrite = false;
  std::vector<std::string> typed;  ///< words of the command as typed
};

/// Returns a text as a value of TOML. Its basic strings escape as JSON's do.
std::string in_toml(const std::string& text);

/// Fire on sides of a specimen, as it is asked for.
struct AskedFire {
  std::string gas;                 ///< value of `gas_temperature` in the deck
  std::string name;                ///< what the fire is called in titles
  double hottest_gas = 0.0;        ///< °C; 0: not known
  double convection = 0.0;         ///< coefficient of heat transfer on these sides, W/(m² K)
  double minutes = 0.0;            ///< duration
  double level = 0.0;              ///< load over the strength
  std::vector<std::string> faces;  ///< sides in the fire
};

/// Reads the options of a fire. Throws Error where they do not go together.
/// \param folder  folder of the deck, from which the deck names a furnace record
AskedFire asked_fire(const ConcreteOptions& options, const std::filesystem::path& folder);

/// Replaces the parts of a deck that is heated evenly by those of a fire, see add_hot_parts.
/// \param strength  strength of the concrete, as a quantity
void add_fire_parts(std::map<std::string, std::string>& values, const AskedFire& fire,
                    const std::string& strength);

/// Returns a deck without its stages that compress to failure.
std::string without_compression(std::string deck);

}  // namespace pyroclast::app
