// One row a line that a unit can have.
#include "tools/parameters/own_monitoring.hpp"

namespace ipos::tools {
namespace {

constexpr Monitoring kRs485{0, 0, 8599, 8612, "P812", "P833"};
constexpr Monitoring kSbus[] = {
    {8600, 8987, 8602, 8615, "P815 (P883 of MOVIDRIVE B)", "P836"},  // P813 or P881, P886
    {8932, 8991, 8934, 8936, "P893", "P837"},                        // P891, P896
};

}  // namespace

tl::expected<std::vector<Monitoring>, AccessError> monitorings(
    WordLine line, uint8_t address, const std::function<AccessReply(uint16_t index)>& read) {
  if (line == WordLine::Rs485) return std::vector{kRs485};
  std::vector<Monitoring> of_unit{kSbus[0]}, of_address;
  for (const Monitoring& one : kSbus) {
    const AccessReply own = read(line == WordLine::Canopen ? one.node : one.address);
    if (!own && !own.error().code) return tl::unexpected(own.error());
    if (!own) continue;  // the unit has no such line
    if (&one != &kSbus[0]) of_unit.push_back(one);
    if (*own == address) of_address.push_back(one);
  }
  return of_address.empty() ? of_unit : of_address;
}

}  // namespace ipos::tools
