#include "stock/state_bytes.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/atomic_file.h"
#include "base/translate.h"

namespace kerf {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they lie in memory");
static_assert(kStateHashBytes == sizeof(XXH128_canonical_t));

template <class T>
bool read_numbers(std::optional<std::string_view> line, T* out, int count) {
  if (!line) return false;
  std::string_view value = *line;
  for (int i = 0; i < count; ++i) {
    while (!value.empty() && value.front() == ' ') value.remove_prefix(1);
    const auto [end, fault] = std::from_chars(value.data(), value.data() + value.size(), out[i]);
    if (fault != std::errc()) return false;
    value.remove_prefix(static_cast<std::size_t>(end - value.data()));
  }
  return value.empty();
}

/// Of the largest model that fits a memory of 16 GB.
constexpr std::size_t kMostStateBytes = std::size_t{16} << 30;

Error unreadable(const std::string& path) { return Error{trf("{}: cannot be read", path)}; }

Error damaged_head(const StateHead& head, const std::string& name) {
  return Error{trf("{}: the head is damaged near byte {}", name, head.position())};
}

/// False for bytes that are shorter than a checksum.
bool has_right_checksum(std::string_view bytes) {
  if (bytes.size() < kStateHashBytes) return false;
  const std::size_t end = bytes.size() - kStateHashBytes;
  XXH128_canonical_t sum;
  std::memcpy(&sum, bytes.data() + end, kStateHashBytes);
  return XXH128_isEqual(XXH128_hashFromCanonical(&sum), XXH3_128bits(bytes.data(), end)) != 0;
}

}  // namespace

struct StateWriter::Impl {
  std::optional<AtomicFile> file;  ///< none: to memory
  std::string* memory = nullptr;
  XXH3_state_t hash;
  explicit Impl(AtomicFile f) : file(std::move(f)) { XXH3_128bits_reset(&hash); }
  explicit Impl(std::string& bytes) : memory(&bytes) { XXH3_128bits_reset(&hash); }

  void write(const void* data, std::size_t bytes) {
    if (file) {
      file->write(data, bytes);
    } else {
      memory->append(static_cast<const char*>(data), bytes);
    }
  }
};

StateWriter::StateWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StateWriter::StateWriter(StateWriter&&) noexcept = default;
StateWriter::~StateWriter() = default;

Result<StateWriter> StateWriter::create(const std::string& path) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return Error{file.error()};
  return StateWriter(std::make_unique<Impl>(std::move(*file)));
}

StateWriter StateWriter::into(std::string& bytes) {
  return StateWriter(std::make_unique<Impl>(bytes));
}

void StateWriter::put(const void* data, std::size_t bytes) {
  XXH3_128bits_update(&impl_->hash, data, bytes);
  impl_->write(data, bytes);
}

Done StateWriter::commit() {
  XXH128_canonical_t sum;
  XXH128_canonicalFromHash(&sum, XXH3_128bits_digest(&impl_->hash));
  impl_->write(&sum, sizeof sum);
  if (!impl_->file) return std::monostate{};
  return impl_->file->commit();
}

std::optional<std::string_view> StateHead::line(std::string_view key) {
  const std::string_view rest = bytes_.substr(position_);
  const std::size_t end = rest.find('\n');
  if (end == std::string_view::npos || rest.substr(0, key.size()) != key) return std::nullopt;
  std::string_view value = rest.substr(key.size(), end - key.size());
  position_ += end + 1;
  if (!value.empty() && value.front() == ' ') value.remove_prefix(1);
  return value;
}

bool StateHead::numbers(std::string_view key, double* out, int count) {
  return read_numbers(line(key), out, count);
}

bool StateHead::numbers(std::string_view key, std::int64_t* out, int count) {
  return read_numbers(line(key), out, count);
}

Result<std::string> read_state_bytes(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) {
    return Error{trf("{}: is a folder, not a saved workpiece", path)};
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{fmt::format("{}: {}", path, std::strerror(errno))};
  // What does not begin like one may have no end (/dev/zero).
  std::string bytes(kStateMagic.size(), '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (bytes != kStateMagic) return in.bad() ? unreadable(path) : Result<std::string>(bytes);
  std::string piece(std::size_t{1} << 20, '\0');
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    bytes.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > kMostStateBytes) {
      return Error{
          trf("{}: longer than {} GB; no saved workpiece is", path, kMostStateBytes >> 30)};
    }
  }
  if (in.bad()) return unreadable(path);
  return bytes;
}

Result<std::string> model_of_state(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, kStateMagic.size()) != kStateMagic)
    return Error{trf("{}: not a saved workpiece (it must begin with \"kerf-state/1\")", name)};
  StateHead head(bytes);
  head.line("kerf-state/1");
  const auto model = head.line("model");
  if (!model) return damaged_head(head, name);
  return std::string(*model);
}

Result<StateHead> head_of_state(std::string_view bytes, const std::string& name,
                                std::string_view model,
                                const std::function<bool(StateHead&)>& read) {
  const Result<std::string> found = model_of_state(bytes, name);
  if (!found) return Error{found.error()};
  if (*found != model)
    return Error{trf("{}: a workpiece of the model {}, not of {}", name, *found, model)};
  StateHead head(bytes);
  head.line("kerf-state/1");
  head.line("model");
  if (!read(head)) return damaged_head(head, name);
  return head;
}

Result<std::string_view> data_of_state(const StateHead& head, const std::string& name) {
  const std::string_view bytes = head.bytes();
  // The checksum may overlap the head of a file that is made up.
  if (!has_right_checksum(bytes) || bytes.size() < head.position() + kStateHashBytes) {
    return Error{trf("{}: the checksum does not match: the file is damaged or cut short", name)};
  }
  return bytes.substr(head.position(), bytes.size() - head.position() - kStateHashBytes);
}

}  // namespace kerf
