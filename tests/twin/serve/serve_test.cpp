#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "stock/zmap/zmap.h"
#include "twin/serve/gzip_pieces.h"
#include "twin/serve/packed_patch.h"
#include "twin/serve/serve_address.h"
#include "twin/serve/served_scene.h"
#include "twin/serve/shop_page.h"
#include "twin/serve/shop_state.h"

namespace kerf {
namespace {

using Json = nlohmann::json;

TEST(ServeAddress, IsReadWithWhatIsMissingAsItIsForThisComputer) {
  const auto read = [](const char* text) {
    const std::optional<ServeAddress> address = read_serve_address(text);
    return address ? to_string(*address) : "none";
  };
  EXPECT_EQ(read("192.168.1.5:9000"), "192.168.1.5:9000");
  EXPECT_EQ(read("192.168.1.5"), "192.168.1.5:8734");
  EXPECT_EQ(read("9000"), "127.0.0.1:9000");
  EXPECT_EQ(read("0"), "127.0.0.1:0");
  EXPECT_EQ(read("localhost:9000"), "127.0.0.1:9000");
  EXPECT_EQ(read("[::1]:9000"), "[::1]:9000");
  EXPECT_EQ(read("[fd00::5]"), "[fd00::5]:8734");
  for (const char* text :
       {"", ":", "a", "1.2.3:80", "1.2.3.4:", "1.2.3.4:65536", "1.2.3.4:-1", "256.1.1.1:80", "[::1",
        "[::1]x", "::1:80", "[1.2.3.4]:80", "shop:80", "1.2.3.4:80:80", "65536", "+80"}) {
    EXPECT_EQ(read(text), "none") << text;
  }
}

TEST(ServeAddress, WhatStandsBehindANulCounts) {
  EXPECT_FALSE(read_serve_address(std::string_view("1.2.3.4\0 evil", 13)));
  EXPECT_FALSE(is_own_host(std::string_view("127.0.0.1\0.evil", 15)));
}

TEST(ServeAddress, LoopbackIsWhatNobodyElseReaches) {
  for (const char* text : {"127.0.0.1:1", "127.9.9.9:1", "localhost:1", "[::1]:1", "80"}) {
    EXPECT_TRUE(read_serve_address(text)->is_loopback()) << text;
  }
  for (const char* text : {"0.0.0.0:1", "192.168.1.5:1", "[::]:1", "[fd00::5]:1", "128.0.0.1:1"}) {
    EXPECT_FALSE(read_serve_address(text)->is_loopback()) << text;
  }
}

TEST(ServeRequests, OnlyThisComputersOwnNamesCountWithoutAToken) {
  for (const char* host :
       {"localhost", "localhost:8734", "127.0.0.1:8734", "127.0.0.8", "[::1]:8734"})
    EXPECT_TRUE(is_own_host(host)) << host;
  for (const char* host :
       {"", "evil.example", "evil.example:8734", "127.0.0.1.evil.example", "localhost.evil.example",
        "127.evil", "[::2]:8734", "[::1", "192.168.1.5"})
    EXPECT_FALSE(is_own_host(host)) << host;
}

TEST(ServeRequests, TheTokenLetsInAndNothingLikeIt) {
  const std::string token = new_access_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, new_access_token());
  EXPECT_TRUE(is_authorized("Bearer " + token, token));
  std::string near = token;
  near.back() = near.back() == '0' ? '1' : '0';
  for (const std::string& said :
       {std::string(), std::string("Bearer "), token, "bearer " + token, "Bearer " + near,
        "Bearer " + token + "0", "Bearer " + token.substr(1), "Basic " + token}) {
    EXPECT_FALSE(is_authorized(said, token)) << said;
  }
  EXPECT_FALSE(is_authorized("Bearer ", ""));
}

TEST(ServeRequests, NumbersAndEncodings) {
  EXPECT_EQ(read_seen_number("0"), 0U);
  EXPECT_EQ(read_seen_number("1795746117361"), 1795746117361U);
  for (const char* text : {"", "-1", "+1", "1e3", " 1", "1 ", "0x1", "12345678901234567890"})
    EXPECT_FALSE(read_seen_number(text)) << text;
  for (const char* text : {"gzip", "gzip, deflate, br", "br,gzip;q=0.5", "deflate,  gzip ; q=1"})
    EXPECT_TRUE(takes_gzip(text)) << text;
  for (const char* text : {"", "br", "xgzip", "gzipx", "gzip;q=0", "gzip; q=0.00", "identity"})
    EXPECT_FALSE(takes_gzip(text)) << text;
}

std::string unzipped(const std::string& file) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  std::string out(std::size_t{1} << 22, '\0'), in = file;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);  // which checks sum and length
  EXPECT_EQ(stream.avail_in, 0U);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

TEST(GzipPieces, AnyOfThemInAnyOrderAreOneFile) {
  const std::string one(1000, 'a'), other("\0\1\2 and more", 12), none;
  const GzipPiece first = gzip_piece(one), second = gzip_piece(other), third = gzip_piece(none);
  const std::array<const GzipPiece*, 5> pieces{&first, &second, &third, &second, &first};
  EXPECT_EQ(unzipped(gzip_of(pieces)), one + other + other + one);
  EXPECT_LT(first.blocks.size(), 60U);
  EXPECT_EQ(unzipped(gzip_of({})), "");
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

/// By hand: two corners of a box 2 x 4 x 0, one cut.
TEST(PackedPatch, HasWhatTheHeaderSays) {
  MeshPatch patch;
  patch.tile = 7;
  patch.vertices = {{glm::vec3(1, 2, 3), pack_normal({0, 0, 1})},
                    {glm::vec3(3, 6, 3), pack_normal({-1, 0, 0})},
                    {glm::vec3(2, 3, 3), pack_normal({0, 1, 0})}};
  patch.indices = {0, 1, 2};
  patch.cut_by = {MeshPatch::kNotCut, 5, MeshPatch::kNotCut};
  const std::string bytes = packed(patch);
  ASSERT_EQ(bytes.size(), 36U + 30 + 6);  // a multiple of 4
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 0), 7U);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 4), 3U);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), 3U);
  const std::array<float, 6> box{1, 2, 3, 2, 4, 0};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(number_at<float>(bytes, 12 + 4 * i), box[i]);
  const std::array<std::uint16_t, 9> places{0, 0, 0, 65535, 65535, 0, 32768, 16384, 0};
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(number_at<std::uint16_t>(bytes, 36 + 10 * (i / 3) + 2 * (i % 3)), places[i]) << i;
  EXPECT_EQ(number_at<std::int8_t>(bytes, 36 + 8), 127);
  EXPECT_EQ(number_at<std::int8_t>(bytes, 46 + 6), -127);
  EXPECT_EQ(bytes[36 + 9], 0);
  EXPECT_EQ(bytes[46 + 9], 1);
  EXPECT_EQ(number_at<std::uint16_t>(bytes, 66 + 4), 2);
}

TEST(PackedPatch, EveryPlaceOfATileIsWithinItsStep) {
  ZMapOptions options;
  BlankBody body;
  body.bounds_mm = {Vec3(-10, 0, -5), Vec3(30, 20, 0)};
  options.blank.bodies = {body};
  options.cell_mm = 0.5;
  const auto made = ZMap::create(options);
  ASSERT_TRUE(made);
  const StockModel* const stock = made->get();
  for (std::uint32_t tile = 0; tile < stock->tile_count(); ++tile) {
    const MeshPatch patch = stock->patch(tile, 1);
    const std::string bytes = packed(patch);
    ASSERT_EQ(bytes.size() % 4, 0U);
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float low = number_at<float>(bytes, 12 + 4 * axis);
        const float size = number_at<float>(bytes, 24 + 4 * axis);
        const auto step = number_at<std::uint16_t>(bytes, 36 + 10 * i + 2 * axis);
        const float place = low + size * static_cast<float>(step) / 65535.0F;
        EXPECT_NEAR(place, patch.vertices[i].position_mm[static_cast<int>(axis)],
                    size / 131070.0F + 1e-5F);
      }
    }
  }
}

struct Answer {
  Json state;
  std::set<std::uint32_t> tiles;  ///< by their first four bytes
  SeenByPage seen;
};

/// Of patches of `size` bytes each.
Answer answer_of(ServedScene& scene, const SeenByPage& seen, std::size_t size) {
  const std::string bytes = scene.answer(seen, false);
  EXPECT_EQ(bytes.substr(0, 4), "KRF1");
  // Of large tiles more come at once when they are compressed.
  EXPECT_TRUE(size > 1000 || unzipped(scene.answer(seen, true)) == bytes);
  const auto length = number_at<std::uint32_t>(bytes, 4);
  EXPECT_EQ(length % 4, 0U);
  Answer answer;
  answer.state = Json::parse(bytes.substr(8, length));
  for (std::size_t at = 8 + length; at < bytes.size(); at += size)
    answer.tiles.insert(number_at<std::uint32_t>(bytes, at));
  answer.seen.epoch = answer.state["epoch"];
  answer.seen.version = answer.state["version"];
  answer.seen.mesh = answer.state["mesh"];
  answer.seen.findings = answer.state["findings_count"];
  return answer;
}

std::string tile_of(std::uint32_t tile, std::size_t size) {
  std::string bytes(size, 'x');
  std::memcpy(bytes.data(), &tile, sizeof(tile));
  return bytes;
}

TEST(ServedScene, APageGetsWhatIsNewerThanWhatItHas) {
  ServedScene scene;
  scene.set_setup(R"("title":"a")");
  scene.set_state(R"("line":1)");
  scene.set_patch(3, tile_of(3, 40));
  scene.set_patch(5, tile_of(5, 40));
  Answer answer = answer_of(scene, {}, 40);
  EXPECT_EQ(answer.tiles, (std::set<std::uint32_t>{3, 5}));
  EXPECT_EQ(answer.state["title"], "a");
  EXPECT_EQ(answer.state["is_whole"], false) << "more tiles may come";
  EXPECT_FALSE(scene.has_news(answer.seen));

  scene.set_whole(true);
  scene.set_state(R"("line":2)");
  EXPECT_TRUE(scene.has_news(answer.seen));
  answer = answer_of(scene, answer.seen, 40);
  EXPECT_TRUE(answer.tiles.empty());
  EXPECT_EQ(answer.state["line"], 2);
  EXPECT_EQ(answer.state["is_whole"], true);
  EXPECT_FALSE(answer.state.contains("title")) << "it has it";

  scene.set_patch(3, tile_of(3, 40));
  scene.add_finding(R"({"text":"one"})");
  answer = answer_of(scene, answer.seen, 40);
  EXPECT_EQ(answer.tiles, std::set<std::uint32_t>{3});
  EXPECT_EQ(answer.state["findings"].size(), 1U);
  answer = answer_of(scene, answer.seen, 40);
  EXPECT_TRUE(answer.tiles.empty());
  EXPECT_TRUE(answer.state["findings"].empty());
  EXPECT_EQ(answer.state["findings_count"], 1);
}

TEST(ServedScene, AnotherWorkpieceIsAllNew) {
  ServedScene scene;
  scene.set_setup(R"("title":"a")");
  scene.set_patch(3, tile_of(3, 40));
  scene.set_whole(true);
  scene.add_finding(R"({"text":"one"})");
  const Answer before = answer_of(scene, {}, 40);
  scene.begin_anew();
  EXPECT_TRUE(scene.has_news(before.seen));
  const Answer after = answer_of(scene, before.seen, 40);
  EXPECT_NE(after.seen.epoch, before.seen.epoch);
  EXPECT_TRUE(after.tiles.empty());
  EXPECT_EQ(after.state["title"], "a");
  EXPECT_EQ(after.state["is_whole"], false);
  EXPECT_EQ(after.state["findings_count"], 0);
}

TEST(ServedScene, AnotherWorkpieceOfTheSameSessionKeepsItsFindings) {
  ServedScene scene;
  scene.set_patch(3, tile_of(3, 40));
  scene.add_finding(R"({"text":"one"})");
  const Answer before = answer_of(scene, {}, 40);
  scene.begin_part_anew();
  const Answer after = answer_of(scene, before.seen, 40);
  EXPECT_NE(after.seen.epoch, before.seen.epoch);
  EXPECT_TRUE(after.tiles.empty());
  EXPECT_EQ(after.state["findings"].size(), 1U);
}

TEST(ServedScene, OfAListThatGoesOnPagesGetWhatIsNewElseAllOfIt) {
  ServedScene scene;
  scene.set_findings({R"({"text":"a"})", R"({"text":"b"})"}, 2);
  Answer answer = answer_of(scene, {}, 40);
  EXPECT_EQ(answer.state["findings_from"], 0);
  EXPECT_EQ(answer.state["findings"].size(), 2U);

  scene.set_findings({R"({"text":"a"})", R"({"text":"b"})", R"({"text":"c"})"}, 5);
  EXPECT_TRUE(scene.has_news(answer.seen));
  answer = answer_of(scene, answer.seen, 40);
  EXPECT_EQ(answer.state["findings_from"], 2);
  EXPECT_EQ(answer.state["findings"], Json::parse(R"([{"text":"c"}])"));
  EXPECT_EQ(answer.state["findings_count"], 5);
  answer.seen.findings = 3;

  scene.set_findings({R"({"text":"a"})", R"({"text":"b"})", R"({"text":"c"})"}, 5);
  EXPECT_FALSE(scene.has_news(answer.seen)) << "the same again is nothing new";

  scene.set_findings({R"({"text":"a"})", R"({"text":"x"})"}, 2);
  answer = answer_of(scene, answer.seen, 40);
  EXPECT_EQ(answer.state["findings_from"], 0);
  EXPECT_EQ(answer.state["findings"], Json::parse(R"([{"text":"a"},{"text":"x"}])"));
}

TEST(ServedScene, AnswersAreBoundedAndATileThatChangesOnAndOnKeepsNoOtherBack) {
  ServedScene scene;
  constexpr std::size_t kSize = 20'000;
  for (std::uint32_t tile = 0; tile < 100; ++tile) scene.set_patch(tile, tile_of(tile, kSize));
  scene.set_whole(true);
  Answer answer = answer_of(scene, {}, kSize);
  std::set<std::uint32_t> got = answer.tiles;
  EXPECT_EQ(got.size(), ServedScene::kMostFirst / kSize);
  int answers = 1;
  while (answer.state["is_whole"] == false) {
    scene.set_patch(99, tile_of(99, kSize));
    answer = answer_of(scene, answer.seen, kSize);
    EXPECT_LE(answer.tiles.size(), ServedScene::kMostAnswer / kSize);
    got.insert(answer.tiles.begin(), answer.tiles.end());
    ASSERT_LT(++answers, 100);
  }
  EXPECT_EQ(got.size(), 100U);
  EXPECT_EQ(answers, 1 + 20);  // 20 at first, then 4 each
}

TEST(ServedScene, OfVeryManyFindingsTheNumberIsTold) {
  ServedScene scene;
  for (int i = 0; i < 1000; ++i) scene.add_finding("{}");
  const Answer answer = answer_of(scene, {}, 40);
  EXPECT_EQ(answer.state["findings"].size(), ServedScene::kMostFindings);
  EXPECT_EQ(answer.state["findings_count"], 1000);
}

TEST(ServedScene, ItKnowsWhetherSomebodyLooks) {
  ServedScene scene;
  EXPECT_FALSE(scene.is_watched());
  scene.answer({}, false);
  EXPECT_TRUE(scene.is_watched());
}

TEST(ShopPage, HasFourFilesAndNoOthers) {
  const ShopPage page;
  for (const char* path : {"/", "/shop.css", "/shop.js", "/icon.svg"}) ASSERT_TRUE(page.find(path));
  for (const char* path : {"", "/.", "//", "/shop.css/", "/SHOP.JS", "shop.js", "/scene"})
    EXPECT_FALSE(page.find(path)) << path;
  const std::string& text = page.find("/")->body;
  EXPECT_EQ(text.find("@TEXTS@"), text.npos);
  EXPECT_EQ(text.find("@LANGUAGE@"), text.npos);
  // What the policy would keep from running.
  for (const char* word : {"style=", "onclick", "http:", "https:"})
    EXPECT_EQ(text.find(word), text.npos) << word;
}

TEST(ShopState, SaysWhatIsKnownInTheReadersUnit) {
  LiveStatus status;
  status.state = LiveState::kLive;
  status.age_s = 0.04;
  status.file = "/programs/part.ngc";
  status.remaining_s = 125;
  status.place.known = status.place.followed = true;
  status.place.tip_mm = Vec3(25.4, 0, -2.54);
  status.place.source.line = 12;
  status.place.tool = 3;
  status.place.spindle_rpm = std::nan("");
  const Json mm = Json::parse(
      "{" + state_members(moment_of(status, "flat 8", LengthUnit::kMm), {{12, "G1 <b>\xff"}}) +
      "}");
  EXPECT_EQ(mm["state"], "live");
  EXPECT_EQ(mm["line"], 12);
  EXPECT_EQ(mm["code"][0][0], 12);
  const Json rows = Json::parse(R"([["Program","part.ngc:12"],["Time left","2 min 05 s"],
      ["Position","X25.400 Y0.000 Z-2.540"],["Tool","T3 flat 8"],["Removed","0.00 cm3"]])");
  EXPECT_EQ(mm["rows"], rows);
  EXPECT_EQ(mm["notice"], "");
  EXPECT_EQ(mm["is_alarm"], false);
  status.collision_in_s = 1.5;
  status.collision_line = 40;
  const Json inch =
      Json::parse("{" + state_members(moment_of(status, "flat 8", LengthUnit::kInch)) + "}");
  EXPECT_EQ(inch["rows"][2][1], "X1.0000 Y0.0000 Z-0.1000");
  EXPECT_EQ(inch["is_alarm"], true);
  EXPECT_EQ(inch["notice"], "collision in 1.5 s, line 40");
}

}  // namespace
}  // namespace kerf
