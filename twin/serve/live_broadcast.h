// twin/serve/live_broadcast.h - a machine that is watched, for the page.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "twin/job/tools.h"
#include "twin/live/live_session.h"
#include "twin/scene/patch_feeder.h"
#include "twin/serve/served_scene.h"
#include "twin/serve/shop_state.h"

namespace kerf {

struct LiveBroadcastOptions {
  std::string title, source_name;
  LengthUnit units = LengthUnit::kMm;
  ToolSources tools;
  Box blank_mm;
  bool turns = false;
  std::shared_ptr<const StockModel> stock;  ///< a snapshot
};

/// Takes what a session tells, passes it on, and puts it into the scene that pages are served from.
/// The session's thread hands over a snapshot and copies a status, whatever pages do; another one
/// makes patches and texts of the newest of them, kPeriod apart, and patches only while somebody
/// looks. Pages see the part of a size that fits a tablet: cells much finer than a pixel of one are
/// joined.
class LiveBroadcast final : public LiveObserver {
 public:
  static constexpr std::chrono::milliseconds kPeriod{100};

  /// The references must outlive it.
  LiveBroadcast(LiveBroadcastOptions options, LiveObserver& next, ServedScene& scene);
  ~LiveBroadcast() override;

  void on_status(const LiveStatus& status) override;
  void on_finding(const Finding& finding, const std::vector<std::string>& files) override;
  void on_warning(const AheadWarning& warning, const std::vector<std::string>& files) override;
  void on_run(const LiveRun& run) override { next_.on_run(run); }
  bool wants_frames() const override { return true; }
  std::chrono::milliseconds frame_period() const override;
  void on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                std::span<const Vec3> trail, std::span<const CutLabel> labels) override;

  /// What the watch came to; shown as long as this object is there.
  void end(const StockModel* stock);

 private:
  using Clock = std::chrono::steady_clock;
  struct News {
    std::shared_ptr<const StockModel> stock;
    std::optional<LiveStatus> status;
    Clock::time_point status_at;
    std::vector<std::string> findings;  ///< finding_object()
    bool has_tool = false;
    std::shared_ptr<const Cutter> cutter;
  };
  void note_tool(int tool, const Cutter* cutter);
  void tell(std::string finding);
  void run(const std::stop_token& stop);
  void take(News news);
  void make_patches();
  void put_state();
  void put_setup();
  std::vector<ShownLine> code_about(const std::string& path, int line);

  const LiveBroadcastOptions options_;
  LiveObserver& next_;
  ServedScene& scene_;

  // of the session's thread
  ToolResolver resolver_;
  std::string noted_spec_;

  std::mutex mutex_;  // of what follows
  std::condition_variable_any arrived_;
  bool has_news_ = false;
  News news_;

  // of this one's thread
  std::shared_ptr<const StockModel> stock_;
  bool is_followed_ = false;  ///< by the feeder, as it is now
  std::size_t tiles_ = 0;     ///< of what it follows
  PatchFeeder feeder_;
  std::optional<LiveStatus> status_;
  Clock::time_point status_at_;
  std::shared_ptr<const Cutter> cutter_;
  std::string tool_name_;
  std::string code_path_;
  std::int64_t code_time_ = 0;
  std::shared_ptr<const ProgramText> code_;
  std::jthread thread_;
};

}  // namespace kerf
