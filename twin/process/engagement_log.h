// twin/process/engagement_log.h - adds up how tools were engaged, pass by pass.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stock/stock_model.h"
#include "twin/process/engagement.h"

namespace kerf {

/// Hears of each part of the feed moves as it is measured: between the on_step() of a motion and
/// that of the next (MotionRecorder), parts are of that motion, in their order. One thread.
class EngagementListener {
 public:
  virtual ~EngagementListener() = default;
  /// What is told from now on is of this tool.
  virtual void on_mount(int tool, const Cutter& cutter) = 0;
  virtual void on_part(const EngagementLook& look, double length_mm) = 0;
  /// A feed move whose engagement nobody knows.
  virtual void on_unmeasured(double length_mm) = 0;
};

/// Is told of each part of a feed move how the tool was engaged on it. For the map it cuts the
/// parts that were engaged out of heights of its own, kMostMapCells each way at most, whatever the
/// model of the workpiece is: who cut a place last is then known. A pass takes 200 bytes, a part
/// with a map 4. One thread.
class EngagementLog {
 public:
  static constexpr int kMostMapCells = 500;
  static constexpr std::uint32_t kNoPass = ~std::uint32_t{0};

  explicit EngagementLog(bool with_map) : with_map_(with_map) {}

  /// It hears of all that is told. Outlives the log.
  void tell(EngagementListener& listener) { listener_ = &listener; }
  bool is_heard() const { return listener_ != nullptr; }

  /// Forgets all, for another run over `stock`, which has not been cut.
  void begin(const StockModel& stock);
  /// What is told from now on is of this tool.
  void mount(int tool, const Cutter& cutter);
  /// A traverse, or a change of the tool.
  void end_pass();

  /// A part of a feed move that begins at `start_s` of the program.
  struct Part {
    EngagementLook look;
    const CutMove* move = nullptr;  ///< the part alone
    EngagedWay way;
    SourceRef source;
    double start_s = 0;
  };
  /// Returns the pass that it belongs to; kNoPass: none.
  std::uint32_t add(const Part& part);
  /// A feed move whose engagement nobody knows.
  void add_unmeasured(double length_mm) {
    unmeasured_mm_ += length_mm;
    if (listener_ != nullptr) listener_->on_unmeasured(length_mm);
  }
  /// A part of a move of that pass, told as one in material, has removed none.
  void take_back_cut(std::uint32_t pass, const EngagementLook& look, const EngagedWay& way);
  /// A part of a move of the present tool, told as one in the air, has removed material.
  void take_back_air(const EngagedWay& way);
  /// What a move of that pass has removed, on so much of its way and time as it was in material
  /// (EngagementSums::in_material_mm(), cut_s). `most_mm3`: what stood before the tool there;
  /// heights count what its front takes on the way straight on with a later move, or with the last
  /// of them all that the front holds, and a rate is none of that.
  /// `is_plunge`: straight down, where a rate is another one than along the way.
  void add_removed(std::uint32_t pass, double mm3, double way_mm, double seconds,
                   double most_mm3 = std::numeric_limits<double>::infinity(),
                   bool is_plunge = false);

  /// What a tool has left, when all is cut.
  void set_scallops(int tool, const std::string& shape, const Scallops& scallops);

  /// A part of a feed move of a turning tool.
  void add_turned(int tool, const Cutter& cutter, const TurnedWay& way);

  /// The run is over.
  Engagement result();

 private:
  bool goes_on(const CutMove& last, const CutMove& next) const;
  void cut_map();
  EngagementMap map() const;

  bool with_map_;
  EngagementListener* listener_ = nullptr;
  std::unique_ptr<StockModel> heights_;  ///< of the map
  std::vector<CutMove> moves_;           ///< of the tool, that are still to be cut out of it
  std::optional<Cutter> cutter_;
  std::vector<float> angles_;  ///< by the numbers of its cuts
  std::vector<CutReport> reports_;
  std::vector<EngagementPass> passes_;
  std::vector<EngagementOfTool> tools_;
  std::vector<TurningEngagement> turned_;
  std::vector<std::uint32_t> tool_of_pass_;
  std::uint32_t tool_ = 0;
  bool is_open_ = false;
  double gap_mm_ = 0;  ///< since the pass was last in material
  /// Moves of a pass whose removal is known, until they are long enough for a rate.
  struct Window {
    std::uint32_t pass = kNoPass;
    double mm3 = 0, most_mm3 = 0, mm = 0, seconds = 0;
  } window_;
  double unmeasured_mm_ = 0, unmeasured_mm3_ = 0;
};

}  // namespace kerf
