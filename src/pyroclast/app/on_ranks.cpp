#include "pyroclast/app/on_ranks.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <new>
#include <thread>

#include <dlfcn.h>
#include <fmt/format.h>
#include <malloc.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/launcher.hpp"
#include "pyroclast/base/own_program.hpp"
#include "pyroclast/base/processors.hpp"
#include "pyroclast/parallel/processes.hpp"
#include "pyroclast/plugin/code_permission.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast::app {

namespace {

/// Time that the first copy has to tell an error that all have, and to end them.
constexpr std::chrono::seconds kFirstSpeaks{2};

/// Lets the system have large arrays back once they are freed. By default the C library soon keeps them, and
/// a rank, which holds much at the start that it frees then, takes a tenth more memory.
void give_back_large_arrays() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

const MpiObject& mpi_object() {
  const auto file = own_prefix() / "lib" / "pyroclast" / "pyroclast_mpi.so";
  if (!std::filesystem::exists(file))
    throw Error(
        "--mpi: this program was built without MPI: configure it with -DPYROCLAST_MPI=ON, which needs Open "
        "MPI or MPICH");
  // what MPI loads later looks for its symbols among all
  void* const object = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (object == nullptr) throw Error(fmt::format("--mpi: {} cannot be loaded: {}", file.string(), dlerror()));
  auto* const function = reinterpret_cast<const MpiObject* (*)()>(dlsym(object, kMpiSymbol));
  const auto own = fmt::format("{} {}", kVersion, kCommit);
  if (function == nullptr || function()->version != own)
    throw Error(fmt::format("--mpi: {} belongs to another build than this program, {}: build both again",
                            file.string(), own));
  return *function();
}

}  // namespace

int tell_failure() {
  const LaunchedCopies copies = launched_copies();
  if (copies.number > 0) std::this_thread::sleep_for(kFirstSpeaks);
  const auto tell = [&](const char* what) {
    say_aside(copies.number > 0 ? fmt::format("error: rank {}: {}\n", copies.number, what)
                                : fmt::format("error: {}\n", what));
  };
  try {
    throw;
  } catch (const CodeNotAllowed& error) {
    tell(error.what());
    return kCodeNotAllowed;
  } catch (const std::bad_alloc&) {
    tell("out of memory");
  } catch (const std::exception& error) {
    tell(error.what());
  }
  return 1;
}

int on_ranks(const std::function<int(const RanksOfRun&)>& act) {
  give_back_large_arrays();
  const std::shared_ptr<Processes> ranks = mpi_object().join();
  try {
    const int code = act({ranks, std::max(1, free_processors() / ranks->sharing_processors())});
    ranks->wait_for_all();
    return code;
  } catch (...) {
    const int code = tell_failure();
    if (ranks->count() > 1) ranks->end_all(code);
    return code;
  }
}

void require_one_copy(const std::string& remedy) {
  const LaunchedCopies copies = launched_copies();
  if (copies.count > 1)
    throw Error(fmt::format(
        "{} copies of this command were started together ({}={}), and would write into one folder: {}; for "
        "runs of their own, unset that variable for each",
        copies.count, copies.variable, copies.count, remedy));
}

}  // namespace pyroclast::app
