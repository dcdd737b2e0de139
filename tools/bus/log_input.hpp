// The log that a subcommand of `ipos bus` reads, and which of its buses are wanted.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tools/cli/verb.hpp"
#include "tools/logs/log_findings.hpp"

namespace ipos::tools {

struct LogFlags {
  std::string path;
  std::vector<std::string> channels;  // empty: all
};

// LOG and --channel.
void add_log_options(cli::Verb& verb, LogFlags& flags, const std::string& text);
// --channel alone.
void add_channel_option(cli::Verb& verb, LogFlags& flags);

// Which buses of a log are wanted: by name, or by the number of a channel ("1" is can1).
class ChannelChoice {
 public:
  explicit ChannelChoice(const LogFlags& flags) : flags_(flags) {}

  // The reader that gets what is wanted only.
  LogReader choose(LogReader reader);
  // At the end of the log. Throws if no bus has a name that was asked for.
  void check() const;

 private:
  bool takes(const std::string& bus);

  const LogFlags& flags_;
  std::set<std::string> seen_;   // at most kNamedBuses of them
  std::set<std::string> found_;  // of those that were asked for
};

// "can0, can1" for people; of very many the first ones.
std::string bus_list(const std::set<std::string>& names);

// Reads a log of any form (tools/logs), also packed, from a file or standard input. What is wrong in it goes to `findings`,
// which the verb finishes; the members of `reader` for that are left to it.
void read_log_file(const LogFlags& flags, LogFindings& findings, LogReader reader);

}  // namespace ipos::tools
