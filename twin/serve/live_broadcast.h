// twin/serve/live_broadcast.h - a machine that is watched, for the page.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "twin/job/tools.h"
#include "twin/live/live_session.h"
#include "twin/serve/shop_broadcast.h"

namespace kerf {

/// Takes what a session tells, passes it on, and puts it into the scene that pages are served from.
/// The session's thread hands over a snapshot and copies a status, whatever pages do.
class LiveBroadcast final : public LiveObserver {
 public:
  /// The references must outlive it.
  LiveBroadcast(ShopBroadcastOptions options, LengthUnit unit, ToolSources tools,
                LiveObserver& next, ServedScene& scene);

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
  void note_tool(int tool, const Cutter* cutter, ShopNews& news);

  const LengthUnit unit_;
  LiveObserver& next_;
  ToolResolver resolver_;
  std::string noted_spec_;
  ShopBroadcast broadcast_;
};

}  // namespace kerf
