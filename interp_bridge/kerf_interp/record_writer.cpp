#include "interp_bridge/kerf_interp/record_writer.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>

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

}  // namespace kerf::interp
