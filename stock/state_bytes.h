// stock/state_bytes.h - what the files of all saved workpieces share: kerf-state/1.
//
//   kerf-state/1\n
//   model NAME\n
//   ...                    lines `KEY VALUE..` of the model; decimals that give the same doubles
//   data\n
//   ...                    bytes of the model, little endian
//   xxh3-128 of all bytes before, 16 bytes, big endian
//
// What the lines and bytes are: stock/zmap/state_file.h, stock/octree/octree_state.h,
// stock/sheet/sheet_state.h, stock/turning/turning_state.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace kerf {

inline constexpr std::string_view kStateMagic = "kerf-state/1\n";
inline constexpr std::size_t kStateHashBytes = 16;

/// Writes such a file, under a temporary name until commit().
class StateWriter {
 public:
  static Result<StateWriter> create(const std::string& path);
  /// Into memory: a file that lies within another one. Cannot fail.
  static StateWriter into(std::string& bytes);
  StateWriter(StateWriter&&) noexcept;
  ~StateWriter();
  void put(const void* data, std::size_t bytes);
  /// Puts the checksum behind it all. Once.
  Done commit();

 private:
  struct Impl;
  explicit StateWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Takes lines of the head off the front of a file's bytes, which must outlive it.
class StateHead {
 public:
  explicit StateHead(std::string_view bytes) : bytes_(bytes) {}
  /// Of the file; behind what has been taken.
  std::string_view bytes() const { return bytes_; }
  std::size_t position() const { return position_; }
  /// The rest of a line that begins with `key`; none if the next line is another one.
  std::optional<std::string_view> line(std::string_view key);
  /// The same of a line that has `count` numbers and nothing else; false if it is not so.
  bool numbers(std::string_view key, double* out, int count);
  bool numbers(std::string_view key, std::int64_t* out, int count);

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

/// The whole file. Error: cannot be read ("part.state: No such file or directory").
Result<std::string> read_state_bytes(const std::string& path);

/// The model that saved these bytes: "zmap", "octree". Error: no such file; `name` is the file's.
Result<std::string> model_of_state(std::string_view bytes, const std::string& name);

/// A file's head, of which `read` takes the lines behind the model's, up to `data`. Error: no such
/// file, that of another model, or a head with which `read` is not content.
Result<StateHead> head_of_state(std::string_view bytes, const std::string& name,
                                std::string_view model,
                                const std::function<bool(StateHead&)>& read);

/// The bytes between the head and the checksum, a part of the file's. Error: the checksum does not
/// agree, or there is none behind the head.
Result<std::string_view> data_of_state(const StateHead& head, const std::string& name);

}  // namespace kerf
