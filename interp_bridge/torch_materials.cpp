#include "interp_bridge/torch_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/text_scan.h"

namespace kerf {
namespace {

constexpr std::size_t kLongestNumber = 64;
constexpr std::size_t kLongestName = 100;

struct Word {
  std::string_view key;
  double TorchMaterial::*value;
  bool is_length;
  bool mandatory;
};
constexpr std::array<Word, 13> kWords = {{
    {"ph", &TorchMaterial::pierce_height_mm, true, true},
    {"pd", &TorchMaterial::pierce_delay_s, false, true},
    {"ch", &TorchMaterial::cut_height_mm, true, true},
    {"fr", &TorchMaterial::feed_mm_per_min, true, true},
    {"kw", &TorchMaterial::kerf_width_mm, true, false},
    {"jh", &TorchMaterial::puddle_jump_height_mm, true, false},
    {"jd", &TorchMaterial::puddle_jump_delay_s, false, false},
    {"ca", &TorchMaterial::cut_amps, false, false},
    {"cv", &TorchMaterial::cut_volts, false, false},
    {"pe", &TorchMaterial::pause_at_end_s, false, false},
    {"gp", &TorchMaterial::gas_pressure, false, false},
    {"cm", &TorchMaterial::cut_mode, false, false},
    {"th", nullptr, false, false},
}};

/// What a magic comment leaves unsaid.
TorchMaterial unsaid() {
  TorchMaterial material;
  material.kerf_width_mm = 0;
  material.cut_amps = 15;
  material.cut_volts = 100;
  return material;
}

struct Pin {
  std::string_view plasmac;    ///< behind "plasmac."
  std::string_view qtplasmac;  ///< behind "qtplasmac."
  double TorchMaterial::*value;
  bool is_length;
};
constexpr std::array<Pin, 12> kPins = {{
    {"cut-feed-rate", "cut_feed_rate-f", &TorchMaterial::feed_mm_per_min, true},
    {"kerf-width", "kerf_width-f", &TorchMaterial::kerf_width_mm, true},
    {"cut-height", "cut_height-f", &TorchMaterial::cut_height_mm, true},
    {"cut-volts", "cut_volts-f", &TorchMaterial::cut_volts, false},
    {"pierce-height", "pierce_height-f", &TorchMaterial::pierce_height_mm, true},
    {"pierce-delay", "pierce_delay-f", &TorchMaterial::pierce_delay_s, false},
    {"puddle-jump-height", "puddle_jump_height-f", &TorchMaterial::puddle_jump_height_mm, true},
    {"puddle-jump-delay", "puddle_jump_delay-f", &TorchMaterial::puddle_jump_delay_s, false},
    {"pause-at-end", "pause_at_end-f", &TorchMaterial::pause_at_end_s, false},
    {"", "cut_amps-f", &TorchMaterial::cut_amps, false},
    {"", "gas_pressure-f", &TorchMaterial::gas_pressure, false},
    {"", "cut_mode-f", &TorchMaterial::cut_mode, false},
}};

bool read_whole(std::string_view text, double least, double most, int& value) {
  double number = 0;
  if (!read_material_number(text, number)) return false;
  if (number != std::floor(number) || number < least || number > most) return false;
  value = static_cast<int>(number);
  return true;
}

/// The words of a magic comment, by their keys.
struct Words {
  int operation = -1;
  bool has_number = false;
  bool has_name = false;
  std::array<bool, kWords.size()> has{};
  TorchMaterial material = unsaid();
};

/// False: `complaint` is the word that is wrong.
bool read_words(std::string_view comment, double unit_mm, Words& words, std::string& complaint) {
  while (!comment.empty()) {
    const std::size_t comma = std::min(comment.find(','), comment.size());
    const std::string_view item = trim(comment.substr(0, comma), is_line_blank);
    comment.remove_prefix(std::min(comment.size(), comma + 1));
    const std::size_t equals = item.find('=');
    if (equals == item.npos) continue;  // more of a name, as QtPlasmaC passes over it
    const std::string_view key = trim(item.substr(0, equals), is_line_blank);
    const std::string_view value = trim(item.substr(equals + 1), is_line_blank);
    complaint = std::string(item.substr(0, kLongestName));
    if (key == "o") {
      if (!read_whole(value, 0, 2, words.operation)) return false;
    } else if (key == "nu") {
      words.has_number = true;
      const double most = MaterialTable::kFirstTemporary - 1;
      if (!read_whole(value, 0, most, words.material.number)) return false;
    } else if (key == "na") {
      words.has_name = true;
      words.material.name = std::string(value.substr(0, kLongestName));
    } else {
      const auto word = std::find_if(kWords.begin(), kWords.end(),
                                     [&](const Word& known) { return known.key == key; });
      double number = 0;
      if (word == kWords.end()) continue;
      if (!read_material_number(value, number)) return false;
      words.has[static_cast<std::size_t>(word - kWords.begin())] = true;
      if (word->value != nullptr) {
        words.material.*word->value = word->is_length ? number * unit_mm : number;
      }
    }
  }
  complaint.clear();
  return words.operation >= 0;
}

}  // namespace

bool read_material_number(std::string_view text, double& value) {
  text = trim(text, is_line_blank);
  if (text.empty() || text.size() > kLongestNumber) return false;
  const std::string digits(text);
  char* end = nullptr;
  value = std::strtod(digits.c_str(), &end);
  constexpr double kLargest = 1e9;
  return *end == 0 && std::abs(value) <= kLargest;
}

bool material_pin(const TorchMaterial& material, std::string_view name, double& value,
                  bool& is_length) {
  const bool component = take_prefix(name, "plasmac.");
  if ((!component && !take_prefix(name, "qtplasmac.")) || name.empty()) return false;
  const auto pin = std::find_if(kPins.begin(), kPins.end(), [&](const Pin& known) {
    return (component ? known.plasmac : known.qtplasmac) == name;
  });
  if (pin == kPins.end()) return false;
  value = material.*pin->value;
  is_length = pin->is_length;
  return true;
}

MaterialTable::MaterialTable(std::vector<TorchMaterial> rows) : rows_(std::move(rows)) {
  if (rows_.empty()) rows_.emplace_back();
}

/// The last row of that number; rows().size() if there is none.
std::size_t MaterialTable::find(int number) const {
  const auto found = std::find_if(rows_.rbegin(), rows_.rend(), [number](const TorchMaterial& row) {
    return row.number == number;
  });
  return found == rows_.rend() ? rows_.size() : static_cast<std::size_t>(rows_.rend() - found) - 1;
}

void MaterialTable::add(TorchMaterial material) {
  // A program that makes more than all its lines could name is in a loop; its last one counts.
  if (rows_.size() < kMaxRows) {
    rows_.push_back(std::move(material));
  } else {
    rows_.back() = std::move(material);
  }
}

bool MaterialTable::select(int number) {
  const std::size_t row = find(number < 0 ? 0 : number);
  if (row < rows_.size()) {
    current_ = row;
    return true;
  }
  TorchMaterial unknown = rows_[0];
  unknown.number = number;
  unknown.name.clear();
  add(std::move(unknown));
  current_ = rows_.size() - 1;
  return false;
}

MaterialTable::Edit MaterialTable::edit(std::string_view comment, double unit_mm) {
  complaint_.clear();
  comment = trim(comment, is_line_blank);
  if (comment.substr(0, 2) != "o=") return Edit::kNone;
  Words words;
  if (!read_words(comment, unit_mm, words, complaint_)) return Edit::kMalformed;
  const bool temporary = words.operation == 0;
  if (!temporary && !words.has_number) {
    complaint_ = "nu";
    return Edit::kMalformed;
  }
  const auto miss = [&](std::string_view key) {
    complaint_ += complaint_.empty() ? "" : ", ";
    complaint_ += key;
  };
  TorchMaterial& material = words.material;
  if (!temporary && !words.has_name) miss("na");
  bool incomplete = false;
  for (std::size_t i = 0; i < kWords.size(); ++i) {
    if (!kWords[i].mandatory || words.has[i]) continue;
    miss(kWords[i].key);
    incomplete = true;
  }
  if (incomplete) {
    for (std::size_t i = 0; i < kWords.size(); ++i) {
      if (words.has[i] || kWords[i].value == nullptr) continue;
      material.*kWords[i].value = rows_[0].*kWords[i].value;
    }
  }
  if (temporary) {
    material.number = next_temporary_++;
    if (!words.has_name) material.name = "Temporary " + std::to_string(material.number);
  }
  const bool in_force = temporary || material.number == current().number;
  add(std::move(material));
  if (in_force) current_ = rows_.size() - 1;
  return complaint_.empty() ? Edit::kDone : Edit::kIncomplete;
}

}  // namespace kerf
