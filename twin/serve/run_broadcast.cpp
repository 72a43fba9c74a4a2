#include "twin/serve/run_broadcast.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/translate.h"
#include "twin/live/live_text.h"
#include "twin/report/shown_lengths.h"

namespace kerf {
namespace {

std::string volume_text(double mm3, LengthUnit unit) {
  return in_unit(fmt::format("{:.2f} cm3", mm3 / 1000), unit);
}

}  // namespace

RunBroadcast::RunBroadcast(RunBroadcastOptions options, const Session& session, ServedScene& scene)
    : options_(std::move(options)), session_(session), scene_(scene) {}

void RunBroadcast::on_start(const StockModel& stock) {
  ShopBroadcastOptions options;
  options.title = options_.title;
  options.source_name = tr("dry run");
  options.blank_mm = stock.bounds_mm();
  options.turns = stock.turned() != nullptr;
  options.stock = stock.snapshot();
  told_findings_ = 0;
  cut_at_ = told_at_ = Clock::now();
  broadcast_.reset();
  broadcast_.emplace(std::move(options), scene_, [](const std::string&) {
    ShopMoment moment;
    moment.state = "live";
    moment.state_text = tr("cutting");
    return moment;
  });
}

void RunBroadcast::on_files(std::span<const std::string> files) {
  files_.assign(files.begin(), files.end());
}

void RunBroadcast::on_cut(const StockModel& stock, std::span<const Motion> motions, double end_s) {
  const Clock::time_point now = Clock::now();
  const Clock::duration took = now - std::exchange(cut_at_, now);
  if (took > ShopBroadcast::kPeriod) {
    most_motions_ = std::max<std::size_t>(1, most_motions_ / 2);
  } else if (took < ShopBroadcast::kPeriod / 4) {
    most_motions_ = std::min(kMostMotions, most_motions_ * 2);
  }
  if (motions.empty() || now - told_at_ < ShopBroadcast::kPeriod) return;
  told_at_ = now;
  ShopNews news;
  if (broadcast_->is_watched()) news.stock = stock.snapshot();
  const ShopMoment moment = cutting_moment(motions.back(), end_s);
  news.moment = [moment](const std::string&) { return moment; };
  tell_findings(news);
  broadcast_->tell(std::move(news));
}

/// Those that are added; what is taken back while it runs end() sets right.
void RunBroadcast::tell_findings(ShopNews& news) {
  const std::vector<Finding>& kept = session_.report().findings.kept();
  for (; told_findings_ < kept.size(); ++told_findings_)
    news.findings.push_back(finding_object(kept[told_findings_], files_, false, options_.unit));
}

ShopMoment RunBroadcast::cutting_moment(const Motion& last, double end_s) const {
  ShopMoment moment;
  moment.state = "live";
  moment.state_text = tr("cutting");
  moment.line = static_cast<int>(last.source.line);
  std::string file = options_.title;
  if (options_.has_file && last.source.file < files_.size())
    file = moment.file = files_[last.source.file];
  moment.rows.emplace_back(tr("Program"), line_text(file, moment.line));
  const double share = session_.progress();
  if (share >= 0) moment.rows.emplace_back(tr("Cut"), fmt::format("{:.0f} %", 100 * share));
  moment.rows.emplace_back(tr("Time on the machine"), time_left_text(end_s));
  if (last.tool > 0) moment.rows.emplace_back(tr("Tool"), fmt::format("T{}", last.tool));
  return moment;
}

ShopMoment RunBroadcast::end_moment() const {
  const Report& report = session_.report();
  ShopMoment moment;
  moment.state = "ended";
  moment.state_text = report.partial_reason.empty() ? tr("finished") : tr("not finished");
  moment.notice = in_unit(report.partial_reason, options_.unit);
  moment.rows.emplace_back(tr("Program"), options_.title);
  moment.rows.emplace_back(tr("Time on the machine"), time_left_text(report.motion.duration_s));
  if (!report.stock) return moment;
  const StockReport& stock = *report.stock;
  moment.rows.emplace_back(tr("Removed"),
                           volume_text(stock.blank_mm3 - stock.remaining_mm3, options_.unit));
  moment.rows.emplace_back(tr("Remaining"), volume_text(stock.remaining_mm3, options_.unit));
  return moment;
}

void RunBroadcast::end() {
  if (!broadcast_ || session_.stock() == nullptr) return;
  ShopNews news;
  news.stock = session_.stock()->snapshot();
  const ShopMoment moment = end_moment();
  news.moment = [moment](const std::string&) { return moment; };
  const Report& report = session_.report();
  ShopNews::Findings findings;
  findings.total = report.findings.total();
  const std::vector<Finding>& kept = report.findings.kept();
  for (std::size_t i = 0; i < std::min(kept.size(), ServedScene::kMostFindings); ++i) {
    findings.first.push_back(finding_object(kept[i], report.program.files, false, options_.unit));
  }
  news.all_findings = std::move(findings);
  broadcast_->tell(std::move(news));
}

}  // namespace kerf
