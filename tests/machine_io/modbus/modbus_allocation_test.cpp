// A poll that goes well allocates nothing: memory that grows, or a stall in malloc, never shows in
// a day of polling.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <new>

#include "machine_io/modbus/modbus_source.h"
#include "tests/machine_io/modbus/faulty_device.h"

namespace {
thread_local std::uint64_t allocations = 0;
}

void* operator new(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
// Not inlined: g++ would see free() where it expects the partner of its own operator new.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace kerf {
namespace {

void expect_no_allocation(const FaultyDevice& device, bool rtu) {
  ModbusSettings settings = settings_for(device, rtu);
  settings.poll_hz = 500;
  settings.timeout_ms = 5000;
  settings.counter = ModbusRegister{16, ModbusTable::kHolding, ModbusType::kUint16};
  ModbusSource source(settings);
  AxisSample sample;
  const auto poll = [&] { return source.next(sample, std::chrono::milliseconds(10000)); };
  ASSERT_EQ(poll(), PositionSource::Next::kSample) << source.status().trouble;
  const std::uint64_t before = allocations;
  EXPECT_GT(before, 0u);
  int samples = 0;
  for (int i = 0; i < 100; ++i) samples += poll() == PositionSource::Next::kSample ? 1 : 0;
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(samples, 100);
}

TEST(ModbusAllocation, none_per_sample_over_tcp) {
  expect_no_allocation(*FaultyDevice::tcp(), false);
}

TEST(ModbusAllocation, none_per_sample_over_rtu) {
  expect_no_allocation(*FaultyDevice::rtu(), true);
}

}  // namespace
}  // namespace kerf
