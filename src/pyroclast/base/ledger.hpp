#pragma once

#include <cstdint>

namespace pyroclast {

/// Side of the ledger on which an entry stands: the amount put in equals the amount held, the amount lost and
/// the error of the ledger.
enum class LedgerSide : std::uint8_t { put_in, held, lost, error };

/// One entry of a ledger of energy or heat, J. The list of entries determines the columns of the history, the
/// values in the summary and the sums of the ledger.
template <class Ledger>
struct LedgerEntry {
  const char* name;    ///< name in summary.json
  const char* column;  ///< column of the history
  LedgerSide side;
  const char* label;  ///< few words for legends
  const char* meaning;
  double (*value)(const Ledger&);
  /// Tells whether the entry stands in a ledger: some are of some bodies alone.
  bool (*is_there)(const Ledger&) = [](const Ledger&) { return true; };
};

/// Returns the column of the ledger's error.
template <class Entries>
constexpr const char* error_column(const Entries& entries) {
  const char* column = nullptr;
  for (const auto& entry : entries)
    if (entry.side == LedgerSide::error) column = entry.column;
  return column;
}

}  // namespace pyroclast
