#pragma once

#include <cstdint>
#include <string>

#include "pyroclast/base/unit.hpp"

namespace pyroclast {

/// Role of a column: what its numbers tell a reader that does not know its name.
enum class ColumnRole : std::uint8_t {
  clock,                 ///< stage, steps, times
  temperature,           ///< temperature of the specimen
  press,                 ///< stress or strain of the specimen between platens
  rest,                  ///< measure of how near the body is to rest, and to small jumps
  exchange,              ///< exchange of temperatures with the mechanics
  control,               ///< control of an opening
  energy_put_in,         ///< energy, J; the error is the energy put in less the energies held and lost
  energy_held,           ///< likewise
  energy_lost,           ///< likewise
  energy_error,          ///< likewise
  crack_damaged,         ///< number of contact points damaged by a mode at an interface
  crack_broken,          ///< number of the broken ones of these points
  crack_damaged_extent,  ///< length, in space area, that the damaged points stand for
  crack_broken_extent,   ///< length, in space area, that the broken points stand for
  crack_opening,         ///< opening of cracks
  heat_put_in,           ///< heat, J; the error is the heat put in less the heat held
  heat_held,             ///< likewise
  heat_lost,             ///< likewise
  heat_error,            ///< likewise
  heat_flow,             ///< measure of how heat flows
  water,                 ///< water in the pores: amounts, and extremes of its pressure
  spalling,              ///< pieces that have left the body
  bar,                   ///< temperature at the depth of a bar
  bar_unspalled,         ///< the same, had no piece left
  probe,                 ///< temperature at a probe
  probe_pressure,        ///< pore pressure at a probe
  record,                ///< record of the deck
  own                    ///< column of a stage from outside the program
};

/// Returns the name of a role in files, "energy.put_in".
const char* name_of(ColumnRole role);

/// Column of the history: its name, and what its numbers are. Words in capitals in the name of a column that
/// a history may have, such as NAME and INTERFACE, stand for names of the deck.
struct Column {
  std::string name;  ///< name, with the unit as its end where it has one: "stress_MPa"
  std::string unit;  ///< unit; "1" for a number
  std::string meaning = {};
  ColumnRole role = ColumnRole::own;
  std::string of = {};         ///< word for the quantity within its role: "stress", a probe's name
  std::string label = {};      ///< few words for legends; of energies and heats
  std::string mode = {};       ///< of cracks: "tension", "shear" or "mixed"
  std::string interface = {};  ///< of cracks: interface of the blocks

  bool operator==(const Column&) const = default;
};

/// Returns the column of a law's quantity, in SI, with the unit behind its name, where it has one.
Column column_with_unit(const std::string& name, const Unit& unit);

}  // namespace pyroclast
