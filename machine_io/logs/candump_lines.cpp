// Frames of a candump log, gathered to samples.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/translate.h"
#include "machine_io/can/can_map.h"
#include "machine_io/logs/candump_line.h"
#include "machine_io/logs/log_lines.h"

namespace kerf {
namespace {

// So many frames without one of the map's tell that it is the wrong map, or the wrong log.
constexpr std::uint64_t kFramesToTell = 10'000;
// Identifiers that are counted for that; 29-bit buses can have very many.
constexpr std::size_t kMostIds = 256;
constexpr std::size_t kMostIdsShown = 12;

using Id = std::pair<std::uint32_t, bool>;  // and whether it is extended

class CandumpFrames final : public LogLines {
 public:
  explicit CandumpFrames(const LogSettings& settings)
      : assembler_(*settings.can_map), interface_(settings.can_interface) {
    const auto add = [this](const std::optional<CanSignal>& signal) {
      if (!signal) return;
      const Id id{signal->id, signal->extended};
      if (std::find(ids_.begin(), ids_.end(), id) == ids_.end()) ids_.push_back(id);
    };
    for (const auto& signal : settings.can_map->axes) add(signal);
    add(settings.can_map->tool);
    add(settings.can_map->line);
    add(settings.can_map->spindle);
    add(settings.can_map->tool_offset_z);
    add(settings.can_map->trigger);
    add(settings.can_map->load);
  }

  LineMeaning read(std::string_view text, LineRemark& remark) override {
    if (text.empty() || text.front() == '#') return LineMeaning::kNothing;
    CandumpFault fault;
    if (!read_candump_line(text, line_, fault)) {
      remark.column = fault.column;
      remark.message = fault.text;
      return LineMeaning::kDamaged;
    }
    if (!interface_.empty() && line_.interface != interface_) return LineMeaning::kNothing;
    watch_ids();
    watch_interfaces();
    const CanAssembler::Taken taken = assembler_.push(line_.frame, line_.time_ns);
    switch (taken) {
      case CanAssembler::Taken::kUnfit:
        remark.message = assembler_.unfit_text();
        remark.column = 1;
        return LineMeaning::kDamaged;
      case CanAssembler::Taken::kLate:
        return LineMeaning::kLate;
      case CanAssembler::Taken::kClockStepped:
        return LineMeaning::kClockSet;
      default:
        return LineMeaning::kSample;
    }
  }

  bool next_sample(AxisSample& sample) override { return assembler_.next(sample); }

  void end() override {
    assembler_.flush();
    is_ended_ = true;
  }

  bool judges_order() const override { return true; }
  std::uint64_t incomplete() const override { return assembler_.incomplete(); }
  std::string incomplete_text() const override { return assembler_.incomplete_text(); }

  bool take_complaint(std::string& text) override {
    if (is_watching_ && frames_ != 0 && (is_ended_ || frames_ >= kFramesToTell)) {
      is_watching_ = false;
      text = trf("none of the {} frames{} has an id of the map ({}); the log has {}", frames_,
                 interface_.empty() ? "" : trf(" of {}", interface_), wanted_ids(), found_ids());
      return true;
    }
    if (complaint_.empty()) return false;
    text = std::exchange(complaint_, {});
    return true;
  }

 private:
  /// Until the first frame of the map: which ids there are.
  void watch_ids() {
    if (!is_watching_ || line_.frame.error) return;
    ++frames_;
    const Id id{line_.frame.id, line_.frame.extended};
    if (is_wanted(id)) {
      is_watching_ = false;
      seen_.clear();
      return;
    }
    const auto it = seen_.find(id);
    if (it != seen_.end()) {
      ++it->second;
    } else if (seen_.size() < kMostIds) {
      seen_.emplace(id, 1);
    }
  }

  bool is_wanted(const Id& id) const {
    return std::find(ids_.begin(), ids_.end(), id) != ids_.end();
  }

  /// Two buses with the same ids are two machines, or two halves of one.
  void watch_interfaces() {
    if (has_two_ || !interface_.empty() || line_.interface == first_interface_) return;
    if (line_.frame.error || !is_wanted({line_.frame.id, line_.frame.extended})) return;
    if (first_interface_.empty()) {
      first_interface_ = line_.interface;
      return;
    }
    has_two_ = true;
    complaint_ = trf("frames of the map come from {} and from {}; source.interface chooses one",
                     first_interface_, line_.interface);
  }

  std::string wanted_ids() const {
    std::string text;
    for (const auto& [id, extended] : ids_) {
      text += fmt::format("{}{}", text.empty() ? "" : ", ", can_id_text(id, extended));
    }
    return text;
  }

  std::string found_ids() const {
    std::vector<std::pair<std::uint64_t, Id>> often;
    for (const auto& [id, count] : seen_) often.emplace_back(count, id);
    std::sort(often.begin(), often.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::string text;
    for (std::size_t i = 0; i < std::min(often.size(), kMostIdsShown); ++i) {
      text +=
          fmt::format("{}{} ({}x)", i == 0 ? "" : ", ",
                      can_id_text(often[i].second.first, often[i].second.second), often[i].first);
    }
    if (often.size() > kMostIdsShown) {
      text += trf(" and {} more", often.size() - kMostIdsShown);
    }
    return text;
  }

  CanAssembler assembler_;
  std::string interface_;
  std::vector<Id> ids_;
  CandumpLine line_;
  std::string first_interface_;  // of a frame of the map
  bool has_two_ = false;
  std::string complaint_;
  bool is_watching_ = true;
  bool is_ended_ = false;
  std::uint64_t frames_ = 0;
  std::map<Id, std::uint64_t> seen_;
};

}  // namespace

std::unique_ptr<LogLines> make_candump_lines(const LogSettings& settings) {
  return std::make_unique<CandumpFrames>(settings);
}

}  // namespace kerf
