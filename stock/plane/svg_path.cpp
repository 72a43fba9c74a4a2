#include "stock/plane/svg_path.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "base/portable_math.h"
#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/plane/outline_curves.h"

namespace kerf::plane {
namespace {

constexpr double kMaxUser = 1e6;
/// Ends of a path that close it without Z: what six digits are good for.
constexpr double kClosed = 1e-4;
constexpr std::size_t kMaxPoints = 10'000'000;

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}
  void skip() {
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n,").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }
  bool ended() { return skip(), at_ >= text_.size(); }
  std::size_t at() const { return at_; }
  char peek() const { return text_[at_]; }
  char take() { return text_[at_++]; }

  Result<double> number() {
    skip();
    const std::size_t begin = at_;
    bool point = false;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      const char before = at_ > begin ? text_[at_ - 1] : 'e';
      const bool sign = (c == '+' || c == '-') && (at_ == begin || before == 'e' || before == 'E');
      const bool first_point = c == '.' && !point;
      const bool exponent = (c == 'e' || c == 'E') && at_ > begin;
      if (!is_digit(c) && !sign && !first_point && !exponent) break;
      point |= first_point || exponent;
    }
    const std::string_view found = text_.substr(begin, at_ - begin);
    const std::optional<double> value = parse_decimal(found);
    if (!value || std::abs(*value) > kMaxUser) {
      return Error{trf("character {}: '{}' is not a number", begin + 1,
                       shown(found.empty() ? text_.substr(begin, 10) : found))};
    }
    return *value;
  }

  /// A flag of an arc may stand without a blank before what follows.
  Result<double> flag() {
    skip();
    if (at_ < text_.size() && (text_[at_] == '0' || text_[at_] == '1'))
      return static_cast<double>(text_[at_++] - '0');
    return Error{trf("character {}: an arc's flag must be 0 or 1", at_ + 1)};
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

class PathReader {
 public:
  PathReader(std::string_view text, double tolerance) : scan_(text), tolerance_(tolerance) {}

  Result<std::vector<std::vector<Vec2>>> read() {
    char command = 0;
    while (error_.empty() && !scan_.ended()) {
      const bool letter =
          std::string_view("MmLlHhVvCcSsQqTtAaZz").find(scan_.peek()) != std::string_view::npos;
      if (letter) {
        command = scan_.take();
      } else if (command == 0 || command == 'Z' || command == 'z') {
        const char found = scan_.peek();
        fail(trf("character {}: '{}' is no command", scan_.at() + 1,
                 shown(std::string_view(&found, 1))));
        break;
      } else if (command == 'M' || command == 'm') {
        command = command == 'M' ? 'L' : 'l';  // further pairs are lines
      }
      if (ring_.empty() && command != 'M' && command != 'm') {
        fail(tr("a part does not begin with M"));
        break;
      }
      run(command);
      if (count_ > kMaxPoints) fail(trf("more than {} points", kMaxPoints));
    }
    end_part(false);
    if (!error_.empty()) return Error{error_};
    return std::move(rings_);
  }

 private:
  void fail(const std::string& what) {
    if (error_.empty()) error_ = what;
  }
  double number() {
    const Result<double> value = scan_.number();
    if (!value) fail(value.error());
    return value ? *value : 0;
  }
  Vec2 point(const Vec2& origin) {
    const double x = number();
    return origin + Vec2(x, number());
  }

  void run(char command) {
    const bool relative = command >= 'a';
    const Vec2 here = ring_.empty() ? last_ : ring_.back();
    const Vec2 origin = relative ? here : Vec2(0);
    const std::size_t before = ring_.size();
    Vec2 cubic = here, quadratic = here;  // where S and T would begin after another command
    switch (command) {
      case 'M':
      case 'm': {
        const Vec2 begin = point(origin);
        end_part(false);
        ring_ = {begin};
        break;
      }
      case 'L':
      case 'l':
        ring_.push_back(point(origin));
        break;
      case 'H':
      case 'h':
        ring_.emplace_back(origin.x + number(), here.y);
        break;
      case 'V':
      case 'v':
        ring_.emplace_back(here.x, origin.y + number());
        break;
      case 'C':
      case 'c':
      case 'S':
      case 's': {
        const bool smooth = command == 'S' || command == 's';
        const Vec2 first = smooth ? 2.0 * here - cubic_or(here) : point(origin);
        const Vec2 second = point(origin), to = point(origin);
        if (error_.empty()) append_bezier(first, second, to, tolerance_, ring_);
        cubic = second;
        break;
      }
      case 'Q':
      case 'q':
      case 'T':
      case 't': {
        const bool smooth = command == 'T' || command == 't';
        const Vec2 control = smooth ? 2.0 * here - quadratic_or(here) : point(origin);
        const Vec2 to = point(origin);
        if (error_.empty())
          append_bezier(here + 2.0 / 3 * (control - here), to + 2.0 / 3 * (control - to), to,
                        tolerance_, ring_);
        quadratic = control;
        break;
      }
      case 'A':
      case 'a':
        run_arc(here, origin);
        break;
      default:
        end_part(true);
        return;
    }
    after_cubic_ = std::string_view("CcSs").find(command) != std::string_view::npos;
    after_quadratic_ = std::string_view("QqTt").find(command) != std::string_view::npos;
    cubic_ = cubic;
    quadratic_ = quadratic;
    count_ += ring_.size() > before ? ring_.size() - before : 0;
  }

  Vec2 cubic_or(const Vec2& here) const { return after_cubic_ ? cubic_ : here; }
  Vec2 quadratic_or(const Vec2& here) const { return after_quadratic_ ? quadratic_ : here; }

  /// From the ends to the centre: SVG 1.1, appendix F.6.5.
  void run_arc(const Vec2& here, const Vec2& origin) {
    double rx = std::abs(number()), ry = std::abs(number());
    const double turned = number() * kPi / 180;
    const Result<double> large = scan_.flag();
    if (!large) return fail(large.error());
    const Result<double> ccw = scan_.flag();
    if (!ccw) return fail(ccw.error());
    const Vec2 to = point(origin);
    if (!error_.empty() || to == here) return;
    if (rx == 0 || ry == 0) return ring_.push_back(to);
    const double c = portable::cos(turned), s = portable::sin(turned);
    const Vec2 half = (here - to) / 2.0;
    const Vec2 p(c * half.x + s * half.y, -s * half.x + c * half.y);
    const double reach = p.x * p.x / (rx * rx) + p.y * p.y / (ry * ry);
    if (reach > 1) {
      rx *= std::sqrt(reach);
      ry *= std::sqrt(reach);
    }
    const double square = std::max(1 / std::min(reach, 1.0) - 1, 0.0);
    const double factor = (*large == *ccw ? -1 : 1) * std::sqrt(square);
    const Vec2 mid(factor * rx * p.y / ry, -factor * ry * p.x / rx);
    const Vec2 center = (here + to) / 2.0 + Vec2(c * mid.x - s * mid.y, s * mid.x + c * mid.y);
    const double from = portable::atan2((p.y - mid.y) / ry, (p.x - mid.x) / rx);
    const double until = portable::atan2((-p.y - mid.y) / ry, (-p.x - mid.x) / rx);
    double sweep = until - from;
    if (*ccw == 1 && sweep < 0) sweep += 2 * kPi;
    if (*ccw == 0 && sweep > 0) sweep -= 2 * kPi;
    // The tolerance holds for the longer axis's circle, and so for the ellipse within it.
    const double finer = tolerance_ * std::min(1.0, rx / ry);
    append_arc(center, rx, from, sweep, finer, ring_, ry / rx, turned);
    ring_.back() = to;
  }

  void end_part(bool closes) {
    if (ring_.empty()) return;
    last_ = ring_.front();
    const bool returns = ring_.size() > 1 && glm::length(ring_.front() - ring_.back()) <= kClosed;
    if (ring_.size() > 1) {
      if (!closes && !returns)
        fail(trf("an open part, from {:.4f},{:.4f} to {:.4f},{:.4f}; must end with Z",
                 ring_.front().x, ring_.front().y, ring_.back().x, ring_.back().y));
      if (returns) ring_.pop_back();
      rings_.push_back(ring_);
    }
    // After Z the next part may begin where this one did.
    ring_.clear();
    if (closes) ring_.push_back(last_);
  }

  Scanner scan_;
  double tolerance_;
  std::vector<Vec2> ring_;
  Vec2 last_{0}, cubic_{0}, quadratic_{0};
  bool after_cubic_ = false, after_quadratic_ = false;
  std::size_t count_ = 0;
  std::string error_;
  std::vector<std::vector<Vec2>> rings_;
};

}  // namespace

Result<std::vector<double>> parse_numbers(std::string_view text) {
  Scanner scan(text);
  std::vector<double> numbers;
  while (!scan.ended()) {
    const Result<double> value = scan.number();
    if (!value) return Error{value.error()};
    numbers.push_back(*value);
  }
  return numbers;
}

Result<std::vector<std::vector<Vec2>>> parse_svg_path(std::string_view text, double tolerance) {
  return PathReader(text, tolerance).read();
}

}  // namespace kerf::plane
