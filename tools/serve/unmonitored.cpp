// Two questions to the unit: how long its words may stay away, and what then happens.
#include "tools/serve/unmonitored.hpp"

#include <fmt/format.h>

#include "tools/links/link_access.hpp"
#include "tools/parameters/own_monitoring.hpp"

namespace ipos::tools::serve {

using stdlib::Service;

void refuse_unmonitored(BusLink& link, const EnablingTelegram& telegram) {
  if (telegram.unasked != nullptr)
    throw Mistake(fmt::format("this telegram could enable a drive: {}", telegram.unasked));
  const std::string could = fmt::format("this telegram could enable unit {}, ", telegram.address);
  const auto read = [&](uint16_t index) { return ask(link, telegram.address, Service::Read, index); };
  const WordLine line = link.serial_line() != nullptr ? WordLine::Rs485
                        : link.carries_process_data() ? WordLine::Sbus
                                                      : WordLine::Canopen;
  const auto all = monitorings(line, telegram.address, read);
  if (!all) throw Mistake(could + "which does not tell whether it monitors its process data");
  for (const Monitoring& own : *all) {
    const AccessReply timeout = read(own.timeout);
    if (!timeout)
      throw Mistake(fmt::format("{}which does not tell whether it monitors its process data ({})", could,
                                own.timeout_name));
    const AccessReply response = read(own.response);  // where it cannot be chosen the unit stops
    const bool goes_on = response ? lets_go_on(*response) : !response.error().code;
    if (ends_in_time(*timeout) && !goes_on) continue;
    const std::string why =
        ends_in_time(*timeout)
            ? fmt::format(
                  "{0} lets it go on, so nothing but a person would end the movement. Let it stop first: {0} "
                  "= "
                  "RAPID STOP/ERROR",
                  own.response_name)
            : fmt::format(
                  "{0} is off or longer than {1} ms, so nothing but a person would end the movement in time. "
                  "Switch the monitoring on first: {0} = {2} s, as a parameter on the page or by 'ipos param "
                  "set'",
                  own.timeout_name, kLongestSilence, kLongestSilence / 1000.0);
    throw Mistake(fmt::format("{}and {}", could, why));
  }
}

}  // namespace ipos::tools::serve
