// twin/serve/run_broadcast.h - a dry run, for the page: the part as it is cut, then what came of
// it.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "twin/serve/shop_broadcast.h"
#include "twin/session/session.h"

namespace kerf {

struct RunBroadcastOptions {
  std::string title;
  bool has_file = true;  ///< the program is no standard input: its lines can be shown
  LengthUnit unit = LengthUnit::kMm;
};

/// Told by the thread that cuts. It hands over a snapshot kPeriod apart, and only while a page
/// asks; the tool, which is everywhere at once, is not drawn.
class RunBroadcast final : public SessionObserver {
 public:
  /// `session`, to be observed by it, and `scene` must outlive it.
  RunBroadcast(RunBroadcastOptions options, const Session& session, ServedScene& scene);

  void on_start(const StockModel& stock) override;
  void on_files(std::span<const std::string> files) override;
  void on_cut(const StockModel& stock, std::span<const Motion> motions, double end_s) override;
  /// As many as take about kPeriod.
  std::size_t most_motions() const override { return most_motions_; }

  /// What the run came to, when it is over; shown as long as this object is there.
  void end();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMostMotions = 4096;
  void tell_findings(ShopNews& news);
  ShopMoment cutting_moment(const Motion& last, double end_s) const;
  ShopMoment end_moment() const;

  const RunBroadcastOptions options_;
  const Session& session_;
  ServedScene& scene_;
  std::vector<std::string> files_;
  std::size_t told_findings_ = 0;
  std::size_t most_motions_ = 64;
  Clock::time_point cut_at_, told_at_;
  std::optional<ShopBroadcast> broadcast_;  ///< since on_start()
};

}  // namespace kerf
