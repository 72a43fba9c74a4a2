#include "twin/cli/machine_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/exit_code.h"
#include "base/translate.h"
#include "twin/cli/console.h"

namespace kerf {

int machine_command(int argc, char** argv) {
  constexpr const char* kName = "kerf-machine";
  std::error_code ignored;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path folder = self.parent_path();
  std::string name = kName;
  std::vector<char*> arguments(argv, argv + argc);
  arguments[0] = name.data();
  arguments.push_back(nullptr);
  for (const auto& place : {folder / kName, folder / "../lib/kerf" / kName}) {
    execv(place.c_str(), arguments.data());
  }
  execvp(kName, arguments.data());
  Diagnostic d;
  d.message = fmt::format("{}: {}", kName, std::strerror(errno));
  d.hint = tr("it is built and installed beside kerf");
  kerf::print(stderr, "{}", to_string(d));
  return kExitFailure;
}

}  // namespace kerf
