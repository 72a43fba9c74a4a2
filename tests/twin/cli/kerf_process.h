// tests/twin/cli/kerf_process.h - the kerf executable as a process: arguments in, exit code and
// texts out.
#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace kerf {

/// An empty folder that is removed with all it holds.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string write(const std::string& name, const std::string& text) const;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

struct KerfResult {
  int exit_code = -1;  ///< 128 + signal if it was killed
  std::string out;
  std::string err;
};

struct KerfCall {
  std::vector<std::string> arguments;
  std::string folder;                              ///< working folder
  std::map<std::string, std::string> environment;  ///< set on top of the test's own
  std::string input;                               ///< standard input
  long file_size_limit = -1;                       ///< RLIMIT_FSIZE, bytes
};

/// Runs kerf to its end.
KerfResult run_kerf(const KerfCall& call);

/// A kerf that still runs. Its standard input stays open (write_input) until the end.
class RunningKerf {
 public:
  explicit RunningKerf(const KerfCall& call);
  ~RunningKerf();
  void write_input(const std::string& text) const;
  /// Waits until it has read all its input so far, has its signal handlers, and `ready` holds.
  /// False after a minute.
  bool wait_until(const std::function<bool()>& ready) const;
  bool has_read_its_input() const;
  bool catches_interrupts() const;
  void send(int signal) const;
  /// Processor time that it has used itself so far, without children; also once it has ended.
  double cpu_s() const;
  /// Waits for its end, and leaves the rest to finish().
  void wait_for_end() const;
  /// What it has said there so far.
  std::string err() const;
  KerfResult finish();

 private:
  friend KerfResult run_kerf(const KerfCall& call);
  TestFolder scratch_;
  pid_t pid_ = -1;
  int input_fd_ = -1;
};

std::string read_file(const std::string& path);
bool file_exists(const std::string& path);
/// Names in a folder, sorted, joined by blanks.
std::string listing(const std::string& folder);

}  // namespace kerf
