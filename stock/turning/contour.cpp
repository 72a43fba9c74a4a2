#include "stock/turning/contour.h"

#include <cmath>
#include <cstdlib>

namespace kerf::turning {

RunPointer make_run(std::vector<Point> points, std::vector<std::uint32_t> marks) {
  auto run = std::make_shared<Run>();
  run->points = std::move(points);
  run->marks = std::move(marks);
  for (std::size_t i = 0; i < run->points.size(); ++i) {
    run->box.extend(run->points[i]);
    if (i == 0) continue;
    run->area2 += static_cast<std::uint64_t>(area2_of(run->points[i - 1], run->points[i]));
    run->moment6 += moment6_of(run->points[i - 1], run->points[i]);
  }
  return run;
}

Contour::Contour(std::vector<RunPointer> runs) : runs_(std::move(runs)) {
  std::uint64_t area2 = 0;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const Run& run = *runs_[i];
    const Point &last = run.points.back(),
                &next = runs_[i + 1 == runs_.size() ? 0 : i + 1]->points.front();
    box_.extend(run.box);
    area2 += run.area2 + static_cast<std::uint64_t>(area2_of(last, next));
    moment6_ += run.moment6 + moment6_of(last, next);
  }
  area2_ = static_cast<std::int64_t>(area2);
}

std::size_t Contour::corner_count() const {
  std::size_t count = 0;
  for (const RunPointer& run : runs_) count += run->points.size();
  return count;
}

Ring Contour::ring() const {
  Ring ring;
  for (const RunPointer& run : runs_)
    ring.insert(ring.end(), run->points.begin(), run->points.end());
  return ring;
}

bool Contour::is_thinner(double units) const {
  const double area2 = std::abs(static_cast<double>(area2_));
  const auto across = static_cast<double>(box_.max_x - box_.min_x + box_.max_y - box_.min_y);
  if (area2 >= units * across * static_cast<double>(corner_count())) return false;
  double around = 0;
  const Point* before = &runs_.back()->points.back();
  for (const RunPointer& run : runs_) {
    for (const Point& p : run->points) {
      const auto x = static_cast<double>(p.X - before->X), y = static_cast<double>(p.Y - before->Y);
      around += std::sqrt(x * x + y * y);
      before = &p;
    }
  }
  return area2 < units * around;
}

ContourBuilder::Place ContourBuilder::place_from_end(std::size_t back) const {
  if (back < open_.size()) return {nullptr, open_.size() - 1 - back};
  back -= open_.size();
  std::size_t run = runs_.size() - 1;
  while (back >= runs_[run]->points.size()) back -= runs_[run--]->points.size();
  return {runs_[run].get(), runs_[run]->points.size() - 1 - back};
}

const Point& ContourBuilder::from_end(std::size_t back) const {
  const Place place = place_from_end(back);
  return place.run == nullptr ? open_[place.index] : place.run->points[place.index];
}

std::uint32_t ContourBuilder::mark_from_end(std::size_t back) const {
  const Place place = place_from_end(back);
  return place.run == nullptr ? open_marks_[place.index] : place.run->marks[place.index];
}

/// Whether `corner` is none: of the line from `before` to `after`, and no other mark begins there;
/// where the way turns back it is none in any case.
bool ContourBuilder::is_passed(const Point& before, const Point& corner, const Point& after,
                               std::size_t before_from_end, std::size_t corner_from_end) const {
  if (turn(before, corner, after) != 0) return false;
  if (!is_marked_ || mark_from_end(before_from_end) == mark_from_end(corner_from_end)) return true;
  return (corner.X - before.X) * (after.X - corner.X) +
             (corner.Y - before.Y) * (after.Y - corner.Y) <
         0;
}

void ContourBuilder::open_last() {
  open_ = runs_.back()->points;
  open_marks_ = runs_.back()->marks;
  runs_.pop_back();
}

void ContourBuilder::pop_back() {
  if (open_.empty()) open_last();
  open_.pop_back();
  if (is_marked_) open_marks_.pop_back();
  --count_;
}

void ContourBuilder::pop_front() {
  --count_;
  if (runs_.empty()) {
    open_.erase(open_.begin());
    if (is_marked_) open_marks_.erase(open_marks_.begin());
    return;
  }
  const Run& first = *runs_[0];
  std::vector<Point> rest(first.points.begin() + 1, first.points.end());
  std::vector<std::uint32_t> marks;
  if (is_marked_) marks.assign(first.marks.begin() + 1, first.marks.end());
  if (rest.empty()) {
    runs_.erase(runs_.begin());
  } else {
    runs_[0] = make_run(std::move(rest), std::move(marks));
  }
}

void ContourBuilder::flush() {
  if (open_.empty()) return;
  runs_.push_back(make_run(std::move(open_), std::move(open_marks_)));
  open_ = {};
  open_marks_ = {};
}

/// False: p is the last corner.
bool ContourBuilder::push(const Point& p) {
  while (count_ > 0) {
    if (from_end(0) == p) return false;
    if (count_ < 2 || !is_passed(from_end(1), from_end(0), p, 1, 0)) break;
    pop_back();
  }
  if (open_.size() >= 2 * kRun) flush();
  open_.push_back(p);
  ++count_;
  return true;
}

void ContourBuilder::append(const Point& p) { push(p); }

void ContourBuilder::append(const Point& p, std::uint32_t mark) {
  is_marked_ = true;
  if (push(p)) {
    open_marks_.push_back(mark);
    return;
  }
  // What began there has no length.
  if (open_.empty()) open_last();
  open_marks_.back() = mark;
}

void ContourBuilder::append(const RunPointer& run) {
  // Copied where it would leave runs of a few corners behind, and where it may meet what is before
  // it in a straight line.
  constexpr std::size_t kLone = kRun / 4;
  const std::size_t n = run->points.size();
  bool shared = n >= kLone && (open_.size() >= kLone || open_.size() + n > 2 * kRun ||
                               (open_.empty() && !runs_.empty()));
  if (shared && count_ > 0) {
    shared = !(from_end(0) == run->points[0]) &&
             (count_ < 2 || turn(from_end(1), from_end(0), run->points[0]) != 0) &&
             turn(from_end(0), run->points[0], run->points[1]) != 0;
  }
  if (!shared) {
    for (std::size_t i = 0; i < n; ++i) {
      if (run->marks.empty()) {
        append(run->points[i]);
      } else {
        append(run->points[i], run->marks[i]);
      }
    }
    return;
  }
  is_marked_ = !run->marks.empty();
  flush();
  runs_.push_back(run);
  count_ += n;
}

Contour ContourBuilder::close() {
  for (bool changed = true; changed && count_ >= 3;) {
    const Point& first = runs_.empty() ? open_[0] : runs_[0]->points[0];
    const Point second = runs_.empty()                 ? open_[1]
                         : runs_[0]->points.size() > 1 ? runs_[0]->points[1]
                         : runs_.size() > 1            ? runs_[1]->points[0]
                                                       : open_[0];
    changed = true;
    if (from_end(0) == first || is_passed(from_end(1), from_end(0), first, 1, 0)) {
      pop_back();
    } else if (is_passed(from_end(0), first, second, 0, count_ - 1)) {
      pop_front();
    } else {
      changed = false;
    }
  }
  flush();
  Contour contour;
  if (count_ >= 3) contour = Contour(std::move(runs_));
  runs_.clear();
  open_marks_.clear();
  count_ = 0;
  is_marked_ = false;
  return contour;
}

}  // namespace kerf::turning
