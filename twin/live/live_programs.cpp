#include "twin/live/live_programs.h"

#include <utility>

#include "twin/live/program_duration.h"

namespace kerf {

bool LivePrograms::open(const ProgramOptions& first, Diagnostics& diagnostics) {
  options_ = first;
  if (first.path == "-") {
    followed_ = Program::open(first, diagnostics);
    first_ = followed_.get();
    return first_ != nullptr;
  }
  readings_.push_back(ProgramReadings::open(first, diagnostics));
  if (!readings_[0]) return false;
  first_ = &readings_[0]->source();
  return true;
}

bool LivePrograms::start(const KnownTools& tools, std::span<const std::string> others,
                         Diagnostics& diagnostics) {
  if (followed_) followed_->give_tools(tools);
  readings_.resize(1);
  for (const std::string& path : others) {
    ProgramOptions other = options_;
    other.path = path;
    readings_.push_back(std::make_shared<ProgramReadings>(std::move(other)));
  }
  for (const std::shared_ptr<ProgramReadings>& readings : readings_) {
    if (readings) readings->give_tools(tools);
    const std::size_t i = all_.size();
    ShiftProgram& program =
        all_.emplace_back(ShiftProgram{i == 0 ? options_.path : others[i - 1], {}});
    if (!readings) continue;
    program.open = [readings](const ProgramStart& start) {
      Diagnostics ignored;
      return readings->reader(start.value_or(ProgramReadings::Start{}), ignored);
    };
  }
  total_s_ = std::vector<std::atomic<double>>(all_.size());
  for (std::atomic<double>& total_s : total_s_) total_s = -1;
  if (!followed_) followed_ = read(diagnostics);
  return followed_ != nullptr;
}

std::unique_ptr<Program> LivePrograms::read(Diagnostics& diagnostics) const {
  return readings_[0]->reader(options_.machine.start, diagnostics);
}

void LivePrograms::measure(const TimelineOptions& timeline, std::stop_token stop) {
  for (std::size_t i = 0; i < all_.size() && !stop.stop_requested(); ++i) {
    if (!all_[i].open) continue;
    const std::unique_ptr<Program> opened = all_[i].open({});
    if (opened) total_s_[i] = program_duration_s(*opened, timeline, stop);
  }
}

}  // namespace kerf
