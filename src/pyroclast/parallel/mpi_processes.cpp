// Ranks by MPI. This file alone knows MPI; it becomes a shared object that the program loads on demand.

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <unordered_map>

#include <mpi.h>
#include <sched.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/parallel/processes.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

using Seconds = std::chrono::duration<double>;
using WaitClock = std::chrono::steady_clock;

/// Begin of the packet that each rank gives to a gather; the bytes of the rank follow where the packet has
/// room.
struct Head {
  std::uint64_t size = 0;   ///< bytes of the rank
  std::uint64_t place = 0;  ///< hash of the place from which it calls
};

class MpiProcesses final : public Processes {
 public:
  MpiProcesses() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &me_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    if (const char* const limit = std::getenv("PYROCLAST_RANKS_LIMIT")) longest_wait_ = std::atof(limit);
    count_sharing();
  }
  ~MpiProcesses() override { MPI_Finalize(); }
  MpiProcesses(const MpiProcesses&) = delete;
  MpiProcesses& operator=(const MpiProcesses&) = delete;

  int me() const override { return me_; }
  int count() const override { return count_; }
  int sharing_processors() const override { return sharing_; }

  void begin_exchange(std::vector<Message>& messages, CallPlace at) override {
    of_exchange_.clear();
    const int tag = static_cast<int>(at.hash() % kTags);
    for (Message& message : messages)
      MPI_Irecv(message.received.data(), length(message.received.size()), MPI_DOUBLE, message.rank, tag,
                MPI_COMM_WORLD, &of_exchange_.emplace_back());
    for (const Message& message : messages)
      MPI_Isend(message.sent.data(), length(message.sent.size()), MPI_DOUBLE, message.rank, tag,
                MPI_COMM_WORLD, &of_exchange_.emplace_back());
  }
  void go_on() override {
    int done = 0;
    MPI_Testall(static_cast<int>(of_exchange_.size()), of_exchange_.data(), &done, MPI_STATUSES_IGNORE);
  }
  void end_exchange(std::vector<Message>& /*messages*/, CallPlace at) override { wait(of_exchange_, at); }

  void wait_for_all() override {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && done == 0;)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  [[noreturn]] void end_all(int exit_code) override {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

 protected:
  std::vector<std::byte> gather(std::span<const std::byte> own, Receivers receivers, CallPlace at) override {
    const Head head{.size = own.size(), .place = at.hash()};
    std::size_t& room = rooms_.try_emplace(head.place, kLeastRoom).first->second;
    const std::size_t of_packet = sizeof(Head) + room;
    std::vector<std::byte> packet(of_packet), packets(of_packet * static_cast<std::size_t>(count_));
    std::memcpy(packet.data(), &head, sizeof(Head));
    std::copy_n(own.begin(), std::min(own.size(), room), packet.begin() + sizeof(Head));
    requests_.assign(1, MPI_REQUEST_NULL);
    MPI_Iallgather(packet.data(), length(of_packet), MPI_BYTE, packets.data(), length(of_packet), MPI_BYTE,
                   MPI_COMM_WORLD, requests_.data());
    wait(requests_, at);
    const bool receives = receivers == Receivers::all || is_first();
    std::vector<int> sizes, begins;
    std::size_t total = 0, largest = 0;
    for (std::size_t rank = 0; rank < static_cast<std::size_t>(count_); ++rank) {
      Head of_rank;
      std::memcpy(&of_rank, &packets[rank * of_packet], sizeof(Head));
      if (of_rank.place != head.place)
        throw Error("ranks are in different places of the program, this one in " + at.text() +
                    ": please report this as a fault of pyroclast");
      begins.push_back(length(total));
      sizes.push_back(length(of_rank.size));
      total += of_rank.size;
      largest = std::max<std::size_t>(largest, of_rank.size);
    }
    length(total);
    std::vector<std::byte> all(receives ? total : 0);
    if (largest <= room) {
      for (std::size_t rank = 0; receives && rank < sizes.size(); ++rank)
        std::copy_n(packets.begin() + rank * of_packet + sizeof(Head), sizes[rank],
                    all.begin() + begins[rank]);
      return all;
    }
    // All ranks know all sizes, so they give the next packet from here the same room. By a fault of the
    // program ranks may be in different places whose packets differ in length: then MPI ends them all.
    if (receivers == Receivers::all && largest * sizes.size() <= kMostPadded * total) room = largest;
    requests_.assign(1, MPI_REQUEST_NULL);
    if (receivers == Receivers::all)
      MPI_Iallgatherv(own.data(), sizes[static_cast<std::size_t>(me_)], MPI_BYTE, all.data(), sizes.data(),
                      begins.data(), MPI_BYTE, MPI_COMM_WORLD, requests_.data());
    else
      MPI_Igatherv(own.data(), sizes[static_cast<std::size_t>(me_)], MPI_BYTE, all.data(), sizes.data(),
                   begins.data(), MPI_BYTE, 0, MPI_COMM_WORLD, requests_.data());
    wait(requests_, at);
    return all;
  }

 private:
  static constexpr int kTags = 30000;  // MPI has at least 32,767
  static constexpr std::size_t kLeastRoom = 240;
  static constexpr std::size_t kMostPadded = 2;  // bytes of packets over those of ranks

  /// Returns a length for MPI, which counts by int.
  static int length(std::size_t count) {
    if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw Error("a message between ranks is longer than 2 GB: take more ranks");
    return static_cast<int>(count);
  }

  /// Counts the ranks on this machine that may use the same processors.
  void count_sharing() {
    MPI_Comm of_machine = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &of_machine);
    int ranks = 1;
    MPI_Comm_size(of_machine, &ranks);
    cpu_set_t own;
    CPU_ZERO(&own);
    sched_getaffinity(0, sizeof(own), &own);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(ranks));
    MPI_Allgather(&own, sizeof(own), MPI_BYTE, all.data(), sizeof(own), MPI_BYTE, of_machine);
    sharing_ = static_cast<int>(
        std::ranges::count_if(all, [&](const cpu_set_t& other) { return CPU_EQUAL(&own, &other) != 0; }));
    MPI_Comm_free(&of_machine);
  }

  /// Waits for requests. A rank that waits long sleeps: who sleeps gets a shared processor back as soon as a
  /// message is there, while one that merely yields it waits until others have used up their time. The longer
  /// it has waited, the longer it sleeps, as each look takes a processor from those for which it waits.
  void wait(std::vector<MPI_Request>& requests, CallPlace at) const {
    constexpr int kSpins = 1000;
    constexpr Seconds kShortestSleep{20e-6}, kLongestSleep{500e-6};
    constexpr double kSleepOverWait = 0.125;
    const auto begun = WaitClock::now();
    int done = 0;
    for (int spins = 0;; ++spins) {
      MPI_Testall(static_cast<int>(requests.size()), requests.data(), &done, MPI_STATUSES_IGNORE);
      if (done != 0) return;
      if (spins < kSpins) continue;
      const Seconds waited = WaitClock::now() - begun;
      std::this_thread::sleep_for(std::clamp(kSleepOverWait * waited, kShortestSleep, kLongestSleep));
      if (longest_wait_ > 0.0 && waited.count() > longest_wait_)
        throw Error("it waits for other ranks in " + at.text());
    }
  }

  int me_ = 0, count_ = 1, sharing_ = 1;
  double longest_wait_ = 0.0;  ///< s; 0: any
  std::vector<MPI_Request> requests_, of_exchange_;
  std::unordered_map<std::uint64_t, std::size_t> rooms_;  ///< bytes of a rank in a packet, by place
};

}  // namespace

}  // namespace pyroclast

extern "C" const pyroclast::MpiObject* pyroclast_mpi() {
  static const std::string version = std::string(pyroclast::kVersion) + " " + std::string(pyroclast::kCommit);
  static const pyroclast::MpiObject object{version.c_str(), []() -> std::unique_ptr<pyroclast::Processes> {
                                             return std::make_unique<pyroclast::MpiProcesses>();
                                           }};
  return &object;
}
