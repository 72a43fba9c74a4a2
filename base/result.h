// base/result.h - a value or the reason why there is none.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace kerf {

/// Why something failed, in one sentence that names the object ("disk full while writing
/// part.stl").
struct Error {
  std::string message;
};

/// For failures of the outside world and of single values. Many faults at once are a list of
/// Diagnostic instead (diagnostic.h); our own mistakes are asserts. `Result<std::monostate>` for
/// "done or why not".
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value)
      : state_(std::move(value)) {}  // NOLINT: implicit so that `return value;` reads well
  Result(Error error) : state_(std::move(error)) {}  // NOLINT
  explicit operator bool() const { return state_.index() == 0; }
  T& value() { return assert(*this), std::get<0>(state_); }
  const T& value() const { return assert(*this), std::get<0>(state_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const std::string& error() const { return assert(!*this), std::get<1>(state_).message; }

 private:
  std::variant<T, Error> state_;
};

using Done = Result<std::monostate>;

}  // namespace kerf
