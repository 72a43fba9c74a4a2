#include "viewer/csg/csg_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>
#include <numeric>
#include <optional>
#include <utility>

#include "base/translate.h"
#include "viewer/csg/csg_schedule.h"
#include "viewer/csg/csg_store.h"
#include "viewer/csg/layer_composer.h"
#include "viewer/csg/query_pool.h"
#include "viewer/gl_objects.h"
#include "viewer/shaders/shaders.h"

namespace kerf {
namespace {

/// Solids end this share of the blank's size above it: enough for the depth buffer to tell both
/// apart, as little as possible to draw.
constexpr double kAboveBlank = 0.02;
/// Batches mark the stencil with their number, so it is cleared only when the numbers run out.
constexpr GLint kLastMark = 255;
/// The blank seen from above, in steps along its longer side: finds solids that overlap in space.
constexpr int kGround_steps = 2048;
/// Solids that are taken at once at the beginning of a draw with a time limit.
constexpr std::size_t kFirstGroup = 2;
/// With a time limit the card is waited for after so much work, which a software renderer does in
/// about 2 ms: the clock says nothing of what is only queued. In pixels; a triangle counts for
/// kTriangle_px of them.
constexpr std::int64_t kLook_px = 300'000;
constexpr std::int64_t kTriangle_px = 40;

using Clock = std::chrono::steady_clock;

/// Of material that the near plane cuts through.
constexpr glm::vec3 kSection{0.45f, 0.43f, 0.41f};

/// Colour and depth of what is left of one layer of the blank.
struct Layer {
  DepthLayer pixels;
  TileClock clock;                       // of the picture
  TileClock ground;                      // of the blank seen from above
  std::vector<std::uint64_t> looked_at;  // by solid: when it was subtracted last
  bool is_settled = true;                // no solid has to be looked at again
};

struct Solid {
  StoredSolid stored;
  Box bounds_mm;
  Vec3 middle_mm{0.0};  // of the tip's way: orders solids from front to back
  PixelArea area;
  PixelRect ground;  // seen from above
};

/// Solids that share no pixel.
struct Batch {
  std::vector<StoredSolid> solids;
  bool is_around_eye = false;  // of the only one then
  std::int64_t work_px = 0;    // see kLook_px
};

struct Tool {
  std::vector<ConvexProfile> pieces;
  std::uint32_t color = 0;
};

bool is_eye_in(const Box& box, const Projection& projection) {
  if (projection.clip_from_world[0][3] == 0.0f && projection.clip_from_world[1][3] == 0.0f &&
      projection.clip_from_world[2][3] == 0.0f) {
    return false;  // parallel rays come from outside
  }
  const Vec3 eye(glm::inverse(glm::dmat4(projection.view_from_world))[3]);
  return glm::all(glm::greaterThan(eye, box.min)) && glm::all(glm::lessThan(eye, box.max));
}

bool overlaps(const Box& a, const Box& b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y &&
         a.min.z < b.max.z && b.min.z < a.max.z;
}

}  // namespace

class CsgRenderer::Impl {
 public:
  Impl(GlProgram solid_program, LayerComposer composer, const CsgOptions& options)
      : solid_program_(std::move(solid_program)),
        composer_(std::move(composer)),
        options_(options) {
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size_px_);
  }

  Done set_blank(const CsgBlank& blank);
  Done set_tools(std::span<const CsgTool> tools);
  void append(std::span<const SweptMove> moves);
  void clear_moves();
  Done draw(const Projection& projection, double longest_ms, bool shows);
  bool has_waiting() const { return !waiting_.empty() || !is_settled(); }
  const PixelRect& unshown() const { return unshown_; }
  const DepthLayer& shown() const { return composer_.shown(); }

  CsgCounters counters;
  std::size_t move_count = 0;
  PixelRect last_changed;  // by the last draw()

 private:
  Done resize(const Projection& projection);
  PixelRect ground_of(const Box& box) const;
  void begin_anew(const Projection& projection);
  std::vector<std::uint32_t> take_newest(std::size_t count);
  void place(std::vector<std::uint32_t>* solids);
  void take_waiting(double longest_ms);
  bool is_settled() const {
    return std::all_of(layers_.begin(), layers_.end(),
                       [](const Layer& layer) { return layer.is_settled; });
  }
  void use_solid_program() const;
  void begin_layer(const Layer& layer, int number);
  PixelRect whole_picture() const { return {{0, 0}, size_px_}; }
  std::size_t gpu_bytes() const;
  PixelRect settle(Layer* layer, std::vector<std::uint32_t> pending);
  std::size_t subtract_in_time(const std::vector<Batch>& batches);
  void subtract(const Batch& batch, std::size_t query);
  std::vector<std::uint32_t> to_look_at_again(const Layer& layer) const;
  Done compose(const PixelRect& rect);

  GlProgram solid_program_;
  LayerComposer composer_;
  CsgOptions options_;
  GLint max_size_px_ = 1;
  SolidStore store_;
  BlankStore blank_store_;
  QueryPool queries_;
  std::vector<Layer> layers_;

  std::vector<Tool> tools_;
  Box blank_mm_;
  int convexity_ = 0;  // 0: no blank
  std::optional<SweepBuilder> builder_;
  std::vector<Solid> solids_;
  std::vector<std::uint32_t> order_;    // of solids_ that the layers know, about front to back
  std::vector<std::uint32_t> waiting_;  // the others, the newest at the end
  PixelRect touched_;                   // of the layers: all else is as they were begun
  PixelRect unshown_;                   // of the layers, not in shown() yet
  Clock::time_point deadline_ = Clock::time_point::max();  // of the draw()
  std::uint64_t time_ = 1;                                 // counts batches; 0 is before all
  GLint mark_ = kLastMark;  // of the batch last drawn, in the stencil
  Projection projection_;
  glm::ivec2 size_px_{0};  // of the layers
  bool is_old_ = true;     // the layers, all of them
};

Done CsgRenderer::Impl::set_blank(const CsgBlank& blank) {
  if (Done done = check(blank); !done) return done;
  clear_moves();
  blank_store_.set(blank);
  blank_mm_ = {};
  for (const glm::vec3& p : blank.mesh.positions_mm) blank_mm_.extend(Vec3(p));
  convexity_ = blank.convexity;
  touched_ = whole_picture();
  const Vec3 size = blank_mm_.size();
  const double top = blank_mm_.max.z;
  builder_.emplace(options_.tolerance_mm, top,
                   top + kAboveBlank * std::max({size.x, size.y, size.z}));
  return std::monostate{};
}

Done CsgRenderer::Impl::set_tools(std::span<const CsgTool> tools) {
  std::vector<Tool> taken;
  for (const CsgTool& tool : tools) {
    Result<std::vector<ConvexProfile>> pieces = convex_pieces(tool.shape.cutter);
    if (!pieces) return Error{trf("tool {}: {}", taken.size(), pieces.error())};
    for (ConvexProfile& piece : *pieces) piece = simplified(piece, options_.tolerance_mm);
    taken.push_back({std::move(*pieces), tool.color});
  }
  tools_ = std::move(taken);
  clear_moves();
  return std::monostate{};
}

PixelRect CsgRenderer::Impl::ground_of(const Box& box) const {
  const Vec3 size = blank_mm_.size();
  const double steps_per_mm = kGround_steps / std::max(size.x, size.y);
  const auto step = [steps_per_mm](double mm) {
    return static_cast<int>(
        std::clamp(std::floor(mm * steps_per_mm), 0.0, static_cast<double>(kGround_steps - 1)));
  };
  return {{step(box.min.x - blank_mm_.min.x), step(box.min.y - blank_mm_.min.y)},
          {step(box.max.x - blank_mm_.min.x) + 1, step(box.max.y - blank_mm_.min.y) + 1}};
}

void CsgRenderer::Impl::append(std::span<const SweptMove> moves) {
  assert(builder_);
  for (const SweptMove& move : moves) {
    assert(move.tool < tools_.size());
    for (const ConvexProfile& piece : tools_[move.tool].pieces) {
      const SolidMesh mesh =
          builder_->build(piece, move.from_mm, move.to_mm, tools_[move.tool].color);
      if (mesh.indices.empty() || !overlaps(mesh.bounds_mm, blank_mm_)) continue;
      counters.triangles += mesh.indices.size() / 3;
      waiting_.push_back(static_cast<std::uint32_t>(solids_.size()));
      solids_.push_back({store_.add(mesh), mesh.bounds_mm, 0.5 * (move.from_mm + move.to_mm),
                         PixelArea{}, ground_of(mesh.bounds_mm)});
    }
  }
  counters.solids = solids_.size();
  move_count += moves.size();
}

void CsgRenderer::Impl::clear_moves() {
  store_.clear();
  solids_.clear();
  order_.clear();
  waiting_.clear();
  counters = {};
  move_count = 0;
  is_old_ = true;
}

Done CsgRenderer::Impl::resize(const Projection& projection) {
  const glm::ivec2 size_px = projection.size_px;
  const int layers = convexity_ + (is_eye_in(blank_mm_, projection) ? 1 : 0);
  if (size_px == size_px_ && layers == static_cast<int>(layers_.size())) return std::monostate{};
  if (std::max(size_px.x, size_px.y) > max_size_px_) {
    return Error{trf("this OpenGL draws at most {} x {} pixels; the picture has {} x {}",
                     max_size_px_, max_size_px_, size_px.x, size_px.y)};
  }
  layers_.resize(static_cast<std::size_t>(layers));
  for (Layer& layer : layers_) {
    if (Done done = layer.pixels.allocate(size_px); !done) return done;
  }
  size_px_ = size_px;
  touched_ = whole_picture();
  is_old_ = true;
  return std::monostate{};
}

/// Finds where the solids are in the picture, and puts them in order, about from front to back.
void CsgRenderer::Impl::place(std::vector<std::uint32_t>* solids) {
  std::vector<std::pair<float, std::uint32_t>> by_distance;
  for (const std::uint32_t number : *solids) {
    Solid& solid = solids_[number];
    solid.area = pixels_of(solid.bounds_mm, projection_);
    by_distance.emplace_back(
        -(projection_.view_from_world * glm::vec4(glm::vec3(solid.middle_mm), 1.0f)).z, number);
  }
  std::sort(by_distance.begin(), by_distance.end());
  for (std::size_t i = 0; i < solids->size(); ++i) (*solids)[i] = by_distance[i].second;
}

/// No solid is subtracted from the layers any more.
void CsgRenderer::Impl::begin_anew(const Projection& projection) {
  if (projection != projection_ || !options_.is_local) touched_ = whole_picture();
  projection_ = projection;
  order_.clear();
  waiting_.resize(solids_.size());
  std::iota(waiting_.begin(), waiting_.end(), 0u);
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    use_solid_program();
    glEnable(GL_CULL_FACE);
    begin_layer(layers_[i], static_cast<int>(i));
    layers_[i].is_settled = true;
    layers_[i].looked_at.clear();
    layers_[i].clock = TileClock(size_px_);
    layers_[i].ground = TileClock(glm::ivec2(kGround_steps));
  }
  unshown_.extend(std::exchange(touched_, {}));
  is_old_ = false;
}

std::vector<std::uint32_t> CsgRenderer::Impl::take_newest(std::size_t count) {
  const auto begin = waiting_.end() - static_cast<std::ptrdiff_t>(std::min(count, waiting_.size()));
  std::vector<std::uint32_t> taken(begin, waiting_.end());
  waiting_.erase(begin, waiting_.end());
  return taken;
}

/// Groups grow as long as they are taken quickly: many solids side by side cost little more than
/// one. What the last draw() had no time to look at again comes first. No time at all: nothing.
void CsgRenderer::Impl::take_waiting(double longest_ms) {
  const auto begin = Clock::now();
  const bool is_limited = std::isfinite(longest_ms);
  deadline_ = Clock::time_point::max();
  const auto room = std::chrono::duration<double, std::milli>(is_limited ? longest_ms : 0.0);
  if (is_limited) deadline_ = begin + std::chrono::duration_cast<Clock::duration>(room);
  const auto settle_all = [this](const std::vector<std::uint32_t>& added) {
    for (Layer& layer : layers_) {
      use_solid_program();
      glEnable(GL_CULL_FACE);
      layer.looked_at.resize(solids_.size());
      touched_.extend(settle(&layer, layer.is_settled ? added : to_look_at_again(layer)));
    }
    unshown_.extend(touched_);
  };
  bool has_done = !is_settled();
  if (has_done) settle_all({});
  std::size_t group = is_limited ? kFirstGroup : solids_.size();
  while (!waiting_.empty() && is_settled()) {
    const auto group_begin = Clock::now();
    if (std::exchange(has_done, true) && group_begin > deadline_) return;
    std::vector<std::uint32_t> added = take_newest(group);
    place(&added);
    order_.insert(order_.end(), added.begin(), added.end());
    settle_all(added);
    if (Clock::now() - group_begin < 0.25 * room) group *= 2;
  }
}

void CsgRenderer::Impl::use_solid_program() const {
  solid_program_.use();
  solid_program_.set("clip_from_world", projection_.clip_from_world);
  solid_program_.set("view_from_world", projection_.view_from_world);
}

/// Fills the layer with its front of the blank: of the fronts that are drawn at a pixel, the one
/// with the layer's number. Every front gets into one layer, whatever the order of triangles. The
/// layer after those begins at the near plane, for an eye inside of the blank.
void CsgRenderer::Impl::begin_layer(const Layer& layer, int number) {
  glBindFramebuffer(GL_FRAMEBUFFER, layer.pixels.framebuffer());
  glClearDepth(number < convexity_ ? 1.0 : 0.0);
  glClearStencil(0);
  glClearColor(kSection.r, kSection.g, kSection.b, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_STENCIL_TEST);
  glClearDepth(1.0);
  glStencilFunc(GL_EQUAL, number, 0xff);
  glStencilOp(GL_INCR, GL_INCR, GL_INCR);
  glDepthFunc(GL_ALWAYS);
  glCullFace(GL_BACK);
  if (number < convexity_) blank_store_.draw();
  mark_ = kLastMark;
}

/// Subtracts the solids, and again what may have to, until the layer stays as it is or the time is
/// over. Gives the pixels that changed.
PixelRect CsgRenderer::Impl::settle(Layer* layer, std::vector<std::uint32_t> pending) {
  glBindFramebuffer(GL_FRAMEBUFFER, layer->pixels.framebuffer());
  glEnable(GL_STENCIL_TEST);
  if (layers_.size() > 1) mark_ = kLastMark;  // each has a stencil of its own
  store_.bind();
  PixelRect changed;
  layer->is_settled = pending.empty();
  while (!pending.empty()) {
    ++counters.sweeps;
    std::vector<PixelRect> rects;
    for (const std::uint32_t solid : pending) rects.push_back(solids_[solid].area.rect);
    const std::vector<std::uint32_t> batch_of = layer->clock.batches(rects);
    const std::size_t count = 1 + *std::max_element(batch_of.begin(), batch_of.end());
    std::vector<Batch> batches(count);
    for (std::size_t i = 0; i < pending.size(); ++i) {
      const Solid& solid = solids_[pending[i]];
      Batch& batch = batches[batch_of[i]];
      batch.solids.push_back(solid.stored);
      batch.is_around_eye = solid.area.is_around_eye;
      batch.work_px += solid.area.rect.pixels() + kTriangle_px * (solid.stored.index_count / 3);
    }
    const std::size_t done = subtract_in_time(batches);
    for (std::size_t i = 0; i < pending.size(); ++i) {
      if (batch_of[i] >= done) continue;
      ++counters.subtractions;
      layer->looked_at[pending[i]] = time_ + batch_of[i];
      if (!queries_.has_passed(batch_of[i])) continue;
      layer->clock.mark(rects[i], time_ + batch_of[i]);
      layer->ground.mark(solids_[pending[i]].ground, time_ + batch_of[i]);
      changed.extend(rects[i]);
    }
    counters.batches += done;
    time_ += done;
    pending = to_look_at_again(*layer);
    layer->is_settled = pending.empty();
    if (Clock::now() >= deadline_) break;
  }
  return changed;
}

/// As many of the batches as there is time for, at least one; those before are done when one is.
std::size_t CsgRenderer::Impl::subtract_in_time(const std::vector<Batch>& batches) {
  const bool is_limited = deadline_ != Clock::time_point::max();
  std::int64_t queued_px = 0;
  for (std::size_t batch = 0; batch < batches.size(); ++batch) {
    subtract(batches[batch], batch);
    queued_px += batches[batch].work_px;
    if (!is_limited || queued_px < kLook_px) continue;
    queued_px = 0;
    queries_.wait(batch);
    if (Clock::now() >= deadline_) return batch + 1;
  }
  return batches.size();
}

/// Solids side by side, or a single one that reaches around the eye. Its fronts may be missing
/// then, so that a front behind the kept depth says that it keeps the pixel. Of the others, fronts
/// before the depth say that it goes: they are right also where a face is seen so exactly edge on
/// that it is drawn although it is hidden.
void CsgRenderer::Impl::subtract(const Batch& batch, std::size_t query) {
  if (mark_ == kLastMark) {
    glStencilMask(0xff);
    glClear(GL_STENCIL_BUFFER_BIT);
    mark_ = 0;
  }
  ++mark_;
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  glDepthFunc(batch.is_around_eye ? GL_GREATER : GL_LEQUAL);
  glStencilFunc(GL_ALWAYS, mark_, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glCullFace(GL_BACK);
  store_.draw(batch.solids);

  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_GREATER);
  glStencilFunc(batch.is_around_eye ? GL_NOTEQUAL : GL_EQUAL, mark_, 0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glCullFace(GL_FRONT);
  queries_.begin(query);
  store_.draw(batch.solids);
  QueryPool::end();
}

/// Solids that there was no time for, and those under which a pixel moved after they were
/// subtracted last. It moved to a point of the solid that moved it, so they must overlap in space
/// too.
std::vector<std::uint32_t> CsgRenderer::Impl::to_look_at_again(const Layer& layer) const {
  std::vector<std::uint32_t> again;
  for (const std::uint32_t solid : order_) {
    const std::uint64_t looked_at = layer.looked_at[solid];
    if (looked_at == 0 || (layer.clock.newest(solids_[solid].area.rect) > looked_at &&
                           layer.ground.newest(solids_[solid].ground) > looked_at)) {
      again.push_back(solid);
    }
  }
  return again;
}

/// Background, and over it what is left of the layers, within the rectangle.
Done CsgRenderer::Impl::compose(const PixelRect& rect) {
  std::vector<const DepthLayer*> layers;
  for (const Layer& layer : layers_) layers.push_back(&layer.pixels);
  mark_ = kLastMark;  // it uses the stencil
  return composer_.compose(layers, size_px_, rect, [this] {
    use_solid_program();
    blank_store_.draw();
  });
}

std::size_t CsgRenderer::Impl::gpu_bytes() const {
  std::size_t bytes = store_.gpu_bytes() + blank_store_.gpu_bytes() + shown().gpu_bytes();
  for (const Layer& layer : layers_) bytes += layer.pixels.gpu_bytes();
  return bytes;
}

Done CsgRenderer::Impl::draw(const Projection& projection, double longest_ms, bool shows) {
  if (Done done = resize(projection); !done) return done;
  const bool is_full = is_old_ || !options_.is_local || projection != projection_;
  store_.upload();
  counters.was_full = is_full;
  counters.sweeps = counters.batches = counters.subtractions = 0;

  glViewport(0, 0, size_px_.x, size_px_.y);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
  glEnable(GL_DEPTH_TEST);
  // What reaches beyond the clip planes keeps its front and its back.
  glEnable(GL_DEPTH_CLAMP);
  if (is_full) begin_anew(projection);
  if (longest_ms > 0.0) take_waiting(longest_ms);
  last_changed = {};
  Done done = std::monostate{};
  if (shows) {
    last_changed = std::exchange(unshown_, {});
    done = compose(last_changed);
  }
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_CULL_FACE);
  glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
  counters.gpu_bytes = gpu_bytes();
  return done;
}

Result<CsgRenderer> CsgRenderer::create(const CsgOptions& options) {
  if (!(options.tolerance_mm > 0.0) || !std::isfinite(options.tolerance_mm)) {
    return Error{trf("a tolerance of {} mm is not allowed for the CSG view; must be above 0",
                     options.tolerance_mm)};
  }
  Result<GlProgram> solid = GlProgram::create(shaders::csg_solid_vert, shaders::csg_solid_frag);
  if (!solid) return Error{solid.error()};
  Result<LayerComposer> composer = LayerComposer::create();
  if (!composer) return Error{composer.error()};
  return CsgRenderer(std::make_unique<Impl>(std::move(*solid), std::move(*composer), options));
}

CsgRenderer::CsgRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CsgRenderer::CsgRenderer(CsgRenderer&&) noexcept = default;
CsgRenderer& CsgRenderer::operator=(CsgRenderer&&) noexcept = default;
CsgRenderer::~CsgRenderer() = default;
Done CsgRenderer::set_blank(const CsgBlank& blank) { return impl_->set_blank(blank); }
Done CsgRenderer::set_tools(std::span<const CsgTool> tools) { return impl_->set_tools(tools); }
void CsgRenderer::append(std::span<const SweptMove> moves) { impl_->append(moves); }
void CsgRenderer::clear_moves() { impl_->clear_moves(); }
Done CsgRenderer::draw(const Projection& projection, double longest_ms, bool shows) {
  return impl_->draw(projection, longest_ms, shows);
}
bool CsgRenderer::has_waiting() const { return impl_->has_waiting(); }
PixelRect CsgRenderer::unshown() const { return impl_->unshown(); }
PixelRect CsgRenderer::changed() const { return impl_->last_changed; }
void CsgRenderer::bind_picture(int color_unit, int depth_unit) const {
  impl_->shown().bind_textures(color_unit, depth_unit);
}
void CsgRenderer::show_in(unsigned framebuffer, glm::ivec2 corner_px) const {
  impl_->shown().show_in(framebuffer, corner_px);
}
void CsgRenderer::finish() const { glFinish(); }
Picture CsgRenderer::read() const { return impl_->shown().read(); }
DepthPicture CsgRenderer::read_depth() const { return impl_->shown().read_depth(); }
std::size_t CsgRenderer::move_count() const { return impl_->move_count; }
const CsgCounters& CsgRenderer::counters() const { return impl_->counters; }

}  // namespace kerf
