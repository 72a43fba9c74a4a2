#include "mesh/step_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/text_scan.h"
#include "base/translate.h"

extern char** environ;

namespace kerf {
namespace {

/// A path, or a name that is looked for in the PATH.
std::string step_program() {
  if (const char* const named = std::getenv("KERF_STEP"); named != nullptr && *named != '\0')
    return named;
  std::error_code none;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  for (const char* const place : {"kerf-step", "../lib/kerf/kerf-step"}) {
    const std::filesystem::path beside = folder / place;
    if (!none && ::access(beside.c_str(), X_OK) == 0) return beside.string();
  }
  return "kerf-step";
}

/// What it writes goes here: a file without a name.
class UnnamedFile {
 public:
  UnnamedFile() : file_(std::tmpfile()) {}
  ~UnnamedFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;
  bool is_open() const { return file_ != nullptr; }
  int descriptor() const { return fileno(file_); }
  /// At most so much of it.
  std::string read(std::size_t most) const {
    std::string bytes;
    std::rewind(file_);
    std::array<char, 1 << 16> some{};
    for (std::size_t n = 1; n > 0 && bytes.size() < most;) {
      n = std::fread(some.data(), 1, std::min(some.size(), most - bytes.size()), file_);
      bytes.append(some.data(), n);
    }
    return bytes;
  }

 private:
  std::FILE* file_;
};

}  // namespace

Result<std::string> step_as_stl(const std::string& path, std::size_t most_bytes) {
  const UnnamedFile out, said;
  if (!out.is_open() || !said.is_open())
    return Error{trf("{}: no temporary file: {}", path, std::strerror(errno))};
  std::string program = step_program(), file = path,
              deviation = fmt::format("{}", kStepDeviation_mm);
  // A name that begins with a minus is a file all the same.
  if (file.starts_with('-')) file = "./" + file;
  std::array<char*, 4> arguments{program.data(), file.data(), deviation.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, said.descriptor(), STDERR_FILENO);
  pid_t child = -1;
  const int fault =
      posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  const auto missing = [&] {
    return Error{
        trf("{}: STEP files need kerf-step, which is not installed here; an STL, OBJ or "
            "3MF of the part does without",
            path)};
  };
  if (fault == ENOENT) return missing();
  if (fault != 0) return Error{trf("{}: cannot run {}: {}", path, program, std::strerror(fault))};
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return missing();
  if (WIFSIGNALED(status)) {
    return Error{trf("{}: kerf-step was ended by signal {} ({})", path, WTERMSIG(status),
                     strsignal(WTERMSIG(status)))};
  }
  if (WEXITSTATUS(status) != 0) {
    const std::string words(trim(said.read(4096)));
    return Error{words.empty()
                     ? trf("{}: kerf-step ended with status {}", path, WEXITSTATUS(status))
                     : words};
  }
  std::string stl = out.read(most_bytes + 1);
  if (stl.size() > most_bytes) {
    return Error{trf("{}: its mesh takes more than {} MB; must be less", path, most_bytes >> 20U)};
  }
  return stl;
}

}  // namespace kerf
