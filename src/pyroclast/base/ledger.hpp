#pragma once

#include <cstdint>

namespace pyroclast {

/// What an entry of a ledger is to the others: what is put in is held, lost, or the ledger's error.
enum class LedgerSide : std::uint8_t { put_in, held, lost, error };

/// One entry of a ledger of energy or heat, J. The history, the summary and the ledger's own sums follow from
/// the list of its entries.
template <class Ledger>
struct LedgerEntry {
  const char* name;    ///< in summary.json
  const char* column;  ///< of the history
  LedgerSide side;
  const char* meaning;
  double (*value)(const Ledger&);
};

/// The column of the ledger's error.
template <class Entries>
constexpr const char* error_column(const Entries& entries) {
  const char* column = nullptr;
  for (const auto& entry : entries)
    if (entry.side == LedgerSide::error) column = entry.column;
  return column;
}

}  // namespace pyroclast
