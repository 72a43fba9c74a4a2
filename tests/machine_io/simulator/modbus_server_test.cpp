#include "machine_io/simulator/modbus_server.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/base/temporary_folder.h"
#include "tests/machine_io/simulator/modbus_client.h"

namespace kerf {
namespace {

ServedState served_at(double x, std::initializer_list<FaultKind> faults = {}) {
  ServedState served;
  served.state.position = {x, 2 * x, -x, x, 0, 0};
  served.state.line = 12;
  for (const FaultKind kind : faults) served.faults.add(kind);
  return served;
}

/// A server on TCP, or on a pty, whose reopening can be waited for.
class Served {
 public:
  explicit Served(bool rtu, bool restarts = false) {
    board.publish(served_at(1.5));
    const auto reopened = [this](const std::string& address) {
      const std::lock_guard lock(mutex_);
      reopened_ = address;
      changed_.notify_all();
    };
    auto opened = rtu ? ModbusServer::open_rtu({"", 4000000, 1}, board, restarts, reopened)
                      : ModbusServer::open_tcp({"127.0.0.1", 0}, board, restarts, reopened);
    EXPECT_TRUE(opened) << (opened ? "" : opened.error());
    if (opened) server = std::move(*opened);
  }
  std::string wait_reopened() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(30), [&] { return !reopened_.empty(); });
    return reopened_;
  }

  StateBoard board;
  std::unique_ptr<ModbusServer> server;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string reopened_;
};

/// Over TCP (false) and over a serial line (true).
class ModbusServerTest : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(BothLines, ModbusServerTest, testing::Bool(),
                         [](const auto& test) { return test.param ? "Rtu" : "Tcp"; });

TEST_P(ModbusServerTest, AnswersWithTheStateAsItIs) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  ASSERT_TRUE(client.connected());
  ASSERT_EQ(client.read(), 0);
  EXPECT_EQ(client.integer(0), 1500);
  EXPECT_EQ(client.integer(2), 3000);
  EXPECT_EQ(client.integer(kLineRegister), 12);
  served.board.publish(served_at(-2));
  ASSERT_EQ(client.read(), 0);
  EXPECT_EQ(client.integer(0), -2000);
  std::array<std::uint16_t, 2> input{};
  ASSERT_EQ(modbus_read_input_registers(client.context(), 4, 2, input.data()), 2);
  EXPECT_EQ(input[0], 2000);
}

TEST_P(ModbusServerTest, RefusesWhatIsNotARead) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  EXPECT_EQ(modbus_write_register(client.context(), 0, 7), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  const std::array<std::uint16_t, 2> values{1, 2};
  EXPECT_EQ(modbus_write_registers(client.context(), 0, 2, values.data()), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  std::array<std::uint8_t, 2> coils{};
  EXPECT_EQ(modbus_read_bits(client.context(), 0, 2, coils.data()), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  EXPECT_EQ(served.server->refused(), 3u);
  ASSERT_EQ(client.read(), 0);
  EXPECT_EQ(client.integer(0), 1500);
  std::array<std::uint16_t, 4> beyond{};
  EXPECT_EQ(modbus_read_registers(client.context(), kRegisterCount - 1, 2, beyond.data()), -1);
  EXPECT_EQ(errno, EMBXILADD);
}

TEST_P(ModbusServerTest, DropGivesNoAnswer) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  served.board.publish(served_at(1, {FaultKind::kDrop}));
  client.set_timeout_ms(50);
  EXPECT_EQ(client.read(), ETIMEDOUT);
  served.board.publish(served_at(1));
  client.set_timeout_ms(2000);
  EXPECT_EQ(client.read(), 0);
}

TEST_P(ModbusServerTest, ExceptionHasItsCode) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  ServedState state = served_at(1, {FaultKind::kException});
  for (const int code : {1, 2, 4, 6, 11}) {
    state.faults.exception_code = code;
    served.board.publish(state);
    EXPECT_EQ(client.read(), MODBUS_ENOBASE + code);
  }
  served.board.publish(served_at(1));
  EXPECT_EQ(client.read(), 0);
}

TEST_P(ModbusServerTest, GarbageIsNoAnswer) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  served.board.publish(served_at(1, {FaultKind::kGarbage}));
  client.set_timeout_ms(200);
  EXPECT_NE(client.read(), 0);
  served.board.publish(served_at(1));
  client.reconnect();
  modbus_flush(client.context());
  client.set_timeout_ms(2000);
  EXPECT_EQ(client.read(), 0);
}

TEST_P(ModbusServerTest, DelayAndExceptionAtOnce) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  ServedState state = served_at(1, {FaultKind::kDelay, FaultKind::kException});
  state.faults.delay_ms = 120;
  state.faults.exception_code = 4;
  served.board.publish(state);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(client.read(), EMBXSFAIL);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(120));
}

TEST_P(ModbusServerTest, ADelayedAnswerIsOfTheTimeOfItsRequest) {
  Served served(GetParam());
  ModbusClient client(served.server->address());
  ServedState state = served_at(1, {FaultKind::kDelay});
  state.faults.delay_ms = 300;
  served.board.publish(state);
  client.set_timeout_ms(30);
  EXPECT_EQ(client.read(), ETIMEDOUT);
  served.board.publish(served_at(9));
  client.set_timeout_ms(3000);
  // The late answer is what a client on a serial line takes for the new one: facts of the protocol.
  const int error = client.read();
  if (GetParam()) {
    EXPECT_EQ(error, 0);
    EXPECT_EQ(client.integer(0), 1000);
  } else {
    EXPECT_NE(error, 0);
  }
}

TEST_P(ModbusServerTest, RestartHangsUpAndComesBack) {
  Served served(GetParam(), true);
  const std::string address = served.server->address();
  ModbusClient client(address);
  ASSERT_EQ(client.read(), 0);
  served.board.publish(served_at(1, {FaultKind::kRestart}));
  // Until the server has looked, requests are dropped.
  client.set_timeout_ms(20);
  int error = 0;
  do {
    error = client.read();
    ASSERT_NE(error, 0);
  } while (error == ETIMEDOUT);
  if (GetParam()) {
    EXPECT_TRUE(error == EIO || error == ECONNRESET) << error;
  } else {
    EXPECT_TRUE(error == ECONNRESET || error == EPIPE) << error;
    client.reconnect();
    EXPECT_FALSE(client.connected());
    EXPECT_EQ(errno, ECONNREFUSED);
  }
  served.board.publish(served_at(3));
  const std::string again = served.wait_reopened();
  ASSERT_FALSE(again.empty());
  if (!GetParam()) {
    EXPECT_EQ(again, address);
  }
  ModbusClient next(again);
  ASSERT_EQ(next.read(), 0);
  EXPECT_EQ(next.integer(0), 3000);
}

/// Answers of one moment each: X, Y, Z belong together while they change as fast as they can.
TEST_P(ModbusServerTest, NoAnswerIsTorn) {
  Served served(GetParam());
  std::atomic<bool> stop = false;
  std::thread machine([&] {
    for (int i = -5000; !stop; i = i == 5000 ? -5000 : i + 1) {
      served.board.publish(served_at(i * 13.107));
    }
  });
  ModbusClient client(served.server->address());
  constexpr int kStates = 500;
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  int different = 0;
  std::int32_t last = 0;
  while (different < kStates && std::chrono::steady_clock::now() < limit) {
    if (client.read() != 0) break;
    const std::int32_t x = client.integer(0);
    const float as_float = modbus_get_float_abcd(&client.registers[kFloatRegister]);
    if (client.integer(2) != 2 * x || client.integer(4) != -x || client.integer(6) != x ||
        std::abs(as_float - x * 1e-3) > 0.01) {
      ADD_FAILURE() << "torn at " << x;
      break;
    }
    if (x != last) ++different;
    last = x;
  }
  stop = true;
  machine.join();
  EXPECT_EQ(different, kStates);
}

TEST(ModbusTcp, ServesSeveralClientsAndSurvivesNonsense) {
  Served served(false);
  std::vector<std::unique_ptr<ModbusClient>> clients;
  for (int i = 0; i < 5; ++i) {
    clients.push_back(std::make_unique<ModbusClient>(served.server->address()));
  }
  const std::array<char, 20> nonsense = {"GET / HTTP/1.0\r\n\r\n"};
  ASSERT_EQ(write(modbus_get_socket(clients[2]->context()), nonsense.data(), nonsense.size()),
            static_cast<ssize_t>(nonsense.size()));
  for (int i = 0; i < 5; ++i) {
    if (i != 2) {
      EXPECT_EQ(clients[static_cast<std::size_t>(i)]->read(), 0) << i;
    }
  }
  clients[2]->reconnect();
  EXPECT_EQ(clients[2]->read(), 0);
}

TEST(ModbusTcp, APortThatIsTakenIsNamed) {
  Served served(false);
  const std::string address = served.server->address();
  const int port = std::stoi(address.substr(address.rfind(':') + 1));
  StateBoard board;
  const auto second = ModbusServer::open_tcp({"127.0.0.1", port}, board, false);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error(), "listening on " + address + ": Address already in use");
  const auto unknown = ModbusServer::open_tcp({"no.such.host.invalid", 0}, board, false);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().substr(0, 37), "listening on no.such.host.invalid:0: ");
}

TEST(ModbusRtu, OtherUnitsGetNoAnswer) {
  Served served(true);
  ModbusClient client(served.server->address());
  modbus_set_slave(client.context(), 2);
  client.set_timeout_ms(50);
  EXPECT_EQ(client.read(), ETIMEDOUT);
  modbus_set_slave(client.context(), 1);
  client.set_timeout_ms(2000);
  EXPECT_EQ(client.read(), 0);
}

TEST(ModbusRtu, AnswersTakeTheTimeOfTheLine) {
  StateBoard board;
  ModbusRtuEnd end;
  end.baud = 9600;
  auto server = ModbusServer::open_rtu(end, board, false);
  ASSERT_TRUE(server);
  ModbusClient client((*server)->address());
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(client.read(), 0);
  // 8 bytes there, 237 back, 10 bits each.
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(255));
}

TEST(ModbusRtu, TheLinkIsMadeAndTakenAway) {
  const TemporaryFolder folder;
  const std::string link = folder / "ttyM";
  StateBoard board;
  ModbusRtuEnd end;
  end.link = link;
  {
    auto server = ModbusServer::open_rtu(end, board, false);
    ASSERT_TRUE(server);
    EXPECT_TRUE((*server)->address().ends_with(" link " + link));
    ModbusClient client(link);
    EXPECT_EQ(client.read(), 0);
  }
  struct stat found = {};
  EXPECT_NE(lstat(link.c_str(), &found), 0);
  std::ofstream(link) << "somebody's";
  const auto refused = ModbusServer::open_rtu(end, board, false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error(), link + " exists and is no symbolic link");
}

}  // namespace
}  // namespace kerf
