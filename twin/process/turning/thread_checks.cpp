#include "twin/process/turning/thread_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "base/portable_math.h"
#include "base/translate.h"
#include "twin/collision/tool_bodies.h"
#include "twin/process/contact_grounds.h"
#include "twin/process/finding_at.h"

namespace kerf {
namespace {

struct ThreadForm {
  double angle_deg, outside, inside;
};
/// ISO 68-1, ISO 228-1, ISO 2901 and ASME B1.5.
constexpr std::array kThreadForms{ThreadForm{60, 0.6134, 0.5413}, ThreadForm{55, 0.6403, 0.6403},
                                  ThreadForm{30, 0.5, 0.5}, ThreadForm{29, 0.5, 0.5}};
constexpr double kAngleSlack_deg = 0.4;
/// Passes less apart in depth are as deep: spring passes, rounding.
constexpr double kAsDeep_mm = 0.005;
/// Of the lead: what differs by more is another thread.
constexpr double kSameLead = 1e-4;
/// Of the lead: starts that lie less apart are one.
constexpr double kSameStart = 0.04;
/// Threads are no more slanting to the axis, as a tangent.
constexpr double kMostTaper = 0.3;
/// Flanks that lean less from square to the axis are none of a thread.
constexpr double kLeastFlank = 0.2;
/// Pieces of one pass begin where the one before has ended.
constexpr double kSamePlace_mm = 1e-3;

/// Of the crest nearest to z; none where a pass in pieces is beside them, in the air.
std::optional<double> crest_near(const std::vector<Vec2>& crests_mm, double z_mm) {
  if (crests_mm.size() == 1) return crests_mm.front().y;
  const auto [low, high] = std::ranges::minmax(crests_mm, {}, &Vec2::x);
  if (z_mm < low.x || z_mm > high.x) return std::nullopt;
  return std::ranges::min(crests_mm, {}, [&](const Vec2& c) { return std::abs(c.x - z_mm); }).y;
}

/// Of what of a stretch lies within the workpiece, as far as that reaches along z.
std::optional<double> middle_within(const TurnedPart& part, double low_z_mm, double high_z_mm) {
  turning::Rect box;
  for (const turning::Contour& contour : part.contours()) box.extend(contour.box());
  if (box.empty()) return std::nullopt;
  const double low = std::max(low_z_mm, turning::to_mm(box.min_x));
  const double high = std::min(high_z_mm, turning::to_mm(box.max_x));
  if (low >= high) return std::nullopt;
  return 0.5 * (low + high);
}

/// Angle between the two flanks of a tool that points straight at the axis, or away from it.
std::optional<double> flank_angle_deg(const InsertOutline& outline, bool& in_bore) {
  std::optional<Vec2> front, back;
  for (const InsertPart& part : outline.parts) {
    Vec2 from = part.back().end_mm;
    for (const InsertEdge& edge : part) {
      const Vec2 way = edge.end_mm - from;
      const bool leaves = std::abs(edge.end_mm.y) > std::abs(from.y);
      from = edge.end_mm;
      if (edge.center_mm || glm::length(way) == 0) continue;
      const Vec2 out = glm::normalize(leaves ? way : -way);  // away from the tip
      if (edge.side == InsertSide::kFront) front = out;
      if (edge.side == InsertSide::kBack) back = out;
    }
  }
  if (!front || !back || std::abs(front->x) < kLeastFlank || front->x * back->x >= 0) {
    return std::nullopt;
  }
  // Symmetric: its middle is square to the axis.
  if (std::abs(front->x + back->x) > 1e-3 || front->y * back->y <= 0) return std::nullopt;
  in_bore = front->y < 0;
  return portable::acos(std::clamp(glm::dot(*front, *back), -1.0, 1.0)) * 180 / kPi;
}

/// From the controlled point to where the lower of the flanks ends.
double profile_height_mm(const InsertOutline& outline) {
  double front = 0, back = 0;
  for (const InsertPart& part : outline.parts) {
    Vec2 from = part.back().end_mm;
    for (const InsertEdge& edge : part) {
      const double far_mm = std::max(std::abs(edge.end_mm.y), std::abs(from.y));
      from = edge.end_mm;
      if (edge.side == InsertSide::kFront) front = std::max(front, far_mm);
      if (edge.side == InsertSide::kBack) back = std::max(back, far_mm);
    }
  }
  return std::min(front, back);
}

}  // namespace

void ThreadChecks::mount(const Cutter& cutter) {
  form_.reset();
  if (!cutter.insert()) return;
  bool in_bore = false;
  const std::optional<double> angle = flank_angle_deg(*cutter.insert(), in_bore);
  if (!angle) return;
  for (const ThreadForm& form : kThreadForms) {
    if (std::abs(form.angle_deg - *angle) < kAngleSlack_deg)
      form_ = Form{form.angle_deg, form.outside, form.inside, in_bore,
                   profile_height_mm(*cutter.insert())};
  }
}

/// Radius of the surface that the thread is cut into: the outermost, or the bore's.
std::optional<double> ThreadChecks::crest_at(double z_mm) const {
  std::optional<double> crest;
  for (const std::vector<Vec2>& ring : stock_.part().profile()) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.x > z_mm) == (b.x > z_mm)) continue;
      const double r = a.y + (z_mm - a.x) / (b.x - a.x) * (b.y - a.y);
      if (form_->in_bore && r <= 0) return std::nullopt;  // solid down to the axis
      if (!crest || (form_->in_bore ? r < *crest : r > *crest)) crest = r;
    }
  }
  return crest;
}

void ThreadChecks::follow_pass(const Motion& motion) {
  const bool goes_on = pass_ && pass_->source == motion.source &&
                       glm::distance(pass_->to_mm, motion.from_mm) < kSamePlace_mm;
  if (!goes_on) {
    const int number = pass_ ? pass_->number + 1 : 1;
    pass_ = Pass{number, motion.from_mm, motion.to_mm, motion.source};
  }
  pass_->to_mm = motion.to_mm;
}

/// Of a pass in pieces the first one that counts may begin a bit farther inside.
bool ThreadChecks::is_apart(double low_z_mm, double high_z_mm) const {
  const double beside_mm = thread_->crests_mm.size() > 1 ? thread_->lead_mm : 0;
  return low_z_mm >= thread_->high_z_mm + beside_mm || high_z_mm <= thread_->low_z_mm - beside_mm;
}

void ThreadChecks::note(const TurnedMove& move) {
  const Motion& m = move.motion;
  if (!form_ || m.kind != MotionKind::kThread || m.feed_mm_per_min <= 0) return;
  const double low = std::min(m.from_mm.z, m.to_mm.z), high = std::max(m.from_mm.z, m.to_mm.z);
  // Ways in and out slant (E and L of G76); taper threads hardly do.
  const double across = std::abs(m.to_mm.x - m.from_mm.x);
  if (across >= kMostTaper * (high - low)) return;
  const double lead = m.feed_mm_per_min * (high - low) / portable::hypot(across, high - low);
  const std::optional<double> middle = middle_within(stock_.part(), low, high);
  follow_pass(m);
  if (!middle) return;  // beside the workpiece
  const double z = *middle, done = (z - m.from_mm.z) / (m.to_mm.z - m.from_mm.z);
  const double x = std::abs(m.from_mm.x + done * (m.to_mm.x - m.from_mm.x));
  const std::optional<double> there = crest_at(z);
  const auto below = [&](double crest) { return form_->in_bore ? x - crest : crest - x; };
  if (!there || below(*there) <= 0) return;  // in the air
  if (thread_ && (std::abs(thread_->lead_mm - lead) > kSameLead * lead ||
                  (thread_->last_pass != pass_->number && is_apart(low, high)))) {
    end();
  }
  if (!thread_) {
    thread_ = Thread{};
    thread_->lead_mm = lead;
    thread_->low_z_mm = low;
    thread_->high_z_mm = high;
    thread_->first_pass = pass_->number;
  }
  Thread& thread = *thread_;
  thread.last_pass = pass_->number;
  if (thread.first_pass == pass_->number) thread.crests_mm.emplace_back(z, *there);
  thread.low_z_mm = std::min(thread.low_z_mm, low);
  thread.high_z_mm = std::max(thread.high_z_mm, high);
  const std::optional<double> crest = crest_near(thread.crests_mm, z);
  if (!crest) return;
  const double depth = below(*crest);
  tell_body(move, thread, depth);
  if (depth < thread.depth_mm - kAsDeep_mm || depth <= 0) return;
  if (depth > thread.depth_mm + kAsDeep_mm) thread.phases.clear();
  const double phase = pass_->from_mm.z / lead;
  if (thread.phases.empty() || thread.phases.back() != phase) thread.phases.push_back(phase);
  if (depth <= thread.depth_mm) return;
  thread.depth_mm = depth;
  thread.source = m.source;
  thread.time_s = move.step.start_s;
  thread.place_mm = pass_->from_mm;
  thread.tool = move.tool;
  thread.tool_guessed = move.tool_guessed;
}

/// Once a thread. How high the profile of a guessed tool is nobody knows.
void ThreadChecks::tell_body(const TurnedMove& move, Thread& thread, double depth_mm) {
  if (thread.body_told || move.tool_guessed || depth_mm <= form_->profile_mm + kBeyond_mm) return;
  thread.body_told = true;
  Finding finding = finding_at(FindingId::kFlankContact, Severity::kError, move.motion, move.step);
  finding.text =
      trf("the thread is {:.2f} mm deep, and the profile of the insert {:.2f} mm high: what of it "
          "does not cut runs into the crests",
          depth_mm, form_->profile_mm);
  finding.hint = tr("edge=L of the tool's SHAPE is how high its profile is");
  finding.position_mm = move.motion.from_mm;
  finding.tool = move.tool;
  finding.depth_mm = depth_mm - form_->profile_mm;
  finding.bodies = {to_string(ToolPart::kCutter), kWorkpieceBody};
  log_.add(std::move(finding));
}

void ThreadChecks::end() {
  if (!thread_ || !form_) return thread_.reset();
  const Thread thread = *std::exchange(thread_, std::nullopt);
  if (thread.depth_mm <= 0) return;
  std::vector<double> starts;
  for (const double phase : thread.phases) {
    const bool known = std::ranges::any_of(starts, [&](double start) {
      const double apart = phase - start;
      return std::abs(apart - std::round(apart)) < kSameStart;
    });
    if (!known) starts.push_back(phase);
  }
  const double pitch = thread.lead_mm / static_cast<double>(starts.size());
  const double share = form_->in_bore ? form_->inside : form_->outside;
  if (thread.depth_mm >= share * pitch * (1 - kMissing)) return;
  const Grounds grounds{false, thread.tool_guessed};
  Finding finding =
      finding_at(FindingId::kThreadShallow, Severity::kWarning, thread.source, thread.time_s);
  finding.text = trf("the thread is {:.3f} mm deep: a pitch of {:g} mm and {:g} degrees ask for "
                     "{:.3f} mm ({:g} P)",
                     thread.depth_mm, pitch, form_->angle_deg, share * pitch, share) +
                 doubt_of(FindingId::kThreadShallow, grounds);
  finding.position_mm = thread.place_mm;
  finding.tool = thread.tool;
  finding.hint =
      tr("deeper passes: K of G76 is the whole depth; or the diameter before the "
         "thread is another one than it should be");
  log_.add(std::move(finding));
}

}  // namespace kerf
