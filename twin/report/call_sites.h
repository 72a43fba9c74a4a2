// twin/report/call_sites.h - which lines call the subroutine that a line stands in.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "interp_bridge/o_word.h"

namespace kerf {

struct CallSite {
  std::string file;
  int line = 0;
  std::string name;  ///< of what is called there, as it is spelled
};

/// Of a program and the files of its subroutines, read when they are first asked about. Lines that
/// may call, by their names: which of them it was in a run is not known where there are several.
class CallSites {
 public:
  /// In the order of `files`, their callers' callers behind them up to the program itself, at most
  /// kMostCallSites. Empty: the line is in no subroutine.
  std::vector<CallSite> of(const std::vector<std::string>& files, const std::string& file,
                           int line);

 private:
  struct Line {
    int number = 0;
    OWord word;
  };
  const std::vector<Line>& words_of(const std::string& file);
  std::string subroutine_at(const std::string& file, int line);

  std::map<std::string, std::vector<Line>> words_;
};
inline constexpr std::size_t kMostCallSites = 10;

}  // namespace kerf
