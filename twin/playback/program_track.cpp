#include "twin/playback/program_track.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/motion/motion_geometry.h"
#include "twin/motion/motion_nearest.h"

namespace kerf {
namespace {

Vec3 read(const std::array<PackedColumn, 3>& columns, std::size_t i) {
  return {columns[0].real_at(i), columns[1].real_at(i), columns[2].real_at(i)};
}

std::array<double, 3> read_angles(const std::array<PackedColumn, 3>& columns, std::size_t i) {
  return {columns[0].real_at(i), columns[1].real_at(i), columns[2].real_at(i)};
}

/// The largest share of a way that is not all of it.
constexpr double kNotDone = 1 - 0x1p-53;

/// Equal bits: a program's -0 stays one.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool continues(const Motion& motion, const Motion& previous) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    if (!same_bits(motion.from_mm[axis], previous.to_mm[axis])) return false;
    if (!same_bits(motion.from_abc_deg[index], previous.to_abc_deg[index])) return false;
    if (!same_bits(motion.from_uvw_mm[axis], previous.to_uvw_mm[axis])) return false;
  }
  return true;
}

/// Small differences lie close to it on both sides.
constexpr std::uint64_t kNoChange = std::uint64_t{1} << 63;

std::uint64_t line_key(SourceRef source) { return std::uint64_t{source.file} << 32 | source.line; }

}  // namespace

const ProgramTrack::Jump* ProgramTrack::jump_at(std::size_t i) const {
  const auto found =
      std::lower_bound(jumps_.begin(), jumps_.end(), i,
                       [](const Jump& jump, std::size_t motion) { return jump.motion < motion; });
  return found != jumps_.end() && found->motion == i ? &*found : nullptr;
}

Vec3 ProgramTrack::to_mm(std::size_t i) const { return read(to_mm_, i); }

Vec3 ProgramTrack::from_mm(std::size_t i) const {
  if (const Jump* jump = jump_at(i)) return jump->from_mm;
  return i == 0 ? Vec3{0} : to_mm(i - 1);
}

SourceRef ProgramTrack::source(std::size_t i) const {
  return {mode_of(i).source.file, static_cast<std::uint32_t>(line_.at(i))};
}

Motion ProgramTrack::motion(std::size_t i) const {
  Motion m = mode_of(i);
  m.source.line = static_cast<std::uint32_t>(line_.at(i));
  m.to_mm = to_mm(i);
  m.to_abc_deg = read_angles(to_abc_deg_, i);
  m.to_uvw_mm = read(to_uvw_mm_, i);
  if (const Jump* jump = jump_at(i)) {
    m.from_mm = jump->from_mm;
    m.from_abc_deg = jump->from_abc_deg;
    m.from_uvw_mm = jump->from_uvw_mm;
  } else if (i > 0) {
    m.from_mm = to_mm(i - 1);
    m.from_abc_deg = read_angles(to_abc_deg_, i - 1);
    m.from_uvw_mm = read(to_uvw_mm_, i - 1);
  }
  m.arc.center_mm = read(arc_center_mm_, i);
  m.arc.sweep_rad = arc_sweep_rad_.real_at(i);
  m.feed_mm_per_min = feed_.real_at(i);
  m.spindle_rpm = spindle_rpm_.real_at(i);
  m.selected_tool = static_cast<int>(static_cast<std::uint32_t>(selected_tool_.at(i)));
  const std::uint64_t selected_at = selected_at_.at(i);
  m.selected_at = {static_cast<std::uint32_t>(selected_at >> 32),
                   static_cast<std::uint32_t>(selected_at)};
  return m;
}

bool ProgramTrack::is_traverse(std::size_t i) const { return kerf::is_traverse(mode_of(i)); }

CutMove ProgramTrack::cut_move(std::size_t i) const {
  CutMove move;
  move.from_mm = from_mm(i);
  move.to_mm = to_mm(i);
  move.id = i;
  const Motion& mode = mode_of(i);
  if (mode.kind == MotionKind::kArc) {
    move.arc = CutArc{read(arc_center_mm_, i), mode.arc.axis, arc_sweep_rad_.real_at(i)};
  }
  if (mode.kind == MotionKind::kThread) move.lead_mm = lead_mm_of(motion(i));
  return move;
}

void ProgramTrack::append_moves(std::size_t i, const MotionMoves& moves, const Cutter& cutter,
                                std::vector<CutMove>& out) const {
  if (moves.ordered() != nullptr) {
    append_part(i, 1, moves, cutter, out);
  } else if (moves.path() == nullptr && moves.live_path(cutter) == nullptr) {
    out.push_back(cut_move(i));
  } else {
    moves.append(motion(i), cutter, i, out);
  }
}

void ProgramTrack::append_part(std::size_t i, double fraction, const MotionMoves& moves,
                               const Cutter& cutter, std::vector<CutMove>& out) const {
  if (const OrderedMoves* const ordered = moves.ordered()) {
    ordered->append(
        i, [this](std::size_t n) { return motion(n); }, fraction, cutter, i, out);
    return;
  }
  Motion m = motion(i);
  if (fraction < 1) m = part_of(m, 0, fraction);
  moves.append(m, cutter, i, out);
}

TimedStep ProgramTrack::step(std::size_t i) const {
  TimedStep step;
  step.start_s = start_s(i);
  step.duration_s = motion_s(i);
  step.programmed_mm_per_min = programmed_.real_at(i);
  step.allowed_mm_per_min = allowed_.real_at(i);
  step.way = way(i);
  const Motion m = motion(i);
  if (is_move(m) && m.start_known) step.length_mm = fed_length_mm(m);
  return step;
}

double ProgramTrack::motion_s(std::size_t i) const {
  const double until_next_s = i + 1 < size() ? start_s(i + 1) - start_s(i) : 0;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(until_next_s) + duration_change_.at(i) -
                               kNoChange);
}

TrackPosition ProgramTrack::place_before(std::size_t i) const {
  return {i, 0, i < size() ? start_s(i) : duration_s()};
}

TrackPosition ProgramTrack::place_at(double time_s) const {
  std::size_t first = 0;
  std::size_t count = size();
  while (count > 0) {  // the first motion that starts later
    const std::size_t half = count / 2;
    if (start_s(first + half) <= time_s) {
      first += half + 1;
      count -= half + 1;
    } else {
      count = half;
    }
  }
  if (first == 0) return place_before(0);
  const std::size_t motion = first - 1;
  const double start = start_s(motion);
  const double duration = motion_s(motion);
  if (duration <= 0 || time_s - start >= duration) {
    return {motion + 1, 0, std::min(time_s, duration_s())};
  }
  // All of its way may be done before its time is: it is on it until the next one begins.
  const double done = way(motion).way_of((time_s - start) / duration);
  return {motion, std::min(done, kNotDone), time_s};
}

std::size_t ProgramTrack::line_lower_bound(SourceRef line, std::size_t motion) const {
  const std::pair<std::uint64_t, std::size_t> key(line_key(line), motion);
  std::size_t first = 0;
  for (std::size_t count = lines_.size(); count > 0;) {
    const std::size_t half = count / 2;
    const std::size_t block = motion_of_line(first + half);
    if (std::pair(line_key(source(block)), block) < key) {
      first += half + 1;
      count -= half + 1;
    } else {
      count = half;
    }
  }
  return first;
}

std::optional<std::size_t> ProgramTrack::first_of_line(SourceRef line, std::size_t from) const {
  // Within a block the next motion of its line may be `from` itself.
  if (from < size() && source(from) == line) return from;
  const std::size_t at = line_lower_bound(line, from);
  if (at == lines_.size() || source(motion_of_line(at)) != line) return std::nullopt;
  return motion_of_line(at);
}

std::optional<SourceRef> ProgramTrack::line_with_motions(SourceRef line) const {
  const std::size_t at = line_lower_bound(line, 0);
  if (at == lines_.size()) return std::nullopt;
  const SourceRef found = source(motion_of_line(at));
  if (found.file != line.file) return std::nullopt;
  return found;
}

std::size_t ProgramTrack::next_block(std::size_t i) const {
  const std::size_t n = size();
  for (std::size_t at = i + 1; at < n;) {
    const std::uint64_t bits = block_start_[at / 64] >> (at % 64);
    if (bits != 0) return at + static_cast<std::size_t>(std::countr_zero(bits));
    at = (at / 64 + 1) * 64;
  }
  return n;
}

std::size_t ProgramTrack::previous_block(std::size_t i) const {
  std::size_t end = std::min(i, size());  // looked for below this one
  while (end > 0) {
    const std::size_t word = (end - 1) / 64;
    const std::size_t used = end - word * 64;
    const std::uint64_t bits = block_start_[word] << (64 - used);
    if (bits != 0) return end - 1 - static_cast<std::size_t>(std::countl_zero(bits));
    end = word * 64;
  }
  return 0;
}

std::optional<std::size_t> ProgramTrack::next_tool_change(std::size_t i) const {
  const auto found = std::upper_bound(tool_changes_.begin(), tool_changes_.end(), i);
  if (found == tool_changes_.end()) return std::nullopt;
  return *found;
}

std::optional<std::size_t> ProgramTrack::previous_tool_change(std::size_t i) const {
  const auto found = std::lower_bound(tool_changes_.begin(), tool_changes_.end(), i);
  if (found == tool_changes_.begin()) return std::nullopt;
  return *(found - 1);
}

std::size_t ProgramTrack::bytes() const {
  std::size_t sum = sizeof *this;
  for (const auto* columns : {&to_mm_, &to_abc_deg_, &to_uvw_mm_, &arc_center_mm_}) {
    for (const PackedColumn& column : *columns) sum += column.bytes() - sizeof column;
  }
  for (const PackedColumn* column :
       {&arc_sweep_rad_, &feed_, &spindle_rpm_, &start_s_, &duration_change_, &programmed_,
        &allowed_, &line_, &lines_, &selected_tool_, &selected_at_, &mode_, &way_}) {
    sum += column->bytes() - sizeof *column;
  }
  sum += modes_.capacity() * sizeof(Motion) + jumps_.capacity() * sizeof(Jump);
  sum += ways_.capacity() * sizeof(PackedWay);
  sum += block_start_.capacity() * sizeof(std::uint64_t);
  return sum + tool_changes_.capacity() * sizeof(std::uint32_t);
}

ProgramTrackBuilder::ProgramTrackBuilder() : track_(new ProgramTrack) {}

ProgramTrackBuilder::ModeKey ProgramTrackBuilder::key_of(const Motion& m) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::uint64_t flags =
      static_cast<std::uint64_t>(m.kind) | static_cast<std::uint64_t>(m.spindle) << 8 |
      static_cast<std::uint64_t>(m.path_mode) << 16 | std::uint64_t{m.flood} << 24 |
      std::uint64_t{m.mist} << 25 | std::uint64_t{m.feed_per_rev} << 26 |
      std::uint64_t{m.start_known} << 27 | std::uint64_t{m.user_m} << 28 |
      std::uint64_t{m.rapid} << 36 | std::uint64_t{m.unknown_from} << 37 |
      std::uint64_t{m.unknown_to} << 40 | std::uint64_t{m.to_machine_place} << 43 |
      std::uint64_t{m.speed_said} << 44 | std::uint64_t{m.compensated} << 45;
  const std::uint64_t stops =
      std::uint64_t{m.halts} | std::uint64_t{m.io_halts} << 8 |
      static_cast<std::uint64_t>(m.chain_end) << 16 |
      static_cast<std::uint64_t>(m.tool_prepare) << 24 | std::uint64_t{m.by_number} << 32 |
      std::uint64_t{m.table_reloaded} << 33 | std::uint64_t{m.length.displaces} << 34;
  const std::uint64_t tool = static_cast<std::uint32_t>(m.tool);
  const auto floats = [](float a, float b) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b);
  };
  return {flags,
          stops,
          tool << 32 | m.source.file,
          floats(m.blend_tolerance_mm, m.merge_tolerance_mm),
          bits(m.duration_s),
          bits(m.surface.mm_per_min),
          bits(m.surface.max_rpm),
          bits(m.surface.axis_x_mm),
          bits(m.tool_offset_mm.x),
          bits(m.tool_offset_mm.y),
          bits(m.tool_offset_mm.z),
          bits(m.tool_offset_uvw_mm.x),
          bits(m.tool_offset_uvw_mm.y),
          bits(m.tool_offset_uvw_mm.z),
          bits(m.arc.axis.x),
          bits(m.arc.axis.y),
          bits(m.arc.axis.z),
          m.torch.outputs,
          floats(m.torch.analog[0], m.torch.analog[1]),
          floats(m.torch.analog[2], m.torch.analog[3]),
          std::uint64_t{m.torch.material} << 32 | std::uint64_t{m.torch.spindles_on} << 8 |
              std::uint64_t{m.torch.adaptive_feed} << 1 | std::uint64_t{m.torch.overburn},
          bits(m.length.applied_mm.x),
          bits(m.length.applied_mm.y),
          bits(m.length.applied_mm.z),
          bits(m.length.real_mm.x),
          bits(m.length.real_mm.y),
          bits(m.length.real_mm.z),
          bits(m.length.tip_shift_mm.x),
          bits(m.length.tip_shift_mm.y),
          bits(m.length.tip_shift_mm.z),
          bits(m.length.uvw_off_mm.x),
          bits(m.length.uvw_off_mm.y),
          bits(m.length.uvw_off_mm.z),
          bits(m.length.abc_off_deg.x),
          bits(m.length.abc_off_deg.y),
          bits(m.length.abc_off_deg.z),
          std::uint64_t{m.length.set_at.file} << 32 | m.length.set_at.line,
          std::uint64_t{static_cast<std::uint32_t>(m.length.offset_tool)} << 32 |
              static_cast<std::uint64_t>(m.length.verdict)};
}

std::uint64_t ProgramTrackBuilder::mode_of(const Motion& m) {
  const ModeKey key = key_of(m);
  if (key == last_key_ && !track_->modes_.empty()) return last_mode_;
  const auto [entry, fresh] =
      mode_numbers_.try_emplace(key, static_cast<std::uint32_t>(track_->modes_.size()));
  if (fresh) {
    Motion mode = m;
    mode.source.line = 0;
    mode.selected_tool = 0;
    mode.selected_at = {};
    mode.from_mm = mode.to_mm = mode.from_uvw_mm = mode.to_uvw_mm = Vec3{0};
    mode.from_abc_deg = mode.to_abc_deg = {};
    mode.arc.center_mm = Vec3{0};
    mode.arc.sweep_rad = mode.feed_mm_per_min = mode.spindle_rpm = 0;
    track_->modes_.push_back(mode);
  }
  last_key_ = key;
  return last_mode_ = entry->second;
}

void ProgramTrackBuilder::step(const Motion& m, const TimedStep& timed,
                               std::span<const PathPiece> /*path*/) {
  ProgramTrack& t = *track_;
  const std::size_t i = t.size();
  if (i >= kMaxMotions) {
    ++left_out_;
    return;
  }
  const auto number = static_cast<std::uint32_t>(i);
  if (!continues(m, previous_)) {
    t.jumps_.push_back({number, m.from_mm, m.from_abc_deg, m.from_uvw_mm});
  }
  const bool starts = i == 0 || !(m.source == previous_.source);
  if (i % 64 == 0) t.block_start_.push_back(0);
  if (starts) {
    t.block_start_.back() |= std::uint64_t{1} << (i % 64);
    t.lines_.push(number);
  }
  const bool changes = i == 0 ? m.tool != 0 : m.tool != previous_.tool;
  if (changes || m.kind == MotionKind::kToolChange) t.tool_changes_.push_back(number);
  for (int axis = 0; axis < 3; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    t.to_mm_[index].push_real(m.to_mm[axis]);
    t.to_abc_deg_[index].push_real(m.to_abc_deg[index]);
    t.to_uvw_mm_[index].push_real(m.to_uvw_mm[axis]);
    t.arc_center_mm_[index].push_real(m.arc.center_mm[axis]);
  }
  t.arc_sweep_rad_.push_real(m.arc.sweep_rad);
  t.feed_.push_real(m.feed_mm_per_min);
  t.spindle_rpm_.push_real(m.spindle_rpm);
  t.start_s_.push_real(timed.start_s);
  if (i > 0) note_duration(timed.start_s - previous_start_s_);
  previous_start_s_ = timed.start_s;
  previous_duration_s_ = timed.duration_s;
  t.programmed_.push_real(timed.programmed_mm_per_min);
  t.allowed_.push_real(timed.allowed_mm_per_min);
  t.mode_.push(mode_of(m));
  const bool even = timed.way.is_even();
  if (!even) t.ways_.emplace_back(timed.way);
  t.way_.push(even ? 0 : t.ways_.size());
  t.line_.push(m.source.line);
  t.selected_tool_.push(static_cast<std::uint32_t>(m.selected_tool));
  t.selected_at_.push(line_key(m.selected_at));
  previous_ = m;
}

/// Of the motion before, as motion_s() has it.
void ProgramTrackBuilder::note_duration(double until_next_s) {
  track_->duration_change_.push(std::bit_cast<std::uint64_t>(previous_duration_s_) -
                                std::bit_cast<std::uint64_t>(until_next_s) + kNoChange);
}

/// Blocks come in order of time; most programs run their lines in order, too.
void ProgramTrackBuilder::sort_lines() {
  ProgramTrack& t = *track_;
  const auto key_of_block = [&t](std::size_t index) {
    const std::uint64_t block = t.lines_.at(index);
    return std::pair(line_key(t.source(static_cast<std::size_t>(block))), block);
  };
  bool is_sorted = true;
  for (std::size_t n = 1; n < t.lines_.size() && is_sorted; ++n) {
    is_sorted = key_of_block(n - 1) < key_of_block(n);
  }
  if (is_sorted) return;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> keyed;
  keyed.reserve(t.lines_.size());
  for (std::size_t n = 0; n < t.lines_.size(); ++n) keyed.push_back(key_of_block(n));
  std::sort(keyed.begin(), keyed.end());
  t.lines_ = PackedColumn(PackedColumn::Of::kIntegers);
  for (const auto& entry : keyed) t.lines_.push(entry.second);
}

std::shared_ptr<const ProgramTrack> ProgramTrackBuilder::build(std::vector<std::string> files,
                                                               const WorkpieceFrame& frame) {
  assert(track_);
  if (!track_->empty()) note_duration(0);
  sort_lines();
  ProgramTrack& t = *track_;
  t.files_ = std::move(files);
  t.frame_ = frame;
  for (auto* columns : {&t.to_mm_, &t.to_abc_deg_, &t.to_uvw_mm_, &t.arc_center_mm_}) {
    for (PackedColumn& column : *columns) column.shrink();
  }
  for (PackedColumn* column : {&t.arc_sweep_rad_, &t.feed_, &t.spindle_rpm_, &t.start_s_,
                               &t.duration_change_, &t.programmed_, &t.allowed_, &t.line_,
                               &t.lines_, &t.selected_tool_, &t.selected_at_, &t.mode_, &t.way_}) {
    column->shrink();
  }
  t.modes_.shrink_to_fit();
  t.ways_.shrink_to_fit();
  t.jumps_.shrink_to_fit();
  t.block_start_.shrink_to_fit();
  t.tool_changes_.shrink_to_fit();
  mode_numbers_.clear();
  return std::shared_ptr<const ProgramTrack>(std::move(track_));
}

}  // namespace kerf
