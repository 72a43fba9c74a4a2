#include "mesh/threemf_model.h"

#include <expat.h>
#include <fmt/format.h>

#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "base/expat_line.h"
#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

constexpr ThreemfTransform kInPlace{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0}};
constexpr std::pair<std::string_view, double> kUnits[] = {{"micron", 0.001},  {"millimeter", 1},
                                                          {"centimeter", 10}, {"inch", 25.4},
                                                          {"foot", 304.8},    {"meter", 1000}};
/// Extensions that leave the meshes as they are.
constexpr std::string_view kUnderstood[] = {"/production/", "/material/", "/trianglesets/"};

/// A name without the prefix of its namespace.
std::string_view bare(std::string_view name) {
  const std::size_t colon = name.rfind(':');
  return colon == name.npos ? name : name.substr(colon + 1);
}

/// What an element says of itself.
class Attributes {
 public:
  explicit Attributes(const XML_Char** all) : all_(all) {}
  std::optional<std::string_view> get(std::string_view name) const {
    for (const XML_Char** at = all_; *at != nullptr; at += 2)
      if (bare(at[0]) == name) return at[1];
    return std::nullopt;
  }
  /// Namespaces by prefix: xmlns:p="..".
  std::string_view space(std::string_view prefix) const {
    for (const XML_Char** at = all_; *at != nullptr; at += 2) {
      std::string_view name = at[0];
      if (take_prefix(name, "xmlns:") && name == prefix) return at[1];
    }
    return {};
  }

 private:
  const XML_Char** all_;
};

}  // namespace

struct ThreemfReader::State {
  State(std::string of, std::size_t most_triangles)
      : name(std::move(of)), most(most_triangles), parser(XML_ParserCreate(nullptr)) {
    XML_SetUserData(parser, this);
    XML_SetStartElementHandler(parser,
                               [](void* self, const XML_Char* element, const XML_Char** all) {
                                 static_cast<State*>(self)->begin(bare(element), Attributes(all));
                               });
    // 3MF forbids them; with them a few bytes would become many.
    XML_SetStartDoctypeDeclHandler(
        parser, [](void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
          static_cast<State*>(self)->fail(tr("a document type is not allowed in 3MF"));
        });
  }
  ~State() { XML_ParserFree(parser); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void fail(const std::string& text) {
    if (!fault.empty()) return;
    fault = fmt::format("{}:{}: {}", name, expat_line(parser), text);
    XML_StopParser(parser, XML_FALSE);
  }

  void begin(std::string_view element, const Attributes& has) {
    if (!fault.empty()) return;
    if (element == "model") {
      begin_model(has);
    } else if (element == "object") {
      object = nullptr;
      if (const auto id = has.get("id")) object = &model.objects[std::string(*id)];
    } else if (element == "vertex") {
      add_corner(has);
    } else if (element == "triangle") {
      add_triangle(has);
    } else if (element == "component") {
      if (object != nullptr) place(has, object->components);
    } else if (element == "item") {
      place(has, model.build);
    }
  }

  void begin_model(const Attributes& has) {
    is_model = true;
    const std::string_view unit = has.get("unit").value_or("millimeter");
    bool known = false;
    for (const auto& [word, mm] : kUnits) {
      if (word != unit) continue;
      model.mm_per_unit = mm;
      known = true;
    }
    if (!known) return fail(trf("unknown unit '{}'", shown(unit)));
    for (const std::string_view prefix : words_of(has.get("requiredextensions").value_or(""))) {
      const std::string_view space = has.space(prefix);
      bool understood = false;
      for (const std::string_view word : kUnderstood) understood |= contains(space, word);
      if (!understood) {
        return fail(trf("needs the extension {}, which is not read",
                        shown(space.empty() ? prefix : space)));
      }
    }
  }

  void add_corner(const Attributes& has) {
    if (object == nullptr) return;
    Vec3 corner{0};
    constexpr std::string_view kNames[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view text = has.get(kNames[axis]).value_or("");
      const std::optional<double> value = parse_decimal(trim(text));
      if (!value) return fail(trf("'{}' found where a number is due", shown(text)));
      corner[axis] = *value;
    }
    object->corners.push_back(corner);
  }

  void add_triangle(const Attributes& has) {
    if (object == nullptr) return;
    std::array<std::uint32_t, 3> triangle{};
    constexpr std::string_view kNames[] = {"v1", "v2", "v3"};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view text = has.get(kNames[i]).value_or("");
      if (!read_number(text, triangle[i]))
        return fail(trf("'{}' found where a number is due", shown(text)));
      if (triangle[i] >= object->corners.size()) {
        return fail(trf("triangle with corner {}; {} corners are there", triangle[i],
                        object->corners.size()));
      }
    }
    if (++triangles > most)
      return fail(trf("has {} triangles or more; must be from 1 to {}", triangles, most));
    object->triangles.push_back(triangle);
  }

  void place(const Attributes& has, std::vector<ThreemfPlaced>& out) {
    ThreemfPlaced placed{std::string(has.get("path").value_or("")),
                         std::string(has.get("objectid").value_or("")), kInPlace};
    if (const auto text = has.get("transform")) {
      const std::vector<std::string_view> words = words_of(*text);
      for (std::size_t i = 0; i < 12; ++i) {
        const auto value = words.size() == 12 ? parse_decimal(words[i]) : std::nullopt;
        if (!value) return fail(trf("transform '{}' is not twelve numbers", shown(*text)));
        placed.transform[i / 3][static_cast<int>(i % 3)] = *value;
      }
    }
    out.push_back(std::move(placed));
  }

  void parse(std::string_view piece, bool last) {
    if (!fault.empty()) return;
    const auto size = static_cast<int>(piece.size());
    if (XML_Parse(parser, piece.data(), size, last ? XML_TRUE : XML_FALSE) != XML_STATUS_ERROR)
      return;
    if (fault.empty()) fail(XML_ErrorString(XML_GetErrorCode(parser)));
  }

  std::string name;
  std::size_t most;
  XML_Parser parser;
  ThreemfModel model;
  ThreemfObject* object = nullptr;
  std::size_t triangles = 0;
  bool is_model = false;
  std::string fault;
};

ThreemfReader::ThreemfReader(std::string name, std::size_t most)
    : state_(std::make_unique<State>(std::move(name), most)) {}
ThreemfReader::~ThreemfReader() = default;

bool ThreemfReader::take(std::string_view piece) {
  state_->parse(piece, false);
  return state_->fault.empty();
}

Result<ThreemfModel> ThreemfReader::finish() {
  state_->parse({}, true);
  if (state_->fault.empty() && !state_->is_model) state_->fail(tr("is no 3MF model"));
  if (!state_->fault.empty()) return Error{state_->fault};
  return std::move(state_->model);
}

}  // namespace kerf
