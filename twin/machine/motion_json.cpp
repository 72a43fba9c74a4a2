#include "twin/machine/motion_json.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "interp_bridge/motion_kinds.h"

namespace kerf {
namespace {

/// "12.5", "-3", "0" (never "-0"), "1e+20".
void append_number(double value, std::string& out) {
  const double scaled = std::round(value * 1e6) / 1e6;
  fmt::format_to(std::back_inserter(out), "{}", scaled == 0 ? 0.0 : scaled);
  // fmt writes 5.0 for a whole double; JSON needs no ".0".
  if (out.size() >= 2 && out.compare(out.size() - 2, 2, ".0") == 0) out.resize(out.size() - 2);
}

void append_field(const char* name, double value, std::string& out) {
  out += ",\"";
  out += name;
  out += "\":";
  append_number(value, out);
}

template <class Vector>
void append_vector(const char* name, const Vector& v, std::string& out) {
  out += ",\"";
  out += name;
  out += "\":[";
  for (int i = 0; i < 3; ++i) {
    if (i > 0) out += ',';
    append_number(v[static_cast<typename Vector::size_type>(i)], out);
  }
  out += ']';
}
void append_vector(const char* name, const Vec3& v, std::string& out) {
  append_vector(name, std::array<double, 3>{v.x, v.y, v.z}, out);
}

bool is_zero(const std::array<double, 3>& abc) { return abc[0] == 0 && abc[1] == 0 && abc[2] == 0; }

/// null for an axis of which nothing says where it goes.
void append_end(const Motion& m, std::string& out) {
  if (m.unknown_to == 0) return append_vector("to", m.to_mm, out);
  out += ",\"to\":";
  for (int i = 0; i < 3; ++i) {
    out += i == 0 ? '[' : ',';
    if ((m.unknown_to >> i & 1) != 0) {
      out += "null";
    } else {
      append_number(m.to_mm[i], out);
    }
  }
  out += ']';
}

void append_axes(const char* name, std::uint8_t axes, std::string& out) {
  if (axes == 0) return;
  out += fmt::format(",\"{}\":\"", name);
  for (std::size_t i = 0; i < 3; ++i) {
    if ((axes >> i & 1) != 0) out += "XYZ"[i];
  }
  out += '"';
}

void append_way(const Motion& m, std::string& out) {
  if (m.start_known) {
    append_vector("from", m.from_mm, out);
  } else {
    out += ",\"from\":null";
  }
  append_end(m, out);
  append_axes("unknown_from", m.unknown_from, out);
  append_axes("unknown_to", m.unknown_to, out);
  if (!is_zero(m.from_abc_deg) || !is_zero(m.to_abc_deg)) {
    append_vector("from_abc", m.from_abc_deg, out);
    append_vector("to_abc", m.to_abc_deg, out);
  }
  if (m.from_uvw_mm != Vec3(0) || m.to_uvw_mm != Vec3(0)) {
    append_vector("from_uvw", m.from_uvw_mm, out);
    append_vector("to_uvw", m.to_uvw_mm, out);
  }
  if (m.kind == MotionKind::kArc && m.start_known) {
    append_vector("center", m.arc.center_mm, out);
    append_vector("axis", m.arc.axis, out);
    append_field("sweep_deg", m.arc.sweep_rad * 180 / kPi, out);
  }
  if (m.length.tip_shift_mm != Vec3(0)) append_vector("tip_off", m.length.tip_shift_mm, out);
  if (m.length.displaces && m.length.uvw_off_mm != Vec3(0)) {
    append_vector("tip_off_uvw", m.length.uvw_off_mm, out);
  }
  if (m.kind == MotionKind::kTraverse) return;
  append_field("feed", m.feed_mm_per_min, out);
  if (m.feed_per_rev || m.kind == MotionKind::kThread) out += ",\"feed_per_rev\":true";
}

void append_path_mode(const Motion& m, std::string& out) {
  if (m.path_mode == PathMode::kExactStop) out += ",\"path\":\"exact-stop\"";
  if (m.path_mode == PathMode::kExactPath) out += ",\"path\":\"exact-path\"";
  if (m.blend_tolerance_mm > 0) append_field("blend_mm", double{m.blend_tolerance_mm}, out);
  if (m.merge_tolerance_mm > 0) append_field("merge_mm", double{m.merge_tolerance_mm}, out);
}

void append_spindle_and_coolant(const Motion& m, std::string& out) {
  if (m.spindle != SpindleState::kStopped) {
    out += m.spindle == SpindleState::kClockwise ? ",\"spindle\":\"cw\"" : ",\"spindle\":\"ccw\"";
    append_field("rpm", m.spindle_rpm, out);
  }
  if (!m.flood && !m.mist) return;
  out += ",\"coolant\":[";
  if (m.flood) out += "\"flood\"";
  if (m.flood && m.mist) out += ',';
  if (m.mist) out += "\"mist\"";
  out += ']';
}

/// What is not as at the start of every program.
void append_torch(const TorchState& torch, std::string& out) {
  if (torch.spindles_on > 1)
    fmt::format_to(std::back_inserter(out), ",\"spindles\":{}", torch.spindles_on);
  if (torch.outputs != 0) {
    const char* comma = ",\"outputs\":[";
    for (unsigned n = 0; n < TorchState::kOutputs; ++n) {
      if (!torch.output(n)) continue;
      fmt::format_to(std::back_inserter(out), "{}{}", comma, n);
      comma = ",";
    }
    out += ']';
  }
  if (torch.analog != std::array<float, TorchState::kAnalogs>{}) {
    const char* comma = ",\"analog\":[";
    for (const float value : torch.analog) {
      out += comma;
      append_number(double{value}, out);
      comma = ",";
    }
    out += ']';
  }
  if (torch.adaptive_feed) out += ",\"adaptive_feed\":true";
  if (torch.overburn) out += ",\"overburn\":true";
  if (torch.material != 0) {
    fmt::format_to(std::back_inserter(out), ",\"material\":{}", torch.material);
  }
}

}  // namespace

const char* to_string(MotionKind kind) {
  switch (kind) {
    case MotionKind::kTraverse:
      return "traverse";
    case MotionKind::kFeed:
      return "feed";
    case MotionKind::kArc:
      return "arc";
    case MotionKind::kThread:
      return "thread";
    case MotionKind::kProbe:
      return "probe";
    case MotionKind::kDwell:
      return "dwell";
    case MotionKind::kToolChange:
      return "tool-change";
    case MotionKind::kStop:
      return "stop";
    case MotionKind::kProgramEnd:
      return "program-end";
    case MotionKind::kSignal:
      return "signal";
  }
  return "";
}

void MotionJson::set_files(const std::vector<std::string>& files) {
  for (std::size_t i = quoted_files_.size(); i < files.size(); ++i) {
    // Names may hold bytes that are not UTF-8.
    quoted_files_.push_back(
        nlohmann::json(files[i]).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  }
}

void MotionJson::append(const Motion& m, const TimedStep& step, std::string& out) const {
  fmt::format_to(std::back_inserter(out), "{{\"line\":{},\"file\":", m.source.line);
  out += m.source.file < quoted_files_.size() ? quoted_files_[m.source.file] : "null";
  out += ",\"kind\":\"";
  out += to_string(m.kind);
  out += '"';
  if (is_move(m)) {
    append_way(m, out);
    append_path_mode(m, out);
  }
  fmt::format_to(std::back_inserter(out), ",\"tool\":{}", m.tool);
  append_spindle_and_coolant(m, out);
  append_torch(m.torch, out);
  append_field("t", step.start_s, out);
  append_field("duration", step.duration_s, out);
  out += "}\n";
}

}  // namespace kerf
