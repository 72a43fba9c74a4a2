// --serve as a user writes it. The page itself: tests/serve.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/twin/cli/kerf_process.h"
#include "twin/cli/cli_options.h"

namespace kerf {
namespace {

constexpr const char* kLog = "t_s,x_mm,y_mm,z_mm,tool\n0,0,0,5,1\n0.5,0,0,-1,1\n1,10,0,-1,1\n";

KerfResult replay(const TestFolder& folder, const std::vector<std::string>& serve) {
  KerfCall call;
  call.arguments = {"replay",  folder.write("log.csv", kLog),
                    "--stock", "box:-5,-5,-5:15,5,0",
                    "--tool",  "1=flat:4",
                    "--speed", "max"};
  call.arguments.insert(call.arguments.end(), serve.begin(), serve.end());
  return run_kerf(call);
}

TEST(ServeCommand, SaysWhereThePageIsAndEndsAsItWouldWithoutOne) {
  const TestFolder folder;
  const KerfResult served = replay(folder, {"--serve", "127.0.0.1:0"});
  EXPECT_NE(served.err.find("kerf: the page is at http://127.0.0.1:"), std::string::npos)
      << served.err;
  EXPECT_EQ(served.err.find('#'), std::string::npos) << "a token for this computer: " << served.err;
  const KerfResult alone = replay(folder, {});
  EXPECT_EQ(served.exit_code, alone.exit_code);
  const auto after_its_clock = [](const std::string& text) {
    return text.substr(0, text.find("cut "));
  };
  EXPECT_EQ(after_its_clock(served.out), after_its_clock(alone.out));
}

TEST(ServeCommand, ForOthersTheLinkHasATokenEachTimeAnother) {
  const TestFolder folder;
  const auto token_of = [&] {
    const std::string err = replay(folder, {"--serve", "0.0.0.0:0"}).err;
    const std::size_t at = err.find("/#");
    return at == err.npos ? std::string() : err.substr(at + 2, err.find('\n', at) - at - 2);
  };
  const std::string token = token_of();
  EXPECT_EQ(token.size(), 32U) << token;
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
  EXPECT_NE(token, token_of());
}

TEST(ServeCommand, WhatIsNoAddressIsAUsageError) {
  const TestFolder folder;
  for (const char* const address : {"shop:80", "1.2.3.4:99999", "::1:80"}) {
    const KerfResult result = replay(folder, {"--serve", address});
    EXPECT_EQ(result.exit_code, 2) << address;
    EXPECT_NE(result.err.find("is no address of this computer"), std::string::npos) << result.err;
  }
}

TEST(ServeCommand, APortThatIsTakenIsAFailureThatSaysSo) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof(place);
  auto* const bound = reinterpret_cast<sockaddr*>(&place);
  ASSERT_EQ(::bind(fd, bound, length), 0);
  ASSERT_EQ(::listen(fd, 1), 0);
  ASSERT_EQ(::getsockname(fd, bound, &length), 0);
  const std::string address = "127.0.0.1:" + std::to_string(ntohs(place.sin_port));
  const TestFolder folder;
  const KerfResult result = replay(folder, {"--serve", address});
  ::close(fd);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_NE(result.err.find("--serve: " + address), std::string::npos) << result.err;
}

TEST(ServeCommand, APictureOrSeveralProgramsHaveNoPage) {
  const TestFolder folder;
  const std::string part = folder.write("part.ngc", "G21\nM2\n");
  const std::string other = folder.write("other.ngc", "G21\nM2\n");
  KerfCall call;
  call.arguments = {"run", part, other, "--serve=0"};
  KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--serve: one page, and there are several programs"), std::string::npos)
      << result.err;
  call.arguments = {"view", part, "--png", folder.file("part.png"), "--serve=0"};
  result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--serve: is for the window"), std::string::npos) << result.err;
}

TEST(ServeCommand, WhoDoesNotHaveItSaysWhoHas) {
  KerfCall call;
  call.arguments = {"job", "part.yaml", "--serve"};
  const KerfResult result = run_kerf(call);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("kerf run has it"), std::string::npos) << result.err;
}

TEST(ServeCommand, TakesTheNextWordUnlessThatIsAnOptionOrAFile) {
  const TestFolder folder;
  const std::string log = folder.write("log.csv", kLog);
  using Words = std::vector<std::string>;
  const std::string bare = "--serve=127.0.0.1:8734";
  EXPECT_EQ(with_bare_options({"kerf", "shadow", "--serve"}), (Words{"kerf", "shadow", bare}));
  EXPECT_EQ(with_bare_options({"--serve", "--quiet"}), (Words{bare, "--quiet"}));
  EXPECT_EQ(with_bare_options({"--serve", log}), (Words{bare, log}));
  EXPECT_EQ(with_bare_options({"--serve", "9000", log}), (Words{"--serve", "9000", log}));
  EXPECT_EQ(with_bare_options({"--serve", "1.2.3"}), (Words{"--serve", "1.2.3"}));
  EXPECT_EQ(with_bare_options({"--serve=9000"}), (Words{"--serve=9000"}));
  EXPECT_EQ(with_bare_options({"--", "--serve"}), (Words{"--", "--serve"}));
}

}  // namespace
}  // namespace kerf
