#include "interp_bridge/probe_branches.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/text_scan.h"

namespace kerf {
namespace {

using Names = std::set<std::string, std::less<>>;

/// Parameters that are found by number may be any.
constexpr std::string_view kByNumber = "#[";
/// What a subroutine is given.
constexpr int kArguments = 30;
/// LinuxCNC reads no longer lines.
constexpr std::size_t kLongest = 1000;

struct Line {
  Names read, set;
  bool branches = false;
  bool calls = false;
};

/// Without blanks and comments, small letters.
std::string bare(std::string_view line) {
  std::string out;
  bool comment = false;
  for (const char c : line) {
    if (comment) {
      comment = c != ')';
    } else if (c == '(') {
      comment = true;
    } else if (c == ';') {
      break;
    } else if (c > ' ') {
      out += to_lower(c);
    }
  }
  return out;
}

/// Where the brackets that begin at `at` are closed.
std::size_t closing(const std::string& text, std::size_t at) {
  int depth = 0;
  for (; at < text.size(); ++at) {
    if (text[at] == '[') ++depth;
    if (text[at] == ']' && --depth == 0) return at;
  }
  return text.size();
}

Line line_of(std::string_view raw) {
  const std::string text = bare(raw);
  Line line;
  for (std::size_t at = text.find('#'); at < text.size(); at = text.find('#', at + 1)) {
    std::string name(kByNumber);
    std::size_t end = at + 1;
    if (end < text.size() && text[end] == '<') {
      end = std::min(text.find('>', end), text.size() - 1) + 1;
      name = text.substr(at, end - at);
    } else if (end < text.size() && is_digit(text[end])) {
      while (end < text.size() && is_digit(text[end])) ++end;
      name = text.substr(at, end - at);
    } else if (end < text.size() && text[end] == '[') {
      end = closing(text, end) + 1;
    }
    const bool is_set = end < text.size() && text[end] == '=';
    (is_set ? line.set : line.read).insert(std::move(name));
  }
  if (text.empty() || text[0] != 'o') return line;
  for (const char* const word : {"if[", "while[", "repeat["}) {
    line.branches = line.branches || text.find(word) != text.npos;
  }
  line.calls = text.find("call") != text.npos;
  return line;
}

}  // namespace

bool branches_on_probe(const std::string& text) {
  std::vector<Line> lines;
  std::map<std::string, std::vector<std::size_t>, std::less<>> readers;
  std::istringstream in(text);
  for (std::string raw; std::getline(in, raw);) {
    if (raw.find('#') == raw.npos) continue;
    raw.resize(std::min(raw.size(), kLongest));
    lines.push_back(line_of(raw));
    for (const std::string& name : lines.back().read) readers[name].push_back(lines.size() - 1);
  }
  Names probed;
  std::vector<std::string> fresh;
  const auto add = [&](const std::string& name) {
    if (probed.insert(name).second) fresh.push_back(name);
  };
  for (int number = 5061; number <= 5069; ++number) add("#" + std::to_string(number));
  while (!fresh.empty()) {
    const auto found = readers.find(fresh.back());
    fresh.pop_back();
    if (found == readers.end()) continue;
    for (const std::size_t i : found->second) {
      const Line& line = lines[i];
      if (line.branches) return true;
      for (const std::string& name : line.set) add(name);
      for (int number = 1; line.calls && number <= kArguments; ++number) {
        add("#" + std::to_string(number));
      }
    }
  }
  return false;
}

bool file_branches_on_probe(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return true;
  return branches_on_probe({std::istreambuf_iterator<char>(file), {}});
}

}  // namespace kerf
