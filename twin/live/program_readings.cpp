#include "twin/live/program_readings.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace kerf {
namespace {

std::unique_ptr<Program> open_program(const ProgramOptions& options, const KnownTools& tools,
                                      Diagnostics& diagnostics) {
  std::unique_ptr<Program> opened = Program::open(options, diagnostics);
  if (opened) opened->give_tools(tools);
  return opened;
}

std::int64_t now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace

ProgramReadings::Stamp ProgramReadings::stamp_of(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) != 0) return {path};
  return {path, info.st_mtim.tv_sec * 1'000'000'000 + info.st_mtim.tv_nsec, info.st_size};
}

/// Of the files that are known beforehand.
std::vector<ProgramReadings::Stamp> ProgramReadings::stamps() const {
  std::vector<Stamp> out;
  for (const std::string* path :
       {&options_.path, &options_.tool_table_path, &options_.machine.ini_path,
        &options_.machine.parameter_path, &options_.torch.materials_path}) {
    if (!path->empty()) out.push_back(stamp_of(*path));
  }
  return out;
}

/// Nothing that was read has changed since.
bool ProgramReadings::is_fresh(const Known& known) const {
  if (stamps() != known.stamps) return false;
  const std::vector<std::string> files = known.reading->files();
  return std::all_of(files.begin(), files.end(), [&](const std::string& path) {
    return stamp_of(path).changed_ns <= known.opened_ns;
  });
}

ProgramReadings::Known ProgramReadings::open(const Start& start, Diagnostics& diagnostics) const {
  ProgramOptions options = options_;
  options.machine.start = start;
  Known known{start, stamps(), now_ns(), nullptr};
  std::unique_ptr<Program> program = open_program(options, tools_, diagnostics);
  if (!program) return known;
  known.reading = SharedReading::of(std::move(program), [options, tools = tools_] {
    Diagnostics ignored;
    return open_program(options, tools, ignored);
  });
  return known;
}

std::shared_ptr<ProgramReadings> ProgramReadings::open(const ProgramOptions& options,
                                                       Diagnostics& diagnostics) {
  auto readings = std::make_shared<ProgramReadings>(options);
  Known first = readings->open(options.machine.start, diagnostics);
  if (!first.reading) return nullptr;
  readings->first_ = first.reading;
  readings->known_.push_back(std::move(first));
  return readings;
}

void ProgramReadings::give_tools(const KnownTools& tools) {
  tools_ = tools;
  if (first_) first_->source().give_tools(tools);
}

std::unique_ptr<Program> ProgramReadings::reader(const Start& start, Diagnostics& diagnostics) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& one) { return one.start == start; });
  if (known != known_.end()) {
    std::unique_ptr<Program> reader = is_fresh(*known) ? known->reading->reader() : nullptr;
    if (reader) return reader;
    known_.erase(known);
  }
  Known opened = open(start, diagnostics);
  if (!opened.reading) return nullptr;
  std::erase_if(known_, [&](const Known& one) {
    const bool is_own = one.start == options_.machine.start;
    return is_own == (start == options_.machine.start);
  });
  known_.push_back(opened);
  return opened.reading->reader();
}

}  // namespace kerf
