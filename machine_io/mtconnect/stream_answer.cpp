#include "machine_io/mtconnect/stream_answer.h"

#include <algorithm>

#include "base/text_scan.h"
#include "base/translate.h"

namespace kerf {
namespace {

void read_observation(const XmlElement& element, bool is_ours, StreamAnswer& out) {
  Observation one;
  one.id = element.attribute("dataItemId");
  const std::optional<AgentTime> stamp = parse_agent_time(element.attribute("timestamp"));
  if (one.id.empty() || !stamp || !read_number(element.attribute("sequence"), one.sequence)) {
    ++out.damaged;
    return;
  }
  ++out.count;
  out.newest = std::max(out.newest, one.sequence);
  if (!is_ours) return;
  one.stamp_ns = stamp->ns;
  one.text = element.text;
  for (const XmlElement& entry : element.children) {
    for (const XmlElement& cell : entry.children) {
      one.cells.emplace_back(cell.attribute("key"), cell.text);
    }
  }
  out.observations.push_back(std::move(one));
}

void read_device_stream(const XmlElement& stream, bool is_ours, StreamAnswer& out) {
  for (const XmlElement& component : stream.children) {
    if (component.name != "ComponentStream") continue;
    for (const XmlElement& group : component.children) {
      // A condition is no value, but has a sequence number.
      const bool is_value = group.name == "Samples" || group.name == "Events";
      for (const XmlElement& one : group.children) read_observation(one, is_ours && is_value, out);
    }
  }
}

}  // namespace

Result<StreamAnswer> parse_streams(std::string_view text, const DeviceModel& device) {
  Result<XmlElement> root = parse_xml(text);
  if (!root) return Error{root.error()};
  StreamAnswer out;
  if (const std::optional<std::string> error = agent_error_of(*root)) {
    out.error = *error;
    return out;
  }
  if (root->name != "MTConnectStreams") {
    return Error{trf("a document of {}, and MTConnectStreams is wanted", shown(root->name))};
  }
  const Result<AgentHeader> header = read_agent_header(*root, true);
  if (!header) return Error{header.error()};
  out.header = *header;
  if (const XmlElement* const streams = root->child("Streams")) {
    for (const XmlElement& one : streams->children) {
      const std::string_view uuid = one.attribute("uuid");
      const bool is_ours =
          uuid.empty() ? one.attribute("name") == device.name : uuid == device.uuid;
      if (one.name == "DeviceStream") read_device_stream(one, is_ours, out);
    }
  }
  std::stable_sort(
      out.observations.begin(), out.observations.end(),
      [](const Observation& a, const Observation& b) { return a.sequence < b.sequence; });
  return out;
}

}  // namespace kerf
