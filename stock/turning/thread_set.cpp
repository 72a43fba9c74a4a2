#include "stock/turning/thread_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::turning {
namespace {

/// A pass that takes less of a part than this may take nothing: it is looked at closely.
constexpr double kNothing_mm3 = 1e-9;

bool is_one_of(const std::shared_ptr<const ThreadPass>& pass,
               std::span<const std::shared_ptr<const ThreadPass>> others) {
  return std::find(others.begin(), others.end(), pass) != others.end();
}

}  // namespace

double ThreadSet::volume_mm3() const {
  return std::accumulate(volumes_mm3_.begin(), volumes_mm3_.end(), 0.0);
}

Rect ThreadSet::box() const {
  Rect box;
  for (const auto& pass : passes_) box.extend(pass->swept_box());
  return box;
}

void ThreadSet::drop(std::size_t pass) {
  const auto at = static_cast<std::ptrdiff_t>(pass);
  passes_.erase(passes_.begin() + at);
  cells_.erase(cells_.begin() + at);
  volumes_mm3_.erase(volumes_mm3_.begin() + at);
}

void ThreadSet::measure(std::size_t i, std::size_t first, std::span<const Contour> region) {
  const ThreadPass& pass = *passes_[i];
  const Vec2 low = pass.swept_low_mm(), high = pass.swept_high_mm();
  scratch_.edges.clear();
  append_edges(region, low.x, high.x, low.y, scratch_.edges);
  auto cells = std::make_shared<Cells>(ThreadIntegral::cell_count(pass), 0.0);
  if (cells_[i] != nullptr) std::copy_n(cells_[i]->begin(), first, cells->begin());
  for (std::size_t k = first; k < cells->size(); ++k) {
    (*cells)[k] = scratch_.integral.cell_mm3(pass, k, std::span(passes_).first(i), scratch_.edges);
  }
  volumes_mm3_[i] = std::accumulate(cells->begin(), cells->end(), 0.0);
  cells_[i] = std::move(cells);
}

void ThreadSet::add(std::vector<std::shared_ptr<const ThreadPass>> fresh,
                    std::span<const std::shared_ptr<const ThreadPass>> replaces,
                    std::span<const Contour> region) {
  const std::size_t old = passes_.size();
  for (auto& pass : fresh) {
    const bool is_known = std::any_of(passes_.begin(), passes_.end(), [&](const auto& other) {
      return !is_one_of(other, replaces) && other->covers(*pass);
    });
    if (is_known) continue;
    passes_.push_back(std::move(pass));
    cells_.push_back(nullptr);
    volumes_mm3_.push_back(0);
  }
  // What they cover goes; of what they go on from, the cells that stay as they were are kept.
  Rect gone;
  std::size_t begin = old, first_gone = passes_.size(), kept = 0;
  for (std::size_t i = old; i-- > 0;) {
    const ThreadPass& pass = *passes_[i];
    std::size_t by = begin;
    while (by < passes_.size() && !passes_[by]->covers(pass)) ++by;
    const bool is_replaced = is_one_of(passes_[i], replaces);
    if (by == passes_.size() && !is_replaced) continue;
    // The last of the old ones: nobody had to do with it.
    const bool goes_on = is_replaced && by < passes_.size() && i + 1 == by &&
                         passes_[by]->corners() == pass.corners();
    if (goes_on) {
      kept = cells_[i]->size() - 1;
      cells_[by] = cells_[i];
    } else {
      gone.extend(pass.swept_box());
      first_gone = i;
    }
    drop(i);
    --begin;
  }
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    const bool had_to_do = i >= first_gone && gone.meets(passes_[i]->swept_box());
    if (i < begin && !had_to_do) continue;
    measure(i, had_to_do || cells_[i] == nullptr ? 0 : kept, region);
  }
}

void ThreadSet::restore(std::vector<std::shared_ptr<const ThreadPass>> passes,
                        std::span<const Contour> region) {
  passes_ = std::move(passes);
  cells_.assign(passes_.size(), nullptr);
  volumes_mm3_.assign(passes_.size(), 0);
  for (std::size_t i = 0; i < passes_.size(); ++i) measure(i, 0, region);
}

void ThreadSet::refresh(const Rect& changed, std::span<const Contour> region) {
  for (std::size_t i = passes_.size(); i-- > 0;) {
    const ThreadPass& pass = *passes_[i];
    if (!changed.meets(pass.swept_box())) continue;
    const Vec2 low = pass.swept_low_mm(), high = pass.swept_high_mm();
    scratch_.edges.clear();
    append_edges(region, low.x, high.x, low.y, scratch_.edges);
    auto cells = std::make_shared<Cells>(*cells_[i]);
    const double step = ThreadIntegral::cell_mm(pass);
    for (std::size_t k = 0; k < cells->size(); ++k) {
      const Vec2 from = pass.at(static_cast<double>(k) * step),
                 to = pass.at(std::min(static_cast<double>(k + 1) * step, pass.length_mm()));
      Rect box;
      box.extend(to_units(pass.low_mm() + glm::min(from, to)));
      box.extend(to_units(pass.high_mm() + glm::max(from, to)));
      if (!changed.meets(box)) continue;
      (*cells)[k] =
          scratch_.integral.cell_mm3(pass, k, std::span(passes_).first(i), scratch_.edges);
    }
    volumes_mm3_[i] = std::accumulate(cells->begin(), cells->end(), 0.0);
    cells_[i] = std::move(cells);
    if (volumes_mm3_[i] > kNothing_mm3) continue;
    // What is no longer there is cut by nobody: the others stay as they are.
    pass.swept(scratch_.swept);
    if (!scratch_.cut.look(region, scratch_.swept)) drop(i);
  }
}

void ThreadSet::carve(double turns, double low_z_mm, double high_z_mm, ConvexCut& cut,
                      std::vector<Contour>& region) const {
  ConvexRegion outline;
  std::vector<Point> corners;
  const bool is_marked = !region.empty() && !region[0].runs()[0]->marks.empty();
  for (const auto& pass : passes_) {
    if (pass->swept_high_mm().x < low_z_mm || pass->swept_low_mm().x > high_z_mm) continue;
    // The part of the way on which the outline is between the two.
    double low = 0, high = pass->length_mm();
    if (const double z = pass->direction().x; z != 0) {
      const double a = (low_z_mm - pass->high_mm().x - pass->from_mm().x) / z,
                   b = (high_z_mm - pass->low_mm().x - pass->from_mm().x) / z;
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    const ThreadPass::Turns seen = pass->turns_seen(turns, turns, low, high);
    for (std::int64_t n = seen.first; n <= seen.last; ++n) {
      const Vec2 at = pass->at(pass->way_at(turns, static_cast<double>(n)));
      corners.clear();
      for (const Vec2& p : pass->corners()) corners.push_back(to_units(p + at));
      outline.assign(corners);
      if (outline.empty() || !cut.look(region, outline)) continue;
      if (is_marked) {
        cut.apply(region, pass->mark());
      } else {
        cut.apply(region);
      }
    }
  }
}

std::size_t ThreadSet::unique_bytes() const {
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    if (passes_[i].use_count() == 1)
      bytes += sizeof(ThreadPass) + passes_[i]->corners().capacity() * sizeof(Vec2);
    if (cells_[i].use_count() == 1) bytes += sizeof(Cells) + cells_[i]->capacity() * sizeof(double);
  }
  return bytes;
}

}  // namespace kerf::turning
