#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pyroclast/base/flat_array.hpp"

namespace pyroclast {

/// Is shown, under its name, all that a moving thing keeps from one batch of steps to the next. It reads it,
/// or replaces it by what the same thing kept elsewhere; the thing then works out what follows.
class StateVisitor {
 public:
  StateVisitor() = default;
  StateVisitor(const StateVisitor&) = delete;
  StateVisitor& operator=(const StateVisitor&) = delete;
  virtual ~StateVisitor() = default;

  /// Whether what is shown is replaced.
  virtual bool replaces() const = 0;

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void visit(std::string_view name, T& value) {
    visit_row(scope_ + std::string(name), {sizeof(T), 1, reinterpret_cast<std::byte*>(&value), {}});
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void visit(std::string_view name, std::vector<T>& values) {
    visit_array<T>(name, values);
  }
  template <class T>
  void visit(std::string_view name, FlatArray<T>& values) {
    visit_array<T>(name, values);
  }
  void visit(std::string_view name, std::string& text) { visit_array<char>(name, text); }
  /// A list of words, none of which may hold a line's end.
  void visit(std::string_view name, std::vector<std::string>& words) {
    std::string lines;
    for (const std::string& word : words) lines += word + '\n';
    visit(name, lines);
    if (!replaces()) return;
    words.clear();
    for (std::size_t begin = 0; begin < lines.size();) {
      const auto end = lines.find('\n', begin);
      words.push_back(lines.substr(begin, end - begin));
      begin = end + 1;
    }
  }

  /// Puts "name." before all names while it is there.
  class Scope {
   public:
    Scope(StateVisitor& visitor, std::string_view name) : visitor_(visitor), outer_(visitor.scope_) {
      visitor_.scope_ += name;
      visitor_.scope_ += '.';
    }
    ~Scope() { visitor_.scope_ = outer_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    StateVisitor& visitor_;
    std::string outer_;
  };

 protected:
  /// Plain data of one kind, side by side.
  struct Row {
    std::size_t item;  ///< bytes of one
    std::size_t count;
    std::byte* data;
    /// Makes room for another number of them and returns where they stand; empty where the number is fixed.
    std::function<std::byte*(std::size_t)> resize;
  };
  virtual void visit_row(const std::string& name, const Row& row) = 0;

 private:
  template <class T, class Array>
  void visit_array(std::string_view name, Array& values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);
    visit_row(scope_ + std::string(name),
              {sizeof(T), values.size(), reinterpret_cast<std::byte*>(values.data()), [&](std::size_t count) {
                 values.resize(count);
                 return reinterpret_cast<std::byte*>(values.data());
               }});
  }

  std::string scope_;
};

}  // namespace pyroclast
