#include "twin/batch/called_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/text_scan.h"
#include "interp_bridge/ini_file.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// A line without blanks and without comments in brackets.
std::string bare(std::string_view line) {
  std::string out;
  bool in_comment = false;
  for (const char c : line) {
    if (c == ';' && !in_comment) break;
    if (c == '(') in_comment = true;
    if (!in_comment && !is_line_blank(c) && c != '\r') out += c;
    if (c == ')') in_comment = false;
  }
  return out;
}

std::string_view digits_at(std::string_view text, std::size_t at) {
  const std::size_t end = text.find_first_not_of("0123456789", at);
  return text.substr(at, end == text.npos ? text.npos : end - at);
}

/// Behind the block number and a '/', an O word comes first.
std::optional<std::string> called_by_o_word(std::string_view line, std::string_view small) {
  std::size_t at = small.starts_with('/') ? 1 : 0;
  if (at < small.size() && small[at] == 'n') at += 1 + digits_at(small, at + 1).size();
  if (at >= small.size() || small[at] != 'o') return std::nullopt;
  ++at;
  if (at < small.size() && small[at] == '<') {
    const std::size_t end = small.find('>', at);
    if (end == small.npos || !small.substr(end + 1).starts_with("call")) return std::nullopt;
    return std::string(line.substr(at + 1, end - at - 1));
  }
  const std::string_view number = digits_at(small, at);
  if (number.empty() || !small.substr(at + number.size()).starts_with("call")) return std::nullopt;
  return std::string(number);
}

std::optional<std::string> called_by_m98(std::string_view small) {
  if (!contains(small, "m98")) return std::nullopt;
  const std::size_t at = small.find('p');
  if (at == small.npos) return std::nullopt;
  const std::string_view number = digits_at(small, at + 1);
  return number.empty() ? std::nullopt : std::optional<std::string>(number);
}

void add_name(const std::string& name, std::vector<std::string>& names) {
  for (const std::string& form : {name, to_lower(name)}) {
    if (!form.empty() && std::ranges::find(names, form) == names.end()) names.push_back(form);
  }
}

void add_called(std::string_view line, std::vector<std::string>& names) {
  const std::string plain = bare(line), small = to_lower(plain);
  std::optional<std::string> called = called_by_o_word(plain, small);
  if (!called) called = called_by_m98(small);
  if (called) add_name(*called, names);
}

/// "M6 modalgroup=6 prolog=change_prolog ngc=change": change.
void add_remapped(std::string_view value, std::vector<std::string>& names) {
  for (std::string_view word : words_of(value)) {
    if (take_prefix(word, "ngc=")) add_name(std::string(word), names);
  }
}

}  // namespace

std::vector<std::string> called_names(std::string_view text) {
  std::vector<std::string> names;
  while (!text.empty()) add_called(take_line(text), names);
  return names;
}

SubroutinePlaces subroutine_places(const std::string& ini_path) {
  SubroutinePlaces places;
  places.files.push_back(ini_path);
  Diagnostics faults;  // the run tells them
  const Result<IniFile> ini = IniFile::read(ini_path, faults);
  if (!ini) return places;
  for (std::size_t n = 1; n < ini->files().size(); ++n) places.files.push_back(ini->files()[n]);
  const std::string folder = fs::path(ini_path).parent_path().string();
  for (const IniEntry& entry : ini->entries()) {
    const bool is_path = entry.key == "SUBROUTINE_PATH" || entry.key == "PROGRAM_PREFIX" ||
                         entry.key == "WIZARD_ROOT";
    if (is_path) {
      for (const std::string_view part : split(entry.value, ':'))
        if (!trim(part).empty()) places.folders.push_back(resolve_ini_path(trim(part), folder));
    } else if (entry.key == "REMAP") {
      add_remapped(entry.value, places.names);
    } else if (entry.key == "ON_ABORT_COMMAND") {
      add_called(entry.value, places.names);
    } else if (!entry.value.empty()) {
      std::string path = resolve_ini_path(entry.value, folder);
      std::error_code ignored;
      if (fs::is_regular_file(path, ignored)) places.files.push_back(std::move(path));
    }
  }
  return places;
}

}  // namespace kerf
