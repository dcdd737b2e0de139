// The tabs of the page, each with its commands and topics.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "tools/serve/host/plant_host.hpp"

namespace ipos::tools::serve {

inline constexpr std::string_view kPerson = "a person";  // who forces by the page

std::unique_ptr<Tab> make_plant_tab(PlantHost& host);
std::unique_ptr<Tab> make_watch_tab(PlantHost& host);
std::unique_ptr<Tab> make_scope_tab(PlantHost& host);
std::unique_ptr<Tab> make_parameter_tab(PlantHost& host);
std::unique_ptr<Tab> make_bus_tab(PlantHost& host);
std::unique_ptr<Tab> make_program_tab(PlantHost& host);
std::unique_ptr<Tab> make_files_tab(PlantHost& host);
std::unique_ptr<Tab> make_journal_tab(PlantHost& host);
std::unique_ptr<Tab> make_hash_tab(PlantHost& host);
std::unique_ptr<Tab> make_timeline_tab(PlantHost& host);
std::unique_ptr<Tab> make_keep_tab(PlantHost& host);
std::unique_ptr<Tab> make_form_tab(PlantHost& host);

std::vector<std::unique_ptr<Tab>> make_tabs(PlantHost& host);

}  // namespace ipos::tools::serve
