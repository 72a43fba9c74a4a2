// twin/cli/stdin_program.h - a program on standard input: NC text, or a listing of rs274.
#pragma once

#include <cstdint>
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

/// Stands for "-" while a program is run. What is to be read more than once is taken whole, into a
/// file of its own: NC text always, since the interpreter wants a file; a listing where blank or
/// tools are to be guessed from it, else that is read as it comes. At most kMostBytes of it. The
/// file is gone with this object.
class StdinProgram {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  /// What messages call it.
  static constexpr const char* kName = "stdin";

  enum class Listings : std::uint8_t { kStreamed, kKept };

  /// `path` "-": what is taken whole is in a file behind this, and `path` is that of the file.
  /// Waits for the first line. Of a terminal and of sockets nothing can be known before it is read:
  /// they are taken whole where a listing would be, else for a listing. Every other path is left as
  /// it is, and so is "-" where `stop` is requested meanwhile (but for NC text, of which that is a
  /// fault). Faults are diagnostics.
  void take(std::string& path, Listings listings, const std::stop_token& stop,
            Diagnostics& diagnostics);

  /// The path of the file, so that messages about it can be given its name; empty: there is none.
  const std::string& path() const { return path_; }
  /// The text with the file's path replaced by its name.
  std::string renamed(std::string text) const;

 private:
  std::optional<PrivateFolder> folder_;
  std::string path_;
};

}  // namespace kerf
