// Preloaded into User Mode Linux by with-vcan. linux.uml 6.1 keeps 2.7 kB of floating-point
// registers of each of its processes; on a CPU with AMX, the host's ptrace() takes back nothing
// less than all 11 kB (EFAULT, and the guest's first process dies). This ptrace() keeps the rest of
// them. Elsewhere it changes nothing.
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>

namespace {

constexpr long kPeekFirst = 1;
constexpr long kPeekLast = 3;
constexpr long kGetRegisterSet = 0x4204;
constexpr long kSetRegisterSet = 0x4205;
constexpr long kExtendedState = 0x202;

/// Not on the stack: those of UML's kernel are small. It has one thread.
char all_registers[65536];

}  // namespace

extern "C" long ptrace(int request, ...) {
  va_list arguments;
  va_start(arguments, request);
  const int process = va_arg(arguments, int);
  const long address = va_arg(arguments, long);
  const long data = va_arg(arguments, long);
  va_end(arguments);
  if ((request == kGetRegisterSet || request == kSetRegisterSet) && address == kExtendedState) {
    auto* const asked = reinterpret_cast<iovec*>(data);
    iovec all{all_registers, sizeof all_registers};
    if (syscall(SYS_ptrace, kGetRegisterSet, process, kExtendedState, &all) < 0) return -1;
    const std::size_t bytes = std::min(asked->iov_len, all.iov_len);
    if (request == kGetRegisterSet) {
      std::memcpy(asked->iov_base, all_registers, bytes);
      asked->iov_len = bytes;
      return 0;
    }
    std::memcpy(all_registers, asked->iov_base, bytes);
    return syscall(SYS_ptrace, kSetRegisterSet, process, kExtendedState, &all);
  }
  if (request >= kPeekFirst && request <= kPeekLast) {
    long word = 0;
    if (syscall(SYS_ptrace, request, process, address, &word) < 0) return -1;
    errno = 0;
    return word;
  }
  return syscall(SYS_ptrace, request, process, address, data);
}
