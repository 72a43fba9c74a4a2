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
#include "twin/batch/called_files.h"

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

/// Where subroutines may stand, and those that something else than the program calls.
struct Subroutines {
  std::vector<fs::path> folders;
  std::vector<std::string> names;
};

void add_ini(const fs::path& path, ContentHasher& hasher, Subroutines& subroutines) {
  SubroutinePlaces places = subroutine_places(path.string());
  for (const std::string& file : places.files) hasher.file(file);
  subroutines.folders.insert(subroutines.folders.end(), places.folders.begin(),
                             places.folders.end());
  subroutines.names.insert(subroutines.names.end(), places.names.begin(), places.names.end());
}

/// Files that "key: value" lines of a configuration name.
void add_named_files(const std::string& text, const fs::path& folder, ContentHasher& hasher,
                     Subroutines& subroutines) {
  if (text.size() > kMostSettingBytes) return;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = trim(take_line(rest));
    const std::size_t at = line.find_first_of(":=");
    if (line.empty() || line.front() == '#' || at == line.npos) continue;
    std::string_view value = trim(line.substr(at + 1));
    value = value.substr(0, value.find('#'));
    value = trim(value, [](char c) { return is_line_blank(c) || c == '"' || c == '\''; });
    if (value.empty() || value.size() >= 4096 || !is_file(folder / value)) continue;
    if (to_lower(fs::path(value).extension().string()) == ".ini")
      add_ini(folder / value, hasher, subroutines);
    else
      hasher.file(folder / value);
  }
}

/// One that is in several of the folders counts with all of them.
void add_subroutines(const std::vector<std::string>& names, const Subroutines& subroutines,
                     ContentHasher& hasher) {
  for (const std::string& name : names) {
    for (const fs::path& folder : subroutines.folders) {
      const fs::path called = folder / (name + ".ngc");
      if (!is_file(called)) continue;
      const std::string more = hasher.file(called);
      if (!more.empty()) add_subroutines(called_names(more), subroutines, hasher);
    }
  }
}

void add_setting(const fs::path& path, ContentHasher& hasher, Subroutines& subroutines) {
  if (path.empty() || !is_file(path)) return;
  const std::string end = to_lower(path.extension().string());
  if (end == ".ini") return add_ini(path, hasher, subroutines);
  const std::string text = hasher.file(path);
  if (end == ".yaml" || end == ".yml")
    add_named_files(text, path.parent_path(), hasher, subroutines);
}

void add_word(const std::string& word, ContentHasher& hasher, Subroutines& subroutines) {
  add_setting(word, hasher, subroutines);
  for (std::size_t at = word.find_first_of("=:"); at != word.npos;
       at = word.find_first_of("=:", at + 1))
    add_setting(word.substr(at + 1), hasher, subroutines);
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
  const fs::path path = program;
  // Without an INI they may stand where kerf was started, too.
  Subroutines subroutines{{path.parent_path(), fs::path(".")}, {}};
  for (const std::string& word : words) {
    hasher.text(word);
    add_word(word, hasher, subroutines);
  }
  add_subroutines(called_names(hasher.file(path)), subroutines, hasher);
  add_subroutines(subroutines.names, subroutines, hasher);
  return hasher.digest();
}

}  // namespace kerf
