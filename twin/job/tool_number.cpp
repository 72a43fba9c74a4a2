#include "twin/job/tool_number.h"

#include "base/translate.h"

namespace kerf {

std::string hint_of_number(int number) {
  constexpr int kPlaces = 100;
  const int tool = number / kPlaces;
  if (tool <= 0 || tool >= kPlaces || tool != number % kPlaces) return {};
  return trf(
      "LinuxCNC reads tool {} there; if it is meant for tool {} with offset {}, as on other "
      "controls: T{} M6 G43",
      number, tool, tool, tool);
}

}  // namespace kerf
