#include "twin/tool_library/zip_member.h"

#include <zip.h>

#include <memory>

#include "base/text_scan.h"
#include "base/translate.h"

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

zip_int64_t find_json(zip_t* archive) {
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr && to_lower(std::string_view(name)).ends_with(".json")) return i;
  }
  return -1;
}

}  // namespace

bool is_zip(std::string_view bytes) {
  return bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06");
}

Result<std::string> json_of_zip(std::string_view bytes, std::size_t max_bytes) {
  const Archive archive = open_archive(bytes);
  if (!archive) return Error{tr("is no whole zip file")};
  const zip_int64_t at = find_json(archive.get());
  if (at < 0) return Error{tr("is a zip file without a .json in it; tools.json is needed")};
  const Member member(zip_fopen_index(archive.get(), static_cast<zip_uint64_t>(at), 0));
  if (!member) return Error{tr("its .json cannot be unpacked")};
  std::string text;
  while (text.size() <= max_bytes) {
    const std::size_t before = text.size();
    text.resize(before + kPieceBytes);
    const zip_int64_t got = zip_fread(member.get(), text.data() + before, kPieceBytes);
    if (got < 0) return Error{tr("its .json cannot be unpacked")};
    text.resize(before + static_cast<std::size_t>(got));
    if (got == 0) return text;
  }
  return Error{trf("its .json is larger than {} MB", max_bytes / (1024 * 1024))};
}

}  // namespace kerf
