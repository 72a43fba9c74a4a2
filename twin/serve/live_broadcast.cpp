#include "twin/serve/live_broadcast.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "twin/scene/program_text.h"
#include "twin/scene/tool_shape.h"
#include "twin/serve/packed_patch.h"

namespace kerf {
namespace {

/// The longest edge of the blank is so many pixels on a tablet. What is finer is not seen, and
/// costs four times the bytes each time.
constexpr double kBlankPixels = 400;
/// Of what changes at once, about kMostAnswer: more comes a level coarser until it is calm.
constexpr std::size_t kEasyTriangles = 7000;
constexpr std::chrono::milliseconds kSlice{40};
/// Fast enough that the picture is not older for it, seldom enough that snapshots cost nothing.
constexpr std::chrono::milliseconds kServedFrames{25};
constexpr int kCodeLines = 3;  ///< before and behind the present one
constexpr std::size_t kMostCode = std::size_t{64} << 20;
constexpr std::size_t kMostLineShown = 160;
constexpr int kBelowOthers = 5;

std::int64_t changed_ns(const std::string& path) {
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0) return -1;
  return facts.st_mtim.tv_sec * std::int64_t{1'000'000'000} + facts.st_mtim.tv_nsec;
}

}  // namespace

LiveBroadcast::LiveBroadcast(LiveBroadcastOptions options, LiveObserver& next, ServedScene& scene)
    : options_(std::move(options)),
      next_(next),
      scene_(scene),
      resolver_(options_.tools, nullptr),
      stock_(options_.stock) {
  const Vec3 size = options_.blank_mm.size();
  feeder_.set_detail({std::max({size.x, size.y, size.z}) / kBlankPixels}, kEasyTriangles);
  scene_.begin_anew();
  put_setup();
  status_ = LiveStatus{};
  status_at_ = Clock::now();
  put_state();
  scene_.publish();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

LiveBroadcast::~LiveBroadcast() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

std::chrono::milliseconds LiveBroadcast::frame_period() const {
  return next_.wants_frames() ? next_.frame_period() : kServedFrames;
}

void LiveBroadcast::on_status(const LiveStatus& status) {
  next_.on_status(status);
  const std::lock_guard lock(mutex_);
  news_.status = status;
  news_.status_at = Clock::now();
  has_news_ = true;
  arrived_.notify_one();
}

void LiveBroadcast::tell(std::string finding) {
  const std::lock_guard lock(mutex_);
  news_.findings.push_back(std::move(finding));
  has_news_ = true;
  arrived_.notify_one();
}

void LiveBroadcast::on_finding(const Finding& finding, const std::vector<std::string>& files) {
  next_.on_finding(finding, files);
  tell(finding_object(finding, files, false, options_.units));
}

void LiveBroadcast::on_warning(const AheadWarning& warning, const std::vector<std::string>& files) {
  next_.on_warning(warning, files);
  tell(finding_object(warning.finding, files, true, options_.units));
}

void LiveBroadcast::on_frame(StockModel& stock, const Cutter* cutter, const LiveStatus& status,
                             std::span<const Vec3> trail, std::span<const CutLabel> labels) {
  if (next_.wants_frames()) next_.on_frame(stock, cutter, status, trail, labels);
  // So that tiles that were only passed over count as unchanged.
  stock.take_dirty_tiles();
  std::shared_ptr<const StockModel> snapshot = stock.snapshot();
  const std::lock_guard lock(mutex_);
  news_.stock.swap(snapshot);
  news_.status = status;
  news_.status_at = Clock::now();
  note_tool(status.place.tool, cutter);
  has_news_ = true;
  arrived_.notify_one();
}

/// The shape by the cutter in use, or, as long as none was needed, by what is known of the tool.
void LiveBroadcast::note_tool(int tool, const Cutter* cutter) {
  if (cutter == nullptr && tool >= 0) {
    const ResolvedTool& resolved = resolver_.mount(tool, 0);
    if (resolved.cutter) cutter = &*resolved.cutter;
  }
  const std::string spec = cutter != nullptr ? cutter->spec() : std::string();
  if (spec == noted_spec_) return;
  noted_spec_ = spec;
  news_.has_tool = true;
  news_.cutter = cutter != nullptr ? std::make_shared<const Cutter>(*cutter) : nullptr;
}

void LiveBroadcast::end(const StockModel* stock) {
  if (stock == nullptr) return;
  std::shared_ptr<const StockModel> snapshot = stock->snapshot();
  const std::lock_guard lock(mutex_);
  news_.stock.swap(snapshot);
  has_news_ = true;
  arrived_.notify_one();
}

void LiveBroadcast::run(const std::stop_token& stop) {
  [[maybe_unused]] const int now = ::nice(kBelowOthers);  // of this thread; refused: as it is
  Clock::time_point published = Clock::now() - kPeriod;
  while (!stop.stop_requested()) {
    News news;
    {
      std::unique_lock lock(mutex_);
      const bool is_behind = scene_.is_watched() && feeder_.behind();
      if (!is_behind) arrived_.wait_for(lock, stop, kPeriod, [&] { return has_news_; });
      const bool has_early_news = !stop.stop_requested() && Clock::now() - published < kPeriod;
      if (has_early_news) {
        arrived_.wait_until(lock, stop, published + kPeriod, [] { return false; });
      }
      news = std::exchange(news_, {});
      has_news_ = false;
    }
    published = Clock::now();
    take(std::move(news));
    make_patches();
    put_state();
    scene_.publish();
  }
}

void LiveBroadcast::take(News news) {
  if (news.stock) {
    stock_ = std::move(news.stock);
    is_followed_ = false;
  }
  if (news.status) {
    status_ = std::move(news.status);
    status_at_ = news.status_at;
  }
  for (std::string& finding : news.findings) scene_.add_finding(std::move(finding));
  if (!news.has_tool) return;
  cutter_ = std::move(news.cutter);
  tool_name_ = cutter_ ? tool_name_of(*cutter_) : std::string();
  put_setup();
}

/// What nobody sees need not be made: the tiles that differ by then are made when somebody looks.
void LiveBroadcast::make_patches() {
  if (!stock_ || !scene_.is_watched()) return;
  if (!std::exchange(is_followed_, true)) {
    // Of another size: what pages have of the one before is no part of it.
    if (std::exchange(tiles_, stock_->tile_count()) != stock_->tile_count()) scene_.begin_anew();
    feeder_.follow(stock_);
  }
  for (const auto& patch : feeder_.make_until(Clock::now() + kSlice)) {
    scene_.set_patch(patch->tile, packed(*patch));
  }
  if (!feeder_.behind()) scene_.set_whole(true);
}

void LiveBroadcast::put_setup() {
  const std::shared_ptr<const ToolShape> shape = cutter_ ? tool_shape_of(*cutter_) : nullptr;
  ShopSetup setup{options_.title, options_.source_name, options_.blank_mm, options_.turns,
                  shape.get()};
  scene_.set_setup(setup_members(setup));
}

void LiveBroadcast::put_state() {
  LiveStatus shown = *status_;
  shown.age_s += std::chrono::duration<double>(Clock::now() - status_at_).count();
  std::vector<ShownLine> code;
  if (shown.place.followed)
    code = code_about(shown.file, static_cast<int>(shown.place.source.line));
  scene_.set_state(state_members(shown, tool_name_, code, options_.units));
}

/// The file is read once, and again when it has changed.
std::vector<ShownLine> LiveBroadcast::code_about(const std::string& path, int line) {
  const std::int64_t changed = changed_ns(path);
  if (path != code_path_ || changed != code_time_) {
    code_path_ = path;
    code_time_ = changed;
    code_ = changed < 0 ? nullptr : read_program_text({path}, kMostCode);
  }
  std::vector<ShownLine> lines;
  if (!code_ || line < 1 || line > code_->files[0].line_count()) return lines;
  const int last = std::min(line + kCodeLines, code_->files[0].line_count());
  for (int number = std::max(1, line - kCodeLines); number <= last; ++number) {
    lines.push_back({number, std::string(code_->files[0].line(number).substr(0, kMostLineShown))});
  }
  return lines;
}

}  // namespace kerf
