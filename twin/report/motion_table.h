// twin/report/motion_table.h - the motions of a program as a table (CSV, RFC 4180), a row each,
// with what each of them has cut.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/result.h"
#include "twin/process/motion_recorder.h"

namespace kerf {

/// Writes while the program is cut; the file appears with commit(). mm, mm/min, s, degrees, rpm,
/// rounded to 1e-6. Columns, in this order:
///     line, file, type ("feed"; kerf canon has the names), x, y, z, a, b, c, u, v, w (where it
///     ends; empty: not known), feed_mm_per_min (feed_mm_per_rev where that is in force, the other
///     is empty then), length_mm, start_s, duration_s, tool, spindle_rpm (negative: M4),
///     removed_mm3, depth_mm, removed_mm3_per_s (over its duration)
/// and where engagement is measured, as means over its way sideways in material:
///     ae_mm, ap_mm, entry_deg, exit_deg, climb_share,
///     plunge_share (of its way in material, straight down), cut_share (of its way, in material),
///     cut_mm3_per_s (over its time in material),
///     turned_mm_per_rev (the planned feed for each turn of a workpiece that turns), chip_mm (mean
///     thickness of its chips: the former by the sine of the lead angle),
///     air_s (of its time, in no material; their sum over a tool's rows is that of the report)
/// Of a tool that stands still while the workpiece turns there are ap_mm, cut_share and from
/// cut_mm3_per_s on; of one that turns all but the two behind that. They are empty where there is
/// none of that way; all of them of motions that were not measured. Where a part of a motion was
/// not measured, shares are those of the rest. Columns may be added behind. About 2 us a row; keeps
/// rows of motions whose cuts have not come yet. What cannot be replaced under its name (standard
/// output) is written by commit() alone.
class MotionTable final : public MotionRecorder {
 public:
  /// `renamed`: how a file is called. Error: the file cannot be written.
  static Result<std::unique_ptr<MotionTable>> create(
      const std::string& path, std::function<std::string(std::string)> renamed,
      bool with_engagement = false);

  /// All rows are there; once. Error: what could not be written.
  Done commit();

  void restart() override;
  void name_files(const std::vector<std::string>& files) override;
  void on_step(std::uint64_t number, const Motion& motion, const TimedStep& step) override;
  void on_cut(std::uint64_t number, double removed_mm3, double depth_mm) override;
  void on_engaged(std::uint64_t number, const EngagementLook& look, const EngagedWay& way) override;
  void on_engaged_until(std::uint64_t number) override { engaged_until_ = number; }
  void on_turned(std::uint64_t number, const TurnedWay& way) override;

 private:
  struct Row {
    std::uint64_t number = 0;
    std::string head;  ///< the columns that are known at once
    double duration_s = 0;
    double removed_mm3 = 0;
    double depth_mm = 0;
    std::optional<EngagementSums> engaged;
    double air_mm = 0, air_s = 0;  ///< of what was measured
    std::optional<TurningEngagement> turned;
  };
  MotionTable(std::string path, std::function<std::string(std::string)> renamed,
              bool with_engagement);
  static constexpr std::uint64_t kNotWaiting = ~std::uint64_t{0};
  void begin();
  Row* row_of(std::uint64_t number);
  void write(const Row& row);
  void write_engaged(const Row& row);
  void write_turned(const TurningEngagement& sums);
  void write_cell(bool known, double value);

  std::string path_;
  std::function<std::string(std::string)> renamed_;
  std::optional<AtomicFile> file_;  ///< none: `text_` is kept until commit()
  std::string trouble_;             ///< why there is none, though there should
  bool as_it_comes_ = false;
  bool with_engagement_ = false;
  std::string text_;
  std::vector<std::string> files_;  ///< quoted
  std::deque<Row> waiting_;
  std::uint64_t engaged_until_ = kNotWaiting;
};

/// Tables of the setups of a part as one, setup after setup, with a last column `setup`: 1, 2 ..;
/// of one whose name is empty there are no rows. Appears whole or not at all. Error: what cannot be
/// read or written.
Done join_motion_tables(const std::string& path, const std::vector<std::string>& tables);

}  // namespace kerf
