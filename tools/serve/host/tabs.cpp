// All tabs of a plant.
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {

std::vector<std::unique_ptr<Tab>> make_tabs(PlantHost& host) {
  std::vector<std::unique_ptr<Tab>> tabs;
  tabs.push_back(make_plant_tab(host));
  tabs.push_back(make_watch_tab(host));
  tabs.push_back(make_scope_tab(host));
  tabs.push_back(make_parameter_tab(host));
  tabs.push_back(make_bus_tab(host));
  tabs.push_back(make_program_tab(host));
  tabs.push_back(make_files_tab(host));
  tabs.push_back(make_journal_tab(host));
  tabs.push_back(make_hash_tab(host));
  tabs.push_back(make_timeline_tab(host));
  tabs.push_back(make_keep_tab(host));
  tabs.push_back(make_form_tab(host));
  return tabs;
}

}  // namespace ipos::tools::serve
