#include "stock/cutter/profile_file.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "base/portable_math.h"
#include "base/small_file.h"
#include "base/suggest.h"
#include "base/translate.h"
#include "stock/cutter/scan.h"

namespace kerf {
namespace {

constexpr double kMaxRadius_mm = 500;
constexpr double kMaxHeight_mm = 2000;
constexpr double kMinArcRadius_mm = 0.001;
constexpr double kMaxArcRadius_mm = 10000;
/// How far an arc may miss its ends or its level: files are written with three or four decimals.
constexpr double kFitTolerance_mm = 1e-3;

constexpr std::array<std::string_view, 7> kKeywords = {"line",  "arc",   "start", "upper",
                                                       "flute", "shank", "holder"};

using Words = std::vector<std::string_view>;

class Reader {
 public:
  /// Error without file and line.
  Done read_line(const Words& words) {
    const std::string keyword = to_lower(words[0]);
    if (keyword == "line") return read_piece(words, 3, "line R Z");
    if (keyword == "arc") return read_piece(words, 5, tr("arc R Z RADIUS cw|ccw"));
    if (keyword == "start") return read_start(words);
    if (keyword == "upper") return read_upper(words);
    if (keyword == "flute") return read_option(words, file_.flute);
    if (keyword == "shank") return read_option(words, file_.shank);
    if (keyword == "holder") return read_option(words, file_.holder);
    return Error{
        trf("unknown keyword '{}'{} Allowed: line, arc, start, upper, flute, shank, holder",
            shown(words[0]), did_you_mean(words[0], kKeywords))};
  }
  ProfileFile take() { return std::move(file_); }
  bool has_pieces() const { return !file_.pieces.empty(); }

 private:
  Done read_start(const Words& words) {
    if (words.size() != 3) return Error{tr("wrong number of values; the form is 'start 0 Z'")};
    if (has_pieces()) return Error{tr("start must come before the first line or arc")};
    const Result<double> r = parse_within("R", words[1], 0, 0, "mm");
    if (!r) return Error{r.error()};
    const Result<double> z = parse_within("Z", words[2], 0, kMaxHeight_mm, "mm");
    if (!z) return Error{z.error()};
    z_ = *z;
    return std::monostate{};
  }

  Done read_upper(const Words& words) {
    if (words.size() != 1) return Error{tr("'upper' takes no value")};
    if (!has_pieces()) return Error{tr("upper must come after the lower side of the outline")};
    if (upper_) return Error{tr("'upper' is given twice")};
    upper_ = true;
    return std::monostate{};
  }

  Done read_option(const Words& words, std::optional<std::string>& option) {
    if (words.size() != 2) {
      return Error{trf("'{}' takes one value", to_lower(words[0]))};
    }
    if (option) return Error{trf("'{}' is given twice", to_lower(words[0]))};
    option = std::string(words[1]);
    return std::monostate{};
  }

  Done read_piece(const Words& words, std::size_t count, std::string_view form) {
    if (words.size() != count) {
      return Error{trf("wrong number of values; the form is '{}'", form)};
    }
    std::vector<ProfilePiece>& pieces = upper_ ? file_.upper_pieces : file_.pieces;
    if (pieces.size() >= kMaxProfilePieces) {
      return Error{trf("more than {} pieces", kMaxProfilePieces)};
    }
    const Result<double> r = parse_within("R", words[1], 0, kMaxRadius_mm, "mm");
    if (!r) return Error{r.error()};
    const Result<double> z = parse_within("Z", words[2], 0, kMaxHeight_mm, "mm");
    if (!z) return Error{z.error()};
    if (upper_ && *r > r_) {
      return Error{trf("the radius rises from {} to {}; the upper side must run inward",
                       number_text(r_), number_text(*r))};
    }
    if (!upper_ && *r < r_) {
      return Error{trf("the radius falls from {} to {}; the outline must run outward",
                       number_text(r_), number_text(*r))};
    }
    if (*r == r_ && *z == z_) return Error{tr("the piece has no length")};
    ProfilePiece piece;
    piece.r0 = r_;
    piece.z0 = z_;
    piece.r1 = *r;
    piece.z1 = *z;
    if (count == 5) {
      Done arc = make_arc(words, piece);
      if (arc) arc = upper_ ? level_with_start(piece) : level_with_end(piece);
      if (!arc) return arc;
    }
    pieces.push_back(piece);
    r_ = *r;
    z_ = *z;
    return std::monostate{};
  }

  /// Centre from ends, radius and sense: on the left of the way for ccw, on the right for cw.
  static Done make_arc(const Words& words, ProfilePiece& piece) {
    const Result<double> radius =
        parse_within("RADIUS", words[3], kMinArcRadius_mm, kMaxArcRadius_mm, "mm");
    if (!radius) return Error{radius.error()};
    const std::string sense = to_lower(words[4]);
    if (sense != "cw" && sense != "ccw") {
      return Error{trf("'{}' is not a sense; must be cw or ccw", shown(words[4]))};
    }
    const double dr = piece.r1 - piece.r0;
    const double dz = piece.z1 - piece.z0;
    const double half_chord = portable::hypot(dr, dz) / 2;
    if (half_chord > *radius + kFitTolerance_mm / 2) {
      return Error{trf("arc radius {} is too small: the ends are {:.4g} mm apart",
                       number_text(*radius), 2 * half_chord)};
    }
    piece.kind = ProfilePiece::Kind::kArc;
    piece.convex = sense == "ccw";
    piece.radius = std::max(*radius, half_chord);
    const double offset =
        std::sqrt(std::max(0.0, (piece.radius - half_chord) * (piece.radius + half_chord))) *
        (piece.convex ? 1 : -1) / (2 * half_chord);
    piece.center_r = (piece.r0 + piece.r1) / 2 - dz * offset;
    piece.center_z = (piece.z0 + piece.z1) / 2 + dr * offset;
    return std::monostate{};
  }

  /// An arc that ends upright has its centre level with that end. Written with a few decimals it
  /// may come out slightly below, as if the arc turned back: fit the circle through both ends with
  /// the centre on that level instead.
  static Done level_with_end(ProfilePiece& arc) {
    const double level = arc.convex ? std::max(arc.z0, arc.z1) : std::min(arc.z0, arc.z1);
    const double excess = arc.convex ? level - arc.center_z : arc.center_z - level;
    if (excess <= 0) return std::monostate{};
    if (excess > kFitTolerance_mm || arc.r1 == arc.r0) {
      return Error{tr("the arc turns back inward; it must not pass its widest point")};
    }
    const double a = arc.z0 - level;
    const double b = arc.z1 - level;
    arc.center_z = level;
    arc.center_r = (arc.r0 + arc.r1) / 2 + (b - a) * (b + a) / (2 * (arc.r1 - arc.r0));
    arc.radius = portable::hypot(arc.r1 - arc.center_r, b);
    return std::monostate{};
  }

  /// The same on the upper side, where an arc may start upright.
  static Done level_with_start(ProfilePiece& arc) {
    const auto turn_over = [](ProfilePiece& piece) {
      std::swap(piece.r0, piece.r1);
      std::swap(piece.z0, piece.z1);
      piece.z0 = -piece.z0;
      piece.z1 = -piece.z1;
      piece.center_z = -piece.center_z;
    };
    turn_over(arc);
    const Done done = level_with_end(arc);
    turn_over(arc);
    return done;
  }

  ProfileFile file_;
  bool upper_ = false;
  double r_ = 0;
  double z_ = 0;
};

}  // namespace

Result<ProfileFile> parse_profile_text(std::string_view text, const std::string& name) {
  Reader reader;
  int number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    const Words words = words_of(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    const Done done = reader.read_line(words);
    if (!done) return Error{fmt::format("{}:{}: {}", name, number, done.error())};
  }
  if (!reader.has_pieces()) {
    return Error{trf("{}: no outline found; at least one 'line R Z' is needed", name)};
  }
  return reader.take();
}

Result<std::vector<HolderSection>> parse_holder_profile(std::string_view text,
                                                        const std::string& name) {
  std::vector<HolderSection> sections;
  double r = 0, z = 0;
  int number = 0;
  const auto refuse = [&](const std::string& message) {
    return Error{fmt::format("{}:{}: {}", name, number, message)};
  };
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    const Words words = words_of(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    if (to_lower(words[0]) != "line" || words.size() != 3) {
      return refuse(trf("'{}' is not allowed; an outline of a holder has 'line R Z' alone",
                        shown(trim(line))));
    }
    const Result<double> next_r = parse_within("R", words[1], 0, kMaxRadius_mm, "mm");
    if (!next_r) return refuse(next_r.error());
    const Result<double> next_z = parse_within("Z", words[2], 0, kMaxHeight_mm, "mm");
    if (!next_z) return refuse(next_z.error());
    if (*next_z < z) {
      return refuse(trf("Z falls from {} to {}; the outline must run upward", number_text(z),
                        number_text(*next_z)));
    }
    if (*next_z > z) {
      if (!(r > 0) || !(*next_r > 0)) return refuse(tr("the radius must be above 0"));
      if (sections.size() >= kMaxProfilePieces) {
        return refuse(trf("more than {} pieces", kMaxProfilePieces));
      }
      sections.push_back({2 * r, 2 * *next_r, *next_z - z});
    }
    r = *next_r;
    z = *next_z;
  }
  if (!sections.empty()) return sections;
  return Error{trf("{}: no outline found; at least 'line R 0' and 'line R Z' are needed", name)};
}

namespace {

Result<std::string> read_outline(const std::string& path) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path, code);
  if (!std::filesystem::exists(status)) return Error{trf("{}: no such file", shown(path))};
  if (!std::filesystem::is_regular_file(status)) {
    return Error{trf("{}: not a regular file", shown(path))};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{fmt::format("{}: {}", shown(path), std::strerror(errno))};
  const std::string text = read_up_to(file, kMaxProfileBytes + 1);
  if (file.bad()) return Error{trf("{}: read error", shown(path))};
  if (text.size() > kMaxProfileBytes) {
    return Error{trf("{}: larger than {} bytes", shown(path), kMaxProfileBytes)};
  }
  return text;
}

}  // namespace

Result<ProfileFile> read_profile_file(const std::string& path) {
  const Result<std::string> text = read_outline(path);
  if (!text) return Error{text.error()};
  return parse_profile_text(*text, path);
}

Result<std::vector<HolderSection>> read_holder_profile(const std::string& path) {
  const Result<std::string> text = read_outline(path);
  if (!text) return Error{text.error()};
  return parse_holder_profile(*text, path);
}

}  // namespace kerf
