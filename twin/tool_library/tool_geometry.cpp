#include "twin/tool_library/tool_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text_scan.h"
#include "base/translate.h"
#include "stock/cutter/shape_spec.h"

namespace kerf {
namespace {

/// Libraries are written with a few decimals: less is no difference.
constexpr double kSame_mm = 0.01;

/// What is left of inches after they became mm is noise.
std::string length_text(double mm) { return number_text(std::round(mm * 1e6) / 1e6); }

double top_of(const Cutter& cutter) {
  return cutter.upper_profile().empty() ? cutter.profile().back().z1
                                        : cutter.upper_profile().back().z1;
}

std::string holder_text(const std::vector<HolderSection>& sections) {
  std::string text;
  for (const HolderSection& section : sections) {
    text += fmt::format("{}{}", text.empty() ? "" : "+", length_text(section.lower_mm));
    if (std::abs(section.upper_mm - section.lower_mm) > 1e-6) {
      text += '-' + length_text(section.upper_mm);
    }
    text += 'x' + length_text(section.length_mm);
  }
  return text;
}

/// Flutes, shank and holder as options of SHAPE, made to fit each other.
class Options {
 public:
  Options(const ToolGeometry& tool, const Cutter& bare, std::vector<std::string>& remarks)
      : tool_(tool), bare_(bare), remarks_(remarks), top_mm_(top_of(bare)) {
    fit_flutes();
    fit_stickout();
    fit_neck();
  }

  std::string text() const {
    std::string out = tool_.shape;
    if (flute_mm_) out += ":flute=" + length_text(*flute_mm_);
    if (!shank_.empty()) out += ":shank=" + shank_;
    if (stickout_mm_) {
      out += fmt::format(":holder={}:stickout={}", holder_text(tool_.holder),
                         length_text(*stickout_mm_));
    }
    if (tool_.teeth) out += fmt::format(":teeth={}", *tool_.teeth);
    return out;
  }

 private:
  /// A head with a neck has its flutes by its shape.
  void fit_flutes() {
    if (bare_.undercuts() || !tool_.flute_mm) return;
    flute_mm_ = tool_.flute_mm;
    if (*flute_mm_ >= top_mm_) return;
    if (*flute_mm_ < top_mm_ - kSame_mm) {
      remarks_.push_back(
          trf("flutes of {:.4g} mm end below the top of its shape, {:.4g} mm: they "
              "are taken to end there",
              *flute_mm_, top_mm_));
    }
    flute_mm_ = top_mm_;
  }

  void fit_stickout() {
    if (tool_.holder.empty()) return;
    if (!tool_.stickout_mm) {
      remarks_.push_back(tr("nothing says how far it sticks out of its holder: that is left out"));
      return;
    }
    if (*tool_.stickout_mm < top_mm_) {
      remarks_.push_back(
          trf("it sticks out {:.4g} mm, less than its shape is high ({:.4g} mm): "
              "its holder is left out",
              *tool_.stickout_mm, top_mm_));
      return;
    }
    stickout_mm_ = tool_.stickout_mm;
    if (flute_mm_ && *flute_mm_ > *stickout_mm_) {
      if (*flute_mm_ > *stickout_mm_ + kSame_mm) {
        remarks_.push_back(
            trf("flutes of {:.4g} mm reach into the holder, {:.4g} mm above the "
                "tip: they are taken to end there",
                *flute_mm_, *stickout_mm_));
      }
      flute_mm_ = stickout_mm_;
    }
  }

  void fit_neck() {
    const double flutes = bare_.undercuts() ? top_mm_ : flute_mm_.value_or(0);
    const bool knows_flutes = bare_.undercuts() || flute_mm_;
    const bool has_neck = knows_flutes && tool_.neck_mm && tool_.neck_top_mm &&
                          *tool_.neck_top_mm > flutes + kSame_mm;
    if (!has_neck) {
      if (tool_.shank_mm) shank_ = length_text(*tool_.shank_mm);
      return;
    }
    const bool hides_shank = stickout_mm_ && *tool_.neck_top_mm >= *stickout_mm_ - kSame_mm;
    const double width = tool_.shank_mm.value_or(*tool_.neck_mm);
    if (hides_shank || std::abs(width - *tool_.neck_mm) < kSame_mm) {
      shank_ = length_text(*tool_.neck_mm);
    } else {
      shank_ = fmt::format("{}x{}+{}", length_text(*tool_.neck_mm),
                           length_text(*tool_.neck_top_mm - flutes), length_text(width));
    }
  }

  const ToolGeometry& tool_;
  const Cutter& bare_;
  std::vector<std::string>& remarks_;
  double top_mm_;
  std::optional<double> flute_mm_, stickout_mm_;
  std::string shank_;
};

}  // namespace

std::string shape_text(std::string_view name, std::initializer_list<double> values) {
  std::string text(name);
  for (const double value : values) text += ':' + length_text(value);
  return text;
}

Result<Cutter> cutter_of(const ToolGeometry& tool, std::vector<std::string>& remarks) {
  // A cone without an end ends where its flutes do.
  const bool ends_with_flutes = tool.shape.starts_with("taper:");
  if (ends_with_flutes && !tool.flute_mm) {
    return Error{tr("nothing says how long its cone is: its flutes have no length")};
  }
  Result<Cutter> bare = parse_shape(
      ends_with_flutes ? fmt::format("{}:flute={}", tool.shape, length_text(*tool.flute_mm))
                       : tool.shape);
  if (!bare) return bare;
  std::vector<std::string> said;
  Result<Cutter> whole = parse_shape(Options(tool, *bare, said).text());
  if (whole) {
    remarks.insert(remarks.end(), said.begin(), said.end());
    return whole;
  }
  // What carries it is at fault: what cuts is understood.
  remarks.push_back(trf("shank and holder are left out: {}", whole.error()));
  return bare;
}

}  // namespace kerf
