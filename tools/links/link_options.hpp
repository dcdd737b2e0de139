// Options of the verbs that reach a unit over a port.
#pragma once

#include <string>

#include "tools/cli/verb.hpp"
#include "tools/links/bus_link.hpp"

namespace ipos::tools {

// --baud, --quiet, and --port unless the port is a word of its own.
void add_link_options(cli::Verb& verb, LinkFlags& flags, bool port);

// --profibus, for verbs that speak DP, too.
void add_profibus_option(cli::Verb& verb, LinkFlags& flags);
// Both kinds of masters at once, or a port that no PROFIBUS line can have: a Failure.
void check_profibus(const LinkFlags& flags);

// For options that name a unit type with parameters, and for addresses of single units.
std::string check_unit(const std::string& name);
std::string check_address(const std::string& text);

}  // namespace ipos::tools
