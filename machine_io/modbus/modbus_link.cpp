#include "machine_io/modbus/modbus_link.h"

#include <fmt/format.h>
#include <modbus.h>

#include <cerrno>

#include "base/translate.h"

namespace kerf {

ModbusLink::~ModbusLink() { close(); }

bool ModbusLink::open() {
  close();
  context_ = create();
  if (context_ == nullptr) {
    note(fmt::format("{}: {}", place(), modbus_strerror(errno)));
    return false;
  }
  const auto seconds = static_cast<std::uint32_t>(settings_.timeout_ms / 1000);
  const auto micros = static_cast<std::uint32_t>(settings_.timeout_ms % 1000 * 1000);
  modbus_set_response_timeout(context_, seconds, micros);
  // No limit of its own for the bytes: the whole answer must be there within the timeout.
  modbus_set_byte_timeout(context_, 0, 0);
  if (modbus_connect(context_) != 0) {
    note(fmt::format("{}: {}", place(), modbus_strerror(errno)));
    modbus_free(context_);
    context_ = nullptr;
    return false;
  }
  open_ = true;
  opened();
  return true;
}

void ModbusLink::close() {
  if (open_) modbus_close(context_);
  open_ = false;
  if (context_ != nullptr) modbus_free(context_);
  context_ = nullptr;
}

int ModbusLink::descriptor() const { return modbus_get_socket(context_); }

void ModbusLink::note(const PollRead& read, const std::string& what) {
  trouble_ = fmt::format("{} {}..{}: {}", name_of(read.table), read.address,
                         read.address + read.count - 1, what);
}

void ModbusLink::note_errno(const PollRead& read, int error) {
  if (error == ETIMEDOUT) {
    note(read, trf("no answer within {} ms", settings_.timeout_ms));
  } else {
    note(read, modbus_strerror(error));
  }
}

ModbusLink::Answer ModbusLink::refused(const PollRead& read, int code) {
  exception_code_ = code;
  note(read, trf("the device answers with exception {} ({})", code,
                 modbus_strerror(MODBUS_ENOBASE + code)));
  return Answer::kException;
}

}  // namespace kerf
