#include "twin/cli/stdin_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <regex>
#include <utility>

#include "base/translate.h"

namespace kerf {
namespace {

constexpr std::size_t kHead = 4096;
constexpr int kPatience_ms = 50;

Diagnostic fault(std::string message) {
  Diagnostic d;
  d.file = StdinProgram::kName;
  d.message = std::move(message);
  return d;
}

/// There is something to be read, or its end. False: stopped.
bool wait_for_input(const std::stop_token& stop, short& events) {
  while (!stop.stop_requested()) {
    pollfd wait{STDIN_FILENO, POLLIN, 0};
    if (poll(&wait, 1, kPatience_ms) > 0) {
      events = wait.revents;
      return true;
    }
  }
  return false;
}

/// Of a pipe: what is in it, without taking it out. Waits for a whole line or the end.
std::string head_of_pipe(const std::stop_token& stop) {
  int copy[2];
  if (pipe2(copy, O_CLOEXEC | O_NONBLOCK) != 0) return {};
  std::string head;
  short events = 0;
  while (wait_for_input(stop, events)) {
    const ssize_t got = tee(STDIN_FILENO, copy[1], kHead, SPLICE_F_NONBLOCK);
    if (got <= 0) break;
    head.resize(static_cast<std::size_t>(got));
    const ssize_t taken = read(copy[0], head.data(), head.size());
    head.resize(static_cast<std::size_t>(taken > 0 ? taken : 0));
    if (head.find('\n') != std::string::npos || head.size() >= kHead) break;
    if ((events & POLLHUP) != 0) break;
    usleep(5000);  // the line goes on
  }
  close(copy[0]);
  close(copy[1]);
  return head;
}

std::string head_of_stdin(const std::stop_token& stop) {
  struct stat status {};
  if (fstat(STDIN_FILENO, &status) != 0) return {};
  if (S_ISFIFO(status.st_mode)) return head_of_pipe(stop);
  if (!S_ISREG(status.st_mode)) return {};
  std::string head(kHead, '\0');
  const off_t here = lseek(STDIN_FILENO, 0, SEEK_CUR);
  const ssize_t got = pread(STDIN_FILENO, head.data(), head.size(), here < 0 ? 0 : here);
  head.resize(static_cast<std::size_t>(got > 0 ? got : 0));
  return head;
}

/// All that comes, into the file. Empty, or what went wrong.
std::string spool(int file, const std::stop_token& stop) {
  std::string buffer(std::size_t{1} << 16, '\0');
  std::size_t bytes = 0;
  short events = 0;
  while (wait_for_input(stop, events)) {
    const ssize_t got = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (got == 0) return {};
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return trf("cannot be read: {}", std::strerror(errno));
    bytes += static_cast<std::size_t>(got);
    if (bytes > StdinProgram::kMostBytes) {
      return trf("is longer than {} MB; give such a program as a file",
                 StdinProgram::kMostBytes >> 20);
    }
    for (ssize_t done = 0; done < got;) {
      const ssize_t put = write(file, buffer.data() + done, static_cast<std::size_t>(got - done));
      if (put < 0) return trf("cannot be kept for the interpreter: {}", std::strerror(errno));
      done += put;
    }
  }
  return tr("interrupted while the program was read");
}

}  // namespace

bool is_nc_text(std::string_view head) {
  static const std::regex kListing(R"(^\s*\d+\s*N[.\d]+\s*[A-Z_][A-Z0-9_.]*\()");
  static const std::regex kBlock(
      R"(^\s*/?\s*(%|[(;]|#\s*[<\d]|o\s*[<\d]|[abcdfghijklmnpqrstuvwxyz]\s*[-+.\d#\[]))",
      std::regex::icase);
  bool has_block = false;
  while (!head.empty()) {
    const std::size_t end = head.find('\n');
    // Long lines are cut: matching is by recursion.
    const std::string line(head.substr(0, std::min<std::size_t>(end, 200)));
    if (std::regex_search(line, kListing)) return false;
    has_block = has_block || std::regex_search(line, kBlock);
    if (end == std::string_view::npos) break;
    head.remove_prefix(end + 1);
  }
  return has_block;
}

void StdinProgram::take(std::string& path, Listings listings, const std::stop_token& stop,
                        Diagnostics& diagnostics) {
  if (path != "-") return;
  const std::string head = head_of_stdin(stop);
  const bool nc = is_nc_text(head);
  if (stop.stop_requested() || (!nc && listings == Listings::kStreamed)) return;
  Result<PrivateFolder> folder = PrivateFolder::create();
  if (!folder) {
    diagnostics.push_back(fault(folder.error()));
    return;
  }
  folder_.emplace(std::move(*folder));
  // What could not be looked at tells by its whole text what it is.
  path_ = folder_->path() + (nc ? "/stdin.ngc" : head.empty() ? "/stdin" : "/stdin.canon");
  const int file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const std::string trouble =
      file < 0 ? trf("cannot be kept for the interpreter: {}", std::strerror(errno))
               : spool(file, stop);
  if (file >= 0) close(file);
  if (!nc && stop.stop_requested()) {
    path_.clear();  // nothing of it will be read: a run of it ends at once, with its report
    return;
  }
  if (!trouble.empty()) {
    diagnostics.push_back(fault(trouble));
    return;
  }
  path = path_;
}

std::string StdinProgram::renamed(std::string text) const {
  if (path_.empty()) return text;
  for (std::size_t at = text.find(path_); at != text.npos; at = text.find(path_, at)) {
    text.replace(at, path_.size(), kName);
  }
  return text;
}

}  // namespace kerf
