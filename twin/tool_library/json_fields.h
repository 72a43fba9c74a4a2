// twin/tool_library/json_fields.h - the values of a JSON object that somebody else wrote.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"

namespace kerf {

using Json = nlohmann::json;

/// The document; nothing, with a diagnostic at the place of the fault, if it is none.
std::optional<Json> parse_json(std::string_view text, const std::string& path,
                               Diagnostics& diagnostics);

/// The member; null if there is none, or `object` is no object.
const Json* member(const Json& object, const char* name);
/// Of a text; empty if it is none.
std::string text_of(const Json* value);

/// Numbers of one object. What is there and is none is kept in faults().
class JsonFields {
 public:
  /// `object` may be null: then nothing is there. `mm`: of a unit of its lengths.
  JsonFields(const Json* object, std::string prefix, double mm)
      : object_(object), prefix_(std::move(prefix)), mm_(mm) {}

  /// A JSON number, or a text that begins with one ("5.0000 mm", "0,25 in", "60 °"): then its unit
  /// counts, and a number without one has that of the object. Nothing: it is not there, or no such
  /// number.
  std::optional<double> length_mm(const char* name);
  std::optional<double> angle_deg(const char* name);
  std::optional<double> number(const char* name);
  /// Above 0; what is not counts as not there.
  std::optional<double> positive_mm(const char* name);

  /// "geometry.DC: 'abc' is no length"
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  const Json* find(const char* name) const;
  /// `wanted`: "{} is no length".
  std::optional<double> fault(const char* name, const Json& value, const char* wanted);

  const Json* object_;
  std::string prefix_;
  double mm_;
  std::vector<std::string> faults_;
};

}  // namespace kerf
