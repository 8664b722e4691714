#pragma once

namespace pyroclast {

/// Returns the memory that this process may still take, bytes: the free memory of the machine, or the process
/// limit if smaller.
double available_memory();

}  // namespace pyroclast
