#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <utility>

#include "base/translate.h"
#include "interp_bridge/canonical_reader.h"
#include "interp_bridge/program_kinds.h"

namespace kerf {
namespace {

class ListingProgram final : public Program {
 public:
  ListingProgram(const ProgramOptions& options, std::vector<int> tool_by_index, TextSurvey survey,
                 TorchRun torch)
      : options_(options),
        tool_by_index_(std::move(tool_by_index)),
        survey_(std::move(survey)),
        torch_(std::move(torch)) {}

  const std::vector<ProgramComment>& comments() const override { return survey_.comments; }
  ProgramSummary run(const MotionSink& sink, std::stop_token stop,
                     Diagnostics& diagnostics) override;
  double progress() const override {
    if (is_stdin()) return -1;
    return static_cast<double>(bytes_read_) / static_cast<double>(survey_.bytes);
  }

 private:
  bool is_stdin() const { return options_.path == "-"; }
  std::string name() const { return is_stdin() ? "stdin" : options_.path; }
  bool read_all(int fd, CanonicalReader& reader, const std::stop_token& stop,
                Diagnostics& diagnostics);
  void report(Severity severity, std::string message, std::string hint,
              Diagnostics& diagnostics) const;

  ProgramOptions options_;
  std::vector<int> tool_by_index_;
  TextSurvey survey_;
  TorchRun torch_;
  std::atomic<std::uint64_t> bytes_read_{0};
};

void ListingProgram::report(Severity severity, std::string message, std::string hint,
                            Diagnostics& diagnostics) const {
  Diagnostic diagnostic;
  diagnostic.severity = severity;
  diagnostic.file = name();
  diagnostic.message = std::move(message);
  diagnostic.hint = std::move(hint);
  diagnostics.push_back(std::move(diagnostic));
}

/// False: stopped before the end.
bool ListingProgram::read_all(int fd, CanonicalReader& reader, const std::stop_token& stop,
                              Diagnostics& diagnostics) {
  while (!stop.stop_requested()) {
    pollfd wait{fd, POLLIN, 0};
    const int ready = poll(&wait, 1, kReaderPatience_ms);
    if (ready == 0) {
      if (!reader.feeder().flush_if_old()) return false;
      continue;
    }
    const std::span<char> room = reader.room();
    const ssize_t got = ready < 0 ? -1 : read(fd, room.data(), room.size());
    if (got == 0) return true;
    if (got < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      report(Severity::kError, trf("cannot be read: {}", std::strerror(errno)), {}, diagnostics);
      return true;
    }
    bytes_read_ += static_cast<std::uint64_t>(got);
    if (!reader.received(static_cast<std::size_t>(got))) return false;
  }
  return false;
}

ProgramSummary ListingProgram::run(const MotionSink& sink, std::stop_token stop,
                                   Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  ProgramSummary summary;
  summary.files = files_ = {name()};
  summary.interpreter = "canon";
  const int fd = is_stdin() ? STDIN_FILENO : ::open(options_.path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) {
    report(Severity::kError, trf("cannot be read: {}", std::strerror(errno)), {}, diagnostics);
    return summary;
  }
  CanonicalReaderOptions reading;
  reading.listing_name = name();
  reading.feeder.tool_by_index = tool_by_index_;
  // A file has an end; a pipe may have none.
  const std::uint64_t limit =
      is_stdin() ? command_limit(options_, 0) : options_.max_commands.value_or(0);
  reading.feeder.max_commands = limit;
  reading.feeder.frame = &frame_;
  reading.feeder.torch = torch_;
  reading.feeder.signals = options_.signals;
  reading.feeder.places.has_blocks = false;
  reading.feeder.follows_probes = follows_probes_;
  reading.feeder.no_answer = tr("a listing was written without a workpiece");
  reading.feeder.materials = &materials_;
  CanonicalReader reader(std::move(reading), sink, summary, diagnostics);
  const bool complete = read_all(fd, reader, stop, diagnostics);
  if (!is_stdin()) close(fd);
  reader.finish();
  summary.stopped_early = !complete;
  summary.program_lines = static_cast<std::size_t>(reader.listing_lines());
  if (reader.feeder().too_many_commands()) {
    report(Severity::kError,
           trf("more than {} canonical commands; the program counts as endless", limit), {},
           diagnostics);
  } else if (complete && reader.commands() == 0) {
    const bool empty = reader.listing_lines() == 0;
    report(Severity::kError,
           empty ? tr("is empty; canonical text of rs274 is expected")
                 : tr("no line of it is a canonical command of rs274"),
           tr("rs274 -v /nonexistent/x.var -g part.ngc | kerf run -"), diagnostics);
  } else if (complete && !summary.has_program_end) {
    summary.end_remarked = true;
    report(Severity::kWarning,
           tr("the listing has no program end (PROGRAM_END or FINISH): the program has none, or an "
              "error stopped rs274"),
           {}, diagnostics);
  }
  const auto end = std::chrono::steady_clock::now();
  summary.interpret_s = std::chrono::duration<double>(end - begin).count();
  return summary;
}

}  // namespace

std::unique_ptr<Program> make_listing_program(const ProgramOptions& options,
                                              std::vector<int> tool_by_index, TextSurvey survey,
                                              TorchRun torch) {
  return std::make_unique<ListingProgram>(options, std::move(tool_by_index), std::move(survey),
                                          std::move(torch));
}

}  // namespace kerf
