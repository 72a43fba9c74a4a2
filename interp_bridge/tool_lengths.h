// interp_bridge/tool_lengths.h - which tool length offset is in force, and how long the tool in the
// spindle is.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "interp_bridge/canonical.h"
#include "interp_bridge/motion.h"
#include "interp_bridge/program.h"

namespace kerf {

/// A difference of lengths up to this is none.
inline constexpr double kSameLength_mm = 1e-3;
/// What a program adds itself to a tool's row (G43.2, or G43.1 with the length it has measured) is
/// wear up to this, and nothing to be told.
inline constexpr double kMostWear_mm = 1.0;

/// Along X Y Z A B C U V W: mm and degrees.
using ToolOffset = std::array<double, 9>;

/// What is known of lengths before the program runs.
struct ToolLengthSetup {
  /// What USE_TOOL_LENGTH_OFFSET holds.
  enum class Calls : std::uint8_t {
    kTrue,    ///< the offset: the interpreter has the table's lengths
    kHidden,  ///< it has lengths of 0; which row is meant stands behind the nine numbers
    kCoded,   ///< lengths of 0, and the row in U and W (rs274: coded_offset())
  };
  std::map<int, ToolOffset> lengths;  ///< of the tool table's rows; empty: nothing is checked
  unsigned axes = 7;                  ///< bit 0 is X .. bit 8 is W: the others have no lengths
  Calls calls = Calls::kTrue;
  double table_unit_mm = 1;  ///< mm in one unit of SET_TOOL_TABLE_ENTRY
  double start_z_mm = 0;     ///< where the interpreter has the machine's Z at the start
  bool displaces = true;     ///< a wrong length moves the tip along X Y Z: straight axes
};

/// Of a tool table, along these axes (ToolLengthSetup::axes). Lengths that are all 0 are none.
std::map<int, ToolOffset> known_lengths(const std::vector<ToolTableRow>& rows, unsigned axes);

/// Behind the nine numbers of USE_TOOL_LENGTH_OFFSET, as kerf-interp records it: how it came to be,
/// and the tool whose row it is.
enum class OffsetOrigin : std::uint8_t {
  kNone,      ///< G49
  kRow,       ///< G43, with the row's tool
  kAddedRow,  ///< G43.2 H, with the tool of the row that was added
  kStated,    ///< G43.1: numbers of the program
};

/// How rs274 is told the tool of a row: its axes are X Y Z A B C, and U and W of a tool's offset
/// are printed by G43 and used nowhere. W counts the rows that are added up (G43.2), U is the sum
/// of their tools.
struct CodedOffset {
  double u_mm = 0;
  double w_mm = 0;
};
constexpr CodedOffset coded_offset(int tool) { return {static_cast<double>(tool), 1.0}; }

/// Follows a program's tools and offsets. The tip of the tool in the spindle is at the programmed
/// place plus the applied offset less its real length. What the table does not know is taken to be
/// right: an unlisted tool, an empty spindle, an offset whose row is not known. Of A, B and C the
/// interpreter knows no lengths (kTrue), and of U, V, W it does not where it has no such axes
/// (rs274).
///
/// The real length is the table's row, as the program may change it by G10 L1, L10 or L11. An
/// offset that the program states itself for the tool in the spindle (G43.1; G43.2 upon the tool's
/// own row) is taken for the truth: a length that was measured, or wear.
class ToolLengths {
 public:
  void set_up(ToolLengthSetup setup);
  bool checks() const { return !setup_.lengths.empty(); }

  /// `by_hand`: M61, of which rs274 does not tell its own row of the spindle.
  void mount(int tool, bool by_hand);
  /// USE_TOOL_LENGTH_OFFSET; `unit_mm`: of the program.
  void use(const CanonicalCommand& command, double unit_mm, SourceRef source);
  /// From here on the program's own numbers may be measured lengths that nobody else knows.
  void take_stated_as_measured() { stated_is_measured_ = true; }
  /// SET_TOOL_TABLE_ENTRY.
  void set_row(const CanonicalCommand& command);

  /// Without tip_shift_mm.
  const ToolLengthState& state() const { return state_; }
  /// In force, X Y Z; and the interpreter does not know it.
  Vec3 applied_mm() const { return {applied_[0], applied_[1], applied_[2]}; }
  bool is_hidden() const { return setup_.calls != ToolLengthSetup::Calls::kTrue; }
  /// The tip is displaced by applied_mm less real_mm, and by uvw_off_mm.
  bool displaces() const {
    return state_.verdict == ToolLengthState::Verdict::kWrong && setup_.displaces;
  }

 private:
  struct Call {
    OffsetOrigin origin = OffsetOrigin::kNone;
    int tool = -1;
    ToolOffset offset{};
  };
  Call decode(const CanonicalCommand& command, double unit_mm);
  Call decode_coded(const ToolOffset& offset, double u, double w, double unit_mm);
  void apply(const Call& call);
  bool is_told(std::size_t axis) const;
  void judge();

  ToolLengthSetup setup_;
  std::map<int, ToolOffset> hidden_;  ///< the interpreter's own rows, where they are not 0 (G10)
  int tool_ = 0;
  int row_of_spindle_ = 0;  ///< tool that rs274 holds for the one in the spindle
  ToolOffset applied_{};
  bool applied_known_ = true;
  std::vector<int> rows_;  ///< whose rows make up the offset
  bool stated_ = false;    ///< or the program's own numbers
  bool stated_is_measured_ = false;
  bool of_this_tool_ = false;  ///< set since the tool came into the spindle
  SourceRef set_at_;
  ToolOffset call_{};  ///< of the last call
  double call_u_ = 0;
  double call_w_ = 0;
  ToolLengthState state_;
};

}  // namespace kerf
