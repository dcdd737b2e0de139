// Parameters: shown as the unit shows them, written over the parameter channel, volatile.
#include <fmt/format.h>

#include "runtime/signals/collector.hpp"
#include "runtime/signals/parameter_channel.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::signals {

using namespace runtime;

const stdlib::Parameter* find_parameter(const stdlib::UnitType& unit, std::string_view number) {
  const stdlib::Parameter* row = stdlib::parameter_table(unit).find(number);
  return row != nullptr && row->index != 0 ? row : nullptr;
}

Signal& Collector::add_parameter(const stdlib::Parameter& row, Group group, std::string_view name) {
  Signal& signal = add(group, name, fmt::format("P{} {}", row.number, row.name),
                       [&station = owner_.station, &row] {
                         return row.number_of(station.drive().parameters().value(row.index));
                       });
  const stdlib::DisplayScale scale = stdlib::display_scale(row);
  if (row.display == "hex")
    signal.bits = kLongBits;
  else
    signal.unit = row.display;
  signal.factor = scale.factor;
  signal.decimals = scale.decimals;
  signal.number = row.index;
  if (group != Group::Parameter) return signal;  // what the drive shows
  signal.parameter = &row;
  signal.limits = {INT32_MIN, UINT32_MAX};
  signal.put = write_parameter;
  return signal;
}

// Of rows that share a number or an index, the one which the name leads to; an index that is a number of another has no name.
void add_parameters(Collector& out) {
  const stdlib::ParameterTable& table = stdlib::parameter_table(*out.station().config().unit);
  for (const stdlib::Parameter& row : table.rows()) {
    if (row.index == 0) continue;
    for (const std::string& shown : {fmt::format("P{}", row.number), fmt::format("{}", row.index)})
      if (table.find(std::string_view(shown)) == &row) {
        out.add_parameter(row, Group::Parameter, shown);
        break;
      }
  }
}

ParameterReply parameter_channel(UnitInterface& drive, stdlib::Service service, uint16_t index, int32_t value) {
  return drive.parameters().execute(service, index, value);
}

Refusal write_parameter(Station& station, uint32_t number, int32_t value) {
  const auto index = static_cast<uint16_t>(number);
  const auto service = ParameterService::WriteVolatile;
  const ParameterReply reply = parameter_channel(station.drive(), service, index, value);
  if (reply) return std::nullopt;
  return station.drive().parameters().explain(static_cast<uint8_t>(service), index, value, reply.error());
}

}  // namespace ipos::signals
