#include "twin/cli/live_place.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <utility>
#include <variant>

#include "base/translate.h"
#include "machine_io/logs/log_source.h"
#include "twin/cli/live_options.h"
#include "twin/config/make_source.h"
#include "twin/live/live_frame.h"

namespace kerf {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kOneWait{100};
/// So long it has to stand: longer than a corner or a short dwell, shorter than anybody minds.
constexpr double kStill_s = 0.4;
/// What an encoder flickers by is no move.
constexpr double kStill_mm = 0.02;
constexpr double kNsPerSecond = 1e9;

std::int64_t now_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

void fault(std::string message, std::string hint, Diagnostics& diagnostics) {
  diagnostics.push_back(general_error(std::move(message), std::move(hint)));
}

/// A file of positions, which does not wait for any.
const LogSettings* log_file(const LiveConfig& config) {
  const auto* const log = std::get_if<LogSettings>(&config.source);
  if (log == nullptr) return nullptr;
  struct stat status {};
  const bool is_file = stat(log->path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
  return is_file ? log : nullptr;
}

/// When the last line of it was written, ns.
std::int64_t written_ns(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return 0;
  return std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
}

/// Positions as they come, and whether they will do.
class Watch {
 public:
  Watch(LiveFrame frame, double length_mm) : frame_(std::move(frame)), length_mm_(length_mm) {}

  void take(const AxisSample& sample) {
    sample_ = sample;
    const std::int64_t at = now_ns();
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      if ((sample.fresh >> i & 1U) != 0) seen_ns_[i] = at;
    }
    const std::optional<SamplePose> pose = frame_.pose_of(sample, length_mm_);
    if (!pose) {
      place_.reset();
      return;
    }
    const bool moved = !place_ || glm::length(pose->tip_mm - still_at_) > kStill_mm;
    if (moved) {
      still_at_ = pose->tip_mm;
      still_since_ = Clock::now();
    }
    place_ = pose->tip_mm;
  }
  bool has_place() const { return place_.has_value(); }
  const Vec3& place_mm() const { return *place_; }
  int tool() const { return sample_.tool; }
  std::string missing() const { return frame_.missing_axes(sample_); }
  std::int64_t host_ns() const { return sample_.host_ns; }
  /// Of the oldest of the positions that make the place, s.
  double age_s() const {
    std::int64_t oldest = now_ns();
    const LiveFrameOptions& options = frame_.options();
    for (std::size_t i = 0; i < kMaxPositions; ++i) {
      const bool counts =
          options.kinematics ? sample_.has(i) : options.axis[i] >= 0 && options.axis[i] < 3;
      if (counts && sample_.has(i)) oldest = std::min(oldest, seen_ns_[i]);
    }
    return static_cast<double>(now_ns() - oldest) / kNsPerSecond;
  }
  bool stands() const {
    return std::chrono::duration<double>(Clock::now() - still_since_).count() >= kStill_s;
  }

 private:
  LiveFrame frame_;
  double length_mm_;
  AxisSample sample_;
  std::array<std::int64_t, kMaxPositions> seen_ns_{};
  std::optional<Vec3> place_;
  Vec3 still_at_{0};
  Clock::time_point still_since_;
};

EntryLive live_of(const Watch& watch, const PositionSource& source, double age_s) {
  return {source.describe(), watch.place_mm(), age_s, watch.tool()};
}

/// The machine may have been moved since a log was written: an old one says nothing of now.
std::optional<EntryLive> end_of_log(const LogSettings& log, double stale_s, Watch& watch,
                                    PositionSource& source, std::stop_token stop,
                                    Diagnostics& diagnostics) {
  AxisSample sample;
  while (!stop.stop_requested()) {
    const PositionSource::Next next = source.next(sample, kOneWait);
    if (next == PositionSource::Next::kEnd) break;
    if (next == PositionSource::Next::kSample) watch.take(sample);
  }
  if (stop.stop_requested()) return std::nullopt;
  if (!watch.has_place()) {
    fault(trf("--at live: {} does not say where {} is", source.describe(), watch.missing()), {},
          diagnostics);
    return std::nullopt;
  }
  const auto* const reader = dynamic_cast<const LogSource*>(&source);
  const bool has_clock = reader != nullptr && reader->contents().recording.has_value();
  const std::int64_t at = has_clock ? watch.host_ns() : written_ns(log.path);
  const double age_s = std::max(0.0, static_cast<double>(now_ns() - at) / kNsPerSecond);
  if (age_s <= stale_s) return live_of(watch, source, age_s);
  const Vec3 p = watch.place_mm();
  fault(trf("--at live: the last position of {} is {:.0f} s old; at most {:g} s are allowed "
            "(source.stale_after_ms)",
            source.describe(), age_s, stale_s),
        trf("if it still stands there: --at {:.3f},{:.3f},{:.3f}", p.x, p.y, p.z), diagnostics);
  return std::nullopt;
}

std::string why_not(const Watch& watch, bool any, double stale_s, const PositionSource& source) {
  const std::string who = source.describe();
  const auto patience = kPatience.count();
  if (!any) {
    const std::string& trouble = source.status().trouble;
    return trf("--at live: no position of {} has come within {} s", who, patience) +
           (trouble.empty() ? "" : ": " + trouble);
  }
  if (!watch.has_place())
    return trf("--at live: {} does not say where {} is", who, watch.missing());
  if (watch.age_s() > stale_s) {
    return trf(
        "--at live: the last position of {} is {:.1f} s old; at most {:g} s are allowed "
        "(source.stale_after_ms)",
        who, watch.age_s(), stale_s);
  }
  return trf("--at live: by {} the machine has not stood still within {} s", who, patience);
}

std::optional<EntryLive> watch_machine(double stale_s, Watch& watch, PositionSource& source,
                                       std::stop_token stop, Diagnostics& diagnostics) {
  bool any = false;
  AxisSample sample;
  for (const auto until = Clock::now() + kPatience; Clock::now() < until;) {
    if (stop.stop_requested()) return std::nullopt;
    const PositionSource::Next next = source.next(sample, kOneWait);
    if (next == PositionSource::Next::kEnd) break;
    if (next != PositionSource::Next::kSample) continue;
    any = true;
    watch.take(sample);
    if (!watch.has_place() || !watch.stands()) continue;
    if (const double age_s = watch.age_s(); age_s <= stale_s) return live_of(watch, source, age_s);
  }
  fault(why_not(watch, any, stale_s, source), tr("--at X,Y,Z says it by hand"), diagnostics);
  return std::nullopt;
}

std::optional<EntryLive> find_place(LiveRequest& request, const EntryFrame& there,
                                    std::stop_token stop, Diagnostics& diagnostics) {
  const std::unique_ptr<PositionSource> source = make_source(request.config, diagnostics);
  if (source == nullptr) return std::nullopt;
  Diagnostics told;  // of the work offset, which is the program's here
  choose_frame(request, *source, told);
  LiveFrameOptions& options = request.options.cutting.frame;
  const bool knows_work = request.config.machine.work_offset || !request.parameter_path.empty();
  if (!options.workpiece_frame && !knows_work) {
    fault(tr("--at live: where the workpiece lies in the machine is not known"),
          tr("--ini reads it from the machine's parameter file; --work-offset X,Y,Z gives it"),
          diagnostics);
    return std::nullopt;
  }
  options.work = there.work;
  // It is asked where the program would have its own tool, whatever is in the spindle now.
  options.tool_length = ToolLengthFrom::kProgram;
  Watch watch(LiveFrame(options), there.tool_length_mm);
  const double stale_s = request.config.common.stale_after_s;
  if (const LogSettings* const log = log_file(request.config)) {
    return end_of_log(*log, stale_s, watch, *source, stop, diagnostics);
  }
  return watch_machine(stale_s, watch, *source, stop, diagnostics);
}

}  // namespace

EntryPlaceFinder live_place_finder(const Arguments& arguments, Diagnostics& diagnostics) {
  // What a watch of this machine would be told of it, and nothing else.
  Arguments watching;
  watching.command = kShadow;
  watching.words = arguments.words;
  for (const char* const option : {"--config", "--ini", "--work-offset", "--units"}) {
    if (arguments.options.has(option)) {
      watching.options.set(option, arguments.options.text(option));
    }
  }
  watching.options.set_all("--set", arguments.options.texts("--set"));
  watching.options.set_flag("--no-view");
  Diagnostics told;
  auto request = std::make_shared<LiveRequest>(understand_live(watching, told));
  const bool is_faulty = has_error(told);
  // `kerf run` has told of the rest by itself.
  if (is_faulty && !has_error(diagnostics)) {
    for (Diagnostic& d : told) {
      if (d.severity == Severity::kError) diagnostics.push_back(std::move(d));
    }
  }
  if (!is_faulty && std::holds_alternative<std::monostate>(request->config.source)) {
    fault(tr("--at live: there is no source of positions"),
          tr("-c FILE with source.type, or --set source.type=hal"), diagnostics);
  }
  return [request](const EntryFrame& there, std::stop_token stop, Diagnostics& out) {
    return find_place(*request, there, stop, out);
  };
}

}  // namespace kerf
