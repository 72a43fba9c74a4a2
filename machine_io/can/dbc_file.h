// machine_io/can/dbc_file.h - signals by name from a DBC file, the usual description of a CAN bus.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/result.h"
#include "machine_io/can/can_signal.h"

namespace kerf {

struct DbcSignal {
  std::string message;  ///< "DriveX"
  std::string name;     ///< "ActualPosition"
  std::string unit;     ///< "mm", as the file has it, in UTF-8; may be empty
  CanSignal signal;     ///< scale and offset as in the file
  int line = 0;         ///< in the file
};

/// What a DBC file says of its signals. Read are
///     BO_ id name: bytes sender
///      SG_ name [M|mN] : start|length@order sign (scale,offset) [min|max] "unit" receivers
///     SIG_VALTYPE_ id name : 1 (float32) or 2 (float64) ;
/// Everything else (comments, attributes, value tables, nodes) is passed over. Bytes beyond ASCII
/// in texts are taken for Latin-1. Signals of extended multiplexing (mNM) are left out with a
/// warning. The limits min|max are not applied.
class DbcFile {
 public:
  static constexpr std::size_t kMaxFileBytes = 64U * 1024 * 1024;
  static constexpr std::size_t kMaxSignals = 200'000;
  static constexpr std::size_t kMaxNameBytes = 128;  // the format's own limit

  const std::vector<DbcSignal>& signals() const { return signals_; }

  /// "Message.Signal", or "Signal" if only one message has it. The error says what there is
  /// instead.
  Result<DbcSignal> find(std::string_view name) const;

 private:
  friend class DbcReader;
  std::string path_;
  std::vector<DbcSignal> signals_;
};

/// Reads a text; `path` names it in the diagnostics. Any bytes are accepted. A faulty line is
/// reported and left out, the rest is read; after kMaxDbcDiagnostics of them reading ends with one
/// that says so.
DbcFile parse_dbc(std::string_view text, const std::string& path, Diagnostics& diagnostics);
inline constexpr std::size_t kMaxDbcDiagnostics = 50;

/// Reads a file; an unreadable one is a diagnostic, too.
DbcFile read_dbc_file(const std::string& path, Diagnostics& diagnostics);

}  // namespace kerf
