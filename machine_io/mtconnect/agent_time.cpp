#include "machine_io/mtconnect/agent_time.h"

#include <algorithm>
#include <chrono>

#include "base/text_scan.h"

namespace kerf {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// Clocks of computers part by less than so much of the time that passes.
constexpr std::int64_t kDriftParts = 5000;
/// The quickest of late is forgotten slowly: an agent that becomes slower, another adapter.
constexpr std::int64_t kSlowerParts = 1000;
/// Stamps are cut off to ms, and are made before and after others.
constexpr std::int64_t kStampSlack_ns = 50'000'000;

/// Takes `digits` digits off the front.
bool take_number(std::string_view& text, std::size_t digits, int& out) {
  if (text.size() < digits || !read_number(text.substr(0, digits), out) || text[0] == '-') {
    return false;
  }
  text.remove_prefix(digits);
  return true;
}

bool take_char(std::string_view& text, char wanted) {
  if (text.empty() || text[0] != wanted) return false;
  text.remove_prefix(1);
  return true;
}

/// "", "Z", "+02:00", "-0530": seconds ahead of UTC.
std::optional<int> read_zone(std::string_view text) {
  if (text.empty() || text == "Z" || text == "z") return 0;
  const int sign = text[0] == '-' ? -1 : 1;
  if (!take_char(text, '+') && !take_char(text, '-')) return std::nullopt;
  int hours = 0, minutes = 0;
  if (!take_number(text, 2, hours)) return std::nullopt;
  take_char(text, ':');
  if (!text.empty() && !take_number(text, 2, minutes)) return std::nullopt;
  if (!text.empty() || hours > 15 || minutes > 59) return std::nullopt;
  return sign * (hours * 3600 + minutes * 60);
}

/// ".123" off the front: ns, and that of its last digit. Digits after the ninth are dropped.
void take_fraction(std::string_view& text, AgentTime& out) {
  out.resolution_ns = kSecond_ns;
  if (text.size() < 2 || text[0] != '.' || !is_digit(text[1])) return;
  text.remove_prefix(1);
  while (!text.empty() && is_digit(text[0])) {
    if (out.resolution_ns > 1) {
      out.resolution_ns /= 10;
      out.ns += (text[0] - '0') * out.resolution_ns;
    }
    text.remove_prefix(1);
  }
}

}  // namespace

std::optional<AgentTime> parse_agent_time(std::string_view text) {
  text = text.substr(0, text.find('@'));
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  const bool is_date = take_number(text, 4, year) && take_char(text, '-') &&
                       take_number(text, 2, month) && take_char(text, '-') &&
                       take_number(text, 2, day) && (take_char(text, 'T') || take_char(text, 't'));
  const bool is_time = is_date && take_number(text, 2, hour) && take_char(text, ':') &&
                       take_number(text, 2, minute) && take_char(text, ':') &&
                       take_number(text, 2, second);
  // 60: a leap second. Years beyond 2200 are beyond 64 bits of ns soon.
  if (!is_time || year < 1970 || year > 2200 || hour > 24 || minute > 59 || second > 60) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  AgentTime out;
  take_fraction(text, out);
  const std::optional<int> zone_s = read_zone(text);
  if (!zone_s) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  out.ns += (days * 86400 + hour * 3600 + minute * 60 + second - *zone_s) * kSecond_ns;
  return out;
}

void StampClock::heard(std::optional<std::int64_t> asked_ns, std::int64_t received_ns,
                       AgentTime created) {
  const std::int64_t most = received_ns - created.ns;
  if (!known_ && !asked_ns) return;
  const std::int64_t drift_ns = (received_ns - heard_ns_) / kDriftParts + 1000;
  heard_ns_ = received_ns;
  const std::int64_t least =
      asked_ns ? *asked_ns - created.ns - created.resolution_ns : least_ns_ - drift_ns;
  if (known_ && least <= most_ns_ + drift_ns && most >= least_ns_ - drift_ns) {
    least_ns_ = std::max(least, least_ns_ - drift_ns);
    most_ns_ = std::min(most, most_ns_ + drift_ns);
    return;
  }
  // The first, or one of the clocks has been set.
  const std::int64_t width_ns = most_ns_ - least_ns_;
  most_ns_ = most;
  least_ns_ = asked_ns ? least : most - width_ns;
  quickest_ns_.reset();
  known_ = true;
}

void StampClock::observed(std::int64_t stamp_ns, std::int64_t received_ns) {
  const std::int64_t took_ns = received_ns - stamp_ns;
  const std::int64_t slower_ns = (received_ns - observed_ns_) / kSlowerParts;
  quickest_ns_ = quickest_ns_ ? std::min(took_ns, *quickest_ns_ + slower_ns) : took_ns;
  observed_ns_ = received_ns;
}

std::optional<double> StampClock::behind_s() const {
  if (!quickest_ns_ || !known_) return std::nullopt;
  const std::int64_t usual_ns = *quickest_ns_ - offset_ns();
  const std::int64_t slack_ns = kStampSlack_ns + doubt_ns();
  if (usual_ns >= -slack_ns && usual_ns <= kMostUsual_ns + slack_ns) return std::nullopt;
  return static_cast<double>(usual_ns) * 1e-9;
}

std::int64_t StampClock::age_ns(std::int64_t stamp_ns, std::int64_t received_ns) const {
  if (!behind_s()) return answer_age_ns(stamp_ns, received_ns);
  return std::max<std::int64_t>(0, received_ns - stamp_ns - *quickest_ns_);
}

std::int64_t StampClock::answer_age_ns(std::int64_t created_ns, std::int64_t received_ns) const {
  if (!known_) return 0;
  return std::max<std::int64_t>(0, received_ns - created_ns - offset_ns());
}

}  // namespace kerf
