#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <sys/mman.h>

#include "pyroclast/base/team.hpp"

namespace pyroclast {

/// Array of plain data that starts on a cache line and is filled with zero bytes. Behind the last element
/// stands memory that may be read: lanes read three numbers as four.
///
/// On a machine with several memories the system puts a page near the thread that touches it first. Where a
/// team is given, each of its threads touches an even share of the array.
template <class T>
class FlatArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  FlatArray() = default;
  explicit FlatArray(std::size_t size, Team* team = nullptr) : size_(size), capacity_(size) {
    if (size == 0) return;
    const std::size_t needed = size * sizeof(T) + kReadBehind;
    const std::size_t alignment = needed < kHugePage ? kPage : kHugePage;
    const std::size_t shift = alignment == kHugePage ? next_shift() : 0;
    const std::size_t bytes = (needed + shift + alignment - 1) / alignment * alignment;
    char* const base = static_cast<char*>(std::aligned_alloc(alignment, bytes));
    if (!base) throw std::bad_alloc();
    data_ = {reinterpret_cast<T*>(base + shift), Free{base}};
#ifdef MADV_HUGEPAGE
    // Gathers all over a large array would miss most translations of small pages; a refusal costs only time.
    if (alignment == kHugePage) madvise(base, bytes, MADV_HUGEPAGE);
#endif
    const auto touch = [&](std::ptrdiff_t first, std::ptrdiff_t last) {
      std::memset(base + static_cast<std::size_t>(first) * kPage, 0,
                  static_cast<std::size_t>(last - first) * kPage);
    };
    const auto pages = static_cast<std::ptrdiff_t>(bytes / kPage);
    if (team)
      team->share(pages, kPagesForAThread, touch);
    else
      touch(0, pages);
  }

  explicit FlatArray(const std::vector<T>& values) : FlatArray(values.size()) {
    std::copy(values.begin(), values.end(), begin());
  }

  FlatArray(const FlatArray& other) : FlatArray(other.size()) {
    std::copy(other.begin(), other.end(), begin());
  }
  FlatArray(FlatArray&& other) noexcept
      : data_(std::move(other.data_)),
        size_(std::exchange(other.size_, 0)),
        capacity_(std::exchange(other.capacity_, 0)) {}
  FlatArray& operator=(FlatArray other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    return *this;
  }
  ~FlatArray() = default;

  /// Changes the number of elements; new ones are zero bytes. The elements move when there is no room left;
  /// the new place then has room for twice as many.
  void resize(std::size_t size) {
    if (size > capacity_) {
      FlatArray bigger(std::max(size, 2 * capacity_));
      std::copy(begin(), end(), bigger.begin());
      bigger.size_ = size_;
      *this = std::move(bigger);
    }
    if (size > size_) std::memset(static_cast<void*>(data() + size_), 0, (size - size_) * sizeof(T));
    size_ = size;
  }

  std::size_t size() const {
    return size_;
  }
  bool empty() const {
    return size_ == 0;
  }
  T* data() {
    return data_.get();
  }
  const T* data() const {
    return data_.get();
  }
  T& operator[](std::size_t i) {
    return data_.get()[i];
  }
  const T& operator[](std::size_t i) const {
    return data_.get()[i];
  }
  T* begin() {
    return data();
  }
  T* end() {
    return data() + size_;
  }
  const T* begin() const {
    return data();
  }
  const T* end() const {
    return data() + size_;
  }

 private:
  static constexpr std::size_t kPage = 4096, kHugePage = std::size_t{2} << 20;
  static constexpr std::ptrdiff_t kPagesForAThread = 256;
  static constexpr std::size_t kReadBehind = sizeof(double);
  struct Free {
    void* base = nullptr;
    void operator()(T*) const { std::free(base); }
  };
  /// Returns the bytes by which the next large array is shifted, so that large arrays begin apart in the sets
  /// of a cache. Arrays that are walked through side by side would otherwise compete for the same sets, and
  /// drive out the program that walks through them.
  static std::size_t next_shift() {
    static std::atomic<unsigned> made = 0;
    return (made++ % 16) * (kPage + 5 * 64);
  }
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

/// Returns the bytes that the elements of an array take.
template <class Array>
std::size_t bytes_of(const Array& array) {
  return array.size() * sizeof(*array.begin());
}

}  // namespace pyroclast
