// twin/app/stdin_program.h - a program on standard input: NC text, or a listing of rs274.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "base/diagnostic.h"
#include "interp_bridge/private_folder.h"

namespace kerf {

/// Whether text that begins so is NC code: it has a block (%, O100, N10, G0 X1, a comment) and no
/// line of a listing. False for what is neither: readers of listings pass over such lines.
bool is_nc_text(std::string_view head);

/// Stands for "-" while a program is run. A listing stays where it is, and is read as it comes. NC
/// text is taken whole, into a file of its own, since the interpreter wants one; at most
/// kMostBytes of it. The file is gone with this object.
class StdinProgram {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  /// What messages call it.
  static constexpr const char* kName = "stdin";

  /// `path` "-" and NC text on standard input: `path` becomes that of the file. Waits for the first
  /// line. Of a terminal and of sockets nothing can be known before it is read: they are left as
  /// they are, and so is every other path, and "-" where `stop` is requested meanwhile. Faults are
  /// diagnostics.
  void take(std::string& path, const std::stop_token& stop, Diagnostics& diagnostics);

  /// The path of the file, so that messages about it can be given its name; empty: there is none.
  const std::string& path() const { return path_; }
  /// The text with the file's path replaced by its name.
  std::string renamed(std::string text) const;

 private:
  std::optional<PrivateFolder> folder_;
  std::string path_;
};

}  // namespace kerf
