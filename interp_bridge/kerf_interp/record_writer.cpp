#include "interp_bridge/kerf_interp/record_writer.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "interp_bridge/canonical.h"

namespace kerf::interp {

void RecordWriter::flush() {
  const char* from = buffer_.data();
  while (used_ > 0) {
    const ssize_t written = ::write(fd_, from, used_);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) std::_Exit(1);  // nobody is left to be told
    from += written;
    used_ -= static_cast<std::size_t>(written);
  }
}

void RecordWriter::make_room(std::size_t bytes) {
  flush();
  if (bytes > buffer_.size()) buffer_.resize(bytes);
}

/// What moves, waits, changes tools or talks. A length offset goes with the tool it is of.
bool RecordWriter::is_deed(std::uint8_t code) {
  if (code == records::kSpline || code == records::kUserM || code == records::kWait ||
      code == records::kRotary || code == records::kProbe || code == records::kStore) {
    return true;
  }
  if (code >= records::kFile && code < records::kText) return false;
  switch (static_cast<CanonicalName>(code & ~records::kText)) {
    case CanonicalName::kStraightFeed:
    case CanonicalName::kStraightTraverse:
    case CanonicalName::kArcFeed:
    case CanonicalName::kStraightProbe:
    case CanonicalName::kRigidTap:
    case CanonicalName::kNurbsFeed:
    case CanonicalName::kDwell:
    case CanonicalName::kOrientSpindle:
    case CanonicalName::kWaitOrientComplete:
    case CanonicalName::kSelectTool:
    case CanonicalName::kStartChange:
    case CanonicalName::kChangeTool:
    case CanonicalName::kChangeToolNumber:
    case CanonicalName::kReloadTooldata:
    case CanonicalName::kUseToolLengthOffset:
    case CanonicalName::kComment:
    case CanonicalName::kMessage:
    case CanonicalName::kLog:
    case CanonicalName::kLogOpen:
    case CanonicalName::kLogAppend:
    case CanonicalName::kLogClose:
    case CanonicalName::kProgramStop:
    case CanonicalName::kOptionalProgramStop:
    case CanonicalName::kPalletShuttle:
      return true;
    default:
      return false;
  }
}

}  // namespace kerf::interp
