#include "twin/report/call_sites.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <system_error>

#include "base/text_scan.h"

namespace kerf {

const std::vector<CallSites::Line>& CallSites::words_of(const std::string& file) {
  const auto [at, is_new] = words_.try_emplace(file);
  std::error_code ignored;
  if (!is_new || !std::filesystem::is_regular_file(file, ignored)) return at->second;
  std::ifstream in(file, std::ios::binary);
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    if (std::optional<OWord> word = o_word(text)) at->second.push_back({number, std::move(*word)});
  }
  return at->second;
}

/// Its name in small letters; empty: none.
std::string CallSites::subroutine_at(const std::string& file, int line) {
  std::string name;
  for (const Line& at : words_of(file)) {
    if (at.number > line) break;
    if (at.word.kind == OWord::Kind::kSub) name = to_lower(at.word.name);
    if (at.word.kind == OWord::Kind::kEndSub && at.number < line) name.clear();
  }
  return name;
}

std::vector<CallSite> CallSites::of(const std::vector<std::string>& files, const std::string& file,
                                    int line) {
  std::vector<CallSite> found;
  std::set<std::string> known;
  std::vector<std::string> wanted{subroutine_at(file, line)};
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    if (wanted[n].empty() || !known.insert(wanted[n]).second) continue;
    const std::string name = wanted[n];
    for (const std::string& caller : files) {
      for (const Line& at : words_of(caller)) {
        if (at.word.kind != OWord::Kind::kCall || to_lower(at.word.name) != name) continue;
        if (found.size() == kMostCallSites) return found;
        found.push_back({caller, at.number, at.word.name});
        wanted.push_back(subroutine_at(caller, at.number));
      }
    }
  }
  return found;
}

}  // namespace kerf
