#include "twin/cli/setup_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/small_file.h"
#include "base/translate.h"
#include "twin/cli/console.h"
#include "twin/cli/screen_setup.h"

namespace kerf {
namespace {

constexpr std::size_t kLargestIni_bytes = 1'000'000;

/// As the screen is to call it: by its name where that leads here, else by its path.
std::string own_command() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return "kerf";
  for (const char* const place : {"/usr/bin/kerf", "/usr/local/bin/kerf"}) {
    if (std::filesystem::equivalent(place, self, error) && !error) return "kerf";
  }
  return self.string();
}

int fail(const std::string& message) {
  Diagnostic d;
  d.message = message;
  print_diagnostics({d}, false);
  return kExitFailure;
}

/// The INI that was, beside it, then the new one in its place.
int write_change(const std::string& path, const std::string& text, const IniChange& change) {
  const std::string backup = path + ".before-kerf";
  if (const Done done = write_text(backup, text); !done) return fail(done.error());
  if (const Done done = write_text(path, change.text); !done) return fail(done.error());
  print_text(stdout, trf("{}: written; as it was: {}\n", path, backup));
  return kExitGood;
}

}  // namespace

int setup_command(const Arguments& arguments) {
  const std::string& path = arguments.options.text("INI");
  const bool writes = arguments.options.has("--write");
  const bool undoes = arguments.options.has("--undo");
  const Result<std::string> text = read_small_file(path, kLargestIni_bytes);
  if (!text) return fail(text.error());
  Diagnostics diagnostics;
  const std::optional<IniChange> change = undoes
                                              ? without_tab(*text, path, diagnostics)
                                              : with_tab(*text, path, own_command(), diagnostics);
  if (!change) {
    print_diagnostics(diagnostics, false);
    return kExitUsage;
  }
  if (!change->changes()) {
    print_text(stdout, undoes ? trf("{}: has no tab of kerf setup\n", path)
                              : trf("{}: has the tab already\n", path));
    return kExitGood;
  }
  kerf::print(stdout, "{}", unified_diff(*text, *change, path));
  if (writes) return write_change(path, *text, *change);
  print_text(stdout, tr("\nNothing is written yet: --write does it.\n"));
  return kExitGood;
}

}  // namespace kerf
