#include "base/print.h"

#include <atomic>
#include <cerrno>
#include <cstring>

#include "base/exit_code.h"
#include "base/translate.h"

namespace kerf {
namespace {

/// The first trouble of stdout and of stderr, errno; 0: none.
std::atomic<int> g_trouble[2];

std::atomic<int>& trouble_of(std::FILE* stream) { return g_trouble[stream == stderr ? 1 : 0]; }

void note(std::FILE* stream, int error) {
  int none = 0;
  trouble_of(stream).compare_exchange_strong(none, error != 0 ? error : EIO);
  std::clearerr(stream);
}

bool is_lost(int error) { return error != 0 && error != EPIPE; }

}  // namespace

void print_text(std::FILE* stream, std::string_view text) {
  if (trouble_of(stream) != 0 || text.empty()) return;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream) != text.size()) note(stream, errno);
}

void flush_console() {
  for (std::FILE* const stream : {stdout, stderr}) {
    errno = 0;
    if (std::fflush(stream) != 0) note(stream, errno);
  }
}

int end_console(int exit_code) {
  flush_console();
  const int out = trouble_of(stdout), err = trouble_of(stderr);
  if (is_lost(out)) {
    print_text(stderr, trf("kerf: error: standard output: {}\n", std::strerror(out)));
  }
  return is_lost(out) || is_lost(err) ? static_cast<int>(kExitFailure) : exit_code;
}

}  // namespace kerf
