#include "twin/batch/result_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <utility>

#include "base/atomic_file.h"
#include "base/translate.h"

namespace kerf {
namespace {

Error write_fault(const std::string& path, int error) {
  return Error{trf("writing {}: {}", path, std::strerror(error))};
}

}  // namespace

std::vector<BatchResult> parse_results(std::string_view text, bool& damaged) {
  std::vector<BatchResult> results;
  std::map<std::string, std::size_t> place;
  damaged = false;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::optional<BatchResult> result;
    if (end != text.npos) result = result_of_line(text.substr(0, end));
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (!result) {
      damaged = true;
      continue;
    }
    const auto [at, is_new] = place.emplace(result->program, results.size());
    if (is_new) {
      results.push_back(std::move(*result));
    } else {
      results[at->second] = std::move(*result);
    }
  }
  return results;
}

Result<ResultLog> ResultLog::open(const std::string& path, const std::vector<BatchResult>& results,
                                  bool as_it_is) {
  if (!as_it_is) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return Error{file.error()};
    for (const BatchResult& result : results) {
      const std::string line = line_of(result);
      file->write(line.data(), line.size());
    }
    if (const Done done = file->commit(); !done) return Error{done.error()};
  }
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (fd < 0) return write_fault(path, errno);
  return ResultLog(path, fd);
}

ResultLog::ResultLog(ResultLog&& other) noexcept
    : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}

ResultLog::~ResultLog() {
  if (fd_ >= 0) close(fd_);
}

Done ResultLog::append(const BatchResult& result) {
  const std::string line = line_of(result);
  const off_t before = lseek(fd_, 0, SEEK_END);
  std::size_t written = 0;
  int error = 0;
  while (error == 0 && written < line.size()) {
    const ssize_t got = write(fd_, line.data() + written, line.size() - written);
    if (got > 0) {
      written += static_cast<std::size_t>(got);
    } else if (got == 0 || errno != EINTR) {
      error = got == 0 ? ENOSPC : errno;
    }
  }
  if (error == 0 && fdatasync(fd_) != 0 && errno != EINVAL) error = errno;
  if (error == 0) return std::monostate{};
  // Should this fail as well: parse_results() passes over what is left of the line.
  if (before >= 0 && ftruncate(fd_, before) != 0) error = errno;
  return write_fault(path_, error);
}

}  // namespace kerf
