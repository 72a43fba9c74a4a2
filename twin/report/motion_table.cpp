#include "twin/report/motion_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "interp_bridge/motion_kinds.h"
#include "twin/machine/motion_json.h"

namespace kerf {
namespace {

constexpr std::string_view kColumns =
    "line,file,type,x,y,z,a,b,c,u,v,w,feed_mm_per_min,feed_mm_per_rev,length_mm,start_s,"
    "duration_s,tool,spindle_rpm,removed_mm3,depth_mm,removed_mm3_per_s";
constexpr std::string_view kEngagementColumns =
    ",ae_mm,ap_mm,entry_deg,exit_deg,climb_share,plunge_share,cut_share,cut_mm3_per_s,"
    "turned_mm_per_rev,chip_mm,air_s";
/// Rows go to the file by so many bytes.
constexpr std::size_t kTextBytes = std::size_t{1} << 16;

void append_cell(double value, std::string& out) {
  const double scaled = std::round(value * 1e6) / 1e6;
  out += ',';
  fmt::format_to(std::back_inserter(out), "{:.10g}", scaled == 0 ? 0.0 : scaled);
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

void append_place(const Motion& m, std::string& out) {
  for (int i = 0; i < 3; ++i) {
    if ((m.unknown_to >> i & 1) != 0) {
      out += ',';
    } else {
      append_cell(m.to_mm[i], out);
    }
  }
  for (const double angle_deg : m.to_abc_deg) append_cell(angle_deg, out);
  for (int i = 0; i < 3; ++i) append_cell(m.to_uvw_mm[i], out);
}

void append_feed(const Motion& m, std::string& out) {
  const bool fed = is_feed(m) || m.kind == MotionKind::kProbe;
  const bool per_turn = m.feed_per_rev || m.kind == MotionKind::kThread;
  for (const bool column_per_turn : {false, true}) {
    if (fed && per_turn == column_per_turn) {
      append_cell(m.feed_mm_per_min, out);
    } else {
      out += ',';
    }
  }
}

double signed_rpm(const Motion& m) {
  if (m.spindle == SpindleState::kStopped) return 0;
  return m.spindle == SpindleState::kClockwise ? m.spindle_rpm : -m.spindle_rpm;
}

}  // namespace

MotionTable::MotionTable(std::string path, std::function<std::string(std::string)> renamed,
                         bool with_engagement)
    : path_(std::move(path)), renamed_(std::move(renamed)), with_engagement_(with_engagement) {
  as_it_comes_ = written_as_it_comes(path_);
}

Result<std::unique_ptr<MotionTable>> MotionTable::create(
    const std::string& path, std::function<std::string(std::string)> renamed,
    bool with_engagement) {
  std::unique_ptr<MotionTable> table(new MotionTable(path, std::move(renamed), with_engagement));
  table->begin();
  if (!table->trouble_.empty()) return Error{table->trouble_};
  return table;
}

void MotionTable::begin() {
  waiting_.clear();
  engaged_until_ = kNotWaiting;
  text_ = kColumns;
  if (with_engagement_) text_ += kEngagementColumns;
  text_ += "\r\n";
  if (as_it_comes_) return;
  file_.reset();
  Result<AtomicFile> file = AtomicFile::create(path_);
  if (file) {
    file_.emplace(std::move(*file));
  } else {
    trouble_ = file.error();
  }
}

void MotionTable::restart() { begin(); }

void MotionTable::name_files(const std::vector<std::string>& files) {
  for (std::size_t i = files_.size(); i < files.size(); ++i) {
    files_.push_back(quoted(renamed_(files[i])));
  }
}

void MotionTable::on_step(std::uint64_t number, const Motion& m, const TimedStep& step) {
  Row& row = waiting_.emplace_back();
  row.number = number;
  row.duration_s = step.duration_s;
  fmt::format_to(std::back_inserter(row.head), "{},{},{}", m.source.line,
                 m.source.file < files_.size() ? files_[m.source.file] : "", to_string(m.kind));
  append_place(m, row.head);
  append_feed(m, row.head);
  append_cell(step.length_mm, row.head);
  append_cell(step.start_s, row.head);
  append_cell(step.duration_s, row.head);
  fmt::format_to(std::back_inserter(row.head), ",{}", m.tool);
  append_cell(signed_rpm(m), row.head);
}

void MotionTable::on_cut(std::uint64_t number, double removed_mm3, double depth_mm) {
  // Cuts come in order: those before have all of theirs.
  const std::uint64_t whole = std::min(number, engaged_until_);
  while (!waiting_.empty() && waiting_.front().number < whole) {
    write(waiting_.front());
    waiting_.pop_front();
  }
  Row* const row = row_of(number);
  if (row == nullptr) return;
  row->removed_mm3 += removed_mm3;
  row->depth_mm = std::max(row->depth_mm, depth_mm);
}

/// Null: it is not reported on, or has been written.
MotionTable::Row* MotionTable::row_of(std::uint64_t number) {
  const auto found =
      std::lower_bound(waiting_.begin(), waiting_.end(), number,
                       [](const Row& row, std::uint64_t wanted) { return row.number < wanted; });
  return found != waiting_.end() && found->number == number ? &*found : nullptr;
}

void MotionTable::on_engaged(std::uint64_t number, const EngagementLook& look,
                             const EngagedWay& way) {
  Row* const row = row_of(number);
  if (row == nullptr) return;
  if (!row->engaged) row->engaged.emplace();
  if (look.is_engaged()) {
    row->engaged->add(look, way);
  } else {
    row->air_mm += way.length_mm, row->air_s += way.seconds;
  }
}

void MotionTable::on_turned(std::uint64_t number, const TurnedWay& way) {
  if (waiting_.empty() || waiting_.back().number != number) return;
  std::optional<TurningEngagement>& turned = waiting_.back().turned;
  if (!turned) turned.emplace();
  turned->add(way);
}

void MotionTable::write_cell(bool known, double value) {
  if (known) {
    append_cell(value, text_);
  } else {
    text_ += ',';
  }
}

/// A width of cut and angles are none of a tool that stands still.
void MotionTable::write_turned(const TurningEngagement& sums) {
  const bool cuts = sums.cut_mm > 0, fed = cuts && sums.feed_sum > 0;
  write_cell(false, 0);
  write_cell(cuts, sums.mean(sums.depth_sum_mm2));
  for (int n = 0; n < 4; ++n) write_cell(false, 0);
  write_cell(sums.feed_mm > 0, sums.cut_mm / sums.feed_mm);
  write_cell(sums.cut_s > 0, sums.rate_mm3_per_s());
  write_cell(fed, sums.mean(sums.feed_sum));
  write_cell(fed, sums.mean(sums.chip_sum));
  write_cell(sums.feed_mm > 0, sums.air_s);
}

void MotionTable::write_engaged(const Row& row) {
  if (row.turned) return write_turned(*row.turned);
  if (!row.engaged) {
    text_.append(static_cast<std::size_t>(
                     std::count(kEngagementColumns.begin(), kEngagementColumns.end(), ',')),
                 ',');
    return;
  }
  constexpr double kDegrees = 180 / kPi;
  const EngagementSums& sums = *row.engaged;
  const double in_mm = sums.in_material_mm();
  for (const double sum : {sums.wide_sum_mm2, sums.deep_sum_mm2, kDegrees * sums.entry_sum,
                           kDegrees * sums.exit_sum, sums.climb_mm})
    write_cell(sums.cut_mm > 0, sums.mean(sum));
  write_cell(in_mm > 0, sums.plunge_mm / in_mm);
  const double measured_mm = in_mm + row.air_mm;
  write_cell(measured_mm > 0, in_mm / measured_mm);
  write_cell(sums.cut_s > 0, row.removed_mm3 / sums.cut_s);
  text_ += ",,";
  write_cell(true, row.air_s);
}

void MotionTable::write(const Row& row) {
  text_ += row.head;
  append_cell(row.removed_mm3, text_);
  append_cell(row.depth_mm, text_);
  append_cell(row.duration_s > 0 ? row.removed_mm3 / row.duration_s : 0, text_);
  if (with_engagement_) write_engaged(row);
  text_ += "\r\n";
  if (as_it_comes_ || !file_ || text_.size() < kTextBytes) return;
  file_->write(text_.data(), text_.size());
  text_.clear();
}

Done MotionTable::commit() {
  for (const Row& row : waiting_) write(row);
  waiting_.clear();
  if (as_it_comes_) {
    Result<AtomicFile> file = AtomicFile::create(path_);
    if (!file) return Error{file.error()};
    file_.emplace(std::move(*file));
  }
  if (!file_) return Error{trouble_};
  file_->write(text_.data(), text_.size());
  return file_->commit();
}

}  // namespace kerf
