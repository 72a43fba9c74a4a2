#include "twin/batch/called_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/text_scan.h"
#include "interp_bridge/ini_file.h"
#include "interp_bridge/o_word.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;

void add_name(const std::string& name, std::vector<std::string>& names) {
  for (const std::string& form : {name, to_lower(name)}) {
    if (!form.empty() && std::ranges::find(names, form) == names.end()) names.push_back(form);
  }
}

void add_called(std::string_view line, std::vector<std::string>& names) {
  const std::optional<OWord> word = o_word(line);
  if (word && word->kind == OWord::Kind::kCall) add_name(word->name, names);
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
