#include "twin/optimize/feed_trace.h"

#include <bit>
#include <concepts>
#include <memory>
#include <span>

#include "interp_bridge/motion_kinds.h"
#include "twin/job/tools.h"
#include "twin/motion/motion_geometry.h"
#include "twin/program/session_parts.h"

namespace kerf {
namespace {

/// Bits, stirred (the mixer of splitmix64).
class Print {
 public:
  void add(std::uint64_t bits) {
    value_ += 0x9e3779b97f4a7c15 + bits;
    value_ = (value_ ^ (value_ >> 30)) * 0xbf58476d1ce4e5b9;
    value_ = (value_ ^ (value_ >> 27)) * 0x94d049bb133111eb;
    value_ ^= value_ >> 31;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  void add(const std::array<double, 3>& values) {
    for (const double value : values) add(value);
  }
  template <std::integral Whole>
  void add(Whole value) requires(!std::same_as<Whole, std::uint64_t>) {
    add(static_cast<std::uint64_t>(value));
  }
  template <class Word>
  void add(Word value) requires std::is_enum_v<Word> {
    add(static_cast<std::uint64_t>(value));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

void add_torch(const TorchState& torch, Print& print) {
  print.add(torch.outputs);
  for (const float value : torch.analog) print.add(double{value});
  print.add(torch.spindles_on);
  print.add(torch.adaptive_feed);
  print.add(torch.material);
}

}  // namespace

std::uint64_t print_of(const Motion& m) {
  Print print;
  print.add(m.kind);
  print.add(m.spindle);
  for (const bool flag : {m.flood, m.mist, m.feed_per_rev, m.compensated, m.start_known,
                          m.to_machine_place, m.rapid, m.by_number})
    print.add(flag);
  print.add(m.path_mode);
  print.add(m.unknown_from);
  print.add(m.unknown_to);
  print.add(m.user_m);
  print.add(m.halts);
  print.add(m.tool);
  print.add(m.selected_tool);
  print.add(m.from_mm);
  print.add(m.to_mm);
  print.add(m.from_abc_deg);
  print.add(m.to_abc_deg);
  print.add(m.from_uvw_mm);
  print.add(m.to_uvw_mm);
  if (m.kind == MotionKind::kArc) {
    print.add(m.arc.center_mm);
    print.add(m.arc.axis);
    print.add(m.arc.sweep_rad);
  }
  print.add(m.tool_offset_mm);
  print.add(m.tool_offset_uvw_mm);
  print.add(m.spindle_rpm);
  print.add(m.surface.mm_per_min);
  print.add(m.duration_s);
  print.add(double{m.blend_tolerance_mm});
  print.add(double{m.merge_tolerance_mm});
  add_torch(m.torch, print);
  return print.value();
}

FeedTrace read_trace(const SessionOptions& options, std::stop_token stop,
                     Diagnostics& diagnostics) {
  FeedTrace trace;
  const std::unique_ptr<Program> program = Program::open(options.program, diagnostics);
  if (!program) return trace;
  ToolSources tools;
  Diagnostics told_already;
  if (!gather_tool_sources(options.tools, options.libraries, program.get(), options.program, tools,
                           told_already))
    return trace;
  program->give_tools(known_tools(tools));
  const auto take = [&trace](std::span<const Motion> motions) {
    for (const Motion& m : motions) {
      const bool goes = !stands_still(m) || !m.start_known;
      const bool is_fed = goes && (is_feed(m) || m.kind == MotionKind::kProbe);
      trace.motions.push_back(
          {print_of(m), m.source, m.kind, is_fed ? m.feed_mm_per_min : 0, m.from_mm, m.to_mm});
    }
    return true;
  };
  const ProgramSummary summary = program->run(take, stop, diagnostics);
  trace.is_listing = summary.interpreter == "canon";
  trace.is_whole = !summary.stopped_early && !has_error(diagnostics);
  return trace;
}

}  // namespace kerf
