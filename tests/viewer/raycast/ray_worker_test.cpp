// Rays in a thread: what is put together from the parts that are taken is the picture that a caster
// makes at once.
#include "viewer/raycast/ray_worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <optional>

#include "tests/viewer/raycast/sample_grids.h"

namespace kerf {
namespace {

constexpr glm::ivec2 kSize_px{160, 120};
const Box kBox{Vec3(0, 0, -8), Vec3(40, 30, 0)};

/// A dish, and a groove whose depth changes.
std::shared_ptr<const HeightGrid> part(double groove_mm) {
  return test::make_grid(kBox, 160, 120, [groove_mm](double x, double y) {
    if (std::abs(x - 10) < 1.5) return -groove_mm;
    const double r = std::hypot(x - 25, y - 15);
    return r < 10 ? -4 * (1 - r / 10) : 0.0;
  });
}

class RayWorkerTest : public testing::Test {
 protected:
  /// Takes pictures until one is of this view, in full size and with all that was asked for.
  bool takes(const Projection& view) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < end) {
      if (const auto picture = worker_.take()) {
        if (picture->is_whole) {
          size_px_ = picture->size_px;
          const auto count = static_cast<std::size_t>(size_px_.x * size_px_.y);
          rgba_.assign(4 * count, 0);
          depths_.assign(count, 0.0f);
        }
        coarse_ += picture->size_px == view.size_px ? 0 : 1;
        paste(*picture);
        if (picture->projection == view && picture->size_px == view.size_px) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  void paste(const RayPicture& picture) {
    ASSERT_EQ(picture.size_px, size_px_) << "parts are of the picture before them";
    last_rect_px_ = picture.high_px - picture.low_px;
    std::size_t from = 0;
    for (int y = picture.low_px.y; y < picture.high_px.y; ++y) {
      for (int x = picture.low_px.x; x < picture.high_px.x; ++x, ++from) {
        const auto to = static_cast<std::size_t>(y * size_px_.x + x);
        std::copy_n(&picture.rgba[4 * from], 4, &rgba_[4 * to]);
        depths_[to] = picture.window_depths[from];
      }
    }
  }
  /// Takes pictures until what they have made together is, bit for bit, what one cast makes.
  bool comes_to(const std::shared_ptr<const HeightGrid>& grid, const Projection& view) {
    RayCaster caster(1);
    caster.set_workpiece(grid);
    caster.draw(view);
    const auto is_same = [&] {
      if (!std::equal(depths_.begin(), depths_.end(), caster.workpiece_depths().begin())) {
        return false;
      }
      for (std::size_t i = 0; i < depths_.size(); ++i) {
        if (!std::equal(&rgba_[4 * i], &rgba_[4 * i] + 3, &caster.picture().rgb[3 * i])) {
          return false;
        }
      }
      return true;
    };
    while (takes(view)) {
      if (is_same()) return true;
    }
    return false;
  }

  std::atomic<int> told_{0};
  RayWorker worker_{2, [this] { ++told_; }};
  glm::ivec2 size_px_{0}, last_rect_px_{0};
  std::vector<std::uint8_t> rgba_;
  std::vector<float> depths_;
  int coarse_ = 0;
};

TEST_F(RayWorkerTest, PartsMakeThePictureOfOneCast) {
  const Projection view = test::view_of(kBox, 0, kSize_px);
  worker_.begin_anew();
  worker_.look_from(view);
  worker_.set_workpiece(part(1));
  ASSERT_TRUE(comes_to(part(1), view));
  for (const double groove_mm : {2.0, 3.0, 1.5}) {
    const auto grid = part(groove_mm);
    worker_.set_workpiece(grid);
    ASSERT_TRUE(comes_to(grid, view));
    EXPECT_LE(last_rect_px_.x, kSize_px.x / 2) << "the groove alone";
  }
  EXPECT_GE(told_, 4);
  const auto grid = part(1.5);
  for (const int number : {9, 12, 15}) {
    const Projection other = test::view_of(kBox, number, kSize_px);
    worker_.look_from(other);
    ASSERT_TRUE(comes_to(grid, other));
  }
}

TEST_F(RayWorkerTest, PicturesThatNobodyTookGrowTogether) {
  const Projection view = test::view_of(kBox, 0, kSize_px);
  worker_.begin_anew();
  worker_.look_from(view);
  worker_.set_workpiece(part(1));
  ASSERT_TRUE(comes_to(part(1), view));
  const auto is_made = [this](int before) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (told_ <= before && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    return told_ > before;
  };
  for (const double groove_mm : {2.0, 3.0}) {
    const int before = told_;
    worker_.set_workpiece(part(groove_mm));
    ASSERT_TRUE(is_made(before));
  }
  // Elsewhere than the groove.
  const auto last = test::make_grid(kBox, 160, 120, [](double x, double y) {
    if (std::abs(x - 10) < 1.5) return -3.0;
    if (std::abs(y - 28) < 1.0) return -2.0;
    const double r = std::hypot(x - 25, y - 15);
    return r < 10 ? -4 * (1 - r / 10) : 0.0;
  });
  worker_.set_workpiece(last);
  EXPECT_TRUE(comes_to(last, view));
}

TEST_F(RayWorkerTest, AfterBeginAnewTheNextPictureIsWhole) {
  const Projection view = test::view_of(kBox, 1, kSize_px);
  worker_.begin_anew();
  worker_.look_from(view);
  worker_.set_workpiece(part(1));
  ASSERT_TRUE(comes_to(part(1), view));
  rgba_.clear();
  depths_.clear();
  worker_.begin_anew();
  EXPECT_TRUE(comes_to(part(1), view));
}

/// More pixels than can be cast in time on any machine: first fewer of them.
TEST_F(RayWorkerTest, AnEyeThatMovesGetsACoarserPictureFirst) {
  constexpr glm::ivec2 kLarge_px{2400, 1800};
  const Projection view = test::view_of(kBox, 0, kLarge_px);
  worker_.begin_anew();
  worker_.look_from(view);
  worker_.set_workpiece(part(1));
  ASSERT_TRUE(takes(view));
  EXPECT_GE(coarse_, 1);
}

}  // namespace
}  // namespace kerf
