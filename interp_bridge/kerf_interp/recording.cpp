#include "interp_bridge/kerf_interp/recording.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <tuple>

namespace kerf::interp {

Recording& recording() {
  static Recording instance;
  return instance;
}

records::Answer Recording::ask_probe(int move_line, const Pose& target, unsigned char type) {
  std::array<double, 1 + std::tuple_size_v<Pose>> question{static_cast<double>(type)};
  std::copy(target.begin(), target.end(), question.begin() + 1);
  records->numbers(records::kProbe, line_of_move(move_line), question.data(), question.size());
  records->flush();
  records::Answer answer;
  auto* to = reinterpret_cast<char*>(&answer);
  for (std::size_t got = 0; got < sizeof answer;) {
    const ssize_t more = ::read(answers_fd, to + got, sizeof answer - got);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) std::_Exit(1);  // nobody is left to be told
    got += static_cast<std::size_t>(more);
  }
  return answer;
}

void Recording::begin(const std::string& program) {
  files_ = {program};
  records->text(records::kFile, 0, program);
}

void Recording::change_file(int index, std::string_view name) {
  if (index == file_) return;
  file_ = index;
  records->text(records::kFile, index, name);
}

void Recording::find_file() {
  restore_file_ = false;
  std::array<char, PATH_MAX> name;
  name.front() = name.back() = 0;
  if (interpreter != nullptr) interpreter->file(name.data(), name.size() - 1);
  const std::string_view text(name.front() != 0 ? name.data() : files_[0].c_str());
  if (files_[static_cast<std::size_t>(file_)] == text) return;
  const auto found = std::find(files_.begin(), files_.end(), text);
  const int index = static_cast<int>(found - files_.begin());
  if (found != files_.end()) return change_file(index, {});
  files_.emplace_back(text);
  change_file(index, text);
}

std::string Recording::block_text() const {
  std::array<char, 1024> text{};
  if (interpreter != nullptr) interpreter->line_text(text.data(), text.size() - 1);
  return text.data();
}

/// Moves come in the order of their blocks, so the block is the first with that line from the last
/// move's on. (A later one may have the same number in another file.)
void Recording::find_earlier_block(int line) {
  const std::size_t oldest = blocks_ >= kRecent ? blocks_ - kRecent + 1 : 1;
  for (std::size_t i = std::max(moved_, oldest); i <= blocks_; ++i) {
    const Block& block = recent_[i % kRecent];
    if (block.line != line) continue;
    moved_ = i;
    restore_file_ = block.file != file_;
    return change_file(block.file, {});
  }
}

}  // namespace kerf::interp
