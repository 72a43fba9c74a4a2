#include "twin/serve/live_broadcast.h"

#include <utility>

namespace kerf {
namespace {

/// Fast enough that the picture is not older for it, seldom enough that snapshots cost nothing.
constexpr std::chrono::milliseconds kServedFrames{25};

/// Its age goes on while nothing new comes.
std::function<ShopMoment(const std::string&)> aging(LiveStatus status, LengthUnit unit) {
  using Clock = std::chrono::steady_clock;
  return [status = std::move(status), unit, since = Clock::now()](const std::string& tool_name) {
    LiveStatus shown = status;
    shown.age_s += std::chrono::duration<double>(Clock::now() - since).count();
    return moment_of(shown, tool_name, unit);
  };
}

}  // namespace

LiveBroadcast::LiveBroadcast(ShopBroadcastOptions options, LengthUnit unit, ToolSources tools,
                             LiveObserver& next, ServedScene& scene)
    : unit_(unit),
      next_(next),
      resolver_(std::move(tools), nullptr),
      broadcast_(std::move(options), scene, aging({}, unit)) {}

std::chrono::milliseconds LiveBroadcast::frame_period() const {
  return next_.wants_frames() ? next_.frame_period() : kServedFrames;
}

void LiveBroadcast::on_status(const LiveStatus& status) {
  next_.on_status(status);
  ShopNews news;
  news.moment = aging(status, unit_);
  broadcast_.tell(std::move(news));
}

void LiveBroadcast::on_finding(const Finding& finding, const std::vector<std::string>& files) {
  next_.on_finding(finding, files);
  ShopNews news;
  news.findings.push_back(finding_object(finding, files, false, unit_));
  broadcast_.tell(std::move(news));
}

void LiveBroadcast::on_warning(const AheadWarning& warning, const std::vector<std::string>& files) {
  next_.on_warning(warning, files);
  ShopNews news;
  news.findings.push_back(finding_object(warning.finding, files, true, unit_));
  broadcast_.tell(std::move(news));
}

void LiveBroadcast::on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                             std::span<const Vec3> trail, std::span<const CutLabel> labels) {
  if (next_.wants_frames()) next_.on_frame(stock, cutter, status, trail, labels);
  // So that tiles that were only passed over count as unchanged.
  stock.take_dirty_tiles();
  ShopNews news;
  news.stock = stock.snapshot();
  news.moment = aging(status, unit_);
  note_tool(status.place.tool, cutter, news);
  broadcast_.tell(std::move(news));
}

/// The shape by the cutter in use, or, as long as none was needed, by what is known of the tool.
void LiveBroadcast::note_tool(int tool, const Cutter* cutter, ShopNews& news) {
  if (cutter == nullptr && tool >= 0) {
    const ResolvedTool& resolved = resolver_.mount(tool, 0);
    if (resolved.cutter) cutter = &*resolved.cutter;
  }
  const std::string spec = cutter != nullptr ? cutter->spec() : std::string();
  if (spec == noted_spec_) return;
  noted_spec_ = spec;
  news.has_tool = true;
  news.cutter = cutter != nullptr ? std::make_shared<const Cutter>(*cutter) : nullptr;
}

void LiveBroadcast::end(const StockModel* stock) {
  if (stock == nullptr) return;
  ShopNews news;
  news.stock = stock->snapshot();
  broadcast_.tell(std::move(news));
}

}  // namespace kerf
