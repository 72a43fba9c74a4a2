// Arbitrary bytes as a LinuxCNC INI and a file that it may include: a line of dashes parts them.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/ini_file.h"

namespace {

using kerf::Diagnostics;
using kerf::IniEntry;
using kerf::IniFile;

void check(bool holds) {
  if (!holds) std::abort();
}

kerf::Result<std::string> no_file(const std::string& path) { return kerf::Error{path}; }

/// Places lie in the files; what is found is what LinuxCNC could find.
void check_entries(IniFile& ini) {
  std::vector<IniEntry> entries = ini.entries();
  if (entries.size() > 50) entries.resize(50);  // a search goes through all of them
  for (const IniEntry& entry : entries) {
    check(entry.file < ini.files().size() && entry.line > 0);
    check(entry.key_column >= 0 && entry.value_column >= 0 && entry.excerpt.size() <= 255);
    check(entry.key.find_first_of(" \t\r\n=") == entry.key.npos);
    check(entry.value.find('\n') == entry.value.npos);
    check(entry.shadowed || ini.has_section(entry.section));
    const std::vector<const IniEntry*> all = ini.find_all(entry.section, entry.key);
    check(ini.find(entry.section, entry.key) == (all.empty() ? nullptr : all[0]));
    for (const IniEntry* const one : all)
      check(!one->value.empty() && !one->shadowed && one->asked);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t parting = text.find("\n----\n");
  const std::string_view ini_text = text.substr(0, parting);
  const std::string_view included = parting == text.npos ? "" : text.substr(parting + 6);
  const kerf::IniIncludes files = [&](const std::string& path) -> kerf::Result<std::string> {
    if (path == "dir/a.inc") return std::string(included);
    return kerf::Error{"cannot read " + path};
  };
  Diagnostics diagnostics;
  IniFile ini = IniFile::parse(ini_text, "dir/fuzz.ini", files, diagnostics);
  for (const kerf::Diagnostic& diagnostic : diagnostics) {
    check(!kerf::to_string(diagnostic).empty() && diagnostic.line >= 0 && diagnostic.column >= 0);
  }
  check(diagnostics.size() <= 51);
  check_entries(ini);

  // The interpreter is given the expanded text, and must find in it what was found here.
  if (ini.expanded_text().empty() || kerf::has_error(diagnostics)) return 0;
  // A line of it is no #INCLUDE any more, unless it begins with that word and more.
  const std::string given = "\n" + ini.expanded_text();
  if (given.find("\n#INCLUDE") != std::string::npos) return 0;
  Diagnostics again_diagnostics;
  const IniFile again = IniFile::parse(given, "dir/fuzz.ini", no_file, again_diagnostics);
  check(again.entries().size() == ini.entries().size());
  for (std::size_t i = 0; i < again.entries().size(); ++i) {
    const IniEntry& one = ini.entries()[i];
    const IniEntry& other = again.entries()[i];
    check(one.section == other.section && one.key == other.key && one.value == other.value);
    check(one.shadowed == other.shadowed);
  }
  return 0;
}
