#define XXH_INLINE_ALL
#include "twin/batch/content_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>

#include "base/small_file.h"
#include "base/text_scan.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// Larger ones count by their size and the time of their change: nobody keeps programs of such.
constexpr std::size_t kMostBytes = 1U << 30U;
constexpr std::size_t kMostSettingBytes = 4U << 20U;

class ContentHasher {
 public:
  ContentHasher() { XXH3_128bits_reset(&state_); }

  void text(std::string_view text) {
    const std::uint64_t size = text.size();  // so that two texts are not one
    XXH3_128bits_update(&state_, &size, sizeof size);
    XXH3_128bits_update(&state_, text.data(), text.size());
  }

  /// Once each; its text, if it could be read.
  std::string file(const fs::path& path) {
    if (!seen_.insert(path.lexically_normal().string()).second) return {};
    text(path.string());
    Result<std::string> read = read_small_file(path.string(), kMostBytes);
    if (read) {
      text(*read);
      return std::move(*read);
    }
    std::error_code ignored;
    const auto changed = fs::last_write_time(path, ignored).time_since_epoch().count();
    text(fmt::format("{} {}", fs::file_size(path, ignored), changed));
    return {};
  }

  std::string digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(&state_);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  XXH3_state_t state_;
  std::set<std::string> seen_;
};

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Files that "key = value" and "key: value" lines of a configuration or an INI name.
void add_named_files(const std::string& text, const fs::path& folder, ContentHasher& hasher) {
  if (text.size() > kMostSettingBytes) return;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = trim(take_line(rest));
    const std::size_t at = line.find_first_of(":=");
    if (line.empty() || line.front() == '#' || at == line.npos) continue;
    std::string_view value = trim(line.substr(at + 1));
    value = value.substr(0, value.find('#'));
    value = trim(value, [](char c) { return is_line_blank(c) || c == '"' || c == '\''; });
    if (!value.empty() && value.size() < 4096 && is_file(folder / value)) {
      hasher.file(folder / value);
    }
  }
}

/// O<name> CALL
void add_called_files(const std::string& text, const fs::path& folder, ContentHasher& hasher) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::string line = to_lower(take_line(rest));
    const std::size_t start = line.find("o<");
    const std::size_t end = start == line.npos ? line.npos : line.find('>', start);
    if (end == line.npos || line.find("call", end) == line.npos) continue;
    const fs::path called = folder / (line.substr(start + 2, end - start - 2) + ".ngc");
    if (!is_file(called)) continue;
    const std::string more = hasher.file(called);
    if (!more.empty()) add_called_files(more, folder, hasher);
  }
}

void add_word(const std::string& word, ContentHasher& hasher) {
  for (std::size_t at = word.find_first_of("=:"); at != word.npos;
       at = word.find_first_of("=:", at + 1)) {
    const fs::path path = word.substr(at + 1);
    if (path.empty() || !is_file(path)) continue;
    const std::string text = hasher.file(path);
    const std::string end = to_lower(path.extension().string());
    if (end == ".ini" || end == ".yaml" || end == ".yml") {
      add_named_files(text, path.parent_path(), hasher);
    }
  }
}

const std::string& hash_of_kerf() {
  static const std::string kHash = [] {
    ContentHasher hasher;
    hasher.file("/proc/self/exe");
    return hasher.digest();
  }();
  return kHash;
}

}  // namespace

std::string content_hash(const std::string& program, const std::vector<std::string>& words) {
  ContentHasher hasher;
  hasher.text(hash_of_kerf());
  for (const std::string& word : words) {
    hasher.text(word);
    add_word(word, hasher);
  }
  const fs::path path = program;
  add_called_files(hasher.file(path), path.parent_path(), hasher);
  return hasher.digest();
}

}  // namespace kerf
