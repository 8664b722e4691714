#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pyroclast/base/ranks.hpp"

/// Ranks as threads of one process, for tests: the collectives of a run without MPI. All ranks must call from
/// the same place, and none may wait for long. Numbers of foreign items are NaN wherever no rank has sent
/// them.
namespace pyroclast {

class RanksInThreads {
 public:
  using Bytes = std::vector<std::byte>;

  class OfThread final : public Ranks {
   public:
    OfThread(std::shared_ptr<RanksInThreads> board, int me) : board_(std::move(board)), me_(me) {}
    int me() const override { return me_; }
    int count() const override { return static_cast<int>(board_->own_.size()); }
    bool spoil_foreign() const override { return true; }
    void begin_exchange(std::vector<Message>& messages, CallPlace /*at*/) override {
      events_ += 'x';
      board_->send(me_, messages);
    }
    void end_exchange(std::vector<Message>& messages, CallPlace at) override {
      board_->receive(me_, messages, at);
    }

    /// Returns the calls so far: 'c' for a collective, 'x' for an exchange with neighbours, and what `note`
    /// was given.
    const std::string& events() const { return events_; }
    void note(char event) { events_ += event; }

   protected:
    Bytes gather(std::span<const std::byte> own, Receivers receivers, CallPlace at) override {
      events_ += 'c';
      Bytes all;
      for (const Bytes& bytes : board_->gather(me_, {own.begin(), own.end()}, at))
        if (receivers == Receivers::all || me_ == 0) all.insert(all.end(), bytes.begin(), bytes.end());
      return all;
    }

   private:
    std::shared_ptr<RanksInThreads> board_;
    int me_;
    std::string events_;
  };

  explicit RanksInThreads(int count) : own_(count), places_(count) {}

  /// Calls `f(ranks)` on a thread a rank. Throws again the first exception of any.
  static void run(int count, const std::function<void(const std::shared_ptr<OfThread>&)>& f) {
    auto board = std::make_shared<RanksInThreads>(count);
    std::vector<std::thread> threads;
    for (int me = 0; me < count; ++me)
      threads.emplace_back([&f, board, me] {
        try {
          f(std::make_shared<OfThread>(board, me));
        } catch (...) {
          board->fail(std::current_exception());
        }
      });
    for (std::thread& thread : threads) thread.join();
    if (board->failure_) std::rethrow_exception(board->failure_);
  }

 private:
  void fail(std::exception_ptr why) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(why);
    changed_.notify_all();
  }
  template <class Condition>
  void wait(std::unique_lock<std::mutex>& lock, CallPlace at, Condition condition) {
    const bool done =
        changed_.wait_for(lock, std::chrono::seconds(60), [&] { return failure_ || condition(); });
    if (failure_) throw std::runtime_error("another rank has failed");
    if (!done) throw std::runtime_error("a rank waits for others in " + at.text());
  }

  /// The last rank that comes copies what all have put down; then the next collective may begin.
  std::vector<Bytes> gather(int me, Bytes own, CallPlace at) {
    std::unique_lock lock(mutex_);
    own_[me] = std::move(own);
    places_[me] = at;
    const std::int64_t round = round_;
    if (++arrived_ == static_cast<int>(own_.size())) {
      for (const CallPlace& place : places_)
        if (!(place == at))
          throw std::runtime_error("ranks call different collectives: " + place.text() + ", " + at.text());
      all_ = own_;
      arrived_ = 0;
      ++round_;
      changed_.notify_all();
    } else {
      wait(lock, at, [&] { return round_ != round; });
    }
    return all_;
  }

  void send(int me, const std::vector<Message>& messages) {
    const std::lock_guard lock(mutex_);
    for (const Message& message : messages) mail_[{me, message.rank}].push_back(message.sent);
    changed_.notify_all();
  }
  void receive(int me, std::vector<Message>& messages, CallPlace at) {
    std::unique_lock lock(mutex_);
    for (Message& message : messages) {
      auto& mail = mail_[{message.rank, me}];
      wait(lock, at, [&] { return !mail.empty(); });
      if (mail.front().size() != message.received.size())
        throw std::runtime_error("a message has another length than was expected in " + at.text());
      message.received = std::move(mail.front());
      mail.pop_front();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Bytes> own_, all_;
  std::vector<CallPlace> places_;
  int arrived_ = 0;
  std::int64_t round_ = 0;
  std::map<std::pair<int, int>, std::deque<std::vector<double>>> mail_;  ///< by sender and receiver
  std::exception_ptr failure_;
};

}  // namespace pyroclast
