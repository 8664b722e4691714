#include "pyroclast/results/run_folder.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "pyroclast/results/frame_series.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

namespace {

namespace fs = std::filesystem;

/// That is gone with this.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("fuzz-" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

bool run_folder(std::string_view text) {
  return takes([&] {
    const Folder folder;
    std::ofstream(folder.path / "manifest.json", std::ios::binary) << text;
    std::ofstream(folder.path / FrameSeries::file_name(MeshPart::blocks, 0), std::ios::binary) << text;
    require(FrameSeries(folder.path, MeshPart::blocks, 2, {0.0}).lost().size() <= 1,
            "one frame is lost or is not");
    RunFolder::require(folder.path);
    RunFolder::check(folder.path, /*overwrite=*/true);
    const auto known = RunFolder::departures(folder.path);
    RunFolder::note_departure(folder.path, {"a reason of its own"});
    require(RunFolder::departures(folder.path).size() >= known.size(), "what was known stays");
    Inputs inputs;
    inputs.deck_text = "title = \"another\"\n";
    RunFolder::replace_inputs(folder.path, inputs);
    RunFolder::require(folder.path);
  });
}

}  // namespace pyroclast::fuzz
