// judge_contacts < CASE: decides contacts that kerf has told of, one line of output each. Nothing
// of kerf is in it: no model of a workpiece, no grid over one, no envelopes.
//
// A part against the workpiece: points are laid over the part where the tool stands at the contact,
// those in the blank are kept, and each way before takes those that its cutter passes over. One
// that is left is material inside the part, whatever the cells of a workpiece are. A part against a
// fixture: the distance of two convex bodies, by projections from one to the other and back.
//
// CASE, lengths in mm, angles in degrees:
//     blank box X0 Y0 Z0 X1 Y1 Z1 | blank rod X Y Z0 Z1 D
//     cell EDGE                                  of the workpiece that kerf had
//     tool N KIND D A B FLUTES                   flat, ball, bull (A: corner), cone (A: half angle,
//     B: tip) part N NAME WIDTH FROM_Z TO_Z fixture NAME X0 Y0 Z0 X1 Y1 Z1 move LINE TOOL BEGIN END
//     x y z  x y z  a b c  a b c  [arc cx cy cz ax ay az SWEEP] contact ID LINE TIME TOOL  x y z
//     PART WIDTH FROM_Z OTHER DEPTH
// A, B and C turn a table left-handed about lines through 0 0 0; A carries B carries C. Output:
//     ID VERDICT PLACE_MM      true | near (half a cell more) | false | lost (no such move)

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct V {
  double x = 0, y = 0, z = 0;
};
V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
V operator*(double s, V a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double norm(V a) { return std::sqrt(dot(a, a)); }
/// So near kerf's way is to the true one while a table turns.
constexpr double kWay_mm = 0.01;
constexpr double kRad = 0.017453292519943295;

std::istream& operator>>(std::istream& in, V& v) { return in >> v.x >> v.y >> v.z; }

V turned(V p, V axis, double rad) {
  const double c = std::cos(rad), s = std::sin(rad);
  return c * p + s * cross(axis, p) + (1 - c) * dot(axis, p) * axis;
}

/// From the machine to the workpiece on its table, which turns left-handed: back about A, B, C.
V on_table(V p, V abc_deg) {
  p = turned(p, {1, 0, 0}, abc_deg.x * kRad);
  p = turned(p, {0, 1, 0}, abc_deg.y * kRad);
  return turned(p, {0, 0, 1}, abc_deg.z * kRad);
}

struct Tool {
  std::string kind;
  double radius = 0, a = 0, b = 0, flutes = 0;

  /// Height of its lower side above the tip, r from its axis.
  double low(double r) const {
    if (kind == "ball") return radius - std::sqrt(std::max(0.0, radius * radius - r * r));
    if (kind == "bull") {
      const double over = r - (radius - a);
      return over <= 0 ? 0 : a - std::sqrt(std::max(0.0, a * a - over * over));
    }
    if (kind == "cone") return std::max(0.0, r - b / 2) / std::tan(a * kRad);
    return 0;
  }
};

struct Part {
  std::string name;
  double radius, from_z, to_z;
};

struct Pose {
  V tip, axis;
};

struct Move {
  int line = 0, tool = 0;
  double begin = 0, end = 0;
  V from, to, abc_from, abc_to;
  bool is_arc = false;
  V center, about;
  double sweep = 0;
  V low, high;  ///< of its tips, and a little more where it turns

  bool turns() const { return norm(abc_to - abc_from) > 0; }
  bool tilted() const { return norm(abc_from) > 0 || norm(abc_to) > 0; }
  V way(double t) const {
    if (!is_arc) return from + t * (to - from);
    // Where the ends are not equally far from the center the radius changes evenly.
    const V arm = from - center;
    const double along = dot(arm, about);
    const V across = arm - along * about;
    const V arm_to = to - center;
    const V across_to = arm_to - dot(arm_to, about) * about;
    const double grow = 1 + t * (norm(across_to) / std::max(norm(across), 1e-12) - 1);
    return center + grow * turned(across, about, t * sweep) +
           (along + t * dot(to - from, about)) * about;
  }
  Pose pose(double t) const {
    if (!tilted()) return {way(t), {0, 0, 1}};
    const V abc = abc_from + t * (abc_to - abc_from);
    return {on_table(way(t), abc), on_table({0, 0, 1}, abc)};
  }
  double length() const {
    if (!is_arc) return norm(to - from);
    const double arm = std::max(norm(from - center), norm(to - center));
    return std::abs(sweep) * arm + norm(to - from);
  }
  /// No place of a tool within reach of the tip goes farther.
  double travel(double reach) const {
    const V d = abc_to - abc_from;
    const double turn = (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) * kRad;
    return length() + turn * (reach + std::max(norm(from), norm(to)));
  }
  void bound() {
    low = {1e9, 1e9, 1e9}, high = {-1e9, -1e9, -1e9};
    const int pieces = 64;
    const double slack = is_arc || turns() ? travel(0) / pieces : 0;
    for (int i = 0; i <= pieces; i += is_arc || turns() ? 1 : pieces) {
      const V p = pose(static_cast<double>(i) / pieces).tip;
      low = {std::min(low.x, p.x - slack), std::min(low.y, p.y - slack),
             std::min(low.z, p.z - slack)};
      high = {std::max(high.x, p.x + slack), std::max(high.y, p.y + slack),
              std::max(high.z, p.z + slack)};
    }
  }
};

struct Box {
  V low, high;
  V nearest(V p) const {
    return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y),
            std::clamp(p.z, low.z, high.z)};
  }
};

struct Contact {
  std::string id;
  int line = 0, tool = 0;
  double time = 0;
  V tip;
  std::string part;
  double width = 0, from_z = 0;
  std::string other;
  double depth = 0;
};

struct Blank {
  bool rod = false;
  Box box;
  double x = 0, y = 0, radius = 0;
  bool has(V p) const {
    if (p.z < box.low.z || p.z > box.high.z) return false;
    if (rod) return std::hypot(p.x - x, p.y - y) <= radius;
    return p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y;
  }
};

/// Where a convex function is least.
template <class Function>
double least_at(const Function& f, double a, double b) {
  const double ratio = 0.6180339887498949;
  const double ends[] = {a, b};
  double x = b - ratio * (b - a), y = a + ratio * (b - a), fx = f(x), fy = f(y);
  for (int i = 0; i < 45; ++i) {
    if (fx < fy) {
      b = y, y = x, fy = fx, x = b - ratio * (b - a), fx = f(x);
    } else {
      a = x, x = y, fx = fy, y = a + ratio * (b - a), fy = f(y);
    }
  }
  double best = fx < fy ? x : y;
  for (const double end : ends)
    if (f(end) < f(best)) best = end;
  return best;
}

/// Does the cutter pass over p on the move, up to `until`? `top`: how high above its tip it cuts.
bool passes(const Tool& tool, const Move& move, V p, double until, double top) {
  const double r2 = tool.radius * tool.radius;
  if (!move.tilted() && !move.is_arc) {
    // The chord on which p is within its width; there the height of its lower side over p is
    // convex.
    const V d = move.to - move.from, w = p - move.from;
    const double a = d.x * d.x + d.y * d.y, b = w.x * d.x + w.y * d.y;
    const double c = w.x * w.x + w.y * w.y - r2;
    double t0 = 0, t1 = until;
    if (a < 1e-18) {
      if (c > 0) return false;
    } else {
      const double disc = b * b - a * c;
      if (disc < 0) return false;
      t0 = std::max(t0, (b - std::sqrt(disc)) / a), t1 = std::min(t1, (b + std::sqrt(disc)) / a);
      if (t0 > t1) return false;
    }
    const auto floor = [&](double t) {
      const double r = std::hypot(w.x - t * d.x, w.y - t * d.y);
      return move.from.z + t * d.z + tool.low(std::min(r, tool.radius)) - p.z;
    };
    const double middle = least_at(floor, t0, t1);
    if (floor(middle) > 0) return false;
    if (!std::isfinite(top)) return true;
    // Where it is low enough, one of the ends is where it stands highest.
    const auto end = [&](double inside, double outside) {
      if (floor(outside) <= 0) return outside;
      for (int i = 0; i < 40; ++i) {
        const double half = (inside + outside) / 2;
        (floor(half) <= 0 ? inside : outside) = half;
      }
      return inside;
    };
    const double high = std::max(end(middle, t0) * d.z, end(middle, t1) * d.z);
    return move.from.z + high + top >= p.z;
  }
  const double speed = move.travel(std::isfinite(top) ? top + tool.radius : 200);
  for (double t = 0;;) {
    const Pose pose = move.pose(t);
    const V w = p - pose.tip;
    const double z = dot(w, pose.axis);
    const double r = norm(w - z * pose.axis);
    const double short_of = std::max({r - tool.radius, -z, z - top});
    double lack = short_of;
    if (short_of <= 0) {
      lack = tool.low(r) - z;
      if (lack <= 0) return true;
      // A slope of the lower side may be steep: then the next step is as short as steps are.
      lack = 0;
    }
    if (t >= until || speed == 0) return false;
    t = std::min(until, t + std::max(lack, 0.004) / speed);
  }
}

/// How near a part comes to boxes, by projections to and fro.
struct Body {
  Tool cutter;  ///< of the cutter itself; without a kind: a cylinder
  double radius, from_z, to_z;

  Body thinner(double by) const {
    Body out{cutter, radius - by, from_z + by, to_z - by};
    out.cutter.radius -= by;
    if (out.cutter.kind == "bull") out.cutter.a = std::max(0.0, out.cutter.a - by);
    return out;
  }
  double low(double r) const { return from_z + cutter.low(r); }
  V nearest(V p, const Pose& pose) const {
    const V w = p - pose.tip;
    double z = dot(w, pose.axis);
    const V out = w - z * pose.axis;
    double r = norm(out);
    const V unit = r > 1e-12 ? 1 / r * out : V{};
    if (!cutter.kind.empty() && cutter.kind != "flat") {
      nearest_of_cutter(r, z);
    } else {
      z = std::clamp(z, from_z, to_z), r = std::min(r, radius);
    }
    return pose.tip + r * unit + z * pose.axis;
  }
  /// Its lower side is convex: the nearest of 400 places of it, and of its cylinder.
  void nearest_of_cutter(double& r, double& z) const {
    if (r <= radius && z <= to_z && z >= low(r)) return;
    const double inside = std::min(r, radius), up = std::clamp(z, low(inside), to_z);
    double best = std::hypot(r - inside, z - up), at_r = inside, at_z = up;
    const auto far = [&](double s) { return std::hypot(r - s, z - low(s)); };
    for (int i = 0; i <= 400; ++i) {
      const double s = radius * i / 400;
      if (far(s) < best) best = far(s), at_r = s, at_z = low(s);
    }
    r = at_r, z = at_z;
  }
};

double gap(const Body& body, const Pose& pose, const Box& box) {
  V p = box.nearest(pose.tip + (body.from_z + body.to_z) / 2 * pose.axis);
  double last = 1e9;
  for (int i = 0; i < 20000; ++i) {
    const V q = body.nearest(p, pose);
    p = box.nearest(q);
    const double now = norm(p - q);
    if (now < 1e-7 || (i > 50 && last - now < 1e-10)) return now;
    last = now;
  }
  return last;
}

class Judge {
 public:
  void read(std::istream& in);
  void decide() {
    for (const Contact& contact : contacts_) {
      double place = 0;
      const std::string verdict =
          contact.other == "workpiece" ? of_workpiece(contact, place) : of_fixture(contact, place);
      std::printf("%s %s %.4f\n", contact.id.c_str(), verdict.c_str(), place);
      std::fflush(stdout);
    }
  }

 private:
  struct Place {
    std::size_t move;
    double t;
  };
  std::optional<Place> place_of(const Contact& contact) const;
  std::string of_workpiece(const Contact& contact, double& place) const;
  std::string of_fixture(const Contact& contact, double& place) const;
  bool any_left(const Contact& contact, const Part& part, Place at, double wider) const;
  void lay(const Part& part, const Pose& pose, double wider, std::vector<V>& points) const;

  Blank blank_;
  double cell_ = 0.1;
  std::map<int, Tool> tools_;
  std::map<int, std::vector<Part>> parts_;
  std::map<std::string, Box> fixtures_;
  std::vector<Move> moves_;
  std::vector<Contact> contacts_;
};

void Judge::read(std::istream& in) {
  std::string text, word;
  while (std::getline(in, text)) {
    std::istringstream line(text);
    line >> word;
    if (word == "blank") {
      line >> word;
      blank_.rod = word == "rod";
      if (blank_.rod) {
        line >> blank_.x >> blank_.y >> blank_.box.low.z >> blank_.box.high.z >> blank_.radius;
        blank_.radius /= 2;
      } else {
        line >> blank_.box.low >> blank_.box.high;
      }
    } else if (word == "cell") {
      line >> cell_;
    } else if (word == "tool") {
      int number = 0;
      Tool tool;
      double d = 0;
      line >> number >> tool.kind >> d >> tool.a >> tool.b >> tool.flutes;
      tool.radius = d / 2;
      tools_[number] = tool;
    } else if (word == "part") {
      int number = 0;
      Part part{};
      line >> number >> part.name >> part.radius >> part.from_z >> part.to_z;
      part.radius /= 2;
      parts_[number].push_back(part);
    } else if (word == "fixture") {
      Box box;
      std::string name;
      line >> name >> box.low >> box.high;
      fixtures_[name] = box;
    } else if (word == "move") {
      Move move;
      line >> move.line >> move.tool >> move.begin >> move.end >> move.from >> move.to >>
          move.abc_from >> move.abc_to;
      if (line >> word && word == "arc") {
        move.is_arc = true;
        line >> move.center >> move.about >> move.sweep;
        move.sweep *= kRad;
      }
      move.bound();
      moves_.push_back(move);
    } else if (word == "contact") {
      Contact contact;
      line >> contact.id >> contact.line >> contact.time >> contact.tool >> contact.tip >>
          contact.part >> contact.width >> contact.from_z >> contact.other >> contact.depth;
      contacts_.push_back(contact);
    }
    if (!line && !line.eof()) std::cerr << "not understood: " << text << "\n";
  }
}

/// The move of that line and time, and where on it the tip is there.
std::optional<Judge::Place> Judge::place_of(const Contact& contact) const {
  std::optional<Place> found;
  double best = 0.02;
  for (std::size_t i = 0; i < moves_.size(); ++i) {
    const Move& move = moves_[i];
    if (move.line != contact.line || contact.time < move.begin - 0.002 ||
        contact.time > move.end + 0.002)
      continue;
    const auto away = [&](double t) { return norm(move.pose(t).tip - contact.tip); };
    const int pieces = move.is_arc || move.turns() ? 400 : 8;
    for (int k = 0; k < pieces; ++k) {
      double a = static_cast<double>(k) / pieces, b = static_cast<double>(k + 1) / pieces;
      while (b - a > 1e-9) {
        const double x = a + (b - a) / 3, y = b - (b - a) / 3;
        (away(x) <= away(y) ? b : a) = away(x) <= away(y) ? y : x;
      }
      // Of a tip that comes by twice the first.
      if (away(a) < best - 1e-6) best = away(a), found = Place{i, a};
    }
  }
  return found;
}

void Judge::lay(const Part& part, const Pose& pose, double wider, std::vector<V>& points) const {
  const double radius = part.radius + wider;
  const double low = part.from_z - (pose.axis.z < 1 ? wider : 0) + 0.0005;
  double step = cell_ / 3;
  const double most = 150000;
  if (3.15 * radius * radius / (step * step) > most) step = radius * std::sqrt(3.15 / most);
  if (pose.axis.z == 1) {
    // The middles of kerf's cells are among them where the blank's corner is that of a cell.
    const double z = pose.tip.z + low, x0 = blank_.box.low.x + cell_ / 2,
                 y0 = blank_.box.low.y + cell_ / 2;
    if (step < cell_ / 3.01 || step > cell_ / 2.99) {
      step = cell_ * std::max(1.0, std::round(step / cell_));
    }
    for (double i = std::ceil((pose.tip.x - radius - x0) / step);
         x0 + i * step < pose.tip.x + radius; ++i) {
      for (double k = std::ceil((pose.tip.y - radius - y0) / step);
           y0 + k * step < pose.tip.y + radius; ++k) {
        const V p{x0 + i * step, y0 + k * step, z};
        if (std::hypot(p.x - pose.tip.x, p.y - pose.tip.y) <= radius && blank_.has(p))
          points.push_back(p);
      }
    }
    // And its rim.
    const int around = std::clamp(static_cast<int>(6.3 * radius / step), 64, 4000);
    for (int i = 0; i < around; ++i) {
      const double a = 6.283185307179586 * i / around;
      const V p{pose.tip.x + radius * std::cos(a), pose.tip.y + radius * std::sin(a), z};
      if (blank_.has(p)) points.push_back(p);
    }
    return;
  }
  const V side =
      norm(cross(pose.axis, {0, 0, 1})) > 1e-6 ? cross(pose.axis, {0, 0, 1}) : V{1, 0, 0};
  const V u = 1 / norm(side) * side, v = cross(pose.axis, u);
  step = std::min(cell_ / 2, std::max(step, 0.05));
  const double top = std::min(part.to_z + wider, low + 120);
  for (double r = radius; r > -step; r -= step) {
    const double ring = std::max(r, 0.0);
    const int around = std::max(1, static_cast<int>(6.3 * ring / step));
    for (int i = 0; i < around; ++i) {
      const double a = 6.283185307179586 * i / around;
      const V out = pose.tip + ring * (std::cos(a) * u + std::sin(a) * v);
      for (const double z : {low, top})
        if (const V p = out + z * pose.axis; blank_.has(p)) points.push_back(p);
      if (r < radius) continue;
      for (double z = low + step; z < top; z += step)
        if (const V p = out + z * pose.axis; blank_.has(p)) points.push_back(p);
    }
  }
}

bool Judge::any_left(const Contact& contact, const Part& part, Place at, double wider) const {
  const Pose pose = moves_[at.move].pose(at.t);
  std::vector<V> points;
  lay(part, pose, wider, points);
  // The last moves first: they are near.
  for (std::size_t i = at.move + 1; i-- > 0 && !points.empty();) {
    const Move& move = moves_[i];
    const auto known = tools_.find(move.tool);
    if (known == tools_.end()) continue;
    const Tool& tool = known->second;
    const bool now = i == at.move;
    // What stands higher than the flutes is not cut on this move. Before it was either cut, or
    // told.
    const double top = now || move.tilted() ? tool.flutes : std::numeric_limits<double>::infinity();
    const double reach = tool.radius + (move.tilted() ? top : 0);
    std::erase_if(points, [&](V p) {
      if (p.x < move.low.x - reach || p.x > move.high.x + reach || p.y < move.low.y - reach ||
          p.y > move.high.y + reach || p.z < move.low.z - (move.tilted() ? reach : 0))
        return false;
      return passes(tool, move, p, now ? at.t : 1, top);
    });
  }
  (void)contact;
  return !points.empty();
}

std::string Judge::of_workpiece(const Contact& contact, double& place) const {
  const auto at = place_of(contact);
  if (!at) return "lost";
  const auto& all = parts_.at(contact.tool);
  const auto own = std::find_if(all.begin(), all.end(), [&](const Part& part) {
    return part.name == contact.part &&
           (contact.width == 0 || std::abs(2 * part.radius - contact.width) < 0.01) &&
           std::abs(part.from_z - contact.from_z) < 0.01;
  });
  if (own == all.end()) return "lost";
  const Move& move = moves_[at->move];
  const double length = std::max(move.travel(own->from_z), 1e-9);
  for (const double further : {0.0, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0}) {
    const Place there{at->move, std::min(1.0, at->t + further / length)};
    if (any_left(contact, *own, there, 0)) {
      place = further;
      return "true";
    }
    if (there.t >= 1) break;
  }
  return any_left(contact, *own, *at, cell_ / 2) ? "near" : "false";
}

std::string Judge::of_fixture(const Contact& contact, double& place) const {
  const auto at = place_of(contact);
  if (!at) return "lost";
  const Box& box = fixtures_.at(contact.other);
  const Tool& tool = tools_.at(contact.tool);
  const Move& move = moves_[at->move];
  std::vector<Body> bodies;
  for (const Part& part : parts_.at(contact.tool))
    if (part.name == contact.part) bodies.push_back({{}, part.radius, part.from_z, part.to_z});
  if (contact.part == "cutter") bodies.push_back({tool, tool.radius, 0, tool.flutes});
  const double speed = std::max(move.travel(200), 1e-9);
  // Where one of them, so much thinner, first is nearer than that; by steps that cannot jump over
  // it.
  const auto first = [&](double thinner, double near) -> std::optional<double> {
    for (double t = 0;;) {
      double now = 1e9;
      for (const Body& body : bodies)
        now = std::min(now, gap(body.thinner(thinner), move.pose(t), box));
      if (now <= near + 2e-6) return t;
      if (t >= 1) return std::nullopt;
      t = std::min(1.0, t + std::max(now - near, 1e-5) / speed);
    }
  };
  const auto touch = first(0, 0), before = first(0, kWay_mm);
  if (!touch) return before ? "near" : "false";
  // What comes to it at a flat angle is that near, and that deep, for long.
  const double from = std::min(*before, *touch), to = first(kWay_mm, 0).value_or(1);
  if (at->t < from || at->t > to)
    place = norm(move.pose(std::clamp(at->t, from, to)).tip - contact.tip);
  return "true";
}

}  // namespace

int main() {
  Judge judge;
  judge.read(std::cin);
  judge.decide();
  return 0;
}
