#include "viewer/png_image.h"

#include <png.h>

#include <cassert>
#include <csetjmp>

#include "base/translate.h"

namespace kerf {
namespace {

/// Fast and within a tenth of the smallest size for shaded pictures.
constexpr int kCompressionLevel = 4;
constexpr int kFilters = PNG_FILTER_SUB | PNG_FILTER_UP;

void append(png_structp png, png_bytep data, png_size_t size) {
  auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  try {
    bytes->insert(bytes->end(), data, data + size);
  } catch (const std::bad_alloc&) {
    png_error(png, tr("out of memory"));  // Back to setjmp: no exception may cross the C library.
  }
}

void flush(png_structp) {}
void ignore_message(png_structp, png_const_charp) {}

/// No objects with destructors live in here: libpng leaves by longjmp.
bool write_image(png_structp png, png_infop info, const Picture& picture,
                 std::vector<std::uint8_t>* bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, bytes, append, flush);
  png_set_compression_level(png, kCompressionLevel);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, kFilters);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width_px),
               static_cast<png_uint_32>(picture.height_px), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width_px) * 3;
  for (int y = 0; y < picture.height_px; ++y) {
    png_write_row(png, picture.rgb.data() + static_cast<std::size_t>(y) * row_bytes);
  }
  png_write_end(png, info);
  return true;
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_png(const Picture& picture) {
  assert(picture.width_px > 0 && picture.height_px > 0);
  assert(picture.rgb.size() == static_cast<std::size_t>(picture.width_px) *
                                   static_cast<std::size_t>(picture.height_px) * 3);
  std::vector<std::uint8_t> bytes;
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, ignore_message);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool written = info && write_image(png, info, picture, &bytes);
  png_destroy_write_struct(png ? &png : nullptr, info ? &info : nullptr);
  if (!written) return Error{tr("out of memory while compressing a picture")};
  return bytes;
}

}  // namespace kerf
