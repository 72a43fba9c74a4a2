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
// stock/sheet/sheet_state.h.
#pragma once

#include <cstddef>
#include <cstdint>
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

/// Does the checksum at the end agree? False for bytes that are shorter than one.
bool has_right_checksum(std::string_view bytes);

/// The model that saved these bytes: "zmap", "octree". Error: no such file; `name` is the file's.
Result<std::string> model_of_state(std::string_view bytes, const std::string& name);

/// The head behind the line of the model. Error: no such file, or that of another model.
Result<StateHead> head_of_state(std::string_view bytes, const std::string& name,
                                std::string_view model);

}  // namespace kerf
