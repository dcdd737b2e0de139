// The subcommands of `ipos bus`, one file each.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/movilink/describe.hpp"
#include "tools/verbs.hpp"

namespace ipos::tools {

void add_bus_plan(CLI::App& bus, int& exit_code);
void add_bus_decode(CLI::App& bus, int& exit_code);
void add_bus_monitor(CLI::App& bus, int& exit_code);
void add_bus_load(CLI::App& bus, int& exit_code);
void add_bus_replay(CLI::App& bus, int& exit_code);
void add_bus_dbc(CLI::App& bus, int& exit_code);

// Calls `take` for each good line of a candump log, with its number; prints the others as "LOG:line:column:
// error: ...". Returns how many were bad.
size_t read_log(const std::string& path,
                const std::function<void(const runtime::LogEntry&, size_t line)>& take);

// The dictionary of a plant or program: it runs for a moment, so that its programs define their objects.
runtime::TelegramNames names_of(const std::string& path, const CompileFlags& compile);
runtime::TelegramNames serial_names_of(const std::string& path, const CompileFlags& compile);

// --names FILE, also as --plant and --program.
void add_names_option(CLI::App& verb, std::string& path);

// For options that take a duration.
std::string check_time(const std::string& text);

}  // namespace ipos::tools
