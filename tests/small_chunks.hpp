#pragma once

#include <cstdlib>
#include <string>

namespace pyroclast {

/// Gives bodies that are made while it lives chunks of another number of blocks, for tests.
class SmallChunks {
 public:
  explicit SmallChunks(int blocks) { setenv(kVariable, std::to_string(blocks).c_str(), 1); }
  ~SmallChunks() { unsetenv(kVariable); }
  SmallChunks(const SmallChunks&) = delete;
  SmallChunks& operator=(const SmallChunks&) = delete;

 private:
  static constexpr const char* kVariable = "PYROCLAST_CHUNK_BLOCKS";
};

}  // namespace pyroclast
