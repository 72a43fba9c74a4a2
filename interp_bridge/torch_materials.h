// interp_bridge/torch_materials.h - the materials of a QtPlasmaC machine, as a program changes
// them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// A row of QtPlasmaC's materials, in mm, mm/min and s. As it stands: the values that QtPlasmaC has
/// where nobody has entered any.
struct TorchMaterial {
  int number = 0;
  std::string name = "DEFAULT";
  double kerf_width_mm = 1;
  double pierce_height_mm = 3;
  double pierce_delay_s = 0;  ///< from the arc to the first move
  double puddle_jump_height_mm = 0;
  double puddle_jump_delay_s = 0;
  double cut_height_mm = 1;
  double feed_mm_per_min = 4000;
  double cut_amps = 45;
  double cut_volts = 99;
  double pause_at_end_s = 0;  ///< with the arc on, before the torch lifts
  double gas_pressure = 0;
  double cut_mode = 1;
  bool operator==(const TorchMaterial&) const = default;
};

/// The materials, and the one in force. What a program changes (M190, magic comments) makes a new
/// row, so that a row keeps its values: an index into rows() means the same for ever. kerf and
/// kerf-interp have one each and tell them the same. No I/O.
class MaterialTable {
 public:
  /// Number of the first material of a (o=0) comment; they count up.
  static constexpr int kFirstTemporary = 1'000'000;
  static constexpr std::size_t kMaxRows = 65'535;

  /// `rows`: of the machine; row 0 must be its default material, number 0. Empty: that of
  /// QtPlasmaC.
  explicit MaterialTable(std::vector<TorchMaterial> rows = {});

  const std::vector<TorchMaterial>& rows() const { return rows_; }
  std::size_t current_index() const { return current_; }
  const TorchMaterial& current() const { return rows_[current_]; }

  /// M190 P: -1 is the default material. False: there is none of that number; one is made, with the
  /// default's values.
  bool select(int number);

  /// What edit() found.
  enum class Edit {
    kNone,        ///< no magic comment
    kDone,        ///< new material, or new values of one
    kIncomplete,  ///< the same, but what QtPlasmaC insists on (nu na ph pd ch fr) is missing: those
                  ///< of the default material are taken
    kMalformed,   ///< nothing was changed
  };
  /// Takes a comment of the program, without its parentheses: "o=0, ph=3, pd=0.1, ch=1, fr=3000,
  /// kw=1.2". o=0 makes a temporary material and puts it in force, o=1 a new one, o=2 changes one
  /// or makes it. `unit_mm`: of the program, 1 or 25.4. Any bytes are accepted.
  Edit edit(std::string_view comment, double unit_mm);
  /// Of the last edit(): "fr", the words that are missing; or the one that is wrong.
  const std::string& complaint() const { return complaint_; }

 private:
  std::size_t find(int number) const;
  void add(TorchMaterial material);

  std::vector<TorchMaterial> rows_;
  std::size_t current_ = 0;
  int next_temporary_ = kFirstTemporary;
  std::string complaint_;
};

/// A number of at most `text.size()` digits; blanks around it do not count. False: it is something
/// else, infinite or not a number.
bool read_material_number(std::string_view text, double& value);

/// Value of the HAL pin `name` that QtPlasmaC has the material's values on, in mm; false: there is
/// none of that name. `is_length`: to be converted into the units in which it is asked for.
bool material_pin(const TorchMaterial& material, std::string_view name, double& value,
                  bool& is_length);

}  // namespace kerf
