#include "base/zip_file.h"

#include <zip.h>

#include <cstdint>
#include <memory>

namespace kerf {
namespace {

constexpr std::size_t kPieceBytes = 64 * 1024;

struct ZipCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, ZipCloser>;
using Member = std::unique_ptr<zip_file_t, ZipCloser>;

Archive open_archive(std::string_view bytes) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  zip_t* const archive = source ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr;
  if (source != nullptr && archive == nullptr) zip_source_free(source);
  zip_error_fini(&error);
  return Archive(archive);
}

}  // namespace

bool is_zip(std::string_view bytes) {
  return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06");
}

std::optional<std::vector<std::string>> names_in_zip(std::string_view bytes) {
  const Archive archive = open_archive(bytes);
  if (!archive) return std::nullopt;
  std::vector<std::string> names;
  const zip_int64_t count = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), 0);
    names.emplace_back(name == nullptr ? "" : name);
  }
  return names;
}

Unpacked unpack_zip(std::string_view bytes, std::size_t member, std::size_t max_bytes,
                    const std::function<bool(std::string_view)>& take) {
  const Archive archive = open_archive(bytes);
  if (!archive) return Unpacked::kDamaged;
  const Member file(zip_fopen_index(archive.get(), member, 0));
  if (!file) return Unpacked::kDamaged;
  std::string piece(kPieceBytes, '\0');
  std::size_t unpacked = 0;
  while (true) {
    const zip_int64_t got = zip_fread(file.get(), piece.data(), piece.size());
    if (got < 0) return Unpacked::kDamaged;
    if (got == 0) return Unpacked::kWhole;
    const auto size = static_cast<std::size_t>(got);
    unpacked += size;
    if (unpacked > max_bytes) return Unpacked::kTooLarge;
    if (!take(std::string_view(piece).substr(0, size))) return Unpacked::kStopped;
  }
}

}  // namespace kerf
