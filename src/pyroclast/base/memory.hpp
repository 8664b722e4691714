#pragma once

namespace pyroclast {

/// Returns the memory that this process may still take, bytes: the free memory of the machine, or the process
/// limit if smaller.
double available_memory();

/// Gives freed memory back to the system. Without it much stays with the process until it is used again.
void give_back_memory();

}  // namespace pyroclast
