// The tabs of the page, each with its commands and topics.
#pragma once

#include <memory>
#include <vector>

#include "runtime/station/profibus_bus.hpp"
#include "tools/serve/plant_host.hpp"

namespace ipos::tools::serve {

std::unique_ptr<Tab> make_plant_tab(PlantHost& host);
std::unique_ptr<Tab> make_watch_tab(PlantHost& host);
std::unique_ptr<Tab> make_scope_tab(PlantHost& host);
std::unique_ptr<Tab> make_parameter_tab(PlantHost& host);
std::unique_ptr<Tab> make_bus_tab(PlantHost& host);
std::unique_ptr<Tab> make_program_tab(PlantHost& host);
std::unique_ptr<Tab> make_journal_tab(PlantHost& host);

// They come after CAN and RS-485 lines wherever lines have numbers.
std::vector<runtime::ProfibusBus*> profibus_lines(const runtime::Plant& plant);

std::vector<std::unique_ptr<Tab>> make_tabs(PlantHost& host);

}  // namespace ipos::tools::serve
