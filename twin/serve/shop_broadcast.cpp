#include "twin/serve/shop_broadcast.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
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

ShopBroadcast::ShopBroadcast(ShopBroadcastOptions options, ServedScene& scene,
                             std::function<ShopMoment(const std::string&)> moment)
    : options_(std::move(options)),
      scene_(scene),
      stock_(options_.stock),
      tiles_(stock_ ? stock_->tile_count() : 0),
      moment_(std::move(moment)) {
  const Vec3 size = options_.blank_mm.size();
  feeder_.set_detail({std::max({size.x, size.y, size.z}) / kBlankPixels}, kEasyTriangles);
  scene_.begin_anew();
  if (!stock_) scene_.set_whole(true);
  put_setup();
  put_state();
  scene_.publish();
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

ShopBroadcast::~ShopBroadcast() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void ShopBroadcast::tell(ShopNews news) {
  const std::lock_guard lock(mutex_);
  // Swapped: what goes is dropped when the lock is free.
  if (news.stock) news_.stock.swap(news.stock);
  if (news.moment) news_.moment.swap(news.moment);
  std::move(news.findings.begin(), news.findings.end(), std::back_inserter(news_.findings));
  if (news.all_findings) news_.all_findings.swap(news.all_findings);
  if (news.has_tool) {
    news_.has_tool = true;
    news_.cutter.swap(news.cutter);
  }
  has_news_ = true;
  arrived_.notify_one();
}

void ShopBroadcast::run(const std::stop_token& stop) {
  [[maybe_unused]] const int now = ::nice(kBelowOthers);  // of this thread; refused: as it is
  Clock::time_point published = Clock::now() - kPeriod;
  while (!stop.stop_requested()) {
    ShopNews news;
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

void ShopBroadcast::take(ShopNews news) {
  if (news.stock) {
    stock_ = std::move(news.stock);
    is_followed_ = false;
  }
  if (news.moment) moment_ = std::move(news.moment);
  for (std::string& finding : news.findings) scene_.add_finding(std::move(finding));
  if (news.all_findings) {
    scene_.set_findings(std::move(news.all_findings->first), news.all_findings->total);
  }
  if (!news.has_tool) return;
  cutter_ = std::move(news.cutter);
  tool_name_ = cutter_ ? tool_name_of(*cutter_) : std::string();
  put_setup();
}

/// What nobody sees need not be made: the tiles that differ by then are made when somebody looks.
void ShopBroadcast::make_patches() {
  if (!stock_ || !scene_.is_watched()) return;
  if (!std::exchange(is_followed_, true)) {
    // Of another size: what pages have of the one before is no part of it.
    if (std::exchange(tiles_, stock_->tile_count()) != stock_->tile_count())
      scene_.begin_part_anew();
    feeder_.follow(stock_);
  }
  for (const auto& patch : feeder_.make_until(Clock::now() + kSlice)) {
    scene_.set_patch(patch->tile, packed(*patch));
  }
  if (!feeder_.behind()) scene_.set_whole(true);
}

void ShopBroadcast::put_setup() {
  const std::shared_ptr<const ToolShape> shape = cutter_ ? tool_shape_of(*cutter_) : nullptr;
  ShopSetup setup{options_.title, options_.source_name, options_.blank_mm, options_.turns,
                  shape.get()};
  scene_.set_setup(setup_members(setup));
}

void ShopBroadcast::put_state() {
  const ShopMoment moment = moment_(tool_name_);
  std::vector<ShownLine> code;
  if (!moment.file.empty()) code = code_about(moment.file, moment.line);
  scene_.set_state(state_members(moment, code));
}

/// The file is read once, and again when it has changed.
std::vector<ShownLine> ShopBroadcast::code_about(const std::string& path, int line) {
  const std::int64_t changed = changed_ns(path);
  if (path != code_path_ || changed != code_time_) {
    code_path_ = path;
    code_time_ = changed;
    code_ = changed < 0 ? nullptr : read_program_text({path}, kMostCode);
  }
  std::vector<ShownLine> lines;
  if (!code_ || line < 1 || line > code_->files[0].line_count()) return lines;
  const int last = std::min(line + kCodeLines, code_->files[0].line_count());
  SourceLines text(code_->files[0]);
  for (int number = std::max(1, line - kCodeLines); number <= last; ++number) {
    lines.push_back({number, std::string(text.line(number).substr(0, kMostLineShown))});
  }
  return lines;
}

}  // namespace kerf
