// Files to readers, by way of the choice of a bus.
#include "tools/bus/log_input.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/diag/places.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"

namespace ipos::tools {
namespace {

constexpr size_t kNamedBuses = 10;  // in a message (ours)

bool is_asked_for(const std::string& channel, const std::string& bus) {
  return channel == bus || "can" + channel == bus;
}

}  // namespace

void add_channel_option(cli::Verb& verb, LogFlags& flags) {
  verb.option("--channel", flags.channels, "only these buses of the log, by name or number, for example can0")
      .separated_by(',');
}

void add_log_options(cli::Verb& verb, LogFlags& flags, const std::string& text) {
  verb.option("LOG", flags.path, text).required();
  add_channel_option(verb, flags);
}

bool ChannelChoice::takes(const std::string& bus) {
  if (flags_.channels.empty()) return true;
  if (seen_.size() <= kNamedBuses) seen_.insert(bus);
  const auto wanted = std::find_if(flags_.channels.begin(), flags_.channels.end(),
                                   [&](const std::string& channel) { return is_asked_for(channel, bus); });
  if (wanted == flags_.channels.end()) return false;
  found_.insert(*wanted);
  return true;
}

LogReader ChannelChoice::choose(LogReader reader) {
  const auto bus_of = [](const auto& entry) -> const std::string& {
    if constexpr (requires { entry.bus; })
      return entry.bus;
    else
      return entry.line;
  };
  const auto chosen = [this, bus_of](auto take) {
    return [this, bus_of, take = std::move(take)](const auto& entry, LogPlace place) {
      if (takes(bus_of(entry))) take(entry, place);
    };
  };
  reader.can = chosen(std::move(reader.can));
  reader.serial = chosen(std::move(reader.serial));
  reader.dp = chosen(std::move(reader.dp));
  return reader;
}

void ChannelChoice::check() const {
  for (const std::string& channel : flags_.channels)
    if (!found_.contains(channel))
      throw Failure(kUsage, fmt::format("{}: there is no bus '{}' in the log{}",
                                        compiler::printable(flags_.path), compiler::printable(channel),
                                        seen_.empty() ? "" : ", only " + bus_list(seen_)));
}

std::string bus_list(const std::set<std::string>& names) {
  std::string list;
  size_t count = 0;
  for (const std::string& name : names) {
    if (count++ == kNamedBuses) return list + ", ...";
    list += (list.empty() ? "" : ", ") + compiler::printable(name);
  }
  return list;
}

void read_log_file(const LogFlags& flags, LogFindings& findings, LogReader reader) {
  ChannelChoice choice(flags);
  const LogReader watched = findings.watch(choice.choose(std::move(reader)));
  read_log(read_file(flags.path, kLogLimit), watched);
  if (findings.understood()) choice.check();
}

}  // namespace ipos::tools
