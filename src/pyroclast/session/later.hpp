#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace pyroclast {

/// Throws Error where a change, "key=value", would act before the end of a stage, from 0.
void require_later(const std::string& change, std::int64_t stage);

/// Copies the first frames of a run into the folder of another run that has them in common.
void copy_frames(const std::filesystem::path& from, const std::filesystem::path& to, int count);

}  // namespace pyroclast
