#include "twin/live/program_duration.h"

#include <cstddef>
#include <span>

namespace kerf {
namespace {

/// Its own plan of a program, for the sum alone.
class DurationSink : public StepSink {
  void step(const Motion&, const TimedStep&, std::span<const PathPiece>) override {}
};

}  // namespace

double program_duration_s(Program& program, TimelineOptions timing, const std::stop_token& stop) {
  Diagnostics ignored;
  DurationSink sink;
  timing.planner.with_path = false;
  Timeline timeline(timing, sink);
  std::size_t materials = 0;
  program.run(
      [&](std::span<const Motion> motions) {
        if (program.materials().size() != materials) {
          materials = program.materials().size();
          timeline.set_materials(program.materials());
        }
        for (const Motion& m : motions) timeline.push(m);
        return true;
      },
      stop, ignored);
  if (stop.stop_requested()) return -1;
  timeline.finish();
  return timeline.clock_s();
}

}  // namespace kerf
