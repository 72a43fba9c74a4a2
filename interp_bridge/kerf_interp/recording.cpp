#include "interp_bridge/kerf_interp/recording.h"

#include <algorithm>
#include <array>
#include <climits>

namespace kerf::interp {

Recording& recording() {
  static Recording instance;
  return instance;
}

void Recording::begin(const std::string& program) {
  files_ = {program};
  records->text(records::kFile, 0, program);
}

void Recording::moved_to_level(int level) {
  records->set_level(level);
  std::array<char, PATH_MAX> name{};
  if (interpreter != nullptr) interpreter->file(name.data(), name.size() - 1);
  const std::string text(name[0] != 0 ? name.data() : files_[0].c_str());
  const auto found = std::find(files_.begin(), files_.end(), text);
  const int index = static_cast<int>(found - files_.begin());
  if (index == file_) return;
  const bool fresh = found == files_.end();
  if (fresh) files_.push_back(text);
  file_ = index;
  records->text(records::kFile, index, fresh ? text : std::string());
}

}  // namespace kerf::interp
