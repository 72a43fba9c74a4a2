// What the simulated machine's frames are on a real interface, vcan0 (see
// tests/machine_io/can/with-vcan).
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "machine_io/simulator/can_sender.h"
#include "tests/base/temporary_folder.h"
#include "tests/machine_io/simulator/machine_process.h"

namespace kerf {
namespace {

constexpr int kPatience_ms = 20'000;

/// Another node of the bus: hears all.
class Listener {
 public:
  Listener() : fd_(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address = {};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    const void* const raw = &address;
    is_bound_ = address.can_ifindex > 0 &&
                bind(fd_, static_cast<const sockaddr*>(raw), sizeof address) == 0;
  }
  ~Listener() { close(fd_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  bool is_bound() const { return is_bound_; }
  bool next(can_frame& frame) const {
    pollfd ready{fd_, POLLIN, 0};
    return poll(&ready, 1, kPatience_ms) > 0 && read(fd_, &frame, sizeof frame) == sizeof frame;
  }

 private:
  int fd_;
  bool is_bound_ = false;
};

TEST(CanWire, FramesArriveAsEncoded) {
  const Listener listener;
  ASSERT_TRUE(listener.is_bound()) << "no interface vcan0";
  for (const CanLayout layout : {CanLayout::kCia402, CanLayout::kOdrive}) {
    auto sender = CanSender::open("vcan0", layout);
    ASSERT_TRUE(sender) << sender.error();
    CanEncoder encoder(layout);
    std::array<SentCanFrame, CanEncoder::kMaxFrames> expected;
    ServedState served;
    for (int update = 0; update < 200; ++update) {
      served.state.position = {update * 0.5, -update * 0.25, 3, 4, 5, 6};
      served.state.scan = static_cast<std::uint16_t>(update);
      (*sender)->send(served, 0.001);
      const std::size_t count = encoder.encode(served, 0.001, expected);
      for (std::size_t i = 0; i < count; ++i) {
        can_frame frame = {};
        ASSERT_TRUE(listener.next(frame));
        ASSERT_EQ(frame.can_id, expected[i].id);
        ASSERT_EQ(frame.can_dlc, expected[i].size);
        ASSERT_TRUE(std::equal(frame.data, frame.data + frame.can_dlc, expected[i].data.begin()));
      }
    }
    EXPECT_EQ((*sender)->sent(), 1600u);
    EXPECT_EQ((*sender)->not_sent(), 0u);
  }
}

TEST(CanWire, TheMachineDrivesItsProgram) {
  const Listener listener;
  ASSERT_TRUE(listener.is_bound()) << "no interface vcan0";
  const TemporaryFolder folder;
  write_file(folder / "part.canon",
             "    1 N..... USE_LENGTH_UNITS(CANON_UNITS_MM)\n"
             "    2 N..... STRAIGHT_TRAVERSE(0.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
             "    3 N..... SET_FEED_RATE(1200.0000)\n"
             "    4 N..... STRAIGHT_FEED(10.0000, 0.0000, 5.0000, 0.0000, 0.0000, 0.0000)\n"
             "    5 N..... PROGRAM_END()\n");
  MachineProcess machine({folder / "part.canon", "--can", "vcan0", "--rate", "200"});
  int positions = 0;
  std::int32_t last = 0;
  while (last < 10000) {
    can_frame frame = {};
    ASSERT_TRUE(listener.next(frame));
    if (frame.can_id != 0x381) continue;
    std::int32_t x = 0;
    std::memcpy(&x, frame.data + 2, sizeof x);
    ASSERT_GE(x, last);
    last = x;
    ++positions;
  }
  EXPECT_EQ(last, 10000);
  EXPECT_GT(positions, 20);
  EXPECT_EQ(machine.finish(), 0);
  EXPECT_NE(machine.out().find("\ncan-sent "), std::string::npos);
  EXPECT_EQ(machine.out().find("can-not-sent"), std::string::npos);
}

}  // namespace
}  // namespace kerf
